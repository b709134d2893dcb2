"""Solver calls of kind `contact` that a run and its error bars share."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.contact.scene import ContactScene
from bem.notes import Note
from bem.notes.scenes import BODIES_APART
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.packing import keep, kept, kept_coarser

if TYPE_CHECKING:
    from bem.adhesion import AdhesiveHistory
    from bem.contact import ContactSolution


def solve_scene(
    scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context
) -> tuple[ContactSolution, FloatArray]:
    """The contact, from the checkpoint where it was solved before, and (n, 2) iterations and residuals."""
    from bem.contact import solve_contact
    from bem.distributed.session import current_session

    session = current_session()
    solve = solve_contact if session is None else session.solve_contact
    solved: tuple[ContactSolution, FloatArray] | None = kept(context)
    if solved is not None:
        return solved
    operator = build.operator_of(scene, grid, scene.contact.friction)
    history = []

    def watch(iterations: int, residual: float, fraction: float) -> None:
        history.append((iterations, residual))
        # convergence is near linear in the logarithm of the residual
        share = math.log(min(max(residual, 1e-300), 1.0)) / math.log(scene.contact.tolerance)
        context.progress(int(100 * min(share, 1.0)), 100, "contact", residual=residual, area_fraction=fraction)

    asked = scene.contact.prescribed(grid.area) | scene.contact.accuracy()
    solution = solve(undeformed, operator, **asked, initial_pressure=_begin(context, grid), callback=watch)
    del operator  # and with it its spectra
    context.progress(100, 100, "contact", residual=solution.residual)
    solved = solution, np.array(history, dtype=np.float64).reshape(-1, 2)
    keep(context, solved)
    return solved


def _begin(context: Context, grid: Grid) -> FloatArray | None:
    """The pressure of the level before: each of its cells cut in four with the same force, or as it is."""
    before = level_before(context)
    if before is None or before.pressure.shape == grid.shape:
        return None if before is None else before.pressure
    return np.repeat(np.repeat(before.pressure, 2, axis=0), 2, axis=1)


def level_before(context: Context) -> ContactSolution | None:
    """The contact on the grid of twice the cell, where an accuracy is refined to."""
    before: tuple[ContactSolution, FloatArray] | None = kept_coarser(context)
    return None if before is None else before[0]


def solve_adhesive(scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context) -> AdhesiveHistory:
    """Return the adhesive contact along its path, from the checkpoint where it was solved before."""
    from bem.adhesion import AdhesiveSolution, follow_path

    solved: AdhesiveHistory | None = kept(context)
    if solved is not None:
        return solved
    law, path = scene.contact.adhesion, scene.contact.path(grid.area)
    assert law is not None
    steps = len(next(iter(path.values())))

    def watch(number: int, state: AdhesiveSolution) -> None:
        context.progress(number + 1, steps, "path", residual=state.residual)

    context.progress(0, steps, "path")
    history = follow_path(
        undeformed,
        build.operator_of(scene, grid),
        law,
        hardness=scene.contact.hardness,
        tolerance=adhesion_tolerance(scene),
        loads=path.get("loads"),
        approaches=path.get("approaches"),
        refined=True,
        callback=watch,
    )
    keep(context, history)
    return history


def standing_off(solution: ContactSolution) -> tuple[Note, ...]:
    """Return the note on bodies that do not touch, so that figures of zero are not taken for those of a contact."""
    if solution.pressure.any() or solution.status is not Status.CONVERGED or solution.approach >= 0:
        return ()
    from bem.accuracy.coarsened import mean_opening

    touching = mean_opening(solution.gap) + solution.approach
    return (BODIES_APART(apart=float(-solution.approach), touching=float(touching)),)


def adhesion_tolerance(scene: ContactScene) -> float:
    """Return the tolerance of the attraction over its strength."""
    return max(scene.contact.tolerance, ADHESION_TOLERANCE)


ADHESION_TOLERANCE = 1e-6
"""Least tolerance of the attraction over its strength: its contacts are solved to a tenth of what it allows."""
