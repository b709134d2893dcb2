"""Problem of partial slip on one grid, checks of arguments, and the scales of displacements.

`rolling` has the same arguments and scales.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.contact import ContactSolution
from bem.errors import InfeasibleError, InputError
from bem.grid import FloatArray, Grid
from bem.tangential.friction_laws import SlipFriction
from bem.tangential.operator import TangentialOperator

_ROUNDING = 1e-6
"""Fraction of the largest imposed movement below which displacements are rounding: a single cell with pressure and
without force does not move, while the surfaces around it do."""


@dataclass(frozen=True)
class SlipProblem:
    """Partial slip on one grid.

    bound : (nx, ny), friction x pressure [Pa].
    imposed : (2, nx, ny), imposed displacement b without an unknown shift [m].
    traction_sum : (2,), sum of the tractions over the cells, the force over the area of a cell [Pa]; None if the shift
        is prescribed and part of `imposed`.
    """

    operator: TangentialOperator
    bound: FloatArray
    imposed: FloatArray
    traction_sum: FloatArray | None


def displacement_scale(*fields: FloatArray, least: float) -> float:
    """Return the length [m] to which violations are relative: the largest value of the fields, and at least `least`."""
    return max(least, *(float(np.abs(field).max(initial=0.0)) for field in fields))


def rounding_scale(*movements: FloatArray) -> float:
    """Return the displacement [m] that counts as rounding if these are the movements of the bodies on the grid."""
    return _ROUNDING * max(float(np.abs(movement).max(initial=0.0)) for movement in movements)


def check_settings(rotation: float, tolerance: float, max_iterations: int) -> None:
    """Refuse an infinite rotation, a tolerance outside (0, 1) and a negative limit of iterations (InputError)."""
    messages = []
    if not math.isfinite(rotation):
        messages.append(f"rotation: {rotation!r} must be a finite angle [rad]")
    if not (math.isfinite(tolerance) and 0 < tolerance < 1):
        messages.append(f"tolerance: {tolerance!r} must lie between 0 and 1")
    if not (isinstance(max_iterations, int) and max_iterations >= 0):
        messages.append(f"max_iterations: {max_iterations!r} must be a whole number >= 0")
    if messages:
        raise InputError(messages)


def check_vectors(
    vectors: dict[str, Sequence[float] | None], messages: list[str]
) -> tuple[FloatArray | None, FloatArray | None]:
    """Return two vectors by name as arrays (2,); add a message for each that is not two finite numbers."""
    arrays = []
    for name, given in vectors.items():
        array = None if given is None else np.asarray(given, dtype=np.float64)
        if array is not None and not (array.shape == (2,) and np.isfinite(array).all()):
            messages.append(f"{name}: {given!r} must be two finite numbers, along x and y")
        arrays.append(array)
    return arrays[0], arrays[1]


@dataclass(frozen=True)
class LocalFriction:
    """Law of friction on the cells in contact.

    pressure : (n,) [Pa]. filled : contact area over that of its cells. The fraction `filled` of every cell touches,
    under a pressure that is higher in proportion, so that the largest force under a constant shear strength is the
    strength times the contact area, of second order; friction x pressure does not depend on `filled`.
    """

    law: SlipFriction
    pressure: FloatArray
    filled: float

    @classmethod
    def of(cls, law: SlipFriction, contact: ContactSolution | FloatArray, pressure: FloatArray) -> LocalFriction:
        """Collect the cells in contact of a pressure (nx, ny) [Pa]; `filled` is 1 if the contact is a pressure only."""
        filled = 1.0
        if isinstance(contact, ContactSolution) and contact.counted_area > 0 and contact.contact_area > 0:
            filled = contact.contact_area / contact.counted_area
        return cls(law, pressure[pressure > 0], filled)

    def bound(self, slip_speed: FloatArray) -> FloatArray:
        """Return the largest traction (n,) [Pa] at slip speeds (n,) [m/s].

        Raises
        ------
        InputError : a bound that is negative, not finite, or of another shape.
        """
        bound = np.asarray(self.law.traction_bound(self.pressure / self.filled, slip_speed), dtype=np.float64)
        if bound.shape != self.pressure.shape or not (np.isfinite(bound).all() and (bound >= 0).all()):
            raise InputError(f"friction: the law {self.law.name!r} must give finite bounds >= 0, one for each cell")
        return self.filled * bound

    def slope(self, slip_speed: FloatArray) -> FloatArray:
        """Return the derivative of the bound with respect to the slip speed, (n,) [Pa s/m]."""
        return self.filled * np.asarray(self.law.slope(self.pressure / self.filled, slip_speed), dtype=np.float64)


def friction_bound(
    contact: ContactSolution | FloatArray, grid: Grid, friction: float | FloatArray | SlipFriction
) -> tuple[FloatArray, FloatArray]:
    """Return the pressure [Pa] and the largest traction without slip [Pa], both (nx, ny).

    Raises
    ------
    InputError : a pressure that is not this grid's, negative or not finite; a friction that is negative or no map.
    """
    given = contact.pressure if isinstance(contact, ContactSolution) else contact
    pressure = grid.check_field(given, "contact")
    messages = []
    if (pressure < 0).any():
        messages.append(f"contact: pressures must not be negative; the least is {float(pressure.min())!r} Pa")
    if isinstance(friction, SlipFriction):
        if messages:
            raise InputError(messages)
        local, bound = LocalFriction.of(friction, contact, pressure), np.zeros(grid.shape)
        bound[pressure > 0] = local.bound(np.zeros_like(local.pressure))
        return pressure, bound
    factor = np.asarray(friction, dtype=np.float64)
    if factor.shape not in ((), grid.shape):
        messages.append(f"friction: shape {factor.shape!r} must be a number or a map of shape {grid.shape!r}")
    elif not (np.isfinite(factor).all() and (factor >= 0).all()):
        messages.append("friction: every coefficient must be finite and not negative")
    if messages:
        raise InputError(messages)
    return pressure, np.ascontiguousarray(np.broadcast_to(factor, grid.shape) * pressure)


def check_no_slip_speed(friction: float | FloatArray | SlipFriction, where: str) -> None:
    """Refuse a law that depends on the slip speed (InputError); `where` names the computation."""
    if isinstance(friction, SlipFriction) and friction.depends_on_speed:
        raise InputError(
            f"friction: the law {friction.name!r} depends on the slip speed, which {where} does not have; choose a law "
            "without speed, such as 'coulomb' or 'tresca'"
        )


def check_force(force: FloatArray, bound: FloatArray, grid: Grid) -> None:
    """Refuse a force (2,) [N] that friction x pressure `bound` (nx, ny) [Pa] cannot carry (InfeasibleError)."""
    limit, size = float(bound.sum()) * grid.cell_area, math.hypot(*force)
    if not size < limit and (limit > 0 or size > 0):
        raise InfeasibleError(
            f"force: {size:.6g} N must be less than friction x load = {limit:.6g} N; beyond it everything slides"
        )
