"""A life of many cycles: how long, what wears and passes, a tribofilm, pieces: tables of the kind running-in-life."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, field_validator

from bem.grid import FloatArray, Grid
from bem.scenes.common import Table, problem
from bem.scenes.laws import LawKey
from bem.scenes.tables.film_defect import FilmDefectScene
from bem.scenes.tables.tribofilm import KineticsScene
from bem.scenes.units import Pressure, Ratio, Temperature, Time
from bem.scenes.wearing import WearDepthsScene
from bem.wear.criterion import Detachment, LocalWear, VonMises
from bem.wear.setup import LOWER, UPPER

if TYPE_CHECKING:
    from bem.life.fatigue import RollingFatigue
    from bem.life.monitors import PieceSizes
    from bem.life.surfaces import GrowingFilm
    from bem.life.surfaces import Temperature as LocalTemperature
    from bem.materials import Body

Bodies = Literal["lower", "upper", "both"]
INDICES = {"lower": (LOWER,), "upper": (UPPER,), "both": (LOWER, UPPER)}


class LifeCycles(Table):
    """How long: `count` cycles, in jumps whose error is at most `tolerance` of what wears in them.

    `first_step` is tried first; figures over cycles have `points` of them, in equal ratios. `coarser_lives`: two more,
    on twice the cell and there in half the positions, for error bars of what cells and positions leave open.
    """

    count: Annotated[Ratio, Field(gt=0, le=1e12)] = 1e6
    tolerance: Annotated[Ratio, Field(ge=1e-4, le=0.5)] = 0.05
    first_step: Annotated[Ratio, Field(gt=0)] = 1.0
    points: Annotated[int, Field(strict=True, ge=2, le=10_000)] = 61
    coarser_lives: bool = Field(default=True, strict=True)

    def reported(self) -> FloatArray:
        """The cycles that figures over them have."""
        return np.geomspace(min(self.first_step, self.count), self.count, self.points)


class LifeWear(Table):
    """What wears, by pressure and distance: a law whose `distance` is what a place slides in a cycle under the patch.

    A body that passes has all its rows go under the patch in a cycle, evenly in `positions`; one that does not lies
    under it and wears a scar: `passes` "lower" is the frame "cylinder" of the wear table of other kinds, the upper body
    fixed with the contact, "upper" is the frame "disk"; with "both" neither body stands still. A place that passes
    slides by slide-to-roll ratio x length of its body's map.
    """

    law: Annotated[Detachment, LawKey("criterion")]
    wears: Bodies = "both"
    passes: Bodies = "both"
    positions: Annotated[int, Field(strict=True, ge=1, le=256)] = 8
    film_defect: FilmDefectScene | None = None

    @field_validator("law")
    @classmethod
    def _local(cls, law: Detachment) -> Detachment:
        if not isinstance(law, LocalWear):
            raise problem(
                f"{law.name}: a criterion cannot be carried over jumps",
                "a law by pressure and distance: archard, archard_over_hardness, energy (pieces: table particles)",
            )
        return law

    def rates(self, bodies: tuple[Body, Body], friction: float) -> tuple[float, float]:
        """Volume by load and distance of (lower, upper) [m^2/N]."""
        law, rates = self.law, [0.0, 0.0]
        assert isinstance(law, LocalWear)
        for body in INDICES[self.wears]:
            rates[body] = law.rate(bodies[body], friction) * (law.upper_over_lower if body == UPPER else 1.0)
        return rates[LOWER], rates[UPPER]

    @property
    def distance(self) -> float:
        """Slid by each place in a cycle [m]."""
        assert isinstance(self.law, LocalWear)
        return self.law.distance


class LifeFilm(KineticsScene):
    """A tribofilm on the lower body: it raises the surface and hides substrate by 1 - exp(-C1 h), from wear and, with
    `friction_on_film`, from friction.

    `cycle_time` is for which a place is under the patch in a cycle: growth and the film's wear count in it. The
    temperature is the oil's where it is not given; with `heat` each spot grows as warm as rubbing makes it.
    """

    cycle_time: Annotated[Time, Field(gt=0)]
    temperature: Annotated[Temperature, Field(gt=0)] | None = None
    friction_on_film: Annotated[Ratio, Field(ge=0, le=2)] | None = None
    heat: bool = Field(default=False, strict=True)

    def build(self, friction: float, temperature: LocalTemperature) -> GrowingFilm:
        """As `bem.life.surfaces.GrowingFilm`."""
        from bem.life.surfaces import GrowingFilm

        balance, on_film = self.balance(), self.friction_on_film
        return GrowingFilm(self.kinetics(), balance, friction, temperature, self.cycle_time, on_film)


class LifeParticles(Table):
    """Sizes of what a criterion would take from the lower body in single passes; as many come off as carry away what
    wears (Archard's volume over the mean volume of a piece, the thesis' way). None is taken from the surface."""

    criterion: Annotated[Detachment, LawKey("criterion")] = VonMises()
    depths: WearDepthsScene

    @field_validator("criterion")
    @classmethod
    def _with_pieces(cls, law: Detachment) -> Detachment:
        if isinstance(law, LocalWear):
            raise problem(f"{law.name} has no pieces", "a criterion such as von_mises, averaged_von_mises, junction")
        return law

    def build(self, grid: Grid, bodies: tuple[Body, Body], hardness: float | None, load: float) -> PieceSizes:
        """Return the criterion of a life that follows the sizes of pieces, `bem.life.monitors.PieceSizes`.

        Raises
        ------
        InputError : a lower body without yield stress, a length that the grid has no room for.
        """
        from bem.life.monitors import PieceSizes

        return PieceSizes.of(grid, bodies, self.criterion, self.depths.build(), hardness, load)


class LifeFatigue(Table):
    """Damage of one body by the stresses of passing roughness, while it wears; see `bem.life.criteria.FatigueLimit`.

    `bending` and `slope` are of the limit in reversed bending over ln of the cycles; the default is hardened 52100,
    which loses 43 MPa a decade. `residual_stress` stays along x and y, negative where it is compressive.
    """

    body: Literal["lower", "upper"] = "lower"
    criterion: Literal["dang_van", "crossland"] = "dang_van"
    bending: Annotated[Pressure, Field(gt=0)] = 1220e6
    slope: Annotated[Pressure, Field(lt=0)] = -43e6 / math.log(10)
    hydrostatic: Annotated[Ratio, Field(ge=0, le=3)] | None = None
    residual_stress: Pressure = 0.0
    depths: WearDepthsScene

    def build(self, bodies: tuple[Body, Body], friction: float, hardness: float | None = None) -> RollingFatigue:
        """As `bem.life.fatigue.RollingFatigue`; friction : traction over pressure, as the lower body feels it;
        hardness : the contact's cap [Pa]."""
        from bem.life.criteria import FatigueLimit
        from bem.life.fatigue import RollingFatigue

        (body,) = INDICES[self.body]
        limit = FatigueLimit(self.criterion, self.bending, self.slope, self.hydrostatic, self.residual_stress)
        cap = math.inf if hardness is None else hardness
        return RollingFatigue(body, bodies[body], self.depths.build(), limit, friction, cap)
