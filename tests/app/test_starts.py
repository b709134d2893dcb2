"""What the first page offers: every task gives a scene without mistakes, every built-in scene is found by its words."""

import tomllib
from xml.etree import ElementTree

import pytest

from bem.app.planning import shown_plan
from bem.app.sketches import has_sketch, sketch
from bem.app.starts import OF_SURFACES, TASKS, built_in_scenes, scene_of_surface, start_text
from bem.app.treatment import treated
from bem.scenes.load import library
from bem.scenes.template import scene_template

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("start", [one for one in TASKS if not one.source.startswith("page")], ids=lambda one: one.name)
def test_a_task_starts_with_a_scene_that_can_run(start):
    table = tomllib.loads(start_text(start.source))
    assert shown_plan(table | {"name": start.name}).messages == ()


def test_every_built_in_scene_is_offered_with_all_of_its_words():
    found = {one.name: one for one in built_in_scenes()}
    assert found.keys() == library().keys()
    assert found["hertz-sphere"].words == library()["hertz-sphere"]["description"]
    assert [one.name for one in built_in_scenes() if "zddp" in one.found_by]


@pytest.mark.parametrize("kind", OF_SURFACES)
def test_a_measured_surface_starts_with_a_scene_that_can_run(kind):
    found = treated("example/ground-disk.al3d", {"detrend": "curvature", "despike": 6})
    table = tomllib.loads(scene_of_surface(kind, found.measured))
    assert table["lower"]["surface"]["path"] == "example/ground-disk.al3d"
    written = scene_template(kind, surfaces={"lower": "example/ground-disk.al3d"})
    assert table == tomllib.loads(written)  # the command writes the same scene
    plan = shown_plan(table | {"name": kind})
    assert (plan.messages, plan.warnings) == ((), ())


def test_every_task_and_kind_has_a_sketch_of_its_own():
    names = {*(one.picture for one in TASKS), *(one.kind for one in built_in_scenes())}
    assert [name for name in names if not has_sketch(name)] == []
    drawn = {name: sketch(name) for name in names}
    assert len(set(drawn.values())) == len(names)
    for text in drawn.values():
        ElementTree.fromstring(text)
