"""Waviness that rolls through a point contact: what is left of its amplitude in the centre."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.scales import point_scales
from bem.reference_solutions.hertz import ellipse_contact

SETTLED = 1.5
"""Waves that have passed the centre before the amplitude of one is taken."""


def amplitude_reduction(waves: float, ratio: float = 0.0) -> float:
    """Amplitude in the centre over that of the body for (wavelength/half-axis) (M/L)^(1/2), in pure rolling.

    A_d/A_i = 1/(1 + 0.15 f n + 0.015 (f n)^2), f = exp(1 - 1/r) for a ratio r > 1 of wavelengths along and across the
    flow, of which the shorter counts, and 1 else (Venner and Lubrecht, Proc. IMechE J 213 (1999) 137; *Multilevel
    methods in lubrication*, 2000; here from memory). A fit: their own solutions scatter around it by about 10 %. Linear
    equations around the film, exact in time, come to it within 4 % from n = 4.5 on, and at n = 2 to 3.5 lie above it by
    about 15 % at M 64 and 200 (reports/experiments/waviness_reduction.py). n is the wavelength over the inlet's length.
    """
    n = waves * (math.exp(1 - 1 / ratio) if ratio > 1 else 1.0)
    return 1 / (1 + 0.15 * n + 0.015 * n**2)


def rolling_reduction(
    wavelength: float, load: float, radius: float, contact_modulus: float, film: PointFilmSolution
) -> float:
    """`amplitude_reduction` of waves across the flow [m] under a ball, with the oil and the speeds of a film."""
    total = abs(film.speeds[0][0] + film.speeds[1][0])
    scales = point_scales(load, (radius, radius), contact_modulus, total, film.lubricant.viscosity)
    half = ellipse_contact(radii=(radius, radius), contact_modulus=contact_modulus, load=load).semi_axes[0]
    material = film.lubricant.pressure_viscosity * scales.pressure
    return amplitude_reduction(wavelength / half * math.sqrt(scales.load / material))


def amplitude_in_centre(films: Sequence[PointFilmSolution], wavelength: float, begin: float | None) -> float | None:
    """Of the film at the centre over the last wave [m], where waves across the flow roll along x with both surfaces and
    begin there at first [m]; None before they have come far enough, or of steps that do not see a wave."""
    speed = abs(films[-1].speeds[0][0])
    time = np.array([film.time for film in films], dtype=np.float64)
    come = speed * (time[-1] - time[0]) - (0.0 if begin is None else abs(begin))
    last = time > time[-1] - wavelength / speed
    if come < SETTLED * wavelength or last.sum() < 8:
        return None
    film = np.array([film.central_thickness for film in films])[last]
    phase = 2 * np.pi * speed / wavelength * time[last]
    parts = np.linalg.lstsq(np.column_stack([np.ones_like(phase), np.cos(phase), np.sin(phase)]), film, rcond=None)[0]
    return float(np.hypot(*parts[1:]))
