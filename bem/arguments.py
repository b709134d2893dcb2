"""Arguments that functions all over `bem` check alike, one message for each number out of range, and hand on."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any

from bem.errors import InputError


def is_finite(value: object) -> bool:
    """Whether an argument is a finite real number: no bool, no string."""
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def is_positive(value: Any, *, finite: bool = True) -> bool:
    """Whether it is one above zero; or infinite, where it need not be finite."""
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
