"""The walk over models: every key once, with its path, unit and level; the schema describes the same keys."""

import pytest

from bem.errors import InputError
from bem.laws import Law, laws_of
from bem.scenes import get_kind, kind_names, library
from bem.scenes.load import load_scene
from bem.scenes.schema import scene_schema
from bem.scenes.walk import keys_of, own_keys, walk
from bem.wear.criterion import LocalWear

pytestmark = pytest.mark.internal


def key_at(kind, *path):
    found = [key for key in walk(get_kind(kind).model) if key.path == path]
    assert found, path
    return found[0]


def test_a_key_says_its_unit_level_default_and_meaning():
    modulus = key_at("contact", "lower", "material", "youngs_modulus")  # or a crystal's stiffness
    assert (modulus.unit, modulus.level, modulus.required, modulus.default) == ("Pa", "basic", False, "")
    assert key_at("contact", "lower", "material").required
    assert modulus.meaning == "Young's modulus E."
    assert modulus.allowed.startswith("a pressure such as")
    surface = key_at("contact", "lower", "surface")
    assert [table.kind for table in surface.tables] == ["smooth", "generated", "measured"]
    assert surface.default
    layers = key_at("contact", "lower", "layers")
    assert (layers.row.kind, layers.tables) == ("", ())
    assert [key.name for key in keys_of(layers.row.model)] == ["material", "thickness", "residual_stress"]


def test_a_key_has_at_least_the_level_of_the_tables_that_it_is_in():
    order = ("basic", "advanced", "expert")
    for kind in kind_names():
        levels = {}
        for key in walk(get_kind(kind).model):
            levels.setdefault(key.path, key.level)
            above = levels.get(key.path[:-1], "basic")
            assert order.index(key.level) >= order.index(above), (kind, key.path)
    layer = key_at("contact", "lower", "layer", "thickness")  # basic in its own table
    assert layer.level == key_at("contact", "lower", "layer").level == "advanced"


def test_laws_are_tables_of_their_key_and_own_keys_leave_parameters_beside_out():
    law = key_at("friction", "oil", "shear_law")
    assert law.is_law
    assert {table.kind for table in law.tables} >= {"eyring", "limited"}
    oil = next(key for key in keys_of(get_kind("friction").model) if key.name == "oil").tables[0].model
    beside = {key.name for key in keys_of(oil)} - {key.name for key in own_keys(oil)}
    parameters = {name for table in law.tables for name in table.model.parameters()}
    assert "shear_stress_limit" in beside & parameters
    assert all(issubclass(table.model, Law) for table in law.tables)


def descriptions(schema):
    """Description by name of each property, at any depth."""
    if isinstance(schema, dict):
        for name, value in (schema.get("properties") or {}).items():
            if isinstance(value, dict) and "description" in value:
                yield name, value["description"]
        for value in schema.values():
            yield from descriptions(value)
    elif isinstance(schema, list):
        for value in schema:
            yield from descriptions(value)


@pytest.mark.parametrize("kind", ["contact", "friction", "wear"])
def test_the_schema_has_the_meanings_of_the_walk(kind):
    described = set(descriptions(scene_schema(kind)))
    for key in walk(get_kind(kind).model):
        if not key.tables and key.path[0] != "over":
            assert (key.name, key.meaning) in described, key.path


@pytest.mark.parametrize(
    ("kind", "path", "start"),
    [
        ("wear", ("wear", "particle_criterion"), "wear-cylinder-scar"),
        ("running-in-life", ("wear", "law"), "running-in-life"),
        ("running-in-life", ("particles", "criterion"), "running-in-life"),
    ],
)
def test_a_key_offers_the_laws_of_a_family_that_its_table_takes(kind, path, start):
    """As loading takes and refuses them."""
    key = key_at(kind, *path)
    offered, family = set(key.choices), laws_of("criterion")
    assert {table.kind for table in key.tables} == offered < set(family)
    table = library()[start]
    for name, law in family.items():
        given = dict.fromkeys(law.required(), 1e-9) | ({"distance": 1e-6} if issubclass(law, LocalWear) else {})
        scene = table | {path[0]: table[path[0]] | {path[1]: {"kind": name, **given}}}
        if name in offered:
            load_scene(scene)
        else:
            with pytest.raises(InputError, match=name):
                load_scene(scene)
