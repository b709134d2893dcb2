"""Text and HTML representation of results at a prompt and in a notebook: numbers in full, arrays as shape and range."""

from __future__ import annotations

import dataclasses
from html import escape
from typing import Any, TypeVar

from bem.notes import OUTSIDE, outside

_Class = TypeVar("_Class", bound=type)


def readable(cls: _Class) -> _Class:
    """Give a dataclass a `__repr__` without array contents, and a table for notebooks."""
    cls.__repr__ = _text  # type: ignore[assignment]
    return tabled(cls)


def tabled(cls: _Class) -> _Class:
    """Give a dataclass with a short `__repr__` of its own a table for notebooks."""
    cls._repr_html_ = _table  # type: ignore[attr-defined]
    return cls


def _text(self: Any) -> str:
    rows = [f"{name}={value}" for name, value in _in_short(self)]
    line = f"{type(self).__name__}({', '.join(rows)})"
    return line if len(line) <= 110 else "\n  ".join([f"{type(self).__name__}(", *(f"{row}," for row in rows)]) + "\n)"


def _table(self: Any) -> str:
    rows = "".join(f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>" for name, value in _in_short(self))
    return f"<p><b>{type(self).__name__}</b></p><table>{rows}</table>"


def _shown(value: Any) -> list[tuple[str, Any]]:
    return [(item.name, getattr(value, item.name)) for item in dataclasses.fields(value) if item.repr]


def _in_short(value: Any) -> list[tuple[str, str]]:
    """Return names and values as texts; the status names the notes that put the result outside its model."""
    beyond = outside(note for note in getattr(value, "notes", ()) if isinstance(note, str))
    said = f" ({OUTSIDE}{'; '.join(beyond)})" if beyond else ""
    return [(name, _short(item) + (said if name == "status" else "")) for name, item in _shown(value)]


def _short(value: Any) -> str:
    """Return a value in one line: arrays as shape and range, nested results by name."""
    if hasattr(value, "dtype") and hasattr(value, "shape") and value.shape:
        size = "x".join(map(str, value.shape))
        if value.size and value.dtype.kind in "fiu":
            return f"<{size} array, {value.min():.4g} to {value.max():.4g}>"
        return f"<{size} array>"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        if len(value) > 6 or any(hasattr(item, "dtype") for item in value):
            return f"<{len(value)} {type(value).__name__} entries>"
        inner = ", ".join(_short(item) for item in value)
        return f"[{inner}]" if isinstance(value, list) else f"({inner}{',' if len(value) == 1 else ''})"
    if isinstance(value, dict):
        return f"<{len(value)} entries>"
    if hasattr(value, "value") and isinstance(value.value, str):  # a Status
        return repr(value.value)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        status: Any = getattr(value, "status", None)
        return f"<{type(value).__name__}{', ' + status.value if hasattr(status, 'value') else ''}>"
    text = repr(value)
    return text if len(text) <= 100 else text[:97] + "..."
