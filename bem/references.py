"""Sources of laws and methods, from `references.bib`: one BibTeX entry a line, by its key."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType

_ENTRY = re.compile(r"@(\w+)\{(\w+), (.*)\}")
_FIELD = re.compile(r"(\w+) = \{((?:[^{}]|\{[^{}]*\})*)\}")
_ACCENTS = {r"{\'e}": "é", r"{\"a}": "ä", r"{\"o}": "ö", r"{\"u}": "ü", r"{\`a}": "à", r"{\ss}": "ß", "--": "-"}


@dataclass(frozen=True)
class Reference:
    """A source.

    key : of the entry. bibtex : the entry as it stands. fields : author, title, year and the like.
    """

    key: str
    bibtex: str
    fields: MappingProxyType[str, str]

    @property
    def text(self) -> str:
        """The source in a line: authors (year), title, where it appeared."""
        told = {name: _plain(value) for name, value in self.fields.items()}
        authors = told["author"].split(" and ")
        names = ", ".join(authors[:-1]) + (" and " if len(authors) > 1 else "") + authors[-1]
        places = ("journal", "booktitle", "publisher", "school", "howpublished")
        place = next((told[name] for name in places if name in told), "")
        pages = f", {told['pages']}" if "pages" in told else ""
        where = " ".join(part for part in (place, told.get("volume", "")) if part)
        note = f" ({told['note']})" if "note" in told else ""
        return f"{names} ({told['year']}). {told['title']}. {where}{pages}.{note}"


@cache
def references() -> dict[str, Reference]:
    """Return all sources by key."""
    found = {}
    for line in files("bem").joinpath("references.bib").read_text(encoding="utf-8").splitlines():
        if entry := _ENTRY.fullmatch(line.strip()):
            fields = MappingProxyType(dict(_FIELD.findall(entry[3])))
            found[entry[2]] = Reference(entry[2], line.strip(), fields)
    return found


def _plain(text: str) -> str:
    for code, letter in _ACCENTS.items():
        text = text.replace(code, letter)
    return text.replace("{", "").replace("}", "")
