"""Finished runs, opened again."""

from __future__ import annotations

import json
import os
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bem.errors import ResultsError
from bem.results.arrays import Arrays, read_arrays
from bem.results.atomic import reason
from bem.results.dataset import read_dataset
from bem.results.directory import (
    CHECKSUMS,
    FIGURES,
    REPORT,
    RESULTS,
    SCENE,
    SUMMARY,
    SWAPPING,
    checksum,
    names_of_files,
)

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class FinishedRun:
    """A run directory.

    `scene` and `summary` are tables of plain values; `dataset` is read from `results.nc` when first asked for.
    """

    path: Path
    scene: dict[str, Any]
    summary: dict[str, Any]

    @cached_property
    def dataset(self) -> xarray.Dataset:
        """All arrays, with units and coordinates; ResultsError if the file is missing or damaged."""
        return read_dataset(self.checked_results())

    @cached_property
    def arrays(self) -> Arrays:
        """The same arrays without xarray, each read when first asked for: what figures are drawn from."""
        return read_arrays(self.checked_results())

    def checked_results(self) -> Path:
        """The file of the arrays, found whole; ResultsError if it is missing or damaged."""
        _check(self.path, RESULTS)
        return self.path / RESULTS

    def __repr__(self) -> str:
        figures = _figures(self.summary)
        lines = [f"  {key} = {value}" for key, value in figures.items()]
        return "\n".join([f"FinishedRun({str(self.path)!r})", *lines])

    def _repr_html_(self) -> str:
        from html import escape

        cells = (
            (key, value if isinstance(value, str) else f"{value:.6g}") for key, value in _figures(self.summary).items()
        )
        rows = "".join(f"<tr><td>{escape(key)}</td><td>{escape(text)}</td></tr>" for key, text in cells)
        return f"<p><b>{escape(str(self.path))}</b></p><table>{rows}</table>"


def _figures(summary: dict[str, Any]) -> dict[str, int | float | str]:
    """Return the entries of a summary that are one value, and not an empty text."""
    return {key: value for key, value in summary.items() if isinstance(value, int | float | str) and value != ""}


def open_run(path: str | os.PathLike[str]) -> FinishedRun:
    """A finished run.

    Raises
    ------
    ResultsError : no such folder, no finished run in it, or damaged files (checksums do not match).
    """
    folder = Path(path)
    if not folder.is_dir():
        raise ResultsError(f"{folder}: no such folder; give the folder of a run")
    if not (folder / SUMMARY).is_file():
        begun = (folder / SCENE).is_file() or (folder / SWAPPING).is_dir()
        hint = "it is unfinished; `bem run` with --resume ends it" if begun else "no run is in it"
        raise ResultsError(f"{folder}: no finished run: {hint}")
    _check(folder, SUMMARY)
    _check(folder, SCENE)
    try:
        summary = json.loads((folder / SUMMARY).read_text("utf-8"))
        scene = tomllib.loads((folder / SCENE).read_text("utf-8"))
    except OSError as error:
        raise ResultsError(f"{folder}: cannot be read ({reason(error)})") from error
    except (ValueError, RecursionError) as error:
        raise ResultsError(f"{folder}: a file of the run is damaged ({error})") from error
    wrong = _wrong_form(summary)
    if wrong:
        raise ResultsError(f"{folder / SUMMARY}: is not the summary of a run ({wrong}); run the scene again")
    return FinishedRun(folder, scene, summary)


def _wrong_form(summary: Any) -> str:
    """Describe the entries that every summary has and this one lacks; empty if none is missing."""
    if not isinstance(summary, dict):
        return "it is not a table"
    for key, kind, words in (
        ("scene", str, "text"),
        ("kind", str, "text"),
        ("version", str, "text"),
        ("status", str, "text"),
        ("where", str, "text"),
        ("wall_time_s", int | float, "a number"),
        ("notes", list, "a list of notes"),
        ("seconds_by_stage", dict, "a table of numbers"),
    ):
        if not isinstance(summary.get(key), kind) or isinstance(summary[key], bool):
            return f"{key} is missing" if key not in summary else f"{key} is not {words}"
    if not all(isinstance(note, str) or _is_note(note) for note in summary["notes"]):
        return "notes is not a list of notes"
    if not all(isinstance(value, int | float) for value in summary["seconds_by_stage"].values()):
        return "seconds_by_stage is not a table of numbers"
    return ""


def _is_note(entry: Any) -> bool:
    """Return True for a table with the texts of a note; older summaries have plain texts."""
    return isinstance(entry, dict) and all(
        isinstance(entry.get(key), str) for key in ("code", "level", "text", "where")
    )


def damaged_files(folder: Path) -> list[str]:
    """Files of a run that are missing, do not match their checksum, or have none; ResultsError without checksums."""
    known = _known(folder)
    names = dict.fromkeys([*known, SCENE, SUMMARY, RESULTS, *names_of_files(folder)])
    return [name for name in names if not _sound(folder, name, known)]


def damaged_data(folder: Path) -> list[str]:
    """Files of a finished run without which its results are not whole, and that are damaged: all but its pictures and
    report, which can be drawn again; ResultsError without checksums."""
    return [name for name in damaged_files(folder) if name != REPORT and not name.startswith(f"{FIGURES}/")]


def check_data(folder: Path) -> None:
    """Refuse a finished run whose scene, summary, results or volumes are damaged.

    Raises
    ------
    ResultsError : names the files, and says how the run is computed again.
    """
    damaged = damaged_data(folder)
    if damaged:
        moved = [name for name in damaged if (folder / name).is_dir()]
        first = f"move the folder {' and '.join(moved)} away, then " if moved else ""
        raise ResultsError(
            f"{folder}: damaged or changed: {', '.join(damaged)}; {first}--overwrite in place of --resume computes the "
            "run again"
        )


def _check(folder: Path, name: str) -> None:
    known = _known(folder)
    if not _sound(folder, name, known):
        why = "does not match" if name in known else f"is missing from {CHECKSUMS}"
        raise ResultsError(f"{folder / name}: is damaged or was changed (its checksum {why}); run the scene again")


def _sound(folder: Path, name: str, known: dict[str, Any]) -> bool:
    try:
        return checksum(folder / name) == known.get(name)
    except OSError:
        return False


def _known(folder: Path) -> dict[str, Any]:
    """Return the checksums of the files when the run was finished; a folder without them is damaged."""
    try:
        known = json.loads((folder / CHECKSUMS).read_text("utf-8"))
    except FileNotFoundError:
        raise ResultsError(
            f"{folder / CHECKSUMS}: is missing, so nothing says that the run is whole; run the scene again"
        ) from None
    except (OSError, ValueError, RecursionError) as error:
        raise ResultsError(f"{folder / CHECKSUMS}: is damaged ({error}); run the scene again") from error
    if not isinstance(known, dict):
        raise ResultsError(f"{folder / CHECKSUMS}: is damaged (it is not a table); run the scene again")
    return known
