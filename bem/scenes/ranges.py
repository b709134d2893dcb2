"""Keys of a scene that run over several values: what `--over key=...` and the table `[over]` mean."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic_core import PydanticCustomError

from bem.errors import InputError
from bem.scenes.paths import parse_key, spell_key, values_in_file

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*?)\s*", re.DOTALL)
_MOST_VALUES = 100_000
_ALLOWED = (
    "key=first:last:count, key=log:first:last:count, key=first:last (whole numbers), key=value,value,... or key=@FILE "
    '(a value on each line); for example contact.load="1 N:10 N:4", contact.load="log:1 N:100 N:5", seed=1:5, '
    "variants[0].depths.count=8,16"
)


@dataclass(frozen=True)
class Axis:
    """A swept key.

    Attributes
    ----------
    key : dotted key of the scene, with indices into lists as in `variants[0].name`.
    values : what each point sets it to, as text of `bem run --set key=VALUE`.
    spacing : "list", "linear" or "logarithmic": how a figure shows it.
    """

    key: str
    values: tuple[str, ...]
    spacing: str = "list"


def parse_axes(texts: Sequence[str]) -> tuple[Axis, ...]:
    """Axes from the texts of `--over`.

    Raises
    ------
    InputError : one message per mistake.
    """
    axes: list[Axis] = []
    messages: list[str] = []
    for text in texts:
        try:
            axes.append(parse_axis(text))
        except InputError as error:
            messages += error.messages
    for key in dict.fromkeys(axis.key for axis in axes):
        if sum(axis.key == key for axis in axes) > 1:
            messages.append(f'--over "{key}": given more than once; allowed: one --over for each key')
    if not texts:
        messages.append(f"--over: missing; allowed: {_ALLOWED}")
    if math.prod(len(axis.values) for axis in axes) > _MOST_VALUES:
        messages.append(f"--over: more than {_MOST_VALUES} points; allowed: fewer values")
    if messages:
        raise InputError(messages)
    return tuple(axes)


def values_of_keys(table: Any) -> dict[str, list[Any]]:
    """The table `[over]` as dotted keys with their values: lists as they are, texts as the values of `--over`.

    Raises
    ------
    PydanticCustomError : no table, no values, the same twice.
    """
    if not isinstance(table, Mapping) or not table:
        raise _wrong("not a table of keys", 'such as "contact.load" = ["1 N", "2 N"]')
    found: dict[str, list[Any]] = {}
    for name, values in table.items():
        if isinstance(values, Mapping):
            found |= {f"{name}.{inner}": item for inner, item in values_of_keys(values).items()}
        elif isinstance(values, list | tuple) and values:
            if len({repr(value) for value in values}) < len(values):
                raise _wrong(f"{name} has the same value twice", "each value once")
            found[str(name)] = list(values)
        elif isinstance(values, str):
            try:
                found[str(name)] = list(parse_axis(f"{name}={values}").values)
            except InputError as error:
                raise _wrong(f"{name}: {error}", 'a list, or a range such as "1 N:10 N:4"') from None
        else:
            raise _wrong(f"{name} is no list of values", 'a list, or a range such as "1 N:10 N:4"')
    return found


def _wrong(problem: str, allowed: str) -> PydanticCustomError:
    return PydanticCustomError("scene", "{problem}; allowed: {allowed}", {"problem": problem, "allowed": allowed})


def parse_axis(text: str) -> Axis:
    """One axis: `key=a:b:n` (linear), `key=log:a:b:n`, `key=a:b` (whole numbers), `key=v1,v2,...` or `key=@FILE`.

    Raises
    ------
    InputError : it cannot be read, or values come twice.
    """
    name, equals, body = text.partition("=")
    parsed, body = parse_key(name), body.strip()
    if not equals or parsed is None or not body:
        raise _refused(text, "is not of the form key=values")
    key = spell_key(parsed)
    if body.startswith("@"):
        values = values_in_file(body[1:], f"--over {_shown(text)}")
        if len(values) > _MOST_VALUES:
            raise _refused(text, f"has more than {_MOST_VALUES} values")
        if len(set(values)) < len(values):
            raise _refused(text, "has the same value twice")
        return Axis(key, values)
    parts = [part.strip() for part in _split(body, ":")]
    spacing = "list"
    if len(parts) == 1:
        values = tuple(part.strip() for part in _split(body, ","))
        if not all(values):
            raise _refused(text, "has an empty value")
        if unit := _unit_of_last(values):
            each = ", ".join((*(f"{value} {unit}" for value in values[:-1]), values[-1]))
            raise InputError(
                f'--over "{_shown(text)}": only the last value has a unit, and a number alone is in the SI unit; '
                f'allowed: a unit at each, such as {key}="{each}"'
            )
    elif len(parts) == 2:
        first, last = _whole(parts[0]), _whole(parts[1])
        if first is None or last is None:
            raise _refused(text, "a range of two is for whole numbers")
        if abs(last - first) >= _MOST_VALUES:
            raise _refused(text, f"has more than {_MOST_VALUES} values")
        values = tuple(str(i) for i in range(first, last + (1 if last >= first else -1), 1 if last >= first else -1))
        spacing = "linear"
    else:
        logarithmic = parts[0].lower() == "log"
        spacing = "logarithmic" if logarithmic else "linear"
        values = _range(text, parts[1:] if logarithmic else parts, logarithmic)
    if len(set(values)) < len(values):
        raise _refused(text, "has the same value twice")
    return Axis(key, values, spacing)


def _unit_of_last(values: Sequence[str]) -> str:
    """Return the unit of the last value where it alone has one and numbers other than zero stand before it."""
    from bem.scenes.units import _unit

    found = [_NUMBER.fullmatch(value) for value in values]
    if len(found) < 2 or None in found:
        return ""
    *before, last = (match.groups() for match in found if match is not None)
    if not last[1] or any(unit for _, unit in before) or not any(float(number) for number, _ in before):
        return ""
    try:
        _unit(last[1])
    except LookupError:
        return ""
    return last[1]


def _range(text: str, parts: Sequence[str], logarithmic: bool) -> tuple[str, ...]:
    if len(parts) != 3:
        raise _refused(text, "is not first:last:count")
    ends = [_NUMBER.fullmatch(part) for part in parts[:2]]
    count = _whole(parts[2])
    if ends[0] is None or ends[1] is None:
        raise _refused(text, "has an end that is not a number or a number with a unit")
    if count is None or not 2 <= count <= _MOST_VALUES:
        raise _refused(text, f"has a count {parts[2]!r} that is not a whole number of 2 or more")
    (low_text, low_unit), (high_text, high_unit) = ends[0].groups(), ends[1].groups()
    unit = low_unit or high_unit
    low, high = float(low_text), float(high_text)
    if low_unit and high_unit and low_unit != high_unit:
        high *= _ratio(text, high_unit, low_unit)
    if logarithmic and not (low > 0 and high > 0):
        raise _refused(text, "is logarithmic with an end that is not positive")
    exponent = [i / (count - 1) for i in range(count)]
    if logarithmic:
        numbers = [math.exp(math.log(low) * (1 - s) + math.log(high) * s) for s in exponent]
    else:
        numbers = [low * (1 - s) + high * s for s in exponent]
    # twelve digits: what a person would have typed, without the last bits of exp and log
    numbers = [low, *(float(f"{number:.12g}") for number in numbers[1:-1]), float(f"{high:.12g}")]
    whole = all(number == int(number) and abs(number) < 2**53 for number in numbers)
    plain = [str(int(number)) if whole and _is_whole_text(low_text, high_text) else repr(number) for number in numbers]
    return tuple(f"{number} {unit}".rstrip() for number in plain)


def _ratio(text: str, unit: str, other: str) -> float:
    """Return the number of `other` in one `unit`."""
    from bem.scenes.units import _unit

    try:
        (kind, factor), (other_kind, other_factor) = _unit(unit), _unit(other)
    except LookupError as error:
        raise _refused(text, f"has the unknown unit {str(error)[:40]!r}") from None
    if kind != other_kind:
        raise _refused(text, f"has ends of different dimensions ({unit}, {other})")
    if "deg" in (unit + other).lower() or "°" in unit + other:
        raise _refused(text, "mixes temperature scales")
    return float(factor / other_factor)


def _is_whole_text(*texts: str) -> bool:
    return all(_whole(text) is not None for text in texts)


def _whole(text: str) -> int | None:
    return int(text) if re.fullmatch(r"[+-]?\d{1,18}", text) else None


def _split(text: str, separator: str) -> list[str]:
    """Parts between separators that stand outside quotes and brackets."""
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in "[{(":
            depth += 1
        elif character in "]})":
            depth -= 1
        if character == separator and not quote and depth <= 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def _refused(text: str, why: str) -> InputError:
    return InputError(f"--over {_shown(text)}: {why}; allowed: {_ALLOWED}")


def _shown(text: str) -> str:
    return json.dumps(text[:80], ensure_ascii=False)
