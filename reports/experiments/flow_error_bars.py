"""Error bars of flow factors of random patches against references of four times the cells a side.

    python -m reports.experiments.flow_error_bars [CASES]

Surfaces of 2 to 12 cells to the shortest wave, isotropic and drawn out, elastic, capped and undeformed, at two
separations of 0.4 to 4 rms heights. The result is stored in `reports/results/flow_error_bars.json`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material
from bem.accuracy import flow_bars
from bem.accuracy.contact import surface_is_resolved
from bem.errors import Status
from bem.flow import FlowFactors, flow_factors
from bem.surfaces import generate_surface
from reports.experiments.contact_error_bars import FloatArray, waves_through
from reports.experiments.judging import judge

RESULT = Path(__file__).resolve().parents[1] / "results" / "flow_error_bars.json"
FINER, CELL = 4, 1e-6
_STEEL = Body(Material("steel", youngs_modulus=200e9, poissons_ratio=0.3))


def rows_of(rng: np.random.Generator) -> list[dict[str, Any]]:
    """Bar and true error of every factor of a random patch."""
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

    def found(heights: FloatArray, factor: int) -> FlowFactors:
        return flow_factors(
            heights,
            Grid((factor * cells,) * 2, (CELL / factor,) * 2, periodic=(True, True)),
            None if behaviour == "undeformed" else _STEEL,
            separations=apart,
            hardness=hardness,
            errors=factor == 1,
        )

    own, reference = found(heights, 1), found(waves_through(heights, FINER), FINER)
    if {own.status, reference.status} != {Status.CONVERGED}:
        return []
    bars = flow_bars(own, heights, grid)
    assert own.coarser is not None
    return [
        {
            "figure": name,
            "patch": f"{shortest:.1f} cells to a wave, {behaviour}",
            "resolved": surface_is_resolved(heights, grid),
            "separation_over_Sq": float(apart[k] / heights.std()),
            "value": float(getattr(own, name)[k]),
            "difference": float(abs(getattr(own, name) - own.coarser[name])[k]),
            "parts": {origin: float(part[name][k]) for origin, part in bars.parts.items()},
            "error": float(abs(getattr(own, name) - getattr(reference, name))[k]),
            "bar": float(bar[k]),
        }
        for name, bar in bars.values.items()
        for k in range(len(apart))
    ]


if __name__ == "__main__":
    judge(rows_of, RESULT, 60, seed=2616)
