"""`python -m tests.mutants`: run chosen mutants against the tests that guard them."""

from __future__ import annotations

import argparse
import fnmatch
import os
import random
import shutil
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.mutants.guards import GUARDS, LEFT_OUT
from tests.mutants.judge import Judging, Times, judge
from tests.mutants.record import (
    GONE,
    HEADERS,
    KILLED,
    STORED,
    SUITES,
    SURVIVED,
    Record,
    as_text,
    by_room,
)
from tests.mutants.runs import Run, preload
from tests.mutants.seeds import Mutant, load
from tests.mutants.trees import ROOT, WORK, Scratch, unchanged


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the tool; returns 1 if a mutant is gone, 0 otherwise: a survivor is a finding, and no failure."""
    asked = _parser().parse_args(arguments)
    os.nice(asked.nice)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # runs in progress are ended, too
    listed = load()
    mutants = chosen(with_loops(listed, asked.loops), asked.only, asked.sample, asked.seed)
    if asked.check:
        return _check(mutants)
    record = Record(asked.record)
    if asked.table:
        return _show(record, listed)
    WORK.mkdir(parents=True, exist_ok=True)
    times, original = Times(WORK / "times.json"), unchanged()
    preload()
    if asked.time:
        _time(original, times, sorted({mutant.room for mutant in mutants}))
    left = [mutant for mutant in mutants if asked.renew or not _known(record, mutant, asked.suite)]
    print(f"{len(left)} of {len(mutants)} mutants to run, up to the suite {asked.suite!r}", flush=True)
    _run(left, original, times, record, asked)
    record.forget_unlisted(listed)
    return _show(record, mutants)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--only", action="append", default=[], metavar="PATTERN", help="room, key, file or slip")
    parser.add_argument("--loops", choices=("with", "without"), help="only files with compiled loops, or without")
    parser.add_argument("--sample", type=int, metavar="N", help="draw N of them")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of the draw")
    parser.add_argument("--suite", choices=SUITES, default="fast", help="up to which tests survivors go")
    parser.add_argument("--workers", type=int, default=2, help="mutants at a time")
    parser.add_argument("--renew", action="store_true", help="also those whose outcome is stored")
    parser.add_argument("--time", action="store_true", help="first time the fast tests of the rooms, unchanged")
    parser.add_argument("--check", action="store_true", help="only look whether every mutant's text is there")
    parser.add_argument("--table", action="store_true", help="only show what is stored")
    parser.add_argument("--record", type=Path, default=STORED, metavar="FILE", help="where outcomes are stored")
    parser.add_argument("--until", metavar="HH:MM", help="begin no mutant after that time of day")
    parser.add_argument("--nice", type=int, default=10)
    return parser


def chosen(listed: Sequence[Mutant], only: Sequence[str], sample: int | None, seed: int) -> list[Mutant]:
    """Return the mutants that match any of the patterns (all without one) in a drawn order, or the first so many: what
    an interrupted run has done is a drawn sample, too."""
    found = [m for m in listed if not only or any(_matches(m, pattern) for pattern in only)]
    random.Random(seed).shuffle(found)
    return found if sample is None else found[:sample]


def with_loops(listed: Sequence[Mutant], wanted: str | None) -> list[Mutant]:
    """Return the mutants of files with or without compiled loops: the former have to be compiled anew, each time."""
    if wanted is None:
        return list(listed)
    looped = {m.file for m in listed if (ROOT / m.file).is_file() and "\n@compiled" in (ROOT / m.file).read_text()}
    return [mutant for mutant in listed if (mutant.file in looped) == (wanted == "with")]


def _matches(mutant: Mutant, pattern: str) -> bool:
    if pattern in GUARDS:
        return mutant.room == pattern
    own = (mutant.key, mutant.file, mutant.slip)
    return any(fnmatch.fnmatch(text, pattern) or (len(pattern) > 3 and pattern in text) for text in own)


def _known(record: Record, mutant: Mutant, suite: str) -> bool:
    """Whether the stored outcome is as good as one that would be found now."""
    entry = record.entries.get(mutant.key)
    if entry is None or entry["result"] == GONE:
        return False
    return entry["result"] == KILLED or SUITES.index(entry["suite"]) >= SUITES.index(suite)


def _check(mutants: Sequence[Mutant]) -> int:
    """Name the mutants whose text is not in its file exactly once."""
    gone = []
    for mutant in mutants:
        path = ROOT / mutant.file
        if not path.is_file() or mutant.apply(path.read_text(encoding="utf-8")) is None:
            gone.append(f"gone: {mutant.key} ({mutant.file}): {mutant.slip}\n    {mutant.old}")
    print("\n".join([*gone, f"{len(mutants) - len(gone)} of {len(mutants)} mutants have their text"]))
    return 1 if gone else 0


def _time(original: Path, times: Times, rooms: Sequence[str]) -> None:
    """Time the fast tests of some rooms on the unchanged tree."""
    for room in rooms:
        log = WORK / f"time-{room}.log"
        run = Run(original, GUARDS[room], f"not slow and {LEFT_OUT}", lambda names: names, {}, log, stop=False)
        while (found := run.poll()) is None:
            time.sleep(0.5)
        times.learn(found)
        print(f"{room}: {len(found.seconds)} fast tests in {found.processor:.0f} s of processor time", flush=True)


@dataclass
class _Slot:
    """A mutant at work in a scratch copy."""

    mutant: Mutant
    judging: Judging
    run: Run
    began: float


def _run(left: list[Mutant], original: Path, times: Times, record: Record, asked: argparse.Namespace) -> None:
    """Judge mutants, some at a time, each in a scratch copy of its own."""
    own = WORK / f"scratch-{os.getpid()}"  # another run's copies may still be in use
    free = [Scratch(original, own / str(k)) for k in range(min(asked.workers, len(left)))]
    waiting, busy = list(left), {}
    try:
        while waiting or busy:
            while free and waiting and not _late(asked.until):
                scratch, mutant = free.pop(), waiting.pop(0)
                before = None if asked.renew else record.entries.get(mutant.key)
                judging = judge(mutant, scratch, asked.suite, times, before, _likely(record, mutant))
                try:
                    busy[scratch] = _Slot(mutant, judging, next(judging), time.monotonic())
                except StopIteration as ended:  # gone
                    _enter(record, mutant, ended.value, 0.0, len(waiting))
                    free.append(scratch)
            if not busy:
                break
            for scratch, slot in list(busy.items()):
                found = slot.run.poll()
                if found is None:
                    continue
                try:
                    slot.run = slot.judging.send(found)
                except StopIteration as ended:
                    _enter(record, slot.mutant, ended.value, time.monotonic() - slot.began, len(waiting))
                    del busy[scratch]
                    free.append(scratch)
            time.sleep(0.5)
    finally:
        for slot in busy.values():
            slot.run.end()
        shutil.rmtree(own, ignore_errors=True)


def _late(until: str | None) -> bool:
    return until is not None and time.strftime("%H:%M") >= until


def _likely(record: Record, mutant: Mutant) -> list[str]:
    """Tests that killed other mutants of the same file, or this one before."""
    found = [entry["by"] for entry in record.entries.values() if entry.get("by") and entry["file"] == mutant.file]
    own = record.entries.get(mutant.key, {}).get("by")
    return list(dict.fromkeys([*([own] if own else []), *found]))


def _enter(record: Record, mutant: Mutant, entry: dict[str, object], wall: float, waiting: int) -> None:
    record.enter(mutant, {**entry, "reason": mutant.reason})
    by = f" by {entry['by']} ({entry['how']})" if "by" in entry else ""
    print(f"{mutant.key}: {entry['result']}{by}, {wall:.0f} s; {mutant.slip} [{waiting} wait]", flush=True)


def _show(record: Record, mutants: Sequence[Mutant]) -> int:
    """Print the tables of the stored outcomes of some mutants."""
    entries = record.current(mutants)
    print(as_text(HEADERS, by_room(entries)))
    for kind in (SURVIVED, GONE):
        for key, entry in entries.items():
            if entry["result"] == kind:
                told = f" ({entry['suite']}): {entry.get('reason') or 'not yet judged'}" if kind == SURVIVED else ""
                print(f"{kind}: {key}: {entry['slip']}{told}")
    return 1 if any(entry["result"] == GONE for entry in entries.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
