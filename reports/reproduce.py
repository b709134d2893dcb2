"""Compute rows of stored results anew and compare each figure within its bar.

    python -m reports.reproduce [NAME ...] [--sample N] [--seed S] [--minutes M] [--jobs J] [--row TEXT] [--no-record]

Rows are drawn from the seed: N of every result, results in random order, rows that were outside their bars first. With
`--row TEXT` rows are chosen by their label instead: those labelled TEXT, otherwise those whose label contains TEXT. A
row that is longer than what is left of the processor time waits for another seed. J rows are computed at a time, each
in a process of its own. The verdicts are stored in `reports/results/reproduced.json`, which the pages show, unless
`--no-record` is given. Rows outside their bars are listed again at the end, each with the command that computes it
alone; the exit code is then 1.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import math
import multiprocessing
import random
import resource
import shlex
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from reports import reproduced
from reports.reproducible import RESULTS, Row

MINUTES = 10.0
"""Processor time of a call where none is given."""


def labelled(results: Mapping[str, Sequence[Row]], wanted: str) -> dict[str, list[Row]]:
    """Return the rows of each result with the wanted label, or without any those whose label contains it."""
    chosen = {name: [row for row in rows if row.label == wanted] for name, rows in results.items()}
    if not any(chosen.values()):
        chosen = {name: [row for row in rows if wanted in row.label] for name, rows in results.items()}
    return {name: rows for name, rows in chosen.items() if rows}


def drawn(results: Mapping[str, Sequence[Row]], sample: int, seed: int) -> Iterator[tuple[str, Row]]:
    """Yield rows of results, one of each in turn, in an order that depends on the seed and on rows found outside."""
    rng = random.Random(seed)
    chosen: dict[str, list[Row]] = {}
    for name in sorted(results):
        rows = list(results[name])
        rng.shuffle(rows)
        wrong = reproduced.outside(name)
        rows.sort(key=lambda row, wrong=wrong: row.label not in wrong)  # type: ignore[misc]
        chosen[name] = rows[: max(sample, len(wrong))]
    order = list(chosen)
    rng.shuffle(order)
    for place in range(max(map(len, chosen.values()), default=0)):
        for name in order:
            if place < len(chosen[name]):
                yield name, chosen[name][place]


def processor_time() -> float:
    """Return the processor time of this process and its finished children [s]."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def judge(row: Row) -> tuple[str, float]:
    """Compute a row; return the verdict and the processor time [s]. An exception is the verdict of its row."""
    began = processor_time()
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            verdict = row.verdict()
    except Exception as error:
        verdict = f"{type(error).__name__}: {error}"
    return verdict, processor_time() - began


_DRAWN: list[tuple[str, Row]] = []
"""Rows of this call, which forked processes know by their place: a row is no message."""


def _judge_drawn(place: int) -> tuple[str, float]:
    return judge(_DRAWN[place][1])


def reproduce(
    names: Sequence[str],
    *,
    sample: int,
    seed: int,
    minutes: float,
    jobs: int = 1,
    record: bool = True,
    row: str | None = None,
) -> dict[str, dict[str, str]]:
    """Compute rows until the processor time is used; print a verdict for each row, and record it.

    Parameters
    ----------
    names : results.
    sample, seed : number of rows of each result, and seed of their draw.
    minutes : processor time [min].
    jobs : rows computed at a time.
    record : whether verdicts are stored.
    row : label, or part of the labels, of the rows that are computed instead of drawn ones.

    Returns
    -------
    verdicts : by result and row; "in" or the figure outside its bar.
    """
    results = {name: RESULTS[name].rows() for name in names}
    if row is None:
        _DRAWN[:] = drawn(results, sample, seed)
    else:
        _DRAWN[:] = [(name, one) for name, rows in labelled(results, row).items() for one in rows]
    waiting, left, skipped = list(range(len(_DRAWN))), 60 * minutes, 0
    verdicts: dict[str, dict[str, str]] = {}
    running: dict[Future[tuple[str, float]], int] = {}
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("fork")) as pool:
        while waiting or running:
            while waiting and len(running) < jobs:
                place = waiting.pop(0)
                if _DRAWN[place][1].seconds > left - sum(_DRAWN[other][1].seconds for other in running.values()):
                    skipped += 1
                    continue
                running[pool.submit(_judge_drawn, place)] = place
            for done in wait(running, return_when=FIRST_COMPLETED).done:
                name, judged = _DRAWN[running.pop(done)]
                verdict, seconds = done.result()
                left -= seconds
                verdicts.setdefault(name, {})[judged.label] = verdict
                print(f"{name:26} {judged.label:46} {seconds:6.1f} s  {verdict}", flush=True)
                if record:
                    reproduced.add(name, verdicts[name], len(results[name]))
    if skipped:
        print(f"{skipped} rows are longer than the processor time that was left")
    return verdicts


def outside_lines(verdicts: Mapping[str, Mapping[str, str]]) -> Iterator[str]:
    """Yield the rows outside their bars with their verdicts, and below each the command that computes it alone."""
    seconds = {(name, row.label): row.seconds for name, row in _DRAWN}
    for name, own in verdicts.items():
        for label, verdict in own.items():
            if verdict == reproduced.INSIDE:
                continue
            command = ["python", "-m", "reports.reproduce", name, f"--row={label}", "--no-record"]
            if seconds[name, label] > 60 * MINUTES:
                command.append(f"--minutes={math.ceil(seconds[name, label] / 60)}")
            yield f"OUTSIDE {name}, {label}: {verdict}"
            yield f"    {shlex.join(command)}"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m reports.reproduce", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"any of {', '.join(RESULTS)}; all where none is named"
    )
    parser.add_argument("--sample", type=int, default=1, help="rows of every result (default 1)")
    parser.add_argument("--seed", type=int, default=1, help="of the draw (default 1)")
    parser.add_argument("--minutes", type=float, default=MINUTES, help=f"processor time (default {MINUTES:g})")
    parser.add_argument("--jobs", type=int, default=1, help="rows at a time (default 1)")
    parser.add_argument("--row", metavar="TEXT", help="compute the rows of this label, or whose label contains it")
    parser.add_argument("--no-record", dest="record", action="store_false", help="leave stored verdicts as they are")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in RESULTS]
    if unknown:
        parser.error(f"no result {', '.join(unknown)}; there are {', '.join(RESULTS)}")
    names = options.names or list(RESULTS)
    given = {key: getattr(options, key) for key in ("sample", "seed", "minutes", "jobs", "record", "row")}
    verdicts = reproduce(names, **given)
    if options.row is not None and not _DRAWN:
        parser.error(f"no row of {', '.join(names)} is labelled {options.row!r} or contains it")
    rows = [verdict for own in verdicts.values() for verdict in own.values()]
    wrong = sum(verdict != reproduced.INSIDE for verdict in rows)
    print(f"{len(rows)} rows of {len(verdicts)} results: {len(rows) - wrong} within their bars, {wrong} outside")
    for line in outside_lines(verdicts):
        print(line)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
