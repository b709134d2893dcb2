"""What the page shows of finished runs: figures, notes, pictures, maps one at a time, runs side by side.

Every function reads no more of the results than it shows. They run in the processes of `bem.app.computing`. Verified
in tests/app/test_run_view.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.app import pictures, solids
from bem.app.answers import Answer, answers, telling_figures
from bem.app.pictures import Picture
from bem.app.workspace import HISTORY, OWN
from bem.campaigns import campaign_of
from bem.campaigns.collect import summary_of
from bem.campaigns.engine import finished_cases
from bem.errors import InputError
from bem.notes import Level, of_summary
from bem.plots.cases import case_shown
from bem.plots.labels import in_celsius, key_words
from bem.plots.report import with_error
from bem.plots.tables import figure_tables, is_list, name_and_unit
from bem.results.arrays import Arrays, read_arrays
from bem.results.compare import (
    Difference,
    beyond,
    figure_differences,
    headline_differences,
    run_labels,
    scene_differences,
    shown,
    unit_of_key,
    unpaired_words,
)
from bem.results.dataset import opened_dataset
from bem.results.directory import CASES, RESULTS, SCENE
from bem.results.read import FinishedRun, open_run
from bem.scenes.kind import get_kind
from bem.scenes.load import load_scene, scene_table

Rows = tuple[tuple[str, ...], ...]
MOST_COMPARED = 20
"""Runs that are laid over each other at once."""
_MOST_PICTURES = 6
_FIRST_OF_FINISHED = 2
_AXES_OF_FIGURES = {"speed_m_s": "speed", "load_N": "load", "temperature_C": "temperature"}
_MARCHED = ("cycle", "time")
"""Axes of curves that are looked for before maps."""


@dataclass(frozen=True)
class Table:
    """A small table of texts."""

    title: str
    rows: Rows
    head: tuple[str, ...] = ()


@dataclass(frozen=True)
class RunView:
    """A finished run without its maps.

    Attributes
    ----------
    failed : where it went wrong, "" where it did not.
    beyond : what of it is outside its model.
    answers : the figures that it was run for.
    main : the picture that is looked for first; None where that is a map.
    tables : figures with their error bars.
    cautions, remarks : its notes by level.
    over, curves : further pictures: figures over what the run goes over, and what is known along an axis of its own.
    maps : words of each map by name.
    layers : by name of a map, which maps there are of it, in words; empty for one.
    solids : words of what can be drawn in space, by name.
    cases : by name of these, which cases there are of it, in words; empty for one.
    """

    failed: str
    beyond: tuple[str, ...]
    answers: tuple[Answer, ...]
    main: Picture | None
    tables: tuple[Table, ...]
    cautions: tuple[str, ...]
    remarks: tuple[str, ...]
    over: tuple[Picture, ...]
    curves: tuple[Picture, ...]
    maps: dict[str, str]
    layers: dict[str, list[str]]
    solids: dict[str, str]
    cases: dict[str, list[str]]


def run_view(path: Path) -> RunView:
    """Read what is shown of a finished run at once.

    Raises
    ------
    ResultsError : no finished run, or a damaged one.
    """
    found = open_run(path)
    arrays, summary = found.arrays, found.summary
    kind = get_kind(summary["kind"])
    first = [name for name in kind.headline if summary.get(name) is not None]
    plain = tuple(with_error(name, summary) for name in first if not is_list(summary[name]))
    tables = [Table("figures", plain)] if plain else []
    tables += [
        Table(item.title, tuple(map(tuple, item.rows)), tuple(item.head)) for item in figure_tables(summary, first)
    ]
    notes = of_summary(summary)
    over = _headline_over(summary, kind.headline)
    drawn = {_AXES_OF_FIGURES.get(key, key) for _, key in over}
    along = [name for name in pictures.curve_names(arrays) if arrays[name].dims[-1] not in drawn]
    maps = {name: str(arrays[name].attrs.get("long_name", name)) for name in pictures.map_names(arrays)}
    in_space = solids.solid_names(arrays)
    of_figures = [pictures.figure_picture(summary, name, axis) for name, axis in over[:_MOST_PICTURES]]
    curves = [
        pictures.curve_picture(arrays, name, case_shown(arrays, summary["kind"], [name]))
        for name in along[:_MOST_PICTURES]
    ]
    main = None
    if of_figures:
        main = of_figures.pop(0)
    elif curves and (not maps or arrays[along[0]].dims[-1] in _MARCHED):
        main = curves.pop(0)
    return RunView(
        failed=f"{summary['status']}: {summary['where']}" if summary["where"] else "",
        beyond=tuple(map(str, summary.get("outside_model") or ())),
        answers=answers(summary, kind.headline, found.scene),
        main=main,
        tables=tuple(tables),
        cautions=tuple(str(note["text"]) for note in notes if note["level"] == Level.CAUTION),
        remarks=tuple(str(note["text"]) for note in notes if note["level"] == Level.INFO),
        over=tuple(of_figures),
        curves=tuple(curves),
        maps=maps,
        layers={name: pictures.layers_of(arrays, name) for name in maps},
        solids=in_space,
        cases={name: solids.cases_of(arrays, name) for name in in_space},
    )


def _headline_over(summary: Mapping[str, Any], headline: Sequence[str]) -> list[tuple[str, str]]:
    """Headline figures that are lists, in their order, each with what it runs over."""
    names = telling_figures(summary, headline)
    return sorted(
        (item for item in pictures.figures_over(summary) if item[0] in names), key=lambda i: names.index(i[0])
    )


@dataclass(frozen=True)
class PartialView:
    """Results so far of a run that is not finished.

    Attributes
    ----------
    finished, cases : the number of cases that are finished, and of all.
    answers : of those that are finished.
    pictures : the first figure over what the cases go over, and figures told by the case that is being computed.
    """

    finished: int
    cases: int
    answers: tuple[Answer, ...]
    pictures: tuple[Picture, ...]


def parts_version(path: Path) -> object:
    """Return what differs once `partial_view` has something new to show; few files are looked at."""
    found = []
    for file in (path / OWN / HISTORY, path / CASES):
        with suppress(OSError):
            found.append(file.stat().st_mtime_ns)
    return tuple(found)


def partial_view(path: Path) -> PartialView:
    """Read what a run has computed up to now: its finished cases, and figures that it has told.

    Raises
    ------
    BemError : its scene cannot be read.
    """
    history = json.loads((path / OWN / HISTORY).read_text("utf-8")) if (path / OWN / HISTORY).is_file() else {}
    told = pictures.told_pictures(history)[:_MOST_PICTURES]
    if not (path / CASES).is_dir():
        return PartialView(0, 1, (), tuple(told))
    campaign = campaign_of(load_scene(path / SCENE))
    records = finished_cases(campaign, path)
    finished = sum(record is not None for record in records)
    if not finished:
        return PartialView(0, len(records), (), tuple(told))
    summary = summary_of(campaign, records)
    if campaign.scene.over:
        axes = {axis.name: axis for axis in campaign.axes}
        summary["over"] = {key: axes[key].unit for key in campaign.scene.over}
        places = list(np.ndindex(campaign.shape))
        for number, axis in enumerate(campaign.axes):
            if axis.name in summary["over"]:
                summary[axis.name] = [axis.values[place[number]] for place in places]
    headline = campaign.kind.headline
    over = _headline_over(summary, headline)
    drawn = [pictures.figure_picture(summary, name, axis) for name, axis in over[:_FIRST_OF_FINISHED]]
    return PartialView(finished, len(records), answers(summary, headline, scene_table(campaign.scene)), (*drawn, *told))


@dataclass(frozen=True)
class MapView:
    """A map of a run and the sections through one of its cells; none of a map that is drawn as lines."""

    picture: Picture
    sections: Picture | None


def map_view(
    path: Path,
    kind: str,
    name: str,
    index: int,
    *,
    at: tuple[float, float] | None = None,
    solid: bool = False,
    whole: bool = False,
) -> MapView:
    """Draw one map of a run.

    Parameters
    ----------
    path : folder of the run, which `run_view` has shown to be whole.
    kind : of the run.
    name : of the map.
    index : which of its layers.
    at : place of the sections in the units of the picture; the largest value without.
    solid : draw it in space.
    whole : end the colours at the least and the largest value.
    """
    arrays = read_arrays(path / RESULTS)
    item = arrays[name]
    sides = (_coordinates(arrays, "x"), _coordinates(arrays, "y"))
    words, unit = str(item.attrs.get("long_name", name)), str(item.attrs.get("units", "")).removeprefix("1")
    values, unit = in_celsius(pictures.layer(arrays, name, index), unit, name, words)
    layers = pictures.layers_of(arrays, name)
    case = (layers[index] if layers else "", case_shown(arrays, kind, [name]))
    words = ", ".join(filter(None, (words, *case)))
    picture = pictures.map_picture(values, sides, words, unit, solid=solid, whole=whole)
    if not pictures.is_map(picture):
        return MapView(picture, None)
    cell = pictures.peak_cell(values) if at is None else pictures.cell_at(sides, at)
    return MapView(picture, pictures.sections_picture(values, sides, cell, words, unit))


def _coordinates(arrays: Arrays, axis: str) -> NDArray[np.float64]:
    """Places of the cells of maps along an axis [m]."""
    return np.asarray(arrays[axis].values, dtype=np.float64)


def solid_view(path: Path, name: str, case: int) -> Picture:
    """Draw a field or the particles of a run in space."""
    return solids.solid_picture(read_arrays(path / RESULTS), name, case)


@dataclass(frozen=True)
class Comparison:
    """Runs side by side: what differs in their scenes and results.

    beyond : what is outside its model. unpaired : which runs have other speeds or loads than the first.
    """

    tables: tuple[Table, ...]
    beyond: tuple[str, ...]
    unpaired: tuple[str, ...] = ()


def comparison(paths: Sequence[Path], names: Sequence[str]) -> Comparison:
    """Compare the scenes and summaries of runs; no arrays are read.

    Raises
    ------
    InputError : fewer than two runs, or more than `MOST_COMPARED`.
    ResultsError : no finished run, or a damaged one.
    """
    check_number(names)
    runs = [open_run(path) for path in paths]
    headline = [key for kind in {run.summary["kind"] for run in runs} for key in get_kind(kind).headline]
    differences = [item for item in figure_differences(*runs) if not item.equal]
    found = headline_differences(differences, [*headline, "status"])
    scenes = tuple(
        (_words_of_key(d.key), *(_shown_value(v, _unit_of(runs, d.key)) for v in d.values))
        for d in scene_differences(*runs)
    )
    results = tuple(_side_by_side(d, runs) for d in found)
    return Comparison(
        (Table("results", results, ("figure", *names)), Table("scenes", scenes, ("key", *names))),
        tuple(beyond(runs, names)),
        tuple(unpaired_words(differences, names)),
    )


def check_number(names: Sequence[str]) -> None:
    """Refuse too few or too many runs to be compared."""
    if not 2 <= len(names) <= MOST_COMPARED:
        raise InputError(f"runs: {len(names)} to compare; allowed: 2 to {MOST_COMPARED} at once")


def overlay(paths: Sequence[Path], names: Sequence[str]) -> tuple[Picture, ...]:
    """Lay runs over each other: up to six variables that all have, a colour for each run; none if they share nothing.

    Raises
    ------
    InputError, ResultsError : as `comparison`.
    """
    from bem.plots.compare import shared_panels

    check_number(names)
    runs = [open_run(path) for path in paths]
    with ExitStack() as files:
        datasets = [files.enter_context(opened_dataset(run.checked_results())) for run in runs]
        labels = run_labels(runs, names)
        return tuple(pictures.panels_picture(group, labels) for group in shared_panels(datasets))


def _words_of_key(key: str) -> str:
    """A key of a scene in words: `lower.surface.rms_height` is "lower surface: rms height"."""
    *tables, name = key.split(".")
    words = key_words(name)
    return f"{' '.join(tables).replace('_', ' ')}: {words}" if tables else words


def _shown_value(value: Any, unit: str) -> str:
    """A value of a scene with its unit: yes and no, equal values of both axes once."""
    if isinstance(value, list) and value and len(value) <= _AXES_OF_A_VALUE:
        return ", ".join(dict.fromkeys(_shown_value(item, unit) for item in value))
    return ("no", "yes")[value] if isinstance(value, bool) else shown(value, unit)


_AXES_OF_A_VALUE = 3
"""Values of a list that are written one by one."""


def _unit_of(runs: Sequence[FinishedRun], key: str) -> str:
    return next((unit for run in runs if (unit := unit_of_key(run, key))), "")


def _side_by_side(difference: Difference, runs: Sequence[FinishedRun]) -> tuple[str, ...]:
    """A figure of several runs by its name, each with its error bar and its difference from the first in per cent."""
    name, _, case = difference.key.partition(" (")
    words, unit = name_and_unit(name)
    cells = []
    for i, (run, value) in enumerate(zip(runs, difference.values, strict=True)):
        if isinstance(run.summary.get(difference.key), int | float):
            text = with_error(difference.key, run.summary)[1].replace(" (no error bar)", "")
        elif name == "status" or not _is_number(value):
            text = shown(value, unit)
        else:
            text = with_error(name, {name: value})[1]
        change = difference.relative(i) if i else None
        cells.append(f"{text} ({_percent(change)})" if change is not None and name != "status" else text)
    return (f"{words} ({case}" if case else words, *cells)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _percent(change: tuple[float, float]) -> str:
    """Least and largest relative difference in per cent, with their signs."""
    low, high = (f"{100 * value:+.3g}" for value in change)
    return f"{low} %" if low == high else f"{low} to {high} %"
