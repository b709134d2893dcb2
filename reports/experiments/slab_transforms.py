"""Whether transforms cut into slabs for processes gain on threads: one pair, forward and back, of a periodic grid.

    python -m reports.experiments.slab_transforms --size 2048 4096

A convolution of a large contact is such a pair. Compared, in turns so that what else the machine does falls on all
alike: scipy's transform and FFTW's with one thread and with two; this project's own passes (`bem`, the product between
included) with one and two; one and two processes with a slab of rows each over shared memory, scipy's transforms and
two transpositions (every process writes its part of the other's slab at once: the least that messages could do);
Dask's blocks on two threads; and mpi4py-fft, in an interpreter that has it, on one rank and two (a rank that waits
works). Processor time of all threads and processes together, the least of several: what two cores can do at best is
half of it, and on a busy machine it says more than what the clock does. `transposed_s` is the part of the slabs' work
that threads have no need of. The result is stored in `reports/results/slab_transforms.json`.
"""

from __future__ import annotations

import argparse
import json
import mmap
import multiprocessing
import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyfftw
import scipy.fft

from bem.threads import set_threads
from bem.transforms import transform_of
from bem.transforms.multipliers import Multiplier

RESULT = Path(__file__).resolve().parents[1] / "results" / "slab_transforms.json"
REPEATS = 5


def with_scipy(cells: int, workers: int) -> Callable[[], None]:
    """A pair of scipy's."""
    field = np.random.default_rng(1).random((cells, cells))

    def pair() -> None:
        scipy.fft.irfft2(scipy.fft.rfft2(field, workers=workers), field.shape, workers=workers, overwrite_x=True)

    return pair


def with_fftw(cells: int, threads: int) -> Callable[[], None]:
    """A pair of FFTW's, with measured plans."""
    field = pyfftw.empty_aligned((cells, cells), np.float64)
    spectrum = pyfftw.empty_aligned((cells, cells // 2 + 1), np.complex128)
    both = [
        pyfftw.FFTW(*arrays, axes=(0, 1), threads=threads, direction=way, flags=("FFTW_MEASURE",))
        for arrays, way in (((field, spectrum), "FFTW_FORWARD"), ((spectrum, field), "FFTW_BACKWARD"))
    ]
    field[:] = np.random.default_rng(1).random(field.shape)

    def pair() -> None:
        for plan in both:
            plan.execute()

    return pair


def with_bem(cells: int, threads: int) -> Callable[[], None]:
    """A convolution of the contact solver: the pair and the product between."""
    transform = transform_of((cells, cells), (cells, cells))
    field = transform.empty_field()
    field[:] = np.random.default_rng(1).random(field.shape)
    factor = Multiplier(np.ones((cells // 2 + 1, cells // 2 + 1)))

    def pair() -> None:
        set_threads(threads)
        transform.convolve(field, factor, field)

    return pair


def with_dask(cells: int, workers: int) -> Callable[[], None]:
    """A pair in Dask's blocks: rows, then columns after `rechunk`, and back."""
    import dask
    import dask.array as da

    field = np.random.default_rng(1).random((cells, cells))
    slab = cells // workers

    def pair() -> None:
        rows = da.fft.rfft(da.from_array(field, chunks=(slab, cells)), axis=1)
        columns = da.fft.fft(rows.rechunk((cells, -(-rows.shape[1] // workers))), axis=0)
        back = da.fft.ifft(columns, axis=0).rechunk((slab, rows.shape[1]))
        with dask.config.set(scheduler="threads", num_workers=workers):
            da.fft.irfft(back, n=cells, axis=1).compute()

    return pair


def shared(shape: tuple[int, ...], dtype: Any) -> np.ndarray:
    """An array in memory that forked processes have in common."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    return np.frombuffer(mmap.mmap(-1, size), dtype).reshape(shape)


class Slabs:
    """Processes with a slab of rows each; half-way array and field are shared."""

    def __init__(self, cells: int, processes: int) -> None:
        fork = multiprocessing.get_context("fork")
        self.cells, self.processes = cells, processes
        self.field = shared((cells, cells), np.float64)
        self.field[:] = np.random.default_rng(1).random((cells, cells))
        self.half = shared((cells // 2 + 1, cells), np.complex128)
        self.spent = shared((processes, 2), np.float64)
        self.barrier = fork.Barrier(processes + 1)
        self.workers = [fork.Process(target=self.work, args=(number,), daemon=True) for number in range(processes)]
        for worker in self.workers:
            worker.start()

    def work(self, number: int) -> None:
        """One process: its rows, its part of the transposed array, its columns, and back."""
        edges = np.linspace(0, self.cells, self.processes + 1).astype(int)
        rows = slice(edges[number], edges[number + 1])
        edges = np.linspace(0, self.half.shape[0], self.processes + 1).astype(int)
        columns = slice(edges[number], edges[number + 1])
        while True:
            self.barrier.wait()
            began = time.process_time()
            spectrum = scipy.fft.rfft(self.field[rows], axis=1)
            moved = time.process_time()
            self.half[:, rows] = spectrum.T
            away = time.process_time() - moved
            self.barrier.wait()
            own = scipy.fft.ifft(scipy.fft.fft(self.half[columns], axis=1), axis=1, overwrite_x=True)
            self.half[columns] = own
            self.barrier.wait()
            moved = time.process_time()
            spectrum[:] = self.half[:, rows].T
            away += time.process_time() - moved
            self.field[rows] = scipy.fft.irfft(spectrum, n=self.cells, axis=1)
            self.spent[number] = time.process_time() - began, away
            self.barrier.wait()

    def pair(self) -> None:
        """One pair by all."""
        for _ in range(4):
            self.barrier.wait()

    def end(self) -> None:
        """Stop the processes."""
        for worker in self.workers:
            worker.terminate()
            worker.join()


MPI = """
import sys, time
import numpy as np
from mpi4py import MPI
from mpi4py_fft import PFFT, newDistArray
cells, repeats = int(sys.argv[1]), int(sys.argv[2])
fft = PFFT(MPI.COMM_WORLD, (cells, cells), axes=(0, 1), dtype=float, grid=(-1,))
field = newDistArray(fft, False)
field[:] = np.random.default_rng(1).random(field.shape)
spectrum = newDistArray(fft, True)
best = 1e9
for _ in range(repeats):
    MPI.COMM_WORLD.Barrier()
    began = time.process_time()
    fft.forward(field, spectrum)
    fft.backward(spectrum, field)
    best = min(best, MPI.COMM_WORLD.allreduce(time.process_time() - began))
if MPI.COMM_WORLD.rank == 0:
    print(best)
"""


def with_mpi(cells: int, ranks: int, python: str) -> float:
    """Processor time [s] of a pair of mpi4py-fft, run by an interpreter that has it."""
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    command = ["mpirun", "--oversubscribe", "-n", str(ranks), python, "-c", MPI, str(cells), str(REPEATS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ | root, timeout=100)
    return float(done.stdout.split()[-1])


def measured(cells: int, python: str | None) -> dict[str, Any]:
    """All on one grid, in turns."""
    slabs = {count: Slabs(cells, count) for count in (1, 2)}  # forked before any thread starts
    ways: dict[str, Callable[[], None]] = {f"slabs_of_{count}": one.pair for count, one in slabs.items()}
    for threads in (1, 2):
        ways[f"scipy_{threads}"] = with_scipy(cells, threads)
        ways[f"fftw_{threads}"] = with_fftw(cells, threads)
        ways[f"bem_{threads}"] = with_bem(cells, threads)
    ways["dask_2"] = with_dask(cells, 2)
    least = dict.fromkeys(ways, np.inf)
    moved = dict.fromkeys(slabs, np.inf)
    for _ in range(REPEATS):
        for name, pair in ways.items():
            began = time.process_time()
            pair()
            spent = time.process_time() - began
            if isinstance(owner := getattr(pair, "__self__", None), Slabs):
                spent = float(owner.spent[:, 0].sum())
            least[name] = min(least[name], spent)
        for count, one in slabs.items():
            moved[count] = min(moved[count], float(one.spent[:, 1].sum()))
    for one in slabs.values():
        one.end()
    if python is not None:
        least |= {f"mpi4py_fft_{n}": with_mpi(cells, n, python) for n in (1, 2)}
    return {
        "processor_s": {name: float(f"{value:.3g}") for name, value in least.items()},
        "transposed_s": {str(count): float(f"{value:.3g}") for count, value in moved.items()},
    }


def main() -> None:
    """Measure, and store."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, nargs="+", default=[2048, 4096])
    parser.add_argument("--mpi-python", help="an interpreter with mpi4py-fft")
    given = parser.parse_args()
    rows: dict[str, Any] = {}
    for cells in given.size:
        rows[str(cells)] = measured(cells, given.mpi_python)
        RESULT.write_text(json.dumps(rows, indent=1) + "\n")
    print(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
