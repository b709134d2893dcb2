"""Mean of one over the gap in every cell of a patch that is partly in contact.

The midpoint rule is exact to all orders where the gap is smooth, but of order one half beside contact: there the gap h
rises with the power 3/2 of the distance for elastic bodies (Johnson, *Contact Mechanics*, section 5.1) and with the
first power for heights that are cut off, so 1/h is singular and a single centre near the edge dominates the sum.

1. Take the measure g = h^(2/3) for elastic bodies, or g = h for heights that are cut off: it is smooth at the edge.
2. Extrapolate g linearly into the closed cells beside open ones (elastic bodies; cut heights are known everywhere).
3. Use the midpoint rule in cells across which g changes little.
4. In the other cells take g linear and integrate 1/h in closed form over the part with h above the smallest gap that
   counts. With Psi'' = 1/h(g) above the smallest g and 0 below, and 2a, 2b the changes of g across the cell along x and
   y, the mean of 1/h is

       (Psi(g+a+b) - Psi(g+a-b) - Psi(g-a+b) + Psi(g-a-b)) / (4 a b).

Cost: a few passes over the cells. On random patches with 4 to 12 cells in the shortest wavelength the error is 0.2 to
0.8 % (`reports/experiments/flow_error_bars.py`). The method is this project's own. Verified in
tests/flow/test_inverse_gap.py against closed forms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray

_SMOOTH = 0.1
"""Relative change of g across half a cell below which the midpoint rule is used: no edge is near."""
_THINNEST = 1e-2
"""Smallest ratio of a and b: below it the mean changes by less than 1e-5, and the differences cancel."""


@dataclass(frozen=True, eq=False)
class InverseGap:
    """Inverse gap of every cell of a patch.

    Attributes
    ----------
    means : (nx, ny), integral of 1/gap over the part of the cell with enough gap, over the area of the whole cell.
    normal_x_squared : (nx, ny), square of the x component of the normal of the contact's edge, in open cells beside
        contact; not-a-number elsewhere.
    """

    means: FloatArray
    normal_x_squared: FloatArray


def inverse_gap_of_contact(gap: FloatArray, least: float, spacing: tuple[float, float] = (1.0, 1.0)) -> InverseGap:
    """Return the inverse gap of elastic bodies in contact, on a periodic patch.

    gap : (nx, ny), zero in contact. least : smallest gap that counts, > 0. spacing : sides of a cell.
    """
    free = gap > 0
    measure, known = _extrapolate(np.where(free, gap, 0.0) ** (2 / 3), free)
    means = _means(measure, known, free, least ** (2 / 3), 1.5)
    return InverseGap(means, _normal_x_squared(measure, free, free, spacing))


def inverse_gap_of_cut_heights(
    opening: FloatArray, least: float, spacing: tuple[float, float] = (1.0, 1.0)
) -> InverseGap:
    """Return the inverse gap of rigid bodies whose heights are cut off, on a periodic patch.

    opening : separation less height (nx, ny), negative where heights are cut off. least, spacing : as above.
    """
    everywhere = np.ones(opening.shape, dtype=np.bool_)
    means = _means(opening, everywhere, everywhere, least, 1.0)
    return InverseGap(means, _normal_x_squared(opening, everywhere, opening > 0, spacing))


def _normal_x_squared(
    g: FloatArray, known: NDArray[np.bool_], free: NDArray[np.bool_], spacing: tuple[float, float]
) -> FloatArray:
    """Return the square of the normal's x component from the slopes of the measure, in open cells beside contact."""
    near, squares = ~free, []
    for axis in (0, 1):
        near = near | np.roll(near, 1, axis) | np.roll(near, -1, axis)
    for axis in (0, 1):
        behind, ahead = (np.roll(known, way, axis) for way in (1, -1))
        rise = np.where(ahead, np.roll(g, -1, axis) - g, 0.0) + np.where(behind, g - np.roll(g, 1, axis), 0.0)
        squares.append((rise / np.maximum(ahead.astype(np.float64) + behind, 1.0) / spacing[axis]) ** 2)
    slope = squares[0] + squares[1]
    return np.where(near & free & (slope > 0), squares[0] / np.where(slope > 0, slope, 1.0), np.nan)


def _extrapolate(measure: FloatArray, free: NDArray[np.bool_]) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Extrapolate the measure linearly from two open cells in a row into closed cells, to at most 0.

    Returns the measure and the cells in which it is known.
    """
    total, count = np.zeros(measure.shape), np.zeros(measure.shape)
    for axis in (0, 1):
        for way in (-1, 1):
            near, far = np.roll(measure, way, axis), np.roll(measure, 2 * way, axis)
            both = ~free & np.roll(free, way, axis) & np.roll(free, 2 * way, axis)
            total += np.where(both, np.minimum(2 * near - far, 0.0), 0.0)
            count += both
    return np.where(free, measure, total / np.maximum(count, 1)), free | (count > 0)


def _means(g: FloatArray, known: NDArray[np.bool_], free: NDArray[np.bool_], least: float, power: float) -> FloatArray:
    """Return the means of 1/g^power over the part of each cell where g is at least `least`."""
    changes, bend, inside = [], np.zeros(g.shape), free.copy()
    for axis in (0, 1):
        behind, ahead = np.roll(g, 1, axis), np.roll(g, -1, axis)
        has_behind, has_ahead = np.roll(known, 1, axis), np.roll(known, -1, axis)
        inside &= np.roll(free, 1, axis) & np.roll(free, -1, axis)
        one_sided = np.where(has_ahead, ahead - g, np.where(has_behind, g - behind, 0.0))
        changes.append(0.5 * np.abs(np.where(has_behind & has_ahead, 0.5 * (ahead - behind), one_sided)))
        bend += behind + ahead - 2 * g
    a, b = np.maximum(*changes), np.minimum(*changes)
    smooth = a + b < _SMOOTH * g
    centred = smooth & (g >= least)
    means = np.zeros(g.shape)
    means[centred] = g[centred] ** -power
    cut = known & ~smooth & (a > 0)
    # the cell's mean instead of its centre, unless a neighbour is closed
    middle = g[cut] + np.where(inside[cut], bend[cut] / 24, 0.0)
    means[cut] = _over_cells(middle, a[cut], b[cut], least, power)
    return means


def _over_cells(g: FloatArray, a: FloatArray, b: FloatArray, least: float, power: float) -> FloatArray:
    """Return the means over cells across which g is linear, in closed form (step 4)."""
    b = np.maximum(b, _THINNEST * a)
    corners = (_second_antiderivative(g + way, least, power) for way in (a + b, a - b, b - a, -a - b))
    first, second, third, fourth = corners
    return np.asarray((first - second - third + fourth) / (4 * a * b))


def _second_antiderivative(g: FloatArray, least: float, power: float) -> FloatArray:
    """Return Psi(g), whose second derivative is g^-power above `least` and 0 below; Psi and its slope are 0 there."""
    ratio = np.maximum(g / least, 1.0)
    if power == 1.0:
        return np.asarray(least * (ratio * np.log(ratio) - ratio + 1))
    return np.asarray(least ** (2 - power) * (2 * (ratio - 1) - 4 * (np.sqrt(ratio) - 1)))
