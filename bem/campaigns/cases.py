"""From a scene to its cases: what `[over]` names, what the kind's own lists hold, and repetitions of each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from bem.errors import InputError
from bem.quantities import si
from bem.scenes.axes import Axis
from bem.scenes.common import SceneModel
from bem.scenes.kind import Kind, get_kind
from bem.scenes.load import scene_table, scenes_over, unit_at
from bem.scenes.paths import parse_key, value_at
from bem.scenes.records import Figure
from bem.scenes.uncertain import deviations, has_number

REPETITION = "repetition"
_MOST_CASES = 100_000


@dataclass(frozen=True)
class Case:
    """One case of a campaign.

    Attributes
    ----------
    index : place in the campaign, the last axis running fastest.
    scene : with one value of everything that runs.
    repetition : which; enters the seeds.
    repeated : whether seeds carry the repetition at all.
    label : what tells it from the others, such as "load 5 N, repetition 2"; empty for the only one.
    """

    index: int
    scene: SceneModel
    repetition: int
    repeated: bool
    label: str


@dataclass(frozen=True)
class Campaign:
    """A scene and all its cases, in the order of `axes`, the last one running fastest.

    base : the resolved scene at the first values of `over`; the scene itself where nothing is given there.
    """

    kind: Kind
    scene: SceneModel
    base: SceneModel
    axes: tuple[Axis, ...]
    cases: tuple[Case, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Count of values of each axis."""
        return tuple(len(axis) for axis in self.axes)


def campaign_of(scene: SceneModel) -> Campaign:
    """The cases of a scene: all combinations of the values of `over`, of the kind's own lists, and repetitions.

    Raises
    ------
    InputError : too many of them; values of `over` that make a bad scene, or lists of another length; an uncertain key
        that no case has, or whose deviation is none of a case.
    """
    kind = get_kind(scene.kind)
    bases = [kind.resolved(one) for one in scenes_over(scene)]
    inner = [_own_axes(kind, base) for base in bases]
    if len({tuple(len(axis) for axis in axes) for axes in inner}) > 1:
        raise InputError("over: its values change how long the scene's own lists are; allowed: lists of one length")
    axes = (*axes_of_keys(scene.over or {}, bases), *_common(inner))
    if math.prod(len(axis) for axis in axes) > _MOST_CASES:
        raise InputError(f"scene: {math.prod(map(len, axes))} cases; allowed: {_MOST_CASES} in all combinations")
    cases = []
    outer = len(axes) - len(inner[0])
    for index, place in enumerate(product(*(range(len(axis)) for axis in axes))):
        at = index // math.prod(len(axis) for axis in inner[0])
        own, repetition = bases[at], 0
        for axis, i in zip(inner[at], place[outer:], strict=True):
            own = axis.pick(own, i)
            repetition = i if axis.name == REPETITION else repetition
        cases.append(Case(index, own, repetition, _seeds_are_numbered(scene, repetition), label_of(axes, place)))
    return Campaign(kind, scene, bases[0], axes, _with_uncertain_keys(scene, cases))


def _with_uncertain_keys(scene: SceneModel, cases: Sequence[Case]) -> tuple[Case, ...]:
    """Return the cases, each with the uncertain keys that it has: a case with another law has not all of its keys.

    Raises
    ------
    InputError : a key that no case has, such as one in a list that the cases replace; a deviation that is none.
    """
    keys = list(scene.uncertain or ())
    if not keys:
        return tuple(cases)
    found: list[Case] = []
    there: set[str] = set()
    for case in cases:
        own = {key: given for key, given in (case.scene.uncertain or {}).items() if has_number(case.scene, key)}
        there.update(own)
        changed = case.scene.model_copy(update={"uncertain": own or None})
        deviations(changed)  # refuses deviations that are none of this case
        found.append(replace(case, scene=changed))
    missing = [key for key in keys if key not in there]
    if missing:
        raise InputError(
            [
                f'uncertain."{key}": the cases take their own values from this list; allowed: the key of the scene '
                "that they set, such as lower.surface.rms_height for variants[0].lower_rms_height"
                for key in missing
            ]
        )
    return tuple(found)


def _own_axes(kind: Kind, scene: SceneModel) -> tuple[Axis, ...]:
    repeats = _repetitions(scene)
    return tuple(kind.axes(scene)) if repeats is None else (*kind.axes(scene), repeats)


def _common(inner: Sequence[Sequence[Axis]]) -> list[Axis]:
    """The kind's own axes; where `over` changes the values along one, they are counted instead."""
    found = []
    for same in zip(*inner, strict=True):
        if len({axis.values for axis in same}) == 1:
            found.append(same[0])
        else:
            number = Figure("", f"number of the {same[0].name}, whose values differ")
            found.append(Axis(same[0].name, tuple(range(len(same[0]))), number, same[0].pick))
    return found


def axes_of_keys(over: Mapping[str, Sequence[Any]], scenes: Sequence[SceneModel]) -> list[Axis]:
    """Keys with their values as the scenes at all combinations understood them, in SI units; as they were written
    where these are no different numbers.

    over : the keys with what was given. scenes : resolved, the last key running fastest.
    """
    axes: list[Axis] = []
    counts = [len(values) for values in over.values()]
    for number, (key, given) in enumerate(over.items()):
        step = math.prod(counts[number + 1 :])
        found = [_value(scene_table(scenes[i * step]), key) for i in range(len(given))]
        numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in found)
        if numbers and len(set(found)) == len(found):
            values, unit = tuple(found), unit_at(scenes[0], key)
        else:
            values, unit = tuple(str(value).strip("\"'") for value in given), "1"
        axes.append(Axis(key, values, Figure("", key), lambda scene, i: scene, unit=unit))
    return axes


def _value(table: Mapping[str, Any], key: str) -> Any:
    """Return the value at a key; one value where it stands for both axes."""
    value = value_at(table, parse_key(key) or ())
    if isinstance(value, list) and value and all(item == value[0] for item in value):
        return value[0]
    return value


def label_of(axes: Sequence[Axis], place: Sequence[int | None]) -> str:
    """Describe a place: "load 5 N, repetition 2"; axes of one value and those with None are left out."""
    words = [_words(axis, i) for axis, i in zip(axes, place, strict=True) if i is not None and len(axis) > 1]
    return ", ".join(words)


def _words(axis: Axis, i: int) -> str:
    value, unit = axis.figure.shown(axis.values[i]), axis.figure.written or axis.unit.replace("1", "")
    if unit == "m" and isinstance(value, float):
        return f"{axis.name} {si(value, unit, 4)}"
    number = f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"{axis.name} {number} {unit}".rstrip()


def _repetitions(scene: SceneModel) -> Axis | None:
    if scene.repetitions is None:
        return None
    values = tuple(range(scene.repetitions))
    return Axis(REPETITION, values, Figure("", "repetition"), lambda scene, i: _once(scene), always=False)


def _once(scene: SceneModel) -> Any:
    return scene.model_copy(update={"repetitions": 1})


def _seeds_are_numbered(scene: SceneModel, repetition: int) -> bool:
    """A scene that says nothing of repetitions has seeds without a number, and so has the first of its repetitions;
    kinds that always have repetitions number all of them."""
    always = type(scene).model_fields["repetitions"].default is not None
    return always or repetition > 0
