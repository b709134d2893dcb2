"""Differences of two scenes, key by key, and in words for a user who resumes a folder with another scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_MOST_NAMED = 6
_LONGEST = 60
_NOT_SET = object()


def leaves(value: Any, key: str = "") -> dict[str, Any]:
    """The plain values of nested tables by dotted key; a list of plain values is one, others are `bodies[0].material`.

    >>> leaves({"grid": {"shape": [2, 3]}})
    {'grid.shape': [2, 3]}
    """
    if isinstance(value, Mapping):
        parts = [leaves(item, f"{key}.{name}" if key else str(name)) for name, item in value.items()]
    elif isinstance(value, list) and any(isinstance(item, Mapping | list) for item in value):
        parts = [leaves(item, f"{key}[{i}]") for i, item in enumerate(value)]
    else:
        return {key: value}
    return {name: item for part in parts for name, item in part.items()}


def words_of_difference(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """The first keys in which two scenes' tables differ, with both values; empty where they are equal.

    >>> words_of_difference({"seed": 1, "grid": {"shape": [2, 3]}}, {"seed": 2, "grid": {"shape": [2, 3]}})
    'seed: 1 there, 2 now'
    """
    there, now = leaves(old), leaves(new)
    names = sorted(
        key for key in there.keys() | now.keys() if there.get(key, _NOT_SET) != now.get(key, _NOT_SET)
    )  # a table that is empty on one side has no leaf, and is no difference
    told = [f"{key}: {_shown(there, key)} there, {_shown(now, key)} now" for key in names[:_MOST_NAMED]]
    more = [f"and {len(names) - _MOST_NAMED} more"] if len(names) > _MOST_NAMED else []
    return "; ".join([*told, *more])


def _shown(table: Mapping[str, Any], key: str) -> str:
    text = repr(table[key]) if key in table else "not set"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
