"""Mass-conserving cavitation of a point contact on cells: how full the gap is where the oil carries no pressure.

1. A ruptured cell holds the oil that flows in, and no more leaves it than comes (Jakobsson and Floberg 1957, Olsson
   1965): its oil content m moves on with the Couette flux 6 c m in place of 6 c rho h of a full cell (`reynolds`).
2. At an angle to the axes the content leaves along x and y in the ratio in which a full cell's oil would leave. Split
   in the ratio of the entrainment, the fluxes would jump when the cell fills, and rough films have no solution.
3. Outermost cells hold the layer that the surfaces bring along.
4. A change of the inflow of a ruptured cell is a change of the inflow of the next full cells downstream.
   `pass_downstream` adds it to their balances, so a content is no unknown of the Newton system.

With Swift and Stieber's condition ruptured cells have no account of oil; `film_fraction` then follows from the solved
fluxes in one sweep downstream.

Cost: one sweep over the cells. Verified in tests/lubrication/point/test_point_supply.py and
test_rough_film_at_an_angle.py.
"""

from __future__ import annotations

from typing import Any

from bem.compiled import compiled
from bem.grid import FloatArray


@compiled
def fill_partially(
    p: FloatArray,
    layer: float,
    entrainment: tuple[float, float],
    spacing: tuple[float, float],
    full: Any,
    flux: FloatArray,
    derivatives: FloatArray,
    ruptured: Any,
    content: FloatArray,
    split: FloatArray,
) -> None:
    """Find the ruptured cells and their oil content; replace their Couette flux, which depends on no film.

    Parameters
    ----------
    p : (nx, ny) pressures of the oil.
    layer : oil that the surfaces bring along, as a film thickness.
    entrainment : components of the entrainment along x and y.
    spacing : of the cells along x and y.
    full : (nx, ny) outermost cells that are full.
    flux, derivatives : of `reynolds`, changed in place.
    ruptured, content, split : (nx, ny) results: ruptured cells, oil content of all cells, and the share of the outflow
        of a ruptured cell that leaves along x.
    """
    nx, ny = p.shape
    dx, dy = spacing
    along, across = entrainment[0] / dx, entrainment[1] / dy
    outflow, even = 6.0 * (along + across), along / (along + across)
    for i in range(nx):
        for j in range(ny):
            content[i, j] = derivatives[8, i, j]
            ruptured[i, j] = False
            split[i, j] = even
            if full[i, j]:
                continue
            if i == 0 or j == 0 or i == nx - 1 or j == ny - 1:
                ruptured[i, j] = True
                content[i, j] = min(layer, content[i, j])
            elif p[i, j] <= 0.0:
                comes = (flux[0, i - 1, j] - flux[0, i, j] + derivatives[11, i, j]) / dx
                comes += (flux[1, i, j - 1] - flux[1, i, j] + derivatives[12, i, j]) / dy
                leaves = derivatives[11, i, j] / dx + derivatives[12, i, j] / dy
                if comes < leaves:
                    ruptured[i, j] = True
                    content[i, j] = comes / outflow
                    split[i, j] = derivatives[11, i, j] / dx / leaves
            if ruptured[i, j]:
                leaves = outflow * content[i, j]
                flux[0, i, j] += split[i, j] * leaves * dx - derivatives[11, i, j]
                flux[1, i, j] += (1.0 - split[i, j]) * leaves * dy - derivatives[12, i, j]
                derivatives[11, i, j] = derivatives[12, i, j] = 0.0


@compiled
def remove_couette(ruptured: Any, derivatives: FloatArray) -> None:
    """Set the Couette flux out of ruptured cells (nx, ny) to zero: it depends on no film."""
    nx, ny = ruptured.shape
    for i in range(nx):
        for j in range(ny):
            if ruptured[i, j]:
                derivatives[11, i, j] = 0.0
                derivatives[12, i, j] = 0.0


@compiled
def pass_downstream(ruptured: Any, split: FloatArray, out: FloatArray) -> None:
    """Add the balances (nx, ny) of ruptured inner cells to the cells downstream, the share `split` along x."""
    nx, ny = out.shape
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if ruptured[i, j]:
                out[i + 1, j] += split[i, j] * out[i, j]
                out[i, j + 1] += (1.0 - split[i, j]) * out[i, j]


@compiled
def film_fraction(
    flux: FloatArray,
    oil_mass: FloatArray,
    full: Any,
    entrainment: tuple[float, float],
    spacing: tuple[float, float],
    fraction: FloatArray,
) -> None:
    """Compute the film fraction (nx, ny) of ruptured cells from the fluxes of a Swift-Stieber film.

    The fraction is the inflow of a cell, from full cells and from ruptured cells upstream, over the Couette outflow of
    the full cell. Outermost cells take the fraction of the cell beside them; full cells keep their value.
    """
    nx, ny = oil_mass.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if full[i, j]:
                continue
            inflow = 0.0
            if full[i - 1, j]:
                inflow += flux[0, i - 1, j] / dx
            else:
                inflow += 6.0 * entrainment[0] * fraction[i - 1, j] * oil_mass[i - 1, j] / dx
            if full[i, j - 1]:
                inflow += flux[1, i, j - 1] / dy
            else:
                inflow += 6.0 * entrainment[1] * fraction[i, j - 1] * oil_mass[i, j - 1] / dy
            if full[i + 1, j]:
                inflow -= flux[0, i, j] / dx
            if full[i, j + 1]:
                inflow -= flux[1, i, j] / dy
            outflow = 6.0 * oil_mass[i, j] * (entrainment[0] / dx + entrainment[1] / dy)
            fraction[i, j] = min(max(inflow / outflow, 0.0), 1.0)
    for i in range(nx):
        for j in range(ny):
            if not full[i, j] and (i == 0 or j == 0 or i == nx - 1 or j == ny - 1):
                fraction[i, j] = fraction[min(max(i, 1), nx - 2), min(max(j, 1), ny - 2)]
