"""What stays the same over the speeds of a Stribeck curve and the cycles of a run: contact, oil, surfaces, accuracy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.friction.boundary import BoundaryFriction, BoundaryFrictionGiven, boundary_law
from bem.friction.oil_volume import OilVolume
from bem.grid import FloatArray, Grid
from bem.heat.bodies import conductors_of
from bem.lubrication import Lubricant
from bem.lubrication.rough_walls import WallFactors
from bem.lubrication.supply import InletDistance, Supply, checked_supply, inside_hertz
from bem.materials import Body, contact_modulus

CONTACT_MODELS = ("coupled", "uncoupled")
SEPARATIONS = ("volume", "film")
HEAT_NEEDS = ("temperature", "density", "heat_capacity", "thermal_conductivity", "temperature_viscosity")
"""Of an oil."""


@dataclass(frozen=True)
class FilmHeat:
    """Which model of the film's heat, as of `solve_line_film`, and the flat and the cylinder that it enters."""

    model: str
    bodies: tuple[Body, Body]


@dataclass(frozen=True)
class LineContact:
    """A cylinder on a flat, and the oil: radius and width [m], E* of the pair [Pa]; how roughness changes the flow;
    load on the whole width [N] that deforms the bodies where a film has a part of it (`OilVolume.LOADED`), None where
    the film's own does; how much oil there is, None where the inlet is flooded; its heat, None where it has none."""

    radius: float
    width: float
    contact_modulus: float
    lubricant: Lubricant
    flow_factors: WallFactors | str = "off"
    deforming_load: float | None = None
    supply: Supply | None = None
    heat: FilmHeat | None = None

    def film_modulus(self, load: float) -> float:
        """E* [Pa] of the bodies as a film feels it that carries a load on the whole width [N]."""
        return (
            self.contact_modulus if self.deforming_load is None else self.contact_modulus * load / self.deforming_load
        )

    def half_width(self, load: float) -> float:
        """Hertz' half-width [m] under a load on the whole width [N]; Johnson (1985), eq. 4.43."""
        return math.sqrt(4 * load / self.width * self.radius / (math.pi * self.contact_modulus))


@dataclass(frozen=True, eq=False)
class MixedSetup:
    """Load sharing but for roughness and speeds; the fields are those arguments of `solve_mixed`.

    Raises
    ------
    InputError : one message for each value out of range; a patch that is larger than `film_position` or does not
        cover the contact.
    """

    grid: Grid
    bodies: Body | tuple[Body, Body]
    radius: float
    width: float
    load: float
    lubricant: Lubricant
    boundary_friction: BoundaryFrictionGiven
    hardness: float | None = None
    tolerance: float = 1e-4
    film_points: int = 2000
    contact_model: str = "coupled"
    asperity_separation: str = "volume"
    contact_tolerance: float = 1e-6
    film_position: FloatArray | None = None
    striated_exit: bool = False
    flow_factors: WallFactors | str = "off"
    oil_volume: OilVolume | str = OilVolume.PATCH
    supply: Supply | float | None = None
    thermal: str = "off"

    def __post_init__(self) -> None:
        if not isinstance(self.grid, Grid):
            raise InputError(f"grid: {self.grid!r} is not a Grid")
        messages = [*self._numbers(), *self._choices()]
        if messages:
            raise InputError(messages)
        for name in ("radius", "width", "load"):
            object.__setattr__(self, name, float(getattr(self, name)))
        object.__setattr__(self, "oil_volume", OilVolume(self.oil_volume))
        object.__setattr__(self, "supply", checked_supply(self.supply))
        friction = self.boundary_friction
        made = (
            float(friction)  # type: ignore[arg-type]
            if _real(friction)
            else boundary_law(friction).at_temperature(self.lubricant.temperature)
        )
        object.__setattr__(self, "boundary_friction", made)
        if not isinstance(self.bodies, Body):
            pair = tuple(self.bodies)
            object.__setattr__(self, "bodies", pair[0] if len(pair) == 1 else pair)
        if self.film_position is not None:
            object.__setattr__(self, "film_position", np.asarray(self.film_position, dtype=np.float64))
        self._check_reach()

    def _numbers(self) -> list[str]:
        messages = []
        for name in ("radius", "width", "load"):
            value = getattr(self, name)
            if not (_real(value) and value > 0):
                messages.append(f"{name}: {value!r} must be positive and finite")
        messages += [*self._boundary_friction(), *self._supply(), *self._heat()]
        if self.hardness is not None and not (_real(self.hardness) and self.hardness > 0):
            messages.append(f"hardness: {self.hardness!r} must be positive [Pa], or None for elastic contact")
        if not (_real(self.tolerance) and 1e-9 <= self.tolerance <= 0.1):
            messages.append(f"tolerance: {self.tolerance!r} must lie between 1e-9 and 0.1")
        if not (_real(self.contact_tolerance) and 0 < self.contact_tolerance < 1):
            messages.append(f"contact_tolerance: {self.contact_tolerance!r} must lie between 0 and 1")
        if not (isinstance(self.film_points, (int, np.integer)) and 100 <= self.film_points <= 20000):
            messages.append(f"film_points: {self.film_points!r} must be an integer from 100 to 20000")
        return messages

    def _boundary_friction(self) -> list[str]:
        value = self.boundary_friction
        if _real(value) and value >= 0:  # type: ignore[operator]
            return []
        if not isinstance(value, (str, Mapping, BoundaryFriction)):
            return [f"boundary_friction: {value!r} must be zero or positive, or a law"]
        try:
            law = boundary_law(value)
            if isinstance(self.lubricant, Lubricant):
                law.at_temperature(self.lubricant.temperature)
        except InputError as error:
            return list(error.messages)
        return []

    def _supply(self) -> list[str]:
        try:
            checked_supply(self.supply)
        except InputError as error:
            return list(error.messages)
        return []

    def _heat(self) -> list[str]:
        if self.thermal == "off":
            return []
        allowed = ("off", "lumped")
        if self.thermal not in allowed:
            return [f"thermal: {self.thermal!r} is unknown; choose from {', '.join(allowed)}"]
        if isinstance(self.bodies, Body) or len(self.bodies) != 2:
            return ["thermal: heat enters both bodies; give a pair"]
        missing = [name for name in HEAT_NEEDS if getattr(self.lubricant, name, None) is None]
        messages = [f"thermal: the lubricant lacks {', '.join(missing)}; give an oil by grade"] if missing else []
        try:
            conductors_of("thermal", self.bodies, (0.0, 0.0), (0.0, 0.0))
        except InputError as error:
            messages += error.messages
        return messages

    def _choices(self) -> list[str]:
        messages = []
        if not isinstance(self.lubricant, Lubricant):
            messages.append(f"lubricant: {type(self.lubricant).__name__} is not a Lubricant")
        choices = {"contact_model": CONTACT_MODELS, "asperity_separation": SEPARATIONS, "oil_volume": tuple(OilVolume)}
        for name, allowed in choices.items():
            value = getattr(self, name)
            if value not in allowed:
                messages.append(f"{name}: {value!r} is unknown; choose from {', '.join(allowed)}")
        factors = self.flow_factors
        if not (isinstance(factors, WallFactors) or (isinstance(factors, str) and factors == "off")):
            messages.append(f'flow_factors: {factors!r} must be "off" or a table of bem.flow_factors')
        pair = (self.bodies,) if isinstance(self.bodies, Body) else self.bodies
        if not (
            isinstance(pair, (tuple, list)) and 1 <= len(pair) <= 2 and all(isinstance(body, Body) for body in pair)
        ):
            messages.append("bodies: must be one Body or a pair of them")
        return messages

    def _check_reach(self) -> None:
        x, position = self.grid.x, self.film_position
        if position is not None and (x[0] < position[0] or x[-1] > position[-1]):
            raise InputError(
                f"height: the rough patch reaches from {x[0]:g} to {x[-1]:g} m, beyond the film grid's "
                f"{position[0]:g} to {position[-1]:g} m; make the patch smaller or film_position longer"
            )
        half_width = self.line.half_width(self.load)
        if isinstance(self.supply, InletDistance) and self.supply.distance <= half_width:
            raise InputError(inside_hertz(self.supply, half_width))
        if 0.5 * self.grid.lengths[0] < half_width:
            raise InputError(
                f"grid: the rough patch reaches {0.5 * self.grid.lengths[0]:.3g} m to either side, less than the "
                f"contact's half-width {half_width:.3g} m; make it at least that long"
            )

    @property
    def line(self) -> LineContact:
        """The smooth contact and its oil."""
        bodies = (self.bodies,) if isinstance(self.bodies, Body) else self.bodies
        modulus = contact_modulus(*(body.material for body in bodies))
        deforming = self.load if self.counted is OilVolume.LOADED else None
        supply = checked_supply(self.supply)
        heat = None if self.thermal == "off" else FilmHeat(self.thermal, (bodies[0], bodies[-1]))
        return LineContact(self.radius, self.width, modulus, self.lubricant, self.flow_factors, deforming, supply, heat)

    @property
    def counted(self) -> OilVolume:
        """Where the oil is counted."""
        return OilVolume(self.oil_volume)

    @property
    def boundary_law(self) -> BoundaryFriction:
        """The boundary friction as a law, also where it is a number."""
        value = self.boundary_friction
        return value if isinstance(value, BoundaryFriction) else boundary_law(value)

    @property
    def slices(self) -> float:
        """How many patches side by side make the width."""
        return self.width / self.grid.lengths[1]


def _real(value: object) -> bool:
    return (
        isinstance(value, (int, float, np.integer, np.floating))
        and not isinstance(value, bool)
        and math.isfinite(value)
    )
