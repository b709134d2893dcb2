"""Adhesive contact: bodies that attract each other over the gap between them.

`laws` has the attraction over the gap, `solve` one state under a load or an approach, `history` the states that a path
of loads or approaches goes through, with its jumps. Names are loaded when first used: a law alone loads no solver.

Sees contact, operators and grids; no surfaces, no scenes. Verified in tests/adhesion against Maugis' and Bradley's
closed forms, the limits of Johnson, Kendall and Roberts and of a hard wall, and Johnson's adhesive wave.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.adhesion.history import AdhesiveHistory, follow_path
    from bem.adhesion.laws import AdhesionLaw, DugdaleAdhesion, ExponentialAdhesion
    from bem.adhesion.solve import AdhesiveSolution, solve_adhesive_contact

__all__ = [
    "AdhesionLaw",
    "AdhesiveHistory",
    "AdhesiveSolution",
    "DugdaleAdhesion",
    "ExponentialAdhesion",
    "follow_path",
    "solve_adhesive_contact",
]

__getattr__ = loader(
    __name__,
    {
        "history": ["AdhesiveHistory", "follow_path"],
        "laws": ["AdhesionLaw", "DugdaleAdhesion", "ExponentialAdhesion"],
        "solve": ["AdhesiveSolution", "solve_adhesive_contact"],
    },
)
