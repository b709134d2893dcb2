"""Wear criteria: material that comes off a body in a cycle, by default where an equivalent stress exceeds a strength.

To add a criterion of stress, derive from `StressCriterion`, define its `equivalent_stress` and register it, here or in
a file of your own. A criterion that needs more than the stress point by point, or has a memory, defines its own
`detach`: `averaged`, `fatigue`. A criterion without stress derives from `Criterion`: `junction`, and `local` wear,
which has no pieces. The compiled loops are in `bem.wear` and are loaded when they run. Knows bodies, stresses and
grids; no contact, no cycle.

Verified in tests/wear/test_criterion.py and test_criteria_with_length.py.
"""

from bem.wear.criterion.averaged import AveragedVonMises
from bem.wear.criterion.base import Criterion, StressCriterion
from bem.wear.criterion.fatigue import LowCycleFatigue
from bem.wear.criterion.junction import Junction
from bem.wear.criterion.local import Archard, ArchardOverHardness, EnergyWear, LocalWear
from bem.wear.criterion.stresses import MaximumTension, Tresca, VonMises, principal_stresses

__all__ = [
    "Archard",
    "ArchardOverHardness",
    "AveragedVonMises",
    "Criterion",
    "EnergyWear",
    "Junction",
    "LocalWear",
    "LowCycleFatigue",
    "MaximumTension",
    "StressCriterion",
    "Tresca",
    "VonMises",
    "principal_stresses",
]
