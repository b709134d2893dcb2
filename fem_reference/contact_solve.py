"""Frictionless contact of a convex symmetric profile with a condensed body: a linear complementarity problem.

Unknown are nodal pressures p >= 0 and the approach; the gap, weighted with each pressure shape, is >= 0 and zero
where p > 0 (the mixed form of the variational inequality, whose multiplier is the pressure). On a fixed mesh every
figure depends on where the edge of contact falls inside a cell, which spoils convergence studies. So the problem is
solved exactly at the loads at which the edge stands *on* a node, one load per node, where the next pressure and the
next gap are zero together; in between the solutions are interpolated along that branch. What the mesh does to the
edge is then the same at all loads and all meshes, and errors fall in clean orders. Needs numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

STENCIL = 6
"""Solutions of the branch between which a load is interpolated (polynomial of degree 5)."""


@dataclass(frozen=True)
class Branch:
    """All contact states with the edge on a node.

    Parameters
    ----------
    nodes : (n,) positions of the pressure nodes.
    edges : (m,) indices of the nodes at which the edge stands.
    forces : (m,) half-plane or per-radian force, growing.
    approaches : (m,) rigid approach.
    pressures : (m, n) nodal pressures.
    gaps : (m, n) gap weighted with each pressure shape.
    """

    nodes: NDArray[np.float64]
    edges: NDArray[np.int64]
    forces: NDArray[np.float64]
    approaches: NDArray[np.float64]
    pressures: NDArray[np.float64]
    gaps: NDArray[np.float64]


@dataclass(frozen=True)
class ContactState:
    """One load: the edge's position, the approach, nodal pressures and weighted gaps."""

    force: float
    edge: float
    approach: float
    pressure: NDArray[np.float64]
    gap: NDArray[np.float64]


def trace_branch(
    nodes: NDArray[np.float64],
    compliance: NDArray[np.float64],
    weights: NDArray[np.float64],
    profile: NDArray[np.float64],
    *,
    first: int = 2,
) -> Branch:
    """Solve for every edge node from `first` on.

    profile : (n,) height of the gap before deformation, weighted with each pressure shape.
    RuntimeError where a state breaks the complementarity conditions (a profile that is not convex enough touches
    elsewhere first).
    """
    count = nodes.size
    forces, approaches, pressures, gaps, edges = [], [], [], [], []
    for edge in range(first, count):
        rows = edge + 1
        system = np.column_stack([compliance[:rows, :edge], -weights[:rows]])
        solution = np.linalg.solve(system, -profile[:rows])
        pressure = np.zeros(count)
        pressure[:edge] = solution[:-1]
        approach = solution[-1]
        gap = compliance @ pressure + profile - approach * weights
        if edge >= 4:
            if np.min(pressure) < -1e-9 * np.max(pressure):
                raise RuntimeError(f"tension inside the contact with its edge at {nodes[edge]:g}")
            if np.min(gap / weights) < -1e-9 * abs(np.max(profile / weights)):
                raise RuntimeError(f"overlap outside the contact with its edge at {nodes[edge]:g}")
        edges.append(edge)
        forces.append(weights @ pressure)
        approaches.append(approach)
        pressures.append(pressure)
        gaps.append(gap)
    forces_array = np.asarray(forces)
    if np.any(np.diff(forces_array) <= 0):
        raise RuntimeError("the contact does not grow with the load: the profile is not convex enough")
    return Branch(
        nodes, np.asarray(edges), forces_array, np.asarray(approaches), np.asarray(pressures), np.asarray(gaps)
    )


def at_force(branch: Branch, force: float) -> ContactState:
    """The state at a force, interpolated along the branch; ValueError when the patch cannot hold it."""
    inside = (branch.forces[0], branch.forces[-2])
    if not inside[0] <= force <= inside[1]:
        raise ValueError(f"force {force:g} is not between {inside[0]:g} and {inside[1]:g}, which the patch resolves")
    after = int(np.searchsorted(branch.forces, force))
    start = int(np.clip(after - STENCIL // 2, 0, branch.forces.size - STENCIL))
    chosen = np.arange(start, start + STENCIL)

    def lagrange(t: float) -> NDArray[np.float64]:
        return np.array([np.prod([(t - b) / (a - b) for b in chosen if b != a]) for a in chosen])

    low, high = float(max(after - 1, 0)), float(after)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if lagrange(middle) @ branch.forces[chosen] < force else (low, middle)
    weights = lagrange(0.5 * (low + high))
    return ContactState(
        force=force,
        edge=float(weights @ branch.nodes[branch.edges[chosen]]),
        approach=float(weights @ branch.approaches[chosen]),
        pressure=weights @ branch.pressures[chosen],
        gap=weights @ branch.gaps[chosen],
    )


def weighted_profile(nodes: NDArray[np.float64], profile: object, *, axisymmetric: bool) -> NDArray[np.float64]:
    """Integral of a profile.

    (callable of position) with each piecewise linear shape, (n,), by six Gauss points a cell.
    """
    points, factors = np.polynomial.legendre.leggauss(6)
    left, right = nodes[:-1, None], nodes[1:, None]
    x = left + (right - left) * (1 + points) / 2
    integrand = profile(x) * factors * (right - left) / 2 * (x if axisymmetric else 1.0)  # type: ignore[operator]
    rising = (x - left) / (right - left)
    found = np.zeros(nodes.size)
    found[:-1] += np.sum(integrand * (1 - rising), axis=1)
    found[1:] += np.sum(integrand * rising, axis=1)
    return found
