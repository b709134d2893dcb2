"""Von Mises stress of the regions above a limit that are connected to the surface; other rows are not computed.

Rows (constant x) are computed in groups of eight (`transforms.loops.GROUP`). The queue holds pairs of a depth and a
group.

1. Queue all groups of the first depth: a region that is connected to the surface has points there.
2. Take the shallowest depth of the queue. Transform the five terms of its von Mises stress along x. Cost: five passes
   along x over all columns.
3. Transform its queued groups along y and add the squares. Cost: half of the rows of a rough contact over all depths.
4. Queue the groups beside a row with points above the limit, at its own depth and at `depths_beside` depths above and
   below.
5. Repeat from step 3 at the same depth, then from step 2, until the queue is empty.

The result is exact: every row beside a row above the limit that is connected to the first depth is computed, so a row
that is left out is not part of such a region. A flood fill by rows; this project's own. Verified in
tests/stress/test_connected_regions.py against whole planes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.request import VON_MISES_WEIGHTS, StressRequest, TransformedLoad
from bem.threads import threads_for
from bem.transforms.count import COUNT as TRANSFORM_COUNT
from bem.transforms.loops import GROUP, Squares, term_of_group

_WEIGHTS = np.array(VON_MISES_WEIGHTS[1:])
"""Weights of the squares of d, e, yz, xz, xy."""
_TERMS = len(_WEIGHTS)
"""Number of terms of von Mises stress."""


@dataclass(frozen=True, eq=False)
class ConnectedStress:
    """Von Mises stress around the regions above a limit, down to the deepest depth they can reach.

    planes : (nz, nx, ny) [Pa], not set in rows that were not computed; `clear_other_rows` writes zeros there.
    computed : (nz, nx) True for rows that were computed.
    exceeding : (nx, ny) True where the limit is exceeded at any depth in a row that was computed.
    passes : number of passes along x: one for each depth, and one for each return from a deeper depth.
    """

    planes: FloatArray
    computed: NDArray[np.bool_]
    exceeding: NDArray[np.bool_]
    passes: int


def connected_stress(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    limit: float,
    *,
    friction: float = 0.0,
    depths_beside: int = 1,
) -> ConnectedStress:
    """Compute von Mises stress in and around the regions above a limit that are connected to the first depth.

    Parameters
    ----------
    pressure, grid, body, friction : as in `subsurface_stress`.
    depths : (nz,) [m], rising.
    limit : von Mises stress [Pa].
    depths_beside : number of depths above and below a row above the limit at which it and its neighbours are computed.

    Raises
    ------
    InputError : as `subsurface_stress`.
    """
    request = StressRequest.of("connected_stress", pressure, grid, body, depths, friction)
    if any(request.residual):
        return _whole_planes(request, limit, depths_beside)
    (load,) = request.loads
    transform, number, wraps = load.transform, len(request.depths), grid.periodic[0]
    stress = np.empty((number, *grid.shape))
    requested, computed = np.zeros((2, number, grid.shape[0]), np.bool_)
    exceeding = np.zeros(grid.shape, np.bool_)
    requested[:1] = True
    squares = transform.empty_squares(_WEIGHTS)
    passes, waiting, starts = 0, {0} if number else set(), _starts(grid)
    while waiting:
        index = min(waiting)
        waiting.remove(index)
        missing = requested[index] & ~computed[index]
        if threads_for(transform.entries) == 1:  # step 2 adds the squares of requested groups while they are in cache
            squares.begun[:] = np.logical_or.reduceat(missing, starts)
        _transform_along_x(load, request.depths[index], squares, stress[index])
        passes += 1
        rows = requested[index], computed[index], exceeding
        done, beside = _follow_rows(
            transform.plan, transform.single_column_plans, squares, stress[index], limit, wraps, *rows
        )
        TRANSFORM_COUNT.rows += done * _TERMS
        for other in range(max(index - depths_beside, 0), min(index + depths_beside + 1, number)):
            requested[other] |= beside
            if (requested[other] & ~computed[other]).any():
                waiting.add(other)
    used = int(computed.any(axis=1).sum())
    return ConnectedStress(stress[:used], computed[:used], exceeding, passes)


def _whole_planes(request: StressRequest, limit: float, depths_beside: int) -> ConnectedStress:
    """Compute whole planes to the first without a point above the limit, and `depths_beside` - 1 below it."""
    number, shape = len(request.depths), request.grid.shape
    planes, exceeding, last = np.empty((number, *shape)), np.zeros(shape, np.bool_), number - 1
    index = 0
    while index <= last:
        request.write_von_mises(index, planes[index])
        above = ~(planes[index] <= limit)
        exceeding |= above
        if not above.any():
            last = min(last, index + depths_beside - 1) if index > 0 else index
        index += 1
    return ConnectedStress(planes[:index], np.ones((index, shape[0]), np.bool_), exceeding, index)


def clear_other_rows(planes: FloatArray, rows: NDArray[np.bool_]) -> FloatArray:
    """Write zeros into the rows of the planes (nz, nx, ny) that are not in `rows` (nz, nx), and return the planes."""
    _clear(planes, rows)
    return planes


def _starts(grid: Grid) -> NDArray[np.intp]:
    """Return the number of the first row of each group."""
    return np.arange(0, grid.shape[0], GROUP)


@compiled
def _clear(stress, computed):
    """Write zeros into rows that were not computed."""
    nz, nx, ny = stress.shape
    for k in range(nz):
        for i in range(nx):
            if not computed[k, i]:
                for j in range(ny):
                    stress[k, i, j] = 0.0


def _transform_along_x(load: TransformedLoad, depth: float, squares: Squares, out: FloatArray) -> None:
    """Transform the five terms of von Mises stress at a depth along x (step 2).

    Squares of the groups marked in `squares.begun` are added in the same pass.
    """
    spectra = load.spectra(depth)
    squares.columns[:] = spectra.columns[1:]
    factors = tuple(one.factor(load.transform.dtype) for one in spectra.multipliers[1:])
    load.transform.terms_back(load.spectrum, factors, squares, (0, _TERMS), out)


@compiled
def _follow_rows(plan, singles, squares, out, limit, wraps, requested, computed, exceeding):
    """Compute the groups with a requested row and the groups beside rows above the limit (steps 3 and 4).

    Returns the number of computed rows, and (nx,) True for rows above the limit and their neighbours. `requested` and
    `computed` (nx,) are updated; `exceeding` (nx, ny) receives the points above the limit.
    """
    nx, done, again = plan.nx, 0, True
    beside = np.zeros(nx, np.bool_)
    while again:
        again = False
        for start in range(0, nx, GROUP):
            stop = min(nx, start + GROUP)
            if computed[start] or not requested[start:stop].any():
                continue
            if not squares.begun[start // GROUP]:
                for term in range(squares.weights.size):
                    term_of_group(plan, singles, squares, term, start // GROUP, out)
            again = True
            done += stop - start
            for i in range(start, stop):
                computed[i] = True
                above = 0
                for j in range(plan.ny):
                    over = not out[i, j] <= limit  # true for a value that is not a number
                    above += over
                    exceeding[i, j] |= over
                if above > 0:
                    for k in range(i - 1, i + 2):
                        if wraps or 0 <= k < nx:
                            beside[k % nx] = requested[k % nx] = True
    return done, beside
