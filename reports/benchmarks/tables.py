"""Tables and pictures of stored runs: goals, threads, memory, other codes, and two runs side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.benchmarks.record import Run
from bem.benchmarks.show import Table, by_case, floor_share
from bem.benchmarks.work_precision import CELLS_ALONE, OURS, Curve
from reports.benchmarks.beside import (
    CURVE_HEADERS,
    MISES_HEADERS,
    STRESS_HEADERS,
    curve_rows,
    mises_rows,
    stress_rows,
)
from reports.benchmarks.goals import FLOOR_GOALS, PEER_GOALS
from reports.benchmarks.history import StoredRun, compare, find_run, read_history

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEAST_MEMORY = 2**20
"""Bytes below which a solve fitted into what its process held from before: its own share is not known."""


def floor_rows(run: Run) -> list[tuple[str, ...]]:
    """Time beside convolutions and FFTW pairs, for each size that both were measured at."""
    rows: list[tuple[str, ...]] = []
    for points in by_case(run).values():
        for p in points:
            share = floor_share(run, p)
            if share is not None and run.floor is not None:
                pair = 1e3 * (run.floor.pair(int(p.size), 32, 1) or math.nan)
                count, goal = p.counts["convolutions"], FLOOR_GOALS.get(int(p.size))
                wanted = "" if goal is None or p.case != "contact-periodic" else f"{goal:g}"
                cells = f"{p.size:g}", f"{1e3 * p.cpu_median:.3g}", f"{count:.1f}", f"{pair:.3g}"
                rows.append((p.case, *cells, f"{share:.2f}", wanted))
    return rows


FLOOR_HEADERS = ("case", "cells a side", "CPU ms", "convolutions", "FFTW pair, ms", "time / floor", "goal")


def thread_rows(run: Run) -> list[tuple[str, ...]]:
    """Rows of the gain of a second thread, the serial share of the work, and the gains that four and eight would have.

    By Amdahl (*AFIPS Conf. Proc.* 30, 1967): with the share s, n threads take s + (1 - s)/n of the time of one. s is
    what follows from two, so that memory that both wait for counts as serial.
    """
    points = {(p.case, p.size, p.threads): p for p in run.points}
    rows: list[tuple[str, ...]] = []
    for (case, size, threads), two in points.items():
        one = points.get((case, size, 1))
        if threads != 2 or one is None or not one.wall_median > 0:
            continue
        serial = min(1.0, max(0.0, 2 * two.wall_median / one.wall_median - 1))
        gains = [1 / (serial + (1 - serial) / n) for n in (4, 8)]
        measured = one.wall_median / two.wall_median
        rows.append((case, f"{size:g}", f"{measured:.2f}", f"{100 * serial:.0f}", *(f"{gain:.1f}" for gain in gains)))
    return rows


THREAD_HEADERS = ("case", "size", "gain of two threads", "serial share, %", "gain of four", "gain of eight")


def memory_rows(run: Run) -> list[tuple[str, ...]]:
    """Most bytes that the largest point of each case took beyond what was there, a cell (and depth)."""
    rows: list[tuple[str, ...]] = []
    for name, points in by_case(run).items():
        point = points[-1]
        each = point.values.get("bytes_a_cell")
        if each is None and name.startswith(("contact-", "stress", "von-mises")) and point.memory > 0:  # of older runs
            each = point.memory / (point.size**2 * point.counts.get("depths", 1.0))
        if each is not None and name != "contact-tolerance":
            rows.append((name, f"{point.size:g}", f"{point.memory / 2**20:.0f}", f"{each:.0f}"))
    return rows


MEMORY_HEADERS = ("case", "cells a side", "memory, MiB", "bytes a cell (and depth)")


def peer_rows(peers: Sequence[Mapping[str, Any]]) -> list[tuple[str, ...]]:
    """Peers beside bem, of a run's rows or others like them."""
    from statistics import median

    return [
        (
            row["peer"],
            str(row["cells"]),
            f"{row['complementarity']:.1e}",
            f"{median(row['cpu']):.3g}",
            f"{row['bem_complementarity']:.1e}",
            f"{median(row['bem_cpu']):.3g}",
            f"{row['ratio']:.1f}",
            f"{PEER_GOALS[of]:g}" if (of := (row["peer"], row["cells"])) in PEER_GOALS else "",
        )
        for row in peers
    ]


PEER_HEADERS = ("peer", "cells", "its residual", "its CPU s", "bem's residual", "bem's CPU s", "ratio", "goal")


def print_peers(run: StoredRun, table: Table) -> None:
    """Print what other codes did in a run."""
    if rows := peer_rows(run.peers):
        table(PEER_HEADERS, rows, title="peers at equal residual, one thread", right=range(1, 8))
    if run.peer_curves:
        title = "peers: 20 loads, at equal residual and at equal error of the area"
        table(CURVE_HEADERS, curve_rows(run.peer_curves), title=title, right=range(2, 16))
    if run.peer_stresses:
        title = "peers: six stresses on the same points"
        table(STRESS_HEADERS, stress_rows(run.peer_stresses), title=title, right=range(2, 13))
        title = "peers: highest von Mises stress at equal error"
        table(MISES_HEADERS, mises_rows(run.peer_stresses), title=title, right=range(2, 10))


def print_comparison(path: Path, old: str, new: str, table: Table) -> None:
    """Two commits of a history side by side.

    Raises
    ------
    InputError : a commit that the history does not have.
    """
    runs = read_history(path)
    before, after = find_run(runs, old), find_run(runs, new)
    rows: list[tuple[str, ...]] = []
    for c in compare(before, after):
        counts = ", ".join(f"{name} {a:.4g} -> {b:.4g}" for name, (a, b) in c.counts.items())
        verdict = ("slower" if c.ratio > 1 else "faster") if c.clear else "within noise"
        rows.append(
            (
                c.case,
                f"{c.size:g}",
                str(c.threads),
                f"{1e3 * c.before:.3g}",
                f"{1e3 * c.after:.3g}",
                f"{c.ratio:.2f}",
                verdict,
                "" if math.isnan(c.error_ratio) else f"{c.error_ratio:.2f}",
                counts,
            )
        )
    headers = ("case", "size", "threads", "old ms", "new ms", "ratio", "", "error ratio", "counts that changed")
    table(headers, rows, title=f"{before.commit} ({before.date}) -> {after.commit} ({after.date})", right=range(1, 6))


def draw_errors(found: Sequence[Curve], kind: str) -> Figure:
    """Errors of a kind's figures over processor time, and over memory where any curve is told by it: with corrections
    (full lines), of cells alone (broken), by peers (dotted, paler); thin lines are of looser tolerances."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    own = [c for c in found if c.kind == kind]
    over_memory = [c for c in own if _memory_rises(c)]
    picture = Figure(figsize=(9, 3.8), layout="constrained")
    FigureCanvasAgg(picture)
    panels = picture.subplots(1, 2 if over_memory else 1, sharey=True, squeeze=False)[0]
    _draw_curves(panels[0], own, lambda c: c.times, own)
    panels[0].set(xlabel="processor time, s", ylabel="error, %")
    if over_memory:
        _draw_curves(panels[1], over_memory, _mebibytes, own)
        panels[1].set(xlabel="memory beyond what the process held, MiB")
    picture.legend(*panels[0].get_legend_handles_labels(), fontsize=7, ncols=5, loc="outside upper center")
    return picture


def _memory_rises(curve: Curve) -> bool:
    """Return True if at least two grids needed more than the process held, and the finer ones the more."""
    told = [m for m in curve.memory if m > _LEAST_MEMORY]
    return len(told) > 1 and told == sorted(told)


def _mebibytes(curve: Curve) -> tuple[float, ...]:
    return tuple(m / 2**20 if m > _LEAST_MEMORY else math.nan for m in curve.memory)


def _draw_curves(
    axes: Axes, drawn: Sequence[Curve], across: Callable[[Curve], Sequence[float]], own: Sequence[Curve]
) -> None:
    """`own`, all curves of the kind, give the colours, one for each figure."""
    figures = list(dict.fromkeys(c.figure for c in own))
    most = max((c.digits for c in own), default=0)
    for c in drawn:
        ours = c.solver in (OURS, CELLS_ALONE)
        tight = c.digits in (0, most)
        axes.plot(
            across(c),
            [100 * max(error, 1e-6) for error in c.errors],
            {OURS: "o-", CELLS_ALONE: "o--"}.get(c.solver, "s:"),
            ms=3 if ours else 2.5,
            lw=1.2 if tight else 0.5,
            color=f"C{figures.index(c.figure)}",
            alpha=1.0 if ours else 0.5,
            label=c.figure.replace("_", " ") if c.solver == OURS and tight else None,
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", lw=0.3)
