"""Records of all cases as one summary and one dataset with the axes as dimensions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.campaigns.cases import REPETITION, Campaign, Case
from bem.errors import Status
from bem.scenes.axes import Axis
from bem.scenes.context import Outcome, Variable
from bem.scenes.records import Figure, Record, Series, described, mean, spread

_WORST = (Status.CONVERGED, Status.MAX_ITERATIONS, Status.STALLED, Status.INFEASIBLE)
_FAILURES_NAMED = 5


@dataclass(frozen=True)
class Given:
    """What a case gave: a record, or why it failed and with what status."""

    case: Case
    record: Record | None
    error: str = ""
    status: Status = Status.CONVERGED


def collect(campaign: Campaign, given: Sequence[Given]) -> Outcome:
    """All of it as the outcome of the scene."""
    records = [item.record for item in given]
    status, where = worst(given)
    assert campaign.kind.record is not None
    known = described(campaign.kind.record)
    summary = _summary(campaign, known, records)
    own = campaign.kind.summarise(campaign.scene, campaign.axes, records)
    variables = _variables(campaign, known, records)
    volumes = campaign.kind.volumes(campaign.scene)
    return Outcome({**summary, **own}, variables, status, where, volumes, tuple(axis.name for axis in campaign.axes))


def worst(given: Sequence[Given]) -> tuple[Status, str]:
    """The worst status of all cases, and where they did not converge, in words."""
    found, words = Status.CONVERGED, []
    for item in given:
        status = item.status if item.record is None else item.record.status
        text = item.error if item.record is None else item.record.where
        found = max(found, status, key=_WORST.index)
        if status is not Status.CONVERGED:
            words.append(f"{item.case.label}: {text}" if item.case.label else text)
    more = [f"and {len(words) - _FAILURES_NAMED} more"] if len(words) > _FAILURES_NAMED else []
    return found, "; ".join([*words[:_FAILURES_NAMED], *more])


def _summary(
    campaign: Campaign, known: Mapping[str, Figure | Series], records: Sequence[Record | None]
) -> dict[str, Any]:
    """Figures by their names: one value, or a list over all axes but the repetitions, of which means are taken."""
    outer = [axis for axis in campaign.axes if axis.name != REPETITION]
    repeated = next((len(axis) for axis in campaign.axes if axis.name == REPETITION), None)
    each = repeated or 1
    groups = [list(records[start : start + each]) for start in range(0, len(records), each)]
    lists = len(groups) > 1 or campaign.kind.always_lists

    def shaped(values: list[Any]) -> Any:
        return values if lists else values[0]

    summary: dict[str, Any] = {}
    for axis in outer:
        if axis.always:
            summary[axis.figure.key(axis.name)] = shaped(_along(outer, axis))
    if repeated is not None:
        summary["repetitions"] = each
    for name, figure in known.items():
        if not isinstance(figure, Figure):
            continue
        found = [[None if r is None else figure.shown(getattr(r, name)) for r in group] for group in groups]
        if figure.optional and all(value is None for group in found for value in group):
            continue
        key = figure.key(name)
        if each == 1:
            summary[key] = shaped([group[0] for group in found])
        else:
            summary[key] = shaped([_over(mean, group) for group in found])
            summary[f"{key}_spread"] = shaped([_over(spread, group) for group in found])
            summary[f"{key}_each"] = shaped(found)
    return summary


def _over(statistic: Any, values: list[Any]) -> Any:
    """A statistic over repetitions: of numbers, of lists entry by entry; texts stay where all are the same."""
    if any(isinstance(value, list) for value in values):
        rows = [value for value in values if isinstance(value, list)]
        return [_over(statistic, list(entry)) for entry in zip(*rows, strict=True)]
    if any(isinstance(value, str) for value in values):
        return values[0] if len(set(values)) == 1 else None
    return statistic(values)


def _along(outer: Sequence[Axis], axis: Axis) -> list[Any]:
    """The axis' value in each group, in the order of the groups."""
    shape = tuple(len(other) for other in outer)
    places = np.indices(shape)[list(outer).index(axis)].ravel()
    return [axis.figure.shown(axis.values[int(i)]) for i in places]


def _variables(
    campaign: Campaign, known: Mapping[str, Figure | Series], records: Sequence[Record | None]
) -> dict[str, Variable]:
    variables: dict[str, Variable] = {}
    axes = tuple(axis.name for axis in campaign.axes)
    for axis in campaign.axes:
        variables[axis.name] = Variable((axis.name,), np.array(axis.values), axis.figure.si, axis.figure.text)
    for name, item in known.items():
        values = [None if record is None else getattr(record, name) for record in records]
        if all(value is None for value in values):
            continue
        if isinstance(item, Figure):
            dimensions, unit, text = item.dimensions, item.si, item.text
            if any(isinstance(value, str) for value in values):
                texts = np.array(["" if value is None else str(value) for value in values])
                variables[name] = Variable(axes, texts.reshape(campaign.shape), "1", text)
                continue
        else:
            dimensions, unit, text = item.dimensions, item.unit, item.text
        if isinstance(item, Series) and item.rows:
            variables |= _rows(name, item, values, variables)
        elif isinstance(item, Series) and item.of != "each":
            kept = next(value for value in (values if item.of == "first" else values[::-1]) if value is not None)
            variables[name] = Variable(dimensions, np.asarray(kept), unit, text)
        elif dimensions == (name,):
            variables[name] = Variable(dimensions, _coordinate(name, values), unit, text)
        else:
            stacked = _stacked(values)
            variables[name] = Variable(
                (*axes, *dimensions), stacked.reshape(*campaign.shape, *stacked.shape[1:]), unit, text
            )
    return variables


def _rows(name: str, item: Series, values: list[Any], known: Mapping[str, Variable]) -> dict[str, Variable]:
    """Rows of all cases after one another, and which case each is of."""
    (dimension,) = item.dimensions
    parts = [np.zeros(0) if value is None else np.asarray(value) for value in values]
    found = {name: Variable((dimension,), np.concatenate(parts), item.unit, item.text)}
    if f"{dimension}_case" not in known:
        cases = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
        found[f"{dimension}_case"] = Variable(
            (dimension,), cases, "1", "case that it is of, counted with the last axis running fastest"
        )
    return found


def _coordinate(name: str, values: list[Any]) -> NDArray[Any]:
    """The longest of the cases' coordinates, of which the others must be the beginning."""
    known = [np.asarray(value) for value in values if value is not None]
    longest = max(known, key=len)
    for value in known:
        if not np.array_equal(value, longest[: len(value)]):
            raise ValueError(f"{name}: differs between cases, so arrays over it cannot stand side by side")
    return longest


def _stacked(values: list[Any]) -> NDArray[Any]:
    """Arrays of all cases; shorter ones and missing ones are filled up with not-a-number."""
    known = [np.asarray(value) for value in values if value is not None]
    shapes = {value.shape for value in known}
    if len(shapes) == 1 and len(known) == len(values):
        return np.stack(known)
    shape = tuple(max(sizes) for sizes in zip(*shapes, strict=True)) if shapes != {()} else ()
    table = np.full((len(values), *shape), np.nan)
    for row, value in zip(range(len(values)), values, strict=True):
        if value is not None:
            place: Any = (row, *(slice(0, n) for n in np.shape(value)))
            table[place] = value
    return table
