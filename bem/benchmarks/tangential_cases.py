"""Partial slip that is timed: a first push of a rough contact, beside the normal contact that it starts from."""

from __future__ import annotations

from bem.benchmarks.contact_cases import MEAN_PRESSURE, PERIODIC, POISSON, rough_gap
from bem.benchmarks.measure import Outcome, Timed
from bem.grid import Grid
from bem.materials import Body, Material

HALF = Body(Material("two of unit contact modulus", youngs_modulus=2 * (1 - POISSON**2), poissons_ratio=POISSON))
"""E* = 1 against one like it: pressure moves nothing in the plane."""
FRICTION, SHARE = 0.4, 0.6
"""Coefficient, and the push over what friction can carry."""


def partial_slip(cells: float) -> Timed:
    """Stick and slip of the rough contact of all comparisons; the error is the residual, formed anew."""
    from bem.contact import solve_contact
    from bem.convolution import displacement_operator
    from bem.tangential import TangentialSolution, solve_partial_slip

    n = int(cells)
    grid = Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC)
    contact = solve_contact(rough_gap(n), displacement_operator(grid, (HALF, HALF)), load=MEAN_PRESSURE)
    force = (SHARE * FRICTION * contact.load, 0.0)

    def solve() -> TangentialSolution:
        return solve_partial_slip(contact, grid, (HALF, HALF), friction=FRICTION, force=force)

    def judge(found: TangentialSolution) -> Outcome:
        sticks = found.stick_area / (found.stick_area + found.slip_area)
        # a convolution of both directions is two of one
        counts = {"convolutions": 2 * found.convolutions, "of_the_normal_contact": contact.convolutions}
        return Outcome(
            {"residual": found.residual},
            counts,
            {"stick_fraction": sticks, "converged": float(found.status == "converged")},
        )

    return Timed(solve, judge)
