"""Error bars of an adhesive contact: the same path on the grid of twice the cell, and the steps about its lowest load.

Verified in tests/adhesion/test_adhesive_bars.py against Maugis' spheres and finer grids of rough surfaces.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import ContactCase, coarser_problem, edge_fraction, regime_of
from bem.accuracy.contact import figures_of, missed_by_differences
from bem.accuracy.richardson import Regime, Table, relative, residual_errors, rows
from bem.adhesion import AdhesionLaw, AdhesiveHistory, follow_path
from bem.errors import InfeasibleError, Status
from bem.notes.accuracy import NoBar

RULES = Table(
    "adhesion_error_bars",
    rows(
        "contact_area contact_area_fraction contact_perimeter mean_contact_pressure mean_contact_traction "
        "plastic_area_fraction",
        0.5,
        "Between first and second order: attraction beside the edge is steep, and the edge moves within cells.",
        order=1,
        edge=0.02,
    ),
    rows("max_pressure", 0.5, "As the area; at the edge or at the sharpest asperity.", order=1, edge=0.005),
    rows(
        "load lowest_load adhesive_energy",
        1.0,
        "First order: the sum of the attraction, which is steep between cells.",
        order=1,
        edge=0.02,
    ),
    rows("approach mean_gap", 0.5, "As the area.", order=1, edge=0.004),
)
"""Factors on the difference to twice the cell; floors on the fraction of the area within a cell of the edge."""


def adhesive_bars(
    case: ContactCase,
    law: AdhesionLaw,
    path: AdhesiveHistory,
    asked: Mapping[str, list[float]],
    tolerance: float = 1e-6,
    after: Callable[[int], object] | None = None,
) -> ErrorBars:
    """Return the error bars of an adhesive contact.

    case : of the last contact. path : as solved. asked : loads or approaches of the path.
    tolerance : with which the path was solved.
    after : called after each step of the coarser path with the number of steps that are done.
    """
    given = "load" if "loads" in asked else "approach"
    problem = coarser_problem(case)
    if problem is None:
        return ErrorBars.unknown(RULES, NoBar.TOO_SMALL, prescribed=[given])
    gap, operator = problem
    try:
        coarse = follow_path(
            gap,
            operator,
            law,
            loads=asked.get("loads"),
            approaches=asked.get("approaches"),
            hardness=case.hardness,
            tolerance=tolerance,
            refined=True,
            callback=None if after is None else lambda number, _: after(number + 1),
        )
    except InfeasibleError:
        return ErrorBars.unknown(RULES, NoBar.IMPOSSIBLE, prescribed=[given])
    if coarse.status is not Status.CONVERGED:
        return ErrorBars.unknown(RULES, NoBar.COARSER_UNSOLVED, prescribed=[given])
    fine, other = (
        figures_of(one.last.contact, grid.area)
        | {"load": one.last.load, "lowest_load": one.lowest_load, "adhesive_energy": one.last.energy}
        for one, grid in ((path, case.grid), (coarse, operator.grid))
    )
    grid = RULES.errors(fine, other, {"edge": relative(edge_fraction(case), fine)})
    for name, missed in missed_by_differences(case, resolved=regime_of(case) is Regime.RESOLVED).items():
        grid[name] += missed
    if len(path.load) == 1:  # one state has no lowest load beside its own
        del grid["lowest_load"]
    left = residual_errors(path.last.residual, fine)
    if given == "approach" and "lowest_load" in grid:
        left["lowest_load"] = left.get("lowest_load", 0.0) + path.lowest_load_error
    parts = {GRID: grid, RESIDUAL: left}
    for errors in parts.values():  # pressure less a constant, the strength of the law
        errors["mean_contact_traction"] = errors["mean_contact_pressure"]
    return ErrorBars.together(parts).with_prescribed([given])
