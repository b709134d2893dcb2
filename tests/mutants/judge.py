"""The judgement of one mutant: run the guarding tests stage by stage, and check a kill on the unchanged tree."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Generator, Iterable
from pathlib import Path
from typing import Any

from tests.mutants.guards import GATES, GUARDS, LEFT_OUT
from tests.mutants.record import GONE, KILLED, SUITES, SURVIVED, Entry
from tests.mutants.runs import Finished, Run
from tests.mutants.seeds import Mutant
from tests.mutants.trees import Scratch

BOUNDS = (0.1, 0.5, 2.0, 8.0, 30.0)
"""Seconds between classes of tests: those of a shorter class are run first."""
UNKNOWN = 1.0
"""Seconds that a test is taken to need which has not been timed yet."""
SHARED_SETUP = 0.5
"""Seconds of a set-up from which the tests of a file stay together, since they share it."""
LEAD = 2
"""Classes by which tests of files that name the changed module are preferred."""
FAR_LESS = 0.25
"""A timeout counts as a kill if the unchanged tree needs less than this fraction of the time allowed."""

Judging = Generator[Run, Finished, Entry]


class Times:
    """Seconds and outcomes of tests on the unchanged tree, and where they are kept between runs of the tool."""

    def __init__(self, path: Path) -> None:
        self.path = path
        known: dict[str, Any] = json.loads(path.read_text()) if path.is_file() else {}
        self.seconds: dict[str, float] = known.get("seconds", {})
        self.guessed: dict[str, float] = known.get("guessed", {})
        """Seconds on changed trees, of tests that have not been timed on the unchanged one."""
        self.setup: dict[str, float] = known.get("setup", {})
        self.broken: set[str] = set(known.get("broken", []))
        """Tests that fail without any change: they say nothing, and are left out."""

    def learn(self, found: Finished) -> None:
        """Take over what a run of the unchanged tree has found."""
        self.seconds |= found.seconds
        self.setup |= found.setup
        self.broken |= {*found.failed, *([found.killer] if found.killer is not None else [])}
        self.write()

    def guess(self, found: Finished) -> None:
        """Take over the times of a run of a changed tree, which may be longer for what had to be compiled."""
        for name, seconds in found.seconds.items():
            self.guessed[name] = min(seconds, self.guessed.get(name, seconds))
        self.write()

    def write(self) -> None:
        """Keep them."""
        kept = {"seconds": self.seconds, "guessed": self.guessed, "setup": self.setup, "broken": sorted(self.broken)}
        self.path.write_text(json.dumps(kept, indent=0))

    def ranking(self, paths: list[str], first: Iterable[str] = (), mentioning: str = "") -> Callable[..., list[str]]:
        """Return what sorts tests: those in `first`, then by class of seconds, files that name the module `mentioning`
        preferred, then in the order of `paths` and of collection. Broken tests are dropped."""
        early = {name: place for place, name in enumerate(first)}
        importing: dict[str, bool] = {}
        files: dict[str, list[str]] = {}
        for name in self.seconds:
            files.setdefault(name.split("::")[0], []).append(name)
        together = {
            file: sum(self.seconds[name] for name in names) / len(names)
            for file, names in files.items()
            if max(self.setup.get(name, 0.0) for name in names) > SHARED_SETUP
        }

        def ranked(names: list[str]) -> list[str]:
            def rank(name: str) -> tuple[Any, ...]:
                file = name.split("::")[0]
                if file not in importing:
                    importing[file] = bool(mentioning) and _imports(Path(file), mentioning)
                seconds = together.get(file, self.seconds.get(name, self.guessed.get(name, UNKNOWN)))
                place = next((k for k, path in enumerate(paths) if file.startswith(path)), len(paths))
                cost = sum(seconds > bound for bound in BOUNDS) + (0 if importing[file] else LEAD)
                return early.get(name, len(early)), cost, not importing[file], place

            return sorted((name for name in names if name not in self.broken), key=rank)

        return ranked


def _imports(file: Path, module: str) -> bool:
    """Whether a test file names a module of the package, or is named after it."""
    package, _, stem = module.rpartition(".")
    if stem in file.stem:
        return True
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    return module in text or re.search(rf"from {package} import [^\n]*\b{stem}\b", text) is not None


def stages(room: str, suite: str, after: str | None = None) -> list[tuple[str, list[str], str]]:
    """Return the runs up to a suite, and after another one that was survived: suite, paths, marks."""
    found = [
        ("fast", GUARDS[room], f"not slow and {LEFT_OUT}"),
        ("full", GUARDS[room], f"slow and {LEFT_OUT}"),
        ("gates", GATES, LEFT_OUT),
    ]
    return found[0 if after is None else SUITES.index(after) + 1 : SUITES.index(suite) + 1]


def judge(
    mutant: Mutant, scratch: Scratch, suite: str, times: Times, before: Entry | None, first: list[str]
) -> Judging:
    """Judge a mutant up to a suite; yields runs, is sent their outcomes, and returns the entry of the record.

    before : an outcome to go on from, of a smaller suite. first : tests that are likely to kill it.
    """
    source = scratch.original / mutant.file
    changed = mutant.apply(source.read_text(encoding="utf-8")) if source.is_file() else None
    if changed is None:
        return {"result": GONE, "suite": suite}
    survived = before["suite"] if before is not None and before["result"] == SURVIVED else None
    spent = before.get("processor_s", 0.0) if survived and before else 0.0
    tests = before.get("tests", 0) if survived and before else 0
    module = mutant.file.removesuffix(".py").replace("/", ".")
    entry: Entry = {"result": SURVIVED, "suite": survived or "fast"}
    scratch.write(mutant.file, changed)
    try:
        for name, paths, marks in stages(mutant.room, suite, survived):
            while True:
                ranked = times.ranking(paths, first, module)
                log = scratch.folder.with_suffix(".log")
                found = yield Run(scratch.folder, paths, marks, ranked, times.seconds, log)
                spent, tests = spent + found.processor, tests + len(found.seconds)
                times.guess(found)
                entry["suite"] = name
                if found.killer is None:
                    break
                sound = yield from _passes_unchanged(found, scratch, times)
                if sound:
                    entry |= {"result": KILLED, "by": found.killer, "how": found.how}
                    break
                if found.killer not in times.broken:  # slow without the change, too: that says nothing
                    times.broken.add(found.killer)
                    times.write()
            if entry["result"] == KILLED:
                break
    finally:
        scratch.restore(mutant.file)
    return entry | {"tests": tests, "processor_s": round(spent, 1)}


def _passes_unchanged(found: Finished, scratch: Scratch, times: Times) -> Generator[Run, Finished, bool]:
    """Whether the test that has failed passes on the unchanged tree, in far less time if it was too late."""
    assert found.killer is not None
    if found.killer == "collection":
        return True
    if found.killer not in times.seconds or found.how == "timeout":
        file = found.killer.split("::")[0]
        log = scratch.folder.with_name(f"{scratch.folder.name}-unchanged.log")

        def alone(names: list[str]) -> list[str]:
            return [name for name in names if name.startswith(found.killer or "")]

        healthy = yield Run(scratch.original, [file], LEFT_OUT, alone, times.seconds, log)
        times.learn(healthy)
        if healthy.killer is not None:
            return False
        if found.how == "timeout" and healthy.processor > FAR_LESS * found.processor:
            return False
    return True
