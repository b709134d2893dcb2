"""Figures of a point film: as light shows it, maps, sections, the pressure as a surface."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from bem.plots.figures import FigureKind
from bem.plots.interferograms import finely_coloured
from bem.plots.style import BLUE, OPEN, VERMILION, field_axes, label, map_of, prefix

_TICKS = 6
"""Most ticks of the longer horizontal axis of a surface."""
_THICK = 3.0
"""Central films at which a map's colours end."""


def _array(run: Any, name: str) -> Any:
    return run.dataset[name].values


def _interferogram(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    extent = field_axes(axes, _array(run, "x"), _array(run, "y"))
    colours = finely_coloured(_array(run, "thickness"))
    axes.imshow(colours.transpose(1, 0, 2), extent=extent, origin="lower", aspect=axes.get_aspect())


def _typical(run: Any, thickness: NDArray[np.float64]) -> float:
    """Film [m] of the middle; between rough bodies the median where the pressure is above half its highest."""
    if "contact_pressure" not in run.dataset:
        x, y = (_array(run, name) for name in ("x", "y"))
        return float(thickness[np.abs(x).argmin(), np.abs(y).argmin()])
    pressure = _array(run, "pressure")
    return float(np.median(thickness[pressure > 0.5 * pressure.max()]))


def _touching(run: Any, figure: Figure) -> None:
    """Film with spots in contact on it, the oil's pressure, and that of the surfaces."""
    x, y, thickness, oil, surfaces = (
        _array(run, name) for name in ("x", "y", "thickness", "oil_pressure", "contact_pressure")
    )
    left, middle, right, empty = figure.subplots(2, 2).ravel()
    empty.remove()
    most = _THICK * _typical(run, thickness)
    film = np.where(thickness < most, thickness, np.nan)
    drawn = map_of(figure, left, x, y, film, "film thickness", "m", ends=(0.0, most))
    spots = surfaces > 0
    if spots.any():
        red = ListedColormap([VERMILION])
        left.imshow(np.where(spots, 1.0, np.nan).T, extent=drawn.get_extent(), origin="lower", cmap=red)
    map_of(figure, middle, x, y, np.where(oil > 0, oil, np.nan), "pressure of the oil", "Pa", vmin=0)
    if spots.any():
        map_of(figure, right, x, y, np.where(spots, surfaces, np.nan), "pressure of the surfaces", "Pa", vmin=0)
    else:
        field_axes(right, x, y)
        right.set_facecolor(OPEN)
        right.set_xlim(*drawn.get_extent()[:2])
        right.set_ylim(*drawn.get_extent()[2:])
        right.set_title("nothing touches")


def _maps(run: Any, figure: Figure) -> None:
    x, y, thickness, pressure = (_array(run, name) for name in ("x", "y", "thickness", "pressure"))
    left, right = figure.subplots(1, 2)
    most = _THICK * _typical(run, thickness)
    shown = np.where(thickness < most, thickness, np.nan)
    map_of(figure, left, x, y, shown, "film thickness", "m", ends=(0.0, most))
    map_of(figure, right, x, y, np.where(pressure > 0, pressure, np.nan), "film pressure", "Pa", vmin=0)


def _sections(run: Any, figure: Figure) -> None:
    """Along x and along y through the middle: the film above, the pressure below."""
    x, y, thickness, pressure = (_array(run, name) for name in ("x", "y", "thickness", "pressure"))
    i, j = np.abs(x).argmin(), np.abs(y).argmin()
    most = 4 * _typical(run, thickness)
    film, film_unit = prefix([most], "m")
    force, force_unit = prefix(pressure, "Pa")
    panels = figure.subplots(2, 2, sharex="col", sharey="row", height_ratios=(3, 2))
    for column, (at, along, film_row, pressure_row) in enumerate(
        (("x", x, thickness[:, j], pressure[:, j]), ("y", y, thickness[i], pressure[i]))
    ):
        factor, unit = prefix(along, "m")
        panels[0, column].plot(along * factor, film_row * film, color=BLUE)
        panels[0, column].set_ylim(0, most * film)
        panels[1, column].plot(along * factor, pressure_row * force, color=VERMILION)
        panels[1, column].set_ylim(0, 1.05 * max(pressure[:, j].max(), pressure[i].max()) * force)
        panels[1, column].set_xlim(along[0] * factor, along[-1] * factor)
        panels[1, column].set_xlabel(label(f"{at}, through the middle", unit))
    panels[0, 0].set_ylabel(label("film thickness", film_unit))
    panels[1, 0].set_ylabel(label("pressure", force_unit))


def _surface(run: Any, figure: Figure) -> None:
    x, y, pressure = (_array(run, name) for name in ("x", "y", "pressure"))
    every = max(1, max(pressure.shape) // 96)
    (across, unit), (force, force_unit) = prefix([x[-1] - x[0]], "m"), prefix(pressure, "Pa")
    axes: Any = figure.add_subplot(projection="3d")
    first, second = np.meshgrid(x[::every] * across, y[::every] * across, indexing="ij")
    axes.plot_surface(
        first, second, pressure[::every, ::every] * force, cmap="viridis", linewidth=0, rcount=200, ccount=200
    )
    axes.set_box_aspect((x[-1] - x[0], y[-1] - y[0], 0.6 * (x[-1] - x[0])))
    axes.set_xlabel(label("x", unit))
    axes.set_ylabel(label("y", unit))
    axes.set_zlabel(label("pressure", force_unit))
    for axis, length in ((axes.xaxis, x[-1] - x[0]), (axes.yaxis, y[-1] - y[0])):
        ticks = max(2, round(_TICKS * length / max(x[-1] - x[0], y[-1] - y[0])))  # short axes have room for few
        axis.set_major_locator(MaxNLocator(ticks))
    axes.view_init(elev=32, azim=-120)


_NEEDS = ("x", "y", "thickness", "pressure", "thickness_along")

FIGURES = (
    FigureKind(
        "interferogram",
        "The film as two beams of light show it: computed colours of red, green and blue light of 630, 532 and 465 nm "
        "in oil of refractive index 1.5, without the phase that a coating adds.",
        _NEEDS,
        _interferogram,
    ),
    FigureKind(
        "point-film-maps",
        "Film thickness up to three times that of the middle, and film pressure; blank where there is none.",
        _NEEDS,
        _maps,
        (7.6, 3.4),
    ),
    FigureKind(
        "touching-film-maps",
        "A rough body's film up to three times that of its middle, with what touches in red; pressure of the oil, "
        "and of the surfaces where they touch.",
        (*_NEEDS, "oil_pressure", "contact_pressure"),
        _touching,
        (7.6, 6.2),
    ),
    FigureKind(
        "point-film-sections",
        "Film and pressure through the middle, along x and along y.",
        _NEEDS,
        _sections,
        (7.0, 4.2),
    ),
    FigureKind("point-pressure", "Film pressure over the plane.", _NEEDS, _surface, (6.0, 4.6)),
)
