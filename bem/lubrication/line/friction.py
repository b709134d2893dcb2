"""Friction force of a steady line film: Couette and rolling part, with the inlet upstream of the mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.newton import LineState
from bem.lubrication.line.problem import Scales
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear_profile import middle_stress


def upstream_of_mesh(state: LineState) -> tuple[float, float]:
    """Return the integrals of 1/H and 1/H^2 upstream of the mesh, where H = X^2/2 + c with small c; zero upstream of a
    meniscus."""
    start = abs(float(state.position[0]))
    offset = float(state.film[0]) - 0.5 * start**2
    return state.far_field * 2 / start * (1 - 2 * offset / start**2 / 3), state.far_field * 4 / (3 * start**3)


def rolling_part(thickness: FloatArray, pressure: FloatArray) -> float:
    """Return the integral of h/2 dp/dx [N/m] by the trapezoidal rule, of films (n,) [m] and pressures (n,) [Pa]."""
    return 0.25 * float(np.sum((thickness[1:] + thickness[:-1]) * np.diff(pressure)))


def trapezoid(position: FloatArray, values: FloatArray) -> float:
    """Return the trapezoidal integral of values (n,) at positions (n,)."""
    return float(np.sum(0.5 * np.diff(position) * (values[1:] + values[:-1])))


def sliding_stress(
    lubricant: Lubricant, position: FloatArray, thickness: FloatArray, pressure: FloatArray, sliding: float
) -> FloatArray:
    """Return the shear stress in the middle of the film [Pa], of walls that slide at u1 - u2 [m/s]; arrays (n,), SI."""
    newtonian = lubricant.viscosity_at(pressure) * sliding / thickness
    return middle_stress(lubricant, newtonian, pressure, thickness, np.gradient(pressure, position))


def rolling_upstream(state: LineState) -> float:
    """Return the integral of h/2 dp/dx upstream of the mesh, in units of pressure times film; zero upstream of a
    meniscus.

    There h^3/(12 mu) dp/dx = (u1 + u2)/2 (h - h_e).
    """
    tail_1, tail_2 = upstream_of_mesh(state)
    return 3 * (tail_1 - float(state.film[-1]) * tail_2)


@dataclass(frozen=True)
class Friction:
    """Forces per unit length of a film with positive entrainment [N/m]: in the full film, and its rolling part."""

    full: float
    rolling: float


def film_friction(
    state: LineState,
    scales: Scales,
    speeds: Sequence[float],
    reversed_: bool,
    lubricant: Lubricant,
) -> Friction:
    """Return the friction forces of a steady film."""
    x, film = state.position, state.film
    pressure = np.maximum(state.pressure, 0.0)
    difference = (speeds[0] - speeds[1]) * (-1.0 if reversed_ else 1.0)
    thickness = film * scales.film
    position = x * scales.length

    tail_1 = upstream_of_mesh(state)[0]
    sliding = sliding_stress(lubricant, position, thickness, pressure * scales.pressure, difference)
    couette = trapezoid(position, sliding)
    couette += lubricant.viscosity * difference * tail_1 * scales.length / scales.film
    rolling = (rolling_part(film, pressure) + rolling_upstream(state)) * scales.film * scales.pressure
    full = couette + rolling

    return Friction(full, rolling)
