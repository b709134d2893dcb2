"""The process of one run: `python -m bem.app.worker FOLDER`. It writes how it goes on into the run's folder."""

from __future__ import annotations

import contextlib
import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bem.app.workspace import ASKED, OWN, PROGRESS
from bem.errors import BemError, interrupts_as_they_are
from bem.notes import Level, Note
from bem.results.atomic import write_text
from bem.startup.interrupts import catch_interrupts

_EVERY = 0.3  # seconds between two writings of the progress


class Told:
    """A watcher (see `bem.campaigns.context.Watcher`) that keeps what it is told in a file."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._state: dict[str, Any] = {"state": "running", "done": 0, "total": 0, "what": "", "notes": []}
        self._written = 0.0

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `Watcher`."""
        self._state |= {"done": done, "total": total, "what": what or "working"}
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

    def end(self, state: str, message: str = "") -> None:
        """Write how the run ended."""
        self._state |= {"state": state, "message": message}
        self._write()

    def _write(self) -> None:
        self._written = time.monotonic()
        with contextlib.suppress(BemError):  # a full disk: the run itself will say so
            write_text(self._file, json.dumps(self._state))


def main(folder: Path) -> int:
    """Run, or go on with, the scene in the folder; the exit code of `bem run`."""
    from bem.runs import run_scene

    told = Told(folder / OWN / PROGRESS)
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
