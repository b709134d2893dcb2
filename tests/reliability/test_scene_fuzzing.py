"""Scene files of every kind, damaged at random: a scene, or an InputError with one line per mistake; nothing else."""

import re
import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes import library
from bem.scenes.load import library_text

NAMES = sorted(library())
HOSTILE = [
    *("nan", "inf", "-inf", "0", "-1", "1e308", "-1e308", "1e-308", "9" * 400, "true", "[]", "{}", "[[[]]]", '""'),
    *('"10 N"', '"1 um"', '"1e999 m"', '"1 um um um"', '"(((((m)))))"', '"m**9**9**9"', '"1 m^99999999"', '"∞ m"'),
    *("\"__import__('os').system('false')\"", '"${HOME}"', '"../../../etc/passwd"', '"/dev/zero"', '"\\u0000"'),
    *("1979-05-27T07:32:00Z", "[1, 2, 3, 4]", '["a", 1, {b = 2}]', '"' + "x" * 5000 + '"', "0x7fffffffffffffff"),
]
_VALUE = re.compile(r"(?<== )[^#\n]+")
SLOWLY = [pytest.param(value, marks=pytest.mark.slow) for value in (-1.0, 0, "", {}, True)]
SLOW = 5.0
"""Seconds of processor time that no scene may need to be planned or refused: a hundred times the usual."""


@st.composite
def damaged(draw):
    """The text of a built-in scene with a few values, lines or characters changed."""
    text = library_text(draw(st.sampled_from(NAMES)))
    for _ in range(draw(st.integers(1, 3))):
        lines = text.splitlines()
        place = draw(st.integers(0, len(lines) - 1))
        what = draw(st.sampled_from(["value", "value", "value", "drop", "twice", "key", "noise"]))
        if what == "value":
            value = draw(st.sampled_from(HOSTILE))
            lines[place] = _VALUE.sub(lambda _, value=value: value, lines[place], count=1)
        elif what == "drop":
            del lines[place]
        elif what == "twice":
            lines.insert(place, lines[draw(st.integers(0, len(lines) - 1))])
        elif what == "key":
            lines[place] = "x" + lines[place]
        else:
            lines[place] = draw(st.text(max_size=12)) + lines[place]
        text = "\n".join(lines) + "\n"
    return text


@given(damaged())
@settings(deadline=None, max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_damaged_scene_is_planned_or_refused_in_words(tmp_path, text):
    file = tmp_path / "scene.toml"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    start = time.process_time()
    try:
        _, plan = plan_scene(file)
    except InputError as error:
        assert error.messages  # noqa: PT017
        assert all(message and "\n" not in message for message in error.messages)  # noqa: PT017
    else:
        assert plan.steps
        assert plan.memory >= 0
    assert time.process_time() - start < SLOW
    assert [item.name for item in tmp_path.iterdir()] == ["scene.toml"]


@given(st.binary(max_size=300))
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_bytes_are_refused_in_words(tmp_path, content):
    file = tmp_path / "scene.toml"
    file.write_bytes(content)
    with pytest.raises(InputError):
        plan_scene(file)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("hostile", [1e308, float("nan"), [], *SLOWLY])
def test_every_value_of_every_scene_may_be_wrong(name, hostile):
    """Each leaf in turn, replaced: what is left is a scene that can be planned, or words."""
    for path in leaves(library()[name]):
        data = library()[name] | {"name": name}
        table = data
        for part in path[:-1]:
            table = table[part]
        table[path[-1]] = hostile
        try:
            _, plan = plan_scene(data)
        except InputError as error:
            assert all(message and "\n" not in message for message in error.messages), path  # noqa: PT017
        else:
            assert plan.memory >= 0, path


def leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    found = [leaf for key, item in items for leaf in leaves(item, (*path, key))]
    return found or ([path] if path else [])
