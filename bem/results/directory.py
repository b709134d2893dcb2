"""The folder of one run: locked while in use, and never left with half a file in it."""

from __future__ import annotations

import hashlib
import json
import math
import os
import shutil
import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from bem.errors import InputError, ResultsError
from bem.results.atomic import force_names, reason, write_text
from bem.results.checkpoint import load_checkpoint, save_checkpoint
from bem.results.differing import words_of_difference

SCENE, SUMMARY, RESULTS, REPORT = "scene.toml", "summary.json", "results.nc", "report.html"
FIGURES, CHECKPOINT, CHECKSUMS, LOCK = "figures", "checkpoint.bin", "checksums.json", ".lock"
CASES = "cases"
BESIDE, SWAPPING = ".replacement", ".replacing"
_OURS = (SUMMARY, SCENE, RESULTS, REPORT, CHECKPOINT, CHECKSUMS)


class RunDirectory:
    """A run's folder, held by this process until `close`.

    Use `RunDirectory.start`; the constructor only takes the lock. A run that replaces an older one is written into the
    folder `.replacement` inside it (`path` is that folder until `finish`), which becomes `.replacing` when it is whole;
    then its files take the place of the older run's. Who finds a folder of the second name ends the move.
    """

    def __init__(self, path: Path, made: Sequence[Path] = ()) -> None:
        self.path = path
        self._home = path
        self.resumed = False
        self._made = list(made)
        self._filled = False
        self._sums: dict[str, str] = {}
        try:
            for folder in (*reversed(path.parents), path):
                if not folder.is_dir():
                    folder.mkdir(exist_ok=True)
                    self._made.append(folder)
            # not bound to a thread; no soft lock, which would outlast a killed process
            self._lock = FileLock(path / LOCK, timeout=0, mode=0o644, thread_local=False, fallback_to_soft=False)
            self._lock.acquire()
        except Timeout as error:
            raise ResultsError(_in_use(path)) from error
        except (OSError, ValueError) as error:
            self._unmake()
            text = reason(error) if isinstance(error, OSError) else str(error)
            raise ResultsError(f"{path}: cannot be used as the run's folder ({text})") from error
        with suppress(OSError):  # who holds it is only for the message
            (path / LOCK).write_text(f"{os.getpid()}\n", "utf-8")

    @classmethod
    def start(
        cls, out: Path | None, name: str, scene: str, *, resume: bool = False, overwrite: bool = False
    ) -> RunDirectory:
        """Take the folder for a run of the resolved scene text `scene`.

        Parameters
        ----------
        name, scene : of the run: first part of a new folder's name, and text of the resolved scene.
        out : the folder; None takes the next free `runs/NAME-001`, or with `resume` this scene's latest unfinished one.
        resume : go on from the checkpoint in it.
        overwrite : replace an older run in it, which stays until this one is finished; with `resume`, one of another
            scene only.

        Raises
        ------
        ResultsError : the folder cannot be written, is in use, or holds a run, without resume or overwrite.
        InputError : resume, but the run in the folder is of another scene.
        """
        made: list[Path] = []
        if out is None:
            out = _latest_unfinished(name, scene) if resume else None
        if out is None:
            out, made = _next_free(name)
        directory = cls(out, made)
        try:
            directory._take(scene, resume, overwrite)
        except BaseException:
            directory.discard()
            raise
        return directory

    def _take(self, scene: str, resume: bool, overwrite: bool) -> None:
        self._swap()
        old, begun = _scene_text(self._home), _scene_text(self._home / BESIDE)
        self.remove_leftovers()
        if resume and begun == scene:
            self.path = self._home / BESIDE
            self.resumed = True
            self.remove_leftovers()
        elif old is not None and resume and not (overwrite and old != scene):
            if old != scene:
                raise InputError(
                    f"--resume: the run in {self.path} is of another scene (they differ in {_difference(old, scene)}); "
                    "allowed: the same scene, another --out, or --overwrite too, which replaces that run"
                )
            self.resumed = True
        elif old is not None and not overwrite:
            raise ResultsError(f"{self.path}: holds a run already; --resume continues it, --overwrite replaces it")
        elif old is not None:
            self.path = self._home / BESIDE
            shutil.rmtree(self.path, ignore_errors=True)
            try:
                self.path.mkdir(exist_ok=True)
            except OSError as error:
                raise ResultsError(f"{self.path}: cannot be made ({reason(error)})") from error
        self._filled = True
        write_text(self.path / SCENE, scene)

    @property
    def finished(self) -> bool:
        """Return True if a summary is there, which is written last."""
        return (self.path / SUMMARY).is_file()

    @property
    def begun(self) -> bool:
        """Return True if something computed is kept in it, from which a run can go on."""
        return (self.path / CHECKPOINT).is_file() or any((self.path / CASES).glob("*.bin"))

    @property
    def home(self) -> Path:
        """The folder as it was asked for, also while `path` is beside an older run in it."""
        return self._home

    @property
    def figures(self) -> Path:
        """Folder of the figures, made when first asked for."""
        return figures_folder(self.path)

    def save_checkpoint(self, state: Mapping[str, Any]) -> None:
        """Replace the checkpoint, whole or not at all."""
        save_checkpoint(self.path / CHECKPOINT, state)

    def load_checkpoint(self) -> dict[str, Any] | None:
        """The last checkpoint, or None."""
        return load_checkpoint(self.path / CHECKPOINT)

    def sum_up(self) -> None:
        """Take the checksums of the results and volumes, which are written and stay so, while pictures are drawn."""
        names = [name for name in names_of_files(self.path) if name == RESULTS or name.startswith("volume")]
        self._sums = {name: checksum(self.path / name) for name in names}

    def finish(self, summary: Mapping[str, Any]) -> None:
        """Write checksums and, last of all, the summary; the checkpoint goes, and so does the run that was replaced."""
        self.remove_leftovers()
        text = summary_text(summary)
        known = checksums(self.path, self._sums) | {SUMMARY: hashlib.sha256(text.encode()).hexdigest()}
        write_text(self.path / CHECKSUMS, json.dumps(known, indent=1) + "\n")
        for folder in dict.fromkeys((self.path / name).parent for name in known):
            force_names(folder)  # a summary must not be there before what it speaks of
        write_text(self.path / SUMMARY, text)
        force_names(self.path)
        with suppress(OSError):
            (self.path / CHECKPOINT).unlink(missing_ok=True)
        shutil.rmtree(self.path / CASES, ignore_errors=True)
        self._swap()

    def _swap(self) -> None:
        """Let a finished run that is beside an older one take its place."""
        try:
            if (self._home / BESIDE / SUMMARY).is_file():
                os.rename(self._home / BESIDE, self._home / SWAPPING)
            if (self._home / SWAPPING).is_dir():
                self._end_swap()
        except OSError as error:
            raise ResultsError(
                f"{self._home}: the finished run in {BESIDE} or {SWAPPING} cannot take the older one's place "
                f"({reason(error)}); the same command with --resume ends that"
            ) from error
        self.path = self._home

    def _end_swap(self) -> None:
        """Move the finished run in `.replacing` to where the older one is; what of that is left over goes.

        May be interrupted and repeated at any point: until the summary moves, last of all, there is none.
        """
        source = self._home / SWAPPING
        if (source / SUMMARY).is_file():
            for old in (SUMMARY, CHECKSUMS, CHECKPOINT):
                if old == CHECKPOINT or (source / old).is_file():  # else the one at home is new already
                    (self._home / old).unlink(missing_ok=True)
            shutil.rmtree(self._home / CASES, ignore_errors=True)
            (source / CHECKPOINT).unlink(missing_ok=True)
            shutil.rmtree(source / CASES, ignore_errors=True)
            new = [item.relative_to(source) for item in source.rglob("*") if item.is_file()]
            if FIGURES in {name.parts[0] for name in new}:
                (self._home / FIGURES).mkdir(exist_ok=True)
            for name in sorted(new, key=lambda name: (name.name == SUMMARY, name.name == CHECKSUMS)):
                if name.name == SUMMARY:
                    self._remove_unknown()
                os.replace(source / name, self._home / name)
        shutil.rmtree(source, ignore_errors=True)

    def _remove_unknown(self) -> None:
        """Remove the files of an older run that the run whose checksums are here does not have."""
        known = json.loads((self._home / CHECKSUMS).read_text("utf-8"))
        older = [RESULTS, REPORT, *(item.name for item in self._home.glob("volume*.vtu"))]
        older += [f"{FIGURES}/{item.name}" for item in (self._home / FIGURES).glob("*")]
        for name in older:
            if name not in known:
                (self._home / name).unlink(missing_ok=True)
        with suppress(OSError):
            (self._home / FIGURES).rmdir()

    def remove_leftovers(self) -> None:
        """Delete temporary files that a killed process left."""
        for folder in (self.path, self.path / FIGURES, self.path / CASES):
            for leftover in folder.glob(".writing-*"):
                with suppress(OSError):
                    leftover.unlink()

    def close(self) -> None:
        """Give the folder back, without what a process that was ended while it wrote had begun."""
        if self._lock.is_locked:
            self.remove_leftovers()
            with suppress(OSError):  # while it is held: who has opened it meanwhile sees that it is gone
                (self._home / LOCK).unlink(missing_ok=True)
            self._lock.release()

    def discard(self) -> None:
        """Give the folder back and remove what this run made, as for a bad scene; an older run's files stay."""
        if self._filled and not self.resumed:
            self._clear()
        self.close()
        self._unmake()

    def _clear(self) -> None:
        """Remove a run's files, and nothing else."""
        self.remove_leftovers()
        for name in _OURS:
            with suppress(OSError):
                (self.path / name).unlink(missing_ok=True)
        for volume in self.path.glob("volume*.vtu"):
            with suppress(OSError):
                volume.unlink()
        shutil.rmtree(self.path / FIGURES, ignore_errors=True)
        shutil.rmtree(self.path / CASES, ignore_errors=True)
        if self.path != self._home:
            with suppress(OSError):
                self.path.rmdir()

    def _unmake(self) -> None:
        for folder in reversed(self._made):
            with suppress(OSError):
                folder.rmdir()
        self._made = []

    def __enter__(self) -> RunDirectory:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def figures_folder(run: Path) -> Path:
    """Folder of a run's figures, made when first asked for; ResultsError where it cannot be."""
    folder = run / FIGURES
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ResultsError(f"{folder}: cannot be made ({reason(error)})") from error
    return folder


def names_of_files(folder: Path) -> list[str]:
    """Every finished file of a run but the summary, by its path in the folder."""
    names = [SCENE, RESULTS, REPORT, *(f"{FIGURES}/{item.name}" for item in (folder / FIGURES).glob("*.*"))]
    names += [item.name for item in folder.glob("volume*.vtu")]
    return [name for name in sorted(names) if (folder / name).is_file() and not Path(name).name.startswith(".")]


def checksums(folder: Path, known: Mapping[str, str] | None = None) -> dict[str, str]:
    """SHA-256 of every finished file of a run but the summary, by its path in the folder; `known` ones are not taken
    again."""
    found = known or {}
    return {name: found.get(name) or checksum(folder / name) for name in names_of_files(folder)}


def checksum(path: Path) -> str:
    """SHA-256 of a file."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def summary_text(summary: Mapping[str, Any]) -> str:
    """The summary as JSON; numbers that are not finite become null."""
    return json.dumps(plain(summary), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """JSON values from numbers and arrays of any kind."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, str):
        return str(value)
    return value


def _next_free(name: str) -> tuple[Path, list[Path]]:
    """The first free `runs/NAME-001`, `-002`, ..., made here so that no two runs take the same; and what was made."""
    base = Path("runs")
    made = [] if base.is_dir() else [base]
    try:
        base.mkdir(exist_ok=True)
        for number in range(1, 1_000_000):
            path = base / f"{name}-{number:03d}"
            with suppress(FileExistsError):
                path.mkdir()
                return path, [*made, path]
    except OSError as error:
        raise ResultsError(f"{base.absolute()}: cannot be written ({reason(error)}); give --out") from error
    raise ResultsError(f"{base.absolute()}: holds a million runs; give --out")


def _latest_unfinished(name: str, scene: str) -> Path | None:
    for path in sorted(Path("runs").glob(f"{name}-[0-9]*"), reverse=True):
        with suppress(OSError):
            if (path / SCENE).read_text("utf-8") == scene and not (path / SUMMARY).is_file():
                return path
    return None


def _scene_text(folder: Path) -> str | None:
    """The scene of the run in a folder, None where there is none."""
    path = folder / SCENE
    return path.read_text("utf-8", errors="replace") if path.is_file() else None


def _in_use(path: Path) -> str:
    holder = ""
    with suppress(OSError):
        holder = (path / LOCK).read_text("utf-8", errors="replace")[:20].strip()
    return (
        f"{path}: another run is using this folder (process {holder or 'unknown'}); wait for it or give another --out"
    )


def _difference(old: str, new: str) -> str:
    """Describe the keys in which two scene texts differ."""
    try:
        return words_of_difference(tomllib.loads(old), tomllib.loads(new)) or "comments"
    except ValueError:
        return "scene files"
