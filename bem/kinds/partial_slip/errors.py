"""Error bars of kind `partial-slip`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from bem.errors import Status
from bem.kinds.partial_slip.pushing import Path, figures_of, pressed, pressing_steps, pushed
from bem.kinds.partial_slip.scene import PartialSlipScene
from bem.kinds.partial_slip.solve import stiffness
from bem.scenes import sticking
from bem.scenes.resolutions import CELLS, DEPTHS
from bem.scenes.sticking import Coarse, Found, Site

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.stress import StressSummary


def bars_of(
    scene: PartialSlipScene, site: Site, path: Path, below: StressSummary | None, extra: dict[str, Any]
) -> ErrorBars:
    """Estimate errors from the same steps on the grid of twice the cell, and there with half of those in which the load
    comes."""
    from bem.accuracy.sticking import LIMITED_RULES, PUSH_RULES

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
            stiff = stiffness(scene, coarser) or dict.fromkeys(("normal_stiffness", "tangential_stiffness"), math.nan)
            figures, fewer = figures | stiff, None if fewer is None else fewer | stiff
        return Coarse(figures, there.contact(coarser), there.last.traction, converged, fewer, left)

    figures = figures_of(scene, path) | extra
    rules = PUSH_RULES if isinstance(scene.push.friction, float) else LIMITED_RULES
    given: tuple[str, ...] = ("shift",) if scene.push.shift is not None else ("force",)
    if scene.push.share is not None and not isinstance(scene.push.friction, float):
        given = ()  # a share of the sum of the law's bounds, which depends on the cells
    residual = max(site.contact.residual, float(path.column("residual").max()))
    limit = sticking.friction_limit(scene.push.friction, site)
    return sticking.bars(scene, site, Found(figures, path.contact(site), rules, given, residual, limit, below), again)


RESOLUTIONS = (CELLS, DEPTHS)
"""Resolutions that are refined to a requested accuracy."""
