"""Kind `flow-factors`, from its parts."""

from __future__ import annotations

from bem.kinds.flow_factors.errors import RESOLUTIONS
from bem.kinds.flow_factors.plan import plan
from bem.kinds.flow_factors.record import FlowRecord
from bem.kinds.flow_factors.run import run
from bem.kinds.flow_factors.scene import FlowFactorsScene, resolve
from bem.scenes.kind import Kind

KIND = Kind(
    name="flow-factors",
    title="flow factors of rough surfaces (Patir and Cheng) over separation, as deformed in contact",
    model=FlowFactorsScene,
    record=FlowRecord,
    plan=plan,
    run=run,
    resolve=resolve,
    resolutions=RESOLUTIONS,
    figures=("flow-factors", "flow-heights"),
    warm_up=(("flow-factors", ("grid.shape=64", "flow.ratios=[1.0]")),),
)
