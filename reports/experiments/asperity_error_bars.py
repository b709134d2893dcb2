"""Error bars of random arrays of asperities against references of four times the cells a side.

    python -m reports.experiments.asperity_error_bars [CASES]

Spheres of 2 to 100 um, pressed in by 2 to 50 nm, two to seven cells in Hertz' radius at the deepest, heights of two to
six depths, spacings of 9 to 16 of that radius. The result is stored in
`reports/results/asperities_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem import Body, Grid, Material, contact_modulus
from bem.accuracy import asperity_bars
from bem.convolution import displacement_operator
from bem.friction.asperity_array import ArrayLoads, press_array
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4
_STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)


@dataclass(frozen=True)
class ArrayDrawn:
    """A random array: radius, height, depth and spacing [m], cells a side."""

    radius: float
    height: float
    depth: float
    spacing: float
    cells: int

    def loads(self, cells: int) -> ArrayLoads:
        """Its loads on a grid of so many cells a side, at a third, two thirds and all of the depth."""
        grid = Grid((cells, cells), (self.spacing / cells,) * 2, periodic=(True, True))
        return press_array(
            displacement_operator(grid, Body(_STEEL)),
            radius=self.radius,
            height=self.height,
            contact_modulus=contact_modulus(_STEEL),
            depths=self.depth * np.array([1 / 3, 2 / 3, 1.0]),
            window=10 * self.spacing,
        )


def draw(rng: np.random.Generator) -> ArrayDrawn:
    """A random array."""
    radius, depth = 10 ** rng.uniform(-5.7, -4), 10 ** rng.uniform(-8.7, -7.3)
    height = depth * rng.uniform(2, 6)
    # nearer neighbours lift each other so that the loads of a curve do not reach the depth
    spacing = max(2.05 * math.sqrt(2 * radius * height), math.sqrt(radius * depth) * rng.uniform(9, 16))
    cells = round(spacing / math.sqrt(radius * depth) * rng.uniform(2, 7))
    return ArrayDrawn(radius, height, depth, spacing, max(16, cells))


def solve(case: ArrayDrawn) -> Comparison:
    """Loads at every depth, their bars, and loads on four times the cells a side."""
    found, coarser, reference = (case.loads(n) for n in (case.cells, case.cells // 2, FINER * case.cells))
    bars = asperity_bars(found, coarser, case.radius, case.spacing / case.cells).values
    figures = {"mean_plane": "asperity_load", "from_flat": "asperity_load_window"}
    own, truth = ({figures[name]: getattr(one, name) for name in bars} for one in (found, reference))
    return Comparison(own, truth, {figures[name]: bar for name, bar in bars.items()})


EXPERIMENT = Experiment("asperities_error_bars", draw, solve, cases=100)

if __name__ == "__main__":
    main(EXPERIMENT)
