"""State of a wear loop: all that the next cycle needs, and the tables so far; packed for checkpoints.

Knows arrays only. Verified in tests/wear/test_cycle.py: a run resumed from its packed state ends in the same bits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.packing import packed, unpacked
from bem.wear.traction import Rubbing

PARTICLE_FIELDS = np.dtype(
    [
        ("cycle", np.int32),
        ("body", np.int8),
        ("volume", np.float64),
        ("length", np.float64),
        ("width", np.float64),
        ("thickness", np.float64),
        ("x", np.float64),
        ("y", np.float64),
        ("columns", np.int32),
        ("truncated", np.bool_),
    ]
)
"""A particle as a row of a table, in SI units: fields of `bem.particles.Particle` of the same names, and the body that
it left. `columns` is the number of its grid columns; x and y are its position."""

CYCLE_FIELDS = np.dtype(
    [
        ("cycle", np.int32),
        ("particles", np.int32),
        ("volume", np.float64),
        ("contact_area", np.float64),
        ("plastic_area", np.float64),
        ("contact_load", np.float64),
        ("friction", np.float64),
        ("minimum_film", np.float64),
        ("rms_height", np.float64),
        ("residual", np.float64),
        ("convolutions", np.float64),
        ("depths_computed", np.int32),
        ("converged", np.bool_),
        ("stick_share", np.float64),
        ("loop_energy", np.float64),
        ("loop_way", np.float64),
        ("third_body_load", np.float64),
        ("third_bodies_per_area", np.float64),
        ("cut_volume", np.float64),
    ]
)
"""A cycle as a row of a table, in SI units.

`volume` is the sum of pieces and local wear of the wearing bodies and of cuts by third bodies in both bodies.
`cut_volume` is that of the cuts alone.
`depths_computed` is the sum over the wearing bodies. `contact_area`, `plastic_area` and `contact_load` are on the grid.
`friction` is the boundary traction over the pressure, on the lower body along +x where positive. `rms_height` is Sq of
the (first) wearing surface inside the strip that is in contact in the cycle (`RunningInState.strip`); figures of scenes
are over other regions (`bem.scenes.wearing.WornSurface`), so that their last value is not that of a scene's `Sq_final`.
`converged` is True in every row of a loop, which stops at a contact that did not converge.

`stick_share`, `loop_energy` and `loop_way` are of the cycle's `Rubbing`, 0 in gross sliding."""

TIME_FIELDS = np.dtype([("contact", np.float64), ("stress", np.float64), ("particles", np.float64)])
"""Time of a cycle [s]: `stress` in stresses; `particles` in segmentation or in the removal of a criterion without
stress; `contact` in all other steps from the contact's start to the lowered surfaces, partial slip and third bodies
included. The move of the body before them, and the strip and rows of the tables after them, are not timed."""


@dataclass(frozen=True, eq=False)
class RunningInState:
    """All that the next cycle needs, and the record so far.

    cycle : number of cycles so far.
    heights : of the lower and the upper body [m]; the moving one may be longer along x than the grid.
    offset : cells that the moving body has slid.
    pressure : of the last cycle [Pa]; None before the first.
    removed : depth that the criterion removed from each column of the (first) wearing body in the last cycle [m],
        without the cuts of third bodies; None before the first.
    cycles, particles, times : tables of `CYCLE_FIELDS`, `PARTICLE_FIELDS` and `TIME_FIELDS`.
    memories : memory of the criterion on the material of (lower, upper), (planes, rows, ny) on the heights' own rows;
        None for none.
    rubbing : loop of partial slip of the last cycle; None in gross sliding.
    sliding : direction in which the upper body slides over the lower one, 1 along +x, -1 along -x; None where no cycle
        had a direction.
    strip : fraction (nx,) of each row within the strip in contact, of the last cycle with a contact; all rows where no
        cycle had one; None before the first cycle.
    contact : memory of the contact step; `memories` are those of the criterion.
    sharing : rows that a lubricated contact step gave, one per cycle; None for a dry one.
    """

    cycle: int
    heights: tuple[FloatArray, FloatArray]
    offset: int
    pressure: FloatArray | None
    removed: FloatArray | None
    cycles: NDArray[np.void]
    particles: NDArray[np.void]
    times: NDArray[np.void]
    memories: tuple[FloatArray | None, FloatArray | None] = (None, None)
    rubbing: Rubbing | None = None
    strip: FloatArray | None = None
    sliding: int | None = None
    contact: Any = None
    sharing: NDArray[np.void] | None = None


def pack_state(state: RunningInState) -> dict[str, Any]:
    """Return a state as plain arrays and values, for a checkpoint."""
    return dict(packed(state))


def unpack_state(stored: dict[str, Any]) -> RunningInState:
    """Return the state that `pack_state` was called with."""
    state = unpacked(stored)
    assert isinstance(state, RunningInState)
    return state


def initial_state(lower_heights: FloatArray, upper_heights: FloatArray) -> RunningInState:
    """Return the state before the first cycle."""
    return RunningInState(
        cycle=0,
        heights=(np.array(lower_heights, dtype=np.float64), np.array(upper_heights, dtype=np.float64)),
        offset=0,
        pressure=None,
        removed=None,
        cycles=np.zeros(0, CYCLE_FIELDS),
        particles=np.zeros(0, PARTICLE_FIELDS),
        times=np.zeros(0, TIME_FIELDS),
    )
