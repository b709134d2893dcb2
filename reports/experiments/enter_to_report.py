"""From Enter to the report: a built-in scene over the import of the libraries that it needs, in one run.

    python -m reports.experiments.enter_to_report

A minute on a quiet machine. Turn by turn, in processes of their own: the imports, `bem run hertz-sphere` with pictures
and report, and without. A ratio is the median over turns of one turn's processor times (user and system, children
with it) and of its wall times, which on a busy machine are longer for all three. The result is stored in
`reports/results/enter_to_report.json`.
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

from reports.experiments.kept import keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "enter_to_report.json"
LIBRARIES = "import numba, scipy, pyfftw, matplotlib, h5netcdf, pydantic, pint"
TURNS = 7
BEM = str(Path(sys.executable).parent / "bem")


def spent(command: list[str]) -> tuple[float, float]:
    """Processor and wall time [s] of a command with its children."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def main() -> None:
    """All turns; a first one, which fills the caches of the file system, is not counted."""
    ratios: dict[str, list[float]] = {}
    imports = []
    with tempfile.TemporaryDirectory() as folder:
        run = [BEM, "run", "hertz-sphere", "--overwrite", "--out", f"{folder}/run"]
        ways = {"with report": run, "without": [*run, "--no-figures"]}
        for turn in range(TURNS + 1):
            base = spent([sys.executable, "-c", LIBRARIES])
            found = {way: spent(command) for way, command in ways.items()}
            if turn:
                imports.append(base)
                for way, (cpu, wall) in found.items():
                    ratios.setdefault(f"{way}, processor", []).append(cpu / base[0])
                    ratios.setdefault(f"{way}, wall", []).append(wall / base[1])
            print({name: round(values[-1], 2) for name, values in ratios.items()}, flush=True)
    keep(
        RESULT,
        rounded(
            {
                "ratios": {name: statistics.median(values) for name, values in ratios.items()},
                "imports_processor_s": statistics.median(cpu for cpu, _ in imports),
                "imports_wall_s": statistics.median(wall for _, wall in imports),
                "load_average": os.getloadavg()[0],
            }
        ),
    )


if __name__ == "__main__":
    main()
