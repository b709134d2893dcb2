"""Peaks of memory: larger cases, each traced in a process of its own.

    python -m reports.golden.memory CASE

Python's and numpy's own allocations are traced, which are the same on every machine; what compiled loops and FFTW take
for themselves is not. A small case runs before, so that nothing is compiled or loaded under the trace.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tracemalloc
from collections.abc import Callable

import numpy as np

from bem import (
    Body,
    Grid,
    Lubricant,
    contact_modulus,
    displacement_operator,
    generate_surface,
    solve_contact,
    solve_line_film,
    solve_mixed,
    solve_point_film,
    subsurface_stress,
)
from reports.golden.films import STEEL
from reports.golden.stored import FOLDER, Difference, as_text
from reports.golden.tolerances import MEMORY

PATH = FOLDER / "memory.json"
OIL = Lubricant(0.05, pressure_viscosity=20e-9, density_law="dowson_higginson")
MODULUS = contact_modulus(STEEL, STEEL)


def _surface(cells: int, periodic: bool) -> tuple[Grid, np.ndarray]:
    grid = Grid((cells, cells), (1e-6, 1e-6), periodic=(True, True))
    height = generate_surface(grid, rms_height=200e-9, correlation_length=10e-6, seed=1)
    return Grid(grid.shape, grid.spacing, periodic=(periodic, periodic)), height


def _contact(small: bool) -> None:
    for periodic in (False, True):
        grid, height = _surface(48 if small else 256, periodic)
        solution = solve_contact(-height, displacement_operator(grid, Body(STEEL)), load=1e8 * grid.area)
        subsurface_stress(solution.pressure, grid, Body(STEEL), np.array([1e-6, 2e-6]), friction=0.1)


def _line_film(small: bool) -> None:
    points = 200 if small else 1000
    solve_line_film(load=5e4, radius=0.01, contact_modulus=MODULUS, speeds=(1.0, 0.9), lubricant=OIL, points=points)


def _point_film(small: bool) -> None:
    cells = 48 if small else 96
    solve_point_film(
        load=20.0, radii=(0.01, 0.01), contact_modulus=MODULUS, speeds=(1.0, 0.9), lubricant=OIL, shape=(cells, cells)
    )


def _mixed(small: bool) -> None:
    cells = 32 if small else 96
    spacing = 120e-6 / cells
    whole = Grid((cells, cells), (spacing, spacing), periodic=(True, True))
    height = generate_surface(whole, rms_height=100e-9, correlation_length=12e-6, seed=1)
    solve_mixed(
        height=height, grid=Grid(whole.shape, whole.spacing, periodic=(False, True)), bodies=(Body(STEEL), Body(STEEL)),
        radius=2e-3, width=6e-3, load=5.5, speeds=(0.05, 0.0), lubricant=OIL, boundary_friction=0.12, film_points=300,
    )  # fmt: skip


CASES: dict[str, Callable[[bool], None]] = {
    "contact": _contact,
    "line-film": _line_film,
    "point-film": _point_film,
    "mixed": _mixed,
}


def peak(case: str) -> float:
    """Peak of a case in this process [MiB]."""
    CASES[case](True)
    tracemalloc.start()
    try:
        CASES[case](False)
        return tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()


def peak_in_process(case: str) -> float:
    """Peak of a case in a process of its own [MiB]."""
    command = [sys.executable, "-m", "reports.golden.memory", case]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def stored() -> dict[str, float]:
    """Stored peaks [MiB] by case."""
    found: dict[str, float] = json.loads(PATH.read_text("utf-8"))
    return found


def store() -> list[Difference]:
    """Measure and store all peaks; return those that moved."""
    before = stored() if PATH.exists() else {}
    now = {case: round(peak_in_process(case), 1) for case in CASES}
    moved = [
        Difference("memory", case, before[case], value, MEMORY * before[case])
        for case, value in now.items()
        if case in before and abs(value - before[case]) > MEMORY * before[case]
    ]
    kept = before | {case: now[case] for case in CASES if case not in before or case in {one.figure for one in moved}}
    PATH.write_text(as_text({case: kept[case] for case in CASES}), "utf-8")
    return moved


if __name__ == "__main__":
    print(peak(sys.argv[1]))
