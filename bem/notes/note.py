"""A note on a result as data: a code of the catalogue, its level, its values, and the place that it applies to.

A `NoteKind` is one entry of the catalogue: the code, the level, and the texts with places for values. Calling it with
values makes a `Note`. A `Note` is also a string, its full text, so that scripts which print or search notes need not
know more. Code decides by `code`, `level` and `values`, never by the text. Verified in tests/notes.
"""

from __future__ import annotations

import re
import string
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, NamedTuple

from bem.quantities import counted, si

OUTSIDE = "outside the model: "
"""Words before the headline of a note of level `OUTSIDE_MODEL`, in every view."""
PLAIN = "remark"
"""Code of a text without an entry in the catalogue, such as one of a law or a check from outside the package."""


class Level(StrEnum):
    """Severity of a note for a reader of the results."""

    OUTSIDE_MODEL = "outside_model"
    """The result is solved, but it is not what it is called: the model does not hold there."""
    CAUTION = "caution"
    """Something to check or to change: the result may be wrong by more than a few per cent, or hangs on a choice."""
    INFO = "info"
    """A remark for the report, such as a figure without an error bar or a stated simplification."""


class Span(NamedTuple):
    """Smallest and largest of a value over several cases."""

    low: float
    high: float


class Reason(NamedTuple):
    """One cause of a kind of note: its sentence, and what differs from the kind.

    sentence : by how much, with the numbers, in place of the kind's own.
    action : what to do, in place of the kind's own; empty for the kind's.
    level : in place of the kind's own; None for the kind's.
    foreseen : whether the note is made before the run and gives way to one of its code that the results confirm.
    headline : what is wrong or uncertain, in place of the kind's own; empty for the kind's.
    """

    sentence: str
    action: str = ""
    level: Level | None = None
    foreseen: bool = False
    headline: str = ""


_FEW = 3
"""Words of a long list that are shown, the number of the others included."""


class _Formatter(string.Formatter):
    """Format specifications beside Python's, for values, spans and lists.

    `si UNIT` : prefixes from nano to giga. `%` : a share of one. `few` : the first words of a long list.
    `count NOUN` : a whole number with its noun, as "1 point" or "2 points".
    `.2g beside LIMIT`, `% beside LIMIT`, `si UNIT beside LIMIT` : with the digits that tell the value from its limit,
    which is the value of that name, or a number.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        """Format with these values, among which limits are."""
        self._values = values

    def format_field(self, value: Any, format_spec: str) -> str:
        format_spec, _, beside = format_spec.partition(" beside ")
        limit = self._values.get(beside, beside)
        if beside and isinstance(value, int | float) and not isinstance(limit, Span):
            return told_apart(float(value), float(limit), format_spec)
        if isinstance(value, Span):
            if beside:
                format_spec = f"{format_spec} beside {beside}"
            low, high = (self.format_field(end, format_spec) for end in value)
            return low if low == high else f"{low} to {high}"
        if isinstance(value, list | tuple):
            if format_spec == "few":
                between = "; " if any("," in str(item) for item in value) else ", "
                if len(value) > _FEW:
                    return f"{between.join(value[: _FEW - 1])} and {len(value) - _FEW + 1} more"
                if between == "; ":
                    return between.join(map(str, value))
            return joined([self.format_field(item, "" if format_spec == "few" else format_spec) for item in value])
        if format_spec.startswith("si "):
            return si(float(value), format_spec.removeprefix("si "))
        if format_spec.startswith("count "):
            return counted(int(value), format_spec.removeprefix("count "))
        if format_spec == "%":
            return percent(float(value))
        if isinstance(value, float) and not format_spec:
            return f"{value:.3g}"
        return str(format(value, format_spec))


_PRECISION = re.compile(r"\.(\d+)([gf])")
"""Format of a number with its digits."""
_MOST_DIGITS = 12
"""Digits beyond which a value counts as equal to its limit."""


def told_apart(value: float, limit: float, spec: str) -> str:
    """Return a value in the fewest digits that tell it from a limit, by a format of `_Formatter`: `.2g`, `%`, `si m`.

    A share of 0.3015 in two digits is "30 %", and beside a limit of 0.3 "30.2 %".
    """
    for digits in range(_MOST_DIGITS):
        if (shown := _with_digits(value, spec, digits)) != _with_digits(limit, spec, digits) or value == limit:
            break
    return shown


def _with_digits(value: float, spec: str, more: int) -> str:
    """Return a value in so many digits more than a format has."""
    if spec == "%":
        return percent(value, 2 + more)
    if spec.startswith("si "):
        return si(value, spec.removeprefix("si "), 3 + more)
    return format(value, _PRECISION.sub(lambda found: f".{int(found[1]) + more}{found[2]}", spec))


@dataclass(frozen=True)
class NoteKind:
    """One entry of the catalogue.

    Attributes
    ----------
    code : unique name, such as "film-spike".
    level : how much it matters.
    headline : what is wrong or uncertain, at most 12 words.
    sentence : by how much, with the numbers; a template over the values; empty for none.
    action : what to do; empty for none.
    reasons : of a kind with a value `reason`: sentence, action, level and headline of each reason.
    """

    code: str
    level: Level
    headline: str
    sentence: str = ""
    action: str = ""
    reasons: Mapping[str, Reason] = field(default_factory=dict)

    @property
    def anchor(self) -> str:
        """Anchor of the kind in the documentation's list of notes."""
        return f"note-{self.code}"

    def __call__(self, where: str = "", /, level: Level | None = None, **values: Any) -> Note:
        """Return the note with these values, on the place `where`; `level` replaces the kind's own."""
        own = self.reasons[values["reason"]].level if self.reasons else None
        return Note(self.code, level or own or self.level, values, where, self.texts(values))

    def texts(self, values: Mapping[str, Any]) -> tuple[str, str, str]:
        """Return headline, sentence and action with the values filled in."""
        reason = self.reasons[values["reason"]] if self.reasons else Reason(self.sentence)
        templates = (reason.headline or self.headline, reason.sentence, reason.action or self.action)
        formatter = _Formatter(values)
        headline, said, action = (formatter.vformat(template, (), values) for template in templates)
        return headline, said, action


class LevelledText(str):
    """A text about several results that begins with its level, such as "remark, 4 of 4 points"; shown as it is."""


_KINDS: dict[str, NoteKind] = {}


def define(
    code: str,
    level: Level,
    headline: str,
    sentence: str = "",
    action: str = "",
    *,
    reasons: Mapping[str, str | Reason] | None = None,
) -> NoteKind:
    """Enter a kind of note into the catalogue and return it.

    Raises
    ------
    ValueError : a code that is there already.
    """
    if code in _KINDS:
        raise ValueError(f"note {code!r} is in the catalogue already")
    causes = {name: one if isinstance(one, Reason) else Reason(one) for name, one in (reasons or {}).items()}
    _KINDS[code] = kind = NoteKind(code, level, headline, sentence, action, causes)
    return kind


def defined_kinds() -> Mapping[str, NoteKind]:
    """Return the kinds that are defined so far, by their codes; `bem.notes.catalogue` defines all."""
    return _KINDS


@dataclass(frozen=True, eq=False, repr=False)
class Note(str):
    """A note on a result; as a string, its full text. Made by calling a `NoteKind`.

    Attributes
    ----------
    code : of its kind in the catalogue.
    level : how much it matters.
    values : numbers and words of its texts, by name.
    where : the case, body or key that it applies to; empty for the whole result.
    texts : headline, sentence and action with the values filled in.
    """

    code: str
    level: Level
    values: Mapping[str, Any]
    where: str
    texts: tuple[str, str, str]

    def __new__(
        cls, code: str, level: Level, values: Mapping[str, Any], where: str, texts: tuple[str, str, str]
    ) -> Note:
        """Return the note as the string of its texts, with the place in front."""
        begins = OUTSIDE if level is Level.OUTSIDE_MODEL else ""
        return super().__new__(cls, _placed(where, begins + " ".join(text for text in texts if text)))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by the fields."""
        return Note, (self.code, self.level, dict(self.values), self.where, self.texts)

    @property
    def headline(self) -> str:
        """First sentence with the note's place, without a full stop: what is wrong or uncertain."""
        text = self.texts[0].split(";")[0] if self.code == PLAIN else self.texts[0]
        return _placed(self.where, text.rstrip("."))

    @property
    def line(self) -> str:
        """The note on a terminal: headline and action, or the sentence where there is no action."""
        headline, sentence, action = self.texts
        return _placed(self.where, f"{headline} {action or sentence}".rstrip())

    def at(self, where: str) -> Note:
        """Return the note with a place in front of its own."""
        place = ", ".join(part for part in (where, self.where) if part)
        return Note(self.code, self.level, self.values, place, self.texts)

    def as_dict(self) -> dict[str, str]:
        """Return code, level, text and place, as a summary holds them."""
        return {"code": self.code, "level": self.level.value, "text": str(self), "where": self.where}

    def packed(self) -> dict[str, Any]:
        """Return plain values from which `unpacked` makes the note again, for a checkpoint."""
        values = {key: list(value) if isinstance(value, tuple) else value for key, value in self.values.items()}
        spans = [key for key, value in self.values.items() if isinstance(value, Span)]
        about = {"code": self.code, "level": self.level.value, "where": self.where, "texts": list(self.texts)}
        return {**about, "values": values, "spans": spans}


def unpacked(packed: Mapping[str, Any] | str) -> Note:
    """Return the note of `Note.packed`; of a plain text, that text."""
    if isinstance(packed, str):
        return as_note(packed)
    values = {key: Span(*value) if key in packed["spans"] else value for key, value in packed["values"].items()}
    headline, sentence, action = packed["texts"]
    return Note(packed["code"], Level(packed["level"]), values, packed["where"], (headline, sentence, action))


def as_note(text: str) -> Note:
    """Return a text as a note: itself if it is one, else a caution, or outside the model where the text says so."""
    if isinstance(text, Note):
        return text
    where, found, said = text.partition(OUTSIDE)
    if not found:
        return Note(PLAIN, Level.CAUTION, {"text": text}, "", (text, "", ""))
    return Note(PLAIN, Level.OUTSIDE_MODEL, {"text": said}, where.rstrip(": "), (said, "", ""))


def of_summary(summary: Mapping[str, Any]) -> list[dict[str, str]]:
    """Return the notes of a run's summary as tables of code, level, text and where; of older runs these were texts."""
    found = summary.get("notes") or ()
    return [dict(entry) if isinstance(entry, Mapping) else as_note(str(entry)).as_dict() for entry in found]


def outside(notes: Iterable[str]) -> tuple[str, ...]:
    """Return the headlines of the notes that put a result outside its model, each once."""
    found = (as_note(note) for note in notes)
    return tuple(dict.fromkeys(note.headline for note in found if note.level is Level.OUTSIDE_MODEL))


def has_code(notes: Iterable[str], *kinds: NoteKind, reason: str | None = None) -> bool:
    """Return True if any of the notes is of one of the kinds, and of this reason where one is given."""
    codes = {kind.code for kind in kinds}
    return any(
        isinstance(note, Note) and note.code in codes and reason in (None, note.values.get("reason")) for note in notes
    )


def without(notes: Iterable[Note], *kinds: NoteKind) -> tuple[Note, ...]:
    """Return the notes that are of none of the kinds."""
    codes = {kind.code for kind in kinds}
    return tuple(note for note in notes if note.code not in codes)


def percent(share: float, digits: int = 2) -> str:
    """Return a share of one in per cent: two digits below 100, whole per cents from there on; or more digits."""
    return f"{100 * share:.{digits}g} %" if share < 0.995 else f"{100 * share:.{digits - 2}f} %"


def joined(words: list[str]) -> str:
    """Return "a, b and c"; empty for none."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def _placed(where: str, text: str) -> str:
    return f"{where}: {text}" if where else text
