"""Run the benchmarks into a history, with other codes beside bem, or compare two runs of a history.

    python -m reports.benchmarks --quick                                    all cases, small, into the history
    python -m reports.benchmarks --peers                                    also time other codes
    python -m reports.benchmarks --kind all --peers                         physical figures over time and memory
    python -m reports.benchmarks --compare -2 -1                            two runs of the history, by commit or place

Other codes (tamaas, ContactMechanics, ASPHER, slippy) are installed into an environment of their own. The exit code is
1 where a point failed and 130 after an interrupt; what was measured is kept.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bem.benchmarks.record import INTERRUPTED, Run
from bem.benchmarks.run import check_names, check_sizes, run_cases
from bem.benchmarks.show import print_run
from bem.benchmarks.work_precision import (
    ERROR_HEADERS,
    REACH_HEADERS,
    check_kinds,
    error_rows,
    measure_kinds,
    reach_rows,
)
from bem.cli._terminal import table
from bem.errors import BemError
from reports.benchmarks.history import StoredRun, append_run, read_history, stored_run
from reports.benchmarks.peer_figures import curves_with_peers
from reports.benchmarks.peers import environment
from reports.benchmarks.run import add_figures_of_peers, add_peers
from reports.benchmarks.tables import print_comparison, print_peers

RESULTS = Path(__file__).resolve().parents[1] / "results"
CASES_HISTORY, KINDS_HISTORY = RESULTS / "performance.json", RESULTS / "work_precision.json"
"""Histories that the performance report draws."""


def options() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m reports.benchmarks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", metavar="NAME", help="cases; without it all")
    parser.add_argument("--kind", nargs="+", metavar="NAME", help="physical figures of kinds (or all), not cases")
    parser.add_argument("--quick", action="store_true", help="small sizes")
    parser.add_argument("--size", type=float, nargs="+", help="sizes in place of a case's own")
    parser.add_argument("--limit", type=float, default=2048, help="largest number of cells a side of a case's own")
    parser.add_argument("--threads", type=int, nargs="+", help="without it 1, and 2 where it matters")
    parser.add_argument("--repeats", type=int, default=5, help="timed solves of each point")
    parser.add_argument("--no-floor", action="store_true", help="do not measure what the machine can do at best")
    parser.add_argument("--peers", action="store_true", help="also time other codes")
    parser.add_argument("--peers-folder", type=Path, default=Path(".venv-peers"), help="environment of the other codes")
    parser.add_argument("--peers-size", type=int, nargs="+", default=[512], help="cells a side of their contacts")
    parser.add_argument("--history", type=Path, metavar="FILE", help="file to append to; without it the report's")
    parser.add_argument("--compare", nargs=2, metavar=("A", "B"), help="compare two runs of the history, run nothing")
    return parser


def main(arguments: list[str]) -> int:
    """Run the command line and return its exit code."""
    given = options().parse_args(arguments)
    history = given.history or (KINDS_HISTORY if given.kind else CASES_HISTORY)
    try:
        if given.compare:
            print_comparison(history, *given.compare, table)
            return 0
        read_history(history)  # refuse another file before any work
        run = _kinds(given) if given.kind else _cases(given)
        append_run(history, run)
    except BemError as error:
        print(*getattr(error, "messages", [error]), sep="\n", file=sys.stderr)
        return error.exit_code
    print(f"history: {history}")
    for what, why in run.failures.items():
        print(f"{what}: {why}", file=sys.stderr)
    return (130 if INTERRUPTED in run.failures else 1) if run.failures else 0


def _cases(given: argparse.Namespace) -> StoredRun:
    """Measure cases and print their tables."""
    names = check_names(given.only)
    check_sizes("--size", given.size)
    check_sizes("--peers-size", given.peers_size, least=16)
    python = environment(given.peers_folder, _say) if given.peers else None
    run: Run = run_cases(
        names,
        quick=given.quick,
        sizes=given.size,
        limit=given.limit,
        threads=given.threads,
        repeats=given.repeats,
        with_floor=not given.no_floor,
        say=_say,
    )
    if python is None or INTERRUPTED in run.failures:
        stored = stored_run(run)
    else:
        stored = add_peers(run, given.peers_folder, python, given.peers_size, given.quick, given.repeats, _say)
    print_run(stored, table)
    print_peers(stored, table)
    return stored


def _kinds(given: argparse.Namespace) -> StoredRun:
    """Measure physical figures of kinds and print their tables."""
    kinds, repeats = check_kinds(given.kind), min(given.repeats, 3)
    python = environment(given.peers_folder, _say) if given.peers else None
    run = measure_kinds(kinds, quick=given.quick, repeats=repeats, say=_say)
    if python is None or INTERRUPTED in run.failures or "contact" not in kinds:
        stored = stored_run(run)
    else:
        stored = add_figures_of_peers(run, python, given.quick, repeats, _say)
    found = curves_with_peers(stored)
    table(ERROR_HEADERS, error_rows(found), title="errors against the limit of the two finest grids")
    table(REACH_HEADERS, reach_rows(found), title="processor time to an error; in brackets: extrapolated")
    return stored


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
