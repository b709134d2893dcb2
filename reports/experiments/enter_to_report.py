"""From Enter to the report: what a run of a built-in scene takes besides its solvers.

    python -m reports.experiments.enter_to_report             the import of the libraries, over which a run is held
    python -m reports.experiments.enter_to_report scenes      every built-in scene; names after it: these

The first, a minute on a quiet machine: turn by turn, in processes of their own, the imports, `bem run hertz-sphere`
with pictures and report, and without. A ratio is the median over turns of one turn's processor times (user and system,
children with it) and of its wall times, which on a busy machine are longer for all three.

The second, half an hour: `bem run SCENE --workers 1` twice, so that loops are compiled in the second run, which counts
unless the first one is `LONG`. All of its processor time but what was spent while its campaign was computed is outside
of the solvers: the start of Python, imports, the plan, files, pictures, the report. Scenes are kept one by one, each
with the imports right after it: on a machine whose cores are shared, processor time too is up to twice as long.

Python may keep what it compiles of the package's sources, as it does for a user and has done for the libraries. The
result is stored in `reports/results/enter_to_report.json`.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from reports.experiments.kept import found, keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "enter_to_report.json"
LIBRARIES = "import numba, scipy, pyfftw, matplotlib, h5netcdf, pydantic, pint"
TURNS = 7
LONG = 200.0
"""Seconds from which on a scene is run once: compiling is a small part of it."""
BEM = str(Path(sys.executable).parent / "bem")
_KEEPING = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
_ALONE = {**_KEEPING, "OPENBLAS_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1", "BEM_THREADS": "1"}
_TIMED = """
import gc, sys, time
gc.disable()  # as the command does
import bem.runs.scene as runs
from bem.cli import main
compute, spent = runs.compute, []
def timed(*given, **more):
    start = time.process_time()
    try:
        return compute(*given, **more)
    finally:
        spent.append(time.process_time() - start)
runs.compute = timed
sys.argv = ["bem", "run", sys.argv[1], "--workers", "1", "--overwrite", "--out", sys.argv[2]]
try:
    main()
finally:
    print("\\nsolvers", sum(spent), flush=True)
"""


def spent(command: list[str], environment: dict[str, str] = _KEEPING) -> tuple[float, float, str]:
    """Processor and wall time [s] of a command with its children, and what it prints; it may find no convergence."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 3):
        raise RuntimeError(f"{command}: {done.stderr}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall, done.stdout


def scene_names() -> list[str]:
    """Of the built-in scenes."""
    import bem

    return sorted(path.stem for path in (Path(bem.__file__).parent / "kinds").glob("*/examples/*.toml"))


def outside(scene: str, folder: str) -> dict[str, float]:
    """Processor time of a scene's second run, of it what is outside its solvers, and of the imports after it [s]."""
    command = [sys.executable, "-c", _TIMED, scene, folder]
    whole, _, told = spent(command, _ALONE)
    if whole < LONG:
        whole, _, told = spent(command, _ALONE)
    imports, *_ = spent([sys.executable, "-c", LIBRARIES], _ALONE)
    solvers = float(told.rsplit("solvers", 1)[1])
    return {"processor_s": whole, "outside_s": whole - solvers, "imports_s": imports}


def excess(row: dict[str, float]) -> float:
    """How many times what a scene may spend outside its solvers: two seconds, or a fifth of its time."""
    return row["outside_s"] / max(2.0, row["processor_s"] / 5)


def _ratios() -> dict[str, Any]:
    """All turns; a first one, which fills the caches of the file system, is not counted."""
    ratios: dict[str, list[float]] = {}
    imports = []
    with tempfile.TemporaryDirectory() as folder:
        run = [BEM, "run", "hertz-sphere", "--overwrite", "--out", f"{folder}/run"]
        ways = {"with report": run, "without": [*run, "--no-figures"]}
        for turn in range(TURNS + 1):
            base = spent([sys.executable, "-c", LIBRARIES])
            taken = {way: spent(command) for way, command in ways.items()}
            if turn:
                imports.append(base)
                for way, (cpu, wall, _) in taken.items():
                    ratios.setdefault(f"{way}, processor", []).append(cpu / base[0])
                    ratios.setdefault(f"{way}, wall", []).append(wall / base[1])
            print({name: round(values[-1], 2) for name, values in ratios.items()}, flush=True)
    return {
        "ratios": {name: statistics.median(values) for name, values in ratios.items()},
        "imports_processor_s": statistics.median(cpu for cpu, *_ in imports),
        "imports_wall_s": statistics.median(wall for _, wall, _ in imports),
        "load_average": os.getloadavg()[0],
    }


def main(asked: list[str]) -> None:
    """One of the two; the other's part of the result stays."""
    known = found(RESULT.stem) if RESULT.exists() else {}
    if not asked:
        keep(RESULT, known | rounded(_ratios()))
        return
    for scene in asked[1:] or scene_names():
        with tempfile.TemporaryDirectory() as folder:
            row = rounded(outside(scene, folder))
        print(scene, row, f"{excess(row):.2f}", flush=True)
        known["scenes"] = dict(sorted({**known.get("scenes", {}), scene: row}.items()))
        keep(RESULT, known)


if __name__ == "__main__":
    main(sys.argv[1:])
