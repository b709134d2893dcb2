"""Figures of a life of many cycles: friction, wear, roughness, film and jumps over cycles, on a logarithmic axis.

Knows a run's dataset; solves nothing. Verified in tests/plots/test_figures.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.style import BLUE, GREEN, VERMILION, map_of, start_at_zero


def _axis(run: Any, axes: Axes) -> Any:
    """Cycles on a logarithmic axis."""
    cycle = run.dataset["cycle"].values
    axes.set_xscale("log")
    axes.set_xlim(cycle[0], cycle[-1])
    axes.set_xlabel("cycles")
    return cycle


def _friction(run: Any, figure: Figure) -> None:
    axes, data = figure.add_subplot(), run.dataset
    cycle = _axis(run, axes)
    axes.plot(cycle, data["friction_over_cycles"].values, color=BLUE, label="friction")
    axes.plot(cycle, data["boundary_friction_over_cycles"].values, "--", color="0.45", label="boundary part")
    axes.set_ylabel("friction coefficient")
    start_at_zero(axes)
    other = axes.twinx()
    other.plot(cycle, data["contact_share"].values, ":", color=VERMILION, label="asperity load share")
    other.set_ylabel("asperity load share", color=VERMILION)
    other.set_ylim(0, 1.06)  # a share of one is a line below the edge
    _legend_above(axes, other)


def _legend_above(axes: Axes, other: Axes) -> None:
    """Put one legend of both axes above them, where no curve runs."""
    lines = [*axes.lines, *other.lines]
    axes.legend(handles=lines, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(lines), fontsize=8)


def _wear(run: Any, figure: Figure) -> None:
    data = run.dataset
    upper, lower = figure.subplots(2, 1, sharex=True)
    _axis(run, upper)
    cycle = _axis(run, lower)
    upper.set_xlabel("")
    missed = 1e9 * data["depth_error_over_cycles"].values
    for name, colour, line in (("lower", BLUE, "-"), ("upper", VERMILION, "--")):  # of one rate both wear alike
        depth = 1e9 * data[f"{name}_depth_over_cycles"].values
        bar = run.summary.get(f"{name}_worn_depth_nm_error")
        band = missed
        if isinstance(bar, float) and depth[-1] > 0:  # the bar of the end, in proportion to the depth
            band = np.maximum(missed, bar * depth / depth[-1])
        upper.plot(cycle, 1e9 * data[f"{name}_rms_over_cycles"].values, line, color=colour, label=f"{name} surface")
        lower.plot(cycle, depth, line, color=colour, label=f"{name} surface")
        lower.fill_between(cycle, depth - band, depth + band, color=colour, alpha=0.2, linewidth=0)
    upper.set_ylabel("Sq of the\nwhole surface (nm)")
    lower.set_ylabel("mean depth\nworn (nm)")
    start_at_zero(upper)
    start_at_zero(lower)
    upper.legend()


def _film(run: Any, figure: Figure) -> None:
    axes, data = figure.add_subplot(), run.dataset
    cycle = _axis(run, axes)
    axes.plot(
        cycle,
        1e9 * data["minimum_film_over_cycles"].values,
        color=BLUE,
        label="minimum oil film, under its part of the load",
    )
    if "tribofilm_over_cycles" in data.variables:
        axes.plot(cycle, 1e9 * data["tribofilm_over_cycles"].values, color=GREEN, label="tribofilm, mean")
    axes.set_ylabel("thickness (nm)")
    start_at_zero(axes)
    other = axes.twinx()
    other.plot(cycle, data["lambda_over_cycles"].values, "--", color=VERMILION, label="lambda ratio")
    other.set_ylabel("lambda ratio,\nunder the whole load", color=VERMILION)
    start_at_zero(other)
    _legend_above(axes, other)


def _jumps(run: Any, figure: Figure) -> None:
    axes, data = figure.add_subplot(), run.dataset
    place = data["step_cycle"].values
    axes.loglog(place, data["step_length"].values, ".-", color=BLUE)
    axes.set_xlabel("cycles")
    axes.set_ylabel("cycles in a jump", color=BLUE)
    other = axes.twinx()
    other.semilogx(place, 100 * data["step_error"].values, ".-", color=VERMILION, linewidth=0.8)
    other.axhline(100 * run.scene["life"]["tolerance"], color=VERMILION, linestyle=":", linewidth=0.8)
    other.set_ylabel("error over the wear in the jump (%)", color=VERMILION)
    start_at_zero(other)


def _particles(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    cycle = _axis(run, axes)
    axes.set_yscale("log")
    axes.plot(cycle, run.dataset["particles_over_cycles"].values, color=BLUE)
    axes.set_ylabel("particles up to the cycle, lower body")


def _pits(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    cycle = _axis(run, axes)
    axes.plot(cycle, 100 * run.dataset["micropitted_over_cycles"].values, color=VERMILION)
    axes.set_ylabel("micropitted share (%)")
    start_at_zero(axes)


def _damage(run: Any, figure: Figure) -> None:
    data = run.dataset
    damage = data["damage_map"].values
    map_of(figure, figure.add_subplot(), data["x"].values, data["y"].values, damage, "damage", "", ends=(0.0, 1.0))


_WIDE = (6.0, 3.6)
FIGURES = (
    FigureKind(
        "friction-over-life",
        "Friction coefficient and asperity load share over the cycles.",
        ("cycle", "friction_over_cycles", "boundary_friction_over_cycles", "contact_share"),
        _friction,
        _WIDE,
    ),
    FigureKind(
        "wear-over-life",
        "Roughness and mean depth worn of both surfaces over the cycles; bands are the error bars of the depths.",
        ("cycle", "lower_depth_over_cycles", "depth_error_over_cycles", "lower_rms_over_cycles"),
        _wear,
        (6.0, 5.0),
    ),
    FigureKind(
        "film-over-life",
        "Minimum film thickness, tribofilm thickness and lambda ratio over the cycles.",
        ("cycle", "minimum_film_over_cycles", "lambda_over_cycles"),
        _film,
        _WIDE,
    ),
    FigureKind(
        "jumps",
        "Length of the cycle jumps and their error; dotted: the tolerance.",
        ("step_cycle", "step_length", "step_error"),
        _jumps,
        _WIDE,
    ),
    FigureKind(
        "particles-over-life",
        "Particles shed by the lower body up to each cycle, of the sizes that the criterion finds.",
        ("cycle", "particles_over_cycles"),
        _particles,
        _WIDE,
    ),
    FigureKind(
        "micropitting-over-life",
        "Share of the surface below which a voxel has no life left, over the cycles.",
        ("cycle", "micropitted_over_cycles"),
        _pits,
        _WIDE,
        lambda run: bool((run.dataset["micropitted_over_cycles"].values > 0).any()),
    ),
    FigureKind(
        "damage-map",
        "Largest damage below each place at the end; one is a micropit.",
        ("x", "y", "damage_map"),
        _damage,
        _WIDE,
    ),
)
