"""Growth laws of a tribofilm: stress-activated Arrhenius kinetics."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.laws import Law, parameter, register
from bem.physical_constants import BOLTZMANN, ELECTRON_VOLT


@dataclass(frozen=True)
class GrowthLaw(Law):
    """Base class of growth laws; to add a law, derive from it and register it, here or in a file of your own."""

    family: ClassVar[str] = "growth"

    @abstractmethod
    def rate(self, shear_stress: FloatArray, temperature: float | FloatArray) -> FloatArray:
        """Return the growth rate [m/s] under a shear stress [Pa], not falling with the stress.

        temperature : absolute [K], a number or an array of the shape of the stress.
        """


@register
@dataclass(frozen=True)
class StressActivatedGrowth(GrowthLaw):
    """Growth rate `prefactor * exp(-(activation_energy - shear_stress * activation_volume) / (k_B T))` [m/s].

    Gosvami et al., Science 348 (2015) 102; thesis, paper E, eq. 3, with a prefactor of 1e-2 m/s. Erratum of the
    thesis: the nomenclature of its part A has nm/s and degrees Celsius; the law needs kelvin.

    Attributes
    ----------
    prefactor : [m/s].
    activation_energy : without stress [J].
    activation_volume : [m^3]; 0 is plain Arrhenius growth without stress activation.
    """

    name: ClassVar[str] = "stress_activated"
    cites: ClassVar[tuple[str, ...]] = ("gosvami2015", "akchurin2017")
    prefactor: float = parameter("pre-exponential factor: growth rate without a barrier", "m/s", above=0)
    activation_energy: float = parameter("activation energy without stress", "J", above=0)
    activation_volume: float = parameter(
        "activation volume, by which stress lowers the activation energy; 0 is Arrhenius", "m^3", at_least=0
    )

    @classmethod
    def from_electron_volts(
        cls, prefactor: float, activation_energy_ev: float, activation_volume_cubic_angstrom: float
    ) -> StressActivatedGrowth:
        """Return the law from the units of the literature: m/s, eV and cubic angstrom."""
        return cls(prefactor, activation_energy_ev * ELECTRON_VOLT, activation_volume_cubic_angstrom * 1e-30)

    def rate(self, shear_stress: FloatArray, temperature: float | FloatArray) -> FloatArray:
        """Return the growth rate [m/s] under a shear stress [Pa]; temperature : absolute [K], one or one per stress.

        The barrier cannot be lower than zero: beyond `activation_energy / activation_volume` the rate is the prefactor.

        Raises
        ------
        InputError : a temperature that is not positive (it is in kelvin: add 273.15 to degrees Celsius).
        """
        if not (np.isfinite(temperature).all() and np.min(temperature) > 0):
            raise InputError(f"temperature {temperature!r} must be positive [K]; add 273.15 to degrees Celsius")
        with np.errstate(over="ignore"):  # an infinite barrier gives zero growth, an infinite work no barrier
            barrier = self.activation_energy - np.asarray(shear_stress, dtype=np.float64) * self.activation_volume
            height = np.maximum(barrier, 0.0) / (BOLTZMANN * np.asarray(temperature, dtype=np.float64))
        return np.asarray(self.prefactor * np.exp(-height))
