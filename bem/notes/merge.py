"""Notes of several results as one list: each once, with the places it applies to and the range of its values."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import Any

from bem.notes.catalogue import known_kinds
from bem.notes.note import PLAIN, Level, Note, Span, as_note

Place = Callable[[list[int]], str]
"""(indices of results) -> words for them."""


def merge(by_result: Sequence[Iterable[str]], place: Place) -> list[Note]:
    """Return the notes of several results, each once.

    Notes of one code, place and wording are one note. Its `where` names the results it applies to unless these are
    all; numbers that differ between the results become a `Span`.

    Parameters
    ----------
    by_result : the notes of each result.
    place : words for some of the results, by their indices.
    """
    groups: dict[Hashable, dict[int, list[Note]]] = {}
    for index, own in enumerate(by_result):
        for note in map(as_note, own):
            groups.setdefault(identity(note), {}).setdefault(index, []).append(note)
    found = []
    for members in groups.values():
        indices, notes = list(members), [note for own in members.values() for note in own]
        merged = together(notes)
        found.append(merged if len(indices) == len(by_result) else merged.at(place(indices)))
    return found


def without_foreseen(notes: Sequence[Note]) -> list[Note]:
    """Return the notes without those made before a run that others of their code, made from its results, confirm.

    A remark from the results does not replace a caution made before the run.
    """
    found = [note for note in notes if not _foreseen(note)]
    return [note for note in notes if not _foreseen(note) or not any(_confirms(one, note) for one in found)]


def _confirms(found: Note, foreseen: Note) -> bool:
    """Return True if a note from the results replaces one made before the run: of its code, and as severe."""
    severities = list(Level)
    return found.code == foreseen.code and severities.index(found.level) <= severities.index(foreseen.level)


def _foreseen(note: Note) -> bool:
    """Return True for a note of a reason that is known before the run."""
    kind = known_kinds().get(note.code)
    return kind is not None and bool(kind.reasons) and kind.reasons[note.values["reason"]].foreseen


def identity(note: Note) -> Hashable:
    """Return the key under which notes of several results are one: code, place, and values other than numbers."""
    if note.code == PLAIN:
        return (note.code, str(note))
    words = tuple((key, _hashable(value)) for key, value in sorted(note.values.items()) if not _is_number(value))
    return (note.code, note.level, note.where, words)


def together(notes: Sequence[Note]) -> Note:
    """Return notes of one identity as one, with spans for numbers that differ."""
    first = notes[0]
    spans = {}
    for key, value in first.values.items():
        if _is_number(value):
            ends = [end for note in notes for end in _ends(note.values[key])]
            if min(ends) != max(ends):
                spans[key] = Span(min(ends), max(ends))
    if not spans:
        return first
    kind = known_kinds().get(first.code)
    if kind is None:  # of a checkpoint from before its code was renamed
        return first
    values = {**first.values, **spans}
    return Note(first.code, first.level, values, first.where, kind.texts(values))


def _is_number(value: Any) -> bool:
    return isinstance(value, Span) or (isinstance(value, int | float) and not isinstance(value, bool))


def _ends(value: Any) -> tuple[float, float]:
    return (value.low, value.high) if isinstance(value, Span) else (value, value)


def _hashable(value: Any) -> Hashable:
    return tuple(value) if isinstance(value, list) else value
