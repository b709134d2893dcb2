"""A sweep from its definition to its files: plan every point, compute what is missing, collect, draw."""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bem
from bem.campaigns import campaign_of
from bem.campaigns.cases import axes_of_keys
from bem.campaigns.context import Silent, Watcher
from bem.campaigns.jobs import Staff, hand_out
from bem.errors import InputError, ResultsError
from bem.notes import Level, of_summary
from bem.notes.note import OUTSIDE, PLAIN, LevelledText
from bem.plots.draw import load_what_draws
from bem.plots.tables import summary_of_points
from bem.quantities import counted
from bem.results import RunDirectory
from bem.results.atomic import force_names, reason, write_text
from bem.results.dataset import read_dataset, write_variables
from bem.results.differing import words_of_difference
from bem.results.directory import SCENE, SUMMARY
from bem.runs.point import Point, finished_summary, store
from bem.runs.scene import check_out, check_workers, plan_scene
from bem.runs.table import dataset_variables, table_text
from bem.scenes import get_kind
from bem.scenes.asked import Asked, with_accuracy
from bem.scenes.axes import Axis
from bem.scenes.checks.plausible import oils_at_one_temperature
from bem.scenes.common import SceneModel
from bem.scenes.context import Variable
from bem.scenes.load import (
    changed_description,
    dump_scene,
    gather,
    read_table,
    refuse,
    scene_from_table,
    scene_table,
    scenes_at,
    words_at,
)
from bem.scenes.paths import parse_key, value_at
from bem.scenes.planner import Plan, check_memory
from bem.scenes.ranges import parse_axes

if TYPE_CHECKING:
    import xarray

DEFINITION, DATASET, TABLE, FIGURE = "sweep.json", "sweep.nc", "sweep.csv", "sweep"
_MOST_NOTES, _MOST_REMARKS, _FEW_POINTS = 20, 5, 3
_POINTS = "points"


@dataclass(frozen=True)
class FinishedSweep:
    """A sweep on disk.

    Attributes
    ----------
    path : its folder, with `sweep.nc`, `sweep.csv`, figures and a run folder for each point under `points/`.
    computed : how many points this call computed; the others were there.
    failed : what went wrong, by the folder of the point.
    not_converged : folders of points whose solver did not converge.
    figures : the figures that a run shows first, as lists with an entry for each case of each point, behind the
        values of the swept keys; laid out as the summary of a run.
    drawn : files of its figures.
    """

    path: Path
    computed: int
    failed: dict[str, str]
    not_converged: tuple[str, ...]
    figures: dict[str, Any] = field(default_factory=dict)
    drawn: tuple[Path, ...] = ()

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
    accuracy: Asked | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    threads: int = 1,
    resume: bool = False,
    watcher: Watcher | None = None,
    pdf: bool = False,
    fields: bool = False,
) -> FinishedSweep:
    """Run a scene at every combination of values.

    Parameters
    ----------
    source : as `bem.scenes.load_scene` takes it.
    over : swept keys: `key=first:last:count`, `key=log:first:last:count`, `key=first:last` (whole numbers) or
        `key=value,value,...` or `key=@FILE` (a value on each line); units as in scenes, an index into lists as in
        `variants[0].name`.
    out : the sweep's folder; `sweeps/NAME` where not given.
    settings, accuracy : as `run_scene` takes them.
    workers : processes on this machine; as many as cores (and memory) allow where not given.
    scheduler : address of a Dask scheduler, instead of processes on this machine.
    threads : threads of each run.
    resume : go on in a folder that holds a sweep. Points are known by their resolved scene, so values may be added to
        a finished sweep, and no finished point is computed again; the scene and settings but for the keys swept now
        are those of the sweep in the folder.
    watcher : told of progress and notes.
    pdf : draw the figure as PDF too, for print.
    fields : keep what of a point is a map at each of several depths, times or cases, too (`von_mises`, `stress`,
        frames), which takes most of its place; single maps are kept always. With `resume`, points that are there
        without are computed again.

    Returns
    -------
    FinishedSweep : points that failed are in it; they do not end the sweep.

    Raises
    ------
    InputError : a bad scene or range, a scheduler that does not answer, or `resume` in a folder that holds a sweep of
        another scene; nothing is written.
    ResultsError : the folder is in use, holds a sweep already, or cannot be written.
    KeyboardInterrupt : passed on; the sweep can be resumed.
    """
    swept, settings = parse_axes(over), with_accuracy(settings, accuracy)
    check_workers(workers)
    check_out(out)
    base, planned = _plan_points(source, {axis.key: axis.values for axis in swept}, settings)
    scenes = [scene for scene, _ in planned]
    axes = axes_of_keys({axis.key: axis.values for axis in swept}, scenes)
    names = [f"{_POINTS}/{hashlib.sha256(dump_scene(scene).encode()).hexdigest()[:16]}" for scene in scenes]
    folder = Path("sweeps") / scenes[0].name if out is None else Path(out)
    held = RunDirectory(folder)
    definition = {
        "scene": scenes[0].name,
        "version": bem.__version__,
        "settings": list(settings),
        "over": {axis.key: list(axis.values) for axis in swept},
        "base": scene_table(base),
    }
    try:
        _take(folder, definition, resume)
    except BaseException:
        held.discard()
        raise
    with held:
        places = {name: place for place, name in reversed(list(enumerate(names)))}
        summaries = {name: finished_summary(folder / name, fields) for name in dict.fromkeys(names)}
        root = folder.resolve()
        missing = [
            Point(places[name], *planned[places[name]], root, name, fields)
            for name, summary in summaries.items()
            if summary is None
        ]
        staff = Staff(workers, scheduler, threads, type(scenes[0]).__module__, root)
        labels = [words_at((a.key for a in swept), at) for at in product(*(a.values for a in swept))]
        computed, failed = _compute(missing, labels, len(summaries), staff, watcher or Silent())
        summaries |= computed
        in_order = [summaries[name] for name in names]
        for note in oils_at_one_temperature(scenes[0], [axis.key for axis in swept]):
            (watcher or Silent()).note(note)
        _tell_notes(in_order, labels, [folder / name / SUMMARY for name in names], watcher or Silent())
        variables = _collect(folder, scenes[0], axes, in_order)
        write_text(folder / TABLE, table_text(axes, in_order, names, failed))
        drawn: list[Path] = []
        if any(in_order):
            spacings = {axis.key: axis.spacing for axis in swept}
            drawn = _draw(folder, scenes[0].kind, variables, spacings, pdf)
        force_names(folder)
    stuck = [name for name, summary in summaries.items() if summary and summary.get("status") != "converged"]
    shown = summary_of_points(
        {axis.name: axis.si for axis in axes},
        list(product(*(axis.values for axis in axes))),
        in_order,
        (*(scenes[0].over or ()), *get_kind(scenes[0].kind).headline),
    )
    return FinishedSweep(folder, len(missing) - len(failed), failed, tuple(stuck), shown, tuple(drawn))


def _tell_notes(
    summaries: Sequence[Mapping[str, Any] | None], labels: Sequence[str], files: Sequence[Path], watcher: Watcher
) -> None:
    """Tell the notes of the points' summaries, those of one code, place and headline once: the most serious ones
    first, then the most frequent, with the points that they hold for.

    Where the texts differ, that of the first of the most serious points is shown with its label. Of remarks the
    headlines are told.

    files : summary of each point, of which the one with most remarks is named.
    """
    told: dict[tuple[str, ...], dict[str, set[int]]] = {}  # points by text, by what is said
    levels: dict[tuple[str, ...], dict[Level, set[int]]] = {}
    for point, summary in enumerate(summaries):
        for note in of_summary(summary or {}):
            plain = note["code"] == PLAIN
            said: tuple[str, ...] = (
                (note["code"], note["text"]) if plain else (note["code"], note["where"], _wording(note["text"]))
            )
            told.setdefault(said, {}).setdefault(note["text"], set()).add(point)
            levels.setdefault(said, {}).setdefault(Level(note["level"]), set()).add(point)
    order = list(Level)
    worst = {said: min(by_level, key=order.index) for said, by_level in levels.items()}
    number = {said: set().union(*by_text.values()) for said, by_text in told.items()}
    shown = [said for said in told if worst[said] != Level.INFO]
    shown.sort(key=lambda said: (order.index(worst[said]), -len(number[said])))
    for said in shown[:_MOST_NOTES]:
        most = levels[said][worst[said]]
        text, points = next((text, points) for text, points in told[said].items() if points & most)
        first = f"figures of {labels[min(points & most)]}" if len(told[said]) > 1 else ""
        beyond = f", outside the model in {len(most)}" if len(most) < len(number[said]) else ""
        of = _points_said(number[said], labels, len(summaries), first)
        level = "outside the model" if worst[said] is Level.OUTSIDE_MODEL and not beyond else "caution"
        at = f"{level}, {len(number[said])} of {counted(len(summaries), 'point')}{beyond}{of}"
        watcher.note(LevelledText(f"{at}: {text.replace(OUTSIDE, '', 1)}"))
    if (more := len(shown) - _MOST_NOTES) > 0:
        watcher.note(LevelledText(f"and {more} more, in the summary.json of points"))
    remarks = [said for said in told if worst[said] == Level.INFO]
    remarks.sort(key=lambda said: -len(number[said]))
    for said in remarks[:_MOST_REMARKS]:
        of = _points_said(number[said], labels, len(summaries), "")
        headline = next(iter(told[said])).partition(". ")[0].rstrip(".")
        at = f"remark, {len(number[said])} of {counted(len(summaries), 'point')}{of}"
        watcher.note(LevelledText(f"{at}: {headline}."))
    if remarks:
        most_told = max(range(len(files)), key=lambda point: sum(point in number[said] for said in remarks))
        where = f'read "notes" in {files[most_told]} (each point has its own)'
        watcher.note(LevelledText(f"{counted(len(remarks), 'remark')}: {where}"))


def _wording(text: str) -> str:
    """Return the first sentence of a note without its numbers: notes of other headlines are other notes."""
    return re.sub(r"\d+(\.\d+)?", "", text.replace(OUTSIDE, "", 1).partition(". ")[0])


def _points_said(points: set[int], labels: Sequence[str], count: int, first: str) -> str:
    """Return the points that a note holds for, in brackets: those of few that are not all, and whose figures follow."""
    few = sorted(points) if len(points) < count and len(points) <= _FEW_POINTS else []
    words = [*([", ".join(labels[point] for point in few)] if few and not (first and len(few) == 1) else []), first]
    said = "; ".join(word for word in words if word)
    return f" ({said})" if said else ""


def _plan_points(
    source: str | os.PathLike[str] | Mapping[str, Any], over: Mapping[str, Sequence[str]], settings: Sequence[str]
) -> tuple[SceneModel, list[tuple[SceneModel, Plan]]]:
    """The scene itself, as it was given, and the resolved ones of all points with their plans; mistakes of all points
    at once."""
    table = read_table(source, settings)
    base = _scene_itself(table, over)
    if base.description:  # of the points: sorted keys without values, so that a resumed sweep finds its points
        table = {**table, "description": changed_description(base.description, sorted(over))}
    planned: list[tuple[SceneModel, Plan]] = []
    mistakes: dict[str, list[str]] = {}
    for scene, values in zip(scenes_at(table, over), product(*over.values()), strict=True):
        try:
            resolved, plan = plan_scene(scene)
            check_memory(plan)
            planned.append((resolved, plan))
        except InputError as error:
            gather(mistakes, words_at(over, values), error)
    refuse(mistakes)
    return base, planned


def _scene_itself(table: Mapping[str, Any], over: Mapping[str, Sequence[str]]) -> SceneModel:
    """The scene as it was given; at the first swept values, where it is none without them.

    Raises
    ------
    InputError : a mistake of the scene itself, once and not for every point.
    """
    try:
        return scene_from_table(table)
    except InputError:
        try:
            (first,) = scenes_at(table, {key: values[:1] for key, values in over.items()})
        except InputError:
            first = None
        if first is None:
            raise
        return first


def _take(folder: Path, definition: Mapping[str, Any], resume: bool) -> None:
    """Write the definition, unless the folder holds something else."""
    path = folder / DEFINITION
    if (folder / SCENE).exists():
        raise ResultsError(f"{folder}: holds a single run; give another --out")
    if path.exists() and not resume:
        raise ResultsError(
            f"{folder}: holds a sweep already; give another folder with --out, or go on in this one with --resume "
            "(values may be added)"
        )
    if path.exists():
        _check_same_base(folder, definition)
    write_text(path, json.dumps(definition, indent=1, ensure_ascii=False) + "\n")
    try:
        (folder / _POINTS).mkdir(exist_ok=True)
    except OSError as error:
        raise ResultsError(f"{folder / _POINTS}: cannot be made ({reason(error)})") from error


def _check_same_base(folder: Path, definition: Mapping[str, Any]) -> None:
    """InputError unless the sweep in the folder is of the same scene and settings, but for the keys swept now."""
    try:
        there = json.loads((folder / DEFINITION).read_text("utf-8"))["base"]
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(
            f"--resume: {folder / DEFINITION} does not say of which scene its sweep is; allowed: another --out"
        ) from None
    now = json.loads(json.dumps(definition["base"]))
    for table in (there, now):
        table.pop("description", None)  # it names settings, which may be of keys that are swept now
    for key in definition["over"]:
        for table in (there, now):
            _take_out(table, parse_key(key) or ())
    differ = words_of_difference(there, now)
    if differ:
        raise InputError(
            f"--resume: the sweep in {folder} is of another scene or other settings (they differ in {differ}); "
            "allowed: the same, of which more values may be swept, or another --out"
        )


def _take_out(table: Any, key: Sequence[str | int]) -> None:
    """Take what stands at a key out, in place, if anything does; the other items of a list stay where they are."""
    place = value_at(table, key[:-1])
    if isinstance(place, dict):
        place.pop(key[-1], None)
    elif isinstance(place, list) and isinstance(key[-1], int) and key[-1] < len(place):
        place[key[-1]] = "swept"


def _compute(
    missing: Sequence[Point], labels: Sequence[str], total: int, staff: Staff, watcher: Watcher
) -> tuple[dict[str, dict[str, Any] | None], dict[str, str]]:
    """Compute points; their summaries, and what went wrong, by folder; `labels` : of all points, by their places."""
    summaries: dict[str, dict[str, Any] | None] = {}
    failed: dict[str, str] = {}
    before = total - len(missing)
    if missing:
        watcher.progress(before, total, "points", {})
    with closing(hand_out(missing, staff, lambda index: Silent(), watcher.note)) as results:  # ends all work at once
        for index, done in results:
            load_what_draws()  # once, while others compute
            if done.files and staff.folder is not None:
                store(done, staff.folder / done.name)
            summaries[done.name] = done.summary
            if done.error:
                failed[done.name] = done.error
                watcher.note(f"{labels[index]} ({done.name}): {done.error}")
            figures = {"failed": float(len(failed))} if failed else {}
            watcher.progress(before + len(summaries), total, "points", figures)
    return summaries, failed


def _collect(
    folder: Path, scene: SceneModel, axes: Sequence[Axis], summaries: Sequence[Mapping[str, Any] | None]
) -> dict[str, Variable]:
    """The dataset, written."""
    attributes = {
        "title": f"sweep of {scene.name} over {', '.join(axis.name for axis in axes)}",
        "Conventions": "CF-1.11",
        "scene": scene.name,
        "kind": scene.kind,
        "version": bem.__version__,
    }
    variables = dataset_variables(get_kind(scene.kind), axes, campaign_of(scene).axes, summaries)
    write_variables(folder / DATASET, variables, attributes)
    return variables


def _draw(
    folder: Path, kind: str, variables: dict[str, Variable], spacings: Mapping[str, str], pdf: bool
) -> list[Path]:
    """Draw the figures over the swept keys, and those of the kind that show all points; return their files."""
    from bem.plots.points import draw_points
    from bem.plots.sweep import draw_sweep

    formats, found = ("png", "pdf") if pdf else ("png",), get_kind(kind)
    paths = draw_sweep(variables, spacings, found.headline, folder / FIGURE, formats)
    return paths + draw_points(variables, kind, found.figures, folder, formats)
