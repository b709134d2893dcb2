"""Viscoelastic contact: half-spaces whose materials relax, pressed over time, or in steady sliding and rolling.

`compliance` has the delayed response of a pair of bodies, `history` the contact along a path in time, `steady` that of
a body which slides or rolls at constant speed, with its hysteresis friction. Both call `bem.contact.solve_contact`.
Poisson's ratio is constant, so that the displacement is the elastic one of the pressure and of its delayed copies.
Names are loaded when first used.

Sees contact, operators and grids; no surfaces, no scenes. Verified in tests/viscoelastic against Lee and Radok's and
Ting's spheres, the elastic limits, and a sliding cylinder by an independent method.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.viscoelastic.history import ViscoelasticHistory, follow_times
    from bem.viscoelastic.steady import SteadySolution, solve_steady_motion

__all__ = [
    "SteadySolution",
    "ViscoelasticHistory",
    "follow_times",
    "solve_steady_motion",
]

__getattr__ = loader(
    __name__,
    {
        "history": ["ViscoelasticHistory", "follow_times"],
        "steady": ["SteadySolution", "solve_steady_motion"],
    },
)
