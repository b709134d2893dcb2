"""From a scene to its cases: what `[over]` names, what the kind's own lists hold, and repetitions of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from bem.errors import InputError
from bem.scenes.axes import Axis
from bem.scenes.common import SceneModel
from bem.scenes.kinds import Kind, get_kind
from bem.scenes.records import Figure

REPETITION = "repetition"
_MOST_CASES = 100_000


@dataclass(frozen=True)
class Case:
    """One case of a campaign.

    Parameters
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
    """A scene and all its cases, in the order of `axes`, the last one running fastest."""

    kind: Kind
    scene: SceneModel
    axes: tuple[Axis, ...]
    cases: tuple[Case, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values each axis has."""
        return tuple(len(axis) for axis in self.axes)


def campaign_of(scene: SceneModel) -> Campaign:
    """The cases of a resolved scene.

    Raises
    ------
    InputError : too many of them.
    """
    kind = get_kind(scene.kind)
    if kind.record is None:
        return Campaign(kind, scene, (), (Case(0, scene, 0, False, ""),))
    axes = tuple(kind.axes(scene))
    repeats = _repetitions(scene)
    if repeats is not None:
        axes = (*axes, repeats)
    count = 1
    for axis in axes:
        count *= len(axis)
    if count > _MOST_CASES:
        raise InputError(f"scene: {count} cases; allowed: {_MOST_CASES}, all combinations taken together")
    cases = [
        _case(index, scene, axes, place) for index, place in enumerate(product(*(range(len(axis)) for axis in axes)))
    ]
    return Campaign(kind, scene, axes, tuple(cases))


def _case(index: int, scene: SceneModel, axes: Sequence[Axis], place: Sequence[int]) -> Case:
    own = scene
    repetition = 0
    for axis, i in zip(axes, place, strict=True):
        own = axis.pick(own, i)
        if axis.name == REPETITION:
            repetition = i
    return Case(index, own, repetition, _seeds_are_numbered(scene, repetition), label_of(axes, place))


def label_of(axes: Sequence[Axis], place: Sequence[int | None]) -> str:
    """What is at a place, in words: "load 5 N, repetition 2"; axes of one value and those with None are left out."""
    words = [_words(axis, i) for axis, i in zip(axes, place, strict=True) if i is not None and len(axis) > 1]
    return ", ".join(words)


def _words(axis: Axis, i: int) -> str:
    value, unit = axis.figure.shown(axis.values[i]), axis.figure.unit.replace("_", "/")
    number = f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"{axis.name} {number} {'degC' if unit == 'C' else unit}".rstrip()


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
