"""Run of a case of kind `point-film-time`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from bem.grid import FloatArray
from bem.kinds.point_film_time.record import PointFilmTimeRecord
from bem.kinds.point_film_time.scene import PointFilmTimeScene
from bem.notes.scenes import WAVE_STEPS_FEW
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.marching import Marched, few_of, oil_scatters

if TYPE_CHECKING:
    from bem.lubrication import MovingSurface, PointFilmSolution

_FEW_STEPS = 24
"""A wave, below which steps damp it by more than 2.5 % over its length: BDF2 by (2 pi/n)^4/4 a step."""
_FRAMES = 24
"""Films of the whole plane that are kept."""


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
        context.note(WAVE_STEPS_FEW(steps=steps, fewest=_FEW_STEPS))
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
    figures: dict[str, Any] = point_march_figures(films)
    friction = np.array([film.friction for film in films])
    return PointFilmTimeRecord(
        **march.figures,
        **figures,
        highest_pressure=max(film.maximum_pressure for film in films),
        **_amplitudes(scene, films),
        mass_imbalance=max((film.mass_imbalance for film in solved), default=0.0),
        load_missed=float(np.abs(wanted - 1).max(initial=0.0)),
        speed=np.array([scene.factors(t)[0] * scene.rolling.mean_speed for t in time]),
        friction=friction,
        friction_oil_scatter=oil_scatters(films, scene.oil.build(), friction),
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


def _amplitudes(scene: PointFilmTimeScene, films: Sequence[PointFilmSolution]) -> dict[str, Any]:
    """Return, of steady rolling over waves across it and nothing else, the amplitude in the centre, and what the curve
    says."""
    from bem.lubrication.point.moving_surfaces import amplitude_in_centre, rolling_reduction

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
