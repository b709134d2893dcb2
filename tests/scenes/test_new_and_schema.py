"""Scenes to start from, and their JSON Schema."""

import json
import re
import tomllib

import pytest
from command_line import run_command
from json_schemas import fits, schema_of

from bem.errors import InputError
from bem.notes import Level
from bem.runs import plan_scene
from bem.scenes import kind_names, library
from bem.scenes.checks import examine, scene_warnings
from bem.scenes.form import keys_of_kind
from bem.scenes.load import load_scene
from bem.scenes.template import scene_template

KINDS = [name for name in kind_names() if any(table["kind"] == name for table in library().values())]


MOST_KEYS = 28
"""Lines of keys in a new scene: about as many as fit on a screen with their headings."""


def key_lines(text):
    """Lines `key = value`, behind a # or not, without their comments."""
    found = re.findall(r"^(?:# )?([a-zA-Z0-9_]+ = .*)$", text, re.MULTILINE)
    return [line.partition("  # ")[0] for line in found]


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_scene_runs_as_it_is_without_a_caution(kind):
    scene, plan = plan_scene(tomllib.loads(scene_template(kind)))
    assert scene.kind == kind
    assert plan.steps
    assert [note.code for note in scene_warnings(examine(scene)) if note.level is not Level.INFO] == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_scene_has_the_keys_that_every_user_sets_with_their_meaning(kind):
    text = scene_template(kind)
    assert len(key_lines(text)) <= MOST_KEYS
    entries = list(entries_of(keys_of_kind(kind)))
    laws = {entry.key for entry in entries if entry.is_law}  # their parameters stand on the law's line
    given = {key for key in values_of(tomllib.loads(text)) if key.rpartition(".")[0] not in laws}
    said = re.sub(r"\s+(# )?", " ", text)
    basic = {entry.key: entry for entry in entries if entry.level == "basic"}
    for key in given - {"kind"}:
        assert basic[key].description.rstrip(".") in said, key


@pytest.mark.parametrize("kind", KINDS)
def test_all_keys_are_in_the_long_scene_which_is_the_same_scene(kind):
    long = scene_template(kind, everything=True)
    assert load_scene(tomllib.loads(long)) == load_scene(tomllib.loads(scene_template(kind)))
    names = {line.partition(" = ")[0] for line in key_lines(long)}
    headings = {name for path in re.findall(r"^(?:# )?\[+([\w.]+)\]", long, re.MULTILINE) for name in path.split(".")}
    for entry in entries_of(keys_of_kind(kind)):
        assert entry.last in names | headings, entry.key
    for line in key_lines(long):
        assert tomllib.loads(line), line


@pytest.mark.parametrize("name", ["hertz-sphere", "stribeck-ball-on-disc"])
def test_a_built_in_scene_has_no_long_form(name):
    with pytest.raises(InputError, match="is a built-in scene"):
        scene_template(name, everything=True)


def entries_of(table):
    """Entries of a table, those of inner tables after their own."""
    for entry in table.entries:
        yield entry
        for inner in (*entry.tables, *([entry.rows] if entry.rows else [])):
            yield from entries_of(inner)


def values_of(table, prefix=""):
    """Dotted keys of a scene's table."""
    found = set()
    for key, value in table.items():
        found.add(f"{prefix}{key}")
        if isinstance(value, dict):
            found |= values_of(value, f"{prefix}{key}.")
    return found


def test_no_such_kind():
    with pytest.raises(InputError, match='did you mean "contact"'):
        scene_template("contct")


def test_new_never_replaces_a_file(tmp_path):
    command = ("new", "contact", "mine.toml")
    first = run_command(*command, cwd=tmp_path)
    assert first.returncode == 0, first.stderr
    assert (tmp_path / "mine.toml").read_text() == scene_template("contact")
    (tmp_path / "mine.toml").write_text("mine")
    again = run_command(*command, cwd=tmp_path)
    assert again.returncode == 4
    assert (tmp_path / "mine.toml").read_text() == "mine"


@pytest.mark.parametrize("kind", KINDS)
def test_resolved_scenes_fit_the_schema(kind):
    scene = load_scene(tomllib.loads(scene_template(kind)))
    schema = schema_of(kind)
    assert fits(scene.model_dump(mode="json", exclude_none=True), schema, schema)


def test_schema_command_prints_json(tmp_path):
    done = run_command("schema", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    schema = json.loads(done.stdout)
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert schema["properties"]["kind"]["enum"] == list(kind_names())
    text = json.dumps(schema)
    for reference in re.findall(r'"#/\$defs/([^"]+)"', text):
        assert reference in schema["$defs"]
