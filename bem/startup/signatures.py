"""Text form of the argument types of compiled loops, for a record that outlives a version of numba.

A record is a JSON object:

`types`   list of types, each a list: a kind and what it is made of, where an integer is the index of an earlier type.
`loops`   module -> name of the loop -> list of signatures; a signature lists the indices of its arguments' types.
`main`    module -> name of the loop -> number of its first signatures that the main job needs.

Kinds: `scalar` (numba's name), `array` (type of the entries, dimensions, layout, whether it is writable), `tuple`,
`named` (class as `module:name`, then its fields), `optional`, `pointer`, `literal` (its value) and `none`.

Knows numba's types, nothing of what is computed. Verified in tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import importlib
import json
from collections.abc import Mapping, Sequence
from typing import Any

Signature = tuple[Any, ...]
"""Argument types of one specialisation of a compiled loop."""


class SignatureWriter:
    """Collects signatures; each type is stored once."""

    def __init__(self) -> None:
        self._types: list[list[Any]] = []
        self._index: dict[str, int] = {}
        self._loops: dict[str, dict[str, list[list[int]]]] = {}
        self._main: dict[str, dict[str, int]] = {}

    def add(self, module: str, name: str, signature: Signature) -> None:
        """Add a specialisation of a loop, unless it is there already.

        Raises
        ------
        TypeError : an argument's type has no text form.
        """
        indices = [self._encode(argument) for argument in signature]
        known = self._loops.setdefault(module, {}).setdefault(name, [])
        if indices not in known:
            known.append(indices)

    def end_main_job(self) -> None:
        """Mark all signatures so far as those of the main job."""
        self._main = {
            module: {name: len(found) for name, found in loops.items()} for module, loops in self._loops.items()
        }

    def text(self) -> str:
        """JSON text of the record; one line for each type and for each loop."""
        types = ",\n".join(f"  {json.dumps(item)}" for item in self._types)
        loops, main = _by_module(self._loops), _by_module(self._main)
        return f'{{\n "types": [\n{types}\n ],\n "loops": {{\n{loops}\n }},\n "main": {{\n{main}\n }}\n}}\n'

    def _encode(self, argument: Any) -> int:
        from numba import types

        given: Any = argument
        if isinstance(given, types.Array):
            if not given.aligned:
                raise TypeError(f"an array of unaligned entries has no text form: {given}")
            return self._store(["array", self._encode(given.dtype), given.ndim, given.layout, given.mutable])
        if isinstance(argument, types.BaseNamedTuple):
            owner = given.instance_class
            fields = [self._encode(field) for field in given]
            return self._store(["named", f"{owner.__module__}:{owner.__qualname__}", *fields])
        if isinstance(argument, types.BaseTuple):
            return self._store(["tuple", *(self._encode(item) for item in given)])
        if isinstance(given, types.Optional):
            return self._store(["optional", self._encode(given.type)])
        if isinstance(given, types.CPointer):
            return self._store(["pointer", self._encode(given.dtype)])
        if isinstance(given, types.IntegerLiteral | types.BooleanLiteral):
            return self._store(["literal", given.literal_value])
        if isinstance(given, types.NoneType):
            return self._store(["none"])
        if isinstance(given, types.Number | types.Boolean):
            return self._store(["scalar", given.name])
        raise TypeError(f"a {type(given).__name__} has no text form: {given}")

    def _store(self, item: list[Any]) -> int:
        key = json.dumps(item)
        if key not in self._index:
            self._index[key] = len(self._types)
            self._types.append(item)
        return self._index[key]


def _by_module(table: Mapping[str, Mapping[str, Any]]) -> str:
    """JSON text of the entries, sorted, one line for each loop."""
    modules = []
    for module, loops in sorted(table.items()):
        lines = ",\n".join(f"   {json.dumps(name)}: {json.dumps(found)}" for name, found in sorted(loops.items()))
        modules.append(f"  {json.dumps(module)}: {{\n{lines}\n  }}")
    return ",\n".join(modules)


class SignatureRecord:
    """Signatures read from a record; types are built when they are asked for.

    Parameters
    ----------
    text : JSON text as `SignatureWriter.text` gives it.
    """

    def __init__(self, text: str) -> None:
        content = json.loads(text)
        self._types: Sequence[Sequence[Any]] = content["types"]
        self._loops: Mapping[str, Mapping[str, Sequence[Sequence[int]]]] = content["loops"]
        self._main: Mapping[str, Mapping[str, int]] = content["main"]
        self._decoded: dict[int, Any] = {}

    def loops(self, *, main: bool = False) -> list[tuple[str, str]]:
        """Module and name of every loop, or of those that the main job needs."""
        return [(module, name) for module, loops in (self._main if main else self._loops).items() for name in loops]

    def signatures(self, module: str, name: str, *, main: bool = False) -> list[Signature]:
        """Signatures of one loop, or those of them that the main job needs; none where the record does not have it.

        Raises
        ------
        ImportError, AttributeError : a class of named tuples is not where it was.
        """
        found = self._loops.get(module, {}).get(name, ())
        if main:
            found = found[: self._main.get(module, {}).get(name, 0)]
        return [tuple(map(self._decode, indices)) for indices in found]

    def _decode(self, index: int) -> Any:
        if index not in self._decoded:
            kind, *parts = self._types[index]
            self._decoded[index] = self._build(kind, parts)
        return self._decoded[index]

    def _build(self, kind: str, parts: Sequence[Any]) -> Any:
        from numba import types

        if kind == "array":
            entries, dimensions, layout, writable = parts
            return types.Array(self._decode(entries), dimensions, layout, readonly=not writable)
        if kind == "named":
            module, _, name = parts[0].partition(":")
            owner = getattr(importlib.import_module(module), name)
            return types.BaseTuple.from_types([self._decode(part) for part in parts[1:]], owner)
        if kind == "tuple":
            return types.BaseTuple.from_types([self._decode(part) for part in parts])
        if kind == "optional":
            return types.Optional(self._decode(parts[0]))
        if kind == "pointer":
            return types.CPointer(self._decode(parts[0]))
        if kind == "literal":
            return types.literal(parts[0])
        if kind == "none":
            return types.none
        name = parts[0]
        return getattr(types, "boolean" if name == "bool" else name)
