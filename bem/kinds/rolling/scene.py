"""Kind `rolling`: where pressed bodies stick and slip while they roll over each other, with creepage and spin."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.scenes import build, sticking
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Series, filled, grid_map
from bem.scenes.resolutions import CELLS, DEPTHS
from bem.scenes.sticking import Coarse, Found, Site, StickRecord
from bem.scenes.tables.tangential import RolledScene

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.stress import StressSummary
    from bem.tangential import TangentialSolution

_TRANSFORMS = 6.0 * 2.8
"""For each cell along the rolling: 2 to 3 convolutions were counted from 32 to 256 of them, each of four transforms and
vector passes."""


class RollingContactScene(RolledScene):
    """Two bodies, what presses them together and how they roll."""

    kind: Literal["rolling"] = key("Kind of computation.", "basic", default="rolling")


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
                seconds=0.05,
            ),
        )

    return sticking.plan_around(scene, steps, 0.5)


@dataclass(frozen=True, eq=False, kw_only=True)
class RollingRecord(StickRecord):
    """A contact that rolls steadily."""

    x: Annotated[FloatArray, Series(("x",), "m", "x, along rolling")]
    force: Annotated[float, Figure("N", "force on the lower body along x", headline=True)]
    force_across: Annotated[float, Figure("N", "force on the lower body along y", headline=True)]
    traction_coefficient: Annotated[float, Figure("", "size of the force over load", headline=True)]
    creepage: Annotated[float, Figure("", "creepage along x", headline=True)]
    creepage_across: Annotated[float, Figure("", "creepage along y")]
    stick_fraction: Annotated[float, Figure("", "share of the contact that sticks", headline=True)]
    friction_work: Annotated[float, Figure("N", "energy of friction over the distance rolled, a drag", headline=True)]
    resolved_work: Annotated[float, Figure("", "share of it that the map of cells shows", unjudged=True)]
    max_von_mises: Annotated[float | None, Figure("Pa", "highest von Mises stress", optional=True, headline=True)] = (
        None
    )
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True)] = None
    slip_residual: Annotated[float, Figure("", "relative residual of slip and stick", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of the rolling", unjudged=True)]
    slip: Annotated[FloatArray, grid_map("1", "sliding over rolling velocity")]
    friction_energy: Annotated[FloatArray, grid_map("J/m^3", "energy of friction over area and distance rolled")]


def run(scene: RollingContactScene, context: Context) -> RollingRecord:
    """Solve the contact, then what sticks while it rolls."""
    site = sticking.pressed_together(scene, context)
    with context.timer("rolling"):
        found = _rolled(scene, site)
    tell(context, found.notes)
    sticking.tell_coupled(scene, context)
    below = sticking.stresses_under(scene, site.grid, site.contact.pressure, found.traction, context)
    wanted = scene.outputs.errors and Status.CONVERGED is site.contact.status is found.status
    errors = error_bars(context, wanted, lambda: _bars(scene, site, found, below))
    return _record(site, found, _figures(site, found, scene.roll.spin) | sticking.stress_figures(below), errors)


def _rolled(scene: RollingContactScene, site: Site) -> TangentialSolution:
    from bem.tangential import solve_rolling

    roll = scene.roll
    carried = site.carried(roll.spin)
    given: dict[str, Any] = {"creepage": (roll.creepage + carried[0], roll.creepage_across + carried[1])}
    if roll.share is not None:
        given = {"force": (roll.share * roll.friction * site.contact.load, 0.0)}
    asked: dict[str, Any] = {"friction": roll.friction, "spin": roll.spin, "tolerance": roll.tolerance}
    return solve_rolling(site.contact, site.grid, build.bodies_of(scene), **given, **asked)


def _figures(site: Site, found: TangentialSolution, spin: float) -> dict[str, float]:
    """Those that have error bars, SI units; `spin` [1/m] of the rolling."""
    load, area = site.contact.load, found.stick_area + found.slip_area
    creepage = found.creepage - site.carried(spin)
    return {
        "force": float(found.force[0]),
        "force_across": float(found.force[1]),
        "traction_coefficient": float(np.hypot(*found.force)) / load if load > 0 else 0.0,
        "creepage": float(creepage[0]),
        "creepage_across": float(creepage[1]),
        "stick_fraction": found.stick_area / area if area > 0 else 1.0,
        "friction_work": found.dissipated_energy / site.grid.spacing[0],
    }


def _bars(scene: RollingContactScene, site: Site, found: TangentialSolution, below: StressSummary | None) -> ErrorBars:
    """From the same on the grid of twice the cell."""
    from bem.accuracy.sticking import ROLL_RULES

    def again(coarser: Site) -> Coarse:
        rolled = _rolled(scene, coarser)
        figures, converged = _figures(coarser, rolled, scene.roll.spin), rolled.status is Status.CONVERGED
        return Coarse(figures, coarser.contact, rolled.traction, converged)

    given = ("creepage", "creepage_across") if scene.roll.share is None else ("force", "force_across")
    residual = max(site.contact.residual, found.residual)
    limit = scene.roll.friction * site.contact.load
    figures = _figures(site, found, scene.roll.spin)
    return sticking.bars(scene, site, Found(figures, site.contact, ROLL_RULES, given, residual, limit, below), again)


def _record(site: Site, found: TangentialSolution, extra: dict[str, Any], errors: dict[str, Any]) -> RollingRecord:
    grid, contact = site.grid, site.contact
    slid = found.slip / grid.spacing[0]
    energy = -(found.traction * slid).sum(axis=0)
    work = found.dissipated_energy / grid.spacing[0]
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    return filled(
        RollingRecord,
        grid,
        sticking.stuck(grid, contact, found),
        extra,
        resolved_work=float(energy.sum()) * grid.cell_area / work if work > 0 else 1.0,
        slip_residual=found.residual,
        convolutions=found.convolutions,
        slip=np.hypot(*slid),
        friction_energy=energy,
        **errors,
        status=status,
        where=f"contact: {contact.status.message}; rolling: {found.status.message}, residual {found.residual:.1e}",
    )


KIND = Kind.of(
    vars(),
    RollingContactScene,
    RollingRecord,
    "pressed bodies that roll over each other with creepage and spin: stick and slip, traction, energy of friction",
    resolutions=(CELLS, DEPTHS),
    figures=("creep-curve", "slip-map", "traction-section", "pressure-map", "von-mises-section", "von-mises-depth"),
)
