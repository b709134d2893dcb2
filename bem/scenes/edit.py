"""Edits of the TOML text of a scene that keep its comments, order and spelling; and new text of a table.

A table is merged into the text: a value that is equal stays as it is written, a changed value keeps the comment behind
it, a key that the table lacks is removed, a new key follows the keys of its table.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from bem.errors import InputError
from bem.scenes.paths import absolute


def table_text(table: Mapping[str, Any]) -> str:
    """A table of plain values as the TOML text of a scene: its tables under headings, tables in those on one line."""
    return edited_text("", table)


def edited_text(text: str, table: Mapping[str, Any], folder: Path | None = None, keep: Sequence[str] = ()) -> str:
    """Return the TOML text with the values of a table.

    Parameters
    ----------
    text : of the file, empty for a new one.
    table : plain values that the text shall have.
    folder : of the file; a `path` that names the same file from there stays as it is written.
    keep : keys at the top that stay as the text has them, or has them not.

    Raises
    ------
    InputError : the text is not valid TOML, or tomlkit cannot write the values into it.
    """
    new = text.strip() == ""
    before = _parsed(text)
    wanted = {key: value for key, value in table.items() if new or key not in keep}
    wanted |= {key: before[key] for key in keep if key in before}
    if folder is not None:
        wanted = _written_paths(wanted, before, folder)
    try:
        document = tomlkit.parse(text)
        if new:  # keys before tables
            for key, value in sorted(wanted.items(), key=lambda item: isinstance(item[1], Mapping)):
                document.add(key, _table(value) if isinstance(value, Mapping) else _item(value))
        else:
            _merge(document, wanted, before, top=True)
        edited = tomlkit.dumps(document)
        same = _equal(tomllib.loads(edited), wanted)
    except (TOMLKitError, ValueError, RecursionError):
        same = False
    if not same:
        raise InputError("scene: the form cannot put this value into the file; allowed: the same in its TOML text")
    return edited


def _parsed(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"scene: its file is not valid TOML ({error}), so it stays as it is; mend its text") from None


def _merge(target: Any, wanted: Mapping[str, Any], before: Mapping[str, Any], *, top: bool = False) -> None:
    """Bring a table of tomlkit, which has the plain values `before`, to the wanted ones."""
    for key in before:
        if key not in wanted:
            del target[key]
    for key, value in wanted.items():
        old = before.get(key)
        if key in before and _equal(old, value):
            continue
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            _merge(target[key], value, old)
        elif old and _are_tables(old) and _are_tables(value) and len(value) == len(old):
            for row, one, was in zip(target[key], value, old, strict=True):
                _merge(row, one, was)
        elif key in before:
            target[key] = _item(value)
        else:
            target.append(key, _table(value) if top and isinstance(value, Mapping) else _item(value))


def _are_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _table(values: Mapping[str, Any]) -> Any:
    """A table under a heading."""
    made = tomlkit.table()
    for key, value in values.items():
        made.append(key, _item(value))
    return made


def _item(value: Any) -> Any:
    """A value on one line."""
    if isinstance(value, Mapping):
        inline = tomlkit.inline_table()
        for key, item in value.items():
            inline.append(key, _item(item))
        return inline
    if isinstance(value, list | tuple):
        array = tomlkit.array()
        for item in value:
            array.append(_item(item))
        return array
    return tomlkit.item(value)


def _equal(one: Any, other: Any) -> bool:
    """Return True if two plain values are written alike: 1, 1.0 and true differ."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_equal(value, other[key]) for key, value in one.items())
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(_equal, one, other))
    return type(one) is type(other) and (one == other or one != one)


def _written_paths(value: Any, before: Any, folder: Path) -> Any:
    """The value with each `path` as the text has it, where both name the same file."""
    if isinstance(value, Mapping):
        old = before if isinstance(before, Mapping) else {}
        found = {key: _written_paths(item, old.get(key), folder) for key, item in value.items()}
        path = old.get("path")
        if isinstance(path, str) and path and "\0" not in path and found.get("path") == absolute(path, folder):
            found["path"] = path
        return found
    if isinstance(value, list):
        rows = before if isinstance(before, list) and len(before) == len(value) else [None] * len(value)
        return [_written_paths(item, row, folder) for item, row in zip(value, rows, strict=True)]
    return value
