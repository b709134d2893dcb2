"""Stored durations of tests: which are left out of the fast tests, and in which order workers take their files.

    python tests/durations.py LOG

LOG is the output of `pytest --durations=0 --durations-min=0.05`. Its durations replace those stored of the same files.
Slow functions need no mark of their own. A test that kills a mutant (`reports/results/mutants.json`) stays with the
fast tests, which the mutation tool runs.
"""

from __future__ import annotations

import json
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

TESTS = Path(__file__).resolve().parent
STORED = TESTS / "durations.json"
"""Seconds of all cases of a test function and of its longest case, by its identifier; none below `LEAST`."""
MUTANTS = TESTS.parent / "reports" / "results" / "mutants.json"
LEAST = 0.2
"""Seconds below which the duration of a function does not matter."""
SLOW_CASE = 0.4
"""Seconds of its longest case from which a function is slow: the fast tests take 2.5 minutes together."""
SLOW_FUNCTION = 1.2
"""Seconds of all cases of a function from which it is slow."""
SHARING = ("tests/gallery/test_gallery.py", "tests/results/test_compare_runs.py", "tests/golden/test_golden.py")
"""Files that read the same runs (`golden_runs`): one worker takes them in turn, as two would wait for one another."""
_LINE = re.compile(r"\s*([\d.]+)s (?:call|setup|teardown)\s+(tests/.*?)\s*$")


def function_of(name: str) -> str:
    """Return the identifier of the test function of a case."""
    return name.partition("[")[0]


def stored() -> dict[str, tuple[float, float]]:
    """Return the stored seconds of test functions: of all cases, and of the longest."""
    return {name: (total, longest) for name, (total, longest) in json.loads(STORED.read_text("utf-8")).items()}


def killers() -> set[str]:
    """Return the test functions that kill mutants."""
    entries = json.loads(MUTANTS.read_text("utf-8"))["mutants"].values()
    return {function_of(entry["by"]) for entry in entries if entry.get("by")}


def slow_functions(seconds: Mapping[str, tuple[float, float]], kept: set[str]) -> set[str]:
    """Return the functions that are left out of the fast tests.

    Parameters
    ----------
    seconds : of all cases of a function, and of its longest case.
    kept : functions that stay with the fast tests.
    """
    return {
        function
        for function, (total, longest) in seconds.items()
        if function not in kept and (total >= SLOW_FUNCTION or longest >= SLOW_CASE)
    }


def file_seconds(functions: Iterable[str], seconds: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """Return the seconds of each file: of those of its functions that are given, once each.

    Parameters
    ----------
    functions : functions that will run, once for each case.
    seconds : of all cases of a function, and of its longest case.
    """
    found: dict[str, float] = {}
    for function in dict.fromkeys(functions):
        file = function.partition("::")[0]
        found[file] = found.get(file, 0.0) + seconds.get(function, (0.0, 0.0))[0]
    return found


def deal_files(seconds: Mapping[str, float], sharing: Sequence[str] = SHARING) -> list[str]:
    """Return the files in the order in which two workers take them, each half with its longest files first.

    Workers begin with one half each and steal from the end of the other's: long tests at an end would be waited for.

    Parameters
    ----------
    seconds : of all tests of the files.
    sharing : files that follow one another in the same half.
    """
    together = [file for file in sharing if file in seconds]
    groups = [[file] for file in seconds if file not in together] + ([together] if together else [])
    halves: tuple[list[str], list[str]] = ([], [])
    sums = [0.0, 0.0]
    for total, group in sorted((-sum(seconds[file] for file in group), group) for group in groups):
        half = int(sums[1] < sums[0])
        halves[half].extend(group)
        sums[half] -= total
    return [*halves[0], *halves[1]]


def read_log(lines: Iterable[str]) -> dict[str, tuple[float, float]]:
    """Return the seconds of test functions, of all cases and of the longest, from the output of pytest."""
    cases: defaultdict[str, float] = defaultdict(float)
    for line in lines:
        match = _LINE.match(line)
        if match:
            cases[match[2]] += float(match[1])
    found: dict[str, tuple[float, float]] = {}
    for name, value in cases.items():
        total, longest = found.get(function_of(name), (0.0, 0.0))
        found[function_of(name)] = (total + value, max(longest, value))
    return found


def write(seconds: Mapping[str, tuple[float, float]]) -> None:
    """Store the seconds of functions, a line each."""
    lines = [
        f"{json.dumps(name)}: [{total:.1f}, {longest:.1f}]"
        for name, (total, longest) in sorted(seconds.items())
        if total >= LEAST
    ]
    STORED.write_text("{\n" + ",\n".join(lines) + "\n}\n", "utf-8")


def main() -> None:
    """Store the durations of a log, in place of those of the same files."""
    found = read_log(Path(sys.argv[1]).read_text("utf-8", "replace").splitlines())
    files = {name.partition("::")[0] for name in found}
    others = {name: value for name, value in stored().items() if name.partition("::")[0] not in files}
    there = {name: value for name, value in others.items() if (TESTS.parent / name.partition("::")[0]).is_file()}
    write(there | found)


if __name__ == "__main__":
    main()
