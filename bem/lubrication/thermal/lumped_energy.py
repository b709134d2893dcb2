"""Energy balance of lumped heat: mean temperature of the oil along a film, and of the surfaces.

On cells along the film, heat q1 and q2 enters both bodies, which are moving half-spaces (`bem.heat.operators`); the oil
carries the rest of the generated heat. Even generation makes a parabola between the walls:

    generated = q1 + q2 + C dT/dx,    T = (T1 + T2)/2 + (q1 + q2) h/(12 k),    q1 - q2 = 2 k (T2 - T1)/h,

with Ti = bulk + Ki qi and C = rho c times the flow. Linear in the generated heat, which falls with temperature through
the viscosity: Newton's method on the temperatures of the cells, with limited steps. Energy closes by construction, to
rounding. Verified in tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.line_contact import band_temperatures

MAX_STEPS = 200
"""Largest number of Newton steps."""
LONGEST_STEP = 40.0
"""Longest change of a temperature in one step [K]."""
SHORTEST_STEP = 0.5
"""Bound of that change after residuals that grew [K]."""
TOLERANCE = 1e-9
"""Tolerance of the temperatures, over the largest rise."""


@dataclass(frozen=True)
class Channel:
    """The film for the energy balance, on m cells along the entrainment.

    edges : (m+1,) ascending [m]. thickness : (m,) [m]. conductivity : of the oil [W/(m K)].
    capacity_flow : C, density times heat capacity times flow per length [W/(m K)].
    supply : temperature of the supplied oil [K]. bodies : lower, upper.
    """

    edges: FloatArray
    thickness: FloatArray
    conductivity: float
    capacity_flow: float
    supply: float
    bodies: tuple[Conductor, Conductor]


@dataclass(frozen=True)
class Temperatures:
    """Result on the cells.

    oil, surfaces : (m,), (2, m) [K]. into : (2, m) heat into both bodies [W/m^2]. heat : (m,) generated [W/m^2].
    steps : of Newton's method. residual : deviation from the temperatures of the own heat, over the largest rise.
    """

    oil: FloatArray
    surfaces: FloatArray
    into: FloatArray
    heat: FloatArray
    steps: int
    residual: float


Heat = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Function of temperatures (m,) [K] that returns the generated heat (m,) [W/m^2] and its derivatives (3, m): with the
temperature of a cell, of the heat in the cell before, in itself and in the cell behind."""


def film_temperatures(channel: Channel, heat: Heat, kernels: Sequence[FloatArray] | None = None) -> Temperatures:
    """Solve for the temperatures.

    kernels : `band_temperatures` of both bodies on the edges; computed by default.
    """
    if kernels is None:
        kernels = [band_temperatures(channel.edges, body) for body in channel.bodies]
    into, oil = _responses(channel, kernels)
    base, resting = oil[:, 0], into[:, 0]
    response = oil[:, 1:]
    temperature = base.copy()
    residual, last, longest, steps = np.inf, np.inf, LONGEST_STEP, 0
    while True:
        generated, slope = heat(temperature)
        missed = temperature - base - response @ generated
        rise = max(float(np.ptp(temperature)), float(np.abs(temperature - base).max()), 1e-3)
        residual = float(np.abs(missed).max()) / rise
        if residual <= TOLERANCE or steps == MAX_STEPS or not np.isfinite(residual):
            break
        matrix = _difference(response, slope)
        change = -lu_solve(lu_factor(matrix, check_finite=False), missed, check_finite=False)
        longest = max(0.5 * longest, SHORTEST_STEP) if residual > last else min(1.5 * longest, LONGEST_STEP)
        last = residual
        temperature = temperature + np.clip(change, -longest, longest)
        steps += 1
    fluxes = (resting + into[:, 1:] @ generated).reshape(2, -1)
    bulk = np.array([[body.bulk] for body in channel.bodies])
    surfaces = bulk + np.stack([kernel @ flux for kernel, flux in zip(kernels, fluxes, strict=True)])
    return Temperatures(temperature, surfaces, fluxes, generated, steps, residual)


def _difference(response: FloatArray, slope: FloatArray) -> FloatArray:
    """Return 1 - response x slope (m, m), for a slope as of `Heat`."""
    out = -response * slope[1]
    out[:, 1:] -= response[:, :-1] * slope[0, 1:]
    out[:, :-1] -= response[:, 1:] * slope[2, :-1]
    np.einsum("ii->i", out)[...] += 1.0
    return out


def _responses(channel: Channel, kernels: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return fluxes into the bodies (2m, 1 + m) and temperatures of the oil (m, 1 + m): without heat, and per unit of
    heat in each cell.

    kernels : temperatures of both surfaces per flux in each cell (m, m).
    """
    cells, width = len(channel.thickness), np.diff(channel.edges)
    one, (lower, upper) = np.eye(cells), kernels
    first, second = (body.bulk for body in channel.bodies)
    across = channel.thickness / (12 * channel.conductivity)
    # oil temperature = mean bulk + by_flux @ (q1, q2)
    by_flux = np.concatenate([0.5 * lower + np.diag(across), 0.5 * upper + np.diag(across)], axis=1)
    carried = channel.capacity_flow / width
    balance = np.concatenate([one, one], axis=1) + carried[:, None] * np.diff(by_flux, axis=0, prepend=0.0)
    walls = channel.thickness / (2 * channel.conductivity)
    between = np.concatenate([np.diag(walls) + lower, -np.diag(walls) - upper], axis=1)
    right = np.zeros((2 * cells, 1 + cells))
    right[:cells, 1:] = one
    mean = 0.5 * (first + second)
    right[0, 0] = carried[0] * (channel.supply - mean)
    right[cells:, 0] = second - first
    fluxes = lu_solve(lu_factor(np.concatenate([balance, between])), right)
    oil = by_flux @ fluxes
    oil[:, 0] += mean
    return np.asarray(fluxes), np.asarray(oil)
