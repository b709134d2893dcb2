"""Figures of partial slip and rolling: where it sticks, tractions under their bound."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind, wide_enough
from bem.plots.style import BLACK, BLUE, OPEN, ORANGE, VERMILION, field_axes, label, map_of, prefix, thinned


def _sticks(run: Any, figure: Figure) -> None:
    """Open, stick and slip at the end, beside the distance slid."""
    data = run.dataset
    left, right = figure.subplots(1, 2)
    x, y = data["x"].values, data["y"].values
    colours = ListedColormap([OPEN, BLUE, VERMILION])
    extent = field_axes(left, x, y)
    state = thinned(data["stick_state"].values).T
    left.imshow(state, origin="lower", extent=extent, aspect=left.get_aspect(), cmap=colours, vmin=0, vmax=2)
    left.set_title("blue sticks, red slips")
    slid = np.where(data["stick_state"].values > 0, data["slip"].values, np.nan)
    rolls = data["slip"].attrs.get("units", "m") == "1"
    words, of = ("sliding over rolling velocity", "") if rolls else ("distance slid", "m")
    map_of(figure, right, x, y, slid, words, of, cmap="viridis")


def _section(run: Any, figure: Figure) -> None:
    """Along x through the middle of the load."""
    data = run.dataset
    x, pressure = data["x"].values, data["pressure"].values
    row = int(np.argmax(pressure.sum(axis=0)))
    axes = figure.add_subplot()
    factor, unit = prefix([float(np.ptp(x))], "m")
    if "traction_bound" in data:
        bound, words = data["traction_bound"].values[:, row], "bound without slip"
    else:
        friction = float((run.scene.get("push") or run.scene["roll"])["friction"])
        bound, words = friction * pressure[:, row], "friction x pressure"
    scale, pressure_unit = prefix([float(bound.max())], "Pa")
    for sign in (1, -1):
        axes.plot(x * factor, sign * bound * scale, color="0.6", linewidth=0.9, label=words if sign > 0 else None)
    axes.plot(x * factor, data["traction_x"].values[:, row] * scale, color=BLACK, label="traction along x")
    axes.plot(x * factor, data["traction_y"].values[:, row] * scale, color=ORANGE, linewidth=0.9, label="along y")
    axes.set_xlabel(label("x", unit))
    axes.set_ylabel(label("traction on the lower body", pressure_unit))
    axes.legend()


FIGURES = (
    FigureKind(
        "slip-map",
        "Left: where the surfaces stick and where they slip, in the last step of a history; right: how far they slid "
        "in all its steps, or, while they roll, the sliding over the rolling velocity.",
        ("x", "y", "stick_state", "slip"),
        _sticks,
        (8.0, 3.6),
        applies=wide_enough,
    ),
    FigureKind(
        "traction-section",
        "Tractions along x through the row with most load, at the end, between the bounds of friction.",
        ("x", "y", "pressure", "traction_x", "traction_y"),
        _section,
    ),
)
