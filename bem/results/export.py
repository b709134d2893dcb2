"""Figures of a run or a sweep as a tidy table, a row for each point: CSV with units in its head, and netCDF.

Knows run folders and what records call a figure. Verified in tests/results/test_export.py.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import InputError, ResultsError
from bem.results.atomic import replacing
from bem.results.dataset import read_dataset, write_variables
from bem.results.directory import SUMMARY
from bem.results.read import open_run
from bem.scenes.context import Variable

if TYPE_CHECKING:
    import xarray

    from bem.friction.share_fit import LoadShare

SWEEP = "sweep.nc"
_ROW = "point"
_TEMPERATURE, _RATIO = "oil.temperature", "slide_roll_ratio"
_CYLINDER, _SLIP = "speeds.cylinder", "speeds.slide_roll_ratio"


@dataclass(frozen=True)
class Points:
    """A table of points.

    columns : values by name, (n,) numbers or texts, what was varied first. units : by name, "" for none.
    meanings : by name. title : of the run. notes : damaged points of a sweep, and what is taken instead.
    """

    columns: Mapping[str, np.ndarray[Any, Any]]
    units: Mapping[str, str]
    meanings: Mapping[str, str]
    title: str
    notes: tuple[str, ...] = ()

    def csv(self) -> str:
        """Comma-separated, each column's unit in brackets behind its name."""
        sink = io.StringIO()
        writer = csv.writer(sink, lineterminator="\n")
        heads = [f"{name} [{self.units[name]}]" if self.units[name] else name for name in self.columns]
        writer.writerow(heads)
        for row in zip(*self.columns.values(), strict=True):
            writer.writerow([value if isinstance(value, str) else repr(float(value)) for value in row])
        return sink.getvalue()

    def write_csv(self, path: Path) -> None:
        """`csv` as a file, whole or not at all."""
        with replacing(path) as temporary:
            Path(temporary).write_text(self.csv(), encoding="utf-8")

    def write_netcdf(self, path: Path) -> None:
        """The columns over one dimension, with units and meanings."""
        variables = {
            name.replace(".", "_"): Variable((_ROW,), np.asarray(values), self.units[name] or "1", self.meanings[name])
            for name, values in self.columns.items()
        }
        write_variables(path, variables, {"title": self.title, "Conventions": "CF-1.11"})

    def load_share(self) -> LoadShare:
        """Contact share over the lambda ratio, fitted to all points.

        Raises
        ------
        InputError : a table without lambda ratios and loads, or too few points where film and contact both carry.
        """
        from bem.friction.share_fit import fit_load_share

        def column(*names: str) -> np.ndarray[Any, Any]:
            found = [self.columns[name] for name in names if name in self.columns]
            if not found:
                raise InputError(f"load share: the run has no {names[0]}; allowed: a run of kind friction, or a sweep")
            return found[0]

        contact, film = column("contact_load", "contact_load_N"), column("film_load", "film_load_N")
        return fit_load_share(column("lambda_ratio"), contact / (contact + film))


def points_of(folder: Path) -> Points:
    """The table of a run's or a sweep's folder.

    Figures only, no fields: over everything that was varied, loads, speeds and repetitions; with the oil's temperature
    and the slide-roll ratio 2 (u1 - u2)/(u1 + u2) where the scene has speeds.

    Raises
    ------
    ResultsError : no run or sweep, or damaged files.
    """
    notes: tuple[str, ...] = ()
    if (folder / SWEEP).is_file():
        data, title = read_dataset(folder / SWEEP), folder.name
        names, (scene, notes) = [str(name) for name in data.data_vars], _scene_below(folder)
    else:
        run = open_run(folder)
        data, title, scene = run.dataset, run.summary["scene"], run.scene
        names = _figures(run.summary["kind"], data)
    dimensions = tuple(dict.fromkeys(str(dim) for name in names for dim in data[name].dims))
    if not names:
        raise ResultsError(f"{folder}: no figures are in it")
    return replace(_laid_out(data, names, dimensions, scene, title), notes=notes)


def _figures(kind: str, data: xarray.Dataset) -> list[str]:
    """Names of the variables that are figures, not fields."""
    from bem.scenes import get_kind
    from bem.scenes.records import Figure, described

    known = {name for name, item in described(get_kind(kind).record).items() if isinstance(item, Figure)}
    return [str(name) for name in data.data_vars if str(name) in known]


def _scene_below(folder: Path) -> tuple[dict[str, Any], tuple[str, ...]]:
    """The scene of a sound point of a sweep, empty where none is left; and a sentence on damaged points before it."""
    damaged: list[str] = []
    found: dict[str, Any] = {}
    for path in sorted(folder.glob(f"points/*/{SUMMARY}")):
        try:
            found = open_run(path.parent).scene
            break
        except ResultsError:
            damaged.append(path.parent.name)
    if not damaged:
        return found, ()
    return found, (
        f"{folder}: damaged points: {', '.join(damaged)}; their rows are those of {SWEEP}. `bem sweep` with --resume "
        "computes them again",
    )


def _laid_out(
    data: xarray.Dataset, names: list[str], dimensions: tuple[str, ...], scene: Mapping[str, Any], title: str
) -> Points:
    shape = tuple(data.sizes[dim] for dim in dimensions)
    columns: dict[str, np.ndarray[Any, Any]] = {}
    units, meanings = {}, {}

    def enter(name: str, values: Any, unit: str, meaning: str) -> None:
        columns[name], units[name], meanings[name] = np.asarray(values), "" if unit == "1" else unit, meaning

    for axis, dim in enumerate(dimensions):
        if dim in data.coords:
            along = [1] * len(shape)
            along[axis] = shape[axis]
            values = np.broadcast_to(np.asarray(data[dim].values).reshape(along), shape).ravel()
            about = data[dim].attrs
            if np.unique(values).size > 1 or values.dtype.kind in "fiu":
                enter(dim, values, about.get("units", ""), about.get("long_name", dim))
    for key, found in _from_scene(scene, columns):
        enter(key, np.broadcast_to(found, shape).ravel() if np.ndim(found) == 0 else found, *_ABOUT[key])
    for name in names:
        item = data[name]
        index = tuple(slice(None) if dim in item.dims else None for dim in dimensions)
        values = np.asarray(item.transpose(*[dim for dim in dimensions if dim in item.dims]).values)[index]
        if values.dtype.kind in "fiuUSO":
            enter(
                name,
                np.broadcast_to(values, shape).ravel(),
                item.attrs.get("units", ""),
                item.attrs.get("long_name", name),
            )
    return Points(columns, units, meanings, title)


_ABOUT = {
    _TEMPERATURE: ("K", "temperature of the oil"),
    _RATIO: ("1", "slide-roll ratio, 2 (u1 - u2)/(u1 + u2)"),
}


def _from_scene(scene: Mapping[str, Any], columns: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Return the scene's values of quantities that do not vary: the oil's temperature, the slide-to-roll ratio."""
    from bem.scenes.units import TEMPERATURE

    found: list[tuple[str, Any]] = []
    oil, speeds = scene.get("oil"), scene.get("speeds")
    if _TEMPERATURE not in columns and isinstance(oil, Mapping) and oil.get("temperature") is not None:
        found.append((_TEMPERATURE, TEMPERATURE.parse(oil["temperature"])))
    if speeds is not None:
        found.append((_RATIO, _slide_roll_ratio(speeds, columns)))
    return found


def _slide_roll_ratio(speeds: Any, columns: Mapping[str, Any]) -> Any:
    """Slide-roll ratio of every point: from the varied keys of `speeds`, else from the table of the scene."""
    from bem.scenes.lubrication import slide_roll_ratio, speed_ratio

    table = speeds if isinstance(speeds, Mapping) else {}
    if _SLIP in columns:
        return np.asarray(columns[_SLIP], dtype=np.float64)
    cylinder = np.asarray(columns.get(_CYLINDER, table.get("cylinder", 0.0)), dtype=np.float64)
    return slide_roll_ratio(speed_ratio(cylinder, table.get("slide_roll_ratio")))
