"""One process leads a run, the others help it with each contact.

Rank 0 runs a scene as always: it loads, plans, writes and draws. Where a contact is to be solved it sends the task to
the other ranks, which wait for tasks until the run ends (`Session`). A contact's gap is scattered by rows, its pressure
and displacement are collected on rank 0, where `bem.contact.certificate` judges them as it judges those of the serial
solver.

A failure that all ranks have in common, such as a load that cannot be carried, ends the contact on all of them and is
raised on rank 0. Any other failure of a rank ends all processes, because the others would wait for it for ever.
"""

from __future__ import annotations

import math
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bem.errors import BemError, InputError

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.convolution import DisplacementOperator
    from bem.distributed.mpi import MpiRanks
    from bem.grid import FloatArray, Grid
    from bem.materials import Body

_RANK_VARIABLES = ("PMI_RANK", "OMPI_COMM_WORLD_RANK", "PMIX_RANK", "SLURM_PROCID")
"""Variables by which starters of MPI tell a process its rank before MPI is loaded."""


@dataclass(frozen=True)
class Task:
    """A contact that all ranks solve: arguments of `bem.distributed.solve.solve_slabs` without the gap."""

    grid: Grid
    bodies: Body | tuple[Body, Body]
    load: float | None
    approach: float | None
    hardness: float | None
    tolerance: float
    max_iterations: int


class Session:
    """Ranks of a run, as rank 0 sees them.

    Parameters
    ----------
    ranks : of MPI, more than one.
    """

    def __init__(self, ranks: MpiRanks) -> None:
        self.ranks = ranks
        self.solving = False

    def solve_contact(
        self,
        gap: FloatArray,
        operator: DisplacementOperator,
        *,
        load: float | None = None,
        approach: float | None = None,
        mean_gap: float | None = None,
        hardness: float | None = None,
        tolerance: float = 1e-8,
        initial_pressure: FloatArray | None = None,
        max_iterations: int = 5000,
        callback: Callable[[int, float, float], object] | None = None,
    ) -> ContactSolution:
        """Solve a contact on all ranks, as `bem.contact.solve_contact` does on one.

        Raises
        ------
        InputError : a mean gap, a first pressure, friction that changes the gap, a local compliance, or arguments out
            of range.
        InfeasibleError : as `solve_contact`.
        """
        if mean_gap is not None or initial_pressure is not None or not operator.symmetric or operator.compliance:
            raise InputError(
                "a contact on several ranks takes a load or an approach, no mean gap, no first pressure, no friction "
                "that changes the gap and no local compliance"
            )
        bodies = operator.bodies
        task = Task(
            operator.grid,
            (bodies[0], bodies[1]) if len(bodies) == 2 else bodies[0],
            load,
            approach,
            hardness,
            tolerance,
            max_iterations,
        )
        self.solving = True
        self.ranks.send_to_all(task)
        try:
            solution = _solve(task, self.ranks, gap, operator, callback)
        except BemError:
            self.solving = False  # raised on all ranks
            raise
        self.solving = False
        assert solution is not None
        return solution


_CURRENT: list[Session] = []


def current_session() -> Session | None:
    """Return the session of this process, None where contacts are solved by this process alone."""
    return _CURRENT[-1] if _CURRENT else None


@contextmanager
def leading(ranks: MpiRanks) -> Iterator[Session]:
    """Solve contacts of this process on all ranks while the context lasts; on rank 0.

    At the end the other ranks are told to leave. A failure while they solve a contact ends all processes.
    """
    session = Session(ranks)
    _CURRENT.append(session)
    try:
        yield session
    except BaseException as error:
        if session.solving:
            _end_all(ranks, error)
        raise
    finally:
        _CURRENT.pop()
        ranks.send_to_all(None)


def follow(ranks: MpiRanks) -> None:
    """Help rank 0 with its contacts until it ends; on the other ranks. A failure of this rank ends all processes."""
    try:
        while (task := ranks.next_from_first()) is not None:
            try:
                _solve(task, ranks, None, None, None)
            except BemError:
                continue  # raised on rank 0, too
    except BaseException as error:
        _end_all(ranks, error)


def _end_all(ranks: MpiRanks, error: BaseException) -> None:
    """Write what went wrong, and end the processes of all ranks."""
    if isinstance(error, KeyboardInterrupt):
        print("bem: interrupted", file=sys.stderr, flush=True)
        ranks.abort(130)
    words = "out of memory" if isinstance(error, MemoryError) else "".join(traceback.format_exception(error))
    print(f"bem: rank {ranks.rank} of {ranks.size} failed, all processes end: {words}", file=sys.stderr, flush=True)
    ranks.abort(1)


@contextmanager
def shared_run(ranks: bool) -> Iterator[bool]:
    """Yield True on the process that runs a scene; on the others help it, then yield False.

    ranks : False runs the scene in this process alone.

    Raises
    ------
    InputError : mpi4py cannot be used, or this process is alone; on the first process only, others leave with code 2.
    """
    if not ranks:
        yield True
        return
    found = _ranks_of_run()
    if found.rank > 0:
        follow(found)
        yield False
        return
    with leading(found):
        yield True


def _ranks_of_run() -> MpiRanks:
    """Return the ranks that `mpiexec` started; raises as `shared_run`."""
    from bem.distributed.mpi import world

    try:
        ranks = world()
        if ranks.size == 1:
            raise InputError(
                "--ranks: this process is alone; allowed: mpiexec -n 4 bem run SCENE --ranks, with the mpiexec of the "
                f"MPI library of mpi4py ({ranks.library()})"
            )
    except InputError:
        if any(os.environ.get(name, "0") != "0" for name in _RANK_VARIABLES):
            raise SystemExit(InputError.exit_code) from None
        raise
    return ranks


def _solve(
    task: Task,
    ranks: MpiRanks,
    gap: FloatArray | None,
    operator: DisplacementOperator | None,
    callback: Callable[[int, float, float], object] | None,
) -> ContactSolution | None:
    """Solve a contact whose gap rank 0 has; return the solution there, None on the others."""
    import numpy as np

    from bem.distributed.ranks import own_slice
    from bem.distributed.solve import solve_slabs

    grid = task.grid
    own = own_slice(grid.shape[0], ranks)
    rows = np.empty((own.stop - own.start, grid.shape[1]))
    ranks.scatter_rows(gap, rows)
    slabs = solve_slabs(
        rows,
        grid,
        task.bodies,
        ranks,
        load=task.load,
        approach=task.approach,
        hardness=task.hardness,
        tolerance=task.tolerance,
        max_iterations=task.max_iterations,
        callback=callback,
    )
    del rows
    whole = [None, None] if gap is None else [np.empty(grid.shape), np.empty(grid.shape)]
    for part, field in zip((slabs.pressure, slabs.displacement), whole, strict=True):
        ranks.collect_rows(part, field)
    if gap is None or operator is None:
        return None
    return _certified(task, operator, gap, whole, slabs)


def _certified(
    task: Task, operator: DisplacementOperator, gap: FloatArray, fields: list[Any], slabs: Any
) -> ContactSolution:
    """Return the solution of the collected fields, certified as that of the serial solver; on rank 0."""
    import numpy as np

    from bem.contact import reductions
    from bem.contact.certificate import certify
    from bem.contact.grid_workspace import GridResult
    from bem.contact.problem import Units, checked_request
    from bem.convolution import KernelSpectra

    unit = KernelSpectra(np.empty((0, 0)), None, slabs.response_unit)
    judged = replace(operator, spectra_on=lambda _grid: unit)  # no spectrum of the whole grid is computed
    controls = {"load": task.load, "approach": task.approach, "mean_gap": None}
    request = checked_request(
        gap,
        judged,
        controls,
        hardness=task.hardness,
        tolerance=task.tolerance,
        initial_pressure=None,
        max_iterations=task.max_iterations,
    )
    _, _, rms_gap = reductions.moments(request.gap.reshape(-1))
    pressure, displacement = (field.reshape(-1) for field in fields)
    before = operator.count.weighted
    operator.count.weighted += slabs.convolutions
    return certify(
        request,
        Units(1.0, 1.0, 0.0),
        rms_gap,
        GridResult(pressure, displacement, slabs.approach, math.nan),
        status_if_unmet=slabs.status,
        iterations=slabs.iterations,
        convolutions_before=before,
    )
