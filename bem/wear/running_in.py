"""The wear loop: cycle after cycle until the surface has settled (thesis, papers C and D).

The loop is a fold over a frozen state: `advance(state) -> state`. A state holds all that the next cycle needs, that of
the contact step included, so a run that is stopped after any cycle and resumed from its stored state ends in the same
bits as one that was never stopped.

Knows cycles (`wear.cycle`) and records; no scene, no file. Verified in tests/wear/test_cycle.py.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import ConvergenceError, InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note
from bem.notes.wear import PARTIAL_SLIP_IN_OIL, THIRD_BODIES_MANY
from bem.plausibility import body_arguments, notes_on_arguments
from bem.representation import tabled
from bem.wear.contact_step import ContactOutcome, ContactStart, ContactStep, dry_contact
from bem.wear.criterion import Criterion, LocalWear
from bem.wear.cycle import wear_cycle
from bem.wear.loads import BodyWear, SurfaceLoad
from bem.wear.model import WearModel
from bem.wear.outcome import contact_strip, rms_within
from bem.wear.segmentation import describe_pieces
from bem.wear.setup import LOWER, UPPER, WearSetup
from bem.wear.state import CYCLE_FIELDS, PARTICLE_FIELDS, TIME_FIELDS, RunningInState, initial_state
from bem.wear.step_doubling import step_error


@dataclass(frozen=True)
class Settled:
    """Stop rule: means of particle size and roughness over the last `window` cycles and the window before agree.

    The particle size of a cycle is (V / n)^(1/3): V the volume that left all bodies in it, wear by pressure and cuts of
    third bodies included, n the number of pieces, at least one. The roughness is `rms_height` of `CYCLE_FIELDS`.

    tolerance : relative difference of the means below which they agree.
    """

    window: int = 25
    tolerance: float = 0.02

    def __call__(self, state: RunningInState) -> bool:
        """Return True if the run has settled."""
        if state.cycle < 2 * self.window:
            return False
        rows = state.cycles[-2 * self.window :]
        with np.errstate(invalid="ignore"):
            size = rows["volume"] / np.maximum(rows["particles"], 1)
        for series in (np.cbrt(size), rows["rms_height"]):
            before, after = series[: self.window].mean(), series[self.window :].mean()
            if abs(after - before) > self.tolerance * max(abs(before), abs(after)):
                return False
        return True


@tabled
@dataclass(frozen=True, eq=False)
class RunningIn:
    """A finished (or stopped) wear loop.

    lower_heights, upper_heights : surfaces at the end [m]. pressure : of the last cycle [Pa].
    cycles : table of `CYCLE_FIELDS`; particles : table of `PARTICLE_FIELDS`; times : of `TIME_FIELDS` [s] per cycle.
    settled : True if the stop rule held after the last cycle; False without a stop rule.
    state : to resume from.
    status : CONVERGED, since `run_in` raises where a contact or a loop of partial slip did not converge: every contact
        was solved. Whether the surface still changes is not part of it (`wear.outcome.drift`).
    wearing : indices of the bodies that wear. moving : index of the body that moves through the contact.
    notes : on where the result is outside its model, or uncertain; those of a lubricated contact are
        `wear.mixed.MixedCycles.notes`.
    step_error : estimated error of the depth worn in the last cycle by a local law [m]; None for other laws.
    """

    lower_heights: FloatArray
    upper_heights: FloatArray
    pressure: FloatArray | None
    cycles: NDArray[np.void]
    particles: NDArray[np.void]
    times: NDArray[np.void]
    settled: bool
    state: RunningInState
    status: Status
    wearing: tuple[int, ...] = (LOWER,)
    notes: tuple[Note, ...] = ()
    step_error: float | None = None
    moving: int = LOWER

    def worn_heights(self) -> FloatArray:
        """Heights of the (first) wearing body at the end [m]."""
        return (self.lower_heights, self.upper_heights)[self.wearing[0]]

    def __repr__(self) -> str:
        radius = equivalent_radius(self.particles["volume"])
        mean = f"{1e9 * radius.mean():.0f} nm" if radius.size else "none"
        return f"RunningIn({self.state.cycle} cycles, {radius.size} particles, mean radius {mean}, {self.status})"


def equivalent_radius(volume: FloatArray) -> FloatArray:
    """(3V / 4 pi)^(1/3) [m]; thesis, paper C."""
    return np.asarray(np.cbrt(3 * volume / (4 * np.pi)))


def run_in(
    lower_heights: FloatArray,
    upper_heights: FloatArray,
    *,
    grid: Grid,
    bodies: tuple[Body, Body],
    load: float,
    depths: FloatArray,
    gap: FloatArray | None = None,
    friction: float = 0.0,
    hardness: float | None = None,
    cycles: int = 200,
    model: WearModel | None = None,
    criterion: str | Mapping[str, Any] | Criterion | None = None,
    stop: Settled | None = None,
    contact_step: ContactStep | None = None,
    state: RunningInState | None = None,
    callback: Callable[[RunningInState], None] | None = None,
) -> RunningIn:
    """Slide two rough bodies over each other, cycle by cycle, and let the yielded pieces leave.

    Parameters
    ----------
    lower_heights, upper_heights : (nx, ny) heights out of each body [m]. Before each cycle but the first, the moving
        body (`model.frame`) slides by `model.shift` cells over the other one: along +x if it is the upper body, along
        -x if it is the lower one, for positive friction (`sliding_direction`). It may have more rows than
        the grid, which then pass through the contact, and is taken as periodic along x.
    grid : of the contact, usually free in x and periodic in y.
    bodies : (lower, upper).
    load : on the grid [N]; a contact step that is given has its own.
    depths : (nz,) [m], increasing.
    gap : macroscopic, of the smooth bodies [m]; None is flat. A contact step that is given has its own.
    friction : traction over pressure, along +x on the lower body where positive, along -x where negative. With a
        contact step that is given, the friction of its contacts counts; this one is only checked, and gives the
        direction of sliding as long as no contact gives one.
    hardness : cap of the contact pressure [Pa]; None takes the softer surface's. A contact step that is given has its
        own.
    cycles : how many, counted from the start of the run.
    model : the replaceable parts.
    criterion : in place of the model's: a name, a table with `kind` and parameters, or a `Criterion`.
    stop : rule by which the run ends before its last cycle; a state to resume from that has settled gets no cycle more.
    contact_step : contact of one cycle; None is the dry contact of these arguments, `wear.mixed.MixedContact` a
        lubricated one. Local laws wear by the pressure at the end of the cycle with the former in gross sliding
        (implicit), else by that at its start.
    state : state to resume from; the heights are then ignored.
    callback : called with the state after every cycle (checkpoints, progress).

    Raises
    ------
    InputError : shapes that do not match, a wearing body without yield stress.
    ConvergenceError : a contact that did not converge; says in which cycle.
    """
    choices = model if model is not None else WearModel()
    if criterion is not None:
        choices = replace(choices, criterion=criterion)
    setup = WearSetup(
        grid=grid,
        bodies=bodies,
        gap=np.zeros(grid.shape) if gap is None else gap,
        load=load,
        friction=friction,
        depths=depths,
        hardness=hardness,
    )
    wearing = choices.checked_wearing_bodies(setup)
    if state is None:
        state = initial_state(lower_heights, upper_heights)
    _check_heights(state, grid, choices.moving)
    step, compliance = _contact_step(setup, choices, wearing, contact_step)
    settled = stop is not None and state.cycle > 0 and stop(state)
    while state.cycle < cycles and not settled:
        state = advance(state, setup, choices, step, compliance)
        if callback is not None:
            callback(state)
        settled = stop is not None and stop(state)
    return RunningIn(
        lower_heights=state.heights[LOWER],
        upper_heights=state.heights[UPPER],
        pressure=state.pressure,
        cycles=state.cycles,
        particles=state.particles,
        times=state.times,
        settled=settled,
        state=state,
        status=Status.CONVERGED,
        wearing=wearing,
        notes=_notes_on_arguments(setup) + _partial_slip_notes(state) + _coverage_notes(choices, state),
        step_error=_step_error(state, setup, choices, step, compliance),
        moving=choices.moving,
    )


def _notes_on_arguments(setup: WearSetup) -> tuple[Note, ...]:
    """Return notes on arguments of `run_in` outside their usual ranges."""
    arguments: dict[str, tuple[str, Any]] = {
        "load": ("load", setup.load),
        "friction": ("friction", setup.friction),
        "hardness": ("hardness", setup.hardness),
        "grid.spacing": ("cell of the grid", [setup.grid.spacing[axis] for axis in setup.grid.varying_axes]),
    }
    return notes_on_arguments(arguments | body_arguments(setup.bodies))


def _contact_step(
    setup: WearSetup, model: WearModel, wearing: tuple[int, ...], given: ContactStep | None
) -> tuple[ContactStep, float]:
    """Return the contact step of a loop, and the compliance by which local laws wear in it [m/Pa].

    A contact step that is given gets no compliance: what friction and temperature it has, on which a rate may depend,
    is known after its contact only, and a step of one's own may have no place for it. Lives, whose rates are known
    before, hand `MixedContact` theirs.
    """
    step, compliance = given, 0.0
    if step is None:
        step, compliance = dry_contact(setup), sum(model.criterion_law.compliance(setup, body) for body in wearing)
        if model.film_defect_model is not None:
            compliance *= float(model.film_defect_model.share())
    if model.third_body_model is not None:
        from bem.wear.third_bodies import with_third_bodies  # imports both contacts

        distance = model.criterion_law.distance_per_cycle(abs(model.shift) * setup.grid.spacing[0])
        step = with_third_bodies(step, model.third_body_model, distance)
    return step, compliance


def _contact_start(state: RunningInState, model: WearModel, pressure: FloatArray | None) -> ContactStart:
    """Return the start of the contact after a state; pressure : (nx, ny) warm start [Pa]."""
    standing = UPPER if model.moving == LOWER else LOWER
    return ContactStart(
        pressure,
        state.contact,
        standing_profile=state.heights[standing].mean(axis=1),
        last_cycle=state.cycles[-1] if len(state.cycles) else None,
    )


def _step_error(
    state: RunningInState, setup: WearSetup, model: WearModel, contact_step: ContactStep, compliance: float
) -> float | None:
    """Estimate the error of the last step of a local law by step doubling; see `wear.step_doubling.step_error`."""
    if not isinstance(model.criterion_law, LocalWear) or not state.cycle:
        return None
    start, rows = _contact_start(state, model, state.pressure), setup.grid.shape[0]

    def facing(heights: FloatArray, body: int) -> FloatArray:
        return _window(heights, state.offset * (body == model.moving), rows)

    return step_error(state, setup, model, contact_step, start, facing, compliance)


def _partial_slip_notes(state: RunningInState) -> tuple[Note, ...]:
    """Return the notes on the last cycle's loop of partial slip; a film and its friction know of none."""
    rubbing = state.rubbing
    if rubbing is None:
        return ()
    in_oil = () if state.sharing is None else (PARTIAL_SLIP_IN_OIL(stick=rubbing.stick_share),)
    return (*rubbing.notes, *in_oil)


def _coverage_notes(model: WearModel, state: RunningInState) -> tuple[Note, ...]:
    """Return a note where third bodies cover the whole area."""
    third_bodies = model.third_body_model
    if third_bodies is None or third_bodies.shed == 0:
        return ()
    full = int((state.cycles["third_bodies_per_area"] >= third_bodies.most_per_area * (1 - 1e-9)).sum())
    return (THIRD_BODIES_MANY(full=full, cycles=len(state.cycles), reason="area"),) if full else ()


def advance(
    state: RunningInState, setup: WearSetup, model: WearModel, contact_step: ContactStep, compliance: float = 0.0
) -> RunningInState:
    """Advance by one cycle: move a body through the contact, solve the contact, remove what the criterion finds.

    No body moves before the first cycle, but the first cycle wears as the others: cuts of third bodies and the drag
    of junctions count the slide of a whole cycle, which follows the contact of the cycle, and local wear its law's own
    distance.

    compliance : depth that each place wears by pressure in the cycle [m/Pa], for an implicit step.
    """
    cycle, moving = state.cycle + 1, model.moving
    rows = setup.grid.shape[0]
    offset = state.offset + (sliding_direction(state, setup, moving) * model.shift if state.cycle else 0)
    facing = list(state.heights)
    facing[moving] = _window(state.heights[moving], offset, rows)
    pressure = None if state.pressure is None else _slide(state.pressure, offset - state.offset, setup.grid.periodic[0])
    last = _last_loads(state, moving, offset) if model.stress_range else (None, None)
    began = time.perf_counter()
    facing_memories = [
        _memory_window(state.memories[body], offset if body == moving else 0, rows) for body in (LOWER, UPPER)
    ]
    memories = (facing_memories[LOWER], facing_memories[UPPER])
    start = _contact_start(state, model, pressure)
    contact, removals = wear_cycle(
        (facing[LOWER], facing[UPPER]), setup, model, contact_step, start, last, memories, compliance
    )
    if contact.status != Status.CONVERGED:
        raise ConvergenceError(f"cycle {cycle}: {contact.failure}")
    rubbing = contact.rubbing
    if rubbing is not None and rubbing.status != Status.CONVERGED:
        raise ConvergenceError(
            f"cycle {cycle}: partial slip ended with status {rubbing.status.value!r} at residual "
            f"{rubbing.residual:.1e}; {rubbing.status.message}"
        )
    heights, remembered = list(state.heights), list(state.memories)
    table = []
    for removal in removals:
        body = removal.body
        if body == moving:
            heights[body] = _remove_from_window(heights[body], removal.thickness, offset)
            remembered[body] = _put_back(state.memories[body], removal.memory, len(heights[body]), offset)
        else:
            heights[body] = heights[body] - removal.thickness
            remembered[body] = removal.memory
        table.append(particle_rows(removal, setup.grid, cycle))
    for body, cut in enumerate(() if contact.third_bodies is None else contact.third_bodies.cut):
        heights[body] = _remove_from_window(heights[body], cut, offset if body == moving else 0)
    elapsed = time.perf_counter() - began
    stress_time = sum(removal.stress_time for removal in removals)
    pieces_time = sum(removal.segmentation_time for removal in removals)
    particles = np.concatenate(table)
    worn_heights = _window(heights[removals[0].body], offset if removals[0].body == moving else 0, rows)
    strip = contact_strip(contact.pressure, contact.strip, state.strip)
    row = _cycle_row(cycle, contact, removals, particles, rms_within(worn_heights, strip), setup)
    return RunningInState(
        cycle=cycle,
        heights=(heights[LOWER], heights[UPPER]),
        offset=offset,
        pressure=contact.pressure,
        removed=removals[0].thickness,
        cycles=np.append(state.cycles, row),
        particles=np.concatenate([state.particles, particles]),
        times=np.append(
            state.times,
            np.array([(elapsed - stress_time - pieces_time, stress_time, pieces_time)], dtype=TIME_FIELDS),
        ),
        memories=(remembered[LOWER], remembered[UPPER]),
        rubbing=rubbing,
        strip=strip,
        sliding=_sliding(contact, state),
        contact=contact.memory,
        sharing=_append_row(state.sharing, contact.sharing),
    )


def _append_row(table: NDArray[np.void] | None, row: NDArray[np.void] | None) -> NDArray[np.void] | None:
    if table is None or row is None:
        return row
    if table.dtype != row.dtype:
        raise InputError("state: its table of load sharing is of another version of the program; start the run anew")
    return np.append(table, row)


def sliding_direction(state: RunningInState, setup: WearSetup, moving: int) -> int:
    """Return 1 if the moving body slides along +x over the other body, to which the contact is fixed, -1 if along -x.

    The direction is that of the last cycle (`RunningInState.sliding`). Where no cycle had one, friction of the setup
    drags the lower body the way in which the upper one slides over it; without friction the upper body slides along +x.
    """
    upper = (-1 if setup.friction < 0 else 1) if state.sliding is None else state.sliding
    return upper if moving == UPPER else -upper


def _sliding(contact: ContactOutcome, state: RunningInState) -> int | None:
    """Return the direction in which the upper body slides over the lower one in a cycle, 1 or -1; None if unknown.

    It is that of the contact step's speeds, else that of the friction, else that of the cycle before.
    """
    if contact.sliding is not None:
        return contact.sliding
    return state.sliding if contact.friction == 0 else (1 if contact.friction > 0 else -1)


def _check_heights(state: RunningInState, grid: Grid, moving: int) -> None:
    messages = []
    for body, name in ((LOWER, "lower_heights"), (UPPER, "upper_heights")):
        shape = state.heights[body].shape
        longer = body == moving and len(shape) == 2 and shape[0] >= grid.shape[0] and shape[1] == grid.shape[1]
        if shape != grid.shape and not longer:
            more = " (the moving body may have more rows)" if body == moving else ""
            messages.append(f"{name}: shape {shape} does not match the grid's {grid.shape}{more}")
        elif not np.isfinite(state.heights[body]).all():
            messages.append(f"{name}: some heights are not finite; fill or crop them first")
    if messages:
        raise InputError(messages)


def _window(heights: FloatArray, offset: int, rows: int) -> FloatArray:
    """Return the rows that face the grid after the body slid `offset` cells along +x."""
    return np.take(heights, np.arange(rows) - offset, axis=0, mode="wrap")


def _remove_from_window(heights: FloatArray, thickness: FloatArray, offset: int) -> FloatArray:
    lowered = heights.copy()
    lowered[(np.arange(thickness.shape[0]) - offset) % heights.shape[0]] -= thickness
    return lowered


def _memory_window(memory: FloatArray | None, offset: int, rows: int) -> FloatArray | None:
    """Return the memory (planes, rows, ny) of the rows that face the grid."""
    return None if memory is None else np.take(memory, np.arange(rows) - offset, axis=1, mode="wrap")


def _put_back(whole: FloatArray | None, facing: FloatArray | None, rows: int, offset: int) -> FloatArray | None:
    """Return the memory of all rows of the moving body, updated by the rows on the grid."""
    if facing is None:
        return whole
    planes = max(len(facing), 0 if whole is None else len(whole))
    kept = np.zeros((planes, rows, facing.shape[2]))
    if whole is not None:
        kept[: len(whole)] = whole
    places = (np.arange(facing.shape[1]) - offset) % rows
    kept[:, places] = 0.0
    kept[: len(facing), places] = facing
    return kept


def _last_loads(state: RunningInState, moving: int, offset: int) -> tuple[SurfaceLoad | None, SurfaceLoad | None]:
    """Return the loads of the last cycle on the material of each body that is on the grid now.

    The load stays in place on the fixed body and moves with the material of the moving body.
    """
    if state.pressure is None:
        return None, None
    friction = float(state.cycles["friction"][-1])
    rows = state.pressure.shape[0]
    carried = np.zeros_like(state.heights[moving])
    carried[(np.arange(rows) - state.offset) % carried.shape[0]] = state.pressure
    loads = [SurfaceLoad(state.pressure, friction)] * 2
    loads[moving] = SurfaceLoad(_window(carried, offset, rows), friction)
    return loads[LOWER], loads[UPPER]


def _slide(pressure: FloatArray, cells: int, periodic: bool) -> FloatArray:
    """Return the last pressure carried along with the moving body; a warm start."""
    moved = np.roll(pressure, cells, axis=0)
    if not periodic and cells > 0:
        moved[:cells] = 0.0
    elif not periodic and cells < 0:
        moved[cells:] = 0.0
    return moved


def particle_rows(removal: BodyWear, grid: Grid, cycle: int) -> NDArray[np.void]:
    """Return the particles of a removal as rows of `PARTICLE_FIELDS`."""
    return np.array(
        [
            (
                cycle,
                removal.body,
                particle.volume,
                particle.length,
                particle.width,
                particle.thickness,
                particle.position[0],
                particle.position[1],
                particle.columns_count,
                particle.truncated,
            )
            for particle in describe_pieces(removal.pieces, grid, cycle=cycle)
        ],
        dtype=PARTICLE_FIELDS,
    )


def _cycle_row(
    cycle: int,
    contact: ContactOutcome,
    removals: list[BodyWear],
    particles: NDArray[np.void],
    rms_height: float,
    setup: WearSetup,
) -> NDArray[np.void]:
    cell_area, rubbing, third = setup.grid.cell_area, contact.rubbing, contact.third_bodies
    besides = sum(float(removal.worn.sum()) for removal in removals if removal.worn is not None) * cell_area
    cut_volume = 0.0 if third is None else float(sum(cut.sum() for cut in third.cut)) * cell_area
    return np.array(
        [
            (
                cycle,
                particles.size,
                particles["volume"].sum() + (besides + cut_volume),
                contact.contact_area,
                contact.plastic_area,
                contact.load,
                contact.friction,
                contact.minimum_film,
                rms_height,
                contact.residual,
                contact.convolutions,
                sum(removal.depths_computed for removal in removals),
                contact.status == Status.CONVERGED,
                *((0.0, 0.0, 0.0) if rubbing is None else (rubbing.stick_share, rubbing.energy, rubbing.way)),
                *((0.0, 0.0) if third is None else (third.load, third.number_per_area)),
                cut_volume,
            )
        ],
        dtype=CYCLE_FIELDS,
    )
