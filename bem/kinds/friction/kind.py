"""Kind `friction`, from its parts."""

from __future__ import annotations

from bem.kinds.friction.checks import contacts
from bem.kinds.friction.errors import RESOLUTIONS
from bem.kinds.friction.plan import plan
from bem.kinds.friction.record import CurveRecord, summarise
from bem.kinds.friction.run import run
from bem.kinds.friction.scene import FrictionScene, axes, resolve
from bem.kinds.friction.uncertain import by_tangent
from bem.scenes.kind import Kind

KIND = Kind(
    name="friction",
    title="mixed lubrication (Stribeck curve): friction coefficient and asperity load share over speed",
    model=FrictionScene,
    record=CurveRecord,
    plan=plan,
    run=run,
    resolve=resolve,
    axes=axes,
    summarise=summarise,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    by_tangent=by_tangent,
    figures=(
        "stribeck-curve",
        "load-sharing",
        "contact-temperatures",
        "film-section",
        "film-pressure",
        "friction-map",
        "largest-difference",
        "pressure-map",
    ),
    warm_up=(("stribeck-mineral-oil", ("repetitions=1", "speeds.count=3", "grid.shape=100", "film.points=500")),),
)
