"""Record of a run: what was measured, when, on what machine, and its JSON file."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import bem
from bem.benchmarks.floor import Floor
from bem.benchmarks.measure import Point
from bem.results.atomic import replacing

FORMAT = "bem-benchmarks 1"
"""Format of a JSON file of runs."""
INTERRUPTED = "interrupted"
"""Key of an interrupt among the failures of a run; its text says where the run was."""
PACKAGES = ("bem", "numpy", "scipy", "pyfftw", "numba")


@dataclass(frozen=True)
class Run:
    """One run of the benchmarks.

    date : UTC, ISO 8601. machine : processor, cores, system, Python and load average. versions : of the packages.
    failures : why a point failed, by its name.
    """

    date: str
    machine: dict[str, str]
    versions: dict[str, str]
    points: tuple[Point, ...]
    floor: Floor | None = None
    failures: dict[str, str] = field(default_factory=dict)


def new_run(points: Sequence[Point], floor: Floor | None = None, failures: dict[str, str] | None = None) -> Run:
    """Return the record of a run that ends now on this machine."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    return Run(
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        machine={
            "processor": _processor(),
            "cores": str(os.cpu_count()),
            "system": f"{platform.system()} {platform.machine()}",
            "python": platform.python_version(),
            "load average at the end": f"{load:.1f}",
        },
        versions={name: _version(name) for name in PACKAGES},
        points=tuple(points),
        floor=floor,
        failures=failures or {},
    )


def write_runs(path: Path, runs: Sequence[Run]) -> None:
    """Write runs as JSON; the file is replaced whole or not at all.

    Raises
    ------
    ResultsError : the file cannot be written.
    """
    text = json.dumps({"format": FORMAT, "runs": [asdict(run) for run in runs]}, indent=1)
    with replacing(path) as temporary:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text + "\n")


def _version(package: str) -> str:
    if package == "bem":  # the distribution has another name
        return str(bem.__version__)
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
