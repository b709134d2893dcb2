"""Error bars of kind `rolling`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.errors import Status
from bem.kinds.rolling.scene import RollingContactScene
from bem.kinds.rolling.solve import quarter_step_before, rolled_figures, solve_rolling_contact, solve_rolling_history
from bem.scenes import sticking
from bem.scenes.resolutions import CELLS, DEPTHS
from bem.scenes.sticking import Coarse, Found, Site

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.stress import StressSummary
    from bem.tangential import TangentialSolution


def bars_of(
    scene: RollingContactScene, site: Site, found: TangentialSolution, below: StressSummary | None
) -> ErrorBars:
    """Estimate errors from the same rolling on the grid of twice the cell, whose steps are twice as long."""
    from bem.accuracy.sticking import ROLL_RULES

    def solve_coarser(coarser: Site) -> Coarse:
        """Solve the same rolling on the coarser grid."""
        quarter_step_back: dict[str, float] | None = None
        if scene.history is None:
            coarse = solve_rolling_contact(scene, coarser)
            figures = rolled_figures(coarser, coarse, scene.roll.spin)
        else:
            history = solve_rolling_history(scene, coarser)
            coarse = history.last
            figures = rolled_figures(coarser, coarse, scene.roll.spin)
            quarter_step_back = quarter_step_before(coarser, history, figures)
        return Coarse(figures, coarser.contact, coarse.traction, coarse.status is Status.CONVERGED, quarter_step_back)

    given: tuple[str, ...] = ("creepage", "creepage_across") if scene.roll.share is None else ("force", "force_across")
    if scene.history is not None and scene.history.shares is not None:
        given = ("force", "force_across")
    if "force" in given and not isinstance(scene.roll.friction, float):
        given = ("force_across",)  # the share is one of the sum of the law's bounds, which depends on the cells
    residual = max(site.contact.residual, found.residual)
    limit = sticking.friction_limit(scene.roll.friction, site)
    figures = rolled_figures(site, found, scene.roll.spin)
    return sticking.bars(
        scene, site, Found(figures, site.contact, ROLL_RULES, given, residual, limit, below), solve_coarser
    )


RESOLUTIONS = (CELLS, DEPTHS)
"""Resolutions that are refined to a requested accuracy."""
