"""Pin pressed into a slightly larger hole of an infinite plate, without friction, for elastically similar bodies.

Persson (1964) for equal materials; Ciavarella and Decuzzi (2001) for materials whose Dundurs beta is zero. Neither
paper could be read; the formulas are quoted from memory and agree to 1e-10 with the integral equation of
`bem.contact.shaft_in_bush`, which is derived and solved without them. Verified in tests/contact/test_shaft_in_bush.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

CITES = ("persson1964", "ciavarella2001")
"""Sources, keys of `bem/references.bib`."""


def load_of_angle(half_angle: float, *, modulus: float, alpha: float, clearance: float) -> float:
    """Return the load per length [N/m] under which pin and plate touch over a half-angle.

    With b = tan(half_angle/2): E' c / Q = [2 - (1 - alpha)(ln(1 + b^2) + 2 b^4)] / [pi (1 + alpha) b^2 (1 + b^2)].

    Parameters
    ----------
    half_angle : of the contact [rad].
    modulus : plane-strain modulus E' of the pin [Pa].
    alpha : Dundurs' alpha, (E'_plate - E'_pin)/(E'_plate + E'_pin).
    clearance : difference of the radii [m]; positive.
    """
    square = math.tan(0.5 * half_angle) ** 2
    numerator = 2 - (1 - alpha) * (math.log1p(square) + 2 * square**2)
    return modulus * clearance * math.pi * (1 + alpha) * square * (1 + square) / numerator


def pressure_at(angle: NDArray[np.float64], *, half_angle: float, load: float, radius: float) -> NDArray[np.float64]:
    """Return the pressure [Pa] at angles from the load line [rad], zero outside the contact.

    With y = tan(angle/2) and b = tan(half_angle/2) it is the load per length over the radius times
    2 sqrt(b^2 - y^2)/[pi sqrt(1 + b^2)(1 + y^2)] + artanh(sqrt((b^2 - y^2)/(b^2 + 1)))/[pi b^2 (1 + b^2)].
    """
    b, y = math.tan(0.5 * half_angle), np.tan(0.5 * np.abs(angle))
    root = np.sqrt(np.maximum(b**2 - y**2, 0.0))
    first = 2 * root / (math.pi * math.sqrt(1 + b**2) * (1 + y**2))
    second = np.arctanh(root / math.sqrt(1 + b**2)) / (math.pi * b**2 * (1 + b**2))
    return load / radius * (first + second)
