"""Summaries of all points as one dataset with the swept keys as dimensions, and as a table."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.scenes.context import Variable
from bem.scenes.ranges import Axis

_SKIPPED = ("scene", "kind", "version", "notes", "seconds_by_stage")
_UNITS = {
    "m": "m", "m2": "m2", "m3": "m3", "nm": "nm", "um": "um", "um3": "um3", "Pa": "Pa", "N": "N", "s": "s", "C": "degC",
    "K": "K", "nm_s": "nm/s", "m_s": "m/s", "N_m": "N/m", "J": "J", "per_m": "1/m",
}  # fmt: skip


@dataclass(frozen=True)
class Coordinate:
    """A swept key with its values in SI units, or as they were written where they are no numbers."""

    axis: Axis
    values: tuple[float | int | str, ...]
    unit: str


def dataset_variables(
    coordinates: Sequence[Coordinate], summaries: Sequence[Mapping[str, Any] | None]
) -> dict[str, Variable]:
    """Variables over the swept keys from the summaries in the order of the points; None is a point without a result.

    Numbers become arrays over the swept keys (not-a-number where there is no result), lists of numbers of one length
    get a further dimension "entry_LENGTH", texts stay texts.
    """
    keys = tuple(item.axis.key for item in coordinates)
    shape = tuple(len(item.values) for item in coordinates)
    found: dict[str, Variable] = {}
    for item in coordinates:
        found[item.axis.key] = Variable((item.axis.key,), np.array(item.values), item.unit, item.axis.key)
    names = dict.fromkeys(name for summary in summaries if summary for name in summary if name not in _SKIPPED)
    for name in names:
        if name in found:
            continue
        values = [None if summary is None else summary.get(name) for summary in summaries]
        words = name.replace("_", " ")
        if any(isinstance(value, str) for value in values):
            texts = np.array(["" if value is None else str(value) for value in values]).reshape(shape)
            found[name] = Variable(keys, texts, "1", words)
        elif all(value is None or isinstance(value, bool | int | float) for value in values):
            numbers = np.array([np.nan if value is None else float(value) for value in values])
            found[name] = Variable(keys, numbers.reshape(shape), unit_of(name), words)
        else:
            length = _common_length(values)
            if length is not None:
                rows = [
                    [np.nan] * length if value is None else [np.nan if v is None else float(v) for v in value]
                    for value in values
                ]
                numbers = np.array(rows).reshape(*shape, length)
                found[name] = Variable((*keys, f"entry_{length}"), numbers, unit_of(name), words)
    return found


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


def unit_of(name: str) -> str:
    """The unit that ends the name of a summary's figure: `contact_load_N` -> "N"; "1" where there is none."""
    for ending in sorted(_UNITS, key=len, reverse=True):
        if name.endswith("_" + ending):
            return _UNITS[ending]
    return "1"


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
