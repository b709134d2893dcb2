"""What the first page offers: every task gives a scene without mistakes, every built-in scene is found by its words."""

import tomllib

import pytest

from bem.app.planning import shown_plan
from bem.app.starts import TASKS, built_in_scenes, start_text
from bem.scenes.load import library

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
