"""Many cases of one machine element from a table: each row changes keys of the element's file.

name, radial_load [kN], speed [rpm], oil.temperature [degC]
idle, 1, 800, 40
full, 6, 3000, 80

Keys of tables are dotted, such as oil.base. An empty cell takes a key of the file out; a grade with a base of its own
(PAO 10) does so with the base of the file's oil.
"""

from __future__ import annotations

import math
import re
from collections.abc import Hashable, Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import Any, get_args

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from bem.elements.answer import FORMULA_FILMS, film_of_bush, least_film_ratio, likely_power, place_words, unsolved_ratio
from bem.elements.bearing_life import bearing_life, life_of_film
from bem.elements.bush_answer import JOURNAL, bush_temperature, friction_power_of, journal_of, wear_life
from bem.elements.element import Element, load_element, read_element
from bem.elements.gear_pair import GearModel
from bem.elements.gear_scuffing import friction_of_gear_tests, scuffing_of
from bem.elements.plain_bush import PlainBushModel
from bem.elements.rating_life import hours
from bem.elements.rolling_bearing import BearingModel
from bem.elements.running import Running
from bem.errors import InputError
from bem.kinds.traction.along import columns_of
from bem.lubrication.oils.catalogue import find_oil
from bem.notes import Note
from bem.notes.checks import SLOPES_LARGE
from bem.notes.merge import identity, merge
from bem.scenes.paths import Key, parse_key, put, value_at
from bem.scenes.values import plain_value

_LOADS = ("radial_load", "torque")
"""Keys that hertz_pressure stands in place of."""


def load_cases(source: str | Path, rows: str | Path) -> tuple[Element, ...]:
    """Return an element for each row of a text file with columns, units behind their names.

    Raises
    ------
    InputError : a file that is no such table; keys that the element does not have; one message per mistake.
    """
    table = read_element(source)
    columns = _columns_of(table, rows)
    found, messages = [], []
    for number, values in enumerate(zip(*columns.values(), strict=True), 1):
        case = {key: value for key, value in table.items() if not _replaced(key, columns)}
        case["name"] = f"{table['name']}-{number}"
        for name, value in zip(columns, values, strict=True):
            key = parse_key(name)
            assert key is not None
            if value:
                put(case, key, value if name == "name" else plain_value(value))
            else:
                _take_out(case, key)
        if "oil.grade" in columns:
            _drop_base(case, columns)
        try:
            found.append(load_element(case))
        except InputError as error:
            messages += [f"row {number} of {rows}: {_of_cells(text, columns)}" for text in error.messages]
    if messages:
        raise InputError(messages)
    return tuple(found)


def _of_cells(text: str, columns: Mapping[str, object]) -> str:
    """Return a mistake in an oil that has its own base in words of the table: its cells are left empty."""
    cells = [name for name in ("oil.base", "oil.viscosity_index") if name in columns]
    if not cells or "has its own" not in text:
        return text
    said = f"leave the cell{'s' if len(cells) > 1 else ''} of {' and '.join(cells)} empty"
    return re.sub("leave (them|base = .*?) out", said, text)


def _replaced(key: str, columns: Mapping[str, object]) -> bool:
    """Return True for a key of the file in whose place a column gives the load: pressure for load or the reverse."""
    return key not in columns and any(
        key in (load, "hertz_pressure") and (load in columns or "hertz_pressure" in columns) for load in _LOADS
    )


def _take_out(case: dict[str, Any], key: Key) -> None:
    """Remove a key, in place, whose cell is empty; tables on the way are copied first, as by `put`."""
    if value_at(case, key) is None:
        return
    put(case, key, None)
    value_at(case, key[:-1]).pop(key[-1])


def _drop_base(case: dict[str, Any], columns: Mapping[str, Any]) -> None:
    """Remove base and viscosity index of the file's oil, in place, where the row's grade has its own."""
    for base in ("mineral", "pag"):  # at most one of both is that of the grade
        try:
            find_oil(str(case["oil"]["grade"]), base=base)
        except InputError as error:
            if "has its own" in str(error):
                for name in ("base", "viscosity_index"):
                    if f"oil.{name}" not in columns:
                        _take_out(case, ("oil", name))
                return


def _keys_of(model: type[BaseModel], prefix: str = "") -> list[str]:
    """Return the keys of a table and of the tables in it, dotted."""
    found = []
    for name, field in model.model_fields.items():
        found.append(f"{prefix}{name}")
        for one in (field.annotation, *get_args(field.annotation)):
            if isinstance(one, type) and issubclass(one, BaseModel):
                found += _keys_of(one, f"{prefix}{name}.")
    return found


def changed_keys(source: str | Path, rows: str | Path) -> dict[str, list[str]]:
    """Return the columns of a text file of cases as they stand there, each number with its unit; without their names.

    Raises
    ------
    InputError : as `load_cases`, of the file and its columns.
    """
    return {key: values for key, values in _columns_of(read_element(source), rows).items() if key != "name"}


def _columns_of(table: Mapping[str, Any], rows: str | Path) -> dict[str, list[str]]:
    known = [name for name in _keys_of(type(load_element(table).model)) if name not in ("element", "oil")]
    try:
        return columns_of(str(rows), known, (), 1)
    except PydanticCustomError as error:
        keys = "keys of the element's file, or name"
        said = error.message().replace(", ".join(known), keys)
        raise InputError(said.replace(f"with columns {keys}", f"whose columns are {keys}")) from None


def columns(
    cases: Sequence[Element],
    runs: Sequence[Sequence[Running]] = (),
    changed: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> dict[str, list[float | str]]:
    """Return a row for each case: the contact of highest pressure, that of the thinnest film, power, lives, safeties.

    `worst` names the contact of `load` and `hertz_pressure`, `thinnest` that of the film and lambda ratio after it:
    by the formula, or with solved films `thinnest_by_formula` and `thinnest`.

    Parameters
    ----------
    cases : elements, with their heat balanced where `runs` are given.
    runs : solved films of each case; none at all leaves out what follows from films.
    changed : `changed_keys`, shown beside the names of cases.
    """
    found: dict[str, list[float | str]] = {"case": [one.model.name for one in cases]}
    found |= {key: list(values) for key, values in changed.items()}
    worst = [one.critical() for one in cases]
    found["worst"] = [place_words(one, contact) for one, contact in zip(cases, worst, strict=True)]
    found["load [N]"] = [contact.carried for contact in worst]
    found["hertz_pressure [Pa]"] = [
        contact.hertz(one.modulus).maximum_pressure for one, contact in zip(cases, worst, strict=True)
    ]
    bushes = [one.model for one in cases if isinstance(one.model, PlainBushModel)]
    if bushes:
        found["peak_pressure [Pa]"] = [one.shaft_contact.maximum_pressure for one in bushes]
        found["mean_pressure [Pa]"] = [one.mean_pressure for one in bushes]
        found["sliding_speed [m/s]"] = [one.sliding_speed for one in bushes]
        found["pv [Pa*m/s]"] = [one.mean_pressure * one.sliding_speed for one in bushes]
        if runs:
            found |= _known(_rubbing(cases, runs))
        elif all(one.oil is None or one.friction is not None for one in bushes):  # else friction is that of films
            found |= _rubbing_dry(bushes)
        if all(one.specific_wear_rate for one in bushes):
            found["wear_life [h]"] = [wear_life(one)[1] for one in bushes]
        del found["hertz_pressure [Pa]"]
    if all("minimum_film [m]" in one.columns() for one in cases):
        found |= _films_by_formula(cases, "thinnest_by_formula" if runs else "thinnest")
        for name in FORMULA_FILMS:
            for row, own in enumerate(runs):
                if name in found and any(one.impossible_film for one in own):
                    found[name][row] = math.nan
    if runs:
        known = [[one for one in each if one.converged] for each in runs]
        if all(known):
            found |= _known(_solved(cases, known))
    return found | _known(_lives(cases, runs))


def notes_of_cases(by_case: Sequence[Sequence[Note]]) -> list[Note]:
    """Return the notes of several cases, each once with its rows.

    Where the positions of a note differ between its rows, their smallest and largest number stand for them. The names
    of the places where contacts are wide for their bodies are left out where they differ.

    by_case : notes of each case, those of its films with their positions as `bem.elements.running.notes`.
    """

    def anywhere(note: Note) -> Note:
        counted = re.match(r"at \d+ of \d+ positions", note.where)
        return Note(note.code, note.level, note.values, "", note.texts) if counted else note

    wide = [note for note in chain.from_iterable(by_case) if _is_of_wide_places(note)]
    if len({(note.values["first"], note.values["others"]) for note in wide}) > 1:
        by_case = [[_at_some_places(one) if _is_of_wide_places(one) else one for one in each] for each in by_case]
    places: dict[Hashable, set[str]] = {}
    for note in chain.from_iterable(by_case):
        places.setdefault(identity(anywhere(note)), set()).add(note.where)

    def of_rows(note: Note) -> Note:
        anywhere_in_it = anywhere(note)
        different = places[identity(anywhere_in_it)]
        return anywhere_in_it.at(_position_range(different)) if len(different) > 1 else note

    whole = [[of_rows(one) for one in each] for each in by_case]
    return merge(whole, lambda rows: f"row{'s' if len(rows) > 1 else ''} {', '.join(str(row + 1) for row in rows)}")


def _position_range(places: Iterable[str]) -> str:
    """Return "at 2 to 5 of 12 positions" of places "at 2 of 12 positions" and the like; an empty one is all."""
    counted = [re.match(r"at (\d+) of (\d+) positions", place) for place in places]
    of = {int(found[2]) for found in counted if found}
    if len(of) != 1:
        return "at some positions"
    (number,) = of
    at = [int(found[1]) if found else number for found in counted]
    least = "" if min(at) == max(at) else f"{min(at)} to "
    return f"at {least}{max(at)} of {number} positions"


def _is_of_wide_places(note: Note) -> bool:
    """Return True for the note on places of an element where contacts are wide for the radius of their bodies."""
    return note.code == SLOPES_LARGE.code and note.values["reason"] == "element"


def _at_some_places(note: Note) -> Note:
    """Return a note on wide contacts without the names of their places."""
    return SLOPES_LARGE(note.where, **{**note.values, "first": "some places", "others": ""})


def power_source(cases: Sequence[Element]) -> str:
    """Return in words what the friction power of cases is of; empty for bushes and where cases differ."""
    found = set()
    for one in cases:
        if isinstance(one.model, PlainBushModel):
            return ""
        if isinstance(one.model, GearModel) and friction_of_gear_tests(one) is not None:
            found.add("Schlenk's fit")
        elif isinstance(one.model, BearingModel) or one.model.rms_roughness is None:
            found.add("oil films")
        else:
            found.add("with asperities")
    return found.pop() if len(found) == 1 else ""


def _rubbing(cases: Sequence[Element], runs: Sequence[Sequence[Running]]) -> dict[str, list[float | str]]:
    """Return friction and temperature of lubricated bushes as the answer has them, not a number without a film."""
    found: dict[str, list[float | str]] = {
        "friction_coefficient": [],
        "friction_power [W]": [],
        "asperity_load_share": [],
        "bush_temperature [K]": [],
        JOURNAL: [],
    }
    for case, own in zip(cases, runs, strict=True):
        model = case.model
        assert isinstance(model, PlainBushModel)
        film = film_of_bush(case, [one for one in own if one.converged])
        power = friction_power_of(model, film)[0] if film is not None or model.friction is not None else None
        found["friction_coefficient"].append(_number(power) / (model.radial_load * model.sliding_speed))
        found["friction_power [W]"].append(_number(power))
        found["asperity_load_share"].append(film.asperity_share if film is not None and film.share_known else math.nan)
        found["bush_temperature [K]"].append(math.nan if power is None else bush_temperature(model, power))
        journal = None if film is None else journal_of(model, film)
        found[JOURNAL].append(math.nan if journal is None else journal.minimum_thickness)
    return found


def _rubbing_dry(bushes: Sequence[PlainBushModel]) -> dict[str, list[float | str]]:
    """Return friction and temperature of bushes without films, not a number where no friction is known."""
    power = [friction_power_of(one, None)[0] for one in bushes]
    both = list(zip(bushes, power, strict=True))
    return {
        "friction_coefficient": [_number(each) / (one.radial_load * one.sliding_speed) for one, each in both],
        "friction_power [W]": [_number(each) for each in power],
        "bush_temperature [K]": [math.nan if each is None else bush_temperature(one, each) for one, each in both],
    }


def _known(columns: Mapping[str, list[float | str]]) -> dict[str, list[float | str]]:
    """Return the columns in which a value is known."""
    return {
        name: values
        for name, values in columns.items()
        if not all(isinstance(one, float) and math.isnan(one) for one in values)
    }


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _films_by_formula(cases: Sequence[Element], name: str) -> dict[str, list[float | str]]:
    """Return the contact of the thinnest film by the formula, with that film and its lambda ratio."""
    films = [one.columns()["minimum_film [m]"] for one in cases]
    rows = [film.index(min(film)) for film in films]
    at = list(zip(cases, rows, strict=True))
    found: dict[str, list[float | str]] = {name: [place_words(one, one.found.contacts[row]) for one, row in at]}
    found["minimum_film [m]"] = [film[row] for film, row in zip(films, rows, strict=True)]
    if all(one.model.rms_roughness is not None for one in cases):
        found["film_over_roughness"] = [one.columns()["film_over_roughness"][row] for one, row in at]
    return found


def _solved(cases: Sequence[Element], runs: Sequence[Sequence[Running]]) -> dict[str, list[float | str]]:
    """Return what follows from the solved films: the thinnest one, friction power, safeties of gears."""
    thinnest = [min(each, key=lambda one: one.minimum_film) for each in runs]
    both = list(zip(cases, runs, strict=True))
    found: dict[str, list[float | str]] = {
        "thinnest": [place_words(case, one.contact) for case, one in zip(cases, thinnest, strict=True)],
        "solved_minimum_film [m]": [one.minimum_film for one in thinnest],
        "solved_film_over_roughness": [_number(one.film_ratio) for one in thinnest],
    }
    if not any(isinstance(one.model, PlainBushModel) for one in cases):  # whose columns stand beside pressure
        found["bulk_temperature [K]"] = [_number(one.model.bulk_temperature) for one in cases]
        found["friction_power [W]"] = [likely_power(case, each) for case, each in both]
    if all(isinstance(one.model, GearModel) for one in cases):
        scuffing = [scuffing_of(case, each) for case, each in both]
        found["scuffing_safety_contact_temperature"] = [
            math.nan if one is None else _number(one.contact_safety) for one in scuffing
        ]
        found["scuffing_safety_integral_temperature"] = [
            math.nan if one is None else _number(one.integral_safety) for one in scuffing
        ]
    found["micropitting_safety"] = [
        _number(one.film_ratio) / _number(case.model.permissible_film_ratio)
        if (unsolved := unsolved_ratio(case)) is None or unsolved[0] >= _number(one.film_ratio)
        else math.nan
        for case, one in zip(cases, thinnest, strict=True)
    ]
    return found


def _lives(cases: Sequence[Element], runs: Sequence[Sequence[Running]]) -> dict[str, list[float | str]]:
    """Return rating lives and static safety of bearings; nothing of other elements.

    Modified lives are those to be used: with the viscosity ratio of the solved film where surfaces are rougher than
    usual, which is then in a column of its own.
    """
    models = [one.model for one in cases if isinstance(one.model, BearingModel)]
    if not models:
        return {}
    lives = [bearing_life(one) for one in cases]
    of_film = [
        life_of_film(one, least_film_ratio(each)) for one, each in zip(cases, runs or [()] * len(cases), strict=True)
    ]
    used = [life if film is None else film for life, film in zip(lives, of_film, strict=True)]

    def in_hours(revolutions: Sequence[float | None]) -> list[float | str]:
        return [hours(_number(life), one.speed) for life, one in zip(revolutions, models, strict=True)]

    return {
        "viscosity_ratio": [_number(life.rating.viscosity_ratio) for life in lives],
        "viscosity_ratio_of_film": [
            math.nan if one is None else _number(one.rating.viscosity_ratio) for one in of_film
        ],
        "basic_life [h]": in_hours([life.rating.basic for life in lives]),
        "modified_life [h]": in_hours([life.rating.modified for life in used]),
        "reference_life [h]": in_hours([life.reference.basic for life in lives]),
        "modified_reference_life [h]": in_hours([life.modified_reference for life in used]),
        "static_safety": [life.static_rating / life.static_load for life in lives],
    }
