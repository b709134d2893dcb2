"""Plan of a case of kind `flow-factors`."""

from __future__ import annotations

from bem.kinds.flow_factors.scene import FlowFactorsScene
from bem.scenes import build, plans
from bem.scenes.planner import Plan, Step


def plan(scene: FlowFactorsScene) -> Plan:
    """Plan the computation of one case."""
    grid, flow = build.grid_of(scene.grid), scene.flow
    count, pressed = len(flow.separations or flow.ratios or ()), flow.behaviour != "undeformed"
    of_one = flow.behaviour == "capped", plans.stiffest(scene.lower.build(), scene.upper.build())
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        plans.layered_kernels(grid, scene.lower.build(), scene.upper.build()),
        plans.contacts(
            grid,
            1.25 * count * plans.convolutions(grid, *of_one) if pressed else 0.0,
            f"{count} separations, {flow.behaviour}" if pressed else "overlap is cut off, nothing is deformed",
            name="contacts",
            skipped=not pressed,
        ),
        # measured: some 30 iterations of each problem, 7e-8 s a cell and iteration
        Step(
            "flow",
            f"three cell problems at each of {count} separations",
            seconds=(1.25 if flow.errors else 1.0) * count * 7e-6 * grid.cells,
            memory=600.0 * grid.cells,
        ),
        plans.figures(),
    )
