"""Maps that ranks read and write by rows."""

import h5py
import numpy as np
import pytest
from thread_ranks import on_ranks

from bem import Grid
from bem.distributed import read_rows, write_rows
from bem.distributed.ranks import own_slice
from bem.errors import InputError, ResultsError

GRID = Grid((7, 5), (1e-6, 1e-6))
MAP = np.random.default_rng(2).random(GRID.shape)


def test_rows_of_all_ranks_are_the_map(tmp_path):
    """From .npy in single precision, from a variable of HDF5, and back from what was written."""
    np.save(tmp_path / "single.npy", MAP.astype(np.float32))
    with h5py.File(tmp_path / "map.h5", "w") as file:
        file["height"] = MAP

    def work(ranks):
        single = read_rows(tmp_path / "single.npy", GRID, ranks)
        rows = read_rows(tmp_path / "map.h5", GRID, ranks, variable="height")
        write_rows(tmp_path / "written.npy", rows, GRID, ranks)
        return single

    single = np.concatenate(on_ranks(3, work))
    assert single.dtype == np.float64
    assert np.array_equal(single, MAP.astype(np.float32))
    assert np.array_equal(np.load(tmp_path / "written.npy"), MAP)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.h5", "single.npy", "written.npy"]


def test_what_cannot_be_read_is_raised_on_all_ranks(tmp_path):
    """No file, another shape, complex numbers."""
    np.save(tmp_path / "shape.npy", MAP[:3])
    np.save(tmp_path / "complex.npy", MAP * 1j)

    def work(ranks):
        for name, words in (("none", "No such file"), ("shape", "grid's shape"), ("complex", "real numbers")):
            with pytest.raises(InputError, match=words):
                read_rows(tmp_path / f"{name}.npy", GRID, ranks)

    on_ranks(2, work)


def test_a_failed_rank_leaves_the_older_map(tmp_path):
    """Rank 1 has rows of another shape; nothing is half written."""
    np.save(tmp_path / "map.npy", MAP)

    def work(ranks):
        own = own_slice(7, ranks)
        rows = MAP[own] + 1 if ranks.rank == 0 else np.zeros((2, 3))
        with pytest.raises(ResultsError, match="cannot be written"):
            write_rows(tmp_path / "map.npy", rows, GRID, ranks)

    on_ranks(2, work)
    assert np.array_equal(np.load(tmp_path / "map.npy"), MAP)
    assert [path.name for path in tmp_path.iterdir()] == ["map.npy"]

    def nowhere(ranks):
        with pytest.raises(ResultsError, match="cannot be written"):
            write_rows(tmp_path / "no" / "map.npy", MAP[own_slice(7, ranks)], GRID, ranks)

    on_ranks(2, nowhere)
