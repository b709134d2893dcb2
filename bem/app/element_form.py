"""The form of a machine element and its answer, without a page: fields of the template, answer of a filled form.

Verified in tests/app/test_element_form.py.
"""

from __future__ import annotations

import io
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from pydantic.fields import FieldInfo

from bem.elements.answer import PLACES, all_notes, answer, balance_heat, table_columns
from bem.elements.element import MODELS, Element, element_template, load_element
from bem.elements.figure import element_figure
from bem.elements.running import Running, run_all
from bem.elements.scene_text import element_scene_text
from bem.errors import InputError
from bem.notes import Level
from bem.scenes.edit import table_text
from bem.scenes.keys import reason_of
from bem.scenes.oil import OilScene
from bem.scenes.paths import parse_key, put
from bem.scenes.values import dumped, plain_value
from bem.scenes.values import typed as as_typed

_LINE = re.compile(
    r'(?P<off># )?(?P<key>[a-z_0-9]+) = (?P<value>"[^"]*"|\[.*?\]|\{.*?\}|[^#]*?)\s*(#\s*(?P<words>.*))?'
)
_HEAD = re.compile(r"\[(?P<name>[a-z_]+)\]")

_MORE = {
    "length": "of rollers, such as 12 mm",
    "pitch_diameter": "such as 60 mm; without it the mean of bore and outside",
    "hertz_pressure": "such as 1.2 GPa, in place of the load or torque: highest on the inner ring (of rollers in their "
    "most loaded slice), or at the pitch point",
    "fatigue_load_limit": "such as 0.8 kN; C_u, without it from C0",
    "contamination_factor": "such as 0.5; e_C in place of cleanliness",
    "reliability": "such as 95; in per cent, 90 without it",
    "profile": "such as straight; of rollers, logarithmic without it",
    "structure_factor": "such as 0.8; X_W of the steel for scuffing, 1 for case-hardened",
    "boundary_friction": "such as 0.10; of asperity contacts, 0.12 without it",
    "bore": "such as 20.04 mm; of the bush, in place of shaft_diameter or clearance: empty the other one",
    "thermal": 'such as full: heat across the films, or off; without it "lumped", one mean temperature',
    "mean_particle_volume": "such as 0.01 um^3; with specific_wear_rate, for the number of particles per hour",
    "centre_distance": "such as 91.5 mm; in place of profile_shifts, of whose sum each gear gets half",
    "permissible_film_ratio": "such as 0.5; for a safety against micropitting, of a test with this oil and finish",
    "name": "such as pump-2; of the file and of its scenes",
    "oil.base": "such as pao, ester, pag; mineral without it",
}
"""Keys that templates do not name, with their meaning; those of the oil have it in `OilScene`."""


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
    named = {field.key for field in found} | {field.key.partition(".")[0] for field in found}
    found += [Field(key, "", words, False) for key, words in _known_keys(name).items() if key not in named]
    return sorted(found, key=lambda field: not field.basic)


def fields_from(name: str, table: Mapping[str, Any]) -> list[Field]:
    """Return the fields of an element with the values of its file; keys that the form does not know stand behind them.

    Raises
    ------
    InputError : a name of no element.
    """
    fields = fields_of(name)
    known = {field.key for field in fields}
    given = dict(_typed_by_key({key: value for key, value in table.items() if key != "element"}, known))
    own = [replace(field, value=given.get(field.key, ""), basic=field.basic or field.key in given) for field in fields]
    return [field for field in own if field.basic] + [
        *(Field(key, text, "", True) for key, text in given.items() if key not in known),
        *(field for field in own if not field.basic),
    ]


def _typed_by_key(table: Mapping[str, Any], known: Collection[str], inside: str = "") -> Iterator[tuple[str, str]]:
    """Yield dotted keys of a table with their values as typed; a table is one value where its key is known."""
    for name, value in table.items():
        key = f"{inside}{name}"
        if isinstance(value, Mapping) and key not in known:
            yield from _typed_by_key(value, known, f"{key}.")
        else:
            yield key, value if isinstance(value, str) and plain_value(value) == value else as_typed(value)


def _known_keys(name: str) -> dict[str, str]:
    """Return all dotted keys of an element's file that it uses, with their meaning where templates do not say it."""
    model = MODELS[name]
    own = [key for key in (*model.OTHER_KEYS, *model.model_fields) if key not in ("element", *model.UNUSED_KEYS)]
    words = {key: _MORE.get(key, "") for key in own if key != "oil"}
    return words | {
        f"oil.{key}": _MORE.get(f"oil.{key}") or _meaning(field) for key, field in OilScene.model_fields.items()
    }


def _meaning(field: FieldInfo) -> str:
    """Return the meaning of a field that explains itself, after its example: "such as 20 mPa*s; dynamic viscosity"."""
    said = (field.description or "").rstrip(".")
    said += f"; without it {reason}" if (reason := reason_of(field)) else ""
    if not field.examples:
        return said
    example = field.examples[0]
    shown = example if isinstance(example, str) else dumped(example)
    return f"such as {shown}; {said[:1].lower()}{said[1:]}"


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
    """Return the text of a scene of a filled form, as `bem element --scene` writes it.

    kind : "traction", the film along the path of contact or of the most loaded contact, or another kind of
        `bem.elements.element.KINDS` of the contact that `Element.contact_for` gives.

    Raises
    ------
    InputError : one message per mistake.
    """
    element = balance_heat(load_element(table_of(name, typed)))
    if kind != "traction":
        return element_scene_text(element, element.scene(element.contact_for(kind), kind))
    whole = element.found.along_unit == "m"
    return element_scene_text(element, element.path_scene() if whole else most_loaded_scene(element))


def most_loaded_scene(element: Element) -> dict[str, Any]:
    """Return the film of the contact with the highest pressure, of those that a steady film can have.

    Raises
    ------
    InputError : no contact has a steady film; the mistake of the most loaded contact where all have one.
    """
    mistakes: list[InputError] = []
    for contact in sorted(element.found.contacts, key=lambda one: -one.hertz(element.modulus).maximum_pressure):
        try:
            return element.scene(contact, "traction")
        except InputError as error:
            mistakes.append(error)
    raise mistakes[-1] if mistakes else InputError(f"{element.model.name}: no contact has a steady film")
