"""Wear: which pieces come off, how large, what shape, and how the surface runs in (thesis, papers B, C and D).

Algorithm of `run_in` (running_in.py), one cycle after the other:

1. Move one body through the contact, not before the first cycle, and take the rows of both that face each other
   (running_in.py).
2. Solve the contact: dry (contact_step.py), or shared with a film by `bem.friction` (mixed.py), whose shape follows
   wear in flooded line contacts (worn_shape.py); particles between the surfaces are a step around either
   (third_bodies.py). The loop's own dry contact in gross sliding has local wear as a compliance: its pressure is that
   after the wear of the cycle (criterion/local.py).
3. Shear tractions on the contact: friction x pressure, or those of a loop of partial slip (traction/), of which a film
   and its friction know nothing.
4. Removal by the criterion (criterion/) on each wearing body (cycle.py). Stress criteria: equivalent stress from the
   first depth (the skin, 100 nm by default) down; von Mises stress of one load of friction x pressure, without residual
   stress, only where yielding material is connected to the surface; all others (partial slip, stress range where
   friction changed since the last cycle, other equivalent stresses) in whole planes to one below the first without
   yield (yielding.py); then runs above yield joined to pieces (segmentation.py, yielded_runs.py), of which the removal
   law says what leaves (removal.py). Averaged von Mises: the same, from a pressure averaged over a disc
   (criterion/averaged.py, lengths.py). Others: fatigue damage (damage.py), junctions (junctions.py), a depth by
   pressure and distance (criterion/local.py).
5. Lower the surfaces by pieces, local wear and cuts of third bodies; append the cycle and its particles to the tables
   (running_in.py).

Heights change by removal and by cuts of third bodies only. Where the pressure is at the hardness, the overlap of the
surfaces leaves no dent: the next cycle begins with heights that are not flattened. In mixed lubrication only the
pressure of the rough contact makes stresses: the pressure of the oil does not, so where the film carries all load
nothing yields. The dry loop is what kind `wear` calls boundary lubrication.

After the loop: the error of the last step of local wear by step doubling (step_doubling.py), figures (outcome.py,
mixed_figures.py). Types: loads.py is what a criterion receives and returns, setup.py and model.py what stays the same.

Source: thesis, papers C and D; each law names its own. Cost: one contact, three to fifteen depths of stress per cycle;
segmentation costs the yielded columns only. Sees contacts, stresses, particles and mixed lubrication; no scene, no
file. Names are loaded when first used, so that laws cost no solver.

Verified in tests/wear: volumes are those that the surface loses, pieces those of labelling every voxel, resumed runs
end in the same bits; validated against papers C and D on the validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.wear.contact_step import ContactOutcome, ContactStart, ContactStep, DryContact, dry_contact
    from bem.wear.cycle import wear_cycle
    from bem.wear.model import WearModel
    from bem.wear.running_in import RunningIn, Settled, advance, equivalent_radius, run_in
    from bem.wear.segmentation import Segmentation, describe_pieces, find_particles, refine_depths, segment
    from bem.wear.setup import WearSetup
    from bem.wear.state import RunningInState, initial_state, pack_state, unpack_state
    from bem.wear.yielding import yielded_pieces

__all__ = [
    "ContactOutcome",
    "ContactStart",
    "ContactStep",
    "DryContact",
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
        "contact_step": ["ContactOutcome", "ContactStart", "ContactStep", "DryContact", "dry_contact"],
        "cycle": ["wear_cycle"],
        "model": ["WearModel"],
        "running_in": ["RunningIn", "Settled", "advance", "equivalent_radius", "run_in"],
        "segmentation": ["Segmentation", "describe_pieces", "find_particles", "refine_depths", "segment"],
        "setup": ["WearSetup"],
        "state": ["RunningInState", "initial_state", "pack_state", "unpack_state"],
        "yielding": ["yielded_pieces"],
    },
)
