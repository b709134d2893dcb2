"""History of benchmark runs: kept in one JSON file, appended to, and two of them compared."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.arguments import named
from bem.benchmarks.floor import Floor
from bem.benchmarks.measure import Point
from bem.benchmarks.record import FORMAT, Run, write_runs
from bem.errors import InputError, ResultsError
from reports.benchmarks.beside import CurveBeside, StressBeside, beside_of

HERE = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class StoredRun(Run):
    """A run with its commit and with what other codes did in it.

    commit : short hash of the source tree. peers : rows of `reports.benchmarks.peers`. peer_curves, peer_stresses :
    empty in runs that did not measure them.
    """

    commit: str = ""
    peers: tuple[dict[str, Any], ...] = ()
    peer_curves: tuple[CurveBeside, ...] = ()
    peer_stresses: tuple[StressBeside, ...] = ()


def stored_run(
    run: Run,
    peers: Sequence[dict[str, Any]] = (),
    curves: Sequence[CurveBeside] = (),
    stresses: Sequence[StressBeside] = (),
) -> StoredRun:
    """Return the run at the present commit, with what other codes did."""
    return StoredRun(
        **vars(run),
        commit=present_commit(),
        peers=tuple(peers),
        peer_curves=tuple(curves),
        peer_stresses=tuple(stresses),
    )


def present_commit() -> str:
    """Return the short hash of the source tree's commit, with "+" if files of bem differ; "" outside of a tree."""

    def git(*arguments: str) -> str:
        try:
            done = subprocess.run(["git", *arguments], cwd=HERE, capture_output=True, text=True, timeout=20, check=True)
        except (OSError, subprocess.SubprocessError):
            return ""
        return done.stdout.strip()

    commit = git("rev-parse", "--short=10", "HEAD")
    return commit + ("+" if commit and git("status", "--porcelain", "--untracked-files=no", "--", "bem") else "")


def read_history(path: Path) -> list[StoredRun]:
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
            f"{path} is not a history of benchmarks ({error}); allowed: a file of python -m reports.benchmarks"
        ) from None


def _run_of(data: dict[str, Any]) -> StoredRun:
    return StoredRun(
        **(
            data
            | {
                "points": tuple(Point.of(item) for item in data["points"]),
                "floor": None if data["floor"] is None else Floor(**data["floor"]),
                "peers": tuple(data.get("peers", ())),
                "peer_curves": tuple(beside_of(CurveBeside, item) for item in data.get("peer_curves", ())),
                "peer_stresses": tuple(beside_of(StressBeside, item) for item in data.get("peer_stresses", ())),
            }
        )
    )


def append_run(path: Path, run: StoredRun) -> None:
    """Add a run to a file, which is replaced whole or not at all.

    Raises
    ------
    ResultsError : the file is no history, or cannot be written; what was there before is untouched.
    """
    write_runs(path, [*read_history(path), run])


def find_run(runs: Sequence[StoredRun], commit: str) -> StoredRun:
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
