"""Local solution of Reynolds' equation around a pressure spike: nonlinear elimination.

Newton's method on all cells takes many short steps where a spike lands some cells beside its place. Only there are the
equations far from linear. The pressures of `SPIKE_NODES` nodes on either side are therefore solved for alone, all
others fixed, before a step is judged (P. J. Lanzkron, D. J. Rose and J. T. Wilkes, *SIAM J. Sci. Comput.* 17 (1996)
538). Cost: up to twelve dense systems of 120 unknowns.
"""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, LineOperator
from bem.lubrication.line.reynolds import Flow

SPIKE_NODES = 60
"""Nodes on either side of the spike that are solved for."""
LEAST_RESIDUAL_SHARE = 0.3
"""Residual around the spike over that of all other cells, from which a local solution pays."""
LOCAL_STEPS = 12
"""Largest number of local Newton steps."""
SHORTEST_STEP = 0.2
"""Shortest length of a local step."""


def solve_spike(
    flow: Flow, operator: LineOperator, pressure: FloatArray, film: FloatArray, error: FloatArray
) -> FloatArray | None:
    """Return pressures (n+1,) that solve the equations around the spike; None where the residual is elsewhere or no
    step helps.

    pressure, film : (n+1,). error : (n,) residuals of the cells.
    """
    cells = len(flow.width)
    top = int(np.argmin(np.diff(pressure) / flow.width))
    first, last = max(top - SPIKE_NODES, 1), min(top + SPIKE_NODES, cells)
    rest = float(np.linalg.norm(error[:first])) + float(np.linalg.norm(error[last:]))
    start = float(np.linalg.norm(error[first:last]))
    if start < LEAST_RESIDUAL_SHARE * rest:
        return None
    local, nodes = flow.cut(first - 1, last), slice(first - 1, last + 1)
    response = -DEFLECTION * operator.factor * operator.block(first, last)
    exit_film, inner = float(film[-1]), slice(1, -1)
    p, h = pressure[nodes].copy(), film[nodes]
    wrong, parts = local.residual(p, h, exit_film)
    size, index = start, np.arange(last - first)
    for _ in range(LOCAL_STEPS):
        before, here, after, low, diagonal, high = (d[1:, None] for d in local.derivatives(parts))
        matrix = before * response[:-2] + here * response[1:-1] + after * response[2:]
        matrix[index, index] += diagonal[:, 0]
        matrix[index[:-1], index[1:]] += high[:-1, 0]
        matrix[index[1:], index[:-1]] += low[1:, 0]
        change = np.linalg.solve(matrix, -wrong[1:])
        film_change = response @ change
        length = 1.0
        while length > SHORTEST_STEP:
            new_p, new_h = p.copy(), h + length * film_change
            new_p[inner] += length * change
            if new_h.min() > 0:
                new_wrong, new_parts = local.residual(new_p, new_h, exit_film)
                new_size = float(np.linalg.norm(new_wrong[1:]))
                if new_size < (1 - 0.05 * length) * size:
                    break
            length *= 0.5
        else:
            break
        p, h, wrong, parts, size = new_p, new_h, new_wrong, new_parts, new_size
        if size < max(0.1 * rest, 1e-3 * start):
            break
    if size == start:
        return None
    better = pressure.copy()
    better[first:last] = p[inner]
    return better
