"""How fast a tribofilm grows: stress-activated Arrhenius kinetics."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.constants import Boltzmann, electron_volt

from bem.errors import InputError
from bem.grid import FloatArray

ZERO_CELSIUS = 273.15


@dataclass(frozen=True)
class StressActivatedGrowth:
    """Growth rate `prefactor * exp(-(activation_energy - shear_stress * activation_volume) / (k_B T))` [m/s].

    Gosvami et al., Science 348 (2015) 102; thesis, paper E, eq. 3 (its prefactor is 1e-2 m/s, not nm/s).

    Parameters
    ----------
    prefactor : [m/s]. activation_energy : without stress [J]. activation_volume : [m^3]; 0 switches stress activation
    off and leaves plain Arrhenius growth.
    """

    prefactor: float
    activation_energy: float
    activation_volume: float

    def __post_init__(self) -> None:
        messages = []
        for key in ("prefactor", "activation_energy"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0):
                messages.append(f"StressActivatedGrowth: {key} {value!r} must be positive and finite")
        if not (math.isfinite(self.activation_volume) and self.activation_volume >= 0):
            messages.append(
                f"StressActivatedGrowth: activation_volume {self.activation_volume!r} must be >= 0 and finite [m^3]"
            )
        if messages:
            raise InputError(messages)

    @classmethod
    def from_electron_volts(
        cls, prefactor: float, activation_energy_ev: float, activation_volume_cubic_angstrom: float
    ) -> StressActivatedGrowth:
        """From the units of the literature: m/s, eV and cubic angstrom."""
        return cls(prefactor, activation_energy_ev * electron_volt, activation_volume_cubic_angstrom * 1e-30)

    def rate(self, shear_stress: FloatArray, temperature: float) -> FloatArray:
        """Growth rate [m/s] under a shear stress [Pa] at an absolute temperature [K].

        The barrier cannot be lower than zero: beyond `activation_energy / activation_volume` the rate is the prefactor.

        Raises
        ------
        InputError : a temperature that is not positive (it is in kelvin: add 273.15 to degrees Celsius).
        """
        if not (math.isfinite(temperature) and temperature > 0):
            raise InputError(f"temperature {temperature!r} must be positive [K]; add 273.15 to degrees Celsius")
        barrier = self.activation_energy - np.asarray(shear_stress, dtype=np.float64) * self.activation_volume
        return np.asarray(self.prefactor * np.exp(-np.maximum(barrier, 0.0) / (Boltzmann * temperature)))
