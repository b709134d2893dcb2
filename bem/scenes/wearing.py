"""Parts shared by the kinds with wear: depths, the wear model, the loop over cycles with its checkpoint and on the
grid of twice the cell size, and its results.

Knows tables, plans and records; the loop itself is `bem.wear.run_in`. Verified in tests/scenes/test_wear_kind.py and
test_friction_kinds.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import ConvergenceError, InputError
from bem.grid import FloatArray, Grid
from bem.notes.checks import PARTICLES_CUT
from bem.packing import packed, unpacked
from bem.scenes import pieces, plans
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.context import Context, PlainContext, tell
from bem.scenes.keys import key
from bem.scenes.planner import Step, padded_points, stress_kernel_seconds
from bem.scenes.records import Figure, Series
from bem.scenes.rubbing import RubbedRecord, rubbed, rubbing_step
from bem.scenes.tables.film_defect import film_defect
from bem.scenes.third_bodies import ThirdBodyRecord, build_third_bodies, third_body_figures
from bem.scenes.units import Length
from bem.wear.criterion import StressCriterion
from bem.wear.setup import wearing_bodies

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.wear import RunningIn, RunningInState, WearModel
    from bem.wear.film_defect import FilmDefect
    from bem.wear.third_bodies import ThirdBodies

Found = TypeVar("Found")
_CHECKPOINT_EVERY = 10  # cycles
Count = Annotated[int, Field(strict=True, ge=1)]
IntArray = NDArray[np.int_]


class WearDepthsScene(Table):
    """Equally spaced depths at which stresses are computed."""

    count: Annotated[int, Field(strict=True, ge=2, le=1024)] = key("Number of depths.", "basic", default=64)
    spacing: PositiveLength = key("Distance between depths: the resolution of particle thickness.", "basic")
    first: Annotated[Length, Field(ge=0)] = key("First depth below the surface.", "expert", default=0.0)

    def build(self) -> NDArray[np.float64]:
        """Depths [m]; InputError if they are beyond numbers."""
        if not math.isfinite(self.first + self.spacing * self.count):
            raise InputError(
                f"depths.spacing = {self.spacing:g} m: the deepest lies beyond numbers; give a smaller one"
            )
        return self.first + self.spacing * np.arange(self.count, dtype=np.float64)


class LastCycles(Table):
    """Number of wear cycles, and of the last ones over which means are taken, even if the surface still changes."""

    count: Count = key("Number of wear cycles.", "basic", default=200)
    settled: Count = key(
        "Number of last cycles over which means of wear particles are taken.",
        "advanced",
        default=50,
        reason="50, or all of fewer",
    )
    coarser_grid: bool = key(
        "Repeat the cycles on twice the cell size, for discretisation errors of roughness, wear and friction.",
        "advanced",
        default=False,
        strict=True,
    )

    @model_validator(mode="before")
    @classmethod
    def _no_more_than_count(cls, data: Any) -> Any:
        """Take the windows of means that are not given no longer than the loop."""
        count = data.get("count") if isinstance(data, Mapping) else None
        if not isinstance(count, int) or count < 1:
            return data
        defaults = {
            name: cls.model_fields[name].default for name in ("averaged", "settled") if name in cls.model_fields
        }
        return {name: count for name, default in defaults.items() if default > count} | dict(data)

    @model_validator(mode="after")
    def _enough(self) -> Self:
        for name in ("averaged", "settled"):
            if getattr(self, name, 0) > self.count:
                raise problem(f"{name} {getattr(self, name)} is more than count {self.count}", f"{name} <= count")
        return self


def cycle_steps(
    scene: Any, grid: Grid, *, convolutions: int, solves: float, contacts: str, usual: int, first: int, friction: float
) -> tuple[Step, ...]:
    """Contact, slip, stresses and pieces of a case.

    convolutions, solves : of the contacts of a cycle, and their number. contacts : what is solved, in words.
    usual, first : depths before one at which nothing yields, in a usual cycle and in the first ones. friction : of the
    surfaces.

    Raises
    ------
    InputError : neither body has a yield stress, a length of the criterion that the grid has no room for, partial slip
    without friction.
    """
    scene.wear.traction.check(friction)
    finds = scene.wear.finds_particles
    strengths = [body.build().surface_material.yield_stress for body in (scene.lower, scene.upper)]
    if finds.needs_strength and all(value is None for value in strengths):
        raise InputError(
            "lower.material: neither body has a yield_stress or a hardness, so nothing can wear; allowed: one of them"
        )
    finds.check_length(grid)
    points, cycles = padded_points(grid.shape, grid.periodic), scene.cycles.count
    depths, deepest = min(scene.depths.count, usual), min(scene.depths.count, first)
    bodies = wearing_bodies((scene.lower.build(), scene.upper.build()), scene.wear.wears)
    why = f"{cycles} cycles a case, {contacts}"
    contact = plans.contacts(grid, convolutions * cycles, why, solves=solves * cycles)
    transformed = points * (1.0 if all(grid.periodic) or not any(grid.periodic) else _NARROWED)
    return (
        replace(contact, seconds=contact.seconds + _COPIED * cycles**2),
        rubbing_step(scene.wear.traction, grid, cycles),
        Step("stresses", "the criterion asks for none", skipped=True)
        if not isinstance(finds, StressCriterion)
        else Step(
            "stresses",
            "from the surface down to the first depth at which nothing yields",
            transforms=len(bodies) * stress_transforms(scene.wear, depths) * cycles,
            points=transformed * _ROWS,
            seconds=stress_kernel_seconds(grid.cells, deepest),
            memory=8.0 * (points / 4 * 12 * deepest + grid.cells * (deepest + 8)),
        ),
        Step("pieces", "runs of yielded voxels along depth", seconds=0.006 * cycles, memory=8.0 * grid.cells * 8)
        if finds.needs_strength
        else Step("pieces", "the criterion wears by pressure and distance, without any", skipped=True),
    )


_COPIED = 1.2e-8
"""Processor time [s], over n^2, of n cycles whose tables are copied in each and stored in every tenth."""
_ROWS = 0.7
"""Work of a transform of which half of the rows are left out, and no column, in whole ones."""
_NARROWED = 2 / 3
"""Points of a transform along x, over twice the cells, where short waves of a periodic y need less padding."""


def stress_transforms(wear: Any, depths: int) -> float:
    """Transforms of the stresses of one body in a cycle whose pieces take so many depths: of what acts, once, and five
    at a depth for von Mises stress under one load, whatever its tractions; else for each load and depth of what acts,
    and six.

    wear : criterion, stress_range and traction of a wear model.
    """
    fields = 1 if wear.traction.slides else 3
    if wear.finds_particles.is_von_mises and not wear.stress_range:
        return fields * (5.0 * depths + 1)
    return (2 if wear.stress_range else 1) * fields * 7.0 * depths


def bars_step(scene: Any, grid: Grid, convolutions: int, solves: float) -> Step:
    """Step of a plan for the loop on the coarser grid; `convolutions` of the contacts of a cycle, and their number."""
    wanted = scene.cycles.coarser_grid
    return Step(
        "error bars",
        "the same cycles on the grid of twice the cell" if wanted else _SCATTER_ALONE,
        skipped=not wanted,
        kept=0.0,
        transforms=4.0 * convolutions * scene.cycles.count,
        seconds=plans.SOLVE * solves * scene.cycles.count,
        points=padded_points(grid.shape, grid.periodic) // 4,
    )


_SCATTER_ALONE = "cycles.coarser_grid is false: error bars are the scatter of repetitions alone"


def grid_keys(scene: Any, factor: float, across: float | None = None) -> dict[str, Any]:
    """Keys of a scene in mixed lubrication with so many times the cells and points of the film; `across` : times the
    cells along y, where that is another number."""
    grid, factors = scene.grid, (factor, factor if across is None else across)
    assert grid.shape is not None
    shape = tuple(round(times * n) for times, n in zip(factors, grid.shape, strict=True))
    keys: dict[str, Any] = {"grid.shape": shape} | film_keys(scene, factor)
    if grid.spacing is None:
        return keys
    return keys | {"grid.spacing": tuple(h / times for times, h in zip(factors, grid.spacing, strict=True))}


_FEWEST_POINTS, _FEWEST_FILM_CELLS = 100, 32
"""Fewest points or cells on which a film is solved."""


def film_keys(scene: Any, factor: float) -> dict[str, Any]:
    """Keys of a scene in mixed lubrication with so many times the points of the film, as far as that can be."""
    sharing = scene.sharing
    return {
        "sharing.film_points": min(max(round(factor * sharing.film_points), _FEWEST_POINTS), 2000),
        "sharing.film_cells": min(max(round(factor * sharing.film_cells), _FEWEST_FILM_CELLS), 256),
    }


def film_is_halved(scene: Any) -> bool:
    """Return True if the film of a scene is still solved on half its points."""
    if scene.contact.point_radii is None:
        return bool(scene.sharing.film_points >= 2 * _FEWEST_POINTS)
    return bool(scene.sharing.film_cells >= 2 * _FEWEST_FILM_CELLS)


def resolution_keys(scene: Any, factor: float) -> dict[str, Any]:
    """Keys of a scene with so many times the depths, that slides as far in a cycle on so many times the cells."""
    depths, shift = scene.depths, factor * scene.wear.shift
    return {
        "depths.count": max(2, round(factor * (depths.count - 1)) + 1),
        "depths.spacing": depths.spacing / factor,
        "wear.shift": math.floor(abs(shift) + 0.5) * (1 if shift > 0 else -1),
    }


def on_every_second_cell(
    heights: tuple[FloatArray, FloatArray], grid: Grid, loop: Callable[[tuple[FloatArray, FloatArray], float], Found]
) -> Found | None:
    """Run `loop` on every second sample of the heights of both bodies, and pass it the factor of the cells along y:
    a half, or one in a uniform strip with too few cells for a coarser grid. None where the cells are odd or too few,
    or a contact does not converge."""
    from bem.accuracy.wear import FEWEST
    from bem.contact.nested_iteration import sample

    (nx, ny), enough = grid.shape, [n % 2 == 0 and n >= FEWEST for n in grid.shape]
    strip = ny < FEWEST and all(bool((each == each[:, :1]).all()) for each in heights)
    if not (enough[0] and (enough[1] or strip)):
        return None
    shape = (nx // 2, ny if strip else ny // 2)
    lower, upper = (np.array(sample(each, shape, grid.periodic)) for each in heights)
    try:
        return loop((lower, upper), shape[1] / ny)
    except ConvergenceError:
        return None


def third_bodies_and_defect(scene: Any, grid: Grid, load: float) -> tuple[ThirdBodies | None, FilmDefect | None]:
    """Return third bodies and boundary film with defects of a case, under a load [N] on its grid.

    Raises
    ------
    InputError : what either lacks; particles that cut deeper than they lie.
    """
    defect = film_defect(scene)
    return build_third_bodies(scene, grid, load), defect


def on_twice_the_cell(
    scene: Any,
    heights: tuple[FloatArray, FloatArray],
    grid: Grid,
    loop: Callable[[Any, tuple[FloatArray, FloatArray], Context], Found],
    at: Callable[[Any, float, float], Any],
) -> Found | None:
    """Run `loop` with half of all resolutions from heights on its grid: `at(scene, factor, across)` is the scene
    with its resolutions times `factor`, and its cells along y times `across`. None as `on_every_second_cell`."""
    return on_every_second_cell(
        heights, grid, lambda coarser, across: loop(at(scene, 0.5, across), coarser, PlainContext(scene.seed))
    )


def with_least_area(bars: ErrorBars, found: Any, cap: float | None) -> ErrorBars:
    """Widen the bars of the contact area and the mean pressure where nearly all of the contact is at the hardness [Pa],
    in every loop alike: the area may be as large as the cells in contact of the last cycle."""
    from bem.accuracy.bars import GRID

    area, bar = found.contact_area_fraction, bars.values.get("contact_area_fraction")
    least = 0.0 if cap is None else float(found.pressure.mean()) / cap
    if bar is None or not 0 < area <= _LEAST * least:
        return bars
    wider = bar + max(np.count_nonzero(found.pressure) / found.pressure.size - area, 0.0)
    parts = {"contact_area_fraction": wider}
    if bars.values.get("mean_contact_pressure") is not None:
        parts["mean_contact_pressure"] = found.mean_contact_pressure / area * wider
    return bars | bars.together({GRID: parts})


_LEAST = 1.1
"""Contact area over the least that carries the load at the hardness, below which nearly all of it is at the hardness.
"""


def wear_model(scene: Any, third_bodies: ThirdBodies | None = None, defect: FilmDefect | None = None) -> WearModel:
    """Build the wear model of a scene, with the third bodies and the boundary film between its surfaces."""
    from bem.wear import WearModel

    table = scene.wear.model_dump(exclude={"third_bodies", "film_defect", "particle_criterion"})
    return WearModel(**table, third_bodies=third_bodies, film_defect=defect)


def wears_on_a_track(scene: Any) -> bool:
    """Return True if the first body that wears moves through the contact, so that its whole track wears alike."""
    moving = 0 if scene.wear.frame == "cylinder" else 1
    return wearing_bodies((scene.lower.build(), scene.upper.build()), scene.wear.wears)[0] == moving


def volume_follows_load(scene: Any) -> bool:
    """Return True if the worn volume is that of Archard's law for the contact load.

    It is not of pieces, of cuts by third bodies, nor under a boundary film, whose defects follow the temperature.
    """
    wear = scene.wear
    return wear.criterion.wears_by_pressure and wear.film_defect is None and wear.third_bodies is None


def cycles_of_a_turn(shape: tuple[int, int], shift: float) -> int:
    """Return the cycles after which a moving surface is where it was, to half its slide in a cycle; 0 at rest.

    It wraps around on its grid, so that this is the number of its rows over the cells that it slides in a cycle.
    """
    return round(shape[0] / abs(shift)) if shift else 0


def worn_region(scene: Any, strip: FloatArray) -> tuple[int, FloatArray]:
    """Return the index of the first body that wears, and the fraction of its rows or cells in the contact region.

    strip : fraction of rows (nx,) or cells (nx, ny) in the contact; on a body that moves through the contact the region
    is the contact's whole track (1, ny).
    """
    from bem.wear.outcome import track_of

    worn = wearing_bodies((scene.lower.build(), scene.upper.build()), scene.wear.wears)[0]
    return worn, track_of(strip) if wears_on_a_track(scene) else strip


def particle_rates(scene: Any, result: RunningIn, grid: Grid) -> dict[str, float | None]:
    """Return particles per sliding distance [1/m] and per volume worn from their body [1/m^3] in the settled cycles.

    None without sliding, without particles, and of a law that knows none.
    """
    if scene.wear.finds_particles.wears_by_pressure:
        return {"particles_per_distance": None, "particles_per_volume": None}
    last = scene.cycles.settled
    distance = scene.wear.criterion.distance_per_cycle(abs(scene.wear.shift) * grid.spacing[0])
    settled, count = result.cycles[-last:], particle_number(scene, result, result.cycles[-last:])
    volumes = _volumes(scene, result, settled)
    return {
        "particles_per_distance": count / (len(settled) * distance) if count is not None and distance > 0 else None,
        "particles_per_volume": volumes.size / float(volumes.sum()) if volumes.size else None,
    }


def stress_below_strength(scene: Any, result: RunningIn, grid: Grid, load: float) -> float | None:
    """Largest equivalent stress [Pa] of the last cycle in the body whose particles are reported; None of criteria that
    ask for more than a stress, in partial slip, and where nothing touches."""
    from bem.wear import WearSetup
    from bem.wear.loads import SurfaceLoad
    from bem.wear.yielding import largest_stress

    law, pressure = scene.wear.finds_particles, result.pressure
    plain = isinstance(law, StressCriterion) and type(law).detach is StressCriterion.detach
    if not plain or scene.wear.stress_range or not scene.wear.traction.slides or pressure is None or not pressure.any():
        return None
    friction = float(result.cycles["friction"][-1])
    bodies = (scene.lower.build(), scene.upper.build())
    setup = WearSetup(grid, bodies, np.zeros(grid.shape), load, friction, scene.depths.build())
    acting = SurfaceLoad(pressure, friction)
    return largest_stress(acting, setup, replace(wear_model(scene), criterion=law), scene.sizes.body(result.wearing))


def wear_loop(
    scene: Any,
    context: Context,
    heights: tuple[FloatArray, FloatArray],
    *,
    watch: Callable[[RunningInState], Mapping[str, float]],
    keep: Callable[[], Mapping[str, Any]] = dict,
    grid: Grid,
    load: float,
    **contact: Any,
) -> RunningIn:
    """The wear loop of a case, from its checkpoint where there is one.

    heights : of both bodies at the start [m]. watch : called after every cycle; gives the figures beside the progress.
    keep : what the checkpoint holds then besides the loop's own state, under names other than "wear".
    grid, load : of the contact, and on it [N]. contact : further arguments of `bem.wear.run_in`.
    """
    from bem.wear import WearSetup, pack_state, run_in, unpack_state

    saved, count = context.saved(), scene.cycles.count
    third_bodies, defect = third_bodies_and_defect(scene, grid, load)

    model, bodies = wear_model(scene, third_bodies, defect), (scene.lower.build(), scene.upper.build())
    depths, sizing = scene.depths.build(), scene.wear.particle_criterion
    found = [] if saved is None or sizing is None else [unpacked(saved["particles"])]

    def find(now: RunningInState) -> None:
        from bem.wear.sizing import particles_beside_law

        setup = WearSetup(grid, bodies, np.zeros(grid.shape), load, float(now.cycles["friction"][-1]), depths)
        found.append(particles_beside_law(now, setup, replace(model, criterion=sizing, film_defect=None)))

    def after(now: RunningInState) -> None:
        if sizing is not None:
            find(now)
        figures = watch(now)
        if now.cycle % _CHECKPOINT_EVERY == 0 or now.cycle == count:
            beside = {} if sizing is None else {"particles": packed(np.concatenate(found))}
            context.save({"wear": pack_state(now), **beside, **keep()})
        context.progress(now.cycle, count, "cycles", **figures)

    with context.timer("cycles"):
        result = run_in(
            *heights,
            bodies=bodies,
            depths=depths,
            cycles=count,
            model=model,
            grid=grid,
            load=load,
            state=None if saved is None else unpack_state(saved["wear"]),
            callback=after,
            **contact,
        )
    tell(context, result.notes)
    if sizing is None:
        return result
    rows = np.concatenate(found)
    cut = rows["truncated"].mean() if rows.size else 0.0
    if cut > _MOST_CUT:
        context.note(PARTICLES_CUT(share=float(cut), unless="", reason="depths"))
    return replace(result, particles=rows)


_MOST_CUT = 0.02
"""Share of particles cut off by the deepest depth above which their sizes are doubtful."""


def sizes_over_cycles(scene: Any, result: RunningIn) -> tuple[FloatArray, FloatArray]:
    """Return the volume-mean radius [m] (nan without particles) and the number of reported particles of each cycle.

    Beside a wear law most cycles may have no particle to know a size from. The number of a cycle is then the volume
    that the law takes from the body in it over the mean volume of the particles of its stretch of cycles. Stretches are
    `cycles.settled` long, counted back from the last cycle, the first may be shorter: the mean over the last stretch is
    `particles_per_cycle`. nan where something is worn in a stretch in which no particle is found.
    """
    from bem.wear.outcome import sizes_over_cycles

    cycles, settled = result.cycles, scene.cycles.settled
    radius, number = sizes_over_cycles(cycles["cycle"], scene.sizes.particles(result))
    if scene.wear.particle_criterion is None:
        return radius, number
    for end in range(len(cycles), 0, -settled):
        stretch = slice(max(end - settled, 0), end)
        volumes, worn = _volumes(scene, result, cycles[stretch]), _worn_by_law(scene, result, cycles[stretch])
        with np.errstate(invalid="ignore"):
            number[stretch] = np.where(worn > 0, worn / (volumes.mean() if volumes.size else np.nan), 0.0)
    return radius, number


def particle_number(scene: Any, result: RunningIn, cycles: NDArray[np.void]) -> float | None:
    """Return the number of reported particles of some successive cycles, rows of `CYCLE_FIELDS`.

    Beside a wear law, it is the volume that the law takes from the body in all of these cycles, without cuts of third
    bodies, over the mean volume of all its particles in them. A mean of the ratios of single cycles would count a cycle
    in which no particle is found as one without wear. None where something is worn and no particle is found.
    """
    volumes = _volumes(scene, result, cycles)
    if scene.wear.particle_criterion is None:
        return float(volumes.size)
    worn = float(_worn_by_law(scene, result, cycles).sum())
    return worn / float(volumes.mean()) if volumes.size else None if worn > 0 else 0.0


def all_particles(scene: Any, result: RunningIn) -> float | None:
    """Return the expected number of reported particles of all cycles beside a wear law.

    It is the sum over the stretches of `sizes_over_cycles`, as sizes change while surfaces wear; a stretch in which no
    particle is found has the mean volume of all that are. None where something is worn and none is found at all.
    """
    number = sizes_over_cycles(scene, result)[1]
    unknown = np.isnan(number)
    if not unknown.any():
        return float(number.sum())
    volumes = _volumes(scene, result, result.cycles)
    if not volumes.size:
        return None
    return float(np.nansum(number) + _worn_by_law(scene, result, result.cycles[unknown]).sum() / volumes.mean())


def _volumes(scene: Any, result: RunningIn, cycles: NDArray[np.void]) -> FloatArray:
    """Return the volumes [m^3] of the reported particles of some cycles."""
    particles = scene.sizes.particles(result)
    volumes: FloatArray = particles["volume"][np.isin(particles["cycle"], cycles["cycle"])]
    return volumes


def _worn_by_law(scene: Any, result: RunningIn, cycles: NDArray[np.void]) -> FloatArray:
    """Return the volume [m^3] that a wear law takes from the reported body in each cycle, without cuts."""
    worn: FloatArray = _share_worn(scene, result) * (cycles["volume"] - cycles["cut_volume"])
    return worn


def _share_worn(scene: Any, result: RunningIn) -> float:
    """Return the share of the reported body in the volume that a wear law takes from both."""
    if len(result.wearing) < 2:
        return 1.0
    law, bodies = scene.wear.criterion, (scene.lower.build(), scene.upper.build())
    friction = float(result.cycles["friction"][-1])
    rates = [law.rate(bodies[0], friction), law.rate(bodies[1], friction) * law.upper_over_lower]
    return rates[scene.sizes.body(result.wearing)] / (sum(rates) or 1.0)


STRETCHES = (
    "; beside a wear law worn volume over mean particle volume of cycles.settled cycles, nan where no particle is found"
)
"""What the curve of the number of particles is beside a wear law, behind its description."""


@dataclass(frozen=True, eq=False, kw_only=True)
class WornRecord(RubbedRecord, ThirdBodyRecord):
    """Fields of the record of every wear loop."""

    convolutions_per_cycle: Annotated[float, Figure("", "convolutions of the contact per cycle", unjudged=True)]
    truncated_particles: Annotated[
        int, Figure("", "particles of the last cycles.settled cycles cut off by the deepest depth", unjudged=True)
    ]
    largest_stress: Annotated[
        float | None,
        Figure(
            "Pa",
            "largest equivalent stress of a cell in the last cycle, where nothing came off",
            optional=True,
            unjudged=True,  # one cell's, told to compare with the strength
        ),
    ] = None
    largest_worn_depth: Annotated[
        float | None,
        Figure(
            "nm",
            "depth of the deepest cell of a body worn by pressure, of the shown rows",
            optional=True,
            headline=True,
            unjudged=True,  # one cell's, told to compare with the error of the step
        ),
    ] = None
    particles_all_cycles: Annotated[
        float | None,
        Figure(
            "",
            "expected number of particles of all cycles, of one body, beside a wear law: worn volume over mean "
            "particle volume, added up over stretches of cycles.settled cycles",
            optional=True,
            no_bar=pieces.FOLLOWS_CELL,
        ),
    ] = None
    cycle: Annotated[IntArray, Series(("cycle",), "1", "cycle")]


@dataclass(frozen=True, eq=False)
class WornSurface:
    """Result of a wear loop: heights of the (first) wearing body in its own rows [m], unworn and run in, the last
    pressure [Pa], the reported particles, all (`particles`) and of the last `cycles.settled` cycles (`late`), and
    figures of its records by name."""

    height_before: FloatArray
    height_after: FloatArray
    pressure: FloatArray
    particles: NDArray[np.void]
    late: NDArray[np.void]
    figures: dict[str, Any]

    @classmethod
    def of(
        cls,
        scene: Any,
        initial: tuple[FloatArray, FloatArray],
        result: RunningIn,
        grid: Grid,
        load: float,
        strip: NDArray[Any],
    ) -> WornSurface:
        """Result of a scene's loop, which started from `initial` heights of both bodies; `load` [N] on the grid.

        strip : the fraction of each row (nx,) or cell (nx, ny) over which roughness and depth are averaged; on a body
        that moves through the contact, its whole track is.
        """
        from bem.wear.outcome import criterion_wear_rate, strip_wear, track_of

        assert result.pressure is not None
        cycles, particles, last = result.cycles, scene.sizes.particles(result), scene.cycles.settled
        settled = cycles["cycle"][-last:]
        late = particles[particles["cycle"] >= settled[0]]
        before, after = initial[result.wearing[0]], result.worn_heights()
        worn = strip_wear(before, after, track_of(strip) if result.wearing[0] == result.moving else strip)
        before, after = before[: grid.shape[0]], after[: grid.shape[0]]
        finds, beside = scene.wear.finds_particles.needs_strength, scene.wear.particle_criterion is not None
        number = particle_number(scene, result, cycles[-last:]) if finds else None
        figures = {
            "cycle": np.arange(1, len(cycles) + 1),
            "particles_per_cycle": None if number is None else number / len(settled),
            "particles_all_cycles": all_particles(scene, result) if beside else None,
            "convolutions_per_cycle": float(cycles["convolutions"].mean()),
            "truncated_particles": int(late["truncated"].sum()),
            "step_error": result.step_error,
            "largest_worn_depth": None if result.step_error is None else float((before - after).max()),
            "criterion_wear_rate": criterion_wear_rate(
                cycles[-last:],
                load,
                scene.wear.criterion.distance_per_cycle(abs(scene.wear.shift) * grid.spacing[0]),
            ),
            "largest_stress": None if late.size else stress_below_strength(scene, result, grid, load),
            "Sq_initial": worn.rms_before,
            "Sq_final": worn.rms_after,
            "worn_depth": worn.depth,
            **rubbed(result, last),
            **third_body_figures(scene.wear.third_bodies, cycles, last, load),
        }
        return cls(before, after, result.pressure, particles, late, figures)
