"""What two, four and eight threads would give: how much of the work they share, counted with all of it done by one.

    python -m reports.experiments.shared_work

Two minutes. Whatever threads share goes through `bem.threads.share`, in blocks, if it is large enough. Here a case runs
as it does on so many threads, but one thread does all blocks, one after another, and is timed with them: what is
outside is serial, and of b blocks n threads do at best ceil(b/n) in a row. The gain that follows is Amdahl's (*AFIPS
Conf. Proc.* 30, 1967), with the blocks that are left over: a bound, as threads that wait for memory or for one another
are not in it. It needs no second core and no quiet machine. The result is stored in `reports/results/shared_work.json`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem import threads
from bem.benchmarks.cases import CASES
from reports.experiments.kept import keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "shared_work.json"
THREADS = (2, 4, 8)
SIZES = {
    "contact-periodic": (256, 512, 1024, 2048),
    "contact-free": (256, 512, 1024),
    "contact-capped": (1024,),
    "stress-warm": (64, 128, 256),
    "von-mises-warm": (64, 128, 256),
    "wear-cycle": (64,),
}
REPEATS = 3


@dataclass
class Shared:
    """Seconds of one thread: in blocks that are shared, and as many as would be left of these."""

    alone: float = 0.0
    together: float = 0.0


@contextmanager
def counted(count: int) -> Iterator[Shared]:
    """Run as on so many threads, with all blocks done by this one."""
    found, outright, before, cores = Shared(), threads.share, threads.get_threads(), threads.cores

    def share(work: Callable[[int, int], None], blocks: int, entries: int) -> None:
        apart = threads.threads_for(entries) > 1 and blocks > 1
        start = time.thread_time()
        if apart:
            threads.set_threads(1)  # what is shared shares nothing further
        for block in range(blocks):
            work(0, block)
        if apart:
            threads.set_threads(count)
            spent = time.thread_time() - start
            found.alone += spent
            found.together += spent * -(-blocks // count) / blocks

    holding = [module for module in list(sys.modules.values()) if getattr(module, "share", None) is outright]
    threads.set_threads(count)
    vars(threads)["cores"] = lambda: count
    try:
        for module in holding:
            vars(module)["share"] = share
        yield found
    finally:
        for module in holding:
            vars(module)["share"] = outright
        threads.set_threads(before)
        vars(threads)["cores"] = cores


def gain(solve: Callable[[], Any], count: int) -> tuple[float, float]:
    """How many times as fast so many threads may be at best, and the share of the work that none of them takes over."""
    with counted(count) as found:
        start = time.process_time()
        solve()
        whole = time.process_time() - start
    return whole / (whole - found.alone + found.together), 1 - found.alone / whole


def row(case: str, size: float) -> dict[str, Any]:
    """Medians of some repeats, plans and kernels made before."""
    timed = CASES[case].prepare(size)
    timed.solve()
    gains, serial = [], []
    for count in THREADS:
        found = []
        for _ in range(REPEATS + 1):  # the first makes plans for blocks
            if timed.restart is not None:
                timed.restart()
            found.append(gain(timed.solve, count))
        middle = sorted(found[1:])[REPEATS // 2]
        gains.append(middle[0])
        serial.append(middle[1])
    return {"case": case, "size": size, "serial": serial[0], "gains": gains}


def main() -> None:
    """All cases and sizes."""
    rows = []
    for case, sizes in SIZES.items():
        for size in sizes:
            rows.append(row(case, size))
            print(rows[-1], flush=True)
    keep(RESULT, rounded(rows))


if __name__ == "__main__":
    main()
