"""Every built-in scene at the gallery's reduced size, some still smaller: its summary and the arrays of its results."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import FinishedRun, run_scene
from bem.scenes import library
from reports.gallery import gallery_scene
from reports.golden.record import Case, Figure, Record, Trial, plain_figure

COUNTS = {
    "convolutions", "iterations", "newton_steps", "film_solves", "contact_solves", "evaluations", "linear_cycles",
    "depths_computed",
}  # fmt: skip
"""Keys of summaries and names of arrays that count work."""
UNCOMPARED = {"scene", "kind", "version", "seed", "wall_time_s", "where"}
"""Keys of summaries that say what ran and where."""
TIMES = "seconds"
"""In names of times that the computer took."""
PART_OF_BAR = re.compile(r"_error_")
"""In names of the parts that an error bar is the sum of."""
SMALLER: dict[str, dict[tuple[str, ...], Any]] = {
    "starved-ball": {("film", "cells"): 48, ("over", "supply.layer"): ["150 nm", "500 nm"]},
    "film-rough-ball": {("film", "cells"): 48},
    "contact-challenge": {("contact", "adhesion", "range"): "60 nm"},
    "dimple": {("march", "steps"): 6},
    "waviness": {("march", "steps"): 6},
}
"""Scenes that take more than about two seconds at the gallery's size: keys and their values here. The challenge's own
range is not resolved by the cells, which then open and close by rounding."""
_NUDGED = {"load", "loads", "mean_pressure", "rms_height", "viscosity", "hertz_pressures", "hertz_pressure"}


def cases() -> dict[str, Case]:
    """Scenes by name."""
    return {name: partial(_run, name) for name in sorted(library())}


def small_scene(name: str, folder: Path) -> dict[str, Any]:
    """Table of a built-in scene as the golden net runs it.

    Parameters
    ----------
    name : of the scene.
    folder : where stand-ins for measured surfaces are written.
    """
    scene = gallery_scene(name, folder, reduced=True)
    for key, values in scene.get("over", {}).items():
        if isinstance(values, list):
            scene["over"][key] = [values[0], values[-1]]
    for path, value in SMALLER.get(name, {}).items():
        *tables, key = path
        place = scene
        for table in tables:
            place = place.setdefault(table, {})
        place[key] = value
    return scene


def _run(name: str, trial: Trial, folder: Path) -> Record:
    scene = nudged(small_scene(name, folder), trial)
    return record_of_run(run_scene(scene, folder / "run", figures=False, workers=1))


def nudged(scene: dict[str, Any], trial: Trial) -> dict[str, Any]:
    """The scene with loads, roughness and viscosity changed by the trial's nudge."""
    if not trial.nudge:
        return scene
    scene = copy.deepcopy(scene)
    _nudge(scene, 1 + trial.nudge)
    return scene


def _nudge(table: Any, factor: float) -> None:
    places = table.items() if isinstance(table, dict) else enumerate(table) if isinstance(table, list) else ()
    for key, value in list(places):
        if key in _NUDGED and isinstance(value, str | float | list):
            several = isinstance(value, list)
            changed = [_times(one, factor) for one in (value if several else [value])]
            table[key] = changed if several else changed[0]
        else:
            _nudge(value, factor)


def _times(quantity: Any, factor: float) -> Any:
    if isinstance(quantity, float):
        return quantity * factor
    if not isinstance(quantity, str):
        return quantity
    number, _, unit = quantity.partition(" ")
    return f"{float(number) * factor!r} {unit}"


def record_of_run(run: FinishedRun) -> Record:
    """Figures and counts of a finished run.

    Of a summary: numbers one by one, lists with their index, tables with their keys, of notes their number. Of an array
    of numbers in the results: its root mean square and its unit.
    """
    record = Record()
    for key, value in run.summary.items():
        if key in UNCOMPARED or TIMES in key or PART_OF_BAR.search(key):
            continue
        into: dict[str, Any] = record.counts if key in COUNTS else record.figures
        if key in ("notes", "outside_model"):
            record.figures[key] = float(len(value))
        else:
            into.update(_flat(key, value))
    record.figures["parts of error bars"] = " ".join(sorted(key for key in run.summary if PART_OF_BAR.search(key)))
    arrays = run.dataset.variables
    for name in sorted(str(one) for one in arrays):
        array = arrays[name]
        if array.dtype.kind not in "fiub" or TIMES in name or PART_OF_BAR.search(name):
            continue
        values = np.asarray(array.values, dtype=np.float64)
        finite = values[np.isfinite(values)]
        size = float(np.sqrt(np.mean(finite**2))) if finite.size else None
        if name.rpartition("/")[2] in COUNTS:
            record.counts[f"results/{name}"] = float(finite.sum())
        else:
            record.figures[f"results/{name} [{array.attrs.get('units', '1')}]"] = size
    return record


def _flat(key: str, value: Any) -> Iterator[tuple[str, Figure]]:
    if isinstance(value, dict):
        for name, one in value.items():
            if not (TIMES in name or PART_OF_BAR.search(name)):
                yield from _flat(f"{key}.{name}", one)
    elif isinstance(value, list) and not value:
        yield key, "empty"
    elif isinstance(value, list):
        for number, one in enumerate(value):
            yield from _flat(f"{key}.{number}", one)
    elif isinstance(value, bool):
        yield key, str(value).lower()
    else:
        yield key, plain_figure(value)
