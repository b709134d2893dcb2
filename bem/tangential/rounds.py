"""Partial slip on one grid: rounds of an active set, each a Newton step by conjugate gradients.

Unknown are the tractions q on the cells in contact, |q| <= g = friction x pressure; b is the displacement imposed on
them, and r = b - A q what they leave of it unmet: minus the slip. Coulomb: r = 0 where |q| < g (stick), r = lambda q,
lambda >= 0 where |q| = g (slip). That is the least of the convex energy q (A q / 2 - b) on a product of discs, with
sum q = force where one is given; the shift is then the multiplier.

A round: cells slip that are on their discs and driven on outwards (r q > 0). On all others q is free; on these it
moves along the tangent of the disc, which adds lambda / g to the stiffness (the disc's curvature). That linear problem
is solved by conjugate gradients (`inverse` is their preconditioner), no further than putting the result back into the
discs will leave it. Where the energy does not fall by that, the rounds on that grid take slip from q + t r, t the
cell's own stiffness, bring what is to slip to its disc first, and shorten the step until the energy does not rise. Over
240 random steps of rough contacts that took 21 convolutions a step, halved steps of the former kind 35.

Primal-dual active sets for friction: Stadler, SIAM J. Optim. 15 (2004); Hueeber, Stadler, Wohlmuth, SIAM J. Sci.
Comput. 30 (2008). Ours differs in the tangent step and the guard by the energy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.tangential.discs import nearest, nearest_with_force
from bem.tangential.inverse import InverseOnCells, Inverses
from bem.tangential.operator import TangentialOperator

_REDUCTION = 1e-3
"""What a round's linear problem is solved to at best. Convolutions of balls and rough contacts of 256 and 512 cells
hardly hang on it from 1e-2 to 1e-5 (counted)."""

_LEAST = 0.3
"""What it is solved to at least, however much putting back undoes."""

_UNDONE = 10.0
"""Between the two it ends where what is left is less than this times what putting back undoes over a cell alone: a
tenth fewer convolutions than with 1, with 6 to 12 alike (counted)."""

_ENOUGH = 0.8
"""Share of the tolerance that ends it."""

_ON_DISC = 1e-9
"""Relative distance from its disc at which a traction is on it."""

_INNER = 200
_HALVINGS = 10

_FLAT = 1e-13
"""Stiffness of a direction over that of one cell, below which no displacement answers to it."""

_LEAST_SCALE = 1e-6
"""Share of the largest movement imposed on the grid, below which displacements are rounding: one cell alone that
carries pressure but no force does not move, while the surfaces around it do."""


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

    @property
    def least_scale(self) -> float:
        """Displacement [m] that violations are relative to at least; the others are rounding."""
        return least_scale(self.imposed)


@dataclass
class Effort:
    """Rounds that are left, and those made, on all grids."""

    left: int
    rounds: int = 0


@dataclass(frozen=True)
class Slipped:
    """Tractions (2, n) [Pa] on the cells in contact; `field` (2, nx, ny), the operator applied to them [m]; shift (2,)
    [m], 0 where none was looked for; `unmet` (2, n), r [m] with the shift; `slips` (n,)."""

    cells: NDArray[np.bool_]
    traction: FloatArray
    field: FloatArray
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
    inverses: Inverses
    stiffness: float
    numbers: NDArray[np.int64]
    room: FloatArray

    def field(self, traction: FloatArray) -> FloatArray:
        """A q everywhere, (2, nx, ny)."""
        self.room.reshape(2, -1)[:, self.numbers] = traction
        return self.problem.operator.apply(self.room)

    def here(self, field: FloatArray) -> FloatArray:
        """A field on the cells, (2, n)."""
        return field.reshape(2, -1).take(self.numbers, 1)

    def displaced(self, traction: FloatArray) -> FloatArray:
        """A q, (2, n)."""
        return self.here(self.field(traction))

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


@dataclass(frozen=True)
class _Kept:
    """The force that a round keeps: `sums` (2, 2, n) add up what may move, `responses` are the inverse of those; and
    the inverses of the products of the former with themselves and with the latter, (2, 2).
    """

    sums: FloatArray
    gram: FloatArray
    responses: FloatArray
    mixed: FloatArray

    def part(self, values: FloatArray, inverse: FloatArray) -> FloatArray:
        """Multiples (2,) of the sums, or of the responses, that have the force of `values` (2, n)."""
        return np.asarray(inverse @ np.einsum("kin,in->k", self.sums, values))


@dataclass(frozen=True)
class _Face:
    """Where a round may move: freely where cells stick, across `normal` (2, n) where they slip, keeping the force."""

    slips: NDArray[np.bool_]
    normal: FloatArray
    curvature: FloatArray
    inverse: InverseOnCells
    kept: _Kept | None

    def along(self, values: FloatArray) -> FloatArray:
        """Without what is across the discs of the cells that slip."""
        return np.asarray(values - self.normal * (self.normal * values).sum(0))

    def shift(self, values: FloatArray) -> FloatArray:
        """What (2,) to add to displacements (2, n) so that their sum is zero where tractions may move."""
        return np.zeros(2) if self.kept is None else -self.kept.part(values, self.kept.gram)

    def project(self, values: FloatArray) -> FloatArray:
        """The part of displacements (2, n) that a round can change."""
        return self.along(values + self.shift(values)[:, None])

    def preconditioned(self, values: FloatArray) -> FloatArray:
        """An approximate inverse of the stiffness on the face: tractions (2, n) without a force."""
        out = self.along(self.inverse.apply(values))
        if self.kept is None:
            return out
        share = self.kept.part(out, self.kept.mixed)
        return out - share[0] * self.kept.responses[0] - share[1] * self.kept.responses[1]


def slip_on_grid(problem: Slipping, start: FloatArray, tolerance: float, effort: Effort) -> Slipped:
    """Rounds from wanted tractions (2, nx, ny) until the violation [m] is at most tolerance x the largest displacement.

    `start` may lie outside the discs: how far says how much a cell slips.
    """
    on = _cells(problem)
    traction, _ = on.inside(start[:, on.cells])
    field = on.field(traction)
    bold = True
    least = problem.least_scale
    while True:
        displacement = on.here(field)
        judged = _judged(on, traction, displacement)
        scale = reach(displacement, on.imposed, least)
        converged = judged.violation <= tolerance * scale
        if converged or effort.left <= 0:
            break
        effort.left -= 1
        effort.rounds += 1
        goal = _ENOUGH * tolerance * scale
        stepped = _bold_round(on, traction, displacement, judged, goal) if bold else None
        if stepped is None:  # slip turns: so it will in the rounds to come
            bold = False
            stepped = _careful_round(on, traction, displacement, judged, goal)
        if stepped is None:
            break
        traction, field = stepped
    return Slipped(on.cells, traction, field, judged.shift, judged.unmet, judged.slips, judged.violation, converged)


def reach(displacement: FloatArray, imposed: FloatArray, least: float) -> float:
    """Length [m] that violations are relative to: the largest displacement or movement imposed, both (2, n), and no
    less than `least`.
    """
    return max(float(np.abs(displacement).max(initial=0.0)), float(np.abs(imposed).max(initial=0.0)), least)


def least_scale(*movements: FloatArray) -> float:
    """Length [m] below which displacements are rounding, where the bodies' movements anywhere are these [m]."""
    return _LEAST_SCALE * max(float(np.abs(values).max(initial=0.0)) for values in movements)


def _cells(problem: Slipping) -> _Cells:
    grid = problem.operator.grid
    cells = problem.bound > 0
    numbers = np.flatnonzero(cells)
    return _Cells(
        problem,
        cells,
        problem.bound[cells],
        problem.imposed[:, cells],
        Inverses.of(problem.operator, _push(problem, cells)),
        problem.stiffness,
        numbers,
        np.zeros((2, *grid.shape)),
    )


def _push(problem: Slipping, cells: NDArray[np.bool_]) -> FloatArray:
    """Unit vector (2,) of the force, or of the mean movement imposed; along x where there is none."""
    given = problem.imposed[:, cells].mean(1) if problem.force is None else problem.force
    length = math.hypot(*given)
    return given / length if length > 0 else np.array([1.0, 0.0])


@dataclass(frozen=True)
class _Judged:
    """What tractions are: shift (2,) [m], what is unmet (2, n) [m], which cells slip (n,), and the largest violation of
    Coulomb's conditions [m].
    """

    shift: FloatArray
    unmet: FloatArray
    slips: NDArray[np.bool_]
    violation: float


def _judged(on: _Cells, traction: FloatArray, displacement: FloatArray) -> _Judged:
    unmet = on.imposed - displacement
    allowed, offset = on.inside(traction + on.stiffness * unmet)
    shift = offset / on.stiffness
    unmet += shift[:, None]
    violation = float(np.abs(allowed - traction).max()) / on.stiffness
    wanted = traction + on.stiffness * unmet
    length = np.hypot(wanted[0], wanted[1])
    return _Judged(shift, unmet, length > on.bound, violation)


def _bold_round(
    on: _Cells, traction: FloatArray, displacement: FloatArray, judged: _Judged, goal: float
) -> tuple[FloatArray, FloatArray] | None:
    """New tractions and what they move (2, nx, ny); None where the step raises the energy.

    Cells slip that are on their discs and are driven on outwards; all others move freely and are put back.
    """
    length = np.hypot(traction[0], traction[1])
    slips = (length >= (1 - _ON_DISC) * on.bound) & ((judged.unmet * traction).sum(0) > 0)
    face = _face(on, slips, np.where(slips, traction / np.where(slips, length, 1.0), 0.0), judged.unmet)
    step = _newton_step(on, face, traction, judged.unmet, goal)
    return _shortened(on, traction, displacement, step, 1)


def _careful_round(
    on: _Cells, traction: FloatArray, displacement: FloatArray, judged: _Judged, goal: float
) -> tuple[FloatArray, FloatArray] | None:
    """The same where cells that are to slip go to their discs first; None where no step lowers the energy.

    That costs a convolution more, and may be too far where many go together; and a cell that is let go may be driven
    out of its disc again. Where the step does not lower the energy, one along what is unmet does, short enough: putting
    it back is then the projection on a convex set.
    """
    wanted = traction + on.stiffness * judged.unmet
    # a cell alone is far stiffer than a spot that moves as a whole: one that is to turn round is let go first
    slips = judged.slips & ((wanted * traction).sum(0) > 0)
    normal = np.where(slips, wanted / np.where(slips, np.hypot(wanted[0], wanted[1]), 1.0), 0.0)
    jump = np.where(slips, on.bound * normal - traction, 0.0)
    if on.problem.force is not None and not slips.all():  # what they take is given back where the others stick
        jump -= np.where(slips, 0.0, (jump.sum(1) / np.count_nonzero(~slips))[:, None])
    unmet = judged.unmet
    if float(np.abs(jump).max()) > _ON_DISC * float(np.abs(traction).max()):
        unmet = unmet - on.displaced(jump)
    step = jump + _newton_step(on, _face(on, slips, normal, judged.unmet), traction + jump, unmet, goal)
    return _shortened(on, traction, displacement, step) or _shortened(
        on, traction, displacement, on.stiffness * judged.unmet
    )


def _face(on: _Cells, slips: NDArray[np.bool_], normal: FloatArray, unmet: FloatArray) -> _Face:
    """Where these cells slip, (n,), on their discs in the directions `normal` (2, n)."""
    curvature = np.where(slips, np.maximum((unmet * normal).sum(0), 0.0) / on.bound, 0.0)
    face = _Face(slips, normal, curvature, on.inverses.on(on.numbers, slips, normal, curvature), None)
    if on.problem.force is None:
        return face
    keeps = np.stack([face.along(np.broadcast_to(unit[:, None], normal.shape)) for unit in np.eye(2)])
    responses = np.stack([face.along(face.inverse.apply(kept)) for kept in keeps])
    return replace(face, kept=_Kept(keeps, _inverse_of(keeps, keeps), responses, _inverse_of(keeps, responses)))


def _inverse_of(one: FloatArray, two: FloatArray) -> FloatArray:
    """Of the products (2, 2) of fields (2, 2, n)."""
    return np.asarray(np.linalg.pinv([[float((a * b).sum()) for b in two] for a in one]))


def _shortened(
    on: _Cells, traction: FloatArray, displacement: FloatArray, step: FloatArray, trials: int = _HALVINGS
) -> tuple[FloatArray, FloatArray] | None:
    """The step put back into the discs and what it moves (2, nx, ny), halved until the energy does not rise; None where
    it always does.
    """
    before = on.energy(traction, displacement)
    share = 1.0
    for _ in range(trials):
        moved, _ = on.inside(traction + share * step)
        there = on.field(moved)
        # as good as the same is enough of a whole step only: shortened ones would creep on uphill
        if on.energy(moved, on.here(there)) <= before + (1e-11 * abs(before) if share == 1 else 0.0):
            return moved, there
        share *= 0.5
    return None


def _norm(values: FloatArray) -> float:
    return math.sqrt(float((values * values).sum()))


def _newton_step(on: _Cells, face: _Face, traction: FloatArray, unmet: FloatArray, goal: float) -> FloatArray:
    """On the face by conjugate gradients: to `goal` [m], or until putting the step back undoes more than is left."""
    step, raw = np.zeros_like(unmet), unmet.copy()
    residual = face.project(unmet)
    # as the violation is measured: a disc that is small beside the slip gives way by little
    damping = 1 / (1 + face.curvature * on.stiffness)
    first = _norm(damping * residual)
    direction = face.preconditioned(residual)
    product = float((residual * direction).sum())
    for _ in range(_INNER):
        if not product > 0:
            break
        moved = on.displaced(direction)
        stiff = moved + face.curvature * direction
        along = float((direction * stiff).sum())
        if not along > _FLAT * float((direction * direction).sum()) / on.stiffness:
            # a mean traction on a doubly periodic grid moves nothing: only the discs end it
            return step + direction * (2 * float(on.bound.max()) / float(np.abs(direction).max()))
        share = product / along
        step += share * direction
        raw -= share * moved
        residual = residual - share * face.project(stiff)
        seen = damping * residual
        left = _norm(seen)
        if left <= _REDUCTION * first or float(np.abs(seen).max()) <= goal:
            break
        if left <= _LEAST * first and left <= _UNDONE * _undone(on, face, traction + step, raw - face.curvature * step):
            break
        towards = face.preconditioned(residual)
        following = float((residual * towards).sum())
        direction = towards + (following / product) * direction
        product = following
    return step


def _undone(on: _Cells, face: _Face, wanted: FloatArray, unmet: FloatArray) -> float:
    """About what residual comes back [m] when a step is put back into the discs, and where cells no longer slip."""
    over = np.maximum(np.hypot(wanted[0], wanted[1]) - on.bound, 0.0)
    released = np.where(face.slips, np.minimum(((unmet + face.shift(unmet)[:, None]) * face.normal).sum(0), 0.0), 0.0)
    return math.hypot(_norm(over) / on.stiffness, _norm(released))
