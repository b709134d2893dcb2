"""What a checkpoint costs: bem's own format, and the same state as netCDF-4 groups beside it.

Why the format is bem's own: a state is many small arrays in a tree, of which netCDF-4 makes a group or a dataset each,
and it must be refused when a byte of it is wrong, which netCDF-4 does not do by itself. Measured at the sizes of the
case: netCDF-4 took 8 to 150 times as long to save, and files 1 to 9 % (many small arrays: 35 %) larger. Both are
replaced whole or not at all by `bem.results.atomic`. Verified in tests/benchmarks/test_campaign_cases.py.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bem.benchmarks.measure import Outcome, Timed
from bem.results.atomic import replacing
from bem.results.checkpoint import load_checkpoint, save_checkpoint


def checkpoint(films: float) -> Timed:
    """Save the state of a march of so many films on 501 nodes. The error is how many arrays read back are not those
    that were saved; `netcdf_s` and `netcdf_bytes` are those of the same state as netCDF-4."""
    rng = np.random.default_rng(1)
    names = ("position", "pressure", "thickness")
    state = {"films": [{name: rng.normal(size=501) for name in names} for _ in range(int(films))]}
    folder = Path(tempfile.mkdtemp())

    def solve() -> Path:
        save_checkpoint(folder / "state.bin", state)
        return folder / "state.bin"

    def judge(path: Path) -> Outcome:
        found = load_checkpoint(path) or {}
        pairs = zip(state["films"], found["films"], strict=True)
        wrong = sum(not np.array_equal(a[name], b[name]) for a, b in pairs for name in names)
        start = time.process_time()
        _save_netcdf(folder / "state.nc", state)
        seconds, size = time.process_time() - start, (folder / "state.nc").stat().st_size
        counts = {"bytes": float(path.stat().st_size), "netcdf_bytes": float(size)}
        return Outcome({"arrays_wrong": float(wrong)}, counts, {"netcdf_s": seconds})

    return Timed(solve, judge)


def _save_netcdf(path: Path, state: Mapping[str, Any]) -> None:
    """A tree of arrays and numbers as groups, variables and attributes."""
    import h5netcdf

    with replacing(path) as temporary, h5netcdf.File(temporary, "w") as file:
        _put(file, state)


def _put(group: Any, table: Mapping[str, Any]) -> None:
    for name, value in table.items():
        if isinstance(value, np.ndarray):
            dimensions = tuple(f"{name}_{axis}" for axis in range(value.ndim))
            group.dimensions.update(zip(dimensions, value.shape, strict=True))
            group.create_variable(name, dimensions, data=value)
        elif isinstance(value, list):
            _put(group.create_group(name), {str(number): item for number, item in enumerate(value)})
        else:
            _put(group.create_group(name), value)
