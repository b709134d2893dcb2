"""Sinusoidal surfaces in contact: a row of cylinders (Westergaard) and crossed sinusoids.

Westergaard, *J. Appl. Mech.* 6 (1939) 49; Johnson, *Contact Mechanics* (1985), section 13.2;
Johnson, Greenwood & Higginson, *Int. J. Mech. Sci.* 27 (1985) 383.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class SinusoidalContact:
    """A row with undeformed gap `amplitude` (1 - cos 2 pi x / wavelength), crest at x = 0, under `mean_pressure` [Pa].

    amplitude: half the peak-to-valley height [m].
    """

    amplitude: float
    wavelength: float
    contact_modulus: float
    mean_pressure: float

    def __post_init__(self) -> None:
        messages = [
            f"SinusoidalContact: {name} {value!r} must be positive and finite"
            for name, value in vars(self).items()
            if not (math.isfinite(value) and value > 0)
        ]
        if messages:
            raise InputError(messages)

    @property
    def full_contact_pressure(self) -> float:
        """Mean pressure [Pa] at which the last valley closes: p* = pi E* amplitude / wavelength."""
        return math.pi * self.contact_modulus * self.amplitude / self.wavelength

    @property
    def half_width(self) -> float:
        """Half-width of a contact [m]: p_mean = p* sin^2(pi a / wavelength); half a wavelength once full."""
        share = min(self.mean_pressure / self.full_contact_pressure, 1.0)
        return self.wavelength / math.pi * math.asin(math.sqrt(share))

    @property
    def contact_fraction(self) -> float:
        """Contact area over nominal area."""
        return 2 * self.half_width / self.wavelength

    def pressure(self, x: ArrayLike) -> FloatArray:
        """Pressure [Pa] at x [m]: 2 p* cos(psi) sqrt(sin^2 psi_a - sin^2 psi), psi = pi x / wavelength.

        Beyond full contact p_mean + p* cos 2 psi.
        """
        psi = np.pi * np.asarray(x) / self.wavelength
        star = self.full_contact_pressure
        if self.mean_pressure >= star:
            return self.mean_pressure + star * np.cos(2 * psi)
        inside = self.mean_pressure / star - np.sin(psi) ** 2
        return 2 * star * np.abs(np.cos(psi)) * np.sqrt(np.maximum(inside, 0.0))

    def gap(self, x: ArrayLike) -> FloatArray:
        """Deformed gap [m]: amplitude (2 s sqrt(s^2 - t^2) - 2 t^2 arccosh(s/t)), s = |sin psi|, t = sin psi_a."""
        s = np.abs(np.sin(np.pi * np.asarray(x) / self.wavelength))
        t2 = self.mean_pressure / self.full_contact_pressure
        if t2 >= 1:
            return np.zeros_like(s)
        t = math.sqrt(t2)
        s = np.maximum(s, t)
        return 2 * self.amplitude * (s * np.sqrt(np.maximum(s * s - t2, 0.0)) - t2 * np.arccosh(s / t))


def crossed_full_contact_pressure(amplitude: float, wavelengths: tuple[float, float], contact_modulus: float) -> float:
    """p* [Pa] of gap amplitude (1 - cos kx x cos ky y): E* amplitude sqrt(kx^2 + ky^2) / 2, kx = 2 pi / lx, ky alike.

    An infinite wavelength gives the row. For equal wavelengths sqrt(2) pi E* amplitude / wavelength (Johnson,
    Greenwood & Higginson).
    """
    wavenumber = 2 * math.pi * math.hypot(1 / wavelengths[0], 1 / wavelengths[1])
    return 0.5 * contact_modulus * amplitude * wavenumber


def crossed_full_contact(
    x: ArrayLike,
    y: ArrayLike,
    *,
    amplitude: float,
    wavelengths: tuple[float, float],
    contact_modulus: float,
    mean_pressure: float,
) -> FloatArray:
    """Pressure [Pa] in full contact of gap amplitude (1 - cos(2 pi x/lx) cos(2 pi y/ly)).

    Raises
    ------
    InputError : a mean pressure below the full-contact pressure, where no closed form is known.
    """
    star = crossed_full_contact_pressure(amplitude, wavelengths, contact_modulus)
    if not mean_pressure >= star:
        raise InputError(f"mean_pressure {mean_pressure!r} must be at least the full-contact pressure {star!r}")
    kx, ky = (2 * math.pi / length for length in wavelengths)
    return mean_pressure + star * np.cos(kx * np.asarray(x)) * np.cos(ky * np.asarray(y))


def crossed_contact_fraction_light(pressure_ratio: float) -> float:
    """Contact fraction of equal crossed sinusoids for p_mean/p* << 1: pi (3/8pi p_mean/p*)^(2/3).

    Hertz on the two crests per wavelength squared, in the form of Johnson, Greenwood & Higginson.
    """
    return math.pi * (3 * pressure_ratio / (8 * math.pi)) ** (2 / 3)


def crossed_contact_fraction_near_full(pressure_ratio: float) -> float:
    """Contact fraction of equal crossed sinusoids for 1 - p_mean/p* << 1: 1 - (3/2pi)(1 - p_mean/p*).

    Each valley is a penny-shaped gap whose edge carries no stress concentration.
    """
    return 1 - 3 / (2 * math.pi) * (1 - pressure_ratio)
