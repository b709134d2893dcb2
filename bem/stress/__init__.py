"""Stresses below a loaded surface: six components or von Mises only, plane by plane, and a bound on von Mises.

`spectra` makes and keeps the kernels, `packed` in less memory, `sweeps` goes through the depths, `bound` says where
nothing can be, `reach` where what begins at the surface can be, `below` gives all of one contact with its figures.

Sees kernels, transforms and bodies; no contact. Verified in tests/test_stress.py and tests/stress against Hamilton's
and McEwen's closed forms, in tests/frugality for memory, and by the gates of `bem verify` against finite elements.
"""

from bem.stress.below import StressBelow, stress_below
from bem.stress.bound import von_mises_limit
from bem.stress.reach import ReachedStress, cleared, reached_stress
from bem.stress.spectra import COUNT, set_stress_memory, stress_memory
from bem.stress.sweeps import subsurface_stress, von_mises, von_mises_field, von_mises_planes

__all__ = [
    "COUNT",
    "ReachedStress",
    "StressBelow",
    "cleared",
    "reached_stress",
    "set_stress_memory",
    "stress_below",
    "stress_memory",
    "subsurface_stress",
    "von_mises",
    "von_mises_field",
    "von_mises_limit",
    "von_mises_planes",
]
