"""Kind `running-in-life`, from its parts."""

from __future__ import annotations

from bem.kinds.running_in_life.checks import contacts
from bem.kinds.running_in_life.plan import plan
from bem.kinds.running_in_life.record import RunningInLifeRecord, summarise
from bem.kinds.running_in_life.run import run
from bem.kinds.running_in_life.scene import RunningInLifeScene, axes, resolve
from bem.scenes.kind import Kind

KIND = Kind(
    name="running-in-life",
    title="running-in over a life: wear, tribofilm and micropitting over millions of cycles in mixed lubrication",
    model=RunningInLifeScene,
    record=RunningInLifeRecord,
    plan=plan,
    run=run,
    resolve=resolve,
    axes=axes,
    summarise=summarise,
    contacts=contacts,
    figures=(
        "friction-over-life",
        "wear-over-life",
        "film-over-life",
        "jumps",
        "particles-over-life",
        "micropitting-over-life",
        "damage-map",
        "worn-surface",
        "pressure-map",
        "film-map",
    ),
    headline=("speed_m_s",),
    warm_up=(
        ("micropitting-rig", ("life.count=64", "wear.positions=2", "grid.shape=[80, 12]", "fatigue.depths.count=2")),
        (
            "running-in-life",
            (
                "life.count=64",
                "wear.positions=2",
                'fatigue={criterion = "crossland", depths = {count = 2, spacing = "1 um"}}',
            ),
        ),
    ),
)
