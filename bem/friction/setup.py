"""Set-up of load sharing: contact, oil, models and accuracy, constant over speeds and cycles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bem.arguments import is_finite
from bem.errors import InputError
from bem.friction.boundary import BoundaryFriction, BoundaryFrictionGiven, boundary_law
from bem.friction.oil_volume import OilVolume, mean_where_counted
from bem.friction.smooth import LineContact, PointContact
from bem.grid import FloatArray, Grid
from bem.lubrication import Lubricant
from bem.lubrication.flow_factors import WallFactors
from bem.lubrication.supply import InletDistance, Supply, checked_layer, checked_supply, inside_hertz
from bem.lubrication.thermal.model import HEAT, FilmHeat
from bem.materials import Body, contact_modulus

if TYPE_CHECKING:
    from bem.friction.cell_law import CellLaw
    from bem.friction.film import PatchFilm

CONTACT_MODELS = ("coupled", "uncoupled")
SEPARATIONS = ("volume", "film")
FEWEST_CELLS, FILM_CELLS = 32, 96
"""Cells of a ball's film along an axis: fewest, and default."""
FILM_PLACES, REACH = 96, 1.5
"""Grid of a ball's film over repeated cells: cells along an axis, and half-length in half-axes of the Hertz contact."""
LINE_PLACES, LINE_REACH = 384, 3.0
"""The same of a cylinder's film. Soft rough bodies touch beside the Hertz contact, and films carry load there."""
HEAT_NEEDS = ("temperature", "density", "heat_capacity", "thermal_conductivity", "temperature_viscosity")
"""Properties of the oil that heat needs."""


@dataclass(frozen=True, eq=False)
class MixedSetup:
    """Arguments of `solve_mixed` without heights and speeds, checked.

    Two fields are added. `heat_mesh`: factor on the columns and layers of full heat, or on the cells of lumped heat of
    a line (`FilmHeat.mesh`). `film_modulus`: contact modulus of the film and of the Hertz contact [Pa] where it is not
    that of the bodies, such as of a thin wall of polymer in a stiff housing; asperities deform the bodies themselves.

    Raises
    ------
    InputError : one message for each value out of range; a patch that is larger than `film_position` or does not
        cover the contact.
    """

    grid: Grid
    bodies: Body | tuple[Body, Body]
    load: float
    lubricant: Lubricant
    boundary_friction: BoundaryFrictionGiven
    radius: float | None = None
    width: float | None = None
    radii: Sequence[float] | None = None
    hardness: float | None = None
    tolerance: float = 1e-4
    film_points: int = 2000
    film_cells: int = FILM_CELLS
    contact_model: str = "coupled"
    asperity_separation: str = "volume"
    separation: str = "volume"
    contact_tolerance: float = 1e-6
    film_position: FloatArray | None = None
    flow_factors: WallFactors | str = "off"
    oil_volume: OilVolume | str = OilVolume.LOADED
    supply: Supply | float | None = None
    thermal: str = "off"
    heat_mesh: float = 1.0
    film_modulus: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.grid, Grid):
            raise InputError(f"grid: {self.grid!r} is not a Grid")
        messages = [*self._geometry(), *self._numbers(), *self._choices()]
        if messages:
            raise InputError(messages)
        for name in ("load",) if self.radii is not None else ("radius", "width", "load"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if self.radii is not None:
            object.__setattr__(self, "radii", tuple(float(r) for r in self.radii))
        object.__setattr__(self, "oil_volume", OilVolume(self.oil_volume))
        object.__setattr__(self, "supply", checked_supply(self.supply))
        friction = self.boundary_friction
        made = (
            float(friction)  # type: ignore[arg-type]
            if is_finite(friction)
            else boundary_law(friction).at_temperature(self.lubricant.temperature)
        )
        object.__setattr__(self, "boundary_friction", made)
        if not isinstance(self.bodies, Body):
            pair = tuple(self.bodies)
            object.__setattr__(self, "bodies", pair[0] if len(pair) == 1 else pair)
        if self.film_position is not None:
            object.__setattr__(self, "film_position", np.asarray(self.film_position, dtype=np.float64))
        self._check_reach()

    def _geometry(self) -> list[str]:
        """Return messages on the geometry: a cylinder with a width, or a ball or ellipsoid with fewer film options."""
        names = ("radius", "width")
        if self.radii is None:
            missing = [name for name in names if getattr(self, name) is None]
            values = {name: getattr(self, name) for name in names if name not in missing}
            advice = "give radius and width of a cylinder, or radii (Rx, Ry) of a ball or ellipsoid"
            messages = [f"{name}: missing; {advice}" for name in missing] + _not_positive(values)
            return messages + self._cell()
        if any(getattr(self, name) is not None for name in names):
            return ["radii: given beside radius or width; give radii for a ball, radius and width for a cylinder"]
        try:
            radii = tuple(self.radii)
        except TypeError:
            radii = ()
        if len(radii) != 2:
            return [f"radii: {self.radii!r} must be two positive, finite radii (Rx, Ry) [m]"]
        messages = _not_positive({"radii": radii[0]}) or _not_positive({"radii": radii[1]})
        if self.film_position is not None:
            messages.append("film_position: the film of a ball has none; leave it out, or take a cylinder")
        if isinstance(self.lubricant, Lubricant) and self.lubricant.shears_film:
            messages.append('lubricant: film_rheology "shear_law" is not there for a ball; use "newtonian"')
        return messages + self._patch_of_a_ball()

    def _patch_of_a_ball(self) -> list[str]:
        """Return messages on the patch of a ball: one that holds the contact, or a repeated cell of the roughness."""
        if self.grid.periodic[0] is not self.grid.periodic[1]:
            return [
                "grid: a patch that holds the contact of a ball goes on nowhere, a cell that repeats all over it goes "
                "on along both; make it periodic nowhere, or along x and y"
            ]
        return self._cell()

    def _cell(self) -> list[str]:
        """Return messages on options that a repeated cell of the roughness does not have."""
        if self.repeated_cell and self.oil_volume != OilVolume.LOADED:
            return ['oil_volume: a cell that repeats has its oil where the film carries; make it "loaded"']
        if self.film_modulus is not None and not self.repeated_cell:
            return [
                "film_modulus: a patch that holds the contact deforms by the moduli of its bodies; leave it out, or "
                "take a grid that repeats under the contact, periodic along x and y"
            ]
        if self.repeated_cell and self.contact_model == "uncoupled":
            free = "nowhere" if self.radii is not None else "along y alone"
            return [f"grid: uncoupled asperities need a patch that holds the contact; make it periodic {free}"]
        return []

    def _numbers(self) -> list[str]:
        messages = _not_positive({"load": self.load})
        messages += [*self._boundary_friction(), *self._supply(), *self._heat()]
        if self.film_modulus is not None:
            messages += _not_positive({"film_modulus": self.film_modulus})
        if self.hardness is not None and not (is_finite(self.hardness) and self.hardness > 0):
            messages.append(f"hardness: {self.hardness!r} must be positive [Pa], or None for elastic contact")
        if not (is_finite(self.tolerance) and 1e-9 <= self.tolerance <= 0.1):
            messages.append(f"tolerance: {self.tolerance!r} must lie between 1e-9 and 0.1")
        if not (is_finite(self.contact_tolerance) and 0 < self.contact_tolerance < 1):
            messages.append(f"contact_tolerance: {self.contact_tolerance!r} must lie between 0 and 1")
        if not (isinstance(self.film_points, (int, np.integer)) and 100 <= self.film_points <= 20000):
            messages.append(f"film_points: {self.film_points!r} must be an integer from 100 to 20000")
        if not (isinstance(self.film_cells, (int, np.integer)) and FEWEST_CELLS <= self.film_cells <= 1024):
            messages.append(f"film_cells: {self.film_cells!r} must be an integer from {FEWEST_CELLS} to 1024")
        return messages

    def _boundary_friction(self) -> list[str]:
        value = self.boundary_friction
        if is_finite(value) and value >= 0:  # type: ignore[operator]
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
            if self.radii is None:
                checked_supply(self.supply)
            else:
                checked_layer(self.supply, self.flow_factors)
        except InputError as error:
            return list(error.messages)
        return []

    def _heat(self) -> list[str]:
        if self.thermal == "off":
            return []
        allowed = ("off", *HEAT)
        if self.thermal not in allowed:
            return [f"thermal: {self.thermal!r} is unknown; choose from {', '.join(allowed)}"]
        if self.thermal == "full" and self.radii is not None:
            return ['thermal: "full" is not there for the film of a ball; take "lumped" or "off", or a cylinder']
        if self.repeated_cell and self.radii is not None:
            return [
                'thermal: a cell that repeats has no heat of its own; take "off", or a patch that holds the contact'
            ]
        if self.grid.periodic[0] and not self.repeated_cell:
            return [
                "thermal: on a grid periodic along x the heat of the contact warms the bodies for ever; make it free "
                'along x, or take thermal "off"'
            ]
        if self.thermal == "full" and self.supply is not None:
            return ['supply: not there with thermal "full"; take "lumped" or "off" with it, or no supply']
        if isinstance(self.bodies, Body) or len(self.bodies) != 2:
            return ["thermal: heat enters both bodies; give a pair"]
        missing = [name for name in HEAT_NEEDS if getattr(self.lubricant, name, None) is None]
        messages = [f"thermal: the lubricant lacks {', '.join(missing)}; give an oil by grade"] if missing else []
        from bem.heat.bodies import conductors_of  # loaded where there is heat

        try:
            conductors_of("thermal", self.bodies, (0.0, 0.0), (0.0, 0.0))
        except InputError as error:
            messages += error.messages
        return messages

    def _choices(self) -> list[str]:
        messages = []
        if not isinstance(self.lubricant, Lubricant):
            messages.append(f"lubricant: {type(self.lubricant).__name__} is not a Lubricant")
        choices: dict[str, tuple[str, ...]] = {
            "contact_model": CONTACT_MODELS,
            "asperity_separation": SEPARATIONS,
            "separation": SEPARATIONS,
            "oil_volume": tuple(OilVolume),
        }
        for name, allowed in choices.items():
            value = getattr(self, name)
            if value not in allowed:
                messages.append(f"{name}: {value!r} is unknown; choose from {', '.join(allowed)}")
        if self.at_film_separation and isinstance(self.grid, Grid):
            if self.radii is not None:
                messages.append('separation: "film" needs a cylinder; take "volume" for a ball or ellipsoid')
            elif not all(self.grid.periodic):
                messages.append('separation: "film" needs a grid that is periodic along x and y; make it so')
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
        half_axes = self.smooth.half_axes(self.load)
        if isinstance(self.supply, InletDistance) and self.supply.distance <= half_axes[0]:
            raise InputError(inside_hertz(self.supply, half_axes[0]))
        if self.repeated_cell:
            if self.radii is not None and max(self.grid.lengths) > min(half_axes):
                raise InputError(
                    f"grid: the cell of the roughness is {max(self.grid.lengths):.3g} m long, more than the contact's "
                    f"half-axis {min(half_axes):.3g} m; make it shorter, or a patch that holds the contact"
                )
            return
        for axis, length, half in zip("xy", self.grid.lengths, half_axes, strict=True):
            if math.isfinite(half) and 0.5 * length < half:
                name, there = (
                    ("half-width", "") if self.radii is None else (f"half-axis along {axis}", f" along {axis}")
                )
                raise InputError(
                    f"grid: the rough patch reaches {0.5 * length:.3g} m to either side{there}, less than the "
                    f"contact's {name} {half:.3g} m; make it at least that long"
                )

    @property
    def smooth(self) -> LineContact | PointContact:
        """Smooth contact of the bodies, and its oil."""
        bodies = (self.bodies,) if isinstance(self.bodies, Body) else self.bodies
        modulus = self.film_modulus or contact_modulus(*(body.material for body in bodies))
        deforming = self.load if self.counted is OilVolume.LOADED else None
        supply = checked_supply(self.supply)
        if self.radii is not None:
            radii = (self.radii[0], self.radii[1])
            return PointContact(
                radii, modulus, self.lubricant, deforming, self.flow_factors, supply, self._film_heat(bodies)
            )
        assert self.radius is not None
        assert self.width is not None
        return LineContact(
            self.radius, self.width, modulus, self.lubricant, self.flow_factors, deforming, supply,
            self._film_heat(bodies),
        )  # fmt: skip

    def _film_heat(self, bodies: tuple[Body, ...]) -> FilmHeat | None:
        if self.thermal == "off":
            return None
        return FilmHeat(self.thermal, (bodies[0], bodies[-1]), self.heat_mesh)

    @property
    def counted(self) -> OilVolume:
        """Area over which oil and opening are averaged.

        At a prescribed separation no volume is kept, and the film's own load deforms the bodies, as with "patch".
        """
        return OilVolume.PATCH if self.at_film_separation else OilVolume(self.oil_volume)

    @property
    def at_film_separation(self) -> bool:
        """Return True if the separation of the undeformed mean planes is the film thickness, in place of a volume of
        oil."""
        return self.separation == "film"

    @cached_property
    def hertz_fraction(self) -> FloatArray:
        """Fraction of each cell of the film's grid within the Hertz contact under the total load."""
        return self.smooth.hertz_fraction(self.film_grid, self.load)

    def mean_counted(self, length: FloatArray, film: PatchFilm) -> float:
        """Return the mean of a thickness or opening (nx, 1) or (nx, ny) [m] over the area where oil is counted [m]."""
        fraction = self.hertz_fraction if self.counted is OilVolume.HERTZ else None
        return mean_where_counted(length, film, self.counted, fraction)

    @property
    def boundary_law(self) -> BoundaryFriction:
        """Boundary friction as a law; a number is a constant coefficient."""
        value = self.boundary_friction
        return value if isinstance(value, BoundaryFriction) else boundary_law(value)

    @property
    def repeated_cell(self) -> bool:
        """Return True if the rough patch is a cell that repeats over the whole contact."""
        return all(self.grid.periodic) and not self.at_film_separation

    @cached_property
    def cell_laws(self) -> dict[tuple[float, bytes], CellLaw]:
        """Laws of repeated cells that were tabulated, by traction and heights; all speeds share them."""
        return {}

    @property
    def slices(self) -> float:
        """Number of patches that make the contact; of repeated cells, area of the Hertz contact over that of a cell."""
        if self.repeated_cell:
            return self.smooth.hertz_area(self.load) / self.grid.area
        return self.smooth.slices(self.grid)

    @property
    def film_grid(self) -> Grid:
        """Grid on which the film is sampled: that of the rough patch, or one over the contact of repeated cells."""
        if not self.repeated_cell:
            return self.grid
        a, b = self.smooth.half_axes(self.load)
        if self.width is not None:
            spacing = 2 * LINE_REACH * a / LINE_PLACES
            return Grid((LINE_PLACES, 1), (spacing, self.width), periodic=(False, True))
        return Grid((FILM_PLACES, FILM_PLACES), (2 * REACH * a / FILM_PLACES, 2 * REACH * b / FILM_PLACES))

    @property
    def film_resolution(self) -> int:
        """Nodes of the line film's mesh, or cells of a ball's film along an axis."""
        return self.film_points if self.radii is None else self.film_cells

    def with_film(self, resolution: int) -> MixedSetup:
        """Return the set-up with a film of another resolution."""
        if self.radii is None:
            return replace(self, film_points=resolution)
        return replace(self, film_cells=resolution)


def _not_positive(values: Mapping[str, object]) -> list[str]:
    return [
        f"{name}: {value!r} must be positive and finite"
        for name, value in values.items()
        if not (is_finite(value) and value > 0)  # type: ignore[operator]
    ]
