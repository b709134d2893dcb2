"""Kind `surface-temperature`: how hot rubbing makes the surfaces of two bodies in contact, rough or smooth."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.scenes import build, plans
from bem.scenes.common import Table
from bem.scenes.context import Context
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.records import Figure, GridRecord, Series
from bem.scenes.tables.pressing import PressedScene
from bem.scenes.units import Speed, Temperature

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.heat import TemperatureSolution

BulkTemperature = Annotated[Temperature, Field(ge=150, le=2000)]
ROOM = 293.15


class RubbingHeatScene(Table):
    """Speeds of the surfaces over the contact, along x, and temperatures far below them."""

    lower_speed: Speed
    upper_speed: Speed = 0.0
    lower_bulk: BulkTemperature = ROOM
    upper_bulk: BulkTemperature = ROOM


class SurfaceTemperatureScene(PressedScene):
    """A contact whose friction makes heat; all of it enters the lower body where the upper one has no material."""

    kind: Literal["surface-temperature"] = "surface-temperature"
    heat: RubbingHeatScene


def plan(scene: SurfaceTemperatureScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area.
    InputError : surfaces that cannot be generated on the grid, materials without thermal constants, layers, a grid on
        which no steady temperature exists.
    """
    from bem.heat.bodies import check_steady, conductors_of

    grid = build.grid_of(scene.grid)
    scene.contact.check_load(grid.area)
    rubbing = plans.of_bodies(scene, grid, scene.contact.friction)
    lower, upper = scene.lower.build(), scene.upper.build()
    bodies, speeds, bulk = _pair(scene, lower, upper)
    check_steady(grid, conductors_of("heat", bodies, speeds, bulk))
    points = padded_points(grid.shape, grid.periodic)
    return Plan(
        (
            *rubbing,
            plans.contact(grid, f"{scene.contact.behaviour}"),
            Step(
                "surface temperature",
                "heat of friction, shared between the bodies" if upper else "all heat enters the lower body",
                transforms=200.0,  # some forty products of both bodies, and two kernels
                points=points,
                memory=8.0 * points * 8 + 8.0 * grid.cells * 30,
                kept=8.0 * grid.cells * 8,
                seconds=0.5,
            ),
            plans.figures(grid.cells),
        )
    )


def _map(unit: str, text: str) -> Series:
    return Series(("x", "y"), unit, text)


@dataclass(frozen=True, eq=False)
class SurfaceTemperatureRecord(GridRecord):
    """Temperatures of a rubbing contact."""

    maximum_temperature: Annotated[float, Figure("C", "highest surface temperature", headline=True)]
    mean_temperature: Annotated[float, Figure("C", "mean temperature of the contact, by heat", headline=True)]
    maximum_rise: Annotated[float, Figure("K", "highest temperature over the hotter bulk", headline=True)]
    share_of_lower: Annotated[float, Figure("", "share of the heat that enters the lower body", headline=True)]
    friction_power: Annotated[float, Figure("W", "heat made by friction")]
    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area")]
    contact_residual: Annotated[float, Figure("", "relative residual of the contact")]
    temperature_residual: Annotated[float, Figure("", "difference of both surfaces over the largest rise")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure")]
    surface_temperature: Annotated[FloatArray, _map("K", "surface temperature, of the lower body out of contact")]
    heat_lower: Annotated[FloatArray, _map("W/m^2", "heat into the lower body")]
    heat_made: Annotated[FloatArray, _map("W/m^2", "heat made by friction")]


def run(scene: SurfaceTemperatureScene, context: Context) -> SurfaceTemperatureRecord:
    """Solve the contact, then the temperature of its surfaces; both again on cells of twice the side for error bars."""
    grid = build.grid_of(scene.grid)
    with context.timer("surfaces"):
        lower, upper = build.both_heights(scene, grid, context)
    gap = build.undeformed_gap(scene, grid, lower, upper)
    contact, found = _solve(scene, grid, gap, context)
    for note in (*contact.notes, *found.notes):
        context.note(note)
    figures = _figures(scene, grid, contact, found)
    errors: Mapping[str, float | None] = {}
    if any(n % 2 for n in grid.shape):
        context.note("grid.shape: no error bars, which need even numbers of cells along x and y")
    else:
        coarse = Grid(
            (grid.shape[0] // 2, grid.shape[1] // 2),
            (2 * grid.spacing[0], 2 * grid.spacing[1]),
            periodic=grid.periodic,
        )
        blocks = gap.reshape(coarse.shape[0], 2, coarse.shape[1], 2).mean(axis=(1, 3))
        other = _figures(scene, coarse, *_solve(scene, coarse, blocks, context))
        errors = {name: abs(other[name] - value) for name, value in figures.items()}
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    return SurfaceTemperatureRecord(
        **figures,
        load=contact.load,
        contact_residual=contact.residual,
        temperature_residual=found.residual,
        x=grid.x,
        y=grid.y,
        pressure=contact.pressure,
        surface_temperature=found.temperature,
        heat_lower=found.heat[0],
        heat_made=found.heat.sum(axis=0),
        errors=errors,
        status=status,
        where="" if status is Status.CONVERGED else f"contact: {contact.status}, temperature: {found.status}",
    )


def _solve(
    scene: SurfaceTemperatureScene, grid: Grid, gap: FloatArray, context: Context
) -> tuple[ContactSolution, TemperatureSolution]:
    from bem.contact import solve_contact
    from bem.heat import flash_temperature

    lower, upper = scene.lower.build(), scene.upper.build()
    control = scene.contact
    with context.timer("contact"):
        contact = solve_contact(
            gap,
            build.operator_of(scene, grid, control.friction),
            **control.prescribed(grid.area),
            **control.accuracy(),
        )
    bodies, _, bulk = _pair(scene, lower, upper)
    speeds = (scene.heat.lower_speed, scene.heat.upper_speed)
    with context.timer("temperature"):
        return contact, flash_temperature(
            contact.pressure,
            grid,
            bodies if upper else lower,
            friction=control.friction,
            speeds=speeds,
            bulk=bulk,
        )


def _pair(
    scene: SurfaceTemperatureScene, lower: Body, upper: Body | None
) -> tuple[tuple[Body, ...], tuple[float, ...], tuple[float, ...]]:
    """Bodies with their speeds and bulk temperatures."""
    heat = scene.heat
    if upper is None:
        return (lower,), (heat.lower_speed,), (heat.lower_bulk,)
    return (lower, upper), (heat.lower_speed, heat.upper_speed), (heat.lower_bulk, heat.upper_bulk)


def _figures(
    scene: SurfaceTemperatureScene, grid: Grid, contact: ContactSolution, found: TemperatureSolution
) -> dict[str, Any]:
    hottest = max(_pair(scene, scene.lower.build(), scene.upper.build())[2])
    return {
        "maximum_temperature": found.maximum,
        "mean_temperature": found.mean,
        "maximum_rise": found.maximum - hottest,
        "share_of_lower": found.share if math.isfinite(found.share) else 0.5,
        "friction_power": float(found.heat.sum() * grid.cell_area),
        "contact_area_fraction": contact.contact_area / grid.area,
        "mean_contact_pressure": contact.load / contact.contact_area if contact.contact_area else 0.0,
    }


KIND = Kind(
    name="surface-temperature",
    title="heat of friction in a rough or smooth contact: surface temperature, its share between the bodies",
    model=SurfaceTemperatureScene,
    plan=plan,
    run=run,
    record=SurfaceTemperatureRecord,
    resolve=SurfaceTemperatureScene.resolved,
    figures=("temperature-map", "temperature-section", "pressure-map"),
)
