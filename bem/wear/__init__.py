"""Wear: which pieces come off, how large, what shape, and how the surface settles (thesis, papers B, C and D).

`cycle` is one sliding cycle, `running_in` the loop; `criterion` says where material yields, `segmentation` and
`yielded_runs` find pieces there, `removal` what leaves with them; `mixed` is the contact of a lubricated cycle. Names
are loaded when first used, so that the criteria cost no solver.

Sees contacts, stresses, particles and mixed lubrication; no scene, no file. Verified in tests/wear: volumes are what
the surface loses, pieces those of labelling every voxel, resumed runs the same bits; against papers C and D in the
validation page.
"""

from typing import TYPE_CHECKING

from bem.lazy import loader

if TYPE_CHECKING:
    from bem.wear.cycle import (
        ContactOutcome,
        ContactStep,
        WearModel,
        WearSetup,
        dry_contact,
        wear_cycle,
        yielded_pieces,
    )
    from bem.wear.running_in import (
        RunningIn,
        RunningInState,
        Settled,
        advance,
        equivalent_radius,
        initial_state,
        pack_state,
        run_in,
        unpack_state,
    )
    from bem.wear.segmentation import Segmentation, describe_pieces, find_particles, refine_depths, segment

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
            *("ContactOutcome", "ContactStep", "WearModel", "WearSetup"),
            *("dry_contact", "wear_cycle", "yielded_pieces"),
        ],
        "running_in": [
            *("RunningIn", "RunningInState", "Settled", "advance", "equivalent_radius"),
            *("initial_state", "pack_state", "run_in", "unpack_state"),
        ],
        "segmentation": ["Segmentation", "describe_pieces", "find_particles", "refine_depths", "segment"],
    },
)
