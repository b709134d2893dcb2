"""Contacts of a scene of kind `running-in-life`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.running_in_life.scene import RunningInLifeScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: RunningInLifeScene) -> list[Case]:
    """Contact of the rough bodies under the load."""
    from bem.scenes.checks.facts import lubricated_contacts

    return lubricated_contacts(scene, scene.contact.hardness)
