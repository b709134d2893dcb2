"""What the kinds with wear share: depths, the wear model's parts, the loop over cycles with its checkpoint, how sizes
of particles are reported.

Knows tables, plans and records; the loop itself is `bem.wear.run_in`. Verified in tests/scenes/test_wear_kind.py and
test_friction_kinds.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import ConvergenceError, InputError
from bem.grid import FloatArray, Grid
from bem.scenes import plans
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.context import Context, tell
from bem.scenes.planner import Step, padded_points, stress_kernel_seconds
from bem.scenes.records import Figure, Record, Series, without_bars
from bem.scenes.rubbing import rubbing_step
from bem.scenes.units import Length, WearCoefficient
from bem.wear.criterion import WearCriterion
from bem.wear.loads import wearing_bodies

if TYPE_CHECKING:
    from bem.wear import RunningIn, RunningInState
    from bem.wear.film_defect import FilmDefect
    from bem.wear.third_bodies import ThirdBodies

Found = TypeVar("Found")
_CHECKPOINT_EVERY = 10  # cycles
Count = Annotated[int, Field(strict=True, ge=1)]
IntArray = NDArray[np.int_]
QUANTITIES = ("equivalent_radius", "length", "width", "thickness")


class WearDepthsScene(Table):
    """Equally spaced depths: `first`, `first + spacing`, ..."""

    count: Annotated[int, Field(strict=True, ge=2, le=1024)] = 64
    spacing: PositiveLength
    first: Annotated[Length, Field(ge=0)] = 0.0

    def build(self) -> NDArray[np.float64]:
        """Depths [m]; InputError if they are beyond numbers."""
        if not math.isfinite(self.first + self.spacing * self.count):
            raise InputError(
                f"depths.spacing = {self.spacing:g} m: the deepest lies beyond numbers; give a smaller one"
            )
        return self.first + self.spacing * np.arange(self.count, dtype=np.float64)


class LastCycles(Table):
    """How many cycles, and over how many of the last ones means are taken.

    `coarser_grid` : the same cycles once more on the grid of twice the cell, for error bars of what cells leave open.
    """

    count: Count = 200
    settled: Count = 50
    coarser_grid: bool = Field(default=False, strict=True)

    @model_validator(mode="after")
    def _enough(self) -> Self:
        for name in ("averaged", "settled"):
            if getattr(self, name, 0) > self.count:
                raise problem(f"{name} {getattr(self, name)} is more than count {self.count}", f"{name} <= count")
        return self


class WearRateScene(Table):
    """Archard's law: the wear volume that the criterion cannot give, and so the number of particles."""

    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)]
    distance: PositiveLength

    def figures(self, load: float, mean_particle_volume: float) -> dict[str, float]:
        """What records hold of it, for a load [N] and particles of a mean volume [m^3]."""
        from bem.particles import archard_wear

        wear = archard_wear(self.specific_wear_rate, load, self.distance, mean_particle_volume)
        values = (wear.volume, wear.number, 1e-3 * wear.coefficient)
        return dict(zip(ARCHARD_FIGURES, values, strict=True))


ARCHARD_FIGURES = ("wear_volume", "particle_number", "particles_per_mm_and_N")


def cycle_steps(
    scene: Any, grid: Grid, *, convolutions: int, contacts: str, usual: int, first: int, friction: float
) -> tuple[Step, ...]:
    """Contact, slip, stresses and pieces of a case.

    convolutions : of the contacts of a cycle. contacts : what is solved, in words.
    usual, first : depths before one at which nothing yields, in a usual cycle and in the first ones. friction : of the
    surfaces.

    Raises
    ------
    InputError : neither body has a yield stress, a length of the criterion that the grid has no room for, partial slip
    without friction.
    """
    scene.wear.traction.check(friction)
    strengths = [body.build().surface_material.yield_stress for body in (scene.lower, scene.upper)]
    if scene.wear.criterion.needs_strength and all(value is None for value in strengths):
        raise InputError(
            "lower.material: neither body has a yield_stress or a hardness, so nothing can wear; allowed: one of them"
        )
    scene.wear.criterion.check_length(grid)
    points, cycles = padded_points(grid.shape, grid.periodic), scene.cycles.count
    depths, deepest = min(scene.depths.count, usual), min(scene.depths.count, first)
    return (
        plans.contacts(grid, convolutions * cycles, f"{cycles} cycles a case, {contacts}"),
        rubbing_step(scene.wear.traction, grid, cycles),
        Step("stresses", "the criterion asks for none", skipped=True)
        if not isinstance(scene.wear.criterion, WearCriterion)
        else Step(
            "stresses",
            "from the surface down to the first depth at which nothing yields",
            transforms=7.0 * depths * cycles,
            points=points,
            seconds=stress_kernel_seconds(grid.cells, deepest),
            memory=8.0 * (points / 4 * 12 * deepest + grid.cells * (deepest + 8)),
        ),
        Step("pieces", "runs of yielded voxels along depth", seconds=0.004 * cycles, memory=8.0 * grid.cells * 8),
    )


def bars_step(scene: Any, grid: Grid, convolutions: int) -> Step:
    """Of a plan: the loop on the coarser grid; `convolutions` of the contacts of a cycle."""
    wanted = scene.cycles.coarser_grid
    return Step(
        "error bars",
        "the same cycles on the grid of twice the cell" if wanted else _SCATTER_ALONE,
        skipped=not wanted,
        kept=0.0,
        transforms=4.0 * convolutions * scene.cycles.count,
        points=padded_points(grid.shape, grid.periodic) // 4,
    )


_SCATTER_ALONE = "cycles.coarser_grid is false: what repetitions scatter is all that is told of errors"


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
"""That a film is solved on."""


def film_keys(scene: Any, factor: float) -> dict[str, Any]:
    """Keys of a scene in mixed lubrication with so many times the points of the film, as far as that can be."""
    sharing = scene.sharing
    return {
        "sharing.film_points": min(max(round(factor * sharing.film_points), _FEWEST_POINTS), 2000),
        "sharing.film_cells": min(max(round(factor * sharing.film_cells), _FEWEST_FILM_CELLS), 256),
    }


def film_is_halved(scene: Any) -> bool:
    """Whether the film of a scene is still solved on half its points."""
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
    """What a loop finds from the heights of both bodies on the grid of twice the cell, told how many times the cells
    along y that has: half, or as many in a strip of fewer than a coarser grid needs along which nothing changes. None
    where cells are odd or too few for one, or a contact there does not converge."""
    from bem.accuracy.wear import FEWEST
    from bem.contact.cascade import sample

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


def wear_loop(
    scene: Any,
    context: Context,
    heights: tuple[FloatArray, FloatArray],
    *,
    watch: Callable[[RunningInState], Mapping[str, float]],
    keep: Callable[[], Mapping[str, Any]] = dict,
    third_bodies: ThirdBodies | None = None,
    film_defect: FilmDefect | None = None,
    **contact: Any,
) -> RunningIn:
    """The wear loop of a case, from its checkpoint where there is one.

    heights : of both bodies at the start [m]. watch : called after every cycle; gives the figures beside the progress.
    keep : what the checkpoint holds then besides the loop's own state, under names other than "wear".
    third_bodies : particles between the surfaces. film_defect : of a boundary film. contact : further arguments of
    `bem.wear.run_in`.
    """
    from bem.wear import WearModel, pack_state, run_in, unpack_state

    saved, count = context.saved(), scene.cycles.count

    def after(now: RunningInState) -> None:
        figures = watch(now)
        if now.cycle % _CHECKPOINT_EVERY == 0 or now.cycle == count:
            context.save({"wear": pack_state(now), **keep()})
        context.progress(now.cycle, count, "cycles", **figures)

    with context.timer("cycles"):
        result = run_in(
            *heights,
            bodies=(scene.lower.build(), scene.upper.build()),
            depths=scene.depths.build(),
            cycles=count,
            model=WearModel(
                **scene.wear.model_dump(exclude={"third_bodies", "film_defect"}),
                third_bodies=third_bodies,
                film_defect=film_defect,
            ),
            state=None if saved is None else unpack_state(saved["wear"]),
            callback=after,
            **contact,
        )
    tell(context, result.notes)
    return result


class SizesScene(Table):
    """How particle sizes are reported.

    `report` names the mean that stands as `particle_equivalent_radius_nm`; `smallest` is the equivalent radius under
    which particles are left out of the means "above".
    """

    report: Literal["number", "area", "volume", "number_above"] = "volume"
    smallest: Annotated[Length, Field(ge=0)] = 25e-9
    particles_of: Literal["wearing", "lower", "upper"] = "wearing"

    def particles(self, result: RunningIn) -> NDArray[np.void]:
        """The particles that are reported of a wear loop."""
        body = {"wearing": result.wearing[0], "lower": 0, "upper": 1}[self.particles_of]
        return result.particles[result.particles["body"] == body]


@dataclass(frozen=True, eq=False)
class WornSurface:
    """What every wear loop leaves: the wearing body's heights on the grid [m], unworn and run in, the last pressure
    [Pa], the particles that are reported, all and of the settled cycles, and figures of its records by their names."""

    height_before: FloatArray
    height_after: FloatArray
    pressure: FloatArray
    particles: NDArray[np.void]
    late: NDArray[np.void]
    figures: dict[str, Any]

    @classmethod
    def of(
        cls, scene: Any, initial: tuple[FloatArray, FloatArray], result: RunningIn, grid: Grid, load: float
    ) -> WornSurface:
        """That of a scene's loop, which started from `initial` heights of both bodies; `load` [N] on the grid."""
        from bem.wear.criterion import LocalWear
        from bem.wear.outcome import criterion_wear_rate, step_error

        assert result.pressure is not None
        cycles, particles = result.cycles, scene.sizes.particles(result)
        settled = cycles["cycle"][-scene.cycles.settled :]
        late = particles[particles["cycle"] >= settled[0]]
        before, after = initial[result.wearing[0]], result.worn_heights()[: grid.shape[0]]
        figures = {
            "cycle": np.arange(1, len(cycles) + 1),
            "particles_per_cycle": float(late.size / len(settled)),
            "convolutions_per_cycle": float(cycles["convolutions"].mean()),
            "step_error": step_error(result.state.memories[result.wearing[0]])
            if isinstance(scene.wear.criterion, LocalWear)
            else None,
            "criterion_wear_rate": criterion_wear_rate(
                cycles[-scene.cycles.settled :],
                load,
                scene.wear.criterion.distance_per_cycle(abs(scene.wear.shift) * grid.spacing[0]),
            ),
        }
        return cls(before, after, result.pressure, particles, late, figures)

    def strip(self, where: NDArray[np.bool_]) -> dict[str, float]:
        """Sq before and after and the mean depth worn [m] in those rows (nx,) or cells (nx, ny)."""
        from bem.wear.outcome import strip_wear

        strip = strip_wear(self.height_before, self.height_after, where)
        return {"Sq_initial": strip.rms_before, "Sq_final": strip.rms_after, "worn_depth": strip.depth}


particle_rows = partial(Series, ("particle",), rows=True)
"""A column of the table of particles."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ParticleTable(Record):
    """Size and place of every particle."""

    particle_volume: Annotated[FloatArray, particle_rows("m^3", "volume of a particle")]
    particle_length: Annotated[FloatArray, particle_rows("m", "length of a particle's bounding rectangle")]
    particle_width: Annotated[FloatArray, particle_rows("m", "width of a particle's bounding rectangle")]
    particle_thickness: Annotated[FloatArray, particle_rows("m", "largest thickness of a particle")]
    particle_x: Annotated[FloatArray, particle_rows("m", "x of a particle's centre")]
    particle_y: Annotated[FloatArray, particle_rows("m", "y of a particle's centre")]


_OF_PIECES = "which pieces leave first decides the sizes of those that follow, and repetitions narrow that, no cells"


def _reported(quantity: str) -> Figure:
    return Figure(
        "nm",
        f"{quantity} of the particles, the reported mean",
        name=f"particle_{quantity.replace(' ', '_')}",
        headline=True,
        chance=_OF_PIECES,
    )


FOLLOWS_CELL = (
    "it follows the mesh, or was not shown to converge with it: the source's criterion has no length but the cell, and "
    "most of its pieces are of one cell or a few"
)
"""Why a mean by number, and a count, has no error bar."""


def _by(weight: str, quantity: str) -> Figure:
    follows = "number" in weight
    return Figure(
        "nm",
        f"{quantity} of the particles, mean {weight}",
        no_bar=FOLLOWS_CELL if follows else "",
        chance="" if follows else _OF_PIECES,
    )


@dataclass(frozen=True, eq=False)
class MeanSizes(Record):
    """Mean sizes of the settled particles: the reported one, and by number, area, volume, and number above a size."""

    scatters: ClassVar[tuple[str, ...]] = (
        *(f"{weight}_{quantity}" for weight in ("reported", "area_mean", "volume_mean") for quantity in QUANTITIES),
    )
    reported_equivalent_radius: Annotated[float, _reported("equivalent radius")]
    reported_length: Annotated[float, _reported("length")]
    reported_width: Annotated[float, _reported("width")]
    reported_thickness: Annotated[float, _reported("thickness")]
    number_mean_equivalent_radius: Annotated[float, _by("by number", "equivalent radius")]
    number_mean_length: Annotated[float, _by("by number", "length")]
    number_mean_width: Annotated[float, _by("by number", "width")]
    number_mean_thickness: Annotated[float, _by("by number", "thickness")]
    area_mean_equivalent_radius: Annotated[float, _by("by area", "equivalent radius")]
    area_mean_length: Annotated[float, _by("by area", "length")]
    area_mean_width: Annotated[float, _by("by area", "width")]
    area_mean_thickness: Annotated[float, _by("by area", "thickness")]
    volume_mean_equivalent_radius: Annotated[float, _by("by volume", "equivalent radius")]
    volume_mean_length: Annotated[float, _by("by volume", "length")]
    volume_mean_width: Annotated[float, _by("by volume", "width")]
    volume_mean_thickness: Annotated[float, _by("by volume", "thickness")]
    number_above_mean_equivalent_radius: Annotated[float, _by("by number above the smallest", "equivalent radius")]
    number_above_mean_length: Annotated[float, _by("by number above the smallest", "length")]
    number_above_mean_width: Annotated[float, _by("by number above the smallest", "width")]
    number_above_mean_thickness: Annotated[float, _by("by number above the smallest", "thickness")]


def mean_sizes(particles: NDArray[np.void], sizes: SizesScene) -> dict[str, Any]:
    """The fields of `MeanSizes` [m] of a table of particles."""
    statistics = size_statistics(particles, sizes.smallest)
    reported = {f"reported_{quantity}": statistics[sizes.report][quantity] for quantity in QUANTITIES}
    return reported | {
        f"{weight}_mean_{quantity}": value
        for weight, values in statistics.items()
        for quantity, value in values.items()
    }


def sizes_converge(scene: Any, grid: Grid) -> bool:
    """Whether sizes by number were found to converge under the scene's criterion, on cells as small as a case's."""
    bodies, law = (scene.lower.build(), scene.upper.build()), scene.wear.criterion
    wearing = (bodies[body].surface_material for body in wearing_bodies(bodies, scene.wear.wears))
    return law.sizes_converge and all(law.resolved(material, grid) for material in wearing)


def sizes_without_bars(scene: Any, grid: Grid) -> dict[str, None]:
    """The reported sizes, where the mean that is reported follows the mesh."""
    follows = "number" in scene.sizes.report and not sizes_converge(scene, grid)
    return dict.fromkeys(f"reported_{quantity}" for quantity in QUANTITIES) if follows else {}


def scattering(record: type[Record], scene: Any, grid: Grid) -> tuple[str, ...]:
    """Figures of a record that follow the mesh under the source's criterion, where under the scene's they converge."""
    return tuple(without_bars(record)) if sizes_converge(scene, grid) else ()


def mean_radii(particles: NDArray[np.void], sizes: SizesScene, *names: str) -> dict[str, float]:
    """Mean equivalent radii [m] under three names: the reported one, by number and by volume; 0 of no particles."""
    if not particles.size:
        return dict.fromkeys(names, 0.0)
    statistics = size_statistics(particles, sizes.smallest)
    weights = (sizes.report, "number", "volume")
    return {name: statistics[weight]["equivalent_radius"] for name, weight in zip(names, weights, strict=True)}


def size_statistics(particles: NDArray[np.void], smallest: float) -> dict[str, dict[str, float]]:
    """Means of radius, length, width and thickness [m] by number, area and volume, and by number above a size."""
    from bem.particles import particle_statistics

    statistics = {weight: particle_statistics(particles, weight=weight) for weight in ("number", "area", "volume")}
    statistics["number_above"] = particle_statistics(particles, smallest_radius=smallest)
    return {
        name: {quantity: getattr(each, f"mean_{quantity}") for quantity in QUANTITIES}
        for name, each in statistics.items()
    }
