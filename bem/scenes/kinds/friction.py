"""Kind `friction`: load sharing between oil film and rough contact over speed, the Stribeck curve (thesis, paper A).

A case is one curve: one load, one surface, one contact model; each speed starts from the solution of the one before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import contact_modulus
from bem.scenes import build
from bem.scenes.axes import Axis, changed, listed, variants
from bem.scenes.common import BodyScene, LineGridScene, PositiveLength, SceneModel, Table, problem
from bem.scenes.context import Context
from bem.scenes.kinds import Kind
from bem.scenes.lubrication import FilmMeshScene, LubricatedScene, SpeedsScene
from bem.scenes.oil import OilScene
from bem.scenes.packing import packed, unpacked
from bem.scenes.planner import Plan, Step, convolution_memory, padded_points
from bem.scenes.records import Figure, Record, Series
from bem.scenes.units import Ratio

if TYPE_CHECKING:
    from bem.friction import MixedSolution

Model = Literal["elastic", "capped", "uncoupled", "uncoupled_elastic"]
_CONVOLUTIONS = 120  # of the contacts of one speed
_BASELINE = {"capped": "uncoupled", "elastic": "uncoupled_elastic"}


class SurfaceVariant(Table):
    """Changes to the generated lower surface."""

    name: Annotated[str, Field(min_length=1, max_length=60)]
    correlation_length: PositiveLength | None = None
    rms_height: PositiveLength | None = None


class SharingScene(Table):
    """How the load is shared.

    `models`: "elastic" and "capped" (at the hardness) are the rough half-space; "uncoupled" and "uncoupled_elastic"
    take every summit as a Hertz sphere of its own, the usual baseline. `asperity_separation`: mean planes of the
    uncoupled summits as far apart as keeps the oil's "volume", or as the "film" is thick.
    """

    models: Annotated[list[Model], Field(min_length=1, max_length=4)] = ["capped"]  # noqa: RUF012
    tolerance: Annotated[Ratio, Field(ge=1e-9, le=0.1)] = 1e-4
    contact_tolerance: Annotated[Ratio, Field(gt=0, le=1e-2)] = 1e-6
    asperity_separation: Literal["volume", "film"] = "volume"
    striated_exit: bool = Field(default=False, strict=True)

    @model_validator(mode="after")
    def _each_once(self) -> SharingScene:
        if len(set(self.models)) != len(self.models):
            raise problem("a model is named twice", "each model once")
        return self


class FrictionScene(SceneModel):
    """A rough cylinder on a rough flat with oil between them, at many speeds."""

    kind: Literal["friction"] = "friction"
    lower: BodyScene
    upper: BodyScene
    contact: LubricatedScene
    oil: OilScene
    speeds: SpeedsScene
    grid: LineGridScene = LineGridScene()
    film: FilmMeshScene = FilmMeshScene()
    sharing: SharingScene = SharingScene()
    variants: list[SurfaceVariant] = []  # noqa: RUF012
    repetitions: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1


def check_patch(grid: Grid, film: FilmMeshScene, half_width: float) -> None:
    """Whether the rough patch fits the contact and the film's grid.

    Raises
    ------
    InputError : it does not.
    """
    reach = 0.5 * grid.lengths[0]
    messages = []
    if grid.periodic[0]:
        messages.append("grid.periodic: the patch lies under a cylinder; allowed: [false, true] or [false, false]")
    if reach < half_width:
        messages.append(
            f"grid: the rough patch reaches {reach:.3g} m to either side, less than the contact's half-width "
            f"{half_width:.3g} m; allowed: at least that"
        )
    if film.start is not None and film.end is not None and (film.start > grid.x[0] or film.end < grid.x[-1]):
        messages.append(
            f"film: the rough patch, {grid.x[0]:.3g} to {grid.x[-1]:.3g} m, is larger than the film grid, "
            f"{film.start:.3g} to {film.end:.3g} m; allowed: film.start and film.end beyond the patch"
        )
    if messages:
        raise InputError(messages)


def half_width(scene: Any, load: float) -> float:
    """Half-width of the smooth line contact at a load on the full width [m]; Johnson (1985), eq. 4.43."""
    modulus = modulus_of(scene)
    return float(np.sqrt(4 * load / scene.contact.width * scene.contact.radius / (np.pi * modulus)))


def modulus_of(scene: Any) -> float:
    """Contact modulus of the scene's bodies [Pa]."""
    return contact_modulus(scene.lower.build().material, scene.upper.build().material)


def resolve(scene: FrictionScene) -> FrictionScene:
    """Fill in the grid and the softer surface's hardness."""
    grid = build.resolved_grid(scene.grid, scene.lower.surface, scene.upper.surface)
    contact = scene.contact
    if contact.hardness is None and any(model in ("capped", "uncoupled") for model in scene.sharing.models):
        contact = contact.model_copy(
            update={"hardness": build.softer_hardness(scene.lower.build(), scene.upper.build())}
        )
    return scene.model_copy(update={"grid": grid, "contact": contact})


def variant_of(scene: FrictionScene, variant: SurfaceVariant) -> FrictionScene:
    """The scene with a variant's changes to the lower surface."""
    if scene.lower.surface.kind != "generated":
        raise InputError("variants: the lower surface is not generated; allowed: a generated one")
    changes = {k: v for k, v in variant.model_dump(exclude={"name"}).items() if v is not None}
    if "correlation_length" in changes and scene.lower.surface.correlation_length is None:
        raise InputError(
            "variants.correlation_length: the lower surface has none; allowed: one with correlation_length"
        )
    return changed(scene, "lower.surface", scene.lower.surface.model_copy(update=changes))


def axes(scene: FrictionScene) -> tuple[Axis, ...]:
    """Loads, then variants of the surface, then models."""
    return (
        load_axis(scene),
        variants(scene, variant_of, always=True),
        listed(scene, "sharing.models", "model", Figure("", "contact model")),
    )


def load_axis(scene: Any) -> Axis:
    """The loads on the whole width, given as such or by their Hertz pressures."""
    key = "loads" if scene.contact.loads is not None else "hertz_pressures"
    values = getattr(scene.contact, key)
    return Axis(
        "load",
        tuple(scene.contact.forces(modulus_of(scene))),
        Figure("N", "load"),
        lambda scene, i: changed(scene, f"contact.{key}", [values[i]]),
    )


def load_of(scene: Any) -> float:
    """The load of a case on the whole width [N]."""
    (load,) = scene.contact.forces(modulus_of(scene))
    return float(load)


def plan(scene: FrictionScene) -> Plan:
    """What will be computed for one curve.

    Raises
    ------
    InputError : a patch that does not fit. InfeasibleError : a load that neither film nor surfaces can carry.
    """
    grid = build.grid_of(scene.grid)
    load, (model,) = load_of(scene), scene.sharing.models
    check_patch(grid, scene.film, half_width(scene, load))
    check_load(scene, load)
    build.check_surfaces(grid, lower=scene.lower.surface, upper=scene.upper.surface)
    speeds = len(scene.speeds.build())
    coupled = model in _BASELINE
    points = padded_points(grid.shape, grid.periodic)
    bodies = (scene.lower.build(), scene.upper.build())
    couples = coupled and build.traction_couples(*bodies, scene.contact.boundary_friction)
    return Plan(
        (
            Step("surfaces", "a pair for each curve", transforms=40.0, points=grid.cells),
            Step(
                "films",
                f"about 8 for each of {speeds} speeds of a curve, most of them on a coarser mesh",
                seconds=speeds * (0.3 + 5e-8 * scene.film.points**2),
                memory=16.0 * scene.film.points**2,
            ),
            Step(
                "rough contacts",
                "each speed from the one before; none where the film clears the roughness",
                skipped=not coupled,
                transforms=2.0 * _CONVOLUTIONS * speeds,
                points=points,
                memory=convolution_memory(grid.shape, grid.periodic),
            ),
            Step("stresses", "friction alone needs none", skipped=True),
            Step(
                "tangential kernels in the normal gap",
                "boundary friction couples into the gap, by a kernel of its own"
                if couples
                else "boundary friction does not move the gap of bodies elastically alike, nor of uncoupled asperities",
                skipped=not couples,
                memory=convolution_memory(grid.shape, grid.periodic) if couples else 0.0,
            ),
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8, per="run"),
        )
    )


def check_load(scene: Any, load: float) -> None:
    """Refuse a load beyond hardness times the patch where a film cannot be expected to take it.

    Raises
    ------
    InfeasibleError : such a load.
    """
    hardness, grid = scene.contact.hardness, build.grid_of(scene.grid)
    area = grid.lengths[0] * scene.contact.width
    if hardness is not None and load > hardness * area:
        raise InfeasibleError(
            f"contact.loads: {load:g} N is beyond hardness x area of the patch, {hardness * area:g} N, and the "
            "film cannot carry more than the surfaces under it; allowed: a smaller load or a larger patch"
        )


def _curve(unit: str, text: str, name: str = "") -> Figure:
    return Figure(unit, text, ("speed",), name=name)


def _shown(dimensions: tuple[str, ...], unit: str, text: str) -> Series:
    return Series(dimensions, unit, text, of="first")


@dataclass(frozen=True, eq=False)
class CurveRecord(Record):
    """A Stribeck curve, and the fields that make pictures, at the speed where film and contact share most evenly."""

    speed: Annotated[FloatArray, _curve("m_s", "speed of the flat")]
    friction: Annotated[FloatArray, _curve("", "coefficient of friction")]
    boundary_part: Annotated[FloatArray, _curve("", "boundary part of the friction", "boundary_friction_part")]
    film_part: Annotated[FloatArray, _curve("", "film part of the friction", "film_friction_part")]
    contact_load: Annotated[FloatArray, _curve("N", "load carried by contact")]
    film_load: Annotated[FloatArray, _curve("N", "load carried by the film")]
    minimum_film: Annotated[FloatArray, _curve("nm", "minimum film thickness")]
    lambda_ratio: Annotated[FloatArray, _curve("", "film under the whole load over roughness")]
    contact_area_fraction: Annotated[FloatArray, _curve("", "real contact area over patch")]
    film_solves: Annotated[FloatArray, _curve("", "films solved")]
    contact_solves: Annotated[FloatArray, _curve("", "rough contacts solved")]
    rms_height: Annotated[float, Figure("nm", "rms height of both surfaces together", name="Sq")]
    shown_speed: Annotated[FloatArray, _shown((), "m/s", "speed at which the fields are shown")]
    x: Annotated[FloatArray, _shown(("x",), "m", "x, along sliding")]
    y: Annotated[FloatArray, _shown(("y",), "m", "y")]
    height: Annotated[FloatArray, _shown(("x", "y"), "m", "height of both surfaces together")]
    displacement: Annotated[FloatArray, _shown(("x", "y"), "m", "normal displacement by the contact")]
    pressure: Annotated[FloatArray, _shown(("x", "y"), "Pa", "contact pressure")]
    separation: Annotated[FloatArray, _shown(("x",), "m", "distance of the mean planes")]
    film_thickness_patch: Annotated[FloatArray, _shown(("x",), "m", "film thickness over the patch")]
    film_pressure_patch: Annotated[FloatArray, _shown(("x",), "Pa", "film pressure over the patch")]
    film_x: Annotated[FloatArray, _shown(("film_x",), "m", "x on the film's own mesh")]
    film_pressure: Annotated[FloatArray, _shown(("film_x",), "Pa", "film pressure")]
    film_thickness: Annotated[FloatArray, _shown(("film_x",), "m", "film thickness")]


@dataclass(frozen=True)
class _Point:
    """The numbers of one speed, by the fields of the record."""

    speed: float
    friction: float
    boundary_part: float
    film_part: float
    contact_load: float
    film_load: float
    minimum_film: float
    lambda_ratio: float
    contact_area_fraction: float
    film_solves: float
    contact_solves: float
    status: Status

    @classmethod
    def of(cls, solution: MixedSolution) -> _Point:
        """Those of a solution."""
        area = 0.0 if solution.contact is None else solution.contact.contact_area
        return cls(
            speed=solution.speeds[0],
            friction=solution.friction,
            boundary_part=solution.boundary_force / solution.load,
            film_part=solution.film_force / solution.load,
            contact_load=solution.contact_load,
            film_load=solution.film_load,
            minimum_film=solution.minimum_film,
            lambda_ratio=solution.lambda_ratio,
            contact_area_fraction=area / solution.grid.area,
            film_solves=float(solution.evaluations),
            contact_solves=float(solution.contact_solves),
            status=solution.status,
        )


@dataclass(frozen=True)
class _Curve:
    """A curve so far: the numbers of its speeds, the solution that makes pictures, and the one the next starts from."""

    points: tuple[_Point, ...] = ()
    shown: MixedSolution | None = None
    last: MixedSolution | None = None

    def then(self, solution: MixedSolution) -> _Curve:
        """With one speed more; shown is where film and contact share most evenly, or the first of full films."""
        shown = solution if self.shown is None or _evenness(solution) < _evenness(self.shown) else self.shown
        return _Curve((*self.points, _Point.of(solution)), shown, solution)


def _evenness(solution: MixedSolution) -> float:
    return 1.0 if solution.full_film else abs(solution.contact_load / solution.load - 0.5)


def run(scene: FrictionScene, context: Context) -> CurveRecord:
    """One curve, speed by speed, with a checkpoint after each."""
    from bem.friction import solve_mixed

    grid, (model,) = build.grid_of(scene.grid), scene.sharing.models
    lubricant, boundary_friction = scene.oil.build(), scene.contact.boundary_friction
    bodies = (scene.lower.build(), scene.upper.build())
    with context.timer("surfaces"):
        height = build.heights_of(scene.lower.surface, grid, context.seed("lower"), context.note)
        height = height + build.heights_of(scene.upper.surface, grid, context.seed("upper"), context.note)
    pairs, saved = scene.speeds.build(), context.saved()
    made_again = (grid, lubricant, boundary_friction)
    curve = _Curve() if saved is None else unpacked(saved["curve"], made_again)
    for speeds in pairs[len(curve.points) :]:
        with context.timer("load sharing"), _in_words_of_the_scene():
            own = solve_mixed(
                height=height,
                grid=grid,
                bodies=bodies,
                radius=scene.contact.radius,
                width=scene.contact.width,
                load=load_of(scene),
                speeds=speeds,
                lubricant=lubricant,
                boundary_friction=boundary_friction,
                hardness=scene.contact.hardness if model in ("capped", "uncoupled") else None,
                tolerance=scene.sharing.tolerance,
                contact_tolerance=scene.sharing.contact_tolerance,
                film_points=scene.film.points,
                film_position=scene.film.positions(),
                contact_model="uncoupled" if model.startswith("uncoupled") else "coupled",
                asperity_separation=scene.sharing.asperity_separation,
                striated_exit=scene.sharing.striated_exit,
                initial=curve.last,
            )
        for note in own.notes:
            # the film's model is the same at all speeds: said once
            context.note(f"film: {note}" if note in own.film.notes else f"speed {speeds[0]:g} m/s: {note}")
        curve = curve.then(own)
        if len(curve.points) < len(pairs):
            context.save({"curve": packed(curve, made_again)})
        context.progress(len(curve.points), len(pairs), "speeds", friction=own.friction)
    return _record(grid, curve, height)


@contextmanager
def _in_words_of_the_scene() -> Iterator[None]:
    """Messages about `position` are about the table `film`."""
    try:
        yield
    except InputError as error:
        raise InputError([m.replace("position: ", "film: the film grid ", 1) for m in error.messages]) from None


def _record(grid: Grid, curve: _Curve, height: FloatArray) -> CurveRecord:
    """A row for each speed; fields of the middle speed in touch."""
    shown = curve.shown
    assert shown is not None
    film_pressure, film_thickness = shown.film.at(grid.x)
    bad = [one for one in curve.points if one.status is not Status.CONVERGED]
    numbers = [field.name for field in fields(_Point) if field.name != "status"]
    over_speed: dict[str, Any] = {name: np.array([getattr(one, name) for one in curve.points]) for name in numbers}
    return CurveRecord(
        **over_speed,
        rms_height=float(height.std()),
        shown_speed=np.array(shown.speeds[0]),
        x=grid.x,
        y=grid.y,
        height=height,
        displacement=getattr(shown.contact, "displacement", np.zeros(grid.shape)),
        pressure=shown.contact_pressure,
        separation=shown.separation,
        film_thickness_patch=film_thickness,
        film_pressure_patch=film_pressure,
        film_x=shown.film.position,
        film_pressure=shown.film.pressure,
        film_thickness=shown.film.thickness,
        status=bad[0].status if bad else Status.CONVERGED,
        where="; ".join(f"speed {one.speed:g} m/s: {one.status.value}" for one in bad[:5]),
    )


def summarise(
    scene: FrictionScene, axes: Sequence[Axis], records: Sequence[CurveRecord | None]
) -> dict[str, list[dict[str, Any]]]:
    """The largest |f_u - f_c| over f_u there [%], eq. (13) of paper A: mean and spread over the repetitions."""
    table = np.empty(tuple(len(axis) for axis in axes), dtype=object)
    table.ravel()[:] = records
    loads, names, models, _ = (axis.values for axis in axes[-4:])
    table = table.reshape(-1, *table.shape[-4:])[0]
    found = []
    for (i, load), (j, variant), (k, model) in product(enumerate(loads), enumerate(names), enumerate(models)):
        if _BASELINE.get(model) not in models:
            continue
        values = []
        for one, base in zip(table[i, j, k], table[i, j, models.index(_BASELINE[model])], strict=True):
            if one is not None and base is not None:
                at = int(np.argmax(np.abs(base.friction - one.friction)))
                values.append(100 * float(abs(base.friction[at] - one.friction[at]) / base.friction[at]))
        spread = float(np.std(values, ddof=1)) if len(values) > 1 else 0.0
        percent = float(np.mean(values)) if values else None
        row = {"load_N": load, "variant": variant, "model": model, "d_percent": percent, "d_percent_spread": spread}
        found.append(row)
    return {"largest_difference": found} if found else {}


KIND = Kind(
    name="friction",
    title="load sharing between oil film and rough contact over speed: the Stribeck curve",
    model=FrictionScene,
    axes=axes,
    plan=plan,
    run=run,
    record=CurveRecord,
    summarise=summarise,
    resolve=resolve,
    figures=(
        "stribeck-curve",
        "load-sharing",
        "film-section",
        "film-pressure",
        "largest-difference",
        "pressure-map",
    ),
    headline=("speed_m_s", "friction", "contact_load_N", "film_load_N", "minimum_film_nm", "lambda_ratio"),
)
