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
crossings are met to 0.007 of a cell. The fit is by least squares over all links of Hertz' balls of 30 to 120 cells in
radius at 16 random places, and of waves in 15 directions, with a term in proportion to a cell over the contact's radius
that is left out of the constants. What a narrow piece of contact or of gap adds goes with the inverse of its number of
cells along the link; those two constants are fitted to areas of rough surfaces (`reports/experiments/contact_area.py`)
and held against Hertz' and Westergaard's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.crossings import Crossed, Field, Law, cells_at_edge, cross_links, links_along, sum_squares
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


_KINK = 5.0
"""The undeformed gap has a kink where its slope changes this many times as much as beside it. The slope of a parabola
changes twice as much over two links as over one."""


_ELASTIC_SHARE = 0.05
"""Of the part of a partly loaded cell beyond pressure / cap, the least that touches as well: 0.05 to 0.1 of it do on
eight times finer cells, at slopes of 6 to 26 times the hardness over E*."""


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
    compliance: float = 0.0,
) -> Region:
    """The cells in contact; under a cap no less than what carries their load at the cap.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], zero outside contact.
    gap, undeformed : (nx, ny), deformed and undeformed gap [m].
    grid : of the cells.
    modulus : E* as the length of a cell sees it [Pa].
    ends : what narrow contact and narrow gaps
        add, in place of the fitted constants.
    cap : highest pressure of a cell, the hardness [Pa].
    compliance : what each
        cell gives way besides, by its own pressure [m/Pa].

    Notes
    -----
    At an edge whose cells are at the cap the pressure has no root to follow, and the law cuts off too much: 3 % of the
    area where a tenth of the edge is so, 30 % where nearly all is. There the edge lies half-way between centres, cells
    at the cap count whole, and those between count for no less than the share of the cap that they carry. That takes
    off too much as well where edges curve or are elastic, so the larger area of both is nearer (measured in
    `tests/contact/test_contact_edge.py`).
    """
    inside = pressure > 0
    found, crossed = _region(inside, pressure, gap, undeformed, grid, modulus, ends, compliance=compliance)
    area = found.area
    if compliance > 0 and inside.any():
        area += _beyond_kinks(inside, undeformed + compliance * pressure, crossed, grid)
        area = min(max(area, 0.0), grid.area)
    if math.isfinite(cap) and inside.any():
        area = max(area, _capped_area(inside, pressure, cap, crossed, grid))
    return found.of_area(area)


def _beyond_kinks(inside: NDArray[np.bool_], worn: FloatArray, crossed: Crossed, grid: Grid) -> float:
    """The area [m^2] that the contact gains where its edge lies at a kink of the worn gap (nx, ny) [m] instead of where
    the law of a smooth gap has put it."""
    gained = 0.0
    for axis in (0, 1):
        first, second, column, crossing, cosine = links_along(crossed, axis, grid.spacing, grid.periodic)
        across, within = (worn, inside) if axis == 0 else (worn.T, inside.T)
        for outwards, row in ((1, first), (-1, second)):
            outward = within[row, column]
            place = (crossing if outwards > 0 else 1 - crossing)[outward]
            kink = _kink(across, row[outward], column[outward], outwards, grid.periodic[axis])
            gained += float(np.nansum(cosine[outward] ** 2 * (kink - place)))
    return gained * grid.cell_area


def _capped_area(inside: NDArray[np.bool_], pressure: FloatArray, cap: float, crossed: Crossed, grid: Grid) -> float:
    """The area of cells in contact [m^2], each with the fraction of it that lies within the edge: all of a cell at the
    cap, and of others a little more than their pressure over the cap, at least."""
    numbers, beyond = cells_at_edge(crossed, inside.view(np.uint8), grid.spacing, grid.periodic)
    below_cap = np.maximum(1 - pressure.reshape(-1)[numbers] / cap, 0.0)
    beyond = np.where(below_cap > 0, np.minimum(beyond, (1 - _ELASTIC_SHARE) * below_cap), 0.0)
    return float(np.count_nonzero(inside) - beyond.sum()) * grid.cell_area


def rows_in_contact(
    pressure: FloatArray,
    gap: FloatArray,
    undeformed: FloatArray,
    grid: Grid,
    modulus: float,
    *,
    cap: float = math.inf,
    compliance: float = 0.0,
) -> FloatArray:
    """The fraction of each row of cells (nx,) within the strip along y that is in contact anywhere; 1 everywhere where
    nothing touches.

    The strip ends at the outermost crossing of the edge with the links along x, inside the last row that touches or the
    row beyond it, or at a kink of the gap as what each cell gives way has left it, as at the edge of a scar. Means over
    the strip thus converge with the cell. Parameters as in `contact_region`.
    """
    inside = pressure > 0
    touched = np.asarray(inside.any(axis=1))
    rows: FloatArray = touched.astype(np.float64)
    if touched.all() or not touched.any():
        return np.ones_like(rows)
    _, crossed = _region(inside, pressure, gap, undeformed, grid, modulus, compliance=compliance)
    worn = undeformed + compliance * pressure
    nx = rows.size
    first, second, column, crossing, _ = links_along(crossed, 0, grid.spacing, grid.periodic)
    for outwards, row, beyond in ((1, first, second), (-1, second, first)):
        outward = inside[row, column] & ~touched[beyond]
        place = crossing if outwards > 0 else 1 - crossing
        place = np.where(pressure[row, column] >= cap, 0.5, place)[outward]
        row, at = row[outward], column[outward]
        kink = _kink(worn, row, at, outwards, grid.periodic[0])
        furthest = np.full(nx, -np.inf)
        np.maximum.at(furthest, row, np.where(np.isnan(kink), place, kink))
        for end in np.flatnonzero(np.isfinite(furthest)):
            past = furthest[end] - 0.5
            rows[end if past < 0 else (end + outwards) % nx] += past
    return np.clip(rows, 0.0, 1.0)


def _kink(gap: FloatArray, row: NDArray[np.int64], column: NDArray[np.int64], outwards: int, wraps: bool) -> FloatArray:
    """Where an undeformed gap has a kink in the link from a cell inside (row, column) to the next row outwards (m,),
    in links from the cell; not-a-number where it has none.

    Bodies that are worn where they touch meet at an angle where the contact ends. The kink is where the straight lines
    through the last two cells inside and the first two outside cross.
    """
    nx = gap.shape[0]
    rows = [row + outwards * step for step in range(-2, 4)]
    rows = [one % nx if wraps else np.clip(one, 0, nx - 1) for one in rows]
    slopes = np.diff([gap[one, column] for one in rows], axis=0)
    bend = slopes[3] - slopes[1]
    beside = np.maximum(np.abs(slopes[1] - slopes[0]), np.abs(slopes[4] - slopes[3]))
    place = np.divide(slopes[3] - slopes[2], bend, out=np.full(bend.shape, np.nan), where=bend > _KINK * beside)
    return np.asarray(np.where((place >= 0) & (place <= 1), place, np.nan))


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
    compliance: float = 0.0,
) -> tuple[Region, Crossed]:
    constants, fitted = (_WAVES, _WAVES_ENDS) if all(grid.periodic) else (_CELLS, _CELLS_ENDS)
    marks = np.ascontiguousarray(inside).view(np.uint8)
    field = Field(marks, *(np.ascontiguousarray(field) for field in (strength, opening, undeformed)))
    law = Law(0.75 * modulus, hardness, constants, ends or fitted, 0.75 * modulus * compliance)
    crossed = cross_links(field, grid.spacing, grid.periodic, law)
    sums = sum_squares(crossed, grid.spacing, grid.periodic)
    count = int(np.count_nonzero(inside))
    # chords cut off curvature x chord^3 / 12; the curvature of all edges adds up to 2 pi a piece, less that of holes;
    # chords that run back count as well, or what is left of a jagged edge's length makes any area
    segments = 2 * math.pi * sums.turns * (sums.cubes / sums.chords) / 12 if sums.chords > 0 else 0.0
    area = count * grid.cell_area + sums.area + segments
    area = min(max(area, _LEAST_SHARE * count * grid.cell_area), grid.area)
    return Region(area, sums.length, count * grid.cell_area, sums.sides, area), crossed
