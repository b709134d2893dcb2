"""The edge of contact inside cells: area and perimeter of second order from a solution on cells.

A count of the cells in contact is of first order: 8 % high on a rough surface at 256 cells a side. Next to an edge
p = k sqrt(d) at a distance d inside, and gap = 4 k d^(3/2) / (3 E*) outside (k as of a crack's tip: Johnson, *Contact
Mechanics*, section 5.1), so the pressure of the last cell inside and the gap of its neighbour outside say where the
edge crosses the link between their centres: k drops out of q = 3 E* gap / (4 p d n), d the link's length, n the cosine
between link and normal. What the discrete problem makes of that field is linear in the edge's place, so the place is
(a - b q) / (c + q) of the link, a, b, c depending on n and on how the operator represents a pressure: constant on
cells, or as waves (`spectral`). The polygon through the crossings, with what chords cut off from a curve, bounds the
contact.

The same holds with hardness less pressure in place of the pressure, and the overlap in place of the gap, where contact
turns plastic. At a step of the undeformed gap, as round a punch, the pressure has no root to follow: the edge is then
half-way between the centres.

The constants are fitted to contacts of known edge, Hertz' (cells) and Westergaard's (waves), as the cell becomes small;
crossings are met to 0.007 of a cell. `reports/experiments/contact_edge.py` fits them anew. What a narrow piece of
contact or of gap adds goes with the inverse of its number of cells along the link; those two constants are fitted to
areas of rough surfaces (`reports/experiments/contact_area.py`) and held against Hertz' and Westergaard's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.crossings import Crossed, Field, Law, cells_at_edge, cross_links, sum_squares
from bem.grid import FloatArray, Grid

_CELLS = np.array(
    [
        [10.94914, -21.2896, 11.98124, -0.71223],
        [1.38997, -2.21007, 0.69655, 0.26603],
        [14.22922, -26.58799, 13.72025, -0.27714],
    ]
)
_WAVES = np.array(
    [
        [8.30757, -15.89243, 8.63777, -0.18753],
        [0.16653, 0.41132, -1.11791, 0.68662],
        [9.27729, -15.83725, 6.33764, 1.24422],
    ]
)
"""a, b and c as polynomials in the cosine n, highest power first; for n from 0.24 to 1."""

_CELLS_ENDS = (0.0, 0.42)
_WAVES_ENDS = (0.06, 0.217)
"""How far the edge lies out for a narrow region, and in for a narrow opening beyond it: in cells, times the number of
cells along the link. Fits that weigh 256 and 512 cells in other ways give 0.059 to 0.071 and 0.20 to 0.22 (waves),
-0.01 to 0.01 and 0.42 to 0.48 (cells)."""

_LEAST_SHARE = 0.1
"""Of the cells' area: spots that barely touch a single cell have an area that no cell can tell."""


@dataclass(frozen=True)
class Region:
    """Part of the surface: area [m^2] and perimeter [m], of second order; the area of its cells as counted [m^2]; the
    length of the sides that they do not share [m]; the area with elastic edges everywhere [m^2]."""

    area: float
    perimeter: float
    counted_area: float
    sides: float
    elastic_edge_area: float

    def of_area(self, area: float) -> Region:
        """The same with another area [m^2], and a perimeter that is not shorter than its cells' sides leave it.

        A length of edge passes sides of at most sqrt(2) times its length, and the cells' edge is to that of the region
        as the roots of their areas. Where chords run back by far, as round single cells, nothing else is known of it.
        """
        share = min(area / self.counted_area, 1.0) if self.counted_area > 0 else 0.0
        return replace(self, area=area, perimeter=max(self.perimeter, math.sqrt(0.5 * share) * self.sides))


def contact_region(
    pressure: FloatArray,
    gap: FloatArray,
    undeformed: FloatArray,
    grid: Grid,
    modulus: float,
    ends: tuple[float, float] | None = None,
    cap: float = math.inf,
) -> Region:
    """The cells in contact; under a cap no less than what carries their load at the cap.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], zero outside contact. gap, undeformed : (nx, ny), deformed and undeformed gap [m].
    grid : of the cells. modulus : E* as the length of a cell sees it [Pa]. ends : what narrow contact and narrow gaps
    add, in place of the fitted constants. cap : highest pressure of a cell, the hardness [Pa].

    At an edge whose cells are at the cap the pressure has no root to follow, and the law cuts off too much: 3 % of the
    area where a tenth of the edge is so, 30 % where nearly all is. There the edge lies half-way between centres, cells
    at the cap count whole, and those between count for no less than the share of the cap that they carry. That takes
    off too much as well where edges curve or are elastic, so the larger area of both is nearer (measured in
    `tests/contact/test_contact_edge.py`).
    """
    inside = pressure > 0
    found, crossed = _region(inside, pressure, gap, undeformed, grid, modulus, ends)
    area = found.area
    if math.isfinite(cap) and inside.any():
        area = max(area, _capped_area(inside, pressure, cap, crossed, grid))
    return found.of_area(area)


def _capped_area(inside: NDArray[np.bool_], pressure: FloatArray, cap: float, crossed: Crossed, grid: Grid) -> float:
    """The area of cells in contact [m^2], each with the share of it that lies within the edge: all of a cell at the
    cap, and of others no less than their pressure over the cap."""
    numbers, beyond = cells_at_edge(crossed, inside.view(np.uint8), grid.spacing, grid.periodic)
    below_cap = np.maximum(1 - pressure.reshape(-1)[numbers] / cap, 0.0)
    beyond = np.where(below_cap > 0, np.minimum(beyond, below_cap), 0.0)
    return float(np.count_nonzero(inside) - beyond.sum()) * grid.cell_area


def plastic_region(
    pressure: FloatArray, gap: FloatArray, undeformed: FloatArray, hardness: float, grid: Grid, modulus: float
) -> Region:
    """The cells at the hardness [Pa], as in `contact_region`; there the gap is minus the overlap. Where plastic contact
    meets no contact at all, the edge lies half-way between centres."""
    elastic = pressure < hardness
    rest, _ = _region(elastic, pressure, gap, undeformed, grid, modulus, hardness=hardness)
    area = grid.area - rest.area
    return replace(rest, counted_area=grid.area - rest.counted_area).of_area(area)


def _region(
    inside: NDArray[np.bool_],
    strength: FloatArray,
    opening: FloatArray,
    undeformed: FloatArray,
    grid: Grid,
    modulus: float,
    ends: tuple[float, float] | None = None,
    hardness: float = 0.0,
) -> tuple[Region, Crossed]:
    constants, fitted = (_WAVES, _WAVES_ENDS) if all(grid.periodic) else (_CELLS, _CELLS_ENDS)
    marks = np.ascontiguousarray(inside).view(np.uint8)
    field = Field(marks, *(np.ascontiguousarray(field) for field in (strength, opening, undeformed)))
    law = Law(0.75 * modulus, hardness, constants, ends or fitted)
    crossed = cross_links(field, grid.spacing, grid.periodic, law)
    sums = sum_squares(crossed, grid.spacing, grid.periodic)
    count = int(np.count_nonzero(inside))
    # chords cut off curvature x chord^3 / 12; the curvature of all edges adds up to 2 pi a piece, less that of holes;
    # chords that run back count as well, or what is left of a jagged edge's length makes any area
    segments = 2 * math.pi * sums.turns * (sums.cubes / sums.chords) / 12 if sums.chords > 0 else 0.0
    area = count * grid.cell_area + sums.area + segments
    area = min(max(area, _LEAST_SHARE * count * grid.cell_area), grid.area)
    return Region(area, sums.length, count * grid.cell_area, sums.sides, area), crossed
