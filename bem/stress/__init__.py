"""Stresses below a loaded surface: six components, von Mises stress, an upper bound, and a summary of one contact.

Stress at a depth is the convolution of the surface load with the stress kernels of that depth (`bem.kernels`): the
Boussinesq and Cerruti solutions integrated over a cell, or the response of a layered body.

1. `fields` checks the request and transforms the pressure, and each direction of a prescribed traction. Cost: one
   forward transform each for all depths.
2. `spectra` gives the spectra of the kernels of a depth from a bounded cache, or computes them: six quarter arrays
   under pressure, twelve with friction. Cost: the kernels of a depth take about as long as 25 to 40 transforms, once.
3. `fields` multiplies and transforms back: six components take six inverse transforms a depth. Von Mises stress takes
   five, whose squares are added in the last pass, so no component is stored. Threads share the depths.
4. Waves along a periodic axis decay exponentially with depth and distance: `spectra` drops wavenumbers below rounding
   error and shortens the transforms of short waves.
5. `von_mises_bound` bounds von Mises stress at a depth from the largest pressure and the load alone. No transform.
6. `connected_regions` computes von Mises stress only where a region above a limit, connected to the surface, can be.
   Five passes along x a depth, and passes along y for about half of the rows.
7. `stress_summary` collects the figures of one contact: largest von Mises stress between points and depths, its depth,
   and yielded area and volume.

The package knows kernels, transforms and bodies, but no contact. Verified in tests/test_stress.py and tests/stress
against the closed forms of Hamilton and McEwen, in tests/frugality for memory, and by the gates of `bem verify` against
finite elements.
"""

from bem.stress.connected_regions import ReachedStress, cleared, reached_stress
from bem.stress.fields import subsurface_stress, von_mises, von_mises_field, von_mises_planes
from bem.stress.spectra import COUNT, set_stress_memory, stress_memory
from bem.stress.stress_summary import StressBelow, stress_below
from bem.stress.von_mises_bound import von_mises_limit

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
