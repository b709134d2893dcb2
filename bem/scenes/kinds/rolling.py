"""Kind `rolling`: where pressed bodies stick and slip while they roll over each other, with creepage and spin."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.scenes import build
from bem.scenes.context import Context, tell
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, GridRecord, Series, filled
from bem.scenes.sticking import FIRST_ORDER, plan_around, pressed_together, stresses_under, tell_coupled
from bem.scenes.tables.tangential import RolledScene

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.tangential import TangentialSolution

_TRANSFORMS = 6.0 * 2.8
"""For each cell along the rolling: 2 to 3 convolutions were counted from 32 to 256 of them, each of four transforms and
vector passes."""


class RollingContactScene(RolledScene):
    """Two bodies, what presses them together and how they roll."""

    kind: Literal["rolling"] = "rolling"


def plan(scene: RollingContactScene) -> Plan:
    """What will be computed."""

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "rolling",
                f"steady along x, friction {scene.roll.friction:g}",
                transforms=_TRANSFORMS * max(grid.shape[0], 40),
                points=points,
                # directions that GMRES keeps, on the cells in contact
                memory=8.0 * points * 6 + 8.0 * grid.cells * 2 * 62,
                kept=8.0 * grid.cells * 10,
                seconds=0.2,
            ),
        )

    return plan_around(scene, steps)


_map = partial(Series, ("x", "y"))


@dataclass(frozen=True, eq=False, kw_only=True)
class RollingRecord(GridRecord):
    """A contact that rolls steadily."""

    x: Annotated[FloatArray, Series(("x",), "m", "x, along rolling")]
    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    force: Annotated[float, Figure("N", "force on the lower body along x", headline=True, no_bar=FIRST_ORDER)]
    force_across: Annotated[float, Figure("N", "force on the lower body along y", headline=True, no_bar=FIRST_ORDER)]
    traction_coefficient: Annotated[float, Figure("", "size of the force over load", headline=True, no_bar=FIRST_ORDER)]
    creepage: Annotated[float, Figure("", "creepage along x", headline=True, no_bar=FIRST_ORDER)]
    creepage_across: Annotated[float, Figure("", "creepage along y", no_bar=FIRST_ORDER)]
    stick_fraction: Annotated[float, Figure("", "share of the contact that sticks", headline=True, no_bar=FIRST_ORDER)]
    friction_work: Annotated[
        float, Figure("N", "energy of friction over the distance rolled, a drag", headline=True, no_bar=FIRST_ORDER)
    ]
    resolved_work: Annotated[float, Figure("", "share of it that the map of cells shows", unjudged=True)]
    max_von_mises: Annotated[
        float | None, Figure("Pa", "highest von Mises stress", optional=True, headline=True, no_bar=FIRST_ORDER)
    ] = None
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True, no_bar=FIRST_ORDER)] = None
    contact_residual: Annotated[float, Figure("", "relative residual of the contact")]
    slip_residual: Annotated[float, Figure("", "relative residual of slip and stick")]
    convolutions: Annotated[float, Figure("", "convolutions of the rolling")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure")]
    traction_x: Annotated[FloatArray, _map("Pa", "traction on the lower body along x")]
    traction_y: Annotated[FloatArray, _map("Pa", "traction on the lower body along y")]
    slip: Annotated[FloatArray, _map("1", "sliding over rolling velocity")]
    friction_energy: Annotated[FloatArray, _map("J/m^3", "energy of friction over area and distance rolled")]
    stick_state: Annotated[FloatArray, _map("1", "0 open, 1 sticks, 2 slips")]
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")] = None
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")] = None


def run(scene: RollingContactScene, context: Context) -> RollingRecord:
    """Solve the contact, then what sticks while it rolls."""
    from bem.tangential import solve_rolling

    grid = build.grid_of(scene.grid)
    _, contact = pressed_together(scene, grid, context)
    roll, bodies = scene.roll, build.bodies_of(scene)
    given: dict[str, Any] = {"creepage": (roll.creepage, roll.creepage_across)}
    if roll.share is not None:
        given = {"force": (roll.share * roll.friction * contact.load, 0.0)}
    with context.timer("rolling"):
        found = solve_rolling(
            contact, grid, bodies, friction=roll.friction, spin=roll.spin, tolerance=roll.tolerance, **given
        )
    tell(context, found.notes)
    tell_coupled(scene, context)
    return _record(scene, grid, contact, found, stresses_under(scene, grid, contact.pressure, found.traction, context))


def _record(
    scene: RollingContactScene, grid: Grid, contact: ContactSolution, found: TangentialSolution, extra: dict[str, Any]
) -> RollingRecord:
    slid = found.slip / grid.spacing[0]
    energy = -(found.traction * slid).sum(axis=0)
    touching, area = contact.pressure > 0, found.stick_area + found.slip_area
    size, work = float(np.hypot(*found.force)), found.dissipated_energy / grid.spacing[0]
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    return filled(
        RollingRecord,
        grid,
        extra,
        load=contact.load,
        contact_area_fraction=contact.contact_area / grid.area,
        force=float(found.force[0]),
        force_across=float(found.force[1]),
        traction_coefficient=size / contact.load if contact.load > 0 else 0.0,
        creepage=float(found.creepage[0]),
        creepage_across=float(found.creepage[1]),
        stick_fraction=found.stick_area / area if area > 0 else 1.0,
        friction_work=work,
        resolved_work=float(energy.sum()) * grid.cell_area / work if work > 0 else 1.0,
        contact_residual=contact.residual,
        slip_residual=found.residual,
        convolutions=found.convolutions,
        pressure=contact.pressure,
        traction_x=found.traction[0],
        traction_y=found.traction[1],
        slip=np.hypot(*slid),
        friction_energy=energy,
        stick_state=np.where(touching, np.where(found.slip.any(axis=0), 2.0, 1.0), 0.0),
        status=status,
        where=f"contact: {contact.status.message}; rolling: {found.status.message}, residual {found.residual:.1e}",
    )


KIND = Kind.of(
    vars(),
    RollingContactScene,
    RollingRecord,
    "pressed bodies that roll over each other with creepage and spin: stick and slip, traction, energy of friction",
    resolve=RollingContactScene.resolved,
    figures=("creep-curve", "slip-map", "traction-section", "pressure-map", "von-mises-section", "von-mises-depth"),
)
