"""Temperature of a half-space under a uniformly heated cell that stands still while the body moves along +x.

A point source of heat Q J on the surface gives T = 2 Q / (rho c) (4 pi kappa t)^(-3/2) exp(-r^2 / (4 kappa t)) after a
time t (H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), section 10.2); in the frame of the
heat it has moved by U t. Integrated over the cell |x'| < a, |y'| < b and over time, with s = sqrt(4 kappa t) and the
wavenumber w = U / (2 kappa), a flux of 1 W/m^2 from t1 to t2 ago gives on the surface

    T = 1/(4 sqrt(pi) k) integral X Y ds,    X = erf((x+a)/s - w s/2) - erf((x-a)/s - w s/2),
                                             Y = erf((y+b)/s) - erf((y-b)/s),

s from sqrt(4 kappa t1) to sqrt(4 kappa t2); from 0 to infinity it is the steady temperature (ibid., section 10.7). A
flux that varies like cos(q y) has Y = 2 exp(-(q s)^2 / 4) in place of the cell's.

One rule of Gauss points over s serves all offsets, so that the table is a sum of products of a column and a row.
Panels: X and Y change over a factor of two in s (they are bounded in |arg s| < pi/4) and, once w s > 1, over 1/w, the
time in which the source moves by its own spread. 14 points on panels [s, 2 s] no longer than 3/w leave 1e-14 of the
largest coefficient. A point outside of 6 s of a cell feels nothing of it (erfc(6) = 2e-17), which keeps fast sources,
that need many panels, narrow: the work grows like the root of the Peclet number at most.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled

FloatArray = NDArray[np.float64]

_POINTS = 14
_REACH = 6.0
"""Distance from a cell over s beyond which the cell's heat is below round-off: erfc(6) = 2e-17."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_POINTS)
_CHUNK = 64
_STILL = 1e-14
"""Peclet number of a whole grid below which the source stands still: round-off."""


@dataclass(frozen=True)
class Rows:
    """Variation of the heat across the motion: in cells, or as cosines.

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
    cells: int, spacing: float, rows: Rows, wavenumber: float, begin: float, end: float
) -> FloatArray:
    """Temperature times conductivity per unit flux [m] at offsets from a heated cell, (2 cells - 1, rows.count).

    Parameters
    ----------
    cells, spacing : along x; offsets are -(cells - 1) ... cells - 1, downstream is positive.
    rows : along y.
    wavenumber : w = U / (2 kappa) >= 0 [1/m].
    begin, end : sqrt(4 kappa t) [m] since the flux ended and began; 0 and infinity for the steady temperature.
    """
    half = 0.5 * spacing
    length = cells * spacing
    finest = min(half, 0.5 * math.pi / (rows.count * rows.step) if rows.cosines else 0.5 * rows.step)
    across = 0.0 if rows.cosines else rows.count * rows.step
    reach = math.hypot(length, across)
    if wavenumber * reach < _STILL:
        wavenumber = 0.0
    nodes, weights = _rule(finest, reach, length, wavenumber, begin, end)
    table = np.zeros((2 * cells - 1, rows.count))
    _sum(nodes, weights / (4 * math.sqrt(math.pi)), spacing, wavenumber, rows.step, rows.cosines, table)
    return table


def _rule(
    finest: float, reach: float, length: float, wavenumber: float, begin: float, end: float
) -> tuple[FloatArray, FloatArray]:
    """Return the Gauss points s and weights between `begin` and `end` [m]; see the module."""
    # until then the heat has not reached the next cell
    calm = finest / (2 * _REACH)
    if wavenumber > 0:
        calm = min(calm, math.sqrt(finest / wavenumber))
        # from then on the source has left the grid: w s^2 / 2 > length + 6 s
        gone = (_REACH + math.sqrt(_REACH**2 + 2 * wavenumber * length)) / wavenumber
        end = min(end, gone)
    edges = [begin]
    far = 2 * reach
    last = end if math.isfinite(end) else max(far, begin)
    while edges[-1] < last:
        s = edges[-1]
        width = max(s, calm)
        if wavenumber > 0:
            width = min(width, max(3 / wavenumber, calm) if s == 0 else 3 / wavenumber)
        edges.append(last if s + 1.0001 * width >= last else s + width)
    low, high = np.array(edges[:-1]), np.array(edges[1:])
    centre, half = 0.5 * (high + low), 0.5 * (high - low)
    nodes = (centre[:, None] + half[:, None] * _NODES).ravel()
    weights = (half[:, None] * _WEIGHTS).ravel()
    if not math.isfinite(end):
        # a source at rest: X Y is a power series in 1/s^2, integrated over 1/s
        inverse = 0.5 * (1 + _NODES) / last
        nodes = np.concatenate([nodes, 1 / inverse])
        weights = np.concatenate([weights, 0.5 * _WEIGHTS / last / inverse**2])
    return nodes, weights


@compiled
def _difference(high: float, low: float) -> float:
    """Return erf(high) - erf(low) for high > low without cancellation in the tails."""
    if low > 0:
        return math.erfc(low) - math.erfc(high)
    if high < 0:
        return math.erfc(-high) - math.erfc(-low)
    return math.erf(high) - math.erf(low)


@compiled
def _sum(
    nodes: FloatArray,
    weights: FloatArray,
    spacing: float,
    wavenumber: float,
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
            drift = 0.5 * wavenumber * s * s
            reach = _REACH * s + 0.5 * spacing
            first[n] = math.ceil(min(max((drift - reach) / spacing, -middle), middle + 1.0)) + middle
            last[n] = math.floor(min(max((drift + reach) / spacing, -middle - 1.0), middle)) + middle + 1
            for i in range(first[n], last[n]):
                x = (i - middle) * spacing - drift
                column[i, n] = _difference((x + 0.5 * spacing) / s, (x - 0.5 * spacing) / s) * weights[start + n]
            if cosines:
                # exp(-36) is round-off
                width[n] = min(count, int(min(12.0 / (step * s), 1e9)) + 1)
                for j in range(width[n]):
                    row[n, j] = 2 * math.exp(-((0.5 * j * step * s) ** 2))
            else:
                width[n] = min(count, int(min(_REACH * s / step + 0.5, 1e9)) + 1)
                for j in range(width[n]):
                    row[n, j] = _difference((j + 0.5) * step / s, (j - 0.5) * step / s)
        for i in range(offsets):
            for n in range(block):
                if first[n] <= i < last[n]:
                    factor = column[i, n]
                    for j in range(width[n]):
                        table[i, j] += factor * row[n, j]
