"""A life of many cycles: how long, what wears and passes, a tribofilm, pieces: tables of the kind running-in-life."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, field_validator

from bem.grid import FloatArray, Grid
from bem.laws import Law
from bem.scenes.common import Table, problem
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.tables.film_defect import FilmDefectScene
from bem.scenes.tables.tribofilm import KineticsScene
from bem.scenes.units import Pressure, Ratio, Temperature, Time
from bem.scenes.wearing import WearDepthsScene
from bem.wear.criterion import Criterion, LocalWear, VonMises
from bem.wear.setup import LOWER, UPPER

if TYPE_CHECKING:
    from bem.life.fatigue import RollingFatigue
    from bem.life.monitors import PieceSizes
    from bem.life.surfaces import GrowingTribofilm
    from bem.life.surfaces import Temperature as LocalTemperature
    from bem.materials import Body

Bodies = Literal["lower", "upper", "both"]
INDICES = {"lower": (LOWER,), "upper": (UPPER,), "both": (LOWER, UPPER)}


class LifeCycles(Table):
    """Number of cycles of the life, computed in cycle jumps."""

    count: Annotated[Ratio, Field(gt=0, le=1e12)] = key("Number of cycles of the whole life.", "basic", default=1e6)
    tolerance: Annotated[Ratio, Field(ge=1e-4, le=0.5)] = key(
        "Permitted relative error of the wear in a cycle jump, estimated by step doubling.", "advanced", default=0.05
    )
    first_step: Annotated[Ratio, Field(gt=0)] = key(
        "Number of cycles of the first trial jump; later jumps double or halve it, up to the longest allowed and the "
        "end of the life.",
        "expert",
        default=1.0,
    )
    points: Annotated[int, Field(strict=True, ge=2, le=10_000)] = key(
        "Number of cycles, in a geometric series, at which curves over the life are stored.", "expert", default=61
    )
    coarser_lives: bool = key(
        "Two more lives, with twice the cell size and with half the positions, for error estimates (40 % more work).",
        "advanced",
        default=True,
        strict=True,
    )

    def reported(self) -> FloatArray:
        """The cycles that figures over them have."""
        return np.geomspace(min(self.first_step, self.count), self.count, self.points)


def _by_pressure(law: type[Law]) -> bool:
    return issubclass(law, LocalWear)


def _finds_particles(law: type[Law]) -> bool:
    if not issubclass(law, Criterion) or issubclass(law, LocalWear):
        return False
    return law.counts_passes is Criterion.counts_passes  # not overridden: single passes bring pieces off


class LifeWear(Table):
    """Wear law of both bodies, and which of them pass through the contact."""

    law: Annotated[Criterion, LawKey("criterion", takes=_by_pressure)] = key(
        "Wear law, with its parameters: archard, archard_over_hardness or energy; specific_wear_rate is the worn "
        "volume of each body that wears per load and sliding distance, distance the sliding of a place of the lower "
        "body in a cycle (a pass: length of the patch times sliding speed over its own speed), upper_over_lower wear "
        "rate times that distance of the upper body over those of the lower one (1: both together lose twice as "
        "much).",
        "basic",
        example="archard",
    )
    wears: Bodies = key("Bodies that lose material.", "advanced", default="both")
    passes: Bodies = key(
        "Bodies whose surface moves through the contact; one that does not gets a wear scar.",
        "advanced",
        default="both",
    )
    positions: Annotated[int, Field(strict=True, ge=1, le=256)] = key(
        "Number of relative positions of the rough surfaces over which a jump is averaged.", "expert", default=8
    )
    film_defect: FilmDefectScene | None = key(
        "Adsorbed boundary film that protects the surfaces from wear.", "advanced", default=None
    )

    @field_validator("law")
    @classmethod
    def _local(cls, law: Criterion) -> Criterion:
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
            rates[body] = law.body_rate(bodies, body, friction)
        return rates[LOWER], rates[UPPER]

    @property
    def distance(self) -> float:
        """Slid by each place in a cycle [m]."""
        assert isinstance(self.law, LocalWear)
        return self.law.distance


class LifeFilm(KineticsScene):
    """Tribofilm on the lower body, which grows, wears, and covers the substrate."""

    cycle_time: Annotated[Time, Field(gt=0)] = key(
        "Time for which a point of the surface is under the patch in each cycle.", "basic", example="300 us"
    )
    temperature: Annotated[Temperature, Field(gt=0)] | None = key(
        "Temperature at which the film grows.", "basic", default=None, reason="the oil's"
    )
    friction_on_film: Annotated[Ratio, Field(ge=0, le=2)] | None = key(
        "Boundary friction coefficient where the tribofilm covers the substrate.",
        "advanced",
        default=None,
        reason="that of the contact",
        example=0.1,
    )
    heat: bool = key(
        "Growth at the local surface temperature, with the flash temperature of sliding.",
        "advanced",
        default=False,
        strict=True,
    )

    def build(self, friction: float, temperature: LocalTemperature) -> GrowingTribofilm:
        """Build the `bem.life.surfaces.GrowingTribofilm` of this table."""
        from bem.life.surfaces import GrowingTribofilm

        balance, on_film = self.balance(), self.friction_on_film
        return GrowingTribofilm(self.kinetics(), balance, friction, temperature, self.cycle_time, on_film)


class LifeParticles(Table):
    """Sizes of the particles that a detachment criterion finds; none of them is taken from the surface."""

    criterion: Annotated[Criterion, LawKey("criterion", takes=_finds_particles)] = key(
        "Wear criterion that finds the particles.", "advanced", default=VonMises()
    )
    depths: WearDepthsScene = key("Depths at which stresses are computed.", "basic")

    @field_validator("criterion")
    @classmethod
    def _with_pieces(cls, law: Criterion) -> Criterion:
        if isinstance(law, LocalWear):
            raise problem(f"{law.name} has no pieces", "a criterion such as von_mises, averaged_von_mises, junction")
        if law.counts_passes:
            raise problem(
                f"{law.name} finds pieces after many passes, and a life looks for pieces in single passes",
                "a criterion of stress or junction (damage: table fatigue)",
            )
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
    """Rolling contact fatigue of one body under the stresses of passing roughness, in competition with wear."""

    body: Literal["lower", "upper"] = key("Body whose fatigue damage is computed.", "basic", default="lower")
    criterion: Literal["dang_van", "crossland"] = key(
        "Multiaxial high-cycle fatigue criterion.", "advanced", default="dang_van"
    )
    bending: Annotated[Pressure, Field(gt=0)] = key(
        "Constant B of the fatigue limit in reversed bending, B + A ln N.",
        "advanced",
        default=1220e6,
        reason="hardened 52100 bearing steel",
    )
    slope: Annotated[Pressure, Field(lt=0)] = key(
        "Slope A of the fatigue limit in reversed bending, B + A ln N.",
        "advanced",
        default=-43e6 / math.log(10),
        reason="hardened 52100: -43 MPa a decade of cycles",
    )
    hydrostatic: Annotated[Ratio, Field(ge=0, le=3)] | None = key(
        "Weight of the hydrostatic stress in the criterion.",
        "expert",
        default=None,
        reason="0.232 for Dang Van, 0 for Crossland",
        example=0.232,
    )
    residual_stress: Pressure = key("Residual stress along x and y, negative in compression.", "advanced", default=0.0)
    depths: WearDepthsScene = key("Depths at which stresses are computed.", "basic")

    def build(self, bodies: tuple[Body, Body], hardness: float | None = None) -> RollingFatigue:
        """Build the `bem.life.fatigue.RollingFatigue` of this table; hardness : limit of the contact pressure [Pa]."""
        from bem.life.fatigue import RollingFatigue
        from bem.life.fatigue_limit import FatigueLimit

        (body,) = INDICES[self.body]
        limit = FatigueLimit(self.criterion, self.bending, self.slope, self.hydrostatic, self.residual_stress)
        cap = math.inf if hardness is None else hardness
        return RollingFatigue(body, bodies[body], self.depths.build(), limit, cap)
