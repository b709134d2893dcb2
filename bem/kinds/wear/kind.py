"""Kind `wear`, from its parts."""

from __future__ import annotations

from bem.kinds.wear.checks import contacts
from bem.kinds.wear.errors import RESOLUTIONS
from bem.kinds.wear.plan import plan
from bem.kinds.wear.record import WearRecord, scattering, summarise
from bem.kinds.wear.run import run
from bem.kinds.wear.scene import WearScene, axes, resolve
from bem.scenes.kind import Kind

KIND = Kind(
    name="wear",
    title="wear in boundary lubrication (no oil film): particles, volume and roughness of a cylinder on a flat",
    model=WearScene,
    record=WearRecord,
    plan=plan,
    run=run,
    axes=axes,
    summarise=summarise,
    scattering=scattering,
    resolve=resolve,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "particle-radius-over-cycles",
        "wear-volume-over-cycles",
        "contact-pressure-over-cycles",
        "roughness-over-cycles",
        "particle-distribution",
        "radius-over-load",
        "worn-surface",
        "particle-shapes",
        "pressure-map",
        "slip-and-wear",
    ),
    warm_up=(
        (
            "wear-soft-roughness",
            (
                "repetitions=1",
                "cycles.count=3",
                "cycles.settled=1",
                "depths.count=8",
                "domain.cells=120",
                "domain.half_widths=2.4",
            ),
        ),
        ("fretting-wear", ("cycles.count=3", "cycles.settled=1", "domain.cells=[60, 2]")),
        (
            "wear-steel-brass",
            ("repetitions=1", "cycles.count=3", "cycles.settled=1", "depths.count=8", "domain.cells=160"),
        ),
        (
            "wear-criteria",
            (
                "repetitions=1",
                "cycles.count=3",
                "cycles.settled=1",
                "depths.count=8",
                "domain.cells=96",
                "variants[4].criterion.passes=100000",
            ),
        ),
    ),
)
