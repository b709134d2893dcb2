"""A periodic contact of 8192 x 8192 cells to 1e-11 on one thread, beside the time that ASPHER's project page publishes.

    python -m reports.experiments.large_published [--size 8192]

Surface and bodies are those of `reports.experiments.large_contact`, at a pressure at which 8 % of the cells touch.
ASPHER's page (version 0.1.3, package index) says: "Periodic nested solve, Ns=8192, 8% contact, tol 1e-11: 62 s on 10
threads / 161 s on 1 (49 it)", on a workstation with 20 cores, for self-affine roughness of a fixed band that it does
not give. It was not run here. Beside bem's own residual, complementarity and penetration are formed anew from the
pressure, over the rms height of the gap, since ASPHER certifies a duality gap and the penetration. Processor time and
the load of the machine are stored; the result is `reports/results/large_published.json`.
"""

from __future__ import annotations

import argparse
import os
import time
from typing import Any

import numpy as np

from bem import displacement_operator, generate_surface, solve_contact
from bem.benchmarks.measure import forget_peak, held_memory
from bem.benchmarks.record import new_run
from bem.convolution import set_spectra_memory, spectra_memory
from bem.threads import set_threads
from reports.benchmarks.history import present_commit
from reports.experiments.kept import keep, result_of
from reports.experiments.large_contact import CELL, STEEL, grid_of, solve_on

RESULT = result_of("large_published")
PRESSURE, TOLERANCE = 565e6, 1e-11
PUBLISHED = {
    "code": "ASPHER 0.1.3",
    "cells": 8192,
    "wall_s": 161.0,
    "iterations": 49,
    "tolerance": 1e-11,
    "contact_fraction": 0.08,
    "operator_bytes_a_cell": 13.0,
}
"""Of ASPHER's project page; its 13 bytes a cell are those of the operator of free surfaces, without the fields."""


def one(cells: int) -> dict[str, Any]:
    """Return time, memory and residuals of the contact on a grid of so many cells a side."""
    set_threads(1)
    solve_on(64)  # compiled loops and libraries are no part of it
    grid = grid_of(cells)
    forget_peak()
    before = held_memory()[0]
    gap = generate_surface(
        grid,
        rms_height=5e-7 * (cells / 16384) ** 0.8,
        seed=3,
        hurst=0.8,
        rolloff_wavelength=grid.lengths[0] / 4,
        cutoff_wavelength=8 * CELL,
    )
    np.subtract(gap.max(), gap, out=gap)
    forget_peak()
    began, work = time.perf_counter(), time.process_time()
    operator = displacement_operator(grid, STEEL)
    solution = solve_contact(gap, operator, load=PRESSURE * grid.area, tolerance=TOLERANCE)
    spent = {"processor_s": time.process_time() - work, "wall_s": time.perf_counter() - began}
    peak = held_memory()[1] - before
    set_spectra_memory(0)  # those of coarser grids are no part of the operator
    set_spectra_memory(1 << 31)
    displacement_operator(grid, STEEL)(gap)
    pressure, spread = solution.pressure, float(gap.std())
    opened = solution.gap
    return spent | {
        "cells": cells,
        "bytes_a_cell": peak / grid.cells,
        "operator_bytes_a_cell": spectra_memory() / grid.cells,
        "convolutions": solution.convolutions,
        "iterations": solution.iterations,
        "residual": solution.residual,
        "status": str(solution.status),
        "complementarity": float((pressure * np.abs(opened)).sum() / pressure.sum() / spread),
        "penetration": max(0.0, -float(opened.min())) / spread,
        "load_error": abs(float(pressure.mean()) / PRESSURE - 1),
        "contact_fraction": solution.counted_area / grid.area,
        "load_average": round(os.getloadavg()[0], 1),
        "date": new_run([]).date,
        "commit": present_commit(),
    }


def main() -> None:
    """Measure once and store the row."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=PUBLISHED["cells"])
    given = parser.parse_args()
    found = {"bem": one(given.size), "published": PUBLISHED}
    print(found)
    if given.size == PUBLISHED["cells"]:
        keep(RESULT, found)


if __name__ == "__main__":
    main()
