"""Tables of keys of scenes, read from the models of the kinds: each table of a scene is described once.

A table that several kinds have stands on the page of shared tables, one of a single kind on the page of that kind.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from bem.laws import laws_of
from bem.scenes import get_kind, kind_names, library
from bem.scenes.keys import LEVELS
from bem.scenes.walk import Key, fields_of_table, is_law, keys_of, literals, walk

_TOP = ("name", "description", "redoes", "seed", "repetitions", "over", "accuracy")
"""Keys of every scene, described on the page of shared tables."""


def keys_of_table(model: Any, name: str = "") -> list[Key]:
    """Return the keys of a table, basic ones first; of a kind's scene (no `name`) without those of every scene."""
    found = [key for key in keys_of(model, naming=bool(name)) if name or key.name not in _TOP]
    return sorted(found, key=lambda key: LEVELS.index(key.level))


def scene_keys() -> list[Key]:
    """Return the keys that every scene has."""
    return [key for key in keys_of(get_kind("contact").model) if key.name in _TOP]


def allowed_at(key: Key) -> str:
    """Return unit or choices of a key, a quantity as "length [m]"."""
    words = re.sub(r'^an? (.+?) such as ".+?", or a number in ([^,]+)', r"\1 [\2]", key.allowed)
    return words.replace('a number such as 0.3 or "10 %"', "number or %")


def meaning_of(key: Key) -> str:
    """Return the description of a key, with the reason of its default."""
    return f"{key.meaning} Default: {key.reason}." if key.reason else key.meaning


def tables_at(key: Key) -> tuple[Any, ...]:
    """Return the models of the tables that may stand at a key, laws with parameters included."""
    if key.law is not None and not is_law(key.type):  # of a number or a law
        return tuple(law for law in laws_of(key.law.family).values() if law.parameters())
    if key.law is not None:
        return () if key.law.beside else tuple(table.model for table in key.tables if table.model.parameters())
    return tuple(dict.fromkeys(table.model for table in (*key.tables, *([key.row] if key.row else []))))


def default_of(key: Key) -> str:
    """Return the default of a key as it would be typed; empty for a table."""
    return "" if tables_at(key) else key.default


def tables_of(kind: str) -> dict[Any, str]:
    """Return the models of all tables of a kind, with the key where each stands first; laws are left out."""
    found: dict[Any, str] = {}
    for key in walk(get_kind(kind).model):
        for inner in tables_at(key):
            if not is_law(inner):
                found.setdefault(inner, key.name)
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


def scenes_of(kind: str) -> Iterator[tuple[str, str]]:
    """Names and descriptions of the built-in scenes of a kind."""
    for name, scene in library().items():
        if scene["kind"] == kind:
            yield name, scene.get("description", "")
