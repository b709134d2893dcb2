"""Error bars of stresses in random coatings against references four times finer.

    python -m reports.experiments.coating_error_bars [CASES]

Balls, cylinders and rough flats on one to three layers of a third of a cell to twelve cells, softer and stiffer than
the body below, rubbed and not. References have four times the cells a side and the same surfaces, and four times the
depths in every layer. The result is stored in `reports/results/coating_error_bars.json`.

The rows of the tensions were chosen on the seeds 90417 and 5150. On 90417 the highest tension of points missed, at the
surface, a fifth of that of four times the cells, and that one a tenth of the limit: both have a cusp at the edge of the
contact. Since then the figures have the tension at the edge (`bem.stress.edge_tension`), the principal stress beyond
free edges of the grid, and the tension of shallow interfaces without waves of two cells (`bem.stress.coating_maxima`),
in the references too. On 48611 four of the six bars of shear that missed were of interfaces less than half a cell below
the surface of grids that do not repeat, where the shear was too low by 34 to 116 %; the floor `steps` was chosen on
cylinders and balls since then. The seed is one that nothing was chosen on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bem import Body, Layer, Material
from bem.accuracy import ContactCase, coating_bars, solve_coarser
from bem.accuracy.coating import NAMES
from bem.errors import Status
from bem.grid import FloatArray
from bem.stress import (
    LayerStresses,
    StressSummary,
    coating_maxima,
    layer_stresses,
    summarise_stress,
    with_layer_depths,
)
from reports.experiments import contact_error_bars
from reports.experiments.contact_error_bars import FINER, Problem
from reports.experiments.judging import Comparison, Experiment, main

_LARGEST = 44
"""Cells along an axis: the reference has four times more."""
_PER_LAYER, _DEPTHS = 5, 24
"""Depths in each layer, and graded ones down to a quarter of the grid, as runs have them."""


@dataclass(frozen=True)
class Coated:
    """A contact with a coated body, rubbed with a friction coefficient."""

    problem: Problem
    friction: float

    def stresses(self, case: ContactCase, factor: int) -> tuple[StressSummary, LayerStresses]:
        """Below the contact, with `factor` times as many depths."""
        body, count = self.problem.body, (_DEPTHS - 1) * factor + 1
        graded = min(self.problem.grid.lengths) / 4 * (np.arange(count) / (count - 1)) ** 2
        inside = graded[graded < body.interfaces[-1]]
        depths = np.array(with_layer_depths(inside.tolist(), body, (_PER_LAYER - 1) * factor + 1))
        below = summarise_stress(
            case.solution.pressure, case.grid, body, depths, friction=self.friction, components=True
        )
        assert below.stress is not None
        maxima = coating_maxima(
            below.stress, below.von_mises, depths, case.solution.pressure, case.grid, body, self.friction
        )
        return below, layer_stresses(maxima.highest, body)


def draw(rng: np.random.Generator) -> Coated:
    """A random contact; one that would take too many cells is drawn again."""
    problem = contact_error_bars.draw(rng)
    if max(problem.grid.shape) > _LARGEST:
        return draw(rng)
    steel, (cell, _) = problem.body.material, problem.grid.spacing
    layers = []
    for _ in range(int(rng.integers(1, 4))):
        modulus = steel.youngs_modulus * 10 ** rng.uniform(-0.7, 0.7)
        coat = Material("coat", youngs_modulus=modulus, poissons_ratio=float(rng.uniform(0.1, 0.4)))
        layers.append(Layer(coat, cell * float(10 ** rng.uniform(math.log10(0.3), math.log10(12)))))
    friction = 0.0 if rng.random() < 0.5 else float(rng.uniform(0.05, 0.5))
    return Coated(replace(problem, body=Body(steel, layers=layers), depths=0), friction)


def solve(drawn: Coated) -> Comparison | None:
    """Figures of a coating, their bars, and figures on four times the cells a side."""
    coated = replace(drawn, problem=drawn.problem.prescribed())
    case = coated.problem.case(1)
    coarser = solve_coarser(case)
    fine = coated.problem.case(FINER, 1e-7)
    if coarser.solution is None or {case.solution.status, fine.solution.status} != {Status.CONVERGED}:
        return None
    below, found = coated.stresses(case, 1)
    _, truth = coated.stresses(fine, FINER)
    bars = coating_bars(case, coarser, coated.problem.body, below, coated.friction)
    told = ({name: getattr(one, name) for name in NAMES} for one in (found, truth))
    return Comparison(*told, {name: _known(bars.values[name]) for name in NAMES}, bars.parts)


def _known(bars: FloatArray) -> list[float | None]:
    """Bars of a list; None where there is none."""
    return [None if math.isnan(bar) else bar for bar in bars.tolist()]


EXPERIMENT = Experiment("coating_error_bars", draw, solve, cases=60, seed=20611)

if __name__ == "__main__":
    main(EXPERIMENT)
