"""Further figures of wear loops in partial slip: share that sticks, energy of a loop, sliding distance of each
place.

Knows records and plans; the loop is `bem.wear.traction`. Verified in tests/scenes/test_wear_partial_slip.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from bem.grid import FloatArray, Grid
from bem.scenes.planner import Step, padded_points
from bem.scenes.records import Figure, Record, grid_map
from bem.wear.traction import TractionLaw

if TYPE_CHECKING:
    from bem.wear import RunningIn

_TRANSFORMS = 3 * 6.0 * 22
"""Transforms of a cycle: three steps as those of kind partial-slip."""
_RUBBING_CYCLE = 0.015
"""Processor time of the slip solver besides its transforms in one cycle [s]."""
FIRST_ORDER = "of first order in the cell at the edges of contact and stick; compare with the grid of twice the cell"
"""Reason why figures of a loop have no error bar."""
_told = partial(Figure, optional=True, headline=True, no_bar=FIRST_ORDER)
_map = partial(grid_map, of="last")


@dataclass(frozen=True, eq=False, kw_only=True)
class RubbedRecord(Record):
    """Means over the settled cycles, and maps of the last; nothing in gross sliding."""

    stick_share: Annotated[float | None, _told("", "share of the contact that sticks all through a loop")] = None
    loop_energy: Annotated[float | None, _told("J", "energy of friction in a loop, on the slice")] = None
    slid: Annotated[FloatArray | None, _map("m", "what the surfaces slide in a loop")] = None
    traction_x: Annotated[FloatArray | None, _map("Pa", "traction on the lower body along x, at a loop's end")] = None
    traction_y: Annotated[FloatArray | None, _map("Pa", "traction on the lower body along y, at a loop's end")] = None


def rubbed(result: RunningIn, settled: int) -> dict[str, Any]:
    """The fields of `RubbedRecord` of a loop, means over so many of its last cycles."""
    rubbing, late = result.state.rubbing, result.cycles[-settled:]
    if rubbing is None:
        return {}
    return {
        "stick_share": float(late["stick_share"].mean()),
        "loop_energy": float(late["loop_energy"].mean()),
        "slid": rubbing.slid,
        "traction_x": rubbing.traction[0],
        "traction_y": rubbing.traction[1],
    }


def rubbing_step(law: TractionLaw, grid: Grid, cycles: int) -> Step:
    """Step of a plan for these figures."""
    return Step(
        "partial slip",
        "wear.traction is gross_sliding: traction is friction x pressure everywhere"
        if law.slides
        else f"{law.name}: a push, back and forth again in each of {cycles} cycles",
        skipped=law.slides,
        transforms=_TRANSFORMS * cycles,
        seconds=_RUBBING_CYCLE * cycles,
        points=padded_points(grid.shape, grid.periodic),
        memory=8.0 * grid.cells * 60,
    )
