"""The mean of one over the gap in every cell of a patch that is partly in contact.

Its sum over the centres of cells is exact to all orders where the gap is smooth, but of half an order next to contact:
beside elastic contact the gap h rises with the power 3/2 of the distance (Johnson, *Contact Mechanics*, section 5.1),
beside heights that are cut off with the first, so that 1/h grows there to the least gap that counts, and a single
centre that happens to lie near the edge says as much as hundreds. The measure g = h^(2/3), or h, is smooth: it is taken
linear across a cell where it changes by more than a part of itself, and 1/h integrated in closed form over the cell's
part with enough gap. With Psi'' = 1/h(g) above the least g and 0 below, and 2a, 2b the changes of g across the cell
along x and y, the mean of 1/h is

    (Psi(g+a+b) - Psi(g+a-b) - Psi(g-a+b) + Psi(g-a-b)) / (4 a b).

Inside contact g is that of the open cells beside, gone on with in a straight line. On random patches of 4 to 12 cells
to the shortest wave that is 0.2 to 0.8 % from four times the cells where centres are 2 to 5 %
(`reports/experiments/flow_error_bars.py`). Ours. Verified in tests/flow/test_inverse_gap.py against closed forms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray

_SMOOTH = 0.1
"""A cell across half of which g changes by a smaller part of itself counts with its centre: no edge is near."""
_THINNEST = 1e-2
"""The smaller of a and b, over the larger: at less the mean differs from that at none by 1e-5, and digits get lost."""


@dataclass(frozen=True, eq=False)
class InverseGap:
    """Of every cell of a patch (nx, ny): `means`, of 1/gap where there is enough gap, 0 elsewhere; `normal_x`, beside
    contact the square of the x component of the normal of its edge, not-a-number elsewhere."""

    means: FloatArray
    normal_x: FloatArray


def inverse_gap(gap: FloatArray, least: float, spacing: tuple[float, float] = (1.0, 1.0)) -> InverseGap:
    """Of a periodic patch with the gap (nx, ny), >= 0 and 0 in contact, which is elastic; of gaps less than `least` > 0
    there is no inverse."""
    free = gap > 0
    measure, known = _gone_on(np.where(free, gap, 0.0) ** (2 / 3), free)
    means = _means(measure, known, free, least ** (2 / 3), 1.5)
    return InverseGap(means, _normal_x(measure, free, free, spacing))


def inverse_opening(opening: FloatArray, least: float, spacing: tuple[float, float] = (1.0, 1.0)) -> InverseGap:
    """The same of bodies that are not deformed but cut off, from separation less height (nx, ny), of either sign."""
    everywhere = np.ones(opening.shape, dtype=np.bool_)
    means = _means(opening, everywhere, everywhere, least, 1.0)
    return InverseGap(means, _normal_x(opening, everywhere, opening > 0, spacing))


def _normal_x(
    g: FloatArray, known: NDArray[np.bool_], free: NDArray[np.bool_], spacing: tuple[float, float]
) -> FloatArray:
    """From the slopes of the measure between cells where it is known, in free cells beside others,
    along axes or across a corner."""
    near, squares = ~free, []
    for axis in (0, 1):
        near = near | np.roll(near, 1, axis) | np.roll(near, -1, axis)
    for axis in (0, 1):
        behind, ahead = (np.roll(known, way, axis) for way in (1, -1))
        rise = np.where(ahead, np.roll(g, -1, axis) - g, 0.0) + np.where(behind, g - np.roll(g, 1, axis), 0.0)
        squares.append((rise / np.maximum(ahead.astype(np.float64) + behind, 1.0) / spacing[axis]) ** 2)
    slope = squares[0] + squares[1]
    return np.where(near & free & (slope > 0), squares[0] / np.where(slope > 0, slope, 1.0), np.nan)


def _gone_on(measure: FloatArray, free: NDArray[np.bool_]) -> tuple[FloatArray, NDArray[np.bool_]]:
    """The measure in closed cells from two open ones beside them in a row, at most 0; and where it is known."""
    total, count = np.zeros(measure.shape), np.zeros(measure.shape)
    for axis in (0, 1):
        for way in (-1, 1):
            near, far = np.roll(measure, way, axis), np.roll(measure, 2 * way, axis)
            both = ~free & np.roll(free, way, axis) & np.roll(free, 2 * way, axis)
            total += np.where(both, np.minimum(2 * near - far, 0.0), 0.0)
            count += both
    return np.where(free, measure, total / np.maximum(count, 1)), free | (count > 0)


def _means(g: FloatArray, known: NDArray[np.bool_], free: NDArray[np.bool_], least: float, power: float) -> FloatArray:
    """Of 1/g^power where g is at least `least`; g is linear in cells where it changes much, and `known` there."""
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
    # the cell's mean and not its centre, where all around is open: what contact bends is the edge itself
    middle = g[cut] + np.where(inside[cut], bend[cut] / 24, 0.0)
    means[cut] = _over_cells(middle, a[cut], b[cut], least, power)
    return means


def _over_cells(g: FloatArray, a: FloatArray, b: FloatArray, least: float, power: float) -> FloatArray:
    """Means over cells, in closed form."""
    b = np.maximum(b, _THINNEST * a)
    corners = (_twice_integrated(g + way, least, power) for way in (a + b, a - b, b - a, -a - b))
    first, second, third, fourth = corners
    return np.asarray((first - second - third + fourth) / (4 * a * b))


def _twice_integrated(g: FloatArray, least: float, power: float) -> FloatArray:
    """Psi: its second derivative is g^-power from `least` on, itself and its slope 0 there."""
    ratio = np.maximum(g / least, 1.0)
    if power == 1.0:
        return np.asarray(least * (ratio * np.log(ratio) - ratio + 1))
    return np.asarray(least ** (2 - power) * (2 * (ratio - 1) - 4 * (np.sqrt(ratio) - 1)))
