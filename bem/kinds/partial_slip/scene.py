"""Kind `partial-slip`: where pressed bodies stick and slip while they are pushed along, once or there and back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.errors import InfeasibleError, Status
from bem.grid import FloatArray, Grid
from bem.kinds.partial_slip.pushing import PRESSING_STEPS, Path, answers, figures_of, pressed, pressing_steps, pushed
from bem.notes import Note
from bem.notes.contact import PRESSING_PATH
from bem.notes.scenes import JOINT_CLOSED, PART_UNSOLVED
from bem.scenes import build, sticking
from bem.scenes.context import Context, error_bars
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.packing import keep, kept
from bem.scenes.planner import SEARCHED_IN_SINGLE, Plan, Step
from bem.scenes.records import Figure, Series, filled, grid_map
from bem.scenes.resolutions import CELLS, DEPTHS
from bem.scenes.sticking import Coarse, Found, Site, StickRecord
from bem.scenes.tables.tangential import PushedScene

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.stress import StressSummary

_TRANSFORMS = 6.0 * 22
"""Of a step: 15 to 23 convolutions were counted on 128 to 512 cells a side, first steps and later ones alike, each of
four transforms and vector passes worth two more."""
_ANSWERED = 4.0
"""Times as much where the pressure follows the tractions: six to nine rounds, each from the one before."""


class PartialSlipScene(PushedScene):
    """Two bodies, what presses them together and what pushes them along."""

    kind: Literal["partial-slip"] = key("Kind of computation.", "basic", default="partial-slip")


def plan(scene: PartialSlipScene) -> Plan:
    """What will be computed."""
    count, pressing = len(scene.push.path()), pressing_steps(scene)
    each = _TRANSFORMS * (_ANSWERED if answers(scene) else 1.0)

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "pressing in steps",
                f"{pressing} contacts: pressure alone makes bodies that differ slip"
                if pressing > 1
                else "pressure does not make these bodies slip, or push.pressing_steps is 1",
                skipped=pressing == 1,
                transforms=(40.0 + each) * (pressing - 1),
                points=points,
                precision=SEARCHED_IN_SINGLE,
            ),
            Step(
                "partial slip",
                f"{count} steps along x, friction {scene.push.friction:g}"
                + (", the pressure follows the tractions" if answers(scene) else ""),
                transforms=each * count,
                points=points,
                memory=8.0 * points * 6 + 8.0 * grid.cells * 40,
                kept=8.0 * grid.cells * 10,
                seconds=0.05 + 0.04 * count,
                precision=SEARCHED_IN_SINGLE if answers(scene) else "",
            ),
            Step(
                "stiffness",
                "normal and tangential, of the contact as a whole, before anything slips",
                skipped=not scene.outputs.stiffness,
                transforms=80.0 + 2 * _TRANSFORMS,
                points=points,
            ),
        )

    return sticking.plan_around(scene, steps, 1.0 if pressing == 1 else 1.5)


_step = partial(Series, ("step",))


@dataclass(frozen=True, eq=False, kw_only=True)
class PartialSlipRecord(StickRecord):
    """A contact that was pushed along."""

    force: Annotated[float, Figure("N", "tangential force at the end", headline=True)]
    shift: Annotated[float, Figure("m", "shift at the end", headline=True)]
    stick_fraction: Annotated[float, Figure("", "share of the contact that sticks at the end", headline=True)]
    first_stiffness: Annotated[float, Figure("N_m", "force over shift of the first step", headline=True)]
    dissipated: Annotated[float, Figure("J", "energy of friction in all steps", headline=True)]
    dissipated_in_cycle: Annotated[
        float | None,
        Figure("J", "energy of friction in the last cycle", optional=True, headline=True),
    ] = None
    normal_stiffness: Annotated[
        float | None, Figure("N_m", "normal stiffness of the contact", optional=True, headline=True)
    ] = None
    tangential_stiffness: Annotated[
        float | None,
        Figure("N_m", "tangential stiffness before slip", optional=True, headline=True),
    ] = None
    max_von_mises: Annotated[
        float | None,
        Figure("Pa", "highest von Mises stress at the end", optional=True, headline=True),
    ] = None
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True)] = None
    counted_stick_fraction: Annotated[float, Figure("", "cells that stick over cells in contact", unjudged=True)]
    moment: Annotated[
        float | None, Figure("Nm", "moment about the grid's centre at the end", optional=True, headline=True)
    ] = None
    rotation: Annotated[float | None, Figure("rad", "rotation at the end", optional=True, unjudged=True)] = None
    slip_residual: Annotated[float, Figure("", "largest relative residual of the steps", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of all steps", unjudged=True)]
    slip: Annotated[FloatArray, grid_map("m", "distance slid in all steps")]
    friction_energy: Annotated[FloatArray, grid_map("J/m^2", "energy of friction in all steps")]
    step: Annotated[FloatArray, _step("1", "step")]
    step_force: Annotated[FloatArray, _step("N", "tangential force")]
    step_shift: Annotated[FloatArray, _step("m", "shift")]
    step_stick_fraction: Annotated[FloatArray, _step("1", "share of the contact that sticks")]
    step_dissipated: Annotated[FloatArray, _step("J", "energy of friction in the step")]
    step_rotation: Annotated[FloatArray | None, _step("rad", "rotation")] = None
    step_moment: Annotated[FloatArray | None, _step("N*m", "moment about the grid's centre")] = None


def run(scene: PartialSlipScene, context: Context) -> PartialSlipRecord:
    """Solve the contact, then step after step."""
    site = sticking.pressed_together(scene, context)
    steps = pressing_steps(scene)

    def after(path: Path, done: int, total: int) -> None:
        keep(context, path)
        context.progress(done, total, "steps", residual=float(path.column("residual")[-1]))

    with context.timer("partial slip"):
        path: Path = kept(context) or pressed(scene, site, steps)
        path = pushed(scene, site, path, after)
    _tell(scene, steps, context)
    extra: dict[str, Any] = {}
    if scene.outputs.stiffness:
        with context.timer("stiffness"):
            extra |= _stiffness(scene, site, context.note)
    below = sticking.stresses_under(scene, site.grid, path.contact(site).pressure, path.last.traction, context)
    wanted = scene.outputs.errors and site.contact.load > 0 and Status.CONVERGED is site.contact.status is path.status
    errors = error_bars(context, wanted, lambda: _bars(scene, site, path, below, extra))
    return _record(scene, site, path, extra | sticking.stress_figures(below), errors)


def _tell(scene: PartialSlipScene, steps: int, context: Context) -> None:
    """What bodies that differ do under pressure alone."""
    if not sticking.coupled(scene):
        return
    if not answers(scene):
        sticking.tell_coupled(scene, context)
    if steps > 1:
        context.note(PRESSING_PATH(steps=steps, reason="steps"))
    else:
        context.note(PRESSING_PATH(usual=PRESSING_STEPS, reason="one-step"))


def _bars(
    scene: PartialSlipScene, site: Site, path: Path, below: StressSummary | None, extra: dict[str, Any]
) -> ErrorBars:
    """From the same steps on the grid of twice the cell, and there with half of those in which the load comes."""
    from bem.accuracy.sticking import PUSH_RULES

    steps = pressing_steps(scene)

    def again(coarser: Site) -> Coarse:
        there = pushed(scene, coarser, pressed(scene, coarser, steps))
        figures, fewer, converged = figures_of(scene, there), None, there.status is Status.CONVERGED
        left = None
        if steps > 1:
            half = pushed(scene, coarser, pressed(scene, coarser, max(steps // 2, 1)))
            fewer, converged = figures_of(scene, half), converged and half.status is Status.CONVERGED
            left = half.contact(coarser), half.last.traction
        if scene.outputs.stiffness:
            # closed on the coarser grid: what is not known there has no bar
            stiff = _stiffness(scene, coarser) or dict.fromkeys(("normal_stiffness", "tangential_stiffness"), math.nan)
            figures, fewer = figures | stiff, None if fewer is None else fewer | stiff
        return Coarse(figures, there.contact(coarser), there.last.traction, converged, fewer, left)

    figures = figures_of(scene, path) | extra
    given = ("shift",) if scene.push.shift is not None else ("force",)
    residual = max(site.contact.residual, float(path.column("residual").max()))
    limit = scene.push.friction * site.contact.load
    return sticking.bars(
        scene, site, Found(figures, path.contact(site), PUSH_RULES, given, residual, limit, below), again
    )


_PROBE = 1e-3
"""Of the approach from first touch, or of the range of gaps: how far the bodies are moved for the normal stiffness."""


def _stiffness(
    scene: PartialSlipScene, site: Site, note: Callable[[Note], None] = lambda note: None
) -> dict[str, float]:
    """Of the contact as a whole [N/m]: load over approach, by its difference, and force over shift where all sticks."""
    from bem.contact import solve_contact
    from bem.tangential import tangential_stiffness

    contact = site.contact
    if not contact.load > 0:
        return {"normal_stiffness": 0.0, "tangential_stiffness": 0.0}
    if all(site.grid.periodic) and contact.pressure.min() > 0:
        note(JOINT_CLOSED())
        return {}
    asked = scene.contact.accuracy() | {"hardness": scene.contact.hardness, "initial_pressure": contact.pressure}
    operator = build.operator_of(scene, site.grid, 0.0)
    step = _PROBE * max(abs(contact.approach), float(np.ptp(contact.gap)))
    near = [solve_contact(site.gap, operator, approach=contact.approach - step, **asked)]
    try:
        near.append(solve_contact(site.gap, operator, approach=contact.approach + step, **asked))
    except InfeasibleError:  # nearly closed: no room for a step further
        near.append(contact)
    for found in near:
        if found.status is not Status.CONVERGED:
            note(
                PART_UNSOLVED(
                    part="contact for the normal stiffness",
                    message=found.status.message,
                    residual=found.residual,
                    action="Take a larger tolerance, or more iterations",
                )
            )
    stuck = tangential_stiffness(contact, site.grid, build.bodies_of(scene), tolerance=scene.push.tolerance)
    return {
        "normal_stiffness": (near[1].load - near[0].load) / (near[1].approach - near[0].approach),
        "tangential_stiffness": float(stuck[0, 0]),
    }


def _record(
    scene: PartialSlipScene, site: Site, path: Path, extra: dict[str, Any], errors: dict[str, Any]
) -> PartialSlipRecord:
    last, contact, turns = path.last, path.contact(site), scene.push.rotation is not None
    status = site.contact.status if site.contact.status is not Status.CONVERGED else path.status
    return filled(
        PartialSlipRecord,
        site.grid,
        sticking.stuck(site.grid, contact, last),
        figures_of(scene, path),
        extra,
        counted_stick_fraction=float(path.column("counted_stick")[-1]),
        rotation=last.rotation if turns else None,
        slip_residual=float(path.column("residual").max()),
        convolutions=path.convolutions,
        slip=path.sums[0],
        friction_energy=path.sums[1],
        step=np.arange(1.0, len(path.steps) + 1),
        step_force=path.column("force"),
        step_shift=path.column("shift"),
        step_stick_fraction=path.column("stick"),
        step_dissipated=path.column("energy"),
        step_rotation=path.column("rotation") if turns else None,
        step_moment=path.column("moment") if turns else None,
        **errors,
        status=status,
        where=f"contact: {contact.status.message}; partial slip: {path.status.message}",
    )


KIND = Kind.of(
    vars(),
    PartialSlipScene,
    PartialSlipRecord,
    "pressed bodies pushed along, once or there and back: where they stick and slip, loop, energy of friction",
    resolutions=(CELLS, DEPTHS),
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
