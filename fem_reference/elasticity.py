"""Linear elasticity on graded grids: strains, materials, assembly, direct solution and evaluation, for every linear
problem of the reference.

A *kinematics* says how a few fields of the mesh's two (or three) coordinates make a three-dimensional strain. It is
written twice, once in UFL for the assembly and once in numpy for the evaluation.

Knows meshes and their tags; no problem, nothing of `bem`. Verified in tests/fem_reference/test_fem_solutions.py
(equilibrium, convergence) and by the stored cases, which `python -m fem_reference CASE --check` solves again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from fem_reference import compat
from fem_reference.tensor_solver import FastDiagonalisation, held_nodes, solve_block
from meshes import Builder
from meshes.grids import CELL_TAGS, FACET_TAGS

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Material:
    """Young's modulus and Poisson's ratio of an isotropic solid."""

    youngs_modulus: float
    poissons_ratio: float

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants (lambda, mu)."""
        e, nu = self.youngs_modulus, self.poissons_ratio
        return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))


@dataclass(frozen=True)
class Solution:
    """A solved problem: the fields, their gradient in a discontinuous space, and what is needed to evaluate them."""

    mesh: Any
    cell_tags: Any
    materials: Mapping[str, Material]
    field: Any
    gradient: Any
    dofs: int
    cells: int
    reaction: Array

    def sample(self, points: ArrayLike, side: str | None = None) -> tuple[Array, Array, Array, Array]:
        """Fields (n, f), gradients (n, f, d) and Lame's constants (n,), (n,) at mesh points (n, d).

        side : "layer" or "substrate" picks the cell for points on the interface.
        """
        points = np.atleast_2d(np.asarray(points, dtype=np.float64))
        padded = np.zeros((len(points), 3))
        padded[:, : points.shape[1]] = points
        tags = np.empty(compat.cell_count(self.mesh), dtype=np.int32)
        tags[self.cell_tags.indices] = self.cell_tags.values
        wanted = None if side is None else (lambda cell: bool(tags[cell] == CELL_TAGS[side]))
        cells = compat.locate(self.mesh, padded, wanted=wanted)
        values = compat.evaluate(self.field, padded, cells)
        gradients = compat.evaluate(self.gradient, padded, cells).reshape(len(points), values.shape[1], -1)
        lame = {CELL_TAGS[name]: material.lame for name, material in self.materials.items()}
        constants = np.array([lame[int(tags[cell])] for cell in cells])
        return values, gradients, constants[:, 0], constants[:, 1]


def isotropic_stress(strain: Array, lame: Array, shear: Array) -> Array:
    """Stress (n, 3, 3) of a tensor strain (n, 3, 3)."""
    trace = np.trace(strain, axis1=1, axis2=2)
    return lame[:, None, None] * trace[:, None, None] * np.eye(3) + 2 * shear[:, None, None] * strain


def cartesian_components(stress: Array) -> Array:
    """The six components (6, n) in the order xx, yy, zz, yz, xz, xy of tensors (n, 3, 3) over (x, y, z)."""
    return np.array([stress[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))])


@dataclass(frozen=True)
class WeakForm:
    """A linear problem as it is assembled, whatever the mesh.

    Parameters
    ----------
    fields : number of unknown fields.
    degree : of the Lagrange elements.
    strain : (field, coordinates) -> UFL strain tensor, 3 x 3.
    weight : coordinates -> UFL factor of the volume and surface elements (1 or the radius).
    load : (test field, coordinates) -> UFL work of the tractions on the loaded facets, without the weight.
    held : fields (None: all) kept at zero, by facet tag name.
    rigid : rigid motions, as values of the fields, with which the reaction of the far boundary is measured.
    load_degree : quadrature degree on the loaded facets (polynomial loads need none).
    loaded : names of the loaded facet tags.
    """

    fields: int
    degree: int
    strain: Callable[[Any, Any], Any]
    weight: Callable[[Any], Any]
    load: Callable[[Any, Any], Any]
    held: Mapping[str, Sequence[int] | None]
    rigid: Sequence[Sequence[float]] = ()
    load_degree: int | None = None
    loaded: Sequence[str] = ("loaded",)

    def listed(self, u: Any) -> Any:
        """The fields as a vector, also where there is one only."""
        return u if self.fields > 1 else ufl.as_vector([u])

    def shape(self, *more: int) -> tuple[int, ...]:
        """Value shape of the fields, or of something with further axes for each of them."""
        return (self.fields, *more) if self.fields > 1 else more


@dataclass(frozen=True)
class ProductGrid:
    """A block of hexahedra that is a product of three axes: solved with `tensor_solver`.

    interface : depth of the layer's lower side; 0 without a layer.
    """

    interface: float


@dataclass(frozen=True)
class _Assembled:
    """A weak form on a mesh: what is held at zero, the energy of two fields, the matrix and its right-hand side."""

    mesh: Any
    cell_tags: Any
    space: Any
    conditions: list[Any]
    energy: Callable[[Any, Any], Any]
    matrix: Any
    right: Any


def solve(
    builder: Builder, materials: Mapping[str, Material], form: WeakForm, product_grid: ProductGrid | None = None
) -> Solution:
    """Solve one linear problem, by a sparse Cholesky factorisation or, on blocks, by conjugate gradients.

    materials : by cell tag name.

    The reaction is the work of the residual of all held fields on each rigid motion; by equilibrium it is minus the
    load's.
    """
    problem = _assemble(builder, materials, form)
    field = compat.function(problem.space)
    if product_grid is None:
        factor_and_solve(problem.matrix, problem.right, compat.petsc_vector(field))
    else:
        inverse = _inverse_on_products(problem, materials, form.degree, product_grid.interface)
        solve_block(problem.matrix, problem.right, compat.petsc_vector(field), inverse, 1e-9)
    problem.matrix.destroy()
    reaction = _reaction(problem, form, field)
    gradient = compat.interpolate_expression(
        ufl.grad(field),
        compat.function_space(problem.mesh, form.degree, form.shape(problem.mesh.geometry.dim), continuous=False),
    )
    return Solution(
        problem.mesh,
        problem.cell_tags,
        materials,
        field,
        gradient,
        compat.dof_count(problem.space),
        compat.cell_count(problem.mesh),
        reaction,
    )


def _assemble(builder: Builder, materials: Mapping[str, Material], form: WeakForm) -> _Assembled:
    mesh, cell_tags, facet_tags = compat.load_mesh(builder)
    space = compat.function_space(mesh, form.degree, form.shape())
    constants = compat.function_space(mesh, 0, (), continuous=False)
    lame, shear = compat.function(constants), compat.function(constants)
    for name, material in materials.items():
        cells = cell_tags.find(CELL_TAGS[name])
        lame.x.array[cells], shear.x.array[cells] = material.lame
    x = ufl.SpatialCoordinate(mesh)
    weight = form.weight(x)
    # a rectangle's Jacobian is constant: 2 degree integrates the plain products exactly; the radius needs more
    precision = 2 * form.degree if weight == 1.0 else 2 * form.degree + 2
    on_surface = form.load_degree or 2 * form.degree + 2
    dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": precision})
    ds = ufl.Measure("ds", mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": on_surface})
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)

    def energy(u: Any, v: Any) -> Any:
        e, f = form.strain(form.listed(u), x), form.strain(form.listed(v), x)
        return (lame * ufl.tr(e) * ufl.tr(f) + 2 * shear * ufl.inner(e, f)) * weight * dx

    conditions: list[Any] = []
    for name, components in form.held.items():
        conditions += compat.fixed(space, facet_tags, FACET_TAGS[name], components)
    work = sum((form.load(form.listed(test), x) * weight * ds(FACET_TAGS[name]) for name in form.loaded), start=0)
    right = compat.assemble_vector(compat.form(work))
    compat.zero_fixed(right, conditions)
    matrix = compat.assemble_matrix(compat.form(energy(trial, test)), conditions)
    return _Assembled(mesh, cell_tags, space, conditions, energy, matrix, right)


def _inverse_on_products(
    problem: _Assembled, materials: Mapping[str, Material], degree: int, interface: float
) -> FastDiagonalisation:
    """The preconditioner of a product grid: shear moduli over depth, one ratio of the moduli."""
    coordinates = np.asarray(problem.space.tabulate_dof_coordinates())
    fixed = held_nodes(len(coordinates), compat.fixed_dofs(problem.conditions))
    lame_of = {name: material.lame for name, material in materials.items()}
    below, shear_below = lame_of["substrate"]

    def shear_at(depth: Array) -> Array:
        return np.where(depth < interface, lame_of.get("layer", lame_of["substrate"])[1], shear_below)

    return FastDiagonalisation(coordinates, degree, fixed, shear_at, 2 + below / shear_below)


def _reaction(problem: _Assembled, form: WeakForm, field: Any) -> Array:
    """Work of the held fields' residual on each rigid motion."""
    if not form.rigid:
        return np.array([])
    test = ufl.TestFunction(problem.space)
    residual = compat.assemble_vector(compat.form(problem.energy(field, test))).array.reshape(-1, form.fields)
    held = np.zeros(residual.size, dtype=bool)
    held[compat.fixed_dofs(problem.conditions)] = True
    worked = residual * held.reshape(residual.shape)
    return np.array([float(np.sum(worked * np.asarray(motion))) for motion in form.rigid])


def factor_and_solve(matrix: Any, right: Any, solution: Any, kind: str = "cholesky") -> None:
    """Solve with MUMPS' factorisation (or "lu") and one step of iterative refinement; RuntimeError when it fails."""
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("preonly")
    preconditioner = solver.getPC()
    preconditioner.setType(kind)
    preconditioner.setFactorSolverType("mumps")
    solver.setUp()
    solver.solve(right, solution)
    if solver.getConvergedReason() < 0:
        raise RuntimeError(f"the factorisation failed: PETSc's reason {solver.getConvergedReason()}")
    residual = right.duplicate()
    matrix.mult(solution, residual)
    residual.aypx(-1.0, right)
    correction = right.duplicate()
    solver.solve(residual, correction)
    solution.axpy(1.0, correction)
    # by hand, all: petsc4py keeps what python merely forgets
    preconditioner.destroy()
    solver.destroy()
    residual.destroy()
    correction.destroy()
