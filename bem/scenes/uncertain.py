"""Uncertain inputs of a scene: standard deviations of numbers at dotted keys.

    uncertain = { "oil.viscosity" = "5 %", "contact.load" = "0.2 N" }

A relative deviation is of the value at the key; of a list all entries change alike. Parameters of laws are keys as in
the file: in the law's table, or beside it where the scene takes them there. Knows keys, numbers and units;
verified in tests/scenes/test_uncertain.py.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from bem.arguments import did_you_mean
from bem.errors import InputError
from bem.laws import Law
from bem.scenes.laws import LawTable
from bem.scenes.paths import parse_key
from bem.scenes.units import Dimension
from bem.scenes.walk import Key, keys_of, own_keys

_NUMBER = Dimension("", "a number", "0.01")
_HARDNESSES = ("lower.material.hardness", "upper.material.hardness")
"""Keys whose values a resolved scene has copied into `contact.hardness`."""


def value_of(scene: BaseModel, key: str) -> Any:
    """Return the value at a dotted key of a scene; None if there is none."""
    place: Any = scene
    for part in parse_key(key) or ("",):
        place = _value_in(place, part)
    return place


def has_number(scene: BaseModel, key: str) -> bool:
    """Return True if there is a quantity at a dotted key of a scene."""
    return bool(_numbers(value_of(scene, key)))


def _value_in(place: Any, part: str | int) -> Any:
    """Return the value at one part of a key in a table, law or list; None if there is none."""
    if isinstance(part, int):
        return place[part] if isinstance(place, list | tuple) and part < len(place) else None
    if isinstance(place, Law):
        return place.values().get(part)
    if not isinstance(place, BaseModel):
        return None
    law = _law_beside(place, part)
    return getattr(place, part, None) if law is None else getattr(getattr(place, law), part)


def _law_beside(table: BaseModel, name: str) -> str | None:
    """Return the key of the law of a table whose parameter may stand beside it under a name; None if there is none."""
    if not isinstance(table, LawTable) or name in type(table).model_fields:
        return None
    return next((key for key in type(table).law_keys() if name in getattr(table, key).parameters()), None)


def _keys_of_numbers(model: BaseModel, before: str = "") -> Iterator[str]:
    """Yield the dotted keys of a scene whose values are quantities, not whole numbers or names."""
    for name in type(model).model_fields:
        value = getattr(model, name)
        if isinstance(value, BaseModel):
            yield from _keys_of_numbers(value, f"{before}{name}.")
        elif isinstance(value, Law):
            beside = {one: _law_beside(model, one) == name for one in value.parameters()}
            yield from (
                f"{before}{one}" if beside[one] else f"{before}{name}.{one}"
                for one, item in value.values().items()
                if _numbers(item)
            )
        elif isinstance(value, list | tuple) and value and all(isinstance(one, BaseModel) for one in value):
            for number, one in enumerate(value):
                yield from _keys_of_numbers(one, f"{before}{name}[{number}].")
        elif _numbers(value):
            yield before + name


def deviation(scene: BaseModel, key: str, given: str | float, unit: str) -> float:
    """Return the standard deviation of the value at a key, in SI units; of a list that of an entry of size one, if
    relative.

    unit : SI unit of the value, "" for none.

    Raises
    ------
    InputError : a key that holds no real number, or a deviation that is none.
    """
    numbers = _numbers(value_of(scene, key))
    if key in _HARDNESSES:
        raise InputError(f'uncertain."{key}": the model takes contact.hardness; allowed: "contact.hardness"')
    if not numbers:
        other = key.replace(".layer.", ".layers[0].") if ".layer." in key else key.replace(".layers[0].", ".layer.")
        found_there = other != key and _numbers(value_of(scene, other))
        known = list(_keys_of_numbers(scene))
        numbered = next((one for one in known if re.sub(r"\[\d+\]", "", one) == key), None)
        other = numbered or other
        hint = f' - did you mean "{other}"?' if numbered or found_there else did_you_mean(key, known)
        raise InputError(
            f'uncertain."{key}": no quantity is set there; allowed: a dotted key of the scene whose value is a '
            f"quantity, not a whole number or a name, such as contact.load{hint}"
        )
    text = str(given).strip()
    if text.endswith("%") and not any(numbers):
        raise InputError(
            f'uncertain."{key}" = {given}: the value is 0, so a share of it is none; allowed: an absolute '
            f'deviation, such as "{_example_at(scene, key)}"'
        )
    try:
        if text.endswith("%"):
            found = _NUMBER.parse(text) * max(map(abs, numbers))
        else:
            found = Dimension(unit, "a standard deviation", f"0.1 {unit}".strip()).parse(given)
    except PydanticCustomError as error:
        raise InputError(f'uncertain."{key}" = {given}: {error.message()}, or a relative one such as "5 %"') from None
    if not (math.isfinite(found) and found > 0):
        raise InputError(f'uncertain."{key}": {given} is not a positive standard deviation')
    return found


def deviations(scene: Any) -> dict[str, float]:
    """Return the standard deviations of a scene by its keys, in SI units; of lists that of the largest entry.

    Raises
    ------
    InputError : one message for each key that holds no number or deviation that is none.
    """
    found: dict[str, float] = {}
    messages: list[str] = []
    for key, given in (scene.uncertain or {}).items():
        try:
            found[key] = deviation(scene, key, given, _unit_at(scene, key))
        except InputError as error:
            messages += error.messages
    if messages:
        raise InputError(messages)
    return found


def _unit_at(scene: BaseModel, key: str) -> str:
    """Return the SI unit of the value at a key, "" for none."""
    found = _key_at(scene, key)
    return "" if found is None else found.unit


def _example_at(scene: BaseModel, key: str) -> str:
    """Return a tenth of a key's typical value as an example of a deviation, such as "0.2 GPa"."""
    found = _key_at(scene, key)
    assert found is not None
    assert found.dimension is not None
    number, _, unit = str((found.field.examples or [found.dimension.example])[0]).partition(" ")
    return f"{0.1 * abs(float(number)):g} {unit}".strip()


def _key_at(scene: BaseModel, key: str) -> Key | None:
    """Return the last key of a dotted key; None if there is none."""
    place: Any = scene
    found: Key | None = None
    for part in parse_key(key) or ():
        if isinstance(part, str) and isinstance(place, BaseModel | Law):
            law = None if isinstance(place, Law) else _law_beside(place, part)
            owner = place if law is None else getattr(place, law)
            known = keys_of(type(owner)) if isinstance(owner, Law) else own_keys(type(owner))
            found = next((one for one in known if one.name == part), None)
        place = _value_in(place, part)
    return found


def _numbers(value: Any) -> list[float]:
    """Return the numbers of a value: one, or those of a list; none of what is no real number."""
    if isinstance(value, list | tuple):
        found = [_numbers(item) for item in value]
        return [number for each in found for number in each] if all(found) else []
    return [float(value)] if isinstance(value, float) else []


def moved(scene: Any, key: str, deviation: float, steps: float) -> Any:
    """Return the scene with the value at a key changed by so many deviations; of a list in proportion to its entries.

    deviation : of the largest entry.
    """
    parts, value = parse_key(key), value_of(scene, key)
    assert parts is not None
    return _put(scene, parts, _shifted(value, deviation, steps))


def _shifted(value: Any, deviation: float, steps: float) -> Any:
    if isinstance(value, list | tuple):
        largest = max(abs(number) for number in _numbers(value)) or 1.0
        return type(value)(
            _shifted(item, deviation * (max(map(abs, _numbers(item))) / largest), steps) for item in value
        )
    return value + steps * deviation


def _put(place: Any, parts: Sequence[str | int], value: Any) -> Any:
    """Return a copy of a table or list with another value at a place."""
    if not parts:
        return value
    first, rest = parts[0], parts[1:]
    if isinstance(first, int):
        items = list(place)
        items[first] = _put(items[first], rest, value)
        return type(place)(items)
    if isinstance(place, Law):
        return dataclasses.replace(place, **{first: _put(getattr(place, first), rest, value)})
    law = _law_beside(place, first)
    if law is not None:
        return _put(place, (law, *parts), value)
    return place.model_copy(update={first: _put(getattr(place, first), rest, value)})


def relative_step(scene: BaseModel, key: str, deviation: float, relative: float) -> float:
    """Return the number of deviations that changes the value at a key by a relative amount; at most one deviation."""
    largest = max(map(abs, _numbers(value_of(scene, key))), default=0.0)
    return min(1.0, relative * largest / deviation) if largest > 0 else relative
