"""One point of a sweep: a run in a folder of its own. Works in any process, on this disk or not."""

from __future__ import annotations

import tempfile
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from bem.campaigns.context import Watcher
from bem.campaigns.disk import sees
from bem.errors import BemError, ResultsError


@dataclass(frozen=True)
class Point:
    """What to compute.

    Parameters
    ----------
    index : place in the sweep, the last swept key running fastest.
    scene : the resolved scene as TOML text.
    root : folder of the sweep.
    folder : the point's folder in it.
    threads : threads for the run.
    token : by which a worker elsewhere knows that it sees the same disk, see `bem.campaigns.disk`.
    """

    index: int
    scene: str
    root: str
    folder: str
    threads: int = 1
    token: str = ""

    def compute(self, watcher: Watcher) -> Done:
        """See `compute`."""
        return compute(self)

    def lost(self, why: str) -> Done:
        """Its process died."""
        return Done(self.index, why)


@dataclass(frozen=True)
class Done:
    """How a point ended; `files` only where the worker does not see the sweep's folder."""

    index: int
    error: str = ""
    files: dict[str, bytes] = field(default_factory=dict)


def is_finished(folder: Path) -> bool:
    """Whether a sound finished run is in the folder."""
    from bem.results import open_run

    try:
        open_run(folder)
    except ResultsError:
        return False
    return True


def compute(point: Point) -> Done:
    """Run the point where that is not done yet, going on from its checkpoint if it was begun.

    Errors that a scene can cause come back as words, so that one bad point does not end a sweep.
    """
    from bem.threads import set_threads

    set_threads(point.threads)
    root = Path(point.root)
    try:
        if not point.token or sees(root, point.token):
            _run(point, root / point.folder)
            return Done(point.index)
        with tempfile.TemporaryDirectory(prefix="bem-sweep-") as elsewhere:
            _run(point, Path(elsewhere) / "run")
            files = [item for item in (Path(elsewhere) / "run").rglob("*") if item.is_file()]
            return Done(
                point.index,
                files={str(item.relative_to(Path(elsewhere) / "run")): item.read_bytes() for item in files},
            )
    except BemError as error:
        return Done(point.index, " | ".join(getattr(error, "messages", None) or [str(error)]))
    except MemoryError:
        return Done(point.index, "out of memory; fewer --workers or a smaller grid")


def store(done: Done, folder: Path) -> None:
    """Write what a worker on another disk sent; the summary last."""
    from bem.results.atomic import write_bytes
    from bem.results.directory import SUMMARY

    for name in sorted(done.files, key=lambda item: item == SUMMARY):
        path = folder / name
        if not path.resolve().is_relative_to(folder.resolve()):
            raise ResultsError(f"{name}: a worker sent a file outside its point's folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, done.files[name])


def _run(point: Point, folder: Path) -> None:
    from bem.results.directory import SUMMARY
    from bem.runs import run_scene

    if is_finished(folder):
        return
    damaged = (folder / SUMMARY).exists()  # finished once, but what is there now cannot be trusted
    run_scene(tomllib.loads(point.scene), folder, resume=not damaged, overwrite=damaged, figures=False, workers=1)
