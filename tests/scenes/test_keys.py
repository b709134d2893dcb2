"""Keys explain themselves: every key of every kind has a meaning, a level and, where it is a quantity, a dimension."""

import typing

import pytest
from pydantic import BaseModel

from bem.laws import FAMILIES, laws_of
from bem.scenes import get_kind, kind_names
from bem.scenes.form import mistakes_of, start_of
from bem.scenes.keys import LEVELS, key, level_of, reason_of
from bem.scenes.kind import kind_aliases, kinds_by_task
from bem.scenes.laws import LawTable, fields_of
from bem.scenes.table import Table
from bem.scenes.units import Dimension

pytestmark = pytest.mark.internal


def parts_of(annotation):
    """An annotation and all that is in it."""
    yield annotation
    if typing.get_origin(annotation) is typing.Annotated:
        yield from annotation.__metadata__
    for item in typing.get_args(annotation):
        yield from parts_of(item)


def tables_of(model, seen=None):
    """A table and all tables in it, each once."""
    seen = [] if seen is None else seen
    if model not in seen:
        seen.append(model)
        for field in model.model_fields.values():
            for part in parts_of(field.annotation):
                if isinstance(part, type) and issubclass(part, BaseModel):
                    tables_of(part, seen)
    return seen


def has_dimension(field):
    parts = [*parts_of(field.annotation), *(part for item in field.metadata for part in parts_of(item))]
    parts += [part for item in parts if hasattr(item, "number") for part in parts_of(item.number)]
    return any(isinstance(part, Dimension) for part in parts)


def is_a_quantity(field):
    """Return True if a field holds real numbers."""
    return float in parts_of(field.annotation)


@pytest.mark.parametrize("kind", kind_names())
def test_every_key_has_a_meaning_a_level_and_a_dimension(kind):
    for table in tables_of(get_kind(kind).model):
        fields = dict(table.model_fields)
        if issubclass(table, LawTable):
            fields |= table.fields_beside()
        for name, field in fields.items():
            where = f"{table.__name__}.{name}"
            assert field.description, where
            assert field.description[0].isupper(), where
            assert field.description.endswith("."), where
            assert level_of(field) in LEVELS, where
            if is_a_quantity(field) and name != "accuracy":  # a fraction with a parser of its own
                assert has_dimension(field), where


@pytest.mark.parametrize("kind", kind_names())
def test_what_a_table_needs_is_basic(kind):
    for table in tables_of(get_kind(kind).model):
        for name, field in table.model_fields.items():
            assert not field.is_required() or level_of(field) == "basic", f"{table.__name__}.{name}"


@pytest.mark.parametrize("family", FAMILIES)
def test_every_parameter_of_a_law_has_a_meaning(family):
    for law in laws_of(family).values():
        for name, field in fields_of(law).items():
            assert len((field.description or "").split()) >= 2, f"{law.__name__}.{name}: {field.description}"
            assert level_of(field) == ("basic" if name in law.required() else "advanced")


def test_a_key_is_a_field_with_level_and_reason():
    class Own(Table):
        load: float = key("Normal load.", "basic", gt=0)
        steps: int = key("Number of steps.", "expert", default=8, reason="enough for one cycle")
        plain: int = 3

    fields = Own.model_fields
    assert fields["load"].is_required()
    assert [level_of(fields[name]) for name in fields] == ["basic", "expert", "advanced"]
    assert reason_of(fields["steps"]) == "enough for one cycle"
    assert reason_of(fields["plain"]) == ""
    assert Own(load=1.0).steps == 8
    assert Own.model_json_schema()["properties"]["steps"]["level"] == "expert"
    with pytest.raises(ValueError, match="greater than 0"):
        Own(load=-1.0)


def test_a_message_on_a_missing_key_says_what_it_means():
    table = start_of("contact")
    table["lower"] = {"material": {"youngs_modulus": "200 GPa"}}
    (message,) = mistakes_of(table)
    assert message.startswith(
        "lower.material.poissons_ratio: missing (Poisson's ratio, above -1 and below 0.5); allowed:"
    )


def test_kinds_are_listed_by_task_and_each_once():
    tasks = kinds_by_task()
    assert [name for names in tasks.values() for name in names] == list(kind_names())
    assert len(set(kind_names())) == len(kind_names())
    assert next(iter(tasks.values()))[0] == "contact"
    assert "other kinds" not in tasks  # each folder says its task


def test_names_that_people_guess_mean_one_kind_each():
    aliases = [word for kind in kind_names() for word, meant in kind_aliases().items() if meant == kind]
    assert len(aliases) == len(kind_aliases())
    assert not set(aliases) & set(kind_names())
    assert kind_aliases()["stribeck"] == "friction"
