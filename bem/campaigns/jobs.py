"""Jobs handed out: to this process, to processes on all cores, or to a Dask cluster, the longest first.

Everything that computes many things comes through here: the cases of a scene (`engine`) and the points of a sweep
(`bem.runs.sweep`). What is handed out where, and when, never shows in a result.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.campaigns.cluster import compute_on_cluster
from bem.campaigns.context import Watcher
from bem.campaigns.disk import marked
from bem.campaigns.job import Job, Sent
from bem.campaigns.local import compute_locally
from bem.errors import BemError
from bem.laws import modules_of_laws
from bem.scenes.planner import available_memory, machine_rate
from bem.surfaces.formats import modules_of_formats
from bem.threads import cores, get_threads, set_threads

_WORTH_A_PROCESS = 4.0
"""Seconds of work that pay for starting a process, which takes two."""
_ALIKE = 0.75
"""Jobs are alike where the shortest is this part of the longest, by their plans."""


@dataclass(frozen=True)
class Staff:
    """Workers of a run: processes of this machine, or a Dask cluster.

    workers : processes on this machine; as many as cores, memory and work allow where None.
    scheduler : address of a Dask scheduler, instead of processes.
    threads : of each; None leaves this process's number.
    module : of the scene's kind; nobody else can know what "__main__" defines.
    folder : in which jobs are kept, for workers to find out whether they see it; None where nothing is kept.
    """

    workers: int | None = None
    scheduler: str | None = None
    threads: int | None = None
    module: str = "bem"
    folder: Path | None = None


def hand_out(
    jobs: Sequence[Job], staff: Staff, watching: Callable[[int], Watcher], note: Callable[[str], None]
) -> Generator[tuple[int, Any], None, None]:
    """Do all jobs, yielding index and result of each as it ends; closing the iterator ends what runs.

    watching : the watcher of the job with that index. note : of all together.

    Raises
    ------
    InputError : no scheduler answers. ResultsError : it is gone. RuntimeError : a mistake in the program.
    """
    before = get_threads()
    threads = staff.threads or before
    modules = tuple(dict.fromkeys((staff.module, *modules_of_laws(), *modules_of_formats())))
    seconds = _seconds(jobs, threads)
    longest_first = sorted(jobs, key=lambda job: -seconds[job.index])  # so that no long one is left for the end
    if staff.scheduler is not None and jobs:
        with nullcontext("none") if staff.folder is None else marked(staff.folder) as token:
            sent = [Sent(job, threads, modules, staff.folder, token) for job in longest_first]
            yield from compute_on_cluster(sent, staff.scheduler)
        return
    count = processes(staff.workers, jobs, math.fsum(seconds.values()), threads, note)
    if count > 1 and "__main__" not in modules:
        at_end = _threads_at_end([seconds[job.index] for job in longest_first], count)
        sent = [Sent(job, threads * n, modules) for job, n in zip(longest_first, at_end, strict=True)]
        yield from compute_locally(sent, count, watching)
        return
    set_threads(threads)
    try:
        for job in jobs:
            yield job.index, job.compute(watching(job.index))
    finally:
        set_threads(before)


def _seconds(jobs: Sequence[Job], threads: int) -> dict[int, float]:
    """Estimated time of each job [s]; zero of a single one, about which there is nothing to decide."""
    plans = {job.index: job.plan for job in jobs}
    if len(jobs) < 2 or not any(plans.values()):
        return dict.fromkeys(plans, 0.0)
    rate = machine_rate(threads)
    return {index: 0.0 if plan is None else plan.work(rate) for index, plan in plans.items()}


def _threads_at_end(seconds: Sequence[float], count: int) -> list[int]:
    """Return the factor of threads for every job in turn: jobs of a last round that is not full share the idle
    cores.

    Only where jobs are alike; of others nobody knows who will be idle when. No result depends on its threads.
    """
    left = len(seconds) % count
    alike = min(seconds) >= _ALIKE * max(seconds)
    return [count // left if alike and i >= len(seconds) - left else 1 for i in range(len(seconds))]


def processes(
    workers: int | None, jobs: Sequence[Job], seconds: float, threads: int, note: Callable[[str], None]
) -> int:
    """Return the number of processes: as asked, or one per core as far as `seconds` of work are worth it and memory
    allows."""
    if workers is not None:
        return min(workers, len(jobs))
    wanted = max(1, min(cores() // threads, len(jobs), int(seconds / _WORTH_A_PROCESS)))
    memory = max((job.plan.memory for job in jobs if job.plan is not None), default=1.0)
    fitting = max(1, int(available_memory() // memory))
    if fitting < wanted:
        note(f"{fitting} processes instead of {wanted}: more would not fit into memory")
    return min(wanted, fitting)


def words_of(error: BemError | MemoryError) -> str:
    """Describe the failure of a job, several mistakes in one line."""
    if isinstance(error, MemoryError):
        return "out of memory; fewer --workers or a smaller grid"
    return " | ".join(getattr(error, "messages", None) or [str(error)])
