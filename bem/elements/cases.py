"""Many cases of one machine element from a table: each row changes keys of the element's file.

name, radial_load [kN], speed [rpm], oil.temperature [degC]
idle, 1, 800, 40
full, 6, 3000, 80
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from pydantic_core import PydanticCustomError

from bem.elements.bush_answer import bush_temperature, friction_power_of, wear_life
from bem.elements.element import Element, load_element, read_element
from bem.elements.plain_bush import PlainBushModel
from bem.errors import InputError
from bem.kinds.traction.along import columns_of
from bem.scenes.paths import parse_key, put
from bem.scenes.values import plain_value


def load_cases(source: str | Path, rows: str | Path) -> tuple[Element, ...]:
    """An element for each row of a text file with columns, units behind their names.

    Raises
    ------
    InputError : a file that is no such table; keys that the element does not have; one message per mistake.
    """
    table = read_element(source)
    known = [name for name in type(load_element(table).model).model_fields if name not in ("element", "oil")]
    known += ["oil.temperature", "oil.grade"] if isinstance(table.get("oil"), Mapping) else []
    try:
        columns = columns_of(str(rows), known, ())
    except PydanticCustomError as error:
        raise InputError(error.message()) from None
    found, messages = [], []
    for number, values in enumerate(zip(*columns.values(), strict=True), 1):
        case = {**table, "name": f"{table['name']}-{number}"}
        for name, value in zip(columns, values, strict=True):
            key = parse_key(name)
            assert key is not None
            put(case, key, value if name == "name" else plain_value(value))
        try:
            found.append(load_element(case))
        except InputError as error:
            messages += [f"row {number} of {rows}: {text}" for text in error.messages]
    if messages:
        raise InputError(messages)
    return tuple(found)


def columns(cases: Sequence[Element]) -> dict[str, list[float | str]]:
    """A row for each case: the highest load and pressure, the thinnest film and that over the roughness."""
    found: dict[str, list[float | str]] = {"case": [one.model.name for one in cases]}
    worst = [one.worst() for one in cases]
    found["worst"] = [contact.name for contact in worst]
    found["load [N]"] = [max(contact.load for contact in one.found.contacts) for one in cases]
    found["hertz_pressure [Pa]"] = [
        contact.hertz(one.modulus).maximum_pressure for one, contact in zip(cases, worst, strict=True)
    ]
    bushes = [one.model for one in cases if isinstance(one.model, PlainBushModel)]
    if bushes:
        found["peak_pressure [Pa]"] = [one.conforming.maximum_pressure for one in bushes]
        found["mean_pressure [Pa]"] = [one.mean_pressure for one in bushes]
        found["sliding_speed [m/s]"] = [one.sliding_speed for one in bushes]
        found["pv [Pa*m/s]"] = [one.mean_pressure * one.sliding_speed for one in bushes]
        if all(one.oil is None or one.friction is not None for one in bushes):  # else friction is that of films
            power = [friction_power_of(one, None)[0] for one in bushes]
            found["friction_power [W]"] = [math.nan if each is None else each for each in power]
            found["bush_temperature [K]"] = [
                math.nan if each is None else bush_temperature(one, each)
                for one, each in zip(bushes, power, strict=True)
            ]
        if all(one.specific_wear_rate for one in bushes):
            found["wear_life [h]"] = [wear_life(one)[1] for one in bushes]
        del found["hertz_pressure [Pa]"]
    if all("minimum_film [m]" in one.columns() for one in cases):
        films = [min(one.columns()["minimum_film [m]"]) for one in cases]
        found["minimum_film [m]"] = list(films)
        if all(one.model.rms_roughness is not None for one in cases):
            found["film_over_roughness"] = [min(one.columns()["film_over_roughness"]) for one in cases]
    return found
