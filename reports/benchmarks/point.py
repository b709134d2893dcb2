"""Points beside other codes, each measured in a process of its own."""

from __future__ import annotations

from bem.benchmarks.measure import Point, measure_apart
from reports.benchmarks.history import HERE

_PROGRAM = f"""
import sys
sys.path.insert(0, {str(HERE)!r})
from bem.benchmarks.__main__ import measure_point
from reports.benchmarks.peer_cases import PEER_CASES
measure_point(sys.argv[1:], PEER_CASES)
"""


def measure_beside(case: str, size: float, threads: int, repeats: int) -> Point:
    """Measure a case of `reports.benchmarks.peer_cases`.

    Raises
    ------
    RuntimeError : the process failed; its last line says why.
    """
    return measure_apart(case, size, threads, repeats, program=("-P", "-c", _PROGRAM))
