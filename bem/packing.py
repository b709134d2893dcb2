"""Packing of frozen dataclasses into plain values and arrays, for checkpoints.

A dataclass of this package is stored under the name of its class; nothing else is created by name. Objects that the
reader rebuilds anyway (a lubricant, a law of the user's, a grid) are `given` to both sides and are not stored.

Verified in tests/scenes/test_packing.py.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any

import numpy as np

from bem.notes import Note
from bem.notes import unpacked as unpacked_note

_PACKAGE = "bem."


def packed(value: Any, given: Sequence[Any] = ()) -> Any:
    """Return dataclasses, enums, mappings, tables, tuples and lists as dictionaries and lists of plain values and
    arrays.

    Raises
    ------
    TypeError : a dataclass or an enum that is not of this package.
    """
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
    if isinstance(value, np.ndarray) and value.dtype.names is not None:
        columns = {name: np.ascontiguousarray(value[name]) for name in value.dtype.names}
        return {"rows": value.size, "columns": [[name, values.dtype.str, values] for name, values in columns.items()]}
    if isinstance(value, Mapping):
        return {"entries": [[packed(key, given), packed(item, given)] for key, item in value.items()]}
    if isinstance(value, tuple):
        return {"tuple": [packed(item, given) for item in value]}
    return [packed(item, given) for item in value] if isinstance(value, list) else value


def unpacked(value: Any, given: Sequence[Any] = ()) -> Any:
    """Return the value that `packed` was called with, from the same `given` objects.

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
    if "entries" in value:
        return {unpacked(key, given): unpacked(item, given) for key, item in value["entries"]}
    if "columns" in value:
        table = np.zeros(value["rows"], np.dtype([(name, kind) for name, kind, _ in value["columns"]]))
        for name, _, values in value["columns"]:
            table[name] = values
        return table
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
