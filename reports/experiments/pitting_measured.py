"""Micropitting for the surface pairs of Morales-Espejel and Brizmer (2011), with A per factor e and per decade.

    python -m reports.experiments.pitting_measured

Two minutes. Surfaces are drawn with the published roughness; their lay and correlation length are those of the scene
micropitting-rig. The result is stored in `reports/results/pitting_measured.json`, which `reports.friction` reads.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from bem.life.fatigue_limit import CRITERIA, FatigueLimit
from bem.reference_solutions.mcewen import cylinder_stress
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("pitting_measured")
SLOPE = -43e6
"""A of sigma = A ln N + B [Pa]."""
SLOPES = {"per factor e": SLOPE, "per decade": SLOPE / math.log(10)}
"""A per factor e of the number of cycles, for both readings."""
PRESSURE, FRICTION = 1.5e9, 0.05
CYCLES = 720_000
PAIRS = (
    (0.05, 0.50, 4.0, "upper"),
    (0.05, 0.50, 0.25, "upper"),
    (0.05, 0.26, 4.0, "upper"),
    (0.05, 1.00, 4.0, "upper"),
    (0.05, 1.00, 4.0, "lower"),
    (0.50, 0.50, 4.0, "upper"),
)
"""Rq of roller and disc [um], elongation of the lay along the rolling direction, body whose damage counts."""
BOTH = 3
"""Of the first so many pairs both readings are run, of the others bem's own."""
SETTINGS = (
    "wear.positions=4",
    "grid.shape=[96, 24]",
    "fatigue.depths.count=6",
)
"""Smaller than the scene, without error bars."""
WIDE = ("grid.shape=[96, 48]", 'grid.lengths=["384 um", "192 um"]')
"""A patch that holds ridges across the rolling direction."""


def smooth(criterion: str) -> dict[str, Any]:
    """Cycles to damage below a smooth contact that rolls, by both readings of A."""
    along = np.append(np.linspace(-6.0, 6.0, 241), 1e3)
    stress = cylinder_stress(
        along[:, None], np.linspace(0.02, 2.0, 60)[None, :], half_width=1.0, maximum_pressure=PRESSURE,
        poissons_ratio=0.3, friction=FRICTION,
    )  # fmt: skip
    limit = FatigueLimit(criterion)
    shear = float(limit.equivalent_shear(stress).max())
    lives = {
        name: math.log10(math.e) * (math.sqrt(3) * shear - limit.bending) / slope for name, slope in SLOPES.items()
    }
    return {"criterion": criterion, "shear": shear, "decades": lives}


def pair(roller: float, disc: float, elongation: float, body: str, reading: str) -> dict[str, Any]:
    """Pitted fraction of a surface after the cycles of the test, with its bracket."""
    from bem.runs import run_scene

    settings = [
        *SETTINGS,
        *(WIDE if elongation < 1 else ()),
        f'lower.surface.rms_height="{1e3 * disc:g} nm"',
        f'upper.surface.rms_height="{1e3 * roller:g} nm"',
        f"lower.surface.elongation={elongation:g}",
        f"upper.surface.elongation={elongation:g}",
        f'fatigue.body="{body}"',
        f"fatigue.slope={SLOPES[reading]:.6g}",
    ]
    with tempfile.TemporaryDirectory() as folder:
        found = run_scene("micropitting-rig", Path(folder) / "run", settings=settings, figures=False, workers=1).summary
    return {
        "roller": roller,
        "disc": disc,
        "elongation": elongation,
        "body": body,
        "reading": reading,
        "status": found["status"],
        "pitted": _last(found["micropitted_share"]),
        "most": _last(found["micropitted_at_most"]),
        "least": _last(found["micropitted_at_least"]),
    }


def _last(value: Any) -> float:
    return float(value[-1] if isinstance(value, list) else value)


def main() -> None:
    """Run, print, store."""
    found: dict[str, Any] = {"smooth": [smooth(criterion) for criterion in CRITERIA], "pairs": []}
    print(rounded(found["smooth"]), flush=True)
    for place, case in enumerate(PAIRS):
        for reading in list(SLOPES)[0 if place < BOTH else 1 :]:
            found["pairs"].append(pair(*case, reading))
            print(rounded(found["pairs"][-1]), flush=True)
    keep(RESULT, rounded(found))


if __name__ == "__main__":
    main()
