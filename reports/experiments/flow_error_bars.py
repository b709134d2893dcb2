"""Error bars of flow factors of random patches against references of four times the cells a side.

    python -m reports.experiments.flow_error_bars [CASES]

Surfaces of 2 to 12 cells to the shortest wave, isotropic and drawn out, elastic, capped and undeformed, at two
separations of 0.4 to 4 rms heights. The result is stored in `reports/results/flow_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem import Body, Grid, Material
from bem.accuracy import flow_bars
from bem.errors import Status
from bem.flow import FlowFactors, flow_factors
from bem.surfaces import generate_surface
from reports.experiments.contact_error_bars import FloatArray, waves_through
from reports.experiments.judging import Comparison, Experiment, main

FINER, CELL = 4, 1e-6
_STEEL = Body(Material("steel", youngs_modulus=200e9, poissons_ratio=0.3))


@dataclass(frozen=True)
class Patch:
    """A rough patch: cells a side, heights [m], separations [m], hardness [Pa]; `elastic`: it deforms."""

    cells: int
    heights: FloatArray
    apart: FloatArray
    hardness: float | None
    elastic: bool

    def grid(self, factor: int) -> Grid:
        """Return the grid with each cell cut into factor x factor."""
        return Grid((factor * self.cells,) * 2, (CELL / factor,) * 2, periodic=(True, True))

    def factors(self, factor: int) -> FlowFactors:
        """Return the flow factors on the refined grid."""
        return flow_factors(
            waves_through(self.heights, factor),
            self.grid(factor),
            _STEEL if self.elastic else None,
            separations=self.apart,
            hardness=self.hardness,
            errors=factor == 1,
        )


def draw(rng: np.random.Generator) -> Patch:
    """A random patch."""
    cells = 2 * int(rng.integers(16, 33))
    grid = Grid((cells, cells), (CELL, CELL), periodic=(True, True))
    shortest = 2.0 if rng.random() < 0.2 else float(10 ** rng.uniform(math.log10(4), math.log10(12)))
    heights = generate_surface(
        grid,
        seed=int(rng.integers(1 << 30)),
        hurst=float(rng.uniform(0.4, 1.0)),
        cutoff_wavelength=shortest * CELL,
        rms_slope=float(10 ** rng.uniform(-2.5, -1)),
    )
    heights = waves_through(heights, 1)
    behaviour = str(rng.choice(["elastic", "capped", "undeformed"], p=[0.5, 0.25, 0.25]))
    apart = float(heights.std()) * np.sort(10 ** rng.uniform(math.log10(0.4), math.log10(4), 2))
    hardness = float(rng.uniform(2e9, 8e9)) if behaviour == "capped" else None
    return Patch(cells, heights, apart, hardness, behaviour != "undeformed")


def solve(patch: Patch) -> Comparison | None:
    """Flow factors at both separations, their bars, and factors on four times the cells a side."""
    own, reference = patch.factors(1), patch.factors(FINER)
    if {own.status, reference.status} != {Status.CONVERGED}:
        return None
    bars = flow_bars(own, patch.heights, patch.grid(1))
    found, truth = ({name: getattr(one, name) for name in bars.values} for one in (own, reference))
    return Comparison(found, truth, bars.values, bars.parts)


EXPERIMENT = Experiment("flow_error_bars", draw, solve, cases=60, seed=2616)

if __name__ == "__main__":
    main(EXPERIMENT)
