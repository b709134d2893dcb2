"""The walk over the model of a scene: each key with its path, type, meaning, unit, level and default.

Template, schema, form, documentation, messages and the text of resolved scenes read a key's properties here, so that
each is derived from the field once.
"""

from __future__ import annotations

import types
import typing
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from bem.laws import Law, laws_of
from bem.scenes.keys import LEVELS, Level, level_of, reason_of
from bem.scenes.laws import LawKey, LawOrNumber, LawTable, fields_of
from bem.scenes.units import Dimension
from bem.scenes.values import dumped

DEEPEST = 6
"""Depth of tables within tables to which the walk descends."""


@dataclass(frozen=True)
class TableType:
    """A table that may stand at a key.

    Attributes
    ----------
    model : pydantic model, or class of a law.
    kind : value of `kind` that chooses the table among several; "" where it is the only one.
    """

    model: Any
    kind: str

    @property
    def meaning(self) -> str:
        """First paragraph of the model's docstring, in one line."""
        return meaning_of_table(self.model)


@dataclass(frozen=True)
class Key:
    """A key of a scene.

    Attributes
    ----------
    path : parts of the dotted key, from the table where the walk began.
    field : of the model.
    level : its own or that of a table that it is in, whichever is higher.
    """

    path: tuple[str, ...]
    field: FieldInfo
    level: Level

    @property
    def name(self) -> str:
        """Last part of the path."""
        return self.path[-1]

    @property
    def meaning(self) -> str:
        """Description in one sentence, "" for none."""
        return self.field.description or ""

    @property
    def reason(self) -> str:
        """Reason of the default, "" for none."""
        return reason_of(self.field)

    @cached_property
    def type(self) -> Any:
        """Type without `Annotated` and None; of a number or a law the law."""
        return without_none(self.field.annotation)

    @cached_property
    def parts(self) -> tuple[Any, ...]:
        """The annotation, everything that it is composed of, and its metadata."""
        found: list[Any] = []
        pending = [self.field.annotation, *self.field.metadata]
        while pending:
            item = pending.pop(0)
            found.append(item)
            pending += [*getattr(item, "__metadata__", ()), *typing.get_args(item)]
            if isinstance(item, LawOrNumber):
                pending.append(item.number)
        return tuple(found)

    @cached_property
    def dimension(self) -> Dimension | None:
        """Dimension of the key's numbers; None for other keys, and for numbers of several dimensions."""
        found = {item for item in self.parts if isinstance(item, Dimension)}
        return found.pop() if len(found) == 1 else None

    @property
    def unit(self) -> str:
        """SI unit, "" for none."""
        return "" if self.dimension is None else self.dimension.unit

    @property
    def required(self) -> bool:
        """Return True if the scene needs the key."""
        return self.field.default is PydanticUndefined and self.field.default_factory is None

    @cached_property
    def default(self) -> str:
        """Default as it would be typed, "" for none."""
        value = self.field.default
        if value is PydanticUndefined or value is None:
            return ""
        try:
            return dumped(value.name if isinstance(value, Law) else value)
        except TypeError:
            return ""

    @cached_property
    def allowed(self) -> str:
        """Choices or dimension in words; "" for other types."""
        return f"one of {', '.join(self.choices)}" if self.law_alone else _allowed(self.field)

    @property
    def law_alone(self) -> bool:
        """Return True if a law stands at the key, and not a number or a law."""
        return self.law is not None and not isinstance(self.law, LawOrNumber)

    @property
    def choices(self) -> list[str]:
        """Words that may stand at the key: of a literal, or names of the laws that it takes."""
        return self.law.names() if self.law is not None and self.law_alone else literals(self.type)

    @cached_property
    def law(self) -> LawKey | None:
        """Annotation of a key that takes a law."""
        return next((item for item in self.parts if isinstance(item, LawKey)), None)

    @cached_property
    def family(self) -> str:
        """Family of laws that the key takes, alone or beside a number; "" for none."""
        if isinstance(self.law, LawOrNumber):
            return self.law.family
        annotation, _ = unwrap(self.type)  # of an optional law the type keeps the annotation
        return annotation.family if is_law(annotation) and not annotation.name else ""

    @property
    def is_law(self) -> bool:
        """Return True if a law may stand at the key."""
        return is_law(self.type) or bool(self.family)

    @cached_property
    def tables(self) -> tuple[TableType, ...]:
        """Tables that may stand at the key: one, or several told apart by `kind`; laws of a family."""
        if self.family:
            laws = laws_of(self.family) if self.law is None else self.law.laws()
            return tuple(TableType(law, name) for name, law in laws.items())
        inner = members_of(self.type) or [self.type]
        found = [one for one in inner if fields_of_table(one) and typing.get_origin(one) is not list]
        return tuple(TableType(one, tag_of(one) if len(found) > 1 else "") for one in found)

    @cached_property
    def row(self) -> TableType | None:
        """Table that the key is a list of; None for other keys."""
        if typing.get_origin(self.type) not in (list, tuple):
            return None
        item = unwrap(typing.get_args(self.type)[0])[0]
        return TableType(item, "") if fields_of_table(item) and not is_law(item) else None


def keys_of(model: Any, path: tuple[str, ...] = (), above: Level = "basic", *, naming: bool = False) -> Iterator[Key]:
    """Yield the keys of one table, which stands at `path` and has the level `above`.

    naming : also a `kind` that only names the table or the kind of scene.
    """
    for name, field in fields_of_table(model).items():
        names = name == "kind" and not is_law(model) and (not path or len(typing.get_args(field.annotation)) == 1)
        if names and not naming:
            continue
        yield Key((*path, name), field, max(level_of(field), above, key=LEVELS.index))


def own_keys(model: Any) -> Iterator[Key]:
    """Yield the keys that are fields of a model, with `kind`, without parameters of laws beside them."""
    for name, field in getattr(model, "model_fields", {}).items():
        yield Key((name,), field, level_of(field))


def walk(model: Any, path: tuple[str, ...] = (), above: Level = "basic") -> Iterator[Key]:
    """Yield all keys of a table and of the tables in it, each table after its key."""
    for key in keys_of(model, path, above):
        yield key
        if len(path) < DEEPEST:
            for table in (*key.tables, *([key.row] if key.row else [])):
                yield from walk(table.model, key.path, key.level)


def meaning_of_table(model: Any) -> str:
    """Return the first paragraph of a table's docstring, in one line."""
    if not (isinstance(model, type) and issubclass(model, BaseModel | Law)) or not model.__doc__:
        return ""
    return " ".join(model.__doc__.strip().split("\n\n")[0].split())


def tag_of(model: Any) -> str:
    """Return the `kind` that chooses a table among several; without one the name of its class."""
    kind = fields_of_table(model).get("kind")
    return str(typing.get_args(kind.annotation)[0]) if kind is not None else model.__name__


def _allowed(field: FieldInfo) -> str:
    annotation, metadata = unwrap(without_none(field.annotation))
    words: list[str] = list(literals(annotation))
    pending = [*metadata, *field.metadata, *typing.get_args(annotation)]
    for item in sorted(pending, key=lambda item: not isinstance(item, LawOrNumber)):
        item, more = unwrap(item)
        for part in (*more, item):
            if isinstance(part, LawOrNumber):
                return f"{_allowed(FieldInfo.from_annotation(part.number))}, or a law: {', '.join(part.names())}"
            if isinstance(part, Dimension):
                return part.allowed
        words = words or list(literals(item))
    if words:
        return "one of " + ", ".join(words)
    return "true or false" if annotation is bool else ""


def unwrap(annotation: Any) -> tuple[Any, tuple[Any, ...]]:
    """An annotation without `Annotated`, and what was in it."""
    metadata: tuple[Any, ...] = ()
    while typing.get_origin(annotation) is typing.Annotated:
        metadata = (*metadata, *annotation.__metadata__)
        annotation = annotation.__origin__
    return annotation, metadata


def without_none(annotation: Any) -> Any:
    """An annotation without `Annotated` and `None`; of a number or a law the law."""
    annotation, _ = unwrap(annotation)
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        members = [item for item in typing.get_args(annotation) if item is not type(None)]
        # of a number or a law the number's dimension is with the field
        members = [item for item in members if is_law(item)] or members
        if len(members) == 1:
            return members[0]
    return annotation


def is_law(annotation: Any) -> bool:
    """Return True if it is a law or a family of them."""
    return isinstance(annotation, type) and issubclass(annotation, Law)


def members_of(annotation: Any) -> list[Any]:
    """The members of a union, none of anything else."""
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        return [unwrap(item)[0] for item in typing.get_args(annotation)]
    return []


def fields_of_table(annotation: Any) -> dict[str, Any]:
    """Fields of a table, or of a law that has a name; a family of laws has none of its own."""
    annotation = without_none(annotation)
    if not isinstance(annotation, type):
        return {}
    if issubclass(annotation, LawTable):
        return {**annotation.model_fields, **annotation.fields_beside()}
    if issubclass(annotation, BaseModel):
        return dict(annotation.model_fields)
    return fields_of(annotation) if issubclass(annotation, Law) and annotation.name else {}


def literals(annotation: Any) -> list[str]:
    """The words that are allowed: of a literal, or names of a family of laws."""
    annotation = without_none(annotation)
    if isinstance(annotation, type) and issubclass(annotation, Law) and not annotation.name:
        return list(laws_of(annotation.family))
    return (
        [str(item) for item in typing.get_args(annotation)] if typing.get_origin(annotation) is typing.Literal else []
    )
