"""A kind of scene as a form: every key with what may stand there, its default and its unit, tables inside tables.

Read off the models, as the schema and the commented templates are; knows nothing of how a form is shown. Verified in
tests/scenes/test_form.py.
"""

from __future__ import annotations

import typing
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic_core import PydanticUndefined

from bem.errors import InputError
from bem.laws import laws_of
from bem.lubrication.oils.catalogue import oil_names
from bem.materials import CATALOGUE
from bem.scenes.common import MaterialScene
from bem.scenes.kind import get_kind
from bem.scenes.laws import LawOrNumber, fields_of
from bem.scenes.load import dumped, library, read_table, scene_from_table
from bem.scenes.template import about_field, about_table, default_text
from bem.scenes.validate import fields_of_table, is_law, literals, members_of, unwrap, without_none

_NOT_ASKED = ("redoes", "name", "over", "sha256")
_DEEPEST = 6


@dataclass(frozen=True)
class Entry:
    """A key of a form.

    Attributes
    ----------
    key : dotted, from the top of the scene.
    name : its last part, in words.
    allowed : what may be typed, with the unit.
    default : as it would be typed, "" for none.
    choices : words that may be typed.
    closed : no others.
    required : whether the scene needs it.
    switch : true or false.
    tables : what may stand there as a table: one, or several told apart by their `kind`.
    typed : whether a value may be typed, too (or only, without tables).
    """

    key: str
    name: str
    allowed: str
    default: str
    choices: tuple[str, ...]
    closed: bool
    required: bool
    switch: bool
    tables: tuple[FormTable, ...]
    typed: bool


@dataclass(frozen=True)
class FormTable:
    """A table of a form; `kind` tells it from others that may stand in its place, "" where it is the only one."""

    kind: str
    about: str
    entries: tuple[Entry, ...]


def form_of(kind: str) -> FormTable:
    """The form of a kind; KeyError if there is none."""
    found = get_kind(kind)
    return FormTable(kind, found.title, _entries(found.model, "", 0))


def start_of(kind: str) -> dict[str, Any]:
    """A table to start a form of the kind from: its smallest built-in scene that needs no file, under its own name."""
    from bem.scenes.template import shortest_scene

    table = dict(shortest_scene(kind)[1])
    for key in ("description", "redoes"):
        table.pop(key, None)
    return table


def mistakes_of(table: Mapping[str, Any]) -> tuple[str, ...]:
    """What is wrong with a table as a scene, one message per mistake; none where it is right."""
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


def text_of(value: Any) -> str:
    """A plain value as it would be typed."""
    return "" if value is None else value if isinstance(value, str) else dumped(value)


def library_scene(name: str) -> dict[str, Any]:
    """The table of a built-in scene, under its name."""
    return {**library()[name], "name": name}


def _entries(model: Any, prefix: str, depth: int) -> tuple[Entry, ...]:
    return tuple(
        _entry(f"{prefix}{name}", field, depth)
        for name, field in fields_of_table(model).items()
        if name not in _NOT_ASKED and not (name == "kind" and _says_which(field, prefix))
    )


def _says_which(field: Any, prefix: str) -> bool:
    """Return True if a `kind` only tells which table or scene it is: there is nothing to choose then."""
    return not prefix or len(typing.get_args(field.annotation)) == 1


def _entry(key: str, field: Any, depth: int) -> Entry:
    annotation = without_none(field.annotation)
    default = "" if field.default in (PydanticUndefined, None) else default_text(field)
    tables = () if depth >= _DEEPEST else _tables(annotation, field, key, depth)
    return Entry(
        key=key,
        name=key.rpartition(".")[2].replace("_", " "),
        allowed=about_field(field) or _words(annotation),
        default="" if default == "(not set)" else default,
        choices=_choices(annotation, key),
        closed=typing.get_origin(annotation) is typing.Literal,
        required=field.default is PydanticUndefined and field.default_factory is None,
        switch=annotation is bool,
        tables=tables,
        typed=not tables or annotation is MaterialScene or is_law(annotation) or _family(field) is not None,
    )


def _tables(annotation: Any, field: Any, key: str, depth: int) -> tuple[FormTable, ...]:
    family = _family(field) or (annotation.family if is_law(annotation) and not annotation.name else None)
    if family is not None:
        return tuple(
            FormTable(name, about_table(law)[0] if about_table(law) else "", _of_law(law, f"{key}.", depth))
            for name, law in laws_of(family).items()
        )
    inner = members_of(annotation) or [annotation]
    tables = [one for one in inner if fields_of_table(one) and typing.get_origin(one) is not list]
    several = len(tables) > 1
    return tuple(
        FormTable(_tag(one) if several else "", " ".join(about_table(one)), _entries(one, f"{key}.", depth + 1))
        for one in tables
    )


def _of_law(law: Any, prefix: str, depth: int) -> tuple[Entry, ...]:
    return tuple(_entry(f"{prefix}{name}", field, depth + 1) for name, field in fields_of(law).items())


def _family(field: Any) -> str | None:
    """The family of laws of which one may stand in a number's place."""
    pending = [field.annotation, *field.metadata]
    while pending:
        item = pending.pop()
        if isinstance(item, LawOrNumber):
            return item.family
        pending += [*getattr(item, "__metadata__", ()), *typing.get_args(item)]
    return None


def _tag(model: Any) -> str:
    kind = fields_of_table(model).get("kind")
    return str(typing.get_args(kind.annotation)[0]) if kind is not None else model.__name__


def _choices(annotation: Any, key: str) -> tuple[str, ...]:
    if annotation is MaterialScene:
        return tuple(sorted(CATALOGUE))
    if key.rpartition(".")[2] == "grade":
        return oil_names()
    return tuple(literals(annotation))


def _words(annotation: Any) -> str:
    if annotation is MaterialScene:
        return "a material of the catalogue, or constants of its own"
    if typing.get_origin(annotation) is list:
        item = unwrap(typing.get_args(annotation)[0])[0]
        if fields_of_table(item):
            names = list(fields_of_table(item))
            return f"a list of tables, such as [{{{names[0]} = ...}}]; keys: {', '.join(names)}"
        return "a list, such as [1, 2]"
    return {int: "a whole number", str: "text", float: "a number"}.get(annotation, "")
