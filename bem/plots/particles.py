"""Particles on a plate: the map with what was found, and the distributions of size."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bem.grid import FloatArray, Grid
from bem.particles import Particle, particle_statistics
from bem.plots.style import BLUE, ORANGE, VERMILION, map_of, style
from bem.results.atomic import replacing


def draw_particles(level: FloatArray, spacing: tuple[float, float], particles: Sequence[Particle], path: Path) -> Path:
    """Write the figure; its format is the path's ending (.png, .pdf, .svg).

    level : heights above the plate (nx, ny) [m]; particles : as `particles_from_height_map` found them on it.

    Raises
    ------
    ResultsError : the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    grid = Grid((level.shape[0], level.shape[1]), spacing)
    with style():
        figure = Figure(figsize=(9.0, 4.2), layout="constrained")
        FigureCanvasAgg(figure)
        map_axes, axes = figure.subplots(1, 2)
        map_of(figure, map_axes, grid.x, grid.y, level, "height above the plate", "m", cmap="cividis")
        mask = np.zeros(level.shape)
        for particle in particles:
            mask[particle.columns[:, 0], particle.columns[:, 1]] = 1
        left, right, bottom, top = map_axes.images[0].get_extent()
        if particles:
            xs = left + (np.arange(level.shape[0]) + 0.5) * (right - left) / level.shape[0]
            ys = bottom + (np.arange(level.shape[1]) + 0.5) * (top - bottom) / level.shape[1]
            map_axes.contour(xs, ys, mask.T, levels=[0.5], colors=[VERMILION], linewidths=0.6)
        map_axes.set_title(f"{len(particles)} particles")
        for weight, colour in (("number", BLUE), ("area", ORANGE), ("volume", VERMILION)):
            statistics = particle_statistics(particles, weight=weight, edges=20)
            mean = 1e9 * statistics.mean_equivalent_radius
            text = f"by {weight}" + (f", mean {mean:.0f} nm" if particles else "")
            axes.stairs(
                statistics.counts / max(statistics.count, 1),
                statistics.edges * 1e9,
                color=colour,
                label=text,
                linewidth=1.3,
            )
        axes.set_xlabel("equivalent radius (nm)")
        axes.set_ylabel("share")
        axes.set_ylim(0)
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, columnspacing=1.0, handlelength=1.2)
        with replacing(path) as temporary:
            figure.savefig(temporary, format=path.suffix[1:].lower())
    return path
