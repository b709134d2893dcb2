"""How many bytes a cell the surface and the contact of a large periodic grid take, and how long: a fresh process each.

    python -m reports.experiments.large_contact --size 1024 2048 4096
    python -m reports.experiments.large_contact --size 2048 4096 --run

A self-affine surface (H 0.8, roll-off at a quarter of the side, shortest waves of 8 cells, Sq 0.5 um on 16384 cells of
61 nm) is pressed on a flat with E* 231 GPa at 500 MPa, elastic, to a residual of 1e-6. Cells and shortest waves are
those of the largest grid, so that a smaller one is a piece of it in length. Memory is the peak of the process beyond
what it held before, the gap counted with the contact; everything is in double but the search (`bem plan`). Sizes that
the result has already are kept. With `--run` the same is a scene for `bem run`, with its error bars, results and
pictures: the most that the command and its copies hold, interpreter and libraries included (up to 200 MB, 48 bytes a
cell of 2048 x 2048), beside what `bem plan` says. The result is stored in `reports/results/large_contact.json`.

16384 x 16384 cells take some 17 GB; nothing else should want memory then.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.benchmarks.measure import forget_peak, held_memory
from bem.runs.scene import plan_scene
from bem.scenes.load import dump_scene
from bem.threads import set_threads

RESULT = Path(__file__).resolve().parents[1] / "results" / "large_contact.json"
CELL = 1e-3 / 16384
"""Spacing [m]."""
PRESSURE, TOLERANCE = 500e6, 1e-6


def one(cells: int, threads: int) -> dict[str, Any]:
    """Surface and contact on a grid of so many cells a side: bytes a cell, seconds, and what was found."""
    set_threads(threads)
    solve_on(64)  # compiled loops and libraries are no part of it
    grid = grid_of(cells)
    forget_peak()
    before, began, work = held_memory()[0], time.perf_counter(), time.process_time()
    gap = generate_surface(
        grid,
        rms_height=5e-7 * (cells / 16384) ** 0.8,
        seed=3,
        hurst=0.8,
        rolloff_wavelength=grid.lengths[0] / 4,
        cutoff_wavelength=8 * CELL,
    )
    surface = {
        "surface_bytes_a_cell": (held_memory()[1] - before) / grid.cells,
        "surface_wall_s": time.perf_counter() - began,
        "surface_processor_s": time.process_time() - work,
    }
    np.subtract(gap.max(), gap, out=gap)
    forget_peak()
    began, work = time.perf_counter(), time.process_time()
    operator = displacement_operator(grid, STEEL)
    solution = solve_contact(gap, operator, load=PRESSURE * grid.area, tolerance=TOLERANCE)
    return surface | {
        "contact_bytes_a_cell": (held_memory()[1] - before) / grid.cells,
        "contact_wall_s": time.perf_counter() - began,
        "contact_processor_s": time.process_time() - work,
        "convolutions": solution.convolutions,
        "residual": solution.residual,
        "status": str(solution.status),
        "contact_area_fraction": solution.contact_area / grid.area,
        "cells_in_contact": solution.counted_area / grid.area,
        "maximum_pressure_GPa": solution.maximum_pressure / 1e9,
    }


STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))


def grid_of(cells: int) -> Grid:
    """So many cells a side, periodic."""
    return Grid((cells, cells), (CELL, CELL), periodic=(True, True))


def solve_on(cells: int) -> None:
    """A small contact."""
    grid = grid_of(cells)
    heights = generate_surface(grid, rms_height=1e-8, seed=1, hurst=0.8, cutoff_wavelength=8 * CELL)
    solve_contact(heights.max() - heights, displacement_operator(grid, STEEL), load=PRESSURE * grid.area)


def scene_of(cells: int) -> dict[str, Any]:
    """The contact as a scene, as one writes it; its surface has another seed."""
    return {
        "kind": "contact",
        "name": "large",
        "seed": 3,
        "grid": {"shape": cells, "lengths": f"{1e6 * cells * CELL!r} um", "periodic": True},
        "lower": {
            "material": {"name": "steel", "youngs_modulus": "210 GPa", "poissons_ratio": 0.3},
            "surface": {
                "kind": "generated",
                "rms_height": f"{500 * (cells / 16384) ** 0.8!r} nm",
                "hurst": 0.8,
                "rolloff_wavelength": f"{1e6 * cells * CELL / 4!r} um",
                "cutoff_wavelength": f"{1e6 * 8 * CELL!r} um",
            },
        },
        "contact": {"mean_pressure": "500 MPa", "tolerance": TOLERANCE},
    }


def whole_run(cells: int, threads: int) -> dict[str, Any]:
    """The scene by `bem run` in a process of its own: bytes a cell at its peak, what was planned, seconds.

    Raises
    ------
    RuntimeError : the run failed; its last words."""
    scene, planned = plan_scene(scene_of(cells))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.toml"
        path.write_text(dump_scene(scene))
        out = Path(folder) / "run"
        command = [sys.executable, "-m", "bem", "run", str(path), "--out", str(out)]
        began, peak = time.perf_counter(), 0.0
        with subprocess.Popen(
            command,
            env=os.environ | {"BEM_THREADS": str(threads)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        ) as run:
            while run.poll() is None:
                peak = max(peak, _held(run.pid))
                time.sleep(0.05)
            assert run.stderr is not None
            words = run.stderr.read()
        wall = time.perf_counter() - began
        if run.returncode != 0:
            raise RuntimeError(words)
        peak = max(peak, 1024.0 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
        summary = json.loads((out / "summary.json").read_text())
        pictures = len(list((out / "figures").glob("*.png")))
    return {
        "run_bytes_a_cell": peak / cells**2,
        "planned_bytes_a_cell": planned.memory / cells**2,
        "run_wall_s": wall,
        "run_pictures": pictures,
        "run_status": summary["status"],
        "run_area_error": summary["contact_area_fraction_error"],
    }


def _held(number: int) -> float:
    """Bytes that a process holds, and its copies alone; zero once it is gone."""
    total = 0.0
    with contextlib.suppress(OSError, ProcessLookupError):
        total += _bytes(Path(f"/proc/{number}/status").read_text(), "VmRSS")
        for copy in Path(f"/proc/{number}/task/{number}/children").read_text().split():
            with contextlib.suppress(OSError):
                total += _bytes(Path(f"/proc/{copy}/smaps_rollup").read_text(), "Private_Dirty")
    return total


def _bytes(text: str, name: str) -> float:
    found = re.search(rf"{name}:\s+(\d+) kB", text)
    return 1024.0 * int(found.group(1)) if found else 0.0


def main() -> None:
    """Each size in a process of its own; the results so far are stored after each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, nargs="+", default=[1024, 2048, 4096])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--run", action="store_true", help="measure whole runs, beside what there is")
    parser.add_argument("--alone", action="store_true", help="measure one size here and print it")
    given = parser.parse_args()
    if given.alone:
        print(json.dumps((whole_run if given.run else one)(given.size[0], given.threads)))
        return
    rows: dict[str, Any] = json.loads(RESULT.read_text()) if RESULT.is_file() else {}
    for cells in given.size:
        command = [sys.executable, "-m", "reports.experiments.large_contact", "--alone", "--size", str(cells)]
        command += ["--threads", str(given.threads), *(["--run"] if given.run else [])]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        found = json.loads(done.stdout.strip().splitlines()[-1])
        rows[str(cells)] = rows.get(str(cells), {}) | {"threads": given.threads} | found
        ordered = {key: rows[key] for key in sorted(rows, key=int)}
        RESULT.write_text(json.dumps(ordered, indent=1) + "\n")
        print(cells, rows[str(cells)], flush=True)


if __name__ == "__main__":
    main()
