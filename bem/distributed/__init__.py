"""One dry contact on several processes (MPI), each with its rows of the grid.

`solve_slabs` solves a contact whose gap every rank holds by rows (`ranks`); `session` lets rank 0 run a scene while the
others help. Steps of a solution:

1. Each rank computes the spectrum of the bodies on its own columns, wavenumbers along y (`spectra`).
2. Rank 0 solves the contact on at most 512 x 512 sampled cells by the serial solver; every rank interpolates its rows
   of that pressure (`coarse_start`).
3. Preconditioned conjugate gradients within the bounds find the pressure, and secant steps the approach of a load
   (`bounded_cg`). A convolution transforms own rows along y, transposes rows to columns by one all-to-all exchange,
   takes own columns through the spectrum, and goes back in the same way (`convolution`, `transpose`).
4. Displacement, violations and load are computed again from the pressure (`solve`).

`maps` reads and writes own rows of maps on a disk that all ranks see.

Sums are gathered by rows and added in their order on every rank, and each transform is of one row or one column: all
numbers of ranks give the same bits on one kind of machine. The serial solver gives the same contact to the tolerance.

It takes a load or an approach, elastic bodies or a hardness, free and periodic axes, and any bodies whose kernel is a
spectrum or a table: half-spaces, layers, crystals, surfaces under tension. Friction in the gap, a mean gap, adhesion
and time are for one process.

The serial solver takes fewer convolutions (`bem.contact`: sparse preconditioner, single precision, nested grids). This
one keeps to what needs no neighbours' rows.

Knows contacts, operators and transforms, no scene. Verified in tests/distributed.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.distributed.maps import read_rows, write_rows
    from bem.distributed.mpi import MpiRanks, world
    from bem.distributed.ranks import OneRank, Ranks, own_slice
    from bem.distributed.solve import SlabSolution, solve_slabs

__all__ = [
    "MpiRanks",
    "OneRank",
    "Ranks",
    "SlabSolution",
    "own_slice",
    "read_rows",
    "solve_slabs",
    "world",
    "write_rows",
]

__getattr__ = loader(
    __name__,
    {
        "maps": ["read_rows", "write_rows"],
        "mpi": ["MpiRanks", "world"],
        "ranks": ["OneRank", "Ranks", "own_slice"],
        "solve": ["SlabSolution", "solve_slabs"],
    },
)
