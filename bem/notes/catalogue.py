"""The whole catalogue: importing it defines the kinds of all parts of the package."""

from collections.abc import Mapping

from bem.notes import accuracy, checks, contact, elements, friction, general, heat, lubrication, scenes, wear
from bem.notes.note import NoteKind, defined_kinds

PARTS = (general, contact, heat, lubrication, friction, wear, scenes, checks, accuracy, elements)
"""Modules of kinds, in the order of the documentation."""


def known_kinds() -> Mapping[str, NoteKind]:
    """Return all kinds of notes by their codes, those of other packages that are defined so far included."""
    return defined_kinds()
