"""Run of a case of kind `running-in`."""

from __future__ import annotations

from dataclasses import replace

from bem.kinds.running_in.errors import bars
from bem.kinds.running_in.record import RunningInRecord
from bem.kinds.running_in.scene import RunningInScene
from bem.kinds.running_in.solve import wear_down
from bem.scenes import build
from bem.scenes.context import Context, error_bars


def run(scene: RunningInScene, context: Context) -> RunningInRecord:
    """One wear loop, and where its errors are asked for the same on a coarser grid."""
    initial = build.both_heights(scene, build.grid_of(scene.grid), context)
    found = wear_down(scene, initial, context)
    return replace(found, **error_bars(context, scene.cycles.coarser_grid, lambda: bars(scene, initial, found)))
