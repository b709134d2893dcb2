"""Asperities of a surface (summits of its cells) and the plasticity indices of a contact.

Sees heights and grids, no contact. Verified in tests/surfaces/test_asperities.py against spheres and waves in closed
form and against Nayak's statistics of a Gaussian surface.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.surfaces.surface import Surface, check_map, spacing_of


@dataclass(frozen=True)
class AsperityStatistics:
    """Summits of a surface: cells higher than their eight neighbours. All depend on the spacing of the cells.

    Attributes
    ----------
    density : summits per area [1/m^2].
    rms_height : standard deviation of their heights [m].
    mean_height : mean of their heights above the mean of the surface [m].
    radius : inverse of their mean curvature [m]; nan without summits.
    rms_curvature : rms mean curvature of the whole surface [1/m].
    bandwidth : Nayak's alpha = m0 m4 / m2^2 of the spectral moments; at least 1.5 for a Gaussian isotropic surface.
    """

    density: float
    rms_height: float
    mean_height: float
    radius: float
    rms_curvature: float
    bandwidth: float


def describe_asperities(
    heights: FloatArray | Surface,
    spacing: tuple[float, float] | None = None,
    *,
    periodic: tuple[bool, bool] = (False, False),
) -> AsperityStatistics:
    """Find the summits of heights (nx, ny) [m] on cells of `spacing` (dx, dy) [m].

    Curvatures are second differences over three cells, the mean of both axes. The spectral moments m2 and m4 are means
    over both axes of squared first and second differences. Cells at a free edge are left out. Source: Nayak, J. Lubr.
    Technol. 93 (1971) 398.

    Raises
    ------
    InputError : heights that are not a finite map of at least 3 x 3 cells.
    """
    heights, cell = check_map(heights, spacing_of(heights, spacing))
    if min(heights.shape) < 3:
        raise InputError(f"heights: shape {heights.shape} must be at least (3, 3) for summits")
    mean = float(heights.mean())
    rows = np.arange(-1, heights.shape[0] + 1) if periodic[0] else np.arange(heights.shape[0])
    total = _Sums()
    for first in range(1, rows.size - 1, _ROWS):
        band = heights.take(rows[first - 1 : first + _ROWS + 1], axis=0, mode="wrap") - mean
        if periodic[1]:
            band = np.concatenate([band[:, -1:], band, band[:, :1]], axis=1)
        total += _sums(band, cell)
    height = total.height / total.summits if total.summits else math.nan
    curvature = total.summit_curvature / total.summits if total.summits else math.nan
    m0, m2, m4 = (moment / total.cells for moment in (total.squares, total.slopes, total.curvatures))
    return AsperityStatistics(
        density=total.summits / (total.cells * cell[0] * cell[1]),
        rms_height=math.sqrt(max(total.height_squares / total.summits - height**2, 0.0)) if total.summits else math.nan,
        mean_height=height,
        radius=1 / curvature if total.summits else math.nan,
        rms_curvature=math.sqrt(total.mean_curvatures / total.cells),
        bandwidth=m0 * m4 / m2**2 if m2 > 0 else math.nan,
    )


_ROWS = 256
"""Rows that are looked at together: their copies stay in the processor's cache."""


@dataclass(frozen=True)
class _Sums:
    """Sums over cells: squared heights, slopes, curvatures; and over summits: number, heights, curvatures."""

    cells: int = 0
    squares: float = 0.0
    slopes: float = 0.0
    curvatures: float = 0.0
    mean_curvatures: float = 0.0
    summits: int = 0
    height: float = 0.0
    height_squares: float = 0.0
    summit_curvature: float = 0.0

    def __add__(self, other: _Sums) -> _Sums:
        return _Sums(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))


def _sums(z: FloatArray, cell: tuple[float, float]) -> _Sums:
    """Return the sums over all cells of z but those at its edges."""
    dx, dy = cell
    middle = z[1:-1, 1:-1]
    curved_x = (z[2:, 1:-1] - 2 * middle + z[:-2, 1:-1]) / dx**2
    curved_y = (z[1:-1, 2:] - 2 * middle + z[1:-1, :-2]) / dy**2
    mean_curvature = -(curved_x + curved_y) / 2
    nx, ny = z.shape
    neighbours = [z[i : nx - 2 + i, j : ny - 2 + j] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    summit = np.logical_and.reduce([middle > neighbour for neighbour in neighbours])
    top = middle[summit]
    slope_x, slope_y = (z[2:, 1:-1] - middle) / dx, (z[1:-1, 2:] - middle) / dy
    return _Sums(
        cells=middle.size,
        squares=float(np.sum(middle**2)),
        slopes=float(np.sum(slope_x**2) + np.sum(slope_y**2)) / 2,
        curvatures=float(np.sum(curved_x**2) + np.sum(curved_y**2)) / 2,
        mean_curvatures=float(np.sum(mean_curvature**2)),
        summits=top.size,
        height=float(top.sum()),
        height_squares=float(np.sum(top**2)),
        summit_curvature=float(mean_curvature[summit].sum()),
    )


def plasticity_index(asperities: AsperityStatistics, modulus: float, hardness: float) -> float:
    """Return Greenwood and Williamson's index (E* / H) sqrt(sigma_s / R); above about 1 asperities yield at any load.

    modulus : combined modulus E* [Pa]. hardness : of the softer body [Pa]. nan without summits. Source: Greenwood and
    Williamson, Proc. R. Soc. A 295 (1966) 300.
    """
    return modulus / hardness * math.sqrt(asperities.rms_height / asperities.radius)


def slope_plasticity_index(rms_slope: float, modulus: float, hardness: float) -> float:
    """Return Mikic's index (E* / H) times the rms slope, which does not need summits.

    rms_slope : sqrt(slope_x^2 + slope_y^2) of the combined surface. Source: Mikic, Int. J. Heat Mass Transfer 17 (1974)
    205, whose slope is of the profile: that of an isotropic surface is 1 / sqrt(2) of this one.
    """
    return modulus / hardness * rms_slope
