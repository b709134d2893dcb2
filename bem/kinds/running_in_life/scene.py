"""Kind `running-in-life`: wear and a tribofilm over up to millions of cycles in mixed lubrication, in jumps whose error
is known.

A case is one life: one speed, one pair of surfaces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import model_validator

from bem.grid import FloatArray
from bem.kinds.running_in_life import lives
from bem.kinds.running_in_life.tables import LifeCycles, LifeFatigue, LifeFilm, LifeParticles, LifeWear
from bem.notes.accuracy import BARS_PARTIAL
from bem.notes.wear import LIFE_DISTANCE_DIFFERS
from bem.scenes import build, film_plans, plans
from bem.scenes.axes import Axis
from bem.scenes.common import Repetitions, problem
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.packing import keep, kept
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.records import LAMBDA_WHOLE, MINIMUM_FILM, Figure, GridRecord, Series, filled, grid_map
from bem.scenes.tables.film_defect import film_defect
from bem.scenes.tables.sharing import TEMPERATURES, OneLoadScene, RunningInSharing, heated

if TYPE_CHECKING:
    from bem.friction.setup import MixedSetup
    from bem.life.march import LifeState
    from bem.life.monitors import Monitors
    from bem.notes import Note

_CONVOLUTIONS = 7  # of the contacts of a pass, each from the last: 2 to 7 were counted
_SECONDS = 0.008  # of a pass besides: films from the table, friction, what wears
_JUMPS = 25  # steps of a life of a million cycles, each of three rounds


class RunningInLifeScene(OneLoadScene):
    """A rough cylinder and a rough flat that wear each other in oil over a life."""

    kind: Literal["running-in-life"] = key("Kind of computation.", "basic", default="running-in-life")
    wear: LifeWear = key("Wear law of both bodies.", "basic")
    life: LifeCycles = key("Number of cycles of the life.", "basic", default=LifeCycles())
    sharing: RunningInSharing = key(
        "Load sharing between oil film and asperities.", "advanced", default=RunningInSharing()
    )
    tribofilm: LifeFilm | None = key(
        "Tribofilm on the lower body, which grows and wears in the same loop.", "advanced", default=None
    )
    particles: LifeParticles | None = key(
        "Sizes of the particles that a detachment criterion finds.", "advanced", default=None
    )
    fatigue: LifeFatigue | None = key(
        "Rolling contact fatigue of one body, in competition with wear.", "advanced", default=None
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    @model_validator(mode="after")
    def _cylinder_and_film(self) -> RunningInLifeScene:
        if self.contact.point_radii is not None:
            raise problem("a ball or ellipsoid", "radius and width of a cylinder: lives under a ball were not tried")
        film = self.tribofilm
        if film is not None and film.temperature is None and self.oil.temperature is None:
            raise problem("a tribofilm without a temperature", "tribofilm.temperature, or oil.temperature")
        for name in ("lower", "upper"):
            if film is not None and film.heat and getattr(self, name).build().material.thermal_diffusivity is None:
                raise problem(
                    f"tribofilm.heat: heat of the {name} body, whose material has no thermal constants",
                    "materials with thermal_conductivity, density and heat_capacity, or no heat",
                )
        return self

    @property
    def friction(self) -> float:
        """Boundary friction as one number, before any contact is known."""
        (speeds,) = self.speeds.build()
        return self.contact.nominal_friction(self.load, self.modulus, speeds, self.oil.temperature)


def resolve(scene: RunningInLifeScene) -> RunningInLifeScene:
    """Fill in the grid and the softer surface's hardness."""
    return build.with_hardness(build.with_grid(scene), needed=False)


def axes(scene: RunningInLifeScene) -> tuple[Axis, ...]:
    """Speeds."""
    return (scene.speed_axis(),)


def plan(scene: RunningInLifeScene) -> Plan:
    """What will be computed for one life.

    Raises
    ------
    InputError : a patch that does not fit, a law without the hardness it needs. InfeasibleError : too much load.
    """
    grid, life = scene.check(), scene.life
    scene.wear.rates(scene.bodies, scene.friction)
    film_defect(scene)
    if scene.fatigue is not None:
        scene.fatigue.build(scene.bodies, scene.friction)
    if scene.particles is not None:
        scene.particles.build(grid, scene.bodies, scene.contact.hardness, lives.on_grid(scene))
    decades = max(np.log2(max(life.count / life.first_step, 2.0)) / 20, 0.1)
    passes = 3 * scene.wear.positions * _JUMPS * decades * max(0.05 / life.tolerance, 0.5)
    # stresses and damage of both bodies at each depth, by cells
    fatigue = 0.0 if scene.fatigue is None else 1.2e-6 * grid.cells * scene.fatigue.depths.count * passes
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        film_plans.tables(scene.sharing.film_points, "passes"),
        replace(
            plans.contacts(
                grid,
                _CONVOLUTIONS * passes,
                f"about {passes / scene.wear.positions / 3:.0f} jumps, each once whole and in two halves, of "
                f"{scene.wear.positions} positions",
            ),
            seconds=_SECONDS * passes,
        ),
        Step("tribofilm", "grows cell by cell where surfaces touch", skipped=scene.tribofilm is None, seconds=0.1),
        Step(
            "fatigue",
            "stresses of every position after each jump",
            skipped=scene.fatigue is None,
            seconds=fatigue,
        ),
        Step(
            "pieces",
            "sizes that the criterion finds after each jump",
            skipped=scene.particles is None,
            seconds=0.02 * passes / 3,
        ),
        Step(
            "error bars",
            "a life on twice the cell, and there one of half the positions" if life.coarser_lives else _JUMPS_ALONE,
            skipped=not life.coarser_lives,
            kept=0.0,
            transforms=3.0 * _CONVOLUTIONS * passes,
            seconds=1.5 * _SECONDS * passes + 0.6 * fatigue,
            points=padded_points(grid.shape, grid.periodic) // 4,
        ),
        plans.figures(grid.cells),
    )


_JUMPS_ALONE = "what the cycle jumps leave open alone, since life.coarser_lives is false"
_over, _shown = partial(Series, ("cycle",)), partial(grid_map, of="first")
_step = partial(Series, ("step",), rows=True)
_PITS = "it follows the stresses of single cells, the positions that sample a pass, and the surfaces drawn"
_COUNTS = "pieces follow the mesh under most criteria; see kind wear"


@dataclass(frozen=True, eq=False)
class RunningInLifeRecord(GridRecord):
    """A life: friction, roughness, film and wear from its first cycle to its last, and the jumps that led there."""

    friction_initial: Annotated[float, Figure("", "friction of the unworn surfaces", headline=True)]
    friction_final: Annotated[float, Figure("", "friction at the end", headline=True)]
    lower_Sq_initial: Annotated[float, Figure("nm", "Sq of the whole lower surface, unworn", headline=True)]
    lower_Sq_final: Annotated[
        float, Figure("nm", "Sq of the whole lower surface at the end, its film on it", headline=True)
    ]
    lower_worn_depth: Annotated[float, Figure("nm", "mean depth worn of the whole lower surface", headline=True)]
    Sq_initial: Annotated[float, Figure("nm", "second name of lower_Sq_initial")]
    Sq_final: Annotated[float, Figure("nm", "second name of lower_Sq_final")]
    worn_depth: Annotated[float, Figure("nm", "second name of lower_worn_depth")]
    upper_Sq_initial: Annotated[float, Figure("nm", "Sq of the whole upper surface, unworn")]
    upper_Sq_final: Annotated[float, Figure("nm", "Sq of the whole upper surface at the end")]
    upper_worn_depth: Annotated[float, Figure("nm", "mean depth worn of the whole upper surface")]
    lambda_ratio_initial: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, unworn")]
    lambda_ratio: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, at the end", headline=True)]
    contact_share_initial: Annotated[float, Figure("", "share of the load on contact, unworn")]
    contact_share_final: Annotated[float, Figure("", "share of the load on contact, at the end")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over the patch, at the end")]
    minimum_film: Annotated[float, Figure("nm", f"{MINIMUM_FILM}, at the end")]
    wear_volume: Annotated[float, Figure("um3", "volume worn of both surfaces of the patch")]
    contact_temperature: Annotated[float | None, heated("surfaces in contact, mean by pressure, at the end")]
    flash_temperature: Annotated[float | None, heated("surfaces in contact, highest, at the end")]
    tribofilm_thickness: Annotated[float | None, Figure("nm", "mean thickness of the tribofilm", optional=True)]
    particles: Annotated[float | None, Figure("", "pieces that carry away what wore", optional=True, no_bar=_COUNTS)]
    particle_equivalent_radius: Annotated[
        float | None,
        Figure("nm", "equivalent radius of the mean volume of pieces, over the life", optional=True, no_bar=_COUNTS),
    ]
    micropitted_share: Annotated[
        float | None, Figure("", "share of the surface with a voxel without life left", optional=True, no_bar=_PITS)
    ]
    micropitted_at_most: Annotated[
        float | None,
        Figure("", "the same with the larger damage of either end of each jump", optional=True, unjudged=True),
    ]
    micropitted_at_least: Annotated[
        float | None,
        Figure("", "the same with the smaller, position by position instead of one path", optional=True, unjudged=True),
    ]
    largest_damage: Annotated[
        float | None, Figure("", "largest share of a voxel's life that is used up", optional=True, no_bar=_PITS)
    ]
    jump_error: Annotated[float, Figure("nm", "what the jumps leave open of the mean depths worn", unjudged=True)]
    jumps: Annotated[int, Figure("", "jumps taken", unjudged=True)]
    jumps_rejected: Annotated[int, Figure("", "jumps made shorter", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of all contacts", unjudged=True)]
    cycle: Annotated[FloatArray, _over("1", "cycle")]
    friction_over_cycles: Annotated[FloatArray, _over("1", "coefficient of friction")]
    boundary_friction_over_cycles: Annotated[FloatArray, _over("1", "boundary part of the friction")]
    contact_share: Annotated[FloatArray, _over("1", "share of the load carried by contact")]
    minimum_film_over_cycles: Annotated[FloatArray, _over("m", MINIMUM_FILM)]
    lambda_over_cycles: Annotated[FloatArray, _over("1", LAMBDA_WHOLE)]
    lower_rms_over_cycles: Annotated[FloatArray, _over("m", "Sq of the lower surface, its film on it")]
    upper_rms_over_cycles: Annotated[FloatArray, _over("m", "Sq of the upper surface")]
    lower_depth_over_cycles: Annotated[FloatArray, _over("m", "mean depth worn of the lower surface")]
    upper_depth_over_cycles: Annotated[FloatArray, _over("m", "mean depth worn of the upper surface")]
    depth_error_over_cycles: Annotated[FloatArray, _over("m", "what the jumps leave open of the mean depths worn")]
    flash_temperature_over_cycles: Annotated[FloatArray | None, _over("K", "highest temperature of the contact")]
    tribofilm_over_cycles: Annotated[FloatArray | None, _over("m", "mean thickness of the tribofilm")]
    particles_over_cycles: Annotated[FloatArray | None, _over("1", "pieces so far")]
    micropitted_over_cycles: Annotated[FloatArray | None, _over("1", "micropitted share of the surface")]
    step_cycle: Annotated[FloatArray, _step("1", "cycles after a jump")]
    step_length: Annotated[FloatArray, _step("1", "cycles of a jump")]
    step_error: Annotated[FloatArray, _step("1", "error of a jump over what wore in it")]
    height_before: Annotated[FloatArray, _shown("m", "height of the lower surface, unworn")]
    height_after: Annotated[FloatArray, _shown("m", "height of the lower surface at the end, its film left out")]
    pressure: Annotated[FloatArray, _shown("Pa", "contact pressure in one of the last positions")]
    film_map: Annotated[FloatArray | None, _shown("m", "local thickness of the tribofilm at the end")]
    damage_map: Annotated[FloatArray | None, _shown("1", "largest damage below each place at the end")]


def run(scene: RunningInLifeScene, context: Context) -> RunningInLifeRecord:
    """One life."""
    from bem.life.error_bars import jump_bars
    from bem.life.march import initial_state, run_life

    setup = scene.setup(**scene.sharing.model_dump())
    initial = build.both_heights(scene, setup.grid, context)
    case = lives.case_of(scene, setup)
    monitors, saved = lives.monitors_of(scene, setup, case), kept(context)
    if saved is None:
        state = monitors.start(initial_state(case, *initial))
    else:
        state, pieces, pits = saved
        monitors = replace(monitors, pieces=pieces, pits=pits, last=state)

    def after(now: LifeState) -> LifeState:
        now = monitors.record(now)
        keep(context, (now, monitors.pieces, monitors.pits))
        done = np.log1p(now.cycles / case.first_step) / np.log1p(case.cycles / case.first_step)
        context.progress(round(1000 * done), 1000, "cycles", friction=float(now.over("friction")[-1]))
        return now

    with context.timer("cycles"):
        end = run_life(case, *initial, state=state, callback=after)
    _tell(scene, context, setup, end.passes[-1].film_notes)
    for note in monitors.notes():
        context.note(note)
    wanted = scene.life.coarser_lives
    bars = error_bars(context, wanted, lambda: lives.bars(scene, initial, end)) or {"errors": jump_bars(end)}
    bars["errors"] = _with_body(bars["errors"])
    if "error_parts" in bars:
        bars["error_parts"] = {origin: _with_body(part) for origin, part in bars["error_parts"].items()}
    return replace(_record(scene, setup, end, monitors), **bars)


def _with_body(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Figures, or their errors, with those of the lower surface also under names that say so."""
    names = ("Sq_initial", "Sq_final", "worn_depth")
    return {**figures, **{f"lower_{name}": figures[name] for name in names if name in figures}}


def _tell(scene: RunningInLifeScene, context: Context, setup: MixedSetup, film_notes: tuple[Note, ...]) -> None:
    """What the reader must know."""
    wear, (speeds,) = scene.wear, scene.speeds.build()
    hold = "cycle jumps, positions, cells and points of the films" if scene.life.coarser_lives else _JUMPS_ALONE
    context.note(BARS_PARTIAL(positions=wear.positions, hold=hold, reason="life"))
    mean, slide = 0.5 * abs(sum(speeds)), abs(speeds[0] - speeds[1])
    passing = wear.passes == "both" and mean > 0
    length = setup.grid.lengths[0]
    slid = length * slide / mean if passing else wear.distance
    if passing and slid > 0 and abs(wear.distance / slid - 1) > 0.05:
        context.note(LIFE_DISTANCE_DIFFERS(given=wear.distance, slid=slid, length=length))
    tell(context, film_notes, "film")


def _record(scene: RunningInLifeScene, setup: MixedSetup, end: LifeState, monitors: Monitors) -> RunningInLifeRecord:
    """The figures of a life."""
    from bem.life.error_bars import life_figures

    cycle, at = scene.life.reported(), end.over("cycles")
    over = {name: np.interp(cycle, at, end.over(column)) for name, column in _COLUMNS.items()}
    film, missed = end.surfaces.film, float(end.over("depth_error")[-1])
    return filled(
        RunningInLifeRecord,
        setup.grid,
        _with_body(life_figures(end)),
        over,
        monitors.figures(cycle, end),
        cycle=cycle,
        **_temperatures(scene, cycle, end),
        tribofilm_over_cycles=None if film is None else np.interp(cycle, at, end.over("film_thickness")),
        film_map=film,
        jump_error=missed,
        jumps=len(end.rows) - 1,
        jumps_rejected=end.rejected,
        convolutions=end.convolutions,
        step_cycle=at[1:],
        step_length=end.over("step")[1:],
        step_error=end.over("step_error")[1:],
        height_before=end.first[0],
        height_after=end.surfaces.heights[0],
        pressure=end.passes[0].pressure,
        **({} if film is not None else {"tribofilm_thickness": None}),
    )


def _temperatures(scene: RunningInLifeScene, cycle: FloatArray, end: LifeState) -> dict[str, Any]:
    """Of the contact, where its heat was asked for."""
    if scene.thermal == "off":
        return dict.fromkeys((*TEMPERATURES, "flash_temperature_over_cycles"))
    flash = np.interp(cycle, end.over("cycles"), end.over("flash_temperature"))
    return {name: float(end.over(name)[-1]) for name in TEMPERATURES} | {"flash_temperature_over_cycles": flash}


_COLUMNS = {
    "friction_over_cycles": "friction",
    "boundary_friction_over_cycles": "boundary_friction",
    "contact_share": "contact_share",
    "minimum_film_over_cycles": "minimum_film",
    "lambda_over_cycles": "lambda_ratio",
    "lower_rms_over_cycles": "lower_rms",
    "upper_rms_over_cycles": "upper_rms",
    "lower_depth_over_cycles": "lower_depth",
    "upper_depth_over_cycles": "upper_depth",
    "depth_error_over_cycles": "depth_error",
}


def summarise(scene: RunningInLifeScene, axes: Sequence[Axis], records: Sequence[Any]) -> dict[str, Any]:
    """What is the same for all cases."""
    return {"cycles": scene.life.count, "load_N": scene.load}


KIND = Kind.of(
    vars(),
    RunningInLifeScene,
    RunningInLifeRecord,
    "running-in over a life: wear and tribofilm over millions of cycles in mixed lubrication, in jumps of known error",
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
)
