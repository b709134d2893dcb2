"""Kinetics, properties and wear of a tribofilm, and how it is rubbed: tables of the kind tribofilm."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from bem.errors import InfeasibleError
from bem.grid import FloatArray, Grid
from bem.materials import softer_hardness
from bem.physical_constants import ZERO_CELSIUS
from bem.reference_solutions.hertz import smooth_load, sphere_contact
from bem.scenes import build, sources
from bem.scenes.axes import Model, changed, with_keys
from bem.scenes.common import (
    BodyScene,
    GridScene,
    HertzPressures,
    Loads,
    SceneModel,
    Table,
    Variant,
    one_of,
    problem,
)
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.lubrication import FilmCells
from bem.scenes.oil import OilScene
from bem.scenes.tables.shape import ShapeScene
from bem.scenes.units import Energy, InverseLength, Length, Rate, Ratio, Speed, Temperature, Time, Volume
from bem.tribofilm.balance import FilmBalance
from bem.tribofilm.growth import GrowthLaw, StressActivatedGrowth
from bem.tribofilm.properties import PropertyLaw

if TYPE_CHECKING:
    from bem.scenes.checks.hertz import SmoothContact
    from bem.tribofilm import FilmContact


class KineticsScene(Table):
    """Kinetics of growth and wear of a film.

    Growth is stress-activated, of the energy, volume and prefactor given, or that of another law, `growth`.
    """

    growth: Annotated[GrowthLaw, LawKey("growth")] | None = key(
        "Growth law of the tribofilm; instead of activation_energy and activation_volume.", "advanced", default=None
    )
    prefactor: Annotated[Speed, Field(gt=0)] = key(
        "Pre-exponential factor of the stress-activated growth rate.", "advanced", default=1e-2
    )
    activation_energy: Annotated[Energy, Field(gt=0)] | None = key(
        "Activation energy of the growth without stress.", "basic", default=None
    )
    activation_volume: Annotated[Volume, Field(ge=0)] | None = key(
        "Activation volume, by which shear stress lowers the activation energy.",
        "basic",
        default=None,
        example="50 angstrom^3",
    )
    wear_coefficient: Annotated[Rate, Field(ge=0)] = key(
        "Wear coefficient alpha: wear rate of the film divided by its thickness.", "basic"
    )
    concentration_constant: Annotated[InverseLength, Field(gt=0)] | None = key(
        "Constant C1: of the worn film of thickness h the fraction exp(-C1 h) is substrate.",
        "basic",
        default=None,
        reason="no substrate in the film",
        example="1.2e7 1/m",
    )
    initial_thickness: Annotated[Length, Field(ge=0)] = key("Film thickness at the start.", "advanced", default=0.0)

    @model_validator(mode="after")
    def _one_kinetics(self) -> Self:
        own = {key: getattr(self, key) for key in ("activation_energy", "activation_volume")}
        if self.growth is not None and any(value is not None for value in own.values()):
            raise problem(f"growth with {' and '.join(k for k, v in own.items() if v is not None)}", "one of them")
        if self.growth is None and None in own.values():
            missing = " and ".join(key for key, value in own.items() if value is None)
            raise problem(f"no {missing}", "activation_energy with activation_volume, or growth, another law")
        return self

    def kinetics(self) -> GrowthLaw:
        """The law of growth."""
        if self.growth is not None:
            return self.growth
        assert self.activation_energy is not None
        assert self.activation_volume is not None
        return StressActivatedGrowth(self.prefactor, self.activation_energy, self.activation_volume)

    def balance(self) -> FilmBalance:
        """As `bem.tribofilm.balance.FilmBalance`."""
        constant = self.concentration_constant or np.inf
        return FilmBalance(self.wear_coefficient, 0.0, constant, self.initial_thickness)


class FilmScene(KineticsScene):
    """The tribofilm: growth kinetics, mechanical properties, wear."""

    hardness: Annotated[PropertyLaw, LawKey("film_property")] = key(
        "Hardness of the film over thickness and temperature, which limits the pressure that drives growth.", "basic"
    )
    youngs_modulus: Annotated[PropertyLaw, LawKey("film_property")] = key(
        "Young's modulus of the film over its thickness.", "basic"
    )
    poissons_ratio: Annotated[Ratio, Field(gt=-1, lt=0.5)] = key(
        "Poisson's ratio of the film.", "advanced", default=0.3
    )
    lag: Annotated[Time, Field(ge=0)] = key(
        "Time by which the wear of the film lags behind its thickness, so that the thickness overshoots.",
        "advanced",
        default=0.0,
    )
    average: Literal["contact", "nominal"] = key(
        "Area over which growth is averaged: the real contact, or the nominal contact area.",
        "advanced",
        default="contact",
    )
    feedback: Literal["mean", "local"] = key(
        "Thickness of the tribofilm in the contact: one mean value, or cell by cell (local).",
        "advanced",
        default="mean",
    )
    local_tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = key(
        "Relative tolerance of the time steps of a local film.", "expert", default=1e-2
    )

    def balance(self) -> FilmBalance:
        """As `bem.tribofilm.balance.FilmBalance`, with the lag."""
        return replace(super().balance(), lag=self.lag)


class VariantScene(Variant):
    """Changes of the film."""

    wear_coefficient: Annotated[Rate, Field(ge=0)] | None = key(
        "Wear coefficient alpha: wear rate of the film divided by its thickness.", "basic", default=None
    )
    lag: Annotated[Time, Field(ge=0)] | None = key(
        "Time by which the wear of the film lags behind its thickness.", "advanced", default=None
    )
    activation_volume: Annotated[Volume, Field(ge=0)] | None = key(
        "Activation volume, by which shear stress lowers the activation energy.", "basic", default=None
    )
    activation_energy: Annotated[Energy, Field(gt=0)] | None = key(
        "Activation energy of the growth without stress.", "basic", default=None
    )

    def applied(self, scene: Model) -> Model:
        """The scene with these changes in it."""
        return with_keys(scene, {f"film.{key}": value for key, value in self.changes().items()})


class RubbingScene(Table):
    """Loads, temperatures and duration of rubbing."""

    loads: Loads | None = key(
        "Normal loads, one result for each; instead of hertz_pressures.", "basic", default=None, example=["20 N"]
    )
    hertz_pressures: HertzPressures | None = key(
        "Maximum Hertz pressures of the smooth shape without layers, one result for each; instead of loads.",
        "basic",
        default=None,
        example=["1.2 GPa"],
    )
    temperatures: Annotated[list[Annotated[Temperature, Field(gt=0)]], Field(min_length=1, max_length=64)] = key(
        "Temperatures, one result for each.", "basic"
    )
    friction: Annotated[Ratio, Field(ge=0, le=2)] = key(
        "Friction coefficient: shear stress that activates growth, divided by the pressure.", "basic", default=0.1
    )
    duration: Annotated[Time, Field(gt=0)] = key("Duration of rubbing.", "basic")
    points: Annotated[int, Field(strict=True, ge=2, le=100_000)] = key(
        "Number of output points in time.", "expert", default=241
    )
    report: tuple[Annotated[Time, Field(ge=0)], Annotated[Time, Field(ge=0)]] | None = key(
        "The two times between which the wear depth is reported.",
        "advanced",
        default=None,
        reason="the whole duration",
        example=["30 min", "60 min"],
    )
    cycle: Annotated[Time, Field(gt=0)] | None = key(
        "Duration of a cycle, for curves against cycles.", "advanced", default=None, example="10 ms"
    )
    speeds: tuple[Speed, Speed] | None = key(
        "Surface speeds of lower and upper body; the film then grows at its local flash temperature.",
        "basic",
        default=None,
        example=["0.1 m/s", "0 m/s"],
    )

    _one_load = one_of("loads", "hertz_pressures")

    @model_validator(mode="after")
    def _within(self) -> RubbingScene:
        if self.report is not None and not self.report[0] < self.report[1] <= self.duration:
            raise problem(f"report {self.report} s", "two times, the second later and not after duration")
        return self


class RubbedScene(SceneModel):
    """Two rough bodies that rub, and the film on the lower one; in a case there is one load and one temperature.

    With `oil` under a sphere or ellipsoid the surfaces carry what the oil film leaves them (`bem.tribofilm.under_oil`),
    of `oil_cells` along an axis; it is as warm as the contact.
    """

    grid: GridScene = key("Grid of the contact.", "basic", default=GridScene())
    lower: BodyScene = key("Lower body, on whose surface or coating the film grows.", "basic")
    upper: BodyScene = key("Upper body (counter-body), which carries the smooth shape.", "basic")
    shape: ShapeScene = key("Smooth shape of the upper body.", "basic", default=ShapeScene())
    rubbing: RubbingScene = key("Loads, temperatures and duration of rubbing.", "basic")
    film: FilmScene = key("The tribofilm: growth kinetics, mechanical properties, wear.", "basic")
    oil: OilScene | None = key(
        "Lubricant; the asperities under a ball then carry the load that the oil film leaves them.",
        "advanced",
        default=None,
        reason="boundary lubrication: the asperities carry the whole load",
    )
    oil_cells: FilmCells = key("Number of cells of the oil film along each axis.", "expert", default=64)

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.rubbing.speeds is not None:  # the film is as warm as the spots in contact
            yield from (sources.MOVING_HEAT, sources.FLASH)
        if self.oil is not None:
            yield from (sources.SHARED, sources.POINT_FILM)

    @model_validator(mode="after")
    def _pressures_of_a_shape(self) -> Self:
        if self.rubbing.hertz_pressures is not None and math.isinf(self.shape.radii[0]):
            raise problem(
                f"rubbing.hertz_pressures under a shape of kind {self.shape.kind}",
                "a sphere, cylinder or ellipsoid, or rubbing.loads",
            )
        return self

    @model_validator(mode="after")
    def _no_profiles(self) -> Self:
        if self.shape.kind == "profiles":
            raise problem("profiles of a wheel and a rail", "another shape, or kind contact, partial-slip or rolling")
        return self

    @model_validator(mode="after")
    def _oil_under_a_ball(self) -> Self:
        if self.oil is None:
            return self
        temperatures = self.rubbing.temperatures
        if self.shape.kind not in ("sphere", "ellipsoid") or any(self.grid.periodic):
            raise problem(
                "oil of anything but a ball on a free grid", "a sphere or ellipsoid, and grid.periodic = false"
            )
        if self.rubbing.speeds is None or sum(self.rubbing.speeds) == 0:
            raise problem("oil without rubbing.speeds that entrain it", "speeds of both surfaces, their sum not zero")
        self.oil.check_point_film()
        if len(temperatures) > 1 or self.oil.temperature not in (None, *temperatures):
            raise problem(
                "oil at another temperature than the contact",
                "one of rubbing.temperatures, and oil.temperature the same",
            )
        return self

    @model_validator(mode="after")
    def _heat_of_both_bodies(self) -> Self:
        bodies = build.bodies_of(self)
        for body in bodies if isinstance(bodies, tuple) else (bodies,):
            if self.rubbing.speeds is not None and body.material.thermal_diffusivity is None:
                raise problem(
                    f"rubbing.speeds: heat of {body.material.name}, a material without thermal constants",
                    "materials with thermal_conductivity, density and heat_capacity, or no speeds",
                )
        return self

    def forces(self, lengths: tuple[float, float]) -> list[float]:
        """Loads on a grid of these sides [N], as given or by the Hertz pressures of the substrates."""
        rubbing, radii = self.rubbing, self.shape.radii
        if rubbing.loads is not None:
            return list(rubbing.loads)
        assert rubbing.hertz_pressures is not None
        length, modulus = lengths[1] if math.isinf(radii[1]) else 1.0, build.modulus_of(self)
        return [
            smooth_load(radii=radii, contact_modulus=modulus, maximum_pressure=pressure) * length
            for pressure in rubbing.hertz_pressures
        ]

    def resolved(self) -> Self:
        """With the grid filled in where measured surfaces decide it, and the loads of Hertz pressures."""
        scene = build.with_grid(self)
        loads = scene.forces(build.grid_of(scene.grid).lengths)
        rubbing = scene.rubbing.model_copy(update={"loads": loads, "hertz_pressures": None})
        return changed(scene, "rubbing", rubbing)

    def check_load(self, grid: Grid) -> None:
        """Refuse a load beyond the softest hardness that the film can get times the grid's area, before any work.

        Raises
        ------
        InfeasibleError : such a load.
        """
        (load,), (temperature,) = self.forces(grid.lengths), self.rubbing.temperatures
        limit = self._softest() * grid.area
        if load > limit:
            raise InfeasibleError(
                f"rubbing.loads: {load:g} N is beyond the softest film's hardness x area of the grid, {limit:.4g} N at "
                f"{temperature - ZERO_CELSIUS:.4g} degC; allowed: a smaller load, a larger grid or a harder film"
            )

    def _softest(self) -> float:
        """The softest hardness that film or counter-body can have [Pa]."""
        from bem.tribofilm.mean_film import softest_film

        film, rubbing = self.film, self.rubbing
        laws = film.hardness, film.kinetics(), film.balance()
        other = softer_hardness(self.upper.build()) or math.inf
        return min(
            other,
            *(
                softest_film(*laws, friction=rubbing.friction, temperature=temperature, duration=rubbing.duration)
                for temperature in rubbing.temperatures
            ),
        )

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the bodies under the smallest of the loads, without film, on a grid of these sides."""
        from bem.scenes.checks.hertz import smooth_contact

        radii, line = self.shape.radii, math.isinf(self.shape.radii[1])
        if line and lengths is None and self.rubbing.hertz_pressures is None:
            return None
        sides = lengths or (1.0, 1.0)
        load = min(self.forces(sides)) / (sides[1] if line else 1.0)
        return smooth_contact(self.lower.build(), self.upper.build(), radii, load=load)

    def plastic_spread(self, smooth: SmoothContact) -> float:
        """By how much the contact under the largest load and the softest film is larger than the smooth one."""
        loads = self.forces((1.0, 1.0))
        more = max(loads) / min(loads)
        pressure = smooth.maximum_pressure * more ** (1 / 3)
        return more ** (1 / 3) * math.sqrt(max(1.0, pressure * 2 / 3 / self._softest()))

    def contact(self, grid: Grid, lower: FloatArray, upper: FloatArray) -> FilmContact:
        """The rough contact under the film, as `bem.tribofilm.FilmContact`; heights (nx, ny) [m]."""
        from bem.tribofilm import FilmContact

        film, (load,), (temperature,) = self.film, self.forces(grid.lengths), self.rubbing.temperatures
        nominal: FloatArray | None = None
        # cells inside the smooth Hertz contact of a ball; the whole grid for other shapes
        if film.average == "nominal" and self.shape.kind == "sphere" and self.shape.radius is not None:
            ball = sphere_contact(radius=self.shape.radius, contact_modulus=build.modulus_of(self), load=load)
            nominal = (np.hypot(grid.x[:, None], grid.y[None, :]) <= ball.semi_axes[0]).astype(np.float64)
        return FilmContact(
            gap=build.shape_of(self.shape, grid) - (lower + upper),
            grid=grid,
            substrate=self.lower.build().material,
            counterface=self.upper.build().material,
            load=load,
            growth=film.kinetics(),
            hardness=film.hardness,
            modulus=film.youngs_modulus,
            temperature=temperature,
            poissons_ratio=film.poissons_ratio,
            friction=self.rubbing.friction,
            average=film.average,
            nominal_area=nominal,
            speeds=self.rubbing.speeds,
            layers=self.lower.build().layers,
            counterface_layers=self.upper.build().layers,
        )
