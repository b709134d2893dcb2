"""Wear: which pieces come off, how large, what shape, and how the surface settles (thesis, papers B, C and D).

`setup` stays the same over all cycles, `cycle` is one sliding cycle, `running_in` the loop. A criterion (`criterion`)
is given what acts on a body (`loads`) and says what comes off: `yielding` where it yields, `segmentation` and
`yielded_runs` pieces there, `removal` what leaves with them, `junctions`, `fatigue`, `lengths` what criteria with a
length need; `mixed` is the contact of a lubricated cycle. Names are loaded when first used, so that the criteria cost
no solver.

Sees contacts, stresses, particles and mixed lubrication; no scene, no file. Verified in tests/wear: volumes are what
the surface loses, pieces those of labelling every voxel, resumed runs the same bits; against papers C and D in the
validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.wear.cycle import (
        ContactOutcome,
        ContactStep,
        WearModel,
        dry_contact,
        wear_cycle,
    )
    from bem.wear.running_in import RunningIn, Settled, advance, equivalent_radius, run_in
    from bem.wear.segmentation import Segmentation, describe_pieces, find_particles, refine_depths, segment
    from bem.wear.setup import WearSetup
    from bem.wear.state import RunningInState, initial_state, pack_state, unpack_state
    from bem.wear.yielding import yielded_pieces

__all__ = [
    "ContactOutcome",
    "ContactStep",
    "RunningIn",
    "RunningInState",
    "Segmentation",
    "Settled",
    "WearModel",
    "WearSetup",
    "advance",
    "describe_pieces",
    "dry_contact",
    "equivalent_radius",
    "find_particles",
    "initial_state",
    "pack_state",
    "refine_depths",
    "run_in",
    "segment",
    "unpack_state",
    "wear_cycle",
    "yielded_pieces",
]

__getattr__ = loader(
    __name__,
    {
        "cycle": [
            *("ContactOutcome", "ContactStep", "WearModel"),
            *("dry_contact", "wear_cycle"),
        ],
        "running_in": ["RunningIn", "Settled", "advance", "equivalent_radius", "run_in"],
        "segmentation": ["Segmentation", "describe_pieces", "find_particles", "refine_depths", "segment"],
        "setup": ["WearSetup"],
        "state": ["RunningInState", "initial_state", "pack_state", "unpack_state"],
        "yielding": ["yielded_pieces"],
    },
)
