"""Sketches of a steady line film: on a coarse mesh, where the spike of pressure has few cells.

They tell by how much a film changes with its oil, at a share of the cost of the film itself, whose start they are. Sees
what `bem.lubrication.steady` does. Verified in tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from bem.lubrication.film import FilmSolution
from bem.lubrication.line_continuation import sketched
from bem.lubrication.line_kept import KeptSteady
from bem.lubrication.line_newton import is_start
from bem.lubrication.line_scales import scaled_problem
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.rough_walls import WallFactors, walls_of
from bem.lubrication.steady import checked_case, solution_of

_POINTS, _TOLERANCE = 251, 1e-4
"""What `checked_case` is told of: as `line_continuation.sketched` has them."""


def sketch_line_film(  # reason: the arguments of `solve_line_film`
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    speeds: Sequence[float],
    lubricant: Lubricant,
    initial: FilmSolution | None = None,
    max_iterations: int = 40,
    flow_factors: WallFactors | str = "off",
) -> FilmSolution:
    """The flooded film, coarsely; arguments and errors as of `solve_line_film`, `initial` a sketch or any film."""
    scales, reversed_ = checked_case(
        load, radius, contact_modulus, speeds, lubricant, _POINTS, _TOLERANCE, None, initial
    )
    walls = walls_of(flow_factors, scales.film, speeds)
    problem = scaled_problem(scales, scales.load, lubricant, walls, float(speeds[0]) - float(speeds[1]))
    kept = None if initial is None else initial.state
    if isinstance(kept, KeptSteady) and is_start(kept.flooded):
        outcome = sketched(problem, kept.flooded, kept.load, max_iterations)
    else:
        outcome = sketched(problem, None, problem.load, max_iterations)
    film = solution_of(outcome, outcome, problem, scales, speeds, reversed_, lubricant, None)
    assert isinstance(film.state, KeptSteady)
    return replace(film, state=replace(film.state, sketch=True))
