"""Run of a case of kind `flow-factors`."""

from __future__ import annotations

import numpy as np

from bem.errors import Status
from bem.kinds.flow_factors.errors import bars_of
from bem.kinds.flow_factors.record import FlowRecord
from bem.kinds.flow_factors.scene import FlowFactorsScene
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell


def run(scene: FlowFactorsScene, context: Context) -> FlowRecord:
    """Factors of both surfaces together at every separation."""
    from bem.flow import flow_factors

    grid, flow = build.grid_of(scene.grid), scene.flow
    rough = build.both_heights(scene, grid, context)
    heights = rough[0] + rough[1]
    apart = np.unique(flow.separations or float(heights.std()) * np.array(flow.ratios))
    with context.timer("flow factors"):
        found = flow_factors(
            heights,
            grid,
            None if flow.behaviour == "undeformed" else build.bodies_of(scene),
            separations=apart,
            **flow.model_dump(include={"hardness", "tolerance", "errors"}),
            callback=lambda done: context.progress(done, len(apart), "separations"),
        )
    tell(context, found.notes)
    first, second = (float(part.var()) for part in rough)
    pair = (first - second) / (first + second)
    wrong = [f"{1e9 * d:.4g} nm" for d, s in zip(apart, found.statuses, strict=True) if s is not Status.CONVERGED]
    return FlowRecord(
        combined_Sq=found.rms_height,
        separation=found.separations,
        separation_over_Sq=found.separations / found.rms_height,
        pressure_x=found.pressure_x,
        pressure_y=found.pressure_y,
        pressure_xy=found.pressure_xy,
        shear_x=found.shear_x,
        shear_pair=found.shear_x * pair,
        friction_sliding=found.friction_sliding,
        friction_shear=found.friction_shear,
        friction_pressure=found.friction_pressure,
        mean_gap=found.mean_gap,
        contact_area_fraction=found.contact_area_fraction,
        residual=float(found.residual.max()),
        flows_through_x=found.flows_through_x.astype(np.int64),
        flows_through_y=found.flows_through_y.astype(np.int64),
        x=grid.x,
        y=grid.y,
        height=heights,
        **error_bars(context, flow.errors, lambda: bars_of(found, heights, grid, pair)),
        status=found.status,
        where=f"separation {', '.join(wrong)}: {found.status.message}",
    )
