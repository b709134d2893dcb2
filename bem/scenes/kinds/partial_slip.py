"""Kind `partial-slip`: where pressed bodies stick and slip while they are pushed along, once or there and back."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.kind import Kind
from bem.scenes.packing import keep, kept
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, GridRecord, Series, filled
from bem.scenes.sticking import (
    FIRST_ORDER,
    coupled,
    plan_around,
    pressed_together,
    stresses_under,
    tell_coupled,
)
from bem.scenes.tables.tangential import PushedScene

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.tangential import TangentialSolution

_TRANSFORMS = 6.0 * 60
"""Of a step: 40 to 60 convolutions were counted on 256 to 1024 cells a side, in every step of a history alike, each of
four transforms and vector passes worth two more."""

PRESSING_STEPS = 16
"""Of bodies that differ: the stick radius of a ball is then 4 % small, of first order in the steps (Spence, tests)."""


class PartialSlipScene(PushedScene):
    """Two bodies, what presses them together and what pushes them along."""

    kind: Literal["partial-slip"] = "partial-slip"


def plan(scene: PartialSlipScene) -> Plan:
    """What will be computed."""
    count, pressing = len(scene.push.path()), _pressing_steps(scene)

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "pressing in steps",
                f"{pressing} contacts: pressure alone makes bodies that differ slip"
                if pressing > 1
                else "pressure does not make these bodies slip, or push.pressing_steps is 1",
                skipped=pressing == 1,
                transforms=(40.0 + _TRANSFORMS) * (pressing - 1),
                points=points,
            ),
            Step(
                "partial slip",
                f"{count} steps along x, friction {scene.push.friction:g}",
                transforms=_TRANSFORMS * count,
                points=points,
                memory=8.0 * points * 6 + 8.0 * grid.cells * 40,
                kept=8.0 * grid.cells * 10,
                seconds=0.2,
            ),
            Step(
                "stiffness",
                "normal and tangential, of the contact as a whole, before anything slips",
                skipped=not scene.outputs.stiffness,
                transforms=80.0 + 2 * _TRANSFORMS,
                points=points,
            ),
        )

    return plan_around(scene, steps)


_map = partial(Series, ("x", "y"))
_step = partial(Series, ("step",))
_asked = partial(Figure, optional=True, headline=True, no_bar=FIRST_ORDER)


@dataclass(frozen=True, eq=False, kw_only=True)
class PartialSlipRecord(GridRecord):
    """A contact that was pushed along."""

    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    force: Annotated[float, Figure("N", "tangential force at the end", headline=True, no_bar=FIRST_ORDER)]
    shift: Annotated[float, Figure("m", "shift at the end", headline=True, no_bar=FIRST_ORDER)]
    stick_fraction: Annotated[
        float, Figure("", "share of the contact that sticks at the end", headline=True, no_bar=FIRST_ORDER)
    ]
    first_stiffness: Annotated[
        float, Figure("N_m", "force over shift of the first step", headline=True, no_bar=FIRST_ORDER)
    ]
    dissipated: Annotated[float, Figure("J", "energy of friction in all steps", headline=True, no_bar=FIRST_ORDER)]
    dissipated_in_cycle: Annotated[
        float | None,
        Figure("J", "energy of friction in the last cycle", optional=True, headline=True, no_bar=FIRST_ORDER),
    ] = None
    normal_stiffness: Annotated[
        float | None, Figure("N_m", "normal stiffness of the contact", optional=True, headline=True, no_bar=FIRST_ORDER)
    ] = None
    tangential_stiffness: Annotated[
        float | None,
        Figure("N_m", "tangential stiffness before slip", optional=True, headline=True, no_bar=FIRST_ORDER),
    ] = None
    max_von_mises: Annotated[
        float | None,
        Figure("Pa", "highest von Mises stress at the end", optional=True, headline=True, no_bar=FIRST_ORDER),
    ] = None
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True, no_bar=FIRST_ORDER)] = None
    contact_residual: Annotated[float, Figure("", "relative residual of the contact")]
    slip_residual: Annotated[float, Figure("", "largest relative residual of the steps")]
    convolutions: Annotated[float, Figure("", "convolutions of all steps")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure")]
    traction_x: Annotated[FloatArray, _map("Pa", "traction on the lower body along x, at the end")]
    traction_y: Annotated[FloatArray, _map("Pa", "traction on the lower body along y, at the end")]
    slip: Annotated[FloatArray, _map("m", "distance slid in all steps")]
    friction_energy: Annotated[FloatArray, _map("J/m^2", "energy of friction in all steps")]
    stick_state: Annotated[FloatArray, _map("1", "0 open, 1 sticks, 2 slips in the last step")]
    step: Annotated[FloatArray, _step("1", "step")]
    step_force: Annotated[FloatArray, _step("N", "tangential force")]
    step_shift: Annotated[FloatArray, _step("m", "shift")]
    step_stick_fraction: Annotated[FloatArray, _step("1", "share of the contact that sticks")]
    step_dissipated: Annotated[FloatArray, _step("J", "energy of friction in the step")]
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")] = None
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")] = None


@dataclass(frozen=True, eq=False)
class _Path:
    """What came of the steps so far: `steps` (steps, 5), force, shift, share that sticks, energy, residual; `sums`
    (2, nx, ny), distance slid and energy by area.
    """

    last: TangentialSolution | None
    steps: FloatArray
    sums: FloatArray
    convolutions: float
    status: Status


def run(scene: PartialSlipScene, context: Context) -> PartialSlipRecord:
    """Solve the contact, then step after step."""
    grid = build.grid_of(scene.grid)
    gap, contact = pressed_together(scene, grid, context)
    with context.timer("partial slip"):
        path = kept(context) or _pressed(scene, grid, gap, contact)
        path = _pushed(scene, grid, contact, path, context)
    tell_coupled(scene, context)
    if coupled(scene):
        steps = _pressing_steps(scene)
        context.note(
            f"pressure alone makes bodies that differ slip: the load comes in {steps} steps, and what sticks is known "
            f"to about 1/{steps} of it; take twice push.pressing_steps to see"
            if steps > 1
            else "the whole load comes at once, while surfaces that differ slip as it grows: far too little sticks; "
            f"leave push.pressing_steps out ({PRESSING_STEPS}) or raise it"
        )
    extra: dict[str, Any] = {}
    if scene.outputs.stiffness:
        with context.timer("stiffness"):
            extra |= _stiffness(scene, grid, gap, contact, context)
    assert path.last is not None
    extra |= stresses_under(scene, grid, contact.pressure, path.last.traction, context)
    return _record(scene, grid, contact, path, extra)


_PROBE = 1e-3
"""Of the approach from first touch, or of the range of gaps: how far the bodies are moved for the normal stiffness."""


def _stiffness(
    scene: PartialSlipScene, grid: Grid, gap: FloatArray, contact: ContactSolution, context: Context
) -> dict[str, float]:
    """Of the contact as a whole [N/m]: load over approach, by its difference, and force over shift where all sticks."""
    from bem.contact import solve_contact
    from bem.tangential import tangential_stiffness

    if not contact.load > 0:
        return {"normal_stiffness": 0.0, "tangential_stiffness": 0.0}
    asked = scene.contact.accuracy() | {"hardness": scene.contact.hardness, "initial_pressure": contact.pressure}
    operator = build.operator_of(scene, grid, 0.0)
    step = _PROBE * max(abs(contact.approach), float(np.ptp(contact.gap)))
    near = [solve_contact(gap, operator, approach=contact.approach + sign * step, **asked) for sign in (-1.0, 1.0)]
    for found in near:
        if found.status is not Status.CONVERGED:
            context.note(f"normal stiffness: {found.status.message}, residual {found.residual:.1e}")
    stuck = tangential_stiffness(contact, grid, build.bodies_of(scene), tolerance=scene.push.tolerance)
    return {
        "normal_stiffness": (near[1].load - near[0].load) / (2 * step),
        "tangential_stiffness": float(stuck[0, 0]),
    }


def _pressing_steps(scene: PartialSlipScene) -> int:
    given = scene.push.pressing_steps
    return given if given is not None else PRESSING_STEPS if coupled(scene) else 1


def _pressed(scene: PartialSlipScene, grid: Grid, gap: FloatArray, contact: ContactSolution) -> _Path:
    """What pressure alone does, in steps in which the contact's size grows evenly: a ball's load like its cube."""
    from bem.contact import solve_contact
    from bem.tangential import solve_partial_slip

    path = _Path(None, np.zeros((0, 5)), np.zeros((2, *grid.shape)), 0.0, Status.CONVERGED)
    steps = _pressing_steps(scene)
    if steps == 1 or not contact.load > 0:
        return path
    bodies, operator = build.bodies_of(scene), build.operator_of(scene, grid, 0.0)
    power = 1 + sum(math.isfinite(radius) for radius in scene.shape.radii)
    asked: dict[str, Any] = {"friction": scene.push.friction, "force": (0.0, 0.0), "tolerance": scene.push.tolerance}
    for number in range(1, steps + 1):
        part = contact
        if number < steps:
            load = contact.load * (number / steps) ** power
            part = solve_contact(gap, operator, load=load, hardness=scene.contact.hardness, **scene.contact.accuracy())
        found = solve_partial_slip(part, grid, bodies, previous=path.last, **asked)
        met = part.status if part.status is not Status.CONVERGED else found.status
        status = path.status if path.status is not Status.CONVERGED else met
        path = replace(path, last=found, convolutions=path.convolutions + found.convolutions, status=status)
    return path


def _pushed(scene: PartialSlipScene, grid: Grid, contact: ContactSolution, path: _Path, context: Context) -> _Path:
    """All steps, going on from the last one that was kept."""
    from bem.tangential import solve_partial_slip

    push = scene.push
    wanted = push.path() * push.peak * (push.friction * contact.load if push.share is not None else 1.0)
    name = "shift" if push.shift is not None else "force"
    bodies = build.bodies_of(scene)
    asked: dict[str, Any] = {"friction": push.friction, "tolerance": push.tolerance}
    for number in range(len(path.steps), len(wanted)):
        asked[name] = (float(wanted[number]), 0.0)
        found = solve_partial_slip(contact, grid, bodies, previous=path.last, **asked)
        path = _after(path, found)
        keep(context, path)
        context.progress(number + 1, len(wanted), "steps", residual=found.residual)
    return path


def _after(path: _Path, found: TangentialSolution) -> _Path:
    """With one step more."""
    area = found.stick_area + found.slip_area
    row = [
        found.force[0],
        found.shift[0],
        found.stick_area / area if area > 0 else 1.0,
        found.dissipated_energy,
        found.residual,
    ]
    slid = np.stack([np.hypot(*found.slip), -(found.traction * found.slip).sum(axis=0)])
    worse = found.status if path.status is Status.CONVERGED else path.status
    return _Path(
        found, np.concatenate([path.steps, [row]]), path.sums + slid, path.convolutions + found.convolutions, worse
    )


def _record(
    scene: PartialSlipScene, grid: Grid, contact: ContactSolution, path: _Path, extra: dict[str, Any]
) -> PartialSlipRecord:
    last = path.last
    assert last is not None
    force, shift, sticks, energy, residual = path.steps.T
    state = np.where(contact.pressure > 0, np.where(last.slip.any(axis=0), 2.0, 1.0), 0.0)
    in_cycle = 4 * scene.push.steps
    status = contact.status if contact.status is not Status.CONVERGED else path.status
    return filled(
        PartialSlipRecord,
        grid,
        extra,
        load=contact.load,
        contact_area_fraction=contact.contact_area / grid.area,
        force=float(force[-1]),
        shift=float(shift[-1]),
        stick_fraction=float(sticks[-1]),
        first_stiffness=float(force[0] / shift[0]) if shift[0] else math.nan,
        dissipated=float(energy.sum()),
        dissipated_in_cycle=float(energy[-in_cycle:].sum()) if scene.push.cycles else None,
        contact_residual=contact.residual,
        slip_residual=float(residual.max()),
        convolutions=path.convolutions,
        pressure=contact.pressure,
        traction_x=last.traction[0],
        traction_y=last.traction[1],
        slip=path.sums[0],
        friction_energy=path.sums[1],
        stick_state=state,
        step=np.arange(1.0, len(force) + 1),
        step_force=force,
        step_shift=shift,
        step_stick_fraction=sticks,
        step_dissipated=energy,
        status=status,
        where=f"contact: {contact.status.message}; partial slip: {path.status.message}",
    )


KIND = Kind.of(
    vars(),
    PartialSlipScene,
    PartialSlipRecord,
    "pressed bodies pushed along, once or there and back: where they stick and slip, loop, energy of friction",
    resolve=PartialSlipScene.resolved,
    figures=(
        "contact-stiffness",
        "slip-map",
        "traction-section",
        "slip-loop",
        "pressure-map",
        "von-mises-section",
        "von-mises-depth",
    ),
)
