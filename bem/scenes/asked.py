"""The accuracy that a scene asks for: of all headline figures, or figure by figure, each relative to the figure.

    accuracy = "1 %"
    accuracy = { contact_area = "0.5 %", film_load = "2 %" }
    accuracy = { all = "1 %", max_pressure = "any" }

And the standard deviations that it gives for its inputs, as they are written (`bem.scenes.uncertain` reads them):

    uncertain = { "oil.viscosity" = "5 %", "contact.load" = "0.2 N" }

Knows numbers and names, and the records of kinds; verified in tests/campaigns/test_accuracy.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from bem.scenes.records import Figure, Record, described
from bem.scenes.units import Dimension

ALL, ANY = "all", "any"
LEAST, MOST = 1e-5, 0.5
_NUMBER = Dimension("", "a number", "0.01")
_ALLOWED = f'"1 %", or a table of figures with "all" for the others: numbers from {LEAST:g} to {MOST:g}, "any" for none'


def _parsed(value: Any) -> Any:
    """Parse a requested accuracy into one number, or numbers by figure."""
    if not isinstance(value, Mapping):
        return _share("", value)
    if not value:
        raise _wrong("names no figure")
    return {str(name): value[name] if value[name] == ANY else _share(f"{name} = ", value[name]) for name in value}


def _share(name: str, value: Any) -> float:
    try:
        number = _NUMBER.parse(value)
    except PydanticCustomError as error:
        raise _wrong(f"{name}{str(value)[:40]} {error.message().partition(';')[0]}") from None
    if not LEAST <= number <= MOST:
        raise _wrong(f"{name}{number:g} is not between {LEAST:g} and {MOST:g}")
    return number


def _wrong(problem: str) -> PydanticCustomError:
    return PydanticCustomError("scene", "{problem}; allowed: {allowed}", {"problem": problem, "allowed": _ALLOWED})


_SHARE_SCHEMA = {"anyOf": [{"type": "number", "minimum": LEAST, "maximum": MOST}, {"type": "string"}]}
AskedAccuracy = Annotated[
    float | dict[str, float | str],
    BeforeValidator(_parsed),
    WithJsonSchema({"anyOf": [*_SHARE_SCHEMA["anyOf"], {"type": "object", "additionalProperties": _SHARE_SCHEMA}]}),
]


_DEVIATIONS = 'a table of keys with standard deviations, such as "oil.viscosity" = "5 %" or "contact.load" = "0.2 N"'


def _deviations(value: Any) -> dict[str, Any]:
    """Return standard deviations by dotted keys; tables in the table are parts of keys."""
    if not isinstance(value, Mapping) or not value:
        raise _no_deviations("is no table of keys")
    found: dict[str, Any] = {}
    for name, one in value.items():
        if isinstance(one, Mapping):
            found |= {f"{name}.{inner}": item for inner, item in _deviations(one).items()}
        elif isinstance(one, bool) or not isinstance(one, int | float | str):
            raise _no_deviations(f"{name} is no standard deviation")
        else:
            found[str(name)] = one
    return {key.replace('"', ""): one for key, one in found.items()}  # --set uncertain."a.b"=... leaves the quotes


def _no_deviations(problem: str) -> PydanticCustomError:
    return PydanticCustomError("scene", "{problem}; allowed: {allowed}", {"problem": problem, "allowed": _DEVIATIONS})


AskedUncertainty = Annotated[
    dict[str, Any],
    BeforeValidator(_deviations),
    WithJsonSchema(
        {
            "type": "object",
            "additionalProperties": {"anyOf": [{"type": "number"}, {"type": "string"}]},
            "minProperties": 1,
        }
    ),
]


Asked = str | float | Mapping[str, str | float]
"""Requested accuracy: `"1 %"`, 0.01 or a table of figures."""


def with_accuracy(settings: Sequence[str], accuracy: Asked | None) -> list[str]:
    """Settings of a scene (`key=value`), with the accuracy asked for where there is one."""
    if accuracy is None:
        return list(settings)
    if not isinstance(accuracy, Mapping):
        return [*settings, f"accuracy={_toml(accuracy)}"]
    table = ", ".join(f"{json.dumps(str(name))} = {_toml(share)}" for name, share in accuracy.items())
    return [*settings, f"accuracy={{{table}}}"]


def _toml(share: Any) -> str:
    return repr(float(share)) if isinstance(share, float | int) else json.dumps(str(share))


def figures_that_may_be_asked(record: type[Record], headline: Iterable[str]) -> dict[str, bool]:
    """Names under which figures of a record can be asked for, and whether `all` means them too: headline figures that
    follow no mesh."""
    first = set(headline)
    return {
        item.name or name: item.key(name) in first
        for name, item in described(record).items()
        if isinstance(item, Figure) and not (item.no_bar or item.unjudged or item.chance)
    }


def figures_that_may_not(record: type[Record]) -> dict[str, str]:
    """Return the reasons why no accuracy can be asked of the other figures of a record, by name."""
    return figures_of_chance(record) | {
        item.name or name: f"it has no error bar: {item.no_bar or _UNJUDGED}"
        for name, item in described(record).items()
        if isinstance(item, Figure) and (item.no_bar or item.unjudged)
    }


def figures_of_chance(record: type[Record], headline: Iterable[str] | None = None) -> dict[str, str]:
    """Return the parts of error bars that finer cells do not narrow, by figure; of all figures with bars, or of the
    headline figures."""
    shown = None if headline is None else set(headline)
    return {
        item.name or name: f"its error bar holds chance: {item.chance}"
        for name, item in described(record).items()
        if isinstance(item, Figure) and item.chance and (shown is None or item.key(name) in shown)
    }


_UNJUDGED = "none is made of counts, of what cells or solvers tell of themselves, of what is given"


def wanted(asked: float | Mapping[str, float | str], record: Record, headline: Iterable[str]) -> dict[str, float]:
    """The error that each figure of a record may have, by the names of its fields: of those that are named, and, where
    all are meant, of those headline figures that this case has and that have or could have an error bar."""
    table = asked if isinstance(asked, Mapping) else {ALL: asked}
    meant = figures_that_may_be_asked(type(record), headline)
    found: dict[str, float] = {}
    for field, item in described(type(record)).items():
        name = item.name or field if isinstance(item, Figure) else ""
        if name not in meant:
            continue
        own = table.get(name, table.get(ALL, ANY) if meant[name] and field in record.errors else ANY)
        if own != ANY and getattr(record, field) is not None:
            found[field] = float(own)
    return found


def shortfall(record: Record, wanted: Mapping[str, float]) -> dict[str, float]:
    """Error over what is asked for, by fields: met up to 1, infinite without an error bar.

    Errors count against the figure, or against the sum of those that it is a part of (`Figure.part_of`), and in lists
    over speeds against the largest there: what is next to nothing need not be known to a share of itself.
    Those of temperatures count against a rise, as they say, or 30 K if that is more.
    """
    return {name: relative_error(record, name) / share for name, share in wanted.items()}


_KELVINS = 30.0
"""Smallest rise that errors of temperatures count against [K]: over it an oil's viscosity falls to a third or less."""


def relative_error(record: Record, name: str) -> float:
    """The largest relative error of a figure of a record, infinite where it has none."""
    item = described(type(record))[name]
    assert isinstance(item, Figure)
    error, value = record.errors.get(name), getattr(record, name)
    if error is not None and item.optional and isinstance(value, np.ndarray):  # not all speeds have it
        error = np.where(np.isnan(value), 0.0, error)
    if error is None or not np.all(np.isfinite(error)):
        return math.inf
    whole = sum(np.abs(np.asarray(getattr(record, part))) for part in item.part_of or (name,))
    largest, worst = float(np.nanmax(whole, initial=0.0)), float(np.max(np.abs(error)))
    if item.unit in ("C", "K"):
        largest = max(largest, _KELVINS)
    return 0.0 if worst == 0 else worst / largest if largest > 0 else math.inf
