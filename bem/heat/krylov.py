"""GMRES with a preconditioner on the right: Y. Saad, Iterative Methods for Sparse Linear Systems (2003), algorithm 9.5.

The same bits in every process: no threads of a BLAS library.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Map = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class LinearSolution:
    """The solution, how many times the matrix was applied, and the 2-norm of the recomputed residual."""

    values: FloatArray
    applications: int
    residual: float


def norm(vector: FloatArray) -> float:
    """2-norm."""
    return float(np.sqrt(np.einsum("i,i->", vector, vector)))


def gmres(matrix: Map, right: FloatArray, inverse: Map, start: FloatArray, goal: float, limit: int) -> LinearSolution:
    """Solve matrix(x) = right, all of shape (n,).

    Parameters
    ----------
    matrix, right : the system.
    inverse : approximate inverse of the matrix.
    start : first guess.
    goal : of the residual's 2-norm.
    limit : applications of the matrix; it also ends where a restart gains nothing (round-off).
    """
    values = start.copy()
    residual = right - matrix(values)
    size, applications = norm(residual), 1
    while size > goal and applications < limit:
        change, used = _cycle(matrix, residual, inverse, goal, min(40, limit - applications))
        values = values + change
        residual = right - matrix(values)
        applications += used + 1
        before, size = size, norm(residual)
        if size > 0.5 * before:
            break
    return LinearSolution(values, applications, size)


def _cycle(matrix: Map, residual: FloatArray, inverse: Map, goal: float, most: int) -> tuple[FloatArray, int]:
    """One restart: the change of the solution, and how many applications it took."""
    size = norm(residual)
    basis, images = [residual / size], []
    hessenberg = np.zeros((most + 1, most))
    right = np.zeros(most + 1)
    right[0] = size
    for step in range(most):
        images.append(inverse(basis[step]))
        vector = matrix(images[step])
        for row, other in enumerate(basis):
            hessenberg[row, step] = np.einsum("i,i->", other, vector)
            vector = vector - hessenberg[row, step] * other
        hessenberg[step + 1, step] = norm(vector)
        part = hessenberg[: step + 2, : step + 1]
        weights = np.linalg.lstsq(part, right[: step + 2], rcond=None)[0]
        left = norm(right[: step + 2] - np.einsum("ij,j->i", part, weights))
        if left <= 0.5 * goal or step + 1 == most or hessenberg[step + 1, step] <= 1e-15 * size:
            return sum((w * image for w, image in zip(weights, images, strict=True)), np.zeros_like(residual)), step + 1
        basis.append(vector / hessenberg[step + 1, step])
    raise AssertionError("unreachable: a cycle has at least one step")
