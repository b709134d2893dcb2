"""Arguments that functions all over `bem` check alike, one message for each number out of range, and hand on; files
among them are regular ones, not larger than what people write by hand, and read without waiting for anybody."""

from __future__ import annotations

import math
import os
import stat
from collections.abc import Iterable
from numbers import Real
from typing import Any

from bem.errors import InputError

MOST_BYTES = 1_000_000
"""Of a file that somebody wrote by hand."""

_SURELY_MEANT = 0.85
"""Similarity of two spellings, 0 to 1, from which one is a slip of the other; "steel-disc" to "steel-disk" has 0.9."""
_MOST_PROPOSED = 6
"""Names of one message."""


def is_finite(value: object) -> bool:
    """Return True if an argument is a finite real number: no bool, no string."""
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def is_positive(value: Any, *, finite: bool = True) -> bool:
    """Return True if it is one above zero; or infinite, where it need not be finite."""
    return bool((is_finite(value) or (not finite and value == math.inf)) and value > 0)


def not_positive(prefix: str = "", /, **values: float) -> list[str]:
    """A message for each number that is not positive and finite; `prefix` says of what."""
    return [
        f"{prefix}{name} {value!r} must be positive and finite"
        for name, value in values.items()
        if not (math.isfinite(value) and value > 0)
    ]


def check_positive(prefix: str = "", /, **values: float) -> None:
    """Refuse numbers that are not positive and finite (InputError)."""
    if messages := not_positive(prefix, **values):
        raise InputError(messages)


def check_not_negative(**values: float) -> None:
    """Refuse numbers that are negative or not finite (InputError)."""
    messages = [
        f"{name} {value!r} must be finite and not negative"
        for name, value in values.items()
        if not (math.isfinite(value) and value >= 0)
    ]
    if messages:
        raise InputError(messages)


def named(source: object, names: str) -> dict[str, Any]:
    """Attributes of an object, "load radius", by their names: what goes on as keyword arguments."""
    return {name: getattr(source, name) for name in names.split()}


def did_you_mean(word: object, names: Iterable[str]) -> str:
    """` - did you mean "..."?` for the names nearest to a word, or nothing.

    A word that is a whole part of hyphenated names, such as "steel" of "steel-52100", proposes all of them, those that
    begin with it first; else the proposal is the one name of the nearest spelling.
    """
    import difflib

    given = str(word).lower().replace("-", "_").replace(" ", "_")
    spelling = {name.lower().replace("-", "_"): name for name in names}
    close = difflib.get_close_matches(given, spelling, n=1, cutoff=0.6)
    near = bool(close) and difflib.SequenceMatcher(None, given, close[0]).ratio() >= _SURELY_MEANT
    parts = [] if near else [name for name in spelling.values() if given in name.lower().split("-")]
    if parts:
        parts.sort(key=lambda name: not name.lower().startswith(given))
        proposed = " or ".join(f'"{name}"' for name in parts[:_MOST_PROPOSED])
        return f" - did you mean {proposed}?"
    return f' - did you mean "{spelling[close[0]]}"?' if close else ""


def read_small(path: str | os.PathLike[str]) -> bytes:
    """The content of a regular file of at most `MOST_BYTES`.

    Raises
    ------
    OSError : it cannot be opened or read. ValueError : it is a pipe or a device, or larger.
    """
    # a pipe that nobody writes into would keep an ordinary `open` for ever
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with open(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise ValueError("not a regular file")
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ValueError(f"larger than {MOST_BYTES} bytes")
    return content
