"""Tables and progress for people; plain lines, and no progress, when piped."""

from __future__ import annotations

import math
import re
import shutil
import sys
import time
from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import typer

from bem.cli._streams import results_saved
from bem.notes import OUTSIDE, Level, Note, as_note, of_summary
from bem.notes.contact import CONTACT_AT_EDGE, edge_notes_as_one
from bem.notes.merge import identity
from bem.notes.note import LevelledText

_FIRST_SHOWN_AFTER = 1.0  # seconds; shorter work needs no bar
_LINE_EVERY = 30.0  # seconds between lines of progress where there is no terminal


class Terminal:
    """Shows progress while in its `with` block: a bar on a terminal, else a line every half minute."""

    def __init__(self) -> None:
        self._live = sys.stderr.isatty()
        self._bars: Any = None
        self._tasks: dict[str, Any] = {}
        self._started: dict[str, float] = {}
        self._line_at = time.monotonic()
        self._noted: set[Hashable] = set()
        self._held: list[Note] = []
        self.printed = False

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bars is not None:
            self._bars.stop()
            self._bars = None
        held, self._held = self._held, []
        for note in edge_notes_as_one(held):
            self.say(f"{OUTSIDE if note.level is Level.OUTSIDE_MODEL else 'caution: '}{note.line}")

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `bem.runs.Watcher`."""
        now = time.monotonic()
        if not self._live:
            if done > 0 and now - self._line_at >= _LINE_EVERY:
                self._line_at = now
                self.say(f"{what or 'working'}: {done} of {total}")
            return
        started = self._started.setdefault(what, now)
        if self._bars is None:
            if now - started < _FIRST_SHOWN_AFTER:
                return
            self._bars = _bars()
            self._bars.start()
        room = self._bars.console.width - len(what or "working") - _BAR
        beside = figures_within(figures, room)
        if what not in self._tasks:
            self._tasks[what] = self._bars.add_task(what or "working", total=total, beside=beside)
        self._bars.update(self._tasks[what], completed=done, total=total, beside=beside)

    def note(self, text: str) -> None:
        """See `bem.runs.Watcher`: cautions at once and each once, remarks not at all.

        Notes that put the result outside the model stand in the table of numbers (`numbers`), or at the end without it.
        """
        if not isinstance(text, Note):
            self.say(text if isinstance(text, LevelledText) else f"note: {text}")
            return
        keys = {identity(text), (text.code, text.texts), (text.code, text.values.get("reason"), text.headline)}
        if text.level is Level.INFO or keys & self._noted:
            return
        self._noted |= keys
        if text.level is Level.OUTSIDE_MODEL or text.code == CONTACT_AT_EDGE.code:
            self._held.append(text)  # the results say whether the edge cuts the contact off
        else:
            self.say(f"caution: {text.line}")

    def numbers(self, summary: Mapping[str, Any], headline: Sequence[str]) -> None:
        """See `bem.runs.Watcher`: the numbers at once, pictures take longer."""
        texts = {note["text"] for note in of_summary(summary)}
        lines = {note.headline: note.line for note in self._held if note.level is Level.OUTSIDE_MODEL}
        self._held = [note for note in self._held if note.level is not Level.OUTSIDE_MODEL and str(note) in texts]
        self.__exit__()
        print_numbers(summary, headline, lines)
        sys.stdout.flush()
        self.printed = True

    def say(self, text: str) -> None:
        """Print a text on the error stream, above the bars."""
        if self._bars is not None:
            width = self._bars.console.width
            self._bars.console.print(
                wrapped(f"bem: {text}", width, "  "), markup=False, highlight=False, soft_wrap=True
            )
        else:
            print_text(f"bem: {text}", file=sys.stderr)


@contextmanager
def resumable() -> Iterator[Terminal]:
    """A terminal for work that can go on later: an interrupt says how, and ends the command with 130."""
    with Terminal() as terminal:
        try:
            yield terminal
        except KeyboardInterrupt:
            terminal.say("interrupted; the same command with --resume goes on")
            raise typer.Exit(130) from None


_BAR = 16 + 9 + 4 + 8 + 5
"""Characters of a line of progress beside its name and figures: bar, count, "left", time and the spaces between."""


def figures_within(figures: Mapping[str, float], room: int) -> str:
    """Return the first figures by name that fit in so many characters, each of them whole."""
    shown = ""
    for name, value in figures.items():
        longer = f"{shown}  {name.replace('_', ' ')} {value:.4g}".lstrip()
        if len(longer) > room:
            break
        shown = longer
    return shown


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


@dataclass(frozen=True)
class Column:
    """A column of a table on the terminal.

    right : whether its cells are aligned to the right. narrowest, widest : widths [characters] at which every word and
    number of it is whole, and at which nothing of it is wrapped.
    """

    head: str
    cells: tuple[str, ...]
    right: bool
    narrowest: int
    widest: int

    @classmethod
    def of(cls, head: str, cells: Sequence[str], *, right: bool = False) -> Column:
        """The column with the widths that its texts need: heads and sentences may be wrapped, numbers not."""
        texts = [] if right else [cell for cell in cells if len(cell) > _LONG and not _NUMBER.match(cell)]
        words = [word for text in (head, *texts) for word in _kept_together(text).split(" ")]
        whole = [len(cell) for cell in cells if cell not in texts]
        narrowest = max([0, *whole, *(len(word) if _KEPT in word else min(len(word), _LONG) for word in words)])
        return cls(head, tuple(cells), right, narrowest, max([len(head), narrowest, *map(len, texts)]))


_LONG = 24
"""Longer texts may be wrapped between words, and longer words after a mark (`_`, `/`)."""
_UNIT = (
    r"(?:[munpkMG\u00b5]?(?:m|s|g|N|Pa|W|J|B)|cm|[KMG]iB|K|h|min|rad|deg|degC|\u00b0C|%|1(?=/))(?:\^\d|[\u00b2\u00b3])?"
)
_UNITS = rf"{_UNIT}(?:[/ ]\(?{_UNIT}\)?)*"
_WITH_UNIT = re.compile(rf"(?<=[\d)]) (?={_UNITS}(?![\w/^]))")
"""The space between a number and its unit."""
_IN_UNIT = re.compile(rf"(?:(?<=[\d)]\u00a0)|(?<=\()){_UNITS}(?![\w/^])|(?<=/)\({_UNIT}(?: {_UNIT})+\)")
"""A unit of several factors behind a number or in brackets."""
_KEPT = "\u00a0"
"""A space at which no line ends."""
_NUMBER = re.compile(r"[-+–(]?[\d.]")
_GAP = 2
"""Spaces between columns."""
_MOST_TURNED = 6
"""The most rows that become columns where a table is too wide."""


def _kept_together(text: str) -> str:
    """Return the text with spaces at which no line ends: in a number with its unit or error."""
    text = text.replace(" \u00b1 ", f"{_KEPT}\u00b1{_KEPT}")
    text = _WITH_UNIT.sub(_KEPT, text)
    return _IN_UNIT.sub(lambda found: found[0].replace(" ", _KEPT), text)


def _parts(text: str) -> list[str]:
    """Return the parts of a text between which a line may end: words, and parts of long words behind a mark."""
    parts: list[str] = []
    for word in _kept_together(text).split(" "):
        if len(word) <= _LONG or _KEPT in word:
            parts.append(f"{word} ")
            continue
        pieces = re.split(r"(?<=[_/.,-])(?!\d)", word)
        parts += [piece[i : i + _LONG] for piece in pieces for i in range(0, len(piece), _LONG)]
        parts[-1] += " "
    return parts


def wrapped(text: str, width: int, indent: str = "") -> str:
    """Return a text in lines of at most so many characters; numbers stay with their units and errors.

    Parameters
    ----------
    text : the text; its own line breaks stay.
    width : characters of a line, fewer than the longest part needs are exceeded.
    indent : begins every line but the first.
    """
    lines = []
    for paragraph in text.split("\n"):
        line = ""
        for part in _parts(paragraph):
            if line.strip() and len(line) + len(part.rstrip()) > width:
                lines.append(line)
                line = indent
            line += part
        lines.append(line)
    return "\n".join(line.rstrip() for line in lines).replace(_KEPT, " ")


def print_text(text: str, *, file: TextIO | None = None) -> None:
    """Print a sentence: wrapped between words on a terminal, on one line otherwise."""
    stream = sys.stdout if file is None else file
    if stream.isatty():
        text = wrapped(text, shutil.get_terminal_size().columns, "  ")
    print(text, file=stream)


def fitted_widths(columns: Sequence[Column], room: int) -> list[int] | None:
    """Widths of the columns in so many characters; None if words or numbers of them would have to be cut."""
    widths = [column.narrowest for column in columns]
    left = room - sum(widths) - _GAP * (len(columns) - 1)
    if left < 0:
        return None
    while left > 0 and (short := [i for i, column in enumerate(columns) if widths[i] < column.widest]):
        for i in short:
            more = min(columns[i].widest - widths[i], max(left // len(short), 1), left)
            widths[i] += more
            left -= more
    return widths


def tables_within(columns: Sequence[Column], leading: int, room: int) -> list[list[Column]]:
    """The columns as one or several tables, each of which fits in so many characters.

    A table of few rows that is too wide is turned: its rows become columns. Others are divided into tables that repeat
    the leading columns. Where not even one column fits beside these, every row becomes a table of its own.
    """
    if fitted_widths(columns, room) is not None or len(columns) < 2:
        return [list(columns)]
    first, rest = columns[:leading], columns[leading:]
    count = len(columns[0].cells)
    if first and rest and len(columns) > 2 and count <= min(_MOST_TURNED, len(rest)):
        turned = [_turned(columns, range(count))]
        if fitted_widths(turned[0], room) is not None:
            return turned
    parts: list[list[Column]] = [[]]
    for column in rest:
        if parts[-1] and fitted_widths([*first, *parts[-1], column], room) is None:
            parts.append([])
        parts[-1].append(column)
    found = [[*first, *part] for part in parts]
    if all(fitted_widths(part, room) is not None for part in found):
        return found
    return [_turned(columns, [row]) for row in range(count)] if len(columns) > 2 else [list(columns)]


def _turned(columns: Sequence[Column], rows: Iterable[int]) -> list[Column]:
    """Some rows of a table as columns, beside a column of its heads."""
    rows = list(rows)
    heads = Column.of(columns[0].head, [column.head for column in columns[1:]])
    return [heads, *(Column.of(columns[0].cells[i], [column.cells[i] for column in columns[1:]]) for i in rows)]


def table(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    title: str = "",
    right: Sequence[int] = (),
    wide_only: Sequence[int] = (),
    leading: int = 1,
) -> None:
    """A table: ruled and within the width of a terminal, without the columns `wide_only` if that is narrow; aligned
    columns when piped. Columns without any text are left out.

    Columns without names have no line of names above them.

    leading : the number of first columns that say what a row is; a table that is divided repeats them.
    """
    columns = {
        i: Column.of(head[i], [str(row[i]) for row in rows], right=i in right)
        for i in range(len(head))
        if i < leading or not rows or any(str(row[i]) for row in rows)
    }
    if sys.stdout.isatty():
        from rich.console import Console

        console = Console()
        kept = [column for i, column in columns.items() if console.width >= 130 or i not in wide_only]
        for number, part in enumerate(tables_within(kept, leading, console.width)):
            _print_ruled(console, part, title if number == 0 else "")
        return
    if title:
        print(title)
    lines = zip(*((column.head, *column.cells) for column in columns.values()), strict=True)
    for line in list(lines)[0 if any(head) else 1 :]:
        cells = [
            cell.rjust(column.widest) if column.right else cell.ljust(column.widest)
            for cell, column in zip(line, columns.values(), strict=True)
        ]
        print((" " * _GAP).join(cells).rstrip())


def _print_ruled(console: Any, columns: Sequence[Column], title: str) -> None:
    """One table with a rule below its heads; texts are wrapped, never cut."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    widths = fitted_widths(columns, console.width)

    def within(text: str, column: int) -> str:
        return text if widths is None else wrapped(text, widths[column])

    shown = Table(
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1),
        collapse_padding=True,
        show_header=any(column.head for column in columns),
    )
    for i, column in enumerate(columns):
        shown.add_column(
            Text(within(column.head, i)),
            justify="right" if column.right else "left",
            overflow="fold",
            width=None if widths is None else widths[i],
        )
    for row in zip(*(column.cells for column in columns), strict=True):
        shown.add_row(*(Text(within(cell, i)) for i, cell in enumerate(row)))
    console.print()
    if title:
        console.print(Text(title, style="bold"))
    console.print(shown)


def show_warnings(warnings: Sequence[str], *, remarks: str = "") -> None:
    """Print notes one below the other, wrapped and coloured on a terminal, a line each when piped.

    Of cautions and of notes outside the model headline and action are shown, of remarks the number.

    Parameters
    ----------
    warnings : the notes.
    remarks : where remarks can be read, added to their number.
    """
    notes = [as_note(text) for text in warnings]
    begins = {Level.OUTSIDE_MODEL: OUTSIDE, Level.CAUTION: ""}
    lines = [begins[one.level] + one.line for one in notes if one.level in begins]
    beyond = sum(one.level is Level.OUTSIDE_MODEL for one in notes)
    counts = [(len(lines) - beyond, "caution"), (len(notes) - len(lines), "remark")]
    head = ", ".join(
        [f"{beyond} outside the model"] * bool(beyond)
        + [f"{count} {word}{'s' if count > 1 else ''}" for count, word in counts if count]
    )
    if not head:
        return
    if len(notes) > len(lines) and remarks:
        head += f" ({remarks})"
    if not sys.stdout.isatty():
        print(head)
        for text in lines:
            print(f"  {text}")
        return
    from rich.console import Console
    from rich.text import Text

    console = Console()
    console.print(Text(head, style="bold yellow"))
    for text in lines:
        console.print(Text(wrapped(f"  - {text}", console.width, "    ")))


def show_remarks(notes: Sequence[str]) -> None:
    """Print the whole text of the remarks among notes, a line each."""
    for note in map(as_note, notes):
        if note.level is Level.INFO:
            print_text(f"  {note}")


def _without_hidden(text: str, hidden: Collection[str]) -> str:
    """Return the text of a note on missing error bars without figures that the terminal does not show; "" if it names
    no other.

    A note that names its first figures only stays as it is.
    """
    from bem.notes.note import joined

    found = re.fullmatch(r"(.*?No error bars for )(.*?)(\. .*)", text, re.DOTALL)
    if found is None or re.search(r" and \d+ more$", found[2]):
        return text
    names = found[2].split("; ") if "; " in found[2] else re.split(r", | and ", found[2])
    shown = [name for name in names if name not in hidden]
    if len(shown) == len(names):
        return text
    between = "; ".join(shown) if any("," in name for name in shown) else joined(shown)
    return found[1] + between + found[3] if shown else ""


def _hidden_names(summary: Mapping[str, Any], headline: Collection[str]) -> set[str]:
    """Return the names, as of notes, of the figures of a run that the terminal does not show."""
    from bem.notes.accuracy import named
    from bem.plots.tables import unit_of

    names = {key: named([unit_of(key)[0]])[0] for key in summary}
    return {name for key, name in names.items() if key not in headline} - {names[key] for key in headline}


def print_numbers(summary: Mapping[str, Any], headline: Sequence[str], lines: Mapping[str, str] | None = None) -> None:
    """Print the figures of a run.

    lines : what is shown of notes outside the model, by their headlines; the headline alone where it is not given.
    """
    from bem.notes.accuracy import ERROR_BARS_LOST, NO_ERROR_BAR
    from bem.plots.report import NO_BAR, status_words, summary_rows
    from bem.plots.tables import input_share_tables, is_list, place_tables, shows_oil_scatter

    known = [name for name in headline if summary.get(name) is not None]
    rows = summary_rows(summary, [name for name in known if not is_list(summary[name])])
    rows.append(("status", status_words(summary)))
    rows += [("outside the model", (lines or {}).get(text, text)) for text in summary.get("outside_model", ())]
    if remarks := sum(note["level"] == Level.INFO for note in of_summary(summary)):
        rows.append(("remarks", f"{remarks}, in the report and in summary.json"))
    rows.append(("time", f"{summary['wall_time_s']:.1f} s"))
    table(("figure", "value"), rows, title=f"{summary['scene']} ({summary['kind']})")
    lost = any(note["code"] == ERROR_BARS_LOST.code for note in of_summary(summary))  # says why of all of them
    if not lost and any(value.endswith(NO_BAR) for _, value in rows):
        hidden = _hidden_names(summary, known)
        for note in of_summary(summary):
            if note["code"] == NO_ERROR_BAR.code and (text := _without_hidden(note["text"], hidden)):
                print_text(text)
    print_lists(summary, known)
    if summary.get("combined_Sdq") is not None and any(f"{name}_error" in summary for name in known):
        print_text("± is the numerical error; how figures scatter from place to place of the surface is not in it.")
    if shows_oil_scatter(summary, known):
        print_text(
            "± (oil) is the scatter among oils of one base, by their Eyring stress and limiting shear stress; boundary "
            "friction has none."
        )
    for item in place_tables(summary):
        table(item.head, item.rows, title=item.title, leading=item.leading)
    for item in input_share_tables(summary):
        table(item.head, item.rows, title=item.title, right=range(1, len(item.head)))


def print_lists(summary: Mapping[str, Any], names: Sequence[str]) -> None:
    """Print the named figures that are lists, as tables with a row for each case."""
    from bem.plots.tables import MOST_COLUMNS, ends_of_paths, figure_tables, mean_power_of_paths

    most = sys.maxsize if sys.stdout.isatty() else MOST_COLUMNS
    for item in figure_tables(summary, names, columns=most):
        short = ends_of_paths(summary, item)
        table(short.head, short.rows, title=short.title, leading=short.leading)
    if (means := mean_power_of_paths(summary)) is not None:
        table(means.head, means.rows, title=means.title, leading=means.leading)


def print_points(figures: Mapping[str, Any]) -> None:
    """The figures of a sweep, a row for each case of each point; of a single one, a row for each figure."""
    from bem.plots.report import with_error
    from bem.plots.tables import is_error

    names = [name for name in figures if name != "over" and not is_error(name, figures)]
    if all(len(figures[name]) == 1 for name in names):
        table(("figure", "value"), [with_error(name, figures) for name in names])
        return
    print_lists(figures, names)
    rows = scatter_of_places(figures)
    if rows:
        table(("figure", "mean", "standard deviation"), rows, title=f"over {len(figures[names[0]])} surfaces")


_GIVEN = 1e-6
"""Standard deviation over the mean up to which a figure is one that was given, such as a load or the hardness."""


def scatter_of_places(figures: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return name, mean and standard deviation of the figures of a sweep over surfaces alone: files of several places,
    or seeds; none of other sweeps, nor where a point has several cases."""
    from bem.plots.report import with_error
    from bem.plots.tables import SCATTERS, is_error, scatter_key

    over = tuple(figures.get("over") or ())
    if not over or not all(key == "seed" or key.endswith(("surface_path", "surface.path")) for key in over):
        return []
    points = list(zip(*(figures[key] for key in over), strict=True))
    if len(points) < 2 or len(set(points)) < len(points):
        return []
    bars = {scatter_key(name, mark) for name in figures for mark in SCATTERS}
    rows = []
    for name, values in figures.items():
        known = isinstance(values, list) and all(isinstance(v, int | float) and math.isfinite(v) for v in values)
        if not known or name in over or name in bars or is_error(name, figures):
            continue
        mean = math.fsum(values) / len(values)
        deviation = math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (len(values) - 1))
        if deviation <= _GIVEN * abs(mean):
            continue
        words, shown = with_error(name, {name: mean})
        rows.append((words, shown, with_error(name, {name: deviation})[1]))
    return rows


def print_written(path: Path) -> None:
    """Print the name of a file that was written; the exit code then no longer depends on the terminal."""
    results_saved()
    print(f"written: {path}")


def print_files(folder: Path) -> None:
    """Print where the files of a finished run are."""
    results_saved()
    print(f"results: {folder}")
    for name, what in (("figures", "figures"), ("report.html", "report ")):
        if (folder / name).exists():
            print(f"{what}: {folder / name}")
