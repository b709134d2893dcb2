"""Sliding of both bodies while their places pass a contact: sliding distance and passes of each body in a cycle.

A place of body i crosses a patch of length L at its own speed u_i and slides L |u1 - u2| / |u_i| meanwhile, so that
Archard's law wears it by k W |u1 - u2| / |u_i| in a pass, W the load by length and k the wear rate (Flodin and
Andersson, Wear 207 (1997) 16, single-point observation; from memory). A body on which the contact stays slides all the
time: a ring over the stroke while each place of the liner passes once, a bush around the shaft in each turn.

Verified in tests/elements/test_passes.py against `running.wear_per_pass`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from bem.elements.piston_ring import PistonRingModel
from bem.elements.plain_bush import PlainBushModel
from bem.quantities import si

if TYPE_CHECKING:
    from bem.elements.model import ElementModel

NAMES = {
    "gear-pair": ("pinion", "wheel"),
    "cam-follower": ("cam", "follower"),
    "piston-ring": ("liner", "ring"),
    "plain-bush": ("shaft", "bush"),
}
"""Names of body 1 and body 2."""


@dataclass(frozen=True)
class Passes:
    """Sliding of both bodies in a cycle, in which a place of body 1 passes the contact once.

    Attributes
    ----------
    slid : sliding distance of a place of (body 1, body 2) over the patch in a cycle [m]: of a pass times the passes in
        a cycle. 0 of a follower on which the contact stands still at this angle, which no pass of it resolves.
    moves : bodies whose places pass through the contact: "both", or "lower" alone.
    rate : cycles per time [1/s]; None if not known.
    unit : name of the cycles, in words.
    remark : sentence's part on body 2; empty if there is nothing to say.
    """

    slid: tuple[float, float]
    moves: Literal["both", "lower"]
    rate: float | None
    unit: str
    remark: str = ""


def passes_of(
    model: ElementModel, rates: tuple[float | None, float | None], speeds: tuple[float, float], length: float
) -> Passes:
    """Return the sliding and passes of both bodies over a patch of a place of an element.

    Parameters
    ----------
    model : the element.
    rates : passes of a place of either body per time [1/s]; None if not known.
    speeds : of both surfaces over the contact [m/s]; that of body 1 is not zero.
    length : of the patch along the motion [m].
    """
    first, second = NAMES.get(model.element, ("body 1", "body 2"))
    slide = abs(speeds[0] - speeds[1])
    own = length * slide / abs(speeds[0])
    if isinstance(model, PistonRingModel):
        remark = f"the {second} slides {si(model.stroke, 'm', 4)} in each, under the load of this place all the way"
        return Passes((own, model.stroke), "lower", model.speed / math.pi, f"strokes of the {second}", remark)
    if isinstance(model, PlainBushModel):
        swings = model.oscillation
        rate = swings.frequency if swings is not None else (model.speed or 0.0) / (2 * math.pi)
        slid = model.sliding_speed / rate
        return Passes((own, slid), "lower", rate, f"{'swings' if swings else 'turns'} of the {first}")
    unit = f"passes of the {first}"
    if not speeds[1]:
        remark = f"the contact stands still on the {second} at this place, whose wear is left out"
        return Passes((own, 0.0), "lower", rates[0], unit, remark)
    each, remark = 1.0, f"a place of the {second} is taken to pass once in each"
    if rates[0] is not None and rates[1] is not None:
        each, remark = rates[1] / rates[0], ""
    return Passes((own, each * length * slide / abs(speeds[1])), "both", rates[0], unit, remark)


def time_words(seconds: float) -> str:
    """Return a time [s] in seconds, minutes, hours or days, to two digits."""
    for unit, least in (("days", 2 * 86400.0), ("h", 5400.0), ("min", 90.0)):
        if seconds >= least:
            size = {"days": 86400.0, "h": 3600.0, "min": 60.0}[unit]
            return f"{float(f'{seconds / size:.2g}'):g} {unit}"
    return f"{float(f'{seconds:.2g}'):g} s"
