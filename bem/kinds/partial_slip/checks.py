"""Contacts of a scene of kind `partial-slip`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.partial_slip.scene import PartialSlipScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: PartialSlipScene) -> list[Case]:
    """Contact of the two bodies on the grid."""
    from bem.scenes.checks.facts import dry_contacts

    return dry_contacts(scene, scene.wanted_depths())
