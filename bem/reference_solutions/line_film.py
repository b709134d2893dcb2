"""Films of a cylinder on a flat: Martin's rigid one, of a short inlet too, the squeeze film, fits in common use."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.grid import FloatArray


def _primitive(angle: float | FloatArray, exit_angle: float) -> float | FloatArray:
    return (angle / 2 + np.sin(2 * angle) / 4 + math.pi / 4) - (
        3 * angle / 8 + np.sin(2 * angle) / 4 + np.sin(4 * angle) / 32 + 3 * math.pi / 16
    ) / math.cos(exit_angle) ** 2


EXIT_ANGLE = 0.4435543342177832
"""Zero of `_primitive(a, a)`. Where the film ends: x = sqrt(2 R h_min) tan(0.44346); there h = 1.22575 h_min."""
MARTIN_FACTOR = 6 * math.cos(EXIT_ANGLE) ** 2
"""h_min = 4.8950 mu u R / w, u the mean speed."""


@dataclass(frozen=True)
class MartinFilm:
    """Rigid cylinder on a flat, isoviscous oil, Swift-Stieber exit; Martin (1916), *Engineering* 102, 119."""

    load: float
    radius: float
    viscosity: float
    mean_speed: float

    @property
    def minimum_thickness(self) -> float:
        """[m], at x = 0."""
        return MARTIN_FACTOR * self.viscosity * self.mean_speed * self.radius / self.load

    @property
    def exit_position(self) -> float:
        """[m]."""
        return math.sqrt(2 * self.radius * self.minimum_thickness) * math.tan(EXIT_ANGLE)

    def thickness(self, position: FloatArray) -> FloatArray:
        """[m] at positions [m]."""
        return self.minimum_thickness + position**2 / (2 * self.radius)

    def pressure(self, position: FloatArray) -> FloatArray:
        """[Pa] at positions [m]; zero behind the exit."""
        lowest = self.minimum_thickness
        scale = math.sqrt(2 * self.radius * lowest)
        angle = np.arctan(position / scale)
        value = 12 * self.viscosity * self.mean_speed * scale / lowest**2 * _primitive(angle, EXIT_ANGLE)
        return np.where(angle < EXIT_ANGLE, value, 0.0)


@dataclass(frozen=True)
class InletFilm:
    """Rigid cylinder on a flat, isoviscous oil that begins `inlet` before the axis, Swift-Stieber exit.

    Martin's integrals from the inlet's angle instead of -pi/2: with x = sqrt(2 R h) tan a, the pressure is zero at both
    ends where the primitive's difference is, and the load is 24 mu u R / h times -[sin^2 a / 2 + cos^4 a / (4 cos^2 e)]
    between them, e the exit. The film of an infinite inlet is Martin's.

    load : by length [N/m]; radius, inlet [m]; viscosity [Pa s]; mean_speed : of both surfaces [m/s], positive.
    """

    load: float
    radius: float
    viscosity: float
    mean_speed: float
    inlet: float

    @cached_property
    def minimum_thickness(self) -> float:
        """[m], at x = 0."""
        from scipy.optimize import brentq

        martin = MartinFilm(self.load, self.radius, self.viscosity, self.mean_speed).minimum_thickness
        # the shorter the inlet the less is carried: the film lies below Martin's
        low = martin
        while self._carried(low) < self.load:
            low *= 0.25
        return low if low == martin else float(brentq(lambda h: self._carried(h) / self.load - 1, low, martin))

    @property
    def exit_position(self) -> float:
        """[m]; at most half the inlet, which it is of a film much thicker than the gap grows."""
        lowest = self.minimum_thickness
        return math.sqrt(2 * self.radius * lowest) * math.tan(self._ends(lowest)[1])

    def _ends(self, thickness: float) -> tuple[float, float]:
        """Angles of inlet and exit."""
        from scipy.optimize import brentq

        begin = -math.atan(self.inlet / math.sqrt(2 * self.radius * thickness))

        def left(exit_angle: float) -> float:
            return float(_primitive(exit_angle, exit_angle) - _primitive(begin, exit_angle))

        return begin, float(brentq(left, 1e-9 * -begin, min(-begin, 1.0)))

    def _carried(self, thickness: float) -> float:
        """Load [N/m]."""
        begin, end = self._ends(thickness)

        def inner(angle: float) -> float:
            return 0.5 * math.sin(angle) ** 2 + math.cos(angle) ** 4 / (4 * math.cos(end) ** 2)

        return 24 * self.viscosity * self.mean_speed * self.radius / thickness * (inner(begin) - inner(end))


def squeeze_load(thickness: float, approach_speed: float, radius: float, viscosity: float) -> float:
    """Load per length [N/m] of a rigid cylinder coming down on a flat at a speed [m/s], isoviscous oil.

    From h^3/(12 mu) p' = -V x: p = 6 mu R V / h^2, and its integral 3 pi mu V R sqrt(2 R) / h0^(3/2).
    """
    return 3 * math.pi * viscosity * approach_speed * radius * math.sqrt(2 * radius) / thickness**1.5


def squeeze_thickness(time: FloatArray, start: float, load: float, radius: float, viscosity: float) -> FloatArray:
    """Film [m] at times [s] under a constant load [N/m], from `start` [m]: 1/sqrt(h0) grows linearly with time."""
    rate = load / (6 * math.pi * viscosity * radius * math.sqrt(2 * radius))
    return (start**-0.5 + rate * np.asarray(time)) ** -2


def dowson_higginson_minimum(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    mean_speed: float,
    viscosity: float,
    pressure_viscosity: float,
) -> float:
    """Fit of the minimum film [m]: h/R = 2.65 U^0.7 G^0.54 / W^0.13, E' = 2 E*; Dowson (1968), Proc. IMechE 182."""
    reduced = 2 * contact_modulus
    speed = viscosity * mean_speed / (reduced * radius)
    return 2.65 * radius * speed**0.7 * (pressure_viscosity * reduced) ** 0.54 / (load / (reduced * radius)) ** 0.13


def isoviscous_elastic_minimum(
    *, load: float, radius: float, contact_modulus: float, mean_speed: float, viscosity: float
) -> float:
    """Fit of the minimum film of soft bodies [m]: h/R = 3.10 U^0.6 / W^0.2, U = mu u/(E' R), W = w/(E' R), E' = 2 E*.

    Isoviscous-elastic regime of lines after Herrebrugh (1968), in the constants of Hamrock's textbook; neither read.
    """
    reduced = 2 * contact_modulus
    speed = viscosity * mean_speed / (reduced * radius)
    return 3.10 * radius * speed**0.6 / (load / (reduced * radius)) ** 0.2


def moes_central(load: float, piezo: float) -> float:
    """Fit of the central film in Moes' variables, H(M, L) with U = mu (u1 + u2)/(E' R) and E' = 2 E*.

    Moes (1992), *Wear* 159, 57: rigid or elastic, isoviscous or piezoviscous regimes joined; a fit to within about
    ten per cent.
    """
    rigid_iso, elastic_iso = 3 / load, 2.621 * load**-0.2
    rigid_piezo, elastic_piezo = 1.287 * piezo ** (2 / 3), 1.311 * load**-0.125 * piezo**0.75
    power = (7 + 8 * math.exp(-2 * elastic_iso / rigid_iso)) / 5
    iso = (rigid_iso ** (7 / 3) + elastic_iso ** (7 / 3)) ** (3 * power / 7)
    piezoviscous = 0.0
    if piezo > 0:
        piezoviscous = (rigid_piezo**-3.5 + elastic_piezo**-3.5) ** (-2 * power / 7)
    return (iso + piezoviscous) ** (1 / power)
