"""Contact area of rough surfaces from few cells: counted, with the correction by the perimeter, and by the edge inside
cells, against the finest grid; fits what narrow contact and narrow gaps add (`bem.contact.contact_area`) anew.

    python -m reports.experiments.contact_area

Band-limited surfaces, rms slope 0.1, at about 2, 8 and 36 % of contact. Asked for are those of Hurst exponent 0.8,
roll-off 1/4 and cut-off 1/48 of the side, on periodic grids (seeds 1 to 3, 2048 cells a side the finest). The constants
are fitted to seeds 1 and 2 at 512 and 256 cells, and, for pressures constant on cells, to seed 7 on a free grid
(cut-off 1/24, 1024 the finest); seeds 3, 5 (Hurst 0.3, roll-off 1/12, cut-off 1/40) and 8 (free) are held out. The
correction by the perimeter takes (pi - 1 + ln 2) / 24 of a cell times the counted perimeter off the count (Yastrebov,
Anciaux and Molinari, Tribol. Int. 114 (2017) 161). The result is stored in `reports/results/contact_area.json`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.contact.contact_area import contact_region
from bem.grid import FloatArray

RESULT = Path(__file__).resolve().parents[1] / "results" / "contact_area.json"
CELLS = (128, 256, 512, 1024)
LOADS = (0.001, 0.004, 0.02)
"""Mean pressures over E*."""
_STEP = 0.05


@dataclass(frozen=True)
class Surface:
    """A rough surface on a grid of unit length; wave numbers a side."""

    seed: int
    finest: int = 2048
    hurst: float = 0.8
    rolloff: float = 4
    cutoff: float = 48
    periodic: bool = True
    fitted: bool = False

    def heights(self) -> FloatArray:
        """(finest, finest), of rms slope 0.1."""
        grid = Grid((self.finest,) * 2, (1 / self.finest,) * 2, periodic=(True, True))
        return generate_surface(
            grid,
            rms_slope=0.1,
            hurst=self.hurst,
            rolloff_wavelength=1 / self.rolloff,
            cutoff_wavelength=1 / self.cutoff,
            seed=self.seed,
        )


ASKED = (Surface(1, fitted=True), Surface(2, fitted=True), Surface(3))
OTHERS = (
    Surface(5, hurst=0.3, rolloff=12, cutoff=40),
    Surface(7, finest=1024, cutoff=24, periodic=False, fitted=True),
    Surface(8, finest=1024, cutoff=24, periodic=False),
)


def areas(heights: FloatArray, load: float, periodic: bool) -> dict[str, float]:
    """Area fractions of a contact, by the ways of finding them; `bare` without what narrow pieces add, and with a
    twentieth of a cell for contact (`within`) or gap (`beyond`)."""
    n = len(heights)
    grid = Grid((n, n), (1 / n, 1 / n), periodic=(periodic, periodic))
    material = Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)
    solution = solve_contact(-heights, displacement_operator(grid, Body(material)), load=load)
    inside = solution.pressure > 0
    perimeter = sum(np.count_nonzero(inside != np.roll(inside, 1, axis)) for axis in (0, 1)) / n
    found = {
        "counted": solution.counted_area,
        "perimeter": solution.counted_area - (math.pi - 1 + math.log(2)) / 24 * float(perimeter) / n,
        "edge": solution.contact_area,
    }
    for name, ends in (("bare", (0.0, 0.0)), ("within", (_STEP, 0.0)), ("beyond", (0.0, _STEP))):
        found[name] = contact_region(solution.pressure, solution.gap, -heights, grid, 1.0, ends).area
    return found


def rows_of(surface: Surface) -> list[dict[str, Any]]:
    """Relative errors of every way, for every load and number of cells."""
    finest = surface.heights()
    return [row for load in LOADS for row in rows_at(surface, finest, load)]


def rows_at(surface: Surface, finest: FloatArray, load: float) -> list[dict[str, Any]]:
    """Relative errors of every way under one load, for every number of cells; `finest` are the surface's heights."""
    true, rows = areas(finest, load, surface.periodic)["edge"], []
    for cells in (n for n in CELLS if n < surface.finest):
        step = surface.finest // cells
        found = areas(finest[::step, ::step].copy(), load, surface.periodic)
        errors = {way: value / true - 1 for way, value in found.items()}
        rows.append({"seed": surface.seed, "load": load, "area": true, "cells": cells, **errors})
        print({key: round(value, 5) for key, value in rows[-1].items()}, flush=True)
    return rows


def fitted_ends(rows: Sequence[dict[str, Any]]) -> list[float]:
    """What narrow contact and narrow gaps add [cells, times their number], by least squares over these rows, each
    weighed with the square of its number of cells: its error is of second order."""
    weights = np.array([float(row["cells"]) ** 2 for row in rows])
    slopes = np.array([[(row[way] - row["bare"]) / _STEP for way in ("within", "beyond")] for row in rows])
    errors = np.array([row["bare"] for row in rows])
    return np.linalg.lstsq(slopes * weights[:, None], -errors * weights, rcond=None)[0].tolist()


def main() -> None:
    """Print and store."""
    rows = {surface: rows_of(surface) for surface in (*ASKED, *OTHERS)}
    for periodic in (True, False):
        own = [
            row
            for surface, found in rows.items()
            if surface.fitted and surface.periodic == periodic
            for row in found
            if row["cells"] in (256, 512)
        ]
        print("periodic" if periodic else "free", "ends fitted:", np.round(fitted_ends(own), 3))
    stored = {
        "rows": [row for surface in ASKED for row in rows[surface]],
        "others": [row for surface in OTHERS for row in rows[surface]],
    }
    RESULT.write_text(json.dumps(stored, indent=1) + "\n")


if __name__ == "__main__":
    main()
