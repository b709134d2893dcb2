"""Flow of a point contact between rough walls on cells: what `loops.flows` is between smooth ones.

Pressure flow goes with phi h^3 and what is dragged with h + k s phi_s (`bem.lubrication.flow_factors`). The factor of a
face is the harmonic mean of those of its cells: where contact bars one, nothing flows past it. Knows arrays alone;
verified in tests/lubrication/point/test_rough_point.py.
"""

from __future__ import annotations

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.point.loops import add_dragged, pressure_flow


@compiled
def _barred(factor: FloatArray, slope: FloatArray, along_y: int, flow: FloatArray, stencil: FloatArray) -> None:
    """Pressure flow through the faces along one axis and its derivatives (4, nx, ny), from those of smooth walls."""
    nx, ny = factor.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            left, right = factor[i, j], factor[k, n]
            total = left + right
            mean = 2.0 * left * right / total
            smooth = flow[i, j]
            stencil[0, i, j] *= mean
            stencil[1, i, j] *= mean
            stencil[2, i, j] = mean * stencil[2, i, j] + 2.0 * (right / total) ** 2 * slope[i, j] * smooth
            stencil[3, i, j] = mean * stencil[3, i, j] + 2.0 * (left / total) ** 2 * slope[k, n] * smooth
            flow[i, j] = mean * smooth


@compiled
def rough_flows(
    p: FloatArray,
    h: FloatArray,
    oil: FloatArray,
    walls: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    flow: FloatArray,
    stencil: FloatArray,
) -> None:
    """As `loops.flows`, between walls (6, nx, ny): phi_x, phi_y and what is dragged, each with its derivative."""
    pressure_flow(p, h, oil, spacing[0], 0, flow[0], stencil[0:4])
    _barred(walls[0], walls[1], 0, flow[0], stencil[0:4])
    pressure_flow(p, h, oil, spacing[1], 1, flow[1], stencil[4:8])
    _barred(walls[2], walls[3], 1, flow[1], stencil[4:8])
    stencil[8] = oil[2] * walls[4]
    stencil[9] = walls[5] / walls[4]
    stencil[10] = oil[3] / oil[2]
    add_dragged(drag, flow, stencil)
