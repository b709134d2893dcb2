"""Measuring one point: processor and wall time of repeats, peak memory, and where the time goes."""

from __future__ import annotations

import contextlib
import gc
import json
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import FunctionType
from typing import Any

THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
PROGRAM = ("-P", "-m", "bem.benchmarks")
"""Arguments of Python that measure one point (`__main__`)."""

_LEAST_TOLD = 2.0**20
"""Memory [bytes] below which what the process holds anyway decides."""


@dataclass(frozen=True)
class Outcome:
    """What a solve says of itself.

    errors : relative errors by name; the first is the one that diagrams show. counts : of work, by name.
    values : anything else worth keeping.
    """

    errors: dict[str, float]
    counts: dict[str, float] = field(default_factory=dict)
    values: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Timed:
    """A prepared point: `solve` is timed, `judge` is not. `restart`, if given, is called before every repeat.

    cells : of the grid, times depths: the value `bytes_a_cell` is the memory over them; none is told of 0, nor of less
    memory than `_LEAST_TOLD`.
    """

    solve: Callable[[], Any]
    judge: Callable[[Any], Outcome]
    restart: Callable[[], None] | None = None
    cells: float = 0.0


@dataclass(frozen=True)
class Point:
    """A measured point. Times [s] in the order of the repeats; the first solve (kernels, plans) stands apart.

    memory : bytes that the first solve took beyond what the process held before it. split : seconds of one solve.
    """

    case: str
    size: float
    threads: int
    first_cpu: float
    cpu: tuple[float, ...]
    wall: tuple[float, ...]
    memory: float
    errors: dict[str, float]
    counts: dict[str, float]
    values: dict[str, float]
    split: dict[str, float]

    @property
    def cpu_median(self) -> float:
        """Median processor time of a solve [s]."""
        return statistics.median(self.cpu)

    @property
    def wall_median(self) -> float:
        """Median wall time of a solve [s]."""
        return statistics.median(self.wall)

    @property
    def spread(self) -> float:
        """Interquartile range of the processor times over their median."""
        if len(self.cpu) < 2:
            return 0.0
        low, _, high = statistics.quantiles(self.cpu, n=4, method="inclusive")
        return (high - low) / self.cpu_median if self.cpu_median > 0 else 0.0

    @property
    def error(self) -> float:
        """The error that diagrams show."""
        return next(iter(self.errors.values()))

    @classmethod
    def of(cls, data: dict[str, Any]) -> Point:
        """From what `asdict` gave."""
        return cls(**(data | {"cpu": tuple(data["cpu"]), "wall": tuple(data["wall"])}))


def held_memory() -> tuple[float, float]:
    """Bytes this process holds now, and the most since the last `forget_peak`; zeros where the system does not say."""
    try:
        status = Path("/proc/self/status").read_text()
    except OSError:
        return 0.0, 0.0
    found = [re.search(rf"{name}:\s+(\d+) kB", status) for name in ("VmRSS", "VmHWM")]
    return tuple(1024.0 * int(match.group(1)) if match else 0.0 for match in found)  # type: ignore[return-value]


def forget_peak() -> None:
    """Let the peak of this process' memory start from now, where the system allows it."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def measure(case: str, size: float, threads: int, prepare: Callable[[float], Timed], repeats: int) -> Point:
    """Measure a point in this process, which should have done nothing else but warm up compiled loops."""
    timed = prepare(size)
    gc.collect()
    forget_peak()
    before = held_memory()[0]
    start = time.process_time()
    result = timed.solve()
    first = time.process_time() - start
    memory = max(0.0, held_memory()[1] - before)
    outcome = timed.judge(result)
    cpu, wall = [], []
    for _ in range(repeats):
        if timed.restart is not None:
            timed.restart()
        began, start = time.perf_counter(), time.process_time()
        timed.solve()
        cpu.append(time.process_time() - start)
        wall.append(time.perf_counter() - began)
    if timed.restart is not None:
        timed.restart()
    with watched() as split:
        start = time.process_time()
        timed.solve()
        split["whole"] = time.process_time() - start
    return Point(
        case=case,
        size=size,
        threads=threads,
        first_cpu=first,
        cpu=tuple(cpu),
        wall=tuple(wall),
        memory=memory,
        errors=outcome.errors,
        counts=outcome.counts,
        values=outcome.values
        | ({"bytes_a_cell": memory / timed.cells} if timed.cells and memory >= _LEAST_TOLD else {}),
        split=dict(split),
    )


@contextlib.contextmanager
def watched() -> Iterator[dict[str, float]]:
    """Processor time spent in transforms and in elementwise passes of the contact solver while the block runs [s].

    Counters stand around the functions only here, so that a timed solve does not pay for them.
    """
    import bem.stress.fields
    from bem.contact import coarse_correction, pcg, reductions, sparse_inverse
    from bem.transforms import PaddedTransform
    from bem.wear import yielding

    split: dict[str, float] = {}
    depth = 0

    def around(function: Callable[..., Any], name: str) -> Callable[..., Any]:
        def inner(*arguments: Any, **keywords: Any) -> Any:
            nonlocal depth
            if depth:
                return function(*arguments, **keywords)
            depth += 1
            start = time.process_time()
            try:
                return function(*arguments, **keywords)
            finally:
                depth -= 1
                split[name] = split.get(name, 0.0) + time.process_time() - start

        return inner

    kinds = ("convolve", "convolve_cells", "forward", "inverse", "inverse_squared")
    targets: list[tuple[Any, str, str]] = [(PaddedTransform, name, "transforms") for name in kinds]
    targets += [
        (reductions, name, "elementwise")
        for name, value in vars(reductions).items()
        if not name.startswith("_") and isinstance(value, FunctionType) and value.__module__ == reductions.__name__
    ]
    targets += [
        (pcg, "close_gap", "rounds"),  # transforms, passes and preconditioner, compiled together
        (sparse_inverse.SparseInverse, "on", "preconditioner"),
        (sparse_inverse.SparseInverseOnCells, "spread", "preconditioner"),
        (sparse_inverse.SparseInverseOnCells, "collect", "preconditioner"),
        (coarse_correction.CoarseCorrectionOnCells, "apply", "preconditioner"),
        (bem.stress.fields, "_from_deviatoric", "elementwise"),
        (yielding, "segment", "pieces"),
    ]
    kept = [(owner, name, getattr(owner, name)) for owner, name, _ in targets]
    try:
        for owner, name, label in targets:
            setattr(owner, name, around(getattr(owner, name), label))
        yield split
    finally:
        for owner, name, value in kept:
            setattr(owner, name, value)


def measure_apart(
    case: str, size: float, threads: int, repeats: int, limit: float = 1800.0, program: Sequence[str] = PROGRAM
) -> Point:
    """Measure a point in a process of its own.

    Parameters
    ----------
    case, size, threads, repeats : the point.
    limit : wall time [s] that the process may take.
    program : arguments of Python; the point's follow.

    Raises
    ------
    RuntimeError : the process failed; its last line says why.
    """
    environment = os.environ | dict.fromkeys(THREAD_VARIABLES, "1") | {"BEM_THREADS": str(threads)}
    done = subprocess.run(
        [sys.executable, *program, case, repr(size), str(threads), str(repeats)],
        capture_output=True,
        text=True,
        timeout=limit,
        env=environment,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip().splitlines() or ["no message"])[-1])
    return Point.of(json.loads(done.stdout.strip().splitlines()[-1]))


@contextlib.contextmanager
def named_failure(failures: dict[str, str], what: str) -> Iterator[None]:
    """What fails in a process of its own is named with why, and the rest goes on."""
    try:
        yield
    except (RuntimeError, subprocess.TimeoutExpired) as error:
        failures[what] = str(error)


def growth(sizes: list[float], times: list[float]) -> float:
    """Exponent of a power law through times over sizes by least squares; nan for fewer than two points."""
    import numpy as np

    if len(sizes) < 2:
        return float("nan")
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def write_point(point: Point) -> str:
    """One line of JSON."""
    return json.dumps(asdict(point))
