"""Keys of a kind of scene as a tree of entries: meaning, level, unit, default and choices, tables inside tables.

Read off the models; the commented templates, the form of the page and the guide are made of it, and none of them is
known here. Verified in tests/scenes/test_form.py.
"""

from __future__ import annotations

import typing
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

from bem.errors import InputError
from bem.lubrication.oils.catalogue import oil_names
from bem.materials import CATALOGUE
from bem.scenes.common import MaterialScene
from bem.scenes.keys import Level
from bem.scenes.kind import get_kind
from bem.scenes.laws import LawKey, LawOrNumber
from bem.scenes.load import library, read_table, scene_from_table
from bem.scenes.starts import start_scene
from bem.scenes.values import dumped, plain_value
from bem.scenes.walk import DEEPEST, Key, TableType, fields_of_table, keys_of, unwrap

_ANY_TEXT = "..."
"""Example of a text."""
_NOT_ASKED = ("redoes", "name", "over", "sha256")


@dataclass(frozen=True)
class Entry:
    """A key of a scene.

    Attributes
    ----------
    key : dotted, from the top of the scene.
    name : its last part, in words.
    description : its meaning, in a sentence.
    level : "basic", "advanced" or "expert": its own or that of a table that it is in, whichever is higher.
    reason : why the default is what it is, or what is taken without one; "" for none.
    unit : SI unit, "" for none.
    allowed : what may be typed, with the unit.
    default : as it would be typed, "" for none.
    example : a value as it would be typed; the default where there is one.
    choices : words that may be typed.
    closed : no others.
    required : whether the scene needs it.
    switch : true or false.
    tables : what may stand there as a table: one, or several told apart by their `kind`.
    rows : table that the key is a list of; None for other keys.
    typed : whether a value may be typed, too (or only, without tables).
    is_law : whether its tables are laws with their parameters.
    """

    key: str
    name: str
    description: str
    level: Level
    reason: str
    unit: str
    allowed: str
    default: str
    example: str
    choices: tuple[str, ...]
    closed: bool
    required: bool
    switch: bool
    tables: tuple[FormTable, ...]
    rows: FormTable | None
    typed: bool
    is_law: bool

    @property
    def last(self) -> str:
        """Last part of the dotted key."""
        return self.key.rpartition(".")[2]

    @property
    def meaning(self) -> str:
        """Description with the unit in brackets and the reason of the default, as one text."""
        text = self.description.rstrip(".") + (f" [{self.unit}]" if self.unit else "")
        if not self.reason:
            return f"{text}."
        return f"{text}. {'Default' if self.default else 'Without it'}: {self.reason}."


@dataclass(frozen=True)
class FormTable:
    """A table of a form; `kind` tells it from others that may stand in its place, "" where it is the only one."""

    kind: str
    about: str
    entries: tuple[Entry, ...]


def form_of(kind: str) -> FormTable:
    """The form of a kind, without the keys that only files need; KeyError if there is none."""
    return _without(keys_of_kind(kind), _NOT_ASKED)


def keys_of_kind(kind: str) -> FormTable:
    """All keys of a kind; KeyError if there is none."""
    found = get_kind(kind)
    return FormTable(kind, found.title, _entries(found.model, (), "basic"))


def _without(table: FormTable, names: Collection[str]) -> FormTable:
    entries = (
        replace(one, tables=tuple(_without(inner, names) for inner in one.tables))
        for one in table.entries
        if one.last not in names
    )
    return replace(table, entries=tuple(entries))


def start_of(kind: str) -> dict[str, Any]:
    """A table to start a form of the kind from, with values for the keys that every user sets."""
    return {key: value for key, value in start_scene(kind).items() if key not in ("description", "redoes")}


def mistakes_of(table: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the mistakes of a table as a scene, one message each; empty if it is valid."""
    try:
        scene_from_table(table)
    except InputError as error:
        return error.messages
    return ()


def with_value(table: Mapping[str, Any], key: str, text: str) -> dict[str, Any]:
    """A copy of a scene's table with what was typed at a key; empty text takes the key out, and with the last one of an
    inner table that table: a coating whose thickness and material are gone is none.

    Raises
    ------
    InputError : it cannot be put there.
    """
    from bem.scenes.paths import parse_key, value_at

    parsed = parse_key(key)
    if not text.strip() and (parsed is None or value_at(table, parsed) is None):
        return dict(table)
    changed = read_table(table, [f"{key}={text}"])
    above = key.rpartition(".")[0]
    while not text.strip() and "." in above and value_at(changed, parse_key(above) or ()) == {}:
        changed = read_table(changed, [f"{above}="])
        above = above.rpartition(".")[0]
    return changed


def with_kind(table: Mapping[str, Any], entry: Entry, kind: str) -> dict[str, Any]:
    """A copy of a scene's table with another table at an entry: that of `kind`, with the values they share."""
    from bem.scenes.paths import parse_key, put, value_at

    parsed = parse_key(entry.key)
    assert parsed is not None
    old = value_at(table, parsed)
    member = next(one for one in entry.tables if one.kind == kind)
    names = {item.key.rpartition(".")[2] for item in member.entries}
    kept = {key: value for key, value in old.items() if key in names} if isinstance(old, Mapping) else {}
    changed = dict(table)
    put(changed, parsed, {"kind": kind, **kept} if kind else kept)
    return changed


def row_of(entry: Entry, index: int) -> FormTable:
    """Return the table of one row of a list of tables, its keys those of the scene: `lower.layers[0].thickness`.

    entry : with `rows`. index : of the row.
    """
    assert entry.rows is not None
    return _placed(entry.rows, f"{entry.key}[{index}].")


def _placed(table: FormTable, path: str) -> FormTable:
    """Return a table whose keys begin with a path."""
    entries = tuple(
        replace(one, key=path + one.key, tables=tuple(_placed(inner, path) for inner in one.tables))
        for one in table.entries
    )
    return replace(table, entries=entries)


def with_row(table: Mapping[str, Any], entry: Entry) -> dict[str, Any]:
    """A copy of a scene's table with one more row at a list of tables: examples of the keys that a row needs."""
    from bem.scenes.paths import parse_key, put, value_at

    parsed = parse_key(entry.key)
    assert parsed is not None
    assert entry.rows is not None
    found = value_at(table, parsed)
    rows = list(found) if isinstance(found, list) else []
    words = f'"{_ANY_TEXT}"'
    row = {
        one.last: f"{one.name} {len(rows) + 1}" if one.example == words else plain_value(one.example)
        for one in entry.rows.entries
        if one.required
    }
    changed = dict(table)
    put(changed, parsed, [*rows, row])
    return changed


def without_row(table: Mapping[str, Any], entry: Entry, index: int) -> dict[str, Any]:
    """A copy of a scene's table without one row of a list of tables; with the last row the key goes, too."""
    from bem.scenes.paths import drop, parse_key, value_at

    parsed = parse_key(entry.key)
    assert parsed is not None
    changed = dict(table)
    last = index == 0 and len(value_at(table, parsed) or ()) == 1
    drop(changed, parsed if last else (*parsed, index))
    return changed


def table_at(entry: Entry, value: Any) -> FormTable | None:
    """The table of an entry that a value is of: by its `kind` or name, without one the first that has all its keys; of
    no value that of the default."""
    if isinstance(value, Mapping) and "kind" not in value:
        return next((one for one in entry.tables if {item.last for item in one.entries} >= set(value)), None)
    kind = value.get("kind") if isinstance(value, Mapping) else value
    if value is None and '"kind" = "' in entry.default:
        kind = entry.default.split('"kind" = "')[1].split('"')[0]
    return next((one for one in entry.tables if one.kind == kind), None)


def text_of(value: Any) -> str:
    """A plain value as it would be typed."""
    return "" if value is None else value if isinstance(value, str) else dumped(value)


def library_scene(name: str) -> dict[str, Any]:
    """The table of a built-in scene, under its name."""
    return {**library()[name], "name": name}


def _table(table: TableType, path: tuple[str, ...], level: Level) -> FormTable:
    """Return the table of a form that stands at a path."""
    return FormTable(table.kind, table.meaning, _entries(table.model, path, level))


def _entries(model: Any, path: tuple[str, ...], level: Level) -> tuple[Entry, ...]:
    return tuple(_entry(key) for key in keys_of(model, path, level))


def _entry(key: Key) -> Entry:
    deeper = len(key.path) <= DEEPEST
    tables = tuple(_table(one, key.path, key.level) for one in key.tables) if deeper else ()
    rows = _table(key.row, (), key.level) if deeper and key.row else None
    return Entry(
        key=".".join(key.path),
        name=key.name.replace("_", " "),
        description=key.meaning,
        level=key.level,
        reason=key.reason,
        unit=key.unit,
        allowed=key.allowed or _words(key.type),
        default=key.default,
        example=_example(key),
        choices=_choices(key),
        closed=typing.get_origin(key.type) is typing.Literal,
        required=key.required,
        switch=key.type is bool,
        tables=tables,
        rows=rows,
        typed=not tables or key.type is MaterialScene or key.is_law,
        is_law=key.is_law,
    )


def _choices(key: Key) -> tuple[str, ...]:
    if key.type is MaterialScene:
        return tuple(sorted(CATALOGUE))
    return oil_names() if key.name == "grade" else tuple(key.choices)


def _words(annotation: Any) -> str:
    """Describe the values of a key that is no quantity and has no choices."""
    if annotation is MaterialScene:
        return "a material of the catalogue, or constants of its own"
    if typing.get_origin(annotation) is list:
        item = unwrap(typing.get_args(annotation)[0])[0]
        if fields_of_table(item):
            names = list(fields_of_table(item))
            return f"a list of tables, such as [{{{names[0]} = ...}}]; keys: {', '.join(names)}"
        return "a list, such as [1, 2]"
    return {int: "a whole number", str: "text", float: "a number"}.get(annotation, "")


def _example(key: Key) -> str:
    """A value of a key as it would be typed: its default, an example of its own, or one of its type."""
    if key.default:
        return key.default
    if key.field.examples:
        return dumped(key.field.examples[0])
    annotation = unwrap(key.type)[0]
    if key.dimension is not None:
        value: Any = key.dimension.example if key.dimension.unit else float(key.dimension.example)
    elif key.law is not None and not isinstance(key.law, LawOrNumber):
        value = _example_of_law(key.law)
    elif annotation is MaterialScene:
        value = "steel-52100"
    elif choices := _choices(key):
        value = choices[0]
    else:
        value = {bool: True, int: 10, str: _ANY_TEXT}.get(annotation, 10 if int in key.parts else _ANY_TEXT)
    return dumped([value] if typing.get_origin(annotation) is list else value)


def _example_of_law(law_key: LawKey) -> Any:
    """Name of a law that needs no parameters, or else the first law with examples of those that it needs."""
    laws = law_key.laws()
    plain = next((name for name, law in laws.items() if not law.required()), None)
    if plain is not None or not laws:
        return plain or "..."
    name, law = next(iter(laws.items()))
    own = {key.name: key for key in keys_of(law)}
    return {"kind": name} | {one: plain_value(_example(own[one])) for one in law.required()}
