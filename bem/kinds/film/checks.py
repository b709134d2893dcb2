"""Contacts of a scene of kind `film`, as plans show and checks examine them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bem.kinds.film.scene import FilmScene
from bem.scenes import build

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: FilmScene) -> list[Case]:
    """Smooth contact of the cylinder under its largest load."""
    from bem.scenes.checks.facts import Case, bodies_of
    from bem.scenes.checks.hertz import smooth_contact

    bodies, cylinder = bodies_of(scene), scene.cylinder
    load = max(cylinder.force(build.modulus_of(scene)), cylinder.load_end or 0.0)
    radii = (cylinder.radius, math.inf)
    smooth = smooth_contact(bodies["lower"], bodies["upper"], radii, load=load / cylinder.width)
    return [Case(smooth=smooth, width=cylinder.width, shape="cylinder", **bodies)]
