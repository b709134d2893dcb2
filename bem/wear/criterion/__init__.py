"""Wear criteria: what comes off a body in a cycle; by default where one scalar of the stresses exceeds one strength.

To add one, derive from `WearCriterion` and register it, here or in a file of your own, with its `equivalent_stress`.
One that judges something else than stresses point by point, or remembers, has a `detach` of its own, as `averaged`,
`sphere`, `fatigue` and `junction` have; the last knows no stress and derives from `Detachment`, as does `local` wear,
which has no pieces. Loops lie beside the cycle and are loaded when they run. Knows bodies, stresses and grids; no
contact, no cycle.

Verified in tests/wear/test_criterion.py and test_criteria_with_length.py.
"""

from bem.wear.criterion.averaged import AveragedVonMises
from bem.wear.criterion.base import Detachment, WearCriterion
from bem.wear.criterion.fatigue import LowCycleFatigue
from bem.wear.criterion.junction import Junction
from bem.wear.criterion.local import Archard, ArchardOverHardness, EnergyWear, LocalWear
from bem.wear.criterion.sphere import Sphere
from bem.wear.criterion.stresses import MaximumTension, Tresca, VonMises, principal_stresses

__all__ = [
    "Archard",
    "ArchardOverHardness",
    "AveragedVonMises",
    "Detachment",
    "EnergyWear",
    "Junction",
    "LocalWear",
    "LowCycleFatigue",
    "MaximumTension",
    "Sphere",
    "Tresca",
    "VonMises",
    "WearCriterion",
    "principal_stresses",
]
