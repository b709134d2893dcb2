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
from bem.results.atomic import reason
from bem.results.dataset import read_dataset
from bem.results.directory import CHECKSUMS, RESULTS, SCENE, SUMMARY, SWAPPING, checksum

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
        _check(self.path, RESULTS)
        return read_dataset(self.path / RESULTS)

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
    """What of a summary is one value, and not an empty text."""
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
    return FinishedRun(folder, scene, summary)


def damaged_files(folder: Path) -> list[str]:
    """Files of a run that are missing or do not match their checksum."""
    return [name for name in _known(folder) if not _sound(folder, name)]


def _check(folder: Path, name: str) -> None:
    if name in _known(folder) and not _sound(folder, name):
        raise ResultsError(
            f"{folder / name}: is damaged or was changed (its checksum does not match); run the scene again"
        )


def _sound(folder: Path, name: str) -> bool:
    try:
        return checksum(folder / name) == _known(folder)[name]
    except OSError:
        return False


def _known(folder: Path) -> dict[str, str]:
    try:
        known = json.loads((folder / CHECKSUMS).read_text("utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError, RecursionError) as error:
        raise ResultsError(f"{folder / CHECKSUMS}: is damaged ({error})") from error
    return known if isinstance(known, dict) else {}
