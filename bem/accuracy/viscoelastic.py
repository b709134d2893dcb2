"""Error bars of contacts of bodies that relax: the grid of twice the cell, and half of the steps on that grid.

Verified in tests/viscoelastic/test_viscoelastic_bars.py against closed forms; judged by the experiment that `RULES`
names.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, STEPS, ErrorBars
from bem.accuracy.coarsened import ContactCase, coarser_problem, edge_fraction, regime_of
from bem.accuracy.contact import figures_of, missed_by_differences
from bem.accuracy.richardson import Regime, Table, relative, residual_errors, rows
from bem.convolution import DisplacementOperator
from bem.errors import Status
from bem.grid import FloatArray
from bem.notes.accuracy import NoBar
from bem.viscoelastic import SteadySolution, ViscoelasticHistory, follow_times, solve_steady_motion

RULES = Table(
    "viscoelastic_error_bars",
    rows(
        "contact_area contact_area_fraction contact_perimeter mean_contact_pressure plastic_area_fraction",
        1.0,
        "First order: the edge that moves goes by whole cells.",
        order=1,
        edge=0.05,
    ),
    rows("max_pressure", 1.0, "The peak is away from the edge; memory makes it sharper in front.", order=1, edge=0.005),
    rows("load dissipated_energy", 1.0, "First order, as the edge.", order=1, edge=0.01),
    rows("approach mean_gap", 1.0, "First order, as the edge.", order=1, edge=0.005),
    rows(
        "hysteresis_friction hysteresis_force",
        1.0,
        "Second order in the mean, with a scatter by the cells that touch.",
        edge=0.025,
    ),
    rows(
        "dissipated_power",
        1.0,
        "Second order in the mean; first order where the cells are longer than the memory.",
        edge=0.01,
    ),
)
"""Factors on the difference to twice the cell; floors on the fraction of the area within a cell of the edge."""

_HALF_STEPS = 1.0
"""Factor on the difference to half of the steps, whose order is between one and two."""


def relaxed_bars(
    case: ContactCase,
    solved: ViscoelasticHistory | SteadySolution,
    *,
    speeds: tuple[float, float] | None = None,
    times: Sequence[float] = (),
    path: Mapping[str, list[float]] | None = None,
) -> ErrorBars:
    """Return the error bars of a contact of bodies that relax.

    case : of the last contact. solved : what the bars are of. speeds : of steady motion. times, path : of a path in
    time, as arguments of `follow_times`.
    """
    given = "load" if case.load is not None else "approach"
    problem = coarser_problem(case)
    if problem is None:
        return ErrorBars.unknown(RULES, NoBar.TOO_SMALL, prescribed=[given])
    gap, operator = problem
    if isinstance(solved, SteadySolution):
        assert speeds is not None
        other: list[ViscoelasticHistory | SteadySolution] = [
            solve_steady_motion(gap, operator, speeds, load=case.load, approach=case.approach, tolerance=1e-6)
        ]
    else:
        assert path is not None
        other = [_marched(gap, operator, solved.time[::every], times, path) for every in (1, 2)]
    if any(each.status is not Status.CONVERGED for each in other):
        return ErrorBars.unknown(RULES, NoBar.COARSER_UNSOLVED, prescribed=[given])
    fine, *coarse = (
        _figures(each, area)
        for each, area in zip((solved, *other), (case.grid.area, *(operator.grid.area for _ in other)), strict=True)
    )
    grid = RULES.errors(fine, coarse[0], {"edge": relative(edge_fraction(case), fine)})
    for name, missed in missed_by_differences(case, resolved=regime_of(case) is Regime.RESOLVED).items():
        grid[name] += missed
    parts = {GRID: grid, RESIDUAL: residual_errors(case.solution.residual, fine)}
    if len(coarse) > 1:
        parts[STEPS] = {name: _HALF_STEPS * abs(coarse[1][name] - coarse[0][name]) for name in grid}
    return ErrorBars.together(parts).with_prescribed([given])


def _marched(
    gap: FloatArray,
    operator: DisplacementOperator,
    steps: FloatArray,
    times: Sequence[float],
    path: Mapping[str, list[float]],
) -> ViscoelasticHistory:
    """Return the path on other cells at some of the times of the steps."""
    return follow_times(
        gap,
        operator,
        times,
        loads=path.get("loads"),
        approaches=path.get("approaches"),
        steps=[float(time) for time in np.unique(steps)],
        tolerance=1e-6,
    )


def _figures(solved: ViscoelasticHistory | SteadySolution, area: float) -> dict[str, float]:
    """Return the figures of a solution on a grid of that area [m^2]."""
    if isinstance(solved, SteadySolution):
        return figures_of(solved.contact, area) | {
            "hysteresis_friction": solved.friction,
            "hysteresis_force": solved.friction_force,
            "dissipated_power": solved.dissipated_power,
        }
    return figures_of(solved.last, area) | {"dissipated_energy": float(solved.dissipated[-1])}
