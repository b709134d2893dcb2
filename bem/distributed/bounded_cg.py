"""Bounded conjugate gradients on slabs: the pressure at an approach, and the approach of a load.

At an approach d the pressure minimises E(p) = p.Kp/2 + p.(g - d) subject to 0 <= p <= hardness. An iteration, with the
deformed gap h = g + Kp - d:

1. The active cells are those between the bounds and those at a bound that violate it: open cells that overlap, and
   cells at the hardness whose gap opens. The residual is -h there.
2. The direction is the preconditioned residual on the active cells, plus the last direction there times Polak and
   Ribiere's coefficient, not less than zero. The preconditioner convolves with the stiffness of harmonic waves
   (Vollebregt 2014), so iterations hardly grow with the number of cells.
3. The step minimises the energy along the direction. Where it leaves the bounds, the pressure is projected onto them
   (Polonsky and Keer 1999). Where that goes far beyond the minimum of energy on the segment between both, on which the
   displacement is linear, the step is shortened to this minimum.
4. Where the projected step does not lower the energy, a projected gradient step takes its place, of length one over the
   largest response: it always lowers the energy. So no step raises it.

A load is met by the approach: whenever the violation is small against the error of the load, a secant step within a
bracket gives the next approach. The load rises with the approach, so there is one answer.

On a doubly periodic grid a uniform pressure displaces nothing, and near full contact the load runs away with the
approach. K therefore has a compliance c of the mean there: c F, with F the sum of the pressures, is added to the
displacement of all cells, and to the approach. The deformed gap is the same, the energy strictly convex. A prescribed
approach is then searched as a load is.

The approach, not a shift of the pressures, meets the load: with a hardness a uniform shift displaces far more than it
mends, and the iteration hardly converges.

Cost: an iteration takes two convolutions in single precision, one more in double precision where it projects, and two
where the projected step is rejected.

Sources: Polonsky and Keer, Wear 231 (1999) 206; Vollebregt, J. Comput. Phys. 257 (2014) 333; neither original was at
hand, the algorithm follows from the energy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.distributed.convolution import SlabConvolution
from bem.distributed.ranks import reduce_rows

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

_LEAST_FRACTION = 0.02
"""Least fraction of a projected step that is taken; below it a gradient step follows."""

_WHOLE_STEP_FRACTION = 2 / 3
"""Fraction of a projected step at the minimum of energy from which on the whole step is taken. It still takes off a
quarter of the first slope (Armijo's condition), and cells reach their bounds; shortened steps keep them a bit off."""

_CLOSED_BRACKET = 1e-12
"""Width of a bracket of approaches, over the approach, at which it is closed: above rounding."""

_REFRESH_REDUCTION = 1e-4
"""Fall of the residual after which the displacement is computed in double precision again: responses in single
precision add errors of about 1e-6 of what the residual was."""

_STALL_ITERATIONS = 150
"""Iterations without a violation lower by a tenth after which the solution stops."""


@dataclass(frozen=True)
class SlabProblem:
    """Own rows of a contact problem.

    convolution : of the bodies. gap : (own rows, ny), lowest value of all ranks zero [m]. cap : highest pressure [Pa].
    """

    convolution: SlabConvolution
    gap: FloatArray
    cap: float

    def reduce(self, sums: tuple[FloatArray, ...] = (), maxima: tuple[FloatArray, ...] = ()) -> tuple[list[float], ...]:
        """Return sums and maxima over all rows of all ranks, from values of own rows (own rows,)."""
        return reduce_rows(self.convolution.ranks, self.convolution.grid.shape[0], sums, maxima)


class Iterate(NamedTuple):
    """A pressure within the bounds and its displacement, own rows.

    exact : True if the displacement was computed in double precision, not summed from responses in single precision.
    """

    pressure: FloatArray
    displacement: FloatArray
    exact: bool = True


class Direction(NamedTuple):
    """Search direction of an iteration, own rows, in single precision.

    residual : negative gap of the active cells from which the direction follows. product : of that residual with the
    preconditioned one, over all ranks.
    """

    values: NDArray[np.float32]
    residual: NDArray[np.float32]
    product: float


@dataclass
class ApproachSearch:
    """Search for the approach at which the load, or the approach without the mean compliance, is the prescribed one.

    approach : present value [m], above the gap's lowest value, with the mean compliance.
    target : prescribed sum of pressures [Pa], or prescribed approach [m].
    controls_load : which of both is prescribed.
    compliance : displacement of all cells per sum of pressures [m/Pa], that of `ColumnSpectra.mean_compliance`.
    length : change of the approach that changes the load by its own size, the unit of errors of an approach [m].
    ratio : violation over the error below which the pressure is exact enough for a change of the approach.
    """

    approach: float
    target: float
    controls_load: bool
    compliance: float
    length: float
    ratio: float = 0.3
    _bracket: tuple[float, float] = (-math.inf, math.inf)
    _last: tuple[float, float] | None = None

    def error(self, pressure_sum: float) -> float:
        """Return the relative error of the prescribed quantity, with its sign, from the sum of pressures."""
        if self.controls_load:
            return (pressure_sum - self.target) / self.target
        return (self.true_approach(pressure_sum) - self.target) / self.length

    def true_approach(self, pressure_sum: float) -> float:
        """Return the approach without the mean compliance [m]."""
        return self.approach - self.compliance * pressure_sum

    def is_due(self, error: float, violation: float) -> bool:
        """Return True if the violation, over its reference, is small against the error."""
        return violation <= self.ratio * min(1.0, abs(error))

    def advance(self, error: float) -> None:
        """Change the approach after an error: a secant step within the bracket, else bisection.

        Pressures that still violate the contact conditions may bracket wrongly. A bracket that has closed before the
        error is met is opened again, and pressures are then asked to be ten times as exact.
        """
        present = self.approach
        low, high = self._bracket
        low, high = (max(low, present), high) if error < 0 else (low, min(high, present))
        if high - low <= _CLOSED_BRACKET * abs(present):
            self.ratio *= 0.1
            (low, high), self._last = (-math.inf, math.inf), None
        step = -error * self.length
        if self.controls_load:  # two thirds: a ball's load grows as approach^(3/2)
            step = -error * (min(self.length, 2 / 3 * present) + self.compliance * self.target)
        if self._last is not None and self._last[1] != error:
            step = -error * (present - self._last[0]) / (error - self._last[1])
        trial = present + step
        if not low < trial < high or step * error >= 0:
            outer = high if error < 0 else low
            trial = 0.5 * (present + outer) if math.isfinite(outer) else present - math.copysign(self.length, error)
        self._last, self.approach, self._bracket = (present, error), trial, (low, high)


@dataclass(frozen=True)
class BoundedResult:
    """Outcome of `solve_bounded`.

    iterate : the last one. approach : without the mean compliance, above the gap's lowest value [m].
    iterations : number of them. stalled : True if the violation ceased to fall before the tolerance was met.
    """

    iterate: Iterate
    approach: float
    iterations: int
    stalled: bool


def solve_bounded(
    problem: SlabProblem,
    search: ApproachSearch,
    pressure: FloatArray,
    *,
    tolerance: float,
    violation_scale: Callable[[float], float],
    max_iterations: int,
    callback: Callable[[int, float, float], object] | None = None,
) -> BoundedResult:
    """Iterate until the largest violation and the error of the load meet the tolerance; collective.

    pressure : first own rows, within the bounds [Pa].
    violation_scale : returns the length [m] that violations are relative to, from the largest displacement [m].
    callback : called with iterations, residual and the fraction of cells in contact.
    """
    iterate = Iterate(pressure, problem.convolution.displacement(pressure))
    direction: Direction | None = None
    best, since, last_exact = math.inf, 0, math.inf
    for iteration in range(max_iterations + 1):
        deformed = problem.gap + iterate.displacement - search.approach
        (pressure_sum, loaded), (violation, displacement) = problem.reduce(
            (iterate.pressure.sum(axis=1), (iterate.pressure > 0).sum(axis=1)),
            (
                violations_of_rows(iterate.pressure, deformed, problem.cap),
                np.maximum(iterate.displacement.max(axis=1), -iterate.displacement.min(axis=1)),
            ),
        )
        scale, error = violation_scale(displacement), search.error(pressure_sum)
        residual, approach = max(max(violation, 0.0) / scale, abs(error)), search.true_approach(pressure_sum)
        if callback is not None:
            callback(iteration, residual, loaded / problem.convolution.grid.cells)
        last_exact = residual if iterate.exact else last_exact
        if not iterate.exact and (residual <= tolerance or residual < _REFRESH_REDUCTION * last_exact):
            iterate = Iterate(iterate.pressure, problem.convolution.displacement(iterate.pressure))
            continue
        if residual <= tolerance:
            return BoundedResult(iterate, approach, iteration, stalled=False)
        best, since = (residual, 0) if residual < 0.9 * best else (best, since + 1)
        if since > _STALL_ITERATIONS:
            return BoundedResult(iterate, approach, iteration, stalled=True)
        if abs(error) > tolerance and search.is_due(error, violation / scale):
            search.advance(error)
            direction = None
            continue
        iterate, direction = _step(problem, iterate, deformed, direction)
    return BoundedResult(iterate, approach, max_iterations, stalled=False)


def violations_of_rows(pressure: FloatArray, deformed: FloatArray, cap: float) -> FloatArray:
    """Return the largest violation of the contact conditions in each row [m]; negative where no cell violates one.

    Cells below the cap must not overlap, cells with pressure must not gape.
    """
    overlap = np.where(pressure < cap, -deformed, -math.inf).max(axis=1)
    return np.maximum(overlap, np.where(pressure > 0, deformed, -math.inf).max(axis=1))


def _active(problem: SlabProblem, pressure: FloatArray, deformed: FloatArray) -> BoolArray:
    """Return True for cells between the bounds and for those that violate the bound they are at."""
    return np.where(pressure <= 0, deformed < 0, (pressure < problem.cap) | (deformed > 0))


def _step(
    problem: SlabProblem, iterate: Iterate, deformed: FloatArray, last: Direction | None
) -> tuple[Iterate, Direction | None]:
    """Take a step of conjugate gradients, projected onto the bounds, or a gradient step where that does not help."""
    pressure = iterate.pressure
    active = _active(problem, pressure, deformed)
    residual = np.where(active, -deformed, 0.0)
    preconditioned = np.where(active, problem.convolution.precondition(residual), 0.0)
    if last is None:
        (product,), _ = problem.reduce((np.vecdot(preconditioned, residual),))
        values, slope = preconditioned, product
    else:
        last_direction = np.where(active, last.values, 0.0)
        (product, last_product, last_slope), _ = problem.reduce(
            (
                np.vecdot(preconditioned, residual),
                np.vecdot(preconditioned, last.residual),
                np.vecdot(last_direction, residual),
            )
        )
        coefficient = max(0.0, (product - last_product) / last.product)  # Polak and Ribiere's
        if product + coefficient * last_slope <= 0:
            coefficient = 0.0
        values, slope = preconditioned + coefficient * last_direction, product + coefficient * last_slope
    response = problem.convolution.response(values)
    (curvature,), _ = problem.reduce((np.vecdot(values, response),))
    if not (curvature > 0 and slope > 0):
        return _gradient_step(problem, iterate, deformed), None
    length = slope / curvature
    trial = pressure + length * values
    bounded = np.clip(trial, 0.0, problem.cap)
    (outside,), _ = problem.reduce(((trial != bounded).sum(axis=1),))
    direction = Direction(values.astype(np.float32), residual.astype(np.float32), product)
    if outside == 0:
        return Iterate(trial, iterate.displacement + length * response, exact=False), direction
    del trial, response, values, residual, preconditioned
    projected = _minimum_on_segment(problem, iterate, deformed, bounded)
    if projected is None:
        return _gradient_step(problem, iterate, deformed), None
    return projected, direction


def _gradient_step(problem: SlabProblem, iterate: Iterate, deformed: FloatArray) -> Iterate:
    """Return the projected gradient step, or the iterate itself where rounding leaves none."""
    trial = iterate.pressure - deformed / problem.convolution.spectra.largest
    projected = _minimum_on_segment(problem, iterate, deformed, np.clip(trial, 0.0, problem.cap), least=0.0)
    return iterate if projected is None else projected


def _minimum_on_segment(
    problem: SlabProblem, iterate: Iterate, deformed: FloatArray, end: FloatArray, least: float = _LEAST_FRACTION
) -> Iterate | None:
    """Return the iterate of least energy between an iterate and another pressure; None if it is near the iterate.

    end : the other pressure, own rows [Pa]; it is taken where the energy hardly rises again before it.
    least : fraction of the way below which the result is None.
    """
    end_displacement = problem.convolution.displacement(end)
    change, change_of_displacement = end - iterate.pressure, end_displacement - iterate.displacement
    (slope, curvature), _ = problem.reduce((np.vecdot(change, deformed), np.vecdot(change, change_of_displacement)))
    if not (slope < 0 and curvature > 0) or -slope <= least * curvature:
        return None
    fraction = -slope / curvature
    if fraction >= _WHOLE_STEP_FRACTION:
        return Iterate(end, end_displacement)
    return Iterate(iterate.pressure + fraction * change, iterate.displacement + fraction * change_of_displacement)
