"""Contacts of a scene of kind `running-in`, as plans show and checks examine them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.kinds.running_in.scene import RunningInScene

if TYPE_CHECKING:
    from bem.scenes.checks.facts import Case


def contacts(scene: RunningInScene) -> list[Case]:
    """Contact of the rough bodies under the load."""
    from bem.scenes.checks.facts import lubricated_contacts

    depths = tuple(float(depth) for depth in scene.depths.build())
    return lubricated_contacts(scene, scene.contact.hardness, depths, scene.wear)
