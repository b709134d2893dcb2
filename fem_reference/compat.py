"""Everything that differs between dolfinx 0.5 and 0.9, and nothing else: the rest of the package calls these functions.

Serial (one process): direct solvers and point evaluation are what the reference needs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import dolfinx
import dolfinx.fem.petsc
import numpy as np
import ufl
from dolfinx import fem, geometry
from dolfinx import mesh as dmesh
from dolfinx.io import gmshio
from mpi4py import MPI
from numpy.typing import ArrayLike, NDArray

from meshes import Builder, gmsh_model

VERSION = tuple(int(part) for part in dolfinx.__version__.split(".")[:2])
OLD = VERSION < (0, 7)


def load_mesh(builder: Builder) -> tuple[dmesh.Mesh, Any, Any]:
    """Build a mesh in gmsh and hand it to dolfinx: (mesh, cell tags, facet tags)."""
    with gmsh_model(type(builder).__name__) as model:
        builder.build(model)
        found = gmshio.model_to_mesh(model, MPI.COMM_SELF, 0, gdim=builder.dimension)
    return found[0], found[1], found[2]


def function_space(mesh: dmesh.Mesh, degree: int, shape: tuple[int, ...] = (), *, continuous: bool = True) -> Any:
    """Lagrange space (Q on quadrilaterals and hexahedra):

    scalar for shape (), vector (n,) or tensor (n, m); discontinuous if asked.
    """
    if OLD:
        cell = mesh.ufl_cell()
        if continuous:
            family = "Lagrange"
        else:
            family = "DQ" if cell.cellname() in ("quadrilateral", "hexahedron") else "DG"
        element = ufl.FiniteElement(family, cell, degree)
        if len(shape) == 1:
            element = ufl.VectorElement(element, dim=shape[0])
        elif len(shape) == 2:
            element = ufl.TensorElement(element, shape=shape)
        return fem.FunctionSpace(mesh, element)
    import basix.ufl

    element = basix.ufl.element(
        "Lagrange", mesh.basix_cell(), degree, shape=shape or None, discontinuous=not continuous, dtype=np.float64
    )
    return fem.functionspace(mesh, element)


def function(space: Any) -> Any:
    """A new function, zero."""
    return fem.Function(space)


def constant(mesh: dmesh.Mesh, value: ArrayLike) -> Any:
    """A constant of the mesh, always float64 (0.5 refuses integers)."""
    values = np.asarray(value, dtype=np.float64)
    return fem.Constant(mesh, values if values.ndim else float(values))


def petsc_vector(function: Any) -> Any:
    """The PETSc vector behind a function."""
    return function.vector if OLD else function.x.petsc_vec


def interpolation_points(space: Any) -> Any:
    """Reference points at which an expression is needed to interpolate into the space."""
    points = space.element.interpolation_points
    return points() if callable(points) else points


def interpolate_expression(expression: Any, space: Any) -> Any:
    """A new function of `space` that interpolates a UFL expression."""
    function = fem.Function(space)
    function.interpolate(fem.Expression(expression, interpolation_points(space)))
    return function


def fixed(space: Any, facet_tags: Any, tag: int, components: Sequence[int] | None = None) -> list[Any]:
    """Homogeneous conditions on the facets of a tag: all components, or those of a vector space that are listed."""
    mesh = space.mesh
    dimension = mesh.topology.dim - 1
    mesh.topology.create_connectivity(dimension, dimension + 1)
    facets = facet_tags.find(tag)
    if components is None:
        dofs = fem.locate_dofs_topological(space, dimension, facets)
        size = space.dofmap.bs
        zero = np.zeros(size) if size > 1 else 0.0
        return [fem.dirichletbc(zero, dofs, space)]
    conditions = []
    for component in components:
        subspace = space.sub(component)
        dofs = fem.locate_dofs_topological(subspace, dimension, facets)
        conditions.append(fem.dirichletbc(0.0, dofs, subspace))
    return conditions


def form(expression: Any) -> Any:
    """Compile a form."""
    return fem.form(expression)


def assemble_matrix(compiled: Any, conditions: Sequence[Any] = ()) -> Any:
    """Assembled PETSc matrix, rows and columns of the conditions replaced by the identity."""
    matrix = fem.petsc.assemble_matrix(compiled, bcs=list(conditions))
    matrix.assemble()
    return matrix


def assemble_vector(compiled: Any) -> Any:
    """Assembled PETSc vector, without conditions."""
    return fem.petsc.assemble_vector(compiled)


def zero_fixed(vector: Any, conditions: Sequence[Any]) -> None:
    """Set the entries of homogeneous conditions to zero."""
    for condition in conditions:
        dofs, _ = condition.dof_indices()
        vector.array[dofs] = 0.0


def fixed_dofs(conditions: Sequence[Any]) -> NDArray[np.int64]:
    """All scalar degrees of freedom that conditions hold, sorted."""
    found = [np.asarray(condition.dof_indices()[0]) for condition in conditions]
    return np.unique(np.concatenate(found)) if found else np.empty(0, dtype=np.int64)


def assemble_scalar(expression: Any) -> float:
    """Integral of a UFL expression given with its measure."""
    return float(fem.assemble_scalar(fem.form(expression)))


def locate(mesh: dmesh.Mesh, points: ArrayLike, *, wanted: Callable[[int], bool] | None = None) -> NDArray[np.int32]:
    """A cell for each point, shape (n,);

    with `wanted`, the first colliding cell for which it is true. ValueError naming a point outside the mesh.
    """
    points = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
    dimension = mesh.topology.dim
    if OLD:
        tree = geometry.BoundingBoxTree(mesh, dimension)
        candidates = geometry.compute_collisions(tree, points)
    else:
        tree = geometry.bb_tree(mesh, dimension)
        candidates = geometry.compute_collisions_points(tree, points)
    colliding = geometry.compute_colliding_cells(mesh, candidates, points)
    cells = np.empty(len(points), dtype=np.int32)
    for i, point in enumerate(points):
        links = colliding.links(i)
        chosen = [c for c in links if wanted is None or wanted(int(c))]
        if not chosen:
            raise ValueError(f"point {point.tolist()} lies in no cell of the mesh")
        cells[i] = chosen[0]
    return cells


def evaluate(function: Any, points: ArrayLike, cells: NDArray[np.int32] | None = None) -> NDArray[np.float64]:
    """Values of a function at points (n, 3), shape (n, components)."""
    points = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
    if cells is None:
        cells = locate(function.function_space.mesh, points)
    return np.asarray(function.eval(points, cells), dtype=np.float64).reshape(len(points), -1)


def cell_count(mesh: dmesh.Mesh) -> int:
    """Number of cells."""
    return int(mesh.topology.index_map(mesh.topology.dim).size_local)


def dof_count(space: Any) -> int:
    """Number of scalar degrees of freedom."""
    return int(space.dofmap.index_map.size_global * space.dofmap.index_map_bs)


def cell_nodes(mesh: dmesh.Mesh) -> NDArray[np.int64]:
    """Geometry nodes of each cell, (cells, nodes per cell), in dolfinx' order."""
    dofmap = mesh.geometry.dofmap
    if hasattr(dofmap, "array"):
        return np.asarray(dofmap.array, dtype=np.int64).reshape(cell_count(mesh), -1)
    return np.asarray(dofmap, dtype=np.int64)


def quadrature_function(mesh: dmesh.Mesh, size: int, degree: int) -> Any:
    """A vector of `size` numbers at each Gauss point of a rule of that degree, in the order of `quadrature_values`."""
    if OLD:
        element = ufl.VectorElement("Quadrature", mesh.ufl_cell(), degree=degree, dim=size, quad_scheme="default")
        return fem.Function(fem.FunctionSpace(mesh, element))
    import basix.ufl

    element = basix.ufl.quadrature_element(mesh.basix_cell(), value_shape=(size,), scheme="default", degree=degree)
    return fem.Function(fem.functionspace(mesh, element))


def quadrature_values(expression: Any, mesh: dmesh.Mesh, degree: int) -> Callable[[], NDArray[np.float64]]:
    """A callable that evaluates a vector expression, as it is by then, at all Gauss points: (points, components)."""
    import basix

    points, _ = basix.make_quadrature(getattr(basix.CellType, mesh.ufl_cell().cellname()), degree)
    compiled = fem.Expression(expression, points)
    cells = np.arange(cell_count(mesh), dtype=np.int32)
    size = expression.ufl_shape[0]

    def values() -> NDArray[np.float64]:
        found = compiled.eval(cells) if OLD else compiled.eval(mesh, cells)
        return np.asarray(found, dtype=np.float64).reshape(-1, size)

    return values
