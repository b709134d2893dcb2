"""What more threads would give, on the page of run times, from the stored count; other codes that are not beside bem.

Knows the experiment; nothing is measured here. Verified in tests/reports/test_goals.py.
"""

from __future__ import annotations

from reports.builder import table, text
from reports.experiments.kept import age, found
from reports.experiments.shared_work import RESULT, THREADS

MISSING = (
    ("contacts of slippy", "all", "not driven: it searches an approach for a load; timed once before, see below"),
    ("tamaas with OpenMP", "all", "its wheel has none, and the package index has no source of it to build"),
    ("ContactMechanics", "4096", "stopped after 25 minutes of a solve"),
    ("stresses of ContactMechanics and ASPHER", "all", "neither has any below the surface"),
    ("von Mises stress alone", "all", "tamaas and slippy have it from six stored stresses only"),
)
"""What, cells a side, and why it is not in the tables of peers."""


def gains() -> str:
    """Amdahl's bound by counting, for two, four and eight threads."""
    if not RESULT.exists():
        return text(f"Not run: python -m reports.experiments.{RESULT.stem}")
    body = text(
        "What more threads would gain at best (Amdahl), counted: a case runs as on so many threads, but one does all "
        "blocks, and is timed with them. What is outside of blocks is serial; of b blocks n threads do at best "
        "ceil(b/n) in a row. Waiting for memory is not in it, nor does it need a second core or a quiet machine. Below "
        "1024 cells threads are better spent on cases than within one: a case to a core is what `bem sweep` does. "
        f"`python -m reports.experiments.{RESULT.stem}` repeats it."
    )
    rows = [
        (row["case"], f"{row['size']:g}", f"{100 * row['serial']:.0f}", *(f"{gain:.2f}" for gain in row["gains"]))
        for row in found(RESULT.stem)
    ]
    headers = ("case", "size", "serial share, %", *(f"gain of {n} at best" for n in THREADS))
    return body + table(headers, rows) + age(RESULT.stem)


def missing() -> str:
    """What is not compared, and why."""
    return table(("code or task", "cells a side", "why it is not beside bem"), MISSING, caption="Not compared.")
