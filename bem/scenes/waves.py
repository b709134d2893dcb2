"""Rough films by waves in scenes: what the kinds point-film and traction share of checks, figures and notes.

Verified in tests/scenes/test_wave_film_kind.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from bem.grid import FloatArray, Grid
from bem.notes import Level, Note
from bem.notes.lubrication import WAVES_TOO_HIGH
from bem.scenes import build
from bem.scenes.common import problem
from bem.scenes.context import Context
from bem.scenes.records import Figure, Record, Series

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution, PointFilmSolution
    from bem.lubrication.waves import FilmRipples
    from bem.reference_solutions.hertz import LineContact, PointContact

WHERE = 'film.roughness = "waves"'
LEAST_RATIO = 0.5
"""Smallest ratio of the film to the rms heights at which waves were compared with marches
(`reports/experiments/wave_ripples.py`)."""
_of_waves = partial(Figure, optional=True, chance="the waves are linear in the heights")
_CELLS = "it counts cells of a linear film, which is too low where surfaces nearly meet"
_map = partial(Series, ("patch_x", "patch_y"), of="first")


@dataclass(frozen=True, eq=False, kw_only=True)
class WaveRecord(Record):
    """Ripples of a film by waves (`wave_figures`); the record of a kind has the smooth film as another base."""

    film_ripple: Annotated[float | None, _of_waves("nm", "standard deviation of the film", headline=True)] = None
    pressure_ripple: Annotated[float | None, _of_waves("Pa", "standard deviation of the pressure ripple")] = None
    ripple_over_heights: Annotated[
        float | None, _of_waves("", "standard deviation of the film over that of the heights", headline=True)
    ] = None
    film_over_ripple: Annotated[float | None, _of_waves("", "central film over its standard deviation")] = None
    rough_minimum_thickness: Annotated[
        float | None, _of_waves("nm", "minimum film between the rough surfaces", headline=True)
    ] = None
    meeting_area_share: Annotated[
        float | None, Figure("", "area where linear waves would meet, over Hertz'", optional=True, no_bar=_CELLS)
    ] = None
    rough_rms: Annotated[
        float | None, Figure("nm", "standard deviation of the heights in contact", optional=True, unjudged=True)
    ] = None
    patch_x: Annotated[FloatArray | None, Series(("patch_x",), "m", "x of the patch", of="first")] = None
    patch_y: Annotated[FloatArray | None, Series(("patch_y",), "m", "y of the patch", of="first")] = None
    rough_heights: Annotated[FloatArray | None, _map("m", "heights of both bodies")] = None
    rough_thickness: Annotated[FloatArray | None, _map("m", "film between the rough surfaces")] = None
    rough_pressure: Annotated[FloatArray | None, _map("Pa", "pressure with its ripples")] = None
    film_ripple_field: Annotated[FloatArray | None, _map("m", "ripple of the film")] = None
    pressure_ripple_field: Annotated[FloatArray | None, _map("Pa", "ripple of the pressure")] = None


def check_waves(scene: Any) -> None:
    """Refuse what waves of any contact do not cover.

    Raises
    ------
    ValueError : with a message.
    """
    if all(body.surface.kind == "smooth" for body in (scene.lower, scene.upper)):
        raise problem(f"{WHERE} of smooth surfaces", "lower.surface or upper.surface other than smooth")
    if scene.patch is None:
        raise problem("a rough surface without a patch", "patch, with shape and spacing, or smooth surfaces")
    if scene.supply is not None:
        raise problem(f"supply with {WHERE}, whose inlet is flooded", "no supply, or smooth surfaces")
    if scene.roughness is not None:
        raise problem("roughness beside a rough surface", "one of them: roughness is of surfaces that are taken smooth")
    if any(body.build().layers for body in (scene.lower, scene.upper)):
        raise problem(f"coated bodies with {WHERE}, whose waves are of half-spaces", "bodies without layers")


def patch_grid(scene: Any) -> Grid:
    """Grid of the patch of the rough bodies."""
    return build.grid_of(build.resolved_grid(scene.patch, scene.lower.surface, scene.upper.surface))


def wave_heights(scene: Any, context: Context) -> tuple[FloatArray, FloatArray]:
    """Return the heights of both bodies on the patch [m]."""
    return build.both_heights(scene, patch_grid(scene), context)


def combined_rms(heights: tuple[FloatArray, FloatArray]) -> float:
    """Return the rms height of both bodies together [m]."""
    return math.hypot(*(float(one.std()) for one in heights))


def ripples_of(
    scene: Any,
    film: FilmSolution | PointFilmSolution,
    hertz: LineContact | PointContact,
    heights: tuple[FloatArray, FloatArray],
) -> FilmRipples:
    """Return the ripples that the heights of both bodies leave in a smooth film."""
    from bem.lubrication.waves import film_ripples

    lower, upper = (one if one.any() else None for one in heights)
    return film_ripples(film, hertz, (lower, upper), patch_grid(scene).spacing, at=scene.patch.at)


def wave_figures(ripples: FilmRipples) -> dict[str, Any]:
    """Return the fields of the record that waves fill."""
    return {
        "rough_rms": ripples.rms_heights,
        "film_ripple": ripples.rms_film_ripple,
        "pressure_ripple": ripples.rms_pressure_ripple,
        "ripple_over_heights": ripples.amplitude_ratio,
        "film_over_ripple": ripples.deformed_lambda_ratio,
        "rough_minimum_thickness": ripples.minimum_thickness,
        "meeting_area_share": ripples.touching_share,
        "patch_x": ripples.x,
        "patch_y": ripples.y,
        "rough_heights": ripples.heights,
        "rough_thickness": ripples.thickness,
        "rough_pressure": ripples.pressure,
        "film_ripple_field": ripples.film_ripple,
        "pressure_ripple_field": ripples.pressure_ripple,
    }


def wave_notes(ripples: FilmRipples) -> list[Note]:
    """Return the note on heights for which waves are too high."""
    if ripples.lambda_ratio >= 1 and ripples.touching_share == 0:
        return []
    level = Level.CAUTION if ripples.lambda_ratio >= LEAST_RATIO else Level.OUTSIDE_MODEL
    return [WAVES_TOO_HIGH(level=level, ratio=ripples.lambda_ratio, share=ripples.touching_share)]
