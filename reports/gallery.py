"""Every built-in scene, run: `python -m reports gallery` at full size, with `--reduced` in some minutes.

Runs lie under `reports/gallery/` (or `--out`), one folder for each scene, and are not run again once they are finished;
`reports/gallery.html` shows them. Scenes on measured surfaces get two generated maps as stand-ins, which the page says.
"""

from __future__ import annotations

import base64
import copy
import html
import math
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from bem.cli._terminal import Terminal
from bem.errors import BemError
from bem.notes import of_summary
from bem.results import FinishedRun
from bem.results.read import damaged_files
from bem.runs import plan_scene, run_scene
from bem.scenes import get_kind, library
from bem.scenes.load import dump_scene
from bem.scenes.planner import machine_rate, show_seconds
from reports.builder import HERE, Page, Section, table, text

RUNS = HERE / "gallery"
_STAND_IN_CELLS, _STAND_IN_LENGTH = 256, 100e-6


def gallery_scene(name: str, folder: Path, *, reduced: bool = False) -> dict[str, Any]:
    """The table of a built-in scene as the gallery runs it.

    Parameters
    ----------
    name : of the scene.
    folder : where stand-ins for measured surfaces are written, if the scene needs them.
    reduced : fewer cells, cycles, speeds, loads and repetitions; the physics and every code path stay.
    """
    scene = copy.deepcopy(library()[name]) | {"name": name}
    for place, side in enumerate(("lower", "upper")):
        surface = scene.get(side, {}).get("surface")
        if isinstance(surface, dict) and "path" in surface:
            surface["path"] = str(_stand_in(folder, side, seed=place + 1))
    if not reduced:
        return scene
    return _reduced(scene)


def run_gallery(
    folder: Path = RUNS,
    *,
    names: Sequence[str] = (),
    reduced: bool = False,
    say: Callable[[str], None] = lambda words: None,
) -> dict[str, FinishedRun | str]:
    """Run scenes (all where none is named), the quickest first; what went wrong stands in a run's place.

    Finished runs of the very same scene are taken as they are, begun ones go on from their checkpoint. A scene that
    fails, in whatever way, does not keep the others from running. `say` is told what runs, and about how much is left.
    """
    found: dict[str, FinishedRun | str] = {}
    chosen = list(names or library())
    scenes: dict[str, dict[str, Any]] = {}
    planned: dict[str, float] = {}
    for name in chosen:
        try:
            scenes[name] = gallery_scene(name, folder, reduced=reduced)
            scene, plan = plan_scene(scenes[name])
            planned[name] = 0.0 if _is_there(folder / name, dump_scene(scene)) else plan.seconds(machine_rate())
        except Exception as error:
            found[name] = _words(error)
    clock = _Clock()
    waiting = sorted(planned, key=lambda name: planned[name])
    with Terminal() as terminal:
        for number, name in enumerate(waiting):
            left = math.fsum(planned[other] for other in waiting[number:])
            if planned[name] == 0:
                say(f"{number + 1} of {len(waiting)}, {name}: finished before")
            else:
                say(
                    f"{number + 1} of {len(waiting)}, {name}: about {show_seconds(clock.factor * planned[name])}; "
                    f"about {show_seconds(clock.factor * left)} left in all"
                )
            start = time.monotonic()
            try:
                sound = not _is_damaged(folder / name)
                found[name] = run_scene(scenes[name], folder / name, resume=sound, overwrite=True, watcher=terminal)
                if planned[name] > 0:
                    clock.add(planned[name], time.monotonic() - start)
            except Exception as error:
                found[name] = _words(error)
                say(f"{name} failed: {found[name]}")
    return {name: found[name] for name in chosen}


class _Clock:
    """How much longer runs take than planned, from those that are over."""

    def __init__(self) -> None:
        self._planned = self._taken = 0.0

    def add(self, planned: float, taken: float) -> None:
        self._planned += planned
        self._taken += taken

    @property
    def factor(self) -> float:
        return self._taken / self._planned if self._planned > 0 else 1.0


def unfinished(runs: Mapping[str, FinishedRun | str]) -> list[str]:
    """A line for each scene that failed or did not converge."""
    lines = []
    for name, run in runs.items():
        if isinstance(run, str):
            lines.append(f"{name}: {run}")
        elif run.summary["status"] != "converged":
            lines.append(f"{name}: {run.summary['status']}: {run.summary['where']}")
    return lines


def page(runs: Mapping[str, FinishedRun | str], *, reduced: bool = False) -> Page:
    """The page of these runs."""
    known = library()
    rows = [
        (name, known[name]["kind"], known[name].get("redoes", ""), _status(run), _seconds(run))
        for name, run in runs.items()
    ]
    failed = unfinished(runs)
    summary = text(
        f"{len(runs) - len(failed)} of {len(runs)} scenes converged."
        if failed
        else f"All {len(runs)} scenes converged."
    )
    sections = [Section("All scenes", summary + table(("scene", "kind", "redoes", "status", "time"), rows))]
    sections += [Section(name, _about(name, known[name], run)) for name, run in runs.items()]
    size = "at reduced size" if reduced else "at full size"
    return Page("gallery", "Gallery", f"Every built-in scene of bem, run {size}: figures and what they redo.", sections)


def build(folder: Path = RUNS, *, reduced: bool = False) -> Page:
    """The page, from finished runs; those that are missing are run."""
    return page(run_gallery(folder, reduced=reduced), reduced=reduced)


def _is_there(folder: Path, scene: str) -> bool:
    """Return True if a finished run of this very scene is in the folder."""
    try:
        return (folder / "scene.toml").read_text("utf-8") == scene and (folder / "summary.json").exists()
    except OSError:
        return False


def _is_damaged(folder: Path) -> bool:
    """Return True if a run was finished there once, but cannot be trusted now."""
    try:
        return (folder / "summary.json").exists() and bool(damaged_files(folder))
    except BemError:
        return True


def _words(error: Exception) -> str:
    return str(error) if isinstance(error, BemError) else f"{type(error).__name__}: {error}"


def _about(name: str, scene: dict[str, Any], run: FinishedRun | str) -> str:
    body = text(scene["description"] + (f" Reproduces {scene['redoes']}." if scene.get("redoes") else ""))
    if '"path"' in str(scene).replace("'", '"'):
        body += text("The measured surfaces are the user's to give: two generated maps stand in for them here.")
    body += f"<pre>bem run {html.escape(name)}</pre>"
    if isinstance(run, str):
        return body + text(f"Not finished: {run}")
    from bem.plots.report import spelled

    headline = [key for key in get_kind(scene["kind"]).headline if run.summary.get(key) is not None]
    body += table(("figure", "value"), [spelled(key, run.summary[key]) for key in headline])
    for note in of_summary(run.summary):
        body += text(f"Note: {note['text']}")
    pictures = sorted((run.path / "figures").glob("*.png"), key=lambda item: _rank(scene["kind"], item.stem))
    for picture in pictures[:4]:
        data = base64.b64encode(picture.read_bytes()).decode()
        words = html.escape(picture.stem.replace("-", " "))
        body += (
            f'<figure><img alt="{words}" src="data:image/png;base64,{data}"><figcaption>{words}</figcaption></figure>'
        )
    return body


def _rank(kind: str, figure: str) -> int:
    figures = get_kind(kind).figures
    return figures.index(figure) if figure in figures else len(figures)


def _status(run: FinishedRun | str) -> str:
    return "not finished" if isinstance(run, str) else str(run.summary["status"])


def _seconds(run: FinishedRun | str) -> str:
    return "" if isinstance(run, str) else f"{run.summary['wall_time_s']:.0f} s"


def _stand_in(folder: Path, side: str, seed: int) -> Path:
    """A generated map in place of a measured one, the same bits every time."""
    from bem.grid import Grid
    from bem.surfaces import Surface, generate_surface, write_surface

    path = folder / "stand-ins" / f"{side}.npz"
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        cell = _STAND_IN_LENGTH / _STAND_IN_CELLS
        grid = Grid((_STAND_IN_CELLS, _STAND_IN_CELLS), (cell, cell), periodic=(True, True))
        heights = generate_surface(grid, rms_height=100e-9, seed=seed, hurst=0.8, rolloff_wavelength=20e-6)
        write_surface(path, Surface(heights, grid.spacing, {"stand-in": True}))
    return path


_LONGEST_LISTS = {
    "cylinder.loads": 1, "contact.loads": 1, "contact.hertz_pressures": 1, "rubbing.temperatures": 2, "variants": 2,
    "hardnesses": 2, "speeds.values": 2, "array.spacings": 2, "array.interferences": 2,
}  # fmt: skip
_LARGEST = {
    "speeds.count": 3, "cycles.count": 4, "cycles.settled": 2, "cycles.averaged": 2, "march.steps": 20,
    "life.count": 1000, "wear.positions": 2, "film.points": 400, "film.cells": 64, "outputs.depths.count": 6,
    "synthetic.count": 30,
}  # fmt: skip
"""Of a scene whose physics is the same with less of it."""


def _reduced(scene: dict[str, Any]) -> dict[str, Any]:
    """The scene with everything that only costs time made small."""
    if "repetitions" in scene:
        scene["repetitions"] = 1
    for key, most in _LONGEST_LISTS.items():
        _shorten(scene, tuple(key.split(".")), most)
    for key, most in _LARGEST.items():
        _smaller(scene, tuple(key.split(".")), most)
    if scene["kind"] in ("wear", "running-in") and "cycles" not in scene:
        scene["cycles"] = {"count": 4, "settled": 2}
    if "accuracy" in scene:  # the grid follows from it, and from the shortest waves
        scene["accuracy"] = "10 %"
        return scene
    _coarser(scene)
    _smoother(scene)
    return scene


def _coarser(scene: dict[str, Any]) -> None:
    """Fewer cells over the same lengths, fewer depths to the same depth."""
    grid = scene.get("grid", {})
    if "shape" in grid:
        old = grid["shape"] if isinstance(grid["shape"], list) else [grid["shape"]] * 2
        new = [min(n, max(8, n // 4)) for n in old]
        if "spacing" in grid:
            grid["lengths"] = [f"{_number(grid['spacing']) * n:.12g} {_unit(grid['spacing'])}" for n in old]
            del grid["spacing"]
        grid["shape"] = new
    for place in [scene.get("domain", {}), *scene.get("variants", ())]:
        if isinstance(place.get("cells"), int):
            place["cells"] = max(20, place["cells"] // 5)
    if scene["kind"] == "wear" and "cells" not in scene["domain"]:
        scene["domain"]["cells"] = 48
    for place in [scene, *scene.get("variants", ())]:
        depths = place.get("depths")
        if isinstance(depths, dict) and depths.get("count", 0) > 8:
            deepest = _number(depths["spacing"]) * (depths["count"] - 1)
            depths["count"] = 8
            depths["spacing"] = f"{deepest / 7:.12g} {_unit(depths['spacing'])}"
    if "synthetic" in scene:
        scene["synthetic"]["shape"] = [256, 256]
        scene["synthetic"]["lengths"] = ["10 um", "10 um"]
    if "array" in scene:
        scene["array"]["cell"] = "460 nm"
        scene["array"]["window"] = "92 um"


def _smoother(scene: dict[str, Any]) -> None:
    """Roughness that the coarser cells can hold: no cut-off but the cells' own, no correlation below a few cells."""
    for side in ("lower", "upper"):
        surface = scene.get(side, {}).get("surface")
        if not isinstance(surface, dict):
            continue
        surface.pop("cutoff_wavelength", None)
        length = surface.get("correlation_length")
        if length is not None and "grid" in scene and _unit(length) == "um" and _number(length) < 5:
            surface["correlation_length"] = f"{4 * _number(length):g} um"


def _at(scene: dict[str, Any], path: Sequence[str]) -> dict[str, Any] | None:
    """The innermost table of a path of keys, if the whole path is there."""
    for key in path[:-1]:
        scene = scene.get(key, {})
        if not isinstance(scene, dict):
            return None
    return scene if path[-1] in scene else None


def _shorten(scene: dict[str, Any], path: Sequence[str], keep: int) -> None:
    place = _at(scene, path)
    if place is not None and len(place[path[-1]]) > keep:
        values = place[path[-1]]
        step = max(1, math.ceil((len(values) - 1) / max(keep - 1, 1)))
        place[path[-1]] = values[::step][:keep]


def _smaller(scene: dict[str, Any], path: Sequence[str], largest: int) -> None:
    place = _at(scene, path)
    if place is not None:
        place[path[-1]] = min(place[path[-1]], largest)


def _number(quantity: str) -> float:
    return float(quantity.split()[0])


def _unit(quantity: str) -> str:
    return quantity.split()[1]
