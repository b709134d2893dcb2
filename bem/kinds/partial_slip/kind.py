"""Kind `partial-slip`, from its parts."""

from __future__ import annotations

from bem.kinds.partial_slip.checks import contacts
from bem.kinds.partial_slip.errors import RESOLUTIONS
from bem.kinds.partial_slip.plan import plan
from bem.kinds.partial_slip.record import PartialSlipRecord
from bem.kinds.partial_slip.run import run
from bem.kinds.partial_slip.scene import PartialSlipScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="partial-slip",
    title="partial slip and fretting: stick and slip zones, hysteresis loop and friction energy under tangential load",
    model=PartialSlipScene,
    record=PartialSlipRecord,
    plan=plan,
    run=run,
    resolve=PartialSlipScene.resolved,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "contact-stiffness",
        "wheel-rail",
        "slip-map",
        "traction-section",
        "slip-loop",
        "pressure-map",
        "von-mises-section",
        "von-mises-depth",
    ),
    warm_up=(("fretting-ball", ("grid.shape=48", "push.steps=2")),),
)
