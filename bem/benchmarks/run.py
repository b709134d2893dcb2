"""All points of a run, each in its own process."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from bem.benchmarks import peer_curves, peer_stresses
from bem.benchmarks.beside import CurveBeside, StressBeside
from bem.benchmarks.cases import CASES, Case
from bem.benchmarks.floor import measure_floor
from bem.benchmarks.history import INTERRUPTED, Run, new_run
from bem.benchmarks.measure import Point, measure_apart, named_failure
from bem.benchmarks.names import refuse_unknown
from bem.benchmarks.peers import compare_with_peers, environment
from bem.errors import InputError


def check_names(names: Sequence[str] | None) -> list[str]:
    """Names of cases, all where none are given.

    Raises
    ------
    InputError : one message per name that is not known.
    """
    if not names:
        return list(CASES)
    refuse_unknown("--only", names, CASES, "a case")
    return list(names)


def check_sizes(option: str, sizes: Sequence[float] | None, least: int = 1) -> None:
    """Refuse sizes that nothing has.

    Raises
    ------
    InputError : one message per size that is no whole number from `least`.
    """
    wrong = [size for size in sizes or () if not (math.isfinite(size) and size >= least and size == round(size))]
    if wrong:
        raise InputError([f"{option} {size:g}: allowed: whole numbers from {least}" for size in wrong])


def sizes_of(case: Case, *, quick: bool, sizes: Sequence[float] | None, limit: float) -> tuple[float, ...]:
    """Sizes to measure; those that were asked for are never left out."""
    if sizes:
        return tuple(sizes)
    chosen = case.quick if quick else case.sizes
    return tuple(size for size in chosen if case.size_name != "cells a side" or size <= limit)


def run_cases(
    names: Sequence[str],
    *,
    quick: bool = False,
    sizes: Sequence[float] | None = None,
    limit: float = 2048,
    threads: Sequence[int] | None = None,
    repeats: int = 5,
    with_floor: bool = True,
    peers: tuple[Path, tuple[int, ...]] | None = None,
    say: Callable[[str], None] = lambda words: None,
) -> Run:
    """Measure; a point that fails is named in `failures` and the rest goes on. An interrupt keeps what there is."""
    points: list[Point] = []
    failures: dict[str, str] = {}
    floor, rows = None, list[dict[str, Any]]()
    curves, stresses = list[CurveBeside](), list[StressBeside]()
    wanted_points = [
        (name, size, count)
        for name in names
        for size in sizes_of(CASES[name], quick=quick, sizes=sizes, limit=limit)
        for count in threads or ((1, 2) if CASES[name].threads else (1,))
    ]
    counts = {count for _, _, count in wanted_points}
    at = "the start"
    try:
        python = Path() if peers is None else environment(peers[0], say)  # before anything that takes long
        for name, size, count in wanted_points:
            say(at := f"{name}: {size:g} {CASES[name].size_name}, {count} thread{'s' if count > 1 else ''}")
            with named_failure(failures, f"{name} {size:g} ({count})"):
                points.append(measure_apart(name, size, count, min(repeats, CASES[name].most_repeats)))
        if with_floor:
            wanted = {int(p.size) for p in points if p.case.startswith("contact-") and p.size >= 32}
            say(at := "the machine's floor")
            floor = measure_floor(tuple(sorted({240} | wanted)), tuple(sorted(counts)) or (1,))
        for n in () if peers is None else peers[1]:
            at = f"peers at {n}"
            # minutes a solve from 2048 on: once is enough where ratios are of the order of ten
            compare_with_peers(python, n, min(repeats, 3) if n < 2048 else 1, say, rows, failures)
        if peers is not None:
            at = "load-area curves of peers"
            peer_curves.curves_beside(python, quick, min(repeats, 3), say, curves, failures)
            at = "stresses of peers"
            pythons = peer_stresses.interpreters(peers[0], say, failures)
            peer_stresses.stresses_beside(pythons, quick, min(repeats, 3), say, stresses, failures)
    except KeyboardInterrupt:
        failures[INTERRUPTED] = f"at {at}; {len(points)} of {len(wanted_points)} points are kept"
    return new_run(points, floor, rows, failures, curves, stresses)
