"""Parts shared by the kinds of films in time: the march with its checkpoints, and the choice of the times to show.

Knows contexts and checkpoints; the marches are `bem.accuracy.march`. Verified in tests/scenes/test_film_kind.py and
test_point_film_time_kind.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.packing import keep, kept
from bem.scenes.records import OIL_SCATTER, Figure, Record, Series, columns

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.accuracy.march import MarchCase, PointMarchCase
    from bem.lubrication import Lubricant

_CHECKPOINTS = 20  # of a march
JUMPS = "a film is often nearly as thin at several times, and other steps may pick another of them"
"""Reason why the time of the thinnest film has no error bar."""


@dataclass(frozen=True, eq=False, kw_only=True)
class MarchedRecord(Record):
    """A film in time: its minimum and its centre."""

    thinnest_film: Annotated[float, Figure("nm", "minimum film thickness of all times", headline=True)]
    film_at_end: Annotated[float, Figure("nm", "minimum film thickness at the end", headline=True)]
    newton_steps: Annotated[int, Figure("", "Newton steps", unjudged=True)]
    time: Annotated[FloatArray, Series(("time",), "s", "time")]
    minimum_film: Annotated[FloatArray, Series(("time",), "m", "minimum film thickness")]
    central_film: Annotated[FloatArray, Series(("time",), "m", "film thickness at the centre")]
    friction_oil_scatter: Annotated[FloatArray | None, Series(("time",), "1", OIL_SCATTER)] = None


@dataclass(frozen=True, eq=False)
class Marched:
    """The films of a march, figures of its records by their names, and what their status and error bars are."""

    films: list[Any]
    figures: dict[str, Any]
    ended: dict[str, Any]

    @classmethod
    def of(
        cls,
        case: MarchCase | PointMarchCase,
        mesh: Any,
        context: Context,
        wanted: bool,
        bars: Callable[[list[Any]], ErrorBars],
    ) -> Marched:
        """Build the march of a case on its mesh (points or cells); `bars` are those of its films, if `wanted`."""
        with context.timer("film"):
            films = _films(case, mesh, context)
        tell(context, dict.fromkeys(note for film in films for note in film.notes), "film")
        last, over = films[-1], columns(films, ("time", "minimum_thickness", "central_thickness"))
        time, minimum = over["time"], over["minimum_thickness"]
        figures = {
            "thinnest_film_time": float(time[minimum.argmin()]),
            "newton_steps": int(sum(film.iterations for film in films)),
            "time": time,
            "minimum_film": minimum,
            "central_film": over["central_thickness"],
        }
        ended = {"status": last.status, "where": f"time {last.time:g} s: {last.status.message}"}
        solved = wanted and last.status is Status.CONVERGED
        return cls(films, figures, ended | error_bars(context, solved, lambda: bars(films)))


def _films(case: MarchCase | PointMarchCase, mesh: Any, context: Context) -> list[Any]:
    """With a checkpoint at every twentieth of the way."""
    last, made_again = len(case.times) - 1, (case.lubricant,)

    def watch(now: Any) -> None:
        done = len(now.solutions) - 1
        context.progress(done, last, "steps")
        if done == last or done % math.ceil(last / _CHECKPOINTS) == 0:
            keep(context, now, made_again)

    return case.again(mesh, state=kept(context, made_again), callback=watch)


def oil_scatters(films: Sequence[Any], lubricant: Lubricant, friction: FloatArray) -> FloatArray | None:
    """Return the scatter of the friction of each time from the constants of the oil; not-a-number at times without a
    friction coefficient, None with another shear law than that of base oils.

    films : of a march. lubricant : as it was given to the march. friction : coefficient of sliding of each film.
    """
    from bem.lubrication.oil_scatter import friction_scatter
    from bem.lubrication.shear import BaseOilShear

    if not isinstance(lubricant.shear_law, BaseOilShear):
        return None
    found = (friction_scatter(film, lubricant, float(own)) for film, own in zip(films, friction, strict=True))
    return np.array([math.nan if one is None else one for one in found])


def few_of(count: int, most: int) -> list[int]:
    """Indices of so many films at most, evenly over the march, the first and the last among them."""
    return sorted({round(i) for i in np.linspace(0, count - 1, min(count, most))})
