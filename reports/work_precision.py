"""The top of the performance page: how long an asked-for error of each physical figure takes, ours and others'.

Drawn from `reports/results/work_precision.json`, which `python -m reports.benchmarks --kind all --peers` appends to.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from bem.benchmarks.physical_cases import PHYSICAL
from bem.benchmarks.show import draw_reach
from bem.benchmarks.work_precision import ERROR_HEADERS, REACH_HEADERS, error_rows, reach_rows
from reports.benchmarks.history import StoredRun, read_history
from reports.benchmarks.peer_figures import curves_with_peers
from reports.benchmarks.tables import draw_errors
from reports.builder import Section, figure, table, text
from reports.reproduced import paragraph

RESULTS = Path(__file__).resolve().parent / "results" / "work_precision.json"
AREA = RESULTS.with_name("contact_area.json")
_AREA_ASKED = {256: 0.005, 512: 0.001}
"""Relative error of the contact area that was hoped for, by cells a side."""
COMMAND = "python -m reports.benchmarks --kind all --peers"
"""Kinds of scene whose code the benchmarks run."""
_WORDS = (
    "What a user waits for is an error of a figure, not a residual. Each figure is compared with the limit of its two "
    "finest grids; an error counts as reached on a grid if all finer ones have it too. On the rough surface (no waves "
    "shorter than 1/48 of the side, 8 % in contact) the peers solve the same discrete problem and count its cells; "
    "`cells alone` is what bem's cells and points have without what it finds between them. Open circles are drawn on "
    "from the last two grids."
)


def sections() -> Iterator[Section]:
    """The picture with its table, and the curves of each kind; nothing where no run is stored."""
    runs = read_history(RESULTS)
    if not runs:
        return
    run = runs[-1]
    found = curves_with_peers(run)
    body = text(_WORDS) + figure(draw_reach(found), "Processor time, one thread, to errors of 10, 3, 1 and 0.3 %.")
    body += table(REACH_HEADERS, reach_rows(found), caption=f"Seconds; in brackets: drawn on. {measured_on(run)}")
    yield Section("Time to an error, ours and others'", body)
    for case in PHYSICAL.values():
        if any(point.case == case.name for point in run.points):
            caption = (
                "Full lines: as bem gives it; broken: cells alone; dotted and paler: peers; thin: looser tolerances. "
                f"Sizes are {case.size_name}."
            )
            yield Section(
                f"Error over time and memory: {case.title[0].lower()}{case.title[1:]}",
                figure(draw_errors(found, case.kind), caption),
            )
    yield Section("All errors of figures", table(ERROR_HEADERS, error_rows(found)))
    yield _area()


def _area() -> Section:
    """How far contact areas of rough surfaces are off, and whether what was asked for is met."""
    stored = json.loads(AREA.read_text("utf-8"))["rows"]
    loads, cells = sorted({row["load"] for row in stored}), sorted({row["cells"] for row in stored})
    rows, met = [], []
    for load in loads:
        for n in cells:
            own = [row for row in stored if (row["load"], row["cells"]) == (load, n)]
            share = f"{100 * sum(row['area'] for row in own) / len(own):.0f} %"
            ends = [
                (min(row[way] for row in own), max(row[way] for row in own)) for way in ("counted", "perimeter", "edge")
            ]
            asked = _AREA_ASKED.get(n)
            verdict = "" if asked is None else "met" if max(map(abs, ends[-1])) < asked else "missed"
            met.append(verdict)
            rows.append((share, n, *(f"{100 * a:+.2g} to {100 * b:+.2g} %" for a, b in ends), verdict))
    asked_words = " and ".join(f"{100 * share:g} % at {n} cells a side" for n, share in _AREA_ASKED.items())
    words = (
        "Three band-limited surfaces (cut-off 48 waves a side), three loads, against 2048 cells a side. Asked for were "
        f"{asked_words}: met at {met.count('met')} of {met.count('met') + met.count('missed')}."
    )
    head = (
        "in contact",
        "cells a side",
        "counted",
        "corrected by the perimeter",
        "edge inside cells (bem)",
        "asked for",
    )
    return Section("Contact area from few cells", text(words) + table(head, rows) + paragraph(AREA.stem))


def measured_on(run: StoredRun) -> str:
    """Where and when, in words; a busy machine is told, and code that has changed since."""
    load = run.machine.get("load average at the end", "unknown")
    return f"Commit {run.commit}, {run.date}, {run.machine.get('processor', '')}, load average {load} ({COMMAND})."
