"""Kind `contact`, from its parts."""

from __future__ import annotations

from bem.kinds.contact.checks import contacts
from bem.kinds.contact.errors import RESOLUTIONS
from bem.kinds.contact.parallel import refuse_on_ranks
from bem.kinds.contact.plan import plan
from bem.kinds.contact.record import ContactRecord, summarise
from bem.kinds.contact.run import run
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.uncertain import by_tangent
from bem.scenes.kind import Kind

KIND = Kind(
    name="contact",
    title="dry contact of rough, possibly coated bodies: pressure, real contact area, approach, stresses below",
    model=ContactScene,
    record=ContactRecord,
    plan=plan,
    run=run,
    summarise=summarise,
    resolve=ContactScene.resolved,
    resolutions=RESOLUTIONS,
    volumes=lambda scene: scene.outputs.volumes,
    contacts=contacts,
    by_tangent=by_tangent,
    refuse_on_ranks=refuse_on_ranks,
    figures=(
        "pressure-map",
        "contact-map",
        "wheel-rail",
        "contact-section",
        "pressure-histogram",
        "von-mises-section",
        "von-mises-depth",
        "layer-stresses",
        "adhesion-path",
        "contact-over-time",
        "friction-over-speed",
        "area-over-load",
        "spot-sizes",
        "convergence",
        "surface-maps",
    ),
    warm_up=(
        ("rough-contact", ("grid.shape=256",)),
        ("hertz-sphere", ()),
        ("hertz-cylinder", ()),
        ("sinusoid", ()),
        ("coated-sphere", ("grid.shape=96",)),
        ("wheel-flange-root", ("grid.shape=[8, 44]",)),
    ),
)
