"""Contacts of a scene of kind `asperities`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.asperities.scene import AsperitiesScene
from bem.quantities import si

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: AsperitiesScene) -> list[Case]:
    """Contacts of one asperity at its smallest and at its largest depth."""
    from bem.scenes.checks.facts import Case, bodies_of
    from bem.scenes.checks.hertz import smooth_contact

    (spacing,), array, bodies = scene.array.spacings, scene.array, bodies_of(scene)
    radii = (array.radius, array.radius)
    return [
        Case(
            label=f"{si(depth, 'm')} deep",
            grid=array.grid(spacing),
            smooth=smooth_contact(bodies["lower"], bodies["upper"], radii, approach=depth),
            shape="sphere",
            **bodies,
        )
        for depth in sorted({min(array.interferences), max(array.interferences)})
    ]
