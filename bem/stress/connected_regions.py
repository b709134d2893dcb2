"""Von Mises stress of the regions above a limit that are connected to the surface.

A region above the limit that starts at the first depth extends from row to row (along y) and from depth to depth. Rows
are computed in groups of `loops.GROUP`: all groups of the first depth, then the groups beside a row above the limit, at
its depth and at the neighbouring depths, until no group is left. Five transforms along x serve all rows of a depth;
transforms along y are made for the requested groups only, half of them in a rough contact.

The result is exact: a row that is left out touches no row above the limit that is connected to the surface. Verified
in tests/stress/test_connected_regions.py against whole planes.
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
from bem.transforms.count import COUNT
from bem.transforms.loops import GROUP, Squares, term_of_group

_WEIGHTS = np.array(VON_MISES_WEIGHTS[1:])
_TERMS = len(_WEIGHTS)


@dataclass(frozen=True, eq=False)
class ReachedStress:
    """Von Mises stress of the first depths.

    planes : (nz, nx, ny) [Pa], undefined in rows that were left out; `cleared` writes zeros there.
    computed : (nz, nx) True for rows that were computed.
    exceeding : (nx, ny) True where the limit is exceeded at any depth.
    passes : number of passes along x: one for each depth, and one for each return from a deeper depth.
    """

    planes: FloatArray
    computed: NDArray[np.bool_]
    exceeding: NDArray[np.bool_]
    passes: int


def reached_stress(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    limit: float,
    *,
    friction: float = 0.0,
    reach: int = 1,
) -> ReachedStress:
    """Compute von Mises stress in and around the regions above a limit that are connected to the first depth.

    Parameters
    ----------
    pressure, grid, body, friction : as in `subsurface_stress`.
    depths : (nz,) [m], rising.
    limit : von Mises stress [Pa].
    reach : number of depths above and below a row above the limit at which the row and its neighbours are computed.

    Raises
    ------
    InputError : as `subsurface_stress`.
    """
    request = StressRequest.of("reached_stress", pressure, grid, body, depths, friction)
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
        if threads_for(transform.entries) == 1:
            squares.begun[:] = np.logical_or.reduceat(missing, starts)
        _transform_along_x(load, request.depths[index], squares, stress[index])
        passes += 1
        rows = requested[index], computed[index], exceeding
        done, beside = _follow_rows(transform.plan, transform.singles, squares, stress[index], limit, wraps, *rows)
        COUNT.rows += done * _TERMS
        for other in range(max(index - reach, 0), min(index + reach + 1, number)):
            requested[other] |= beside
            if (requested[other] & ~computed[other]).any():
                waiting.add(other)
    used = int(computed.any(axis=1).sum())
    return ReachedStress(stress[:used], computed[:used], exceeding, passes)


def cleared(planes: FloatArray, rows: NDArray[np.bool_]) -> FloatArray:
    """Return the planes (nz, nx, ny) after zeros were written into all rows but `rows` (nz, nx)."""
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
    """Transform the five terms of von Mises stress at a depth along x."""
    spectra = load.spectra(depth)
    squares.columns[:] = spectra.columns[1:]
    factors = tuple(one.factor(load.transform.dtype) for one in spectra.multipliers[1:])
    load.transform.terms_back(load.spectrum, factors, squares, (0, _TERMS), out)


@compiled
def _follow_rows(room, singles, squares, out, limit, wraps, requested, computed, exceeding):
    """Compute the groups with a requested row, then the groups beside rows above the limit, until none is left.

    Returns the number of computed rows, and (nx,) True for rows above the limit and their neighbours. `exceeding`
    receives the points above the limit.
    """
    nx, done, again = room.nx, 0, True
    beside = np.zeros(nx, np.bool_)
    while again:
        again = False
        for start in range(0, nx, GROUP):
            stop = min(nx, start + GROUP)
            if computed[start] or not requested[start:stop].any():
                continue
            if not squares.begun[start // GROUP]:
                for term in range(squares.weights.size):
                    term_of_group(room, singles, squares, term, start // GROUP, out)
            again = True
            done += stop - start
            for i in range(start, stop):
                computed[i] = True
                above = 0
                for j in range(room.ny):
                    over = not out[i, j] <= limit  # true for a value that is not a number
                    above += over
                    exceeding[i, j] |= over
                if above > 0:
                    for k in range(i - 1, i + 2):
                        if wraps or 0 <= k < nx:
                            beside[k % nx] = requested[k % nx] = True
    return done, beside
