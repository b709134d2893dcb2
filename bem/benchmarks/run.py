"""All points of a run, each in its own process."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from bem.benchmarks.cases import CASES, Case
from bem.benchmarks.floor import measure_floor
from bem.benchmarks.measure import Point, measure_apart, named_failure
from bem.benchmarks.names import refuse_unknown
from bem.benchmarks.record import INTERRUPTED, Run, new_run
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
    say: Callable[[str], None] = lambda words: None,
) -> Run:
    """Measure all points of some cases, each in a process of its own.

    A point that fails is named in `failures` and the rest goes on; an interrupt keeps the points there are.
    """
    points: list[Point] = []
    failures: dict[str, str] = {}
    floor = None
    wanted_points = [
        (name, size, count)
        for name in names
        for size in sizes_of(CASES[name], quick=quick, sizes=sizes, limit=limit)
        for count in threads or ((1, 2) if CASES[name].threads else (1,))
    ]
    counts = {count for _, _, count in wanted_points}
    at = "the start"
    try:
        for name, size, count in wanted_points:
            say(at := f"{name}: {size:g} {CASES[name].size_name}, {count} thread{'s' if count > 1 else ''}")
            with named_failure(failures, f"{name} {size:g} ({count})"):
                points.append(measure_apart(name, size, count, min(repeats, CASES[name].most_repeats)))
        if with_floor:
            wanted = {int(p.size) for p in points if p.case.startswith("contact-") and p.size >= 32}
            say(at := "the machine's floor")
            floor = measure_floor(tuple(sorted({240} | wanted)), tuple(sorted(counts)) or (1,))
    except KeyboardInterrupt:
        failures[INTERRUPTED] = f"at {at}; {len(points)} of {len(wanted_points)} points are kept"
    return new_run(points, floor, failures)
