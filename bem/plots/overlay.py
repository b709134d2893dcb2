"""Lines that can be laid over each other, out of any run's dataset.

A variable becomes one line for each case in it: over its own axis (speed, time, cycle, depth, place), averaged over
repetitions; maps are cut along x, particles are counted up by size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.plots.labels import in_celsius, key_words
from bem.plots.style import prefix
from bem.scenes.records import TELLING

AXES = ("time", "cycle", "speed", "depth", "interference", "iteration", "film_x", "x")
"""Dimensions that a line may run along, the first that a variable has."""
PLACED = {"asked": "separation_over_Sq"}
"""Dimensions whose places are a variable, each case having its own."""
COUNTED = ("particle",)
"""Dimensions without an order of their own: a line counts them up by size."""
CASES = (*TELLING, "model", "variant")
"""Figures that tell cases apart, beside dimensions of their own; any of them may be a case's place on the axis."""
_LEFT_OUT = ("sample", "component", "frame")
_PLACES = ("x", "film_x")
_MOST_CASES = 4


@dataclass(frozen=True)
class Line:
    """Abscissa and values (n,) of a case; `case` says which, empty where there is one only."""

    case: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class Panel:
    """A variable of one dataset as lines: title, names and units of both axes."""

    title: str
    along: str
    along_unit: str
    unit: str
    lines: tuple[Line, ...]


def panel(dataset: Any, name: str, *, row: int | None = None) -> Panel | None:
    """A variable as lines over its axis.

    Parameters
    ----------
    dataset : of a run.
    name : of a variable in it.
    row : where to cut maps, an index along y; None is the highest pressure's, or the middle.

    Returns
    -------
    Panel or None : None where the variable is no line (a single number, a stress tensor, a text).
    """
    variable = dataset[name]
    title = str(variable.attrs.get("long_name", name))
    dimensions = [str(d) for d in variable.dims]
    if not dimensions or variable.dtype.kind != "f" or set(dimensions) & set(_LEFT_OUT):
        return None
    if name in CASES or ("time" in dimensions and set(dimensions) & set(_PLACES)):
        return None  # what was asked for, and whole fields over time
    if dimensions[0] in COUNTED:
        return _counted(variable, title) if len(dimensions) == 1 else None
    if dimensions[-2:] == ["x", "y"]:
        if "depth" in dimensions:
            variable, title = variable.max(["x", "y"], keep_attrs=True), f"largest {title}"
        else:
            row = cut_at(dataset) if row is None else row
            where = f"y = {_value(dataset['y'][row])}" if "y" in dataset.coords else f"row {row}"
            variable, title = variable.isel(y=row), f"{title}, along x at {where}"
        dimensions = [str(d) for d in variable.dims]
    return _over_axis(dataset, variable, title)


def cut_at(dataset: Any) -> int:
    """Index along y at which to cut maps: through the highest pressure, else in the middle."""
    if "pressure" in dataset and dataset["pressure"].dims == ("x", "y"):
        return int(np.unravel_index(int(dataset["pressure"].values.argmax()), dataset["pressure"].shape)[1])
    return int(dataset.sizes["y"] // 2)


def _over_axis(dataset: Any, variable: Any, title: str) -> Panel | None:
    dimensions = [str(d) for d in variable.dims]
    along = (
        next((d for d in AXES if d in dimensions and d in dataset.coords), None)
        or next((d for d in dimensions if PLACED.get(d) in dataset), None)
        or next((d for d in dimensions if d in dataset.coords and dataset[d].dtype.kind in "if"), None)
    )
    axis = dataset[PLACED.get(along, along)] if along else _axis_of_cases(dataset, dimensions)
    if axis is None or axis.size < 2:
        return None
    grouped: dict[str, list[tuple[FloatArray, FloatArray]]] = {}
    others = [d for d in dimensions if d != along]
    for place in product(*(range(variable.sizes[d]) for d in others)):
        at = dict(zip(others, place, strict=True))
        words = _case(dataset, at, str(axis.name))
        one = variable.isel(at)
        values = np.atleast_1d(one.values).astype(float)
        x = np.atleast_1d(axis.isel({d: i for d, i in at.items() if d in axis.dims}).values).astype(float)
        grouped.setdefault(words, []).append((x, values))
    lines = []
    for words, found in list(grouped.items())[:_MOST_CASES]:
        if along:
            x, y = found[0][0], np.mean([values for _, values in found], axis=0)
        else:  # cases one behind the other on their own axis, repetitions averaged
            x, where = np.unique([x[0] for x, _ in found], return_inverse=True)
            y = np.bincount(where, [v[0] for _, v in found]) / np.bincount(where)
        if np.isfinite(y).any() and len(x) > 1:
            lines.append(Line(words, x, y))
    if len(grouped) > _MOST_CASES:
        title += f" (the first {_MOST_CASES} of {len(grouped)} cases)"
    words = key_words(str(axis.name), str(axis.attrs.get("long_name", axis.name)))
    lines = [
        Line(line.case, _shown(line.x, axis, str(axis.name))[0], _shown(line.y, variable, str(variable.name))[0])
        for line in lines
    ]
    along_unit, unit = (_shown(0.0, item, str(item.name))[1] for item in (axis, variable))
    return Panel(title, words, along_unit, unit, tuple(lines)) if lines else None


def _axis_of_cases(dataset: Any, dimensions: Sequence[str]) -> Any:
    """Return an axis for cases without one of their own: the first number that varies among them."""
    for name in CASES:
        if name not in dataset or list(dataset[name].dims) != list(dimensions) or dataset[name].dtype.kind != "f":
            continue
        if np.ptp(dataset[name].values) > 0:
            return dataset[name]
    return None


def _case(dataset: Any, at: dict[str, int], axis: str) -> str:
    """Describe the difference of a case from the others; repetitions are not told apart."""
    words = []
    for dimension, index in at.items():
        if dimension == "repetition":
            continue
        if dimension in dataset.coords:
            if dataset.sizes[dimension] > 1:
                words.append(_value(dataset[dimension][index]))
            continue
        for name in CASES:
            if name != axis and name in dataset and dataset[name].dims == (dimension,):
                values = dataset[name].values
                if any(value != values[0] for value in values):
                    words.append(_value(dataset[name][index]))
    return ", ".join(words)


def _counted(variable: Any, title: str) -> Panel | None:
    sizes = np.sort(variable.values[np.isfinite(variable.values)])
    if len(sizes) < 2:
        return None
    share = (np.arange(len(sizes)) + 1) / len(sizes)
    unit = _unit(variable)
    return Panel(title, title, unit, "share not larger", (Line("", sizes, share),))


def _shown(values: Any, item: Any, name: str) -> tuple[Any, str]:
    """Values in the unit that is shown, temperatures in °C, and that unit."""
    return in_celsius(values, _unit(item), name, str(item.attrs.get("long_name", "")))


def _unit(variable: Any) -> str:
    unit = str(variable.attrs.get("units", ""))
    return "" if unit == "1" else unit


def _value(item: Any) -> str:
    """A scalar of a dataset with its unit."""
    value = item.values.item()
    if isinstance(value, str):
        return value.replace("_", " ")
    value, unit = _shown(value, item, str(item.name))
    factor, unit = prefix([value], unit)
    return f"{value * factor:.4g} {unit}".rstrip()
