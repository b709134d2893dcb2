"""The approximate inverse of the kernel on the cells in contact: near neighbours by rows, long waves between them.

It knows the sparse inverse and the long waves' factor on given cells, and no contact. Where the cells fit one block of
`passes`, what conjugate gradients ask of it between two transforms is one compiled function, of the same passes in the
same order (`inner` calls it).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import gradients, long_waves, preconditioner
from bem.contact.long_waves import LongWavesOnCells
from bem.contact.preconditioner import SparseInverseOnCells
from bem.convolution import ScaledConvolution

FloatArray = NDArray[np.float64]


class Descent(NamedTuple):
    """What a preconditioned residual z says: z.r, z.(r - r_previous); how far the step known beforehand leaves the
    bounds, and max |r|."""

    full: float
    change: float
    outside: float
    largest: float


class Step(NamedTuple):
    """A step known beforehand: t = z + beta t, beta from z.(r - r_previous) over `last`; its length, the cap."""

    last: float
    length: float
    cap: float

    def beta(self, change: float) -> float:
        """Of the direction before, by the formula of Polak and Ribiere; none where `last` is infinite."""
        return max(0.0, change / self.last)


@dataclass(frozen=True)
class Inverse:
    """Rows of the near neighbours, the long waves (None on grids too small for them), and room for values."""

    near: SparseInverseOnCells
    far: LongWavesOnCells | None
    values: FloatArray

    def __call__(self, residual: FloatArray, out: FloatArray) -> float:
        """Write the inverse times a residual to `out`; returns its sum."""
        self.near.spread(residual, self.values)
        if self.far is not None:
            self.far.apply(self.values)
        return self.near.collect(self.values, out)

    def compiled(self) -> tuple[Any, ...]:
        """What `_descend` takes of it: the rows, and the long waves. The caller holds the lock of `convolution` while
        that runs, and counts what it made there."""
        own = (self.near.rows, self.near.seam, self.near.outside, self.values)
        if self.far is None:
            return own, None
        return own, self.far.compiled()

    @property
    def convolution(self) -> ScaledConvolution | None:
        """The long waves' own, whose transform's lock is to be held while a compiled loop makes it."""
        return None if self.far is None else self.far.smooth.convolution


@compiled
def _descend(own, far, state, way, balance, step):
    """The preconditioned residual, and where the step known beforehand leads, of cells that fit one block: `Descent`,
    and how many convolutions the long waves took.

    state : (p, r, r before). way : (z, written; t; p after the step, written). balance : as `face.Balance` has them,
    rise, share and room, that of none where the residual's mean is let be.
    """
    rows, seam, outside, values = own
    (pressure, residual, previous), (preconditioned, direction, out), (rise, share, shifted) = state, way, balance
    size, found, applications = values.size, np.zeros(2), 0
    if size == 0:  # no cells, no block of them to read
        return 0.0, 0.0, 0.0, 0.0, 0
    if shifted.size:
        gradients._weighed_free(residual, rise, 1 / share, shifted)
    given = shifted if shifted.size else residual
    preconditioner._spread(0, size, found, rows, given, values)
    preconditioner._spread_seam(seam, given, values)
    if far is not None:
        applications = long_waves._apply(values, far, long_waves._REDUCTION, long_waves._ITERATIONS)
    preconditioner._collect(0, size, found, rows, values, preconditioned, outside, size)
    total = found[0] + preconditioner._collect_seam(seam, values, preconditioned)
    gradients._turn(0, size, found, preconditioned, rise, share * total, residual, previous)
    full, change = found[0], found[1]
    turned = (preconditioned, direction, max(0.0, change / step.last))
    gradients._stride(0, size, found, pressure, turned, step.length, step.cap, residual, out)
    return full, change, found[0], found[1], applications
