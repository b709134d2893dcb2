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
    """Read TOML by `tomllib.loads`; raise ValueError for a key of very many parts, which would take it minutes."""
    if _LONG_KEY.search(text):
        raise ValueError(f"a key of more than {MOST_PARTS} parts")
    return tomllib.loads(text)


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
