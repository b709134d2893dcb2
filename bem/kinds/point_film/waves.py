"""Rough bodies under a steady film by waves: the key `film.roughness` of the kind point-film, and its checks.

Verified in tests/scenes/test_wave_film_kind.py.
"""

from __future__ import annotations

from typing import Any, Literal

from bem.scenes.common import problem
from bem.scenes.keys import key
from bem.scenes.tables.ball import FilmCellsScene
from bem.scenes.waves import WHERE, check_waves


class PointFilmCellsScene(FilmCellsScene):
    """Mesh of the oil film, and how roughness enters it; the extent is chosen automatically."""

    roughness: Literal["solved", "waves"] = key(
        "Roughness of the bodies: solved with the film (one body, at rest, with contact) or followed by waves (both "
        "bodies, moving; fast, linear in the heights).",
        "advanced",
        default="solved",
    )


def check_point_waves(scene: Any) -> None:
    """Refuse what waves under a ball do not cover.

    Raises
    ------
    ValueError : with a message.
    """
    check_waves(scene)
    if scene.contact is not None:
        raise problem(
            f"contact with {WHERE}, which says where surfaces would meet and not what they bear",
            'no contact; film.roughness = "solved" for a rough body at rest; or kind friction, which takes waves too',
        )
    if scene.rolling.direction != 0:
        raise problem(f"rolling.direction with {WHERE}", "no direction: bodies move along x; turn the axes")
