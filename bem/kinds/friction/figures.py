"""Figures of friction: Stribeck curves with their parts, sections through film and surface.

Knows a run's dataset, summary and scene; solves nothing. Verified in tests/plots/test_figures.py: every figure of every
built-in scene is drawn.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bem.kinds.friction.friction_map import FRICTION_MAP
from bem.physical_constants import ZERO_CELSIUS
from bem.plots.cases import case_words, grouped, many_speeds
from bem.plots.figures import FigureKind
from bem.plots.labels import FILM_HEIGHTS, loaded_part
from bem.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PINK,
    SKY,
    VERMILION,
    has_unresolved_spike,
    label,
    mark_spike,
    name_case,
    prefix,
    speed_axis,
)
from bem.scenes.records import INPUTS

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, SKY, PINK, BLACK) * 9
_MODEL_NAMES = {
    "capped": "capped at the hardness",
    "elastic": "elastic",
    "uncoupled": "uncoupled asperities, plastic",
    "uncoupled_elastic": "uncoupled asperities, elastic",
}
_ALIKE = 0.01
"""Fraction of the highest friction: a curve that stays closer to an earlier one hides it."""
Array = NDArray[Any]


def _curves(run: Any, name: str) -> list[tuple[str, Array]]:
    """Label and values (repetition, speed) of each curve, in the order of speed; models are spelt out."""
    order = np.argsort(run.dataset["speed"].values)
    found = []
    for words, values in grouped(run, name):
        parts = [_MODEL_NAMES.get(part, part) for part in words.split(", ") if part]
        found.append((", ".join(parts) or "friction", values[:, order]))
    return found


def _band(axes: Axes, x: Array, values: Array, colour: str, name: str, **how: Any) -> None:
    """Mean of the rows as a line, their range as a band."""
    axes.plot(x, values.mean(axis=0), color=colour, label=name, **how)
    if len(values) > 1:
        axes.fill_between(x, values.min(axis=0), values.max(axis=0), color=colour, alpha=0.18, linewidth=0)


def _stribeck(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed, curves = np.sort(run.dataset["speed"].values), _curves(run, "friction")
    many = len(curves) > 6
    drawn: list[Array] = []
    near = _ALIKE * max((float(np.nanmax(values)) for _, values in curves if np.isfinite(values).any()), default=0.0)
    for number, (name, values) in enumerate(curves):
        style: Any = "--" if "uncoupled" in name else "-"
        mean = values.mean(axis=0)
        if any(np.nanmax(np.abs(mean - other), initial=0.0) < near for other in drawn):
            style = (0, (2, 2))  # both are seen
        drawn.append(mean)
        _band(axes, speed, values, _COLOURS[number], name, linestyle=style, linewidth=0.9 if many else 1.4)
        if number == 0:
            if f"friction{INPUTS}" in run.dataset.variables:
                scatter = _curves(run, f"friction{INPUTS}")[0][1].mean(axis=0)
                axes.fill_between(
                    speed, mean - scatter, mean + scatter, color="0.6", alpha=0.4, linewidth=0, label="inputs"
                )
            for key, text, dots in (("boundary_part", "boundary part", ":"), ("film_part", "film part", "-.")):
                part = _curves(run, key)[0][1].mean(axis=0)
                axes.plot(speed, part, color="0.45", linestyle=dots, linewidth=1.1, label=text)
    axes.set_ylabel("friction coefficient")
    speed_axis(axes, speed)
    axes.legend(ncols=2 if many else 1)


def _sharing(run: Any, figure: Figure) -> None:
    """Loads above, film thickness below, of the first curve over its repetitions."""
    speed = np.sort(run.dataset["speed"].values)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for key, colour, text in (("contact_load", VERMILION, "contact"), ("film_load", BLUE, "film")):
        _band(upper, speed, _curves(run, key)[0][1], colour, text)
    upper.set_ylabel("load (N)")
    upper.set_ylim(0)
    upper.legend()
    film = _curves(run, "minimum_film")[0][1]
    factor, unit = prefix(film, "m")
    _band(lower, speed, film * factor, BLUE, "")
    lower.set_ylabel(label("minimum film thickness\nunder the film's load", unit))
    speed_axis(lower, speed)
    _name_first_curve(run, figure)


def _name_first_curve(run: Any, figure: Figure) -> None:
    """Say which curve is shown where there are several."""
    words = [part for part in case_words(run.dataset).split(", ") if part and not part.startswith("repetition")]
    name_case(figure, ", ".join(_MODEL_NAMES.get(part, part) for part in words))


def _temperatures(run: Any, figure: Figure) -> None:
    """Draw the temperatures of oil and surfaces in contact, of each curve; the surfaces' highest of the first."""
    axes, speed = figure.add_subplot(), np.sort(run.dataset["speed"].values)
    for number, (name, values) in enumerate(_curves(run, "contact_temperature")):
        if not np.isfinite(values).any():  # nothing rubs: no line, and none in the legend
            continue
        _band(
            axes,
            speed,
            values - ZERO_CELSIUS,
            _COLOURS[number],
            f"surfaces in contact, {name}".replace(", friction", ""),
        )
    for key, text, dots in (("flash_temperature", "highest of them", ":"), ("oil_temperature", "oil, mean", "-.")):
        first = _curves(run, key)[0][1].mean(axis=0)
        if not np.isfinite(first).any():
            continue
        axes.plot(speed, first - ZERO_CELSIUS, color="0.45", linestyle=dots, label=text)
    axes.set_ylabel("temperature (°C)")
    speed_axis(axes, speed)
    axes.set_ylim(auto=True)
    axes.autoscale(axis="y")
    axes.legend(fontsize=8)


_OVERLAP = 1e-9
"""Height above the upper surface from which a peak that yields under the capped pressure is said to overlap it [m]."""


def _section(run: Any, figure: Figure) -> None:
    """Draw a line along the sliding at the speed at which film and contact share the load most evenly."""
    data = run.dataset
    x, height = data["x"].values, data["height"].values
    pressure = data["pressure"].values
    row = _row_of_the_separation(run)
    deformed = (height - height.mean() - data["displacement"].values)[:, row]
    plane = data["separation"].values
    reach = np.abs(x[pressure.any(axis=1)])
    limit = min(2.5 * float(reach.max()), float(np.abs(x).max())) if reach.size else float(np.abs(x).max())
    seen = np.abs(x) <= limit
    factor_x, unit_x = prefix(limit, "m")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    upper.plot(x[seen] * factor_x, plane[seen] * 1e9, color=BLUE, label="upper surface, drawn smooth")
    film = data["film_thickness_patch"].values
    upper.plot(x[seen] * factor_x, film[seen] * 1e9, color=SKY, linestyle="--", label="film thickness")
    touch = seen & (pressure[:, row] > 0)
    overlaps = bool(((deformed - plane)[touch] > _OVERLAP).any())
    words = "lower surface, deformed" + (" (capped peaks overlap)" if overlaps else "")
    upper.plot(x[seen] * factor_x, deformed[seen] * 1e9, color="0.25", linewidth=1.0, label=words)
    upper.plot(x[touch] * factor_x, deformed[touch] * 1e9, ".", color=VERMILION, markersize=4, label="in contact")
    low = float(deformed[seen].min()) * 1e9
    high = 1.4e9 * float(np.quantile(film[seen], 0.75))
    tallest = max(deformed[seen].max(), plane[seen].max()) * 1e9
    upper.set_ylim(low * 1.05, max(high, tallest))
    upper.set_ylabel("height (nm), with the\nroughness of both surfaces", fontsize=8)
    upper.legend(fontsize=8, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))  # above the curves
    lower.plot(x[seen] * factor_x, data["film_pressure_patch"].values[seen] * 1e-6, color=BLUE, label="film")
    lower.plot(
        x[seen] * factor_x,
        pressure.mean(axis=1)[seen] * 1e-6,
        color=VERMILION,
        linewidth=1.0,
        label="contact, mean over y",
    )
    lower.set_xlabel(label("x", unit_x))
    lower.set_ylabel("pressure (MPa)")
    lower.set_ylim(0)
    lower.legend(fontsize=8, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))  # above the curves


def _row_of_the_separation(run: Any) -> int:
    """Return the row of cells along x whose separation is stored: the middle one of a point contact.

    The separation of a cylinder is that of every row; the row with most contacts shows most there.
    """
    pressure = run.dataset["pressure"].values
    contact = run.scene["contact"]
    if any(contact.get(name) is not None for name in ("ball", "radii")):
        return int(pressure.shape[1] // 2)
    return int(np.argmax((pressure > 0).sum(axis=0)))


def _film(run: Any, figure: Figure) -> None:
    data = run.dataset
    x, pressure, film = data["film_x"].values, data["film_pressure"].values, data["film_thickness"].values
    first, last = loaded_part(x, pressure)
    seen = (first <= x) & (x <= last)
    factor_x, unit_x = prefix(0.5 * (last - first), "m")
    factor, unit = prefix(pressure, "Pa")
    axes = figure.add_subplot()
    axes.plot(x[seen] * factor_x, pressure[seen] * factor, color=BLUE)
    axes.set_xlabel(label("x", unit_x))
    axes.set_ylabel(label("film pressure", unit), color=BLUE)
    axes.set_ylim(0)
    if has_unresolved_spike(run.summary):
        mark_spike(axes, x[seen] * factor_x, pressure[seen] * factor)
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    other.plot(x[seen] * factor_x, film[seen] * 1e9, color=VERMILION)
    other.set_ylim(0, FILM_HEIGHTS * float(film.min()) * 1e9)
    other.set_ylabel("film thickness (nm)", color=VERMILION)


def _difference(run: Any, figure: Figure) -> None:
    rows = list(run.summary["largest_difference"])
    axes = figure.add_subplot()
    names = list(dict.fromkeys((row["variant"], row["model"]) for row in rows))
    pressures = run.scene["contact"].get("hertz_pressures")
    loads = sorted({row["load_N"] for row in rows})
    x_of = dict(zip(loads, sorted(pressures), strict=True)) if pressures else {load: load for load in loads}
    for number, (colour, (variant, model)) in enumerate(zip(_COLOURS, names, strict=False)):
        own = [row for row in rows if (row["variant"], row["model"]) == (variant, model)]
        x = [x_of[row["load_N"]] * (1e-9 if pressures else 1.0) for row in own]
        text = ", ".join(part for part in (variant, _MODEL_NAMES[model]) if part)
        axes.errorbar(
            x,
            [row["d_percent"] for row in own],
            yerr=[row["d_percent_spread"] for row in own],
            color=colour,
            marker="so^Dv"[number % 5],
            markersize=6 if number % 5 == 0 else 3.5,  # equal ones stay visible on each other
            markerfacecolor="none" if number % 5 == 0 else colour,
            capsize=2,
            linestyle="--" if model == "elastic" else "-",
            label=text,
        )
    axes.set_xlabel("maximum Hertz pressure (GPa)" if pressures else "load (N)")
    axes.set_ylabel("largest difference d (%)")
    highest = max(row["d_percent"] + row["d_percent_spread"] for row in rows)
    axes.set_ylim(0, 1.15 * highest if highest > 0 else 1.0)
    axes.legend()


def _has_differences(run: Any) -> bool:
    return bool(run.summary.get("largest_difference"))


FIGURES = (
    FigureKind(
        "stribeck-curve",
        "Friction coefficient over speed, and the parts that boundary friction and the film have in the first "
        "curve; bands span the repetitions, a grey band is one standard deviation by uncertain inputs; a curve that "
        "lies on another is dotted.",
        ("speed", "friction", "boundary_part", "film_part", "model"),
        _stribeck,
        (5.4, 4.0),
        many_speeds,
        all_cases=True,
    ),
    FigureKind(
        "load-sharing",
        "Load on film and asperities, and minimum film thickness under the film's load, over speed (first curve).",
        ("speed", "contact_load", "film_load", "minimum_film", "model"),
        _sharing,
        (5.0, 4.6),
        many_speeds,
        all_cases=True,
    ),
    FigureKind(
        "contact-temperatures",
        "Surfaces in contact, mean by pressure, over speed; the highest of them and the oil's mean in the first curve.",
        ("speed", "contact_temperature", "flash_temperature", "oil_temperature"),
        _temperatures,
        (5.2, 3.6),
        many_speeds,
        all_cases=True,
    ),
    FigureKind(
        "film-section",
        "A section along sliding: film thickness, gap between both bodies with the roughness of both on the lower one, "
        "and pressures.",
        ("x", "height", "separation", "film_thickness_patch", "displacement", "pressure", "shown_speed"),
        _section,
        (6.0, 4.8),
        lambda run: bool(run.dataset["pressure"].values.any()),
        all_cases=True,
    ),
    FigureKind(
        "film-pressure",
        "Pressure and thickness of the smooth film; a spike that the mesh does not resolve is dotted, and the axis "
        "ends at 1.25 times the highest pressure beside it.",
        ("film_x", "film_pressure", "film_thickness", "shown_speed"),
        _film,
        (5.4, 3.4),
        all_cases=True,
    ),
    FigureKind(
        "largest-difference",
        "Largest relative difference of friction between uncoupled asperities and the rough half-space, over load.",
        ("speed", "friction", "model"),
        _difference,
        (5.6, 3.6),
        _has_differences,
        all_cases=True,
    ),
    FRICTION_MAP,
)
