"""Run of a case of kind `wear`."""

from __future__ import annotations

from dataclasses import replace

from bem.kinds.wear.errors import bars
from bem.kinds.wear.record import WearRecord
from bem.kinds.wear.scene import WearScene, slice_of
from bem.kinds.wear.solve import wear_down
from bem.scenes import build
from bem.scenes.context import Context, error_bars
from bem.scenes.third_bodies import tell_of_third_bodies


def run(scene: WearScene, context: Context) -> WearRecord:
    """One wear loop, and where its errors are asked for the same on a coarser grid."""
    initial = build.both_heights(scene, slice_of(scene)[0], context)
    found = wear_down(scene, initial, context)
    tell_of_third_bodies(context, found.third_body_load_share)
    made = error_bars(context, scene.cycles.coarser_grid, lambda: bars(scene, initial, found))
    return replace(found, errors={**found.errors, **made.get("errors", {})}, error_parts=made.get("error_parts", {}))
