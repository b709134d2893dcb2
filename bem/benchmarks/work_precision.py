"""Processor time and memory against the error of physical figures, and the time that an asked-for error takes.

The reference of a figure comes from the two finest grids, by the order that its kind converges with. An error counts as
reached at a grid if all finer ones have it too. Where a curve ends before, its last two grids say how it goes on: such
a time is marked.
Verified in tests/benchmarks/test_work_precision.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bem.benchmarks.measure import Point, measure_apart, named_failure
from bem.benchmarks.names import refuse_unknown
from bem.benchmarks.physical_cases import PHYSICAL, RAW, PhysicalCase, size_and_digits
from bem.benchmarks.record import INTERRUPTED, Run, new_run

TARGETS = (0.1, 0.03, 0.01, 0.003)
OURS, CELLS_ALONE = "bem", "bem, cells alone"
_LEAST_ORDER = 0.3
"""Errors that fall more slowly than with this power of the time are not drawn on."""


@dataclass(frozen=True)
class Curve:
    """Errors of a figure over grids, coarsest first. `digits` of the tolerance asked for, 0 of another code.

    times : processor time [s]. memory : beyond the inputs [bytes]. errors : relative.
    """

    kind: str
    figure: str
    solver: str
    digits: int
    sizes: tuple[int, ...]
    times: tuple[float, ...]
    memory: tuple[float, ...]
    errors: tuple[float, ...]


@dataclass(frozen=True)
class Reach:
    """Processor time [s] at which an error is reached, and whether a grid was solved that has it."""

    time: float
    measured: bool


def check_kinds(names: Sequence[str]) -> list[str]:
    """Kinds by their names; "all" stands for all.

    Raises
    ------
    InputError : one message for each name that is not known.
    """
    allowed = [*PHYSICAL, "all"]
    refuse_unknown("--kind", names, allowed, "measured")
    return list(PHYSICAL) if "all" in names else list(dict.fromkeys(names))


def measure_kinds(
    kinds: Sequence[str],
    *,
    quick: bool = False,
    repeats: int = 3,
    say: Callable[[str], None] = lambda words: None,
) -> Run:
    """Measure all points of some kinds, each in a process of its own.

    A point that fails is named in `failures` and the rest goes on; an interrupt keeps the points there are.
    """
    points: list[Point] = []
    failures: dict[str, str] = {}
    at = "the start"
    try:
        for case in (PHYSICAL[kind] for kind in kinds):
            for code in case.points(quick=quick):
                size, digits = size_and_digits(code)
                say(at := f"{case.kind}: {size} {case.size_name}, {digits} digits")
                with named_failure(failures, f"{case.kind} {size} ({digits})"):
                    points.append(measure_apart(case.name, code, 1, repeats))
    except KeyboardInterrupt:
        failures[INTERRUPTED] = f"at {at}; {len(points)} points are kept"
    return new_run(points, None, failures)


def reference(case: PhysicalCase, points: Sequence[Point]) -> dict[str, float]:
    """Figures of the limit of fine grids, from the two finest of the points with the most digits."""
    most = sorted((p for p in points if size_and_digits(p.size)[1] == case.digits[-1]), key=lambda p: p.size)[-2:]
    if len(most) < 2:
        return {}
    coarse, fine = (point.values for point in most)
    ratio = size_and_digits(most[1].size)[0] / size_and_digits(most[0].size)[0]
    return {
        name: fine[name] + (fine[name] - coarse[name]) / (ratio**case.order - 1)
        for name in fine
        if not name.startswith(RAW)
    }


def curves(run: Run) -> list[Curve]:
    """All curves of a run; the finest grid, which the reference comes from, is left out."""
    found = []
    for case in PHYSICAL.values():
        points = [p for p in run.points if p.case == case.name]
        limits = reference(case, points)
        finest = max((size_and_digits(p.size)[0] for p in points), default=0)
        for name, limit in limits.items():
            for digits in case.digits:
                own = sorted((p for p in points if size_and_digits(p.size)[1] == digits), key=lambda p: p.size)
                own = [p for p in own if size_and_digits(p.size)[0] < finest]
                for solver, key in ((OURS, name), (CELLS_ALONE, RAW + name)):
                    if own and key in own[0].values:
                        found.append(_curve(case.kind, name, solver, digits, own, key, limit))
    return found


def _curve(kind: str, figure: str, solver: str, digits: int, points: Sequence[Point], key: str, limit: float) -> Curve:
    return Curve(
        kind,
        figure,
        solver,
        digits,
        tuple(size_and_digits(p.size)[0] for p in points),
        tuple(p.cpu_median for p in points),
        tuple(p.memory for p in points),
        tuple(abs(p.values[key] / limit - 1) if limit else math.nan for p in points),
    )


def time_to_reach(curve: Curve, target: float) -> Reach | None:
    """The least processor time at which this grid and all finer ones have at most the error; None where the curve does
    not lead there."""
    reached = None
    for time, error in zip(reversed(curve.times), reversed(curve.errors), strict=True):
        if not error <= target:
            break
        reached = time if reached is None else min(reached, time)
    if reached is not None:
        return Reach(reached, True)
    if len(curve.times) < 2 or not curve.errors[-1] > 0:
        return None
    (first, last), (before, after) = curve.times[-2:], curve.errors[-2:]
    order = math.log(before / after) / math.log(last / first) if last > first and before > 0 else 0.0
    return Reach(last * (after / target) ** (1 / order), False) if order > _LEAST_ORDER else None


def best(found: Sequence[Curve], kind: str, figure: str, solver: str) -> list[Reach | None]:
    """The least time of all tolerances for each of the targets; what was measured goes before what was drawn on."""
    own = [c for c in found if (c.kind, c.figure, c.solver) == (kind, figure, solver)]
    least: list[Reach | None] = []
    for target in TARGETS:
        reaches = [r for r in (time_to_reach(c, target) for c in own) if r is not None]
        least.append(min(reaches, key=lambda r: (not r.measured, r.time), default=None))
    return least


def reach_rows(found: Sequence[Curve]) -> list[tuple[str, ...]]:
    """Rows of words: kind, figure, solver, and the time to each of the targets."""
    rows = []
    for kind, figure, solver in dict.fromkeys((c.kind, c.figure, c.solver) for c in found):
        least = best(found, kind, figure, solver)
        rows.append((kind, figure.replace("_", " "), solver, *(_words(reach) for reach in least)))
    return rows


REACH_HEADERS = ("kind", "figure", "solver", *(f"s to {100 * target:g} %" for target in TARGETS))


def _words(reach: Reach | None) -> str:
    if reach is None:
        return ""
    return f"{reach.time:.2g}" if reach.measured else f"({reach.time:.1g})"


def error_rows(found: Sequence[Curve]) -> list[tuple[str, ...]]:
    """Rows of words: the error of every figure on every grid, with its time and memory."""
    return [
        (
            c.kind,
            c.figure.replace("_", " "),
            c.solver,
            str(c.digits or ""),
            str(n),
            f"{100 * e:.2g}",
            f"{t:.2g}",
            f"{m / 2**20:.2g}",
        )
        for c in found
        for n, e, t, m in zip(c.sizes, c.errors, c.times, c.memory, strict=True)
    ]


ERROR_HEADERS = ("kind", "figure", "solver", "digits", "size", "error %", "CPU s", "MiB")
