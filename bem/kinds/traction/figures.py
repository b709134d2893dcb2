"""Figures of rolling and sliding line contacts: traction over the slide-to-roll ratio, film and heat along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bem.notes import of_summary
from bem.notes.lubrication import FILM_SPIKE
from bem.physical_constants import ZERO_CELSIUS
from bem.plots.cases import Array, axes_of, case_words, first_case, grouped, label_of
from bem.plots.figures import FigureKind
from bem.plots.over import COLOURS, axis_of, lines_over
from bem.plots.style import BLACK, BLUE, VERMILION, has_unresolved_spike, label, mark_spike, name_case, prefix

_MOST_TEMPERATURES = 6
"""Cases that are drawn with temperatures of oil and surfaces; of more, every n-th."""


def _ratio_of(run: Any) -> str | None:
    """The axis of slide-to-roll ratios, if the cases lie along one."""
    return axis_of(run, "slide_roll_ratio")


def _curve(run: Any, figure: Figure) -> None:
    data, ratio = run.dataset, _ratio_of(run)
    hot = "film_temperature" in data.variables
    panels = figure.subplots(2 if hot else 1, 1, sharex=True, squeeze=False)[:, 0]
    lines_over(panels[0], data, "traction_coefficient", ratio)
    panels[0].set_ylabel("friction coefficient")
    if (data["traction_coefficient"].values >= 0).all():
        panels[0].set_ylim(0)
    if hot:
        lines_over(panels[1], data, "film_temperature", ratio, ZERO_CELSIUS)
        panels[1].set_ylabel("oil in the contact (°C)")
    panels[-1].set_xlabel("slide-to-roll ratio")
    if panels[0].get_legend_handles_labels()[1]:
        panels[0].legend()


_GEARS = {"lower": "pinion", "upper": "wheel"}
"""Bodies of a gear pair, whose path of contact has marks."""


def _surface(run: Any, body: str) -> str:
    """Return the name of the surface of a body, "lower" or "upper": of gears that of the pinion or the wheel."""
    marks = (run.scene.get("along") or {}).get("marks") or {}
    gears = any(place is not None for place in marks.values())
    return f"{_GEARS[body]} ({body} surface)" if gears else f"{body} surface"


def _known(run: Any, name: str) -> list[tuple[str, Array]]:
    """Label and values of the cases whose temperatures were found."""
    return [(case, values) for case, values in grouped(run, name) if np.isfinite(values).any()]


def _temperatures(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    cases = _known(run, "oil_temperature")
    chosen = np.linspace(0, len(cases) - 1, min(len(cases), _MOST_TEMPERATURES)).round().astype(int)
    shown = [cases[i] for i in chosen]
    x = run.dataset["x"].values
    x = x if x.ndim == 1 else first_case(run.dataset)["x"].values
    surfaces = {name: dict(grouped(run, f"{name}_surface_temperature")) for name in ("lower", "upper")}
    for colour, (case, oil) in zip(COLOURS, shown, strict=False):
        axes.plot(x, oil[0] - ZERO_CELSIUS, color=colour, label=f"oil, {case}" if case else "oil")
        for name, dash in (("lower", "--"), ("upper", ":")):
            axes.plot(x, surfaces[name][case][0] - ZERO_CELSIUS, color=colour, linestyle=dash)
    common = COLOURS[0] if len(shown) == 1 else BLACK  # dashes of every colour
    axes.plot([], [], "--", color=common, label=_surface(run, "lower"))
    axes.plot([], [], ":", color=common, label=_surface(run, "upper"))
    axes.set_xlabel("x over the Hertz half-width")
    axes.set_ylabel("temperature (°C)")
    axes.legend()
    said = [f"{len(shown)} of {len(cases)} cases"] if len(shown) < len(cases) else []
    if any(note["code"] == FILM_SPIKE.code for note in of_summary(run.summary)):
        said.append("temperature at an unresolved pressure spike follows the mesh")
    axes.set_title("; ".join(said), fontsize=8.5)


def _field(run: Any, figure: Figure) -> None:
    case, field = _known(run, "field")[-1]
    data, data_of = first_case(run.dataset), dict(grouped(run, "thickness"))
    x, height = data["x"].values, data["height"].values
    upper, lower = figure.subplots(2, 1, sharex=True)
    shown = np.isfinite(field[0][:, 0])
    thickness = data_of[case][0][shown] * 1e9
    place = np.broadcast_to(x[shown, None], (int(shown.sum()), len(height)))
    filled = upper.contourf(
        place, height * thickness[:, None], field[0][shown] - ZERO_CELSIUS, levels=24, cmap="inferno"
    )
    figure.colorbar(filled, ax=upper, label="oil (°C)")
    middle = thickness[np.argmin(np.abs(x[shown]))]
    upper.set_ylim(0, 3 * middle)
    upper.set_ylabel("height in the film (nm)")
    if case:
        upper.set_title(f"position {case}" if "position" in axes_of(run.dataset) else case)
    for name, colour in (("lower", BLUE), ("upper", VERMILION)):
        row = dict(grouped(run, f"{name}_surface_temperature"))[case][0]
        lower.plot(x, row - ZERO_CELSIUS, color=colour, label=_surface(run, name))
    lower.plot(x, np.max(field[0], axis=1) - ZERO_CELSIUS, color=BLACK, label="hottest oil")
    lower.set_xlabel("x over the Hertz half-width")
    lower.set_ylabel("temperature (°C)")
    lower.legend()


def _film(run: Any, figure: Figure) -> None:
    data = first_case(run.dataset)
    x, upper = data["x"].values, figure.add_subplot()
    factor, unit = prefix(data["pressure"].values, "Pa")
    upper.plot(x, data["pressure"].values * factor, color=BLUE, label="pressure")
    upper.set_xlabel("x over the Hertz half-width")
    upper.set_ylabel(label("pressure", unit), color=BLUE)
    upper.set_ylim(0)
    name_case(figure, case_words(run.dataset))
    if has_unresolved_spike(run.summary, _key_and_value(run)):
        mark_spike(upper, x, data["pressure"].values * factor)
    if "film_reduction" in data.variables and (data["pressure"].values == 0).any():
        meniscus = x[np.flatnonzero(data["pressure"].values > 0)[0]]
        if meniscus > x[0]:
            upper.axvline(meniscus, color=BLACK, linestyle=":", label="meniscus")
            upper.legend(loc="center left")
    lower = upper.twinx()
    inside = np.abs(x) < 1.2
    factor, unit = prefix(data["thickness"].values[inside], "m")
    lower.plot(x, data["thickness"].values * factor, color=VERMILION, label="film")
    lower.set_ylim(0, 2.5 * factor * float(data["thickness"].values[inside].max()))
    lower.set_ylabel(label("film thickness", unit), color=VERMILION)


def _key_and_value(run: Any) -> str:
    """The first case as notes name it, such as "rolling.slide_roll_ratio 0.01"; empty for a single case."""
    axes = [axis for axis in axes_of(run.dataset) if run.dataset.sizes[axis] > 1]
    return f"{axes[0]} {run.dataset[axes[0]].values[0]:g}:" if len(axes) == 1 else ""


def _starvation(run: Any, figure: Figure) -> None:
    from bem.reference_solutions.starved_inlet import starved_film  # its nodes are computed when it is loaded

    data = run.dataset
    upper, lower = figure.subplots(2, 1)
    upper.plot(*starved_film(np.geomspace(1e-3, 1e3, 400)), color=BLACK, label="Wolveridge, Baglin and Archard (1971)")
    inlet, reduction = data["inlet"].values.ravel(), data["film_reduction"].values.ravel()
    upper.plot(inlet, reduction, "o", color=BLUE, label="this run")
    upper.set_xscale("log")
    upper.set_xlim(*_around(inlet))
    upper.set_ylim(0, 1.05)
    upper.set_xlabel("filled inlet over its natural length")
    upper.set_ylabel("film thickness over the flooded one")
    upper.legend()
    layer = data["oil_layer"].values.ravel() * 1e9
    for name, colour in (("central", BLUE), ("minimum", VERMILION)):
        lower.plot(layer, data[f"{name}_thickness"].values.ravel() * 1e9, "o", color=colour, label=f"{name} film")
    lower.plot([0, layer.max()], [0, layer.max()], color=BLACK, linestyle=":", label="the layer, not compressed")
    lower.set_xlim(0)
    lower.set_ylim(0)
    lower.set_xlabel("oil that goes through, as a layer (nm)")
    lower.set_ylabel("film thickness (nm)")
    lower.legend()


def _along(run: Any, figure: Figure) -> None:
    data = run.dataset
    hot, place = "film_temperature" in data.variables, data["position"].values * 1e3
    loads = _rows_along(run)
    film, friction, power, *others = figure.subplots(3 + hot + (2 if loads else 1), 1, sharex=True)
    dots: dict[str, Any] = {"markersize": 3, "color": BLACK}
    for name, colour in (("central", BLUE), ("minimum", VERMILION)):
        film.plot(place, _row(data, f"{name}_thickness") * 1e9, "o-", markersize=3, color=colour, label=name)
    film.set_ylabel("film\nthickness (nm)")
    film.legend()
    friction.plot(place, np.abs(_row(data, "traction_coefficient")), "o-", **dots)
    friction.set_ylabel("friction\ncoefficient,\nmagnitude")
    power.plot(place, _row(data, "friction_power"), "o-", **dots)
    power.set_ylabel("friction\npower (W)")
    pressed = others[-1]
    factor, unit = prefix(_row(data, "hertz_pressure"), "Pa")
    pressed.plot(place, _row(data, "hertz_pressure") * factor, "o-", markersize=3, color=BLUE)
    pressed.set_ylabel(label("Hertz\npressure", unit), color=BLUE)
    for axes in (film, friction, power, pressed):
        axes.set_ylim(0)
    if loads:
        factor, unit = prefix(loads["load"], "N")
        beside = pressed.twinx()
        beside.plot(place, loads["load"] * factor, "s--", markersize=3, color=VERMILION)
        beside.set_ylabel(label("load", unit), color=VERMILION)
        beside.set_ylim(0)
        sliding = others[-2]
        sliding.plot(place, loads["sliding_speed"], "o-", **dots)
        sliding.axhline(0, color="0.6", linewidth=0.6)
        sliding.set_ylabel("sliding\nspeed (m/s)")
        for zero in _zeros(place, loads["sliding_speed"]):  # of a gear pair the pitch point C
            for axes in (film, friction, power, *others):
                axes.axvline(zero, color="0.6", linestyle=":", linewidth=0.8)
            sliding.annotate("pure rolling", (zero, 0), (6, -12), textcoords="offset points", fontsize=8, color="0.35")
    _mark_places(run, film, (friction, power, *others))
    if "lambda_ratio" in data.variables:
        _lambda_beside(film, _row(data, "lambda_ratio") / _row(data, "minimum_thickness"))
    if hot:
        for name, colour in (("film", BLACK), ("lower", BLUE), ("upper", VERMILION)):
            words = "oil, mean in the contact" if name == "film" else f"{_surface(run, name)}, highest"
            others[0].plot(
                place, _row(data, f"{name}_temperature") - ZERO_CELSIUS, "o-", markersize=3, color=colour, label=words
            )
        others[0].set_ylabel("temperature\n(°C)")
        others[0].legend()
    pressed.set_xlabel("position along the path (mm)")
    others_of = (_first_of(data, axis) for axis in axes_of(data) if axis != "position")
    name_case(figure, ", ".join(filter(None, others_of)))


_CLOSE = 0.035
"""Fraction of the way below which letters of two places would overlap: they share one label."""


def _mark_places(run: Any, top: Axes, below: Sequence[Axes]) -> None:
    """Draw a line through all panels at each marked place of the way, and its letter above the top panel."""
    marks = (run.scene.get("along") or {}).get("marks") or {}
    places = sorted((1e3 * float(place), name) for name, place in marks.items() if place is not None)
    if not places:
        return
    extent = float(np.ptp(run.dataset["position"].values)) * 1e3
    groups: list[list[tuple[float, str]]] = []
    for one in places:
        if groups and one[0] - groups[-1][-1][0] < _CLOSE * extent:
            groups[-1].append(one)
        else:
            groups.append([one])
    for place, _ in places:
        for axes in (top, *below):
            axes.axvline(place, color="0.6", linestyle=":", linewidth=0.8)
    for group in groups:
        middle = 0.5 * (group[0][0] + group[-1][0])
        letters = " ".join(name for _, name in group)
        top.annotate(
            letters,
            xy=(middle, 1),
            xycoords=("data", "axes fraction"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontsize=8.5,
        )


def _first_of(data: Any, axis: str) -> str:
    return label_of(data, (axis,), (0,)) if axis in data.variables else ""


def _rows_along(run: Any) -> dict[str, Any]:
    """Load [N] and sliding speed, lower less upper surface [m/s], of the rows of the scene; empty where unknown."""
    rows = run.scene.get("along") or {}
    names = ("load", "lower_speed", "upper_speed")
    load, lower, upper = (np.asarray(rows.get(name, ()), dtype=np.float64) for name in names)
    if any(values.shape != (run.dataset.sizes["position"],) for values in (load, lower, upper)):
        return {}
    return {"load": load, "sliding_speed": lower - upper}


def _zeros(place: Any, values: Any) -> list[float]:
    """Return the places where values (n,) change their sign, interpolated linearly between two rows."""
    at = np.flatnonzero(values[:-1] * values[1:] < 0)
    between = [place[i] - values[i] * (place[i + 1] - place[i]) / (values[i + 1] - values[i]) for i in at]
    return [float(zero) for zero in (*between, *place[values == 0])]


def _row(data: Any, name: str) -> Any:
    """A figure over the places, of the first of everything else."""
    item = data[name]
    place = tuple(slice(None) if axis == "position" else 0 for axis in item.dims)
    return item.values[place]


def _lambda_beside(axes: Any, by_film: Any) -> None:
    """The ratio of the minimum film, on an axis on which its curve is that film's: a curve of its own on a scale of its
    own lay upon the central film's."""
    known = by_film[np.isfinite(by_film)]
    if known.size:
        beside = axes.twinx()
        beside.set_ylim(0, axes.get_ylim()[1] * 1e-9 * float(known[0]))
        beside.set_ylabel("lambda ratio", color=VERMILION)


def _has_way(run: Any) -> bool:
    return "position" in axes_of(run.dataset) and run.dataset.sizes["position"] > 1


def _around(values: Any) -> tuple[float, float]:
    """Limits of a logarithmic axis that holds all finite values."""
    finite = values[np.isfinite(values)]
    return 0.5 * float(finite.min()), max(4.0 * float(finite.max()), 10.0)


def _starves(run: Any) -> bool:
    return bool(np.isfinite(run.dataset["inlet"].values).sum() > 1)


FIGURES = (
    FigureKind(
        "traction-curve",
        "Friction over load and the oil's mean temperature by pressure, over the slide-to-roll ratio.",
        ("traction_coefficient",),
        _curve,
        size=(5.0, 5.0),
        applies=lambda run: _ratio_of(run) is not None,
        all_cases=True,
    ),
    FigureKind(
        "film-temperatures",
        "Mean temperature of the oil along the film, and of both surfaces. Shear and backflow warm the oil before the "
        'contact. With thermal = "full" oil that expands behind a pressure spike cools, by up to the adiabatic '
        "drop, expansion x T x pressure drop / heat capacity by volume, and may be colder than the supply there; the "
        "depth of this dip depends on the mesh.",
        ("oil_temperature", "lower_surface_temperature", "upper_surface_temperature"),
        _temperatures,
        applies=lambda run: bool(_known(run, "oil_temperature")),
        all_cases=True,
    ),
    FigureKind(
        "temperature-field",
        "Temperature of the oil along and across the film of the last case where it was found, below it that of both "
        "surfaces and of the hottest layer.",
        ("field", "height"),
        _field,
        size=(6.0, 6.0),
        applies=lambda run: bool(_known(run, "field")),
        all_cases=True,
    ),
    FigureKind(
        "starvation-curve",
        "The film over that of a flooded inlet, over how much of the inlet is filled (over the length at which the gap "
        "is as wide as the flooded film is thick); and the film over the oil that goes through.",
        ("inlet", "film_reduction", "oil_layer"),
        _starvation,
        size=(5.0, 6.0),
        applies=_starves,
        all_cases=True,
    ),
    FigureKind(
        "along-the-way",
        "Film, friction, its power, temperatures, sliding speed (lower less upper surface; pinion less wheel), "
        "Hertz pressure and load (dashed, right) over the rows of a way, such as a line of action. Of a gear pair A is "
        "the start of contact, C the pitch point, E the end; between B and D one pair of teeth carries the load.",
        ("traction_coefficient", "friction_power"),
        _along,
        size=(5.5, 10.5),
        applies=_has_way,
        all_cases=True,
    ),
    FigureKind(
        "rolling-film",
        "Pressure and film thickness of the first case; a spike that the mesh does not resolve is dotted, and the axis "
        "ends at 1.25 times the highest pressure beside it.",
        ("pressure", "thickness"),
        _film,
        all_cases=True,
    ),
)
