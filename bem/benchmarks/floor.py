"""What the machine can do at best: a pair of real transforms with FFTW's measured plans, and memory bandwidth."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Floor:
    """Seconds of one forward and inverse transform (cells a side, bits, threads) -> s, and bandwidth [B/s]."""

    pairs: dict[str, float]
    bandwidth: float

    def pair(self, cells: int, bits: int = 64, threads: int = 1) -> float | None:
        """Seconds of a pair, None where it was not measured."""
        return self.pairs.get(f"{cells}-{bits}-{threads}")


def _fastest(work: Callable[[], object], repeats: int) -> float:
    best = np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return float(best)


PLANNINGS = 4
"""Of a measured pair: FFTW's planner times what it tries, and now and then takes a bad plan on a busy machine (7.8 ms
where others took 4.3, 1024 cells)."""


def transform_pair(cells: int, bits: int, threads: int, *, measured: bool = True) -> float:
    """Wall time [s] of the fastest of a few two-dimensional pairs, real to complex and back, periodic, in place of
    nothing else: no padding, no product. Of measured plans the best of several; what FFTW knew before is all it knows
    after, so that solvers of this process plan as they would have."""
    import pyfftw

    if not measured:
        return _planned_pair(cells, bits, threads, "FFTW_ESTIMATE")
    known = pyfftw.export_wisdom()
    try:
        best = np.inf
        for _ in range(PLANNINGS):
            pyfftw.forget_wisdom()  # else the second planning takes the plan of the first
            best = min(best, _planned_pair(cells, bits, threads, "FFTW_MEASURE"))
    finally:
        pyfftw.forget_wisdom()
        pyfftw.import_wisdom(known)
    return float(best)


def _planned_pair(cells: int, bits: int, threads: int, effort: str) -> float:
    """Wall time [s] of a pair that is planned now, with an effort that FFTW knows."""
    import pyfftw

    real = pyfftw.empty_aligned((cells, cells), dtype=f"float{bits}")
    spectrum = pyfftw.empty_aligned((cells, cells // 2 + 1), dtype=f"complex{2 * bits}")
    flags = (effort, "FFTW_DESTROY_INPUT")
    there = pyfftw.FFTW(real, spectrum, axes=(0, 1), flags=flags, threads=threads)
    back = pyfftw.FFTW(spectrum, real, axes=(0, 1), direction="FFTW_BACKWARD", flags=flags, threads=threads)

    def pair() -> None:
        there.execute()
        back.execute()

    repeats = max(3, min(15, 2**22 // cells**2))
    best = np.inf
    for _ in range(repeats):
        real.fill(0.5)  # the pair is not normalised: repeated, it would grow without bound
        best = min(best, _fastest(pair, 1))
    return float(best)


def bandwidth() -> float:
    """Bytes read and written per second by a copy of 256 MB in one thread."""
    source = np.ones(1 << 24)
    target = np.empty_like(source)
    return 2 * source.nbytes / _fastest(lambda: np.copyto(target, source), 5)


def measure_floor(sizes: tuple[int, ...], threads: tuple[int, ...] = (1,)) -> Floor:
    """The floor at some sizes, in both precisions."""
    pairs = {
        f"{cells}-{bits}-{count}": transform_pair(cells, bits, count, measured=cells <= 2048)
        for cells in sizes
        for bits in (64, 32)
        for count in threads
    }
    return Floor(pairs, bandwidth())
