"""Records of all cases as one summary and one dataset with the axes as dimensions."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.campaigns.cases import REPETITION, Campaign, Case, campaign_of
from bem.campaigns.refine import told_in_summary
from bem.errors import Status
from bem.notes import Note
from bem.notes.accuracy import BARS_PARTIAL, NoBar, no_error_bar
from bem.notes.figure_names import figure_name
from bem.scenes.axes import Axis
from bem.scenes.common import SceneModel
from bem.scenes.context import Outcome, Variable
from bem.scenes.records import (
    INPUTS,
    SCATTER,
    Figure,
    Record,
    Series,
    described,
    error_key,
    input_scatter,
    mean,
    scatter,
    scatter_key,
    spread,
    standard_error,
    without_bars,
)

_WORST = (Status.CONVERGED, Status.INACCURATE, Status.MAX_ITERATIONS, Status.STALLED, Status.INFEASIBLE)
_FAILURES_NAMED = 5


@dataclass(frozen=True)
class Given:
    """Result of a case: a record, or the reason of its failure with a status."""

    case: Case
    record: Record | None
    error: str = ""
    status: Status = Status.CONVERGED


def collect(campaign: Campaign, given: Sequence[Given]) -> Outcome:
    """All of it as the outcome of the scene."""
    records = [item.record for item in given]
    status, where = worst(given)
    summary = summary_of(campaign, records)
    variables = _variables(campaign, described(campaign.kind.record), records)
    volumes = campaign.kind.volumes(campaign.scene)
    return Outcome(summary, variables, status, where, volumes, tuple(axis.name for axis in campaign.axes))


def summary_of(campaign: Campaign, records: Sequence[Record | None]) -> dict[str, Any]:
    """Return the figures of all cases, None where a case has no record; at least one has."""
    summary = _summary(campaign, described(campaign.kind.record), records)
    own = campaign.kind.summarise(campaign.scene, campaign.axes, records) | told_in_summary(campaign, records)
    return {**summary, **own, **_input_shares(campaign, records)}


def _input_shares(campaign: Campaign, records: Sequence[Record | None]) -> dict[str, Any]:
    """Return the share of each uncertain input in the variance of the headline figures, by figure and key; nothing with
    fewer than two inputs.

    Of figures with several values the variances are summed, so that the largest count most.
    """
    found: dict[str, dict[str, float]] = {}
    for name, figure in described(campaign.kind.record).items():
        if not isinstance(figure, Figure) or not figure.headline:
            continue
        sums: dict[str, float] = {}
        for record in records:
            changes = {} if record is None else record.input_changes
            if all(name in change for change in changes.values()):
                for key, change in changes.items():
                    sums[key] = sums.get(key, 0.0) + float(np.nansum(np.square(np.asarray(change[name], np.float64))))
        total = sum(sums.values())
        if len(sums) > 1 and total > 0:
            found[figure.key(name)] = {key: part / total for key, part in sums.items()}
    return {"input_shares": found} if found else {}


def outcome_of(scene: SceneModel, record: Record) -> Outcome:
    """The outcome of a resolved scene of one case from its record."""
    campaign = campaign_of(scene)
    (case,) = campaign.cases
    return collect(campaign, [Given(case, record)])


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
    """Figures by their names: one value, or a list over all axes but the repetitions, of which means are taken.

    Where figures are lists themselves (over speeds, times), those of the first case stand there, and all cases under
    `curves`.
    """
    outer = [axis for axis in campaign.axes if axis.name != REPETITION]
    repeated = next((len(axis) for axis in campaign.axes if axis.name == REPETITION), None)
    each = repeated or 1
    told = {name: item for name, item in known.items() if isinstance(item, Figure) and _is_told(name, item, records)}
    common = {name: item for name, item in told.items() if item.dimensions == (name,)}
    barred = _barred(records) | _never_barred(campaign).keys()
    scattering = set(campaign.kind.record.scatters) | _scattering(campaign)
    groups = []
    for index, place in enumerate(np.ndindex(*(len(axis) for axis in outer))):
        own = {
            axis.figure.key(axis.name): axis.figure.shown(axis.values[i])
            for axis, i in zip(outer, place, strict=True)
            if axis.always
        }
        members = records[index * each : (index + 1) * each]
        here = {n: item for n, item in told.items() if n not in common}
        groups.append(own | _figures(here, members, barred, scattering))
    summary: dict[str, Any] = {}
    for name, item in common.items():
        summary[item.key(name)] = item.shown(next(getattr(r, name) for r in records if r is not None))
    if repeated is not None:
        summary["repetitions"] = each
    if any(item.dimensions for item in told.values()):
        return summary | groups[0] | ({"curves": groups} if len(groups) > 1 else {})
    lists = len(groups) > 1 or campaign.kind.always_lists
    # a case without a bar has no parts of it
    keys = dict.fromkeys(key for group in groups for key in group)
    return summary | {key: [group.get(key) for group in groups] if lists else groups[0][key] for key in keys}


def _is_told(name: str, figure: Figure, records: Sequence[Record | None]) -> bool:
    return not figure.optional or any(getattr(record, name) is not None for record in records if record is not None)


def _barred(records: Sequence[Record | None]) -> set[str]:
    """Figures that have error bars, or null for one, in any case."""
    return {name for record in records if record is not None for name in record.errors}


def _never_barred(campaign: Campaign) -> Mapping[str, str]:
    """Return the reasons why figures of the kind never have a bar; empty where no error bars are wanted."""
    wanted = getattr(getattr(campaign.scene, "outputs", None), "errors", True)
    free = _scattering(campaign)
    return {name: why for name, why in without_bars(campaign.kind.record).items() if wanted and name not in free}


def _scattering(campaign: Campaign) -> set[str]:
    """Figures that have no bar in general, but whose scatter is one under the models of all cases."""
    return set.intersection(*(set(campaign.kind.scattering(case.scene)) for case in campaign.cases))


def _something(value: Any) -> bool:
    """Return True if any number of a figure is not zero."""
    return value is not None and bool(np.nan_to_num(np.asarray(value, dtype=np.float64)).any())


def _sentence(why: str, names: Sequence[str]) -> str:
    """Return why figures have no error bar as the beginning of a sentence, in the plural of several."""
    if len(names) > 1:
        for one, several in (("it follows", "they follow"), (", or was not", ", or were not")):
            why = why.replace(one, several)
    return why[:1].upper() + why[1:]


def words_of_bars(campaign: Campaign, records: Sequence[Record | None]) -> list[Note]:
    """Return notes on error bars: figures without bars and the reasons, and bars that are scatter alone; none on
    figures that are zero everywhere, as the sizes of no pieces."""
    record = campaign.kind.record
    told = {
        name: item.name or name
        for name, item in described(record).items()
        if isinstance(item, Figure) and any(getattr(one, name) is not None for one in records if one is not None)
    }
    reasons: dict[str, list[str]] = {}
    for name, why in _never_barred(campaign).items():
        if name in told and any(_something(getattr(one, name)) for one in records if one is not None):
            reasons.setdefault(why, []).append(told[name])
    found = [
        no_error_bar(named_with_mean(names, campaign.scene), NoBar.OF_KIND, why=_sentence(why, names))
        for why, names in reasons.items()
    ]
    repeated = next((len(axis) for axis in campaign.axes if axis.name == REPETITION), 1)
    if record.scatters and repeated > 1:
        judged = [figure_name(told[name]) for name in record.scatters if name in told and name in _barred(records)]
        but = f" (but for {', '.join(judged)})" if judged else ""
        found.append(BARS_PARTIAL(repetitions=repeated, but=but, reason="scatter"))
    return found


def named_with_mean(names: Sequence[str], scene: Any) -> list[str]:
    """Return figures by name, the reported size of particles by that of its mean, which a table has, too."""
    report = getattr(getattr(scene, "sizes", None), "report", None)
    return [
        name
        if report is None
        else re.sub(r"^particle_(equivalent_radius|length|width|thickness)$", rf"{report}_mean_\1", name)
        for name in names
    ]


def _figures(
    told: Mapping[str, Figure], records: Sequence[Record | None], barred: set[str], scattering: set[str]
) -> dict[str, Any]:
    """The figures of one case over its repetitions: mean, spread and each, or the value where there is only one.

    The error of a mean is the mean of errors, which are of one sign, and the standard error of the mean, or this alone
    where it is `scattering`; the scatter stands apart as well.
    """
    found: dict[str, Any] = {}
    for name, figure in told.items():
        values = [None if record is None else figure.shown(getattr(record, name)) for record in records]
        key = figure.key(name)
        errors = [None if record is None else figure.shown_error(record.errors.get(name)) for record in records]
        if len(values) == 1:
            found[key] = values[0]
            if name in barred:
                found |= _with_parts(key, errors[0], _parts(name, figure, records), mean)
        else:
            found[key] = _over(mean, values)
            found[f"{key}_spread"] = _over(spread, values)
            found[f"{key}_each"] = values
            if name in barred:
                error, scattered = _over(mean, errors), _over(standard_error, values)
                parts = _parts(name, figure, records)
                if error is not None and len(_known(values)) > 1:
                    parts[SCATTER] = [scattered]
                found |= _with_parts(key, _sum(error, scattered), parts, mean)
            elif name in scattering:
                found[error_key(key)] = _over(scatter, values)
        by_inputs = [None if r is None else figure.shown_error(input_scatter(r, name)) for r in records]
        if any(value is not None for value in by_inputs):
            found[scatter_key(key, INPUTS)] = _over(mean, by_inputs)
    return found


def _known(values: Sequence[Any]) -> list[Any]:
    return [value for value in values if value is not None]


def _parts(name: str, figure: Figure, records: Sequence[Record | None]) -> dict[str, list[Any]]:
    """Return the contribution of each origin to a figure's error, of every record that knows it, by the words for
    the origin."""
    parts: dict[str, list[Any]] = {}
    for record in records:
        for origin, errors in (record.error_parts if record is not None else {}).items():
            if errors.get(name) is not None:
                parts.setdefault(origin, []).append(figure.shown_error(errors[name]))
    return parts


def _with_parts(key: str, error: Any, parts: Mapping[str, list[Any]], over: Any) -> dict[str, Any]:
    """The error of a figure, and behind it what each origin adds to it."""
    return {error_key(key): error} | {error_key(key, origin): _over(over, each) for origin, each in parts.items()}


def _sum(one: Any, other: Any) -> Any:
    """The sum of two numbers or of lists of them entry by entry; None where the first is none."""
    if isinstance(one, list):
        return [_sum(a, b) for a, b in zip(one, other, strict=True)]
    return None if one is None else one + other


def _over(statistic: Any, values: list[Any]) -> Any:
    """A statistic over repetitions: of numbers, of lists entry by entry; texts stay where all are the same."""
    if any(isinstance(value, list) for value in values):
        rows = [value for value in values if isinstance(value, list)]
        return [_over(statistic, list(entry)) for entry in zip(*rows, strict=True)]
    if any(isinstance(value, str) for value in values):
        return values[0] if len(set(values)) == 1 else None
    return statistic(values)


def coordinates(axes: Sequence[Axis]) -> dict[str, Variable]:
    """The values of the axes."""
    return {axis.name: Variable((axis.name,), np.array(axis.values), axis.si, axis.figure.text) for axis in axes}


def laid_out(
    axes: Sequence[Axis], values: list[Any], unit: str, text: str, dimensions: tuple[str, ...] = ()
) -> Variable:
    """Arrange the values of all cases over the axes: texts, numbers, or arrays with dimensions of their own."""
    names, shape = tuple(axis.name for axis in axes), tuple(len(axis) for axis in axes)
    if any(isinstance(value, str) for value in values):
        texts = np.array(["" if value is None else str(value) for value in values])
        return Variable(names, texts.reshape(shape), "1", text)
    stacked = _stacked(values)
    return Variable((*names, *dimensions), stacked.reshape((*shape, *stacked.shape[1:])), unit, text)


def _variables(
    campaign: Campaign, known: Mapping[str, Figure | Series], records: Sequence[Record | None]
) -> dict[str, Variable]:
    variables = coordinates(campaign.axes)
    odd = _odd_dimensions(known, records)
    for name, item in known.items():
        values = [None if record is None else getattr(record, name) for record in records]
        if all(value is None for value in values):
            continue
        dimensions, text = item.dimensions, item.text
        unit = item.si if isinstance(item, Figure) else item.unit
        if isinstance(item, Series) and item.rows:
            variables |= _rows(name, item, values, variables)
        elif (isinstance(item, Series) and item.of != "each") or odd & set(dimensions):
            first = isinstance(item, Series) and item.of == "first"
            kept = next(value for value in (values if first else values[::-1]) if value is not None)
            variables[name] = Variable(dimensions, np.asarray(kept), unit, text)
        elif dimensions == (name,):
            variables[name] = Variable(dimensions, _coordinate(values), unit, text)
        else:
            variables[name] = laid_out(campaign.axes, values, unit, text, dimensions)
        if name in variables:
            variables |= _error_variables(campaign, name, item, records)
            variables |= _input_variables(campaign, name, item, records)
    return variables


def _input_variables(
    campaign: Campaign, name: str, item: Figure | Series, records: Sequence[Record | None]
) -> dict[str, Variable]:
    """The standard deviation of a figure by the uncertain inputs over the axes, and its change with each of them."""
    if not isinstance(item, Figure):
        return {}
    inputs = dict.fromkeys(key for r in records if r is not None for key in r.input_changes)
    found = {}
    values = [None if r is None else input_scatter(r, name) for r in records]
    if any(value is not None for value in values):
        text = f"standard deviation of {item.text} by {', '.join(inputs)}"
        found[f"{name}{INPUTS}"] = laid_out(campaign.axes, values, item.si, text, item.dimensions)
    for key in inputs:
        changes = [None if r is None else r.input_changes.get(key, {}).get(name) for r in records]
        if any(change is not None for change in changes):
            text = f"change of {item.text} with one standard deviation of {key}"
            own = f"{name}_change_{re.sub('[^0-9A-Za-z]+', '_', key)}"
            found[own] = laid_out(campaign.axes, changes, item.si, text, item.dimensions)
    return found


def _error_variables(
    campaign: Campaign, name: str, item: Figure | Series, records: Sequence[Record | None]
) -> dict[str, Variable]:
    """The errors of a figure or series over the axes, and what each origin adds to them."""
    unit = item.si if isinstance(item, Figure) else item.unit
    origins = dict.fromkeys(o for r in records if r is not None for o, part in r.error_parts.items() if name in part)
    found = {}
    for origin in ("", *origins):
        tables = [None if r is None else r.error_parts.get(origin, {}) if origin else r.errors for r in records]
        errors = [None if table is None else table.get(name) for table in tables]
        text = f"error of {item.text}{f', {origin}' if origin else ''}"
        if any(error is not None for error in errors):
            found[error_key(name, origin)] = laid_out(campaign.axes, errors, unit, text, item.dimensions)
    return found


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


def _odd_dimensions(known: Mapping[str, Figure | Series], records: Sequence[Record | None]) -> set[str]:
    """Dimensions that differ between cases, as those of grids of their own: arrays over them are kept of one case."""
    odd = set()
    for name, item in known.items():
        if item.dimensions == (name,) and not (isinstance(item, Series) and (item.rows or item.of != "each")):
            values = [getattr(record, name) for record in records if record is not None]
            longest = _coordinate(values) if any(value is not None for value in values) else ()
            if any(value is not None and not np.array_equal(value, longest[: len(value)]) for value in values):
                odd.add(name)
    return odd


def _coordinate(values: list[Any]) -> NDArray[Any]:
    """The longest of the cases' coordinates, of which the others are the beginning."""
    return max((np.asarray(value) for value in values if value is not None), key=len)


def _stacked(values: list[Any]) -> NDArray[Any]:
    """Arrays of all cases; shorter ones and missing ones are filled up with not-a-number."""
    known = [np.asarray(value) for value in values if value is not None]
    if len(values) == 1:
        only = known[0].astype(np.int8) if known[0].dtype == bool else known[0]  # files know no truth values
        return only[np.newaxis]  # a view: it may be larger than memory
    if any(value.dtype == bool for value in known):
        return _stacked([None if value is None else np.asarray(value, dtype=np.int8) for value in values])
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
