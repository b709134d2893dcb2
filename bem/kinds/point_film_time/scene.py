"""Kind `point-film-time`: the film of a ball or barrel in time, with dents, waves and roughness that pass through."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import model_validator

from bem.grid import FloatArray
from bem.notes.scenes import WAVE_STEPS_FEW
from bem.scenes import build, plans
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, problem
from bem.scenes.context import Context
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.marching import JUMPS, Marched, MarchedRecord, few_of
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Series, filled
from bem.scenes.tables.ball import BallRollingScene, BallScene
from bem.scenes.tables.passing import (
    BallMarchScene,
    DentScene,
    OverTimeScene,
    PassingCellsScene,
    PatchScene,
    WavesScene,
)

if TYPE_CHECKING:
    from bem.lubrication import MovingSurface, PointFilmSolution

_FEW_STEPS = 24
"""A wave, below which steps damp it by more than 2.5 % over its length: BDF2 by (2 pi/n)^4/4 a step."""
_FRAMES = 24
"""Films of the whole plane that are kept."""


class PointFilmTimeScene(SceneModel):
    """A ball or barrel on a flat with oil between them, in time: speed and load that change (`over_time`), `dents`,
    `waves` and, on a `patch`, rough surfaces of the bodies, which carry them along."""

    kind: Literal["point-film-time"] = key("Kind of computation.", "basic", default="point-film-time")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the ball.", "basic")
    ball: BallScene = key("Ball or barrel, and its load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: BallRollingScene = key("Surface speeds of both bodies.", "basic")
    over_time: OverTimeScene | None = key(
        "Changes of speed and load over time.", "advanced", default=None, reason="both constant"
    )
    dents: tuple[DentScene, ...] = key("Round dents or bumps that pass through the contact.", "basic", default=())
    waves: WavesScene | None = key("Waviness that passes through the contact.", "advanced", default=None)
    patch: PatchScene | None = key("Grid of the rough patch; needed where a body is rough.", "advanced", default=None)
    film: PassingCellsScene = key("Mesh of the oil film.", "basic", default=PassingCellsScene(cells=(64, 64)))
    march: BallMarchScene = key("Duration and time steps.", "basic")
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _together(self) -> PointFilmTimeScene:
        rough = self.lower.surface.kind != "smooth" or self.upper.surface.kind != "smooth"
        if rough and self.patch is None:
            raise problem("a rough surface without a patch", "patch, with shape and spacing, or smooth surfaces")
        if self.patch is not None and not rough:
            raise problem("a patch of smooth surfaces", "lower.surface or upper.surface other than smooth, or no patch")
        self.oil.check_point_film()
        if self.factors(0.0)[0] == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        return self

    def factors(self, time: float) -> tuple[float, float]:
        """Of speed and load at a time [s]."""
        return (1.0, 1.0) if self.over_time is None else self.over_time.factors(time)

    def speeds_at(self, time: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Of flat and ball at a time [m/s]."""
        factor = self.factors(time)[0]
        first, second = self.rolling.speeds
        return (factor * first[0], factor * first[1]), (factor * second[0], factor * second[1])


def plan(scene: PointFilmTimeScene) -> Plan:
    """What will be computed."""
    (nx, ny), steps, errors = scene.film.cells, scene.march.steps, scene.outputs.errors
    # counted: 3 to 5 Newton steps of 4 to 8 cycles each
    seconds = steps * (0.02 + 9e-6 * nx * ny)
    return Plan.of(
        Step("rough contact", "the film carries all of the load", skipped=True),
        Step("film in time", f"{steps} steps on {nx} x {ny} cells, each by Newton's method with multigrid",
             seconds=seconds, memory=(1200.0 + 40 * steps) * nx * ny),
        plans.error_bars(errors, "marches on half the cells, and of steps twice as long", seconds=1.2 * seconds),
        plans.figures(nx * ny),
    )  # fmt: skip


_SPIKE = "pressure spikes are narrower than the cells, and their height follows them"
_FITTED = "it is fitted through one wave of the film; finer cells and steps say how good it is"
_FIT = "a fit to published films, with the scatter of these"


@dataclass(frozen=True, eq=False, kw_only=True)
class PointFilmTimeRecord(MarchedRecord):
    """A film in time."""

    thinnest_film_time: Annotated[float, Figure("s", "when it is that thin", no_bar=JUMPS)]
    central_film_at_end: Annotated[float, Figure("nm", "film at the centre at the end", headline=True)]
    thickest_central_film: Annotated[float, Figure("nm", "thickest film at the centre", headline=True)]
    highest_pressure: Annotated[float, Figure("Pa", "highest pressure of all times", headline=True, no_bar=_SPIKE)]
    amplitude_ratio: Annotated[
        float | None,
        Figure(
            "",
            "amplitude of the last wave in the centre over that of the body",
            optional=True,
            headline=True,
            no_bar=_FITTED,
        ),
    ] = None
    formula_amplitude_ratio: Annotated[
        float | None, Figure("", "the same by Venner and Lubrecht", optional=True, no_bar=_FIT)
    ] = None
    mass_imbalance: Annotated[float, Figure("", "oil that appears or goes in a step, over what moves", unjudged=True)]
    load_missed: Annotated[float, Figure("", "largest share by which the load is missed", unjudged=True)]
    speed: Annotated[FloatArray, Series(("time",), "m/s", "mean speed along x")]
    friction: Annotated[FloatArray, Series(("time",), "1", "sliding force over load")]
    film_x: Annotated[FloatArray, Series(("film_x",), "m", "x through the middle")]
    film_y: Annotated[FloatArray, Series(("film_y",), "m", "y")]
    thickness: Annotated[FloatArray, Series(("time", "film_x"), "m", "film thickness along x through the middle")]
    film_pressure: Annotated[FloatArray, Series(("time", "film_x"), "Pa", "film pressure along x through the middle")]
    surface_heights: Annotated[
        FloatArray, Series(("time", "film_x"), "m", "heights of both surfaces along x through the middle")
    ]
    frame: Annotated[FloatArray, Series(("frame",), "s", "time of a film of the whole plane")]
    frame_thickness: Annotated[FloatArray, Series(("frame", "film_x", "film_y"), "m", "film thickness")]
    frame_pressure: Annotated[FloatArray, Series(("frame", "film_x", "film_y"), "Pa", "film pressure")]


def run(scene: PointFilmTimeScene, context: Context) -> PointFilmTimeRecord:
    """March through the motion."""
    from bem.accuracy.march import PointMarchCase, point_march_bars

    modulus, bodies = build.modulus_of(scene), (scene.lower.build(), scene.upper.build())
    load, duration = scene.ball.force(modulus), scene.march.duration
    case = PointMarchCase(
        films=(),
        times=np.linspace(0.0, duration, scene.march.steps + 1),
        load=lambda time: load * scene.factors(time)[1],
        speeds=scene.speeds_at,
        radii=scene.ball.radii,
        contact_modulus=modulus,
        lubricant=scene.oil.build(),
        cells=scene.film.cells,
        surfaces=_surfaces(scene, context),
        extent=scene.film.extent,
        bodies=bodies if any(body.layers for body in bodies) else None,
        initial_thickness=scene.march.initial_thickness,
    )
    if (steps := _steps_a_wave(scene)) < _FEW_STEPS:
        context.note(WAVE_STEPS_FEW(steps=steps))
    wanted = scene.outputs.errors
    march = Marched.of(case, case.cells, context, wanted, lambda films: point_march_bars(case.done(films)))
    return _record(scene, march)


def _steps_a_wave(scene: PointFilmTimeScene) -> float:
    """Steps in which waves come on by their length at the mean speed; infinite without waves."""
    if scene.waves is None:
        return math.inf
    return scene.waves.wavelength / (scene.rolling.mean_speed * scene.march.duration / scene.march.steps)


def _surfaces(scene: PointFilmTimeScene, context: Context) -> tuple[MovingSurface, ...]:
    """All that passes through."""
    from bem.lubrication import MeasuredHeights, MovingSurface

    found = [table.build() for table in (*scene.dents, scene.waves) if table is not None]
    if scene.patch is not None:
        grid = build.grid_of(build.resolved_grid(scene.patch, scene.lower.surface, scene.upper.surface))
        lower, upper = build.both_heights(scene, grid, context)
        carriers: tuple[tuple[Literal["lower", "upper"], FloatArray], ...] = (("lower", lower), ("upper", upper))
        found += [
            MovingSurface(MeasuredHeights(heights, grid.spacing, scene.patch.at), of)
            for of, heights in carriers
            if heights.any()
        ]
    return tuple(found)


def _record(scene: PointFilmTimeScene, march: Marched) -> PointFilmTimeRecord:
    from bem.accuracy.march import point_march_figures

    films: list[PointFilmSolution] = march.films
    last, solved, time = films[-1], films[1:], march.figures["time"]
    wanted = np.array([film.load for film in solved]) / [_load(scene, film.time) for film in solved]
    few = few_of(len(films), _FRAMES)
    return filled(
        PointFilmTimeRecord,
        march.figures,
        point_march_figures(films),
        highest_pressure=max(film.maximum_pressure for film in films),
        **_amplitudes(scene, films),
        mass_imbalance=max((film.mass_imbalance for film in solved), default=0.0),
        load_missed=float(np.abs(wanted - 1).max(initial=0.0)),
        speed=np.array([scene.factors(t)[0] * scene.rolling.mean_speed for t in time]),
        friction=np.array([film.friction for film in films]),
        film_x=last.x,
        film_y=last.y,
        thickness=np.array([_middle(film, film.thickness) for film in films]),
        film_pressure=np.array([_middle(film, film.pressure) for film in films]),
        surface_heights=np.array([np.zeros_like(f.x) if f.heights is None else _middle(f, f.heights) for f in films]),
        frame=time[few],
        frame_thickness=np.array([films[i].thickness for i in few]),
        frame_pressure=np.array([films[i].pressure for i in few]),
        **march.ended,
    )


def _load(scene: PointFilmTimeScene, time: float | None) -> float:
    assert time is not None
    return scene.ball.force(build.modulus_of(scene)) * scene.factors(time)[1]


def _middle(film: PointFilmSolution, field: FloatArray) -> FloatArray:
    """Values of a field (nx, ny) along x at y = 0."""
    j = int(np.clip(np.searchsorted(film.y, 0.0), 1, len(film.y) - 1))
    share = float((0.0 - film.y[j - 1]) / (film.y[j] - film.y[j - 1]))
    return np.asarray((1 - share) * field[:, j - 1] + share * field[:, j])


def _amplitudes(scene: PointFilmTimeScene, films: Sequence[PointFilmSolution]) -> dict[str, float | None]:
    """Of steady rolling over waves across it and nothing else: the amplitude in the centre, and what the curve says."""
    from bem.lubrication.point.waviness import amplitude_in_centre, rolling_reduction

    waves, ball = scene.waves, scene.ball
    across = waves is not None and waves.direction == 0 and scene.rolling.direction == 0
    alone = (
        scene.over_time is None and not scene.dents and scene.patch is None and scene.march.initial_thickness is None
    )
    if waves is None or not across or not alone or scene.rolling.slide_roll_ratio != 0:
        return {}
    found = amplitude_in_centre(films, waves.wavelength, waves.begin)
    if found is None or ball.radii[0] != ball.radii[1]:
        return {} if found is None else {"amplitude_ratio": found / waves.amplitude}
    modulus = build.modulus_of(scene)
    formula = rolling_reduction(waves.wavelength, ball.force(modulus), ball.radius, modulus, films[0])
    return {"amplitude_ratio": found / waves.amplitude, "formula_amplitude_ratio": formula}


KIND = Kind.of(
    vars(),
    PointFilmTimeScene,
    PointFilmTimeRecord,
    "film of a ball or barrel in time: dents, waviness and roughness that pass through, start, stop, impact",
    figures=("passing-interferogram", "film-over-time", "passing-sections", "passing-over-time"),
)
