# the same for a wear criterion: material leaves where the equivalent stress exceeds the yield stress
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import bem
from bem.laws import parameter
from bem.wear.criterion import StressCriterion


@bem.register
@dataclass(frozen=True)
class OverStress(StressCriterion):
    """Von Mises stress above a threshold."""

    name: ClassVar[str] = "over_stress"
    threshold: float = parameter("stress that does no harm", "Pa", at_least=0)

    # lets depths be skipped by the bound on von Mises: the largest ratio of the two (leave it out if there is none)
    von_mises_factor = 1.0

    def equivalent_stress(self, stress):
        """(...) of stresses (6, ...) [Pa]."""
        return np.maximum(bem.von_mises(stress) - self.threshold, 0.0)


# in a scene: wear.criterion = { kind = "over_stress", threshold = "0.2 GPa" }
tension = np.array([3e8, 0, 0, 0, 0, 0])
assert np.isclose(OverStress(threshold=2e8).equivalent_stress(tension), 1e8)
