"""From a judged round to the pressures that close the gap, on cells that fit one block of `passes`: two compiled calls.

The same passes in the same order as `face.take_in` and `face.solve_on_cells` make one by one; verified against them in
tests/contact/test_contact_passes.py. On grids of some hundred cells a side the calls themselves, with the objects
between them, take as long as what they do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import face, gradients, inner, long_waves, passes, preconditioner, sets
from bem.contact.controls import ApproachControl, Control, LoadControl
from bem.contact.inner import Ends
from bem.contact.inverse import Inverse
from bem.contact.judging import CAPPED, CONTACT
from bem.contact.level import Effort, Iterate, Level
from bem.contact.patterns import NEIGHBOURS
from bem.threads import threads_for

FloatArray = NDArray[np.float64]


_NO_RISE = np.empty(0, np.int64), np.empty(0), 0.0
"""Where nothing is balanced."""


def fits(level: Level, iterate: Iterate, found: NDArray[np.int32], control: Control) -> bool:
    """Whether a round can be made so: one thread's cells in one block, rows packed, and a load or an approach given
    where the contact is not full, which has ways of its own."""
    count = iterate.cells.size + found.size
    if not 1 < count <= passes.BLOCK or threads_for(level.quick.transform.entries) != 1:
        return False
    full = count == level.gap.size and level.operator.mean_free and isinstance(control, ApproachControl)
    return not full and level.rows_of_inverse().patterns.offsets.shape[0] == NEIGHBOURS


def close(
    level: Level,
    iterate: Iterate,
    found: NDArray[np.int32],
    approach: float,
    control: Control,
    goal: float,
    effort: Effort,
) -> tuple[Iterate, FloatArray]:
    """The cells in contact with those found, and pressures without bounds that bring the gap there nearer to zero."""
    loaded = isinstance(control, LoadControl)
    iterate, opening, rise = _taken_in(level, iterate, found, approach, loaded)
    assert level.near is not None
    cells, near = level.near
    tuning, stride, quick, smooth = level.tuning, level.stride, level.quick, level.smooth
    if loaded and not rise[1] > 0:
        far = None if smooth is None else smooth.on(cells, near.row_sums())
        rise = face.first_rise(Inverse(near, far, np.empty(cells.size)), rise[0])
    coarse = None if smooth is None else smooth.convolution
    with quick.transform.lock, quick.transform.lock if coarse is None else coarse.transform.lock:
        raw, made, length, strode, on_coarse, applied = _close(
            (cells, iterate.values, opening.values, opening.mean),
            (near.rows, near.seam, near.outside),
            None if smooth is None else smooth.compiled(),
            rise,
            (level.quick_field, quick.compiled()),
            (tuning.reduction**2, tuning.least_reduction**2, tuning.final * goal),
            (tuning.clipping * level.self_response, face.LEFT, face.LEFT_AT_LAST, level.cap),
            (min(tuning.iterations_per_round, effort.left), stride.trusted, stride.length),
        )
    quick.counted(int(applied))
    if coarse is not None:
        coarse.counted(int(on_coarse))
    if loaded:
        level.rise = cells, *rise
    effort.iterations += int(made)
    stride.length, stride.taken = length, strode == 1
    return iterate, raw


def _taken_in(
    level: Level, iterate: Iterate, found: NDArray[np.int32], approach: float, loaded: bool
) -> tuple[Iterate, face.Opening, tuple[FloatArray, float]]:
    """The cells with those found, the gap there, and the last round's rise carried to them; the level has G's rows."""
    sparse = level.rows_of_inverse()
    known = sparse.patterns
    gathered, rows, seam, unsolved, rise = _gather(
        (iterate.cells, iterate.values),
        found,
        (level.state, level.cap),
        (level.flat["displacement"], level.gap, approach),
        (*sparse.shape, *sparse.periodic),
        (known.offsets, known.solved),
        level.rise or _NO_RISE,
        loaded,
    )
    known.solve(rows[2], unsolved=unsolved)
    cells, values, residual, mean = gathered
    level.near = cells, sparse.of_rows(rows, seam)
    capped = iterate.capped
    if capped.size:
        level.state[found] = CONTACT
        capped = capped[level.state[capped] == CAPPED]
    return Iterate(cells, values, capped), face.Opening(residual, mean), rise


@compiled
def _gather(old, found, states, surface, grid, known, last, loaded):
    """`sets.merge`; the rows of the sparse inverse on the cells as `SparseInverse.on` has them: first neighbours and
    patterns; cells of the seam, columns, patterns; whether a pattern is unsolved; and `gradients.carry`."""
    offsets, solved = known
    cells, values, residual, mean = sets.merge(old, found, states[0], states[1], surface)
    n = cells.size
    upper, lower, pattern = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    listed, lines = np.empty(n, np.int32), np.empty(grid[0] + 1, np.int32)
    counted = np.zeros(2)
    preconditioner._connect(0, n, counted, cells, grid, solved, (upper, lower, pattern, listed, lines))
    listed = listed[: int(counted[0])].copy()
    columns, own = np.empty((listed.size, offsets.shape[0]), np.int32), np.empty(listed.size, np.int32)
    more = preconditioner._look_up((cells, lines), grid, offsets, solved, listed, columns, own, pattern)
    rise, total = np.empty(n if loaded else 0), 0.0
    if loaded:
        total = gradients.carry(last[0], last[1], last[2], cells, rise)
    unsolved = more or counted[1] != 0
    return (cells, values, residual, mean), (upper, lower, pattern), (listed, columns, own), unsolved, (rise, total)


@compiled
def _close(given, near, far, rise, quick, shares, stops, first):
    """Conjugate gradients with all that they begin with: pressures, iterations, the last step's length, whether that
    was known beforehand, convolutions of long waves and of the grid.

    given : cells, pressures, gap there (overwritten), and its mean. rise : as `face.Balance` has it, and its sum; empty
    where the mean stays. shares : of the sum of squares, two of `Ends`, and its goal. stops : others of its numbers,
    and the cap. first : iterations at most, whether a step's length is known beforehand, and that length.
    """
    cells, values, residual, mean = given
    n, found, loaded = cells.size, np.zeros(3), rise[0].size > 0
    pressure = values.copy()
    if loaded:
        for k in range(n):
            residual[k] -= mean
    gradients._squares(0, n, found, residual)
    squares = found[0]
    inverted = (near[0], near[1], near[2], np.empty(n)), _far_on(far, cells, near[0])
    balance = rise[0], 1 / rise[1] if loaded else 0.0, np.empty(rise[0].size)
    way = np.zeros((4, n))
    vectors = pressure, residual, way[0], way[1], way[2], way[3]
    clipping, left, left_at_last, cap = stops
    lowest, enough = squares * shares[0], squares * shares[1]
    ends = Ends(lowest, enough, shares[2], clipping, first[0], first[1], left, left_at_last)
    now = np.array([0.0, 0.0, np.inf, 0.0, squares, first[2], 0.0, 0.0, 0.0])
    inner._iterate(now, inverted, vectors, balance, cells, quick[0], quick[1], ends, cap, True)
    reached = way[3] if now[inner._STRODE] else pressure
    made, length, strode = now[inner._MADE], now[inner._LENGTH], now[inner._STRODE]
    return reached, made, length, strode, now[inner._COARSE], now[inner._APPLIED]


@compiled
def _far_on(far, cells, rows):
    """The long waves on the cells, as `long_waves._apply` takes them; none where there are none."""
    if far is None:
        return None
    (lines, columns, width), workspace, engine = far
    weights, blocks = np.empty(cells.size), np.empty(cells.size, np.int32)
    preconditioner._row_sums(rows, weights)
    root, inverse_root = np.zeros(workspace.given.size), np.zeros(workspace.given.size)
    long_waves._assign(cells, lines, columns, width, weights, blocks, root, inverse_root)
    return (blocks, weights), (root, inverse_root), workspace, engine
