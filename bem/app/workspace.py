"""The folder that the page shows: scenes being written, surface files, runs. All state is in its files."""

from __future__ import annotations

import filecmp
import json
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.errors import BemError, InputError, ResultsError
from bem.results.atomic import write_bytes, write_text
from bem.results.directory import LOCK, SCENE, SUMMARY
from bem.scenes.edit import edited_text, table_text
from bem.scenes.load import read_table
from bem.surfaces.examples import example_names

OWN = ".app"
"""Folder inside a run's folder: the scene as it was asked for, progress, what the process printed."""
ASKED, PROGRESS, LOG, PID = "scene.toml", "progress.json", "log.txt", "pid"
HISTORY, PLANNED = "history.json", "planned.json"
"""Files in `OWN`: figures told while the run went on (`bem.app.worker`), and the seconds that its plan says."""
CANCELLED, REMOVED = ".cancelled", ".removed"
"""Folders of runs, and of scenes and surfaces, that were put out of the lists."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
MOST_BYTES = 1 << 30
"""Largest surface file that is taken."""


@dataclass(frozen=True)
class RunState:
    """A run as its folder shows it.

    `state` : "running", "paused" (it can go on), "failed", or the status of its summary. `done` of `total` steps of
    `what`; `message` says why it failed. `finished` : whether its results are there. `beyond` : what of them is outside
    the model. `cautions` : the number of its notes of that level. `answers` : names and values of the figures that it
    was run for. `begun` : clock time [s]. `seconds` : what it took, or has taken up to now. `left` : seconds to the end
    of `what` at the present pace; `planned` : seconds of all of it by its plan; None where nobody knows.
    """

    name: str
    path: Path
    scene: str
    kind: str
    state: str
    done: int = 0
    total: int = 0
    what: str = ""
    message: str = ""
    notes: tuple[str, ...] = ()
    finished: bool = False
    beyond: tuple[str, ...] = ()
    cautions: int = 0
    answers: tuple[tuple[str, str], ...] = ()
    begun: float = 0.0
    seconds: float | None = None
    left: float | None = None
    planned: float | None = None


@dataclass(frozen=True)
class _RunEntry:
    """Entry of a finished run in lists of runs, from its summary; kept as long as the file is the same."""

    version: tuple[int, int]
    status: str
    beyond: tuple[str, ...]
    cautions: int
    answers: tuple[tuple[str, str], ...]
    seconds: float | None


def _is_element(table: Mapping[str, Any]) -> bool:
    """Return True for the table of a machine element, which is no scene."""
    return isinstance(table.get("element"), str) and "kind" not in table


class Workspace:
    """A folder with scenes (`*.toml`), `surfaces/` and `runs/`.

    Raises
    ------
    ResultsError : it cannot be made or written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()
        self.runs_folder, self.surfaces_folder = self.folder / "runs", self.folder / "surfaces"
        self._children: list[subprocess.Popen[bytes]] = []
        self._summaries: dict[Path, _RunEntry] = {}
        try:
            for item in (self.folder, self.runs_folder, self.surfaces_folder):
                item.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultsError(f"{self.folder}: cannot be used as the folder of scenes and runs ({error})") from error

    # --- scenes

    def scenes(self) -> dict[str, str]:
        """Kinds of the scene files, by name; "" of a file that says none."""
        kinds = {name: table.get("kind") for name, table in self._tables().items() if not _is_element(table)}
        return {name: kind if isinstance(kind, str) else "" for name, kind in kinds.items()}

    def elements(self) -> dict[str, str]:
        """Machine elements of the element files, by name of the file."""
        return {name: str(table["element"]) for name, table in self._tables().items() if _is_element(table)}

    def _tables(self) -> dict[str, dict[str, Any]]:
        """Tables of the files, by name; without those that cannot be read."""
        found = {}
        for path in sorted(self.folder.glob("*.toml")):
            with suppress(OSError, ValueError, RecursionError):
                found[path.stem] = tomllib.loads(path.read_text("utf-8-sig"))
        return found

    def element_table(self, name: str) -> dict[str, Any]:
        """The table of an element's file; InputError where there is none of that name."""
        table = self._tables().get(name, {})
        if not _is_element(table):
            raise InputError(f"{name}: not found; no file of a machine element in {self.folder} has this name")
        return table

    def scene_path(self, name: str) -> Path:
        """The file of a scene; InputError for a name that is none of a file in the folder."""
        _check_name("scene", name)
        return self.folder / f"{name}.toml"

    def scene_text(self, name: str) -> str:
        """Return the text of a scene's file, "" where there is none."""
        try:
            return self.scene_path(name).read_text("utf-8-sig")
        except FileNotFoundError:
            return ""
        except (OSError, ValueError) as error:
            raise ResultsError(f"{self.scene_path(name)}: cannot be read ({error})") from error

    def scene_table(self, name: str) -> dict[str, Any]:
        """The table of a scene, with absolute paths; InputError where the file is no TOML."""
        table = read_table(self.scene_path(name))
        return {**table, "name": name}

    def save_scene(self, name: str, scene: Mapping[str, Any] | str) -> None:
        """Write the file of a scene, whole or not at all.

        scene : the text itself; or a table, which is put into the text of the file: comments, order and paths of the
            file stay, and so does its `name`.

        Raises
        ------
        InputError : a table, and the text of the file is not valid TOML; the file stays as it is.
        """
        if not isinstance(scene, str):
            scene = edited_text(self.scene_text(name), scene, self.folder, keep=("name",))
        write_text(self.scene_path(name), scene)

    def free_scene_name(self, wanted: str) -> str:
        """The name, with a number behind it where there is such a scene."""
        base = re.sub(r"[^A-Za-z0-9_.-]+", "-", wanted).strip("-._") or "scene"
        name, number = base[:56], 1
        while (self.folder / f"{name}.toml").exists():
            number += 1
            name = f"{base[:56]}-{number}"
        return name

    # --- surfaces

    def surfaces(self) -> tuple[str, ...]:
        """Paths of surface files: those put into `surfaces/`, then the package's own."""
        own = (str(item) for item in sorted(self.surfaces_folder.iterdir()) if item.is_file() and item.name[0] != ".")
        return (*own, *example_names())

    def add_surface(self, name: str, content: bytes | Path) -> Path:
        """Keep a file; one of the same name and other content gets a number, nothing is overwritten.

        content : of the file, or a file that has it, which is moved.
        """
        clean = re.sub(r"[^A-Za-z0-9_.-]+", "-", Path(name).name).lstrip("-.") or "surface"
        size = len(content) if isinstance(content, bytes) else content.stat().st_size
        if not 0 < size <= MOST_BYTES:
            raise InputError(f"{clean}: {size} bytes; allowed: a surface file of at most {MOST_BYTES} bytes")
        path, number = self.surfaces_folder / clean, 1
        while path.exists() and not _holds_content(path, content):
            number += 1
            path = self.surfaces_folder / f"{Path(clean).stem}-{number}{Path(clean).suffix}"
        if isinstance(content, bytes):
            write_bytes(path, content)
        else:
            os.replace(content, path)
        return path

    # --- runs

    def runs(self) -> list[RunState]:
        """All runs whose names can be asked for, those begun last first."""
        self._children = [child for child in self._children if child.poll() is None]
        folders = [item for item in self.runs_folder.iterdir() if _NAME.fullmatch(item.name) and item.is_dir()]
        folders.sort(key=lambda item: (_begun(item), item.name), reverse=True)
        return [state for state in map(self.state_of, folders) if state is not None]

    def run_path(self, name: str) -> Path:
        """The folder of a run; InputError where there is none of that name."""
        path = self.runs_folder / name
        if not _NAME.fullmatch(name) or not path.is_dir():
            raise InputError(f"run {name!r}: there is none in {self.runs_folder}")
        return path

    def state_of(self, path: Path) -> RunState | None:
        """A run as its folder shows it; None where none was begun there."""
        asked = path / SCENE if (path / SCENE).is_file() else path / OWN / ASKED
        if not asked.is_file():
            return None
        table: dict[str, Any] = {}
        with suppress(OSError, ValueError, RecursionError):
            table = tomllib.loads(asked.read_text("utf-8"))
        told = _json(path / OWN / PROGRESS)
        name, kind = str(table.get("name", path.name)), str(table.get("kind", ""))
        summary = self._summary(path, table)
        state = self._state(path, told, summary)
        message = str(told.get("message", "")) if state == "failed" else ""
        now, began = time.time(), told.get("began")
        running = state == "running"
        left = told.get("left") if running else None
        return RunState(
            name=path.name,
            path=path,
            scene=name,
            kind=kind,
            state=state,
            done=int(told.get("done", 0)),
            total=int(told.get("total", 0)),
            what=str(told.get("what", "")),
            message=message,
            notes=_texts(told.get("notes")),
            finished=summary is not None and not running,
            beyond=summary.beyond if summary else (),
            cautions=summary.cautions if summary else 0,
            answers=summary.answers if summary else (),
            begun=_begun(path),
            seconds=now - float(began) if running and began else summary.seconds if summary else None,
            left=None if left is None else max(0.0, float(left) - (now - float(told.get("at", now)))),
            planned=_json(path / OWN / PLANNED).get("seconds") if running else None,
        )

    def _summary(self, path: Path, scene: Mapping[str, Any]) -> _RunEntry | None:
        """Read what is shown of a run's summary, unless the same file was read before; None where there is none."""
        try:
            found = (path / SUMMARY).stat()
        except OSError:
            self._summaries.pop(path, None)
            return None
        version = (found.st_mtime_ns, found.st_size)
        known = self._summaries.get(path)
        if known is None or known.version != version:
            known = self._summaries[path] = _entry_of(_json(path / SUMMARY), scene, version)
        return known

    def _state(self, path: Path, told: Mapping[str, Any], summary: _RunEntry | None) -> str:
        if self.process_of(path) is not None:
            return "running"
        if summary is not None:
            return summary.status
        return "failed" if told.get("state") == "failed" else "paused"

    def process_of(self, path: Path) -> int | None:
        """The process that works in a run's folder: it holds its lock, or was started for it a moment ago."""
        for file in (path / LOCK, path / OWN / PID):
            with suppress(OSError, ValueError):
                number = int(file.read_text("utf-8"))
                if _holds(number, file) if file.name == LOCK else _works_in(number, path):
                    return number
        return None

    def start(self, name: str) -> RunState:
        """Run the scene of that name in a process of its own, in the next free folder.

        Raises
        ------
        InputError : a bad scene; nothing is left behind.
        """
        from bem.app.planning import check_scene

        table = self.scene_table(name)
        check_scene(table)
        return self.begin(name, table)

    def begin(self, name: str, table: Mapping[str, Any], planned: float | None = None) -> RunState:
        """Run a scene that was found right, under that name, in a process of its own, in the next free folder.

        planned : seconds that its plan says.
        """
        number = 1
        while True:
            path = self.runs_folder / f"{name}-{number:03d}"
            if not (self.runs_folder / CANCELLED / path.name).exists():  # an address stays that of one run
                with suppress(FileExistsError):
                    path.mkdir()
                    break
            number += 1
        (path / OWN).mkdir()
        write_text(path / OWN / ASKED, table_text(table))
        if planned is not None:
            write_text(path / OWN / PLANNED, json.dumps({"seconds": planned}))
        return self.go_on(path.name)

    def go_on(self, name: str) -> RunState:
        """Start the process of a run that is not running: from its checkpoint where it has one."""
        path = self.run_path(name)
        if self.process_of(path) is None and not (path / SUMMARY).is_file():
            (path / OWN).mkdir(exist_ok=True)
            told = _json(
                path / OWN / PROGRESS
            )  # of the processes before: their time counts, that of the pause does not
            spent = float(told.get("written", 0.0)) - float(told.get("began", 0.0)) if "written" in told else 0.0
            write_text(path / OWN / PROGRESS, json.dumps({"began": time.time() - max(spent, 0.0)}))
            with open(path / OWN / LOG, "ab") as log:
                child = subprocess.Popen(
                    [sys.executable, "-P", "-m", "bem.app.worker", str(path)],  # no modules from the user's folder
                    stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=self.folder,
                    # as on the command line: the same bits; its own processes leave out the folder, too
                    env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONSAFEPATH": "1"},
                    start_new_session=True,  # it outlives this server
                )  # fmt: skip
            self._children.append(child)
            write_text(path / OWN / PID, f"{child.pid}\n")
        found = self.state_of(path)
        assert found is not None
        return found

    def pause(self, name: str) -> None:
        """Ask the run's process to stop; what it has computed stays, and it can go on."""
        path = self.run_path(name)
        process = self.process_of(path)
        if process is not None:
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGTERM)

    def cancel(self, name: str) -> Path:
        """Put a run that is not running out of the list, into `runs/.cancelled`; nothing is deleted.

        Returns
        -------
        Path : where it is now, for `restore`.

        Raises
        ------
        ResultsError : it still runs.
        """
        path = self.run_path(name)
        self._check_still(path)
        return _put_away(path, CANCELLED)

    def rename_run(self, name: str, wanted: str) -> None:
        """Give a run that is not running another name; InputError for one that is taken or cannot be."""
        path = self.run_path(name)
        self._check_still(path)
        _check_name("run", wanted)
        _move(path, self.runs_folder / wanted)

    def _check_still(self, path: Path) -> None:
        if self.process_of(path) is not None:
            raise ResultsError(f"{path}: is still running; pause it first")

    # --- what is taken out of the lists

    def remove_scene(self, name: str) -> Path:
        """Put the file of a scene into `.removed`; returns where it is now, for `restore`."""
        return _put_away(self._there(self.scene_path(name)), REMOVED)

    def rename_scene(self, name: str, wanted: str) -> None:
        """Give the file of a scene another name; InputError for one that is taken or cannot be."""
        _check_name("scene", wanted)
        _move(self._there(self.scene_path(name)), self.scene_path(wanted))

    def remove_surface(self, path: str) -> Path:
        """Put a surface file into `surfaces/.removed`; returns where it is now, for `restore`."""
        return _put_away(self._own_surface(path), REMOVED)

    def rename_surface(self, path: str, wanted: str) -> Path:
        """Give a surface file another name, in the scenes that take it, too; InputError for one that cannot be."""
        old = self._own_surface(path)
        _check_name("surface file", wanted)
        new = self.surfaces_folder / (wanted if Path(wanted).suffix else f"{wanted}{old.suffix}")
        users = self.users_of(path)
        _move(old, new)
        for name in users:
            text = self.scene_text(name)
            for before, after in zip(self._paths_in_scenes(old), self._paths_in_scenes(new), strict=True):
                text = text.replace(before, after)
            self.save_scene(name, text)
        return new

    def users_of(self, path: str) -> list[str]:
        """Names of the scenes that take a surface file."""
        words = self._paths_in_scenes(Path(path))
        return [name for name in self.scenes() if any(word in self.scene_text(name) for word in words)]

    def restore(self, kept: Path) -> None:
        """Put back what was put away; InputError where there is another of its name now."""
        _move(kept, kept.parent.parent / kept.name)

    def _paths_in_scenes(self, path: Path) -> tuple[str, ...]:
        """Return the quoted paths by which scenes may name a file in `surfaces/`."""
        names = (str(path), f"{self.surfaces_folder.name}/{path.name}")
        return tuple(f"{quote}{name}{quote}" for name in names for quote in "\"'")

    def _own_surface(self, path: str) -> Path:
        found = Path(path)
        if found.parent != self.surfaces_folder or found.name.startswith("."):
            raise InputError(f"{path}: is not in {self.surfaces_folder}")
        return self._there(found)

    def _there(self, path: Path) -> Path:
        if not path.is_file():
            raise InputError(f"{path}: there is no such file")
        return path


def _check_name(what: str, name: str) -> None:
    if not _NAME.fullmatch(name):
        raise InputError(f"{what} {name!r}: allowed: letters, digits and _ . - (64 at most, a letter or digit first)")


def _move(path: Path, target: Path) -> None:
    """Give a file or folder another name, which must be free."""
    if target.exists():
        raise InputError(f"{target.name}: there is one of that name; allowed: another name")
    try:
        path.rename(target)
    except OSError as error:
        raise ResultsError(f"{path}: cannot be moved ({error.strerror})") from error


def _put_away(path: Path, into: str) -> Path:
    """Move a file or folder into a hidden folder beside it, under a name that is free there."""
    folder = path.parent / into
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ResultsError(f"{folder}: cannot be made ({error.strerror})") from error
    target, number = folder / path.name, 1
    while target.exists():
        number += 1
        target = folder / f"{path.stem}-{number}{path.suffix}"
    _move(path, target)
    return target


def _holds_content(path: Path, content: bytes | Path) -> bool:
    """Return True if a file has that content."""
    if isinstance(content, Path):
        return filecmp.cmp(path, content, shallow=False)
    return path.stat().st_size == len(content) and path.read_bytes() == content


def _begun(folder: Path) -> float:
    """Return the time at which a run was asked for; the time of its folder changes with each file that it writes."""
    for file in (folder / OWN / ASKED, folder / SCENE):
        with suppress(OSError):
            return file.stat().st_mtime
    return 0.0


def _json(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _entry_of(summary: Mapping[str, Any], scene: Mapping[str, Any], version: tuple[int, int]) -> _RunEntry:
    """Return the entry of a run in lists of runs from its summary."""
    from bem.app.answers import answers
    from bem.notes import Level, of_summary
    from bem.scenes.kind import get_kind

    found: tuple[tuple[str, str], ...] = ()
    with suppress(BemError, KeyError, ValueError, TypeError, AttributeError):  # of a kind that is not here, or damaged
        kind = get_kind(str(summary["kind"]))
        found = tuple((one.words, one.short) for one in answers(summary, kind.headline, scene))
    cautions = sum(note.get("level") == Level.CAUTION for note in of_summary(summary))
    seconds = summary.get("wall_time_s")
    return _RunEntry(
        version,
        str(summary.get("status", "unknown")),
        _texts(summary.get("outside_model")),
        cautions,
        found,
        float(seconds) if isinstance(seconds, int | float) else None,
    )


def _texts(found: object) -> tuple[str, ...]:
    """A list of texts as it was read; of anything else none."""
    return tuple(map(str, found)) if isinstance(found, list) else ()


def _works_in(process: int, folder: Path) -> bool:
    """Return True if a process is the worker of a folder: numbers are used again."""
    words = Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")  # empty of one that has ended
    return b"bem.app.worker" in words and os.fsencode(folder) in words


def _holds(process: int, lock: Path) -> bool:
    """Return True if a process has the file of a lock open."""
    for item in Path(f"/proc/{process}/fd").iterdir():
        with suppress(OSError):
            if os.path.samestat(item.stat(), lock.stat()):
                return True
    return False
