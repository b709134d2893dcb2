"""Boundary friction: the shear stress of surfaces in contact over their pressure and sliding speed.

To add a law, derive from `BoundaryFriction` and register it, here or in a file of your own. A number in its place is a
constant coefficient.

The force is the sum of the shear stress over the contact. The cells in contact count for the real area, which is known
to second order in the cell while their number is not: of each the same part is in contact, under a pressure higher by
as much, so that load and area are those of the contact.

Where one number must stand for all of the contact there are two rules. Traction in the normal gap takes the coefficient
at the pressure that rough contacts have by themselves (`reference_pressure`), known before any contact is solved, so
that one operator serves all of them; stresses below the surface take the contact's own mean, force over load.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from bem.grid import FloatArray, Grid
from bem.laws import Law, make_laws, parameter, register


@dataclass(frozen=True)
class BoundaryFriction(Law):
    """Shear stress of surfaces in contact."""

    family: ClassVar[str] = "boundary_friction"

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """Magnitude [Pa], shape (...), where surfaces in contact under pressures (...) [Pa], all positive, slide over
        each other at a speed [m/s], positive."""
        raise NotImplementedError

    @property
    def constant(self) -> float | None:
        """The coefficient where it is the same at all pressures and speeds, else None."""
        return None

    def coefficient(self, pressure: float, sliding_speed: float) -> float:
        """Shear stress over pressure at one pressure [Pa]."""
        if self.constant is not None:
            return self.constant
        return float(self.shear_stress(np.array([pressure]), sliding_speed)[0] / pressure)

    def mean_coefficient(self, pressure: FloatArray, filled: float, sliding_speed: float) -> float:
        """Force over load of a contact: pressure (nx, ny) [Pa] of the cells, the part `filled` of those in contact."""
        if self.constant is not None:
            return self.constant
        return float(self.cell_stress(pressure, filled, sliding_speed).sum() / pressure.sum())

    def cell_stress(self, pressure: FloatArray, filled: float, sliding_speed: float) -> FloatArray:
        """Shear force over the area of each cell [Pa], as `mean_coefficient`; zero where there is no contact."""
        if self.constant is not None:
            return self.constant * pressure
        stress = np.zeros_like(pressure)
        touching = pressure > 0
        stress[touching] = filled * self.shear_stress(pressure[touching] / filled, sliding_speed)
        return stress


@register
@dataclass(frozen=True)
class ConstantFriction(BoundaryFriction):
    """In proportion to the pressure: Amontons and Coulomb."""

    name: ClassVar[str] = "constant"
    friction: float = parameter("coefficient of friction", at_least=0)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """Coefficient times pressure."""
        return self.friction * pressure

    @property
    def constant(self) -> float:
        """The coefficient."""
        return self.friction


@register
@dataclass(frozen=True)
class PressureDependentShear(BoundaryFriction):
    """tau = tau_0 + a p, of thin films of polymers and soaps; Briscoe and Tabor, J. Adhesion 9 (1978) 145.

    A load W on a real area A makes a coefficient of a + tau_0 A / W, which falls with the load where the area grows
    more slowly.
    """

    name: ClassVar[str] = "pressure_dependent"
    shear_strength: float = parameter("tau_0, shear strength without pressure", "Pa", at_least=0)
    pressure_coefficient: float = parameter("a, its slope with pressure", at_least=0, at_most=2)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """tau_0 + a p."""
        return self.shear_strength + self.pressure_coefficient * pressure


BoundaryFrictionGiven = float | str | Mapping[str, object] | BoundaryFriction
"""A coefficient, the name of a law that needs no parameters, a table with `kind` and parameters, or a law."""


def boundary_law(value: BoundaryFrictionGiven) -> BoundaryFriction:
    """The law that a number, a name, a table or a law means.

    Raises
    ------
    InputError : an unknown law, or parameters missing or out of bounds.
    """
    if isinstance(value, (int, float, np.integer, np.floating)):
        value = {"kind": ConstantFriction.name, "friction": value}
    made = make_laws("boundary_friction", {BoundaryFriction.family: value}, {})
    return cast(BoundaryFriction, made[BoundaryFriction.family])


def filled_part(pressure: FloatArray, area: float, grid: Grid) -> float:
    """Real contact area [m^2] of a patch over the area of its cells in contact; 1 where there are none."""
    cells = int(np.count_nonzero(pressure > 0))
    return area / (cells * grid.cell_area) if cells and area > 0 else 1.0


def reference_pressure(
    height: FloatArray, grid: Grid, contact_modulus: float, smooth: float, hardness: float | None
) -> float:
    """Mean pressure [Pa] that a rough contact has whatever its load: E* h' / 2, h' the rms slope of the height (nx, ny)
    [m], since the real area is close to 2 W / (E* h') (1.6 to 2.5: Persson (2001); Bush, Gibson and Thomas (1975);
    Hyun et al. (2004)); at least `smooth`, the mean
    pressure of the smooth contact [Pa], at most the hardness."""
    slopes = [
        float(np.mean((np.diff(height, axis=axis) / grid.spacing[axis]) ** 2))
        for axis in (0, 1)
        if height.shape[axis] > 1
    ]
    rough = 0.5 * contact_modulus * float(np.sqrt(sum(slopes)))
    pressure = max(rough, smooth)
    return pressure if hardness is None else min(pressure, hardness)
