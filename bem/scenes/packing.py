"""Frozen dataclasses, such as solutions that a case goes on from, as plain values and arrays for a checkpoint.

A dataclass of this package stands in it by the name of its class; nothing else is ever made by name. What the scene
makes again anyway (a lubricant, a law of the user's, a grid) is `given` to both sides and is not stored.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any

from bem.notes import Note
from bem.notes import unpacked as unpacked_note

if TYPE_CHECKING:
    from bem.scenes.context import Context

_PACKAGE = "bem."


def keep(context: Context, state: Any, given: Sequence[Any] = ()) -> None:
    """Replace the checkpoint of a case by its state, which `kept` gives back."""
    context.save({"state": packed(state, given)})


def kept(context: Context, given: Sequence[Any] = ()) -> Any:
    """The state last kept, of a case that goes on; None of one that begins."""
    saved = context.saved()
    return None if saved is None else unpacked(saved["state"], given)


def kept_coarser(context: Context, given: Sequence[Any] = ()) -> Any:
    """The state last kept on the level before, where an accuracy is refined to; None on a first level."""
    saved = context.coarser()
    return None if saved is None else unpacked(saved["state"], given)


def packed(value: Any, given: Sequence[Any] = ()) -> Any:
    """Dataclasses, enums, tuples and lists as dictionaries and lists of plain values and arrays."""
    for number, known in enumerate(given):
        if value is known:
            return {"given": number}
    if isinstance(value, Note):
        return {"note": value.packed()}
    if isinstance(value, Enum):
        return {"member": _name(type(value)), "value": value.value}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        entries = {field.name: packed(getattr(value, field.name), given) for field in dataclasses.fields(value)}
        return {"record": _name(type(value)), "fields": entries}
    if isinstance(value, tuple):
        return {"tuple": [packed(item, given) for item in value]}
    return [packed(item, given) for item in value] if isinstance(value, list) else value


def unpacked(value: Any, given: Sequence[Any] = ()) -> Any:
    """What `packed` was given, from the same `given` things.

    Raises
    ------
    ValueError : a name that is no dataclass or enum of this package.
    """
    if isinstance(value, list):
        return [unpacked(item, given) for item in value]
    if not isinstance(value, Mapping):
        return value
    if "given" in value:
        return given[value["given"]]
    if "note" in value:
        return unpacked_note(value["note"])
    if "tuple" in value:
        return tuple(unpacked(item, given) for item in value["tuple"])
    if "member" in value:
        return _class(value["member"])(value["value"])
    return _class(value["record"])(**{name: unpacked(item, given) for name, item in value["fields"].items()})


def _name(kind: type) -> str:
    if not kind.__module__.startswith(_PACKAGE):
        raise TypeError(f"{kind.__qualname__} is not of this package; give it to both sides instead")
    return f"{kind.__module__}:{kind.__qualname__}"


def _class(name: str) -> Any:
    module, _, qualified = name.partition(":")
    found = getattr(importlib.import_module(module), qualified, None) if module.startswith(_PACKAGE) else None
    if not (isinstance(found, type) and (dataclasses.is_dataclass(found) or issubclass(found, Enum))):
        raise ValueError(f"{name}: no record of this package")
    return found
