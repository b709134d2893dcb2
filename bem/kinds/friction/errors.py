"""Error bars of kind `friction`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.accuracy.bars import POINTS, ErrorBars
from bem.errors import Status
from bem.grid import FloatArray
from bem.scenes.context import Context
from bem.scenes.resolutions import CELLS, counted, of_either

if TYPE_CHECKING:
    from bem.friction import MixedSolution
    from bem.friction.setup import MixedSetup


def bars_of(setup: MixedSetup, height: FloatArray, solution: MixedSolution, context: Context) -> ErrorBars:
    """Error bars of one speed; none of one that did not converge."""
    from bem.accuracy import MixedCase, mixed_bars, solve_coarser_mixed

    if solution.status is not Status.CONVERGED:
        return ErrorBars()
    case = MixedCase(setup, height, solution)
    with context.timer("error bars"):
        return mixed_bars(case, solve_coarser_mixed(case))


_LINE, _POINT = counted("film.points", POINTS, 400, 20000), counted("film.cells", POINTS, 64, 512)

_FILM = of_either(POINTS, lambda scene: _LINE if scene.contact.point_radii is None else _POINT)

RESOLUTIONS = (CELLS, _FILM)
"""Resolutions that are refined to a requested accuracy."""
