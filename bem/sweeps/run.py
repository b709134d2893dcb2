"""A sweep from its definition to its files: plan every point, compute what is missing, collect, draw."""

from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bem
from bem.campaigns.cases import axis_values
from bem.campaigns.context import Silent, Watcher
from bem.campaigns.disk import marked
from bem.campaigns.engine import staff
from bem.errors import InputError, ResultsError
from bem.plots.sweep import draw_sweep
from bem.results import RunDirectory, open_run
from bem.results.atomic import reason, write_text
from bem.results.dataset import read_dataset, write_variables
from bem.results.directory import SCENE
from bem.runs import plan_scene
from bem.scenes import get_kind
from bem.scenes.common import SceneModel
from bem.scenes.load import dump_scene, load_scene, scene_table, unit_at
from bem.scenes.planner import check_memory
from bem.scenes.ranges import Axis, parse_axes
from bem.sweeps.collect import Coordinate, dataset_variables, table_text
from bem.sweeps.point import Done, Point, is_finished, store

if TYPE_CHECKING:
    import xarray

DEFINITION, DATASET, TABLE, FIGURE = "sweep.json", "sweep.nc", "sweep.csv", "sweep"
_POINTS = "points"


@dataclass(frozen=True)
class FinishedSweep:
    """A sweep on disk.

    Parameters
    ----------
    path : its folder, with `sweep.nc`, `sweep.csv`, figures and a run folder for each point under `points/`.
    computed : how many points this call computed; the others were there.
    failed : what went wrong, by the folder of the point.
    not_converged : folders of points whose solver did not converge.
    """

    path: Path
    computed: int
    failed: dict[str, str]
    not_converged: tuple[str, ...]

    @property
    def dataset(self) -> xarray.Dataset:
        """All summaries, with the swept keys as dimensions."""
        return read_dataset(self.path / DATASET)


def run_sweep(
    source: str | os.PathLike[str] | Mapping[str, Any],
    over: Sequence[str],
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    workers: int | None = None,
    scheduler: str | None = None,
    threads: int = 1,
    resume: bool = False,
    watcher: Watcher | None = None,
) -> FinishedSweep:
    """Run a scene at every combination of values.

    Parameters
    ----------
    source : as `bem.scenes.load_scene` takes it.
    over : swept keys: `key=first:last:count`, `key=log:first:last:count`, `key=first:last` (whole numbers) or
        `key=value,value,...` or `key=@FILE` (a value on each line); units as in scenes, an index into lists as in
        `variants[0].name`.
    out : the sweep's folder; `sweeps/NAME` where not given.
    settings : `key=value` changes to the scene.
    workers : processes on this machine; as many as cores (and memory) allow where not given.
    scheduler : address of a Dask scheduler, instead of processes on this machine.
    threads : threads of each run.
    resume : go on in a folder that holds a sweep. Points are known by their resolved scene, so values may be added to
        a finished sweep, and no finished point is computed again.
    watcher : told of progress and notes.

    Returns
    -------
    FinishedSweep : points that failed are in it; they do not end the sweep.

    Raises
    ------
    InputError : a bad scene or range, or a scheduler that does not answer; nothing is written.
    ResultsError : the folder is in use, holds a sweep already, or cannot be written.
    KeyboardInterrupt : passed on; the sweep can be resumed.
    """
    axes = parse_axes(over)
    if workers is not None and workers < 1:
        raise InputError(f"workers = {workers}: not positive; allowed: 1 or more")
    scenes, peak = _plan_points(source, axes, settings)
    texts = [dump_scene(scene) for scene in scenes]
    names = [f"{_POINTS}/{hashlib.sha256(text.encode()).hexdigest()[:16]}" for text in texts]
    coordinates = [_coordinate(axis, i, axes, scenes) for i, axis in enumerate(axes)]
    folder = Path("sweeps") / scenes[0].name if out is None else Path(out)
    held = RunDirectory(folder)
    try:
        _take(folder, scenes[0].name, axes, settings, resume)
    except BaseException:
        held.discard()
        raise
    with held:
        with marked(folder) as token:
            distinct = {name: i for i, name in reversed(list(enumerate(names)))}
            missing = [
                Point(i, texts[i], str(folder.resolve()), name, threads, token)
                for name, i in sorted(distinct.items(), key=lambda item: item[1])
                if not is_finished(folder / name)
            ]
            errors = _compute(missing, folder, len(distinct), peak, workers, scheduler, watcher)
        return _collect(
            folder, scenes[0], coordinates, names, {names[i]: words for i, words in errors.items()}, missing
        )


def _plan_points(
    source: str | os.PathLike[str] | Mapping[str, Any], axes: Sequence[Axis], settings: Sequence[str]
) -> tuple[list[SceneModel], float]:
    """The resolved scenes of all points and the largest memory any needs; mistakes of all points at once."""
    load_scene(source, settings)  # a mistake of the scene itself is said once, not for every point
    scenes, messages, peak = [], [], 0.0
    for values in product(*(axis.values for axis in axes)):
        own = [f"{axis.key}={value}" for axis, value in zip(axes, values, strict=True)]
        try:
            scene, plan = plan_scene(source, [*settings, *own])
            check_memory(plan)
        except InputError as error:
            messages += [f"at {', '.join(own)}: {message}" for message in error.messages]
            continue
        scenes.append(scene)
        peak = max(peak, plan.memory)
    if messages:
        more = [f"and {len(messages) - 10} more"] if len(messages) > 10 else []
        raise InputError([*messages[:10], *more])
    return scenes, peak


def _coordinate(axis: Axis, place: int, axes: Sequence[Axis], scenes: Sequence[SceneModel]) -> Coordinate:
    """Values of a swept key as the scenes understood them, with their unit."""
    step = math.prod(len(other.values) for other in axes[place + 1 :])
    values = axis_values(axis.key, axis.values, [scene_table(scenes[i * step]) for i in range(len(axis.values))])
    return Coordinate(axis, values, "1" if isinstance(values[0], str) else unit_at(scenes[0], axis.key))


def _take(folder: Path, name: str, axes: Sequence[Axis], settings: Sequence[str], resume: bool) -> None:
    """Write the definition, unless the folder holds something else."""
    path = folder / DEFINITION
    if (folder / SCENE).exists():
        raise ResultsError(f"{folder}: holds a single run; give another --out")
    if path.exists() and not resume:
        raise ResultsError(f"{folder}: holds a sweep already; --resume goes on in it (and may add values)")
    definition = {
        "scene": name,
        "version": bem.__version__,
        "settings": list(settings),
        "over": {axis.key: list(axis.values) for axis in axes},
    }
    write_text(path, json.dumps(definition, indent=1, ensure_ascii=False) + "\n")
    try:
        (folder / _POINTS).mkdir(exist_ok=True)
    except OSError as error:
        raise ResultsError(f"{folder / _POINTS}: cannot be made ({reason(error)})") from error


def _compute(
    missing: Sequence[Point],
    folder: Path,
    total: int,
    peak: float,
    workers: int | None,
    scheduler: str | None,
    watcher: Watcher | None,
) -> dict[int, str]:
    """Compute points; returns what went wrong, by index."""
    errors: dict[int, str] = {}
    if not missing:
        return errors
    done = total - len(missing)
    told = watcher or Silent()
    told.progress(done, total, "points", {})
    results: Iterator[tuple[int, Done]]
    if scheduler is not None:
        from bem.campaigns.cluster import compute_on_cluster

        results = compute_on_cluster(missing, scheduler)
    else:
        from bem.campaigns.local import compute_locally

        results = compute_locally(missing, staff(workers, len(missing), peak, told.note), lambda index: Silent())
    names = {point.index: point.folder for point in missing}
    try:
        for _, result in results:
            done += 1
            if result.files:
                store(result, folder / names[result.index])
            if result.error:
                errors[result.index] = result.error
                told.note(f"{names[result.index]}: {result.error}")
            told.progress(done, total, "points", {"failed": float(len(errors))} if errors else {})
    finally:
        results.close()  # type: ignore[attr-defined]  # ends the processes, or frees the cluster, at once
    return errors


def _collect(
    folder: Path,
    scene: SceneModel,
    coordinates: Sequence[Coordinate],
    names: Sequence[str],
    errors: Mapping[str, str],
    computed: Sequence[Point],
) -> FinishedSweep:
    """Dataset, table, figures."""
    summaries: list[dict[str, Any] | None] = []
    for name in names:
        try:
            summaries.append(open_run(folder / name).summary)
        except ResultsError:
            summaries.append(None)
    attributes = {
        "title": f"sweep of {scene.name} over {', '.join(item.axis.key for item in coordinates)}",
        "Conventions": "CF-1.11",
        "scene": scene.name,
        "kind": scene.kind,
        "version": bem.__version__,
    }
    variables = dataset_variables(get_kind(scene.kind), scene, coordinates, summaries)
    write_variables(folder / DATASET, variables, attributes)
    words = [errors.get(name, "") for name in names]
    write_text(folder / TABLE, table_text(coordinates, summaries, names, words))
    if any(summary is not None for summary in summaries):
        spacings = {item.axis.key: item.axis.spacing for item in coordinates}
        draw_sweep(variables, spacings, get_kind(scene.kind).headline, folder / FIGURE)
    stuck = [
        name
        for name, summary in zip(names, summaries, strict=True)
        if summary is not None and summary.get("status") != "converged"
    ]
    return FinishedSweep(folder, len(computed) - len(errors), dict(errors), tuple(dict.fromkeys(stuck)))
