"""Figures of a dry contact: state, a section, the distribution of pressure, convergence, surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

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
        title=_edges_of(run.summary.get("contact_area_fraction"), float(np.mean(state > 0))),
        title_fontsize=8,
    )


def _edges_of(area: Any, counted: float) -> str:
    """Return the shares of the legend, and the headline's area where that is another."""
    if not isinstance(area, float) or f"{area:.3%}" == f"{counted:.3%}":
        return "share of the cells"
    return f"share of the cells; contact area as drawn through them: {area:.3%}"


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
        "surface-maps",
        "The surfaces as they enter the contact; where lone heights would take all colours, these end at the 99.8th "
        "percentile, which the bar says.",
        ("x", "y"),
        _surfaces,
        (7.8, 3.4),
        _rough,
    ),
)
