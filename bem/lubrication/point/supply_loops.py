"""How full the gap of a starved point contact is, where it carries no pressure: compiled loops.

A cell without pressure holds what comes in, of which no more leaves than comes (Jakobsson and Floberg 1957, Olsson
1965): its content m is dragged on, 6 c m, in place of the rho h of a full one (`loops`). Outermost cells hold the layer
that the surfaces bring along. A change of what a cell without pressure gets is thus one of the next full cells
downstream: `carried` adds it to their balances, so that it is no unknown. Verified in
tests/lubrication/point/test_point_supply.py.
"""

from __future__ import annotations

from typing import Any

import numba as nb

from bem.grid import FloatArray
from bem.lubrication.point.loops import COMPILE


@nb.njit(**COMPILE)
def contents(
    p: FloatArray,
    layer: float,
    drag: tuple[float, float],
    spacing: tuple[float, float],
    flow: FloatArray,
    stencil: FloatArray,
    held: Any,
    content: FloatArray,
) -> None:
    """Which cells are not full (nx, ny), what is in all, and the flow out of those that are not in place of a full
    one's, which does not depend on films."""
    nx, ny = p.shape
    dx, dy = spacing
    carried = 6.0 * (drag[0] / dx + drag[1] / dy)
    for i in range(nx):
        for j in range(ny):
            content[i, j] = stencil[8, i, j]
            held[i, j] = False
            if i == 0 or j == 0 or i == nx - 1 or j == ny - 1:
                held[i, j] = True
                content[i, j] = min(layer, content[i, j])
            elif p[i, j] <= 0.0:
                comes = (flow[0, i - 1, j] - flow[0, i, j] + stencil[11, i, j]) / dx
                comes += (flow[1, i, j - 1] - flow[1, i, j] + stencil[12, i, j]) / dy
                if comes < stencil[11, i, j] / dx + stencil[12, i, j] / dy:
                    held[i, j] = True
                    content[i, j] = comes / carried
            if held[i, j]:
                for axis in range(2):
                    flow[axis, i, j] += 6.0 * drag[axis] * content[i, j] - stencil[11 + axis, i, j]
                    stencil[11 + axis, i, j] = 0.0


@nb.njit(**COMPILE)
def nothing_dragged(held: Any, stencil: FloatArray) -> None:
    """No flow out of cells (nx, ny) depends on their films."""
    nx, ny = held.shape
    for i in range(nx):
        for j in range(ny):
            if held[i, j]:
                stencil[11, i, j] = 0.0
                stencil[12, i, j] = 0.0


@nb.njit(**COMPILE)
def carried(held: Any, drag: tuple[float, float], spacing: tuple[float, float], out: FloatArray) -> None:
    """Add balances (nx, ny) of inner cells that are not full to those downstream, which get what they do not keep."""
    nx, ny = out.shape
    along, across = drag[0] / spacing[0], drag[1] / spacing[1]
    share = along / (along + across)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if held[i, j]:
                out[i + 1, j] += share * out[i, j]
                out[i, j + 1] += (1.0 - share) * out[i, j]
