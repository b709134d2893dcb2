"""How full the gap of a starved point contact is, where it carries no pressure: compiled loops.

A cell without pressure holds what comes in, of which no more leaves than comes (Jakobsson and Floberg 1957, Olsson
1965): its content m is dragged on, 6 c m, in place of the rho h of a full one (`loops`). At an angle to the axes that
goes on along either one as a full one's would: split as c is, what leaves would jump where the cell becomes full, and
among bumps there is no film then. Outermost cells hold the layer that the surfaces bring along. A change of what a
cell without pressure gets is thus one of the next full cells downstream: `carried` adds it to their balances, so that
it is no unknown. Verified in tests/lubrication/point/test_point_supply.py and test_rough_film_at_an_angle.py.
"""

from __future__ import annotations

from typing import Any

from bem.compiled import compiled
from bem.grid import FloatArray


@compiled
def contents(
    p: FloatArray,
    layer: float,
    drag: tuple[float, float],
    spacing: tuple[float, float],
    full: Any,
    flow: FloatArray,
    stencil: FloatArray,
    held: Any,
    content: FloatArray,
    split: FloatArray,
) -> None:
    """Which cells are not full (nx, ny), what is in all, the flow out of those that are not in place of a full one's,
    which does not depend on films, and the share of it that leaves along x. full : outermost cells that are."""
    nx, ny = p.shape
    dx, dy = spacing
    along, across = drag[0] / dx, drag[1] / dy
    carried, even = 6.0 * (along + across), along / (along + across)
    for i in range(nx):
        for j in range(ny):
            content[i, j] = stencil[8, i, j]
            held[i, j] = False
            split[i, j] = even
            if full[i, j]:
                continue
            if i == 0 or j == 0 or i == nx - 1 or j == ny - 1:
                held[i, j] = True
                content[i, j] = min(layer, content[i, j])
            elif p[i, j] <= 0.0:
                comes = (flow[0, i - 1, j] - flow[0, i, j] + stencil[11, i, j]) / dx
                comes += (flow[1, i, j - 1] - flow[1, i, j] + stencil[12, i, j]) / dy
                leaves = stencil[11, i, j] / dx + stencil[12, i, j] / dy
                if comes < leaves:
                    held[i, j] = True
                    content[i, j] = comes / carried
                    split[i, j] = stencil[11, i, j] / dx / leaves
            if held[i, j]:
                leaves = carried * content[i, j]
                flow[0, i, j] += split[i, j] * leaves * dx - stencil[11, i, j]
                flow[1, i, j] += (1.0 - split[i, j]) * leaves * dy - stencil[12, i, j]
                stencil[11, i, j] = stencil[12, i, j] = 0.0


@compiled
def nothing_dragged(held: Any, stencil: FloatArray) -> None:
    """No flow out of cells (nx, ny) depends on their films."""
    nx, ny = held.shape
    for i in range(nx):
        for j in range(ny):
            if held[i, j]:
                stencil[11, i, j] = 0.0
                stencil[12, i, j] = 0.0


@compiled
def carried(held: Any, split: FloatArray, out: FloatArray) -> None:
    """Add balances (nx, ny) of inner cells that are not full to those downstream, which get what they do not keep, this
    share of it the next one along x."""
    nx, ny = out.shape
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if held[i, j]:
                out[i + 1, j] += split[i, j] * out[i, j]
                out[i, j + 1] += (1.0 - split[i, j]) * out[i, j]
