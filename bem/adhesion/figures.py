"""Figures of an adhesive contact that its pressure alone does not give.

Verified in tests/adhesion/test_adhesive_bars.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bem.adhesion.laws import AdhesionLaw
    from bem.adhesion.solve import AdhesiveSolution


def mean_contact_traction(state: AdhesiveSolution, law: AdhesionLaw) -> float:
    """Return the mean of pressure less attraction over the contact area [Pa], negative in tension.

    The gap is zero there, so that the attraction is the strength of the law. Zero without contact.
    """
    area = float(state.contact.contact_area)
    return state.contact.load / area - law.strength if area > 0 else 0.0
