"""Figures of a point film in time: as light shows it, sections through the middle, film and surfaces over time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.interferograms import finely_coloured
from bem.plots.style import BLACK, BLUE, SEQUENTIAL, VERMILION, colour_bar, field_axes, label, prefix, said_beyond

_SECTIONS = 6
_MOST = 3.0
"""Median films of the loaded middle that a section shows."""
_BRIGHT = 0.6
"""Fraction of the largest film at which the colours of the film over time end."""
_DOTS = 90
"""Per inch of an animation."""
_WIDE = 4.6
"""Inches of it, of which a map of its films takes three quarters."""


def _array(run: Any, name: str) -> Any:
    return run.dataset[name].values


def _disturbed(run: Any) -> int:
    """The frame whose film in the middle is furthest from the first one."""
    frames = _array(run, "frame_thickness")
    inside = _array(run, "frame_pressure")[0] > 0.7 * _array(run, "frame_pressure")[0].max()
    if not inside.any():
        return len(frames) - 1
    return int(np.abs(frames[:, inside] - frames[0][inside]).max(axis=1).argmax())


def _interferogram(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    extent = field_axes(axes, _array(run, "film_x"), _array(run, "film_y"), along="x")
    shown = _disturbed(run)
    colours = finely_coloured(_array(run, "frame_thickness")[shown])
    axes.imshow(colours.transpose(1, 0, 2), extent=extent, origin="lower", aspect=axes.get_aspect())
    factor, unit = prefix(_array(run, "frame"), "s")
    axes.set_title(f"{_array(run, 'frame')[shown] * factor:.3g} {unit}")


def _animate(run: Any, path: Path) -> None:
    """The film as light shows it over time, above its section through the middle."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from bem.plots.animation import write_animation

    x, y, times, frames = (_array(run, name) for name in ("film_x", "film_y", "frame", "frame_thickness"))
    figure = Figure(figsize=(_WIDE, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    above, below = figure.subplots(2, 1, height_ratios=(3, 2))
    extent = field_axes(above, x, y, along="x")
    dots = round(_DOTS * _WIDE)  # more than it has there

    def shown(index: int) -> Any:
        return finely_coloured(frames[index], dots).transpose(1, 0, 2)

    image = above.imshow(shown(0), extent=extent, origin="lower", aspect=above.get_aspect())
    middle = np.abs(y).argmin()
    film, film_unit = prefix([_highest(run)], "m")
    along, unit = prefix(x, "m")
    (line,) = below.plot(x * along, frames[0][:, middle] * film, color=BLUE)
    below.set_ylim(0, _highest(run) * film)
    below.set_xlim(x[0] * along, x[-1] * along)
    below.set_xlabel(label("x, through the middle", unit))
    below.set_ylabel(label("film thickness", film_unit))
    factor, time_unit = prefix(times, "s")

    def show(index: int) -> None:
        image.set_data(shown(index))
        line.set_ydata(frames[index][:, middle] * film)
        above.set_title(f"{times[index] * factor:.3g} {time_unit}")

    said_beyond(figure, run.summary)
    write_animation(figure, (image, line, above.title), show, len(frames), path, dots=_DOTS, per_second=5)


def _highest(run: Any) -> float:
    """Film up to which sections are shown [m]."""
    thickness, pressure = _array(run, "thickness"), _array(run, "film_pressure")
    loaded = pressure > 0.3 * pressure.max()
    return _MOST * float(np.median(thickness[loaded])) if loaded.any() else float(thickness.max())


def _sections(run: Any, figure: Figure) -> None:
    """Film, surfaces and pressure along x through the middle at some times, one below the other."""
    x, times = _array(run, "film_x"), _array(run, "time")
    thickness, pressure, heights = (_array(run, name) for name in ("thickness", "film_pressure", "surface_heights"))
    wanted = np.unique(np.linspace(0, len(times) - 1, _SECTIONS).round().astype(int))
    film, film_unit = prefix([_highest(run)], "m")
    force, force_unit = prefix(pressure, "Pa")
    along, unit = prefix(x, "m")
    factor, time_unit = prefix(times, "s")
    panels = figure.subplots(len(wanted), 1, sharex=True, squeeze=False)[:, 0]
    for axes, index in zip(panels, wanted, strict=True):
        axes.plot(x * along, thickness[index] * film, color=BLUE, label="film")
        if heights.any():
            axes.plot(x * along, -heights[index] * film, color=BLACK, linewidth=0.8, label="depth of the surfaces")
        axes.set_ylim(min(0.0, 1.1 * float(-heights.max()) * film), _highest(run) * film)
        other = axes.twinx()
        other.plot(x * along, pressure[index] * force, color=VERMILION, linestyle="--", linewidth=0.9)
        other.set_ylim(0, 1.05 * float(pressure.max()) * force)
        other.set_ylabel(label("p", force_unit), color=VERMILION)
        axes.set_ylabel(label("h", film_unit))
        axes.set_title(f"{times[index] * factor:.3g} {time_unit}", loc="left")
    panels[0].plot([], [], color=VERMILION, linestyle="--", linewidth=0.9, label="pressure, right")
    panels[0].legend(loc="upper center", ncols=3)
    panels[-1].set_xlabel(label("x, through the middle", unit))


def _over_time(run: Any, figure: Figure) -> None:
    """Film along x through the middle (colour) over time."""
    x, times, thickness = (_array(run, name) for name in ("film_x", "time", "thickness"))
    axes = figure.add_subplot()
    film, film_unit = prefix([_highest(run)], "m")
    (along, unit), (factor, time_unit) = prefix(x, "m"), prefix(times, "s")
    picture = axes.pcolormesh(
        x * along, times * factor, thickness * film, vmin=0, vmax=_BRIGHT * _highest(run) * film, cmap=SEQUENTIAL,
        shading="nearest", rasterized=True,
    )  # fmt: skip
    axes.set_xlabel(label("x, through the middle", unit))
    axes.set_ylabel(label("time", time_unit))
    colour_bar(figure, axes, picture, thickness, film, label("film thickness", film_unit))


_NEEDS = ("film_x", "film_y", "frame", "frame_thickness", "frame_pressure", "thickness", "film_pressure")

FIGURES = (
    FigureKind(
        "passing-interferogram",
        "The film as two beams of light show it (as the interferogram of a steady film), when it is furthest from the "
        "first one; beside it, animated, over time with its section.",
        _NEEDS,
        _interferogram,
        animate=_animate,
    ),
    FigureKind(
        "passing-sections",
        "Film (line), pressure (dashed, right) and depth of the surfaces that pass, along x through the middle.",
        (*_NEEDS, "surface_heights", "time"),
        _sections,
        (6.0, 9.0),
    ),
    FigureKind(
        "passing-over-time",
        "Film along x through the middle, over time: what a body carries goes with its speed, what the inlet makes of "
        "it with the mean speed of both.",
        (*_NEEDS, "time"),
        _over_time,
    ),
)
