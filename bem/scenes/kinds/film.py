"""Kind `film`: the film of a smooth line contact in time: start and stop, reciprocating sliding, changing load."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.errors import Status
from bem.scenes.common import BodyScene, Force, PositiveLength, SceneModel, Table, UpperBodyScene, problem
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.lubrication import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.units import Length, Speed, Time


class MotionScene(Table):
    """Speed of the flat over time; the cylinder stands still.

    table : `speeds` at `times`, linear in between. reciprocating : `speed` cos(2 pi t / `period`).
    """

    kind: Literal["table", "reciprocating"]
    times: Annotated[list[Time], Field(min_length=2, max_length=1000)] | None = None
    speeds: Annotated[list[Speed], Field(min_length=2, max_length=1000)] | None = None
    speed: Annotated[Speed, Field(gt=0)] | None = None
    period: Annotated[Time, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _complete(self) -> MotionScene:
        wanted = ("times", "speeds") if self.kind == "table" else ("speed", "period")
        given = tuple(name for name in ("times", "speeds", "speed", "period") if getattr(self, name) is not None)
        if given != wanted:
            raise problem(f'kind "{self.kind}" with {", ".join(given) or "nothing"}', " and ".join(wanted))
        if self.times is not None and self.speeds is not None:
            if len(self.times) != len(self.speeds):
                raise problem(f"{len(self.times)} times and {len(self.speeds)} speeds", "as many of each")
            if any(b <= a for a, b in zip(self.times, self.times[1:], strict=False)):
                raise problem("the times do not rise", "times in rising order, none twice")
        return self

    def at(self, time: float) -> float:
        """Speed at a time [m/s]."""
        if self.kind == "table":
            assert self.times is not None
            assert self.speeds is not None
            return float(np.interp(time, self.times, self.speeds))
        assert self.speed is not None
        assert self.period is not None
        return self.speed * math.cos(2 * math.pi * time / self.period)


class FilmCylinderScene(Table):
    """The cylinder and the load on its width; `load_end` changes it linearly over the run."""

    radius: PositiveLength
    width: PositiveLength
    load: Annotated[Force, Field(gt=0)]
    load_end: Annotated[Force, Field(gt=0)] | None = None


class MarchScene(Table):
    """How long and how finely; `initial_thickness` where the motion starts from rest.

    cavitation : "swift_stieber" forgets the oil behind a rupture, "mass_conserving" carries it along, so that a film
        that forms again, as after a reversal, has no more than that.
    """

    duration: Annotated[Time, Field(gt=0)]
    steps: Annotated[int, Field(strict=True, ge=2, le=100_000)] = 200
    points: Annotated[int, Field(strict=True, ge=101, le=5000)] = 501
    initial_thickness: Annotated[Length, Field(gt=0)] | None = None
    cavitation: Literal["swift_stieber", "mass_conserving"] = "swift_stieber"


class FilmScene(SceneModel):
    """A smooth cylinder on a flat with oil between them, in time."""

    kind: Literal["film"] = "film"
    lower: BodyScene
    upper: UpperBodyScene = UpperBodyScene()
    cylinder: FilmCylinderScene
    oil: OilScene
    motion: MotionScene
    march: MarchScene

    @model_validator(mode="after")
    def _smooth(self) -> FilmScene:
        if self.lower.surface.kind != "smooth" or self.upper.surface.kind != "smooth":
            raise problem("a rough surface", 'smooth surfaces, or kind = "friction"')
        if self.motion.at(0.0) == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        return self


def plan(scene: FilmScene) -> Plan:
    """What will be computed."""
    n = scene.march.points
    return Plan(
        (
            Step(
                "film in time",
                f"{scene.march.steps} steps on {n} points, each by Newton's method",
                seconds=scene.march.steps * 4 * (0.002 + 2e-11 * n**3 + 1e-8 * n**2),
                memory=8.0 * n * n * 6,
            ),
            Step("rough contact", "both surfaces are smooth", skipped=True),
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8),
        )
    )


def run(scene: FilmScene, context: Context) -> Outcome:
    """March through the motion."""
    from bem.lubrication import Cavitation, march_line_film
    from bem.materials import contact_modulus

    lower, upper = scene.lower.build(), scene.upper.build()
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

    with context.timer("film"):
        films = march_line_film(
            times,
            load=load,
            speeds=lambda time: (scene.motion.at(time), 0.0),
            radius=cylinder.radius,
            contact_modulus=contact_modulus(lower.material, None if upper is None else upper.material),
            lubricant=scene.oil.build(),
            points=march.points,
            initial_thickness=march.initial_thickness,
            cavitation=Cavitation(march.cavitation),
        )
    for note in dict.fromkeys(note for film in films for note in film.notes):
        context.note(f"film: {note}")
    last = films[-1]
    minimum = np.array([film.minimum_thickness for film in films])
    summary: dict[str, Any] = {
        "time_s": [float(films[i].time or 0.0) for i in _few(len(films))],
        "minimum_film_nm": [float(1e9 * minimum[i]) for i in _few(len(films))],
        "thinnest_film_nm": float(1e9 * minimum.min()),
        "thinnest_film_time_s": float(films[int(minimum.argmin())].time or 0.0),
        "film_at_end_nm": float(1e9 * minimum[-1]),
        "largest_friction_force_N": float(max(abs(film.shear_force) for film in films) * cylinder.width),
        "volume_imbalance": float(max(film.volume_imbalance or 0.0 for film in films)),
        "newton_steps": int(sum(film.iterations for film in films)),
    }
    time = np.array([film.time for film in films], dtype=np.float64)
    variables = {
        "time": Variable(("time",), time, "s", "time"),
        "film_x": Variable(("film_x",), last.position, "m", "x, along sliding"),
        "speed": Variable(("time",), np.array([film.speeds[0] for film in films]), "m/s", "speed of the flat"),
        "minimum_film": Variable(("time",), minimum, "m", "minimum film thickness"),
        "central_film": Variable(
            ("time",), np.array([film.central_thickness for film in films]), "m", "film thickness at the centre"
        ),
        "friction": Variable(
            ("time",),
            np.array([film.shear_force / film.load for film in films]),
            "1",
            "coefficient of friction, positive along +x on the cylinder",
        ),
        "thickness": Variable(("time", "film_x"), np.array([film.thickness for film in films]), "m", "film thickness"),
        "film_pressure": Variable(
            ("time", "film_x"), np.array([film.pressure for film in films]), "Pa", "film pressure"
        ),
    }
    if last.film_fraction is not None:
        variables["film_fraction"] = Variable(
            ("time", "film_x"),
            np.array([film.film_fraction for film in films]),
            "1",
            "share of the gap filled with oil",
        )
    where = "" if last.status is Status.CONVERGED else f"time {last.time:g} s: {last.status.message}"
    return Outcome(summary, variables, last.status, where)


def _few(count: int) -> list[int]:
    return sorted({round(i) for i in np.linspace(0, count - 1, min(count, 21))})


KIND = Kind(
    name="film",
    title="film of a smooth line contact in time: start and stop, reciprocating, changing load",
    model=FilmScene,
    plan=plan,
    run=run,
    figures=("film-over-time", "film-profiles", "film-pressures", "film-fraction"),
    headline=("thinnest_film_nm", "thinnest_film_time_s", "film_at_end_nm", "volume_imbalance"),
)
