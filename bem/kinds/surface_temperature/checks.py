"""Contacts of a scene of kind `surface-temperature`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.surface_temperature.scene import SurfaceTemperatureScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: SurfaceTemperatureScene) -> list[Case]:
    """Contact of the two bodies on the grid."""
    from bem.scenes.checks.facts import dry_contacts

    return dry_contacts(scene)
