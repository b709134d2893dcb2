"""Tables of keys of scenes, read from the models of the kinds: each table of a scene is described once.

A table that several kinds have stands on the page of shared tables, one of a single kind on the page of that kind.
"""

from __future__ import annotations

import re
import typing
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic.fields import FieldInfo

from bem.laws import Law, laws_of
from bem.scenes import get_kind, kind_names, library
from bem.scenes.form import about_field, default_text
from bem.scenes.keys import LEVELS, Level, level_of, reason_of
from bem.scenes.laws import LawKey
from bem.scenes.validate import fields_of_table, literals, unwrap, without_none

_TOP = ("name", "description", "redoes", "seed", "repetitions", "over", "accuracy")
"""Keys of every scene, described on the page of shared tables."""


@dataclass(frozen=True)
class Key:
    """A key of a table.

    Attributes
    ----------
    name : of the key.
    meaning : one sentence.
    allowed : unit or choices.
    default : as it would be typed; "required", or empty for a table.
    level : who sets the key.
    tables : models of the tables that may stand at the key.
    """

    name: str
    meaning: str
    allowed: str
    default: str
    level: Level
    tables: tuple[Any, ...]


def keys_of_table(model: Any, name: str = "") -> list[Key]:
    """Return the keys of a table, basic ones first; of a kind's scene (no `name`) without those of every scene."""
    found = []
    for key, field in fields_of_table(model).items():
        if not name and (key == "kind" or key in _TOP):
            continue
        inner = tables_at(field)
        default = "" if inner else default_text(field).replace("(not set)", "").replace("...", "required")
        found.append(Key(key, meaning_of(field), allowed_at(field), default, level_of(field), inner))
    return sorted(found, key=lambda key: LEVELS.index(key.level))


def scene_keys() -> list[Key]:
    """Return the keys that every scene has."""
    model = get_kind("contact").model
    found = {}
    for key, field in model.model_fields.items():
        if key in _TOP:
            default = default_text(field).replace("(not set)", "")
            found[key] = Key(key, meaning_of(field), allowed_at(field), default, level_of(field), ())
    return list(found.values())


def allowed_at(field: FieldInfo) -> str:
    """Return unit or choices of a key, a quantity as "length [m]"."""
    words = re.sub(r'^an? (.+?) such as ".+?", or a number in ([^,]+)', r"\1 [\2]", about_field(field))
    return words.replace('a number such as 0.3 or "10 %"', "number or %")


def meaning_of(field: FieldInfo) -> str:
    """Return the description of a key, with the reason of its default."""
    reason = reason_of(field)
    return f"{field.description or ''} Default: {reason}." if reason else field.description or ""


def tables_at(field: Any) -> tuple[Any, ...]:
    """Return the models of the tables that may stand at a key, laws with parameters included."""
    found = _models(field.annotation)
    if not found:
        families = [item.family for item in field.metadata if isinstance(item, LawKey) and not item.beside]
        found = [law for family in families for law in laws_of(family).values() if law.parameters()]
    return tuple(dict.fromkeys(found))


def _models(annotation: Any) -> list[Any]:
    annotation = without_none(annotation)
    if fields_of_table(annotation):
        return [annotation]
    return [model for item in typing.get_args(annotation) for model in _models(unwrap(item)[0])]


def is_law(model: Any) -> bool:
    """Whether a table is a law with its parameters, which the page of laws describes."""
    return isinstance(model, type) and issubclass(model, Law)


def tables_of(kind: str) -> dict[Any, str]:
    """Return the models of all tables of a kind, with the key where each stands first; laws are left out."""
    found: dict[Any, str] = {}

    def visit(model: Any) -> None:
        for key, field in fields_of_table(model).items():
            for inner in tables_at(field):
                if inner not in found and not is_law(inner):
                    found[inner] = key
                    visit(inner)

    visit(get_kind(kind).model)
    return found


@cache
def shared_tables() -> Mapping[Any, tuple[str, tuple[str, ...]]]:
    """Return tables of more than one kind: their key, and the kinds that have them."""
    keys: dict[Any, str] = {}
    kinds: dict[Any, list[str]] = {}
    for kind in kind_names():
        for model, key in tables_of(kind).items():
            keys.setdefault(model, key)
            kinds.setdefault(model, []).append(kind)
    return {model: (keys[model], tuple(users)) for model, users in kinds.items() if len(users) > 1}


def own_tables(kind: str) -> dict[Any, str]:
    """Return the tables that no other kind has."""
    return {model: key for model, key in tables_of(kind).items() if model not in shared_tables()}


def anchor(model: Any) -> str:
    """Return the name of the link to a table."""
    words = re.sub(r"Scene(Part)?$", "", model.__name__)
    return "table-" + re.sub(r"(?<=[a-z])(?=[A-Z])", "-", words).lower()


def tag(model: Any) -> str:
    """Return the value of `kind` that chooses a table among several, or nothing."""
    fields = fields_of_table(model)
    return ", ".join(literals(fields["kind"].annotation)) if "kind" in fields else ""


def about(model: Any) -> str:
    """Return the first paragraph of a table's docstring."""
    return " ".join((model.__doc__ or "").strip().split("\n\n")[0].split())


def scenes_of(kind: str) -> Iterator[tuple[str, str]]:
    """Names and descriptions of the built-in scenes of a kind."""
    for name, scene in library().items():
        if scene["kind"] == kind:
            yield name, scene.get("description", "")
