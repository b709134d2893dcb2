"""The form of a machine element: as filled from the template it is that element, and its answer is the command's."""

import re
import tomllib

import pytest

from bem import InputError, load_scene
from bem.app.element_form import answered, fields_from, fields_of, file_of, scene_of_form, table_of
from bem.app.planning import shown_plan
from bem.app.starts import TASKS
from bem.elements.answer import balance_heat
from bem.elements.element import MODELS, element_template, load_element
from bem.elements.scene_text import element_scene_text
from bem.scenes.oil import OilScene

pytestmark = pytest.mark.internal


def typed(name, **changes):
    return {field.key: field.value for field in fields_of(name)} | changes


@pytest.mark.parametrize("name", MODELS)
def test_the_form_begins_as_the_template(name):
    own = tomllib.loads(element_template(name)) | {"name": name}
    assert load_element(table_of(name, typed(name))).model == load_element(own).model
    assert tomllib.loads(file_of(name, typed(name))) == own
    assert all(field.words for field in fields_of(name) if not field.basic)


@pytest.mark.parametrize("name", MODELS)
def test_the_form_offers_every_key_of_the_element(name):
    """Keys of the model, those that stand in their place and those of the oil; the element refuses any other one."""
    model = MODELS[name]
    keys = {*model.model_fields, *model.OTHER_KEYS, *(f"oil.{key}" for key in OilScene.model_fields)}
    fields = [field.key for field in fields_of(name)]
    assert len(set(fields)) == len(fields)
    tables = {key.partition(".")[0] for key in fields} - {"oil"}
    assert keys - {*fields, *tables} == {"element", "oil", *model.UNUSED_KEYS}
    for key in model.UNUSED_KEYS:
        with pytest.raises(InputError, match=f"{key} of a {name}"):
            load_element(table_of(name, typed(name, **{key: "0.5"})))


@pytest.mark.parametrize("name", MODELS)
def test_the_template_names_every_key_of_the_element(name):
    """Given or behind a #; the name is that of the file."""
    model, text = MODELS[name], element_template(name)
    missing = {key for key in model.model_fields if re.search(rf"^(# )?\[?{key}\b", text, re.MULTILINE) is None}
    assert missing == {"name", *model.UNUSED_KEYS}
    for key in model.OTHER_KEYS:
        assert f"{key} = " in text


def test_the_form_of_a_file_has_its_values_and_no_others():
    """Tables as one value, keys of nested tables, text that looks like a number, and a key that no element has."""
    file = tomllib.loads(element_template("plain-bush")) | {
        "name": "pump", "first": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.29}, "bore": "25.06 mm",
        "description": "12", "oscilation": {"amplitude": "40 deg"},
    }  # fmt: skip
    del file["clearance"], file["heat_balance"]
    fields = fields_from("plain-bush", file)
    assert table_of("plain-bush", {field.key: field.value for field in fields}) == file
    assert {field.key: field.basic for field in fields}["bore"]
    with pytest.raises(InputError, match="no machine element"):
        fields_from("no-bush", file)


def test_a_bush_by_its_bore():
    by_bore = typed("plain-bush", bore="20.04 mm", clearance="", thermal="off")
    model = load_element(table_of("plain-bush", by_bore)).model
    assert model.clearance == pytest.approx(40e-6)
    assert model.thermal == "off"


def test_every_key_beside_the_template_is_a_key_of_the_element():
    bearing = typed(
        "rolling-bearing", rolling="roller", length="11 mm", profile="straight", reliability="95", tilt="1 mrad",
        fatigue_load_limit="0.9 kN", contamination_factor="0.4", cleanliness="", boundary_friction="0.1",
    )  # fmt: skip
    model = load_element(table_of("rolling-bearing", bearing)).model
    assert (model.length, model.profile, model.reliability) == (11e-3, "straight", 95)
    gears = typed("gear-pair", torque="", hertz_pressure="1.2 GPa", structure_factor="0.8") | {"oil.base": "pao"}
    assert load_element(table_of("gear-pair", gears)).model.oil.base == "pao"


def test_the_answer_of_a_form():
    found = answered("rolling-bearing", typed("rolling-bearing", radial_load="6 kN"))
    said = dict(found.rows)
    assert "P = 6 kN" in said["basic rating life"]
    assert found.picture.startswith(b"\x89PNG")
    assert found.table.count("\n") > 4
    with pytest.raises(InputError, match="radial_load"):
        answered("rolling-bearing", typed("rolling-bearing", radial_load="6 K"))


@pytest.mark.parametrize("name", MODELS)
def test_the_scene_of_a_form_can_run(name):
    table = tomllib.loads(scene_of_form(name, typed(name)))
    assert load_scene(table).kind == "traction"
    assert shown_plan(table | {"name": name}).messages == ()


@pytest.mark.parametrize("name", MODELS)
def test_the_mixed_scene_of_a_form_is_that_of_the_thinnest_film_as_of_the_command(name):
    """The page took the place of highest pressure, the command that of the thinnest film."""
    table = tomllib.loads(scene_of_form(name, typed(name), "friction"))
    assert load_scene(table).kind == "friction"
    element = balance_heat(load_element(table_of(name, typed(name))))
    assert table == tomllib.loads(element_scene_text(element, element.scene(element.thinnest_steady(), "friction")))
    numbers = re.findall(r"[-+.e0-9]+", " ".join(str(value) for value in table["contact"].values()))
    assert all(len(number) <= 8 for number in numbers)  # six digits
    smooth = typed(name) | {"rms_roughness": ""}
    with pytest.raises(InputError, match="needs the roughness"):
        scene_of_form(name, smooth, "friction")


def test_tasks_lead_to_the_pages_of_all_elements():
    assert {one.source for one in TASKS if "/element/" in one.source} == {f"page /element/{name}" for name in MODELS}
