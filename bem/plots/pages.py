"""What is drawn of a run once it is computed: its figures and its report, here or by a copy that was made ahead.

A copy of this process, made before anything is computed, loads what draws on another core meanwhile (`drawing_ahead`).
It holds nothing of the run: it reads what it draws from the run's file, so only files up to a size are left to it.
Copies are made where `bem.plots.side_by_side` may make them; elsewhere, and for whatever the copy could not do, this
process draws, with the same bytes.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.errors import ResultsError
from bem.notes import Note
from bem.notes.general import SIDE_TASK_FAILED
from bem.plots.draw import draw_all, draw_for_nobody, load_what_draws
from bem.plots.figures import all_figures
from bem.plots.report import write_report
from bem.plots.side_by_side import INTERRUPTS, answer_of, at_once, copied, ended, taken
from bem.results.arrays import Arrays, Described, described, stored_arrays
from bem.results.directory import RESULTS, figures_folder
from bem.results.read import FinishedRun

_MOST_READ = 256 << 20
"""Bytes of a run's file that a copy reads again what is in memory here: more would have to be planned for."""


@dataclass(frozen=True)
class Pages:
    """Figures and report to be made of a run.

    Attributes
    ----------
    path, scene, summary : of the run, as of `FinishedRun`; `results.nc` is there.
    names : of the figures, in their order.
    formats : of their files.
    headline : figures that the report begins with.
    epoch : clock time [s] at which the run would have begun had it not been interrupted.
    processes : that draw at once, as many as cores where None.
    """

    path: Path
    scene: dict[str, Any]
    summary: dict[str, Any]
    names: tuple[str, ...]
    formats: tuple[str, ...]
    headline: tuple[str, ...]
    epoch: float
    processes: int | None


def make(pages: Pages, arrays: Arrays) -> list[Note]:
    """Draw and write them from the run's arrays; what could not be drawn, as notes, which the report shows too.

    Raises
    ------
    ResultsError : files cannot be written.
    """
    failed: list[Note] = []

    def failure(name: str, error: Exception) -> None:
        failed.append(SIDE_TASK_FAILED(task=f"Drawing figure {name}", error=repr(error)))

    run = FinishedRun(pages.path, pages.scene, pages.summary)
    run.__dict__["arrays"] = arrays  # no need to look whether the file is sound
    drawn = draw_all(run, pages.names, figures_folder(pages.path), pages.formats, failure, pages.processes)
    took = time.time() - pages.epoch
    shown = {
        **pages.summary,
        "wall_time_s": took,
        "notes": [*pages.summary["notes"], *(note.as_dict() for note in failed)],
    }
    write_report(FinishedRun(pages.path, pages.scene, shown), drawn, pages.headline)
    return failed


@dataclass(frozen=True)
class _Order:
    """Pages, and what the arrays in the run's file are."""

    pages: Pages
    known: Described
    attributes: dict[str, Any]


@dataclass(frozen=True)
class _Answer:
    """Notes of `make`, or why its files cannot be written."""

    notes: list[Note]
    error: str = ""


class Ahead:
    """A copy of this process that waits for what to draw; nothing where none could be made."""

    def __init__(self, copy: tuple[int, int] | None, orders: int) -> None:
        self._copy = copy
        self._orders = orders
        self._busy = False

    def begin(self, pages: Pages, arrays: Arrays) -> None:
        """Have them made, if the copy is there and the run's file, which holds the arrays, is small enough for it."""
        if self._copy is None or (pages.path / RESULTS).stat().st_size > _MOST_READ:
            return
        self._busy = taken(self._orders, pickle.dumps(_Order(pages, described(arrays), arrays.attrs)))

    def result(self) -> list[Note] | None:
        """What `make` gives, None where the copy did not make them, and is gone; raises as it does."""
        if self._copy is None or not self._busy:
            return None
        answer: _Answer | None = answer_of(self._copy[1])
        if answer is None:
            self.close()  # one that only hangs must not go on to write the same files
            return None
        if answer.error:
            raise ResultsError(answer.error)
        return answer.notes

    def close(self) -> None:
        """Leave no copy behind."""
        if self._copy is not None:
            copy, self._copy = self._copy, None
            os.close(self._orders)
            ended(*copy)


@contextmanager
def drawing_ahead(wanted: bool, processes: int | None) -> Iterator[Ahead]:
    """In the block, a copy that loads what draws and waits, if pictures are wanted, so many processes may be used, and
    matplotlib is still to be loaded."""
    ahead = Ahead(None, -1)
    try:
        if wanted and "matplotlib" not in sys.modules and at_once(processes) > 1:
            # an interrupt between the copy's start and its place here would leave it behind, or let it return
            usual = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
            try:
                ahead = _started(usual)
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, usual)
        yield ahead
    finally:
        ahead.close()


def _started(signals: Any) -> Ahead:
    import h5py  # this process writes with it, the copy reads

    assert h5py
    orders, give = os.pipe()

    def work() -> _Answer | None:
        os.close(give)
        return _wait(orders)

    try:
        copy = copied(work, signals)
    except OSError:  # the system allows no further process
        os.close(give)
        return Ahead(None, -1)
    finally:
        os.close(orders)
    return Ahead(copy, give)


def _wait(orders: int) -> _Answer | None:
    """The copy's life: load, wait, draw; None where the one who started it draws after all."""
    with suppress(Exception), os.fdopen(orders, "rb") as stream:
        load_what_draws()
        all_figures()
        _load_what_writes()
        draw_for_nobody()
        order: _Order = pickle.load(stream)
        pages = order.pages
        try:
            return _Answer(make(pages, stored_arrays(pages.path / RESULTS, order.known, order.attributes)))
        except ResultsError as error:
            return _Answer([], str(error))
    return None


def _load_what_writes() -> None:
    import jinja2
    import PIL.PngImagePlugin

    assert jinja2
    assert PIL.PngImagePlugin
