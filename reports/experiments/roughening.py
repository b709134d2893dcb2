"""How rough a surface ends that loses pieces deeper than its roughness, over the cell.

    python -m reports.experiments.roughening

The surfaces of `running-in-stribeck`, smooth down to 4 um on the disc and 5 um on the cylinder and drawn once for all
grids, after 40 cycles at 0.01 m/s. The first cycle digs the same holes on any cell; on finer ones later pieces are
smaller, and Sq ends lower, but nowhere below where it began. The check `rougher_by_its_own_pieces` says so of a run.
The result is stored in `reports/results/roughening.json`.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from bem.runs import run_scene
from reports.experiments.kept import keep, result_of, rounded

CELLS = (96, 192, 384)
LENGTH = 96.0  # um


def row(cells: int) -> dict[str, Any]:
    """The loop on so many cells a side."""
    settings = [
        "upper.surface.cutoff_wavelength=5 um",
        "lower.surface.correlation_length=4 um",
        f"lower.surface.drawn_on={min(CELLS)}",
        f"grid.shape={cells}",
        f"grid.spacing={LENGTH / cells} um",
        'speeds.values=["0.01 m/s"]',
        "repetitions=1",
        "cycles.count=40",
        "cycles.settled=20",
    ]
    with tempfile.TemporaryDirectory() as folder:
        result = run_scene("running-in-stribeck", Path(folder) / "run", settings=settings, figures=False)
        sq = result.dataset["rms_height_over_cycles"].values.ravel()
    told = result.summary
    return {
        "cell_um": LENGTH / cells,
        "Sq_initial_nm": told["Sq_initial_nm"][0],
        "Sq_after_first_cycle_nm": 1e9 * float(sq[0]),
        "Sq_final_nm": told["Sq_final_nm"][0],
        "volume_mean_radius_nm": told["volume_mean_radius_nm"][0],
    }


def main() -> None:
    """Run, print, store."""
    rows = [row(cells) for cells in CELLS]
    for one in rows:
        print(one)
    keep(result_of("roughening"), rounded(rows))


if __name__ == "__main__":
    main()
