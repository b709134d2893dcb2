"""The process of one run: `python -m bem.app.worker FOLDER`. It writes how it goes on into the run's folder."""

from __future__ import annotations

import contextlib
import json
import math
import sys
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from bem.app.workspace import ASKED, HISTORY, OWN, PROGRESS
from bem.errors import BemError, interrupts_as_they_are
from bem.notes import Level, Note
from bem.results.atomic import write_text
from bem.startup.interrupts import catch_interrupts

_EVERY = 0.3  # seconds between two writings of the progress
_MOST_TOLD = 300
"""Points that are kept of a stage's figures: every second one of more."""
_FIRST_GUESS = 1.0
"""Seconds of a stage after which its pace is known well enough to say what is left."""


class Stage:
    """Stage of a run, such as its cycles: its pace, and the figures reported during it.

    Attributes
    ----------
    total : its steps.
    points : of (done, figures), at most `_MOST_TOLD`; those before it was resumed come first.
    """

    def __init__(self, done: int, total: int, now: float, before: Iterable[tuple[int, dict[str, float]]] = ()) -> None:
        self._first = (done, now)
        self.total = total
        self._step = 1
        self._count = 0
        self.points = [(step, figures) for step, figures in before if step < done]

    def left(self, done: int, now: float) -> float | None:
        """Seconds to its end at the mean pace; None before there is one."""
        moved, spent = done - self._first[0], now - self._first[1]
        return spent * (self.total - done) / moved if moved > 0 and spent >= _FIRST_GUESS else None

    def tell(self, done: int, figures: Mapping[str, float]) -> None:
        """Keep figures, thinned where they are many."""
        known = {name: float(value) for name, value in figures.items() if math.isfinite(value)}
        if known and self._count % self._step == 0:
            self.points.append((done, known))
            if len(self.points) > _MOST_TOLD:
                del self.points[1::2]
                self._step *= 2
        self._count += bool(known)


class Told:
    """A watcher (see `bem.campaigns.context.Watcher`) that keeps what it is told in files of a folder.

    A resumed run goes on from the time and the figures that its folder has.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._state: dict[str, Any] = {"state": "running", "done": 0, "total": 0, "what": "", "notes": []}
        self._state["began"] = _read(folder / PROGRESS).get("began", time.time())
        self._before = _read(folder / HISTORY)
        self._stages: dict[str, Stage] = {}
        self._written = 0.0

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `Watcher`."""
        what, now = what or "working", time.time()
        stage = self._stages.setdefault(what, Stage(done, total, now, self._before.pop(what, {}).get("points", ())))
        stage.tell(done, figures)
        if what == _CASES and len(self._stages) > 1:  # the steps of all cases together say more
            self._state["cases"] = [done, total]
        else:
            self._state |= {"done": done, "total": total, "what": what}
            self._state |= {"left": stage.left(done, now), "at": now}
        if time.monotonic() - self._written > _EVERY:
            self._write()

    def note(self, text: str) -> None:
        """See `Watcher`."""
        if isinstance(text, Note) and text.level is Level.INFO:
            return
        shown = text.line if isinstance(text, Note) else text
        if shown not in self._state["notes"]:
            self._state["notes"].append(shown)
            self._write()

    def begin(self) -> None:
        """Write that the run has begun, which is seen before its first progress."""
        self._write()

    def end(self, state: str, message: str = "") -> None:
        """Write how the run ended."""
        self._state |= {"state": state, "message": message}
        self._write()

    def _write(self) -> None:
        self._written = time.monotonic()
        self._state["written"] = time.time()
        history = self._before | {
            what: {"total": stage.total, "points": stage.points} for what, stage in self._stages.items() if stage.points
        }
        with contextlib.suppress(BemError):  # a full disk: the run itself will say so
            write_text(self._folder / PROGRESS, json.dumps(self._state))
            if history:
                write_text(self._folder / HISTORY, json.dumps(history))


def _read(file: Path) -> dict[str, Any]:
    """Return what a file of a process before holds; nothing where there is none."""
    try:
        found = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


_CASES = "cases"
"""The stage that counts finished cases."""


def main(folder: Path) -> int:
    """Run, or go on with, the scene in the folder; the exit code of `bem run`."""
    from bem.runs import run_scene

    told = Told(folder / OWN)
    told.begin()
    try:
        with interrupts_as_they_are():
            done = run_scene(folder / OWN / ASKED if _asked(folder) else folder, folder, resume=True, watcher=told)
    except BemError as error:
        told.end("failed", "\n".join(getattr(error, "messages", None) or [str(error)]))
        return error.exit_code
    except KeyboardInterrupt:
        told.end("paused")
        return 130
    except BaseException as error:
        told.end("failed", f"{type(error).__name__}: {error}")
        raise
    told.end("done")
    return 0 if done.summary["status"] == "converged" else 3


def _asked(folder: Path) -> bool:
    """Return True if the folder was begun by the page: a run begun on the command line goes on from its own scene."""
    return (folder / OWN / ASKED).is_file()


if __name__ == "__main__":
    catch_interrupts()
    sys.exit(main(Path(sys.argv[1])))
