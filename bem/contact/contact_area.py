"""Area and perimeter of contact from the boundary inside cells, second-order accurate for elastic boundaries.

A count of the cells in contact is first-order accurate: 8 % high on a rough surface at 256 cells a side. Next to the
boundary p = k sqrt(d) at a distance d inside, and gap = 4 k d^(3/2) / (3 E*) outside (k as at a crack tip: Johnson,
*Contact Mechanics*, section 5.1). The pressure of the last cell inside and the gap of its neighbour outside therefore
determine where the boundary crosses the link between their centres: k cancels in q = 3 E* gap / (4 p d n), with d the
length of the link and n the cosine between link and normal. To first order the discrete p and gap at both centres are
linear in the position s of the boundary between them: p is proportional to b + s, and the gap to a - c s. Their ratio q
= (a - c s) / (b + s), solved for s, places the crossing at the fraction s = (a - b q) / (c + q) of the link. The
constants a, b, c depend on n and on the discretisation: constant on cells, or waves (`spectral`). The polygon through
the crossings, with the segments that its chords cut off, bounds the contact.

The same law holds with hardness less pressure in place of the pressure, and the overlap in place of the gap, where
contact turns plastic. At a discontinuity of the undeformed gap, as around a punch, the boundary is half-way between the
centres.

The constants are fitted to contacts with known boundary, Hertz (cells) and Westergaard (waves), in the limit of small
cells. The contribution of narrow regions falls with the inverse of their number
of cells along the link; its two constants are fitted to rough surfaces (`reports/experiments/contact_area.py`).

Part of step 12 of `bem.contact`. Verified in tests/contact/test_contact_area.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.contact_boundary import Crossed, Field, Law, cells_at_edge, cross_links, links_along, sum_squares
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
"""Shift of the boundary outwards at a narrow region, and inwards at a narrow gap: in cells, times their number of cells
along the link."""

_LEAST_SHARE = 0.1
"""Least area over the area of the cells in contact; single-cell spots do not determine their area."""

_KINK = 5.0
"""Ratio of a change of slope to those beside it above which the undeformed gap has a kink; a parabola has two."""

_ELASTIC_SHARE = 0.05
"""Least fraction in contact of the part of a partly loaded cell beyond pressure / cap."""


@dataclass(frozen=True)
class Region:
    """Part of the surface.

    area [m^2], perimeter [m] : second-order accurate at elastic boundaries. counted_area : of its cells [m^2]. sides :
    length of the outer sides of its cells [m]. elastic_edge_area : area by the law of elastic boundaries alone [m^2].
    """

    area: float
    perimeter: float
    counted_area: float
    sides: float
    elastic_edge_area: float

    def of_area(self, area: float) -> Region:
        """Replace the area [m^2]; bound the perimeter from below by the sides of the cells.

        A boundary passes sides of at most sqrt(2) times its length, and perimeters scale as the roots of areas.
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
    """Return the region in contact; below a cap, at least the area that carries the load at the cap.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], zero outside contact.
    gap, undeformed : (nx, ny), deformed and undeformed gap [m].
    grid : of the cells.
    modulus : E* at a wavelength of four cells [Pa].
    ends : contributions of narrow regions and gaps, in place of the fitted constants.
    cap : hardness [Pa].
    compliance : additional displacement of a cell by its own pressure [m/Pa].

    Notes
    -----
    At a boundary with cells at the cap the pressure has no root singularity, and the law removes too much area. There
    cells at the cap count fully, and others at least with the fraction of the cap that they carry. This estimate is
    also too small where boundaries curve or are elastic, so the larger area is taken.
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
    """Return the area [m^2] gained where the boundary lies at a kink of the worn gap (nx, ny) [m] instead of the
    crossing."""
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
    """Return the area of the cells in contact [m^2], each with its fraction within the boundary.

    Cells at the cap count fully, others at least with a little more than their pressure over the cap.
    """
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
    """Return the fraction (nx,) of each row of cells within the strip along y that is in contact anywhere.

    The strip ends at the outermost crossing of the boundary with the links along x, or at a kink of the worn gap, so
    that means over the strip converge with the cell size. Without contact all fractions are zero. Parameters as in
    `contact_region`.
    """
    inside = pressure > 0
    touched = np.asarray(inside.any(axis=1))
    rows: FloatArray = touched.astype(np.float64)
    if touched.all() or not touched.any():
        return rows
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
    """Return the position (m,) of a kink of an undeformed or worn gap, in links from a cell inside to the next row.

    Not-a-number where there is none. Bodies worn in contact meet at an angle where contact ends: the kink is the
    intersection of the lines through the last two cells inside and the first two outside.
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
    """Return the region at the hardness [Pa], as in `contact_region`; its gap is minus the overlap.

    Where plastic contact borders on open gap, the boundary is half-way between centres.
    """
    below_cap = pressure < hardness
    rest, _ = _region(below_cap, pressure, gap, undeformed, grid, modulus, hardness=hardness)
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
    # chords cut off curvature x chord^3 / 12; curvature integrates to 2 pi per region, less holes; chords that run back
    # count as well, or a jagged boundary would have any area
    segments = 2 * math.pi * sums.turns * (sums.cubes / sums.chords) / 12 if sums.chords > 0 else 0.0
    area = count * grid.cell_area + sums.area + segments
    area = min(max(area, _LEAST_SHARE * count * grid.cell_area), grid.area)
    return Region(area, sums.length, count * grid.cell_area, sums.sides, area), crossed
