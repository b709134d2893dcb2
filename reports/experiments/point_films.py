"""Point films from nothing: random contacts over loads, oils, ellipses and directions; which have a film, at what cost.

    python -m reports.experiments.point_films

A quarter of an hour. Each contact is tried on 48 cells a side, where that has no film on 96, with either cavitation in
turn. The result is stored in `reports/results/point_films.json`: a row for each contact, and shares.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

from bem import InputError, Lubricant, PointFilmSolution, solve_point_film
from bem.lubrication.cavitation import Cavitation
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "point_films.json"
MODULUS, RADIUS, ALPHA, VISCOSITY = 1.15e11, 0.01, 22e-9, 0.04
LOADS, OILS, RATIOS = (1.0, 2e4), (0.0, 25.0), (0.05, 20.0)
"""Moes' M (evenly over its logarithm) and L, and Rx/Ry (over its logarithm); half of the contacts at an angle."""
CONTACTS, SEED = 300, 19
CELLS = (48, 96)
STORED_EVERY = 25


def film(
    load: float, oil: float, ratio: float, angle: float, cells: int, cavitation: Cavitation = Cavitation.SWIFT_STIEBER
) -> PointFilmSolution:
    """Of Moes' M and L (with the radius along x), Rx/Ry and a direction [rad]: steel, Roelands' oil."""
    reduced = 2 * MODULUS
    number = (max(oil, 1e-3) / (ALPHA * reduced)) ** 4
    half = 0.5 * number * reduced * RADIUS / VISCOSITY
    return solve_point_film(
        load=load * reduced * RADIUS**2 * number**0.75,
        radii=(RADIUS, RADIUS / ratio),
        contact_modulus=MODULUS,
        speeds=((half * math.cos(angle), half * math.sin(angle)),) * 2,
        lubricant=Lubricant(VISCOSITY, pressure_viscosity=ALPHA, density_law="dowson_higginson"),
        shape=(cells, cells),
        cavitation=cavitation,
    )


def tried(load: float, oil: float, ratio: float, angle: float, cavitation: Cavitation) -> dict[str, Any]:
    """A contact on finer and finer grids, until there is a film."""
    row: dict[str, Any] = {"load": load, "oil": oil, "ratio": ratio, "angle_deg": math.degrees(angle)}
    row["cavitation"] = cavitation.value
    for cells in CELLS:
        try:
            found = film(load, oil, ratio, angle, cells, cavitation)
        except InputError as error:  # across a narrow ellipse M is another, and may be out of range
            return row | {"cells": cells, "status": "refused", "words": str(error)}
        row |= {
            "cells": cells,
            "status": found.status.value,
            "newton_steps": found.iterations,
            "cycles": found.cycles,
            "convolutions": round(found.convolutions),
            "residual": float(f"{found.residual:.2g}") if math.isfinite(found.residual) else None,
            "mass_imbalance": float(f"{found.mass_imbalance:.2g}") if math.isfinite(found.mass_imbalance) else None,
            "maximum_pressure_GPa": round(found.maximum_pressure / 1e9, 3),
        }
        if row["status"] == "converged":
            break
    return row


def main(count: int = CONTACTS) -> None:
    """Try them all and store what came out."""
    rng = np.random.default_rng(SEED)
    rows: list[dict[str, Any]] = []
    for number in range(count):
        load, ratio = (math.exp(rng.uniform(*np.log(ends))) for ends in (LOADS, RATIOS))
        oil, angle = rng.uniform(*OILS), rng.uniform(0, 2 * math.pi)
        angle = angle if rng.random() < 0.5 else 0.0
        rows.append(tried(load, oil, ratio, angle, list(Cavitation)[number % len(Cavitation)]))
        print(rows[-1], flush=True)
        if len(rows) % STORED_EVERY == 0 or len(rows) == count:
            keep(RESULT, {"asked": count, "shares": _shares(rows), "contacts": rows})


def _shares(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Of the contacts that were not refused, those with a film on so many cells a side."""
    solved = [row for row in rows if row["status"] != "refused"]
    shares = {
        str(cells): sum(row["status"] == "converged" and row["cells"] <= cells for row in solved) / len(solved)
        for cells in CELLS
    }
    return shares | {"refused": len(rows) - len(solved)}


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CONTACTS)
