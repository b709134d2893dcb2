"""Reynolds' equation on a periodic rough patch: mean flow and mean shear for given mean gradients.

The patch is at rest, the smooth wall opposite moves. With the gap h, pressure flow along e solves

    div(h^3 (e + grad chi)) = 0,                     mean flow   K e = <h^3 (e + grad chi)>,

and the Couette flow driven by the wall's motion along x solves

    div(h^3 grad chi_s) = dh/dx,                     mean flow   <h e_x - h^3 grad chi_s> = M' e_x,

chi periodic: the cell problems of homogenisation (Bayada and Faure, Journal of Tribology 111 (1989) 323; Almqvist,
Lukkassen, Meidell and Wall, International Journal of Engineering Science 45 (2007) 516). Multiplying each equation by
the other's unknown gives M' = M^T with M e = <h (e + grad chi)>: the Couette flow follows from the pressure problems,
and the third problem is needed for the shear stress only.

Finite volumes: each cell has one gap. A flow from centre to centre passes half of either cell in series, so the h^3 of
a link is the harmonic mean over its two cells, and a cell without gap carries no flow. Straight grooves along or across
the flow are exact on any grid, other surfaces of second order in the cell. Pieces of fluid that do not reach around the
patch have e + grad chi = 0 exactly; they are labelled and left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.flow.inverse_gap import InverseGap
from bem.flow.multigrid import Network, solve
from bem.flow.percolation import open_pieces
from bem.grid import FloatArray

NEGLIGIBLE = 1e-4
"""Flow over straight flow below which the residual is relative to this fraction of the straight flow (round-off)."""


@dataclass(frozen=True, eq=False)
class CellFlow:
    """Means over a patch with the gap h, in the unit of the gap.

    Attributes
    ----------
    pressure_flow : (2, 2), K: mean Poiseuille flow along i for a unit gradient along j, of order h^3.
    dragged_flow : (2, 2), M: mean of h (e_j + grad chi_j) along i, of order h. Row i is twice the Couette flow through
        the patch, in its own frame, while the smooth wall moves along i with unit speed.
    sliding_shear : mean of h d(chi_s)/dx, of order 1/h; the shear stress on the smooth wall in sliding at U is
        mu U (<1/h> + 3 sliding_shear), whose first term is in `bem.flow.inverse_gap`.
    mean_gap, open_fraction : of all cells.
    through_x, through_y : whether the fluid percolates along the axis.
    iterations : of conjugate gradients, all problems together.
    residual : largest of the problems: sum of the cells' imbalances of flow over the flow through a section of the
        patch (over 1e-4 of the straight flow where less flows), recomputed from the solution.
    status : converged if the residual is at most the tolerance.
    """

    pressure_flow: FloatArray
    dragged_flow: FloatArray
    sliding_shear: float
    mean_gap: float
    open_fraction: float
    through_x: bool
    through_y: bool
    iterations: int
    residual: float
    status: Status


@dataclass(frozen=True, eq=False)
class Links:
    """Links from each cell to the next along an axis.

    Attributes
    ----------
    axis : 0 or 1.
    cube : (nx, ny), cubed gap of both half cells in series.
    gap : (nx, ny), mean of the gap weighted by the pressure gradient on the link.
    step : distance of the centres.
    width : side of the cells across the link.
    """

    axis: int
    cube: FloatArray
    gap: FloatArray
    step: float
    width: float

    @classmethod
    def of(cls, gap: FloatArray, spacing: tuple[float, float], axis: int) -> Links:
        """Build the links of a periodic patch of cells (nx, ny)."""
        other = np.roll(gap, -1, axis)
        both = (gap > 0) & (other > 0)
        here, there = np.where(both, gap, 1.0), np.where(both, other, 1.0)
        cube = np.where(both, 2 / (here**-3 + there**-3), 0.0)
        mean = cube * (here**-2 + there**-2) / 2
        return cls(axis, cube, mean, spacing[axis], spacing[1 - axis])

    def difference(self, potential: FloatArray) -> FloatArray:
        """Difference of the potential from each cell to the next."""
        return np.roll(potential, -1, self.axis) - potential

    def net(self, flow: FloatArray) -> FloatArray:
        """Net flow of the links out of each cell."""
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
    inverse : mean of one over the gap in each cell, for `sliding_shear`; it differs from one over the centre's gap
        beside contact, where that grows without limit. None takes the centres' gaps.
    shear : whether to solve for `sliding_shear`, which is not-a-number otherwise.
    """
    links = Links.of(gap, spacing, 0), Links.of(gap, spacing, 1)
    pieces = open_pieces(gap > 0)
    columns = [_pressure_flow(links, pieces.around(axis), axis, tolerance, max_iterations) for axis in (0, 1)]
    sliding = _sliding_shear(gap, links, inverse, tolerance, max_iterations) if shear else _Column.without()
    every = (*columns, sliding)
    residual = max(column.residual for column in every)
    out_of_time = any(column.residual > tolerance and column.iterations >= max_iterations for column in every)
    unmet = Status.MAX_ITERATIONS if out_of_time else Status.STALLED
    return CellFlow(
        pressure_flow=np.stack([column.flow for column in columns], axis=1),
        dragged_flow=np.stack([column.dragged for column in columns], axis=1),
        sliding_shear=float(sliding.flow[0]),
        mean_gap=float(gap.mean()),
        open_fraction=float((gap > 0).mean()),
        through_x=bool(pieces.around_x.any()),
        through_y=bool(pieces.around_y.any()),
        iterations=sum(column.iterations for column in every),
        residual=residual,
        status=Status.CONVERGED if residual <= tolerance else unmet,
    )


@dataclass(frozen=True, eq=False)
class _Column:
    """Solution of one cell problem: a column of K and of M.

    Attributes
    ----------
    flow : (2,), mean flow; of the shear problem its mean alone.
    dragged : (2,), mean of h (e + grad chi).
    iterations : of conjugate gradients.
    residual : relative to the flow.
    """

    flow: FloatArray
    dragged: FloatArray
    iterations: int
    residual: float

    @classmethod
    def without(cls, value: float = np.nan) -> _Column:
        """Return the column of a problem that is not solved."""
        return cls(np.full(2, value), np.full(2, value), 0, 0.0)


def _pressure_flow(
    links: tuple[Links, Links], inside: NDArray[np.bool_], axis: int, tolerance: float, most: int
) -> _Column:
    """Solve for the flow under a unit gradient along `axis` in the cells of percolating pieces."""
    if not inside.any():
        return _Column.without(0.0)
    own = links[axis]
    cube = np.where(inside, own.cube, 0.0)
    divergence = own.net(cube)
    straight = float(cube.sum()) * own.width / inside.shape[axis]
    least = NEGLIGIBLE * straight

    def through(potential: FloatArray) -> float:
        # flow through a section, averaged over all sections
        turned = float((divergence[inside] * potential).sum()) / (inside.shape[axis] * own.step)
        return max(straight - turned, least)

    potential, iterations, left = _solve_network(
        links, inside, divergence, lambda trial: tolerance * through(trial), most
    )
    flow, dragged = np.zeros(2), np.zeros(2)
    for other, link in enumerate(links):
        drop = link.difference(potential) / link.step + (1.0 if other == axis else 0.0)
        drop = np.where(inside & (link.cube > 0), drop, 0.0)
        flow[other], dragged[other] = (link.cube * drop).mean(), (link.gap * drop).mean()
    return _Column(flow, dragged, iterations, left / through(potential[inside]))


def _sliding_shear(
    gap: FloatArray, links: tuple[Links, Links], inverse: InverseGap | None, tolerance: float, most: int
) -> _Column:
    """Return the mean of h d(chi_s)/dx over all open cells; the shear stress on the smooth wall needs three times it.

    With the flow q = h - h^3 dchi_s/dx it is the mean of 1/h (1 - q/h). Towards contact 1/h has no limit, but 1 - q/h
    tends to n_x^2, n being the normal of the contact's edge: the flow across the edge vanishes like h s, s being the
    distance from it, and the flow along it is the Couette flow, because h^3 vanishes faster. Cells beside the edge take
    this limit, because their own edge is a staircase; other open cells take the value at their centre, and closed cells
    the mean of their open neighbours.
    """
    inside = gap > 0
    if not inside.any():
        return _Column.without(0.0)
    along = links[0]
    couette_flow = gap.mean() * gap.shape[1] * along.width
    potential, iterations, left = _solve_network(
        links, inside, -along.net(along.gap), lambda _: tolerance * couette_flow, most
    )
    flow = along.gap - along.cube * along.difference(potential) / along.step
    safe = np.where(inside, gap, 1.0)
    # each half of a cell has the flow of its link
    deficit = np.where(inside, 1 - (flow + np.roll(flow, 1, 0)) / (2 * safe), 0.0)
    if inverse is None:
        mean = np.where(inside, deficit / safe, 0.0).mean()
    else:
        deficit = np.where(np.isnan(inverse.normal_x), deficit, inverse.normal_x)
        mean = (_extrapolate(deficit, inside) * inverse.means).mean()
    return _Column(np.array([mean, 0.0]), np.zeros(2), iterations, left / couette_flow)


def _extrapolate(field: FloatArray, known: NDArray[np.bool_]) -> FloatArray:
    """Return the field with the mean of the known neighbours in unknown cells; 0 where there are none."""
    total, count = np.zeros(field.shape), np.zeros(field.shape)
    for axis in (0, 1):
        for way in (-1, 1):
            beside = np.roll(known, way, axis)
            total += np.where(beside, np.roll(field, way, axis), 0.0)
            count += beside
    return np.where(known, field, total / np.maximum(count, 1))


def _solve_network(
    links: tuple[Links, Links],
    inside: NDArray[np.bool_],
    divergence: FloatArray,
    allowed: Callable[[FloatArray], float],
    most: int,
) -> tuple[FloatArray, int, float]:
    """Solve one network problem on the cells inside.

    Parameters
    ----------
    links : along both axes.
    inside : (nx, ny), cells of the network.
    divergence : (nx, ny), net flow out of every cell at zero potential.
    allowed : bound on the sum of the cells' imbalances, as a function of the potential inside.
    most : iterations at most.

    Returns
    -------
    Potential (nx, ny), zero outside; number of iterations; sum of the cells' imbalances.
    """
    number = np.full(inside.shape, -1, dtype=np.int32)
    number[inside] = np.arange(int(inside.sum()), dtype=np.int32)
    first, second, conductance = [], [], []
    for link in links:
        used = inside & (link.cube > 0)
        first.append(number[used])
        second.append(np.roll(number, -1, link.axis)[used])
        conductance.append(link.cube[used] * link.width / link.step)
    network = Network.of_links(
        int(inside.sum()), np.concatenate(first), np.concatenate(second), np.concatenate(conductance)
    )
    source = divergence[inside]
    found, iterations = solve(network, source, allowed, most)
    left = float(np.abs(network.leak(found, source)).sum())
    potential = np.zeros(inside.shape)
    potential[inside] = found
    return potential, iterations, left
