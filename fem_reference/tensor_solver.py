"""Conjugate gradients for elasticity on a block of graded hexahedra, preconditioned by fast diagonalisation.

Coupling between the three displacement components aside, the stiffness of a block, layered in depth or not, on a grid
that is a product of three axes is a sum of Kronecker products of one-dimensional stiffness and mass matrices (on any
grading, of any degree), those in depth weighted with the shear modulus; the eigenvectors of each axis diagonalise it.
As a preconditioner for the assembled matrix it needs a number of iterations that depends on Poisson's ratios only:
neither on the grading, the degree nor the stiffness of a layer, where multigrid and incomplete factorisations suffer
from all three.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

Array = NDArray[np.float64]


def axis_matrices(nodes: Array, degree: int, weights: Array | None = None) -> tuple[Array, Array]:
    """Stiffness and mass matrix of one axis in the Lagrange basis of its nodes (sorted, `degree` per cell plus one).

    weights : factor of either by cell.
    """
    cells = (nodes.size - 1) // degree
    factors = np.ones(cells) if weights is None else weights
    stiffness, mass = np.zeros((nodes.size, nodes.size)), np.zeros((nodes.size, nodes.size))
    points, gauss = np.polynomial.legendre.leggauss(degree + 1)
    for cell in range(cells):
        span = slice(cell * degree, cell * degree + degree + 1)
        local = nodes[span]
        half = 0.5 * (local[-1] - local[0])
        reference = (local - local[0]) / half - 1
        # columns: coefficients of the Lagrange polynomials
        coefficients = np.linalg.inv(np.polynomial.legendre.legvander(reference, degree))
        values = np.polynomial.legendre.legvander(points, degree) @ coefficients
        slopes = np.polynomial.legendre.legval(points, np.polynomial.legendre.legder(coefficients)).T / half
        measure = (factors[cell] * half * gauss)[:, None]
        mass[span, span] += values.T @ (values * measure)
        stiffness[span, span] += slopes.T @ (slopes * measure)
    return stiffness, mass


def _modes(stiffness: Array, mass: Array, free: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Eigenvalues and mass-orthonormal eigenvectors on the free nodes; rows of held nodes are zero."""
    factor = np.linalg.inv(np.linalg.cholesky(mass[np.ix_(free, free)]))
    values, vectors = np.linalg.eigh(factor @ stiffness[np.ix_(free, free)] @ factor.T)
    full = np.zeros((free.size, values.size))
    full[free] = factor.T @ vectors
    return values, full


class FastDiagonalisation:
    """PETSc preconditioner: see the module.

    Parameters
    ----------
    coordinates : (n, 3) of the nodes, which form a product grid.
    degree : of the elements.
    held : (n, 3) which components are held; whole planes of the grid only.
    shear : shear modulus at depths z (n,) -> (n,), constant in each cell.
    ratio : (lambda + 2 mu) / mu, of the substrate.
    """

    def __init__(
        self,
        coordinates: Array,
        degree: int,
        held: NDArray[np.bool_],
        shear: Callable[[Array], Array],
        ratio: float,
    ) -> None:
        self.place = []
        axes = []
        for d in range(3):
            # nodes of one plane agree to round-off; neighbouring planes are far further apart
            order = np.argsort(coordinates[:, d], kind="stable")
            rising = coordinates[order, d]
            new = np.concatenate([[True], np.diff(rising) > 1e-9 * max(1.0, rising[-1])])
            index = np.empty(order.size, dtype=np.int64)
            index[order] = np.cumsum(new) - 1
            self.place.append(index)
            axes.append(rising[new])
        self.shape = tuple(axis.size for axis in axes)
        if np.prod(self.shape) != len(coordinates):
            raise ValueError("the nodes are no product grid")
        self.held = held
        corners = axes[2][::degree]
        weights = shear(0.5 * (corners[1:] + corners[:-1]))
        matrices = [
            axis_matrices(axes[0], degree),
            axis_matrices(axes[1], degree),
            axis_matrices(axes[2], degree, weights),
        ]
        self.vectors, self.diagonal = [], []
        for component in range(3):
            lattice = np.zeros(self.shape, dtype=bool)
            lattice[tuple(self.place)] = held[:, component]
            modes = []
            for d in range(3):
                others = tuple(k for k in range(3) if k != d)
                modes.append(_modes(*matrices[d], np.asarray(~lattice.all(axis=others))))
            stiff = [ratio if d == component else 1.0 for d in range(3)]
            x, y, z = (stiff[d] * modes[d][0] for d in range(3))
            self.diagonal.append(x[:, None, None] + y[:, None] + z)
            self.vectors.append([mode[1] for mode in modes])

    def apply(self, preconditioner: Any, right: Any, result: Any) -> None:
        """result = approximate inverse of the stiffness times right; the identity on held entries."""
        residual = right.getArray(readonly=True).reshape(-1, 3)
        out = np.where(self.held, residual, 0.0)
        for component in range(3):
            lattice = np.zeros(self.shape)
            lattice[tuple(self.place)] = np.where(self.held[:, component], 0.0, residual[:, component])
            x, y, z = self.vectors[component]
            modal = np.einsum("ijk,ia->ajk", lattice, x, optimize=True)
            modal = np.einsum("ajk,jb->abk", modal, y, optimize=True) @ z
            modal /= self.diagonal[component]
            lattice = np.einsum("abc,ia->ibc", modal, x, optimize=True)
            lattice = np.einsum("ibc,jb->ijc", lattice, y, optimize=True) @ z.T
            out[:, component] += lattice[tuple(self.place)]
        result.setArray(out.ravel())


def solve_block(matrix: Any, right: Any, solution: Any, preconditioner: FastDiagonalisation, tolerance: float) -> int:
    """Solve by preconditioned conjugate gradients; returns the iterations, RuntimeError when they do not converge."""
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("cg")
    solver.setTolerances(rtol=tolerance, atol=0.0, max_it=500)
    solver.setNormType(PETSc.KSP.NormType.NATURAL)
    chosen = solver.getPC()
    chosen.setType("python")
    chosen.setPythonContext(preconditioner)
    solver.setUp()
    solver.solve(right, solution)
    reason, iterations = solver.getConvergedReason(), solver.getIterationNumber()
    # by hand, both: petsc4py keeps what python merely forgets
    chosen.destroy()
    solver.destroy()
    if reason < 0:
        raise RuntimeError(f"conjugate gradients failed after {iterations} iterations: PETSc's reason {reason}")
    return int(iterations)


def held_nodes(count: int, dofs: Sequence[int] | NDArray[np.int64]) -> NDArray[np.bool_]:
    """(count, 3) mask from a list of scalar degrees of freedom."""
    mask = np.zeros(3 * count, dtype=bool)
    mask[np.asarray(dofs)] = True
    return mask.reshape(count, 3)
