"""Waves of roughness in a film: the published ripples of Greenwood and Morales-Espejel, and the inlet's flow by
differences."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.linalg import solve_banded
from scipy.optimize import brentq

from bem.grid import FloatArray
from bem.verification.closed_forms import curve
from bem.verification.rows import Curve, Gate

MODULUS, WAVELENGTH, AMPLITUDE = 113.5e9, 0.2e-3, 0.25e-6
"""E* = E'/2 [Pa] and the wave [m] of Greenwood and Morales-Espejel, Proc. IMechE J 208 (1994) 121."""
FILMS = ((1.341e-6, 0.388e9, 33.1e-9), (0.698e-6, 0.413e9, 18.5e-9))
"""Film [m], pressure ripple [Pa] and film ripple [m] at 50 and at 80 C, from a transcription."""
_CELLS, _FAR = 4000, 14.0


def published_ripples() -> list[Curve]:
    """Ripples of a transverse wave in sliding. The pressure of the contact is not given: the film ripple at 50 C gives
    it, by the oil's compression; both pressure ripples follow. The film ripple at 80 C is in tests (within 1 %)."""
    from bem.lubrication import Lubricant
    from bem.lubrication.waves.plateau import Plateau, wave_amplitudes

    oil = Lubricant(1.0)

    def ripples(film: float, pressure: float) -> tuple[float, float]:
        density, slope = oil.density_ratio(np.array(pressure))
        stiff = Plateau(film, pressure, 1e9, 1e9, film * float(slope / density), MODULUS, 1.0, 1e-5, 1e-4)
        found = wave_amplitudes(stiff, np.array([2 * math.pi / WAVELENGTH]), np.zeros(1), 0.5)
        return AMPLITUDE * abs(found.particular_film[0]), AMPLITUDE * abs(found.particular_pressure[0])

    (first, first_pressure, first_ripple), (second, second_pressure, _) = FILMS
    pressure = float(brentq(lambda p: ripples(first, p)[0] - first_ripple, 1e8, 4e9, rtol=1e-12))
    found = np.array([ripples(film, pressure)[1] for film in (first, second)])
    exact = np.array([first_pressure, second_pressure])
    return [curve("pressure", "ripples", "Pa", np.zeros((2, 3)), found, exact, 6e-3, "three digits, a transcription")]


def inlet_by_differences(wave: float, ky: float, speed_ratio: float, film: FloatArray | None = None) -> complex:
    """Return the flow that an undeformed wave exp(iKX) lets into the contact, from its pressure by finite volumes.

    Cells are uniform in the root of the distance before the edge. `film` : (cells + 1,) at faces in its place.
    """
    root = np.linspace(0.0, math.sqrt(_FAR), _CELLS + 1)
    face = root**2
    centre = 0.5 * (face[1:] + face[:-1])
    size, between = np.diff(face), np.diff(centre)
    opening = 1 + face**1.5
    change = np.exp(-1j * wave * face) if film is None else film
    # distances from the centres to both ends of a face; the pressure vanishes at the edge and far away
    gap = np.concatenate([[centre[0]], between, [face[-1] - centre[-1]]])
    conductance = opening**3 / gap
    drag = (3 / opening - 2) * change
    matrix = np.zeros((3, _CELLS), dtype=complex)
    matrix[1] = -(conductance[1:] + conductance[:-1]) - ky**2 * (1 + centre**1.5) ** 3 * size
    matrix[0, 1:] = matrix[2, :-1] = conductance[1:-1]
    # flow along X = -s leaves a cell at its near face: difference of drag, less storage
    stored = 1j * speed_ratio * wave * 0.5 * (change[1:] + change[:-1]) * size
    pressure = solve_banded((1, 1), matrix, drag[:-1] - drag[1:] - stored)
    # pressure falls to zero over the half cell at the edge: H^3 dphi/dX = -H^3 dphi/ds
    return complex(drag[0] + conductance[0] * pressure[0])


def inlet_flow(wave: float, ky: float, ratio: float) -> list[Curve]:
    """Flow into the contact under an undeformed wave."""
    from bem.lubrication.waves import inlet

    found = inlet.inlet_flow(np.array([wave]), ky, ratio).of_roughness[0]
    exact = inlet_by_differences(wave, ky, ratio)
    here, there = (np.array([one.real, one.imag]) for one in (complex(found), exact))
    return [curve("flow", "real, imaginary", "", np.zeros((2, 3)), here, there, 1e-3, "4000 finite volumes")]


def gates() -> list[Gate]:
    """Gates of rough films by waves."""
    ripples = "Ripples of transverse waves in sliding (Greenwood and Morales-Espejel 1994)."
    flow = "Flow of a wave through the inlet of a film, by finite volumes."
    return [
        Gate("wave-ripples", "closed_forms", ripples, published_ripples),
        Gate("wave-inlet-rolling", "closed_forms", flow, partial(inlet_flow, 0.8, 0.0, 1.0)),
        Gate("wave-inlet-oblique", "closed_forms", flow, partial(inlet_flow, 2.0, 1.5, 0.6)),
    ]
