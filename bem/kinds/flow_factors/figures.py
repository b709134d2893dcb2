"""Figures of flow factors: over separation, beside Patir and Cheng's curves; the heights they are of."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bem.plots.cases import grouped
from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, map_of_heights
from bem.reference_solutions.rough_flow import PATIR_CHENG, patir_cheng_pressure, patir_cheng_shear

_COLOURS = (BLUE, VERMILION, GREEN, PINK, ORANGE, SKY, BLACK)
_ELONGATION = "lower.surface.elongation"


def _factors(run: Any, figure: Figure) -> None:
    ratio = grouped(run, "separation_over_Sq")
    left, right = figure.subplots(1, 2)
    for axes, name, text in ((left, "pressure_x", "pressure flow factor"), (right, "shear_x", "shear flow factor")):
        for colour, (case, values), (_, h) in zip(_COLOURS * 9, grouped(run, name), ratio, strict=False):
            axes.plot(h.mean(axis=0), values.mean(axis=0), "o-", markersize=3, color=colour, label=case or "along x")
            if len(values) > 1:
                axes.fill_between(h.mean(axis=0), values.min(axis=0), values.max(axis=0), color=colour, alpha=0.2)
        _published(axes, run, float(max(h.max() for _, h in ratio)), pressure=name == "pressure_x")
        axes.set_xlabel("separation over Sq")
        axes.set_ylabel(text)
        axes.set_xlim(0)
        axes.set_ylim(0)
    _across(left, run, ratio)
    left.legend()


def _across(axes: Axes, run: Any, ratio: Any) -> None:
    """Flow along y of a single case, beside that along x."""
    cases = grouped(run, "pressure_y")
    if len(cases) == 1:
        axes.plot(ratio[0][1].mean(axis=0), cases[0][1].mean(axis=0), "s--", markersize=3, color=SKY, label="along y")


def _published(axes: Axes, run: Any, highest: float, *, pressure: bool) -> None:
    """Patir and Cheng's curves for the elongations of the cases that they tabulated, from where they were fitted."""
    colours = dict(zip(_elongations(run), _COLOURS * 9, strict=False))
    shown = [(gamma, colour) for gamma, colour in colours.items() if _tabulated(gamma)]
    for gamma, colour in shown:
        row = _tabulated(gamma)
        h = np.linspace(PATIR_CHENG[row].pressure[2] if pressure else 0.25, highest, 200)
        values = patir_cheng_pressure(h, row) if pressure else patir_cheng_shear(h, row)
        axes.plot(h, values, ":", color=colour)
    if shown:
        axes.plot([], [], ":", color=BLACK, label="Patir and Cheng")


def _elongations(run: Any) -> list[float]:
    over = (run.scene.get("over") or {}).get(_ELONGATION)
    if over:
        return [float(value) for value in over]
    surface = (run.scene.get("lower") or {}).get("surface") or {}
    return [float(surface.get("elongation") or 1.0)]


def _tabulated(gamma: float) -> float:
    """Patir and Cheng's gamma next to an elongation; 0 where none is near."""
    return next((row for row in PATIR_CHENG if abs(gamma / row - 1) < 0.02), 0.0)


def _heights(run: Any, figure: Figure) -> None:
    data = run.dataset
    map_of_heights(figure, figure.add_subplot(), data["x"].values, data["y"].values, data["height"].values)


FIGURES = (
    FigureKind(
        "flow-factors",
        "Factors of pressure flow and of shear flow (all roughness on one wall), both along x, over the separation of "
        "the mean planes; dotted: Patir and Cheng's fits for surfaces whose overlap is cut off.",
        ("separation_over_Sq", "pressure_x", "pressure_y", "shear_x"),
        _factors,
        (8.0, 3.8),
        all_cases=True,
    ),
    FigureKind(
        "flow-heights",
        "Heights of both surfaces together; the first case.",
        ("x", "y", "height"),
        _heights,
        (5.0, 4.0),
        lambda run: run.summary["kind"] == "flow-factors",
        all_cases=True,
    ),
)
