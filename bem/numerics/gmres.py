"""GMRES with a preconditioner on the right: Y. Saad, Iterative Methods for Sparse Linear Systems (2003), algorithm 9.5.

Inner products are taken with einsum, without threads of a BLAS library, so every process gets the same bits. Verified
in tests/heat and tests/lubrication, whose solutions it gives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Map = Callable[[FloatArray], FloatArray]

_RESTART = 40
"""Dimension of the Krylov space at which a cycle ends."""


@dataclass(frozen=True)
class LinearSolution:
    """Solution of a linear system.

    Attributes
    ----------
    values : (n,).
    applications : number of applications of the matrix.
    residual : 2-norm of the residual, recomputed from `values`.
    """

    values: FloatArray
    applications: int
    residual: float


def norm(vector: FloatArray) -> float:
    """Return the 2-norm of a vector (n,)."""
    return float(np.sqrt(np.einsum("i,i->", vector, vector)))


def gmres(
    matrix: Map, right: FloatArray, preconditioner: Map, start: FloatArray, goal: float, limit: int
) -> LinearSolution:
    """Solve matrix(x) = right by restarted GMRES.

    Parameters
    ----------
    matrix : linear map (n,) -> (n,).
    right : right-hand side (n,).
    preconditioner : approximate inverse of the matrix.
    start : initial guess (n,).
    goal : bound on the 2-norm of the residual.
    limit : largest number of applications of the matrix.

    Returns
    -------
    LinearSolution : its residual exceeds `goal` at the limit, or where a restart does not halve it (round-off).
    """
    values = start.copy()
    residual = right - matrix(values)
    size, applications = norm(residual), 1
    while size > goal and applications < limit:
        change, used = _cycle(matrix, residual, preconditioner, goal, min(_RESTART, limit - applications))
        values = values + change
        residual = right - matrix(values)
        applications += used + 1
        before, size = size, norm(residual)
        if size > 0.5 * before:
            break
    return LinearSolution(values, applications, size)


def _cycle(
    matrix: Map, residual: FloatArray, preconditioner: Map, goal: float, dimension: int
) -> tuple[FloatArray, int]:
    """Return the change of the solution by one cycle, and the number of applications of the matrix."""
    size = norm(residual)
    basis, images = [residual / size], []
    hessenberg = np.zeros((dimension + 1, dimension))
    right = np.zeros(dimension + 1)
    right[0] = size
    for step in range(dimension):
        images.append(preconditioner(basis[step]))
        vector = matrix(images[step])
        for row, other in enumerate(basis):
            hessenberg[row, step] = np.einsum("i,i->", other, vector)
            vector = vector - hessenberg[row, step] * other
        hessenberg[step + 1, step] = norm(vector)
        part = hessenberg[: step + 2, : step + 1]
        weights = np.linalg.lstsq(part, right[: step + 2], rcond=None)[0]
        left = norm(right[: step + 2] - np.einsum("ij,j->i", part, weights))
        if left <= 0.5 * goal or step + 1 == dimension or hessenberg[step + 1, step] <= 1e-15 * size:
            return sum((w * image for w, image in zip(weights, images, strict=True)), np.zeros_like(residual)), step + 1
        basis.append(vector / hessenberg[step + 1, step])
    raise AssertionError("unreachable: a cycle has at least one step")
