"""The same contact solved another way: the displacement itself bounded by the rigid indenter, by PETSc's SNES.

A check of the condensed, mixed solution that the stored results come from: nothing is condensed, there is no
multiplier, and the inequality holds at each node instead of on average over each pressure shape. The two converge to
each other as the mesh is refined.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from petsc4py import PETSc

from fem_reference import compat
from fem_reference.contact_body import assemble_body
from meshes.contact_block import ContactBlock


def bounded_force(
    block: ContactBlock,
    moduli: dict[str, tuple[float, float]],
    profile: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    approach: float,
    *,
    axisymmetric: bool,
) -> tuple[float, float, int]:
    """Force (per radian, or on half the width), contact radius and Newton iterations at an approach.

    profile : gap before deformation at surface positions. The radius is that of the outermost node whose reaction
        presses.
    RuntimeError when SNES does not converge.
    """
    parts = assemble_body(block, moduli, axisymmetric=axisymmetric)
    space, stiffness = parts.space, parts.stiffness
    at = space.tabulate_dof_coordinates()
    nodes = np.flatnonzero((at[:, 1] < 1e-7 * block.patch) & (at[:, 0] < block.patch * (1 + 1e-7)))
    down = 2 * nodes + 1
    lower, upper, solution = (stiffness.createVecRight() for _ in range(3))
    lower.set(PETSc.NINFINITY)
    upper.set(PETSc.INFINITY)
    lower.array[down] = approach - profile(at[nodes, 0])

    def residual(_: object, x: PETSc.Vec, f: PETSc.Vec) -> None:
        stiffness.mult(x, f)

    snes = PETSc.SNES().create(PETSc.COMM_SELF)
    snes.setType("vinewtonrsls")
    snes.setFunction(residual, solution.duplicate())
    snes.setJacobian(lambda *_: None, stiffness)
    snes.setVariableBounds(lower, upper)
    snes.setTolerances(rtol=1e-10, atol=1e-12, max_it=50)
    snes.getKSP().setType("preonly")
    snes.getKSP().getPC().setType("cholesky")
    snes.getKSP().getPC().setFactorSolverType("mumps")
    snes.solve(None, solution)
    if snes.getConvergedReason() <= 0:
        raise RuntimeError(f"SNES did not converge: reason {snes.getConvergedReason()}")
    reaction = solution.duplicate()
    stiffness.mult(solution, reaction)
    forces = reaction.array[down]
    fixed = np.isin(down, compat.fixed_dofs(parts.conditions))
    pressing = (forces > 1e-9 * np.max(forces)) & ~fixed
    return float(np.sum(forces[~fixed])), float(np.max(at[nodes[pressing], 0])), int(snes.getIterationNumber())
