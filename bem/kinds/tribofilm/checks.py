"""Contacts of a scene of kind `tribofilm`, as plans show and checks examine them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bem.kinds.tribofilm.scene import TribofilmScene
from bem.scenes import build

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: TribofilmScene) -> list[Case]:
    """Contact of the bodies under the load, its pressure capped by the film's hardness."""
    from bem.scenes.checks.facts import Case, bodies_of
    from bem.scenes.checks.hertz import smooth_contact
    from bem.tribofilm.properties import Constant

    grid, bodies, radii = build.grid_of(scene.grid), bodies_of(scene), scene.shape.radii
    (load,), hardness = scene.forces(grid.lengths), scene.film.hardness
    on_it = load / grid.lengths[1] if math.isinf(radii[1]) else load
    return [
        Case(
            grid=grid,
            load=load,
            smooth=smooth_contact(bodies["lower"], bodies["upper"], radii, load=on_it),
            cap=hardness.value if isinstance(hardness, Constant) else None,
            friction=scene.rubbing.friction,
            shape=scene.shape.kind,
            wavelength=scene.shape.wavelength,
            **bodies,
        )
    ]
