"""Contact area of rough surfaces from few cells: counted, with the correction by the perimeter, and by the edge inside
cells, against 2048 cells a side.

    python -m reports.experiments.contact_area

Periodic band-limited surfaces (Hurst 0.8, roll-off 1/4 and cut-off 1/48 of the side, rms slope 0.1) at about 2, 8 and
36 % of contact. The correction takes (pi - 1 + ln 2) / 24 of a cell times the counted perimeter off the count
(Yastrebov, Anciaux and Molinari, Tribol. Int. 114 (2017) 161). The result is stored in
`reports/results/contact_area.json`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.grid import FloatArray

RESULT = Path(__file__).resolve().parents[1] / "results" / "contact_area.json"
FINEST, CELLS = 2048, (128, 256, 512, 1024)
LOADS = (0.001, 0.004, 0.02)
"""Mean pressures over E*."""
SEEDS = (1, 2, 3)
WAYS = ("counted", "perimeter", "edge")


def areas(heights: FloatArray, load: float) -> dict[str, float]:
    """Area fractions of a contact, by the ways of finding them."""
    n = len(heights)
    grid = Grid((n, n), (1 / n, 1 / n), periodic=(True, True))
    material = Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)
    solution = solve_contact(-heights, displacement_operator(grid, Body(material)), load=load)
    inside = solution.pressure > 0
    perimeter = sum(np.count_nonzero(inside != np.roll(inside, 1, axis)) for axis in (0, 1)) / n
    counted = solution.counted_area
    corrected = counted - (math.pi - 1 + math.log(2)) / 24 * perimeter / n
    return {"counted": counted, "perimeter": corrected, "edge": solution.contact_area}


def rows_of(seed: int) -> list[dict[str, Any]]:
    """Relative errors of every way, for every load and number of cells."""
    grid = Grid((FINEST, FINEST), (1 / FINEST, 1 / FINEST), periodic=(True, True))
    finest = generate_surface(
        grid, rms_slope=0.1, hurst=0.8, rolloff_wavelength=1 / 4, cutoff_wavelength=1 / 48, seed=seed
    )
    rows = []
    for load in LOADS:
        true = areas(finest, load)["edge"]
        for cells in CELLS:
            step = FINEST // cells
            found = areas(finest[::step, ::step].copy(), load)
            errors = {way: found[way] / true - 1 for way in WAYS}
            rows.append({"seed": seed, "load": load, "area": true, "cells": cells, **errors})
    return rows


def main() -> None:
    """Print and store."""
    rows = [row for seed in SEEDS for row in rows_of(seed)]
    for row in rows:
        print({key: round(value, 5) for key, value in row.items()})
    RESULT.write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
