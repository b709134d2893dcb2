"""Error bars from at least three meshes:

Richardson extrapolation, with a cautious bar where the sequence is not regular. Needs numpy only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

SAFETY = 1.25
"""Factor on the extrapolated difference for three or more meshes, as in the grid convergence index (Roache 1994)."""


@dataclass(frozen=True)
class Estimate:
    """What a sequence of meshes says.

    Parameters
    ----------
    values : on the finest mesh, shape (n,).
    error_bar : half-width at each point, shape (n,).
    order : observed order of the sequence as a whole (maximum norm), None where the differences are at round-off or do
        not fall.
    """

    values: NDArray[np.float64]
    error_bar: NDArray[np.float64]
    order: float | None


def observed_order(sizes: ArrayLike, differences: ArrayLike) -> float | None:
    """Order p of an error c h^p from the last two successive differences of a sequence on meshes of three sizes.

    ``differences`` are |f2 - f1| and |f3 - f2| (positive). Solves (h1^p - h2^p)/(h2^p - h3^p) = d1/d2 by bisection; the
    left side grows with p. None when the differences do not fall as any order between 0.1 and 20 would make them.
    """
    h1, h2, h3 = np.asarray(sizes, dtype=float)[-3:]
    d1, d2 = np.asarray(differences, dtype=float)[-2:]
    if not (h1 > h2 > h3 > 0):
        raise ValueError(f"sizes must fall, from coarse to fine: {h1}, {h2}, {h3}")
    if d1 <= 0 or d2 <= 0:
        return None

    def excess(p: float) -> float:
        return float((h1**p - h2**p) / (h2**p - h3**p)) - d1 / d2

    low, high = 0.1, 20.0
    if excess(low) > 0 or excess(high) < 0:
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if excess(middle) > 0 else (middle, high)
    return 0.5 * (low + high)


def estimate(
    sizes: ArrayLike,
    values: ArrayLike,
    *,
    expected_order: float,
    round_off: float = 1e-10,
    other_error: ArrayLike = 0.0,
    typical: float = 0.1,
) -> Estimate:
    """Value, error bar and observed order at points computed on three or more meshes.

    Parameters
    ----------
    sizes : (m,) relative mesh sizes, falling, m >= 3.
    values : (m, n) figures on them.
    expected_order : order the elements should give; a higher observed one is not trusted.
    round_off : floor of the bar, relative to the largest value of the curve (linear solver and evaluation).
    other_error : (n,) or scalar, added to the bar: what the far field leaves.
    typical : the least difference of a point, over the root mean square of the curve; near one where meshes are
        coarse and a point's place in its cell decides its error.

    The bar at a point is SAFETY d / ((h2/h3)^p - 1) with p the observed order of the whole curve, at most the expected
    one, at least one half. Its difference d is |f3 - f2|; or, where larger, |f2 - f1| shrunk as the curve's largest
    difference did, or `typical` times the root mean square: at a single point the last difference is small by
    accident when the error passes through zero. Where no order can be seen the differences themselves (times SAFETY)
    are the bar: then the sequence has not converged regularly, and the bar says so.
    """
    sizes = np.asarray(sizes, dtype=float)
    values = np.asarray(values, dtype=float)
    if values.ndim != 2 or values.shape[0] != sizes.size or sizes.size < 3:
        raise ValueError(
            f"values must be (meshes, points) with at least three meshes: {values.shape}, {sizes.size} sizes"
        )
    scale = np.max(np.abs(values[-1]), initial=0.0)
    first = np.abs(values[-2] - values[-3])
    last = np.abs(values[-1] - values[-2])
    floor = round_off * scale
    order = None
    if np.max(last, initial=0.0) > floor:
        order = observed_order(sizes, (np.max(first), np.max(last)))
    least = typical * np.sqrt(np.mean(last**2)) if last.size else 0.0
    shrunk = first * np.max(last, initial=0.0) / max(np.max(first, initial=0.0), 1e-300)
    difference = np.maximum.reduce([last, np.minimum(shrunk, first), np.full_like(last, least)])
    if order is not None:
        used = min(max(order, 0.5), expected_order)
        difference = difference / ((sizes[-2] / sizes[-1]) ** used - 1)
    return Estimate(values[-1], SAFETY * difference + floor + np.abs(other_error), order)
