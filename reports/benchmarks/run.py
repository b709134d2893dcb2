"""Runs of the benchmarks with other codes beside bem."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from bem.benchmarks.record import INTERRUPTED, Run
from reports.benchmarks import peer_curves, peer_figures, peer_stresses
from reports.benchmarks.beside import CurveBeside, StressBeside
from reports.benchmarks.history import StoredRun, stored_run
from reports.benchmarks.peers import compare_with_peers


def add_peers(
    run: Run, folder: Path, python: Path, sizes: Sequence[int], quick: bool, repeats: int, say: Callable[[str], None]
) -> StoredRun:
    """Measure contacts, load-area curves and stresses of other codes, and return them with the run.

    What fails is named in `failures` and the rest goes on; an interrupt keeps what was measured.

    Parameters
    ----------
    run : bem's own points.
    folder, python : environment of the peers and its interpreter.
    sizes : cells a side of the contacts.
    quick : small sizes of curves and stresses.
    repeats : timed solves.
    say : called with what begins.
    """
    failures = dict(run.failures)
    rows, curves, stresses = list[dict[str, Any]](), list[CurveBeside](), list[StressBeside]()
    at = "the start"
    try:
        for n in sizes:
            at = f"peers at {n}"
            # one repeat from 2048 cells on: a solve takes minutes
            compare_with_peers(python, n, min(repeats, 3) if n < 2048 else 1, say, rows, failures)
        at = "load-area curves of peers"
        peer_curves.curves_beside(python, quick, min(repeats, 3), say, curves, failures)
        at = "stresses of peers"
        pythons = peer_stresses.interpreters(folder, say, failures)
        peer_stresses.stresses_beside(pythons, quick, min(repeats, 3), say, stresses, failures)
    except KeyboardInterrupt:
        failures[INTERRUPTED] = f"at {at}; {len(run.points)} points are kept"
    return stored_run(replace(run, failures=failures), rows, curves, stresses)


def add_figures_of_peers(run: Run, python: Path, quick: bool, repeats: int, say: Callable[[str], None]) -> StoredRun:
    """Measure physical figures of other codes, and return them with the run (see `add_peers`)."""
    failures = dict(run.failures)
    rows: list[dict[str, Any]] = []
    try:
        peer_figures.figures_of_peers(python, quick, repeats, say, rows, failures)
    except KeyboardInterrupt:
        failures[INTERRUPTED] = f"at figures of peers; {len(run.points)} points are kept"
    return stored_run(replace(run, failures=failures), rows)
