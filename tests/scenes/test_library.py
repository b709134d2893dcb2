"""The built-in scenes: each is loaded and planned once, and everything that must be true of all of them is tested."""

import json
import math
import tomllib

import pytest
from json_schemas import fits, schema_of

from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes import dump_scene, kind_names, library, load_scene, units
from bem.scenes.checks import SCENE_CHECKS, examine
from bem.scenes.edit import table_text
from bem.scenes.form import library_scene
from bem.scenes.load import read_table
from bem.scenes.planner import SEARCHED_IN_SINGLE

NAMES = sorted(library())
NEEDS_FILES = {name for name, table in library().items() if '"path"' in json.dumps(table)}
"""Scenes of surfaces from files that the user has to give."""

EXPECTED_WARNINGS = {
    "adhesive-sphere": {"viscoelastic_material"},
    # rubber, slope one and waves of two cells: the challenge's own numbers on a grid that a run of a minute allows
    "tense-gel-ball": {"viscoelastic_material"},
    "contact-challenge": {
        "viscoelastic_material",
        "steep_roughness",
        "few_cells_per_wave",
        "adhesive_zone_of_few_cells",  # a range of 2 nm
    },
    "asperities-given-film": {"patch_sinks_at_given_separation"},  # the source's square and its given separation
    "stribeck-polymer-roller": {"viscoelastic_material", "lengths_of_the_process"},  # PEEK; ground shaft
    "uniform-asperities": {"yield_below_the_surface"},  # elastic as in the paper, pressed in by up to 4.2 GPa
    "hardness-optimum": {"few_cells_per_wave"},  # the thesis' cell, two to the shortest wave
    "running-in-stribeck": {"few_cells_per_wave", "few_cells_per_correlation_length"},  # likewise
    "running-in-ball": {"few_cells_per_wave", "few_cells_per_correlation_length"},  # likewise, the same surfaces
    "wear-hard-roughness": {"steep_roughness"},  # Sq 1500 nm is the variant's point; its slope is 5
    "wear-soft-roughness": {"steep_roughness"},  # likewise, slope 1
    "wear-mesh-convergence": {"few_cells_per_wave", "depths_coarser_than_cells"},  # coarse meshes are its point
    "wear-mesh-rigid-flat": {"depths_coarser_than_cells"},  # likewise
}


@pytest.fixture
def no_registry(monkeypatch):
    """Asking for the registry of units is an error: the units of built-in scenes are read without it."""

    def refuse():
        raise AssertionError("pint was asked for")

    units._unit.cache_clear()
    monkeypatch.setattr(units, "_registry", refuse)


def test_there_are_scenes_with_and_without_files():
    assert set() < NEEDS_FILES < set(NAMES)
    assert EXPECTED_WARNINGS.keys() <= set(NAMES) - NEEDS_FILES


@pytest.mark.internal
@pytest.mark.usefixtures("no_registry")
@pytest.mark.parametrize("name", NAMES)
def test_a_built_in_scene(name, tmp_path):
    check_table(name, tmp_path)
    check_schema(library()[name])
    if name in NEEDS_FILES:
        with pytest.raises(InputError) as caught:
            plan_scene(library()[name] | {"name": name})
        assert all(".path = " in message and "no such file" in message for message in caught.value.messages)
        return
    scene, plan = plan_scene(name)
    check_round_trip(scene, name)
    check_plan(plan)
    check_precisions(plan)
    facts = examine(scene)
    warned = {check for check in SCENE_CHECKS if list(SCENE_CHECKS[check](facts))}
    assert warned == EXPECTED_WARNINGS.get(name, set())  # "outside_usual_range", too, in no scene


def check_table(name, folder):
    """The table has a kind and a description of one line, and reads back as it is written."""
    table = library()[name]
    assert table["kind"] in kind_names()
    assert table["description"]
    assert "\n" not in table["description"]
    if name not in NEEDS_FILES:  # whose paths are read from the folder of the scene
        path = folder / "scene.toml"
        path.write_text(table_text(library_scene(name)))
        assert read_table(path) == library_scene(name)


def check_schema(table):
    """The table fits the schema of its kind and that of all kinds; mistakes do not."""
    for schema in (schema_of(table["kind"]), schema_of()):
        assert fits(table, schema, schema)
        for mistake in ({"sead": 1}, {"seed": -1}, {"kind": "nothing"}, {"lower": {"material": "steel-disc"}}):
            assert not fits(table | mistake, schema, schema), mistake


def check_round_trip(scene, name):
    """The resolved scene loads as the same scene."""
    assert scene.name == name
    again = load_scene(tomllib.loads(dump_scene(scene)))
    assert again == scene
    assert dump_scene(again) == dump_scene(scene)


def check_plan(plan):
    """Every step has a name of its own, a reason and a memory; the time falls with the speed of the machine."""
    assert len({step.name for step in plan.steps}) == len(plan.steps)
    assert any(not step.skipped for step in plan.steps)
    for step in plan.steps:
        assert step.why.strip(), step.name
        assert 0 <= step.memory < math.inf
    assert plan.memory > 0
    assert 0 < plan.seconds(4e9) <= plan.seconds(2e9) < math.inf


def check_precisions(plan):
    """Contacts and stresses of free grids say that they are not held in double; films and surfaces are."""
    for step in plan.steps:
        if step.name == "contact" and "on the curved surface" in step.why:
            assert step.precision == ""  # its matrices are in double
        elif not step.skipped and step.name != "partial slip":  # whose pressure may follow the tractions, or not
            searches = ("contact" in step.name and "heat" not in step.name) or step.name == "pressing in steps"
            assert (step.precision == SEARCHED_IN_SINGLE) == searches, step.name
        assert step.precision in ("", SEARCHED_IN_SINGLE)
        assert (step.name in plan.precisions) == (bool(step.precision) and not step.skipped)
