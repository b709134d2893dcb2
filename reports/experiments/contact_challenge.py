"""The Contact-Mechanics Challenge's parameters on grids of 512 to 4096 cells a side, with adhesion and without.

    python -m reports.experiments.contact_challenge --size 512 1024 2048 4096

The numbers are those of the challenge (Mueser and others, Tribol. Lett. 65 (2017) 118): contact modulus 25 MPa, work of
adhesion 50 mJ/m^2, exponential attraction of range 2.071 nm, mean pressure 250 kPa, a periodic square of 0.1 mm,
Hurst 0.8 between wavelengths of 20 um (flat above) and 0.1 um (none below). The surface is our own draw, with the rms
height that has an rms slope of one with all waves (792 nm). A grid has the waves that two cells resolve; waves that
two grids share are the same.

Four contacts on each grid: without adhesion; with it, the bodies coming from far apart; with it, pressed to twice the
load before; and with the work of adhesion over a range that the cells resolve (an adhesive zone of two cells). Each is
measured in a process of its own, on one thread. The result is stored in `reports/results/contact_challenge.json`, and
drawn for the documentation.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.adhesion import ExponentialAdhesion, solve_adhesive_contact
from bem.adhesion.zone import FEWEST_CELLS, adhesive_zone
from bem.benchmarks.measure import held_memory
from bem.contact.regions import count_spots
from bem.grid import FloatArray
from bem.surfaces.describe import rms_slope, rms_slopes
from bem.threads import set_threads
from reports.experiments.kept import found, keep, result_of

RESULT = result_of("contact_challenge")
PICTURE = Path(__file__).resolve().parents[1] / "docs" / "theory" / "contact-challenge.png"
SIDE, PRESSURE, HURST, ROLLOFF, CUTOFF = 1e-4, 250e3, 0.8, 20e-6, 0.1e-6
RMS_HEIGHT = 792e-9
"""Of the rms slope one with all waves [m]."""
BODY = Body(Material("soft", youngs_modulus=25e6, poissons_ratio=0.0))
"""Contact modulus of 25 MPa on a rigid body; Poisson's ratio acts through the modulus only."""
_MODULUS = BODY.material.plane_strain_modulus
LAW = ExponentialAdhesion(work=0.05, range=2.071e-9)
TOLERANCE = 1e-4
"""Of the attraction over its strength; the area is then known to five digits."""
MOST_STEPS = {2048: 100, 4096: 60}
"""Contacts of the search on large grids, which then ends before the tolerance: on 1024 cells 60 of 474 steps give the
area to 0.06 % and the mean gap to 0.01 nm; the rest follows single cells that open and close."""
WAYS = {
    "without": "without adhesion",
    "towards": "with adhesion, from far apart",
    "back": "with adhesion, from twice the load",
    "resolved": "same work over a range that the cells resolve",
}


def surface_of(cells: int, seed: int = 1) -> tuple[Grid, FloatArray]:
    """Return the grid of so many cells a side and the heights of our draw of the surface [m]."""
    grid = Grid((cells, cells), (SIDE / cells,) * 2, periodic=(True, True))
    shortest = max(CUTOFF, 2 * grid.spacing[0])
    heights = generate_surface(
        grid, rms_height=RMS_HEIGHT, seed=seed, hurst=HURST, rolloff_wavelength=ROLLOFF, cutoff_wavelength=shortest
    )
    return grid, heights


def law_of(way: str, cell: float) -> ExponentialAdhesion:
    """Return the challenge's attraction, or the one of the same work whose zone has two cells."""
    if way != "resolved":
        return LAW
    return ExponentialAdhesion(LAW.work, LAW.range * math.sqrt(FEWEST_CELLS * cell / adhesive_zone(LAW, _MODULUS)))


def one(cells: int, way: str) -> dict[str, Any]:
    """Return figures of one of the `WAYS` on a grid of so many cells a side."""
    set_threads(1)
    grid, heights = surface_of(cells)
    law = law_of(way, grid.spacing[0])
    row: dict[str, Any] = {
        "cells": cells,
        "way": way,
        "range_nm": 1e9 * law.range,
        "cells_in_zone": adhesive_zone(law, _MODULUS) / grid.spacing[0],
        "shortest_wave_nm": 1e9 * max(CUTOFF, 2 * grid.spacing[0]),
        "rms_slope": rms_slope(rms_slopes(heights, grid.spacing, grid.periodic)),
    }
    gap = heights.max() - heights
    del heights
    operator = displacement_operator(grid, BODY)
    load, began = PRESSURE * grid.area, time.process_time()
    if way == "without":
        contact = solve_contact(gap, operator, load=load, tolerance=1e-8)
        row |= {"convolutions": contact.convolutions, "residual": contact.residual, "status": str(contact.status)}
    else:
        limits = {"tolerance": TOLERANCE, "max_steps": MOST_STEPS.get(cells, 1500)}
        pressed = solve_adhesive_contact(gap, operator, law, load=2 * load, **limits) if way == "back" else None
        state = solve_adhesive_contact(gap, operator, law, load=load, start=pressed, **limits)
        contact = state.contact
        row |= {"steps": state.steps, "convolutions": state.convolutions, "residual": state.residual}
        row |= {"status": str(state.status), "mean_attraction_kPa": 1e-3 * float(state.attraction.mean())}
    return row | {
        "contact_area_fraction": contact.contact_area / grid.area,
        "cells_in_contact": contact.counted_area / grid.area,
        "spots": count_spots(contact.pressure, grid),
        "mean_gap_nm": 1e9 * float(contact.gap.mean()),
        "max_pressure_MPa": 1e-6 * contact.maximum_pressure,
        "processor_s": time.process_time() - began,
        "memory_GB": held_memory()[1] / 1e9,
    }


def draw(rows: list[dict[str, Any]], path: Path = PICTURE) -> None:
    """Draw contact area and mean gap over the cell for the documentation."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from bem.plots.style import BLUE, GREEN, PINK, VERMILION, style

    with style():
        figure = Figure(figsize=(7.2, 3.2), layout="constrained")
        FigureCanvasAgg(figure)
        area, mean_gap = figure.subplots(1, 2)
        for (way, name), colour in zip(WAYS.items(), (BLUE, VERMILION, PINK, GREEN), strict=True):
            one = [row for row in rows if row["way"] == way]
            cells = [1e9 * SIDE / row["cells"] for row in one]
            area.semilogx(cells, [100 * row["contact_area_fraction"] for row in one], "o-", color=colour, label=name)
            mean_gap.semilogx(cells, [row["mean_gap_nm"] for row in one], "o-", color=colour)
        area.set_ylabel("contact area (% of the square)")
        mean_gap.set_ylabel("mean gap (nm)")
        area.set_ylim(bottom=0)
        ticks = sorted({1e9 * SIDE / row["cells"] for row in rows})
        for axes in (area, mean_gap):
            axes.set_xlabel("cell (nm)")
            axes.set_xticks(ticks, [f"{tick:.0f}" for tick in ticks])
            axes.set_xticks([], minor=True)
        figure.legend(loc="outside upper center", ncols=2)
        figure.savefig(path, dpi=110)


def main() -> None:
    """Measure each contact in a process of its own; what there is so far is stored after each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, nargs="*", default=[512, 1024, 2048, 4096])
    parser.add_argument("--way", choices=list(WAYS), nargs="+", default=list(WAYS))
    parser.add_argument("--alone", action="store_true", help="measure one contact here and print it")
    given = parser.parse_args()
    if given.alone:
        print(json.dumps(one(given.size[0], given.way[0])))
        return
    order = list(WAYS)
    rows = {(row["cells"], order.index(row["way"])): row for row in found(RESULT.stem)} if RESULT.is_file() else {}
    for cells in given.size:
        for way in given.way:
            command = [sys.executable, "-m", "reports.experiments.contact_challenge"]
            command += ["--size", str(cells), "--way", way, "--alone"]
            done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
            row = json.loads(done.stdout.strip().splitlines()[-1])
            rows[cells, order.index(way)] = row
            keep(RESULT, [rows[key] for key in sorted(rows)])
            print(row, flush=True)
    draw([rows[key] for key in sorted(rows)])


if __name__ == "__main__":
    main()
