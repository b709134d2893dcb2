"""Kind `rolling`, from its parts."""

from __future__ import annotations

from bem.kinds.rolling.checks import contacts
from bem.kinds.rolling.errors import RESOLUTIONS
from bem.kinds.rolling.plan import plan
from bem.kinds.rolling.record import RollingRecord
from bem.kinds.rolling.run import run
from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="rolling",
    title="rolling contact with creepage and spin: stick and slip zones, creep force and friction energy",
    model=RollingContactScene,
    record=RollingRecord,
    plan=plan,
    run=run,
    resolve=RollingContactScene.resolved,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "creep-curve",
        "rolling-history",
        "wheel-rail",
        "slip-map",
        "traction-section",
        "pressure-map",
        "von-mises-section",
        "von-mises-depth",
    ),
    warm_up=(("rolling-creepage", ("grid.shape=24", 'over={"roll.creepage" = [0.001]}')),),
)
