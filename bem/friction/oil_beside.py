"""How far a load sharing hangs on the oil beside the contact, and what is said of it.

Knows numbers only; they come from `oil_sensitivity`. Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bem.friction.oil_volume import OilVolume
from bem.notes import Level, Note
from bem.notes.friction import OIL_COUNTED

LOAD_CHANGES = 0.1
"""Change of the surfaces' share of the load, relative to it, from which a note says so."""
FRICTION_CHANGES = 0.01
"""The same of friction."""
LEAST_CHANGE = 0.01
"""Of the share of the load: smaller changes do not count, however small the share is."""
DECIDES = 0.1
"""Of the load, and of friction: where the surfaces' share or friction changes by more, they are that oil's and not
those of film and roughness. Of a ball of lambda 0.04 with 4 % of its load on its surfaces friction was 0.063, and 0.040
with 14 % with the oil counted where the film carries.

The surfaces are as far apart as keeps the oil on the patch. Beside the contact the bodies are apart by their shapes, by
far more than film and roughness, and most of the oil is there; how much follows the width of the contact, and so the
load that the film is left with. Where the film is thin (a small lambda), the rough surfaces need more room than it has,
a rms height or two over the contact, and the balance finds it beside: it takes load off the film's contact until the
larger opening there holds that oil. The room is then found by the length of the patch, not by what flows: a ball of
lambda 0.003 had 24 % of the load on its surfaces so, and 99 % with the oil counted where the film carries.
"""


@dataclass(frozen=True)
class OilBeside:
    """How far a load sharing hangs on oil that carries nothing.

    share : of the film's oil on the patch, what lies beside Hertz' contact under the whole load. contact_share,
    friction : surfaces' share of the load, and friction, as found. loaded_contact_share, loaded_friction : the same
    with the oil counted where the film carries; as found at either end of the balance and where it was counted so;
    not-a-number where that balance was not met. slope : of that balance, as of `Balance`, for the next one; None where
    there was none. counted : area over which oil was counted in the balance found.
    """

    share: float
    contact_share: float
    friction: float
    loaded_contact_share: float = math.nan
    loaded_friction: float = math.nan
    slope: float | None = None
    counted: OilVolume = OilVolume.PATCH

    @property
    def known(self) -> bool:
        """Whether the other balance was met."""
        return not math.isnan(self.loaded_contact_share)

    @property
    def matters(self) -> bool:
        """Whether load share or friction would be others without that oil, or that is not known."""
        allowed = max(LOAD_CHANGES * self.contact_share, LEAST_CHANGE)
        alike = abs(self.loaded_contact_share - self.contact_share) <= allowed
        return not (alike and abs(self.loaded_friction - self.friction) <= FRICTION_CHANGES * abs(self.friction))

    @property
    def decides(self) -> bool:
        """Whether that oil and not film and roughness shares the load, or makes friction, by more than `DECIDES`."""
        return self.known and self.change > DECIDES

    @property
    def change(self) -> float:
        """Of the share of the load, or of friction relative to it, whichever is more; not-a-number if not known."""
        shares = abs(self.loaded_contact_share - self.contact_share)
        friction = abs(self.loaded_friction - self.friction)
        return max(shares, friction / abs(self.friction) if self.friction else 0.0)


def oil_notes(oils: Sequence[OilBeside]) -> tuple[Note, ...]:
    """Return notes on results, at one speed or several, for which that oil matters; none if it does for none."""
    following = [oil for oil in oils if oil.matters]
    if not following:
        return ()
    known = [oil for oil in following if oil.known]
    notes = []
    if known:
        oil = max(known, key=lambda one: one.change)
        level = Level.OUTSIDE_MODEL if oil.decides else None
        values: dict[str, Any] = {
            "contact_share": float(oil.contact_share),
            "friction": float(oil.friction),
            "loaded_contact_share": float(oil.loaded_contact_share),
            "loaded_friction": float(oil.loaded_friction),
            "most": ", where that differs most" if len(known) > 1 else "",
        }
        if all(one.counted is OilVolume.HERTZ for one in following):
            notes.append(OIL_COUNTED(level=level, reason="hertz", **values))
        else:
            share = float(max(one.share for one in following))
            notes.append(OIL_COUNTED(level=level, reason="patch", share=share, **values))
    if len(known) < len(following):
        notes.append(OIL_COUNTED(count=len(following) - len(known), reason="unknown"))
    return tuple(notes)
