"""Error bars of kind `contact`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from bem.grid import FloatArray
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import adhesion_tolerance, level_before
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.resolutions import CELLS, DEPTHS

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.adhesion import AdhesiveHistory
    from bem.contact import ContactSolution
    from bem.kinds.contact.viscoelastic import Relaxed
    from bem.stress import StressSummary


def bars_of(
    scene: ContactScene,
    undeformed: FloatArray,
    solution: ContactSolution,
    below: StressSummary | None,
    rough: Mapping[str, FloatArray],
    context: Context,
    path: AdhesiveHistory | None = None,
    relaxed: Relaxed | None = None,
) -> ErrorBars:
    """Bars of the contact, and of the stresses below it where there are any."""
    from bem.accuracy import ContactCase, coarser_before, coating_bars, contact_bars, solve_coarser, stress_bars

    grid, before = build.grid_of(scene.grid), level_before(context)
    operator = build.operator_of(scene, grid, scene.contact.friction)
    case = ContactCase(operator, undeformed, solution, **scene.contact.prescribed(grid.area), from_touch=bool(rough))
    if relaxed is not None:
        from bem.accuracy.viscoelastic import relaxed_bars

        control = scene.contact
        followed = control.path(grid.area) if control.times else None
        return relaxed_bars(case, relaxed, speeds=scene.speeds, times=control.times, path=followed)
    if path is not None:
        from bem.accuracy.adhesion import adhesive_bars

        law = scene.contact.adhesion
        assert law is not None
        tolerance = adhesion_tolerance(scene)
        return adhesive_bars(case, law, path, scene.contact.path(grid.area), tolerance)
    nested = None if before is None else coarser_before(case, before)
    coarser = nested or solve_coarser(case, scene.contact.max_iterations)
    bars = contact_bars(case, coarser)
    if below is None:
        return bars
    body, sign = scene.stressed()
    friction = sign * scene.contact.friction
    bars |= stress_bars(case, coarser, body, below, friction)
    return (
        bars | coating_bars(case, coarser, body, below, friction) if body.layers and below.stress is not None else bars
    )


RESOLUTIONS = (CELLS, DEPTHS)
"""Resolutions that are refined to a requested accuracy."""
