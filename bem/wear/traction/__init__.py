"""Shear tractions of a wear cycle: friction x pressure everywhere, or those of a loop in partial slip.

To add one, derive from `TractionLaw` and register it, here or in a file of your own. Knows contacts and partial slip,
whose solvers are loaded when a cycle asks for them; no pieces. Verified in tests/wear/test_wear_traction.py:
Cattaneo's annulus, the energy of Mindlin and Deresiewicz' loop, gross sliding at the limit.
"""

from bem.wear.traction.base import Rubbing, TractionLaw
from bem.wear.traction.gross_sliding import GrossSliding
from bem.wear.traction.oscillating import Oscillating, OscillatingForce, OscillatingShift

__all__ = [
    "GrossSliding",
    "Oscillating",
    "OscillatingForce",
    "OscillatingShift",
    "Rubbing",
    "TractionLaw",
]
