"""Contacts of a scene of kind `rolling`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.rolling.scene import RollingContactScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: RollingContactScene) -> list[Case]:
    """Return the contact of the two bodies on the grid."""
    from bem.scenes.checks.facts import dry_contacts

    return dry_contacts(scene, scene.wanted_depths())
