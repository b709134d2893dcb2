"""Forms made from the models: every kind, every key with what may stand there; what is typed goes into the table."""

import pytest

from bem import InputError, load_scene
from bem.scenes import kind_names
from bem.scenes.form import (
    form_of,
    mistakes_of,
    row_of,
    start_of,
    table_at,
    text_of,
    with_kind,
    with_row,
    with_value,
    without_row,
)
from bem.scenes.kind import get_kind

pytestmark = pytest.mark.internal


def entries(table):
    for entry in table.entries:
        yield entry
        for inner in entry.tables:
            yield from entries(inner)


def entry(form, key):
    return next(one for one in entries(form) if one.key == key)


@pytest.mark.parametrize("kind", kind_names())
def test_every_kind_has_a_form_that_starts_good(kind):
    form = form_of(kind)
    asked = {one.key for one in form.entries}
    assert asked >= set(get_kind(kind).model.model_fields) - {"kind", "name", "redoes", "over"}
    assert mistakes_of(start_of(kind)) == ()
    for one in entries(form):
        assert one.tables or one.typed
        assert not (one.closed and not one.choices)


def test_entries_say_unit_default_and_choices():
    form = form_of("contact")
    load = entry(form, "contact.load")
    assert "a number in N" in load.allowed
    assert not load.required
    assert entry(form, "contact.behaviour").choices == ("elastic", "capped")
    assert entry(form, "contact.behaviour").closed
    assert entry(form, "contact.friction").default == "0.0"
    assert entry(form, "outputs.errors").switch
    assert "steel-52100" in entry(form, "lower.material").choices
    assert [one.kind for one in entry(form, "lower.surface").tables] == ["smooth", "generated", "measured"]
    assert entry(form, "shape.kind").choices[0] == "flat"
    assert "ground" in entry(form, "lower.surface.process").choices
    grade = entry(form_of("friction"), "oil.grade")
    assert "ISO VG 68" in grade.choices
    assert not grade.closed  # other grades have names that can be worked out
    laws = entry(form_of("friction"), "contact.boundary_friction")
    assert laws.typed
    assert "pressure_dependent" in [one.kind for one in laws.tables]


def test_what_is_typed_goes_into_the_table_and_nothing_takes_it_out():
    table = start_of("contact")
    typed = with_value(table, "contact.load", "7 N")
    assert load_scene(typed).contact.load == 7.0
    assert table["contact"]["load"] != "7 N"  # a copy
    assert "load" not in with_value(typed, "contact.load", "")["contact"]
    assert with_value(table, "contact.mean_gap", "") == table  # nothing was there
    with pytest.raises(InputError, match="index"):
        with_value(table, "contact.load[3]", "1")
    (mistake,) = mistakes_of(with_value(table, "contact.laod", "7 N"))
    assert mistake.startswith("contact.laod: unknown key - did you mean")


def test_entries_say_meaning_unit_and_level():
    load = entry(form_of("contact"), "contact.load")
    assert (load.unit, load.level) == ("N", "basic")
    assert load.meaning == "Normal load; instead of hertz_pressure, mean_pressure, approach or mean_gap [N]."
    assert entry(form_of("contact"), "contact.tolerance").level == "expert"
    layer = entry(form_of("contact"), "lower.layer.thickness")
    assert layer.level == "advanced"  # that of its table
    assert layer.example == '"2 um"'
    oil = entry(form_of("friction"), "oil.pressure_viscosity")
    assert oil.meaning.endswith("[1/Pa]. Without it: that of the grade, or 0 beside viscosity.")
    assert [one.last for one in entry(form_of("wear"), "variants").rows.entries][:2] == ["name", "cells"]


def test_a_coating_is_taken_off_with_its_last_key():
    """Its empty table would ask for both keys again."""
    table = start_of("contact")
    table["lower"] = {**table["lower"], "layer": {"material": "dlc", "thickness": "2 um"}}
    without = with_value(with_value(table, "lower.layer.thickness", ""), "lower.layer.material", "")
    assert "layer" not in without["lower"]
    assert load_scene(without).lower.stack == []
    assert load_scene(with_value(with_value(without, "lower.layer.thickness", "1 um"), "lower.layer.material", "dlc"))
    assert with_value({"kind": "contact", "contact": {"load": "1 N"}}, "contact.load", "")["contact"] == {}


def test_rows_of_a_list_of_tables_are_added_and_taken_out():
    """A new row has examples of what it needs; the last one takes the key with it."""
    table = start_of("contact")
    layers = entry(form_of("contact"), "lower.layers")
    one = with_row(table, layers)
    two = with_row(one, layers)
    keys = [item.key for item in row_of(layers, 1).entries]
    assert keys == [f"lower.layers[1].{name}" for name in ("material", "thickness", "residual_stress")]
    inner = row_of(layers, 1).entries[0].tables[0].entries
    assert "lower.layers[1].material.hardness" in [item.key for item in inner]
    two = with_value(with_value(two, keys[0], "Cr"), keys[1], "0.5 um")
    assert [(one.material.name, one.thickness) for one in load_scene(two).lower.stack] == [("dlc", 2e-6), ("Cr", 5e-7)]
    left = without_row(two, layers, 0)
    assert left["lower"]["layers"] == [{"material": "Cr", "thickness": "0.5 um"}]
    assert "layers" not in without_row(left, layers, 0)["lower"]
    assert "layers" not in table["lower"]  # a copy
    assert len(two["lower"]["layers"]) == 2
    with pytest.raises(InputError, match="is not set"):
        without_row(left, layers, 1)
    variants = entry(form_of("wear"), "variants")
    assert with_row(with_row({"kind": "wear"}, variants), variants)["variants"] == [
        {"name": "name 1"},
        {"name": "name 2"},
    ]


def test_another_table_keeps_what_both_have():
    table = start_of("contact")
    form = form_of("contact")
    one = entry(form, "lower.surface")
    generated = with_value(with_kind(table, one, "generated"), "lower.surface.process", "")
    generated = with_value(generated, "lower.surface.rms_height", "50 nm")
    measured = with_kind(generated, one, "measured")
    assert measured["lower"]["surface"] == {"kind": "measured", "rms_height": "50 nm"}
    assert with_kind(measured, one, "smooth")["lower"]["surface"] == {"kind": "smooth"}


def test_a_value_tells_which_table_it_is_of():
    surface = entry(form_of("contact"), "lower.surface")
    assert table_at(surface, {"kind": "measured", "path": "a.sur"}).kind == "measured"
    assert table_at(surface, {"process": "ground", "rms_height": "0.2 um"}).kind == "generated"
    assert table_at(surface, {"path": "a.sur"}).kind == "measured"
    assert table_at(surface, "smooth").kind == "smooth"
    assert table_at(surface, None).kind == "smooth"
    assert table_at(surface, {"kind": "rough"}) is None


def test_text_is_what_would_be_typed():
    assert text_of("5 N") == "5 N"
    assert text_of(None) == ""
    assert text_of([1, 2.5]) == "[1, 2.5]"
    assert text_of(True) == "true"
