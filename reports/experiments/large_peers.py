"""Other codes on grids of 2048 and 4096 cells a side: minutes to an hour a solve, so apart from `reports.benchmarks`.

    python -m reports.experiments.large_peers --cells 2048 4096 --peer tamaas aspher

As the contacts of `python -m reports.benchmarks --peers`: the same surface, one thread, one solve each, residuals by
one routine, and bem at the first tolerance whose pressure is at least as good. Processor times; how busy the machine
was is kept with each. Rows of other sizes and peers are kept. The result is stored in
`reports/results/large_peers.json`.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

from bem.benchmarks.record import new_run
from reports.benchmarks.history import present_commit
from reports.benchmarks.peers import SCRIPTS, compare_with_peers, environment
from reports.experiments.kept import found, keep, result_of

RESULT = result_of("large_peers")
HOUR = 3600.0


def main() -> None:
    """Each peer at each size; what there is so far is stored after each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, nargs="+", default=[2048, 4096])
    parser.add_argument("--peer", nargs="+", choices=list(SCRIPTS), default=list(SCRIPTS))
    parser.add_argument("--folder", type=Path, default=Path(".venv-peers"), help="environment of the peers")
    parser.add_argument("--hours", type=float, default=2.0, help="that one solve may take")
    given = parser.parse_args()
    python = environment(given.folder, print)
    rows: dict[tuple[str, int], Any] = {}
    if RESULT.is_file():
        rows = {(row["peer"], row["cells"]): row for row in found(RESULT.stem)}
    for cells in given.cells:
        for peer in given.peer:
            new: list[dict[str, Any]] = []
            failures: dict[str, str] = {}
            compare_with_peers(python, cells, 1, print, new, failures, (peer,), given.hours * HOUR)
            for row in new:
                told = {
                    "commit": present_commit(),
                    "date": new_run([]).date,
                    "load_average": round(os.getloadavg()[1], 1),
                }
                rows[peer, cells] = row | told
                keep(RESULT, [rows[key] for key in sorted(rows, key=lambda key: (key[1], key[0]))])
            print(
                *(f"{row['peer']} {row['cells']}: {row['ratio']:.1f} times" for row in new), failures or "", flush=True
            )


if __name__ == "__main__":
    main()
