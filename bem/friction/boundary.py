"""Boundary friction: the shear stress of surfaces in contact over their pressure, sliding speed and temperature.

To add a law, derive from `BoundaryFriction` and register it, here or in a file of your own. A number in its place is a
constant coefficient.

The force is the sum of the shear stress over the contact. The real area is known to second order in the cell size, the
number of cells in contact only to first order. So the same fraction of every cell in contact is taken to touch, under a
pressure that is higher in proportion; load and area are then those of the contact (`filled_part`).

Three rules give one coefficient for the whole contact. Coupling into the normal gap takes the coefficient at the
pressure of a rough contact that hardly depends on its load (`reference_pressure`); it is known before any contact is
solved, so one operator serves all contacts. Stresses below the surface, of a wear cycle and of each position of
a life, take the mean of that contact, force over load (in a life changed by the tribofilm). What must be known before
any contact of a life, which is the rate of the energy law and growth and flash temperature of the tribofilm, takes the
coefficient at the hardness, or else at Hertz' mean pressure.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from abc import abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, cast

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.laws import Law, make_laws, parameter, register
from bem.physical_constants import BOLTZMANN

_LARGEST_EXPONENT = 100.0
"""Largest exponent of a law: far beyond any friction, and far from the end of floating point."""


@dataclass(frozen=True)
class BoundaryFriction(Law):
    """Shear stress of surfaces in contact.

    needs_temperature : whether the law depends on temperature, which `at_temperature` sets.
    temperature : of the surfaces [K]; None where it is not set.
    """

    family: ClassVar[str] = "boundary_friction"
    needs_temperature: ClassVar[bool] = False
    temperature: float | None = dataclasses.field(default=None, kw_only=True)

    def at_temperature(self, temperature: float | None) -> BoundaryFriction:
        """Return the law at the temperature of the surfaces [K], if it depends on temperature.

        Raises
        ------
        InputError : the law depends on temperature, and none is known.
        """
        if not self.needs_temperature:
            return self
        if temperature is None:
            raise InputError(
                f"boundary_friction: the {self.name} law needs the temperature of the oil; give it one "
                '(oil.temperature, or Lubricant.of("ISO VG 68", temperature=333.15))'
            )
        return dataclasses.replace(self, temperature=temperature)

    @abstractmethod
    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """Return the magnitude of the shear stress [Pa].

        pressure : (...), positive [Pa]. sliding_speed : positive [m/s].
        """

    @property
    def constant(self) -> float | None:
        """Coefficient of friction if it is the same at all pressures and speeds, else None."""
        return None

    def coefficient(self, pressure: float, sliding_speed: float) -> float:
        """Return shear stress over pressure at one pressure [Pa]."""
        if self.constant is not None:
            return self.constant
        return float(self.shear_stress(np.array([pressure]), sliding_speed)[0] / pressure)

    def mean_coefficient(self, pressure: FloatArray, filled: float, sliding_speed: float) -> float:
        """Return force over load of a contact with pressure (nx, ny) [Pa], `filled` as of `filled_part`."""
        if self.constant is not None:
            return self.constant
        return float(self.cell_stress(pressure, filled, sliding_speed).sum() / pressure.sum())

    def cell_stress(self, pressure: FloatArray, filled: float, sliding_speed: float) -> FloatArray:
        """Return shear force over area of each cell [Pa]; zero without contact. Arguments as of `mean_coefficient`."""
        if self.constant is not None:
            return self.constant * pressure
        stress = np.zeros_like(pressure)
        touching = pressure > 0
        stress[touching] = filled * self.shear_stress(pressure[touching] / filled, sliding_speed)
        return stress


@register
@dataclass(frozen=True)
class ConstantFriction(BoundaryFriction):
    """Shear stress proportional to the pressure: Amontons and Coulomb."""

    name: ClassVar[str] = "constant"
    friction: float = parameter("friction coefficient", at_least=0)

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
    cites: ClassVar[tuple[str, ...]] = ("briscoe1978",)
    shear_strength: float = parameter("shear strength tau_0 without pressure", "Pa", at_least=0)
    pressure_coefficient: float = parameter("pressure coefficient a of the shear strength", at_least=0, at_most=2)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """tau_0 + a p."""
        return self.shear_strength + self.pressure_coefficient * pressure


@register
@dataclass(frozen=True)
class PressureLimitedShear(PressureDependentShear):
    """tau = tau_0 + a p, but no more than the softer surface's own shear strength: beyond it the solid shears.

    Bowden and Tabor, *The Friction and Lubrication of Solids* (1950); the strength is about yield stress / sqrt(3), or
    hardness / 4.8.
    """

    name: ClassVar[str] = "pressure_limited"
    cites: ClassVar[tuple[str, ...]] = ("bowden1950",)
    largest_shear_stress: float = parameter(
        "largest shear stress: the shear strength of the softer body, about hardness / 4.8", "Pa", above=0
    )

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """tau_0 + a p, cut."""
        return np.minimum(super().shear_stress(pressure, sliding_speed), self.largest_shear_stress)


@register
@dataclass(frozen=True)
class SpeedDependentFriction(BoundaryFriction):
    """Shear stress proportional to the pressure; the coefficient falls with the sliding speed u: f_k + (f_s - f_k)
    exp(-(u/u_s)^n), Stribeck's curve as a law; Armstrong-Helouvry, *Control of machines with friction* (1991).

    With f_s < f_k it rises, as that of boundary films of friction modifiers.
    """

    name: ClassVar[str] = "speed_dependent"
    cites: ClassVar[tuple[str, ...]] = ("armstrong1991",)
    static_friction: float = parameter("static friction coefficient f_s", at_least=0, at_most=2)
    kinetic_friction: float = parameter("kinetic friction coefficient f_k at high speed", at_least=0, at_most=2)
    speed_scale: float = parameter("sliding speed u_s over which friction falls from static to kinetic", "m/s", above=0)
    speed_exponent: float = parameter("exponent n of the sliding speed", default=1.0, above=0, at_most=4)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The coefficient above times pressure."""
        decay = math.exp(-((sliding_speed / self.speed_scale) ** self.speed_exponent))
        return (self.kinetic_friction + (self.static_friction - self.kinetic_friction) * decay) * pressure


@register
@dataclass(frozen=True)
class TemperatureDependentFriction(BoundaryFriction):
    """Shear stress proportional to the pressure, with the coefficient f_0 exp(-c (T - T_0)) at temperature T."""

    name: ClassVar[str] = "temperature_dependent"
    needs_temperature: ClassVar[bool] = True
    friction: float = parameter("friction coefficient f_0 at the reference temperature", at_least=0)
    softening: float = parameter("relative decrease c of friction per kelvin", "1/K", at_least=-0.1, at_most=0.1)
    reference_temperature: float = parameter("reference temperature T_0", "K", above=0)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The coefficient above times pressure."""
        exponent = -self.softening * (_temperature_of(self) - self.reference_temperature)
        return self.friction * math.exp(min(exponent, _LARGEST_EXPONENT)) * pressure


@register
@dataclass(frozen=True)
class ActivatedShear(BoundaryFriction):
    """tau = [Q + p W + k_B T ln(u/u_0)] / F, thermally activated shear of a molecular film, never below zero; Briscoe
    and Evans, Proc. R. Soc. A 380 (1982) 389.

    It rises with pressure and the logarithm of the speed and falls with temperature as long as u < u_0.
    """

    name: ClassVar[str] = "activated"
    cites: ClassVar[tuple[str, ...]] = ("briscoe1982",)
    needs_temperature: ClassVar[bool] = True
    activation_energy: float = parameter("activation energy Q without pressure and shear", "J", at_least=0)
    pressure_volume: float = parameter("activation volume W of the pressure", "m^3", at_least=0)
    shear_volume: float = parameter("activation volume F of the shear stress", "m^3", above=0)
    reference_speed: float = parameter("reference speed u_0: sliding speed without a barrier", "m/s", above=0)

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The stress above."""
        thermal = BOLTZMANN * _temperature_of(self) * math.log(sliding_speed / self.reference_speed)
        stress = (self.activation_energy + self.pressure_volume * pressure + thermal) / self.shear_volume
        return np.maximum(stress, 0.0)


@dataclass(frozen=True)
class _FrictionTable(BoundaryFriction):
    """Coefficients of friction at ascending values of one variable; linear between them, constant beyond the ends."""

    coefficients: tuple[float, ...] = parameter(
        "friction coefficients of the table", at_least=0, at_most=2, several=True
    )

    @abstractmethod
    def _values(self) -> tuple[float, ...]:
        """Return the values of the variable."""

    def rules(self) -> Iterable[str]:
        """Yield messages: there must be as many values as coefficients, and they must ascend."""
        values = self._values()
        if len(values) != len(self.coefficients) or len(values) < 2:
            yield f"a table of {len(values)} values and {len(self.coefficients)} coefficients; give two or more of each"
        if any(b <= a for a, b in itertools.pairwise(values)):
            yield "the values of the table do not rise"

    def _at(self, value: FloatArray | float) -> FloatArray:
        return np.asarray(np.interp(value, self._values(), self.coefficients), dtype=np.float64)


@register
@dataclass(frozen=True)
class FrictionOverPressure(_FrictionTable):
    """Measured coefficient over the contact pressure of each cell."""

    name: ClassVar[str] = "table_over_pressure"
    pressures: tuple[float, ...] = parameter("contact pressures of the table", "Pa", at_least=0, several=True)

    def _values(self) -> tuple[float, ...]:
        return self.pressures

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The table's coefficient at the pressure, times pressure."""
        return self._at(pressure) * pressure


@register
@dataclass(frozen=True)
class FrictionOverSpeed(_FrictionTable):
    """Measured coefficient over the sliding speed."""

    name: ClassVar[str] = "table_over_speed"
    sliding_speeds: tuple[float, ...] = parameter("sliding speeds of the table", "m/s", at_least=0, several=True)

    def _values(self) -> tuple[float, ...]:
        return self.sliding_speeds

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The table's coefficient at the speed, times pressure."""
        return self._at(sliding_speed) * pressure


@register
@dataclass(frozen=True)
class FrictionOverTemperature(_FrictionTable):
    """Measured coefficient over the temperature."""

    name: ClassVar[str] = "table_over_temperature"
    needs_temperature: ClassVar[bool] = True
    temperatures: tuple[float, ...] = parameter("temperatures of the table", "K", above=0, several=True)

    def _values(self) -> tuple[float, ...]:
        return self.temperatures

    def shear_stress(self, pressure: FloatArray, sliding_speed: float) -> FloatArray:
        """The table's coefficient at the temperature, times pressure."""
        return self._at(_temperature_of(self)) * pressure


def _temperature_of(law: BoundaryFriction) -> float:
    """Return the temperature of a law [K]; InputError where it is not set."""
    return cast(float, law.at_temperature(law.temperature).temperature)


BoundaryFrictionGiven = float | str | Mapping[str, object] | BoundaryFriction
"""A coefficient, the name of a law that needs no parameters, a table with `kind` and parameters, or a law."""


def boundary_law(value: BoundaryFrictionGiven) -> BoundaryFriction:
    """Return the law that a number, a name, a table or a law stands for.

    Raises
    ------
    InputError : an unknown law, or parameters missing or out of bounds.
    """
    if isinstance(value, (int, float, np.integer, np.floating)):
        value = {"kind": ConstantFriction.name, "friction": value}
    made = make_laws("boundary_friction", {BoundaryFriction.family: value}, {})
    return cast(BoundaryFriction, made[BoundaryFriction.family])


def sliding_sign(speeds: tuple[float, float]) -> float:
    """Return 1 where the flat moves faster along x than the cylinder, or as fast; else -1."""
    return 1.0 if speeds[0] >= speeds[1] else -1.0


def filled_part(pressure: FloatArray, area: float, grid: Grid) -> float:
    """Return the real contact area [m^2] of a patch over the area of its cells in contact; 1 without contact.

    It is more than 1 where contacts of uncoupled asperities overlap: their areas add up to more than that of the cells.
    """
    cells = int(np.count_nonzero(pressure > 0))
    return area / (cells * grid.cell_area) if cells and area > 0 else 1.0


def reference_pressure(
    height: FloatArray, grid: Grid, contact_modulus: float, smooth: float, hardness: float | None
) -> float:
    """Return the mean pressure [Pa] of a rough contact, which hardly depends on its load: E* h' / 2.

    h' is the rms slope of the height (nx, ny) [m]. The real area is close to 2 W / (E* h'); the factor is 1.6 to 2.5
    (Persson 2001; Bush, Gibson and Thomas 1975; Hyun et al. 2004). The result is at least `smooth`, the mean pressure
    of the smooth contact [Pa], and at most the hardness.
    """
    slopes = [
        float(np.mean((np.diff(height, axis=axis) / grid.spacing[axis]) ** 2))
        for axis in (0, 1)
        if height.shape[axis] > 1
    ]
    rough = 0.5 * contact_modulus * float(np.sqrt(sum(slopes)))
    pressure = max(rough, smooth)
    return pressure if hardness is None else min(pressure, hardness)
