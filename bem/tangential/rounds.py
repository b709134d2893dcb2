"""Partial slip on one grid: rounds of an active set, each a Newton step by conjugate gradients.

Unknown are the tractions q on the cells in contact, |q| <= g = friction x pressure; b is the displacement imposed on
them, and r = b - A q what they leave of it unmet: minus the slip. Coulomb: r = 0 where |q| < g (stick), r = lambda q,
lambda >= 0 where |q| = g (slip). That is the least of the convex energy q (A q / 2 - b) on a product of discs, with
sum q = force where one is given; the shift is then the multiplier.

A round: with the cell's own stiffness t, q + t r outside its disc says slip, in the direction it says. On stick cells q
is free; on slip cells it moves along the tangent of the disc, which adds lambda / g to the stiffness (the disc's
curvature); that linear problem is solved by conjugate gradients to a tenth, and the step is put back into the discs and
shortened until the energy does not rise. The preconditioner is the sparse approximate inverse of the normal contact, of
the mean of both directions' kernels.

Primal-dual active sets for friction: Stadler, SIAM J. Optim. 15 (2004); Hueeber, Stadler, Wohlmuth, SIAM J. Sci.
Comput. 30 (2008). Ours differs in the tangent step and the guard by the energy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact.preconditioner import SparseInverseOnCells, sparse_inverse
from bem.grid import FloatArray
from bem.tangential.discs import nearest, nearest_with_force
from bem.tangential.operator import TangentialOperator

_SQUARED_RADIUS = 2
"""Of the sparse inverse's stencil in cells. Counted on balls and rough contacts of 128 to 256 cells: 37 to 53
convolutions with any of 1 to 8; without an inverse 1.3 to 1.8 times as many."""

_REDUCTION = 0.1
"""What a round's linear problem is solved to. Counted: 0.3 takes a tenth to 0.4 more rounds, 0.03 up to a fifth more
convolutions; the sum is flat."""

_INNER = 200
_HALVINGS = 10


@dataclass(frozen=True)
class Slipping:
    """A problem on one grid.

    bound : (nx, ny), friction x pressure [Pa]. imposed : (2, nx, ny), b without the shift [m]. force : (2,), the sum of
    the tractions over the cells [Pa], or None where the shift is part of `imposed`.
    """

    operator: TangentialOperator
    bound: FloatArray
    imposed: FloatArray
    force: FloatArray | None

    @property
    def stiffness(self) -> float:
        """t [Pa/m]: of one cell alone."""
        return 2 / sum(self.operator.compliance)


@dataclass
class Effort:
    """Rounds that are left, and those made, on all grids."""

    left: int
    rounds: int = 0


@dataclass(frozen=True)
class Slipped:
    """Tractions (2, n) [Pa] on the cells in contact; shift (2,) [m], 0 where none was looked for; `unmet` (2, n), r [m]
    with the shift; `slips` (n,)."""

    cells: NDArray[np.bool_]
    traction: FloatArray
    shift: FloatArray
    unmet: FloatArray
    slips: NDArray[np.bool_]
    violation: float
    converged: bool


@dataclass(frozen=True)
class _Cells:
    """The problem on the cells in contact, as vectors; `numbers` are their flat indices, `room` a field of both
    directions, zero elsewhere.
    """

    problem: Slipping
    cells: NDArray[np.bool_]
    bound: FloatArray
    imposed: FloatArray
    inverse: SparseInverseOnCells
    stiffness: float
    numbers: NDArray[np.int64]
    room: FloatArray

    def displaced(self, traction: FloatArray) -> FloatArray:
        """A q, (2, n)."""
        self.room.reshape(2, -1)[:, self.numbers] = traction
        return self.problem.operator.apply(self.room).reshape(2, -1).take(self.numbers, 1)

    def inside(self, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The nearest tractions that are allowed, and the shift times the stiffness that this takes."""
        out = np.empty_like(wanted)
        if self.problem.force is None:
            nearest(wanted, self.bound, out)
            return out, np.zeros(2)
        return out, nearest_with_force(wanted, self.bound, self.problem.force, out)

    def energy(self, traction: FloatArray, displacement: FloatArray) -> float:
        """What falls from round to round."""
        return float((traction * (0.5 * displacement - self.imposed)).sum())

    def preconditioned(self, values: FloatArray) -> FloatArray:
        """The sparse inverse of both directions."""
        out, spread = np.empty_like(values), np.empty(self.bound.size)
        for direction in range(2):
            self.inverse.spread(np.ascontiguousarray(values[direction]), spread)
            self.inverse.collect(spread, out[direction])
        return out


@dataclass(frozen=True)
class _Face:
    """Where a round may move: freely where cells stick, along `tangent` (2, n) where they slip, keeping the force."""

    slips: NDArray[np.bool_]
    tangent: FloatArray
    curvature: FloatArray
    keeps: FloatArray | None
    solve: FloatArray | None

    def project(self, values: FloatArray) -> FloatArray:
        """The part of (2, n) that a round may move in."""
        along = _along(values, self.tangent, self.slips)
        if self.keeps is None or self.solve is None:
            return along
        share = self.solve @ (self.keeps * along).sum((1, 2))
        return along - share[0] * self.keeps[0] - share[1] * self.keeps[1]


def _along(values: FloatArray, tangent: FloatArray, slips: NDArray[np.bool_]) -> FloatArray:
    return np.where(slips, tangent * (tangent * values).sum(0), values)


def slip_on_grid(problem: Slipping, start: FloatArray, tolerance: float, effort: Effort) -> Slipped:
    """Rounds from wanted tractions (2, nx, ny) until the violation [m] is at most tolerance x the largest displacement.

    `start` may lie outside the discs: how far says how much a cell slips.
    """
    on = _cells(problem)
    traction, _ = on.inside(start[:, on.cells])
    displacement = on.displaced(traction)
    while True:
        judged = _judged(on, traction, displacement)
        converged = judged.violation <= tolerance * reach(displacement, on.imposed)
        if converged or effort.left <= 0:
            break
        effort.left -= 1
        effort.rounds += 1
        stepped = _round(on, traction, displacement, judged)
        if stepped is None:
            break
        traction, displacement = stepped
    return Slipped(on.cells, traction, judged.shift, judged.unmet, judged.slips, judged.violation, converged)


def reach(displacement: FloatArray, imposed: FloatArray) -> float:
    """What violations are measured by [m]: the largest displacement, or the movement asked for; both (2, n)."""
    return max(float(np.abs(displacement).max(initial=0.0)), float(np.abs(imposed).max(initial=0.0)))


def _cells(problem: Slipping) -> _Cells:
    grid = problem.operator.grid
    cells = problem.bound > 0
    near = problem.operator.near_field(2 * math.isqrt(_SQUARED_RADIUS))
    inverse = sparse_inverse(grid.shape, grid.periodic, near, _SQUARED_RADIUS)
    numbers = np.flatnonzero(cells)
    return _Cells(
        problem,
        cells,
        problem.bound[cells],
        problem.imposed[:, cells],
        inverse.on(numbers, None),
        problem.stiffness,
        numbers,
        np.zeros((2, *grid.shape)),
    )


@dataclass(frozen=True)
class _Judged:
    """What tractions are: shift (2,) [m], what is unmet (2, n) [m], which cells slip (n,) and whereto (2, n), and the
    largest violation of Coulomb's conditions [m].
    """

    shift: FloatArray
    unmet: FloatArray
    slips: NDArray[np.bool_]
    normal: FloatArray
    violation: float


def _judged(on: _Cells, traction: FloatArray, displacement: FloatArray) -> _Judged:
    unmet = on.imposed - displacement
    allowed, offset = on.inside(traction + on.stiffness * unmet)
    shift = offset / on.stiffness
    unmet += shift[:, None]
    violation = float(np.abs(allowed - traction).max()) / on.stiffness
    wanted = traction + on.stiffness * unmet
    length = np.hypot(wanted[0], wanted[1])
    # a cell alone is far stiffer than a spot that moves as a whole: one that is to turn round is let go first
    slips = (length > on.bound) & ((wanted * traction).sum(0) > 0)
    normal = np.where(slips, wanted / np.where(slips, length, 1.0), 0.0)
    return _Judged(shift, unmet, slips, normal, violation)


def _face(on: _Cells, judged: _Judged) -> _Face:
    slips, normal, unmet = judged.slips, judged.normal, judged.unmet
    tangent = np.stack([-normal[1], normal[0]])
    curvature = np.where(slips, np.maximum((unmet * normal).sum(0), 0.0) / on.bound, 0.0)
    if on.problem.force is None:
        return _Face(slips, tangent, curvature, None, None)
    ones, nothing = np.ones(slips.size), np.zeros(slips.size)
    keeps = np.stack([_along(np.stack(pair), tangent, slips) for pair in ((ones, nothing), (nothing, ones))])
    gram = np.array([[float((one * two).sum()) for two in keeps] for one in keeps])
    return _Face(slips, tangent, curvature, keeps, np.linalg.pinv(gram))


def _round(
    on: _Cells, traction: FloatArray, displacement: FloatArray, judged: _Judged
) -> tuple[FloatArray, FloatArray] | None:
    """New tractions and their displacement; None where no step lowers the energy.

    Cells that are said to slip go to their discs at once, which may be too far where many go together; and a cell that
    is let go may be driven out of its disc again. Where neither part of the step lowers the energy, one along what is
    unmet does, short enough: putting it back is then the projection on a convex set.
    """
    face = _face(on, judged)
    jump = np.where(judged.slips, on.bound * judged.normal - traction, 0.0)
    if face.keeps is not None and not judged.slips.all():  # what they take is given back where the others stick
        jump -= np.where(judged.slips, 0.0, (jump.sum(1) / np.count_nonzero(~judged.slips))[:, None])
    residual = judged.unmet
    if float(np.abs(jump).max()) > 1e-9 * float(np.abs(traction).max()):
        residual = residual - on.displaced(jump)
    step = jump + _newton_step(on, face, residual, judged.unmet)
    return _shortened(on, traction, displacement, step) or _shortened(
        on, traction, displacement, on.stiffness * judged.unmet
    )


def _newton_step(on: _Cells, face: _Face, residual: FloatArray, unmet: FloatArray) -> FloatArray:
    """On the face, to a share of what is unmet there."""
    return _conjugate_gradients(on, face, face.project(residual), _REDUCTION * _norm(face.project(unmet)))


def _shortened(
    on: _Cells, traction: FloatArray, displacement: FloatArray, step: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """The step put back into the discs, halved until the energy does not rise; None where it always does."""
    before = on.energy(traction, displacement)
    share = 1.0
    for _ in range(_HALVINGS):
        moved, _ = on.inside(traction + share * step)
        there = on.displaced(moved)
        if on.energy(moved, there) <= before + 1e-11 * abs(before):
            return moved, there
        share *= 0.5
    return None


def _norm(values: FloatArray) -> float:
    return math.sqrt(float((values * values).sum()))


def _conjugate_gradients(on: _Cells, face: _Face, residual: FloatArray, goal: float) -> FloatArray:
    """The step on the face that brings the residual below the goal."""
    damping = 1 / np.sqrt(1 + face.curvature * on.stiffness)

    def preconditioned(values: FloatArray) -> FloatArray:
        return face.project(damping * on.preconditioned(damping * values))

    step = np.zeros_like(residual)
    better: Callable[[FloatArray], FloatArray] = preconditioned
    direction = better(residual)
    product = float((residual * direction).sum())
    for _ in range(_INNER):
        if _norm(residual) <= goal or not product > 0:
            break
        stiff = on.displaced(direction) + face.curvature * direction
        along = float((direction * stiff).sum())
        if not along > 0:
            break
        share = product / along
        step += share * direction
        residual = residual - share * face.project(stiff)
        towards = better(residual)
        following = float((residual * towards).sum())
        direction = towards + (following / product) * direction
        product = following
    return step
