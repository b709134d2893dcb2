"""Growth rate over the mean film thickness, tabulated from contacts that are solved only where they are needed.

The contact depends on the film through its mean thickness alone (a uniform layer of that thickness, capped at the
hardness it has then), so growth is a smooth function of one number. It is tabulated by bisection as far as the film
gets, until interpolation is within a stated tolerance; every further evaluation reuses the table.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.errors import ConvergenceError, InputError, Status
from bem.grid import FloatArray, Grid
from bem.heat.steady import flash_temperature
from bem.materials import Body, Layer, Material, softer_hardness
from bem.notes import Note
from bem.plausibility import material_arguments, notes_on_arguments
from bem.tribofilm.growth import GrowthLaw
from bem.tribofilm.properties import FilmProperty

AVERAGES = ("contact", "nominal")

_NEGLIGIBLE_LAYER = 1e-4
"""Layers thinner than this fraction of a cell are left out: their effect on a cell's compliance is smaller than
that."""


@dataclass(frozen=True, eq=False)
class FilmContact:
    """Contact in which a film grows: rough bodies, load, and film properties over thickness.

    gap : undeformed gap (nx, ny) [m]. substrate : body under the film. counterface : other body, None is rigid.
    layers, counterface_layers : coatings of substrate and counterface, outermost first; the film lies on `layers`.
    hardness, modulus : of the film, functions of (thickness [m], temperature [K]) [Pa].
    friction : shear stress over pressure. temperature : [K], of film and bodies.
    speeds : of substrate and counterface over the contact [m/s]: the film then grows as warm as rubbing makes each
        spot, both bodies being half-spaces without film and coatings (their own resistance is left out); None: nowhere
        warmer.
    average : what "mean" is taken over: "contact", the cells that touch; "nominal", the cells of `nominal_area`
        (all where None), touching or not: what a point of the track sees on average as contacts sweep over it.
    """

    gap: FloatArray
    grid: Grid
    substrate: Material
    counterface: Material | None
    load: float
    growth: GrowthLaw
    hardness: FilmProperty
    modulus: FilmProperty
    temperature: float
    poissons_ratio: float = 0.3
    friction: float = 0.1
    average: str = "contact"
    nominal_area: FloatArray | None = None
    contact_tolerance: float = 1e-6
    speeds: tuple[float, float] | None = None
    layers: tuple[Layer, ...] = ()
    counterface_layers: tuple[Layer, ...] = ()

    def __post_init__(self) -> None:
        self.grid.check_field(self.gap, "gap")
        if self.average not in AVERAGES:
            raise InputError(f"average {self.average!r} must be one of {list(AVERAGES)}")
        if self.counterface_layers and self.counterface is None:
            raise InputError("counterface_layers: the counterface is rigid; give it a material, or leave them out")
        if self.nominal_area is not None and np.shape(self.nominal_area) != self.grid.shape:
            raise InputError(f"nominal_area: shape {np.shape(self.nominal_area)} does not match {self.grid.shape}")

    def hardness_at(self, thickness: float) -> float:
        """Return the hardness of a film of a thickness [m], or of the counterbody's surface if softer [Pa]."""
        hardness = self.hardness(thickness, self.temperature)
        other = softer_hardness(self.counterbody)
        return hardness if other is None else min(hardness, other)

    @property
    def counterbody(self) -> Body | None:
        """The other body with its coatings; None is rigid."""
        return None if self.counterface is None else Body(self.counterface, layers=self.counterface_layers)

    def bodies(self, film: Layer | None = None) -> Body | tuple[Body, Body]:
        """Return the bodies with their coatings, the film outermost of those of the substrate."""
        stack = self.layers if film is None else (film, *self.layers)
        lower, upper = Body(self.substrate, layers=stack), self.counterbody
        return lower if upper is None else (lower, upper)


@dataclass(frozen=True, eq=False)
class ContactSample:
    """A contact solved at one mean thickness.

    growth : mean growth rate [m/s]; growth_map : local (nx, ny) [m/s]; pressure : (nx, ny) [Pa]. temperature : the
    highest of spots in contact [K].
    """

    thickness: float
    hardness: float
    growth: float
    growth_map: FloatArray
    pressure: FloatArray
    mean_pressure: float
    contact_area: float
    plastic_area: float
    convolutions: float
    temperature: float = math.nan

    def without_maps(self) -> ContactSample:
        """Return the sample with empty maps."""
        return replace(self, growth_map=np.zeros((0, 0)), pressure=np.zeros((0, 0)))


def notes_on_growth(contact: FilmContact, wear_coefficient: float, initial_thickness: float) -> tuple[Note, ...]:
    """Return notes on arguments of `grow_tribofilm` and `grow_local_film` outside their usual ranges."""
    arguments: dict[str, tuple[str, Any]] = {
        "wear_coefficient": ("wear coefficient of a tribofilm", wear_coefficient),
        "initial_thickness": ("thickness of a layer", initial_thickness),
        "contact.load": ("load", contact.load),
        "contact.temperature": ("temperature", contact.temperature),
        "contact.friction": ("friction", contact.friction),
        "contact.speeds": ("speed", contact.speeds),
        "contact.grid.spacing": (
            "cell of the grid",
            [contact.grid.spacing[axis] for axis in contact.grid.varying_axes],
        ),
        "contact.growth.activation_energy": ("barrier of growth", getattr(contact.growth, "activation_energy", None)),
        "contact.growth.activation_volume": ("activation volume", getattr(contact.growth, "activation_volume", None)),
    }
    for name in ("substrate", "counterface"):
        arguments |= material_arguments(f"contact.{name}", getattr(contact, name))
    for name in ("layers", "counterface_layers"):
        for number, layer in enumerate(getattr(contact, name)):
            arguments |= material_arguments(f"contact.{name}[{number}].material", layer.material)
            arguments[f"contact.{name}[{number}].thickness"] = ("thickness of a layer", layer.thickness)
    return notes_on_arguments(arguments)


def solve_film_contact(
    contact: FilmContact, thickness: float, initial_pressure: FloatArray | None = None
) -> ContactSample:
    """Solve the contact under a uniform film of a given thickness [m] and average the growth.

    Raises
    ------
    InfeasibleError : the load exceeds the film's hardness times the grid's area.
    ConvergenceError : the contact did not converge, or its heat did not.
    """
    hardness = contact.hardness_at(thickness)
    layer = None
    if thickness > _NEGLIGIBLE_LAYER * min(contact.grid.spacing):
        film = Material(
            "tribofilm",
            youngs_modulus=contact.modulus(thickness, contact.temperature),
            poissons_ratio=contact.poissons_ratio,
        )
        layer = Layer(film, thickness)
    solution = solve_contact(
        contact.gap,
        displacement_operator(contact.grid, contact.bodies(layer)),
        load=contact.load,
        hardness=hardness,
        tolerance=contact.contact_tolerance,
        initial_pressure=initial_pressure,
    )
    if solution.status != Status.CONVERGED:
        raise ConvergenceError(
            f"tribofilm: the contact under a film of {1e9 * thickness:.4g} nm ended with status "
            f"{solution.status.value!r} at residual {solution.residual:.1e}; {solution.status.message}"
        )
    touching = solution.pressure > 0
    temperature = contact.temperature if contact.speeds is None else _surface_temperature(contact, solution.pressure)
    growth_map = np.where(touching, contact.growth.rate(contact.friction * solution.pressure, temperature), 0.0)
    if contact.average == "contact":
        mean = float(growth_map[touching].mean()) if touching.any() else 0.0
    elif contact.nominal_area is None:
        mean = float(growth_map.mean())
    else:
        mean = float(growth_map[np.asarray(contact.nominal_area, dtype=bool)].mean())
    return ContactSample(
        thickness=thickness,
        hardness=hardness,
        growth=mean,
        growth_map=growth_map,
        pressure=solution.pressure,
        mean_pressure=float(solution.pressure[touching].mean()) if touching.any() else 0.0,
        contact_area=solution.contact_area,
        plastic_area=solution.plastic_area,
        convolutions=solution.convolutions,
        temperature=float(np.broadcast_to(temperature, touching.shape)[touching].max()) if touching.any() else math.nan,
    )


def _surface_temperature(contact: FilmContact, pressure: FloatArray) -> FloatArray:
    """Return the surface temperature (nx, ny) [K] of a sliding contact."""
    assert contact.speeds is not None
    substrate = Body(contact.substrate)
    bodies = substrate if contact.counterface is None else (substrate, Body(contact.counterface))
    found = flash_temperature(
        pressure,
        contact.grid,
        bodies,
        friction=contact.friction,
        speeds=contact.speeds,
        bulk=contact.temperature if contact.counterface is None else (contact.temperature,) * 2,
    )
    if found.status is not Status.CONVERGED:
        raise ConvergenceError(f"tribofilm: the temperature of the contact ended with residual {found.residual:.1e}")
    return found.temperature


@dataclass
class GrowthTable:
    """Growth rate [m/s] as a function of mean thickness [m], from as few contacts as a tolerance allows.

    Logarithmic growth is interpolated linearly between samples. An interval is trusted once the value in its middle
    lies within `tolerance` (relative) of the interpolation; with the middle as a further sample the error left is about
    a quarter of that. Intervals narrower than `narrowest` (relative to their thickness, and to `first_interval`) are
    trusted in any case: as single cells come into contact the mean over the contact takes steps, and these are resolved
    to that width.

    Attributes
    ----------
    sample : thickness, last sample or None -> ContactSample.
    tolerance : relative.
    first_interval : [m].
    narrowest : relative width of an interval that is trusted in any case.
    samples : solved so far, ascending.
    """

    sample: Callable[[float, ContactSample | None], ContactSample]
    tolerance: float = 2e-3
    first_interval: float = 5e-9
    narrowest: float = 0.02
    samples: list[ContactSample] = field(default_factory=list)
    _trusted: set[tuple[float, float]] = field(default_factory=set)
    _last: ContactSample | None = None

    def __call__(self, thickness: float) -> float:
        """Return the growth rate at a thickness [m/s]."""
        if not self.samples:
            self._solve(0.0)
            self._solve(self.first_interval)
        while thickness > self.samples[-1].thickness:
            self._solve(2 * self.samples[-1].thickness)
        while True:
            low, high = self._bracket(thickness)
            if (low.thickness, high.thickness) in self._trusted:
                return self._interpolate(low, high, thickness)
            self._split(low, high)

    @property
    def contacts(self) -> int:
        """Number of contacts solved."""
        return len(self.samples)

    def weights(self, thickness: float) -> tuple[tuple[ContactSample, float], tuple[ContactSample, float]]:
        """Return the two samples around a thickness, with their weights in linear interpolation (for maps)."""
        self(thickness)
        low, high = self._bracket(thickness)
        fraction = (thickness - low.thickness) / (high.thickness - low.thickness)
        return (low, 1 - fraction), (high, fraction)

    def _bracket(self, thickness: float) -> tuple[ContactSample, ContactSample]:
        index = bisect_right(self.samples, thickness, key=lambda s: s.thickness)
        index = min(max(index, 1), len(self.samples) - 1)
        return self.samples[index - 1], self.samples[index]

    def _split(self, low: ContactSample, high: ContactSample) -> None:
        middle = 0.5 * (low.thickness + high.thickness)
        expected = self._interpolate(low, high, middle)
        found = self._solve(middle)
        narrow = high.thickness - low.thickness <= 2 * self.narrowest * max(middle, self.first_interval)
        if narrow or abs(found.growth - expected) <= self.tolerance * max(found.growth, expected):
            self._trusted |= {(low.thickness, middle), (middle, high.thickness)}

    def _solve(self, thickness: float) -> ContactSample:
        found = self.sample(thickness, self._last)
        self._last = found
        index = bisect_right(self.samples, thickness, key=lambda s: s.thickness)
        self.samples.insert(index, found)
        return found

    @staticmethod
    def _interpolate(low: ContactSample, high: ContactSample, thickness: float) -> float:
        fraction = (thickness - low.thickness) / (high.thickness - low.thickness)
        if low.growth <= 0 or high.growth <= 0:
            return (1 - fraction) * low.growth + fraction * high.growth
        return float(np.exp((1 - fraction) * np.log(low.growth) + fraction * np.log(high.growth)))
