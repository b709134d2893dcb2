"""One sliding cycle: contact, then the pieces that the criterion finds, body by body.

Every choice that the source leaves open is a field of `WearModel`, one name away from its alternatives.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from bem.arguments import named
from bem.contact import ContactSolution, solve_contact
from bem.contact.contact_area import rows_in_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.laws import make_laws
from bem.wear.criterion import Detachment
from bem.wear.film_defect import FilmDefect
from bem.wear.loads import BodyCycle, Removal, SurfaceLoad, half_the_change
from bem.wear.misfits import boundary_film_misfits
from bem.wear.removal import RemovalLaw
from bem.wear.segmentation import CONNECTIVITIES, REFINEMENTS
from bem.wear.setup import LOWER, UPPER, WearSetup
from bem.wear.third_bodies import ThirdBodies, ThirdBodyLoad
from bem.wear.traction import Rubbing, TractionLaw


@dataclass(frozen=True)
class WearModel:
    """The named, replaceable parts of the wear model.

    criterion : the name of one of `bem.wear.criterion` or of your own, or a `Detachment`. "von_mises" is the
        source's; "tresca" and "maximum_tension", too, let material leave where an equivalent stress exceeds the yield
        stress. These have no length but the cell and a skin at the surface; "averaged_von_mises", "sphere", "junction"
        have one of the material, "low_cycle_fatigue" counts passes. "archard", "archard_over_hardness" and "energy"
        wear by pressure and distance, without pieces.
    stress_range : judge half the change of stress that each body's material has seen since the last cycle instead of
        the stress (low-cycle fatigue: a range of twice the yield stress is what shakedown can bear).
    refine, refinement : fine voxels per depth interval and how stress is interpolated between depths; "exact" computes
        the stress at every fine depth and is the check of the others.
    connectivity : 6, 18 or 26 neighbours.
    removal : "cap" (a piece takes the material above it along: an addition to the source), "top_run" (only material
        that yields leaves, as in the source), or a law of your own.
    wears : "softer" (lower yield stress; the lower body where equal), "lower", "upper" or "both".
    frame : which body stands still with the contact. "cylinder": the upper body and the contact are fixed in space and
        the lower body moves through them, so that all places of its track wear alike; "disk": the lower body is fixed
        and the roughness of the upper body moves, so that the contact wears a groove into the lower one.
    shift : cells that the moving body slides along x per cycle in the direction of friction; negative is against it.
    within_layer : pieces of a coated body end at the interface at the latest; the film is taken as replenished.
    traction : the name of one of `bem.wear.traction` or of your own, a table with `kind` and parameters, or a
        `TractionLaw`. "gross_sliding" is the source's, friction x pressure everywhere; "oscillating_force" and
        "oscillating_shift" give stresses, pieces and local wear the tractions and the slip of a loop in partial slip.
    third_bodies : particles that stay between the surfaces, `bem.wear.third_bodies.ThirdBodies` or a table of its
        fields; None for none. Of dry contacts and of `MixedContact`, where these slide; they roll half as far as a
        cycle of the criterion stands for.
    film_defect : of a boundary film that protects what wears locally, `bem.wear.film_defect.FilmDefect` or a table of
        its fields; None for surfaces that wear as the criterion says.
    """

    criterion: str | Mapping[str, Any] | Detachment = "von_mises"
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
            object.__setattr__(self, "third_bodies", ThirdBodies(**self.third_bodies))
        if isinstance(self.film_defect, Mapping):
            object.__setattr__(self, "film_defect", FilmDefect(**self.film_defect))
        misfits = list(self.tractions.misfits(self.law, self.stress_range))
        if self.particles is not None and not self.tractions.slides:
            misfits.append(
                f"third bodies roll where surfaces slide; allowed: no traction {self.tractions.name}, or none"
            )
        if self.boundary_film is not None:
            misfits += boundary_film_misfits(self.law, self.tractions)
        if misfits:
            raise InputError([f"WearModel: {text}" for text in misfits])

    @property
    def moving(self) -> int:
        """Index of the body that moves through the contact."""
        return LOWER if self.frame == "cylinder" else UPPER

    @property
    def law(self) -> Detachment:
        """The criterion, also where it was named."""
        assert isinstance(self.criterion, Detachment)
        return self.criterion

    @property
    def particles(self) -> ThirdBodies | None:
        """The third bodies, also where they were a table."""
        assert self.third_bodies is None or isinstance(self.third_bodies, ThirdBodies)
        return self.third_bodies

    @property
    def boundary_film(self) -> FilmDefect | None:
        """The film's defect, also where it was a table."""
        assert self.film_defect is None or isinstance(self.film_defect, FilmDefect)
        return self.film_defect

    @property
    def tractions(self) -> TractionLaw:
        """The traction law, also where it was named."""
        assert isinstance(self.traction, TractionLaw)
        return self.traction


@dataclass(frozen=True, eq=False)
class ContactOutcome:
    """What a cycle needs to know of a contact, dry or mixed.

    rubbing : of a cycle in partial slip, which `wear_cycle` adds; None where all slides. third_bodies : what particles
    between the surfaces do; None where there are none. temperature : (nx, ny) [K] of surfaces that rubbing heats; None
    where no heat was asked for. strip : the fraction of each row (nx,) within the strip that is in contact anywhere;
    None takes whole rows by the pressure.
    """

    pressure: FloatArray
    contact_area: float
    plastic_area: float
    load: float
    friction: float
    residual: float
    convolutions: float
    status: Status
    minimum_film: float = 0.0
    rubbing: Rubbing | None = None
    third_bodies: ThirdBodyLoad | None = None
    temperature: FloatArray | None = None
    strip: FloatArray | None = None


ContactStep = Callable[[FloatArray, FloatArray | None], ContactOutcome]
"""(sum of the heights of both bodies (nx, ny) [m], last pressure or None) -> ContactOutcome"""


def dry_contact(setup: WearSetup, *, tolerance: float = 1e-6, compliance: float = 0.0) -> ContactStep:
    """Load-controlled dry contact of the setup, as a step of the cycle.

    The tolerance is relative to the rms roughness: 1e-6 of some hundred nanometres is far below an atom.
    compliance : what each place gives way by wear in the cycle [m/Pa].
    """
    operator = displacement_operator(setup.grid, setup.bodies, friction=setup.friction, compliance=compliance)

    def step(heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        solution = solve_contact(
            setup.gap - heights,
            operator,
            load=setup.load,
            hardness=setup.hardness,
            tolerance=tolerance,
            initial_pressure=last_pressure,
        )
        return outcome_of(solution, setup, operator)

    return step


def outcome_of(solution: ContactSolution, setup: WearSetup, operator: DisplacementOperator) -> ContactOutcome:
    """What a cycle needs to know of a dry contact that was solved with an operator."""
    told = named(solution, "pressure contact_area plastic_area load residual convolutions status")
    modulus = operator.modulus_at(0.5 * math.pi / math.sqrt(setup.grid.cell_area))
    strip = rows_of_contact(solution, setup.grid, modulus, cap=setup.hardness, compliance=operator.compliance)
    return ContactOutcome(**told, friction=setup.friction, strip=strip)


def rows_of_contact(
    solution: ContactSolution, grid: Grid, modulus: float, *, cap: float | None = None, compliance: float = 0.0
) -> FloatArray:
    """The fraction of each row (nx,) within the strip in contact of a solution; see `rows_in_contact`."""
    undeformed = solution.gap - solution.displacement  # but for a constant
    limit = math.inf if cap is None else cap
    pressure, gap = solution.pressure, solution.gap
    return rows_in_contact(pressure, gap, undeformed, grid, modulus, cap=limit, compliance=compliance)


def wear_cycle(
    heights: tuple[FloatArray, FloatArray],
    setup: WearSetup,
    model: WearModel,
    contact_step: ContactStep,
    start: FloatArray | None,
    last_loads: tuple[SurfaceLoad | None, SurfaceLoad | None] = (None, None),
    memories: tuple[FloatArray | None, FloatArray | None] = (None, None),
) -> tuple[ContactOutcome, list[Removal]]:
    """One cycle on the heights (nx, ny) [m] of the lower and upper body, as they face each other now.

    start : pressure (nx, ny) that the contact begins from; it decides nothing but the effort.
    last_loads : what acted in the last cycle on the material of the lower and of the upper body that is on the grid
        now, cell by cell; None for nothing. Only a range of stress asks for it.
    memories : what the criterion kept of that material, (planes, nx, ny).

    Returns the contact, and what leaves from which body. Nothing is changed in place.
    """
    contact = contact_step(heights[LOWER] + heights[UPPER], start)
    rubbing = model.tractions.rub(contact.pressure, contact.friction, setup)
    acting = SurfaceLoad(contact.pressure, contact.friction, None if rubbing is None else rubbing.traction)
    slid = None if rubbing is None else model.tractions.loops_per_cycle * rubbing.slid
    slide = abs(model.shift) * setup.grid.spacing[0]
    removals = []
    for body in setup.wearing(model):
        loads = half_the_change(acting, last_loads[body]) if model.stress_range else (acting,)
        cycle = BodyCycle(contact.pressure, loads, setup, model, body, slide, memories[body], slid, contact.temperature)
        removals.append(model.law.detach(cycle))
    return contact if rubbing is None else replace(contact, rubbing=rubbing), removals
