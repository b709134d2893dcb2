"""Figures of surface temperature: a map, and a section along the motion with heat and pressure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bem.physical_constants import ZERO_CELSIUS
from bem.plots.figures import FigureKind, two_dimensional
from bem.plots.style import BLACK, ORANGE, VERMILION, label, map_of, prefix


def _map(run: Any, figure: Figure) -> None:
    data = run.dataset
    axes = figure.add_subplot()
    x, y = data["x"].values, data["y"].values
    celsius = data["surface_temperature"].values - ZERO_CELSIUS
    if map_of(figure, axes, x, y, celsius, "surface temperature", "°C", cmap="inferno") is None:
        return
    factor, _ = prefix([float(np.ptp(x))], "m")
    i, j = np.unravel_index(int(np.argmax(celsius)), celsius.shape)
    axes.plot(x[i] * factor, y[j] * factor, "+", color="white", markersize=8)
    axes.set_title(f"highest {highest_in_words(celsius)} °C", loc="right")


def highest_in_words(celsius: NDArray[np.float64]) -> str:
    """Return the highest temperature with the decimals that the scale of the map resolves: two digits of its range."""
    span = float(np.ptp(celsius))
    decimals = 0 if span == 0 else min(max(0, 1 - math.floor(math.log10(span))), 6)
    return f"{float(celsius.max()):.{decimals}f}"


def _section(run: Any, figure: Figure) -> None:
    """Along the motion through the hottest place."""
    data = run.dataset
    x, celsius = data["x"].values, data["surface_temperature"].values - ZERO_CELSIUS
    row = int(np.unravel_index(int(np.argmax(celsius)), celsius.shape)[1])
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    factor_x, unit_x = prefix([float(np.ptp(x))], "m")
    upper.plot(x * factor_x, celsius[:, row], color=VERMILION)
    upper.set_ylabel("temperature (°C)")
    made, into = data["heat_made"].values[:, row], data["heat_lower"].values[:, row]
    lower.fill_between(x * factor_x, made / 1e6, step="mid", color=ORANGE, alpha=0.6, linewidth=0, label="made")
    lower.plot(x * factor_x, into / 1e6, color=BLACK, linewidth=0.9, label="into the lower body")
    lower.set_ylabel("heat (MW/m²)")
    lower.set_xlabel(label("x, along the motion", unit_x))
    lower.set_xlim(x[0] * factor_x, x[-1] * factor_x)
    lower.legend()


FIGURES = (
    FigureKind(
        "temperature-map",
        "Temperature of the surface: the common one where the bodies touch, that of the lower body elsewhere; its wake "
        "lies where the body leaves the contact. The cross marks the highest.",
        ("x", "y", "surface_temperature"),
        _map,
        applies=two_dimensional,
    ),
    FigureKind(
        "temperature-section",
        "Along the motion through the hottest place: temperature, heat made by friction, and what of it enters the "
        "lower body.",
        ("x", "y", "surface_temperature", "heat_made", "heat_lower"),
        _section,
        (6.0, 4.2),
    ),
)
