# the same for friction in partial slip and rolling: the traction's bound grows with a power of the pressure
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import bem
from bem.laws import parameter
from bem.tangential.friction_laws import SlipFriction


@bem.register
@dataclass(frozen=True)
class PowerFriction(SlipFriction):
    """Bound of the traction: scale (p / scale)^exponent."""

    name: ClassVar[str] = "power"
    scale: float = parameter("pressure at which the coefficient is one", "Pa", above=0)
    exponent: float = parameter("exponent of the pressure", above=0, at_most=1)

    def traction_bound(self, pressure, slip_speed):
        """(n,) of pressures (n,) [Pa]; a law of the slip speed (n,) [m/s] sets depends_on_speed = True."""
        return self.scale * (pressure / self.scale) ** self.exponent


# in a scene: push.friction = { kind = "power", scale = "1 MPa", exponent = 0.8 }
law = PowerFriction(scale=1e6, exponent=0.5)
assert np.isclose(law.traction_bound(np.array([4e6]), np.zeros(1)), 2e6)
