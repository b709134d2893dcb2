"""What the page shows of finished runs: figures, notes, pictures, maps one at a time, runs side by side.

Every function reads no more of the results than it shows. They run in the processes of `bem.app.computing`. Verified
in tests/app/test_run_view.py.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bem.app import pictures, solids
from bem.app.pictures import Picture
from bem.errors import InputError
from bem.notes import Level, of_summary
from bem.plots.cases import case_shown
from bem.plots.labels import in_celsius
from bem.plots.report import with_error
from bem.plots.tables import figure_tables, is_list
from bem.results.arrays import Arrays, read_arrays
from bem.results.compare import (
    Difference,
    beyond,
    figure_differences,
    headline_differences,
    run_labels,
    scene_differences,
    shown,
)
from bem.results.dataset import opened_dataset
from bem.results.directory import RESULTS
from bem.results.read import FinishedRun, open_run
from bem.scenes.kind import get_kind

Rows = tuple[tuple[str, ...], ...]
MOST_COMPARED = 20
"""Runs that are laid over each other at once."""
_MOST_PICTURES = 6


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
    tables : figures with their error bars.
    cautions, remarks : its notes by level.
    over, curves : pictures of figures over what the run goes over, and of what is known along an axis of its own.
    maps : words of each map by name.
    layers : by name of a map, which maps there are of it, in words; empty for one.
    solids : words of what can be drawn in space, by name.
    cases : by name of these, which cases there are of it, in words; empty for one.
    """

    failed: str
    beyond: tuple[str, ...]
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
    over = [item for item in pictures.figures_over(summary) if item[0] in kind.headline]
    along = [name for name in pictures.curve_names(arrays) if arrays[name].dims[-1] not in ("speed", "load")]
    maps = {name: str(arrays[name].attrs.get("long_name", name)) for name in pictures.map_names(arrays)}
    in_space = solids.solid_names(arrays)
    return RunView(
        failed=f"{summary['status']}: {summary['where']}" if summary["where"] else "",
        beyond=tuple(map(str, summary.get("outside_model") or ())),
        tables=tuple(tables),
        cautions=tuple(str(note["text"]) for note in notes if note["level"] != Level.INFO),
        remarks=tuple(str(note["text"]) for note in notes if note["level"] == Level.INFO),
        over=tuple(pictures.figure_picture(summary, name, axis) for name, axis in over[:_MOST_PICTURES]),
        curves=tuple(
            pictures.curve_picture(arrays, name, case_shown(arrays, summary["kind"], [name]))
            for name in along[:_MOST_PICTURES]
        ),
        maps=maps,
        layers={name: pictures.layers_of(arrays, name) for name in maps},
        solids=in_space,
        cases={name: solids.cases_of(arrays, name) for name in in_space},
    )


@dataclass(frozen=True)
class MapView:
    """A map of a run and the sections through one of its cells; none of a map that is drawn as lines."""

    picture: Picture
    sections: Picture | None


def map_view(
    path: Path, kind: str, name: str, index: int, *, at: tuple[float, float] | None = None, solid: bool = False
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
    """
    arrays = read_arrays(path / RESULTS)
    item = arrays[name]
    sides = (_coordinates(arrays, "x"), _coordinates(arrays, "y"))
    words, unit = str(item.attrs.get("long_name", name)), str(item.attrs.get("units", "")).removeprefix("1")
    values, unit = in_celsius(pictures.layer(arrays, name, index), unit, name, words)
    layers = pictures.layers_of(arrays, name)
    case = (layers[index] if layers else "", case_shown(arrays, kind, [name]))
    words = ", ".join(filter(None, (words, *case)))
    picture = pictures.map_picture(values, sides, words, unit, solid=solid)
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
    """Runs side by side: what differs in their scenes and results, and what is outside its model."""

    tables: tuple[Table, ...]
    beyond: tuple[str, ...]


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
    found = headline_differences([d for d in figure_differences(*runs) if not d.equal], [*headline, "status"])
    scenes = tuple((d.key, *map(shown, d.values)) for d in scene_differences(*runs))
    return Comparison(
        (
            Table("scenes", scenes, ("key", *names)),
            Table("results", tuple(_side_by_side(d, runs) for d in found), ("figure", *names)),
        ),
        tuple(beyond(runs, names)),
    )


def check_number(names: Sequence[str]) -> None:
    """Refuse too few or too many runs to be compared."""
    if not 2 <= len(names) <= MOST_COMPARED:
        raise InputError(f"runs: {len(names)} to compare; allowed: 2 to {MOST_COMPARED} at once")


def overlay(paths: Sequence[Path], names: Sequence[str]) -> str:
    """Lay runs over each other, as `bem compare` draws them, as SVG; "" where they share nothing that can be drawn.

    Raises
    ------
    InputError, ResultsError : as `comparison`.
    """
    from bem.plots.compare import draw_comparison

    check_number(names)
    runs = [open_run(path) for path in paths]
    with tempfile.TemporaryDirectory(prefix="bem-app-") as temporary, ExitStack() as files:
        datasets = [files.enter_context(opened_dataset(run.checked_results())) for run in runs]
        drawn = draw_comparison(datasets, run_labels(runs, names), Path(temporary) / "overlay", ("svg",))
        text = drawn[0].read_text("utf-8") if drawn else ""
    return text[text.index("<svg") :] if text else ""


def _side_by_side(difference: Difference, runs: Sequence[FinishedRun]) -> tuple[str, ...]:
    """A figure of several runs, each with its error bar."""
    cells = [
        with_error(difference.key, run.summary)[1]
        if isinstance(run.summary.get(difference.key), int | float)
        else shown(value)
        for run, value in zip(runs, difference.values, strict=True)
    ]
    return (difference.key, *cells)
