"""Contacts of a scene of kind `traction`, as plans show and checks examine them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bem.kinds.traction.scene import TractionScene
from bem.scenes import build

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: TractionScene) -> list[Case]:
    """Smooth contact of the roller."""
    from bem.scenes.checks.facts import Case, bodies_of
    from bem.scenes.checks.hertz import smooth_contact

    bodies, roller = bodies_of(scene), scene.roller
    load, radii = roller.per_length(build.modulus_of(scene)), (roller.radius, math.inf)
    smooth = smooth_contact(bodies["lower"], bodies["upper"], radii, load=load)
    return [Case(smooth=smooth, width=roller.width, shape="cylinder", **bodies)]
