"""Figures and report of a run once it is computed, written before its summary."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.notes import Note
from bem.notes.general import SIDE_TASK_FAILED
from bem.plots.draw import draw_all
from bem.plots.report import write_report
from bem.results.arrays import Arrays
from bem.results.directory import figures_folder
from bem.results.read import FinishedRun


@dataclass(frozen=True)
class Pages:
    """Figures and report to be made of a run.

    Attributes
    ----------
    path, scene, summary : of the run, as of `FinishedRun`; `results.nc` is there.
    names : of the figures, in their order.
    formats : of their files.
    headline : figures that the report begins with.
    """

    path: Path
    scene: dict[str, Any]
    summary: dict[str, Any]
    names: tuple[str, ...]
    formats: tuple[str, ...]
    headline: tuple[str, ...]


def make(pages: Pages, arrays: Arrays) -> list[Note]:
    """Draw and write the pages from the run's arrays; return notes on figures that failed, which the report shows too.

    Raises
    ------
    ResultsError : files cannot be written.
    """
    failed: list[Note] = []

    def failure(name: str, error: Exception) -> None:
        failed.append(SIDE_TASK_FAILED(task=f"Drawing figure {name}", error=repr(error)))

    run = FinishedRun(pages.path, pages.scene, pages.summary)
    run.__dict__["arrays"] = arrays  # no need to look whether the file is sound
    drawn = draw_all(run, pages.names, figures_folder(pages.path), pages.formats, failure)
    shown = {
        **pages.summary,
        "notes": [*pages.summary["notes"], *(note.as_dict() for note in failed)],
    }
    write_report(FinishedRun(pages.path, pages.scene, shown), drawn, pages.headline)
    return failed
