"""Initial tractions of partial slip: the Jaeger start of a first straight push, or nested iteration from coarser grids.

Initial tractions of slipping cells lie outside their discs, by stiffness x slip: `slip_newton` projects them and reads
the slip from the distance.

**Jaeger start**, for a first push by a force without imposed displacement (like bodies, no rotation). Where no cell
slips sideways, the tractions q along the push and their displacement A q along it solve a normal contact problem. The
unused bound p = g - q >= 0 is its pressure, and the surfaces stick where p > 0:

    -A g + A p = -shift where p > 0,    -A g + A p >= -shift elsewhere.

This is a contact with the gap -A g, under the load sum g - force. It is the exact solution for like bodies with a
Poisson's ratio of zero, and leaves only the sideways slip of other bodies. Ciavarella, J. Mech. Phys. Solids 46 (1998);
Jaeger, Arch. Appl. Mech. 68 (1998).

**Nested iteration**, for all other steps: bodies of different elasticity, a shift, a rotation, or a history. The
solution on a grid of half as many cells along each axis is interpolated; it is started in the same way. Interpolated
are the tractions over their bounds (of a step in a history: their change) and the slip, bilinearly among the coarse
cells in contact.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from bem.contact import solve_contact
from bem.contact.grid_workspace import IterationBudget
from bem.contact.nested_iteration import sample
from bem.grid import FloatArray, Grid
from bem.tangential.problem import SlipProblem
from bem.tangential.slip_newton import solve_slip

_JAEGER_TOLERANCE = 1e-2
"""Tolerance of the normal contact of the Jaeger start; affects cost only."""

_COARSE_TOLERANCE = 1e-3
"""Tolerance on coarse grids, near the error of the interpolation to the finer grid; affects cost only."""

_FEWEST_CELLS = 4
"""Cells in contact below which a coarse grid is not used."""


def jaeger_start(problem: SlipProblem) -> FloatArray | None:
    """Return the initial tractions (2, nx, ny) [Pa] of a first straight push.

    Returns None unless the problem has a force other than zero and no imposed displacement.
    """
    force, bound = problem.traction_sum, problem.bound
    if force is None or problem.imposed.any() or not force.any():
        return None
    size = math.hypot(*force)
    direction = force / size
    operator = problem.operator.along((float(direction[0]), float(direction[1])))
    load = (float(bound.sum()) - size) * operator.grid.cell_area
    unused = solve_contact(-operator(bound), operator, load=load, tolerance=_JAEGER_TOLERANCE)
    slips = (unused.pressure <= 0) & (bound > 0)
    slipping = bound + problem.operator.stiffness * np.maximum(unused.gap, 0.0)
    return direction[:, None, None] * np.where(slips, slipping, np.maximum(bound - unused.pressure, 0.0))


def start_from_coarser(problem: SlipProblem, previous: FloatArray | None, budget: IterationBudget) -> FloatArray:
    """Return the initial tractions (2, nx, ny) [Pa] by nested iteration; the previous ones if the grid is too small.

    previous : (2, nx, ny), tractions of the previous step of a history [Pa]; None for a first step.
    """
    grid = problem.operator.grid
    before = np.zeros((2, *grid.shape)) if previous is None else previous
    coarse = _coarse_problem(problem)
    if coarse is None:
        return before
    coarse_before = _restrict(before, coarse.operator.grid.shape, grid)
    start = start_from_coarser(coarse, None if previous is None else coarse_before, budget)
    result = solve_slip(coarse, start, _COARSE_TOLERANCE, budget)
    cells = result.cells
    fields = np.zeros((4, *cells.shape))
    fields[:2, cells] = (result.traction - coarse_before[:, cells]) / coarse.bound[cells]
    fields[2:, cells] = np.where(result.slips, result.displacement_residual, 0.0)
    fine = _interpolate_in_contact(fields, cells, grid)
    start = before + fine[:2] * problem.bound + fine[2:] * problem.operator.stiffness
    return np.where(problem.bound > 0, start, 0.0)


def _coarse_problem(problem: SlipProblem) -> SlipProblem | None:
    """Return the problem on a grid of half as many cells along each axis; None if too few cells are in contact."""
    operator, grid = problem.operator.coarsened(), problem.operator.grid
    if operator is None or operator.grid.cells == grid.cells:
        return None
    bound = np.maximum(sample(problem.bound, operator.grid.shape, grid.periodic), 0.0)
    if np.count_nonzero(bound) < _FEWEST_CELLS:
        return None
    imposed = _restrict(problem.imposed, operator.grid.shape, grid)
    # the force remains the same fraction of what friction can carry
    traction_sum = None if problem.traction_sum is None else problem.traction_sum * (bound.sum() / problem.bound.sum())
    return replace(problem, operator=operator, bound=bound, imposed=imposed, traction_sum=traction_sum)


def _restrict(field: FloatArray, shape: tuple[int, int], grid: Grid) -> FloatArray:
    """Restrict a field (2, nx, ny) to a coarser grid."""
    return np.stack([sample(component, shape, grid.periodic) for component in field])


def _interpolate_in_contact(fields: FloatArray, cells: NDArray[np.bool_], grid: Grid) -> FloatArray:
    """Interpolate fields (m, nx, ny) bilinearly among the coarse cells in contact; zero where there are none."""
    weighted = np.concatenate([np.where(cells, fields, 0.0), cells[None].astype(np.float64)])
    for axis in (1, 2):
        before, after, weight = _linear_weights(weighted.shape[axis], grid.shape[axis - 1], grid.periodic[axis - 1])
        weight = weight[:, None] if axis == 1 else weight
        weighted = weighted.take(before, axis) * (1 - weight) + weighted.take(after, axis) * weight
    total = weighted[-1]
    return np.where(total > 0, weighted[:-1] / np.where(total > 0, total, 1.0), 0.0)


def _linear_weights(cells: int, onto: int, periodic: bool) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """Return the coarse points before and after each fine point of an axis, and the weight of the second."""
    position = np.arange(onto) * (cells / onto if periodic else 0.5 if onto > cells else 1.0)
    before = np.floor(position).astype(np.int64)
    after = (before + 1) % cells if periodic else np.minimum(before + 1, cells - 1)
    return before, after, position - before
