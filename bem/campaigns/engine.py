"""Cases computed: those that are there are kept, the others run, each with a checkpoint file of its own.

A case that fails (its solver cannot go on, its input cannot be used) is named and does not stop the others. A mistake
in the program does. Every finished case is on disk before the next begins on its worker, and a case that was begun goes
on from its own state, so a campaign killed at any moment ends, resumed, in the same bits.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Hashable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from bem.campaigns.cases import Campaign, Case
from bem.campaigns.collect import Given, collect, words_of_bars
from bem.campaigns.context import CaseContext, Silent, Watcher
from bem.campaigns.jobs import Staff, hand_out, words_of
from bem.campaigns.refine import solve_case, words_of_levels
from bem.campaigns.uncertain import with_inputs
from bem.errors import BemError, ConvergenceError, InputError, ResultsError, Status, interrupts_as_they_are
from bem.notes import Note, as_note, unpacked
from bem.notes.merge import identity, merge
from bem.results.checkpoint import load_checkpoint, save_checkpoint
from bem.results.directory import CASES, CHECKPOINT
from bem.scenes.context import Outcome
from bem.scenes.kind import get_kind
from bem.scenes.planner import Plan
from bem.scenes.records import Record, pack, unpack, without
from bem.startup.lazy import collecting
from bem.threads import one_blas_thread

_RECORD = "_record"


@dataclass(frozen=True)
class Result:
    """Result of a case: its packed record, or the reason of its failure."""

    record: dict[str, Any] | None
    notes: list[Note] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)
    error: str = ""
    status: Status = Status.CONVERGED
    exception: type[BemError] = BemError


@dataclass(frozen=True)
class CaseJob:
    """A case to be computed anywhere, see `bem.campaigns.job.Job`.

    Attributes
    ----------
    index, case, plan : which, what, and how much work it is.
    file : of its checkpoint, None where there is none.
    first, last : whether it is the first, the last of its campaign.
    epoch : clock time [s] at which the run would have begun had it not been interrupted.
    """

    index: int
    case: Case
    plan: Plan | None
    file: Path | None
    first: bool
    last: bool
    epoch: float

    @one_blas_thread
    def compute(self, watcher: Watcher) -> Result:
        """Run the case, going on from its checkpoint; errors that a scene can cause come back as words."""
        kind = self.case.scene.kind
        state = None if self.file is None else load_checkpoint(self.file, kind)
        context = CaseContext(self.case, self.file, state, watcher, self.epoch, kind)
        try:
            with interrupts_as_they_are(), collecting():
                record = solve_case(get_kind(kind), self.case.scene, context)
                record = with_inputs(get_kind(kind), self.case.scene, record, context, self._quiet)
        except ResultsError:
            raise  # no case can be kept on a disk that is full
        except (BemError, MemoryError) as error:
            return _failed(error, context.notes, context.seconds)
        return Result(pack(without(record, first=self.first, last=self.last)), context.notes, context.seconds)

    def _quiet(self, scene: Any) -> CaseContext:
        """Return a context without checkpoint, progress and notes for another scene of the case."""
        case = dataclasses.replace(self.case, scene=scene)
        return CaseContext(case, None, None, Silent(), self.epoch, scene.kind)

    def elsewhere(self) -> CaseJob:
        """Without a checkpoint."""
        return dataclasses.replace(self, file=None)

    def lost(self, why: str) -> Result:
        """Its process died."""
        return Result(None, error=why, status=Status.STALLED, exception=ConvergenceError)


def _failed(error: BemError | MemoryError, notes: list[Note], seconds: dict[str, float]) -> Result:
    kind = ConvergenceError if isinstance(error, MemoryError) else type(error)
    status = Status.INFEASIBLE if isinstance(error, InputError) else Status.STALLED
    return Result(None, notes, seconds, words_of(error), status, kind)


@dataclass(frozen=True)
class Computed:
    """A campaign that is over: its outcome, what the reader must know, seconds by stage, summed over cases, and the
    clock time [s] at which it would have begun had it not been interrupted."""

    outcome: Outcome
    notes: list[Note]
    seconds: dict[str, float]
    epoch: float


def compute(
    campaign: Campaign,
    folder: Path | None = None,
    *,
    plan: Plan | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    watcher: Watcher | None = None,
) -> Computed:
    """Compute what is missing of a campaign and put all of it together.

    Parameters
    ----------
    campaign : the cases.
    folder : of the run, where checkpoints are kept and looked for; None keeps none.
    plan : of the campaign, for how many processes fit into memory and are worth starting; None computes here.
    workers : processes; as many as cores, memory and work allow where not given. One case is computed here.
    scheduler : address of a Dask scheduler, instead of processes on this machine.
    watcher : told of progress and notes of all cases together.

    Raises
    ------
    BemError : no case gave a result: what the first of them said.
    ResultsError : checkpoints cannot be written.
    """
    board = Board(watcher or Silent(), campaign)
    files = [_file(folder, campaign, case) for case in campaign.cases]
    states = [None if file is None else load_checkpoint(file, campaign.kind.name) for file in files]
    epoch = time.time() - max((state["_wall_time_s"] for state in states if state is not None), default=0.0)
    results: dict[int, Result] = {}
    missing = []
    for case, state in zip(campaign.cases, states, strict=True):
        if state is not None and _RECORD in state:
            results[case.index] = Result(state[_RECORD], [unpacked(one) for one in state["_notes"]], state["_seconds"])
            board.over(case.index)
        else:
            missing.append(case)
    del states
    last = len(files) - 1
    plans: Sequence[Plan | None] = [None] * len(files) if plan is None else plan.of_cases
    jobs = [
        CaseJob(case.index, case, plans[case.index], files[case.index], case.index == 0, case.index == last, epoch)
        for case in missing
    ]
    staff = Staff(workers, scheduler, module=type(campaign.scene).__module__, folder=folder)
    for index, result in hand_out(jobs, staff, board.watching, board.note):
        file = files[index]
        if file is not None and len(files) > 1 and result.record is not None:
            notes = [note.packed() for note in result.notes]
            about = {"_notes": notes, "_seconds": result.seconds, "_wall_time_s": time.time() - epoch}
            save_checkpoint(file, {_RECORD: result.record, **about}, campaign.kind.name)
        if result.error and len(files) > 1:
            board.watching(index).note(f"failed: {result.error}")
        results[index] = result
        board.over(index)
    return _together(campaign, [results[case.index] for case in campaign.cases], board, epoch)


def finished_cases(campaign: Campaign, folder: Path) -> list[Record | None]:
    """Return the records of the cases that a run in the folder has finished, None of those that it has not.

    A case whose file is being replaced, or was begun with other code, counts as unfinished.
    """
    records: list[Record | None] = []
    for case in campaign.cases:
        file = folder / CASES / f"{case.index:05d}.bin"
        state = None
        with suppress(BemError):
            state = load_checkpoint(file, campaign.kind.name)
        done = state is not None and _RECORD in state
        records.append(unpack(state[_RECORD], campaign.kind.record) if state is not None and done else None)
    return records


def _file(folder: Path | None, campaign: Campaign, case: Case) -> Path | None:
    if folder is None:
        return None
    if len(campaign.cases) == 1:
        return folder / CHECKPOINT
    (folder / CASES).mkdir(exist_ok=True)
    return folder / CASES / f"{case.index:05d}.bin"


def _together(campaign: Campaign, results: Sequence[Result], board: Board, epoch: float) -> Computed:
    """All results as one; what went wrong in all of them is raised."""
    broken = [result for result in results if result.record is None]
    if len(broken) == len(results):
        words = list(dict.fromkeys(message for result in broken for message in result.error.split(" | ")))
        raise broken[0].exception(words if issubclass(broken[0].exception, InputError) else "; ".join(words))
    kind = campaign.kind
    records = [None if result.record is None else unpack(result.record, kind.record) for result in results]
    given = [
        Given(case, record, result.error, result.status)
        for case, record, result in zip(campaign.cases, records, results, strict=True)
    ]
    seconds: dict[str, float] = {}
    for result in results:
        for stage, spent in result.seconds.items():
            seconds[stage] = seconds.get(stage, 0.0) + spent
    by_case = [(case.label, result.notes) for case, result in zip(campaign.cases, results, strict=True)]
    notes = notes_of(by_case)
    if is_path(campaign):
        for note in notes_of_path(by_case):
            board.note(note)
    for note in map(as_note, (*words_of_bars(campaign, records), *words_of_levels(campaign, records))):
        notes.append(note)
        board.note(note)
    return Computed(collect(campaign, given), notes, seconds, epoch)


def notes_of(by_case: Sequence[tuple[str, Sequence[str]]], named: int = 3) -> list[Note]:
    """Return the notes of all cases, each once, with the cases it applies to where these are not all of them.

    Parameters
    ----------
    by_case : label and notes of each case.
    named : cases that are named at most.
    """

    def labels(indices: list[int]) -> str:
        more = f" and {len(indices) - named} more" if len(indices) > named else ""
        return "; ".join(by_case[index][0] for index in indices[:named]) + more

    return merge([notes for _, notes in by_case], labels)


def is_path(campaign: Campaign) -> bool:
    """Return True for the positions of one path, whose notes the terminal shows after all of them, each once."""
    return [axis.name for axis in campaign.axes] == ["position"]


def notes_of_path(by_case: Sequence[tuple[str, Sequence[str]]], named: int = 3) -> list[Note]:
    """Return the notes of the positions of a path, each once, with the number of positions it applies to, and which
    where these are few.

    Parameters
    ----------
    by_case : label and notes of each position.
    named : positions that are named at most.
    """
    count = len(by_case)

    def at_positions(indices: list[int]) -> str:
        labels = ", ".join(by_case[index][0].removeprefix("position ") for index in indices)
        few = f" ({labels})" if len(indices) <= named else ""
        return f"at {len(indices)} of {count} positions{few}"

    merged = merge([notes for _, notes in by_case], at_positions)
    return [note if note.where.startswith("at ") else note.at(f"at {count} of {count} positions") for note in merged]


class Board:
    """Progress of all cases as one, and their notes with the case in front."""

    def __init__(self, watcher: Watcher, campaign: Campaign) -> None:
        self._watcher = watcher
        self._cases = campaign.cases
        self._after_all = is_path(campaign)
        self._steps: dict[str, dict[int, int]] = {}
        self._totals: dict[str, int] = {}
        self._finished: set[int] = set()
        self._said: set[Hashable] = set()

    def watching(self, index: int) -> Watcher:
        """The watcher of one case."""
        return self._watcher if len(self._cases) == 1 else _Watching(self, index)

    def note(self, text: str) -> None:
        """A note about all of it."""
        self._watcher.note(text)

    def over(self, index: int) -> None:
        """A case is finished, now or before."""
        if len(self._cases) > 1:
            self._finished.add(index)
            for what in self._totals:
                self._show(what, {})
            self._watcher.progress(len(self._finished), len(self._cases), "cases", {})

    def step(self, index: int, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """One case is that far."""
        self._steps.setdefault(what, {})[index] = done
        self._totals[what] = total
        self._show(what, figures)

    def remark(self, index: int, text: str) -> None:
        """Show a note of one case with its label, unless another case has shown it with other numbers.

        Notes of the positions of a path are shown after all of them, with their number: `notes_of_path`.
        """
        if self._after_all and isinstance(text, Note):
            return
        said: Hashable = identity(text) if isinstance(text, Note) else text
        if said in self._said:
            return
        self._said.add(said)
        label = self._cases[index].label
        self._watcher.note(text.at(label) if isinstance(text, Note) else f"{label}: {text}")

    def _show(self, what: str, figures: Mapping[str, float]) -> None:
        total = self._totals[what]
        running = sum(done for index, done in self._steps[what].items() if index not in self._finished)
        done = len(self._finished) * total + running
        self._watcher.progress(min(done, len(self._cases) * total), len(self._cases) * total, what, figures)


class _Watching:
    """The watcher of one of several cases."""

    def __init__(self, board: Board, index: int) -> None:
        self._board, self._index = board, index

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        """See `Watcher`."""
        self._board.step(self._index, done, total, what, figures)

    def note(self, text: str) -> None:
        """See `Watcher`."""
        self._board.remark(self._index, text)
