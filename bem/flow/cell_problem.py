"""Reynolds' equation on a rough patch that repeats for ever: mean flow and mean shear for given mean gradients.

The patch is at rest, the smooth wall opposite moves. With the gap h, pressure flow along e solves

    div(h^3 (e + grad chi)) = 0,                     mean flow   K e = <h^3 (e + grad chi)>,

and the flow that the wall's motion along x drags through solves

    div(h^3 grad chi_s) = dh/dx,                     mean flow   <h e_x - h^3 grad chi_s> = M' e_x,

chi periodic: the cell problems of homogenisation (Bayada and Faure, Journal of Tribology 111 (1989) 323; Almqvist,
Lukkassen, Meidell and Wall, International Journal of Engineering Science 45 (2007) 516). Multiplying each equation by
the other's unknown gives M' = M^T with M e = <h (e + grad chi)>: the dragged flow follows from the pressure problems,
and the third problem is needed for the shear stress only.

Cells have one gap each. What flows from centre to centre meets half of either cell in series, so a link's h^3 is the
harmonic mean of its cells' and a cell without gap carries nothing; surfaces of straight grooves along or across are
then exact on any grid, others of second order in the cell. Pieces of fluid that do not reach round the patch have
e + grad chi = 0 exactly; they are found by labelling and left out.
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
"""Share of the mean h^3 below which a flow's error is measured by that, and not by the flow: rounding is."""


@dataclass(frozen=True, eq=False)
class CellFlow:
    """Means over a patch of the gap h, in the units of the gap given.

    Attributes
    ----------
    pressure_flow : (2, 2), K: mean flow along i for a unit gradient along j, of order h^3.
    dragged_flow : (2, 2), M: mean of h (e_j + grad chi_j) along i, of order h. Twice the flow through the patch, in
        its own frame, while the smooth wall moves along i with unit speed, is row i.
    sliding_shear : mean of h d(chi_s)/dx, of order 1/h; the shear stress on the smooth wall in sliding at U is
        mu U (<1/h> + 3 sliding_shear), whose first term is in `bem.flow.inverse_gap`.
    mean_gap, open_fraction : of all cells.
    through_x, through_y : whether fluid hangs together from patch to patch.
    iterations : of conjugate gradients, all problems together.
    residual : largest of the problems: what all cells lack or have too much, over what flows through a section of the
        patch (over 1e-4 of what would if it could flow straight, where less than that flows); recomputed from the
        solution.
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
    """The links of every cell with the next one along an axis, (nx, ny): `cube` the gap that is the same as both halves
    in series, cubed; `gap` the mean gap along a unit drop."""

    axis: int
    cube: FloatArray
    gap: FloatArray
    step: float
    width: float

    @classmethod
    def of(cls, gap: FloatArray, spacing: tuple[float, float], axis: int) -> Links:
        """Of cells (nx, ny), the last of which are linked with the first."""
        other = np.roll(gap, -1, axis)
        both = (gap > 0) & (other > 0)
        here, there = np.where(both, gap, 1.0), np.where(both, other, 1.0)
        cube = np.where(both, 2 / (here**-3 + there**-3), 0.0)
        mean = cube * (here**-2 + there**-2) / 2
        return cls(axis, cube, mean, spacing[axis], spacing[1 - axis])

    def difference(self, potential: FloatArray) -> FloatArray:
        """From each cell to the next."""
        return np.roll(potential, -1, self.axis) - potential

    def net(self, flow: FloatArray) -> FloatArray:
        """What the links carry out of each cell."""
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
    """Mean flow and shear of a periodic patch.

    Parameters
    ----------
    gap : (nx, ny), >= 0, zero in contact; any unit (of order one is best).
    spacing : (dx, dy), any unit.
    tolerance, max_iterations : of the solver, relative to the flow.
    inverse : of the gap, for `sliding_shear`, where centres do not say it: next to contact, towards which it has no
        limit; one over the gap of each open cell if None.
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
    """What one problem gives: mean flow (2,) and mean of h (e + grad chi) (2,); the shear problem its mean alone."""

    flow: FloatArray
    dragged: FloatArray
    iterations: int
    residual: float

    @classmethod
    def without(cls, value: float = np.nan) -> _Column:
        """Of a problem that is not solved."""
        return cls(np.full(2, value), np.full(2, value), 0, 0.0)


def _pressure_flow(
    links: tuple[Links, Links], inside: NDArray[np.bool_], axis: int, tolerance: float, most: int
) -> _Column:
    """Under a unit gradient along `axis`, in the cells of pieces that reach round the patch along it."""
    if not inside.any():
        return _Column.without(0.0)
    own = links[axis]
    cube = np.where(inside, own.cube, 0.0)
    driven = own.net(cube)
    straight = float(cube.sum()) * own.width / inside.shape[axis]
    least = NEGLIGIBLE * straight

    def through(potential: FloatArray) -> float:
        # flow through a section, the mean over all of them
        turned = float((driven[inside] * potential).sum()) / (inside.shape[axis] * own.step)
        return max(straight - turned, least)

    potential, iterations, left = _solved(links, inside, driven, lambda found: tolerance * through(found), most)
    flow, dragged = np.zeros(2), np.zeros(2)
    for other, link in enumerate(links):
        drop = link.difference(potential) / link.step + (1.0 if other == axis else 0.0)
        drop = np.where(inside & (link.cube > 0), drop, 0.0)
        flow[other], dragged[other] = (link.cube * drop).mean(), (link.gap * drop).mean()
    return _Column(flow, dragged, iterations, left / through(potential[inside]))


def _sliding_shear(
    gap: FloatArray, links: tuple[Links, Links], inverse: InverseGap | None, tolerance: float, most: int
) -> _Column:
    """Mean of h d(chi_s)/dx in all open cells, of which the shear stress on the smooth wall needs thrice.

    With the flow q = h - h^3 dchi_s/dx it is that of 1/h (1 - q/h). Towards contact 1/h has no limit, but 1 - q/h has:
    what flows across the edge vanishes like h s, s the distance from it, and what flows along it is what the wall drags
    there, as h^3 vanishes faster. It comes to n_x^2, n being the edge's normal. Cells beside the edge, which
    is steps for them, have that; others what they have at their centre; closed ones what those beside have.
    """
    inside = gap > 0
    if not inside.any():
        return _Column.without(0.0)
    along = links[0]
    dragged = gap.mean() * gap.shape[1] * along.width
    potential, iterations, left = _solved(links, inside, -along.net(along.gap), lambda _: tolerance * dragged, most)
    flow = along.gap - along.cube * along.difference(potential) / along.step
    safe = np.where(inside, gap, 1.0)
    # each half of a cell has the flow of its link
    held = np.where(inside, 1 - (flow + np.roll(flow, 1, 0)) / (2 * safe), 0.0)
    if inverse is None:
        mean = np.where(inside, held / safe, 0.0).mean()
    else:
        held = np.where(np.isnan(inverse.normal_x), held, inverse.normal_x)
        mean = (_gone_on(held, inside) * inverse.means).mean()
    return _Column(np.array([mean, 0.0]), np.zeros(2), iterations, left / dragged)


def _gone_on(field: FloatArray, known: NDArray[np.bool_]) -> FloatArray:
    """A field with the mean of the known cells beside in cells where it is not known; 0 where there are none."""
    total, count = np.zeros(field.shape), np.zeros(field.shape)
    for axis in (0, 1):
        for way in (-1, 1):
            beside = np.roll(known, way, axis)
            total += np.where(beside, np.roll(field, way, axis), 0.0)
            count += beside
    return np.where(known, field, total / np.maximum(count, 1))


def _solved(
    links: tuple[Links, Links],
    inside: NDArray[np.bool_],
    driven: FloatArray,
    allowed: Callable[[FloatArray], float],
    most: int,
) -> tuple[FloatArray, int, float]:
    """The potential (nx, ny), zero outside; iterations; the sum over cells of what they lack or have too much.

    driven : (nx, ny), what leaves every cell at no potential. allowed : that sum, for the potential inside.
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
    source = driven[inside]
    found, iterations = solve(network, source, allowed, most)
    left = float(np.abs(network.leak(found, source)).sum())
    potential = np.zeros(inside.shape)
    potential[inside] = found
    return potential, iterations, left
