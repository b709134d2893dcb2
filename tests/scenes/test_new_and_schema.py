"""Scenes to start from, and their JSON Schema."""

import json
import re
import subprocess
import sys
import tomllib

import pytest
from json_schemas import fits, schema_of

from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes import get_kind, kind_names, library
from bem.scenes.load import load_scene
from bem.scenes.template import scene_template

KINDS = [name for name in kind_names() if any(table["kind"] == name for table in library().values())]


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_scene_runs_as_it_is_and_names_every_key(kind):
    text = scene_template(kind)
    scene, plan = plan_scene(tomllib.loads(text))
    assert scene.kind == kind
    assert plan.steps
    for key in get_kind(kind).model.model_fields:
        if key not in ("name", "redoes"):
            assert re.search(rf"^(# )?(\[+)?{key}\b", text, re.MULTILINE), key
    assert max(map(len, text.splitlines())) <= 400


def test_no_such_kind():
    with pytest.raises(InputError, match='did you mean "contact"'):
        scene_template("contct")


def test_new_never_replaces_a_file(tmp_path):
    command = [sys.executable, "-m", "bem", "new", "contact", "mine.toml"]
    first = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert first.returncode == 0, first.stderr
    assert (tmp_path / "mine.toml").read_text() == scene_template("contact")
    (tmp_path / "mine.toml").write_text("mine")
    again = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert again.returncode == 4
    assert (tmp_path / "mine.toml").read_text() == "mine"


@pytest.mark.parametrize("kind", KINDS)
def test_resolved_scenes_fit_the_schema(kind):
    scene = load_scene(tomllib.loads(scene_template(kind)))
    schema = schema_of(kind)
    assert fits(scene.model_dump(mode="json", exclude_none=True), schema, schema)


def test_schema_command_prints_json(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "bem", "schema"], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    schema = json.loads(done.stdout)
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert schema["properties"]["kind"]["enum"] == list(kind_names())
    text = json.dumps(schema)
    for reference in re.findall(r'"#/\$defs/([^"]+)"', text):
        assert reference in schema["$defs"]
