"""Kind `asperities`, from its parts."""

from __future__ import annotations

from bem.kinds.asperities.checks import contacts
from bem.kinds.asperities.errors import RESOLUTIONS
from bem.kinds.asperities.plan import plan
from bem.kinds.asperities.record import AsperityRecord, summarise
from bem.kinds.asperities.run import run
from bem.kinds.asperities.scene import AsperitiesScene, axes
from bem.scenes.kind import Kind

KIND = Kind(
    name="asperities",
    title="dry contact of an asperity array: load per asperity over interference, at several spacings",
    model=AsperitiesScene,
    record=AsperityRecord,
    plan=plan,
    run=run,
    axes=axes,
    summarise=summarise,
    resolutions=RESOLUTIONS,
    always_lists=True,
    contacts=contacts,
    figures=("asperity-loads", "pressure-map"),
    headline=("spacing_um", "load_over_hertz", "load_over_hertz_finite_array", "hertz_load_N"),
    warm_up=(("uniform-asperities", ('array.spacings=["20 um"]', 'array.interferences=["50 nm"]', "array.cell=1 um")),),
)
