"""Partial slip on one grid by an active-set Newton method with preconditioned conjugate gradients.

Unknown are the tractions q on the n cells in contact, abs(q) <= g = friction x pressure. With the imposed displacement
b and the in-plane operator A, the displacement residual r = b - A q is minus the slip. Coulomb's law reads: r = 0 where
abs(q) < g (stick), and r = lambda q with lambda >= 0 where abs(q) = g (slip). Its solution minimises the convex energy
q (A q / 2 - b) on a product of discs. If a force is given, sum q = force, and the shift is the Lagrange multiplier.

One iteration is one Newton step:

1. The slip set is the cells on their discs whose residual points outwards (r q > 0).
2. The tractions of sticking cells are free. Those of slipping cells move along the tangent of the disc, whose curvature
   adds lambda / g to the stiffness. This tangent space may also keep the total force.
3. Conjugate gradients solve the linear problem in the tangent space, with the preconditioner of `preconditioner`. They
   end where the projection onto the discs would bring back a residual of the same size.
4. The result is projected onto the discs. A full step is accepted if the energy does not rise.
5. Otherwise, and from then on, steps are damped: the slip set is predicted from q + t r, where t is the stiffness of a
   single cell; predicted cells jump to their discs first; and the step is halved until the energy does not rise. If no
   length is accepted, the step is a projected gradient step along r, which lowers the energy if it is short enough.

Primal-dual active sets for friction: Stadler, SIAM J. Optim. 15 (2004); Hueeber, Stadler, Wohlmuth, SIAM J. Sci.
Comput. 30 (2008). The step along the tangent and the energy guard are additions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.grid_workspace import IterationBudget
from bem.grid import FloatArray
from bem.tangential.friction_discs import project_to_friction_discs, project_with_force
from bem.tangential.preconditioner import DirectionalPreconditioner, SplitPreconditioner
from bem.tangential.problem import SlipProblem, displacement_scale, rounding_scale

BoolArray = NDArray[np.bool_]

_REDUCTION = 1e-3
"""Relative residual at which conjugate gradients end; affects cost only, and little."""

_LEAST_REDUCTION = 0.3
"""Relative residual from which on the projection onto the discs may end conjugate gradients."""

_PROJECTION = 10.0
"""Conjugate gradients end where their residual is below this multiple of the residual that the projection brings back,
estimated with the stiffness of single cells."""

_GOAL = 0.8
"""Fraction of the tolerance at which conjugate gradients end."""

_ON_DISC = 1e-9
"""Relative distance from its disc within which a traction counts as on the disc."""

_CG_ITERATIONS = 200
"""Limit of the iterations of conjugate gradients in one Newton step."""
_HALVINGS = 10
"""Limit of the trials of a line search."""

_FLAT = 1e-13
"""Curvature along a direction, relative to the stiffness of a single cell, below which no displacement resists it."""

_ENERGY_ROUNDING = 1e-11
"""Relative rise of the energy that a full step may have. Shorter steps may have none: they would creep uphill."""


@dataclass(frozen=True)
class SlipResult:
    """Result of `solve_slip` on the n cells in contact.

    cells : (nx, ny), True for cells in contact.
    traction : (2, n) [Pa].
    displacement : (2, nx, ny), the operator applied to the tractions [m].
    shift : (2,) [m], zero if it is imposed.
    displacement_residual : (2, n), r with the shift [m].
    slips : (n,), True for cells that slip.
    violation : largest violation of Coulomb's law [m].
    """

    cells: BoolArray
    traction: FloatArray
    displacement: FloatArray
    shift: FloatArray
    displacement_residual: FloatArray
    slips: BoolArray
    violation: float
    converged: bool


def solve_slip(problem: SlipProblem, start: FloatArray, tolerance: float, budget: IterationBudget) -> SlipResult:
    """Solve partial slip on one grid: Newton steps until the violation is at most tolerance x the largest displacement.

    Parameters
    ----------
    problem : with at least one cell in contact.
    start : (2, nx, ny), initial tractions [Pa]; outside their discs by stiffness x slip where cells slip.
    tolerance : relative.
    budget : limit of the Newton steps over all grids.
    """
    reduced = _ReducedProblem.of(problem)
    traction, _ = reduced.project(start[:, reduced.cells])
    displacement = reduced.displace(traction)
    full_steps = True
    least = rounding_scale(problem.imposed)
    while True:
        state = reduced.evaluate(traction, reduced.gather(displacement))
        scale = displacement_scale(state.displacement, reduced.imposed, least=least)
        converged = state.violation <= tolerance * scale
        if converged or budget.left <= 0:
            break
        budget.iterations += 1
        goal = _GOAL * tolerance * scale
        step = _full_step(reduced, state, goal) if full_steps else None
        if step is None:  # slip changes its direction, and will do so in the next iterations
            full_steps = False
            step = _damped_step(reduced, state, goal)
        if step is None:
            break
        traction, displacement = step
    return SlipResult(
        reduced.cells,
        traction,
        displacement,
        state.shift,
        state.displacement_residual,
        state.slips,
        state.violation,
        converged,
    )


@dataclass(frozen=True)
class _State:
    """Tractions (2, n) [Pa], their displacement (2, n) [m], and Coulomb's conditions.

    shift : (2,) [m]. displacement_residual : (2, n), r with the shift [m]. slips : (n,). violation : [m].
    """

    traction: FloatArray
    displacement: FloatArray
    shift: FloatArray
    displacement_residual: FloatArray
    slips: BoolArray
    violation: float


@dataclass(frozen=True)
class _ReducedProblem:
    """The problem restricted to the n cells in contact.

    cells : (nx, ny), True for cells in contact. numbers : (n,), their flat indices. bound : (n,) [Pa].
    imposed : (2, n) [m]. stiffness : of a single cell [Pa/m]. field : (2, nx, ny), scratch, zero on all other cells.
    """

    problem: SlipProblem
    cells: BoolArray
    numbers: NDArray[np.int64]
    bound: FloatArray
    imposed: FloatArray
    stiffness: float
    preconditioner: SplitPreconditioner
    field: FloatArray

    @classmethod
    def of(cls, problem: SlipProblem) -> _ReducedProblem:
        """Collect the cells in contact."""
        operator, cells = problem.operator, problem.bound > 0
        imposed = problem.imposed[:, cells]
        return cls(
            problem,
            cells,
            np.flatnonzero(cells),
            problem.bound[cells],
            imposed,
            operator.stiffness,
            SplitPreconditioner.of(operator, _main_direction(problem, imposed)),
            np.zeros((2, *operator.grid.shape)),
        )

    def displace(self, traction: FloatArray) -> FloatArray:
        """Return A q on the whole grid, (2, nx, ny) [m]."""
        self.field.reshape(2, -1)[:, self.numbers] = traction
        return self.problem.operator.apply(self.field)

    def gather(self, field: FloatArray) -> FloatArray:
        """Return a field (2, nx, ny) on the cells, (2, n)."""
        return field.reshape(2, -1).take(self.numbers, 1)

    def project(self, trial: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the nearest admissible tractions (2, n), and stiffness x the shift (2,) that meets the force."""
        out = np.empty_like(trial)
        if self.problem.traction_sum is None:
            project_to_friction_discs(trial, self.bound, out)
            return out, np.zeros(2)
        return out, project_with_force(trial, self.bound, self.problem.traction_sum, out)

    def energy(self, traction: FloatArray, displacement: FloatArray) -> float:
        """Return the energy that the method minimises, over the area of a cell."""
        return float((traction * (0.5 * displacement - self.imposed)).sum())

    def evaluate(self, traction: FloatArray, displacement: FloatArray) -> _State:
        """Return Coulomb's conditions for tractions and their displacement."""
        residual = self.imposed - displacement
        allowed, offset = self.project(traction + self.stiffness * residual)
        shift = offset / self.stiffness
        residual += shift[:, None]
        violation = float(np.abs(allowed - traction).max()) / self.stiffness
        slips = np.hypot(*(traction + self.stiffness * residual)) > self.bound
        return _State(traction, displacement, shift, residual, slips, violation)


def _main_direction(problem: SlipProblem, imposed: FloatArray) -> FloatArray:
    """Return the unit vector (2,) of the force, or of the mean imposed displacement; along x if both vanish."""
    given = imposed.mean(1) if problem.traction_sum is None else problem.traction_sum
    length = math.hypot(*given)
    return given / length if length > 0 else np.array([1.0, 0.0])


@dataclass(frozen=True)
class _ForceConstraint:
    """Tractions in the tangent space that carry no net force.

    sums : (2, 2, n), unit tractions along x and y in the tangent space; products with them are the force.
    responses : (2, 2, n), preconditioned sums.
    gram, mixed : (2, 2), inverses of the products sums . sums and sums . responses.
    """

    sums: FloatArray
    gram: FloatArray
    responses: FloatArray
    mixed: FloatArray

    @classmethod
    def of(cls, space: _TangentSpace) -> _ForceConstraint:
        """Prepare the constraint for a tangent space."""
        shape = space.normal.shape
        sums = np.stack([space.tangential(np.broadcast_to(unit[:, None], shape)) for unit in np.eye(2)])
        responses = np.stack([space.tangential(space.preconditioner.apply(part)) for part in sums])
        return cls(sums, _inverse_products(sums, sums), responses, _inverse_products(sums, responses))

    def coefficients(self, values: FloatArray, inverse: FloatArray) -> FloatArray:
        """Return the multiples (2,) of the sums (`gram`) or responses (`mixed`) with the force of `values` (2, n)."""
        return np.asarray(inverse @ np.einsum("kin,in->k", self.sums, values))


def _inverse_products(one: FloatArray, two: FloatArray) -> FloatArray:
    """Return the pseudo-inverse of the products (2, 2) of fields (2, 2, n)."""
    return np.asarray(np.linalg.pinv([[float((a * b).sum()) for b in two] for a in one]))


@dataclass(frozen=True)
class _TangentSpace:
    """Directions that the slip set permits: any for sticking cells, the tangent of the disc for slipping cells.

    slips : (n,). normal : (2, n), of the discs, zero for sticking cells. curvature : (n,), lambda / g [m/Pa].
    constraint : None if no force is given.
    """

    slips: BoolArray
    normal: FloatArray
    curvature: FloatArray
    preconditioner: DirectionalPreconditioner
    constraint: _ForceConstraint | None

    @classmethod
    def of(cls, reduced: _ReducedProblem, slips: BoolArray, normal: FloatArray, residual: FloatArray) -> _TangentSpace:
        """Prepare the space for a slip set (n,), the normals (2, n) of its discs and the displacement residual."""
        curvature = np.where(slips, np.maximum((residual * normal).sum(0), 0.0) / reduced.bound, 0.0)
        preconditioner = reduced.preconditioner.on(reduced.numbers, slips, normal, curvature)
        space = cls(slips, normal, curvature, preconditioner, None)
        return space if reduced.problem.traction_sum is None else replace(space, constraint=_ForceConstraint.of(space))

    def tangential(self, values: FloatArray) -> FloatArray:
        """Remove the part of `values` (2, n) along the normals of the discs."""
        return np.asarray(values - self.normal * (self.normal * values).sum(0))

    def shift(self, values: FloatArray) -> FloatArray:
        """Return the shift (2,) that removes the mean of displacements (2, n) in the tangent space."""
        return np.zeros(2) if self.constraint is None else -self.constraint.coefficients(values, self.constraint.gram)

    def project(self, values: FloatArray) -> FloatArray:
        """Return the part of displacements (2, n) that a step in the space can change."""
        return self.tangential(values + self.shift(values)[:, None])

    def precondition(self, values: FloatArray) -> FloatArray:
        """Apply an approximate inverse of the stiffness: displacements (2, n) to tractions (2, n) without a force."""
        out = self.tangential(self.preconditioner.apply(values))
        if self.constraint is None:
            return out
        first, second = self.constraint.coefficients(out, self.constraint.mixed)
        return out - first * self.constraint.responses[0] - second * self.constraint.responses[1]


def _full_step(reduced: _ReducedProblem, state: _State, goal: float) -> tuple[FloatArray, FloatArray] | None:
    """Return new tractions and their displacement after a full Newton step; None if it raises the energy."""
    traction, residual = state.traction, state.displacement_residual
    length = np.hypot(*traction)
    slips = (length >= (1 - _ON_DISC) * reduced.bound) & ((residual * traction).sum(0) > 0)
    normal = np.where(slips, traction / np.where(slips, length, 1.0), 0.0)
    step = _solve_linear(reduced, _TangentSpace.of(reduced, slips, normal, residual), traction, residual, goal)
    return _backtrack(reduced, state, step, trials=1)


def _damped_step(reduced: _ReducedProblem, state: _State, goal: float) -> tuple[FloatArray, FloatArray] | None:
    """Return new tractions and their displacement after a damped step; None if no step lowers the energy.

    The cells of the predicted slip set jump to their discs before the Newton step, which costs one more convolution.
    """
    traction, residual = state.traction, state.displacement_residual
    trial = traction + reduced.stiffness * residual
    # a single cell is far stiffer than a spot that moves as a whole: cells that would turn around are freed first
    slips = state.slips & ((trial * traction).sum(0) > 0)
    normal = np.where(slips, trial / np.where(slips, np.hypot(*trial), 1.0), 0.0)
    jump = np.where(slips, reduced.bound * normal - traction, 0.0)
    if reduced.problem.traction_sum is not None and not slips.all():  # sticking cells take the opposite force
        jump -= np.where(slips, 0.0, (jump.sum(1) / np.count_nonzero(~slips))[:, None])
    after_jump = residual
    if float(np.abs(jump).max()) > _ON_DISC * float(np.abs(traction).max()):
        after_jump = residual - reduced.gather(reduced.displace(jump))
    space = _TangentSpace.of(reduced, slips, normal, residual)
    step = jump + _solve_linear(reduced, space, traction + jump, after_jump, goal)
    return _backtrack(reduced, state, step) or _backtrack(reduced, state, reduced.stiffness * residual)


def _backtrack(
    reduced: _ReducedProblem, state: _State, step: FloatArray, trials: int = _HALVINGS
) -> tuple[FloatArray, FloatArray] | None:
    """Project the step onto the discs and halve it until the energy does not rise.

    Returns the tractions (2, n) and their displacement (2, nx, ny); None if the energy rises in all trials.
    """
    before = reduced.energy(state.traction, state.displacement)
    length = 1.0
    for _ in range(trials):
        traction, _ = reduced.project(state.traction + length * step)
        displacement = reduced.displace(traction)
        allowed_rise = _ENERGY_ROUNDING * abs(before) if length == 1 else 0.0
        if reduced.energy(traction, reduced.gather(displacement)) <= before + allowed_rise:
            return traction, displacement
        length *= 0.5
    return None


def _solve_linear(
    reduced: _ReducedProblem, space: _TangentSpace, traction: FloatArray, residual: FloatArray, goal: float
) -> FloatArray:
    """Return the step (2, n) in the tangent space that removes the displacement residual, by conjugate gradients.

    The iteration ends at `goal` [m], or where the projection onto the discs would bring back more than is left.
    """
    step, full_residual = np.zeros_like(residual), residual.copy()
    residual = space.project(residual)
    # violations are measured on the discs: a slipping cell with a small disc and a large slip is compliant
    damping = 1 / (1 + space.curvature * reduced.stiffness)
    first = _norm(damping * residual)
    direction = space.precondition(residual)
    product = float((residual * direction).sum())
    for _ in range(_CG_ITERATIONS):
        if not product > 0:
            break
        displacement = reduced.gather(reduced.displace(direction))
        response = displacement + space.curvature * direction
        curvature = float((direction * response).sum())
        if not curvature > _FLAT * float((direction * direction).sum()) / reduced.stiffness:
            # a mean traction on a doubly periodic grid displaces nothing: only the discs limit the step
            return step + direction * (2 * float(reduced.bound.max()) / float(np.abs(direction).max()))
        length = product / curvature
        step += length * direction
        full_residual -= length * displacement
        residual = residual - length * space.project(response)
        damped = damping * residual
        left = _norm(damped)
        if left <= _REDUCTION * first or float(np.abs(damped).max()) <= goal:
            break
        if left <= _LEAST_REDUCTION * first:
            elastic = full_residual - space.curvature * step
            if left <= _PROJECTION * _residual_after_projection(reduced, space, traction + step, elastic):
                break
        preconditioned = space.precondition(residual)
        following = float((residual * preconditioned).sum())
        direction = preconditioned + (following / product) * direction
        product = following
    return step


def _residual_after_projection(
    reduced: _ReducedProblem, space: _TangentSpace, traction: FloatArray, residual: FloatArray
) -> float:
    """Estimate the residual [m] that the projection onto the discs and cells that stop slipping bring back."""
    excess = np.maximum(np.hypot(*traction) - reduced.bound, 0.0)
    outward = ((residual + space.shift(residual)[:, None]) * space.normal).sum(0)
    released = np.where(space.slips, np.minimum(outward, 0.0), 0.0)
    return math.hypot(_norm(excess) / reduced.stiffness, _norm(released))


def _norm(values: FloatArray) -> float:
    return math.sqrt(float((values * values).sum()))
