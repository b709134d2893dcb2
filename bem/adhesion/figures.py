"""Figures of an adhesive contact that its pressure alone does not give, and of the lowest load of its path.

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


LOWEST_LOAD_TOLERANCE = 5e-3
"""Part of the lowest load of a refined path by which the load may be lower between two of its steps; the error bar
includes it."""


def load_between_steps(load: FloatArray, approach: FloatArray) -> FloatArray:
    """Return a lower bound of the load [N] within each of the n - 1 steps of a path of approaches.

    Load over approach is taken as convex where the contact does not jump: the load of a step then lies above the chords
    of the steps beside it, prolonged. A chord that the load at the far end of the step lies below is not used: there
    is a jump. A way in that the path later goes back is left at its own loads, as the bodies that part hold together
    more. Infinitely low for a step beside the lowest load whose neighbours go the other way.
    load : [N]; approach : [m]; (n,) over the steps of the path.
    """
    step = np.diff(approach)
    bound = np.minimum(load[:-1], load[1:])
    lowest = int(load.argmin())
    for k in range(len(step)):
        if step[k] == 0 or (step[k] > 0 and approach[k + 1 :].min() <= approach[k]):
            continue
        chords = []
        if k > 0 and step[k - 1] * step[k] > 0:
            chords.append((load[k], load[k] + (load[k] - load[k - 1]) * step[k] / step[k - 1], load[k + 1]))
        if k + 1 < len(step) and step[k + 1] * step[k] > 0:
            chords.append((load[k + 1], load[k + 1] - (load[k + 2] - load[k + 1]) * step[k] / step[k + 1], load[k]))
        if not chords:
            bound[k] = -np.inf if lowest in (k, k + 1) and load[lowest] < 0 else bound[k]
            continue
        lower = [min(near, far) for near, far, there in chords if far <= there]
        bound[k] = min(bound[k], max(lower, default=bound[k]))
    return bound
