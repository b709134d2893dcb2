"""Kind `contact`: two rough, possibly coated bodies pressed together; pressure, gap, approach, stresses below."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.scenes import build
from bem.scenes.common import (
    BodyScene,
    DepthsScene,
    Force,
    GridScene,
    PositivePressure,
    SceneModel,
    ShapeScene,
    Table,
    UpperBodyScene,
    exactly_one,
    problem,
)
from bem.scenes.context import LARGE, Context, release
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step, padded_points, show_bytes
from bem.scenes.records import Figure, Record, Series
from bem.scenes.units import Length, Ratio

if TYPE_CHECKING:
    from bem.contact import ContactSolution

_TRANSFORMS_PER_CONVOLUTION = 3.2
"""Time of a convolution and what the contact solver does besides, in transforms: measured, 256 to 1024 cells."""
_LIBRARIES = 2.2e8
"""Bytes of the interpreter with the solver's libraries."""


def _map(unit: str, text: str) -> Series:
    return Series(("x", "y"), unit, text)


_STRESS_COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")


class ContactControl(Table):
    """How the bodies are pressed together: by load, mean pressure, approach from first touch or mean gap."""

    load: Annotated[Force, Field(gt=0)] | None = None
    mean_pressure: PositivePressure | None = None
    approach: Length | None = None
    mean_gap: Annotated[Length, Field(gt=0)] | None = None
    behaviour: Literal["elastic", "capped"] = "elastic"
    hardness: PositivePressure | None = None
    friction: Annotated[Ratio, Field(ge=-10, le=10)] = 0.0
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = 1e-8
    max_iterations: Annotated[int, Field(strict=True, ge=1, le=1_000_000)] = 2000

    @model_validator(mode="after")
    def _one_control(self) -> ContactControl:
        exactly_one(self, "load", "mean_pressure", "approach", "mean_gap")
        if self.behaviour == "elastic" and self.hardness is not None:
            raise problem(
                "hardness is given but behaviour is elastic", 'behaviour = "capped" with hardness, or neither'
            )
        return self


class ContactOutputs(Table):
    """What is wanted besides pressure, gap and displacement."""

    von_mises: bool = Field(default=False, strict=True)
    stresses: bool = Field(default=False, strict=True)
    depths: DepthsScene | None = None
    body: Literal["lower", "upper"] = "lower"
    vtk: bool = Field(default=True, strict=True)
    errors: bool = Field(default=True, strict=True)


class ContactScene(SceneModel):
    """Two bodies, a grid and a load."""

    kind: Literal["contact"] = "contact"
    grid: GridScene = GridScene()
    lower: BodyScene
    upper: UpperBodyScene = UpperBodyScene()
    shape: ShapeScene = ShapeScene()
    contact: ContactControl
    outputs: ContactOutputs = ContactOutputs()

    @model_validator(mode="after")
    def _stresses_in_an_elastic_body(self) -> ContactScene:
        if self.outputs.body == "upper" and self.upper.material is None and _wants_stresses(self):
            raise problem(
                'outputs.body = "upper": the upper body is rigid', 'outputs.body = "lower", or upper.material'
            )
        return self


def resolve(scene: ContactScene) -> ContactScene:
    """Fill in the grid where measured surfaces decide it, and the hardness of the softer surface."""
    update: dict[str, Any] = {"grid": build.resolved_grid(scene.grid, scene.lower.surface, scene.upper.surface)}
    if scene.contact.behaviour == "capped" and scene.contact.hardness is None:
        hardness = build.softer_hardness(scene.lower.build(), scene.upper.build())
        update["contact"] = scene.contact.model_copy(update={"hardness": hardness})
    if _wants_stresses(scene) and scene.outputs.depths is None:
        deepest = min(build.grid_of(update["grid"]).lengths) / 4
        update["outputs"] = scene.outputs.model_copy(update={"depths": DepthsScene(deepest=deepest, count=24)})
    return scene.model_copy(update=update)


def plan(scene: ContactScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area. InputError : surfaces that cannot be generated on the grid.
    """
    grid = build.grid_of(scene.grid)
    build.check_surfaces(grid, lower=scene.lower.surface, upper=scene.upper.surface)
    lower, upper = scene.lower.build(), scene.upper.build()
    load, hardness = _load(scene, grid.area), scene.contact.hardness
    if load is not None and hardness is not None and load > hardness * grid.area:
        key, value = ("load", f"{load:g} N") if scene.contact.load else ("mean_pressure", f"{load / grid.area:g} Pa")
        raise InfeasibleError(
            f"contact.{key} = {value}: beyond hardness x area = {hardness:g} Pa x {grid.area:g} m^2 = "
            f"{hardness * grid.area:g} N; allowed: a smaller load, a larger grid or a higher hardness"
        )
    points = padded_points(grid.shape, grid.periodic)
    coupled = build.traction_couples(lower, upper, scene.contact.friction)
    depths = _depths(scene)
    stressed = lower if scene.outputs.body == "lower" else upper
    vtk = scene.outputs.vtk and bool(depths)
    steps = (
        _plan_surfaces(scene, grid),
        Step(
            "layered kernels",
            _layered(lower, upper) or "no body is coated",
            skipped=not _layered(lower, upper),
            transforms=60,
            points=points,
            memory=8.0 * points / 4,
        ),
        Step(
            "traction kernels",
            _coupling_reason(coupled, scene.contact.friction),
            skipped=not coupled,
            transforms=20,
            points=points,
            memory=8.0 * points / 4,
        ),
        Step(
            "contact",
            f"{scene.contact.behaviour}, {_control(scene)}",
            transforms=_TRANSFORMS_PER_CONVOLUTION * _convolutions(grid),
            points=points,
            # Measured from 2048 to 4096 cells: fields of the solver and of its coarser grids, spectra and buffers.
            memory=_LIBRARIES + 8.0 * grid.cells * 9.5 + 20.0 * points,
            kept=_LIBRARIES + 8.0 * grid.cells * 4.2 + 8.0 * points,
            seconds=1.0,
        ),
        _plan_stresses(scene, grid, stressed, depths),
        _plan_errors(scene, grid, depths),
        Step(
            "VTK",
            "stress field for ParaView" if vtk else "no stress field to write",
            skipped=not vtk,
            seconds=1.0,
            memory=1e8,
            kept=0.0,
        ),
        Step(
            "figures and report",
            "pictures of the results, and the libraries for them",
            per="run",
            seconds=4.0,
            memory=2.2e8 + 8.0 * grid.cells * 2,
        ),
    )
    return Plan(steps)


def _plan_surfaces(scene: ContactScene, grid: Grid) -> Step:
    surfaces = {name: getattr(scene, name).surface for name in ("lower", "upper")}
    rough = {name: surface for name, surface in surfaces.items() if surface.kind != "smooth"}
    # A surface that is not Gaussian is found by iteration.
    iterated = sum(s.kind == "generated" and (s.skewness, s.kurtosis) != (0.0, 3.0) for s in rough.values())
    return Step(
        "surfaces",
        f"heights of {' and '.join(rough)}" if rough else "both bodies are smooth",
        skipped=not rough,
        transforms=60.0 * len(rough) + 300.0 * iterated,
        points=grid.cells,
        memory=8.0 * grid.cells * 14,
        kept=8.0 * grid.cells * (1 + len(rough)),
        seconds=0.3,
    )


def _plan_stresses(scene: ContactScene, grid: Grid, body: Body | None, depths: tuple[float, ...]) -> Step:
    points = padded_points(grid.shape, grid.periodic)
    periodic = all(grid.periodic)
    fields = 7 if scene.outputs.stresses else 1
    loads = 1 if scene.contact.friction == 0 else 2
    # Six real spectra a load and depth: half arrays where periodic, quarters elsewhere, kept up to half a gigabyte.
    spectra = min(2.0**29, len(depths) * loads * 6 * 8 * points * (0.5 if periodic else 0.25))
    coated = body is not None and not body.homogeneous
    volume = 8.0 * grid.cells * len(depths)
    on_disk = volume >= LARGE
    held = volume * (fields - on_disk)
    where = f"; {show_bytes(volume)} of them on disk, not in memory" if on_disk else ""
    return Step(
        "stresses below",
        f"{len(depths)} depths in the {scene.outputs.body} body{where}"
        if depths
        else "neither stresses nor von Mises are asked for",
        skipped=not depths,
        # Time of the kernels and of six components at one depth, in transforms: measured.
        transforms=len(depths) * (25.0 if periodic else 40.0) * (2.5 if coated else 1.0),
        points=points,
        memory=held + spectra + 8 * 8.0 * points,
        kept=held + spectra,
        seconds=0.5,
    )


def _plan_errors(scene: ContactScene, grid: Grid, depths: tuple[float, ...]) -> Step:
    wanted = scene.outputs.errors
    points = padded_points(grid.shape, grid.periodic) / 4
    # From a start nearby; the coarser operator's own spectra, and von Mises at every second depth.
    return Step(
        "error bars",
        "the contact on the grid of twice the cell" if wanted else "outputs.errors is false",
        skipped=not wanted,
        transforms=_TRANSFORMS_PER_CONVOLUTION * _convolutions(grid) + 0.5 * len(depths) * 25.0,
        points=int(points),
        memory=8.0 * grid.cells * 9.5 / 4 + 20.0 * points,
        kept=0.0,
    )


def _convolutions(grid: Grid) -> float:
    """Convolutions of a solve, coarse levels included: about 18 at 256 cells a side, growing slowly with them."""
    return 18.0 * max(1.0, max(grid.shape) / 256) ** 0.2


def _layered(lower: Body, upper: Body | None) -> str:
    return " and ".join(
        f"{build.show_layers(body)} on the {name} body"
        for name, body in (("lower", lower), ("upper", upper))
        if body is not None and not body.homogeneous
    )


def _coupling_reason(coupled: bool, friction: float) -> str:
    if coupled:
        return "friction between elastically dissimilar bodies (Dundurs' beta is not zero)"
    return "no friction" if friction == 0 else "Dundurs' beta is zero: traction does not move the gap"


@dataclass(frozen=True, eq=False)
class ContactRecord(Record):
    """A solved contact, and the stresses below it where they are asked for."""

    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    plastic_area_fraction: Annotated[float, Figure("", "area at the hardness over that of the grid")]
    contact_area: Annotated[float, Figure("m2", "real contact area")]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area")]
    max_pressure: Annotated[float, Figure("Pa", "highest pressure")]
    load: Annotated[float, Figure("N", "load")]
    approach: Annotated[float, Figure("m", "approach from first touch")]
    mean_gap: Annotated[float, Figure("m", "mean of the open gap")]
    residual: Annotated[float, Figure("", "relative residual")]
    iterations: Annotated[int, Figure("", "iterations")]
    convolutions: Annotated[float, Figure("", "convolutions")]
    lower_Sq: Annotated[float | None, Figure("m", "Sq of the lower surface", optional=True)]
    upper_Sq: Annotated[float | None, Figure("m", "Sq of the upper surface", optional=True)]
    max_von_mises: Annotated[float | None, Figure("Pa", "highest von Mises stress", optional=True)]
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True)]
    yielded_volume: Annotated[float | None, Figure("m3", "volume beyond the yield stress", optional=True)]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along sliding")]
    y: Annotated[FloatArray, Series(("y",), "m", "y")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure")]
    displacement: Annotated[FloatArray, _map("m", "normal displacement of both bodies together")]
    gap: Annotated[FloatArray, _map("m", "gap between the deformed surfaces")]
    contact_state: Annotated[NDArray[np.int8], _map("1", "0 open, 1 elastic, 2 capped")]
    undeformed_gap: Annotated[FloatArray, _map("m", "gap before deformation, zero at first touch")]
    plastic_depth: Annotated[FloatArray | None, _map("m", "overlap of the surfaces where capped")]
    lower_height: Annotated[FloatArray | None, _map("m", "height of the lower surface")]
    upper_height: Annotated[FloatArray | None, _map("m", "height of the upper surface")]
    iteration: Annotated[NDArray[np.int64] | None, Series(("iteration",), "1", "iteration")]
    residual_history: Annotated[
        FloatArray | None, Series(("iteration",), "1", "relative residual of the contact solver")
    ]
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")]
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")]
    component: Annotated[list[str] | None, Series(("component",), "1", "component of the stress")]
    stress: Annotated[FloatArray | None, Series(("component", "depth", "x", "y"), "Pa", "stress, positive in tension")]


def run(scene: ContactScene, context: Context) -> ContactRecord:
    """Solve the contact and, where asked for, the stresses below it."""
    grid = build.grid_of(scene.grid)
    with context.timer("surfaces"):
        heights = {
            name: build.heights_of(body.surface, grid, context.seed(name), context.note)
            for name, body in (("lower", scene.lower), ("upper", scene.upper))
        }
    undeformed = build.shape_of(scene.shape, grid)
    for values in heights.values():
        undeformed -= values
    if any(values.any() for values in heights.values()):
        undeformed -= undeformed.min()  # approach counts from first touch; smooth shapes touch at zero already
    with context.timer("contact"):
        solution, history = _solve(scene, grid, undeformed, context)
    for note in solution.notes:
        context.note(note)
    stresses: dict[str, Any] = dict.fromkeys(_STRESSES)
    highest: FloatArray | None = None
    if _depths(scene):
        with context.timer("stresses"):
            found, highest = _stresses(scene, solution.pressure, context)
            stresses |= found
    converged = solution.status is Status.CONVERGED
    errors: Mapping[str, float | None] = {}
    if scene.outputs.errors and converged:
        with context.timer("error bars"):
            rough = any(values.any() for values in heights.values())
            errors = _errors(scene, undeformed, solution, highest, rough, context)
    return ContactRecord(
        **_figures(solution, grid.area, heights),
        x=grid.x,
        y=grid.y,
        pressure=solution.pressure,
        displacement=solution.displacement,
        gap=solution.gap,
        contact_state=_contact_state(solution.pressure, scene.contact.hardness),
        undeformed_gap=undeformed,
        plastic_depth=solution.plastic_depth if np.any(solution.plastic_depth) else None,
        iteration=history[:, 0].astype(np.int64) if len(history) else None,
        residual_history=history[:, 1] if len(history) else None,
        **stresses,
        errors=errors,
        status=solution.status,
        where="" if converged else f"contact solve: {solution.status.message}, residual {solution.residual:.2g}",
    )


def _solve(
    scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context
) -> tuple[ContactSolution, FloatArray]:
    """The contact, from the checkpoint where it was solved before, and (n, 2) iterations and residuals."""
    from bem.contact import ContactSolution, solve_contact
    from bem.convolution import displacement_operator

    saved = context.saved()
    if saved is not None:
        fields = saved["solution"]
        told = {"status": Status(fields["status"]), "notes": tuple(fields.get("notes", ()))}
        return ContactSolution(**(fields | told)), saved["history"]
    lower, upper = scene.lower.build(), scene.upper.build()
    operator = displacement_operator(grid, lower if upper is None else (lower, upper), friction=scene.contact.friction)
    history = []

    def watch(iterations: int, residual: float, fraction: float) -> None:
        history.append((iterations, residual))
        # convergence is near linear in the logarithm of the residual
        share = math.log(min(max(residual, 1e-300), 1.0)) / math.log(scene.contact.tolerance)
        context.progress(int(100 * min(share, 1.0)), 100, "contact", residual=residual, area_fraction=fraction)

    solution = solve_contact(
        undeformed,
        operator,
        load=_load(scene, grid.area),
        approach=scene.contact.approach,
        mean_gap=scene.contact.mean_gap,
        hardness=scene.contact.hardness,
        tolerance=scene.contact.tolerance,
        max_iterations=scene.contact.max_iterations,
        callback=watch,
    )
    del operator  # and with it its spectra
    context.progress(100, 100, "contact", residual=solution.residual)
    told_of = np.array(history, dtype=np.float64).reshape(-1, 2)
    context.save({"solution": _fields(solution), "history": told_of})
    return solution, told_of


def _figures(solution: ContactSolution, area: float, heights: dict[str, FloatArray]) -> dict[str, Any]:
    from bem.accuracy import figures_of

    figures: dict[str, Any] = {
        **figures_of(solution, area),
        "residual": float(solution.residual),
        "iterations": int(solution.iterations),
        "convolutions": float(solution.convolutions),
    }
    for name, values in heights.items():
        rough = bool(values.any())
        figures[f"{name}_height"] = values if rough else None
        figures[f"{name}_Sq"] = float(np.sqrt(np.mean((values - values.mean()) ** 2))) if rough else None
    return figures


_STRESSES = (
    *("max_von_mises", "max_von_mises_depth", "yielded_volume"),
    *("depth", "von_mises", "component", "stress"),
)


def _stresses(scene: ContactScene, pressure: FloatArray, context: Context) -> tuple[dict[str, Any], FloatArray]:
    """Von Mises at every depth, the six components where asked for, and the figures of both; the highest at each."""
    from bem.stress import subsurface_stress, von_mises, von_mises_planes

    grid, depths = build.grid_of(scene.grid), np.array(_depths(scene))
    below, friction = _stressed(scene)
    stress = subsurface_stress(pressure, grid, below, depths, friction=friction) if scene.outputs.stresses else None
    limits = _yield_stresses(below, depths)
    mises = context.scratch((len(depths), *grid.shape))
    highest, yielded = np.empty(len(depths)), np.empty(len(depths))
    planes: Any = (
        von_mises_planes(pressure, grid, below, depths, friction=friction, out=np.empty(grid.shape))
        if stress is None
        else (von_mises(stress[:, i]) for i in range(len(depths)))
    )
    for i, plane in enumerate(planes):
        mises[i] = plane
        highest[i] = plane.max()
        yielded[i] = np.count_nonzero(plane > limits[i]) * grid.cell_area
        release(mises)
        context.progress(i + 1, len(depths), "stresses")
    figures = {
        "max_von_mises": float(highest.max()),
        "max_von_mises_depth": float(depths[int(np.argmax(highest))]),
        "yielded_volume": float(np.trapezoid(yielded, depths)) if np.isfinite(limits).any() else None,
        "depth": depths,
        "von_mises": mises,
        "component": None if stress is None else list(_STRESS_COMPONENTS),
        "stress": stress,
    }
    return figures, highest


def _errors(
    scene: ContactScene,
    undeformed: FloatArray,
    solution: ContactSolution,
    highest: FloatArray | None,
    rough: bool,
    context: Context,
) -> Mapping[str, float | None]:
    """Error bars of the figures; where there are none the notes say why."""
    from bem.accuracy import ContactCase, contact_bars, solve_coarser, stress_bars
    from bem.convolution import displacement_operator

    grid, control = build.grid_of(scene.grid), scene.contact
    lower, upper = scene.lower.build(), scene.upper.build()
    case = ContactCase(
        displacement_operator(grid, lower if upper is None else (lower, upper), friction=control.friction),
        undeformed,
        solution,
        load=_load(scene, grid.area),
        approach=control.approach,
        mean_gap=control.mean_gap,
        hardness=control.hardness,
        from_touch=rough,
    )
    coarser = solve_coarser(case, control.max_iterations)
    bars = contact_bars(case, coarser)
    if highest is not None:
        below, friction = _stressed(scene)
        bars = bars | stress_bars(case, coarser, below, np.array(_depths(scene)), highest, friction)
    for note in bars.notes:
        context.note(note)
    return bars.values


def _stressed(scene: ContactScene) -> tuple[Body, float]:
    """The body whose stresses are wanted, and its friction: traction on the lower body acts along +x, on the upper one
    along -x; z points into the body itself."""
    if scene.outputs.body == "lower":
        return scene.lower.build(), scene.contact.friction
    upper = scene.upper.build()
    assert upper is not None
    return upper, -scene.contact.friction


def _yield_stresses(body: Body, depths: FloatArray) -> FloatArray:
    """The yield stress at each depth [Pa]; infinite where none is known."""
    here = (body.material_at(depth) for depth in depths.tolist())
    return np.array([np.inf if material.yield_stress is None else material.yield_stress for material in here])


def _contact_state(pressure: FloatArray, hardness: float | None) -> NDArray[np.int8]:
    state = (pressure > 0).astype(np.int8)
    if hardness is not None:
        state[pressure >= hardness] = 2
    return state


def _fields(solution: Any) -> dict[str, Any]:
    """The parts of a solution for the checkpoint, not copied."""
    fields = {field.name: getattr(solution, field.name) for field in dataclasses.fields(solution)}
    return fields | {"notes": list(solution.notes)}


def _wants_stresses(scene: ContactScene) -> bool:
    return scene.outputs.von_mises or scene.outputs.stresses


def _depths(scene: ContactScene) -> tuple[float, ...]:
    if not _wants_stresses(scene) or scene.outputs.depths is None:
        return ()
    return scene.outputs.depths.build()


def _load(scene: ContactScene, area: float) -> float | None:
    pressure = scene.contact.mean_pressure
    return scene.contact.load if pressure is None else pressure * area


def _control(scene: ContactScene) -> str:
    control = scene.contact
    if control.load is not None:
        return f"load {control.load:g} N"
    if control.mean_pressure is not None:
        return f"mean pressure {control.mean_pressure:g} Pa"
    if control.approach is not None:
        return f"approach {control.approach:g} m"
    return f"mean gap {control.mean_gap:g} m"


def volumes(scene: ContactScene) -> tuple[str, ...]:
    """Fields for ParaView."""
    if not scene.outputs.vtk or not _depths(scene):
        return ()
    return ("von_mises", "stress") if scene.outputs.stresses else ("von_mises",)


KIND = Kind(
    name="contact",
    title="two rough, possibly coated bodies pressed together: pressure, contact area, approach, stresses below",
    model=ContactScene,
    plan=plan,
    run=run,
    record=ContactRecord,
    volumes=volumes,
    resolve=resolve,
    figures=(
        "pressure-map",
        "contact-map",
        "contact-section",
        "pressure-histogram",
        "von-mises-section",
        "von-mises-depth",
        "convergence",
        "surface-maps",
    ),
    headline=(
        "load_N",
        "contact_area_fraction",
        "plastic_area_fraction",
        "mean_contact_pressure_Pa",
        "max_pressure_Pa",
        "approach_m",
        "max_von_mises_Pa",
        "residual",
    ),
)
