"""Contacts of a scene of kind `point-film-time`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.point_film_time.scene import PointFilmTimeScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: PointFilmTimeScene) -> list[Case]:
    """Smooth contact of the ball or barrel."""
    from bem.scenes.checks.facts import ball_contacts

    return ball_contacts(scene)
