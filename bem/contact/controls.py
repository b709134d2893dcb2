"""The prescribed quantity: load, approach, or mean gap. Constraints on one algorithm.

The part of steps 3, 7, 9 and 10 of `bem.contact` that depends on the prescribed quantity: the approach of a pressure,
the projection onto the feasible set, the restoration of the prescribed quantity, the constraint on search directions of
`gcr`, and the transfer to another grid. `pcg` has the constraint of a prescribed load built in (`zero_sum`). All
numbers are in the solver's units: forces are sums of scaled pressures, lengths are scaled gaps.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from bem.contact.bounds import Iterate, clip_to_bounds, clip_to_load, shift_to_sum, split_field
from bem.contact.grid_workspace import GridWorkspace, InitialPressure

FloatArray = NDArray[np.float64]

MOSTLY_PLASTIC_RATIO = 0.1
"""Cells between the bounds over cells at the cap, below which the contact counts as mostly plastic: the former then
determine neither the approach nor the pressures."""

_SMALLEST_FALL = 0.02
"""Smallest fall of the mean gap with the approach (one without contact) that search directions count on."""


class Control(ABC):
    """Constraint on the pressure of a contact."""

    zero_sum: ClassVar[bool] = False
    """True if search directions carry no net load."""

    uses_unit_approach: ClassVar[bool] = False
    """True if search directions are corrected by the pressure of a unit approach."""

    has_energy: ClassVar[bool] = True
    """True if the contact minimises an energy over the feasible pressures."""

    leaves_uniform_pressure: ClassVar[bool] = False
    """True if a uniform pressure, which displaces nothing where displacements have no mean, is not determined."""

    @abstractmethod
    def approach_without_contact(self, gap: FloatArray) -> float:
        """Return the approach without pressure over a gap (one-dimensional); infinite with a load."""

    @abstractmethod
    def approach(self, grid: GridWorkspace, iterate: Iterate, separation_sum: float) -> float:
        """Return the approach of a pressure whose displacement is in the grid's buffer.

        separation_sum : sum of gap + displacement over the cells between the bounds.
        """

    def potential(self, energy: float, force: float) -> float:
        """Return the minimised energy, from the energy at approach zero and the sum of pressures."""
        return energy

    def initial_iterate(self, grid: GridWorkspace, start: InitialPressure) -> Iterate:
        """Return a feasible first pressure."""
        if start is None:
            overlapping = np.flatnonzero(grid.gap < self.approach_without_contact(grid.gap))
            return Iterate(overlapping, np.zeros(overlapping.size), overlapping[:0])
        return start if isinstance(start, Iterate) else split_field(start, grid.cap)

    def keeps_load_of_squares(self, *, capped: bool, mean_free: bool) -> bool:
        """Return True if squares of 8 x 8 cells keep clipped load, False if `eliminate_tension` corrects neighbours.

        Elimination has no counterpart for pressures above a cap: their excess would be spread over the whole surface by
        the shift of `restore`. Where displacements have no mean, elimination changes the mean pressure, which hardly
        displaces anything near full contact, so that later iterations would restore it slowly.

        capped : True below a finite hardness. mean_free : True if displacements have no mean.
        """
        return capped or mean_free

    def restore(self, grid: GridWorkspace, iterate: Iterate, trial: FloatArray) -> Iterate:
        """Clip trial pressures to the bounds and restore the prescribed quantity, if the pressure determines it."""
        return clip_to_bounds(iterate, trial, grid.cap)

    def project(self, trial: FloatArray, cap: float) -> FloatArray:
        """Return the closest feasible field."""
        return np.clip(trial, 0.0, cap)

    def unit_approach_coefficient(self, grid: GridWorkspace, iterate: Iterate, unit_approach_load: float) -> float:
        """Return the multiple of the pressure of a unit approach that `gcr` subtracts from a direction of unit sum.

        The pressure of a unit approach is the preconditioner applied to a uniform unit displacement;
        `unit_approach_load` is its sum.
        """
        return 0.0

    def approach_change(self, response: FloatArray, grid: GridWorkspace, iterate: Iterate) -> float:
        """Return the change of the approach by a direction of `gcr`.

        response : displacement on the active cells; the grid's single-precision buffer has the displacement everywhere.
        """
        return 0.0

    def on_coarser(self, gap: FloatArray, coarse_gap: FloatArray, *, force_factor: float, mean_free: bool) -> Control:
        """Return the control on a coarser grid.

        gap, coarse_gap : of both grids. force_factor : ratio of sums of pressures. mean_free : as above.
        """
        return self


@dataclass(frozen=True)
class LoadControl(Control):
    """Prescribed sum of pressures; the approach is its Lagrange multiplier."""

    force: float

    zero_sum: ClassVar[bool] = True
    uses_unit_approach: ClassVar[bool] = True

    def approach_without_contact(self, gap: FloatArray) -> float:
        """Return zero without a load, infinity with a load."""
        return 0.0 if self.force == 0 else math.inf

    def approach(self, grid: GridWorkspace, iterate: Iterate, separation_sum: float) -> float:
        """Return the mean of gap + displacement over the cells between the bounds: an estimate of the multiplier.

        Where hardly any cell is between the bounds, return the least approach at which no cell violates its state: the
        largest separation of a cell with pressure. If an open cell or one between the bounds has a smaller separation,
        there is no such approach, and the midpoint between both separations minimises the largest violation.
        """
        if iterate.cells.size > MOSTLY_PLASTIC_RATIO * iterate.capped.size:
            return separation_sum / iterate.cells.size
        largest, smallest = grid.separations(iterate)
        return largest if largest <= smallest else 0.5 * (largest + smallest)

    def initial_iterate(self, grid: GridWorkspace, start: InitialPressure) -> Iterate:
        """Return the start brought to the load by `restore`, or a uniform pressure.

        With a hardness the start is shifted and clipped, which may change its set; without one it is scaled.
        """
        if start is not None:
            iterate = start if isinstance(start, Iterate) else split_field(start, grid.cap)
            if iterate.cells.size or iterate.capped.size:
                return self.restore(grid, iterate, iterate.values)
        cells = np.arange(grid.gap.size)
        return Iterate(cells, np.full(cells.size, self.force / cells.size), cells[:0])

    def keeps_load_of_squares(self, *, capped: bool, mean_free: bool) -> bool:
        """Return True below a finite hardness; elastic load is restored by scaling all pressures."""
        return capped

    def restore(self, grid: GridWorkspace, iterate: Iterate, trial: FloatArray) -> Iterate:
        """Restore the load within the bounds.

        Without a hardness the trial is clipped, then scaled. With one the unclipped trial is shifted uniformly, then
        clipped.
        """
        return clip_to_load(iterate, trial, grid.cap, self.force, grid.gap.size)

    def project(self, trial: FloatArray, cap: float) -> FloatArray:
        """Return the closest field within the bounds that carries the load."""
        return shift_to_sum(trial, self.force, cap if math.isfinite(cap) else self.force)

    def unit_approach_coefficient(self, grid: GridWorkspace, iterate: Iterate, unit_approach_load: float) -> float:
        """Return the coefficient that leaves no net load."""
        return 1 / unit_approach_load

    def approach_change(self, response: FloatArray, grid: GridWorkspace, iterate: Iterate) -> float:
        """Return the mean response of the active cells."""
        return float(response.mean())

    def on_coarser(
        self, gap: FloatArray, coarse_gap: FloatArray, *, force_factor: float, mean_free: bool
    ) -> LoadControl:
        """Scale the force, which is a sum over cells."""
        return LoadControl(self.force * force_factor)


@dataclass(frozen=True)
class ApproachControl(Control):
    """Prescribed approach; the pressure is constrained by its bounds only."""

    distance: float

    leaves_uniform_pressure: ClassVar[bool] = True

    def approach_without_contact(self, gap: FloatArray) -> float:
        """Return the prescribed approach."""
        return self.distance

    def approach(self, grid: GridWorkspace, iterate: Iterate, separation_sum: float) -> float:
        """Return the prescribed approach."""
        return self.distance

    def potential(self, energy: float, force: float) -> float:
        """Return the energy less the work of the approach."""
        return energy - self.distance * force

    def on_coarser(
        self, gap: FloatArray, coarse_gap: FloatArray, *, force_factor: float, mean_free: bool
    ) -> ApproachControl:
        """Keep the distance from the mean gap where displacements have no mean: full contact is reached there."""
        return ApproachControl(self.distance + float(coarse_gap.mean() - gap.mean())) if mean_free else self


@dataclass(frozen=True)
class MeanGapControl(Control):
    """Prescribed mean of the positive part of the deformed gap; the approach follows from the displacement.

    The gap vanishes in elastic contact. The mean gap is therefore the mean of gap + displacement less the approach over
    the cells below the cap, times the fraction of these cells. Every cell changes the approach: there is no energy.
    """

    mean_gap: float

    uses_unit_approach: ClassVar[bool] = True
    has_energy: ClassVar[bool] = False

    def approach_without_contact(self, gap: FloatArray) -> float:
        """Return the approach that closes the undeformed gap to the prescribed mean."""
        return float(gap.mean()) - self.mean_gap

    def approach(self, grid: GridWorkspace, iterate: Iterate, separation_sum: float) -> float:
        """Return the approach that gives the mean gap."""
        opening = grid.mean_below_cap(grid.gap + grid.displacement_values, iterate.capped)
        return opening - self.mean_gap * grid.gap.size / max(1, grid.gap.size - iterate.capped.size)

    def unit_approach_coefficient(self, grid: GridWorkspace, iterate: Iterate, unit_approach_load: float) -> float:
        """Return the negative coefficient by which the approach follows the mean displacement."""
        displacement_per_force = grid.mean_displacement_per_force(iterate)
        return -displacement_per_force / max(1 - displacement_per_force * unit_approach_load, _SMALLEST_FALL)

    def approach_change(self, response: FloatArray, grid: GridWorkspace, iterate: Iterate) -> float:
        """Return the mean response of the cells below the cap."""
        return grid.mean_below_cap(grid.single_field.reshape(-1), iterate.capped)


def scaled_control(
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    *,
    cell_force: float,
    length: float,
    datum: float,
) -> Control:
    """Return the prescribed quantity in the solver's units.

    cell_force : force of a cell at unit pressure [N]. length : unit of length [m]. datum : offset of the gap [m].
    """
    if load is not None:
        return LoadControl(load / cell_force)
    if approach is not None:
        return ApproachControl((approach - datum) / length)
    assert mean_gap is not None
    return MeanGapControl(mean_gap / length)
