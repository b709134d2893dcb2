# my_laws.py, a file of your own: a law is one class; its parameters have units and bounds, its formula is a method
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import bem
from bem.laws import parameter
from bem.lubrication.viscosity import ViscosityLaw


@bem.register
@dataclass(frozen=True)
class Power(ViscosityLaw):
    """mu = mu0 (1 + alpha p / n)^n."""

    name: ClassVar[str] = "power"
    exponent: float = parameter("n: Barus' law where it is large", default=16.0, above=0)

    def log_viscosity_ratio(self, pressure, viscosity, pressure_viscosity):
        """ln(mu / mu0) and its derivative with pressure, which is alpha at zero pressure for every law."""
        base = 1 + pressure_viscosity * pressure / self.exponent
        return self.exponent * np.log(base), pressure_viscosity / base


oil = bem.Lubricant(0.1, pressure_viscosity=20e-9, viscosity_law="power", exponent=12)
assert oil.viscosity_at(np.array([0.0]))[0] == 0.1
assert bem.Lubricant(0.1, pressure_viscosity=20e-9, viscosity_law=Power(exponent=12)) == oil
