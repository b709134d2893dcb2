"""Figures of an adhesive contact that its pressure alone does not give, and whether its path passes the pull-off.

Verified in tests/adhesion/test_adhesive_bars.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray

if TYPE_CHECKING:
    from bem.adhesion.laws import AdhesionLaw
    from bem.adhesion.solve import AdhesiveSolution


def mean_contact_traction(state: AdhesiveSolution, law: AdhesionLaw) -> float:
    """Return the mean of pressure less attraction over the contact area [Pa], negative in tension.

    The gap is zero there, so that the attraction is the strength of the law. Zero without contact.
    """
    area = float(state.contact.contact_area)
    return state.contact.load / area - law.strength if area > 0 else 0.0


_ALIKE = 1e-4
"""Relative difference of loads of a path that are one load; solved ones differ by up to some 1e-5."""


def passes_pull_off(load: FloatArray, approach: FloatArray, contact_area: FloatArray) -> bool:
    """Return True if the lowest load of a path is minus the pull-off force.

    Bodies that have touched are then pulled further apart from the state of the lowest load, under a tension that
    falls or ends with a jump. A path that turns back before, or ends, has not reached the pull-off. Under a prescribed
    load no state lies beyond the pull-off.
    load : [N], negative in tension; approach : [m]; contact_area : [m^2]; (n,) over the steps of the path.
    """
    least = float(load.min())
    if not least < 0:
        return False
    lowest = np.flatnonzero(load[:-1] <= (1 - _ALIKE) * least)  # a way in and out may have one load but for rounding
    return any(np.any(contact_area[: one + 1] > 0) and approach[one + 1] < approach[one] for one in lowest)
