"""Contacts of a scene of kind `wear`, as plans show and checks examine them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bem.kinds.wear.scene import WearScene
from bem.scenes import build

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: WearScene) -> list[Case]:
    """Contact of the cylinder under the load, on the slice that is computed."""
    from bem.scenes.checks.facts import Case, bodies_of
    from bem.scenes.checks.hertz import smooth_contact

    cylinder, bodies = scene.cylinder, bodies_of(scene)
    grid, on_slice = scene.domain.at(cylinder, build.modulus_of(scene))
    radii = (cylinder.radius or math.inf, math.inf)
    return [
        Case(
            grid=grid,
            load=on_slice,
            smooth=smooth_contact(bodies["lower"], bodies["upper"], radii, load=on_slice / grid.lengths[1]),
            cap=cylinder.hardness,
            friction=cylinder.friction,
            depths=tuple(float(d) for d in scene.depths.build()),
            width=cylinder.width,
            slide=scene.wear.shift * grid.spacing[0],
            wear=scene.wear,
            shape="cylinder" if cylinder.radius else "flat",
            **bodies,
        )
    ]
