"""From a scene to a run directory: plan, run, and everything that is written on the way."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import bem
from bem.errors import ConvergenceError, InputError, Status
from bem.results.directory import RESULTS, RunDirectory, plain
from bem.results.read import FinishedRun, open_run
from bem.scenes.common import SceneModel
from bem.scenes.context import Outcome, derive_seed
from bem.scenes.kinds import Kind, get_kind
from bem.scenes.load import dump_scene, load_scene, scene_table
from bem.scenes.planner import Plan, check_memory

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Watcher(Protocol):
    """Who is told how a run goes on, such as a terminal."""

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """`done` of `total` steps are finished."""

    def note(self, text: str) -> None:
        """Something the reader must know."""


class _Silent:
    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        pass

    def note(self, text: str) -> None:
        pass


class RunContext:
    """The `bem.scenes.Context` of a run that has a folder."""

    def __init__(self, directory: RunDirectory, scene: SceneModel, watcher: Watcher) -> None:
        self._directory = directory
        self._scene = scene
        self._watcher = watcher
        self.notes: list[str] = []
        self.seconds: dict[str, float] = {}
        self._open: dict[str, float] = {}
        self._start = time.perf_counter()
        self._state = directory.load_checkpoint() if directory.resumed else None
        if self._state is not None:
            self.notes = list(self._state.pop("_notes"))
            self.seconds = dict(self._state.pop("_seconds"))
            self._start -= self._state.pop("_wall_time_s", 0.0)

    @property
    def wall_time(self) -> float:
        """Seconds of this session and of those before it, up to their last checkpoint."""
        return time.perf_counter() - self._start

    @property
    def resumed(self) -> bool:
        """See `bem.scenes.Context`."""
        return self._directory.resumed

    def seed(self, purpose: str, *indices: int) -> int:
        """See `bem.scenes.Context`."""
        return derive_seed(self._scene.seed, purpose, *indices)

    def progress(self, done: int, total: int, what: str = "", /, **figures: float) -> None:
        """See `bem.scenes.Context`."""
        self._watcher.progress(done, total, what, figures)

    def note(self, text: str) -> None:
        """See `bem.scenes.Context`."""
        if text not in self.notes:
            self.notes.append(text)
            self._watcher.note(text)

    @contextmanager
    def timer(self, stage: str) -> Iterator[None]:
        """See `bem.scenes.Context`."""
        if stage in self._open:  # the outer block counts it
            yield
            return
        self._open[stage] = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - self._open.pop(stage)

    def scratch(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """See `bem.scenes.Context`."""
        from bem.results.scratch import scratch_array

        return scratch_array(self._directory.path, shape)

    def save(self, state: Mapping[str, Any]) -> None:
        """See `bem.scenes.Context`."""
        now = time.perf_counter()
        seconds = dict(self.seconds)
        for stage, start in self._open.items():
            seconds[stage] = seconds.get(stage, 0.0) + now - start
        self._directory.save_checkpoint(
            {**state, "_notes": self.notes, "_seconds": seconds, "_wall_time_s": self.wall_time}
        )

    def saved(self) -> dict[str, Any] | None:
        """See `bem.scenes.Context`."""
        return None if self._state is None else dict(self._state)


def plan_scene(
    source: str | os.PathLike[str] | Mapping[str, Any] | SceneModel, settings: Sequence[str] = ()
) -> tuple[SceneModel, Plan]:
    """The resolved scene and what running it would compute; no work is done.

    Raises
    ------
    InputError : a bad scene.
    """
    scene = source if isinstance(source, SceneModel) else load_scene(source, settings)
    kind = get_kind(scene.kind)
    scene = kind.resolve(scene)
    return scene, kind.plan(scene)


def run_scene(
    source: str | os.PathLike[str] | Mapping[str, Any] | SceneModel,
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    resume: bool = False,
    overwrite: bool = False,
    figures: bool = True,
    watcher: Watcher | None = None,
) -> FinishedRun:
    """Run a scene and write its run directory.

    Parameters
    ----------
    source : as `bem.scenes.load_scene` takes it, or a scene already loaded.
    out : the run's folder; the next free `runs/NAME-001` where not given.
    settings : `key=value` changes to the scene.
    resume : go on from the checkpoint of an interrupted run; a finished run is returned as it is.
    overwrite : replace an older run in the folder; it stays until this one is finished. With `resume`, replace
        it only if it is of another scene.
    figures : draw figures and write the report; `bem report` can do it later.
    watcher : told of progress and notes.

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
    scene, plan = plan_scene(source, settings)
    check_memory(plan)
    kind = get_kind(scene.kind)
    watcher = watcher or _Silent()
    with RunDirectory.start(
        None if out is None else Path(out), scene.name, dump_scene(scene), resume=resume, overwrite=overwrite
    ) as directory:
        if directory.resumed and directory.finished:
            return open_run(directory.path)
        try:
            context = RunContext(directory, scene, watcher)
            outcome = kind.run(scene, context)
        except InputError as error:
            if directory.begun:
                raise ConvergenceError(
                    f"{'; '.join(error.messages)}. What was computed before is kept in {directory.home}: the same "
                    "command with --resume goes on from there, a changed scene needs another --out"
                ) from error
            directory.discard()
            raise
        _write(directory, kind, scene, outcome, context, figures)
    return open_run(directory.path)


def _write(
    directory: RunDirectory,
    kind: Kind,
    scene: SceneModel,
    outcome: Outcome,
    context: RunContext,
    figures: bool,
) -> None:
    """Arrays, volumes, figures, report; the summary last."""
    from bem.results.dataset import to_dataset, write_variables
    from bem.results.vtk import write_volumes

    about = {"scene": scene.name, "kind": scene.kind, "version": bem.__version__, "seed": scene.seed}
    attributes = {"title": scene.description or scene.name, "Conventions": "CF-1.11", **about}
    with context.timer("writing results"):
        write_variables(directory.path / RESULTS, outcome.variables, attributes)
        if outcome.volumes:
            write_volumes(directory.path, outcome.variables, outcome.volumes)
    summary = {
        **about,
        "wall_time_s": 0.0,
        "status": Status(outcome.status).value,
        "where": outcome.where,
        **plain(outcome.summary),
        "notes": context.notes,
        "seconds_by_stage": context.seconds,
    }
    if figures:
        from bem.plots.draw import draw_all
        from bem.plots.report import write_report

        run = FinishedRun(directory.path, scene_table(scene), summary)
        run.__dict__["dataset"] = to_dataset(outcome.variables, attributes)  # no need to read it back
        with context.timer("figures and report"):
            drawn = draw_all(
                run,
                kind.figures,
                directory.figures,
                on_failure=lambda name, error: context.note(f"figure {name} could not be drawn: {error!r}"),
            )
            summary["wall_time_s"] = context.wall_time
            write_report(run, drawn, kind.headline)
    summary["wall_time_s"] = context.wall_time
    directory.finish(summary)
