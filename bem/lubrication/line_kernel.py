"""Deflection of a half-plane under a line-contact pressure that is linear between nodes."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray


def logarithmic_weights(targets: FloatArray, nodes: FloatArray) -> FloatArray:
    """Weights W with `W @ p = integral of p(x') ln|x - x'| dx'` at the targets, p linear between the nodes.

    Exact: the second difference over the nodes of t^2/2 ln|t| - 3 t^2/4, the second primitive of ln|t|;
    at the two ends the first primitive t ln|t| - t closes the half hat.
    The deflection of both bodies is -2/(pi E*) times this, up to a constant that the load fixes.

    Parameters
    ----------
    targets : (m,) positions, any order.
    nodes : (n,) ascending positions, n >= 2, in the same unit.

    Returns
    -------
    (m, n) weights, in that unit.
    """
    distance = targets[:, None] - nodes[None, :]
    log = np.abs(distance)
    np.maximum(log, np.finfo(np.float64).tiny, out=log)
    np.log(log, out=log)
    ends = distance[:, [0, -1]]
    first = ends * log[:, [0, -1]] - ends
    log -= 1.5
    log *= distance
    log *= distance
    log *= 0.5
    slope = np.diff(log, axis=1)
    slope /= np.diff(nodes)
    weights = log
    weights[:, 1:-1] = slope[:, 1:] - slope[:, :-1]
    weights[:, 0] = first[:, 0] + slope[:, 0]
    weights[:, -1] = -first[:, 1] - slope[:, -1]
    return weights
