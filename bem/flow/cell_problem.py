"""Reynolds' equation on a periodic rough patch: mean flow and mean shear for given mean gradients.

The patch is at rest, the smooth wall opposite moves. With the gap h, Poiseuille flow along e solves

    div(h^3 (e + grad chi)) = 0,                     mean flow   K e = <h^3 (e + grad chi)>,

and the Couette flow driven by the wall's motion along x solves

    div(h^3 grad chi_s) = dh/dx,                     mean flow   <h e_x - h^3 grad chi_s> = M' e_x,

chi periodic: the cell problems of homogenisation (Bayada and Faure, Journal of Tribology 111 (1989) 323; Almqvist,
Lukkassen, Meidell and Wall, International Journal of Engineering Science 45 (2007) 516). Multiplying each equation by
the other's unknown gives M' = M^T with M e = <h (e + grad chi)>: the Couette flow follows from the pressure problems,
and the third problem is needed for the shear stress only.

1. Build the links between neighbouring cells (`Links`). Finite volumes: each cell has one gap. A flow from centre to
   centre passes half of either cell in series, so the h^3 of a link is the harmonic mean over its two cells, and a cell
   without gap carries no flow.
2. Label the clusters of open cells (`percolation`). Clusters that do not percolate have e + grad chi = 0 exactly and
   are left out of the pressure problems.
3. Solve the two pressure problems on percolating clusters (`_pressure_flow`, by `multigrid`).
4. Solve the shear problem on all open cells (`_sliding_shear`), with the mean of 1/h from `inverse_gap` beside contact.

Straight grooves along or across the flow are exact on any grid, other surfaces of second order in the cell. Cost: three
networks of one node per open cell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.flow.inverse_gap import InverseGap
from bem.flow.multigrid import Network, solve_network
from bem.flow.percolation import label_clusters
from bem.grid import FloatArray

NEGLIGIBLE = 1e-4
"""Least flow over straight flow to which the residual is relative; below it residuals are round-off."""


@dataclass(frozen=True, eq=False)
class CellFlow:
    """Means over a patch with the gap h, in the unit of the gap.

    Attributes
    ----------
    pressure_flow : (2, 2), K: mean Poiseuille flow along i for a unit gradient along j, of order h^3.
    couette_gap : (2, 2), M: mean of h (e_j + grad chi_j) along i, of order h; the mean gap for smooth walls. Row i is
        twice the Couette flow through the patch, in its own frame, while the smooth wall moves along i with unit speed.
    sliding_shear : mean of h d(chi_s)/dx, of order 1/h; the shear stress on the smooth wall in sliding at U is
        mu U (<1/h> + 3 sliding_shear), whose first term is in `bem.flow.inverse_gap`.
    mean_gap, open_fraction : of all cells.
    percolates_x, percolates_y : whether the fluid percolates along the axis.
    iterations : of conjugate gradients, all problems together.
    residual : largest of the problems: sum of the cells' imbalances of flow over the flow through a section of the
        patch (over 1e-4 of the straight flow where less flows), recomputed from the solution.
    status : converged if the residual is at most the tolerance.
    """

    pressure_flow: FloatArray
    couette_gap: FloatArray
    sliding_shear: float
    mean_gap: float
    open_fraction: float
    percolates_x: bool
    percolates_y: bool
    iterations: int
    residual: float
    status: Status


@dataclass(frozen=True, eq=False)
class Links:
    """Links from each cell to the next along an axis, in the unit of the gap.

    Attributes
    ----------
    axis : 0 or 1.
    cubed_gap : (nx, ny), harmonic mean of h^3 over both cells; 0 where one of them is closed.
    gap : (nx, ny), mean of the gap weighted by the pressure gradient on the link.
    step : distance of the centres.
    width : side of the cells across the link.
    """

    axis: int
    cubed_gap: FloatArray
    gap: FloatArray
    step: float
    width: float

    @classmethod
    def of(cls, gap: FloatArray, spacing: tuple[float, float], axis: int) -> Links:
        """Build the links of a periodic patch of cells (nx, ny)."""
        other = np.roll(gap, -1, axis)
        both = (gap > 0) & (other > 0)
        here, there = np.where(both, gap, 1.0), np.where(both, other, 1.0)
        cubed_gap = np.where(both, 2 / (here**-3 + there**-3), 0.0)
        mean = cubed_gap * (here**-2 + there**-2) / 2
        return cls(axis, cubed_gap, mean, spacing[axis], spacing[1 - axis])

    def difference(self, potential: FloatArray) -> FloatArray:
        """Return the difference of the potential from each cell to the next, (nx, ny)."""
        return np.roll(potential, -1, self.axis) - potential

    def divergence(self, flow: FloatArray) -> FloatArray:
        """Return the net flow of the links out of each cell, (nx, ny)."""
        return (flow - np.roll(flow, 1, self.axis)) * self.width


def cell_flow(
    gap: FloatArray,
    spacing: tuple[float, float],
    *,
    tolerance: float = 1e-8,
    inverse: InverseGap | None = None,
    max_iterations: int = 300,
    shear: bool = True,
) -> CellFlow:
    """Solve the cell problems of a periodic patch.

    Parameters
    ----------
    gap : (nx, ny), >= 0, zero in contact; any unit (of order one is best).
    spacing : (dx, dy), any unit.
    tolerance, max_iterations : of the solver, relative to the flow.
    inverse : mean of one over the gap in each cell, for `sliding_shear`. Beside contact one over the gap of the centre
        has no limit. None takes the gap of the centre.
    shear : whether to solve for `sliding_shear`, which is not-a-number otherwise.
    """
    links = Links.of(gap, spacing, 0), Links.of(gap, spacing, 1)
    clusters = label_clusters(gap > 0)
    solutions = [
        _pressure_flow(links, clusters.percolating_cells(axis), axis, tolerance, max_iterations) for axis in (0, 1)
    ]
    sliding = _sliding_shear(gap, links, inverse, tolerance, max_iterations) if shear else _CellSolution.constant()
    every = (*solutions, sliding)
    residual = max(each.residual for each in every)
    out_of_time = any(each.residual > tolerance and each.iterations >= max_iterations for each in every)
    unmet = Status.MAX_ITERATIONS if out_of_time else Status.STALLED
    return CellFlow(
        pressure_flow=np.stack([each.flow for each in solutions], axis=1),
        couette_gap=np.stack([each.couette_gap for each in solutions], axis=1),
        sliding_shear=float(sliding.flow[0]),
        mean_gap=float(gap.mean()),
        open_fraction=float((gap > 0).mean()),
        percolates_x=bool(clusters.wraps_x.any()),
        percolates_y=bool(clusters.wraps_y.any()),
        iterations=sum(each.iterations for each in every),
        residual=residual,
        status=Status.CONVERGED if residual <= tolerance else unmet,
    )


@dataclass(frozen=True, eq=False)
class _CellSolution:
    """Solution of one cell problem: a column of K and a column of M.

    Attributes
    ----------
    flow : (2,), mean flow; of the shear problem (mean of h dchi_s/dx, 0).
    couette_gap : (2,), mean of h (e + grad chi).
    iterations : of conjugate gradients.
    residual : relative to the flow.
    """

    flow: FloatArray
    couette_gap: FloatArray
    iterations: int
    residual: float

    @classmethod
    def constant(cls, value: float = np.nan) -> _CellSolution:
        """Return the solution of a problem that is not solved, with a constant in place of each mean."""
        return cls(np.full(2, value), np.full(2, value), 0, 0.0)


def _pressure_flow(
    links: tuple[Links, Links], inside: NDArray[np.bool_], axis: int, tolerance: float, max_iterations: int
) -> _CellSolution:
    """Solve for the flow under a unit gradient along `axis` in the cells of percolating clusters."""
    if not inside.any():
        return _CellSolution.constant(0.0)
    own = links[axis]
    cubed_gap = np.where(inside, own.cubed_gap, 0.0)
    divergence = own.divergence(cubed_gap)
    straight = float(cubed_gap.sum()) * own.width / inside.shape[axis]
    least = NEGLIGIBLE * straight

    def section_flow(potential: FloatArray) -> float:
        # flow through a section, averaged over all sections
        turned = float((divergence[inside] * potential).sum()) / (inside.shape[axis] * own.step)
        return max(straight - turned, least)

    potential, iterations, imbalance = _solve_cells(
        links, inside, divergence, lambda trial: tolerance * section_flow(trial), max_iterations
    )
    flow, couette_gap = np.zeros(2), np.zeros(2)
    for other, link in enumerate(links):
        drop = link.difference(potential) / link.step + (1.0 if other == axis else 0.0)
        drop = np.where(inside & (link.cubed_gap > 0), drop, 0.0)
        flow[other], couette_gap[other] = (link.cubed_gap * drop).mean(), (link.gap * drop).mean()
    return _CellSolution(flow, couette_gap, iterations, imbalance / section_flow(potential[inside]))


def _sliding_shear(
    gap: FloatArray, links: tuple[Links, Links], inverse: InverseGap | None, tolerance: float, max_iterations: int
) -> _CellSolution:
    """Return the mean of h d(chi_s)/dx over all open cells; the shear stress on the smooth wall needs three times it.

    With the flow q = h - h^3 dchi_s/dx it is the mean of 1/h (1 - q/h). Towards contact 1/h has no limit, but 1 - q/h
    tends to n_x^2, n being the normal of the contact's edge: the flow across the edge vanishes like h s, s being the
    distance from it, and the flow along it is the Couette flow, because h^3 vanishes faster. Cells beside the edge take
    this limit, because their own edge is a staircase; other open cells take the value at their centre, and closed cells
    the mean of their open neighbours.
    """
    inside = gap > 0
    if not inside.any():
        return _CellSolution.constant(0.0)
    along = links[0]
    couette_flow = gap.mean() * gap.shape[1] * along.width
    potential, iterations, imbalance = _solve_cells(
        links, inside, -along.divergence(along.gap), lambda _: tolerance * couette_flow, max_iterations
    )
    flow = along.gap - along.cubed_gap * along.difference(potential) / along.step
    safe = np.where(inside, gap, 1.0)
    # each half of a cell has the flow of its link
    deficit = np.where(inside, 1 - (flow + np.roll(flow, 1, 0)) / (2 * safe), 0.0)
    if inverse is None:
        mean = np.where(inside, deficit / safe, 0.0).mean()
    else:
        deficit = np.where(np.isnan(inverse.normal_x_squared), deficit, inverse.normal_x_squared)
        mean = (_extrapolate(deficit, inside) * inverse.means).mean()
    return _CellSolution(np.array([mean, 0.0]), np.zeros(2), iterations, imbalance / couette_flow)


def _extrapolate(field: FloatArray, known: NDArray[np.bool_]) -> FloatArray:
    """Return the field with the mean of the known neighbours in unknown cells; 0 where there are none."""
    total, count = np.zeros(field.shape), np.zeros(field.shape)
    for axis in (0, 1):
        for way in (-1, 1):
            beside = np.roll(known, way, axis)
            total += np.where(beside, np.roll(field, way, axis), 0.0)
            count += beside
    return np.where(known, field, total / np.maximum(count, 1))


def _solve_cells(
    links: tuple[Links, Links],
    inside: NDArray[np.bool_],
    divergence: FloatArray,
    max_imbalance: Callable[[FloatArray], float],
    max_iterations: int,
) -> tuple[FloatArray, int, float]:
    """Solve one cell problem as a network of the cells inside.

    Parameters
    ----------
    links : along both axes.
    inside : (nx, ny), cells of the network.
    divergence : (nx, ny), net flow out of every cell at zero potential.
    max_imbalance : bound on the sum of the cells' imbalances, as a function of the potential inside.
    most : iterations at most.

    Returns
    -------
    Potential (nx, ny), zero outside; number of iterations; sum of the cells' imbalances.
    """
    number = np.full(inside.shape, -1, dtype=np.int32)
    number[inside] = np.arange(int(inside.sum()), dtype=np.int32)
    first, second, conductance = [], [], []
    for link in links:
        used = inside & (link.cubed_gap > 0)
        first.append(number[used])
        second.append(np.roll(number, -1, link.axis)[used])
        conductance.append(link.cubed_gap[used] * link.width / link.step)
    network = Network.of_links(
        int(inside.sum()), np.concatenate(first), np.concatenate(second), np.concatenate(conductance)
    )
    source = divergence[inside]
    solved, iterations = solve_network(network, source, max_imbalance, max_iterations)
    imbalance = float(np.abs(network.residual(solved, source)).sum())
    potential = np.zeros(inside.shape)
    potential[inside] = solved
    return potential, iterations, imbalance
