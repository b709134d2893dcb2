"""Maps on a disk that all ranks see: own rows of a map are read and written, never the whole map.

A `.npy` file is mapped into memory; of a netCDF or HDF5 file a slice is read. A written map is a `.npy` file, whole or
not there at all: ranks write to a file beside it, which rank 0 renames once all have done so.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bem.distributed.ranks import Ranks, computed_on_first, own_slice
from bem.errors import InputError, ResultsError
from bem.grid import Grid

FloatArray = NDArray[np.float64]


def read_rows(path: str | os.PathLike[str], grid: Grid, ranks: Ranks, *, variable: str = "") -> FloatArray:
    """Return the own rows of a map (nx, ny) as float64; collective.

    path : .npy, or netCDF or HDF5 with the name of a variable.

    Raises
    ------
    InputError : a file that cannot be read, another shape than the grid's, no numbers; on all ranks.
    """
    rows: FloatArray | None = None
    failure = ""
    try:
        rows = _read(Path(path), grid.shape, own_slice(grid.shape[0], ranks), variable)
    except (OSError, ValueError, KeyError) as error:
        failure = str(error)
    _raise_together(ranks, failure, InputError, f"{path}: cannot be read")
    assert rows is not None
    return rows


def _read(path: Path, shape: tuple[int, int], own: slice, variable: str) -> FloatArray:
    """Return own rows of a file's map; a map of another shape or without numbers is a ValueError."""
    if variable:
        import h5py

        with h5py.File(path) as file:
            found = file[variable]
            _check(found, shape)
            return np.array(found[own], np.float64)
    mapped = np.load(path, mmap_mode="r")
    _check(mapped, shape)
    return np.array(mapped[own], np.float64)


def _check(found: NDArray, shape: tuple[int, int]) -> None:
    """Refuse a map of another shape, or without real numbers (ValueError)."""
    if tuple(found.shape) != shape or found.dtype.kind not in "fiu":
        raise ValueError(
            f"{found.dtype} of shape {tuple(found.shape)}; allowed: real numbers of the grid's shape {shape}"
        )


def write_rows(path: str | os.PathLike[str], rows: FloatArray, grid: Grid, ranks: Ranks) -> None:
    """Write a map (nx, ny) of which every rank has its rows to a `.npy` file; collective.

    Raises
    ------
    ResultsError : it cannot be written; on all ranks. A file that was there before stays as it was.
    """
    target = Path(path)
    part = target.with_name(target.name + ".part")
    failure = ""

    def create() -> None:
        try:
            np.lib.format.open_memmap(part, "w+", np.float64, grid.shape)
        except OSError as error:
            raise ResultsError(f"{target}: cannot be written ({error})") from None

    computed_on_first(ranks, create)
    try:
        whole = np.lib.format.open_memmap(part, "r+")
        whole[own_slice(grid.shape[0], ranks)] = rows
        whole.flush()
        del whole
    except (OSError, ValueError) as error:
        failure = str(error)
    try:
        _raise_together(ranks, failure, ResultsError, f"{target}: cannot be written")
    except ResultsError:
        if ranks.rank == 0:
            part.unlink(missing_ok=True)
        raise
    computed_on_first(ranks, lambda: os.replace(part, target))


def _raise_together(ranks: Ranks, failure: str, kind: type[InputError] | type[ResultsError], what: str) -> None:
    """Raise an error on all ranks if one of them failed; collective.

    failure : words of the failure of this rank, empty without one; other ranks give its number.
    """
    failed = ranks.allgather_rows(np.full((1, 1), float(bool(failure))), ranks.size)
    if failed.any():
        raise kind(f"{what} ({failure or f'by rank {int(np.argmax(failed))}'})")
