"""Keys of a scene as they are typed: `contact.load`; into lists by index, `variants[0].name` or `variants.0.name`.
And the files that it names."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from bem.arguments import read_small
from bem.errors import InputError
from bem.surfaces.examples import example_path

Key = tuple[str | int, ...]

MOST_PARTS = 40
"""A key of more parts is none of a scene; reading it takes the square of their number."""

_INDEXED = re.compile(r"([^\[\]]*)((?:\[[0-9]{1,6}\])*)")


def parse_key(text: str) -> Key | None:
    """Parts of a dotted key, indices as numbers; None where it is not one."""
    if text.count(".") + text.count("[") >= MOST_PARTS:
        return None
    parts: list[str | int] = []
    for piece in text.split("."):
        match = _INDEXED.fullmatch(piece.strip())
        name = match[1].strip() if match else ""
        if match is None or not name:
            return None
        parts.append(int(name) if re.fullmatch("[0-9]{1,6}", name) else name)
        parts += [int(number) for number in re.findall("[0-9]+", match[2])]
    return tuple(parts) if isinstance(parts[0], str) else None


def spell_key(key: Sequence[str | int]) -> str:
    """The key as messages and results spell it: `variants[0].name`."""
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def value_at(table: Any, key: Sequence[str | int]) -> Any:
    """Return the value at a key in tables and lists of plain values; None if there is none."""
    for part in key:
        if isinstance(part, int):
            table = table[part] if isinstance(table, list | tuple) and part < len(table) else None
        else:
            table = table.get(part) if isinstance(table, Mapping) else None
    return table


def put(data: dict[str, Any], key: Key, value: Any, pair: bool = False) -> None:
    """Set the value at a key, in place; tables on the way are made where they are missing, lists are not.

    The lists and tables on the way are copied first, so that what `data` was made from stays as it is.

    Parameters
    ----------
    data : the scene's table.
    key : where.
    value : plain value.
    pair : whether one value that stands where the last index points stands for both axes.

    Raises
    ------
    InputError : an index into something that is not a list, or beyond its end; a list entered without an index.
    """
    place: Any = data
    for depth, part in enumerate(key):
        here = key[:depth]
        if isinstance(part, int):
            _check_index(place, here, part)
        elif isinstance(place, list):
            raise InputError(f"{spell_key(key)}: {spell_key(here)} is a list; allowed: {_entries(here, place)}")
        if depth == len(key) - 1:
            place[part] = value
            return
        below = place[part] if isinstance(part, int) else place.get(part)
        if isinstance(below, list | tuple):
            below = list(below)
        elif isinstance(key[depth + 1], int) and pair and depth == len(key) - 2 and _is_single(below):
            below = [below, below]
        elif isinstance(below, Mapping):
            below = dict(below)
        elif isinstance(below, str) and part in ("material", "wheel", "rail", "surface"):
            below = {"kind": below} if part == "surface" else {"catalogue": below}
        elif not isinstance(key[depth + 1], int):
            below = {}
        place[part] = below
        place = below


def drop(data: dict[str, Any], key: Key) -> None:
    """Take a key out, in place, as if it had never been written; what `data` was made from stays as it is.

    Raises
    ------
    InputError : nothing stands there, or an index into something that is no list.
    """
    place = value_at(data, key[:-1])
    last = key[-1]
    if value_at(data, key) is None:
        known = [spell_key((*key[:-1], name)) for name in place] if isinstance(place, Mapping) else []
        listed = f"keys that are set, {', '.join(known)}" if known else "a key that is set"
        raise InputError(f"{spell_key(key)}=: is not set, so there is nothing to take out; allowed: {listed}")
    if isinstance(last, int):
        assert isinstance(place, list | tuple)
        rest: Any = [item for index, item in enumerate(place) if index != last]
    else:
        assert isinstance(place, Mapping)
        rest = {name: item for name, item in place.items() if name != last}
    if len(key) > 1:
        put(data, key[:-1], rest)
    else:
        del data[last]  # type: ignore[arg-type]


def _check_index(place: Any, here: Key, index: int) -> None:
    if place is None:
        raise InputError(
            f"{spell_key(here)}[{index}]: {spell_key(here)} is not set and so has no entries; "
            f"allowed: all of it, {spell_key(here)}=..."
        )
    if not isinstance(place, list):
        what = "a table" if isinstance(place, Mapping) else "one value"
        raise InputError(f"{spell_key(here)}[{index}]: {spell_key(here)} is {what}, not a list; allowed: no index")
    if index >= len(place):
        raise InputError(
            f"{spell_key(here)}[{index}]: {spell_key(here)} has {len(place)} "
            f"{'entry' if len(place) == 1 else 'entries'}; allowed: {_entries(here, place)}"
        )


def _entries(here: Key, place: Sequence[Any]) -> str:
    name = spell_key(here)
    if not place:
        return f"the whole list, {name}=[...]"
    return f"{name}[0]" + (f" to {name}[{len(place) - 1}]" if len(place) > 1 else "")


def _is_single(value: Any) -> bool:
    return isinstance(value, bool | int | float | str)


def values_in_file(name: str, option: str) -> tuple[str, ...]:
    """Values from a text file, one a line; empty lines and those that begin with # are left out.

    Raises
    ------
    InputError : the file cannot be read or holds no values.
    """
    try:
        lines = [line.strip() for line in read_small(name).decode("utf-8-sig").splitlines()]
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{option}: {name} cannot be read ({why}); allowed: a text file, one value a line") from None
    values = tuple(line for line in lines if line and not line.startswith("#"))
    if not values:
        raise InputError(f"{option}: {name} holds no values; allowed: a text file, one value a line")
    return values


def what_is_wrong_with(path: str) -> tuple[str, str] | None:
    """Return the fault of a path of a surface file and the allowed values; None if the file can be read."""
    try:
        if not path or not Path(path).is_file():
            return "no such file", (
                "the path of a surface file, relative to the scene file, or one of the package's, "
                "example/ground-disk.al3d and example/polished-pin.x3p"
            )
        with open(path, "rb") as file:
            return None if file.read(1) else ("the file is empty", "the path of a surface file")
    except (OSError, ValueError) as error:
        return f"cannot be read ({error})", "the path of a readable surface file"


def checksum_of(path: str) -> str:
    """SHA-256 of a file, empty where it cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def absolute(path: str, folder: Path) -> str:
    """A path of a scene in `folder`; `example/NAME` is the package's own map unless the folder has such a file."""
    whole = folder / path
    return str(whole if whole.exists() else example_path(path) or whole)
