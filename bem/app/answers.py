"""The few figures that answer what was asked of a run: they lead its page and stand in lists of runs.

Verified in tests/app/test_answers.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from bem.plots.labels import UNIFORM, key_words
from bem.plots.report import with_error
from bem.plots.tables import is_list, is_size_of_no_particles, name_and_unit, varied_keys
from bem.quantities import si
from bem.scenes.records import TELLING

MOST = 5
"""Figures that lead a page."""
_ASIDE = frozenset(
    (
        *(f"{name}_{unit}" for name, unit in TELLING.items() if name != "load"),
        *("residual", "cycles", "contacts_solved", "step_error_nm", "volume_imbalance", "creepage"),
        *("separation_over_Sq", "combined_Sq_nm", "interface_depth_m"),
    )
)
"""Headline figures that say how, where or how well it was computed."""
_WITHOUT_LOAD = ("approach", "mean_gap", "hertz_pressure")
"""Keys of a contact in place of its load, which is a result then."""


@dataclass(frozen=True)
class Answer:
    """A figure in words.

    Attributes
    ----------
    words : its name.
    value : its value with error and unit; of a list the least to the largest.
    where : of a list, where it is least and largest, with their errors; else "".
    short : the value without its error.
    """

    words: str
    value: str
    where: str
    short: str


def answers(summary: Mapping[str, Any], headline: Sequence[str], scene: Mapping[str, Any]) -> tuple[Answer, ...]:
    """Return up to `MOST` headline figures that answer what was asked.

    Figures that are zero everywhere, are the load that was given, or say how well it was computed are left out.
    """
    contact = scene.get("contact")
    asked = isinstance(contact, Mapping) and any(contact.get(key) is not None for key in _WITHOUT_LOAD)
    found = []
    for name in telling_figures(summary, headline):
        value = summary[name]
        if name == "load_N" and not asked:
            continue
        if is_list(value):
            answer = _of_list(name, summary)
        elif isinstance(value, int | float) and not isinstance(value, bool) and value != 0:
            answer = _of_one(name, summary)
        else:
            answer = None
        if answer is not None:
            found.append(answer)
    return tuple(found[:MOST])


def telling_figures(summary: Mapping[str, Any], headline: Sequence[str]) -> list[str]:
    """Return the headline figures of a summary but those that say how, where or how well it was computed, and those
    that are rounding beside another one of their unit."""
    names = [name for name in headline if name not in _ASIDE and name not in varied_keys(summary)]
    names = [name for name in names if not is_size_of_no_particles(name, summary.get(name))]
    largest = {name: _largest(summary.get(name)) for name in names}
    units = {name: name_and_unit(name)[1] for name in names}
    return [
        name
        for name in names
        if summary.get(name) is not None
        and (not units[name] or largest[name] >= UNIFORM * max(largest[n] for n in names if units[n] == units[name]))
    ]


def _largest(value: Any) -> float:
    """The largest absolute value of a figure, 0 of what is no number."""
    items = value if isinstance(value, list) else [value]
    plain = [abs(v) for v in items if isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v)]
    return max(plain, default=0.0)


def _of_one(name: str, summary: Mapping[str, Any]) -> Answer:
    words, shown = with_error(name, summary)
    return Answer(words, shown.replace(" (no error bar)", ""), "", with_error(name, {name: summary[name]})[1])


def _of_list(name: str, summary: Mapping[str, Any]) -> Answer | None:
    """The least and the largest of a list of numbers."""
    values = summary[name]
    known = [
        i
        for i, v in enumerate(values)
        if isinstance(v, int | float) and not isinstance(v, bool) and not is_size_of_no_particles(name, v)
    ]
    if not known or all(values[i] == 0 for i in known):
        return None
    ends = [min(known, key=lambda i: values[i]), max(known, key=lambda i: values[i])]
    low, high = (with_error(name, {name: values[i]})[1] for i in ends)
    words = name_and_unit(name)[0]
    if low == high:
        return Answer(words, low, "", low)
    span = f"{_number(low)} to {high}" if _unit(low) == _unit(high) else f"{low} to {high}"
    places = [_varied_quantity(summary, i, len(values)) for i in ends]
    errors = [_error(name, summary, i) for i in ends]
    said = [
        " ".join(filter(None, (end, error, f"at {place}" if place else "")))
        for end, error, place in zip(("least", "largest"), errors, places, strict=True)
        if error or place
    ]
    return Answer(words, span, "; ".join(said), span)


def _error(name: str, summary: Mapping[str, Any], i: int) -> str:
    """Return the error bar of an entry of a list, with its sign; "" for none."""
    errors = summary.get(f"{name}_error")
    if not isinstance(errors, list) or i >= len(errors) or errors[i] is None:
        return ""
    shown = with_error(name, {name: summary[name][i], f"{name}_error": errors[i]})[1]
    return shown[shown.index("±") :] if "±" in shown else ""


def _varied_quantity(summary: Mapping[str, Any], i: int, length: int) -> str:
    """Describe an entry of a list by the first quantity that varies along it."""
    for key, unit in varied_keys(summary).items():
        if _varies(summary.get(key), length):
            value = summary[key][i]
            plain = unit in ("", "1", "K") or not isinstance(value, float)
            return f"{key_words(key)} {value if plain else si(value, unit)}"
    for name, unit in TELLING.items():
        values = summary.get(f"{name}_{unit}")
        if _varies(values, length):
            return with_error(f"{name}_{unit}", {f"{name}_{unit}": summary[f"{name}_{unit}"][i]})[1]
    return ""


def _varies(values: Any, length: int) -> bool:
    return isinstance(values, list) and len(values) == length and len(set(map(str, values))) > 1


def _number(shown: str) -> str:
    return shown.split(" ")[0]


def _unit(shown: str) -> str:
    return shown.partition(" ")[2]
