"""Micropitted share of scene `micropitting-rig` over how steep its ridges are.

    python -m reports.experiments.micropitting_slopes

Morales-Espejel and Brizmer (2011) find 1 % of the roller micropitted, computed and measured. Their surfaces are not
public: ridges of their Rq are drawn here one to three times as wide as in the scene, which makes them as much less
steep, with as many cells. The Wohler curve loses 43 MPa a decade, and, as it was read before, per factor e. The result
is stored in `reports/results/micropitting_slopes.json`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from bem.scenes import PlainContext, build, get_kind, load_scene
from bem.scenes.axes import with_keys

RESULT = Path(__file__).resolve().parents[1] / "results" / "micropitting_slopes.json"
CASES = ((3, 10.0), (2, 10.0), (1, 10.0), (1, math.e))
"""How many times as wide, and the base of the logarithm over which 43 MPa are lost."""
FIGURES = (
    *("micropitted_share", "micropitted_at_least", "micropitted_at_most", "largest_damage"),
    *("Sq_initial", "Sq_final", "upper_worn_depth", "contact_share_initial", "contact_share_final"),
)


def life(wider: int, base: float) -> dict[str, Any]:
    """Figures of one life, SI, and how steep its disc was."""
    kind = get_kind("running-in-life")
    scene: Any = kind.resolve(load_scene("micropitting-rig"))
    grid = build.grid_of(scene.grid)
    keys: dict[str, Any] = {
        f"{body}.surface.correlation_length": wider * getattr(scene, body).surface.correlation_length
        for body in ("lower", "upper")
    }
    keys |= {"fatigue.slope": -43e6 / math.log(base), "life.coarser_lives": False}
    keys |= {"grid.spacing": (grid.spacing[0], wider * grid.spacing[1])}
    found: Any = kind.run(with_keys(scene, keys), PlainContext(scene.seed))
    across = np.diff(found.height_before, axis=1) / (wider * grid.spacing[1])
    told = {"wider": wider, "base": base, "rms_slope_across": float(np.sqrt(np.mean(across**2)))}
    return told | {name: float(getattr(found, name)) for name in FIGURES}


def main() -> None:
    """All cases, stored."""
    rows = []
    for wider, base in CASES:
        rows.append(life(wider, base))
        print({name: float(f"{value:.4g}") for name, value in rows[-1].items()}, flush=True)
    RESULT.write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
