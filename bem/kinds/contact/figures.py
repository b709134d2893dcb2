"""Figures of a dry contact: state, a section, the distribution of pressure, convergence, surfaces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator, NullFormatter

from bem.contact.regions import label_spots
from bem.grid import Grid
from bem.numerics.blocks import deviation
from bem.plots.figures import FigureKind, wide_enough
from bem.plots.figures.pressure import in_contact
from bem.plots.style import (
    BLACK,
    BLUE,
    OPEN,
    ORANGE,
    VERMILION,
    along_x,
    field_axes,
    label,
    map_of_heights,
    prefix,
    thinned,
)
from bem.scenes.context import release


def _array(run: Any, name: str) -> Any:
    return run.dataset[name].values


def _contact_map(run: Any, figure: Figure) -> None:
    state = _array(run, "contact_state")
    axes = figure.add_subplot()
    area = run.summary.get("contact_area_fraction")
    if "lowest_load_pressure" in run.dataset and not state.any():
        state, area = (_array(run, "lowest_load_pressure") > 0).astype(np.int8), None
        axes.set_title("at the lowest load; apart at the end of the path")
    extent = field_axes(axes, _array(run, "x"), _array(run, "y"))
    colours = ListedColormap([OPEN, BLUE, ORANGE])
    axes.imshow(
        thinned(state).T,
        extent=extent,
        origin="lower",
        aspect=axes.get_aspect(),
        cmap=colours,
        norm=BoundaryNorm([-0.5, 0.5, 1.5, 2.5], 3),
    )
    names = ("open", "elastic", "at the hardness")
    handles = [
        Patch(facecolor=colours(i), edgecolor="0.6", linewidth=0.5, label=f"{names[i]}: {np.mean(state == i):.3%}")
        for i in range(3)
        if i < 2 or (state == 2).any()
    ]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=3,
        columnspacing=1.2,
        title=_edges_of(area, float(np.mean(state > 0))),
        title_fontsize=8,
    )


def _edges_of(area: Any, counted: float) -> str:
    """Return the shares of the legend, and the headline's area where that is another."""
    if not isinstance(area, float) or f"{area:.3%}" == f"{counted:.3%}":
        return "share of the cells"
    return f"share of whole cells; contact area with its edges between cells: {area:.3%}"


def _section(run: Any, figure: Figure) -> None:
    """Along x where the row carries most: the gap above, the pressure below."""
    pressure, gap, x = _array(run, "pressure"), _array(run, "gap"), _array(run, "x")
    along_y = len(x) < 2
    if along_y:
        pressure, gap, x = pressure.T, gap.T, _array(run, "y")
    row = int(np.argmax(pressure.sum(axis=0)))
    undeformed = _array(run, "undeformed_gap")
    undeformed = (undeformed.T if along_y else undeformed)[:, row] - run.summary["approach_m"]
    factor_x, unit_x = prefix(x, "m")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    reach = max(1.1 * float(np.percentile(gap[:, row], 95)), 1e-30)
    deepest = float(undeformed.min())
    factor, unit = prefix([reach, deepest], "m")
    upper.plot(x * factor_x, undeformed * factor, color="0.6", linewidth=0.9, label="undeformed, approached")
    upper.plot(x * factor_x, np.maximum(gap[:, row], 0) * factor, color=BLUE, label="deformed")
    upper.axhline(0, color=BLACK, linewidth=0.6)
    upper.set_ylim((deepest - 0.08 * (reach - deepest)) * factor, reach * factor)
    upper.set_ylabel(label("gap", unit))
    upper.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    factor, unit = prefix(pressure[:, row], "Pa")
    lower.fill_between(x * factor_x, pressure[:, row] * factor, step="mid", color=VERMILION, alpha=0.85, linewidth=0)
    lower.set_ylabel(label("pressure", unit))
    lower.set_xlabel(label("y" if along_y else along_x(), unit_x))
    lower.set_xlim(x[0] * factor_x, x[-1] * factor_x)
    lower.set_ylim(0)


def _histogram(run: Any, figure: Figure) -> None:
    pressure = _array(run, "pressure")
    pressure = pressure[pressure > 0]
    factor, unit = prefix(pressure, "Pa")
    axes = figure.add_subplot()
    counts, edges = np.histogram(pressure * factor, bins=60, range=(0, float(pressure.max()) * factor))
    axes.stairs(counts / counts.sum(), edges, fill=True, color=BLUE, alpha=0.85)
    axes.set_xlabel(label("contact pressure", unit))
    axes.set_ylabel("share of the contact area")
    axes.set_xlim(0)
    axes.set_yscale("log")


def _convergence(run: Any, figure: Figure) -> None:
    residual = _array(run, "residual_history")
    axes = figure.add_subplot()
    axes.semilogy(_array(run, "iteration"), np.maximum(residual, 1e-18), marker="o", markersize=2.5)
    tolerance = run.scene.get("contact", {}).get("tolerance")
    if tolerance:
        axes.axhline(tolerance, color=VERMILION, linestyle="--", linewidth=1.0)
        axes.annotate(
            "tolerance",
            (0.01, tolerance),
            (0, 3),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            color=VERMILION,
            fontsize=8,
        )
    axes.set_xlabel("iteration")
    axes.set_ylabel("relative residual")
    axes.grid(True, axis="y", linewidth=0.4, color="0.85")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def _area_over_load(run: Any, figure: Figure) -> None:
    """All cases or points, over the nominal pressure made dimensionless; a bar ends at the case's own error.

    The plastic limit, load over hardness, is the nominal pressure made dimensionless times the plasticity index of the
    rms slope, E* h' / H.
    """
    pressure = np.ravel(_array(run, "reduced_pressure"))
    area = np.ravel(_array(run, "contact_area_fraction"))
    axes = figure.add_subplot()
    known = np.isfinite(pressure) & (area > 0)
    reach = np.geomspace(0.3 * pressure[known].min(), 3.0 * pressure[known].max(), 200)
    persson = [math.erf(math.sqrt(2.0) * value) for value in reach]
    axes.loglog(reach, persson, color=BLACK, label="Persson: erf(√2 p / (E* h′))")
    bush = math.sqrt(2 * math.pi) * reach
    axes.loglog(
        reach[bush < 1],
        bush[bush < 1],
        "--",
        color="0.5",
        linewidth=2.2,
        label="Bush, Gibson, Thomas: √(2π) p / (E* h′)",
    )
    _plastic_limits(run, axes, reach, pressure, known)
    error = (
        np.ravel(_array(run, "contact_area_fraction_error")) if "contact_area_fraction_error" in run.dataset else None
    )
    _scatter_of_places(run, axes, pressure, area, known)
    axes.errorbar(
        pressure[known],
        area[known],
        yerr=None if error is None else np.nan_to_num(error[known]),
        fmt="o",
        markersize=4,
        capsize=2,
        color=BLUE,
        label=("computed" if np.count_nonzero(known) > 1 else "this run")
        + (" ± numerical error" if error is not None else ""),
    )
    axes.set_xlabel("nominal pressure p / (E* × rms slope h′)")
    axes.set_ylabel("contact area fraction")
    axes.set_xlim(reach[0], reach[-1])
    axes.set_ylim(top=min(1.5, 2.0 * max(persson[-1], min(bush[-1], 1.0), float(area[known].max()))))
    axes.legend(loc="upper left")


def _scatter_of_places(run: Any, axes: Any, pressure: Any, area: Any, known: Any) -> None:
    """Draw for each case how the area scatters from place to place of the surface, by its number of contact spots."""
    from bem.scenes.checks.outcome import scatter_of_places

    name = next((name for name in ("contact_spots_of_map", "contact_spots") if name in run.dataset), None)
    if name is None:
        return
    spots = np.broadcast_to(np.ravel(_array(run, name)), pressure.shape)
    known = known & (spots > 0)
    if not known.any():
        return
    axes.errorbar(
        pressure[known],
        area[known],
        yerr=area[known] * np.array([scatter_of_places(count) for count in spots[known]]),
        fmt="none",
        elinewidth=9.0,  # wider than the marker, which would hide a short bar
        ecolor=BLUE,
        alpha=0.25,
        label="scatter from place to place, by contact spots",
    )


_SAME_LIMIT = 1e-3
"""Relative difference of plasticity indices below which one line shows the plastic limit of all cases."""


def _plastic_limits(run: Any, axes: Any, reach: Any, pressure: Any, known: Any) -> None:
    """Draw the area at which all of the load is carried at the hardness: a line, or points if it differs by case."""
    if "slope_plasticity_index" not in run.dataset:
        return
    index = np.broadcast_to(np.ravel(_array(run, "slope_plasticity_index")), pressure.shape)
    known = known & np.isfinite(index)
    if not known.any():
        return
    if np.ptp(index[known]) <= _SAME_LIMIT * float(index[known].max()):
        limit = float(index[known].mean()) * reach
        axes.loglog(
            reach[limit <= 1],
            limit[limit <= 1],
            ":",
            color=VERMILION,
            linewidth=1.2,
            label="plastic limit: load / hardness",
        )
    else:
        limits = np.minimum(index[known] * pressure[known], 1.0)
        axes.plot(pressure[known], limits, "x", color=VERMILION, label="plastic limit: load / hardness")


def _has_pressures(run: Any) -> bool:
    return bool(np.any(np.isfinite(_array(run, "reduced_pressure")) & (_array(run, "contact_area_fraction") > 0)))


def _adhesive_path(run: Any, figure: Figure) -> None:
    """Load over approach, and contact area over load, with the direction and the jumps of the path."""
    load, approach, area = (_array(run, f"path_{name}") for name in ("load", "approach", "contact_area"))
    jumped = _array(run, "path_jump") > 0
    (force, force_unit), (length, length_unit) = prefix(load, "N"), prefix(approach, "m")
    left, right = figure.subplots(1, 2)
    size, size_unit = (1e12, "µm²") if area.max() < 1e-6 else (1e6, "mm²")
    for axes, x, y in ((left, approach * length, load * force), (right, load * force, area * size)):
        for first in range(len(x) - 1):
            style = "--" if jumped[first + 1] else "-"
            axes.plot(x[first : first + 2], y[first : first + 2], style, color=VERMILION if jumped[first + 1] else BLUE)
        axes.plot(x, y, ".", color=BLUE)
        axes.plot(x[:1], y[:1], "o", color=BLACK, markersize=5, label="start")
        axes.plot(x[-1:], y[-1:], "s", color=BLACK, markersize=5, label="end")
    left.plot([], [], "--", color=VERMILION, label="jump")
    left.axhline(0, color="0.7", linewidth=0.6)
    left.set_xlabel(label("approach", length_unit))
    left.set_ylabel(label("load", force_unit))
    right.set_xlabel(label("load", force_unit))
    right.set_ylabel(label("contact area", size_unit))
    left.legend()


def _over_time(run: Any, figure: Figure) -> None:
    """Load, approach and contact area over the time of the path."""
    time = _array(run, "path_time")
    time = time - time[0]
    factor, unit = prefix(time, "s")
    area = _array(run, "path_contact_area")
    size, size_unit = (1e12, "µm²") if area.max() < 1e-6 else (1e6, "mm²")
    load, approach = (_array(run, f"path_{name}") for name in ("load", "approach"))
    rows = ((load, "load", *prefix(load, "N")), (approach, "approach", *prefix(approach, "m")))
    every = (*rows, (area, "contact area", size, size_unit))
    for axes, (values, name, scale, written) in zip(figure.subplots(1, 3), every, strict=True):
        axes.plot(time * factor, values * scale, ".-", color=BLUE, markersize=3)
        axes.set_xlabel(label("time", unit))
        axes.set_ylabel(label(name, written))
        axes.set_ylim(bottom=min(0.0, 1.05 * float(values.min()) * scale))


def _friction_over_speed(run: Any, figure: Figure) -> None:
    """Hysteresis friction of all cases over the speed."""
    speed, friction = (np.ravel(_array(run, name)) for name in ("contact_speed", "hysteresis_friction"))
    order = np.argsort(speed)
    axes = figure.add_subplot()
    axes.semilogx(speed[order], friction[order], "o-", color=BLUE, markersize=4)
    axes.set_xlabel(label("speed", "m/s"))
    axes.set_ylabel("friction coefficient of hysteresis")
    axes.set_ylim(bottom=0)


def _several_speeds(run: Any) -> bool:
    return bool(np.unique(_array(run, "contact_speed")).size > 1)


_FEWEST_SPOTS = 10


def _spot_sizes(run: Any, figure: Figure) -> None:
    """Number of spots of at least an area over that area, for all spots of contact."""
    x, y = _array(run, "x"), _array(run, "y")
    cell = float(x[1] - x[0]) * float(y[1] - y[0])
    periodic = run.scene.get("grid", {}).get("periodic", False)
    sides = tuple(periodic) if isinstance(periodic, list | tuple) else (bool(periodic), bool(periodic))
    labels = label_spots(_array(run, "pressure"), Grid((len(x), len(y)), (1.0, 1.0), periodic=sides))
    areas = np.sort(np.bincount(labels.ravel())[1:]) * cell
    factor, unit = (1e12, "µm²") if areas[-1] < 1e-6 else (1e6, "mm²")
    axes = figure.add_subplot()
    axes.step(areas * factor, np.arange(areas.size, 0, -1), where="pre", color=BLUE)
    axes.axvspan(0.5 * cell * factor, 12 * cell * factor, color="0.9", label="under four cells across")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(left=0.8 * cell * factor)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(label("area of a spot", unit))
    axes.set_ylabel("spots at least as large")
    axes.legend(loc="upper right")


def _many_spots(run: Any) -> bool:
    """Return True if there are spots enough for a distribution."""
    spots = run.summary.get("contact_spots")
    return wide_enough(run) and (max(spots) if isinstance(spots, list) else spots or 0) >= _FEWEST_SPOTS


def _surfaces(run: Any, figure: Figure) -> None:
    names = [name for name in ("lower_height", "upper_height") if name in run.dataset]
    figure.set_size_inches(3.9 * len(names), figure.get_figheight())  # of one the other half was empty
    for axes, name in zip(np.atleast_1d(figure.subplots(1, len(names))), names, strict=True):
        values = _array(run, name)
        map_of_heights(figure, axes, _array(run, "x"), _array(run, "y"), values)
        axes.set_title(f"{name.split('_')[0]} surface, Sq = {_length(deviation(values))}")
        release(values)


def _length(value: float) -> str:
    factor, unit = prefix([value], "m")
    return f"{value * factor:.3g} {unit}"


def _rough(run: Any) -> bool:
    return wide_enough(run) and any(name in run.dataset for name in ("lower_height", "upper_height"))


FIGURES = (
    FigureKind(
        "contact-map",
        "Where the surfaces touch, and where the pressure has reached the hardness; shares are counts of cells, "
        "the contact area of the figures has its edges between their centres.",
        ("x", "y", "contact_state"),
        _contact_map,
        applies=wide_enough,
    ),
    FigureKind(
        "contact-section",
        "Section along the row of cells that carries most: the gap of the undeformed surfaces moved together by "
        "the approach, the gap after deformation, and the pressure.",
        ("x", "y", "pressure", "gap", "undeformed_gap"),
        _section,
        (6.0, 4.0),
        in_contact,
    ),
    FigureKind(
        "pressure-histogram",
        "Distribution of the pressure over the contact area.",
        ("pressure",),
        _histogram,
        (5.0, 3.2),
        in_contact,
    ),
    FigureKind(
        "convergence", "Residual of the contact solver.", ("iteration", "residual_history"), _convergence, (5.0, 3.2)
    ),
    FigureKind(
        "area-over-load",
        "Contact area over the nominal pressure, divided by contact modulus and rms slope of both surfaces together, "
        "beside the theories of Persson (J. Chem. Phys. 115, 2001) and of Bush, Gibson and Thomas (Wear 35, 1975) for "
        "elastic bodies. The slope is that of neighbouring cells. Pressures limited by the hardness need more area, at "
        "least the load over the hardness (plastic limit). Narrow bars are numerical errors; wide, light ones "
        "estimate how the area scatters between places of the surface: by half over the square root of the number of "
        "contact spots.",
        ("reduced_pressure", "contact_area_fraction"),
        _area_over_load,
        (5.4, 4.2),
        _has_pressures,
        all_cases=True,
        of_sweeps=True,
    ),
    FigureKind(
        "adhesion-path",
        "Path of an adhesive contact: load over approach and contact area over load, from the start to the end; dashed "
        "where the contact jumps.",
        ("path_load", "path_approach", "path_contact_area", "path_jump"),
        _adhesive_path,
        (7.6, 3.6),
    ),
    FigureKind(
        "contact-over-time",
        "Load, approach and contact area of bodies that relax, over time; points are the steps.",
        ("path_time", "path_load", "path_approach", "path_contact_area"),
        _over_time,
        (8.4, 3.0),
    ),
    FigureKind(
        "friction-over-speed",
        "Friction of hysteresis over the speed of steady sliding or rolling, one point for each case.",
        ("contact_speed", "hysteresis_friction"),
        _friction_over_speed,
        (5.4, 3.6),
        _several_speeds,
        all_cases=True,
    ),
    FigureKind(
        "spot-sizes",
        "Sizes of the separate spots of contact: how many are at least as large. The smallest follow the grid.",
        ("x", "y", "pressure"),
        _spot_sizes,
        (5.0, 3.6),
        _many_spots,
    ),
    FigureKind(
        "surface-maps",
        "The surfaces as they enter the contact; where lone heights would take all colours, these end at the 99.8th "
        "percentile, which the bar says.",
        ("x", "y"),
        _surfaces,
        (7.8, 3.4),
        _rough,
    ),
)
