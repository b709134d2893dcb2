"""Figures of wear runs: sizes, volume, pressure and roughness over cycles, distributions, the worn surface."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from bem.plots.cases import Array, grouped, redoes
from bem.plots.figures import FigureKind
from bem.plots.labels import colour_ends
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, label, map_of, prefix, start_at_zero

_LONG = 2.0
"""Length of a map over its width from which two of them are one above the other."""
_DLS_STEEL = (110e-9, 175e-9)  # dynamic light scattering, both materials; thesis, paper B


def _over_cycles(axes: Axes, run: Any, found: list[tuple[str, Array]], text: str, unit: str) -> float:
    """Mean over repetitions of each case as a line, their range as a band; returns the factor to the shown unit."""
    cycle = run.dataset["cycle"].values
    factor, shown = prefix(np.concatenate([values.ravel() for _, values in found]), unit)
    for colour, (name, values) in zip((BLUE, VERMILION, ORANGE, SKY, GREEN, PINK, BLACK) * 9, found, strict=False):
        own = values * factor
        with np.errstate(all="ignore"):
            import warnings

            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # cycles in which nothing came off in any repetition
                mean, low, high = np.nanmean(own, axis=0), np.nanmin(own, axis=0), np.nanmax(own, axis=0)
        axes.plot(cycle, mean, color=colour, label=name)
        if len(own) > 1:
            axes.fill_between(cycle, low, high, color=colour, alpha=0.2, linewidth=0)
    axes.set_xlabel("cycle")
    axes.set_ylabel(label(text, shown))
    axes.set_xlim(1, max(2, cycle[-1]))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    start_at_zero(axes)
    if len(found) > 1:
        axes.legend(ncols=min(len(found), 3))
    return factor


def _radius(run: Any, figure: Figure) -> None:
    _over_cycles(figure.add_subplot(), run, grouped(run, "radius"), "equivalent radius, volume mean", "m")


def _volume(run: Any, figure: Figure) -> None:
    found = [(name, values * 1e18) for name, values in grouped(run, "volume")]
    _over_cycles(figure.add_subplot(), run, found, "volume per cycle (µm³)", "1")


def _pressure(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    with np.errstate(divide="ignore", invalid="ignore"):
        found = [
            (name, load / area)
            for (name, load), (_, area) in zip(grouped(run, "contact_load"), grouped(run, "contact_area"), strict=True)
        ]
    factor = _over_cycles(axes, run, found, "mean contact pressure", "Pa")
    hardness = run.scene.get("cylinder", {}).get("hardness")
    if isinstance(hardness, int | float):
        axes.axhline(hardness * factor, color="0.3", linestyle="--", linewidth=1.0)
        axes.annotate("hardness", (1, hardness * factor), (3, -11), textcoords="offset points", fontsize=8, color="0.3")


def _roughness(run: Any, figure: Figure) -> None:
    _over_cycles(figure.add_subplot(), run, grouped(run, "rms_height"), "Sq in the rows in contact", "m")


def _distribution(run: Any, figure: Figure) -> None:
    """Radii of the settled cycles, by number and by volume."""
    volume, cycle = run.dataset["particle_volume"].values, run.dataset["particle_cycle"].values
    settled = run.scene.get("cycles", {}).get("settled", 50)
    late = cycle > cycle.max() - settled
    volume = volume[late]
    radius = np.cbrt(3 * volume / (4 * np.pi))
    factor, unit = prefix(np.percentile(radius, 99) if radius.size else [0.0], "m")
    edges = np.linspace(0, float(np.percentile(radius, 99.8)) * factor if radius.size else 1.0, 50)
    axes = figure.add_subplot()
    for weight, colour, name in ((np.ones_like(radius), BLUE, "by number"), (volume, VERMILION, "by volume")):
        share, _ = np.histogram(radius * factor, edges, weights=weight)
        total = share.sum()
        mean = float((weight * radius).sum() / weight.sum()) * factor if weight.sum() > 0 else 0.0
        axes.stairs(
            100 * share / (total or 1), edges, color=colour, linewidth=1.4, label=f"{name}, mean {mean:.3g} {unit}"
        )
    axes.set_xlabel(label("equivalent radius", unit))
    axes.set_ylabel("share (%)")
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend()


def _over_load(run: Any, figure: Figure) -> None:
    """Settled volume-mean radius of every run over its load; of the source's contacts beside what dynamic light
    scattering saw."""
    settled = run.scene.get("cycles", {}).get("settled", 50)
    with np.errstate(invalid="ignore"):
        radius = np.nanmean(run.dataset["radius"].values[..., -settled:], axis=-1)
    load = np.broadcast_to(run.dataset["load"].values.reshape(-1, *[1] * (radius.ndim - 1)), radius.shape)
    factor, unit = prefix(radius, "m")
    axes = figure.add_subplot()
    if redoes(run, "paper C"):
        low, high = (factor * each for each in _DLS_STEEL)
        axes.axhspan(low, high, color=SKY, alpha=0.3, linewidth=0, label="light scattering")
    axes.plot(load.ravel(), radius.ravel() * factor, "o", color=BLUE, markersize=4, label="each repetition")
    means = [radius[load == each].mean() * factor for each in np.unique(load)]
    axes.plot(np.unique(load), means, color=BLUE, linewidth=1.0)
    axes.set_xlabel("load (N)")
    axes.set_ylabel(label("equivalent radius, volume mean", unit))
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend()


def _worn_surface(run: Any, figure: Figure) -> None:
    x, y = run.dataset["x"].values, run.dataset["y"].values
    before, after = run.dataset["height_before"].values, run.dataset["height_after"].values
    both = np.stack([before, after])
    low, high = colour_ends(both, 0.5, 99.5)  # of the worn one too: a scar deeper than the roughness is seen
    above = float(np.ptp(x)) > _LONG * float(np.ptp(y))
    if above:
        figure.set_size_inches(6.0, 6.0)
    panels = figure.subplots(*((2, 1) if above else (1, 2)))
    for axes, values, title in zip(panels, (before, after), ("before", "after the last cycle"), strict=True):
        map_of(
            figure,
            axes,
            x,
            y,
            values,
            "height",
            "m",
            ends=(low, high),
            cmap="cividis",
        )  # one scale for both: the difference is what matters
        axes.set_title(title)


def _shapes(run: Any, figure: Figure) -> None:
    """The six largest pieces of the last cycle, upside down, at a slant; thickness is drawn twice as large."""
    from matplotlib.colors import Normalize

    removed = run.dataset["removed"].values
    x, y = run.dataset["x"].values, run.dataset["y"].values
    cell = (float(x[1] - x[0]), float(y[1] - y[0]))
    periodic = (run.scene.get("domain", {}).get("periodic") == "both", True)
    deepest = float(removed.max())
    for place, piece in enumerate(largest_pieces(removed, periodic, 6)):
        depth = np.pad(piece, 1)
        axes: Any = figure.add_subplot(2, 3, place + 1, projection="3d")
        # a column is a prism: repeat its corners so that the walls stand upright
        steps = np.repeat(np.repeat(depth, 2, axis=0), 2, axis=1)
        along = [1e9 * side * np.repeat(np.arange(n + 1), 2)[1:-1] for side, n in zip(cell, depth.shape, strict=True)]
        grid_x, grid_y = np.meshgrid(*along, indexing="ij")
        colours = matplotlib.colormaps["viridis"](Normalize(0, 1e9 * deepest)(1e9 * steps[:-1, :-1]))
        axes.plot_surface(grid_x, grid_y, 1e9 * steps, facecolors=colours, rstride=1, cstride=1, shade=True)
        radius = (3 * float(piece.sum()) * cell[0] * cell[1] / (4 * np.pi)) ** (1 / 3)
        axes.set_title(f"radius {1e9 * radius:.0f} nm", fontsize=9)
        spans = (along[0][-1], along[1][-1], 2e9 * float(depth.max()))
        axes.set_box_aspect(spans, zoom=0.75)
        axes.patch.set_visible(False)  # it would cover the words of the axes beside it
        axes.tick_params(labelsize=8, pad=-2)
        axes.set_xlabel("x (nm)", fontsize=8, labelpad=-3)
        axes.set_ylabel("y (nm)", fontsize=8, labelpad=-3)
        axes.set_zlabel("thickness (nm)", fontsize=8, labelpad=-5)
        axes.xaxis.set_major_locator(MaxNLocator(3))
        axes.yaxis.set_major_locator(MaxNLocator(3))
        axes.zaxis.set_major_locator(MaxNLocator(2))


def largest_pieces(removed: Array, periodic: tuple[bool, bool], most: int) -> list[Array]:
    """Return the depths [m] of the largest connected regions of a map (nx, ny), each on its bounding rectangle.

    removed : (nx, ny) depth that left each column [m]. periodic : True where regions continue across the edges along x
    and y. most : number of regions.
    """
    from scipy.ndimage import label as connected

    names, count = connected(removed > 0)
    for axis in (axis for axis in range(2) if periodic[axis]):
        first, last = (names.take(end, axis) for end in (0, -1))
        for here in np.flatnonzero((first > 0) & (last > 0)):
            own, other = (names.take(end, axis)[here] for end in (0, -1))
            names[names == other] = own
    volume = np.bincount(names.ravel(), removed.ravel(), minlength=count + 1)[1:]
    pieces = []
    for index in np.argsort(volume)[::-1][: min(most, np.count_nonzero(volume))]:
        piece = np.where(names == index + 1, removed, 0.0)
        for axis in range(2):
            used = np.flatnonzero(piece.any(axis=1 - axis))
            # the rectangle begins after the widest run of empty rows, across a periodic edge too
            jumps = np.diff(used, append=used[0] + piece.shape[axis])
            begins = used[(np.argmax(jumps) + 1) % used.size] if periodic[axis] else used[0]
            extent = piece.shape[axis] - jumps.max() + 1 if periodic[axis] else used[-1] - used[0] + 1
            piece = np.take(np.roll(piece, -begins, axis), np.arange(extent), axis)
        pieces.append(piece)
    return pieces


def _something_left(run: Any) -> bool:
    """Return True if particles were removed: a law of wear that removes thickness gives no shapes."""
    return _any_piece(run) and bool((run.dataset["removed"].values > 0).any())


def _any_piece(run: Any) -> bool:
    return bool(np.isfinite(run.dataset["radius"].values).any())


def _many_runs(run: Any) -> bool:
    return _any_piece(run) and np.unique(run.dataset["load"].values).size > 1


FIGURES = (
    FigureKind(
        "particle-radius-over-cycles",
        "Equivalent radius of the particles over the cycles; bands span the repetitions.",
        ("radius", "cycle", "load"),
        _radius,
        (5.0, 3.4),
        _any_piece,
        all_cases=True,
    ),
    FigureKind(
        "wear-volume-over-cycles",
        "Volume that leaves in each cycle; a criterion of pieces overestimates it, Archard's law sets the real amount.",
        ("volume", "cycle", "load"),
        _volume,
        (5.0, 3.4),
        lambda run: bool((run.dataset["volume"].values > 0).any()),
        all_cases=True,
    ),
    FigureKind(
        "contact-pressure-over-cycles",
        "Mean pressure over the real contact area.",
        ("contact_load", "contact_area", "cycle", "load"),
        _pressure,
        (5.0, 3.4),
        lambda run: bool((run.dataset["contact_load"].values > 0).any()),
        all_cases=True,
    ),
    FigureKind(
        "roughness-over-cycles",
        "Root-mean-square height of the worn surface inside the contact strip.",
        ("rms_height", "cycle", "load"),
        _roughness,
        (5.0, 3.4),
        all_cases=True,
    ),
    FigureKind(
        "particle-distribution",
        "Distribution of the particles of the settled cycles.",
        ("particle_volume", "particle_cycle"),
        _distribution,
        (5.0, 3.4),
        lambda run: run.dataset["particle_volume"].size > 0,
        all_cases=True,
    ),
    FigureKind(
        "radius-over-load",
        "Settled radius over load; a band is what dynamic light scattering found of this pair (thesis, paper B).",
        ("radius", "load"),
        _over_load,
        (5.0, 3.4),
        _many_runs,
        all_cases=True,
    ),
    FigureKind(
        "worn-surface",
        "The worn surface before and after, in one colour scale; of several runs the last.",
        ("x", "y", "height_before", "height_after"),
        _worn_surface,
        (7.6, 3.4),
        all_cases=True,
    ),
    FigureKind(
        "particle-shapes",
        "The six largest particles of the last cycle, upside down; their thickness is drawn to twice its scale.",
        ("radius", "x", "y", "removed"),
        _shapes,
        (8.0, 5.8),
        _something_left,
        all_cases=True,
    ),
)
