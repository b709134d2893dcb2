"""Figure of wear in partial slip: what the surfaces slide in a loop, and what wore."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, VERMILION, label, map_of, prefix

_FEWEST = 16
"""Cells along the shorter side from which maps are drawn, not sections."""


def _slip_and_wear(run: Any, figure: Figure) -> None:
    data = run.dataset
    x, y = data["x"].values, data["y"].values
    worn = data["height_before"].values - data["height_after"].values
    slid = np.where(data["pressure"].values > 0, data["slid"].values, np.nan)
    left, right = figure.subplots(1, 2)
    if min(len(x), len(y)) >= _FEWEST:
        map_of(figure, left, x, y, slid, "slid in a loop", "m", cmap="viridis")
        map_of(figure, right, x, y, worn, "depth worn", "m", cmap="magma")
        return
    row = int(np.argmax(data["pressure"].values.sum(axis=0)))
    factor, unit = prefix([float(np.ptp(x))], "m")
    curves = ((left, slid[:, row], "m", "slid in a loop", BLUE), (left.twinx(), worn[:, row], "m", "depth worn", BLACK))
    for axes, values, of, words, colour in curves:
        scale, shown = prefix([float(np.nanmax(np.abs(values), initial=0.0))], of)
        axes.plot(x * factor, values * scale, color=colour, linewidth=1.0)
        axes.set_ylabel(label(words, shown), color=colour)
    traction, pressure = data["traction_x"].values[:, row], data["pressure"].values[:, row]
    scale, shown = prefix([float(np.abs(traction).max())], "Pa")
    least = float((np.abs(traction[pressure > 0]) / pressure[pressure > 0]).max(initial=0.0))
    right.plot(x * factor, least * pressure * scale, color="0.6", linewidth=0.9, label="friction x pressure")
    right.plot(x * factor, traction * scale, color=VERMILION, linewidth=1.0, label="traction at a loop's end")
    right.set_ylabel(label("traction on the lower body", shown))
    right.legend()
    for axes in (left, right):
        axes.set_xlabel(label("x", unit))


FIGURES = (
    FigureKind(
        "slip-and-wear",
        "What the surfaces slide against each other in a loop of the last cycle, and the depth worn; of several runs "
        "the last.",
        ("x", "y", "slid", "pressure", "traction_x", "height_before", "height_after"),
        _slip_and_wear,
        (7.8, 3.4),
        all_cases=True,
    ),
)
