"""`python -m bem.benchmarks CASE SIZE THREADS REPEATS`: measure one point here and print it as one line of JSON."""

from __future__ import annotations

import sys


def main(arguments: list[str]) -> None:
    """Warm up at the case's smallest size, then measure."""
    from bem.benchmarks.cases import CASES, INNER
    from bem.benchmarks.measure import measure, write_point
    from bem.threads import set_threads

    name, size, threads, repeats = arguments[0], float(arguments[1]), int(arguments[2]), int(arguments[3])
    set_threads(threads)
    case = (CASES | INNER)[name]
    warm = case.prepare(case.warm_size)
    warm.judge(warm.solve())
    print(write_point(measure(name, size, threads, case.prepare, repeats)))


if __name__ == "__main__":
    main(sys.argv[1:])
