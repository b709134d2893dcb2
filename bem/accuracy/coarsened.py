"""Problems on coarser grids: a contact on twice the cell, meshes of half the points, and what such grids resolve.

The grid of twice the cell takes every second height, so that a band-limited surface stays the same. On a free axis of
an even number of cells it ends elsewhere by half a cell: means over the grid are compared over the same points.

Knows contacts and grids; films and loops are solved anew by the modules of their kinds. Verified in
tests/accuracy/test_contact_bars.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.accuracy.richardson import Regime
from bem.contact import ContactSolution, solve_contact
from bem.contact.certificate import free_edges_reached
from bem.contact.nested_iteration import sample
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, Status
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar
from bem.numerics import blocks

COARSER_TOLERANCE = 1e-6
"""Tolerance of the coarser contact: far below the differences between the grids."""
_RESOLVED = 0.7
"""Relative change of the curvature from cell to cell (rms) up to which twice the cell resolves a surface: it is
2 sin(pi / n) of waves of n cells, so that the shortest wave has some 9 cells, 5 on the coarser grid."""
_SAMPLED = 1.1
"""Relative change of the curvature up to which a surface has no waves shorter than four cells: 340 generated surfaces
had at most 1.03 with such waves alone, and at least 1.17 with shorter ones."""
_BENDS = 0.1
"""Part of the curvature (squared) from which an axis counts in the smoothness of a surface."""
SPOT = 6.0
"""Cells across the mean spot, 4 area / perimeter, from which on contact areas are of second order."""
_FEWEST_ACROSS = 3
"""Cells across a contact, below which the grid of twice the cell has the same one to four cells in contact and the
difference says nothing: under balls the highest pressure was 5 to 99 % low there."""


@dataclass(frozen=True)
class ContactCase:
    """A solved contact: operator, undeformed gap (nx, ny) [m], solution, and what was prescribed.

    from_touch : the undeformed gap is zero at first touch, which another grid finds elsewhere.
    """

    operator: DisplacementOperator
    undeformed: FloatArray
    solution: ContactSolution
    load: float | None = None
    approach: float | None = None
    mean_gap: float | None = None
    hardness: float | None = None
    from_touch: bool = False

    @property
    def prescribed(self) -> tuple[str, ...]:
        """Names of the figures that were prescribed."""
        return tuple(name for name in ("load", "approach", "mean_gap") if getattr(self, name) is not None)

    @property
    def grid(self) -> Grid:
        """Grid of the contact."""
        return self.operator.grid


@dataclass(frozen=True)
class Coarser:
    """The contact on the grid of twice the cell, or the reason why there is none.

    nested : each cell is four of the finer grid, over the same rectangle.
    """

    grid: Grid | None
    solution: ContactSolution | None
    why: NoBar = NoBar.COARSER_UNSOLVED
    nested: bool = False


def coarser_before(case: ContactCase, solution: ContactSolution) -> Coarser | None:
    """Return the contact as it was solved before each cell was cut in four; None where that solution cannot serve."""
    (nx, ny), (dx, dy) = case.grid.shape, case.grid.spacing
    halved = solution.pressure.shape == (nx / 2, ny / 2) and solution.status is Status.CONVERGED
    periodic = case.grid.periodic
    if not halved or any(free_edges_reached(periodic, each.pressure) for each in (solution, case.solution)):
        return None
    grid = Grid((nx // 2, ny // 2), (2 * dx, 2 * dy), periodic=case.grid.periodic)
    return Coarser(grid, solution, nested=True)


def solve_coarser(case: ContactCase, max_iterations: int = 2000) -> Coarser:
    """Solve the case on the grid of twice the cell, from its own pressure."""
    if free_edges_reached(case.grid.periodic, case.solution.pressure):
        return Coarser(None, None, NoBar.FREE_EDGE)
    if is_narrow(case):
        return Coarser(None, None, NoBar.FEW_CELLS_WIDE)
    problem = coarser_problem(case)
    if problem is None:
        return Coarser(None, None, NoBar.TOO_SMALL)
    gap, operator = problem
    grid = operator.grid
    mean_gap = case.mean_gap
    if mean_gap is not None and not all(grid.periodic):
        mean_gap = mean_opening(sample(case.solution.gap, grid.shape, grid.periodic))
    start: FloatArray | None = np.clip(sample(case.solution.pressure, grid.shape, grid.periodic), 0.0, case.hardness)
    for _ in range(2):  # the second time by nested iteration, where the first start does not converge
        try:
            solution = solve_contact(
                gap,
                operator,
                load=case.load,
                approach=case.approach,
                mean_gap=mean_gap,
                hardness=case.hardness,
                tolerance=COARSER_TOLERANCE,
                initial_pressure=start,
                max_iterations=max_iterations,
            )
        except InfeasibleError:  # an approach in full contact, a mean gap that other cells do not have
            return Coarser(None, None, NoBar.IMPOSSIBLE)
        if solution.status is Status.CONVERGED:
            return Coarser(grid, solution)
        start = None
    return Coarser(None, None, NoBar.COARSER_UNSOLVED)


def coarser_problem(case: ContactCase) -> tuple[FloatArray, DisplacementOperator] | None:
    """Return undeformed gap [m] and operator on the grid of twice the cell; None of grids too small for one."""
    operator = case.operator.coarsened()
    if operator is None:
        return None
    gap = sample(case.undeformed, operator.grid.shape, operator.grid.periodic)
    return gap - gap.min() if case.from_touch else gap, operator


def is_narrow(case: ContactCase) -> bool:
    """Return True if all that touches is one or two cells wide along an axis that it does not fill."""
    touching = case.solution.pressure > 0
    widths = [int(np.count_nonzero(touching.any(axis=1 - axis))) for axis in (0, 1)]
    return any(0 < width < min(_FEWEST_ACROSS, n) for width, n in zip(widths, case.grid.shape, strict=True))


def half_grid(grid: Grid) -> Grid:
    """Return the grid of every second cell along either axis, twice as wide; an odd number of periodic cells is halved
    and rounded up, over the same length."""
    shape, spacing = [], []
    for n, d, periodic in zip(grid.shape, grid.spacing, grid.periodic, strict=True):
        few = (n + 1) // 2
        shape.append(few)
        spacing.append(n * d / few if periodic else 2 * d if n > 1 else d)
    return Grid((shape[0], shape[1]), (spacing[0], spacing[1]), periodic=grid.periodic)


def other_points(points: int, fewest: int) -> int:
    """Return half of the points of a mesh; twice as many where half are fewer than `fewest`."""
    return points // 2 if points >= 2 * fewest else 2 * points


def regime_of(case: ContactCase) -> Regime:
    """Return how well the grid of twice the cell represents the contact: surface and spots."""
    solution = case.solution
    across = 4 * solution.contact_area / solution.contact_perimeter if solution.contact_perimeter > 0 else math.inf
    if surface_is_resolved(case.undeformed, case.grid) and across > SPOT * edge_cell(solution.pressure, case.grid):
        return Regime.RESOLVED
    return Regime.SAMPLED if _is_smooth(case.undeformed, case.grid, _SAMPLED) else Regime.UNRESOLVED


def surface_is_resolved(gap: FloatArray, grid: Grid) -> bool:
    """Return True if the grid of twice the cell resolves the surface: its curvature changes little from cell to
    cell."""
    return _is_smooth(gap, grid, _RESOLVED)


def _is_smooth(gap: FloatArray, grid: Grid, most: float) -> bool:
    """Return True if the curvature of a surface changes from cell to cell by at most this fraction of itself (rms).

    Where cells are longer along one axis, the surface is as smooth as along the axis of the largest changes.
    """
    turns, bends = np.zeros(2), np.zeros(2)
    for axis in (0, 1):
        n = grid.shape[axis]
        if n < 4:
            continue
        lines, square, across = np.moveaxis(gap, axis, 0), grid.spacing[axis] ** 2, gap.size // n
        for first, last in blocks.row_blocks(lines.shape):
            second = np.diff(lines[first : last + 3], 2, axis=0) / square  # one more than those of the block
            third = np.diff(second, axis=0)
            bends[axis] += float(np.sum(second[: last - first] ** 2)) / ((n - 2) * across)
            turns[axis] += float(np.sum(third[: last - first] ** 2)) / ((n - 3) * across)
    if grid.spacing[0] == grid.spacing[1]:
        return bool(turns.sum() <= most**2 * bends.sum())
    counts = bends >= _BENDS * bends.sum()
    return bool(np.all(turns[counts] <= most**2 * bends[counts]))


def edge_fraction(case: ContactCase) -> float:
    """Return the fraction of the contact area within a cell of its edge, 4 cells over the width of the mean spot."""
    solution = case.solution
    if not solution.contact_area > 0:
        return 0.0
    cell = edge_cell(solution.pressure, case.grid)
    return solution.contact_perimeter * cell / solution.contact_area


def edge_cell(pressure: FloatArray, grid: Grid, above: float = 0.0) -> float:
    """Return the width of cells by which the edge of the region under more than a pressure errs [m].

    Each face between a cell inside and one outside has a cell beside it that is dx wide across faces of length dy, and
    dy across those of length dx. The mean of these widths counts, and where most faces are crossed along one axis, so
    that the region has fewest cells along it, the width along this axis. That is the wider cell of spots that are as
    long as wide, dx alone under a cylinder along y, and the width of square cells.

    pressure : (nx, ny) [Pa]. above : pressure that the region exceeds [Pa].
    """
    dx, dy = grid.spacing
    if dx == dy:
        return dx
    region = pressure > above
    along_x, along_y = (int(np.count_nonzero(np.diff(region, axis=axis))) for axis in (0, 1))
    if not along_x + along_y:
        return widest_cell(grid)
    lengths = along_x * dy, along_y * dx
    return dx * dy * max((along_x + along_y) / sum(lengths), max(along_x, along_y) / max(lengths))


def widest_cell(grid: Grid) -> float:
    """Return the largest spacing of a grid [m]; an axis of a single cell does not count beside a longer one."""
    return max(d for n, d in zip(grid.shape, grid.spacing, strict=True) if n > 1 or max(grid.shape) == 1)


def mean_opening(gap: FloatArray) -> float:
    """Return the mean of the positive part of a gap."""
    return blocks.mean(gap, lambda block: np.maximum(block, 0))
