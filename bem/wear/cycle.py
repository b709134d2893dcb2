"""One sliding cycle: contact, stresses, yielded pieces, removal.

Every choice that the source leaves open is a field of `WearModel`, one name away from its alternatives.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.laws import make_laws
from bem.materials import Body
from bem.stress import subsurface_stress, von_mises_limit, von_mises_planes
from bem.wear.criterion import VonMises, WearCriterion
from bem.wear.removal import RemovalLaw
from bem.wear.segmentation import CONNECTIVITIES, REFINEMENTS, Segmentation, refine_depths, segment

LOWER, UPPER = 0, 1


@dataclass(frozen=True)
class WearModel:
    """The named, replaceable parts of the wear model.

    criterion : "von_mises", "tresca", "maximum_tension", the name of one of your own, or a `WearCriterion`; material
        leaves where the equivalent stress exceeds the yield stress.
    stress_range : judge half the change of stress that each body's material has seen since the last cycle instead of
        the stress (low-cycle fatigue: a range of twice the yield stress is what shakedown can bear).
    refine, refinement : fine voxels per depth interval and how stress is interpolated between depths; "exact" computes
        the stress at every fine depth and is the check of the others.
    connectivity : 6, 18 or 26 neighbours.
    removal : "cap" (a piece takes the material above it along) or "top_run", or a law of your own.
    wears : "softer" (lower yield stress; the lower body where equal), "lower", "upper" or "both".
    shift : cells that the counterface slides along x per cycle, the way that friction says; negative is against it.
    within_layer : pieces of a coated body end at the interface at the latest; the film is taken as replenished.
    """

    criterion: str | WearCriterion = "von_mises"
    stress_range: bool = False
    refine: int = 10
    refinement: str = "monotone_cubic"
    connectivity: int = 6
    removal: str | RemovalLaw = "cap"
    wears: str = "softer"
    shift: int = 3
    within_layer: bool = True

    def __post_init__(self) -> None:
        messages = []
        for key, allowed in (
            ("refinement", [*REFINEMENTS, "exact"]),
            ("connectivity", list(CONNECTIVITIES)),
            ("wears", ["softer", "lower", "upper", "both"]),
        ):
            if getattr(self, key) not in allowed:
                messages.append(f"WearModel: {key} {getattr(self, key)!r} must be one of {allowed}")
        if self.refine != int(self.refine) or self.refine < 1:
            messages.append(f"WearModel: refine {self.refine!r} must be an integer >= 1")
        if self.shift != int(self.shift):
            messages.append(f"WearModel: shift {self.shift!r} must be a whole number of cells")
        try:
            made = make_laws("WearModel", {"criterion": self.criterion, "removal": self.removal}, {})
        except InputError as error:
            raise InputError([*messages, *error.messages]) from None
        if messages:
            raise InputError(messages)
        for key, law in made.items():
            object.__setattr__(self, key, law)

    @property
    def law(self) -> WearCriterion:
        """The criterion, also where it was named."""
        assert isinstance(self.criterion, WearCriterion)
        return self.criterion


@dataclass(frozen=True, eq=False)
class WearSetup:
    """What stays the same over all cycles.

    grid : of the contact. bodies : (lower, upper). gap : macroscopic gap of the smooth bodies, (nx, ny) [m].
    load : on the grid [N]. friction : of the contact, traction over pressure. depths : (nz,) [m], increasing, >= 0.
    hardness : cap of the contact pressure [Pa]; None takes the softer surface's, which may be None (elastic).
    """

    grid: Grid
    bodies: tuple[Body, Body]
    gap: FloatArray
    load: float
    friction: float
    depths: FloatArray
    hardness: float | None = None

    def __post_init__(self) -> None:
        depths = np.asarray(self.depths, dtype=np.float64)
        if depths.ndim != 1 or depths.size < 2 or depths[0] < 0 or not (np.diff(depths) > 0).all():
            raise InputError("WearSetup: depths must be at least two increasing values >= 0 [m]")
        object.__setattr__(self, "depths", depths)
        object.__setattr__(self, "gap", self.grid.check_field(self.gap, "gap"))
        if self.hardness is None:
            known = [b.surface_material.hardness for b in self.bodies if b.surface_material.hardness is not None]
            object.__setattr__(self, "hardness", min(known) if known else None)

    def yield_stress(self, body: int) -> float:
        """Yield stress of a body's surface material [Pa]; infinite where none is given: it does not wear."""
        value = self.bodies[body].surface_material.yield_stress
        return np.inf if value is None else value

    def wearing(self, model: WearModel) -> tuple[int, ...]:
        """Indices of the bodies that wear."""
        if model.wears == "softer":
            bodies: tuple[int, ...] = (LOWER,) if self.yield_stress(LOWER) <= self.yield_stress(UPPER) else (UPPER,)
        else:
            bodies = {"lower": (LOWER,), "upper": (UPPER,), "both": (LOWER, UPPER)}[model.wears]
        if any(not np.isfinite(self.yield_stress(body)) for body in bodies):
            raise InputError("the body that wears has no yield_stress and no hardness: give its material one of them")
        return bodies


@dataclass(frozen=True, eq=False)
class ContactOutcome:
    """What a cycle needs to know of a contact, dry or mixed."""

    pressure: FloatArray
    contact_area: float
    plastic_area: float
    load: float
    friction: float
    residual: float
    convolutions: float
    status: Status
    minimum_film: float = 0.0


ContactStep = Callable[[FloatArray, FloatArray | None], ContactOutcome]
"""(sum of the heights of both bodies (nx, ny) [m], last pressure or None) -> ContactOutcome"""


def dry_contact(setup: WearSetup, *, tolerance: float = 1e-6) -> ContactStep:
    """Load-controlled dry contact of the setup, as a step of the cycle.

    The tolerance is relative to the rms roughness: 1e-6 of some hundred nanometres is far below an atom.
    """
    operator = displacement_operator(setup.grid, setup.bodies, friction=setup.friction)

    def step(heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        solution = solve_contact(
            setup.gap - heights,
            operator,
            load=setup.load,
            hardness=setup.hardness,
            tolerance=tolerance,
            initial_pressure=last_pressure,
        )
        return ContactOutcome(
            pressure=solution.pressure,
            contact_area=solution.contact_area,
            plastic_area=solution.plastic_area,
            load=solution.load,
            friction=setup.friction,
            residual=solution.residual,
            convolutions=solution.convolutions,
            status=solution.status,
        )

    return step


@dataclass(frozen=True, eq=False)
class Removal:
    """Pieces of one body in one cycle, how many depths had to be computed to find them, and the time that took [s]."""

    body: int
    pieces: Segmentation
    depths_computed: int
    stress_time: float
    segmentation_time: float


@dataclass(frozen=True, eq=False)
class SurfaceLoad:
    """Pressure (nx, ny) [Pa] on a body, and the friction it slides with: traction over pressure, on the lower body."""

    pressure: FloatArray
    friction: float


def half_the_change(now: SurfaceLoad, before: SurfaceLoad | None) -> tuple[SurfaceLoad, ...]:
    """Loads whose stresses add up to half the change of stress; nothing acted before the first cycle.

    One load where the friction is the same, since stress is linear in pressure and traction.
    """
    if before is None:
        return (SurfaceLoad(0.5 * now.pressure, now.friction),)
    if before.friction == now.friction:
        return (SurfaceLoad(0.5 * (now.pressure - before.pressure), now.friction),)
    return (SurfaceLoad(0.5 * now.pressure, now.friction), SurfaceLoad(-0.5 * before.pressure, before.friction))


def equivalent_stress_planes(
    loads: Sequence[SurfaceLoad],
    setup: WearSetup,
    body: int,
    depths: FloatArray,
    criterion: WearCriterion,
    out: FloatArray,
) -> Iterator[FloatArray]:
    """Equivalent stress of all loads together in one body, a plane of `out` (nz, nx, ny) [Pa] per depth, each written
    when it is asked for.

    Traction on the upper body has the other sign.
    """
    grid, solid, sign = setup.grid, setup.bodies[body], 1 if body == LOWER else -1
    if isinstance(criterion, VonMises) and len(loads) == 1:
        (load,) = loads
        yield from von_mises_planes(load.pressure, grid, solid, depths, friction=sign * load.friction, out=out)
        return
    for index, depth in enumerate(depths):
        stress = sum(
            subsurface_stress(load.pressure, grid, solid, depth[None], friction=sign * load.friction)[:, 0]
            for load in loads
        )
        out[index] = criterion.equivalent_stress(np.asarray(stress))
        yield out[index]


def cannot_yield(
    loads: Sequence[SurfaceLoad], setup: WearSetup, body: int, depth: float, criterion: WearCriterion
) -> bool:
    """Whether a bound, found without a transform, proves that nothing yields at a depth.

    Von Mises stress is a norm of the deviator: that of several loads together is at most the sum of theirs.
    """
    factor = criterion.von_mises_factor
    if factor is None:
        return False
    grid, solid, sign = setup.grid, setup.bodies[body], 1 if body == LOWER else -1
    limit = sum(
        von_mises_limit(load.pressure, grid, solid, [depth], friction=sign * load.friction)[0] for load in loads
    )
    return bool(factor * limit <= setup.yield_stress(body))


def depths_for(setup: WearSetup, model: WearModel, body: int) -> FloatArray:
    """Depths at which stress is computed: the setup's, cut at the outermost interface, refined where exact."""
    depths = setup.depths
    interfaces = setup.bodies[body].interfaces
    if interfaces and model.within_layer:
        # a depth closer to the interface than a tenth of an interval gives way to it
        sliver = 0.1 * float(np.diff(depths).min())
        depths = np.append(depths[depths < interfaces[0] - sliver], interfaces[0])
    if model.refinement == "exact":
        depths = refine_depths(depths, model.refine)
    return depths


def yielded_pieces(load: FloatArray | Sequence[SurfaceLoad], setup: WearSetup, model: WearModel, body: int) -> Removal:
    """The pieces that come off one body under a pressure with the setup's friction, or under loads with their own.

    Depths are computed from the surface down, and no further than one below the first depth at which nothing yields: a
    piece reaches the surface, so it would have to pass that depth, and refinement never exceeds the values it lies
    between. The one below is what the slope of the monotone cubic there needs; other refinements do without.
    """
    start = time.perf_counter()
    loads = (SurfaceLoad(load, setup.friction),) if isinstance(load, np.ndarray) else load
    strength = setup.yield_stress(body)
    depths = depths_for(setup, model, body)
    below = 1 if model.refinement == "monotone_cubic" else 0
    computed = 0
    blocked: int | None = None
    if cannot_yield(loads, setup, body, float(depths[0]), model.law):
        blocked = 0
    else:
        # pages of planes that are never written are never touched
        stack = np.empty((depths.size, *setup.grid.shape))
        for plane in equivalent_stress_planes(loads, setup, body, depths, model.law, stack):
            computed += 1
            if blocked is None and plane.max() <= strength:
                blocked = computed - 1
            if blocked is not None and (blocked == 0 or computed == blocked + 1 + below):
                break
    if blocked == 0:
        shape = setup.grid.shape
        nothing = Segmentation(np.zeros(shape, np.int32), np.zeros(shape), 0, np.zeros(1, dtype=np.bool_))
        return Removal(body, nothing, computed, time.perf_counter() - start, 0.0)
    exact = model.refinement == "exact"
    after_stress = time.perf_counter()
    pieces = segment(
        stack[:computed],
        depths[:computed],
        yield_stress=strength,
        periodic=setup.grid.periodic,
        refine=1 if exact else model.refine,
        refinement="linear" if exact else model.refinement,
        connectivity=model.connectivity,
        removal=model.removal,
    )
    return Removal(body, pieces, computed, after_stress - start, time.perf_counter() - after_stress)


def wear_cycle(
    heights: tuple[FloatArray, FloatArray],
    setup: WearSetup,
    model: WearModel,
    contact_step: ContactStep,
    start: FloatArray | None,
    last_loads: tuple[SurfaceLoad | None, SurfaceLoad | None] = (None, None),
) -> tuple[ContactOutcome, list[Removal]]:
    """One cycle on the heights (nx, ny) [m] of the lower and upper body, as they face each other now.

    start : pressure (nx, ny) that the contact begins from; it decides nothing but the effort.
    last_loads : what acted in the last cycle on the material of the lower and of the upper body that is on the grid
        now, cell by cell; None for nothing. Only a range of stress asks for it.

    Returns the contact, and what leaves from which body. Nothing is changed in place.
    """
    contact = contact_step(heights[LOWER] + heights[UPPER], start)
    acting = SurfaceLoad(contact.pressure, contact.friction)
    removals = []
    for body in setup.wearing(model):
        loads = half_the_change(acting, last_loads[body]) if model.stress_range else (acting,)
        removals.append(yielded_pieces(loads, setup, model, body))
    return contact, removals
