"""Newton's equations of a line contact with hierarchical weights: block elimination from the leaves up.

Woodbury's formula joins every pair of neighbours; H0, X_e and the exit's film are a border. Row i goes with P_i: in the
Hertz zone the Couette flow out of cell i is that of nodes i and i - 1, where pressure drives the flow it is integrated
from the exit backwards, which is the stable direction. So every diagonal block is the film problem of a piece of the
contact and well conditioned.

Nodes 1 .. n-1 are filled up to leaves of equal size; what is filled up has a one on the diagonal and nothing else.
What it buys (the benchmark's rows `line-film` and `line-film-dense`): the same film in the same steps, at the default
of 2000 nodes for 20 instead of 2,700 million multiplications a step and 4 MB of weights instead of 32, in a tenth of
the time; at 1000 for 7 instead of 340, in a third. At 500 it is as good. Verified in
tests/lubrication/test_line_operator.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, Level, LineOperator
from bem.lubrication.line.equations import Equations

BORDER = 3
"""Columns that are solved for besides those of the levels: datum, exit, the exit's film."""


@dataclass(frozen=True)
class Rows:
    """Coefficients of rows 1 .. n-1, filled up: of the films at nodes i - 1, i, i + 1, and of the pressures there in
    their unit. elastic : what a unit of pressure times a weight does to a film."""

    before: FloatArray
    here: FloatArray
    after: FloatArray
    low: FloatArray
    diagonal: FloatArray
    high: FloatArray
    elastic: float

    def of_films(self, weights: FloatArray, clusters: int) -> FloatArray:
        """What pressures do to the rows through the films: weights (clusters, rows + 2, k), one row more at each end,
        to (clusters, rows, k)."""
        out = np.empty((clusters, weights.shape[1] - 2, weights.shape[2]))
        _of_films(out, weights, self.before, self.here, self.after, self.elastic)
        return out


@compiled
def _of_films(
    out: FloatArray, weights: FloatArray, before: FloatArray, here: FloatArray, after: FloatArray, elastic: float
) -> None:
    """As `Rows.of_films`, in one pass."""
    clusters, size, columns = out.shape
    for c in range(clusters):
        for i in range(size):
            row = c * size + i
            low, middle, high = elastic * before[row], elastic * here[row], elastic * after[row]
            for j in range(columns):
                out[c, i, j] = low * weights[c, i, j] + middle * weights[c, i + 1, j] + high * weights[c, i + 2, j]


@dataclass(frozen=True, eq=False)
class Joint:
    """What joins the pairs of neighbours of a level: their columns (clusters, size, rank), the rows of their neighbour
    solved for (clusters, size, rank), and the inverse of what both make of one another."""

    columns: FloatArray
    solved: FloatArray
    inverse: FloatArray

    def seen(self, values: FloatArray) -> FloatArray:
        """What values (clusters, size, k) are worth to the neighbour: of both of a pair, (pairs, 2 rank, k)."""
        own = self.columns.transpose(0, 2, 1) @ values
        return np.concatenate([own[1::2], own[0::2]], axis=1)

    def corrected(self, values: FloatArray, seen: FloatArray) -> None:
        """Make of values solved for with the clusters alone those solved for with the pairs."""
        clusters, _, rank = self.columns.shape
        values -= self.solved @ (self.inverse @ seen).reshape(clusters, rank, -1)


@dataclass(frozen=True, eq=False)
class Elimination:
    """Newton's equations taken apart once, for any right side.

    leaves : inverses of the diagonal blocks. joints : from the leaves up. border : its columns solved for
    (n-1, BORDER). last_rows : of the border (3, n-1). closing : what they leave of datum, exit and the exit's film
    (3, 3).
    """

    operator: LineOperator
    leaves: FloatArray
    joints: tuple[Joint, ...]
    border: FloatArray
    last_rows: FloatArray
    closing: FloatArray

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution (n+1,), in the equations' units, of a right side (n+1,)."""
        inner, clusters = len(right) - 2, len(self.leaves)
        values = np.zeros((clusters * self.operator.leaf, 1))
        values[:inner, 0] = right[1:-1]
        values = (self.leaves @ values.reshape(clusters, -1, 1)).reshape(-1, 1)
        for joint in self.joints:
            of_level = values.reshape(len(joint.columns), -1, 1)
            joint.corrected(of_level, joint.seen(of_level))
        solved = values[:inner, 0]
        known = np.array([right[0], right[-1], 0.0]) - self.last_rows @ solved
        scalars = np.linalg.solve(self.closing, known)
        return np.concatenate([solved - self.border @ scalars, scalars[:2]])


def eliminate(operator: LineOperator, equations: Equations) -> Elimination:
    """Take the equations apart."""
    rows = _rows(operator, equations)
    answers = _answers(operator, equations)
    ranks = [level.short + 1 for level in operator.levels]
    ends = BORDER + np.concatenate([[0], np.cumsum(ranks)])  # of the columns of each level, the leaves' last
    columns = np.empty((operator.leaf * 2**operator.depth, ends[-1]))
    columns[:, :BORDER] = _border(operator, equations, answers)
    rights = []
    for level, start, end in zip(operator.levels, ends[:-1], ends[1:], strict=True):
        columns[:, start:end], right = _coupling(level, rows)
        rights.append(right)
    leaves = np.asarray(np.linalg.inv(_blocks(operator, rows)), dtype=np.float64)
    columns = np.matmul(leaves, columns.reshape(len(leaves), operator.leaf, -1)).reshape(columns.shape)
    joints = tuple(_joined(rights[k], columns, ends[k]) for k in reversed(range(len(rights))))
    border = np.ascontiguousarray(columns[: len(equations.here) - 1, :BORDER])
    last_rows, closing = _closing(operator, equations, answers)
    return Elimination(operator, leaves, joints, border, last_rows, closing - last_rows @ border)


def _rows(operator: LineOperator, e: Equations) -> Rows:
    unit, inner, slots = e.units[0], len(e.here) - 1, operator.leaf * 2**operator.depth

    def filled(values: FloatArray) -> FloatArray:
        out = np.zeros(slots)
        out[:inner] = values
        return out

    before, here, after = filled(e.before[1:]), filled(e.here[1:]), filled(e.after[1:])
    low, diagonal, high = filled(e.low[1:] * unit), filled(e.diagonal[1:] * unit), filled(e.high[1:] * unit)
    diagonal[inner:] = 1.0
    high[inner - 1] = 0.0  # P_n stays zero
    return Rows(before, here, after, low, diagonal, high, -DEFLECTION * unit * operator.factor)


def _answers(operator: LineOperator, e: Equations) -> FloatArray:
    """How the films answer to datum and exit, the inlet's pressure included: (n+1, 2)."""
    _, unit_h, unit_x = e.units
    out = np.empty((len(e.position), 2))
    out[:, 0] = unit_h
    out[:, 1] = (e.position - DEFLECTION * e.inlet_slope * operator.factor * operator.ends[:, 0]) * unit_x
    return out


def _border(operator: LineOperator, e: Equations, answers: FloatArray) -> FloatArray:
    """The columns of datum, exit and the exit's film: (slots, BORDER)."""
    inner = len(e.here) - 1
    out = np.zeros((operator.leaf * 2**operator.depth, BORDER))
    out[:inner, :2] = (
        e.here[1:, None] * answers[1:-1] + e.after[1:, None] * answers[2:] + e.before[1:, None] * answers[:-2]
    )
    out[0, 1] += e.low[1] * e.inlet_slope * e.units[2]
    out[:inner, 2] = e.exit[1:]
    return out


def _coupling(level: Level, rows: Rows) -> tuple[FloatArray, FloatArray]:
    """Thin factors of what the clusters of a level do to their neighbours: (slots, rank) of the rows, and of the
    columns (clusters, size, rank). The last of them is the one row next to the neighbour that is not a product: its
    own pressure and film one node on."""
    (clusters, width, _), rank = level.right.shape, level.short
    left = np.empty((clusters, width, rank + 1))
    left[:, :, :-1] = rows.of_films(level.left[:, :, :rank], clusters)
    left[:, :, -1] = 0.0
    left[0::2, -1, -1] = 1.0  # its next node lies in the neighbour,
    left[1::2, 0, -1] = 1.0  # its last one too
    right = np.empty((clusters, width, rank + 1))
    right[:, :, :-1] = level.right[:, :, :rank]
    last, first = np.arange(0, clusters, 2) * width + width - 1, np.arange(1, clusters, 2) * width
    right[1::2, :, -1] = rows.elastic * rows.after[last, None] * level.edge[1::2]
    right[1::2, 0, -1] += rows.high[last]
    right[0::2, :, -1] = rows.elastic * rows.before[first, None] * level.edge[0::2]
    right[0::2, -1, -1] += rows.low[first]
    return left.reshape(-1, rank + 1), right


def _blocks(operator: LineOperator, rows: Rows) -> FloatArray:
    """The diagonal blocks (leaves, leaf, leaf)."""
    leaves, size = 2**operator.depth, operator.leaf
    blocks = rows.of_films(operator.blocks, leaves)
    index = np.arange(size)
    blocks[:, index, index] += rows.diagonal.reshape(leaves, size)
    blocks[:, index[:-1], index[1:]] += rows.high.reshape(leaves, size)[:, :-1]
    blocks[:, index[1:], index[:-1]] += rows.low.reshape(leaves, size)[:, 1:]
    return blocks


def _joined(right: FloatArray, columns: FloatArray, start: int) -> Joint:
    """The columns (slots, k) before those of a level, solved for with its clusters alone, are then solved for with its
    pairs; those of the level begin at `start`."""
    clusters, width, rank = right.shape
    of_level = columns.reshape(clusters, width, -1)
    kept, own = of_level[:, :, :start], np.ascontiguousarray(of_level[:, :, start : start + rank])
    coupling = right.transpose(0, 2, 1) @ own
    system = np.zeros((clusters // 2, 2 * rank, 2 * rank))
    unit = np.arange(2 * rank)
    system[:, unit, unit] = 1.0
    # z_1 = V_2' x_2 multiplies the left cluster's factor, z_2 = V_1' x_1 the right one's
    system[:, :rank, rank:] = coupling[1::2]
    system[:, rank:, :rank] = coupling[0::2]
    joint = Joint(right, own, np.linalg.inv(system))
    joint.corrected(kept, joint.seen(kept))
    return joint


def _closing(operator: LineOperator, e: Equations, answers: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The border's rows: flow through the first cell, the load, and what the exit's film is, of the pressures (3, n-1)
    and of datum, exit and that film (3, 3)."""
    unit_p, _, unit_x = e.units
    rows = -DEFLECTION * unit_p * operator.factor * operator.rows[:, 1:-1]
    first_row = e.here[0] * rows[0] + e.after[0] * rows[1]
    first_row[0] += e.high[0] * unit_p
    corner = np.zeros((3, 3))
    corner[0, :2] = e.here[0] * answers[0] + e.after[0] * answers[1]
    corner[0, 1] += e.diagonal[0] * e.inlet_slope * unit_x
    corner[0, 2] = e.exit[0]
    corner[1, 1] = e.load_exit * unit_x
    corner[2, :2] = answers[-1]
    corner[2, 2] = -1.0
    return np.stack([first_row, e.load[1:-1] * unit_p, rows[2]]), corner
