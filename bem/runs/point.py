"""One point of a sweep: a run in a folder of its own. Works in any process, on this disk or not."""

from __future__ import annotations

import dataclasses
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bem.campaigns.context import Silent, Watcher
from bem.campaigns.jobs import Staff, words_of
from bem.errors import BemError, ResultsError
from bem.results import open_run
from bem.results.arrays import left_out
from bem.results.atomic import force_names, write_bytes
from bem.results.directory import RESULTS, SUMMARY, RunDirectory
from bem.results.read import damaged_data
from bem.runs.scene import run_planned
from bem.scenes.common import SceneModel
from bem.scenes.load import dump_scene
from bem.scenes.planner import Plan


@dataclass(frozen=True)
class Point:
    """A point to be computed anywhere, see `bem.campaigns.job.Job`.

    Attributes
    ----------
    index : place in the sweep, the last swept key running fastest.
    scene, plan : resolved, and what it takes.
    root : folder of the sweep; None where it is on another disk.
    name : the point's folder in it.
    fields : whether its file of results has stacks of maps, too; see `run_planned`.
    """

    index: int
    scene: SceneModel
    plan: Plan
    root: Path | None
    name: str
    fields: bool = False

    def compute(self, watcher: Watcher) -> Done:
        """Run the point, going on from its checkpoint if it was begun.

        Errors that a scene can cause come back as words, so that one bad point does not end a sweep.
        """
        try:
            if self.root is not None:
                return Done(self.name, self._run(self.root / self.name))
            with tempfile.TemporaryDirectory(prefix="bem-sweep-") as temporary:
                folder = Path(temporary) / "run"
                summary = self._run(folder)
                files = [item for item in folder.rglob("*") if item.is_file()]
                return Done(
                    self.name, summary, files={str(item.relative_to(folder)): item.read_bytes() for item in files}
                )
        except (BemError, MemoryError) as error:
            return Done(self.name, error=words_of(error))

    def elsewhere(self) -> Point:
        """Into a folder that is sent back."""
        return dataclasses.replace(self, root=None)

    def lost(self, why: str) -> Done:
        """Its process died."""
        return Done(self.name, error=why)

    def _run(self, folder: Path) -> dict[str, Any]:
        found = finished_summary(folder, self.fields)  # a process may have died after its last line
        if found is not None:
            return found
        old = (folder / SUMMARY).exists()  # finished once, but what is there now cannot be trusted or is not all
        with RunDirectory.start(
            folder, self.scene.name, dump_scene(self.scene), resume=not old, overwrite=old
        ) as directory:
            return run_planned(directory, self.scene, self.plan, Staff(workers=1), (), Silent(), fields=self.fields)


@dataclass(frozen=True)
class Done:
    """End of a point; `files` only where the worker does not see the sweep's folder."""

    name: str
    summary: dict[str, Any] | None = None
    error: str = ""
    files: dict[str, bytes] = field(default_factory=dict)


def finished_summary(folder: Path, fields: bool) -> dict[str, Any] | None:
    """The summary of the sound finished run in the folder; None where there is none, or not with the fields wanted."""
    try:
        if not (folder / SUMMARY).is_file():
            return None
        lacking = left_out(folder / RESULTS)  # of a file that was cut off an error, too
        return None if (fields and lacking) or damaged_data(folder) else open_run(folder).summary
    except ResultsError:
        return None


def store(done: Done, folder: Path) -> None:
    """Write what a worker on another disk sent; the summary last."""
    for name in sorted(done.files, key=lambda item: item == SUMMARY):
        path = folder / name
        if name == SUMMARY:  # must not be there before what it speaks of
            for item in dict.fromkeys((folder / other).parent for other in done.files):
                force_names(item)
        if not path.resolve().is_relative_to(folder.resolve()):
            raise ResultsError(f"{name}: a worker sent a file outside its point's folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, done.files[name])
    force_names(folder)
