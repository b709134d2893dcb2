"""Kind `surface-temperature`: how hot rubbing makes the surfaces of two bodies in contact, rough or smooth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from bem.errors import Status
from bem.grid import FloatArray
from bem.scenes import build, plans
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.records import Figure, GridRecord, filled, grid_map
from bem.scenes.resolutions import CELLS
from bem.scenes.tables.heat import RubbingScene


class SurfaceTemperatureScene(RubbingScene):
    """Two bodies, a load, and speeds."""

    kind: Literal["surface-temperature"] = key("Kind of computation.", "basic", default="surface-temperature")


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
    case = scene.case(grid)
    check_steady(grid, conductors_of("heat", case.bodies, case.speeds[: len(case.bulk)], case.bulk))
    points = padded_points(grid.shape, grid.periodic)
    pair = len(case.bulk) == 2
    return Plan.of(
        *rubbing,
        plans.contact(grid, scene.contact.behaviour, capped=scene.contact.behaviour == "capped"),
        Step(
            "surface temperature",
            "heat of friction, shared between the bodies" if pair else "all heat enters the lower body",
            transforms=200.0,  # some forty products of both bodies, and two kernels
            points=points,
            memory=8.0 * points * 8 + 8.0 * grid.cells * 30,
            kept=8.0 * grid.cells * 8,
            seconds=0.1,
        ),
        plans.figures(grid.cells),
    )


@dataclass(frozen=True, eq=False)
class SurfaceTemperatureRecord(GridRecord):
    """Temperatures of a rubbing contact."""

    maximum_temperature: Annotated[
        float, Figure("C", "highest surface temperature", headline=True, part_of=("maximum_rise",))
    ]
    mean_temperature: Annotated[
        float, Figure("C", "mean temperature of the contact, by heat", headline=True, part_of=("maximum_rise",))
    ]
    maximum_rise: Annotated[float, Figure("K", "highest temperature over the hotter bulk", headline=True)]
    share_of_lower: Annotated[float, Figure("", "share of the heat that enters the lower body", headline=True)]
    friction_power: Annotated[float, Figure("W", "heat made by friction")]
    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area")]
    contact_residual: Annotated[float, Figure("", "relative residual of the contact", unjudged=True)]
    temperature_residual: Annotated[
        float, Figure("", "difference of both surfaces over the largest rise", unjudged=True)
    ]
    pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure")]
    surface_temperature: Annotated[FloatArray, grid_map("K", "surface temperature, of the lower body out of contact")]
    heat_lower: Annotated[FloatArray, grid_map("W/m^2", "heat into the lower body")]
    heat_made: Annotated[FloatArray, grid_map("W/m^2", "heat made by friction")]


def run(scene: SurfaceTemperatureScene, context: Context) -> SurfaceTemperatureRecord:
    """Solve the contact, then the temperature of its surfaces."""
    from bem.accuracy import rubbing_bars

    grid = build.grid_of(scene.grid)
    gap = build.undeformed_gap(scene, grid, *build.both_heights(scene, grid, context))
    case = scene.case(grid)
    with context.timer("contact"):
        contact = case.contact(grid, gap)
    with context.timer("temperature"):
        found = case.temperature(grid, contact)
    tell(context, (*contact.notes, *found.notes))
    figures = case.figures(grid, contact, found)
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    wanted = status is Status.CONVERGED
    return filled(
        SurfaceTemperatureRecord,
        figures,
        grid,
        load=contact.load,
        contact_residual=contact.residual,
        temperature_residual=found.residual,
        pressure=contact.pressure,
        surface_temperature=found.temperature,
        heat_lower=found.heat[0],
        heat_made=found.heat.sum(axis=0),
        **error_bars(context, wanted, lambda: rubbing_bars(case, grid, gap, (contact, found))),
        status=status,
        where=f"contact: {contact.status}, temperature: {found.status}",
    )


KIND = Kind.of(
    vars(),
    SurfaceTemperatureScene,
    SurfaceTemperatureRecord,
    "heat of friction in a rough or smooth contact: surface temperature, its share between the bodies",
    resolutions=(CELLS,),
    figures=("temperature-map", "temperature-section", "pressure-map"),
)
