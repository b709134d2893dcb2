"""Solver calls and results of a contact of bodies that relax: along a path in time, or in steady motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bem.grid import FloatArray, Grid
from bem.kinds.contact.scene import ContactScene
from bem.notes import Note
from bem.notes.contact import HYSTERESIS_UNBALANCED
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.packing import keep, kept

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.viscoelastic import SteadySolution, ViscoelasticHistory

    Relaxed = ViscoelasticHistory | SteadySolution

UNBALANCED = 0.2
"""Imbalance of work and energy above which the run says so."""


def solve_relaxing(scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context) -> Relaxed | None:
    """Return the contact of bodies that relax, from the checkpoint where it was solved before; None of elastic ones."""
    from bem.viscoelastic import follow_times, solve_steady_motion

    control, speeds = scene.contact, scene.speeds
    if not control.times and speeds is None:
        return None
    solved: Relaxed | None = kept(context)
    if solved is not None:
        return solved
    operator = build.operator_of(scene, grid)
    if speeds is not None:
        given: dict[str, Any] = {"load": control.load_on(grid.area), "approach": control.approach}
        solved = solve_steady_motion(undeformed, operator, speeds, **given, tolerance=control.tolerance)
    else:
        span = control.times[-1] - control.times[0]

        def watch(time: float, contact: ContactSolution) -> None:
            done = 1.0 if span == 0 else (time - control.times[0]) / span
            context.progress(int(100 * done), 100, "path", residual=contact.residual)

        path: dict[str, Any] = scene.contact.path(grid.area)
        solved = follow_times(undeformed, operator, control.times, **path, tolerance=control.tolerance, callback=watch)
    keep(context, solved)
    return solved


def relaxed_contact(solved: Relaxed) -> ContactSolution:
    """Return the contact at the end of the path, or in steady motion, with the convolutions and status of the whole."""
    from dataclasses import replace

    from bem.viscoelastic import SteadySolution

    contact = solved.contact if isinstance(solved, SteadySolution) else solved.last
    return replace(contact, convolutions=solved.convolutions, status=solved.status)


def relaxed_figures(solved: Relaxed) -> dict[str, float]:
    """Return the figures of a contact of bodies that relax which no elastic one has."""
    from bem.viscoelastic import SteadySolution

    if isinstance(solved, SteadySolution):
        return {
            "hysteresis_friction": solved.friction,
            "hysteresis_force": solved.friction_force,
            "dissipated_power": solved.dissipated_power,
            "energy_imbalance": solved.imbalance,
        }
    return {"dissipated_energy": float(solved.dissipated[-1]), "energy_imbalance": solved.imbalance}


def relaxed_notes(scene: ContactScene, grid: Grid, solved: Relaxed) -> tuple[Note, ...]:
    """Return the note on work and energy that do not balance."""
    from bem.viscoelastic import SteadySolution

    if not solved.imbalance > UNBALANCED:  # not-a-number where no balance is known
        return ()
    if not isinstance(solved, SteadySolution):
        return (HYSTERESIS_UNBALANCED(reason="work", share=solved.imbalance),)
    assert scene.speeds is not None
    lengths = [
        abs(speed) * max(body.material.relaxation.times)
        for speed, body in zip(scene.speeds, (scene.lower.build(), scene.upper.build()), strict=True)
        if body is not None and body.material.relaxation is not None
    ]
    cell = grid.spacing[0]
    return (HYSTERESIS_UNBALANCED(reason="power", share=solved.imbalance, length=max(lengths), cell=cell),)


def relaxed_arrays(scene: ContactScene, solved: Relaxed) -> dict[str, Any]:
    """Return the path in time, or the speed of steady motion."""
    from bem.viscoelastic import SteadySolution

    if isinstance(solved, SteadySolution):
        return {"contact_speed": scene.contact.sliding_speed or scene.contact.rolling_speed}
    return {
        "path_time": solved.time,
        "path_load": solved.load,
        "path_approach": solved.approach,
        "path_contact_area": solved.contact_area,
    }
