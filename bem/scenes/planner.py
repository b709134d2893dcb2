"""Plan of a scene: steps, skipped steps with their reasons, memory and time."""

from __future__ import annotations

import json
import math
import os
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from bem.errors import InputError
from bem.memory import available_memory as available_memory

_CALIBRATION_SIDE = 512
_PROCESS = 1.3e8  # bytes of the interpreter and the libraries of a run, compiled loops included
SEARCHED_IN_SINGLE = (
    "pressure, gap and residual in double; transforms of the search for a better pressure in single: no accuracy lost"
)
"""Error of contacts searched in single precision: tests/frugality/test_plans.py compares them with those searched in
double."""
CONTACT = "contact"
"""Name of the step that several processes can share."""
_RANK_BYTES, _RANK_BYTES_OF_POINTS, _RANK_FIELDS = 120.0, 15.0, 4.0
"""Memory of a shared contact, all processes together: bytes for each cell of the grid and each point of its transforms;
and the fields of all cells that it leaves with the first process: pressure, displacement, gap, overlap.

Measured with 2048 x 2048 cells above the start, on one and two processes: 510 and 2 x 260 MB periodic (566 by these
numbers), 570 and 2 x 370 MB free (755)."""
_RANK_WORK = 13.0
"""Processor time of a shared contact, all processes together, over that of the solver of one process: 11 and 13 times
on one and two processes with 2048 x 2048 cells periodic, 14 and 16 times free."""
_START = 0.8  # seconds until libraries and compiled loops are loaded


@dataclass(frozen=True)
class Step:
    """One computation of a plan.

    Attributes
    ----------
    name : what is computed.
    why : why it is needed, or why it is skipped.
    skipped : whether the scene can do without.
    transforms : how many real transforms (one direction) of `points` points it takes.
    points : points of one of these transforms, padding included.
    memory : bytes held at its peak beyond what the steps before it keep.
    kept : bytes of these that stay when it is over; all of them where not given.
    seconds : further time that is not spent in transforms, on any machine [s].
    precision : in which numbers are held that are not all held in double, and what it costs; empty where all are.
    per : of what it is done once, where a scene has several cases: each "case"; each "grid", for all repetitions on it;
        the whole "run".
    """

    name: str
    why: str
    skipped: bool = False
    transforms: float = 0.0
    points: float = 0.0
    memory: float = 0.0
    seconds: float = 0.0
    kept: float | None = None
    precision: str = ""
    per: Literal["case", "grid", "run"] = "case"


@dataclass(frozen=True)
class Plan:
    """The steps of a run in order: the work of all its cases, the memory of one; and the plans of each."""

    steps: tuple[Step, ...]
    cases: int = 1
    of_cases: tuple[Plan, ...] = ()

    @classmethod
    def of(cls, *steps: Step) -> Plan:
        """Plan of one case."""
        return cls(steps)

    @property
    def memory(self) -> float:
        """Estimated bytes of the process at the peak."""
        peak = held = _PROCESS
        for step in self.steps:
            if not step.skipped:
                peak = max(peak, held + step.memory)
                held += step.memory if step.kept is None else step.kept
        return peak

    def on_ranks(self, ranks: int, cells: int) -> Plan:
        """Return the plan of the first of some processes that share each contact of so many cells (`bem.distributed`).

        Its other steps stay with this process, and so do the fields that a contact leaves.
        """
        steps = tuple(self._shared(step, ranks, cells) if step.name == CONTACT else step for step in self.steps)
        return replace(self, steps=steps, of_cases=tuple(one.on_ranks(ranks, cells) for one in self.of_cases))

    @property
    def helper_memory(self) -> float:
        """Estimated bytes of a process that helps with shared contacts alone."""
        return Plan(tuple(step for step in self.steps if step.name == CONTACT)).memory

    def _shared(self, step: Step, ranks: int, cells: int) -> Step:
        return replace(
            step,
            why=f"{step.why}; shared by {ranks} processes: memory and time of each, all together 10 to 16 times the "
            "processor time of the solver of one process",
            transforms=step.transforms * _RANK_WORK / ranks,
            memory=(_RANK_BYTES * cells + _RANK_BYTES_OF_POINTS * step.points) / ranks,
            kept=8.0 * cells * _RANK_FIELDS,
            seconds=step.seconds * _RANK_WORK / ranks,
            precision="",
        )

    @property
    def precisions(self) -> dict[str, str]:
        """List each step with numbers in single precision: the numbers, and the error that this costs."""
        return {step.name: step.precision for step in self.steps if step.precision and not step.skipped}

    @property
    def precision_rows(self) -> list[tuple[str, str]]:
        """The same in words, with all that is held in double."""
        named = list(self.precisions.items())
        return [*named, ("all else", "double; error bars as what they repeat")] if named else [("all", "double")]

    def work(self, rate: float) -> float:
        """Estimated processor time of the cases alone [s], without what a run does once."""
        return math.fsum(step_seconds(step, rate) for step in self.steps if step.per != "run")

    def seconds(self, rate: float) -> float:
        """Estimated processor time [s] on a machine with that transform rate [flop/s], the start included."""
        return _START + math.fsum(step_seconds(step, rate) for step in self.steps)


def step_seconds(step: Step, rate: float) -> float:
    """Estimated time of one step [s]; a real transform of N points counts 2.5 N log2 N operations.

    Beyond 4096 x 4096 points the rate falls as the root of their number: surfaces and stresses of 8192 x 8192 took 2.8
    and 2.3 times what the rate of smaller ones foretells, on a machine whose other core was busy.
    """
    if step.skipped:
        return 0.0
    slower = math.sqrt(max(1.0, step.points / 2**24))
    operations = 2.5 * step.points * math.log2(max(step.points, 2.0)) * slower
    return step.seconds + step.transforms * operations / rate


def layered_kernel_seconds(cells: float, depths: float = 0.0) -> float:
    """Time to make the coefficients of a coated body [s]: displacement on all grids of a cascade, and six stresses
    under pressure and traction at some depths; measured, 0.3 (free) to 0.6 us (one axis periodic) a cell and 5 ms of
    radial tables for each load."""
    return 5e-7 * cells * (4 / 3 + 2 * depths) + 5e-3 * (1 + 2 * depths)


def stress_kernel_seconds(cells: float, depths: float) -> float:
    """Time to make the spectra of six stresses of a homogeneous body under pressure and traction at some depths [s].

    Measured, 0.20 to 0.24 us a cell and depth, free or periodic along one axis. What is made serves all cycles, loads
    and runs of a sweep; displacement kernels take less than 0.1 s. None are kept on disk, by measurement: of 64 depths
    of 256 x 256 cells there are 280 MB, made in 0.9 s; reading them takes 0.2 s with a check sum where the file is
    still in memory, and longer from a disk. In whole scenes less is at stake: making them is 0.3 s of a wear scene's
    13 s (one pair, 200 cycles of 240 x 240 cells), 0.4 s of 8 s for the stresses in a coated sphere.
    """
    return 2.3e-7 * cells * depths


def padded_points(shape: tuple[int, int], periodic: tuple[bool, bool]) -> float:
    """Points of a transform on this grid: free axes are doubled."""
    return math.prod(n if wraps else 2 * n for n, wraps in zip(shape, periodic, strict=True))


def convolution_memory(shape: tuple[int, int], periodic: tuple[bool, bool]) -> float:
    """Bytes of a contact solve: work arrays of both precisions, a quarter-array spectrum, a dozen fields."""
    cells, points = math.prod(shape), padded_points(shape, periodic)
    return 12 * 8.0 * cells + (16 + 8 + 4) * points


def check_memory(plan: Plan) -> None:
    """Refuse a plan that cannot fit, before any work.

    Raises
    ------
    InputError : the estimate exceeds the memory that is available.
    """
    free = available_memory()
    if plan.memory > free:
        raise InputError(
            f"memory: this scene needs about {show_bytes(plan.memory)} and {show_bytes(free)} are available"
            f"{_fitting(plan, free)}; "
            "allowed: a smaller grid.shape, fewer depths or fewer outputs (`bem plan` shows what takes how much)"
        )


def _fitting(plan: Plan, free: float) -> str:
    """Describe the part of the grid that fits into memory; empty if not even the process does."""
    share = (free - _PROCESS) / (plan.memory - _PROCESS)
    if not share > 0:
        return ""
    return f" (grids of {100 * share:.2g} % of the cells fit, {100 * math.sqrt(share):.2g} % of them along each side)"


def machine_rate(threads: int = 1) -> float:
    """Transform rate of this machine [flop/s], measured once (about 0.1 s) and kept in the user's cache folder."""
    key = f"transform_rate_{threads}_threads"
    path = cache_folder() / "machine.json"
    try:
        rate = float(json.loads(path.read_text())[key])
        if math.isfinite(rate) and rate > 0:
            return rate
    except (OSError, ValueError, KeyError, TypeError):
        pass
    rate = _measure(threads)
    try:
        known = json.loads(path.read_text()) if path.is_file() else {}
        known[key] = rate
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as file:
            json.dump(known, file)
        os.replace(file.name, path)
    except (OSError, ValueError, TypeError):
        pass  # a cache that cannot be written costs a tenth of a second next time, no more
    return rate


def cache_folder() -> Path:
    """Return the folder of stored measurements of this machine."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "bem"


def _measure(threads: int) -> float:
    import numpy as np
    import scipy.fft

    field = np.ones((_CALIBRATION_SIDE, _CALIBRATION_SIDE))
    scipy.fft.rfft2(field, workers=threads)
    fastest = math.inf
    for _ in range(8):
        start = time.perf_counter()
        scipy.fft.rfft2(field, workers=threads)
        fastest = min(fastest, time.perf_counter() - start)
    return 2.5 * field.size * math.log2(field.size) / fastest


def show_bytes(size: float) -> str:
    """Bytes for people."""
    for factor, unit in ((2**40, "TiB"), (2**30, "GiB"), (2**20, "MiB"), (2**10, "KiB")):
        if size >= factor:
            return f"{size / factor:.1f} {unit}"
    return f"{size:.0f} B"


def show_seconds(seconds: float) -> str:
    """A duration for people."""
    if seconds < 0.1:
        return "< 0.1 s"
    if seconds < 120:
        return f"{seconds:.1f} s"
    if seconds < 7200:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
