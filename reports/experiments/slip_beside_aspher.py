"""Partial slip of a ball beside ASPHER's friction solver, in one run on one thread.

    python -m reports.experiments.slip_beside_aspher PYTHON

PYTHON is the interpreter of an environment that has ASPHER (`python -m reports.benchmarks --peers` makes one in
.venv-peers). A ball half as wide as the grid, free, like bodies, friction 0.4, pushed by 0.6 of what friction
carries, from nothing. ASPHER stops by its own criterion (`tol_tangential` as it comes); its residual is the one that
it states, ours is formed anew from the tractions (`TangentialSolution.residual`). Processor times of the tangential
step alone. The result is stored in `reports/results/slip_beside_aspher.json`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from typing import Any

import numpy as np

from bem import Grid, displacement_operator, solve_contact, solve_partial_slip
from bem.benchmarks.measure import THREAD_VARIABLES
from bem.benchmarks.tangential_cases import FRICTION, HALF, SHARE
from reports.experiments.kept import keep, result_of

CELLS = (32, 64)
SIDE, RADIUS = 1.0, 50.0
LOAD = 4 * (SIDE / 4) ** 3 / (3 * RADIUS)
"""Of E* = 1, for a contact half as wide as the grid."""
_SCRIPT = """
import json, sys, time
import numpy as np, aspher
from importlib.metadata import version
n, side, radius, load, friction, share = int(sys.argv[1]), *map(float, sys.argv[2:])
x = ((np.arange(n) + 0.5) / n - 0.5) * side
gap = (x[:, None] ** 2 + x**2) / (2 * radius)
law = aspher.CoulombFriction(friction)
solver = aspher.FrictionSolver(grid_size=n, domain_size=side, E_star=1.0, nu=0.3, model=law)
solver.set_gap(gap.ravel())
solver.step(p_bar=load / side**2)
start = time.process_time()
found = solver.step(q_bar=(share * friction * load / side**2, 0.0), dt=1.0)
spent = time.process_time() - start
print(json.dumps({
    "version": version("aspher"), "cpu": spent, "iterations": found.tangential_iters, "converged": found.converged,
    "residual": max(found.stick_residual, found.slip_residual),
    "sticks": found.n_stick / (found.n_stick + found.n_slip),
}))
"""


def theirs(python: str, cells: int) -> dict[str, Any]:
    """ASPHER's step, and what it says of it."""
    words = [python, "-c", _SCRIPT, str(cells), *map(repr, (SIDE, RADIUS, LOAD, FRICTION, SHARE))]
    alone = os.environ | dict.fromkeys(THREAD_VARIABLES, "1")
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=alone)
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def ours(cells: int) -> dict[str, Any]:
    """The same step here: the median of five, after one that compiles."""
    grid = Grid((cells, cells), (SIDE / cells,) * 2)
    gap = (grid.x[:, None] ** 2 + grid.y**2) / (2 * RADIUS)
    contact = solve_contact(gap, displacement_operator(grid, (HALF, HALF)), load=LOAD)
    force = (SHARE * FRICTION * LOAD, 0.0)
    times = []
    for _ in range(6):
        start = time.process_time()
        found = solve_partial_slip(contact, grid, (HALF, HALF), friction=FRICTION, force=force)
        times.append(time.process_time() - start)
    return {
        "cpu": float(np.median(times[1:])),
        "convolutions": found.convolutions,
        "residual": found.residual,
        "converged": found.status == "converged",
        "sticks": found.stick_area / (found.stick_area + found.slip_area),
    }


def main(python: str) -> None:
    """Both, for all sizes."""
    rows = []
    for cells in CELLS:
        peer, own = theirs(python, cells), ours(cells)
        rows.append({"cells": cells, "aspher": peer, "bem": own, "ratio": peer["cpu"] / own["cpu"]})
        print(rows[-1], flush=True)
    keep(result_of("slip_beside_aspher"), rows)


if __name__ == "__main__":
    main(sys.argv[1])
