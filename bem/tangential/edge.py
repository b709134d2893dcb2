"""The edge of stick inside cells: its area of second order, from tractions and slip on cells.

Next to that edge the traction falls short of friction x pressure by k sqrt(d) at a distance d inside, and surfaces
slip by 4 k d^(3/2) / (3 E) outside: what is missing of the bound is as the pressure of a smaller contact, and the slip
as its gap (Ciavarella, J. Mech. Phys. Solids 46 (1998); Jaeger, Arch. Appl. Mech. 68 (1998)).
`bem.contact.contact_area` therefore finds one edge like the other. E is that of slip across the edge or along it (E*
and E* (1 - nu) of like bodies).

The slip is that of a step: where a history moves the edge by less than a cell in one, it is less than that law says,
and the area is known to a part of a cell only. What rolls slips by another power and is counted.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from bem.contact import ContactSolution
from bem.contact.contact_area import contact_region
from bem.grid import FloatArray
from bem.kernels import layered
from bem.tangential.operator import TangentialOperator

_SMOOTH = 1.5
"""Cells over which the edge's direction is taken."""
_HALF_WAY = 0.602
"""Of 3 E opening / (4 strength link): there the edge lies half-way between two centres (`bem.contact.contact_area`)."""
_WAVE = 0.5 * math.pi
"""Wavenumber times the cell's length that stands for the cell, as in the contact's certificate."""
_TINY = 1e-12
_NEIGHBOURS = ((0, 1), (0, -1), (1, 1), (1, -1))
"""Axes and steps."""


def stuck_area(
    operator: TangentialOperator,
    bound: FloatArray,
    traction: FloatArray,
    slip: FloatArray,
    sticks: NDArray[np.bool_],
    contact: ContactSolution | None,
) -> float:
    """Area that sticks [m^2].

    Parameters
    ----------
    operator : of the grid and the bodies.
    bound : friction x pressure (nx, ny) [Pa].
    traction, slip : (2, nx, ny) [Pa], [m].
    sticks : the cells (nx, ny).
    contact : where stick ends with the contact its gap says where; None: half-way between cells.
    """
    if not sticks.any():
        return 0.0
    grid = operator.grid
    missing = np.where(sticks, np.maximum(bound - np.hypot(*traction), _TINY * bound), 0.0)
    across, along = _moduli(operator)
    slips = (bound > 0) & ~sticks
    opening = np.where(slips, _as_across(sticks, slip, across / along, grid.periodic), 0.0)
    link = math.sqrt(grid.cell_area)
    half_way = np.where(slips, 0.0, _around(missing) * (_HALF_WAY * link / (0.75 * across)))
    shape = np.zeros(grid.shape)
    if contact is None:
        return contact_region(missing, opening + half_way, shape, grid, across).area
    ratio = np.divide(missing, contact.pressure, out=np.zeros_like(missing), where=sticks)
    normal = sum(float(layered.surface_response(_WAVE / link, 0.0, b, tangential=False)) for b in operator.bodies)
    parted = np.maximum(contact.gap, 0.0) * _around(ratio) * (2 * link / (_WAVE * normal) / across)
    opening += np.where(contact.pressure > 0, half_way, parted)
    shape = contact.gap - contact.displacement
    return min(contact_region(missing, opening, shape, grid, across).area, contact.contact_area)


def _moduli(operator: TangentialOperator) -> tuple[float, float]:
    """E [Pa] of slip across the edge and along it, as the length of a cell sees them."""
    wave = _WAVE / math.sqrt(operator.grid.cell_area)
    response = np.sum([layered.in_plane_response(wave, 0.0, body) for body in operator.bodies], axis=0)
    return 2 / (wave * float(response[0])), 2 / (wave * float(response[1]))


def _as_across(sticks: NDArray[np.bool_], slip: FloatArray, ratio: float, periodic: tuple[bool, bool]) -> FloatArray:
    """Slip distance [m] that the same missing traction would make across the edge; `ratio` of both moduli."""
    modes = ["wrap" if wraps else "nearest" for wraps in periodic]
    smooth = gaussian_filter(sticks.astype(np.float64), _SMOOTH, mode=modes)
    # across a single row of cells nothing changes
    normal = np.stack(
        [
            np.gradient(smooth, axis=axis) if cells > 1 else np.zeros_like(smooth)
            for axis, cells in enumerate(smooth.shape)
        ]
    )
    size = np.hypot(*normal)
    distance = np.hypot(*slip)
    product = size * distance
    cosine = np.divide((normal * slip).sum(0), product, out=np.full_like(product, math.sqrt(0.5)), where=product > 0)
    return np.asarray(distance / (cosine**2 + (1 - cosine**2) * ratio))


def _around(values: FloatArray) -> FloatArray:
    """Mean of the positive values among the four neighbours of each cell; 0 where there are none."""
    total, count = np.zeros_like(values), np.zeros_like(values)
    for axis, step in _NEIGHBOURS:
        beside = np.roll(values, step, axis)
        total += beside
        count += beside > 0
    return np.divide(total, count, out=total, where=count > 0)
