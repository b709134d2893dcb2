"""From a scene to a run directory: plan, run, and everything that is written on the way."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import bem
from bem.campaigns import Computed, campaign_of, compute, plan
from bem.campaigns.context import Silent, Watcher
from bem.campaigns.jobs import Staff
from bem.distributed.session import current_session
from bem.errors import ConvergenceError, InputError, Status
from bem.notes import Level, Note, outside
from bem.notes.contact import edge_notes_as_one
from bem.notes.merge import without_foreseen
from bem.results.arrays import LEFT_OUT, Arrays, stacks_of_maps
from bem.results.directory import RESULTS, RunDirectory, plain
from bem.results.read import FinishedRun, check_data, open_run
from bem.scenes import build
from bem.scenes.asked import Asked, with_accuracy
from bem.scenes.checks import examine, outcome_warnings, scene_warnings, suspected_units
from bem.scenes.checks.plausible import notes_over
from bem.scenes.common import SceneModel
from bem.scenes.kind import get_kind
from bem.scenes.load import dump_scene, load_scene, scene_table
from bem.scenes.planner import Plan, check_memory


def plan_scene(
    source: str | os.PathLike[str] | Mapping[str, Any] | SceneModel,
    settings: Sequence[str] = (),
    accuracy: Asked | None = None,
) -> tuple[SceneModel, Plan]:
    """The resolved scene and what running it would compute, as `run_scene` takes them; no work is done.

    Raises
    ------
    InputError : a bad scene.
    """
    settings = with_accuracy(settings, accuracy)
    if not isinstance(source, SceneModel):
        scene = load_scene(source, settings)
    else:
        scene = load_scene(scene_table(source), settings) if settings else source
    try:
        if scene.over is None:  # else each of its cases is resolved by itself
            scene = get_kind(scene.kind).resolved(scene)
        return scene, plan(campaign_of(scene))
    except InputError as error:
        if suspected := suspected_units(scene):
            raise InputError(suspected) from error
        raise


def run_scene(
    source: str | os.PathLike[str] | Mapping[str, Any] | SceneModel,
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    accuracy: Asked | None = None,
    resume: bool = False,
    overwrite: bool = False,
    figures: bool = True,
    workers: int | None = None,
    scheduler: str | None = None,
    watcher: Watcher | None = None,
    pdf: bool = False,
) -> FinishedRun:
    """Run a scene and write its run directory.

    Parameters
    ----------
    source : as `bem.scenes.load_scene` takes it, or a scene already loaded.
    out : the run's folder; the next free `runs/NAME-001` where not given.
    settings : `key=value` changes to the scene.
    accuracy : asked for instead of a grid, as in a scene: "1 %", 0.01, or a table of figures.
    resume : go on from the checkpoint of an interrupted run; a finished run is returned as it is, unless a file of it
        is damaged (ResultsError).
    overwrite : replace an older run in the folder; it stays until this one is finished. With `resume`, replace
        it only if it is of another scene.
    figures : draw figures and write the report; `bem report` can do it later.
    workers : processes, for a scene of several cases; as many as cores and memory allow where not given.
    scheduler : address of a Dask scheduler, instead of processes on this machine.
    watcher : told of progress and notes, and of the numbers before pictures of them are drawn.
    pdf : draw every figure as PDF too, for print; `bem plot` makes any later.

    Returns
    -------
    FinishedRun : `summary["status"]` says whether the solvers converged; a run that did not is kept all the same.

    Raises
    ------
    InputError : a bad scene; nothing is left behind.
    ConvergenceError : the run could not go on, or found its input bad after something had been computed; the
        checkpoint stays.
    ResultsError : the results cannot be written.
    KeyboardInterrupt : passed on; the folder can be resumed.
    """
    check_workers(workers)
    check_out(out)
    formats = ("vtu", *(("png", "pdf") if pdf else ("png",))) if figures else ("vtu",)
    scene, planned = plan_scene(source, settings, accuracy)
    if (session := current_session()) is not None:
        workers = _on_ranks(workers, scheduler)
        planned = plan_on_ranks(scene, planned, session.ranks.size)
    check_memory(planned)
    held = RunDirectory.start(
        None if out is None else Path(out), scene.name, dump_scene(scene), resume=resume, overwrite=overwrite
    )
    with held as directory:
        if directory.resumed and directory.finished:
            check_data(directory.path)
        else:
            run_planned(directory, scene, planned, Staff(workers, scheduler), formats, watcher or Silent())
    return open_run(directory.path)


def _on_ranks(workers: int | None, scheduler: str | None) -> int:
    """Return the number of workers of a scene on several ranks, one; InputError where more or a scheduler are given."""
    if scheduler is not None or (workers or 1) > 1:
        raise InputError("--ranks with --workers or --scheduler; allowed: --ranks alone, its cases run one by one")
    return 1


def plan_on_ranks(scene: SceneModel, planned: Plan, ranks: int) -> Plan:
    """Return the plan of the first of several processes that share each contact of a scene (`bem run --ranks`).

    Raises
    ------
    InputError : another kind of scene, options that hold in one process only.
    """
    refuse = get_kind(scene.kind).refuse_on_ranks
    if refuse is None:
        raise InputError(f'--ranks: scenes of kind "{scene.kind}" run in one process; allowed: kind = "contact"')
    cells = 1
    for case in campaign_of(scene).cases:
        refuse(case.scene)
        cells = max(cells, build.grid_of(case.scene.grid).cells)  # type: ignore[attr-defined]  # of kind contact
    return planned.on_ranks(ranks, cells)


def check_out(out: str | os.PathLike[str] | None) -> None:
    """InputError if the name of a folder is empty: it would be the current folder."""
    if isinstance(out, str) and not out.strip():
        raise InputError('out = "": an empty name; allowed: a folder, "." for the current one, or none at all')


def check_workers(workers: int | None) -> None:
    """InputError if a number of workers is given that is none."""
    if workers is not None and workers < 1:
        raise InputError(f"workers = {workers}: not positive; allowed: 1 or more")


def run_planned(
    directory: RunDirectory,
    scene: SceneModel,
    planned: Plan,
    staff: Staff,
    formats: tuple[str, ...],
    watcher: Watcher,
    fields: bool = True,
) -> dict[str, Any]:
    """Compute and write all of a run, with pictures in `formats` ("vtu", "png", "pdf"); return its summary.

    Without `fields` the file of results has single maps but no stacks of them (stresses at depths, frames over time).

    Raises as `run_scene`.
    """
    campaign = campaign_of(scene)
    try:
        facts = examine(campaign.base)
        notes = scene_warnings(facts)
        notes += [text for text in notes_over(scene) if text not in notes]
        for note in notes:
            watcher.note(note)
        computed = compute(
            campaign,
            directory.path,
            plan=planned,
            workers=staff.workers,
            scheduler=staff.scheduler,
            watcher=watcher,
        )
    except InputError as error:
        if directory.begun:
            raise ConvergenceError(
                f"{'; '.join(error.messages)}. What was computed before is kept in {directory.home}: the same "
                "command with --resume goes on from there, a changed scene needs another --out"
            ) from error
        directory.discard()
        raise
    # a note of a case that the scene's own check has made already, at another place, is left out
    made = {(note.code, note.texts) for note in notes}
    computed.notes[:] = [*notes, *(note for note in computed.notes if (note.code, note.texts) not in made)]
    told = set(computed.notes)
    computed.notes.extend(outcome_warnings(facts, computed.outcome))
    computed.notes[:] = without_foreseen(edge_notes_as_one(computed.notes))
    for note in computed.notes:
        if note not in told:
            watcher.note(note)
    computed.notes.sort(key=lambda note: list(Level).index(note.level))  # the most serious ones first
    left_out = [] if fields else stacks_of_maps(computed.outcome.variables)
    return _write(directory, scene, computed, formats, watcher, left_out)


def _stored(notes: list[Note]) -> dict[str, Any]:
    """Return notes as the summary holds them, and the headlines of those that put results outside the model, if any."""
    beyond = list(outside(notes))
    found: dict[str, Any] = {"notes": [note.as_dict() for note in notes]}
    return {**found, "outside_model": beyond} if beyond else found


def _write(
    directory: RunDirectory,
    scene: SceneModel,
    computed: Computed,
    formats: tuple[str, ...],
    watcher: Watcher,
    left_out: Collection[str],
) -> dict[str, Any]:
    """Arrays but those left out, volumes, figures with the report (neither without a format); the summary last."""
    from bem.plots.pages import Pages, make
    from bem.results.dataset import write_variables
    from bem.results.vtk import write_volumes

    outcome, seconds = computed.outcome, dict(computed.seconds)
    about = {"scene": scene.name, "kind": scene.kind, "version": bem.__version__, "seed": scene.seed}
    attributes = {"title": scene.description or scene.name, "Conventions": "CF-1.11", **about}
    attributes["axes"] = " ".join(outcome.axes)
    variables = {name: item for name, item in outcome.variables.items() if name not in left_out}
    if left_out:
        attributes[LEFT_OUT] = " ".join(left_out)
    with _timed(seconds, "writing results"):
        write_variables(directory.path / RESULTS, variables, attributes)
    summary = {
        **about,
        "wall_time_s": 0.0,
        "status": Status(outcome.status).value,
        "where": outcome.where,
        **plain(outcome.summary),
        **({"over": {key: outcome.variables[key].units for key in scene.over}} if scene.over else {}),
        **_stored(computed.notes),
        "seconds_by_stage": seconds,
    }
    kind = get_kind(scene.kind)
    headline = (*(scene.over or ()), *kind.headline)
    drawn_as = tuple(ending for ending in formats if ending != "vtu")
    pages = Pages(directory.path, scene_table(scene), summary, kind.figures, drawn_as, headline)
    arrays = Arrays(variables, attributes)
    summary["wall_time_s"] = time.time() - computed.epoch  # of the numbers, as told; pictures have a stage of their own
    tell = getattr(watcher, "numbers", None)
    if tell is not None:
        with suppress(OSError):  # nobody may be listening any more; the run goes on
            tell(summary, headline)
    if outcome.volumes and not outcome.axes and "vtu" in formats:
        with _timed(seconds, "writing results"):
            write_volumes(directory.path, outcome.variables, outcome.volumes)
    if drawn_as:
        directory.sum_up()
        with _timed(seconds, "figures and report"):
            missing = make(pages, arrays)
        for note in missing:
            summary["notes"].append(note.as_dict())
            watcher.note(note)
    directory.finish(summary)
    return summary


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    """Add the time spent in the block to the stage's sum."""
    start = time.perf_counter()
    try:
        yield
    finally:
        seconds[stage] = seconds.get(stage, 0.0) + time.perf_counter() - start
