"""Record of a case of kind `rolling`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.records import Figure, Series, grid_map
from bem.scenes.sticking import StickRecord

_rolled = partial(Series, ("rolled_distance",))


@dataclass(frozen=True, eq=False, kw_only=True)
class RollingRecord(StickRecord):
    """A contact that rolls steadily."""

    x: Annotated[FloatArray, Series(("x",), "m", "x, along rolling")]
    force: Annotated[
        float, Figure("N", "force on the lower body along x, against rolling where negative", headline=True)
    ]
    force_across: Annotated[float, Figure("N", "force on the lower body along +y", headline=True)]
    lateral_force: Annotated[
        float | None,
        Figure(
            "N",
            "resultant of the pressures on the curved rail across the load, along +y; that of friction is apart",
            optional=True,
        ),
    ] = None
    traction_coefficient: Annotated[float, Figure("", "size of the force over load", headline=True)]
    creepage: Annotated[float, Figure("", "creepage along x", headline=True)]
    creepage_across: Annotated[float, Figure("", "creepage along y")]
    spin: Annotated[
        float | None, Figure("per_m", "spin, with that of the contact angle", optional=True, unjudged=True)
    ] = None
    stick_fraction: Annotated[float, Figure("", "share of the contact that sticks", headline=True)]
    friction_work: Annotated[
        float, Figure("N", "energy of friction over the distance rolled: joules per metre, a drag", headline=True)
    ]
    resolved_work: Annotated[
        float,
        Figure(
            "",
            "share of the friction work that its map of cells shows; the rest is below the resolution of the cells",
            unjudged=True,
        ),
    ]
    max_von_mises: Annotated[float | None, Figure("Pa", "maximum von Mises stress", optional=True, headline=True)] = (
        None
    )
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of the maximum stress", optional=True)] = None
    slip_residual: Annotated[float, Figure("", "relative residual of slip and stick", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of the rolling", unjudged=True)]
    slip: Annotated[FloatArray, grid_map("1", "sliding over rolling velocity")]
    rolled_distance: Annotated[FloatArray | None, _rolled("m", "distance rolled")] = None
    rolled_force: Annotated[FloatArray | None, _rolled("N", "force on the lower body along x")] = None
    rolled_force_across: Annotated[FloatArray | None, _rolled("N", "force on the lower body along y")] = None
    rolled_creepage: Annotated[FloatArray | None, _rolled("1", "creepage along x")] = None
    rolled_creepage_across: Annotated[FloatArray | None, _rolled("1", "creepage along y")] = None
    rolled_stick_fraction: Annotated[FloatArray | None, _rolled("1", "share of the contact's cells that stick")] = None
    rolled_friction_work: Annotated[FloatArray | None, _rolled("N", "energy of friction over distance rolled")] = None
    friction_energy: Annotated[FloatArray, grid_map("J/m^3", "energy of friction over area and distance rolled")]
