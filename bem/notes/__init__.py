"""Notes on results: data with a code, a level, values and a place; the catalogue has their texts.

`note` has the types and `merge` one list of several. The other modules are the catalogue, a file for each part of the
program, gathered in `catalogue`. A solver calls a kind of note with its values, `FILM_MOLECULAR(thickness=1e-9)`; views
show `headline`, `line` or the whole text. To add a note, define its kind in the file of its part: a headline of at most
12 words that says what is wrong or uncertain, one sentence with the numbers, and what to do. Causes of one uncertainty
are reasons of one kind, each with its sentence; a simplification that always holds belongs to the documentation.
"""

from bem.notes.note import (
    OUTSIDE,
    Level,
    Note,
    NoteKind,
    Reason,
    Span,
    as_note,
    define,
    has_code,
    of_summary,
    outside,
    unpacked,
    without,
)

__all__ = [
    "OUTSIDE",
    "Level",
    "Note",
    "NoteKind",
    "Reason",
    "Span",
    "as_note",
    "define",
    "has_code",
    "of_summary",
    "outside",
    "unpacked",
    "without",
]
