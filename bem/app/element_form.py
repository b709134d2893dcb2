"""The form of a machine element and its answer, without a page: fields of the template, answer of a filled form.

Verified in tests/app/test_element_form.py.
"""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.elements.answer import PLACES, all_notes, answer, balance_heat, table_columns
from bem.elements.element import MODELS, Element, element_template, load_element
from bem.elements.figure import element_figure
from bem.elements.running import Running, run_all
from bem.errors import InputError
from bem.notes import Level
from bem.scenes.edit import table_text
from bem.scenes.oil import OilScene
from bem.scenes.paths import parse_key, put
from bem.scenes.values import plain_value

_LINE = re.compile(
    r'(?P<off># )?(?P<key>[a-z_0-9]+) = (?P<value>"[^"]*"|\[.*?\]|\{.*?\}|[^#]*?)\s*(#\s*(?P<words>.*))?'
)
_HEAD = re.compile(r"\[(?P<name>[a-z_]+)\]")

_MORE = {
    "length": "of rollers, such as 12 mm",
    "pitch_diameter": "such as 60 mm; without it the mean of bore and outside",
    "hertz_pressure": "such as 1.2 GPa, in place of the load or torque: on the inner ring, or at the pitch point",
    "fatigue_load_limit": "such as 0.8 kN; C_u, without it from C0",
    "contamination_factor": "such as 0.5; e_C in place of cleanliness",
    "reliability": "such as 95; in per cent, 90 without it",
    "profile": "such as straight; of rollers, logarithmic without it",
    "structure_factor": "such as 0.8; X_W of the steel for scuffing, 1 for case-hardened",
    "boundary_friction": "such as 0.10; of asperity contacts, 0.12 without it",
    "oil.base": "such as pao, ester, pag; mineral without it",
    "oil.pressure_viscosity": "such as 20 1/GPa; without it that of the oil",
}
"""Keys that templates do not name, with their meaning."""


@dataclass(frozen=True)
class Field:
    """A field of the form.

    Attributes
    ----------
    key : dotted key of the element's file.
    value : as a user types it; empty for a key that the template leaves out.
    words : meaning, and an example of a key that is left out.
    basic : True for a key that the template names.
    """

    key: str
    value: str
    words: str
    basic: bool


@dataclass(frozen=True)
class Answered:
    """Answer to a filled form.

    Attributes
    ----------
    rows : name and words of each result. sentences : figures of the geometry. cautions, remarks : texts of notes.
    picture : the figure as PNG. table : all contacts as comma-separated text.
    """

    rows: tuple[tuple[str, str], ...]
    sentences: tuple[str, ...]
    cautions: tuple[str, ...]
    remarks: tuple[str, ...]
    picture: bytes
    table: str


def fields_of(name: str) -> list[Field]:
    """Return the fields of an element: the keys of its template in their order, then those that it comments out.

    Raises
    ------
    InputError : a name of no element.
    """
    found, inside = [], ""
    for line in element_template(name).splitlines():
        if head := _HEAD.match(line):
            inside = head["name"] + "."
        elif (entry := _LINE.fullmatch(line)) and entry["key"] != "element":
            example, words = entry["value"].strip(), entry["words"] or ""
            basic = entry["off"] is None
            typed = example.strip('"') if example.startswith('"') else example
            if not basic:
                words = f"such as {typed}; {words}".removesuffix("; ")
            found.append(Field(inside + entry["key"], typed if basic else "", words, basic))
    named = {field.key for field in found}
    known = {*MODELS[name].model_fields, *(f"oil.{key}" for key in OilScene.model_fields)}
    found += [Field(key, "", words, False) for key, words in _MORE.items() if key in known - named]
    return sorted(found, key=lambda field: not field.basic)


def table_of(name: str, typed: Mapping[str, str]) -> dict[str, Any]:
    """Return the table of an element from what is typed by dotted key; empty fields are left out."""
    table: dict[str, Any] = {"element": name, "name": name}
    for key, text in typed.items():
        parsed = parse_key(key)
        if text.strip() and parsed is not None:
            put(table, parsed, plain_value(text))
    return table


def file_of(name: str, typed: Mapping[str, str]) -> str:
    """Return the filled form as the text of an element's file."""
    return table_text(table_of(name, typed))


def answered(name: str, typed: Mapping[str, str], *, whole: bool = False) -> Answered:
    """Answer a filled form.

    whole : solve the films of all places, not of a selection.

    Raises
    ------
    InputError : one message per mistake.
    """
    element = balance_heat(load_element(table_of(name, typed)))
    runs: tuple[Running, ...] = ()
    if element.model.oil is not None:
        runs = run_all(element, most=None if whole else PLACES)
    every = all_notes(element, runs)
    cautions = tuple(str(note) for note in every if note.level is not Level.INFO)
    remarks = tuple(str(note) for note in every if note.level is Level.INFO)
    picture = io.BytesIO()
    element_figure(element, runs).savefig(picture, format="png", dpi=120)
    table = element.csv(table_columns(element, runs))
    return Answered(answer(element, runs), element.found.geometry, cautions, remarks, picture.getvalue(), table)


def scene_of_form(name: str, typed: Mapping[str, str], kind: str = "traction") -> str:
    """Return a scene of a filled form.

    kind : "traction", the film along the path of contact or of the most loaded contact, or another kind of
        `bem.elements.element.KINDS` of the most loaded contact.

    Raises
    ------
    InputError : one message per mistake.
    """
    element = balance_heat(load_element(table_of(name, typed)))
    along = kind == "traction" and element.found.along_unit == "m"
    return table_text(element.path_scene() if along else most_loaded_scene(element, kind))


def most_loaded_scene(element: Element, kind: str = "traction") -> dict[str, Any]:
    """Return the scene of the contact with the highest pressure, of those that a steady film can have.

    Raises
    ------
    InputError : no contact has a steady film; the mistake of the most loaded contact where all have one.
    """
    mistakes: list[InputError] = []
    for contact in sorted(element.found.contacts, key=lambda one: -one.hertz(element.modulus).maximum_pressure):
        try:
            return element.scene(contact, kind)
        except InputError as error:
            mistakes.append(error)
    raise mistakes[-1] if mistakes else InputError(f"{element.model.name}: no contact has a steady film")
