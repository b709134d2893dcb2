"""Ranks of an MPI run; needs the extra `bem-tribology[mpi]` or another mpi4py."""

from __future__ import annotations

import time
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.distributed.ranks import ExchangeCount, edges
from bem.errors import InputError

Array = NDArray[Any]

MISSING = (
    "--ranks: mpi4py cannot be used ({reason}); allowed: pip install 'bem-tribology[mpi]', which brings mpiexec too, "
    "or the mpi4py of this machine's MPI"
)

_POLL = 0.005
"""Seconds between two looks for a message from rank 0."""


class MpiRanks:
    """The processes of a communicator; see `bem.distributed.ranks.Ranks`.

    Parameters
    ----------
    communicator : of mpi4py.
    """

    def __init__(self, communicator: Any) -> None:
        self.communicator = communicator
        self.rank: int = communicator.Get_rank()
        self.size: int = communicator.Get_size()
        self.count = ExchangeCount()

    def allgather_rows(self, rows: Array, total: int) -> Array:
        """See `bem.distributed.ranks.Ranks`."""
        self.count.reductions += 1
        bounds, width = edges(total, self.size), rows.shape[1]
        out = np.empty((total, width))
        counts = [(last - first) * width for first, last in pairwise(bounds)]
        self.communicator.Allgatherv(np.ascontiguousarray(rows), [out, counts])
        return out

    def all_to_all(self, blocks: Array, sent: list[int], received: list[int]) -> Array:
        """See `bem.distributed.ranks.Ranks`."""
        self.count.transposes += 1
        out = np.empty(sum(received), blocks.dtype)
        self.communicator.Alltoallv([blocks, sent], [out, received])
        return out

    def broadcast(self, value: Any) -> Any:
        """See `bem.distributed.ranks.Ranks`."""
        return self.communicator.bcast(value, root=0)

    def scatter_rows(self, field: Array | None, rows: Array) -> None:
        """See `bem.distributed.ranks.Ranks`."""
        counts = self.communicator.gather(rows.size, root=0)
        whole = None if field is None else [np.ascontiguousarray(field), counts]
        self.communicator.Scatterv(whole, rows, root=0)

    def collect_rows(self, rows: Array, field: Array | None) -> None:
        """See `bem.distributed.ranks.Ranks`."""
        counts = self.communicator.gather(rows.size, root=0)
        self.communicator.Gatherv(np.ascontiguousarray(rows), None if field is None else [field, counts], root=0)

    def send_to_all(self, value: Any) -> None:
        """Send a value from rank 0 to the others, which wait for it in `next_from_first`."""
        for other in range(1, self.size):
            self.communicator.send(value, dest=other)

    def next_from_first(self) -> Any:
        """Return the next value of `send_to_all`; sleep meanwhile, as MPI itself waits with a busy core."""
        while not self.communicator.iprobe(source=0):
            time.sleep(_POLL)
        return self.communicator.recv(source=0)

    def library(self) -> str:
        """Return name and version of the MPI library."""
        from mpi4py import MPI

        name, version = MPI.get_vendor()
        return f"{name} {'.'.join(map(str, version))}"

    def abort(self, code: int) -> None:
        """End the processes of all ranks."""
        self.communicator.Abort(code)


def world() -> MpiRanks:
    """Return the ranks that `mpiexec` started; one rank without it.

    Raises
    ------
    InputError : mpi4py or its library is missing.
    """
    try:
        from mpi4py import MPI
    except (ImportError, RuntimeError) as error:
        raise InputError(MISSING.format(reason=str(error).splitlines()[0])) from None
    return MpiRanks(MPI.COMM_WORLD)
