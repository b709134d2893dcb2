"""Fractional film defect: the factor on local wear that a boundary film of adsorbed molecules leaves.

A molecule stays adsorbed for the mean time t0 exp(E / kB T) and returns at once. A place is bare if its molecule
desorbs while an asperity passes over it, which takes x / U. The fraction of bare places, 1 - exp(-x / (U t0 exp(E / kB
T))), is the factor on the unprotected wear. It rises with the temperature at each place, flash temperature included.

Source: Kingsbury (1958), J. Appl. Phys. 29, 888; Rowe (1966), ASLE Trans. 9, 101; both quoted from memory.

Verified in tests/wear/test_film_defect.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.physical_constants import BOLTZMANN


@dataclass(frozen=True)
class FilmDefect:
    """Boundary film and sliding speed.

    adsorption_energy : E of a molecule [J].
    sliding_speed : U [m/s]; at rest no place is bare.
    temperature : where no local temperature is known [K].
    molecule_length : x along which an asperity passes a molecule [m].
    vibration_time : t0 of the adsorbed molecule [s].
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
        """Return the fraction of unprotected wear, 0 to 1, at temperatures (nx, ny) [K].

        None takes the film's own temperature and returns one number.
        """
        warm = np.asarray(self.temperature if temperature is None else temperature)
        if self.sliding_speed == 0:
            return np.zeros_like(warm)
        stays = self.vibration_time * np.exp(np.minimum(self.adsorption_energy / (BOLTZMANN * warm), 700.0))
        return np.asarray(-np.expm1(-self.molecule_length / self.sliding_speed / stays))


def film_defect_misfits(criterion: str, wears_by_pressure: bool, traction: str, slides: bool) -> list[str]:
    """Return a message for the criterion and for the traction law that do not go with a boundary film.

    criterion, traction : names of the laws. wears_by_pressure, slides : of `Criterion` and of `TractionLaw`.
    """
    found = []
    if not wears_by_pressure:
        found.append(f"film_defect of criterion {criterion}; allowed: archard, archard_over_hardness, energy, or none")
    if not slides:
        found.append(f"film_defect has one sliding speed; allowed: no traction {traction}, or none")
    return found
