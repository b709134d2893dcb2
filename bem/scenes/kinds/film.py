"""Kind `film`: the film of a smooth line contact in time: start and stop, reciprocating sliding, changing load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import model_validator

from bem.errors import Status
from bem.grid import FloatArray
from bem.scenes import build, plans
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, UpperBodyScene, problem
from bem.scenes.context import Context
from bem.scenes.kind import Kind
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series
from bem.scenes.tables.motion import FilmCylinderScene, MarchScene, MotionScene

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution


class FilmScene(SceneModel):
    """A smooth cylinder on a flat with oil between them, in time."""

    kind: Literal["film"] = "film"
    lower: BodyScene
    upper: UpperBodyScene = UpperBodyScene()
    cylinder: FilmCylinderScene
    oil: OilScene
    motion: MotionScene
    march: MarchScene
    outputs: OutputsScene = OutputsScene()

    @model_validator(mode="after")
    def _smooth(self) -> FilmScene:
        if self.lower.surface.kind != "smooth" or self.upper.surface.kind != "smooth":
            raise problem("a rough surface", 'smooth surfaces, or kind = "friction"')
        if self.motion.at(0.0) == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        return self


def plan(scene: FilmScene) -> Plan:
    """What will be computed."""
    n, errors = scene.march.points, scene.outputs.errors
    seconds = scene.march.steps * 4 * (0.002 + 2e-11 * n**3 + 1e-8 * n**2)
    return Plan(
        (
            Step(
                "film in time",
                f"{scene.march.steps} steps on {n} points, each by Newton's method",
                seconds=seconds,
                memory=8.0 * n * n * 6,
            ),
            Step(
                "error bars",
                "marches on half the points, and of steps twice as long" if errors else "outputs.errors is false",
                skipped=not errors,
                seconds=0.5 * seconds,
            ),
            Step("rough contact", "both surfaces are smooth", skipped=True),
            plans.figures(),
        )
    )


_JUMPS = "a film is often nearly as thin at several times, and other steps may pick another of them"


@dataclass(frozen=True, eq=False)
class FilmTimeRecord(Record):
    """A film in time."""

    times_reported: Annotated[FloatArray, Figure("s", "time", ("reported",), name="time")]
    minimum_film_reported: Annotated[FloatArray, Figure("nm", "minimum film", ("reported",), name="minimum_film")]
    thinnest_film: Annotated[float, Figure("nm", "thinnest film of all times", headline=True)]
    thinnest_film_time: Annotated[float, Figure("s", "when it is that thin", headline=True, no_bar=_JUMPS)]
    film_at_end: Annotated[float, Figure("nm", "minimum film at the end", headline=True)]
    largest_friction_force: Annotated[float, Figure("N", "largest friction force")]
    volume_imbalance: Annotated[float, Figure("", "volume that appears or goes, over that in the film", headline=True)]
    newton_steps: Annotated[int, Figure("", "Newton steps")]
    time: Annotated[FloatArray, Series(("time",), "s", "time")]
    film_x: Annotated[FloatArray, Series(("film_x",), "m", "x, along sliding")]
    speed: Annotated[FloatArray, Series(("time",), "m/s", "speed of the flat")]
    minimum_film: Annotated[FloatArray, Series(("time",), "m", "minimum film thickness")]
    central_film: Annotated[FloatArray, Series(("time",), "m", "film thickness at the centre")]
    friction: Annotated[
        FloatArray, Series(("time",), "1", "coefficient of friction, positive along +x on the cylinder")
    ]
    thickness: Annotated[FloatArray, Series(("time", "film_x"), "m", "film thickness")]
    film_pressure: Annotated[FloatArray, Series(("time", "film_x"), "Pa", "film pressure")]
    film_fraction: Annotated[FloatArray | None, Series(("time", "film_x"), "1", "share of the gap filled with oil")]


def run(scene: FilmScene, context: Context) -> FilmTimeRecord:
    """March through the motion."""
    from bem.accuracy import MarchCase, march_bars
    from bem.lubrication import Cavitation

    cylinder, march = scene.cylinder, scene.march
    end = cylinder.load if cylinder.load_end is None else cylinder.load_end
    times = np.linspace(0.0, march.duration, march.steps + 1)
    highest = 0.0

    def load(time: float) -> float:
        nonlocal highest
        if time > highest:
            highest = time
            context.progress(round(time / march.duration * march.steps), march.steps, "steps")
        return (cylinder.load + (end - cylinder.load) * time / march.duration) / cylinder.width

    case = MarchCase(
        films=(),
        times=times,
        load=load,
        speeds=lambda time: (scene.motion.at(time), 0.0),
        radius=cylinder.radius,
        contact_modulus=build.modulus_of(scene),
        lubricant=scene.oil.build(),
        points=march.points,
        initial_thickness=march.initial_thickness,
        cavitation=Cavitation(march.cavitation),
    )
    with context.timer("film"):
        films = case.again(case.points)
    for note in dict.fromkeys(note for film in films for note in film.notes):
        context.note(f"film: {note}")
    errors: dict[str, float | None] = {}
    if scene.outputs.errors and films[-1].status is Status.CONVERGED:
        with context.timer("error bars"):
            bars = march_bars(replace(case, films=films))
        for note in bars.notes:
            context.note(note)
        errors = dict(bars.values)
        force = errors.pop("largest_shear_force")
        errors["largest_friction_force"] = None if force is None else force * cylinder.width
    return _record(films, cylinder.width, errors)


def _record(films: Sequence[FilmSolution], width: float, errors: Mapping[str, float | None]) -> FilmTimeRecord:
    last = films[-1]
    time = np.array([float(film.time or 0.0) for film in films])
    minimum = np.array([film.minimum_thickness for film in films])
    few = sorted({round(i) for i in np.linspace(0, len(films) - 1, min(len(films), 21))})
    filled = None if last.film_fraction is None else np.array([film.film_fraction for film in films])
    return FilmTimeRecord(
        times_reported=time[few],
        minimum_film_reported=minimum[few],
        thinnest_film=float(minimum.min()),
        thinnest_film_time=float(time[minimum.argmin()]),
        film_at_end=float(minimum[-1]),
        largest_friction_force=float(max(abs(film.shear_force) for film in films) * width),
        volume_imbalance=float(max(film.volume_imbalance or 0.0 for film in films)),
        newton_steps=int(sum(film.iterations for film in films)),
        time=time,
        film_x=last.position,
        speed=np.array([film.speeds[0] for film in films]),
        minimum_film=minimum,
        central_film=np.array([film.central_thickness for film in films]),
        friction=np.array([film.shear_force / film.load for film in films]),
        thickness=np.array([film.thickness for film in films]),
        film_pressure=np.array([film.pressure for film in films]),
        film_fraction=filled,
        errors=errors,
        status=last.status,
        where="" if last.status is Status.CONVERGED else f"time {last.time:g} s: {last.status.message}",
    )


KIND = Kind(
    name="film",
    title="film of a smooth line contact in time: start and stop, reciprocating, changing load",
    model=FilmScene,
    plan=plan,
    run=run,
    record=FilmTimeRecord,
    figures=("film-over-time", "film-profiles", "film-pressures", "film-fraction"),
)
