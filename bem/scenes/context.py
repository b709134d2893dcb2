"""Inputs of a kind of scene while it runs, and its outcome; independent of file formats."""

from __future__ import annotations

import hashlib
import math
import mmap
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.notes import Note, as_note
from bem.notes.accuracy import ERROR_BARS_LOST, NO_ERROR_BAR, NoBar, one_note_per_cause
from bem.notes.merge import merge
from bem.numerics.blocks import row_blocks
from bem.plausibility import without_argument_notes

LARGE = 1 << 30
"""From this size on [bytes] an array of `Context.scratch` is on disk."""


class Context(Protocol):
    """Services that `Kind.run` may use besides its scene."""

    @property
    def resumed(self) -> bool:
        """Return True if this run continues an interrupted one."""

    def seed(self, purpose: str, *indices: int) -> int:
        """A seed of its own for every named purpose (and repetition); the same in every run of the scene."""

    def progress(self, done: int, total: int, what: str = "", /, **figures: float) -> None:
        """`done` of `total` steps of `what` are finished; figures such as radius_nm=140 are shown beside."""

    def note(self, text: str) -> None:
        """Something the reader of the results must know; shown, and kept in summary and report."""

    def timer(self, stage: str) -> AbstractContextManager[None]:
        """Add the time spent in the `with` block to the stage's sum, which the summary holds."""

    def scratch(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """An uninitialised array; a very large one is on disk, so that it need not fit into memory. See `release`."""

    def save(self, state: Mapping[str, Any]) -> None:
        """Replace the checkpoint, whole or not at all: arrays, plain values, lists and dictionaries of them."""

    def saved(self) -> dict[str, Any] | None:
        """The state last saved for this very scene if the run is resumed and one exists, else None."""

    def coarser(self) -> dict[str, Any] | None:
        """The state last saved on the level before, where an accuracy is refined to: the same scene with half of those
        cells, depths, points or steps that were too few, and as many of the others. None on a first level."""


class Bars(Protocol):
    """Part of `bem.accuracy.ErrorBars` that is used here."""

    @property
    def values(self) -> Mapping[str, Any]:
        """Errors by the names of their figures; None where there is none."""

    @property
    def notes(self) -> tuple[Note, ...]:
        """Notes on figures without error bars."""

    @property
    def parts(self) -> Mapping[str, Mapping[str, Any]]:
        """Contribution of each origin to the errors."""


class Variable:
    """A named array of the results, from the record of a run to the file, the figures and the page.

    Parameters
    ----------
    dimensions : one name per axis. A variable with the name of its only dimension is that dimension's coordinate.
    values : numbers; with `shape`, a function that reads them when they are first asked for.
    units : SI, such as "Pa"; "1" for none.
    description : long name for axes and for readers of the file.
    shape : of values that are still to be read.
    read_at : function that reads the values at one place along the first axes.
    """

    def __init__(
        self,
        dimensions: Sequence[str],
        values: NDArray[Any] | Callable[[], NDArray[Any]],
        units: str,
        description: str,
        *,
        shape: tuple[int, ...] | None = None,
        read_at: Callable[[tuple[int, ...]], NDArray[Any]] | None = None,
    ) -> None:
        self.dimensions = tuple(dimensions)
        self._read_at = read_at
        self.units = units
        self.description = description
        self._read = values if callable(values) and shape is not None else None
        if self._read is None:
            self.__dict__["values"] = np.asarray(values)
            shape = self.values.shape
        assert shape is not None
        self.shape = shape
        if self.ndim != len(self.dimensions):
            raise ValueError(f"{description}: {self.ndim} axes but dimensions {self.dimensions}")

    @cached_property
    def values(self) -> NDArray[Any]:
        """The numbers."""
        assert self._read is not None
        return self._read()

    def at(self, place: tuple[int, ...]) -> NDArray[Any]:
        """Return the numbers at one place along the first axes; of a stored array, only these are read."""
        if self._read_at is None or "values" in vars(self):
            return np.asarray(self.values[place])
        return self._read_at(place)

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions, by xarray's name."""
        return self.dimensions

    @property
    def attrs(self) -> dict[str, str]:
        """Units and description as xarray has them."""
        known = {"units": self.units, "long_name": self.description}
        return {name: text for name, text in known.items() if text}

    @property
    def size(self) -> int:
        """Count of numbers."""
        return math.prod(self.shape)

    @property
    def ndim(self) -> int:
        """Count of axes."""
        return len(self.shape)

    def with_values(self, values: NDArray[Any], units: str) -> Variable:
        """Return the variable with other values in other units."""
        return Variable(self.dimensions, values, units, self.description)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.values, dtype=dtype, copy=copy)

    def __float__(self) -> float:
        return float(self.values)

    def __repr__(self) -> str:
        return f"Variable({self.dimensions}, shape {self.shape}, {self.units!r}, {self.description!r})"


@dataclass(frozen=True)
class Outcome:
    """Results of a run.

    Attributes
    ----------
    summary : figures for `summary.json`; names carry their unit. Lists run over speeds, loads, temperatures or seeds.
    variables : arrays for `results.nc`, by name.
    status : worst status of the solvers.
    where : if not converged, where that happened, in words.
    volumes : names of variables with dimensions (..., "depth", "x", "y") that go into the VTK file.
    axes : dimensions along which the cases lie, the last one running fastest.
    """

    summary: Mapping[str, Any]
    variables: Mapping[str, Variable]
    status: Status = Status.CONVERGED
    where: str = ""
    volumes: tuple[str, ...] = ()
    axes: tuple[str, ...] = ()


def tell(context: Context, notes: Iterable[str], about: str = "") -> None:
    """Note each, with the place `about`; not those on arguments, of which scenes say it by their keys."""
    for note in without_argument_notes(notes):
        context.note(note.at(about) if about else note)


def notes_over(name: str, unit: str, values: Sequence[float], notes: Sequence[Iterable[str]]) -> list[Note]:
    """Return the notes of results at several values, each once, with its values where these are not all of them.

    Neighbouring values are named as a range.
    """
    return merge(notes, lambda at: f"{name}{'s' if len(at) > 1 else ''} {_ranges(values, at)} {unit}")


def _ranges(values: Sequence[float], at: Sequence[int]) -> str:
    first = [index for index in at if index - 1 not in at]
    last = [index for index in at if index + 1 not in at]
    return ", ".join(
        f"{values[a]:g}" + (f" to {values[b]:g}" if b > a else "") for a, b in zip(first, last, strict=True)
    )


def error_bars(context: Context, wanted: bool, bars: Callable[[], Bars]) -> dict[str, Any]:
    """`errors` and `error_parts` of a record, timed, and noted why some are missing; none where they are not wanted."""
    if not wanted:
        return {}
    with context.timer("error bars"):
        found = bars()
    tell(context, one_note_per_cause(_with_loss(found)))
    return {"errors": dict(found.values), "error_parts": dict(found.parts)}


def _with_loss(bars: Bars) -> tuple[Note, ...]:
    """Return the notes on bars; where an unsolved coarser grid lost all of them, the caution that says so instead."""
    unsolved = [n for n in bars.notes if n.code == NO_ERROR_BAR.code and n.values["reason"] == NoBar.COARSER_UNSOLVED]
    if not unsolved or any(value is not None for value in bars.values.values()):
        return bars.notes
    return (ERROR_BARS_LOST(), *(note for note in bars.notes if note not in unsolved))


def release(values: NDArray[Any]) -> None:
    """Let go of the memory behind a large array of `Context.scratch`; what is in it stays on disk. Others are kept.

    After each part of such an array is written or read, so that never the whole of it is in memory.
    """
    owner: Any = values
    while isinstance(owner, np.ndarray):
        owner = owner.base
    pages = owner.obj if isinstance(owner, memoryview) else owner
    if isinstance(pages, mmap.mmap):
        pages.madvise(mmap.MADV_DONTNEED)


def set_aside(context: Context, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same values, very large ones on disk and not in memory: they come back as they are looked at (see `release`).

    For what a run has no use for until its results are written."""
    if values.nbytes < LARGE:
        return values
    stored = context.scratch(values.shape)
    for first, last in row_blocks(values.shape):
        stored[first:last] = values[first:last]
        release(stored)
    return stored


def derive_seed(seed: int, purpose: str, *indices: int) -> int:
    """63 bits that depend on the scene's seed and the purpose only."""
    text = "/".join([str(seed), purpose, *map(str, indices)])
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") >> 1


@dataclass
class PlainContext:
    """A context without a disk or a terminal, for scripts and tests; the checkpoint is kept in memory."""

    scene_seed: int = 0
    resumed: bool = False
    notes: list[Note] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)
    state: dict[str, Any] | None = None

    def seed(self, purpose: str, *indices: int) -> int:
        """See `Context`."""
        return derive_seed(self.scene_seed, purpose, *indices)

    def progress(self, done: int, total: int, what: str = "", /, **figures: float) -> None:
        """Nothing to show."""

    def note(self, text: str) -> None:
        """See `Context`."""
        note = as_note(text)
        if note not in self.notes:
            self.notes.append(note)

    @contextmanager
    def timer(self, stage: str) -> Iterator[None]:
        """See `Context`."""
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - start

    def scratch(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """See `Context`; always in memory."""
        return np.empty(shape)

    def save(self, state: Mapping[str, Any]) -> None:
        """See `Context`."""
        self.state = {key: np.array(value) if isinstance(value, np.ndarray) else value for key, value in state.items()}

    def saved(self) -> dict[str, Any] | None:
        """See `Context`."""
        return dict(self.state) if self.resumed and self.state is not None else None

    def coarser(self) -> dict[str, Any] | None:
        """See `Context`."""
        return None
