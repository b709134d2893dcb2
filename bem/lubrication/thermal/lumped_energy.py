"""Mean temperature of the oil along a line film, and of the surfaces, from the heat made in it.

On cells along the film, heat q1 and q2 goes into both bodies, which are moving half-spaces
(`bem.heat.operators`), the rest of what is made is carried on by the oil. Heat made evenly across the film makes a
parabola between the walls:

    made = q1 + q2 + C dT/dx,    T = (T1 + T2)/2 + (q1 + q2) h/(12 k),    q1 - q2 = 2 k (T2 - T1)/h,

with Ti = bulk + Ki qi and C = rho c times the flow. Linear in the heat made, which falls with temperature through the
viscosity: Newton's method on the temperatures of the cells. Energy closes by construction, to rounding. Verified in
tests/lubrication/test_thermal_film.py.
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
LONGEST_STEP = 40.0
"""Of a temperature in one step of Newton's method [K]."""
SHORTEST_STEP = 0.5
TOLERANCE = 1e-9


@dataclass(frozen=True)
class Channel:
    """The film as heat sees it, on m cells along the entrainment.

    edges : (m+1,) ascending [m]. thickness : (m,) [m]. conductivity : of the oil [W/(m K)]. capacity_flow : C, density
    x heat capacity x flow per length [W/(m K)]. supply : temperature of the oil that comes [K]. bodies : lower, upper.
    """

    edges: FloatArray
    thickness: FloatArray
    conductivity: float
    capacity_flow: float
    supply: float
    bodies: tuple[Conductor, Conductor]


@dataclass(frozen=True)
class Temperatures:
    """On the cells: of oil and both surfaces [K], heat into both bodies [W/m^2] (2, m) and made [W/m^2]; steps of
    Newton's method, and by how much its temperatures miss those of their own heat, over the largest rise."""

    oil: FloatArray
    surfaces: FloatArray
    into: FloatArray
    made: FloatArray
    steps: int
    residual: float


Heat = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Heat made in the cells (m,) [W/m^2] at their temperatures (m,) [K], and derivatives (3, m): by the temperature of a
cell, of the heat in the one before, in itself and in the one behind."""


def film_temperatures(channel: Channel, heat: Heat, kernels: Sequence[FloatArray] | None = None) -> Temperatures:
    """Temperatures at which the heat made goes where it can; `kernels` are `band_temperatures` of both bodies on the
    edges, where they are known."""
    if kernels is None:
        kernels = [band_temperatures(channel.edges, body) for body in channel.bodies]
    into, oil = _responses(channel, kernels)
    base, resting = oil[:, 0], into[:, 0]
    response = oil[:, 1:]
    temperature = base.copy()
    residual, last, longest, steps = np.inf, np.inf, LONGEST_STEP, 0
    while True:
        made, slope = heat(temperature)
        missed = temperature - base - response @ made
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
    fluxes = (resting + into[:, 1:] @ made).reshape(2, -1)
    bulk = np.array([[body.bulk] for body in channel.bodies])
    surfaces = bulk + np.stack([kernel @ flux for kernel, flux in zip(kernels, fluxes, strict=True)])
    return Temperatures(temperature, surfaces, fluxes, made, steps, residual)


def _difference(response: FloatArray, slope: FloatArray) -> FloatArray:
    """1 - response x slope (m, m), of a slope as of `Heat`."""
    out = -response * slope[1]
    out[:, 1:] -= response[:, :-1] * slope[0, 1:]
    out[:, :-1] -= response[:, 1:] * slope[2, :-1]
    np.einsum("ii->i", out)[...] += 1.0
    return out


def _responses(channel: Channel, kernels: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Fluxes into the bodies (2m, 1 + m) and temperatures of the oil (m, 1 + m): without heat, and per unit of heat
    made in each cell; the kernels are the temperatures of both surfaces per flux in each cell (m, m)."""
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
