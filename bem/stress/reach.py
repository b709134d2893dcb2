"""Von Mises stress where what exceeds a limit from the surface down can reach, and nowhere else.

A region that exceeds a limit and begins at the first depth goes on from row to row (along y) and from depth to depth.
Rows are computed by groups of `loops.GROUP`: all of the first depth, then those beside a row that exceeds the limit,
at its depth and at as many above and below as asked for, until there are none left. Five transforms along x serve all
rows of a depth; those along y are done for the rows asked for, half of them in a rough contact.

Nothing is estimated: a row that is left out touches none that exceeds the limit and is connected to the surface.
Verified in tests/stress/test_reach.py against whole planes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.sweeps import SHARES, Part, Sweep
from bem.threads import threads_for
from bem.transforms.count import COUNT
from bem.transforms.loops import GROUP, Squares, term_of_group

_WEIGHTS = np.array(SHARES[1:])
_TERMS = len(_WEIGHTS)


@dataclass(frozen=True, eq=False)
class ReachedStress:
    """Von Mises stress of the first depths.

    planes : (nz, nx, ny) [Pa], anything in rows that were left out (`cleared` writes zeros there). computed : (nz, nx)
    rows that were computed. exceeding : (nx, ny) whether the limit is exceeded at any depth. passes : depths whose
    transforms along x were made, those made twice, for rows that only a deeper one led to, counted twice.
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
    """Von Mises stress wherever a region above the limit that begins at the first depth can be, and around it.

    Parameters
    ----------
    pressure, grid, body, friction : as in `subsurface_stress`.
    depths : (nz,) [m], rising.
    limit : [Pa].
    reach : depths above and below a row that exceeds the limit that are computed in it and in those beside it.

    Raises
    ------
    InputError : as `subsurface_stress`.
    """
    sweep = Sweep.of("reached_stress", pressure, grid, body, depths, friction)
    (part,) = sweep.parts
    transform, number, wraps = part.transform, len(sweep.depths), grid.periodic[0]
    stress = np.empty((number, *grid.shape))
    wanted, computed = np.zeros((2, number, grid.shape[0]), np.bool_)
    exceeding = np.zeros(grid.shape, np.bool_)
    wanted[:1] = True
    squares = transform.empty_squares(_WEIGHTS)
    passes, waiting, starts = 0, {0} if number else set(), _starts(grid)
    while waiting:
        index = min(waiting)
        waiting.remove(index)
        asked = wanted[index] & ~computed[index]
        if threads_for(transform.entries) == 1:
            squares.begun[:] = np.logical_or.reduceat(asked, starts)
        _along_x(part, sweep.depths[index], squares, stress[index])
        passes += 1
        rows = wanted[index], computed[index], exceeding
        done, beside = _spread(transform.room, transform.singles, squares, stress[index], limit, wraps, *rows)
        COUNT.rows += done * _TERMS
        for other in range(max(index - reach, 0), min(index + reach + 1, number)):
            wanted[other] |= beside
            if (wanted[other] & ~computed[other]).any():
                waiting.add(other)
    used = int(computed.any(axis=1).sum())
    return ReachedStress(stress[:used], computed[:used], exceeding, passes)


def cleared(planes: FloatArray, rows: NDArray[np.bool_]) -> FloatArray:
    """Planes (nz, nx, ny) with zeros written into all but these rows (nz, nx)."""
    _clear(planes, rows)
    return planes


def _starts(grid: Grid) -> NDArray[np.intp]:
    """The first row of each group."""
    return np.arange(0, grid.shape[0], GROUP)


@compiled
def _clear(stress, computed):
    """Zeros in rows that were not computed."""
    nz, nx, ny = stress.shape
    for k in range(nz):
        for i in range(nx):
            if not computed[k, i]:
                for j in range(ny):
                    stress[k, i, j] = 0.0


def _along_x(part: Part, depth: float, squares: Squares, out: FloatArray) -> None:
    """The terms of von Mises stress at a depth, along x."""
    factors = part.factors(depth)
    squares.columns[:] = factors.columns[1:]
    steps = [(0, _TERMS)] if len(part.workspace) == 0 else [(term, term + 1) for term in range(_TERMS)]
    for first, last in steps:
        # what is unpacked lies in the workspace until the next one is
        parts = {term: factors.multiplier(term + 1, part.workspace) for term in range(first, last)}
        given = tuple(parts.get(term, parts[first]).factor(part.transform.dtype) for term in range(_TERMS))
        part.transform.terms_back(part.spectrum, given, squares, (first, last), out)


@compiled
def _spread(room, singles, squares, out, limit, wraps, wanted, computed, exceeding):
    """Compute the groups with a row that is wanted, then those beside rows above the limit, which is noted point by
    point: how many rows, and which are, or are beside, rows above the limit."""
    nx, done, again = room.nx, 0, True
    beside = np.zeros(nx, np.bool_)
    while again:
        again = False
        for start in range(0, nx, GROUP):
            stop = min(nx, start + GROUP)
            if computed[start] or not wanted[start:stop].any():
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
                    over = not out[i, j] <= limit  # what is no number, too
                    above += over
                    exceeding[i, j] |= over
                if above > 0:
                    for k in range(i - 1, i + 2):
                        if wraps or 0 <= k < nx:
                            beside[k % nx] = wanted[k % nx] = True
    return done, beside
