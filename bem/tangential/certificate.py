"""Certificate of a tangential contact: residual, slip and stick area, recomputed from the returned tractions.

The residual is the largest violation of Coulomb's law. The projection of q + t r onto the friction discs equals q if
and only if the law holds for the tractions q and the displacement residual r (minus the slip), for every stiffness
t > 0. With the stiffness of a single cell, the difference over t is a length. Cost: no convolution.

The stick area is of second order in the cell. Next to the edge of stick the traction falls short of friction x pressure
by k sqrt(d) at a distance d inside, and the surfaces slip by 4 k d^(3/2) / (3 E) outside: the missing traction behaves
like the pressure of a smaller contact, and the slip like its gap (Ciavarella, J. Mech. Phys. Solids 46 (1998); Jaeger,
Arch. Appl. Mech. 68 (1998)). `bem.contact.contact_area` therefore finds this edge too. E is the modulus of slip across
the edge or along it (E* and E* (1 - nu) of like bodies).

The slip is that of one step: where a step of a history moves the edge by less than a cell, the slip is smaller than
this law says, and the area is known to a part of a cell only. Rolling slips by another power; its cells are counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from bem.contact import ContactSolution
from bem.contact.contact_area import contact_region
from bem.grid import FloatArray
from bem.kernels.layered import frequency_response
from bem.kernels.loads import Load
from bem.tangential.friction_discs import project_to_friction_discs
from bem.tangential.operator import SlipOperator, TangentialOperator

BoolArray = NDArray[np.bool_]

_SMOOTHING = 1.5
"""Standard deviation [cells] of the filter before the direction of the edge is taken."""

_HALF_WAY = 0.602
"""Value of 3 E opening / (4 strength link) for an edge half-way between two centres; see `bem.contact.contact_area`."""

_CELL_WAVENUMBER = 0.5 * math.pi
"""Wavenumber times the length of a cell at which moduli are taken, as in the certificate of the contact."""

_LEAST_MISSING = 1e-12
"""Least missing traction of a sticking cell, relative to its bound."""


@dataclass(frozen=True)
class Certificate:
    """Coulomb's law for given tractions.

    residual : as in `TangentialSolution`.
    slip : (2, nx, ny) [m], zero on cells that do not slip.
    sticks : (nx, ny), True for cells in contact that do not slip.
    """

    residual: float
    slip: FloatArray
    sticks: BoolArray


def certify(
    operator: SlipOperator,
    bound: FloatArray,
    traction: FloatArray,
    displacement_residual: FloatArray,
    *,
    scale: float,
    traction_sum: FloatArray | None,
) -> Certificate:
    """Evaluate Coulomb's law: its residual, the slip and the sticking cells.

    Parameters
    ----------
    operator : of the grid and the bodies; its stiffness is used.
    bound : (nx, ny), friction x pressure [Pa].
    traction : (2, nx, ny) [Pa].
    displacement_residual : (2, nx, ny), minus the slip [m].
    scale : length [m] to which violations are relative.
    traction_sum : (2,), prescribed sum of the tractions over the cells [Pa], or None.
    """
    cells, stiffness = bound > 0, operator.stiffness
    trial = traction[:, cells] + stiffness * displacement_residual[:, cells]
    allowed = np.empty_like(trial)
    project_to_friction_discs(trial, bound[cells], allowed)
    violation = float(np.abs(allowed - traction[:, cells]).max(initial=0.0)) / stiffness
    residual = violation / scale if scale > 0 else 0.0
    if traction_sum is not None and cells.any():
        residual = max(residual, float(np.abs(traction.sum((1, 2)) - traction_sum).max() / bound.sum()))
    slips = np.zeros_like(cells)
    slips[cells] = np.hypot(*trial) > bound[cells]
    return Certificate(residual, np.where(slips, -displacement_residual, 0.0), cells & ~slips)


def stick_area(
    operator: TangentialOperator,
    bound: FloatArray,
    traction: FloatArray,
    certificate: Certificate,
    contact: ContactSolution | None,
) -> float:
    """Return the area that sticks [m^2], of second order.

    The edge of stick is found as the edge of a contact with the modulus E across the edge, whose pressure is the
    missing traction m = friction x pressure - abs(traction). Its gap is

    - on slipping cells, the slip as if it were directed across the edge;
    - outside contact, gap x (m/pressure) x (E*/E): next to the edge of contact m/pressure is constant and the gap is
      proportional to k / E*, so this is the gap of a contact with the pressure m;
    - on cells without friction, or if `contact` is None, the gap of an edge half-way between the centres.

    Parameters
    ----------
    operator : of the grid and the bodies.
    bound : (nx, ny), friction x pressure [Pa].
    traction : (2, nx, ny) [Pa].
    certificate : slip and sticking cells.
    contact : the normal contact, which has gap and pressure; None if only its pressure is known.
    """
    sticks, grid = certificate.sticks, operator.grid
    if not sticks.any():
        return 0.0
    missing = np.where(sticks, np.maximum(bound - np.hypot(*traction), _LEAST_MISSING * bound), 0.0)
    across, along = _moduli(operator)
    slips = (bound > 0) & ~sticks
    gap = np.where(slips, _slip_across_edge(certificate, across / along, grid.periodic), 0.0)
    link = math.sqrt(grid.cell_area)
    half_way = np.where(slips, 0.0, _mean_of_neighbours(missing) * (_HALF_WAY * link / (0.75 * across)))
    if contact is None:
        return contact_region(missing, gap + half_way, np.zeros(grid.shape), grid, across).area
    ratio = np.divide(missing, contact.pressure, out=np.zeros_like(missing), where=sticks)
    wavenumber = _CELL_WAVENUMBER / link
    normal = sum(float(frequency_response.surface_response(wavenumber, 0.0, b, Load.NORMAL)) for b in operator.bodies)
    outside = np.maximum(contact.gap, 0.0) * _mean_of_neighbours(ratio) * (2 / (wavenumber * normal) / across)
    gap += np.where(contact.pressure > 0, half_way, outside)
    undeformed = contact.gap - contact.displacement
    return min(contact_region(missing, gap, undeformed, grid, across).area, contact.contact_area)


def _moduli(operator: TangentialOperator) -> tuple[float, float]:
    """Return the moduli E [Pa] of slip across the edge and along it, for waves of the length of a cell."""
    wavenumber = _CELL_WAVENUMBER / math.sqrt(operator.grid.cell_area)
    response = np.sum([frequency_response.in_plane_response(wavenumber, 0.0, body) for body in operator.bodies], axis=0)
    return 2 / (wavenumber * float(response[0])), 2 / (wavenumber * float(response[1]))


def _slip_across_edge(certificate: Certificate, ratio: float, periodic: tuple[bool, bool]) -> FloatArray:
    """Return the slip [m] that a slip across the edge of stick would have, under the same missing traction.

    The direction of the edge is the gradient of the smoothed map of sticking cells.

    ratio : modulus across the edge over the modulus along it.
    """
    modes = ["wrap" if wraps else "nearest" for wraps in periodic]
    smooth = gaussian_filter(certificate.sticks.astype(np.float64), _SMOOTHING, mode=modes)
    # along an axis of one cell the gradient is zero
    gradients = [
        np.gradient(smooth, axis=axis) if n > 1 else np.zeros_like(smooth) for axis, n in enumerate(smooth.shape)
    ]
    normal, slip = np.stack(gradients), certificate.slip
    distance = np.hypot(*slip)
    product = np.hypot(*normal) * distance
    cosine = np.divide((normal * slip).sum(0), product, out=np.full_like(product, math.sqrt(0.5)), where=product > 0)
    return np.asarray(distance / (cosine**2 + (1 - cosine**2) * ratio))


def _mean_of_neighbours(values: FloatArray) -> FloatArray:
    """Return the mean of the positive values among the four neighbours of each cell; zero where there are none."""
    total, count = np.zeros_like(values), np.zeros_like(values)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        neighbour = np.roll(values, step, axis)
        total += neighbour
        count += neighbour > 0
    return np.divide(total, count, out=total, where=count > 0)
