"""Kind `flow-factors`: how roughness, as deformed in its contact, changes the flow of a film through it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.flow_factors.tables import FlowScene, PatchGridScene
from bem.scenes import build, plans
from bem.scenes.common import BodyScene, SceneModel, UpperBodyScene, problem
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series, filled
from bem.scenes.resolutions import CELLS

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.flow import FlowFactors


class FlowFactorsScene(SceneModel):
    """Two surfaces, one of them rough at least, and separations."""

    kind: Literal["flow-factors"] = key("Kind of computation.", "basic", default="flow-factors")
    grid: PatchGridScene = key("Grid of the rough patch.", "basic", default=PatchGridScene())
    lower: BodyScene = key("Lower body.", "basic")
    upper: UpperBodyScene = key("Upper body; without a material it is rigid.", "basic", default=UpperBodyScene())
    flow: FlowScene = key("Separations of the surfaces, and how their asperities deform.", "basic")

    @model_validator(mode="after")
    def _rough(self) -> FlowFactorsScene:
        if self.lower.surface.kind == "smooth" and self.upper.surface.kind == "smooth":
            raise problem("both surfaces are smooth", "roughness on one of them, lower.surface or upper.surface")
        return self

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> None:
        """There is none between flat walls; see `bem.scenes.resolutions.CELLS`."""


def resolve(scene: FlowFactorsScene) -> FlowFactorsScene:
    """Fill in the grid where measured surfaces decide it, and the hardness of the softer surface."""
    scene = build.with_grid(scene)
    return build.with_hardness(scene, "flow", needed=True) if scene.flow.behaviour == "capped" else scene


def plan(scene: FlowFactorsScene) -> Plan:
    """What will be computed."""
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


_factor = partial(Figure, "", dimensions=("asked",))


@dataclass(frozen=True, eq=False, kw_only=True)
class FlowRecord(Record):
    """Factors at every separation, in rising order."""

    combined_Sq: Annotated[float, Figure("nm", "Sq of both surfaces together", headline=True, unjudged=True)]
    separation: Annotated[FloatArray, Figure("nm", "separation of the mean planes", ("asked",), unjudged=True)]
    separation_over_Sq: Annotated[FloatArray, _factor("separation over Sq", headline=True, unjudged=True)]
    pressure_x: Annotated[FloatArray, _factor("pressure flow factor along x", headline=True)]
    pressure_y: Annotated[FloatArray, _factor("pressure flow factor along y", headline=True)]
    pressure_xy: Annotated[FloatArray, _factor("pressure flow factor along x of a gradient along y")]
    shear_x: Annotated[FloatArray, _factor("shear flow factor, all roughness on one wall", headline=True)]
    shear_pair: Annotated[FloatArray, _factor("shear flow factor, lower wall less upper one by variance")]
    friction_sliding: Annotated[FloatArray, _factor("friction factor of sliding (phi_f)")]
    friction_shear: Annotated[FloatArray, _factor("friction factor of shear flow (phi_fs)")]
    friction_pressure: Annotated[FloatArray, _factor("friction factor of pressure flow (phi_fp)")]
    mean_gap: Annotated[FloatArray, Figure("nm", "mean gap", ("asked",))]
    contact_area_fraction: Annotated[FloatArray, _factor("contact area over that of the patch", headline=True)]
    flows_through_x: Annotated[NDArray[np.int64], _factor("1 where fluid hangs together along x", unjudged=True)]
    flows_through_y: Annotated[NDArray[np.int64], _factor("1 where fluid hangs together along y", unjudged=True)]
    residual: Annotated[float, Figure("", "largest relative residual", headline=True, unjudged=True)]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along the flow", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    height: Annotated[FloatArray, Series(("x", "y"), "m", "height of both surfaces together", of="first")]


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
    return filled(
        FlowRecord,
        found,
        grid,
        combined_Sq=found.rms_height,
        separation=found.separations,
        separation_over_Sq=found.separations / found.rms_height,
        shear_pair=found.shear_x * pair,
        residual=float(found.residual.max()),
        flows_through_x=found.flows_through_x.astype(np.int64),
        flows_through_y=found.flows_through_y.astype(np.int64),
        height=heights,
        **error_bars(context, flow.errors, lambda: _bars(found, heights, grid, pair)),
        where=f"separation {', '.join(wrong)}: {found.status.message}",
    )


def _bars(found: FlowFactors, heights: FloatArray, grid: Grid, pair: float) -> ErrorBars:
    """With that of roughness on both walls."""
    from bem.accuracy import flow_bars

    bars = flow_bars(found, heights, grid)
    return bars | bars.renamed({"shear_x": "shear_pair"}, lambda error: abs(pair) * error)


KIND = Kind.of(
    vars(),
    FlowFactorsScene,
    FlowRecord,
    "flow factors of rough surfaces over separation, as deformed in their contact",
    resolutions=(CELLS,),
    figures=("flow-factors", "flow-heights"),
)
