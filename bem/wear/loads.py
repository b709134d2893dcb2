"""What acts on one body in one cycle, and what comes off it: all that a wear criterion is given and all that it gives.

Knows pressures and pieces; no solver. Verified in tests/wear/test_cycle.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bem.grid import FloatArray
from bem.wear.setup import LOWER, WearChoices, WearSetup

if TYPE_CHECKING:
    from bem.materials import Body
    from bem.wear.segmentation import Segmentation


@dataclass(frozen=True, eq=False)
class SurfaceLoad:
    """Pressure (nx, ny) [Pa] on a body, and the friction it slides with: traction over pressure, on the lower body.

    traction : (2, nx, ny) [Pa] on the lower body, where it is not friction x pressure along +x everywhere.
    """

    pressure: FloatArray
    friction: float
    traction: FloatArray | None = None

    def shear(self, body: int) -> dict[str, Any]:
        """The traction on a body, as stresses take it: on the upper one it has the other sign."""
        sign = 1 if body == LOWER else -1
        return {"friction": sign * self.friction} if self.traction is None else {"traction": sign * self.traction}


def half_the_change(now: SurfaceLoad, before: SurfaceLoad | None) -> tuple[SurfaceLoad, ...]:
    """Loads whose stresses add up to half the change of stress; nothing acted before the first cycle.

    One load where the friction is the same, since stress is linear in pressure and traction.
    """
    if before is None:
        return (SurfaceLoad(0.5 * now.pressure, now.friction),)
    if before.friction == now.friction:
        return (SurfaceLoad(0.5 * (now.pressure - before.pressure), now.friction),)
    return (SurfaceLoad(0.5 * now.pressure, now.friction), SurfaceLoad(-0.5 * before.pressure, before.friction))


@dataclass(frozen=True, eq=False)
class BodyCycle:
    """One body in one cycle.

    pressure : of the contact, (nx, ny) [Pa]. loads : whose stresses together are judged; the contact's own, or half the
    change since the last cycle. setup, model : of the run. body : LOWER or UPPER. slide : distance [m] that the
    moving body slides from one cycle to the next. memory : what the criterion keeps of the body's material on the grid,
    (planes, nx, ny), as it was given back in the last cycle and moved with the material; None before the first.
    slid : (nx, ny) [m], what the surfaces slide at each place in the computed cycle; None where they do so everywhere
    as far as the bodies move. temperature : (nx, ny) [K] of the surfaces; None where it is not known place by place.
    """

    pressure: FloatArray
    loads: tuple[SurfaceLoad, ...]
    setup: WearSetup
    model: WearChoices
    body: int
    slide: float
    memory: FloatArray | None = None
    slid: FloatArray | None = None
    temperature: FloatArray | None = None

    @property
    def solid(self) -> Body:
        """The body."""
        return self.setup.bodies[self.body]


@dataclass(frozen=True, eq=False)
class Removal:
    """Pieces of one body in one cycle, how many depths had to be computed to find them, and the time that took [s].

    memory : what the criterion wants kept of the body's material, (planes, nx, ny), material that left taken out; None
    where it keeps nothing. worn : what leaves besides the pieces, (nx, ny) [m]; None for nothing.
    """

    body: int
    pieces: Segmentation
    depths_computed: int
    stress_time: float
    segmentation_time: float
    memory: FloatArray | None = None
    worn: FloatArray | None = None

    @property
    def thickness(self) -> FloatArray:
        """What leaves each column (nx, ny) [m], in pieces and besides."""
        return self.pieces.thickness if self.worn is None else self.pieces.thickness + self.worn
