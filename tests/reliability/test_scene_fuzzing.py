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
NUMBERS = [1e308, float("nan"), -1.0, 0]
OTHERS = [True, "", [], {}, "1e999 m"]
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


@pytest.mark.internal
@given(damaged())
@settings(
    deadline=None, max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
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
@settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
def test_any_bytes_are_refused_in_words(tmp_path, content):
    file = tmp_path / "scene.toml"
    file.write_bytes(content)
    with pytest.raises(InputError):
        plan_scene(file)


def general(path):
    """The path without the numbers of list items."""
    return tuple(part for part in path if isinstance(part, str))


def leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    found = [leaf for key, item in items for leaf in leaves(item, (*path, key))]
    return found or ([path] if path else [])


PLACES: dict[tuple[str, tuple[str, ...]], list[str]] = {}
"""Names of the scenes that have a leaf, by the kind of the scene and the path of the leaf."""
for _name, _table in library().items():
    for _leaf in leaves(_table):
        _scenes = PLACES.setdefault((_table["kind"], general(_leaf)), [])
        if _name not in _scenes:
            _scenes.append(_name)


def check_replaced(name, replaced):
    """Plan a scene of the library with replaced leaves: it is planned or refused in words, in reasonable time."""
    scene = library()[name] | {"name": name}
    for path, value in replaced.items():
        for leaf in [leaf for leaf in leaves(scene) if general(leaf) == path]:
            table = scene
            for part in leaf[:-1]:
                table = table[part]
            table[leaf[-1]] = value
    start = time.process_time()
    try:
        _, plan = plan_scene(scene)
    except InputError as error:
        assert error.messages  # noqa: PT017
        assert all(message and "\n" not in message for message in error.messages)  # noqa: PT017
    else:
        assert all(step.memory >= 0 for step in plan.steps)
        assert plan.memory >= 0
    assert time.process_time() - start < SLOW


def wrong_leaves():
    """For each leaf of each kind, scene and two values, of `NUMBERS` and `OTHERS`; and the rest of both for each path.

    Kinds that share the path of a leaf share its values: together they have all of both lists.
    """
    paths: dict[tuple[str, ...], list[list[str]]] = {}
    for (_, path), names in sorted(PLACES.items()):
        paths.setdefault(path, []).append(names)
    once, rest = [], []
    for offset, (path, kinds) in enumerate(sorted(paths.items())):
        for values in (NUMBERS, OTHERS):
            for turn in range(max(len(kinds), len(values))):
                names = kinds[turn % len(kinds)]
                found = (names[(turn + offset) % len(names)], path, values[(turn + offset) % len(values)])
                (once if turn < len(kinds) else rest).append(found)
    return {"each-kind": once, "all-values": rest}


@pytest.mark.parametrize("part", ["each-kind", pytest.param("all-values", marks=pytest.mark.slow)])
def test_every_leaf_of_every_kind_may_be_wrong(part):
    """Each leaf of each kind of scene is replaced by a hostile number and by a value of another type.

    Both parts together give every value to the leaf of every path.
    """
    for name, path, value in wrong_leaves()[part]:
        check_replaced(name, {path: value})


@given(data=st.data())
@settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.too_slow])
def test_some_leaves_of_any_scene_may_be_wrong(data):
    name = data.draw(st.sampled_from(NAMES))
    paths = sorted({general(leaf) for leaf in leaves(library()[name])})
    replaced = st.dictionaries(st.sampled_from(paths), st.sampled_from([*NUMBERS, *OTHERS]), min_size=1, max_size=3)
    check_replaced(name, data.draw(replaced))
