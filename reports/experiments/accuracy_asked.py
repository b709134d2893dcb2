"""Whether the accuracy that is asked for is met: random scenes of contacts against references four times finer.

    python -m reports.experiments.accuracy_asked [CASES]

Balls and rough patches, free and periodic, elastic and capped, with surfaces of random spectra, ask for 0.5 to 5 % of
all headline figures and give no grid. What they end with is compared with the same bodies on cells (and depths) four
times finer. A row's `bar` is the error that was allowed; what could not be had is no row. The result is stored in
`reports/results/accuracy_asked.json`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bem.campaigns.refine import solve_case
from bem.errors import Status
from bem.scenes import get_kind
from bem.scenes.axes import with_keys
from bem.scenes.context import PlainContext
from bem.scenes.load import scene_from_table
from reports.experiments.judging import Comparison, Experiment, compare_records, main

FINER, MOST_CELLS = 4, 2048


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random scene without a grid."""
    cutoff, steel = 1e-6, {"youngs_modulus": 200e9, "poissons_ratio": 0.3}
    surface = {"kind": "generated", "hurst": float(rng.uniform(0.5, 1)), "cutoff_wavelength": cutoff, "rms_height": 0.0}
    surface["rms_height"] = cutoff * float(10 ** rng.uniform(-2.5, -1.2))
    surface["rolloff_wavelength"] = cutoff * float(rng.uniform(2, 6))
    scene: dict[str, Any] = {
        "kind": "contact",
        "seed": int(rng.integers(1 << 30)),
        "accuracy": float(10 ** rng.uniform(math.log10(0.005), math.log10(0.05))),
        "lower": {"material": steel | {"hardness": float(rng.uniform(2e9, 9e9))}},
        "upper": {"material": {"youngs_modulus": float(10 ** rng.uniform(9.3, 11.5)), "poissons_ratio": 0.3}},
    }
    shape = str(rng.choice(["ball", "rough ball", "patch"], p=[0.2, 0.3, 0.5]))
    if shape != "ball":
        scene["lower"]["surface"] = surface
    if shape == "patch":
        scene["grid"] = {"lengths": cutoff * float(rng.uniform(8, 14)), "periodic": True}
        scene["contact"] = {"mean_pressure": float(10 ** rng.uniform(7, 8.7))}
    else:
        scene["shape"] = {"kind": "sphere", "radius": 2e-5}
        scene["contact"] = {"load": float(10 ** rng.uniform(-4, -3))}
        scene["outputs"] = {"von_mises": shape == "ball", "vtk": False}
    if rng.random() < 0.4:
        scene["contact"]["behaviour"] = "capped"
    return scene


def solve(table: dict[str, Any]) -> Comparison | None:
    """Figures of a scene, the errors allowed, and figures on four times the cells a side."""
    kind, context = get_kind("contact"), PlainContext(table["seed"])
    scene: Any = kind.resolved(scene_from_table(table))
    found: Any = solve_case(kind, scene, context)
    shape = (FINER * len(found.x), FINER * len(found.y))
    if found.status is not Status.CONVERGED or max(shape) > MOST_CELLS:
        return None
    spacing = tuple(length / n for length, n in zip(_lengths(found), shape, strict=True))
    finer = {"accuracy": None, "grid.shape": shape, "grid.spacing": spacing, "outputs.errors": False}
    if found.depth is not None:
        finer["outputs.depths.count"] = FINER * (len(found.depth) - 1) + 1
    truth: Any = kind.run(with_keys(scene, finer), context)
    names = list(found.refinement["levels"][-1]["errors"])
    allowed = {
        name: table["accuracy"]
        * (found.contact_area_fraction if name.startswith("plastic") else abs(getattr(found, name)))
        for name in names
    }
    return compare_records(found, truth, allowed, names)


def _lengths(found: Any) -> tuple[float, float]:
    """Sides of the grid of a record [m]."""
    x, y = (axis[1] - axis[0] for axis in (found.x, found.y))
    return float(x) * len(found.x), float(y) * len(found.y)


EXPERIMENT = Experiment("accuracy_asked", draw, solve, cases=60, seed=14)

if __name__ == "__main__":
    main(EXPERIMENT)
