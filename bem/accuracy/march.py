"""Error bars of a film in time: fewer points, and fewer steps on these.

Mesh and steps of `bem.march_line_film` both converge with order two. The march on half the points shows what the mesh
does, a third one of these points and of steps twice as long what the steps do; together they take about half as long as
the march itself. Each part is its difference times a safety factor (`reports/experiments/march_error_bars.py`), the bar
their sum: an estimate, no proved bound, which covers nine errors in ten of coarse, random motions. The time of the
thinnest film jumps between minima and has no bar.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, STEPS, ErrorBars
from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import Cavitation, FilmSolution, Lubricant, march_line_film

FIGURES = ("thinnest_film", "film_at_end", "largest_shear_force")
FEWEST = 101
_MESH, _STEPS = 1.3, 3.0
"""Factors on the differences to half the points and to steps twice as long. Order two would leave 1/3 of either; coarse
motions are not there yet, and the steps are compared on the coarser mesh. On fresh seeds less covers too little: with
0.8 and 2 eight in ten."""
_TOLERANCE = 1e-7
"""Largest residual of a step, relative to the film and the load."""
_UNSOLVED = "no error bars: the march with fewer points and longer steps did not converge"
_FEW = "no error bars: a march of fewer than four steps"


@dataclass(frozen=True, eq=False)
class MarchCase:
    """A march that was done, and the arguments of `bem.march_line_film` that it was done with."""

    films: Sequence[FilmSolution]
    times: FloatArray
    load: Callable[[float], float]
    speeds: Callable[[float], Sequence[float]]
    radius: float
    contact_modulus: float
    lubricant: Lubricant
    points: int
    initial_thickness: float | None = None
    cavitation: Cavitation | str = Cavitation.SWIFT_STIEBER
    layer: float | None = None

    def again(self, points: int, every: int = 1, **going_on: Any) -> list[FilmSolution]:
        """The same march with other points, at every so many of the times and the last one; `going_on` from a state,
        or calling back."""
        return march_line_film(
            np.unique(np.append(self.times[::every], self.times[-1])),
            load=self.load,
            speeds=self.speeds,
            radius=self.radius,
            contact_modulus=self.contact_modulus,
            lubricant=self.lubricant,
            points=points,
            initial_thickness=self.initial_thickness,
            cavitation=self.cavitation,
            supply=self.layer,
            **going_on,
        )


def march_figures(films: Sequence[FilmSolution]) -> dict[str, float]:
    """Headline figures of a march: the thinnest of all minimum thicknesses [m], the last one [m] and the largest shear
    force per unit length [N/m]."""
    minimum = np.array([film.minimum_thickness for film in films])
    return {
        "thinnest_film": float(minimum.min()),
        "film_at_end": float(minimum[-1]),
        "largest_shear_force": float(max(abs(film.shear_force) for film in films)),
    }


def march_bars(case: MarchCase) -> ErrorBars:
    """Bars of the figures of a march; two marches more."""
    if len(case.times) < 5:
        return ErrorBars.unknown(FIGURES, _FEW)
    fewer = max(FEWEST, case.points // 2 + 1)
    other = fewer if fewer < case.points else 2 * case.points - 1
    coarser = case.again(other)
    longer = case.again(min(other, case.points), 2)
    if {coarser[-1].status, longer[-1].status, case.films[-1].status} != {Status.CONVERGED}:
        return ErrorBars.unknown(FIGURES, _UNSOLVED)
    found, mesh, steps = march_figures(case.films), march_figures(coarser), march_figures(longer)
    from_here = mesh if other < case.points else found
    # the difference to half the points, by order two
    halved = 3 / abs((case.points / other) ** 2 - 1)
    residual = {name: 10 * _TOLERANCE * abs(value) for name, value in found.items()}
    return ErrorBars.together(
        {
            POINTS: {name: _MESH * halved * abs(found[name] - mesh[name]) for name in FIGURES},
            STEPS: {name: _STEPS * abs(from_here[name] - steps[name]) for name in FIGURES},
            RESIDUAL: residual,
        }
    )
