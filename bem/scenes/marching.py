"""What the kinds of films in time share: a march with its checkpoints, and the few of its times that are shown.

Knows contexts and checkpoints; the marches are `bem.accuracy.march`. Verified in tests/scenes/test_film_kind.py and
test_point_film_time_kind.py.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.scenes.context import Context
from bem.scenes.packing import keep, kept

if TYPE_CHECKING:
    from bem.accuracy.march import MarchCase, PointMarchCase

_CHECKPOINTS = 20  # of a march
JUMPS = "a film is often nearly as thin at several times, and other steps may pick another of them"
"""Why the time of the thinnest film has no error bar."""


def marched(case: MarchCase | PointMarchCase, mesh: Any, context: Context) -> list[Any]:
    """The films of a case on its mesh (points or cells), with a checkpoint at every twentieth of the way."""
    last, made_again = len(case.times) - 1, (case.lubricant,)

    def watch(now: Any) -> None:
        done = len(now.solutions) - 1
        context.progress(done, last, "steps")
        if done == last or done % math.ceil(last / _CHECKPOINTS) == 0:
            keep(context, now, made_again)

    return case.again(mesh, state=kept(context, made_again), callback=watch)


def few_of(count: int, most: int) -> list[int]:
    """Indices of so many films at most, evenly over the march, the first and the last among them."""
    return sorted({round(i) for i in np.linspace(0, count - 1, min(count, most))})
