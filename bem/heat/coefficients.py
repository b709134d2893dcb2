"""Temperature of a half-space under a uniformly heated cell that stands still while the body moves along +x.

A point source of heat Q J on the surface gives T = 2 Q / (rho c) (4 pi kappa t)^(-3/2) exp(-r^2 / (4 kappa t)) after a
time t (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), section 10.2); in the frame of the
heat it has moved by U t. Integrated over the cell |x'| < a, |y'| < b and over time, with the spread s = sqrt(4 kappa t)
and the Peclet number per length w = U / (2 kappa), a flux of 1 W/m^2 from t1 to t2 ago gives on the surface

    T = 1/(4 sqrt(pi) k) integral X Y ds,    X = erf((x+a)/s - w s/2) - erf((x-a)/s - w s/2),
                                             Y = erf((y+b)/s) - erf((y-b)/s),

s from sqrt(4 kappa t1) to sqrt(4 kappa t2); from 0 to infinity it is the steady temperature (ibid., section 10.7). A
flux that varies like cos(q y) has Y = 2 exp(-(q s)^2 / 4) in place of the cell's.

1. Divide the range of s into panels (`_rule`). X and Y change over a factor of two in s (they are bounded in
   |arg s| < pi/4) and, once w s > 1, over 1/w, the time in which the source moves by its own spread: panels are
   [s, 2 s] and no longer than 3/w. From zero on, the first panel ends before heat reaches the next cell. The last panel
   ends where the source has left the grid, or for a source at rest at infinity. 14 Gauss points a panel leave 1e-14 of
   the largest coefficient.
2. Add the product of a column X and a row Y for each Gauss point (`_add_products`): one rule serves all offsets. A
   point outside of 6 s of a cell feels nothing of it (erfc(6) = 2e-17), which keeps fast sources, that need many
   panels, narrow.

Cost: one product of a column and a row per Gauss point; the work grows like the root of the Peclet number at most. The
quadrature is this project's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled

FloatArray = NDArray[np.float64]

_POINTS = 14
"""Gauss points of a panel."""
_REACH = 6.0
"""Distance from a cell over s beyond which the cell's heat is below round-off: erfc(6) = 2e-17."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_POINTS)
_CHUNK = 64
"""Gauss points of a block: each row of the table is read once per block."""
_STILL = 1e-14
"""Peclet number of the whole grid below which the source counts as at rest: round-off."""


@dataclass(frozen=True)
class TransverseBasis:
    """Basis of the heat across the motion, along y: cells, or cosines on a periodic axis.

    Attributes
    ----------
    count : number of offsets from the cell, or of wavenumbers, from zero on.
    step : side of a cell [m], or spacing of the wavenumbers [rad/m].
    cosines : True for wavenumbers.
    """

    count: int
    step: float
    cosines: bool


def temperature_table(
    cells: int,
    spacing: float,
    basis: TransverseBasis,
    peclet_per_length: float,
    least_spread: float,
    largest_spread: float,
) -> FloatArray:
    """Return temperature x conductivity per unit flux [m] at offsets from a heated cell, (2 cells - 1, basis.count).

    Parameters
    ----------
    cells, spacing : along x; offsets are -(cells - 1) ... cells - 1, downstream is positive.
    basis : along y.
    peclet_per_length : w = U / (2 kappa) >= 0 [1/m].
    least_spread, largest_spread : sqrt(4 kappa t) [m] of the youngest and the oldest heat; 0 and infinity for the
        steady temperature.
    """
    half = 0.5 * spacing
    length = cells * spacing
    finest = min(half, 0.5 * math.pi / (basis.count * basis.step) if basis.cosines else 0.5 * basis.step)
    across = 0.0 if basis.cosines else basis.count * basis.step
    reach = math.hypot(length, across)
    if peclet_per_length * reach < _STILL:
        peclet_per_length = 0.0
    nodes, weights = _rule(finest, reach, length, peclet_per_length, least_spread, largest_spread)
    table = np.zeros((2 * cells - 1, basis.count))
    _add_products(
        nodes, weights / (4 * math.sqrt(math.pi)), spacing, peclet_per_length, basis.step, basis.cosines, table
    )
    return table


def _rule(
    finest: float, reach: float, length: float, peclet_per_length: float, least_spread: float, largest_spread: float
) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss points s [m] and their weights [m] between `least_spread` and `largest_spread`.

    finest : half of the smallest cell or cosine wave [m]. reach : diagonal of the grid [m]. length : along x [m].
    """
    # within this spread no heat has reached the next cell
    first_panel = finest / (2 * _REACH)
    if peclet_per_length > 0:
        first_panel = min(first_panel, math.sqrt(finest / peclet_per_length))
        # beyond this spread the source has left the grid: w s^2 / 2 > length + 6 s
        departed = (_REACH + math.sqrt(_REACH**2 + 2 * peclet_per_length * length)) / peclet_per_length
        largest_spread = min(largest_spread, departed)
    edges = [least_spread]
    far = 2 * reach
    last = largest_spread if math.isfinite(largest_spread) else max(far, least_spread)
    while edges[-1] < last:
        s = edges[-1]
        width = max(s, first_panel)
        if peclet_per_length > 0:
            width = min(width, max(3 / peclet_per_length, first_panel) if s == 0 else 3 / peclet_per_length)
        edges.append(last if s + 1.0001 * width >= last else s + width)
    low, high = np.array(edges[:-1]), np.array(edges[1:])
    centre, half = 0.5 * (high + low), 0.5 * (high - low)
    nodes = (centre[:, None] + half[:, None] * _NODES).ravel()
    weights = (half[:, None] * _WEIGHTS).ravel()
    if not math.isfinite(largest_spread):
        # a source at rest: X Y is a power series in 1/s^2, integrated over 1/s
        inverse = 0.5 * (1 + _NODES) / last
        nodes = np.concatenate([nodes, 1 / inverse])
        weights = np.concatenate([weights, 0.5 * _WEIGHTS / last / inverse**2])
    return nodes, weights


@compiled
def _erf_difference(high: float, low: float) -> float:
    """Return erf(high) - erf(low) for high > low without cancellation in the tails."""
    if low > 0:
        return math.erfc(low) - math.erfc(high)
    if high < 0:
        return math.erfc(-high) - math.erfc(-low)
    return math.erf(high) - math.erf(low)


@compiled
def _add_products(
    nodes: FloatArray,
    weights: FloatArray,
    spacing: float,
    peclet_per_length: float,
    step: float,
    cosines: bool,
    table: FloatArray,
) -> None:
    """Add the product of a column and a row for each Gauss point to the table, a block of points at a time."""
    offsets, count = table.shape
    middle = (offsets - 1) // 2
    column = np.zeros((offsets, _CHUNK))
    row = np.zeros((_CHUNK, count))
    width = np.zeros(_CHUNK, dtype=np.int64)
    first = np.zeros(_CHUNK, dtype=np.int64)
    last = np.zeros(_CHUNK, dtype=np.int64)
    for start in range(0, nodes.size, _CHUNK):
        block = min(_CHUNK, nodes.size - start)
        for n in range(block):
            s = nodes[start + n]
            drift = 0.5 * peclet_per_length * s * s
            reach = _REACH * s + 0.5 * spacing
            first[n] = math.ceil(min(max((drift - reach) / spacing, -middle), middle + 1.0)) + middle
            last[n] = math.floor(min(max((drift + reach) / spacing, -middle - 1.0), middle)) + middle + 1
            for i in range(first[n], last[n]):
                x = (i - middle) * spacing - drift
                column[i, n] = _erf_difference((x + 0.5 * spacing) / s, (x - 0.5 * spacing) / s) * weights[start + n]
            if cosines:
                # exp(-36) is round-off
                width[n] = min(count, int(min(12.0 / (step * s), 1e9)) + 1)
                for j in range(width[n]):
                    row[n, j] = 2 * math.exp(-((0.5 * j * step * s) ** 2))
            else:
                width[n] = min(count, int(min(_REACH * s / step + 0.5, 1e9)) + 1)
                for j in range(width[n]):
                    row[n, j] = _erf_difference((j + 0.5) * step / s, (j - 0.5) * step / s)
        for i in range(offsets):
            for n in range(block):
                if first[n] <= i < last[n]:
                    factor = column[i, n]
                    for j in range(width[n]):
                        table[i, j] += factor * row[n, j]
