"""Summaries of all points of a sweep as one dataset with the swept keys as dimensions, and as a table."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from bem.campaigns.cases import REPETITION
from bem.campaigns.collect import coordinates, laid_out
from bem.scenes.axes import Axis
from bem.scenes.context import Variable
from bem.scenes.kind import Kind
from bem.scenes.records import Figure, described

_SKIPPED = ("scene", "kind", "version", "notes", "seconds_by_stage")
_SAID = "outside_model"
"""Sentences, in one text."""
_FAILED = "failed"
"""Status of a point that has no result, beside those of solvers."""
Summaries = Sequence[Mapping[str, Any] | None]
"""Summaries of the points in the order of the swept values' product; None where there is no result."""


def dataset_variables(
    kind: Kind, axes: Sequence[Axis], inner: Sequence[Axis], summaries: Summaries
) -> dict[str, Variable]:
    """The summaries as arrays over the swept keys, in the units of their names.

    Numbers become numbers (not-a-number where there is no result), texts stay texts. Lists get the dimensions that they
    run over: those of the figure (speed) or the axes of the kind's own cases (load, variant); lists that are neither
    get "entry_LENGTH", unless their lengths differ: then they are left out.

    Parameters
    ----------
    kind : of the scene; its record says what figures are.
    axes : the swept keys.
    inner : axes of the cases of one point.
    summaries : of the points.
    """
    keys = {axis.name for axis in axes}
    inner = [axis for axis in inner if axis.name != REPETITION and axis.name not in keys]
    figures = [(name, item) for name, item in described(kind.record).items() if isinstance(item, Figure)]
    known = {item.key(name): item for name, item in [*figures, *((axis.name, axis.figure) for axis in inner)]}
    found = coordinates(axes)
    for name in dict.fromkeys(name for summary in summaries if summary for name in summary if name not in _SKIPPED):
        if name in found:
            continue
        values = [None if summary is None else summary.get(name) for summary in summaries]
        if name == "status":  # a reader must not have to guess why the figures of a point are no numbers
            values = [_FAILED if summary is None else summary.get(name) for summary in summaries]
        if name == _SAID:
            found[name] = laid_out(axes, ["; ".join(value or ()) for value in values], "1", "outside the model")
            continue
        bare = name if name in known else name.removesuffix("_spread").partition("_error")[0]
        figure = known.get(bare, Figure())
        text = f"{figure.text}{name.removeprefix(bare).replace('_', ', ')}" if figure.text else name.replace("_", " ")
        unit = figure.written or "1"
        if any(isinstance(value, str) for value in values):
            found[name] = laid_out(axes, values, unit, text)
        elif all(_is_number(value) for value in values):
            found[name] = laid_out(axes, [_number(value) for value in values], unit, text)
        elif all(value is None or _is_row(value) for value in values):
            rows = [None if value is None else np.array([_number(item) for item in value]) for value in values]
            lengths = {len(row) for row in rows if row is not None}
            dimensions, sizes = _dimensions(figure, inner, max(lengths))
            if len(lengths) > 1 and not figure.dimensions:
                continue
            shaped = [row if row is None or figure.dimensions else row.reshape(sizes) for row in rows]
            found[name] = laid_out(axes, shaped, unit, text, dimensions)
            found |= _along(dimensions, name, figure, inner, found[name])
    return found


def _is_number(value: Any) -> bool:
    return value is None or isinstance(value, bool | int | float)


def _is_row(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(_is_number(item) for item in value)


def _number(value: Any) -> float:
    return np.nan if value is None else float(value)


def _dimensions(figure: Figure, inner: Sequence[Axis], length: int) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return the dimensions of a list and their lengths."""
    if figure.dimensions:
        return figure.dimensions, (length,)
    several = [axis for axis in inner if len(axis) > 1]
    if math.prod(len(axis) for axis in several) == length and (several or inner):
        chosen = several or inner[-1:]
        return tuple(axis.name for axis in chosen), tuple(len(axis) for axis in chosen)
    return (f"entry_{length}",), (length,)


def _along(
    dimensions: Sequence[str], name: str, figure: Figure, inner: Sequence[Axis], variable: Variable
) -> dict[str, Variable]:
    """Values along the dimensions of lists, where they are the same at all points."""
    found = {}
    for axis in inner:
        if axis.name in dimensions:
            shown = np.array([axis.figure.shown(value) for value in axis.values])
            found[axis.name] = Variable((axis.name,), shown, axis.figure.written or "1", axis.figure.text)
    rows = variable.values.reshape(-1, variable.values.shape[-1])
    if figure.dimensions and figure.key(figure.dimensions[0]) == name and (rows == rows[0]).all():
        (dimension,) = figure.dimensions
        found[dimension] = Variable((dimension,), rows[0], variable.units, variable.description)
    return found


def table_text(axes: Sequence[Axis], summaries: Summaries, folders: Sequence[str], errors: Mapping[str, str]) -> str:
    """The same as CSV, one row per point: swept keys, status, numbers, what went wrong, and the point's folder."""
    swept = {axis.name for axis in axes}
    rows = [{name: v for name, v in _flat(summary or {}).items() if name not in swept} for summary in summaries]
    columns = list(dict.fromkeys(name for row in rows for name in row if name != "status"))
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    heads = [f"{axis.name} [{axis.si}]" if axis.si != "1" else axis.name for axis in axes]
    writer.writerow([*heads, "status", *columns, "error", "folder"])
    for own, row, folder in zip(product(*(axis.values for axis in axes)), rows, folders, strict=True):
        error = errors.get(folder, "")
        status = row.get("status", _FAILED if error else "missing")
        writer.writerow([*own, status, *(row.get(name, "") for name in columns), error, folder])
    return buffer.getvalue()


def _flat(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers, texts and entries of lists of a summary, each under a name of its own."""
    flat: dict[str, Any] = {}
    for name, value in summary.items():
        if name in _SKIPPED or isinstance(value, dict):
            continue
        if name == _SAID:
            flat[name] = "; ".join(value)
        elif not isinstance(value, list):
            flat[name] = value
        elif all(_is_number(item) or isinstance(item, str) for item in value):
            flat |= {f"{name}[{i}]": item for i, item in enumerate(value)}
    return flat
