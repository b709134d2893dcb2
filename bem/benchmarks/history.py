"""Runs of the benchmarks kept in one JSON file, appended to, and two of them compared."""

from __future__ import annotations

import json
import os
import platform
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import bem
from bem.arguments import named
from bem.benchmarks.beside import CurveBeside, StressBeside, beside_of
from bem.benchmarks.floor import Floor
from bem.benchmarks.measure import Point
from bem.errors import InputError, ResultsError
from bem.results.atomic import replacing

FORMAT = "bem-benchmarks 1"
INTERRUPTED = "interrupted"
"""Among the failures of a run: where it was when it was interrupted."""
PACKAGES = ("bem", "numpy", "scipy", "pyfftw", "numba")


@dataclass(frozen=True)
class Run:
    """One run: what was measured, on what, at which commit. `peers` : rows of `bem.benchmarks.peers`; runs of before
    have neither curves nor stresses beside other codes."""

    commit: str
    date: str
    machine: dict[str, str]
    versions: dict[str, str]
    points: tuple[Point, ...]
    floor: Floor | None = None
    peers: tuple[dict[str, Any], ...] = ()
    failures: dict[str, str] = field(default_factory=dict)
    peer_curves: tuple[CurveBeside, ...] = ()
    peer_stresses: tuple[StressBeside, ...] = ()


def present_commit() -> str:
    """Short hash of the source tree's commit, "+" behind it where files differ from it; "" outside of a tree."""
    here = Path(__file__).resolve().parent

    def git(*arguments: str) -> str:
        try:
            done = subprocess.run(["git", *arguments], cwd=here, capture_output=True, text=True, timeout=20, check=True)
        except (OSError, subprocess.SubprocessError):
            return ""
        return done.stdout.strip()

    commit = git("rev-parse", "--short=10", "HEAD")
    return commit + (
        "+" if commit and git("status", "--porcelain", "--untracked-files=no", "--", here.parent.as_posix()) else ""
    )


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


def new_run(
    points: Sequence[Point],
    floor: Floor | None = None,
    peers: Sequence[dict[str, Any]] = (),
    failures: dict[str, str] | None = None,
    curves: Sequence[CurveBeside] = (),
    stresses: Sequence[StressBeside] = (),
) -> Run:
    """A run of now, here."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    return Run(
        commit=present_commit(),
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
        peers=tuple(peers),
        failures=failures or {},
        peer_curves=tuple(curves),
        peer_stresses=tuple(stresses),
    )


def read_history(path: Path) -> list[Run]:
    """All runs of a file, oldest first; none where there is no file.

    Raises
    ------
    ResultsError : not a file of this kind.
    """
    if not path.is_file():
        return []
    try:
        data = json.loads(path.read_text())
        if data["format"] != FORMAT:
            raise ValueError(f"format {data['format']!r}")
        return [_run_of(item) for item in data["runs"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ResultsError(
            f"{path} is not a history of benchmarks ({error}); allowed: a file that bem bench wrote"
        ) from None


def _run_of(data: dict[str, Any]) -> Run:
    return Run(
        **(
            data
            | {
                "points": tuple(Point.of(item) for item in data["points"]),
                "floor": None if data["floor"] is None else Floor(**data["floor"]),
                "peers": tuple(data["peers"]),
                "peer_curves": tuple(beside_of(CurveBeside, item) for item in data.get("peer_curves", ())),
                "peer_stresses": tuple(beside_of(StressBeside, item) for item in data.get("peer_stresses", ())),
            }
        )
    )


def append_run(path: Path, run: Run) -> None:
    """Add a run to a file, which is replaced whole or not at all.

    Raises
    ------
    ResultsError : the file is no history, or cannot be written; what was there before is untouched.
    """
    runs = [*read_history(path), run]
    text = json.dumps({"format": FORMAT, "runs": [asdict(item) for item in runs]}, indent=1)
    with replacing(path) as temporary:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text + "\n")


def find_run(runs: Sequence[Run], commit: str) -> Run:
    """The latest run at a commit (its first letters suffice), or counted from the end: "-1" is the last.

    Raises
    ------
    InputError : none is found.
    """
    if commit.lstrip("-").isdigit() and commit.startswith("-") and 0 < int(commit[1:]) <= len(runs):
        return runs[int(commit)]
    for run in reversed(runs):
        if run.commit and run.commit.startswith(commit):
            return run
    known = ", ".join(dict.fromkeys(run.commit or "(no commit)" for run in runs)) or "none"
    raise InputError(f"commit {commit!r} has no run in this history; allowed: {known}, or -1 for the last run")


@dataclass(frozen=True)
class Change:
    """A point in two runs. `ratio` of processor times, new over old; `clear` where it exceeds both spreads."""

    case: str
    size: float
    threads: int
    before: float
    after: float
    ratio: float
    clear: bool
    error_ratio: float
    counts: dict[str, tuple[float, float]]


def compare(old: Run, new: Run) -> list[Change]:
    """Points that both runs have. Counts that differ are the surest sign: they do not depend on the machine's mood."""
    known = {(p.case, p.size, p.threads): p for p in old.points}
    changes = []
    for point in new.points:
        before = known.get((point.case, point.size, point.threads))
        if before is None:
            continue
        ratio = point.cpu_median / before.cpu_median if before.cpu_median > 0 else float("nan")
        noise = max(0.05, before.spread + point.spread)
        changes.append(
            Change(
                **named(point, "case size threads"),
                before=before.cpu_median,
                after=point.cpu_median,
                ratio=ratio,
                clear=abs(ratio - 1) > noise,
                error_ratio=point.error / before.error if before.error > 0 else float("nan"),
                counts={
                    name: (before.counts[name], value)
                    for name, value in point.counts.items()
                    if name in before.counts and before.counts[name] != value
                },
            )
        )
    return changes
