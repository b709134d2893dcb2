"""Run of a case of kind `asperities`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.errors import Status
from bem.kinds.asperities.errors import bars_of
from bem.kinds.asperities.record import AsperityRecord
from bem.kinds.asperities.scene import AsperitiesScene
from bem.kinds.asperities.solve import solve_array
from bem.scenes.context import Context, error_bars
from bem.scenes.packing import keep, kept

if TYPE_CHECKING:
    from bem.friction.asperity_array import ArrayState
_CHECKPOINT_EVERY = 5  # contacts


def run(scene: AsperitiesScene, context: Context) -> AsperityRecord:
    """Loads over depths at one spacing."""
    from bem.friction.asperity_array import LOADS

    (spacing,) = scene.array.spacings
    grid = scene.array.grid(spacing)

    def after(now: ArrayState) -> None:
        done = len(now.approach)
        if done % _CHECKPOINT_EVERY == 0 or done == LOADS:
            keep(context, now)
        context.progress(done, LOADS, "contacts")

    with context.timer("contacts"):
        found = solve_array(scene, grid, state=kept(context), callback=after)
    wanted = scene.outputs.errors and found.status is Status.CONVERGED
    return AsperityRecord(
        load_over_hertz=float(found.mean_plane[-1] / found.alone[-1]),
        load_over_hertz_finite_array=float(found.from_flat[-1] / found.alone[-1]),
        hertz_load=found.alone,
        interference=found.depth,
        asperity_load=found.mean_plane,
        asperity_load_window=found.from_flat,
        x=grid.x,
        y=grid.y,
        pressure=found.pressure,
        status=found.status,
        where="a contact",
        **error_bars(context, wanted, lambda: bars_of(scene, grid, found)),
    )
