"""A run as tables and a figure; two runs side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.benchmarks.beside import (
    CURVE_HEADERS,
    MISES_HEADERS,
    STRESS_HEADERS,
    curve_rows,
    mises_rows,
    stress_rows,
)
from bem.benchmarks.cases import CASES
from bem.benchmarks.history import Run, compare, find_run, read_history
from bem.benchmarks.measure import Point, growth
from bem.benchmarks.peers import GOALS
from bem.benchmarks.work_precision import CELLS_ALONE, OURS, TARGETS, Curve, best, curves
from bem.results.atomic import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Table = Callable[..., None]

FLOOR_GOALS = {256: 2.5, 512: 1.8, 1024: 1.6, 2048: 1.5}
"""Time of the periodic contact over that of as many FFTW pairs as it has convolutions, by cells a side."""
_LEAST_MEMORY = 2**20
"""Bytes below which a solve fitted into what its process held from before: its own share is not known."""


def by_case(run: Run, threads: int | None = 1) -> dict[str, list[Point]]:
    """Points of each case, by size."""
    found: dict[str, list[Point]] = {}
    for point in sorted(run.points, key=lambda p: (p.size, p.threads)):
        if threads is None or point.threads == threads:
            found.setdefault(point.case, []).append(point)
    return {name: found[name] for name in CASES if name in found}


def time_exponent(points: Sequence[Point]) -> float:
    """How the time grows with the size."""
    return growth([p.size for p in points], [p.cpu_median for p in points])


def floor_share(run: Run, point: Point) -> float | None:
    """Time over that of as many single-precision pairs of transforms with FFTW's measured plans; periodic only."""
    if (
        run.floor is None
        or "convolutions" not in point.counts
        or point.case not in ("contact-periodic", "contact-capped")
    ):
        return None
    pair = run.floor.pair(int(point.size), 32, 1)
    return None if pair is None else point.cpu_median / (point.counts["convolutions"] * pair)


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


def point_rows(run: Run) -> list[tuple[str, ...]]:
    """One row of words per point."""
    rows: list[tuple[str, ...]] = []
    for points in by_case(run, None).values():
        for p in points:
            counts = ", ".join(f"{name} {value:.4g}" for name, value in (p.counts | p.values).items())
            rows.append(
                (
                    p.case,
                    f"{p.size:g}",
                    str(p.threads),
                    f"{p.error:.1e}",
                    f"{1e3 * p.cpu_median:.3g}",
                    f"{100 * p.spread:.0f} %",
                    f"{1e3 * p.wall_median:.3g}",
                    f"{1e3 * p.first_cpu:.3g}",
                    f"{p.memory / 2**20:.0f}",
                    counts,
                )
            )
    return rows


POINT_HEADERS = (
    "case",
    "size",
    "threads",
    "error",
    "CPU ms",
    "spread",
    "wall ms",
    "first ms",
    "MiB",
    "counts and values",
)


def split_rows(run: Run) -> list[tuple[str, ...]]:
    """Where the time of the largest point of each case goes, in per cent."""
    rows: list[tuple[str, ...]] = []
    for name, points in by_case(run).items():
        split = points[-1].split
        whole = split.get("whole", 0.0)
        if whole <= 0:
            continue
        shares = {key: value / whole for key, value in split.items() if key != "whole"}
        if not shares:
            continue
        rest = max(0.0, 1 - sum(shares.values()))
        words = [
            f"{100 * shares.get(key, 0.0):.0f}"
            for key in ("transforms", "rounds", "elementwise", "preconditioner", "pieces")
        ]
        share = floor_share(run, points[-1])
        rows.append(
            (name, f"{points[-1].size:g}", *words, f"{100 * rest:.0f}", "" if share is None else f"{share:.2f}")
        )
    return rows


def thread_rows(run: Run) -> list[tuple[str, ...]]:
    """What a second thread gained, the share of the work that it did not help with, and what four and eight would gain.

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


SPLIT_HEADERS = (
    "case",
    "size",
    "transforms %",
    "compiled rounds %",
    "elementwise %",
    "preconditioner %",
    "pieces %",
    "other %",
    "time / floor",
)


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
            f"{GOALS[of]:g}" if (of := (row["peer"], row["cells"])) in GOALS else "",  # of today, not of the run
        )
        for row in peers
    ]


PEER_HEADERS = ("peer", "cells", "its residual", "its CPU s", "bem's residual", "bem's CPU s", "ratio", "goal")


def print_run(run: Run, table: Table) -> None:
    """The tables of a run."""
    table(POINT_HEADERS, point_rows(run), title=f"commit {run.commit or 'unknown'}", right=range(1, 9))
    exponents = [(name, f"{time_exponent(points):.2f}") for name, points in by_case(run).items() if len(points) > 1]
    if exponents:
        table(("case", "time grows with size to the power"), exponents, right=(1,))
    if rows := split_rows(run):
        table(SPLIT_HEADERS, rows, title="where the time goes", right=range(1, 9))
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
    if run.floor is not None:
        pairs = [(key, f"{1e3 * value:.3g}") for key, value in run.floor.pairs.items()]
        pairs.append(("memory bandwidth, GB/s", f"{run.floor.bandwidth / 1e9:.3g}"))
        table(("cells-bits-threads", "FFTW pair, ms"), pairs, title="the machine's floor", right=(1,))


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


def work_precision(run: Run, names: Sequence[str], title: str, extra: Sequence[dict[str, Any]] = ()) -> Figure:
    """Error over processor time and over memory, a line for each case."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 3.8), layout="constrained")
    FigureCanvasAgg(figure)
    time, memory = figure.subplots(1, 2, sharey=True)
    for number, (name, points) in enumerate((n, p) for n, p in by_case(run).items() if n in names):
        colour = f"C{number}"
        low = [p.cpu_median - min(p.cpu) for p in points]
        high = [max(p.cpu) - p.cpu_median for p in points]
        errors = [max(p.error, 1e-17) for p in points]
        time.errorbar(
            [p.cpu_median for p in points], errors, xerr=[low, high], fmt="o-", ms=4, color=colour, label=name
        )
        memory.plot([max(p.memory, 1e5) / 2**20 for p in points], errors, "o-", ms=4, color=colour, label=name)
        for p in points:
            time.annotate(
                f"{p.size:g}",
                (p.cpu_median, max(p.error, 1e-17)),
                fontsize=6,
                xytext=(3, 3),
                textcoords="offset points",
            )
    for curve in extra:
        time.plot(curve["time"], curve["error"], "s--", ms=4, color="0.3", label=curve["label"])
        if "memory" in curve:
            memory.plot(curve["memory"], curve["error"], "s--", ms=4, color="0.3")
    for axes, words in ((time, "processor time, s"), (memory, "memory beyond the inputs, MiB")):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel(words)
        axes.grid(True, which="major", lw=0.3)
    error_names = {CASES[name].error_name for name in names if name in CASES}
    time.set_ylabel(error_names.pop() if len(error_names) == 1 else "error")
    time.legend(fontsize=7)
    figure.suptitle(title, fontsize=10)
    return figure


def draw_run(run: Run, path: Path) -> None:
    """All cases in one figure."""
    save_picture(work_precision(run, list(CASES), "error against time and memory"), path)


def save_picture(picture: Figure, path: Path) -> None:
    """Written whole or not at all, in the format of its ending.

    Raises
    ------
    ResultsError : it cannot be written.
    """
    with replacing(path) as temporary:
        path.parent.mkdir(parents=True, exist_ok=True)
        picture.savefig(temporary, dpi=150, format=path.suffix[1:].lower())


def draw_reach(run: Run) -> Figure:
    """The time that an error of 10, 3, 1 and 0.3 % takes, a row for each figure and solver; open circles are drawn on
    from the last two grids."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    found = curves(run)
    figures = list(dict.fromkeys((c.kind, c.figure) for c in found))
    rows = sorted(dict.fromkeys((c.kind, c.figure, c.solver) for c in found), key=lambda row: figures.index(row[:2]))
    picture = Figure(figsize=(9, 1.2 + 0.2 * len(rows)), layout="constrained")
    FigureCanvasAgg(picture)
    axes = picture.subplots()
    colours = ("#9ecae1", "#4292c6", "#08519c", "#08102c")
    for number, row in enumerate(rows):
        least = best(found, *row)
        known = [reach.time for reach in least if reach is not None]
        if known:
            axes.plot([min(known), max(known)], [number, number], color="0.8", lw=1, zorder=1)
        for place, (reach, colour) in enumerate(zip(least, colours, strict=True)):
            if reach is None:
                continue
            face = colour if reach.measured else "white"
            size = 64 - 12 * place  # smaller ones in front: where a grid has several errors at once all are seen
            axes.scatter(reach.time, number, s=size, facecolor=face, edgecolor=colour, zorder=2 + place)
        if number and rows[number - 1][:2] != row[:2]:
            axes.axhline(number - 0.5, color="0.9", lw=0.6, zorder=0)
    labels = [f"{kind}: {figure.replace('_', ' ')} - {solver}" for kind, figure, solver in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize=7)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xscale("log")
    axes.set_xlabel("processor time, s")
    axes.grid(True, axis="x", which="major", lw=0.3)
    for target, colour in zip(TARGETS, colours, strict=True):
        axes.scatter([], [], s=40, color=colour, label=f"{100 * target:g} %")
    axes.scatter([], [], s=40, facecolor="white", edgecolor="0.3", label="drawn on")
    picture.legend(*axes.get_legend_handles_labels(), ncols=5, fontsize=7, loc="outside upper center")
    return picture


def draw_errors(run: Run, kind: str) -> Figure:
    """Errors of a kind's figures over processor time, and over memory where any curve is told by it: with corrections
    (full lines), of cells alone (broken), by peers (dotted, paler); thin lines are of looser tolerances."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    own = [c for c in curves(run) if c.kind == kind]
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
