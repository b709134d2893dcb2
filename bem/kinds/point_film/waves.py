"""Rough bodies under a steady film by waves: the key `film.roughness` of the kind point-film, its checks and figures.

Verified in tests/scenes/test_wave_film_kind.py.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.notes.lubrication import WAVES_TOO_HIGH
from bem.scenes.common import problem
from bem.scenes.keys import key
from bem.scenes.tables.ball import FilmCellsScene

if TYPE_CHECKING:
    from bem.accuracy.point import PointCase
    from bem.lubrication import PointFilmSolution
    from bem.lubrication.waves import FilmRipples


class PointFilmCellsScene(FilmCellsScene):
    """Mesh of the oil film, and how roughness enters it; the extent is chosen automatically."""

    roughness: Literal["solved", "waves"] = key(
        "Roughness of the bodies: solved with the film (one body, at rest, with contact) or followed by waves (both "
        "bodies, moving; fast, linear in the heights).",
        "advanced",
        default="solved",
    )


def check_waves(scene: Any) -> None:
    """Refuse what waves do not cover.

    Raises
    ------
    ValueError : with a message.
    """
    where = 'film.roughness = "waves"'
    if all(body.surface.kind == "smooth" for body in (scene.lower, scene.upper)):
        raise problem(f"{where} of smooth surfaces", "lower.surface or upper.surface other than smooth")
    if scene.patch is None:
        raise problem("a rough surface without a patch", "patch, with shape and spacing, or smooth surfaces")
    if scene.contact is not None:
        raise problem(
            f"contact with {where}, which says where surfaces would meet and not what they bear",
            'no contact; film.roughness = "solved" for a rough body at rest; or kind friction',
        )
    if scene.supply is not None:
        raise problem(f"supply with {where}, whose inlet is flooded", "no supply, or smooth surfaces")
    if scene.roughness is not None:
        raise problem("roughness beside a rough surface", "one of them: roughness is of surfaces that are taken smooth")
    if scene.rolling.direction != 0:
        raise problem(f"rolling.direction with {where}", "no direction: bodies move along x; turn the axes")
    if any(body.build().layers for body in (scene.lower, scene.upper)):
        raise problem(f"coated bodies with {where}, whose waves are of half-spaces", "bodies without layers")


def ripples_of(
    case: PointCase,
    film: PointFilmSolution,
    heights: tuple[FloatArray, FloatArray],
    grid: Grid,
    at: tuple[float, float],
) -> FilmRipples:
    """Return the ripples of the heights of both bodies on a patch."""
    from bem.lubrication.waves import film_ripples
    from bem.reference_solutions.hertz import ellipse_contact

    hertz = ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)
    lower, upper = (one if one.any() else None for one in heights)
    return film_ripples(film, hertz, (lower, upper), grid.spacing, at=at)


def combined_rms(heights: tuple[FloatArray, FloatArray]) -> float:
    """Return the rms height of both bodies together [m]."""
    return math.hypot(*(float(one.std()) for one in heights))


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
    return [WAVES_TOO_HIGH(ratio=ripples.lambda_ratio, share=ripples.touching_share)]
