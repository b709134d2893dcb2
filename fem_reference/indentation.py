"""An elastic, perfectly plastic body (von Mises) under a rigid sphere: indentation from first yield to full plasticity.

A validation of the model, not a gate: half-space codes cap the pressure at a hardness and take H = 2.8 sigma_y; here
the plastic flow below the contact is computed. Small strains and a parabolic indenter, so that all depends on a E* /
(R sigma_y) alone (and weakly on Poisson's ratio).

Biquadratic displacements with 2 x 2 Gauss points (which do not lock in plastic, nearly isochoric flow), the state
kept at those points, radial return with the consistent tangent, Newton's method with a backtracking line search,
displacement control. Contact by a penalty at two Gauss points to a surface cell, so stiff that the overlap moves the
edge by far less than a cell. The range of contact sizes is covered by windows: runs from zero on meshes whose patch
fits the window's largest contact.

Knows meshes; no study. Verified in tests/fem_reference/test_fem_plasticity.py: Hertz below yield, the onset of yield,
the plateau of the mean pressure, the return mapping's tangent against differences.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray
from petsc4py import PETSc

from fem_reference import compat
from meshes.contact_block import ContactBlock

USED = (0.3, 0.85)
"""The part of each window, as contact radius over patch, whose states are used: resolved, and inside the patch."""
REACH = 40.0
DEGREE = 3
OVERLAP = 0.005
"""Movement of the contact's edge by the penalty, over the size of a surface cell."""


@dataclass(frozen=True)
class Indentation:
    """States of a window where the contact is resolved, and what the last elastic one showed.

    radius, force, approach : (n,) contact radius, force per radian, approach of each state.
    onset : Hertz' central pressure at first yield (0 where no elastic state is resolved).
    hertz : force over Hertz' at the same approach in the last elastic state.
    Lengths in patches, the yield stress and Young's modulus are 1 (linear kinematics make the size of strains
    immaterial).
    """

    window: float
    radius: NDArray[np.float64]
    force: NDArray[np.float64]
    approach: NDArray[np.float64]
    onset: float
    hertz: float
    cells: int
    dofs: int
    iterations: int
    block: ContactBlock


def _isotropic(nu: float) -> tuple[float, float]:
    """Bulk and shear modulus for unit Young's modulus."""
    return 1 / (3 * (1 - 2 * nu)), 1 / (2 * (1 + nu))


UNIT = np.array([1.0, 1.0, 1.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(UNIT, UNIT) / 3
"""From strain (rr, tt, zz, engineering rz) to its deviator as a stress-like vector (rz once)."""


def radial_return(
    trial: NDArray[np.float64], bulk: float, shear: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return trial stresses (n, 4) to the von Mises cylinder of unit yield stress.

    Returns stresses (n, 4), consistent tangents (n, 4, 4) and the trial's von Mises stress (n,). Simo and Hughes,
    *Computational Inelasticity* (1998), box 3.2, without hardening.
    """
    mean = trial[:, :3].mean(axis=1)
    deviator = trial - mean[:, None] * UNIT
    norm = np.sqrt(np.sum(deviator[:, :3] ** 2, axis=1) + 2 * deviator[:, 3] ** 2)
    equivalent = np.sqrt(1.5) * norm
    plastic = equivalent > 1
    scale = np.where(plastic, 1 / np.maximum(equivalent, 1e-300), 1.0)
    direction = deviator / np.maximum(norm, 1e-300)[:, None]
    tangent = bulk * np.outer(UNIT, UNIT) + 2 * shear * scale[:, None, None] * DEVIATOR
    tangent -= (2 * shear * scale * plastic)[:, None, None] * direction[:, :, None] * direction[:, None, :]
    return scale[:, None] * deviator + mean[:, None] * UNIT, tangent, equivalent


class _Problem:
    """One mesh: its forms, the fields in them, and the state at the Gauss points, new and of the last step taken."""

    def __init__(self, block: ContactBlock, window: float, nu: float) -> None:
        self.block = block
        self.curvature = window * (1 - nu**2)  # 1/R: window = patch E*/(R sigma_y), patch = sigma_y = E = 1
        self.mesh, _, facet_tags = compat.load_mesh(block)
        self.space = compat.function_space(self.mesh, 2, (2,))
        self.u = compat.function(self.space)
        self.stress_field = compat.quadrature_function(self.mesh, 4, DEGREE)
        self.tangent_field = compat.quadrature_function(self.mesh, 16, DEGREE)
        self.approach = compat.constant(self.mesh, 0.0)
        self._set_forms(facet_tags, 3 / (OVERLAP * block.patch / block.cells * window))
        self.conditions = compat.fixed(self.space, facet_tags, block.facet_tags["axis"], [0])
        for side in ("side", "bottom"):
            self.conditions += compat.fixed(self.space, facet_tags, block.facet_tags[side], [0, 1])
        self.bulk, self.shear = _isotropic(nu)
        self.elastic = self.bulk * np.outer(UNIT, UNIT) + 2 * self.shear * DEVIATOR
        self.solver = PETSc.KSP().create(PETSc.COMM_SELF)
        self.solver.setType("preonly")
        self.solver.getPC().setType("cholesky")
        self.solver.getPC().setFactorSolverType("mumps")
        self.old_strain = self.strains()
        self.old_stress = np.zeros_like(self.old_strain)
        self.new_strain, self.new_stress = self.old_strain, self.old_stress
        self.equivalent = np.zeros(len(self.old_strain))
        self.iterations = 0

    def _set_forms(self, facet_tags: Any, penalty: float) -> None:
        """Residual, its derivative and the force, with the contact's penalty on the surface."""
        block, mesh, u, tangent = self.block, self.mesh, self.u, self.tangent_field
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        r = ufl.SpatialCoordinate(mesh)[0]

        def strain(v: Any) -> Any:
            slope = ufl.grad(v)
            return ufl.as_vector([slope[0, 0], v[0] / r, slope[1, 1], slope[0, 1] + slope[1, 0]])

        inside = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": DEGREE})
        surface = ufl.Measure("ds", domain=mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": DEGREE})
        surface = surface(block.facet_tags["loaded"])
        overlap = self.approach - self.curvature * r * r / 2 - u[1]
        touching = ufl.conditional(ufl.gt(overlap, 0.0), 1.0, 0.0)
        pressure = penalty * overlap * touching
        matrix = ufl.as_matrix([[tangent[4 * i + j] for j in range(4)] for i in range(4)])
        worked = ufl.inner(self.stress_field, strain(test)) * r * inside
        self.residual_form = compat.form(worked - pressure * test[1] * r * surface)
        self.jacobian_form = compat.form(
            ufl.inner(matrix * strain(trial), strain(test)) * r * inside
            + penalty * touching * trial[1] * test[1] * r * surface
        )
        self.force_form = compat.form(pressure * r * surface)
        self.strains = compat.quadrature_values(strain(u), mesh, DEGREE)

    def residual(self) -> Any:
        """Residual forces at the present displacements, with the stresses that they return to."""
        self.new_strain = self.strains()
        trial = self.old_stress + (self.new_strain - self.old_strain) @ self.elastic.T
        self.new_stress, moduli, self.equivalent = radial_return(trial, self.bulk, self.shear)
        self.stress_field.x.array[:] = self.new_stress.ravel()
        self.tangent_field.x.array[:] = moduli.ravel()
        vector = compat.assemble_vector(self.residual_form)
        compat.zero_fixed(vector, self.conditions)
        return vector

    def force(self) -> float:
        """Force per radian."""
        return float(compat.fem.assemble_scalar(self.force_form))

    def accept(self) -> None:
        """The next step starts here."""
        self.old_strain, self.old_stress = self.new_strain, self.new_stress

    def solve(self) -> bool:
        """Newton's method with a backtracking line search at the present approach; whether it converged."""
        vector = self.residual()
        size = vector.norm()
        for count in range(15):
            jacobian = compat.assemble_matrix(self.jacobian_form, self.conditions)
            self.solver.setOperators(jacobian)
            step = vector.duplicate()
            self.solver.solve(vector, step)
            self.iterations += 1
            start, before, fraction = self.u.x.array.copy(), size, 1.0
            while True:
                self.u.x.array[:] = start - fraction * step.array
                vector = self.residual()
                size = vector.norm()
                # the first step changes the contact set: its residual says nothing yet
                if count == 0 or fraction < 0.1 or size < (1 - 0.1 * fraction) * before:
                    break
                fraction /= 2
            # residual forces against the load
            if count > 0 and size < 1e-7 * self.force():
                return True
        return False


def _press(problem: _Problem, window: float) -> Iterator[float]:
    """Press deeper and deeper; yields each approach that was reached. Steps that do not converge are halved."""
    u, curvature = problem.u, problem.curvature
    history = [(0.0, u.x.array.copy())]
    low, high = 0.0025 * curvature, 0.9 * curvature
    waiting = list(np.geomspace(low, high, 1 + int(np.ceil(np.log(high / low) / np.log(1.35)))))
    cuts = 0
    while waiting:
        target = waiting[0]
        problem.approach.value = target
        if len(history) == 2:
            (d0, u0), (d1, u1) = history
            u.x.array[:] = u1 + (u1 - u0) * (target - d1) / (d1 - d0)
        if not problem.solve():
            cuts += 1
            if cuts > 12:
                raise RuntimeError(f"indentation to {target:g} in window {window:g} does not converge")
            u.x.array[:] = history[-1][1]
            waiting.insert(0, 0.5 * (history[-1][0] + target))
            continue
        waiting.pop(0)
        history = [history[-1], (target, u.x.array.copy())]
        problem.accept()
        yield target


def indent(window: float, *, nu: float, cells: int, coarsest: int) -> Indentation:
    """One run from first touch until the contact fills most of the patch.

    window : a E* / (R sigma_y) where the contact radius would equal the patch.
    cells : cells over the patch; coarsest : those of the coarsest mesh of the study, on which the growth of cells is
        set.
    RuntimeError when a step does not converge however small.
    """
    block = ContactBlock(
        patch=1.1, cells=cells, reach=REACH, depth=REACH, growth=1.35 ** (coarsest / cells), layer=None
    )
    problem = _Problem(block, window, nu)
    edge = _EdgeFinder(problem.space, block, problem.curvature)
    curvature = problem.curvature
    states, onset, hertz = [], 0.0, 0.0
    for approach in _press(problem, window):
        radius, force = edge(problem.u.x.array, approach), problem.force()
        highest = np.max(problem.equivalent)
        if highest <= 1 and radius > USED[0]:
            # Hertz' central pressure of that load, over the largest von Mises stress: what yield begins at
            hertz = force / (4 / 3 / (1 - nu**2) * np.sqrt(approach**3 / curvature) / (2 * np.pi))
            onset = (6 * 2 * np.pi * force * curvature**2 / (np.pi**3 * (1 - nu**2) ** 2)) ** (1 / 3) / highest
        if radius > USED[1]:
            break
        if radius > USED[0]:
            states.append((radius, force, approach))
    radii, forces, approaches = np.array(states).reshape(-1, 3).T.copy()
    cell_count, dofs = compat.cell_count(problem.mesh), compat.dof_count(problem.space)
    return Indentation(window, radii, forces, approaches, onset, hertz, cell_count, dofs, problem.iterations, block)


class _EdgeFinder:
    """Where the gap closes: found from the open side, between the two Gauss points where the penalty changes."""

    def __init__(self, space: Any, block: ContactBlock, curvature: float) -> None:
        at = space.tabulate_dof_coordinates()
        nodes = np.flatnonzero((at[:, 1] < 1e-7) & (at[:, 0] < block.patch * (1 + 1e-7)))
        nodes = nodes[np.argsort(at[nodes, 0])]
        self.dofs = 2 * nodes + 1
        g = np.array([-1, 1]) / np.sqrt(3)
        self.shape = np.stack([g * (g - 1) / 2, 1 - g * g, g * (g + 1) / 2])
        corners = at[nodes[::2], 0]
        self.x = (corners[:-1, None] + np.diff(corners)[:, None] * (1 + g) / 2).ravel()
        self.profile = curvature * self.x**2 / 2

    def __call__(self, values: NDArray[np.float64], approach: float) -> float:
        """Contact radius; beyond the patch's end when the gap is closed nearly everywhere."""
        w = values[self.dofs]
        gap = self.profile - approach
        gap += sum(
            part[:, None] * shape for part, shape in zip((w[:-2:2], w[1:-1:2], w[2::2]), self.shape, strict=True)
        ).ravel()
        closed = np.flatnonzero(gap < 0)
        last = int(closed[-1]) if closed.size else 0
        if last + 5 >= gap.size:
            return float(self.x[-1])
        # the gap opens like a distance to the power 3/2
        chosen = np.arange(last + 2, last + 5)
        slope, offset = np.polyfit(self.x[chosen], np.maximum(gap[chosen], 0) ** (2 / 3), 1)
        return float(np.clip(-offset / slope, self.x[last], self.x[last + 1]))
