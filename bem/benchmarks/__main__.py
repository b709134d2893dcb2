"""`python -m bem.benchmarks CASE SIZE THREADS REPEATS`: measure one point here and print it as one line of JSON."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bem.benchmarks.cases import Case


def measure_point(arguments: Sequence[str], cases: Mapping[str, Case]) -> None:
    """Warm up at the case's smallest size, then measure.

    Parameters
    ----------
    arguments : name of the case, size, threads, repeats.
    cases : cases by their names.
    """
    from bem.benchmarks.measure import measure, write_point
    from bem.threads import set_threads

    name, size, threads, repeats = arguments[0], float(arguments[1]), int(arguments[2]), int(arguments[3])
    set_threads(threads)
    case = cases[name]
    warm = case.prepare(case.warm_size)
    warm.judge(warm.solve())
    print(write_point(measure(name, size, threads, case.prepare, repeats)))


if __name__ == "__main__":
    from bem.benchmarks.cases import CASES, INNER

    measure_point(sys.argv[1:], CASES | INNER)
