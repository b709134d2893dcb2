"""Figures of measured particles: the levelled map, the distributions of size."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.labels import colour_ends
from bem.plots.style import BLUE, ORANGE, VERMILION, label, map_of, prefix


def _map(run: Any, figure: Figure) -> None:
    data = run.dataset
    axes = figure.add_subplot()
    x, y, level = data["x"].values, data["y"].values, data["level_height"].values
    low, high = colour_ends(level, 1, 99.8)
    map_of(figure, axes, x, y, level, "height above the plate", "m", ends=(low, high), cmap="cividis")
    scale, _ = prefix([x[-1] - x[0], y[-1] - y[0]], "m")
    axes.plot(
        data["particle_x"].values * scale,
        data["particle_y"].values * scale,
        "o",
        markersize=9,
        markerfacecolor="none",
        markeredgecolor=VERMILION,
        markeredgewidth=0.7,
        linestyle="none",
    )
    axes.set_title(f"{data['particle_x'].size} particles")


def _sizes(run: Any, figure: Figure) -> None:
    data = run.dataset
    radius, volume = data["particle_equivalent_radius"].values, data["particle_volume"].values
    area = data["particle_length"].values * data["particle_width"].values
    factor, unit = prefix(radius, "m")
    edges = np.linspace(0, radius.max() * factor * 1.02, 22)
    axes = figure.add_subplot()
    for weight, name, colour in (
        (np.ones_like(radius), "number", BLUE),
        (area, "area", ORANGE),
        (volume, "volume", VERMILION),
    ):
        share, _ = np.histogram(radius * factor, edges, weights=weight)
        mean = (weight * radius).sum() / weight.sum() * factor
        text = f"by {name}, mean {mean:.0f} {unit}"
        axes.stairs(100 * share / share.sum(), edges, color=colour, label=text, linewidth=1.3)
    axes.set_xlabel(label("equivalent radius", unit))
    axes.set_ylabel("share (%)")
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend()


def _found(run: Any) -> bool:
    return bool(run.dataset["particle_equivalent_radius"].size)


FIGURES = (
    FigureKind(
        "particle-map",
        "Height above the plate; circles mark the particles that were counted.",
        ("x", "y", "level_height", "particle_x", "particle_y"),
        _map,
        (5.6, 4.6),
    ),
    FigureKind(
        "particle-sizes",
        "Distribution of equivalent radii by number, by area seen, and by volume.",
        ("particle_equivalent_radius", "particle_volume"),
        _sizes,
        (5.0, 3.4),
        _found,
    ),
)
