"""The wear model: criterion, removal law, traction law and the other choices that the source leaves open.

Knows laws; no contact and no cycle. Verified in tests/wear/test_cycle.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import InputError
from bem.laws import make_laws
from bem.wear.criterion import Criterion
from bem.wear.film_defect import FilmDefect, film_defect_misfits
from bem.wear.removal import RemovalLaw
from bem.wear.segmentation import CONNECTIVITIES, REFINEMENTS
from bem.wear.setup import LOWER, UPPER, WearSetup, wearing_bodies
from bem.wear.traction import TractionLaw

if TYPE_CHECKING:
    from bem.wear.third_bodies import ThirdBodies


@dataclass(frozen=True)
class WearModel:
    """Choices of a wear model: each is a name, a table of parameters or an object of your own.

    criterion : the name of one of `bem.wear.criterion` or of your own, or a `Criterion`; `criterion_law` is the object.
        A `StressCriterion` compares an equivalent stress with the yield stress. "von_mises" is the source's; "tresca"
        and "maximum_tension", too, let material leave where an equivalent stress exceeds the yield stress. These have
        no length but the cell and a skin at the surface; "averaged_von_mises" and "junction" have one of the
        material, "low_cycle_fatigue" counts passes. "archard", "archard_over_hardness" and "energy" wear by pressure
        and distance, without pieces.
    stress_range : judge half the change of stress that each body's material has seen since the last cycle instead of
        the stress (low-cycle fatigue: a range of twice the yield stress is what shakedown can bear). There is no load
        before the first cycle, so half its stress counts. Residual stresses of layers do not change and count nothing.
    refine, refinement : fine voxels per depth interval and how stress is interpolated between depths; "exact" computes
        the stress at every fine depth and is the check of the others.
    connectivity : 6, 18 or 26 neighbours.
    removal : "cap" (a piece takes the material above it along: an addition to the source), "top_run" (only material
        that yields leaves, as in the source), or a law of your own.
    wears : "softer" (lower yield stress; the lower body where equal), "lower", "upper" or "both".
    frame : which body stands still with the contact. "cylinder": the upper body (the cylinder) and the contact are
        fixed in space and the lower body moves through them, so that all places of its track wear alike; "disk": the
        lower body is fixed and the roughness of the upper body moves, so that the contact wears a groove into the lower
        one. The speeds of a film are not compared with it: a film is steady in the frame of its contact whichever body
        carries the roughness along, and the source does not state which one it moved.
    shift : cells that the moving body slides over the other one along x before each cycle but the first: for positive
        friction and shift the upper body along +x, the lower one along -x (`running_in.sliding_direction`), so that
        friction on the moving body acts against its motion. A cycle counts the slide of as many cells, the first one,
        too; laws of local wear have a distance of their own.
    within_layer : pieces of a coated body end at the interface at the latest; the film is taken as replenished.
    traction : the name of one of `bem.wear.traction` or of your own, a table with `kind` and parameters, or a
        `TractionLaw`. "gross_sliding" is the source's, friction x pressure everywhere; "oscillating_force" and
        "oscillating_shift" give stresses, pieces and local wear the tractions and the slip of a loop in partial slip.
        Film and friction of a lubricated contact are of gross sliding all the same, which a note says.
    third_bodies : particles that stay between the surfaces, `bem.wear.third_bodies.ThirdBodies` or a table of its
        fields; None for none. Of dry contacts and of `MixedContact`, where these slide; they roll half as far as a
        cycle of the criterion stands for, and not at all between surfaces of equal speeds.
    film_defect : of a boundary film that protects what wears locally, `bem.wear.film_defect.FilmDefect` or a table of
        its fields; None for surfaces that wear as the criterion says.
    """

    criterion: str | Mapping[str, Any] | Criterion = "von_mises"
    stress_range: bool = False
    refine: int = 10
    refinement: str = "monotone_cubic"
    connectivity: int = 6
    removal: str | RemovalLaw = "cap"
    wears: str = "softer"
    frame: str = "cylinder"
    shift: int = 3
    within_layer: bool = True
    traction: str | Mapping[str, Any] | TractionLaw = "gross_sliding"
    third_bodies: ThirdBodies | Mapping[str, Any] | None = None
    film_defect: FilmDefect | Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        messages = []
        for key, allowed in (
            ("refinement", [*REFINEMENTS, "exact"]),
            ("connectivity", list(CONNECTIVITIES)),
            ("wears", ["softer", "lower", "upper", "both"]),
            ("frame", ["cylinder", "disk"]),
        ):
            if getattr(self, key) not in allowed:
                messages.append(f"WearModel: {key} {getattr(self, key)!r} must be one of {allowed}")
        if self.refine != int(self.refine) or self.refine < 1:
            messages.append(f"WearModel: refine {self.refine!r} must be an integer >= 1")
        if self.shift != int(self.shift):
            messages.append(f"WearModel: shift {self.shift!r} must be a whole number of cells")
        try:
            chosen = {key: getattr(self, key) for key in ("criterion", "removal", "traction")}
            made = make_laws("WearModel", chosen, {})
        except InputError as error:
            raise InputError([*messages, *error.messages]) from None
        if messages:
            raise InputError(messages)
        for key, law in made.items():
            object.__setattr__(self, key, law)
        if isinstance(self.third_bodies, Mapping):
            from bem.wear.third_bodies import ThirdBodies  # imports both contacts

            object.__setattr__(self, "third_bodies", ThirdBodies(**self.third_bodies))
        if isinstance(self.film_defect, Mapping):
            object.__setattr__(self, "film_defect", FilmDefect(**self.film_defect))
        misfits = list(self.traction_law.misfits(self.criterion_law, self.stress_range))
        if self.third_body_model is not None and not self.traction_law.slides:
            misfits.append(
                f"third bodies roll where surfaces slide; allowed: no traction {self.traction_law.name}, or none"
            )
        if self.film_defect_model is not None:
            law, tractions = self.criterion_law, self.traction_law
            misfits += film_defect_misfits(law.name, law.wears_by_pressure, tractions.name, tractions.slides)
        if misfits:
            raise InputError([f"WearModel: {text}" for text in misfits])

    @property
    def moving(self) -> int:
        """Index of the body that moves through the contact."""
        return LOWER if self.frame == "cylinder" else UPPER

    @property
    def criterion_law(self) -> Criterion:
        """The `criterion` as an object."""
        assert isinstance(self.criterion, Criterion)
        return self.criterion

    @property
    def third_body_model(self) -> ThirdBodies | None:
        """Third bodies, the particles that stay between the surfaces; None for none."""
        assert not isinstance(self.third_bodies, Mapping)
        return self.third_bodies

    @property
    def film_defect_model(self) -> FilmDefect | None:
        """Fractional film defect of a boundary film; None for unprotected surfaces."""
        assert self.film_defect is None or isinstance(self.film_defect, FilmDefect)
        return self.film_defect

    @property
    def traction_law(self) -> TractionLaw:
        """The traction law as an object."""
        assert isinstance(self.traction, TractionLaw)
        return self.traction

    def checked_wearing_bodies(self, setup: WearSetup) -> tuple[int, ...]:
        """Return the indices of the bodies that wear, after checks of the laws against a setup.

        Raises
        ------
        InputError : a wearing body without yield stress; lengths, depths or a friction that a law cannot use; a skin or
            a layer that leaves fewer than two depths.
        """
        self.criterion_law.check_length(setup.grid)
        self.traction_law.check(setup.friction)
        bodies = wearing_bodies(setup.bodies, self.wears)
        if self.criterion_law.needs_strength and any(not np.isfinite(setup.yield_stress(body)) for body in bodies):
            raise InputError("the body that wears has no yield_stress and no hardness: give its material one of them")
        self.criterion_law.check_depths(setup.depths)
        from bem.wear.yielding import EquivalentStressLaw, check_usable_depths  # transforms are not loaded for a name

        if isinstance(self.criterion_law, EquivalentStressLaw):
            for body in bodies:
                check_usable_depths(setup, self, body)
        return bodies
