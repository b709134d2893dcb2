"""Summaries of all points as one dataset with the swept keys as dimensions, and as a table."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.campaigns import campaign_of
from bem.campaigns.cases import REPETITION
from bem.scenes.axes import Axis as CaseAxis
from bem.scenes.common import SceneModel
from bem.scenes.context import Variable
from bem.scenes.kinds import Kind
from bem.scenes.ranges import Axis
from bem.scenes.records import Figure, described, figures

_SKIPPED = ("scene", "kind", "version", "notes", "seconds_by_stage")


@dataclass(frozen=True)
class Coordinate:
    """A swept key with its values in SI units, or as they were written where they are no numbers."""

    axis: Axis
    values: tuple[float | int | str, ...]
    unit: str


def dataset_variables(
    kind: Kind, scene: SceneModel, coordinates: Sequence[Coordinate], summaries: Sequence[Mapping[str, Any] | None]
) -> dict[str, Variable]:
    """Variables over the swept keys from the summaries in the order of the points; None is a point without a result.

    Numbers become arrays over the swept keys (not-a-number where there is no result), texts stay texts. Lists get the
    dimensions that they run over: those of the figure (speed) or the axes of the kind's own cases (load, variant);
    lists that are neither get "entry_LENGTH".

    Parameters
    ----------
    kind : of the scene; its record says what figures are, its axes what lists run over.
    scene : resolved, of any point.
    coordinates : the swept keys with their values.
    summaries : of the points in the order of the coordinates' product; None where there is no result.
    """
    keys = tuple(item.axis.key for item in coordinates)
    shape = tuple(len(item.values) for item in coordinates)
    inner = [axis for axis in campaign_of(scene).axes if axis.name != REPETITION and axis.name not in keys]
    known = _figures(kind, inner)
    found: dict[str, Variable] = {}
    for item in coordinates:
        found[item.axis.key] = Variable((item.axis.key,), np.array(item.values), item.unit, item.axis.key)
    names = dict.fromkeys(name for summary in summaries if summary for name in summary if name not in _SKIPPED)
    for name in names:
        if name in found:
            continue
        values = [None if summary is None else summary.get(name) for summary in summaries]
        figure = known.get(name.removesuffix("_spread"), _UNKNOWN)
        words, unit = figure.text or name.replace("_", " "), UNIT_WORDS.get(figure.unit, figure.unit) or "1"
        words = f"{words}, spread" if name.endswith("_spread") else words
        if any(isinstance(value, str) for value in values):
            texts = np.array(["" if value is None else str(value) for value in values]).reshape(shape)
            found[name] = Variable(keys, texts, "1", words)
        elif all(value is None or isinstance(value, bool | int | float) for value in values):
            numbers = np.array([np.nan if value is None else float(value) for value in values])
            found[name] = Variable(keys, numbers.reshape(shape), unit, words)
        elif (length := _common_length(values)) is not None:
            rows = [[np.nan] * length if value is None else [_number(v) for v in value] for value in values]
            dims, sizes = _dimensions(figure, inner, length)
            found[name] = Variable((*keys, *dims), np.array(rows).reshape(*shape, *sizes), unit, words)
            found |= _inner_coordinates(dims, name, figure, inner, found[name])
    return found


_UNKNOWN = Figure()
UNIT_WORDS = {"C": "degC", "nm_s": "nm/s", "m_s": "m/s", "N_m": "N/m", "per_m": "1/m"}
"""How units are written that end the names of figures in another way."""


def _figures(kind: Kind, inner: Sequence[CaseAxis]) -> dict[str, Figure]:
    """What the keys of a summary are."""
    fields = described(kind.record)
    known = {key: fields[name] for key, name in figures(kind.record).items()}
    known |= {axis.figure.key(axis.name): axis.figure for axis in inner}
    return {key: item for key, item in known.items() if isinstance(item, Figure)}


def _dimensions(figure: Figure, inner: Sequence[CaseAxis], length: int) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """What a list runs over, and how far."""
    if figure.dimensions:
        return figure.dimensions, (length,)
    several = [axis for axis in inner if len(axis) > 1]
    if math.prod(len(axis) for axis in several) == length and (several or inner):
        chosen = several or inner[-1:]
        return tuple(axis.name for axis in chosen), tuple(len(axis) for axis in chosen)
    return (f"entry_{length}",), (length,)


def _inner_coordinates(
    dims: Sequence[str], name: str, figure: Figure, inner: Sequence[CaseAxis], variable: Variable
) -> dict[str, Variable]:
    """Values along the dimensions of lists, where they are the same at all points."""
    found = {}
    for axis in inner:
        if axis.name in dims:
            shown = np.array([axis.figure.shown(value) for value in axis.values])
            unit = UNIT_WORDS.get(axis.figure.unit, axis.figure.unit) or "1"
            found[axis.name] = Variable((axis.name,), shown, unit, axis.figure.text)
    rows = variable.values.reshape(-1, variable.values.shape[-1])
    if figure.dimensions and figure.key(figure.dimensions[0]) == name and (rows == rows[0]).all():
        (dimension,) = figure.dimensions
        found[dimension] = Variable((dimension,), rows[0], variable.units, variable.description)
    return found


def _number(value: Any) -> float:
    return np.nan if value is None else float(value)


def table_text(
    coordinates: Sequence[Coordinate],
    summaries: Sequence[Mapping[str, Any] | None],
    folders: Sequence[str],
    errors: Sequence[str],
) -> str:
    """The same as CSV, one row per point: swept keys, status, numbers, what went wrong, and the point's folder."""
    keys = [f"{item.axis.key} [{item.unit}]" if item.unit not in ("", "1") else item.axis.key for item in coordinates]
    columns: dict[str, None] = {}
    swept = {item.axis.key for item in coordinates}
    flat = [_flat(summary) if summary else {} for summary in summaries]
    for row in flat:
        columns.update(dict.fromkeys(name for name in row if name != "status" and name not in swept))
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow([*keys, "status", *columns, "error", "folder"])
    shape = tuple(len(item.values) for item in coordinates)
    for index, row in enumerate(flat):
        place = np.unravel_index(index, shape)
        own = [item.values[int(i)] for item, i in zip(coordinates, place, strict=True)]
        status = row.get("status", "failed" if errors[index] else "missing")
        cells = [row.get(name, "") for name in columns]
        writer.writerow([*own, status, *cells, errors[index], folders[index]])
    return buffer.getvalue()


def _common_length(values: Sequence[Any]) -> int | None:
    """The length of all lists of numbers, or None where they are something else."""
    lengths = set()
    for value in values:
        if value is None:
            continue
        if not isinstance(value, list) or not all(v is None or isinstance(v, bool | int | float) for v in value):
            return None
        lengths.add(len(value))
    return lengths.pop() if len(lengths) == 1 and lengths != {0} else None


def _flat(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers, texts and entries of lists of a summary, each under a name of its own."""
    flat: dict[str, Any] = {}
    for name, value in summary.items():
        if name in _SKIPPED or isinstance(value, dict):
            continue
        if isinstance(value, list):
            if all(v is None or isinstance(v, bool | int | float | str) for v in value):
                flat |= {f"{name}[{i}]": v for i, v in enumerate(value)}
        else:
            flat[name] = value
    return flat
