"""An elastic body reduced to the surface where contact may be: finite elements once, contact many times.

Biquadratic displacements on a `meshes.contact_block.ContactBlock`, axisymmetric or plane strain (half of a symmetric
body); pressures that are continuous and piecewise linear on the patch. One factorisation gives the compliance that
the patch shows to those pressures, exactly as the mesh has it, so that each contact problem afterwards is small; a
further back-substitution with the pressure found gives the whole field.

x stands for the radius in the axisymmetric setting; forces are then per radian, in plane strain per unit length of
half the body.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import ArrayLike, NDArray
from petsc4py import PETSc

from fem_reference import compat
from meshes.contact_block import ContactBlock

COMPONENTS = ("stress_xx", "stress_yy", "stress_zz", "stress_xz")
"""Those that symmetry leaves: radial (or along x), hoop (or out of plane), axial, shear."""
CHUNK = 16
"""Right-hand sides solved at once: enough for the back-substitution to run at the speed of matrix products."""


@dataclass(frozen=True)
class ElasticBody:
    """A factorised body and its compliance on the patch.

    Parameters
    ----------
    block : the mesh's parameters.
    axisymmetric : or plane strain.
    moduli : Young's modulus and Poisson's ratio by cell name.
    nodes : (n,) positions of the pressure nodes, from 0 to the patch's end.
    weights : (n,) force that a unit value of each pressure node makes.
    compliance : (n, n) displacement, weighted with pressure shape i, from a unit of pressure node j.
    rows, loads : (m,) dofs that pressures act on, (m, n) the load vectors of the pressure nodes there.
    factor : factorised stiffness.
    grid : (2 nx + 1, 2 nz + 1) number of the first displacement dof at each node of the tensor grid.
    lines : where the mesh lines are, across and down.
    cells, dofs : sizes, for the record.
    """

    block: ContactBlock
    axisymmetric: bool
    moduli: dict[str, tuple[float, float]]
    nodes: NDArray[np.float64]
    weights: NDArray[np.float64]
    compliance: NDArray[np.float64]
    rows: NDArray[np.int64]
    loads: NDArray[np.float64]
    factor: Any
    grid: NDArray[np.int64]
    lines: tuple[NDArray[np.float64], NDArray[np.float64]]
    cells: int
    dofs: int

    def field(self, pressure: NDArray[np.float64]) -> Field:
        """The displacement field under nodal pressures (n,)."""
        right = PETSc.Vec().createSeq(self.dofs, comm=PETSc.COMM_SELF)
        right.array[self.rows] = self.loads @ pressure
        solution = right.duplicate()
        self.factor.solve(right, solution)
        values = np.asarray(solution.array)
        return Field(self, np.stack([values[self.grid], values[self.grid + 1]]))


@dataclass(frozen=True)
class AssembledBody:
    """What dolfinx makes of a block: the displacement space, stiffness with its conditions, and pressures to forces."""

    mesh: Any
    space: Any
    scalar: Any
    stiffness: Any
    conditions: list[Any]
    coupling: Any


def assemble_body(
    block: ContactBlock, moduli: dict[str, tuple[float, float]], *, axisymmetric: bool, periodic: bool = False
) -> AssembledBody:
    """Mesh and assemble a body.

    moduli : (Young's modulus, Poisson's ratio) for "substrate" and, where the block has a layer, "layer".
    periodic : mirror symmetry at the side and a bottom that moves sideways freely, instead of far boundaries held fast.
    """
    mesh, cell_tags, facet_tags = compat.load_mesh(block)
    space = compat.function_space(mesh, 2, (2,))
    scalar = compat.function_space(mesh, 1)
    constants = compat.function_space(mesh, 0, continuous=False)
    lame, shear = (compat.fem.Function(constants) for _ in range(2))
    for name, (modulus, ratio) in moduli.items():
        cells = cell_tags.find(block.cell_tags[name])
        shear.x.array[cells] = modulus / (2 * (1 + ratio))
        lame.x.array[cells] = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
    radius = ufl.SpatialCoordinate(mesh)[0] if axisymmetric else compat.constant(mesh, 1.0)
    inside = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": 5})
    on_facets = ufl.Measure("ds", domain=mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": 5})

    def strain(u: Any) -> Any:
        slope = ufl.grad(u)
        hoop = u[0] / radius if axisymmetric else 0 * u[0]
        return ufl.as_vector([slope[0, 0], hoop, slope[1, 1], slope[0, 1] + slope[1, 0]])

    def stress(e: Any) -> Any:
        dilatation = lame * (e[0] + e[1] + e[2])
        return ufl.as_vector([dilatation + 2 * shear * e[i] for i in range(3)] + [shear * e[3]])

    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    conditions = compat.fixed(space, facet_tags, block.facet_tags["axis"], [0])
    conditions += compat.fixed(space, facet_tags, block.facet_tags["side"], [0] if periodic else [0, 1])
    conditions += compat.fixed(space, facet_tags, block.facet_tags["bottom"], [1] if periodic else [0, 1])
    stiffness = compat.assemble_matrix(
        compat.form(ufl.inner(stress(strain(u)), strain(v)) * radius * inside), conditions
    )
    p = ufl.TrialFunction(scalar)
    coupling = compat.assemble_matrix(compat.form(p * v[1] * radius * on_facets(block.facet_tags["loaded"])))
    return AssembledBody(mesh, space, scalar, stiffness, conditions, coupling)


def elastic_body(
    block: ContactBlock, moduli: dict[str, tuple[float, float]], *, axisymmetric: bool, periodic: bool = False
) -> ElasticBody:
    """Mesh, assemble (arguments as there), factorise and reduce a body."""
    parts = assemble_body(block, moduli, axisymmetric=axisymmetric, periodic=periodic)
    space, coupling = parts.space, parts.coupling
    solver = PETSc.PC().create(PETSc.COMM_SELF)
    solver.setOperators(parts.stiffness)
    solver.setType("cholesky")
    solver.setFactorSolverType("mumps")
    solver.setUp()
    factor = solver.getFactorMatrix()

    at = parts.scalar.tabulate_dof_coordinates()
    # coordinates carry the rounding of the far boundary's: 1e-11 of a patch, against cells of 1e-3
    on_patch = np.flatnonzero((at[:, 1] < 1e-7 * block.patch) & (at[:, 0] < block.patch * (1 + 1e-7)))
    on_patch = on_patch[np.argsort(at[on_patch, 0])]
    start, column, value = coupling.getValuesCSR()
    row = np.repeat(np.arange(start.size - 1), np.diff(start))
    position = np.full(coupling.getSize()[1], -1)
    position[on_patch] = np.arange(on_patch.size)
    used = (position[column] >= 0) & (value != 0) & ~np.isin(row, compat.fixed_dofs(parts.conditions))
    rows, local = np.unique(row[used], return_inverse=True)
    loads = np.zeros((rows.size, on_patch.size))
    loads[local, position[column[used]]] = value[used]
    compliance = np.empty((on_patch.size, on_patch.size))
    for first in range(0, on_patch.size, CHUNK):
        part = slice(first, min(first + CHUNK, on_patch.size))
        right = np.zeros((coupling.getSize()[0], part.stop - part.start), order="F")
        right[rows] = loads[:, part]
        given = PETSc.Mat().createDense(right.shape, array=right, comm=PETSc.COMM_SELF)
        found = PETSc.Mat().createDense(right.shape, comm=PETSc.COMM_SELF)
        for matrix in (given, found):
            matrix.setUp()
            matrix.assemble()
        factor.matSolve(given, found)
        compliance[:, part] = loads.T @ found.getDenseArray()[rows]
    grid, xs, zs = _tensor_grid(space, block.patch)
    return ElasticBody(
        block=block,
        axisymmetric=axisymmetric,
        moduli=dict(moduli),
        nodes=xs[: 2 * on_patch.size : 2],
        weights=loads.sum(axis=0),  # the shape functions of the displacement sum to one
        compliance=0.5 * (compliance + compliance.T),
        rows=rows,
        loads=loads,
        factor=factor,
        grid=grid,
        lines=(xs[::2], zs[::2]),
        cells=compat.cell_count(parts.mesh),
        dofs=compat.dof_count(space),
    )


def _tensor_grid(space: Any, patch: float) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """First dof of the node at each crossing of the mesh lines and their middles, and where these are.

    Read off the surface and the axis: gmsh integrates a progression numerically, so its lines are not quite those
    that the builder can state.
    """
    at = space.tabulate_dof_coordinates()
    small = 1e-7 * patch
    xs, zs = np.sort(at[at[:, 1] < small, 0]), np.sort(at[at[:, 0] < small, 1])
    index = []
    for position, values in ((at[:, 0], xs), (at[:, 1], zs)):
        nearest = np.clip(np.searchsorted(values, position), 1, values.size - 1)
        nearest -= position - values[nearest - 1] < values[nearest] - position
        index.append(nearest)
    grid = np.full((xs.size, zs.size), -1, dtype=np.int64)
    grid[index[0], index[1]] = 2 * np.arange(at.shape[0])
    if np.any(grid < 0):
        raise RuntimeError("the mesh is not a tensor grid")
    return grid, xs, zs


@dataclass(frozen=True)
class Field:
    """A displacement field.

    `values` (2, 2 nx + 1, 2 nz + 1) at the nodes of the tensor grid, (radial or along x, into the body).
    """

    body: ElasticBody
    values: NDArray[np.float64]

    def surface_displacement(self, x: ArrayLike) -> NDArray[np.float64]:
        """Displacement into the body at surface positions, by the elements' own shape functions."""
        x = np.asarray(x, dtype=float)
        lines = self.body.lines[0]
        cell = np.clip(np.searchsorted(lines, x, side="right") - 1, 0, lines.size - 2)
        s = 2 * (x - lines[cell]) / (lines[cell + 1] - lines[cell]) - 1
        shape = np.stack([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])
        return np.sum(shape * np.stack([self.values[1, 2 * cell + k, 0] for k in range(3)]), axis=0)

    def gauss_stresses(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> tuple[NDArray[np.float64], ...]:
        """x.

        (m, 2), z (m, 2) and the four stresses (4, m, 2, 2) at the 2 x 2 Gauss points of cells (i, j), where they are
        most accurate.
        """
        body = self.body
        lines_x, lines_z = body.lines
        g = np.array([-1, 1]) / np.sqrt(3)
        shape = np.stack([g * (g - 1) / 2, 1 - g * g, g * (g + 1) / 2])
        slope = np.stack([g - 0.5, -2 * g, g + 0.5])
        hx, hz = lines_x[i + 1] - lines_x[i], lines_z[j + 1] - lines_z[j]
        x = lines_x[i][:, None] + hx[:, None] * (1 + g) / 2
        z = lines_z[j][:, None] + hz[:, None] * (1 + g) / 2
        offsets = np.arange(3)
        local = self.values[:, (2 * i[:, None] + offsets)[:, :, None], (2 * j[:, None] + offsets)[:, None, :]]
        along = np.einsum("cmab,ag,bh->cmgh", local, slope, shape) * (2 / hx)[:, None, None]
        across = np.einsum("cmab,ag,bh->cmgh", local, shape, slope) * (2 / hz)[:, None, None]
        hoop = np.zeros_like(along[0])
        if body.axisymmetric:
            hoop = np.einsum("mab,ag,bh->mgh", local[0], shape, shape) / x[:, :, None]
        coat = body.block.layer is not None
        in_layer = lines_z[j + 1] <= (body.block.layer or 0) * (1 + 1e-9) if coat else np.zeros(j.shape, dtype=bool)
        modulus = np.where(in_layer, body.moduli.get("layer", (0, 0))[0], body.moduli["substrate"][0])[:, None, None]
        ratio = np.where(in_layer, body.moduli.get("layer", (0, 0))[1], body.moduli["substrate"][1])[:, None, None]
        shear = modulus / (2 * (1 + ratio))
        lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
        dilatation = lame * (along[0] + hoop + across[1])
        stresses = [dilatation + 2 * shear * e for e in (along[0], hoop, across[1])]
        return x, z, np.stack([*stresses, shear * (across[0] + along[1])])

    def stress(self, points: ArrayLike) -> NDArray[np.float64]:
        """The four stresses (4, n) at points (n, 2) not on the interface.

        A biquadratic fitted to the Gauss points of the cells around, on the same side of the interface.
        """
        lines_x, lines_z = self.body.lines
        layer = self.body.block.layer
        border = int(np.argmin(np.abs(lines_z - layer))) if layer is not None else 0
        found = np.empty((4, len(np.asarray(points))))
        for k, (px, pz) in enumerate(np.asarray(points, dtype=float)):
            ci = int(np.clip(np.searchsorted(lines_x, px, side="right") - 1, 0, lines_x.size - 2))
            cj = int(np.clip(np.searchsorted(lines_z, pz, side="right") - 1, 0, lines_z.size - 2))
            low, high = (0, border) if cj < border else (border, lines_z.size - 1)
            i0 = min(max(ci - 1, 0), lines_x.size - 4)
            j0 = min(max(cj - 1, low), max(high - 3, low))
            i, j = np.meshgrid(np.arange(i0, i0 + 3), np.arange(j0, min(j0 + 3, high)), indexing="ij")
            x, z, s = self.gauss_stresses(i.ravel(), j.ravel())
            gx = np.broadcast_to(x[:, :, None], s.shape[1:]).ravel()
            gz = np.broadcast_to(z[:, None, :], s.shape[1:]).ravel()
            width = lines_x[ci + 1] - lines_x[ci]
            height = lines_z[cj + 1] - lines_z[cj]
            a, b = (gx - px) / width, (gz - pz) / height
            terms = np.stack([a**m * b**n for m in range(3) for n in range(3)], axis=1)
            found[:, k] = np.linalg.lstsq(terms, s.reshape(4, -1).T, rcond=None)[0][0]
        return found

    def force_through(self, depth: float) -> float:
        """Vertical force through a level near `depth`, compression positive: equilibrium asks for the load.

        By the Gauss points of one row of cells.

        Only to a thousand patches: the corner of the far boundary, held fast, draws a per cent of the force to itself
        without any effect on the contact.
        """
        lines_x, lines_z = self.body.lines
        j = int(np.clip(np.searchsorted(lines_z, depth) - 1, 0, lines_z.size - 2))
        i = np.flatnonzero(lines_x[1:] <= 1e3 * self.body.block.patch)
        x, _, s = self.gauss_stresses(i, np.full(i.size, j))
        width = (lines_x[i + 1] - lines_x[i])[:, None] / 2
        measure = width * (x if self.body.axisymmetric else 1.0)
        return float(-np.sum(measure * s[2, :, :, 0]))


def von_mises(stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Von Mises stress of the four components (4, n)."""
    xx, yy, zz, xz = stress
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xz**2)
