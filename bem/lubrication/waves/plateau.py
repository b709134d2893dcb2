r"""Waves in the flat part of an elastohydrodynamic film: what oil and bodies let them do.

The film h, pressure, viscosity mu and density rho of the smooth contact are uniform there. A surface that stands out of
its body by a exp(i(kx (x - u_j t) + ky y)) changes the film by d = -a + C p and the pressure by p, with the compliance
of both half-spaces C = 2/(E* k), k^2 = kx^2 + ky^2. Reynolds' equation for the mass film g = d + h p/B, with the bulk
modulus B = rho/(drho/dp),

    h^3/12 (kx^2/mu_x + ky^2/mu_y) p = -i kx (u - u_j) g,

gives the particular wave (Greenwood and Morales-Espejel 1994)

    p = i kx (u - u_j) a / [h^3/12 (kx^2/mu_x + ky^2/mu_y) + i kx (u - u_j) (C + h/B)].

The oil's own wave, the complementary one, has d = C' p at kx' = kx u_j/u, moves with the mean speed u and decays over
the distance at the rate h^3/12 (kx'^2/mu_x + ky^2/mu_y) / (u (C' + h/B)).

In an oil whose film is sheared by the law of its friction, mu_x is the slope of stress over rate of shear along sliding
and mu_y their ratio (small flow on top of a large one); else both are the viscosity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.waves.inlet import tabulated_inlet_flow

ComplexArray = NDArray[np.complex128]
_STEP = 1e-4
"""Relative step of the difference that gives the slope of stress over rate."""
_LEAST = 1e-9
"""Least effective viscosity over the Newtonian one, of an oil at its limiting shear stress."""


@dataclass(frozen=True)
class Plateau:
    """Smooth film in the middle of the contact.

    Attributes
    ----------
    film : h [m].
    pressure : [Pa].
    viscosity_along, viscosity_across : mu_x and mu_y, effective ones of waves along and across sliding [Pa s].
    compression : h/B [m/Pa].
    contact_modulus : E* [Pa].
    mean_speed : u, of entrainment along +x [m/s].
    inlet_length : l [m].
    reach : distance from the edge to the middle [m].
    """

    film: float
    pressure: float
    viscosity_along: float
    viscosity_across: float
    compression: float
    contact_modulus: float
    mean_speed: float
    inlet_length: float
    reach: float

    def compliance(self, kx: FloatArray, ky: FloatArray) -> FloatArray:
        """Return 2/(E* k) [m/Pa], infinite of k = 0."""
        with np.errstate(divide="ignore"):
            return np.asarray(2 / (self.contact_modulus * np.hypot(kx, ky)))

    def leakage(self, kx: FloatArray, ky: FloatArray) -> FloatArray:
        """Return h^3/12 (kx^2/mu_x + ky^2/mu_y) [m/(Pa s)]."""
        return self.film**3 / 12 * (kx**2 / self.viscosity_along + ky**2 / self.viscosity_across)


@dataclass(frozen=True, eq=False)
class WaveAmplitudes:
    """Amplitudes of film and pressure that a wave of unit height out of a body leaves; arrays of the waves' shape.

    Attributes
    ----------
    particular_film, particular_pressure : of the wave that moves with the surface [1, Pa/m].
    complementary_film, complementary_pressure : of the wave that moves with the oil, at the edge of the contact.
    decay : exponent of the complementary wave's amplitude, from the edge to the middle.
    """

    particular_film: ComplexArray
    particular_pressure: ComplexArray
    complementary_film: ComplexArray
    complementary_pressure: ComplexArray
    decay: FloatArray


def effective_viscosities(lubricant: Lubricant, pressure: float, rate: float) -> tuple[float, float]:
    """Return the viscosities [Pa s] of small flows along and across a large shear at a rate [1/s]."""
    viscosity = float(lubricant.viscosity_at(np.array(pressure)))
    if not lubricant.shears_film or rate == 0:
        return viscosity, viscosity
    newtonian = viscosity * abs(rate)
    stress = lubricant.shear_stress(newtonian * np.array([1 - _STEP, 1.0, 1 + _STEP]), np.full(3, pressure))
    along = float(stress[2] - stress[0]) / (2 * _STEP * newtonian)
    return viscosity * max(along, _LEAST), viscosity * max(float(stress[1]) / newtonian, _LEAST)


def wave_amplitudes(plateau: Plateau, kx: FloatArray, ky: FloatArray, speed: float) -> WaveAmplitudes:
    """Return what waves of a body with a speed [m/s] along x leave of film and pressure.

    kx, ky : [1/m], any signs, not both zero.
    """
    ratio = speed / plateau.mean_speed
    compliance, compression = plateau.compliance(kx, ky), plateau.compression
    swept = 1j * kx * (plateau.mean_speed - speed)
    leakage = plateau.leakage(kx, ky)
    pressure = swept / (leakage + swept * (compliance + compression))
    displacement = compliance * pressure
    film = displacement - 1
    # flow of the particular wave over the mean speed
    along = plateau.film**3 / (12 * plateau.viscosity_along * plateau.mean_speed)
    flow = film + compression * pressure - 1j * kx * along * pressure
    carried = plateau.compliance(ratio * kx, ky)
    scaled = kx * plateau.inlet_length, ky * plateau.inlet_length
    inlet = tabulated_inlet_flow(*scaled, ratio)
    stiff = np.where(np.isfinite(carried), compression / carried, 0.0)
    raised = (-inlet.of_roughness + displacement * inlet.of_particular - flow) / (1 + stiff - inlet.of_complementary)
    rate = plateau.leakage(ratio * kx, ky) / (plateau.mean_speed * (carried + compression))
    return WaveAmplitudes(
        film,
        pressure,
        raised,
        np.where(np.isfinite(carried), raised / carried, 0.0),
        np.where(np.isfinite(carried), rate * plateau.reach, 0.0),
    )


def rolling_amplitude(plateau: Plateau, kx: FloatArray, ky: FloatArray) -> FloatArray:
    """Return the amplitude of waves [1/m] in the middle over that of the surface, in pure rolling."""
    found = wave_amplitudes(plateau, kx, ky, plateau.mean_speed)
    return np.asarray(np.abs(found.particular_film + found.complementary_film * np.exp(-found.decay)))
