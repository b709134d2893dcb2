"""Other codes on the same surface, in an environment of their own: tamaas, ContactMechanics, ASPHER from PyPI.

Here are the environment, how a peer runs, and single contacts; `peer_curves` and `peer_stresses` have the rest. Each
peer solves in its own interpreter and hands back its pressure; its residual is then recomputed here from the pressure
by the routine that judges bem too. bem is timed at the coarsest tolerance whose pressure is at least as good.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bem.benchmarks.contact_cases import MEAN_PRESSURE, PERIODIC, UNIT, common_residual, rough_gap
from bem.benchmarks.measure import THREAD_VARIABLES, Point, named_failure
from bem.errors import InputError
from bem.grid import FloatArray
from reports.benchmarks.point import measure_beside

PACKAGES = ("tamaas", "ContactMechanics", "SurfaceTopography", "aspher", "numpy", "scipy")
TIMER = """
import json, sys, time, numpy as np
folder, pressure, tolerance = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
gap = np.load(folder + "/gap.npy")
n = gap.shape[0]
def held(name):
    try:
        return 1024.0 * int(open("/proc/self/status").read().split(name + ":")[1].split()[0])
    except (OSError, IndexError):
        return 0.0
def keep(solve, **more):
    try:
        open("/proc/self/clear_refs", "w").write("5")
    except OSError:
        pass
    before = held("VmRSS")
    def timed(work):
        times = []
        for _ in range(int(sys.argv[4])):
            start = time.process_time(); result = work(); times.append(time.process_time() - start)
        return times, result
    times, result = timed(solve)
    memory = max(0.0, held("VmHWM") - before)
    np.save(folder + "/result.npy", np.ascontiguousarray(result, dtype=float))
    del result
    others = {name: timed(work) for name, work in more.items()}
    print(json.dumps({"times": times, "memory": memory, "more": {
        name: [times, float(np.max(result))] for name, (times, result) in others.items()}}))
"""
"""Begins every script. `keep` times `solve`, whose result it saves, and other work by name, whose largest number it
tells. A script finds the first array in `gap`, `n` its side, and two numbers in `pressure` and `tolerance`."""
SCRIPTS = {
    "tamaas": """
import tamaas as tm
tm.initialize(1); tm.set_log_level(tm.LogLevel.error)
def solve():
    model = tm.Model(tm.model_type.basic_2d, [1.0, 1.0], [n, n]); model.E = 1.0; model.nu = 0.0
    solver = tm.PolonskyKeerRey(model, np.ascontiguousarray(-gap), tolerance)
    solver.max_iter = 20000
    solver.solve(pressure)
    return np.array(model.traction)
keep(solve)
""",
    "ContactMechanics": """
from ContactMechanics import PeriodicFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from SurfaceTopography import Topography
def solve():
    substrate = PeriodicFFTElasticHalfSpace((n, n), 1.0, (1.0, 1.0))
    system = NonSmoothContactSystem(substrate, Topography(-gap, (1.0, 1.0), periodic=True))
    result = system.minimize_proxy(external_force=pressure, pentol=tolerance * gap.std(),
                                   maxiter=20000)
    force = np.asarray(result.jac)
    return np.abs(force) * n * n
keep(solve)
""",
    "aspher": """
import aspher
def solve():
    result = aspher.solve_nested(n, gap - gap.min(), pressure, 1.0, 1.0, tol=tolerance, backend="periodic")
    return np.array(result.pressure).reshape(n, n)
keep(solve)
""",
}
LIMIT = 1800.0
"""Wall time [s] that a peer may take with all its repeats."""
TOLERANCES = {"tamaas": 1e-8, "ContactMechanics": 1e-5, "aspher": 1e-6}
"""Tolerances, each in the meaning of its code, that give a complementarity near 1e-6, tamaas of 1e-9."""


def environment(
    folder: Path, say: Callable[[str], None], packages: Sequence[str] = PACKAGES, alone: Sequence[str] = ()
) -> Path:
    """The interpreter of the peers' environment, made if it is not there. `alone` : packages without what they ask for.

    Raises
    ------
    InputError : neither uv nor pip can install the peers.
    """
    python = folder / "bin" / "python"
    if (folder / ".installed").is_file():
        return python
    say(f"installing {', '.join([*packages, *alone])} into {folder}")
    begun = (folder / "pyvenv.cfg").is_file()  # and interrupted: uv makes no environment where one is
    uv = shutil.which("uv") or shutil.which("uv", path=str(Path(sys.executable).parent))
    if uv:
        commands = [] if begun else [[uv, "venv", "-q", "--python", sys.executable, str(folder)]]
        install = [uv, "pip", "install", "-q", "--python", str(python)]
    else:
        commands = [[sys.executable, "-m", "venv", str(folder)]]
        install = [str(python), "-m", "pip", "install", "-q"]
    commands += [[*install, *packages], *([[*install, "--no-deps", *alone]] if alone else [])]
    for command in commands:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise InputError(f"--peers: {' '.join(command[:3])} failed ({last}); allowed: a network that reaches PyPI")
    (folder / ".installed").write_text("")
    return python


@dataclass(frozen=True)
class PeerRun:
    """What a script left: processor times [s], memory beyond its inputs [bytes], its result, and of other work by name
    the times [s] with the largest number that it gave."""

    times: list[float]
    memory: float
    result: FloatArray
    more: dict[str, tuple[list[float], float]]


def run_script(
    python: Path,
    what: str,
    script: str,
    array: FloatArray,
    numbers: tuple[float, float],
    repeats: int,
    limit: float = LIMIT,
) -> PeerRun:
    """A script behind `TIMER` in a process of its own, on one thread.

    Raises
    ------
    RuntimeError : it failed; its last line says why.
    """
    with tempfile.TemporaryDirectory() as folder:
        np.save(f"{folder}/gap.npy", array)
        done = subprocess.run(
            [str(python), "-P", "-c", TIMER + script, folder, *map(repr, numbers), str(repeats)],
            capture_output=True,
            text=True,
            timeout=limit,
            env=os.environ | dict.fromkeys(THREAD_VARIABLES, "1"),
            check=False,
        )
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise RuntimeError(f"{what}: {last}")
        told = json.loads(done.stdout.strip().splitlines()[-1])
        result = np.load(f"{folder}/result.npy")
    more = {name: (times, value) for name, (times, value) in told["more"].items()}
    return PeerRun(told["times"], told["memory"], result, more)


def solve_by_peer(
    python: Path, peer: str, gap: FloatArray, repeats: int, limit: float = LIMIT
) -> tuple[list[float], float, FloatArray]:
    """One peer on a gap of side 1: processor times [s], memory beyond its inputs [bytes], pressure (n, n) in E*.

    Raises
    ------
    RuntimeError : it failed; its last line says why.
    """
    what, numbers = f"{peer} at {gap.shape[0]}", (MEAN_PRESSURE, TOLERANCES[peer])
    done = run_script(python, what, SCRIPTS[peer], gap, numbers, repeats, limit)
    return done.times, done.memory, np.maximum(done.result, 0.0)


def run_peer(python: Path, peer: str, cells: int, repeats: int, limit: float = LIMIT) -> dict[str, Any]:
    """One peer on the rough surface: processor times, and its residuals by the common routine."""
    from bem.convolution import displacement_operator
    from bem.grid import Grid

    gap = rough_gap(cells)
    times, _, pressure = solve_by_peer(python, peer, gap, repeats, limit)
    operator = displacement_operator(Grid((cells, cells), (1 / cells, 1 / cells), periodic=PERIODIC), UNIT)
    complementarity, violation = common_residual(pressure, gap, operator)
    return {
        "peer": peer,
        "cells": cells,
        "cpu": times,
        "complementarity": complementarity,
        "violation": violation,
        "load_error": abs(float(pressure.mean()) / MEAN_PRESSURE - 1),
        "contact_fraction": float((pressure > 0).mean()),
    }


def compare_with_peers(
    python: Path,
    cells: int,
    repeats: int,
    say: Callable[[str], None],
    rows: list[dict[str, Any]],
    failures: dict[str, str],
    peers: Sequence[str] = tuple(SCRIPTS),
    limit: float = LIMIT,
) -> None:
    """Add rows of the peers with bem's time at equal or smaller complementarity beside, and what failed."""
    own: dict[int, Point] = {}
    for peer in peers:
        say(f"{peer} at {cells}")
        with named_failure(failures, f"{peer} {cells}"):
            row = run_peer(python, peer, cells, repeats, limit)
            for digits in range(2, 12):
                if digits not in own:
                    own[digits] = measure_beside("peer-tolerance", cells + digits / 100, 1, max(3, repeats))
                if own[digits].errors["complementarity"] <= row["complementarity"]:
                    break
            else:
                failures[f"{peer} {cells}"] = f"no tolerance of bem's has its residual of {row['complementarity']:.1e}"
                continue
            mine = own[digits]
            row |= {
                "bem_cpu": list(mine.cpu),
                "bem_digits": digits,
                "bem_complementarity": mine.errors["complementarity"],
                "bem_convolutions": mine.counts["convolutions"],
                "ratio": float(np.median(row["cpu"])) / mine.cpu_median,
            }
            rows.append(row)
