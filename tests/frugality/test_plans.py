"""`bem plan` for every kind and every built-in scene: what runs, what is skipped and why; it follows the scene."""

import json
import math

import pytest

from bem.runs import plan_scene
from bem.scenes import library
from bem.scenes.kinds import kind_names

SCENES = sorted(name for name, tables in library().items() if '"kind": "measured"' not in json.dumps(tables))
"""Those that need no file of the user's."""


@pytest.mark.parametrize("name", SCENES)
def test_every_built_in_scene_has_a_whole_plan(name):
    _, plan = plan_scene(name)
    assert len({step.name for step in plan.steps}) == len(plan.steps)
    working = [step for step in plan.steps if not step.skipped]
    assert working
    for step in plan.steps:
        assert step.why.strip(), step.name
        assert 0 <= step.memory < math.inf
    assert plan.memory > 0
    assert 0 < plan.seconds(2e9) < math.inf
    assert plan.seconds(4e9) <= plan.seconds(2e9)


def test_every_kind_has_a_built_in_scene_and_something_to_skip():
    kinds = {}
    for name in SCENES:
        scene, plan = plan_scene(name)
        kinds.setdefault(scene.kind, []).append(any(step.skipped for step in plan.steps))
    for kind in kind_names():
        if kind in kinds:
            assert any(kinds[kind]), f"no scene of kind {kind} skips anything"


def skipped(source, *settings):
    _, plan = plan_scene(source, settings)
    return {step.name: step.skipped for step in plan.steps}


def test_a_contact_plan_follows_what_is_asked_for():
    everything = skipped("rough-contact")
    assert not everything["stresses below"]
    assert not everything["traction kernels"]
    assert everything["layered kernels"]
    less = skipped("rough-contact", "outputs.von_mises=false", "outputs.stresses=false", "outputs.vtk=false")
    assert less["stresses below"]
    assert skipped("rough-contact", "contact.friction=0")["traction kernels"]
    assert not skipped("coated-sphere")["layered kernels"]


def test_time_and_memory_of_a_plan_grow_with_the_grid():
    _, small = plan_scene("hertz-sphere", ["grid.shape=128"])
    _, large = plan_scene("hertz-sphere", ["grid.shape=1024"])
    assert large.memory > 4 * small.memory
    assert large.seconds(2e9) > small.seconds(2e9)
