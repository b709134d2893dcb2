"""Loads on one body in one cycle, and the removal from it: all that a wear criterion receives and returns.

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
        """Return the traction on a body as keyword of the stress functions; its sign changes on the upper body."""
        sign = 1 if body == LOWER else -1
        return {"friction": sign * self.friction} if self.traction is None else {"traction": sign * self.traction}


def stress_range_loads(now: SurfaceLoad, before: SurfaceLoad | None) -> tuple[SurfaceLoad, ...]:
    """Return loads whose stresses add up to the stress amplitude, half the change since the load before (None: zero).

    Residual stresses of layers do not change, so they are no part of it: a criterion gets bodies without them. A single
    load suffices where the friction is the same, since stress is linear in pressure and traction.
    """
    if before is None:
        return (SurfaceLoad(0.5 * now.pressure, now.friction),)
    if before.friction == now.friction:
        return (SurfaceLoad(0.5 * (now.pressure - before.pressure), now.friction),)
    return (SurfaceLoad(0.5 * now.pressure, now.friction), SurfaceLoad(-0.5 * before.pressure, before.friction))


@dataclass(frozen=True, eq=False)
class BodyCycle:
    """One body in one cycle: the input of a criterion.

    pressure : (nx, ny) of the contact [Pa].
    loads : whose stresses together the criterion compares: the contact's own, or half the change since the last cycle.
    setup, model : of the loop; for half a change, the setup's bodies are without residual stresses.
    body : LOWER or UPPER.
    shift_distance : distance that the moving body slides between two computed cycles [m].
    memory : (planes, nx, ny) returned in the last cycle and moved with the material; None before the first.
    slid : (nx, ny) slip distance in partial slip [m]; None in gross sliding.
    temperature : (nx, ny) of the surfaces [K]; None where unknown.
    """

    pressure: FloatArray
    loads: tuple[SurfaceLoad, ...]
    setup: WearSetup
    model: WearChoices
    body: int
    shift_distance: float
    memory: FloatArray | None = None
    slid: FloatArray | None = None
    temperature: FloatArray | None = None

    @property
    def solid(self) -> Body:
        """Body of the cycle."""
        return self.setup.bodies[self.body]


@dataclass(frozen=True, eq=False)
class BodyWear:
    """Material that leaves one body in one cycle: the output of a criterion.

    body : LOWER or UPPER. pieces : wear particles.
    depths_computed : number of depths of stress. stress_time, segmentation_time : spent [s].
    memory : (planes, nx, ny) of the remaining material, for the next cycle; None for none.
    worn : (nx, ny) depth that leaves besides the pieces [m]; None for none.
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
        """Depth (nx, ny) that leaves each column [m], pieces and wear besides them."""
        return self.pieces.thickness if self.worn is None else self.pieces.thickness + self.worn
