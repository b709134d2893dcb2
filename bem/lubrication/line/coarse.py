"""Sketches of a steady line film: on a coarse mesh, where the spike of pressure has few cells.

They tell by how much a film changes with its oil, at a share of the cost of the film itself, whose start they are. Sees
what `bem.lubrication.line.steady` does. Verified in tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

from dataclasses import replace

from bem.lubrication.line.case import LineCase
from bem.lubrication.line.continuation import sketched
from bem.lubrication.line.newton import is_start
from bem.lubrication.line.state import KeptSteady
from bem.lubrication.line.steady import solution_of
from bem.lubrication.results import FilmSolution


def sketch_line_film(case: LineCase) -> FilmSolution:
    """The flooded film of a case, coarsely whatever its points and tolerance; errors as of `solve_line_film`, `initial`
    a sketch or any film."""
    units = case.scaled()
    problem = case.problem(units[0])
    kept = None if case.initial is None else case.initial.state
    if isinstance(kept, KeptSteady) and is_start(kept.flooded):
        outcome = sketched(problem, kept.flooded, kept.load, case.max_iterations)
    else:
        outcome = sketched(problem, None, problem.load, case.max_iterations)
    film = solution_of(outcome, outcome, case, units)
    assert isinstance(film.state, KeptSteady)
    return replace(film, state=replace(film.state, sketch=True))
