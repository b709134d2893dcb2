"""The `bem.scenes.Context` of one case: its seeds, its checkpoint file, and who hears of its progress."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from bem.campaigns.cases import Case
from bem.notes import Note, as_note, unpacked
from bem.scenes.context import derive_seed

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Watcher(Protocol):
    """Receiver of progress and notes, such as a terminal."""

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """`done` of `total` steps are finished."""

    def note(self, text: str) -> None:
        """Show a `bem.notes.Note` on the results, or a message on how the work goes, which is a plain text."""

    # It may also have `numbers(summary, headline)`, which a run calls before it draws pictures of them.


class Silent:
    """A watcher that does nothing."""

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `Watcher`."""

    def note(self, text: str) -> None:
        """See `Watcher`."""


class CaseContext:
    """See `bem.scenes.Context`.

    Parameters
    ----------
    case : what is run.
    file : where the state is kept; None keeps none.
    state : what is in the file, of a run that goes on.
    watcher : told of progress and notes.
    epoch : clock time [s] at which the run would have begun had it not been interrupted.
    kind : name of the scene's kind, with whose code a resumed run must have been begun.
    """

    def __init__(
        self,
        case: Case,
        file: Path | None,
        state: Mapping[str, Any] | None,
        watcher: Watcher,
        epoch: float,
        kind: str = "",
    ) -> None:
        self._case = case
        self._file = file
        self._watcher = watcher
        self._epoch = epoch
        self._kind = kind
        self._open: dict[str, float] = {}
        self.resumed = state is not None
        state = dict(state or {})
        self.notes: list[Note] = [unpacked(one) for one in state.pop("_notes", ())]
        self.seconds: dict[str, float] = dict(state.pop("_seconds", {}))
        state.pop("_wall_time_s", None)
        self._state = state if self.resumed else None

    def seed(self, purpose: str, *indices: int) -> int:
        """See `bem.scenes.Context`."""
        number = (self._case.repetition,) if self._case.repeated else ()
        return derive_seed(self._case.scene.seed, purpose, *number, *indices)

    def progress(self, done: int, total: int, what: str = "", /, **figures: float) -> None:
        """See `bem.scenes.Context`."""
        self._watcher.progress(done, total, what, figures)

    def note(self, text: str) -> None:
        """See `bem.scenes.Context`."""
        note = as_note(text)
        if note not in self.notes:
            self.notes.append(note)
            self._watcher.note(note)

    def message(self, text: str) -> None:
        """Tell the watcher how the work goes; no note on the results."""
        self._watcher.note(text)

    @contextmanager
    def timer(self, stage: str) -> Iterator[None]:
        """See `bem.scenes.Context`."""
        if stage in self._open:  # the outer block counts it
            yield
            return
        self._open[stage] = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - self._open.pop(stage)

    def scratch(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """See `bem.scenes.Context`."""
        from bem.results.scratch import scratch_array

        return scratch_array(Path(tempfile.gettempdir()) if self._file is None else self._file.parent, shape)

    def save(self, state: Mapping[str, Any]) -> None:
        """See `bem.scenes.Context`."""
        if self._file is None:
            return
        from bem.results.checkpoint import save_checkpoint

        now = time.perf_counter()
        seconds = dict(self.seconds)
        for stage, start in self._open.items():
            seconds[stage] = seconds.get(stage, 0.0) + now - start
        wall_time = time.time() - self._epoch
        notes = [note.packed() for note in self.notes]
        about = {"_notes": notes, "_seconds": seconds, "_wall_time_s": wall_time}
        save_checkpoint(self._file, {**state, **about}, self._kind)

    def saved(self) -> dict[str, Any] | None:
        """See `bem.scenes.Context`."""
        return None if self._state is None else dict(self._state)

    def coarser(self) -> dict[str, Any] | None:
        """See `bem.scenes.Context`."""
        return None
