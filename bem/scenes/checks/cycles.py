"""Checks of wear loops: a surface that grows rough by its own pieces, figures that still drift at the last cycle, scars
too wide for their bodies, loops that nothing is compared with.

Read off what a run gives; the rule of drift is `bem.wear.outcome.drift`. Verified in tests/scenes/test_checks.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from bem.contact.certificate import unresolved_spots
from bem.grid import FloatArray, Grid
from bem.notes import Level, Note
from bem.notes.accuracy import NoBar, no_error_bar
from bem.notes.checks import (
    CHANGE_WITHIN_ERROR,
    FRICTION_SWINGS,
    LESS_THAN_A_PARTICLE,
    NO_PARTICLE_SIZES,
    NO_WEAR_RATE,
    NOT_SETTLED,
    PARTICLES_OF_BODY,
    SETTLING_UNJUDGED,
    SLOPES_LARGE,
    SURFACE_ROUGHENED,
    WEAR_OUTSIDE_REGION,
    WEAR_STEPS_LONG,
)
from bem.notes.note import joined, percent
from bem.quantities import si
from bem.scenes.checks.facts import Facts
from bem.scenes.checks.hertz import LARGEST_SLOPE, STEEP
from bem.scenes.checks.outcome import at_the_cap
from bem.scenes.checks.registry import outcome_check
from bem.scenes.checks.roughened import roughened, with_pieces
from bem.scenes.checks.words import numbers
from bem.scenes.common import BODIES, SmoothSurface
from bem.scenes.context import Outcome
from bem.scenes.kind import get_kind
from bem.scenes.planner import machine_rate, show_seconds
from bem.scenes.records import CONTACT, TRACK, region_words
from bem.threads import get_threads

_SERIES = {
    "rms_height_over_cycles": "Sq of the worn surface",
    "rms_height": "Sq of the worn surface",
    "friction_over_cycles": "friction",
    "minimum_film_over_cycles": "minimum film thickness",
}


@outcome_check
def rougher_by_its_own_pieces(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Running-in takes summits off. Pieces deeper than the roughness leave holes instead, and friction, film and pieces
    of later cycles are of those: two surfaces of 112 and 55 nm ended at 907, 630 and 469 nm on cells of 1, 0.5 and 0.25
    um (scene `running-in-stribeck` after 40 cycles at 0.01 m/s), so that it is the criterion's, and the cell's."""
    found = roughened(facts, outcome)
    if not found.grown:
        return
    both, before, grown = found.both, found.before, found.grown
    b, a = max(grown, key=lambda pair: pair[1] / pair[0])
    larger = max(numbers(outcome.summary.get("volume_mean_radius_nm")) or [0.0])
    holes = f" (mean radius by volume up to {si(1e-9 * larger, 'm')})" if larger > both else ""
    still, capped = _drifting(facts, outcome), at_the_cap(facts, outcome)
    follows = [f"it had not settled ({joined(still)})"] if still else []
    if capped is not None:
        follows.append(
            f"{percent(capped.cell_share)} of the cells in contact, which carry {percent(capped.load_share)} of the "
            f"load, are at the hardness, {si(capped.cap, 'Pa')}"
        )
    so = f": so {joined(follows)}" if follows else ""
    yield SURFACE_ROUGHENED(
        of=_of_one(grown, len(before)), before=1e-9 * b, after=1e-9 * a, both=1e-9 * both, holes=holes, so=so
    )


_SEVERE = 1e-4
"""The largest specific wear rate of metals in severe dry wear [mm^3/(N m)]: 0.1 / hardness of a soft one (Archard 1953,
Rabinowicz 1995)."""


@outcome_check
def no_wear_rate_of_a_metal(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Under a criterion of pieces all that yields leaves at once, in every cycle, where a real surface takes many
    passes: volumes by load and distance are then thousands of times those of any metal."""
    rates = numbers(outcome.summary.get("criterion_wear_rate_mm3_Nm"))
    if not facts.of_kind("wear", "running-in") or not with_pieces(facts):
        return
    beyond = [rate for rate in rates if rate > 10 * _SEVERE]
    if beyond:
        yield NO_WEAR_RATE(rate=max(beyond), of=_of(len(beyond), len(rates)), severe=_SEVERE)


@outcome_check
def drifting_at_the_last_cycle(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Figures of a loop that has not settled are those of its number of cycles; rule: `bem.wear.outcome.drift`.

    Within two turns of a moving roughness its place changes figures as wear does, and nothing can be compared: film
    thickness drifted by 3.8 % in 60 cycles of a turn of 41, and whole turns of the same loop agreed.
    """
    if roughened(facts, outcome).grown:  # a surface full of holes says it there
        return
    told = [] if _nothing_wore(facts, outcome) else _drifting(facts, outcome)
    turn, cycles = _turn(facts), _cycles(outcome)
    if turn >= 2 and cycles < 2 * turn:
        if told or _swings(facts, outcome):
            averaged = getattr(facts.scene.cycles, "averaged", turn)
            mean = "" if averaged == turn else f", and cycles.averaged = {turn} (one repeat)"
            yield SETTLING_UNJUDGED(turn=turn, cycles=cycles, count=2 * turn, averaged=mean)
        return
    if told:
        window = _window(facts, cycles)
        words = "25, or half of all" if window == _WINDOW else f"{window}, whole repeats of the roughness patch"
        yield NOT_SETTLED(drifting=joined(told), window=words)


def _nothing_wore(facts: Facts, outcome: Outcome) -> bool:
    """Return True if a criterion of pieces alone wears, and no cycle took any off: the surfaces are as they were."""
    over = outcome.variables.get("particles_over_cycles", outcome.variables.get("particles"))
    if over is None or not all(case.wear is not None and case.wear.criterion.needs_strength for case in facts.cases):
        return False
    return not np.any(over.values)


_WINDOW = 25
"""Cycles of the means that are compared where the roughness has no turn; as `bem.wear.outcome.drift` has it."""


def _turn(facts: Facts) -> int:
    """Return the number of cycles after which a rough moving surface is where it was, to half its slide in a cycle.

    0 where nothing rough moves, or where contacts of the scene have different turns.
    """
    if not any(case.wear is not None for case in facts.cases):
        return 0
    from bem.scenes.wearing import cycles_of_a_turn

    turns = set()
    for case in facts.cases:
        moving = "lower" if case.wear is not None and case.wear.frame == "cylinder" else "upper"
        rough = not isinstance(case.surfaces.get(moving, SmoothSurface()), SmoothSurface)
        moves = case.wear is not None and case.grid is not None and rough
        turns.add(cycles_of_a_turn(case.grid.shape, case.wear.shift) if moves and case.grid and case.wear else 0)
    return turns.pop() if len(turns) == 1 else 0


def _window(facts: Facts, cycles: int) -> int:
    """Return the cycles of the means that are compared at the end of a loop: whole turns of the roughness, where two
    turns fit."""
    turn = _turn(facts)
    if turn < 2 or cycles < 2 * turn:
        return _WINDOW
    several = turn * math.ceil(_WINDOW / turn)
    return several if 2 * several <= cycles else turn


def _cycles(outcome: Outcome) -> int:
    """Return the number of cycles of the loops; 0 without a series."""
    series = (outcome.variables.get(name) for name in _SERIES)
    return max(
        (one.values.shape[-1] for one in series if one is not None and one.dimensions[-1:] == ("cycle",)), default=0
    )


_SWING = 0.005
"""Relative difference of friction that counts where the run has no error bar."""


def _swings(facts: Facts, outcome: Outcome) -> bool:
    """Return True if friction changes over the cycles of a running-in by more than `_SWING`."""
    over = outcome.variables.get("friction_over_cycles")
    if not facts.of_kind("running-in") or over is None:
        return False
    loops = over.values.reshape(-1, over.values.shape[-1])
    return bool(np.ptp(loops, axis=-1).max() > _SWING * np.abs(loops).max())


@outcome_check
def friction_that_swings_with_the_place(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A rough surface that slides on by some cells in a cycle meets the other one in the same place only after a turn:
    116 cells at 3 a cycle swung friction by 3 % with a period of 39 cycles, more than 150 cycles of wear changed it.

    The note is made where a figure differs from the mean over the first or the last whole turn by more than its error.
    The first cycle differs by real running-in, too: there the swing within the last turn counts besides. Nothing is
    said where whole turns are averaged, since the table has the mean of the first turn, too; fewer than two turns are
    noted where drift is judged.
    """
    over, turn = outcome.variables.get("friction_over_cycles"), _turn(facts)
    if not facts.of_kind("running-in") or over is None or turn < 2:
        return
    loops, averaged = over.values.reshape(-1, over.values.shape[-1]), facts.scene.cycles.averaged
    cycles = loops.shape[-1]
    if cycles < 2 * turn or averaged % turn == 0:
        return
    shown = len(numbers(outcome.summary.get("friction_run_in"))) or len(loops)
    if len(loops) % shown == 0:  # means over repetitions
        loops = loops.reshape(shown, -1, cycles).mean(axis=1)
    errors = [_errors(outcome, name, len(loops)) for name in ("friction_initial", "friction_run_in")]
    found = []
    for loop, initial_error, run_in_error in zip(loops, *errors, strict=True):
        first, last = float(loop[:turn].mean()), float(loop[-turn:].mean())
        initial, run_in = float(loop[0]), float(loop[-averaged:].mean())
        off = abs(run_in - last) / (run_in_error or _SWING * abs(last) or math.inf)
        least = initial_error or _SWING * abs(first) or math.inf
        if 0.5 * float(np.ptp(loop[-turn:])) > least:
            off = max(off, abs(initial - first) / least)
        if off > 1:
            found.append((off, first, last, initial, run_in))
    if found:
        _, first, last, initial, run_in = max(found)
        yield FRICTION_SWINGS(
            turn=turn,
            first=first,
            last=last,
            initial=initial,
            run_in=run_in,
            averaged=averaged,
            of=_of_one(found, len(loops)),
        )


_OUTSIDE = 0.1
"""Share of the worn volume outside the contact region above which figures of the region miss it."""


@outcome_check
def wear_outside_the_contact_region(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Sq and worn depth are those of Hertz' contact of smooth bodies, or of its track on a body that moves; rough ones
    touch and wear beside it."""
    shares = numbers(outcome.summary.get("volume_outside_region"))
    many = [share for share in shares if share > _OUTSIDE]
    if many and facts.of_kind("running-in"):
        from bem.scenes.wearing import wears_on_a_track

        region = TRACK if wears_on_a_track(facts.scene) else CONTACT
        words = region_words(region, outcome.summary.get("contact_region_width_um")) or "Hertz' contact"
        most = _up_to(map(percent, many))
        yield WEAR_OUTSIDE_REGION(share=max(many), most=most.capitalize(), of=_of(len(many), len(shares)), region=words)


@outcome_check
def running_in_within_its_error(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A difference of two figures that each have a larger error is no finding."""
    if not facts.of_kind("running-in"):
        return
    turns = outcome.summary.get("friction_first_turn") is not None
    friction = ("friction_first_turn", "friction_last_turn") if turns else ("friction_initial", "friction_run_in")
    for words, (first, last), bar in (
        ("friction", friction, "friction_run_in_error"),
        ("Sq of the contact region (nm)", ("Sq_initial_nm", "Sq_final_nm"), "Sq_final_nm_error"),
    ):
        before, after, errors = (numbers(outcome.summary.get(key)) for key in (first, last, bar))
        if not len(before) == len(after) == len(errors):
            continue
        within = [(e - abs(a - b), b, a, e) for b, a, e in zip(before, after, errors, strict=True) if abs(a - b) < e]
        if within:
            _, b, a, error = max(within)
            of = _of_one(within, len(before))
            yield CHANGE_WITHIN_ERROR(figure=words, before=b, after=a, error=error, of=of)


def _errors(outcome: Outcome, name: str, loops: int) -> list[float]:
    """Return the errors of a figure of so many loops; 0 where they are not known."""
    errors = outcome.summary.get(f"{name}_error")
    known = [errors] if isinstance(errors, int | float) else list(errors or [])
    return [float(error or 0.0) for error in known] if len(known) == loops else [0.0] * loops


@outcome_check
def less_than_one_particle(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Warn of less than one particle: worn volume over mean particle volume, by a law of wear, is below one."""
    over = outcome.variables.get("particles_over_cycles", outcome.variables.get("particles"))
    known = outcome.variables.get("particles_all_cycles")
    if not facts.of_kind("wear", "running-in") or known is None or over is None or over.dimensions[-1:] != ("cycle",):
        return
    totals = np.ravel(np.asarray(known.values, dtype=np.float64))
    few = [float(total) for total in totals if 0 < total < 1]
    if few:
        window, loops = facts.scene.cycles.settled, over.values.reshape(len(totals), -1)
        case = int(np.argmax(np.where((totals > 0) & (totals < 1), totals, 0)))
        last = float(loops[case, -window:].mean())  # nan where no particle is found in these cycles
        rate = last if last > 0 else max(few) / loops.shape[-1]
        of_last = f"the last {window}" if last > 0 else "all"
        cycles = round(float(f"{_COUNTABLE / rate:.2g}"))
        yield LESS_THAN_A_PARTICLE(
            number=max(few),
            most=_up_to(f"{one:.2g}" for one in few),
            of=_of(len(few), len(totals)),
            cycles=cycles,
            wanted=_COUNTABLE,
            rate=rate,
            window=of_last,
            time=_time_of(facts, cycles),
        )


def _time_of(facts: Facts, cycles: int) -> str:
    """Return the estimated time of so many cycles in words, by the plans of all cases."""
    kind, scenes = get_kind(facts.scene.kind), [facts.scene]
    for axis in kind.axes(facts.scene):
        scenes = [axis.pick(one, i) for one in scenes for i in range(len(axis))]
    rate = machine_rate(get_threads())
    seconds = math.fsum(kind.plan(one).work(rate) * cycles / one.cycles.count for one in scenes)
    return show_seconds(seconds * (facts.scene.repetitions or 1))


_COUNTABLE = 20
"""Number of particles whose cycles are estimated; their scatter is then about a fifth, as of any count."""


def _drifting(facts: Facts, outcome: Outcome) -> list[str]:
    """Describe the quantities that have not settled, with their changes."""
    if not facts.of_kind("wear", "running-in"):
        return []
    from bem.wear.outcome import drift

    told: list[str] = []
    for name, words in _SERIES.items():
        variable = outcome.variables.get(name)
        if variable is None or variable.dimensions[-1:] != ("cycle",):
            continue
        if name.startswith("rms_height") and not with_pieces(facts):
            continue
        rows = variable.values.reshape(-1, variable.values.shape[-1])
        counts = _worn(outcome, len(rows)) if name.startswith("rms_height") else [True] * len(rows)
        window = _window(facts, rows.shape[-1])
        found = [drift(series, window) for series, counted in zip(rows, counts, strict=True) if counted]
        still = [value for value in found if value is not None]
        if still:
            changes = [percent(abs(change)) for change in still]
            largest = percent(max(map(abs, still)))
            told.append(f"{words} by {_up_to(changes)}{largest}{_of(len(still), len(rows))}")
    return told


def _worn(outcome: Outcome, loops: int) -> list[bool]:
    """Return True if anything came off in each of so many loops: where nothing did, roughness follows the rows that
    touch."""
    volume = outcome.variables.get("volume_over_cycles", outcome.variables.get("volume"))
    if volume is None:
        return [True] * loops
    return [bool((row > 0).any()) for row in volume.values.reshape(loops, -1)]


_MANY = 1.1
"""Cells in contact, or their area, over the least area: as of a single contact (`bem.contact.certificate`)."""


@outcome_check
def least_area_of_worn_surfaces(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Holes have walls, and spots beside them a cell or two: the edge of contact is then not known.

    Kind running-in shows the note of its own last contacts, which know the area with elastic edges.
    """
    caps, maps = {case.cap for case in facts.cases}, outcome.variables.get("pressure")
    areas = numbers(outcome.summary.get("contact_area_fraction"))
    if not facts.of_kind("wear") or len(caps) != 1 or None in caps or maps is None:
        return
    planes, cap = maps.values.reshape(-1, *maps.values.shape[-2:]), caps.pop()
    if len(planes) != len(areas) or cap is None:
        return
    least = [float(plane.mean()) / cap for plane in planes]
    counted = [float((plane > 0).mean()) for plane in planes]
    many = [
        (c / low, plane)
        for area, low, c, plane in zip(areas, least, counted, planes, strict=True)
        if area <= _MANY * low < c
    ]
    grid = facts.cases[0].grid
    if many and grid is not None:
        of = " in the last cycle" + _of_one([times for times, _ in many], len(areas))
        worst, plane = max(many, key=lambda pair: pair[0])
        yield unresolved_spots(plane > 0, worst, grid.periodic, of)


@outcome_check
def worn_beyond_small_slopes(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A scar of half-width a on a radius R is a^2 / 2R deep, and at its edge the bodies meet at the slope a / R, as in
    a contact that was pressed so wide: half-spaces and parabolas need a << R (Johnson 1985, section 4.1).

    A parabola misses a circle by (a/R)^2 / 4 of the depth and lengths along the surface by (a/R)^2 / 2: 1 % and 2 % at
    0.2, 6 % and 12 % at 0.5. The slope is that of the last contact's half-width or that of the depth, whichever is
    larger: the contact ends where the grid does, the depth does not. Of pieces the depth is the mean one.
    """
    curved = [(case, case.smooth) for case in facts.cases if case.smooth is not None]
    if not facts.of_kind("wear", "running-in") or not curved:
        return
    depths, pressures = _largest_depths(facts, outcome), _planes(outcome, "pressure")
    radius = min(radius for _, smooth in curved for radius in smooth.radii)
    slopes = [math.sqrt(2 * max(depth, 0.0) / radius) for depth in depths]
    for number, plane in enumerate(pressures[: len(depths)]):
        case, smooth = curved[number if len(curved) == len(depths) else 0]
        if depths[number] > 0 and case.grid is not None:
            slopes[number] = max(slopes[number], _slope_of_width(plane, case.grid, smooth.radii))
    largest, unworn = max(slopes, default=0.0), max(smooth.ratio for _, smooth in curved)
    # of a contact too wide before any wear it is said there
    if largest <= (STEEP if unworn > LARGEST_SLOPE else LARGEST_SLOPE):
        return
    yield SLOPES_LARGE(
        level=Level.OUTSIDE_MODEL if largest > STEEP else None,
        depth=max(depths),
        radius=radius,
        of=_of_one([slope for slope in slopes if slope > LARGEST_SLOPE], len(slopes)),
        slope=largest,
        limit=LARGEST_SLOPE,
        reason="worn",
    )


def _slope_of_width(pressure: FloatArray, grid: Grid, radii: tuple[float, float]) -> float:
    """The largest half-width of a contact (nx, ny) over the radius [m] along its axis."""
    largest = 0.0
    for axis, radius in enumerate(radii):
        touching = np.flatnonzero(pressure.any(axis=1 - axis))
        if touching.size and math.isfinite(radius):
            largest = max(largest, 0.5 * float(np.ptp(touching) + 1) * grid.spacing[axis] / radius)
    return largest


def _largest_depths(facts: Facts, outcome: Outcome) -> list[float]:
    """The depth worn in each loop [m]: the largest, or in pieces, which leave holes, the mean one."""
    if with_pieces(facts):
        return [1e-9 * depth for depth in numbers(outcome.summary.get("worn_depth_nm"))]
    pairs = zip(_planes(outcome, "height_before"), _planes(outcome, "height_after"), strict=True)
    return [float((before - after).max()) for before, after in pairs]


def _planes(outcome: Outcome, name: str) -> list[FloatArray]:
    """The maps (nx, ny) of all loops."""
    maps = outcome.variables.get(name)
    return [] if maps is None else list(maps.values.reshape(-1, *maps.values.shape[-2:]))


@outcome_check
def particles_and_heights_of_one_of_two(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Sizes and numbers are those of one body; volumes, and what they are divided by, of all that wear."""
    wearing = next((case.wearing_bodies for case in facts.cases if case.wear is not None), ())
    if not facts.of_kind("wear", "running-in") or not wearing:
        return
    named, pieces = facts.scene.sizes.body(wearing), with_pieces(facts)
    worn = outcome.variables.get("volume", outcome.variables.get("volume_over_cycles"))
    if worn is None or not worn.values.sum() > 0:  # that nothing comes off is said by itself
        return
    if pieces and named not in wearing:
        yield PARTICLES_OF_BODY(asked=BODIES[named], worn=BODIES[wearing[0]], reason="unworn")
    if len(wearing) < 2:
        return
    if not pieces and facts.scene.wear.particle_criterion is None:
        yield PARTICLES_OF_BODY(first=BODIES[wearing[0]], particles="", reason="both")
        return
    listed = outcome.variables.get("particle_volume") if pieces else None
    share = "" if listed is None else f", {percent(float(listed.values.sum() / worn.values.sum()))} of the volume"
    particles = (
        f"; particles, their sizes and numbers are those of the {BODIES[named]} body{share}, and "
        f'sizes.particles_of = "{BODIES[1 - named]}" tells those of the other'
    )
    yield PARTICLES_OF_BODY(first=BODIES[wearing[0]], particles=particles, reason="both")


@outcome_check
def steps_of_wear_in_oil_that_overshoot(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Under a film a step wears by the pressure of its start. Where that takes off more than twice what bodies
    give way by, what alternates from cell to cell grows from step to step, as in any explicit step: a gear's
    rough flanks kept Sq to four digits at 1.5 times, and at 10 times lost whole contacts in one step."""
    worn = outcome.variables.get("volume_over_cycles")
    if not facts.of_kind("running-in") or worn is None or not worn.values.sum() > 0:
        return
    from bem.wear.criterion import LocalWear
    from bem.wear.criterion.local import cell_to_cell_compliance

    for case in facts.cases:
        law, grid, upper = case.wear and case.wear.criterion, case.grid, case.upper
        if not isinstance(law, LocalWear) or grid is None or upper is None or facts.scene.wear.film_defect is not None:
            continue
        pair = (case.lower, upper)
        give = law.distance * sum(law.body_rate(pair, body, case.friction) for body in case.wearing_bodies)
        most = cell_to_cell_compliance(grid, pair)
        if give > 2 * most:
            yield WEAR_STEPS_LONG(case.label, ratio=give / most, share=0.99 * most / give, reason="overshoot")
            return


_STEPS = 0.1
"""Fraction of the deepest place below which the error of the steps is small beside the error bars."""


@outcome_check
def long_steps_of_wear_by_pressure(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Bars are those of the cells: the same distances stand in the loop on the coarser ones. What a law that wears by
    pressure leaves open over its distance is `bem.wear.step_doubling.step_error`, that of the worst cell.

    It is compared with the deepest place: the mean depth is that of load and distance, and of few summits is a small
    part of theirs. Compared with the mean, 0.28 nm, an error of 0.051 nm where summits are worn 29 nm deep was called
    18 %, while cycles of half the distance changed the mean by 0.5 %.
    """
    if not facts.of_kind("wear", "running-in") or with_pieces(facts):
        return
    steps, depths = (numbers(outcome.summary.get(name)) for name in ("step_error_nm", "largest_worn_depth_nm"))
    long = [(step, depth) for step, depth in zip(steps, depths, strict=False) if step > _STEPS * depth > 0]
    if long:
        step, depth = max(long, key=lambda pair: pair[0] / pair[1])
        yield WEAR_STEPS_LONG(part=step / depth, depth=1e-9 * depth, of=_of_one(long, len(steps)), reason="error")


@outcome_check
def law_without_particles(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Archard's law knows no particles; of bodies with a yield stress a stress criterion finds their sizes."""
    worn = outcome.variables.get("volume", outcome.variables.get("volume_over_cycles"))
    if not facts.of_kind("wear", "running-in") or worn is None or not worn.values.sum() > 0:
        return
    if not facts.surfaces:  # the scar of smooth bodies sheds particles of no roughness
        return
    for case in facts.cases:
        if case.wear is None or case.wear.particle_criterion is not None:
            return
        strong = any(material.yield_stress is not None for material in case.wearing)
        if case.wear.criterion.wears_by_pressure and case.wear.traction.slides and strong:
            if case.grid is not None:
                shape, length = _cells_for_particles(facts, case.grid)
                criterion = f'{{ kind = "averaged_von_mises", averaging_length = "{si(length, "m")}" }}'
                yield NO_PARTICLE_SIZES(
                    law=case.wear.criterion.name, shape=shape, criterion=f"wear.particle_criterion = {criterion}"
                )
            return


def _cells_for_particles(facts: Facts, grid: Grid) -> tuple[str, float]:
    """Return what to set for cells on which particles are sought, in words, and the length of their criterion [m].

    Cells much longer one way than the other become as short both ways, where the scene says how many there are.
    """
    from bem.wear.criterion.base import resolved_length

    short, long = sorted(grid.spacing)
    told = getattr(getattr(facts.scene, "grid", None), "shape", None)
    if long <= _UNLIKE_CELLS * short or told is None:
        return "", resolved_length(long)
    fine = [16 * math.ceil(length / short / 16 * (1 - 1e-9)) for length in grid.lengths]
    return f"grid.shape = {fine} and ", resolved_length(short)


_UNLIKE_CELLS = 1.5
"""Longer over shorter side of a cell up to which particles are sought, as `bem.elements.rough_scenes` has it."""


@outcome_check
def loop_without_error_bars(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """One loop on one grid says nothing of its errors: no finer cells, no other surfaces to compare it with."""
    told = outcome.summary
    if facts.of_kind("wear", "running-in") and "Sq_final_nm" in told and "Sq_final_nm_error" not in told:
        yield no_error_bar(["friction, wear and worn surfaces"], NoBar.SINGLE_LOOP)


def _of(number: int, all_: int) -> str:
    return f" in {number} of {all_} loops" if all_ > 1 else ""


def _of_one(found: Sequence[Any], all_: int) -> str:
    """Return of how many loops a note is that shows the numbers of one of those `found`."""
    differ = any(one != found[0] for one in found)
    return _of(len(found), all_) + (" (numbers of one of them)" if differ else "")


def _up_to(shown: Iterable[str]) -> str:
    """Return "up to " before the largest of some values if they differ as they are shown."""
    return "up to " if len(set(shown)) > 1 else ""
