"""Renew the stored figures of the golden net, or measure their spread."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence

from reports.golden import memory
from reports.golden.groups import GROUPS, run_case
from reports.golden.record import Record, Trial
from reports.golden.stored import Difference, store, stored
from reports.golden.tolerances import allowed

TRIALS = {"last digits": Trial(nudge=1e-12), "tolerance / 10": Trial(tighter=0.1)}
"""Changes under which a figure should keep within its tolerance."""
MEMORY = "memory"
"""Group of the peaks of memory."""
THIRD = 1 / 3
"""Part of its tolerance that a figure's spread may use up."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command; see `python -m reports.golden --help`."""
    parser = argparse.ArgumentParser(prog="python -m reports.golden", description=__doc__)
    parser.add_argument("--only", action="append", choices=[*GROUPS, MEMORY], help="a group; all where none is given")
    parser.add_argument(
        "--case", action="append", help="a case of the one group that --only names; all if none is given"
    )
    parser.add_argument("--spread", action="store_true", help="measure how far figures follow rounding; store nothing")
    given = parser.parse_args(arguments)
    if given.case and (not given.only or len(given.only) > 1 or given.only == [MEMORY]):
        parser.error("--case needs the one group that it is of: --only GROUP")
    unknown = [case for case in given.case or () if case not in GROUPS[given.only[0]]()]
    if unknown:
        parser.error(f"--case: {', '.join(unknown)} is not in group {given.only[0]}")
    for group in given.only or [*GROUPS, MEMORY]:
        if group == MEMORY:
            if not given.spread:
                print_table(memory.store())
        elif given.spread:
            show_spread(group)
        else:
            renew(group, given.case)


def renew(group: str, cases: Sequence[str] | None = None) -> None:
    """Run cases of a group, all if none are named, store what moved and print it."""
    start = time.process_time()
    records = {case: _run(group, case, Trial()) for case in cases or GROUPS[group]()}
    moved = store(group, records if cases is None else stored(group) | records)
    print(f"{group}: {len(records)} cases, {time.process_time() - start:.0f} s of processor time, {len(moved)} moved")
    print_table(moved)


def show_spread(group: str) -> None:
    """Print the figures of a group whose spread is more than a third of their tolerance."""
    for case in GROUPS[group]():
        base = _run(group, case, Trial())
        for words, trial in TRIALS.items():
            other = _run(group, case, trial)
            for name, value in base.figures.items():
                now, change = other.figures.get(name), allowed(group, case, name, base.figures)
                apart = abs(now - value) if isinstance(now, float) and isinstance(value, float) else 0.0
                if apart > THIRD * change or (apart == 0.0 and now != value):
                    print(f"{case}: {name}: {value} and {now} with {words}, allowed +-{change:.2g}", flush=True)


def print_table(moved: Sequence[Difference]) -> None:
    """Print what moved: case, figure, before, after, allowed."""
    if not moved:
        return
    rows = [("case", "figure", "before", "after", "allowed")]
    rows += [(one.case, one.figure, str(one.before), str(one.after), f"{one.allowed:.2g}") for one in moved]
    widths = [max(len(row[column]) for row in rows) for column in range(5)]
    for row in rows:
        print("  ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip())


def _run(group: str, case: str, trial: Trial) -> Record:
    print(f"{group}/{case}", end="\r", file=sys.stderr, flush=True)
    return run_case(group, case, trial)


if __name__ == "__main__":
    main()
