"""Plan of a case of kind `surface-temperature`."""

from __future__ import annotations

from bem.kinds.surface_temperature.scene import SurfaceTemperatureScene
from bem.scenes import build, plans
from bem.scenes.planner import Plan, Step, padded_points


def plan(scene: SurfaceTemperatureScene) -> Plan:
    """Plan the computation of one case.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area.
    InputError : surfaces that cannot be generated on the grid, materials without thermal constants, a grid on
        which no steady temperature exists.
    """
    from bem.heat.bodies import check_steady, conductors_of

    grid = build.grid_of(scene.grid)
    scene.contact.check_load(grid.area)
    rubbing = plans.of_bodies(scene, grid, scene.contact.friction)
    case = scene.case(grid)
    check_steady(grid, conductors_of("heat", case.bodies, case.speeds[: len(case.bulk)], case.bulk, layered=True))
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
