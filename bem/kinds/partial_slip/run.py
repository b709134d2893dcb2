"""Run of a case of kind `partial-slip`."""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.errors import Status
from bem.kinds.partial_slip.errors import bars_of
from bem.kinds.partial_slip.pushing import PRESSING_STEPS, Path, answers, figures_of, pressed, pressing_steps, pushed
from bem.kinds.partial_slip.record import PartialSlipRecord
from bem.kinds.partial_slip.scene import PartialSlipScene
from bem.kinds.partial_slip.solve import stiffness
from bem.notes.contact import PRESSING_PATH
from bem.scenes import sticking, wheel_rail
from bem.scenes.context import Context, error_bars
from bem.scenes.packing import keep, kept
from bem.scenes.sticking import Site


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
            extra |= stiffness(scene, site, context.note)
    below = sticking.stresses_under(scene, site.grid, path.contact(site).pressure, path.last.traction, context)
    wanted = scene.outputs.errors and site.contact.load > 0 and Status.CONVERGED is site.contact.status is path.status
    errors = error_bars(context, wanted, lambda: bars_of(scene, site, path, below, extra))
    return _record(scene, site, path, extra | sticking.stress_figures(below), errors)


def _tell(scene: PartialSlipScene, steps: int, context: Context) -> None:
    """Note how bodies of different elasticity slip under pressure alone."""
    if not sticking.coupled(scene):
        return
    if not answers(scene):
        sticking.tell_coupled(scene, context)
    if steps > 1:
        context.note(PRESSING_PATH(steps=steps, reason="steps"))
    else:
        context.note(PRESSING_PATH(usual=PRESSING_STEPS, reason="one-step"))


def _record(
    scene: PartialSlipScene, site: Site, path: Path, extra: dict[str, Any], errors: dict[str, Any]
) -> PartialSlipRecord:
    last, contact, turns = path.last, path.contact(site), scene.push.rotation is not None
    status = site.contact.status if site.contact.status is not Status.CONVERGED else path.status
    figures: dict[str, Any] = figures_of(scene, path) | extra
    return PartialSlipRecord(
        x=site.grid.x,
        y=site.grid.y,
        **sticking.stuck(site.grid, contact, last, scene.push.friction),
        **wheel_rail.fields(scene, site.grid, contact),
        **figures,
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
