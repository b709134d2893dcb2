"""Error bars of kind `friction`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.accuracy.bars import POINTS, ErrorBars
from bem.errors import Status
from bem.grid import FloatArray
from bem.notes import Note
from bem.notes.accuracy import NO_ERROR_BAR, named, one_note_per_cause
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


def notes_of_bars(bars: ErrorBars) -> tuple[Note, ...]:
    """Return the notes on the bars of one speed, one of each cause.

    A minimum film follows from a lambda ratio, or the ratio from the minimum: both have no bar for the same reason.
    """
    found = []
    for note in bars.notes:
        if note.code == NO_ERROR_BAR.code:
            figures = [name for one in note.values["figures"] for name in _FOLLOWING.get(one, (one,))]
            note = NO_ERROR_BAR(note.where, level=note.level, **{**note.values, "figures": figures})
        found.append(note)
    return tuple(one_note_per_cause(found))


_FOLLOWING = {
    first: (first, second)
    for first, second in (
        named(["lambda_ratio", "minimum_film_whole"]),
        named(["minimum_film", "lambda_ratio_mixed"]),
    )
}
"""Figures, in words, and what follows from them."""

_LINE, _POINT = counted("film.points", POINTS, 400, 20000), counted("film.cells", POINTS, 64, 512)

_FILM = of_either(POINTS, lambda scene: _LINE if scene.contact.point_radii is None else _POINT)

RESOLUTIONS = (CELLS, _FILM)
"""Resolutions that are refined to a requested accuracy."""
