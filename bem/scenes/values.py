"""Plain values of scenes as TOML text on one line, and read from it."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from pydantic import BaseModel

from bem.laws import Law
from bem.scenes.laws import plain
from bem.scenes.paths import MOST_PARTS

_LONG_KEY = re.compile(rf"(?<![\w\"'-])[\w\"'-]++(?:[ \t]*\.[ \t]*[\w\"'-]++){{{MOST_PARTS}}}", re.ASCII)


def parse_toml(text: str) -> dict[str, Any]:
    """Read TOML by `tomllib.loads`.

    Raises
    ------
    ValueError : text that is not TOML, in plain words where a key stands twice; a key of very many parts, which would
        take minutes.
    """
    if _LONG_KEY.search(text):
        raise ValueError(f"a key of more than {MOST_PARTS} parts")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(_twice(str(error), text) or str(error)) from None


def _twice(message: str, text: str) -> str:
    """Return `tomllib`'s message on a key or table that is given twice in plain words; "" of other messages."""
    if not _GIVEN_TWICE.match(message):
        return ""
    lines = text.rstrip().splitlines()
    place = re.search(r"at line (\d+)", message)
    number = int(place[1]) if place else len(lines)
    key = re.match(r"\s*(\[{1,2}[^\[\]]+\]{1,2}|[\w.\"'-]+(?=\s*=))", lines[number - 1])
    table = key is not None and key[1].startswith("[")
    name = f"the {'table' if table else 'key'} {key[1]}" if key else "a key"
    return f"{name} stands twice, the second time in line {number}"


_GIVEN_TWICE = re.compile(r"Cannot overwrite a value|Cannot declare .* twice|Duplicate inline table key")
"""Beginnings of the messages of `tomllib` on keys and tables that are given twice."""


def plain_value(text: str) -> Any:
    """A value as in TOML; what is none is a plain word or a quantity without quotes."""
    value = text.strip()
    with suppress(ValueError, RecursionError):
        return parse_toml(f"value = {value}")["value"] if "\n" not in value else value
    return value


def dumped(value: Any) -> str:
    """A plain value, a law or a table as TOML, in a line.

    Raises
    ------
    TypeError : anything else.
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return "[" + ", ".join(dumped(item) for item in value) + "]"
    if isinstance(value, Law):
        return dumped(plain(value))
    if isinstance(value, BaseModel):
        value = value.model_dump(mode="python", exclude_none=True)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))} = {dumped(item)}" for key, item in value.items()) + "}"
    raise TypeError(f"no TOML for {type(value).__name__}")


def typed(value: Any) -> str:
    """A plain value as a user would type it: as `dumped`, with keys of tables without quotes."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {typed(item)}" for key, item in value.items()) + " }"
    return dumped(value)
