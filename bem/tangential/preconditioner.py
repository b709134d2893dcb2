"""Preconditioner of a Newton step: separate inverses along the main direction and across it.

Sticking cells move in both directions. Slipping cells move along the tangent of their discs only, where the curvature
of the disc adds to the stiffness. Along the main direction (of the force) the inverse covers the sticking cells; across
it the inverse covers all cells, with the curvature on the diagonal of the kernel. Each is the two-level inverse of the
normal contact (`bem.contact.coarse_correction`) for the kernel of that direction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact.coarse_correction import CoarseCorrection, Preconditioner, coarse_correction
from bem.contact.sparse_inverse import REACH, SparseInverse, sparse_inverse
from bem.convolution import DisplacementOperator
from bem.grid import FloatArray
from bem.tangential.operator import TangentialOperator


@dataclass(frozen=True)
class _DirectionalInverse:
    """Two-level inverse of the kernel of one direction, over `unit` [m/Pa]."""

    unit: float
    near: SparseInverse
    coarse: CoarseCorrection | None

    @classmethod
    def of(cls, operator: DisplacementOperator) -> _DirectionalInverse:
        """Prepare the inverse of an operator from `TangentialOperator.along`."""
        near_field = operator.near_field(2 * REACH)
        near = sparse_inverse(operator.grid.shape, operator.grid.periodic, near_field)
        return cls(operator.unit, near, coarse_correction(operator, near.near_response))

    def on(self, numbers: NDArray[np.int64], diagonal: FloatArray | None = None) -> Preconditioner:
        """Return the inverse on cells (flat indices), with a diagonal (n,) [m/Pa] added to the kernel."""
        near = self.near.on(numbers, None if diagonal is None else diagonal / self.unit)
        coarse = None if self.coarse is None else self.coarse.on(numbers, near.row_sums())
        return Preconditioner(near, coarse, np.empty(numbers.size))


@dataclass(frozen=True)
class SplitPreconditioner:
    """Inverses of the kernels along the main direction (2,) and across it, for all steps on a grid."""

    direction: FloatArray
    along: _DirectionalInverse
    across: _DirectionalInverse

    @classmethod
    def of(cls, operator: TangentialOperator, direction: FloatArray) -> SplitPreconditioner:
        """Prepare both inverses for a unit vector."""
        x, y = float(direction[0]), float(direction[1])
        along, across = (_DirectionalInverse.of(operator.along(unit)) for unit in ((x, y), (-y, x)))
        return cls(direction, along, across)

    def on(
        self, numbers: NDArray[np.int64], slips: NDArray[np.bool_], normal: FloatArray, curvature: FloatArray
    ) -> DirectionalPreconditioner:
        """Return the preconditioner on the cells in contact.

        Parameters
        ----------
        numbers : (n,), flat indices of the cells.
        slips : (n,), True for slipping cells.
        normal : (2, n), normals of the discs of slipping cells.
        curvature : (n,), stiffness by the curvature of the discs [m/Pa]; zero for sticking cells.
        """
        normal = np.where(slips, normal, self.direction[:, None])
        tangent = np.stack([-normal[1], normal[0]])
        tangent *= np.where(self.direction[0] * tangent[1] < self.direction[1] * tangent[0], -1.0, 1.0)
        sticks = ~slips
        along = self.along.on(numbers[sticks]) if sticks.any() else None
        across = self.across.on(numbers, curvature if slips.any() else None)
        return DirectionalPreconditioner(self, sticks, tangent, along, across)


@dataclass(frozen=True)
class DirectionalPreconditioner:
    """Preconditioner on given cells; symmetric, and positive in the tangent space.

    sticks : (n,). tangent : (2, n), of the discs; across the main direction for sticking cells.
    along : on the sticking cells, None without any. across : on all cells.
    """

    split: SplitPreconditioner
    sticks: NDArray[np.bool_]
    tangent: FloatArray
    along: Preconditioner | None
    across: Preconditioner

    def apply(self, values: FloatArray) -> FloatArray:
        """Return tractions (2, n) [Pa] for displacements (2, n) [m]."""
        direction, unit_along, unit_across = self.split.direction, self.split.along.unit, self.split.across.unit
        traction = np.empty(values.shape[1])
        self.across((self.tangent * values).sum(0), traction)
        out = np.asarray(self.tangent * (traction / unit_across))
        if self.along is not None:
            residual = (direction @ values)[self.sticks]
            traction = np.empty_like(residual)
            self.along(residual, traction)
            out[:, self.sticks] += direction[:, None] * (traction / unit_along)
        return out
