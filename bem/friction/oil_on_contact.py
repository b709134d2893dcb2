"""What the oil on cells in contact leaves open about friction, and what is said of it.

The smooth film carries its load on the whole contact, on cells where the surfaces touch, too; its shear stress counts
outside of these alone, as the thesis has it. Between such films and those with the roughness in Reynolds' equation
itself (`reports/experiments/rough_films.py`) friction was up to 31 % too low; with the film's own shear stress there
as well about 5 % too low to 8 % too high under a cylinder, 20 % under a ball, where the smooth film is at least 0.7 of
the rms height, and too high by more below; with boundary friction on the oil's load there by up to 160 %.

Knows numbers only; they come from `forces`. Verified in tests/friction/test_oil_on_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from bem.notes import Level, Note
from bem.notes.friction import OIL_ON_CONTACT

MATTERS = 0.05
"""Fraction of friction from which a note says so."""
DECIDES = 0.2
"""Fraction of friction from which the note is a caution."""


def covered_notes(points: Sequence[tuple[float, float]]) -> tuple[Note, ...]:
    """Return a note on the speed at which oil on cells in contact would add most friction; none where it adds little.

    Parameters
    ----------
    points : (friction, friction that the film's own shear stress on cells in contact would add) at each speed.
    """
    following = [(friction, more) for friction, more in points if abs(more) > MATTERS * abs(friction)]
    if not following:
        return ()
    friction, more = max(following, key=lambda one: abs(one[1] / one[0]) if one[0] else math.inf)
    most = ", where that differs most" if len(following) > 1 else ""
    level = Level.CAUTION if abs(more) > DECIDES * abs(friction) else None
    return (OIL_ON_CONTACT(level=level, with_oil=float(friction + more), friction=float(friction), most=most),)
