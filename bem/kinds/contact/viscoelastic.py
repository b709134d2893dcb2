"""Solver calls and results of a contact of bodies that relax: along a path in time, or in steady motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.materials import Material, relaxation_span
from bem.notes import Note
from bem.notes.contact import HYSTERESIS_UNBALANCED, RELAXATION_EXTRAPOLATED
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.packing import keep, kept

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.contact import ContactSolution
    from bem.stress import StressSummary
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


@dataclass(frozen=True, eq=False)
class RelaxedResponse(Response):
    """Contact of bodies that relax, along a path in time or in steady motion."""

    solved: Relaxed

    @property
    def contact(self) -> ContactSolution:
        """See `Response`."""
        from bem.viscoelastic import SteadySolution

        contact = self.solved.contact if isinstance(self.solved, SteadySolution) else self.solved.last
        return replace(contact, convolutions=self.solved.convolutions, status=self.solved.status)

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """See `Response`."""
        return relaxed_notes(scene, grid, self.solved)

    def figures(self, scene: ContactScene) -> dict[str, float]:
        """See `Response`."""
        from bem.viscoelastic import SteadySolution

        if isinstance(self.solved, SteadySolution):
            return {
                "hysteresis_friction": self.solved.friction,
                "hysteresis_force": self.solved.friction_force,
                "dissipated_power": self.solved.dissipated_power,
                "energy_imbalance": self.solved.imbalance,
            }
        return {"dissipated_energy": float(self.solved.dissipated[-1]), "energy_imbalance": self.solved.imbalance}

    def arrays(self, scene: ContactScene) -> dict[str, Any]:
        """Return the path in time, or the speed of steady motion."""
        from bem.viscoelastic import SteadySolution

        if isinstance(self.solved, SteadySolution):
            return {"contact_speed": scene.contact.sliding_speed or scene.contact.rolling_speed}
        return {
            "path_time": self.solved.time,
            "path_load": self.solved.load,
            "path_approach": self.solved.approach,
            "path_contact_area": self.solved.contact_area,
        }

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`; those of stresses are not known."""
        from bem.accuracy.viscoelastic import relaxed_bars

        control = scene.contact
        path = control.path(case.grid.area) if control.times else None
        return relaxed_bars(case, self.solved, speeds=scene.speeds, times=control.times, path=path)


def relaxed_notes(scene: ContactScene, grid: Grid, solved: Relaxed) -> tuple[Note, ...]:
    """Return the notes on work and energy that do not balance, and on times at which the relaxation is not known."""
    return (*_unbalanced(scene, grid, solved), *_extrapolated(scene, grid, solved))


def _relaxing(scene: ContactScene) -> list[tuple[Material, float]]:
    """Return the materials that relax, and the speeds at which they pass the contact [m/s]."""
    bodies = (scene.lower.build(), scene.upper.build())
    return [
        (body.material, abs(speed))
        for speed, body in zip(scene.speeds or (0.0, 0.0), bodies, strict=True)
        if body is not None and body.material.relaxation is not None
    ]


def _unbalanced(scene: ContactScene, grid: Grid, solved: Relaxed) -> tuple[Note, ...]:
    """Return the note on work and energy that do not balance."""
    from bem.viscoelastic import SteadySolution

    if not solved.imbalance > UNBALANCED:  # not-a-number where no balance is known
        return ()
    if not isinstance(solved, SteadySolution):
        return (HYSTERESIS_UNBALANCED(reason="work", share=solved.imbalance),)
    length = max(speed * max(material.relaxation.times) for material, speed in _relaxing(scene) if material.relaxation)
    return (HYSTERESIS_UNBALANCED(reason="power", share=solved.imbalance, length=length, cell=grid.spacing[0]),)


def _extrapolated(scene: ContactScene, grid: Grid, solved: Relaxed) -> tuple[Note, ...]:
    """Return the notes on materials of the catalogue that are loaded for times of which their source knows nothing.

    In steady motion a point is under pressure while it passes the cells in contact on its line along x. A body that the
    contact does not pass, and one at rest under its load from the start, is relaxed whatever the time.
    """
    from bem.viscoelastic import SteadySolution

    notes = []
    for material, speed in _relaxing(scene):
        span = relaxation_span(material)
        if isinstance(solved, SteadySolution):
            length = float(np.count_nonzero(solved.contact.pressure > 0, axis=0).max()) * grid.spacing[0]
            reason, time = "passing", length / speed if speed else 0.0
        else:
            reason, time = "path", scene.contact.times[-1] - scene.contact.times[0]
        if span is not None and time > 0 and not span[0] <= time <= span[1]:
            values: dict[str, Any] = {"material": material.name, "time": time, "low": span[0], "high": span[1]}
            notes.append(RELAXATION_EXTRAPOLATED(reason=reason, **values))
    return tuple(notes)
