"""Cases of long tests drawn by the commit: another part of them runs at every commit.

A function marked `drawn(part)` runs one of `part` of its cases. All of them run where `TEST_CASES=all` is set, where a
test is named on the command line (`file.py::function`), and where no commit is known, as in a copy of the tree.
"""

from __future__ import annotations

import math
import os
import subprocess
from collections import defaultdict
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path

from durations import function_of


def commit() -> str:
    """Return the commit of the working tree, or an empty text where there is none."""
    done = subprocess.run(
        ["git", "rev-parse", "HEAD"], cwd=Path(__file__).parent, capture_output=True, text=True, check=False
    )
    return done.stdout.strip() if done.returncode == 0 else ""


def all_cases_run(arguments: Iterable[str], known: str) -> bool:
    """Return whether nothing is drawn.

    Parameters
    ----------
    arguments : files and tests that the command line names.
    known : the commit, an empty text where there is none.
    """
    return os.environ.get("TEST_CASES") == "all" or not known or any("::" in one for one in arguments)


def left_out(parts: Mapping[str, int], seed: str) -> set[str]:
    """Return the cases that are not drawn: of each function all but one of so many, rounded up.

    Parameters
    ----------
    parts : of each case, by its identifier, the number of parts that the cases of its function are split into.
    seed : another seed draws other cases.
    """
    cases = defaultdict(list)
    for case in parts:
        cases[function_of(case)].append(case)
    found: set[str] = set()
    for names in cases.values():
        shuffled = sorted(names, key=lambda name: sha256(f"{seed} {name}".encode()).digest())
        found.update(shuffled[math.ceil(len(names) / parts[names[0]]) :])
    return found
