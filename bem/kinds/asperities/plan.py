"""Plan of a case of kind `asperities`."""

from __future__ import annotations

from bem.kinds.asperities.scene import AsperitiesScene
from bem.scenes import plans
from bem.scenes.planner import Plan, Step

_CONVOLUTIONS = 20  # of each contact


def plan(scene: AsperitiesScene) -> Plan:
    """Plan the computation of one case."""
    from bem.friction.asperity_array import LOADS

    grid, convolutions = scene.array.grid(max(scene.array.spacings)), _CONVOLUTIONS * LOADS
    why = f"{LOADS} loads for each spacing, one asperity each"
    coarser = plans.coarser_contacts(grid, convolutions, plans.CONVOLUTION)
    return Plan.of(
        plans.contacts(grid, convolutions, why, name="contacts"),
        plans.error_bars(scene.outputs.errors, "all contacts on the grid of twice the cell", **coarser),
        Step("the other asperities of the array", "all carry the same, by symmetry", skipped=True),
        plans.figures(grid.cells),
    )
