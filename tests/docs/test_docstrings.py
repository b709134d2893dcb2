"""Attributes in the docstrings of public dataclasses are the fields of the class; linters do not see those."""

import dataclasses
import inspect
import re

import pytest

import bem

RECORDS = [
    name for name in bem.__all__ if inspect.isclass(getattr(bem, name)) and dataclasses.is_dataclass(getattr(bem, name))
]


def attributes_of(docstring):
    """Names in the section on attributes: `a, b : description`."""
    _, _, section = inspect.cleandoc(docstring).partition("Attributes\n----------\n")
    section = re.split(r"\n\n|\n\w+\n-{3,}\n", section)[0]
    entries = re.findall(r"^(\*{0,2}\w+(?:, \*{0,2}\w+)*) : ", section, re.MULTILINE)
    return {name.strip() for entry in entries for name in entry.split(",")}


def undocumented(record):
    """Public fields without an entry, and entries that are neither field, property nor argument.

    Fields of a base class may be documented there.
    """
    documented = attributes_of(record.__doc__)
    fields = {field.name for field in dataclasses.fields(record) if not field.name.startswith("_")}
    for base in filter(dataclasses.is_dataclass, record.__mro__[1:]):
        fields -= attributes_of(base.__doc__)
    known = fields | set(dir(record)) | {f"**{name}" for name in inspect.signature(record).parameters}
    return fields - documented if documented else set(), documented - known


@pytest.mark.parametrize("name", RECORDS)
def test_attributes_are_the_fields_of_the_class(name):
    assert undocumented(getattr(bem, name)) == (set(), set())


def test_wrong_attributes_are_found():
    @dataclasses.dataclass
    class Wrong:
        """One line.

        Attributes
        ----------
        load, rate : numbers.
        """

        load: float
        speed: float

    assert undocumented(Wrong) == ({"speed"}, {"rate"})
