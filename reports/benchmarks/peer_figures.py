"""Physical figures of other codes on the rough surface of `bem bench --kind contact`, against the same reference."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from bem.benchmarks.measure import named_failure
from bem.benchmarks.physical_cases import PHYSICAL, pressure_figures, rough_surface
from bem.benchmarks.work_precision import Curve, curves, reference
from reports.benchmarks.history import StoredRun
from reports.benchmarks.peers import SCRIPTS, solve_by_peer

SIZES, QUICK = (128, 256, 512, 1024), (128, 256)
"""Cells a side."""


def figures_of_peers(
    python: Path,
    quick: bool,
    repeats: int,
    say: Callable[[str], None],
    rows: list[dict[str, Any]],
    failures: dict[str, str],
) -> None:
    """Add a row for each peer and grid, and what failed."""
    for peer in SCRIPTS:
        for cells in QUICK if quick else SIZES:
            say(f"{peer} at {cells}")
            gap = rough_surface(cells)
            with named_failure(failures, f"{peer} {cells}"):
                times, memory, pressure = solve_by_peer(python, peer, gap, repeats if cells < 1024 else 1)
                figures = pressure_figures(pressure, gap)
                rows.append({"peer": peer, "cells": cells, "cpu": times, "memory": memory, "figures": figures})


def curves_with_peers(run: StoredRun) -> list[Curve]:
    """Return the curves of a run, those of other codes last."""
    contact = PHYSICAL["contact"]
    limits = reference(contact, [p for p in run.points if p.case == contact.name])
    found = curves(run)
    for peer in dict.fromkeys(row["peer"] for row in run.peers):
        rows = sorted((row for row in run.peers if row["peer"] == peer and "figures" in row), key=lambda r: r["cells"])
        for name in rows[0]["figures"] if rows else ():
            if name in limits:
                found.append(
                    Curve(
                        contact.kind,
                        name,
                        peer,
                        0,
                        tuple(row["cells"] for row in rows),
                        tuple(sorted(row["cpu"])[len(row["cpu"]) // 2] for row in rows),
                        tuple(row["memory"] for row in rows),
                        tuple(abs(row["figures"][name] / limits[name] - 1) for row in rows),
                    )
                )
    return found
