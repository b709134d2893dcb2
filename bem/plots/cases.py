"""The cases of a run, for figures: what tells them apart, and their values with the repetitions together.

A dataset's attribute `axes` names the dimensions along which the cases lie (load, variant, repetition, ...).
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.campaigns.cases import REPETITION
from bem.physical_constants import ZERO_CELSIUS
from bem.plots.labels import key_words, prefix
from bem.results.arrays import Arrays
from bem.scenes.context import Variable
from bem.scenes.kind import get_kind
from bem.scenes.records import Series, described, figures

_PLACES = frozenset(("x", "y", "film_x", "frame"))
"""Axes of maps, films and sections."""
_NAMED = ("m", "Pa")
"""Units of axes that say too little without the axis' name."""
Array = NDArray[Any]


def axes_of(dataset: Any) -> list[str]:
    """Dimensions along which the cases lie."""
    return str(dataset.attrs.get("axes", "")).split()


def first_case(dataset: Any) -> Any:
    """The arrays of the first case alone, for figures that know only one; what has no axes stays as it is."""
    axes = set(axes_of(dataset))
    if not axes:
        return dataset

    def first(item: Any) -> Variable:
        kept = tuple(slice(None) if name not in axes else 0 for name in item.dims)
        dims = tuple(name for name in item.dims if name not in axes)
        shape = tuple(n for n, name in zip(item.shape, item.dims, strict=True) if name not in axes)
        units, description = (str(item.attrs.get(key, "")) for key in ("units", "long_name"))
        return Variable(dims, lambda: np.asarray(item.values[kept]), units, description, shape=shape)

    one = {name: first(dataset[name]) for name in dataset.variables if name not in axes}
    return Arrays(one, {**dataset.attrs, "axes": ""})


def case_shown(data: Any, kind: str, names: Sequence[str]) -> str:
    """Describe the case that variables are of, in words with units, such as "0.01 m/s, 5.5 N"; empty for a single
    case.

    Parameters
    ----------
    data : arrays of a run.
    kind : of the run.
    names : variables that are drawn together; those that keep the first or the last case alone decide.
    """
    known = described(get_kind(kind).record) if kind else {}
    series = [item for name in names if isinstance(item := known.get(name), Series)]
    kept = {item.of for item in series if item.of != "each" and not _PLACES.isdisjoint(item.dimensions)}
    if not kept:
        return ""
    return case_words(data, "last" if "last" in kept else "first", speed="shown_speed" in known)


def case_words(data: Any, of: str = "first", *, speed: bool = False) -> str:
    """The first or last case in words: speed shown (of curves over speed), load, and what differs between cases."""
    axes = [axis for axis in axes_of(data) if axis in data.sizes]
    place = [0 if of == "first" else data.sizes[axis] - 1 for axis in axes]
    words = [value_words(data["shown_speed"], ())] if speed and "shown_speed" in data.variables else []
    for axis, i in zip(axes, place, strict=True):
        if axis == "load" and speed and data.sizes[axis] == 1 and axis in data.variables:
            words.append(value_words(data[axis], i))
        elif axis in data.variables:
            name = f"{key_words(axis.rsplit('.', 1)[-1])} " if data[axis].attrs.get("units") in _NAMED else ""
            words.append(name + value if (value := label_of(data, (axis,), (i,))) else "")
        elif data.sizes[axis] > 1:
            words.append(f"{axis.replace('_', ' ')} {i + 1}")
    return ", ".join(word for word in words if word)


def first_figures(summary: Mapping[str, Any]) -> dict[str, Any]:
    """A summary with the figures of the first case alone, where there are lists over cases."""
    known = figures(get_kind(summary["kind"]).record)
    return {key: value[0] if key in known and isinstance(value, list) else value for key, value in summary.items()}


def grouped(run: Any, name: str) -> list[tuple[str, Array]]:
    """Label and values (repetition, ...) of each case; the label says only what differs, if anything."""
    values, dimensions = run.dataset[name].values, list(run.dataset[name].dims)
    if REPETITION in dimensions:
        values = np.moveaxis(values, dimensions.index(REPETITION), 0)
        dimensions.remove(REPETITION)
    else:
        values = values[np.newaxis]
    outer = [axis for axis in axes_of(run.dataset) if axis in dimensions]
    values = np.moveaxis(values, [1 + dimensions.index(axis) for axis in outer], range(1, 1 + len(outer)))
    return [(label_of(run.dataset, outer, place), values[(slice(None), *place)]) for place in _places(run, outer)]


def rows_of(run: Any, name: str) -> list[tuple[str, Array]]:
    """The same of rows that follow one another, as of particles: label and values (rows,) of each case, all repetitions
    together."""
    (dimension,) = run.dataset[name].dims
    case, axes = run.dataset[f"{dimension}_case"].values, axes_of(run.dataset)
    repetitions = run.dataset.sizes[REPETITION] if REPETITION in axes else 1
    outer = [axis for axis in axes if axis != REPETITION]
    return [
        (label_of(run.dataset, outer, place), run.dataset[name].values[case // repetitions == index])
        for index, place in enumerate(_places(run, outer))
    ]


def along(run: Any, name: str, axis: str) -> tuple[Array, Array, Array, Array]:
    """Values of an axis in rising order, and mean, least and largest of a figure at each, over everything else; not a
    number where nothing is known, as of a speed that failed."""
    order = np.argsort(run.dataset[axis].values)
    values = np.moveaxis(run.dataset[name].values, list(run.dataset[name].dims).index(axis), 0)
    rows = values.reshape(len(values), -1)[order]
    each = run.dataset[axis].values[order]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of rows without a number
        return each, np.nanmean(rows, axis=1), np.nanmin(rows, axis=1), np.nanmax(rows, axis=1)


def many_speeds(run: Any) -> bool:
    """Return True if there is a curve over speed to draw, not one point."""
    return bool(run.dataset.sizes["speed"] > 1)


def redoes(run: Any, source: str) -> bool:
    """Return True if the scene redoes a part of a source, such as "paper C": what was measured there says nothing of
    other contacts."""
    return source in run.scene.get("redoes", "")


def label_of(dataset: Any, axes: Sequence[str], place: Sequence[int]) -> str:
    """Describe a place along axes with more than one value; a number without a unit has its name."""
    words = []
    for axis, i in zip(axes, place, strict=True):
        if dataset.sizes[axis] > 1:
            bare = dataset[axis].values.dtype.kind in "if" and str(dataset[axis].attrs.get("units", "1")) == "1"
            name = f"{key_words(axis.rsplit('.', 1)[-1])} " if bare else ""
            words.append(name + value_words(dataset[axis], i))
    return ", ".join(words)


def value_words(item: Any, i: Any) -> str:
    """A value of an axis with its unit; index () of a single number."""
    value = item.values[i]
    unit = str(item.attrs.get("units", "1"))
    if isinstance(value, bytes | str):
        return value.decode() if isinstance(value, bytes) else str(value)
    if unit == "K":
        return f"{value - ZERO_CELSIUS:.4g} °C"
    if unit == "m/s":  # as on the axes of curves over speed
        return f"{value:.4g} m/s"
    if unit == "1":
        return f"{value:.4g}" if isinstance(value, float) else str(value)
    factor, shown = prefix([value], unit)
    return f"{value * factor:.4g} {shown}"


def _places(run: Any, axes: Sequence[str]) -> Iterator[tuple[int, ...]]:
    return product(*(range(run.dataset.sizes[axis]) for axis in axes))
