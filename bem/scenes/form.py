"""Keys of a kind of scene as a tree of entries: meaning, level, unit, default and choices, tables inside tables.

Read off the models; the commented templates, the form of the page and the guide are made of it, and none of them is
known here. Verified in tests/scenes/test_form.py.
"""

from __future__ import annotations

import typing
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from bem.errors import InputError
from bem.laws import Law, laws_of
from bem.lubrication.oils.catalogue import oil_names
from bem.materials import CATALOGUE
from bem.scenes.common import MaterialScene
from bem.scenes.keys import LEVELS, Level, level_of, reason_of
from bem.scenes.kind import get_kind
from bem.scenes.laws import LawKey, LawOrNumber, fields_of
from bem.scenes.load import dumped, library, plain_value, read_table, scene_from_table
from bem.scenes.starts import start_scene
from bem.scenes.units import Dimension
from bem.scenes.validate import fields_of_table, is_law, literals, members_of, unwrap, without_none

_NOT_ASKED = ("redoes", "name", "over", "sha256")
_DEEPEST = 6


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
    return FormTable(kind, found.title, _entries(found.model, "", 0, "basic"))


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


def _entries(model: Any, prefix: str, depth: int, level: Level) -> tuple[Entry, ...]:
    return tuple(
        _entry(f"{prefix}{name}", field, depth, level)
        for name, field in fields_of_table(model).items()
        if not (name == "kind" and _says_which(field, prefix))
    )


def _says_which(field: Any, prefix: str) -> bool:
    """Return True if a `kind` only tells which table or scene it is: there is nothing to choose then."""
    return not prefix or len(typing.get_args(field.annotation)) == 1


def _entry(key: str, field: Any, depth: int, above: Level) -> Entry:
    annotation = without_none(field.annotation)
    default = "" if field.default in (PydanticUndefined, None) else default_text(field)
    level = max(level_of(field), above, key=LEVELS.index)
    deeper = depth < _DEEPEST
    tables = _tables(annotation, field, key, depth, level) if deeper else ()
    row = _row(annotation) if deeper else None
    return Entry(
        key=key,
        name=key.rpartition(".")[2].replace("_", " "),
        description=field.description or "",
        level=level,
        reason=reason_of(field),
        unit=unit_of(field),
        allowed=about_field(field) or _words(annotation),
        default=default,
        example=_example(field, key, default),
        choices=_choices(annotation, key),
        closed=typing.get_origin(annotation) is typing.Literal,
        required=field.default is PydanticUndefined and field.default_factory is None,
        switch=annotation is bool,
        tables=tables,
        rows=None if row is None else FormTable("", _about(row), _entries(row, "", depth + 1, level)),
        typed=not tables or annotation is MaterialScene or is_law(annotation) or _family(field) is not None,
        is_law=is_law(annotation) or _family(field) is not None,
    )


def _row(annotation: Any) -> Any:
    """Table that a key holds several of; None if it does not."""
    if typing.get_origin(annotation) not in (list, tuple):
        return None
    item = unwrap(typing.get_args(annotation)[0])[0]
    return item if fields_of_table(item) and not is_law(item) else None


def _tables(annotation: Any, field: Any, key: str, depth: int, level: Level) -> tuple[FormTable, ...]:
    family = _family(field) or (annotation.family if is_law(annotation) and not annotation.name else None)
    if family is not None:
        return tuple(
            FormTable(name, _about(law), _of_law(law, f"{key}.", depth, level)) for name, law in laws_of(family).items()
        )
    inner = members_of(annotation) or [annotation]
    tables = [one for one in inner if fields_of_table(one) and typing.get_origin(one) is not list]
    several = len(tables) > 1
    return tuple(
        FormTable(_tag(one) if several else "", _about(one), _entries(one, f"{key}.", depth + 1, level))
        for one in tables
    )


def _of_law(law: Any, prefix: str, depth: int, level: Level) -> tuple[Entry, ...]:
    return tuple(_entry(f"{prefix}{name}", field, depth + 1, level) for name, field in fields_of(law).items())


def _family(field: Any) -> str | None:
    """The family of laws of which one may stand in a number's place."""
    return next((item.family for item in _parts(field) if isinstance(item, LawOrNumber)), None)


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


def _parts(field: Any) -> Iterator[Any]:
    """What the annotation of a field is made of, and its metadata."""
    pending = [field.annotation, *field.metadata]
    while pending:
        item = pending.pop(0)
        yield item
        pending += [*getattr(item, "__metadata__", ()), *typing.get_args(item)]
        if isinstance(item, LawOrNumber):
            pending.append(item.number)


def dimension_of(field: Any) -> Dimension | None:
    """Dimension of the numbers of a key; None of other keys, and of one whose numbers have several."""
    found = {item for item in _parts(field) if isinstance(item, Dimension)}
    return found.pop() if len(found) == 1 else None


def unit_of(field: Any) -> str:
    """SI unit of a key, "" for none."""
    found = dimension_of(field)
    return "" if found is None else found.unit


def _example(field: Any, key: str, default: str) -> str:
    """A value of a key as it would be typed: its default, an example of its own, or one of its type."""
    if default:
        return default
    if field.examples:
        return dumped(field.examples[0])
    annotation, dimension = unwrap(without_none(field.annotation))[0], dimension_of(field)
    law = next((item for item in _parts(field) if isinstance(item, LawKey)), None)
    several = typing.get_origin(annotation) is list
    if dimension is not None:
        value: Any = dimension.example if dimension.unit else float(dimension.example)
    elif law is not None and not isinstance(law, LawOrNumber):
        value = _example_of_law(law)
    elif annotation is MaterialScene:
        value = "steel-52100"
    elif choices := _choices(annotation, key):
        value = choices[0]
    else:
        value = {bool: True, int: 10, str: "..."}.get(annotation, 10 if int in list(_parts(field)) else "...")
    return dumped([value] if several else value)


def _example_of_law(key: LawKey) -> Any:
    """Name of a law that needs no parameters, or else the first law with examples of those that it needs."""
    laws = laws_of(key.family)
    plain = next((name for name, law in laws.items() if not law.required()), None)
    if plain is not None or not laws:
        return plain or "..."
    name, law = next(iter(laws.items()))
    own = fields_of(law)
    return {"kind": name} | {one: plain_value(_example(own[one], one, "")) for one in law.required()}


def about_field(field: Any) -> str:
    """What may be typed at a key: its choices, or its dimension."""
    annotation, metadata = unwrap(without_none(field.annotation))
    pending = [*metadata, *field.metadata, *typing.get_args(annotation)]
    words: list[str] = list(literals(annotation))
    for item in sorted(pending, key=lambda item: not isinstance(item, LawOrNumber)):
        item, more = unwrap(item)
        pending_more = [*more, item]
        for part in pending_more:
            if isinstance(part, LawOrNumber):
                return f"{about_field(FieldInfo.from_annotation(part.number))}, or a law: {', '.join(part.names())}"
            if isinstance(part, Dimension):
                return part.allowed
        words = words or list(literals(item))
    if words:
        return "one of " + ", ".join(words)
    if annotation is bool:
        return "true or false"
    return ""


def _about(model: Any) -> str:
    """The first paragraph of a table's docstring, in a line."""
    if not (isinstance(model, type) and issubclass(model, BaseModel | Law)) or not model.__doc__:
        return ""
    return " ".join(model.__doc__.strip().split("\n\n")[0].split())


def default_text(field: Any) -> str:
    """The default of a key as it would be typed; "" for none."""
    if field.default is PydanticUndefined or field.default is None:
        return ""
    try:
        return dumped(field.default.name if isinstance(field.default, Law) else field.default)
    except TypeError:
        return ""
