"""Commented scenes of any kind, written from the entries of its form: the keys that every user sets, or all of them."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.errors import InputError
from bem.scenes.form import Entry, FormTable, keys_of_kind, table_at
from bem.scenes.keys import LEVELS
from bem.scenes.kind import get_kind, kind_aliases, kind_names
from bem.scenes.load import library, library_text
from bem.scenes.starts import start_scene
from bem.scenes.validate import nearest, show
from bem.scenes.values import dumped, typed

if TYPE_CHECKING:
    from bem.scenes.own_surfaces import MapScale, MeasuredMap

_MOST_CHOICES = 12
_WIDEST, _WIDTH = 42, 118
"""Column of the comments behind keys, at most, and where they end."""


def kind_meant(word: str) -> str:
    """The kind that a word means: its name, one of the names people guess, or the word itself."""
    name = word.strip().lower().replace("_", "-").replace(" ", "-")
    return name if name in kind_names() else kind_aliases().get(name, word)


def scene_template(
    kind: str,
    *,
    everything: bool = False,
    surfaces: Mapping[str, str] | Mapping[str, MeasuredMap] | None = None,
    folder: Path | None = None,
    scale: MapScale | None = None,
) -> str:
    """Return a TOML scene that runs as it is: the keys that every user sets, each with its meaning and unit.

    Parameters
    ----------
    kind : a kind, a name that people guess for one, or a built-in scene, whose own text is then given.
    everything : also all other keys, as comments by level; refused for a built-in scene.
    surfaces : files of measured surfaces, or maps that were read, by body, "lower" and "upper", in place of generated
        roughness.
    folder : of the scene file, to which the paths are relative; the working folder if None.
    scale : spacing and unit of heights of files of measured surfaces that do not say them.

    Raises
    ------
    InputError : no such kind, or none of its scenes can serve as a start.
    """
    kind = kind_meant(kind)
    if kind not in kind_names() and kind in library():
        if surfaces:
            raise InputError(f"--lower, --upper: {kind} is a built-in scene; allowed: a kind, or bem run with --set")
        if everything:
            raise InputError(f"--all: {kind} is a built-in scene; allowed: a kind, such as {library()[kind]['kind']}")
        return without_description(library_text(kind))
    if kind not in kind_names():
        listed = ", ".join(f'"{name}"' for name in kind_names())
        close = nearest(kind, [*kind_names(), *kind_aliases(), *library()])
        raise InputError(
            f"KIND {show(kind)}: not a kind of scene{close}; allowed: {listed}, or a built-in scene of `bem scenes`"
        )
    data, reasons = start_scene(kind), {}
    if surfaces:
        from bem.scenes.own_surfaces import own_surfaces_start, read_maps  # reads files of instruments

        files = {body: one for body, one in surfaces.items() if isinstance(one, str)}
        maps = {body: one for body, one in surfaces.items() if not isinstance(one, str)}
        own = own_surfaces_start(kind, data, maps | read_maps(files, folder or Path.cwd(), scale))
        data, reasons = own.values, own.reasons
    more = "Keys behind a # show their default or an example; levels: basic, advanced (models), expert (numerics)."
    lines = [
        f"# {get_kind(kind).title[:1].upper()}{get_kind(kind).title[1:]}.",
        "# Change the values. A quoted value has its own unit; a bare number is in the SI unit in [brackets].",
        f"# {more}"
        if everything
        else f"# Lines behind a # are optional or alternatives; `bem new {kind} --all` writes all keys.",
        "# `bem plan FILE` checks the file and shows the work, `bem run FILE` runs it.",
        f'kind = "{kind}"',
        *_Writer(everything, reasons).table(keys_of_kind(kind), data, ()),
    ]
    return "\n".join(lines).rstrip() + "\n"


def without_description(text: str) -> str:
    """The TOML text of an example with its description as a comment: what is made of it is another case."""
    return re.sub(
        r'^(description = ".*")$', r"# \1  # of the example; write your own", text, count=1, flags=re.MULTILINE
    )


class _Writer:
    """Lines of the tables of a scene.

    Parameters
    ----------
    everything : whether to write all keys; otherwise those at the level basic, in tables that have values.
    reasons : why values were chosen, by path of the key; written behind the meaning.
    """

    def __init__(self, everything: bool, reasons: Mapping[tuple[str, ...], str]) -> None:
        self._everything, self._reasons = everything, reasons
        self._written: dict[Any, str] = {}

    def table(self, table: FormTable, data: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
        """The keys of a table with values, by level, then its tables."""
        self._written.setdefault(_identity(table), ".".join(path))
        lines = [(f"catalogue = {dumped(data['catalogue'])}", _CATALOGUE)] if "catalogue" in data else []
        if table.kind and path and "kind" in data:
            lines.append((f"kind = {dumped(data['kind'])}", table.about))
        inner: list[tuple[Entry, Any]] = []
        for one in _by_level(table):
            value = data.get(one.last)
            if _has_heading(one, value):
                inner.append((one, value))
                continue
            if value is not None:
                about = f"{_meaning(one, short=not self._everything)} {self._reasons.get((*path, one.last), '')}"
                lines.append((f"{one.last} = {typed(value)}", about.rstrip()))
            elif one.typed and not one.rows and (self._everything or one.level == "basic"):
                lines.append((f"# {one.last} = {one.example}", _meaning(one, short=not self._everything)))
            if self._everything and (one.tables or one.rows) and not _beside(table, one):
                inner.append((one, None))
        yield from _aligned(lines)
        order = {name: number for number, name in enumerate(data)}  # tables with values first, as they were given
        for one, value in sorted(
            inner, key=lambda item: (order.get(item[0].last, len(order)), LEVELS.index(item[0].level))
        ):
            yield from self._inner(one, value, (*path, one.last))

    def _inner(self, entry: Entry, value: Any, path: tuple[str, ...]) -> Iterator[str]:
        """A table or tables at a key: with values, or behind a #."""
        heading, chosen = ".".join(path), None
        if isinstance(value, list) and entry.rows is not None:
            for row in value:
                yield from ("", *_comment(entry.description), f"[[{heading}]]")
                yield from self.table(entry.rows, row, path)
        elif isinstance(value, Mapping):
            chosen = _member(entry, value)
            yield from ("", *_comment(entry.description), f"[{heading}]")
            yield from self.table(chosen, value, path)
        if self._everything and not isinstance(value, list):
            yield from self._behind(entry, heading, chosen)

    def _behind(self, entry: Entry, heading: str, chosen: FormTable | None = None) -> Iterator[str]:
        """The tables at a key behind a #, but for the chosen one; keys of a table stand where it comes first."""
        tables = [entry.rows] if entry.rows else [one for one in entry.tables if one is not chosen and one.entries]
        label = f"[[{heading}]]" if entry.rows else f"[{heading}]"
        for number, table in enumerate(tables):
            about = entry.meaning if number == 0 and chosen is None else "Instead of that:"
            yield ""
            yield from _comment(about if entry.level == "basic" else f"({entry.level}) {about}")
            known = self._written.get(_identity(table))
            kind = f'  kind = "{table.kind}"' if table.kind and known is not None else ""
            yield f"# {label}{kind}" + (f"  # keys as in [{known}]" if known is not None else "")
            if known is not None:
                continue
            self._written[_identity(table)] = heading
            lines = [(f'# kind = "{table.kind}"', table.about)] if table.kind else []
            lines += [
                (f"# {one.last} = {one.example}", _meaning(one, above=entry.level))
                for one in _by_level(table)
                if one.typed and not one.rows
            ]
            yield from _aligned(lines)
            for one in _by_level(table):
                if (one.tables or one.rows) and not _beside(table, one):
                    yield from self._behind(one, f"{heading}.{one.last}")


_CATALOGUE = "Material of the catalogue (`bem materials`); further keys here replace its constants."


def _by_level(table: FormTable) -> list[Entry]:
    """Entries of a table, basic ones first."""
    return sorted(table.entries, key=lambda one: LEVELS.index(one.level))


def _identity(table: FormTable) -> tuple[Any, ...]:
    """Return an identity that tables of one model share, wherever they stand."""
    return table.kind, table.about, tuple((one.last, one.description) for one in table.entries)


def _has_heading(entry: Entry, value: Any) -> bool:
    """Return True if a value is written under a heading of its own; laws are written on their line."""
    if isinstance(value, list):
        return entry.rows is not None
    return isinstance(value, Mapping) and bool(entry.tables) and not entry.is_law


def _beside(table: FormTable, entry: Entry) -> bool:
    """Return True if an entry's laws have their parameters beside it."""
    names = {one.last for one in table.entries}
    return entry.is_law and all(one.last in names for law in entry.tables for one in law.entries)


def _member(entry: Entry, value: Mapping[str, Any]) -> FormTable:
    """The table that a value is of."""
    return table_at(entry, value) or entry.tables[0]


def _meaning(entry: Entry, *, short: bool = False, above: str = "basic") -> str:
    """Meaning, unit and choices of a key, after its level where that is not the one of its table.

    short : without the reason of the default and without laws to choose from. above : level of the table.
    """
    named = all(word in entry.description for word in entry.choices) or (short and entry.is_law)
    listed = "" if named or entry.unit or len(entry.choices) > _MOST_CHOICES else ", ".join(entry.choices)
    level = "" if entry.level == above else f"({entry.level}) "
    meaning = replace(entry, reason="").meaning if short else entry.meaning
    return f"{level}{meaning}" + (f" One of {listed}." if listed else "")


def _comment(text: str) -> Iterator[str]:
    """A comment over several lines where it is long."""
    yield from textwrap.wrap(text, _WIDTH - 4, initial_indent="# ", subsequent_indent="# ")


def _aligned(lines: list[tuple[str, str]]) -> Iterator[str]:
    """Keys with their comments in one column, below each other where they are long; above a key that is long."""
    column = max((len(text) for text, _ in lines if len(text) <= _WIDEST), default=0)
    for text, about in lines:
        if len(text) > _WIDEST:
            yield from _comment(about)
            yield text
            continue
        first, *more = textwrap.wrap(about, _WIDTH - column) or [""]
        yield f"{text:<{column}}  # {first}"
        yield from (f"{'#' * text.startswith('#'):<{column}}  # {line}" for line in more)
