"""Partial slip by accelerated projected gradients: nothing of `bem.tangential` but the operator, and slow.

Nesterov's method with a restart where the energy's slope turns (O'Donoghue, Candes, Found. Comput. Math. 15 (2015)).
"""

import numpy as np


def oracle(operator, bound, shift, rounds=4000, tolerance=1e-11):
    """Tractions (2, nx, ny) under friction x pressure (nx, ny) and a shift (2,) of all cells."""
    step = 1 / max(np.linalg.eigvalsh(_waves(operator)).max(), 1e-300)
    cells = bound > 0
    traction = np.zeros((2, *bound.shape))
    ahead, pace = traction, 1.0
    for _ in range(rounds):
        slope = operator(ahead) - np.asarray(shift)[:, None, None]
        moved = np.where(cells, _inside(ahead - step * slope, bound), 0.0)
        change = moved - traction
        if ((ahead - moved) * change).sum() > 0:
            pace = 1.0
        following = 0.5 * (1 + np.sqrt(1 + 4 * pace**2))
        ahead = moved + (pace - 1) / following * change
        traction, pace = moved, following
        if np.abs(change).max() <= tolerance * bound.max():
            return traction
    raise AssertionError("the oracle did not converge")


def _inside(traction, bound):
    length = np.hypot(*traction)
    return traction * np.where(length > bound, bound / np.where(length > 0, length, 1.0), 1.0)


def _waves(operator):
    xx, yy, xy = operator.spectra
    return np.stack([np.stack([xx, xy], -1), np.stack([xy, yy], -1)], -1)
