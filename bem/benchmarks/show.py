"""A run as tables and a figure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.benchmarks.cases import CASES
from bem.benchmarks.measure import Point, growth
from bem.benchmarks.record import Run
from bem.benchmarks.work_precision import TARGETS, Curve, best
from bem.results.atomic import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Table = Callable[..., None]


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


def print_run(run: Run, table: Table) -> None:
    """The tables of a run."""
    table(
        POINT_HEADERS,
        point_rows(run),
        title=f"bem {run.versions['bem']}, {run.machine['processor']}",
        right=range(1, 9),
    )
    exponents = [(name, f"{time_exponent(points):.2f}") for name, points in by_case(run).items() if len(points) > 1]
    if exponents:
        table(("case", "time grows with size to the power"), exponents, right=(1,))
    if rows := split_rows(run):
        table(SPLIT_HEADERS, rows, title="where the time goes", right=range(1, 9))
    if run.floor is not None:
        pairs = [(key, f"{1e3 * value:.3g}") for key, value in run.floor.pairs.items()]
        pairs.append(("memory bandwidth, GB/s", f"{run.floor.bandwidth / 1e9:.3g}"))
        table(("cells-bits-threads", "FFTW pair, ms"), pairs, title="the machine's floor", right=(1,))


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


def draw_reach(found: Sequence[Curve]) -> Figure:
    """The time that an error of 10, 3, 1 and 0.3 % takes, a row for each figure and solver; open circles are drawn on
    from the last two grids."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

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
