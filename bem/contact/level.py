"""One grid of a contact: its operator, gap and buffers, the pressure on it, and what a solution on it is.

Pressures and gaps are flat and in the solver's units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes
from bem.contact.inverse import Inverse
from bem.contact.judging import NOTHING, Survey, find_violations, mark, separations, survey
from bem.contact.long_waves import LongWaves, long_waves
from bem.contact.preconditioner import SparseInverse, SparseInverseOnCells, sparse_inverse
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Indices = NDArray[np.int64]

_RESOLUTION = 4e-16
"""Violations below this share of the lengths they are differences of are round-off."""

_FLAT = 1e-6
"""A gap whose roughness is below this times the displacement is called flat; the residual is then of the latter."""

_FLAT_RESOLUTION = 1e-12
"""Share of the displacement that a flat gap is closed to, unless more is asked for: near what transforms can. Rounds
that went after the roughness itself, at 1e-7 of the displacement, took 460 convolutions in place of some twenty; those
that went after 1e-13 took over 400 on many grids of 80 to 384 cells, which ended at 1e-13 to 7e-13."""


def is_flat(roughness: float, reach: float) -> bool:
    """Whether a gap is flat beside displacements [m] that reach so far."""
    return roughness <= _FLAT * reach


@dataclass
class Effort:
    """Iterations of conjugate gradients so far, over all levels, and their limit."""

    limit: int
    iterations: int = 0

    @property
    def left(self) -> int:
        """Iterations that may still be made."""
        return self.limit - self.iterations


@dataclass(frozen=True)
class Tolerance:
    """Largest violation allowed: a length, and a share of the displacement where that is less. On coarse grids a share
    of the violation that the rounds begin with, where that is less than both and not below `least`."""

    length: float
    relative: float
    of_first: float = math.inf
    least: float = 0.0

    @staticmethod
    def resolves(violation: float, reach: float) -> bool:
        """Whether a violation is near what transforms resolve of displacements that reach so far."""
        return violation <= _FLAT_RESOLUTION * reach

    def of(self, approach: float, reach: float, first: float) -> float:
        """The length that holds where displacements reach so far and rounds began with a violation; never below what
        double precision can resolve."""
        goal = min(self.length, self.relative * reach)
        if math.isfinite(self.of_first):
            goal = min(goal, max(self.of_first * first, self.least))
        if is_flat(self.length, self.relative * reach):
            goal = min(self.relative, _FLAT_RESOLUTION) * reach
        return max(goal, _RESOLUTION * (abs(approach) + reach))


@dataclass(frozen=True)
class LevelResult:
    """Where a level ended: scaled pressure and displacement (flat), approach, largest violation, and how.

    `fresh` : the displacement is the operator applied to this very pressure, not put together from others.
    `resolved` : not converged, and what is missed is round-off of the transforms: no use in trying another way.
    `least_mean_gap` : where less was asked for, a bound below which no mean gap exists.
    `least_found` : where less was asked for and neither found nor proved not to exist, the least that was found.
    """

    pressure: FloatArray
    displacement: FloatArray
    approach: float
    violation: float
    converged: bool = False
    fresh: bool = True
    resolved: bool = False
    least_mean_gap: float | None = None
    least_found: float | None = None


@dataclass(frozen=True)
class Tuning:
    """Numbers that trade work between rounds and iterations; measured on self-affine surfaces of 256 to 2048 cells."""

    reduction: float = 1e-4
    least_reduction: float = 0.3
    clipping: float = 0.3
    iterations_per_round: int = 80
    final: float = 0.8
    squared_radius: int = 5
    rounds: int = 100
    patience: int = 8
    stall: int = 60


@dataclass
class Iterate:
    """A feasible pressure: the cells between the bounds, their values, and the cells at the cap."""

    cells: Indices
    values: FloatArray
    capped: Indices


Begin = FloatArray | Iterate | None
"""What a level begins with: a pressure everywhere, or without its zeros; None for none."""


@dataclass(slots=True)
class Stride:
    """Steps along the preconditioned residual that cost no convolution: their length, and whether they still help."""

    length: float = 1.0
    trusted: bool = True
    taken: bool = False
    before: float = math.inf

    def judge(self, violation: float) -> None:
        """Once a round: give them up where one did not halve the violation."""
        if self.taken and violation > 0.5 * self.before:
            self.trusted = False
        self.taken, self.before = False, violation


def _quick_field(field: FloatArray) -> NDArray[np.float32]:
    """A field of single precision in the memory of one of double."""
    return field.reshape(-1).view(np.float32).reshape(2, *field.shape)[0]


class Level:
    """Operator, buffers and gap of one grid."""

    def __init__(self, operator: DisplacementOperator, gap: FloatArray, cap: float, tuning: Tuning) -> None:
        self.operator = operator
        self.exact = operator.scaled()
        self.quick = operator.scaled(np.float32)
        self.gap = gap
        self.cap = cap
        self.tuning = tuning
        self.state = np.zeros(gap.size, np.uint8)
        self.displacement = self.exact.transform.empty_field()
        self.before = self.exact.transform.empty_field()
        names = ("displacement", "before")
        self.flat: dict[str, NDArray[Any]] = {name: getattr(self, name).reshape(-1) for name in names}
        # what the quick operator gives is where the displacement before is: nobody asks for that between the end of one
        # round and the beginning of the next
        self.quick_field, self._other_field = _quick_field(self.before), _quick_field(self.displacement)
        self.kept = False
        self.self_response = float(operator.near_field(0)[0, 0])
        self.stride = Stride()
        self.rise: tuple[Indices, FloatArray, float] | None = None
        self.sparse: SparseInverse | None = None
        self.near: tuple[Indices, SparseInverseOnCells] | None = None
        self.smooth: LongWaves | None = None

    @property
    def largest_eigenvalue(self) -> float:
        """A bound on the eigenvalues of the symmetric part."""
        real = self.exact.multiplier.real
        assert real is not None
        return float(np.abs(real).max())

    def outside_cap(self, field: NDArray[Any], capped: Indices) -> float:
        """Mean of a field (flat) over the cells that are not at the cap."""
        total = float(field.sum(dtype=np.float64) - field[capped].sum(dtype=np.float64))
        return total / max(1, field.size - capped.size)

    def follows(self, iterate: Iterate) -> float:
        """By how much the mean displacement outside the cap rises with the sum of pressures, as in the buffer."""
        force = float(iterate.values.sum())
        if iterate.capped.size:
            force += self.cap * iterate.capped.size
        return self.outside_cap(self.flat["displacement"], iterate.capped) / force if force > 0 else 0.0

    def displace(self, iterate: Iterate) -> None:
        """Write the displacement of a pressure into the buffer."""
        if iterate.capped.size == 0:
            self.exact.apply_to_cells(iterate.cells, iterate.values, self.displacement)
            return
        passes.place(self.flat["displacement"], iterate.cells, iterate.values, iterate.capped, self.cap)
        self.exact.apply(self.displacement, self.displacement)

    def keep(self) -> None:
        """Make the displacement the one before, once a round; the next takes the other's buffer."""
        if self.kept:
            return
        self.kept = True
        self.displacement, self.before = self.before, self.displacement
        self.flat["displacement"], self.flat["before"] = self.flat["before"], self.flat["displacement"]
        self.quick_field, self._other_field = self._other_field, self.quick_field

    def survey(self, iterate: Iterate, other: Iterate | None = None) -> Survey:
        """Of a pressure with its displacement in the buffer, and the work of another one there."""
        before = NOTHING if other is None else (other.cells, other.values, other.capped)
        pressure = iterate.cells, iterate.values, iterate.capped
        return survey(self.flat["displacement"], self.gap, pressure, self.cap, before)

    def separations(self, iterate: Iterate) -> tuple[float, float]:
        """Largest gap + displacement of cells with pressure, smallest of cells that are not at the cap."""
        mark(self.state, iterate.cells, iterate.capped)
        return separations(self.flat["displacement"], self.gap, self.state)

    def violations(self, iterate: Iterate, approach: float) -> tuple[NDArray[np.int32], float]:
        """Cells that should not have the state they have, and by how much at most; all states are noted."""
        pressure = iterate.cells, iterate.values, iterate.capped
        return find_violations(self.flat["displacement"], self.gap, self.state, pressure, approach)

    def rows_of_inverse(self) -> SparseInverse:
        """The preconditioner's near part on this grid; the long waves are made with it."""
        if self.sparse is None:
            reach = 2 * math.isqrt(self.tuning.squared_radius)
            self.sparse = sparse_inverse(
                self.operator.grid.shape,
                self.operator.grid.periodic,
                self.operator.near_field(reach),
                self.tuning.squared_radius,
            )
            self.smooth = long_waves(self.operator, self.sparse.near)
        return self.sparse

    def preconditioner(self, cells: Indices) -> Inverse:
        """Approximate inverse of the kernel on the cells."""
        sparse = self.rows_of_inverse()
        self.near = None  # the old rows go before the new ones come
        near = sparse.on(cells)
        self.near = cells, near
        far = None if self.smooth is None else self.smooth.on(cells, near.row_sums())
        return Inverse(near, far, np.empty(cells.size))

    def near_on(self, cells: Indices) -> SparseInverseOnCells | None:
        """The preconditioner's near part; None where the last one was for other cells."""
        return self.near[1] if self.near is not None and self.near[0] is cells else None

    def begin_round(self, iterate: Iterate, *, keep: bool) -> None:
        """Displace, with the last displacement kept as the one before if so asked."""
        if keep:
            self.keep()
        self.kept = False
        self.displace(iterate)

    def handed_over(self, iterate: Iterate) -> tuple[FloatArray, FloatArray]:
        """A pressure everywhere and the displacement in the buffer: the level is done with its buffers."""
        pressure = self.flat["before"]
        passes.place(pressure, iterate.cells, iterate.values, iterate.capped, self.cap)
        return pressure, self.flat["displacement"]
