"""Scenes to start from, and their JSON Schema."""

import json
import re
import subprocess
import sys
import tomllib
from functools import cache

import pytest

from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes import get_kind, kind_names, library
from bem.scenes.load import load_scene
from bem.scenes.schema import scene_schema
from bem.scenes.template import scene_template

KINDS = [name for name in kind_names() if any(table["kind"] == name for table in library().values())]

schema_of = cache(scene_schema)  # one for each kind, and the one of all kinds, serve every test


def fits(value, schema, root):
    """Whether a value satisfies a JSON schema: the part of the standard that our schemas use."""
    if "$ref" in schema:
        found = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            found = found[part]
        return fits(value, found, root)
    kinds = {
        "object": isinstance(value, dict),
        "array": isinstance(value, list),
        "string": isinstance(value, str),
        "boolean": isinstance(value, bool),
        "integer": isinstance(value, int) and not isinstance(value, bool),
        "number": isinstance(value, int | float) and not isinstance(value, bool),
        "null": value is None,
    }
    checks = [
        "type" not in schema or kinds[schema["type"]],
        "const" not in schema or value == schema["const"],
        "enum" not in schema or value in schema["enum"],
        "anyOf" not in schema or any(fits(value, item, root) for item in schema["anyOf"]),
        "oneOf" not in schema or sum(fits(value, item, root) for item in schema["oneOf"]) == 1,
    ]
    if isinstance(value, dict):
        known = schema.get("properties", {})
        checks.append(all(key in value for key in schema.get("required", ())))
        checks.append(all(fits(item, known[key], root) for key, item in value.items() if key in known))
        if schema.get("additionalProperties") is False:
            checks.append(value.keys() <= known.keys())
    if isinstance(value, list):
        checks.append(schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)))
        rows = schema.get("prefixItems", [schema["items"]] * len(value) if "items" in schema else [])
        checks.append(all(fits(item, row, root) for item, row in zip(value, rows, strict=False)))
    if kinds["number"]:
        checks.append(value >= schema.get("minimum", value))
        checks.append(value <= schema.get("maximum", value))
        checks.append(value > schema.get("exclusiveMinimum", value - 1))
        checks.append(value < schema.get("exclusiveMaximum", value + 1))
    if isinstance(value, str):
        checks.append(re.search(schema.get("pattern", ""), value) is not None)
    return all(checks)


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


@pytest.mark.parametrize("name", sorted(library()))
def test_built_in_scenes_fit_the_schema(name):
    table = library()[name]
    for schema in (schema_of(table["kind"]), schema_of()):
        assert fits(table, schema, schema), name
        assert not fits(table | {"sead": 1}, schema, schema)
        assert not fits(table | {"seed": -1}, schema, schema)
        assert not fits(table | {"kind": "nothing"}, schema, schema)
        assert not fits(table | {"lower": {"material": "steel-disc"}}, schema, schema)


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
