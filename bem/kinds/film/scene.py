"""Kind `film`: the film of a smooth line contact in time: start and stop, reciprocating sliding, changing load."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import model_validator

from bem.accuracy.bars import POINTS, STEPS
from bem.grid import FloatArray
from bem.kinds.film.tables import FilmCylinderScene, MarchScene, MotionScene
from bem.scenes import build, plans
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, UpperBodyScene, check_smooth, problem
from bem.scenes.context import Context
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.marching import JUMPS, Marched, MarchedRecord, few_of
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Series, columns, filled
from bem.scenes.resolutions import counted
from bem.scenes.tables.supply import SupplyScene

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars, MarchCase
    from bem.lubrication import FilmSolution


class FilmScene(SceneModel):
    """A smooth cylinder on a flat with oil between them, in time."""

    kind: Literal["film"] = key("Kind of computation.", "basic", default="film")
    lower: BodyScene = key("Lower body, the flat; it moves and must be smooth.", "basic")
    upper: UpperBodyScene = key(
        "Upper body, the cylinder; without a material it is rigid.", "basic", default=UpperBodyScene()
    )
    cylinder: FilmCylinderScene = key("Cylinder and load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    motion: MotionScene = key("Speed of the flat over time.", "basic")
    march: MarchScene = key("Duration and time steps.", "basic")
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _smooth(self) -> FilmScene:
        check_smooth(self, 'smooth surfaces, or kind = "friction"')
        if self.motion.at(0.0) == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        if self.supply is not None and self.supply.layer is None:
            raise problem("supply.distance: in time the meniscus moves", "supply.layer")
        if self.supply is not None and self.march.cavitation != "mass_conserving":
            raise problem(
                f'a supply of oil with march.cavitation "{self.march.cavitation}", which forgets oil',
                'march.cavitation = "mass_conserving"',
            )
        return self


def plan(scene: FilmScene) -> Plan:
    """What will be computed."""
    n, errors = scene.march.points, scene.outputs.errors
    why = f"{scene.march.steps} steps on {n} points, each by Newton's method"
    seconds = scene.march.steps * 1.6 * (0.002 + 2e-11 * n**3 + 1e-8 * n**2)
    return Plan.of(
        Step("film in time", why, seconds=seconds, memory=8.0 * n * n * 6),
        plans.error_bars(errors, "marches on half the points, and of steps twice as long", seconds=0.35 * seconds),
        Step("rough contact", "both surfaces are smooth", skipped=True),
        plans.figures(),
    )


_BY_TIME = "the thinnest one and the last one have theirs"


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmTimeRecord(MarchedRecord):
    """A film in time."""

    times_reported: Annotated[FloatArray, Figure("s", "time", ("reported",), name="time", unjudged=True)]
    minimum_film_reported: Annotated[
        FloatArray, Figure("nm", "minimum film", ("reported",), name="minimum_film", no_bar=_BY_TIME)
    ]
    thinnest_film_time: Annotated[float, Figure("s", "when it is that thin", headline=True, no_bar=JUMPS)]
    largest_friction_force: Annotated[float, Figure("N", "largest friction force")]
    volume_imbalance: Annotated[
        float, Figure("", "volume that appears or goes, over that in the film", headline=True, unjudged=True)
    ]
    film_x: Annotated[FloatArray, Series(("film_x",), "m", "x, along sliding")]
    speed: Annotated[FloatArray, Series(("time",), "m/s", "speed of the flat")]
    friction: Annotated[
        FloatArray, Series(("time",), "1", "coefficient of friction, positive along +x on the cylinder")
    ]
    thickness: Annotated[FloatArray, Series(("time", "film_x"), "m", "film thickness")]
    film_pressure: Annotated[FloatArray, Series(("time", "film_x"), "Pa", "film pressure")]
    meniscus: Annotated[FloatArray | None, Series(("time",), "m", "where the gap begins to be full")]
    film_fraction: Annotated[FloatArray | None, Series(("time", "film_x"), "1", "share of the gap filled with oil")]


def run(scene: FilmScene, context: Context) -> FilmTimeRecord:
    """March through the motion."""
    from bem.accuracy import MarchCase
    from bem.lubrication import Cavitation

    cylinder, asked = scene.cylinder, scene.march
    case = MarchCase(
        films=(),
        times=np.linspace(0.0, asked.duration, asked.steps + 1),
        load=lambda time: cylinder.per_length(time / asked.duration),
        speeds=lambda time: (scene.motion.at(time), 0.0),
        radius=cylinder.radius,
        contact_modulus=build.modulus_of(scene),
        lubricant=scene.oil.build(),
        points=asked.points,
        initial_thickness=asked.initial_thickness,
        cavitation=Cavitation(asked.cavitation),
        layer=None if scene.supply is None else scene.supply.layer,
    )
    wanted, width = scene.outputs.errors, cylinder.width
    march = Marched.of(case, case.points, context, wanted, lambda films: _bars(replace(case, films=films), width))
    return _record(march, width, starved=scene.supply is not None)


def _bars(case: MarchCase, width: float) -> ErrorBars:
    """With the friction force on the whole width."""
    from bem.accuracy import march_bars

    bars = march_bars(case)
    return bars | bars.renamed({"largest_shear_force": "largest_friction_force"}, lambda force: force * width)


def _record(march: Marched, width: float, *, starved: bool) -> FilmTimeRecord:
    from bem.accuracy import march_figures

    films: list[FilmSolution] = march.films
    last, figures, over, few = films[-1], march_figures(films), columns(films, _OVER_TIME), few_of(len(films), 21)
    return filled(
        FilmTimeRecord,
        march.figures,
        figures,
        over,
        times_reported=march.figures["time"][few],
        minimum_film_reported=march.figures["minimum_film"][few],
        largest_friction_force=figures["largest_shear_force"] * width,
        volume_imbalance=float(over["volume_imbalance"].max()),
        film_x=last.position,
        speed=over["speeds"][:, 0],
        # a film that begins as a gap carries nothing at first
        friction=over["shear_force"] / np.where(over["load"] > 0, over["load"], np.nan),
        film_pressure=over["pressure"],
        meniscus=np.array([_meniscus(film) for film in films]) if starved else None,
        film_fraction=None if last.film_fraction is None else over["film_fraction"],
        **march.ended,
    )


def _meniscus(film: FilmSolution) -> float:
    """Upstream end of the pressure [m]; not-a-number where there is none."""
    full = film.position[film.pressure > 0]
    if not len(full):
        return math.nan
    return float(full[0] if sum(film.speeds) >= 0 else full[-1])


_OVER_TIME = (*("speeds", "thickness", "pressure", "film_fraction", "shear_force", "load", "volume_imbalance"),)


KIND = Kind.of(
    vars(),
    FilmScene,
    FilmTimeRecord,
    "film of a smooth line contact in time: start and stop, reciprocating, changing load",
    resolutions=(counted("march.points", POINTS, 201, 5000), counted("march.steps", STEPS, 50, 100_000)),
    figures=("film-over-time", "film-profiles", "film-pressures", "film-fraction"),
)
