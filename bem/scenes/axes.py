"""Axes of a scene as its kind declares them: loads, variants, temperatures, speeds, ...

A kind knows one case. `Kind.axes(scene)` says in which keys a scene holds several, and how to make the scene of one:

    def axes(scene):
        return (listed(scene, "cylinder.loads", "load", Figure("N", "load on the full width")),)

`bem.campaigns` takes all combinations, the last axis running fastest, and the repetitions of each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from bem.scenes.records import Figure

Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class Axis:
    """One thing that runs.

    Attributes
    ----------
    name : the dimension in the dataset, and with the figure's unit the key of the summary.
    values : of each place: numbers in SI units, or texts.
    figure : unit and label of the values.
    pick : pick(scene, i) -> the scene with only the i-th.
    always : whether the summary says it even where there is nothing to tell.
    unit : SI unit of the values, where it is not that of the figure.
    """

    name: str
    values: tuple[Any, ...]
    figure: Figure
    pick: Callable[[Any, int], Any] = field(compare=False)
    always: bool = True
    unit: str = ""

    @property
    def si(self) -> str:
        """The SI unit of the values."""
        return self.unit or self.figure.si

    def __len__(self) -> int:
        return len(self.values)


def listed(scene: Any, key: str, name: str, figure: Figure) -> Axis:
    """The axis of a list of numbers at a dotted key of the scene."""
    place = scene
    for part in key.split("."):
        place = getattr(place, part)
    values = tuple(place)
    return Axis(name, values, figure, lambda scene, i: changed(scene, key, [values[i]]))


def variants(
    scene: Any,
    change: Callable[[Any, Any], Any] = lambda scene, variant: variant.applied(scene),
    unnamed: str = "",
    always: bool = False,
) -> Axis:
    """The axis of the named tables in `variants`; `change(scene, variant)` makes the scene of one.

    unnamed : what a scene without variants is called. always : whether its summary says so.
    """
    key = "variants"
    found: Sequence[Any] = getattr(scene, key)

    def pick(scene: Any, i: int) -> Any:
        return changed(change(scene, found[i]), key, []) if found else scene

    names = tuple(item.name for item in found) or (unnamed,)
    return Axis("variant", names, Figure("", "variant"), pick, always=bool(found) or always)


def over_last(count: int, axes: Sequence[Axis], each: Sequence[Any]) -> tuple[list[tuple[Any, ...]], NDArray[Any]]:
    """The values of the last axes, so many, and what there is of each case as an array of objects over them, of the
    first place along the others."""
    last = axes[-count:]
    table = np.empty(len(each), dtype=object)
    table[:] = each
    return [axis.values for axis in last], table.reshape(-1, *(len(axis) for axis in last))[0]


def with_keys(table: Model, values: Mapping[str, Any]) -> Model:
    """A table of a scene with other values at dotted keys."""
    for key, value in values.items():
        table = changed(table, key, value)
    return table


def changed(table: Model, key: str, value: Any) -> Model:
    """A table of a scene with another value at a dotted key."""
    name, _, rest = key.partition(".")
    return table.model_copy(update={name: changed(getattr(table, name), rest, value) if rest else value})
