"""The cases of a run, for figures: what tells them apart, and their values with the repetitions together.

A dataset's attribute `axes` names the dimensions along which the cases lie (load, variant, repetition, ...).
"""

from __future__ import annotations

from itertools import product
from typing import Any

from numpy.typing import NDArray

from bem.plots.style import prefix

REPETITION = "repetition"
Array = NDArray[Any]


def axes_of(dataset: Any) -> list[str]:
    """Dimensions along which the cases lie."""
    return str(dataset.attrs.get("axes", "")).split()


def grouped(run: Any, name: str) -> list[tuple[str, Array]]:
    """Label and values (repetition, ...) of each case; the label says only what differs, if anything."""
    variable = run.dataset[name]
    outer = [axis for axis in axes_of(run.dataset) if axis in variable.dims and axis != REPETITION]
    found = []
    for place in product(*(range(run.dataset.sizes[axis]) for axis in outer)):
        at = dict(zip(outer, place, strict=True))
        values = variable.isel(at)
        if REPETITION not in values.dims:
            values = values.expand_dims(REPETITION)
        words = [value_words(run.dataset[axis][i]) for axis, i in at.items() if run.dataset.sizes[axis] > 1]
        found.append((", ".join(words), values.transpose(REPETITION, ...).values))
    return found


def rows_of(run: Any, name: str) -> list[tuple[str, Array]]:
    """The same of rows that follow one another, as of particles: label and values (rows,) of each case, all repetitions
    together."""
    variable = run.dataset[name]
    (dimension,) = variable.dims
    case = run.dataset[f"{dimension}_case"].values
    axes = axes_of(run.dataset)
    repetitions = run.dataset.sizes[REPETITION] if REPETITION in axes else 1
    outer = [axis for axis in axes if axis != REPETITION]
    found = []
    for index, place in enumerate(product(*(range(run.dataset.sizes[axis]) for axis in outer))):
        words = [
            value_words(run.dataset[axis][i])
            for axis, i in zip(outer, place, strict=True)
            if run.dataset.sizes[axis] > 1
        ]
        found.append((", ".join(words), variable.values[case // repetitions == index]))
    return found


def value_words(item: Any) -> str:
    """A value of an axis with its unit."""
    value = item.values.item()
    unit = str(item.attrs.get("units", "1"))
    if isinstance(value, bytes | str):
        return value.decode() if isinstance(value, bytes) else value
    if unit == "K":
        return f"{value - 273.15:.4g} °C"
    if unit == "1":
        return f"{value:.6g}"
    factor, shown = prefix([value], unit)
    return f"{value * factor:.4g} {shown}"
