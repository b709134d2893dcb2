"""Kind `friction`: load sharing between oil film and rough contact over speed, the Stribeck curve (thesis, paper A).

One curve per load, surface and contact model, each over repetitions with surfaces of their own.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, InputError, Status
from bem.grid import Grid
from bem.materials import contact_modulus
from bem.scenes import build
from bem.scenes.common import BodyScene, GridScene, PositiveLength, SceneModel, Table, problem
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.lubrication import FilmMeshScene, LubricatedScene, OilScene, SpeedsScene
from bem.scenes.planner import Plan, Step, convolution_memory, padded_points
from bem.scenes.units import Ratio

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
    grid: GridScene = GridScene(periodic=(False, True))
    film: FilmMeshScene = FilmMeshScene()
    sharing: SharingScene = SharingScene()
    variants: list[SurfaceVariant] = []  # noqa: RUF012
    repetitions: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1


def check_patch(grid: Grid, film: FilmMeshScene, half_widths: list[float]) -> None:
    """Whether the rough patch fits the contact and the film's grid.

    Raises
    ------
    InputError : it does not.
    """
    reach = 0.5 * grid.lengths[0]
    messages = []
    if grid.periodic[0]:
        messages.append("grid.periodic: the patch lies under a cylinder; allowed: [false, true] or [false, false]")
    if reach < max(half_widths):
        messages.append(
            f"grid: the rough patch reaches {reach:.3g} m to either side, less than the contact's half-width "
            f"{max(half_widths):.3g} m; allowed: at least that"
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


def surface_of(scene: FrictionScene, variant: SurfaceVariant | None) -> Any:
    """The lower surface with a variant's changes."""
    if variant is None:
        return scene.lower.surface
    if scene.lower.surface.kind != "generated":
        raise InputError("variants: the lower surface is not generated; allowed: a generated one")
    changes = {k: v for k, v in variant.model_dump(exclude={"name"}).items() if v is not None}
    if "correlation_length" in changes and scene.lower.surface.correlation_length is None:
        raise InputError(
            "variants.correlation_length: the lower surface has none; allowed: one with correlation_length"
        )
    return scene.lower.surface.model_copy(update=changes)


def plan(scene: FrictionScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InputError : a patch that does not fit. InfeasibleError : a load that neither film nor surfaces can carry.
    """
    grid = build.grid_of(scene.grid)
    loads = scene.contact.forces(modulus_of(scene))
    check_patch(grid, scene.film, [half_width(scene, load) for load in loads])
    check_loads(scene, loads)
    for variant in (*scene.variants,) or (None,):
        build.check_surfaces(grid, lower=surface_of(scene, variant), upper=scene.upper.surface)
    curves = len(loads) * max(1, len(scene.variants)) * scene.repetitions * len(scene.sharing.models)
    speeds = curves * len(scene.speeds.build())
    coupled = sum(model in _BASELINE for model in scene.sharing.models) / len(scene.sharing.models)
    points = padded_points(grid.shape, grid.periodic)
    bodies = (scene.lower.build(), scene.upper.build())
    couples = coupled > 0 and build.traction_couples(*bodies, scene.contact.boundary_friction)
    return Plan(
        (
            Step("surfaces", f"{scene.repetitions} pairs", transforms=40.0 * scene.repetitions, points=grid.cells),
            Step(
                "films",
                f"about 8 for each of {speeds} speeds, most of them on a coarser mesh",
                seconds=speeds * (0.3 + 5e-8 * scene.film.points**2),
                memory=16.0 * scene.film.points**2,
            ),
            Step(
                "rough contacts",
                f"{curves} curves, each speed from the one before; none where the film clears the roughness",
                skipped=coupled == 0,
                transforms=2.0 * _CONVOLUTIONS * speeds * coupled,
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
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8),
        )
    )


def check_loads(scene: Any, loads: list[float]) -> None:
    """Refuse loads beyond hardness times the patch where a film cannot be expected to take them.

    Raises
    ------
    InfeasibleError : such a load.
    """
    hardness, grid = scene.contact.hardness, build.grid_of(scene.grid)
    area = grid.lengths[0] * scene.contact.width
    for load in loads:
        if hardness is not None and load > hardness * area:
            raise InfeasibleError(
                f"contact.loads: {load:g} N is beyond hardness x area of the patch, {hardness * area:g} N, and the "
                "film cannot carry more than the surfaces under it; allowed: a smaller load or a larger patch"
            )


def run(scene: FrictionScene, context: Context) -> Outcome:
    """All curves, speed by speed."""
    from bem.friction import solve_mixed

    grid = build.grid_of(scene.grid)
    bodies = (scene.lower.build(), scene.upper.build())
    oil = scene.oil.build()
    pairs = scene.speeds.build()
    position = scene.film.positions()
    curves = [
        (load, variant, model, repetition)
        for load in scene.contact.forces(modulus_of(scene))
        for variant in (*scene.variants,) or (None,)
        for model in scene.sharing.models
        for repetition in range(scene.repetitions)
    ]
    finished: list[dict[str, Any]] = list((context.saved() or {"finished": []})["finished"])
    for index, (load, variant, model, repetition) in enumerate(curves):
        if index < len(finished):
            continue
        with context.timer("surfaces"):
            height = build.heights_of(
                surface_of(scene, variant), grid, context.seed("lower", repetition), context.note
            ) + build.heights_of(scene.upper.surface, grid, context.seed("upper", repetition), context.note)
        solutions: list[Any] = []
        for number, speeds in enumerate(pairs):
            with context.timer("load sharing"), _in_words_of_the_scene():
                solutions.append(
                    solve_mixed(
                        height=height,
                        grid=grid,
                        bodies=bodies,
                        radius=scene.contact.radius,
                        width=scene.contact.width,
                        load=load,
                        speeds=speeds,
                        lubricant=oil,
                        boundary_friction=scene.contact.boundary_friction,
                        hardness=scene.contact.hardness if model in ("capped", "uncoupled") else None,
                        tolerance=scene.sharing.tolerance,
                        contact_tolerance=scene.sharing.contact_tolerance,
                        film_points=scene.film.points,
                        film_position=position,
                        contact_model="uncoupled" if model.startswith("uncoupled") else "coupled",
                        asperity_separation=scene.sharing.asperity_separation,
                        striated_exit=scene.sharing.striated_exit,
                        initial=solutions[-1] if solutions else None,
                    )
                )
            own = solutions[-1]
            for note in own.notes:
                # the film's model is the same at all speeds: said once
                context.note(f"film: {note}" if note in own.film.notes else f"speed {speeds[0]:g} m/s, {model}: {note}")
            context.progress(
                index * len(pairs) + number + 1, len(curves) * len(pairs), "speeds", friction=solutions[-1].friction
            )
        name = "" if variant is None else variant.name
        finished.append(
            {"load": load, "variant": name, "model": model, "repetition": repetition} | _record(solutions, height)
        )
        context.save({"finished": finished})
    return _outcome(scene, grid, finished)


@contextmanager
def _in_words_of_the_scene() -> Iterator[None]:
    """Messages about `position` are about the table `film`."""
    try:
        yield
    except InputError as error:
        raise InputError([m.replace("position: ", "film: the film grid ", 1) for m in error.messages]) from None


_FIGURES = (
    "friction",
    "boundary_friction_part",
    "film_friction_part",
    "contact_load_N",
    "film_load_N",
    "minimum_film_nm",
    "lambda_ratio",
    "contact_area_fraction",
    "film_solves",
    "contact_solves",
)


def _record(solutions: list[Any], height: NDArray[np.float64]) -> dict[str, Any]:
    """What is kept of a curve: a row per speed, and the fields that make pictures, at the middle speed in touch."""
    rows = {
        "friction": [s.friction for s in solutions],
        "boundary_friction_part": [s.boundary_force / s.load for s in solutions],
        "film_friction_part": [s.film_force / s.load for s in solutions],
        "contact_load_N": [s.contact_load for s in solutions],
        "film_load_N": [s.film_load for s in solutions],
        "minimum_film_nm": [1e9 * s.minimum_film for s in solutions],
        "lambda_ratio": [s.lambda_ratio for s in solutions],
        "contact_area_fraction": [
            0.0 if s.contact is None else s.contact.contact_area / s.grid.area for s in solutions
        ],
        "film_solves": [float(s.evaluations) for s in solutions],
        "contact_solves": [float(s.contact_solves) for s in solutions],
    }
    mixed = [i for i, s in enumerate(solutions) if not s.full_film]
    shares = [abs(s.contact_load / s.load - 0.5) for s in solutions]
    shown = min(mixed, key=lambda i: shares[i]) if mixed else 0
    s = solutions[shown]
    pressure, thickness = s.film.at(s.grid.x)
    bad = [i for i, one in enumerate(solutions) if one.status is not Status.CONVERGED]
    return {
        "rows": {key: np.array(values) for key, values in rows.items()},
        "rms_height": float(height.std()),
        "shown": shown,
        "height": height,
        "pressure": s.contact_pressure,
        "film_position": s.film.position,
        "film_pressure": s.film.pressure,
        "film_thickness": s.film.thickness,
        "patch_film_pressure": pressure,
        "patch_film_thickness": thickness,
        "separation": s.separation,
        "displacement": _zeros(s)
        if s.contact is None or not hasattr(s.contact, "displacement")
        else s.contact.displacement,
        "statuses": [str(one.status.value) for one in solutions],
        "failed": bad,
    }


def _zeros(solution: Any) -> NDArray[np.float64]:
    return np.zeros(solution.grid.shape)


def _outcome(scene: FrictionScene, grid: Grid, finished: list[dict[str, Any]]) -> Outcome:
    each = scene.repetitions
    groups = [finished[start : start + each] for start in range(0, len(finished), each)]
    speed = [pair[0] for pair in scene.speeds.build()]
    curves = []
    for group in groups:
        curve: dict[str, Any] = {key: group[0][key] for key in ("load", "variant", "model")}
        curve["load_N"] = curve.pop("load")
        for key in _FIGURES:
            values = np.array([record["rows"][key] for record in group])
            curve[key] = values.mean(axis=0).tolist()
            if each > 1:
                curve[f"{key}_spread"] = values.std(axis=0, ddof=1).tolist()
        curves.append(curve)
    main = curves[0]
    summary: dict[str, Any] = {
        "speed_m_s": speed,
        **{key: main[key] for key in main if key not in ("variant", "model")},
        "model": main["model"],
        "variant": main["variant"],
        "repetitions": each,
        "Sq_nm": 1e9 * float(np.mean([record["rms_height"] for record in groups[0]])),
    }
    if len(curves) > 1:
        summary["curves"] = curves
    differences = _differences(groups)
    if differences:
        summary["largest_difference"] = differences
    failed = [
        f"{record['model']} at {record['load']:g} N, speed {speed[i]:g} m/s: {record['statuses'][i]}"
        for record in finished
        for i in record["failed"]
    ]
    status = Status.CONVERGED
    if failed:
        first = next(record for record in finished if record["failed"])
        status = Status(first["statuses"][first["failed"][0]])
    return Outcome(summary, _variables(grid, speed, finished), status, "; ".join(failed[:5]))


def _differences(groups: list[list[dict[str, Any]]]) -> list[dict[str, Any]]:
    """The largest |f_u - f_c| over f_u there [%], eq. (13) of paper A: mean and spread over the repetitions."""
    found = []
    by_key = {(g[0]["load"], g[0]["variant"], g[0]["model"]): g for g in groups}
    for (load, variant, model), group in by_key.items():
        base = by_key.get((load, variant, _BASELINE.get(model, "")))
        if base is None:
            continue
        values = []
        for one, other in zip(group, base, strict=True):
            coupled, alone = one["rows"]["friction"], other["rows"]["friction"]
            at = int(np.argmax(np.abs(alone - coupled)))
            values.append(100 * float(abs(alone[at] - coupled[at]) / alone[at]))
        found.append(
            {
                "load_N": load,
                "variant": variant,
                "model": model,
                "d_percent": float(np.mean(values)),
                "d_percent_spread": float(np.std(values, ddof=1)) if len(values) > 1 else 0.0,
            }
        )
    return found


def _variables(grid: Grid, speed: list[float], finished: list[dict[str, Any]]) -> dict[str, Variable]:
    last = finished[0]

    def over(key: str, factor: float = 1.0) -> NDArray[np.float64]:
        return factor * np.array([record["rows"][key] for record in finished])

    along = ("curve", "speed")
    return {
        "speed": Variable(("speed",), np.array(speed), "m/s", "speed of the flat"),
        "load": Variable(("curve",), np.array([r["load"] for r in finished]), "N", "load"),
        "model": Variable(("curve",), np.array([r["model"] for r in finished]), "1", "contact model"),
        "variant": Variable(("curve",), np.array([r["variant"] for r in finished]), "1", "surface"),
        "repetition": Variable(("curve",), np.array([r["repetition"] for r in finished]), "1", "repetition"),
        "friction": Variable(along, over("friction"), "1", "coefficient of friction"),
        "boundary_part": Variable(along, over("boundary_friction_part"), "1", "boundary part of the friction"),
        "film_part": Variable(along, over("film_friction_part"), "1", "film part of the friction"),
        "contact_load": Variable(along, over("contact_load_N"), "N", "load carried by contact"),
        "film_load": Variable(along, over("film_load_N"), "N", "load carried by the film"),
        "minimum_film": Variable(along, over("minimum_film_nm", 1e-9), "m", "minimum film thickness"),
        "lambda_ratio": Variable(along, over("lambda_ratio"), "1", "film under the whole load over roughness"),
        "contact_area_fraction": Variable(along, over("contact_area_fraction"), "1", "real contact area over patch"),
        "shown_speed": Variable((), np.array(speed[last["shown"]]), "m/s", "speed at which the fields are shown"),
        "x": Variable(("x",), grid.x, "m", "x, along sliding"),
        "y": Variable(("y",), grid.y, "m", "y"),
        "height": Variable(("x", "y"), last["height"], "m", "height of both surfaces together"),
        "displacement": Variable(("x", "y"), last["displacement"], "m", "normal displacement by the contact"),
        "pressure": Variable(("x", "y"), last["pressure"], "Pa", "contact pressure"),
        "separation": Variable(("x",), last["separation"], "m", "distance of the mean planes"),
        "film_thickness_patch": Variable(("x",), last["patch_film_thickness"], "m", "film thickness over the patch"),
        "film_pressure_patch": Variable(("x",), last["patch_film_pressure"], "Pa", "film pressure over the patch"),
        "film_x": Variable(("film_x",), last["film_position"], "m", "x on the film's own mesh"),
        "film_pressure": Variable(("film_x",), last["film_pressure"], "Pa", "film pressure"),
        "film_thickness": Variable(("film_x",), last["film_thickness"], "m", "film thickness"),
    }


KIND = Kind(
    name="friction",
    title="load sharing between oil film and rough contact over speed: the Stribeck curve",
    model=FrictionScene,
    plan=plan,
    run=run,
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
