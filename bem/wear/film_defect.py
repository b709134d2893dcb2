"""What a boundary film leaves of local wear: the share of a surface that adsorbed molecules do not cover.

Molecules leave the surface thermally and come back in no time: one stays t0 exp(E / kB T), and is missing where an
asperity passes over its place, which takes x / U, if it leaves meanwhile. The share of places without one, Kingsbury's
fractional film defect, is that of unprotected wear which is left (Kingsbury 1958, J. Appl. Phys. 29, 888; Rowe 1966,
ASLE Trans. 9, 101; both from memory): it rises with the temperature of each place, flash temperature included.

Verified in tests/wear/test_film_defect.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.friction.boundary import BOLTZMANN
from bem.grid import FloatArray


@dataclass(frozen=True)
class FilmDefect:
    """A boundary film, and what slides over it.

    adsorption_energy : E of a molecule [J]. sliding_speed : U [m/s]; no place is bared at rest. temperature : [K] where
    none is known place by place. molecule_length : x along which an asperity passes a molecule [m]. vibration_time : t0
    of the adsorbed molecule [s].
    """

    adsorption_energy: float
    sliding_speed: float
    temperature: float
    molecule_length: float = 5e-10
    vibration_time: float = 3e-12

    def __post_init__(self) -> None:
        messages = [
            f"film defect: {name} {getattr(self, name)!r} must be positive and finite"
            for name in ("adsorption_energy", "temperature", "molecule_length", "vibration_time")
            if not (math.isfinite(getattr(self, name)) and getattr(self, name) > 0)
        ]
        if not (math.isfinite(self.sliding_speed) and self.sliding_speed >= 0):
            messages.append(f"film defect: sliding_speed {self.sliding_speed!r} must be >= 0 and finite")
        if messages:
            raise InputError(messages)

    def share(self, temperature: FloatArray | None = None) -> FloatArray:
        """Of unprotected wear that is left, 0 to 1, at temperatures (nx, ny) [K]; None is the film's own everywhere,
        one number."""
        warm = np.asarray(self.temperature if temperature is None else temperature)
        if self.sliding_speed == 0:
            return np.zeros_like(warm)
        stays = self.vibration_time * np.exp(np.minimum(self.adsorption_energy / (BOLTZMANN * warm), 700.0))
        return np.asarray(-np.expm1(-self.molecule_length / self.sliding_speed / stays))
