"""Edits of TOML text: the values asked for, and everything else as it was."""

import tomllib

import pytest

from bem import InputError
from bem.scenes import library
from bem.scenes.edit import edited_text, table_text
from bem.scenes.load import library_text

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("name", library())
def test_a_built_in_scene_is_edited_key_by_key(name):
    text, table = library_text(name), library()[name]
    assert edited_text(text, table) == text
    for key in table:
        changed = {one: value for one, value in table.items() if one != key} | {"new": {"a": [1, {"b": 2}]}}
        edited = edited_text(text, changed)
        assert tomllib.loads(edited) == changed
        if not isinstance(table[key], dict | list):
            assert len(set(text.splitlines()) - set(edited.splitlines())) == 1  # the line of the key
    assert tomllib.loads(table_text(table)) == table


def test_values_of_other_types_are_other_values():
    assert edited_text("a = 1  # one\n", {"a": 1.0}) == "a = 1.0  # one\n"
    assert edited_text("a = true\n", {"a": 1}) == "a = 1\n"
    assert edited_text("a = 0x10\nb = 1_000\n", {"a": 16, "b": 1000}) == "a = 0x10\nb = 1_000\n"


def test_rows_and_dotted_keys_are_edited_in_place():
    text = "a.b = 1  # first\na.c = 2\n\n[[row]]\nx = 1  # x\n\n[[row]]\nx = 2\n"
    table = {"a": {"b": 5, "c": 2}, "row": [{"x": 1, "y": "z"}, {"x": 3}]}
    edited = edited_text(text, table)
    assert tomllib.loads(edited) == table
    assert "a.b = 5  # first" in edited
    assert "x = 1  # x" in edited
    fewer = {"a": {"b": 1, "c": 2}, "row": [{"x": 2}]}
    assert tomllib.loads(edited_text(text, fewer)) == fewer


def test_text_that_is_no_toml_is_refused():
    with pytest.raises(InputError, match="not valid TOML"):
        edited_text("a = \n", {"a": 1})


def test_new_text_has_keys_before_tables():
    table = {
        "lower": {"material": "steel", "layer": {"thickness": "1 um"}},
        "kind": "contact",
        "we ird": {"q.q": "\x7f"},
    }
    text = table_text(table)
    assert tomllib.loads(text) == table
    assert text.startswith('kind = "contact"\n')
