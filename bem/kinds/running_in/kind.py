"""Kind `running-in`, from its parts."""

from __future__ import annotations

from bem.kinds.running_in.checks import contacts
from bem.kinds.running_in.errors import RESOLUTIONS
from bem.kinds.running_in.plan import plan
from bem.kinds.running_in.record import RunningInRecord, scattering, summarise
from bem.kinds.running_in.run import run
from bem.kinds.running_in.scene import RunningInScene, axes, resolve
from bem.scenes.kind import Kind

KIND = Kind(
    name="running-in",
    title="running-in in mixed lubrication (with oil film): friction, roughness and wear particles over wear cycles",
    model=RunningInScene,
    record=RunningInRecord,
    plan=plan,
    run=run,
    resolve=resolve,
    axes=axes,
    summarise=summarise,
    scattering=scattering,
    resolutions=RESOLUTIONS,
    always_lists=True,
    contacts=contacts,
    figures=(
        "running-in-stribeck",
        "friction-over-cycles",
        "contact-share-over-cycles",
        "wear-over-cycles",
        "particle-radius-over-speed",
        "friction-over-hardness",
        "worn-surface",
        "pressure-map",
        "running-in-frames",
        "slip-and-wear",
    ),
    headline=("speed_m_s",),
    warm_up=(
        (
            "running-in-stribeck",
            (
                "repetitions=1",
                "cycles.count=3",
                "cycles.settled=1",
                "depths.count=8",
                'speeds.values=["0.01 m/s"]',
                "cycles.averaged=1",
                "grid.shape=96",
            ),
        ),
    ),
)
