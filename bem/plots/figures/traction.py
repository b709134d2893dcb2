"""Figures of rolling and sliding line contacts: traction over the slide-to-roll ratio, film and heat along it."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.cases import axes_of, first_case, grouped, label_of
from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, label, prefix

ALL_CASES = True
_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PINK, SKY, BLACK)
_RATIO = "slide_roll_ratio"
_CELSIUS = 273.15


def _ratio_of(run: Any) -> str | None:
    """The axis of slide-to-roll ratios, if the cases lie along one."""
    found = [axis for axis in axes_of(run.dataset) if axis.endswith(_RATIO) and run.dataset.sizes[axis] > 1]
    return found[0] if found else None


def _curve(run: Any, figure: Figure) -> None:
    data, ratio = run.dataset, _ratio_of(run)
    hot = "film_temperature" in data.variables
    panels = figure.subplots(2 if hot else 1, 1, sharex=True, squeeze=False)[:, 0]
    _lines(panels[0], data, "traction_coefficient", ratio, 0.0)
    panels[0].set_ylabel("traction coefficient")
    if (data["traction_coefficient"].values >= 0).all():
        panels[0].set_ylim(0)
    if hot:
        _lines(panels[1], data, "film_temperature", ratio, _CELSIUS)
        panels[1].set_ylabel("oil in the contact (°C)")
    panels[-1].set_xlabel("slide-to-roll ratio")
    if panels[0].get_legend_handles_labels()[1]:
        panels[0].legend()


def _lines(axes: Any, data: Any, name: str, ratio: str | None, zero: float) -> None:
    """A line over the ratio for every place along the other axes."""
    dims = list(data[name].dims)
    others = [axis for axis in dims if axis != ratio]
    order = np.argsort(data[ratio].values)
    values = np.moveaxis(data[name].values, dims.index(ratio), -1)[..., order] - zero
    bars = data[f"{name}_error"].values if f"{name}_error" in data.variables else None
    spread = None if bars is None else np.moveaxis(bars, dims.index(ratio), -1)[..., order]
    places = product(*(range(data.sizes[axis]) for axis in others))
    for colour, place in zip(_COLOURS * 9, places, strict=False):
        words = label_of(data, others, place)
        axes.errorbar(
            data[ratio].values[order],
            values[place],
            yerr=None if spread is None else spread[place],
            fmt="o-",
            markersize=3,
            capsize=2,
            color=colour,
            label=words or None,
        )


def _temperatures(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    cases = grouped(run, "oil_temperature")
    shown = cases if len(cases) <= 4 else [cases[i] for i in np.linspace(0, len(cases) - 1, 4).round().astype(int)]
    x = run.dataset["x"].values
    x = x if x.ndim == 1 else first_case(run.dataset)["x"].values
    surfaces = {name: dict(grouped(run, f"{name}_surface_temperature")) for name in ("lower", "upper")}
    for colour, (case, oil) in zip(_COLOURS, shown, strict=False):
        axes.plot(x, oil[0] - _CELSIUS, color=colour, label=f"oil, {case}" if case else "oil")
        for name, dash in (("lower", "--"), ("upper", ":")):
            axes.plot(x, surfaces[name][case][0] - _CELSIUS, color=colour, linestyle=dash)
    axes.plot([], [], "--", color=BLACK, label="lower surface")
    axes.plot([], [], ":", color=BLACK, label="upper surface")
    axes.set_xlabel("x over the Hertz half-width")
    axes.set_ylabel("temperature (°C)")
    axes.legend()


def _film(run: Any, figure: Figure) -> None:
    data = first_case(run.dataset)
    x, upper = data["x"].values, figure.add_subplot()
    factor, unit = prefix(data["pressure"].values, "Pa")
    upper.plot(x, data["pressure"].values * factor, color=BLUE, label="pressure")
    upper.set_xlabel("x over the Hertz half-width")
    upper.set_ylabel(label("pressure", unit), color=BLUE)
    upper.set_ylim(0)
    lower = upper.twinx()
    inside = np.abs(x) < 1.2
    factor, unit = prefix(data["thickness"].values[inside], "m")
    lower.plot(x, data["thickness"].values * factor, color=VERMILION, label="film")
    lower.set_ylim(0, 2.5 * factor * float(data["thickness"].values[inside].max()))
    lower.set_ylabel(label("film thickness", unit), color=VERMILION)


FIGURES = (
    FigureKind(
        "traction-curve",
        "Friction over load and the oil's mean temperature by pressure, over the slide-to-roll ratio.",
        ("traction_coefficient",),
        _curve,
        size=(5.0, 5.0),
        applies=lambda run: _ratio_of(run) is not None,
    ),
    FigureKind(
        "film-temperatures",
        "Mean temperature of the oil along the film, and of both surfaces.",
        ("oil_temperature", "lower_surface_temperature", "upper_surface_temperature"),
        _temperatures,
    ),
    FigureKind("rolling-film", "Pressure and film thickness of the first case.", ("pressure", "thickness"), _film),
)
