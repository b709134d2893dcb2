"""Tables and progress for people; plain lines, and no progress, when piped."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

_FIRST_SHOWN_AFTER = 1.0  # seconds; shorter work needs no bar


class Terminal:
    """Shows progress on the terminal while in its `with` block; silent when the error stream is not one."""

    def __init__(self) -> None:
        self._live = sys.stderr.isatty()
        self._bars: Any = None
        self._tasks: dict[str, Any] = {}
        self._started: dict[str, float] = {}
        self.printed = False

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bars is not None:
            self._bars.stop()
            self._bars = None

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `bem.runs.Watcher`."""
        if not self._live:
            return
        now = time.monotonic()
        started = self._started.setdefault(what, now)
        if self._bars is None:
            if now - started < _FIRST_SHOWN_AFTER:
                return
            self._bars = _bars()
            self._bars.start()
        beside = "  ".join(f"{name.replace('_', ' ')} {value:.4g}" for name, value in figures.items())
        if what not in self._tasks:
            self._tasks[what] = self._bars.add_task(what or "working", total=total, beside=beside)
        self._bars.update(self._tasks[what], completed=done, total=total, beside=beside)

    def note(self, text: str) -> None:
        """See `bem.runs.Watcher`."""
        self.say(f"note: {text}")

    def numbers(self, summary: Mapping[str, Any], headline: Sequence[str]) -> None:
        """See `bem.runs.Watcher`: the numbers at once, pictures take longer."""
        self.__exit__()
        print_numbers(summary, headline)
        sys.stdout.flush()
        self.printed = True

    def say(self, text: str) -> None:
        """A line on the error stream, above the bars."""
        if self._bars is not None:
            self._bars.console.print(f"bem: {text}", markup=False, highlight=False)
        else:
            print(f"bem: {text}", file=sys.stderr)


@contextmanager
def resumable() -> Iterator[Terminal]:
    """A terminal for work that can go on later: an interrupt says how, and ends the command with 130."""
    with Terminal() as terminal:
        try:
            yield terminal
        except KeyboardInterrupt:
            terminal.say("interrupted; the same command with --resume goes on")
            raise typer.Exit(130) from None


def _bars() -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
    from rich.table import Column

    def fixed(width: int | None = None) -> Column:
        return Column(no_wrap=True, min_width=width)

    return Progress(
        TextColumn("{task.description}", table_column=fixed()),
        BarColumn(bar_width=16, table_column=fixed(16)),
        MofNCompleteColumn(table_column=fixed(9)),
        TextColumn("left", table_column=fixed()),
        TimeRemainingColumn(compact=True, table_column=fixed(8)),
        TextColumn("[dim]{task.fields[beside]}", table_column=Column(no_wrap=True, overflow="ellipsis")),
        console=Console(stderr=True),
    )


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    title: str = "",
    right: Sequence[int] = (),
    wide_only: Sequence[int] = (),
) -> None:
    """A table: ruled on a terminal, without the columns `wide_only` if it is narrow; aligned columns when piped.

    Columns without names have no line of names above them.
    """
    if sys.stdout.isatty():
        from rich import box
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text

        console = Console()
        kept = [i for i in range(len(head)) if console.width >= 130 or i not in wide_only]
        shown = Table(
            title=title or None,
            box=box.SIMPLE_HEAD,
            title_justify="left",
            title_style="bold",
            padding=(0, 1),
            show_header=any(head),
        )
        for i in kept:
            short = max((len(str(row[i])) for row in rows), default=0) <= 24
            shown.add_column(head[i], justify="right" if i in right else "left", no_wrap=short)
        for row in rows:
            shown.add_row(*(Text(str(row[i])) for i in kept))
        console.print(shown)
        return
    if title:
        print(title)
    widths = [max(len(str(row[i])) for row in [head, *rows]) for i in range(len(head))]
    for row in [head, *rows] if any(head) else rows:
        cells = [
            str(c).rjust(w) if i in right else str(c).ljust(w) for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        print("  ".join(cells).rstrip())


def show_warnings(warnings: Sequence[str]) -> None:
    """Sentences one below the other, wrapped and coloured on a terminal, a line each when piped."""
    if not warnings:
        return
    head = f"{len(warnings)} warning{'s' if len(warnings) > 1 else ''}"
    if not sys.stdout.isatty():
        print(head)
        for text in warnings:
            print(f"  {text}")
        return
    from rich.console import Console
    from rich.padding import Padding
    from rich.text import Text

    console = Console()
    console.print(Text(head, style="bold yellow"))
    for text in warnings:
        console.print(Padding(Text(f"- {text}"), (0, 0, 0, 2)))


def print_numbers(summary: Mapping[str, Any], headline: Sequence[str]) -> None:
    """The figures of a run."""
    from bem.plots.report import with_error
    from bem.plots.tables import figure_tables, is_list

    known = [name for name in headline if summary.get(name) is not None]
    rows = [with_error(name, summary) for name in known if not is_list(summary[name])]
    rows.append(("status", summary["status"]))
    rows += [("outside the model", text) for text in summary.get("outside_model", ())]
    rows.append(("time", f"{summary['wall_time_s']:.1f} s"))
    table(("figure", "value"), rows, title=f"{summary['scene']} ({summary['kind']})")
    for item in figure_tables(summary, known):
        table(item.head, item.rows, title=item.title)


def print_files(folder: Path) -> None:
    """Where the files of a finished run are."""
    print(f"results: {folder}")
    for name, what in (("figures", "figures"), ("report.html", "report ")):
        if (folder / name).exists():
            print(f"{what}: {folder / name}")
