"""The state of a wear loop: all that the next cycle needs and the tables so far, and the same as plain arrays.

Knows arrays only. Verified in tests/wear/test_cycle.py: a run goes on from its packed state to the same bits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.notes import unpacked
from bem.wear.setup import LOWER, UPPER
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
"""A particle as a row of a table: SI units, the fields of `Particle` without its columns."""

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
    ]
)
"""A cycle as a row of a table: SI units; `rms_height` is Sq of the wearing surface inside the contact strip.
`stick_share`, `loop_energy` and `loop_way` are of the cycle's `Rubbing`, 0 in gross sliding."""

TIME_FIELDS = np.dtype([("contact", np.float64), ("stress", np.float64), ("particles", np.float64)])


@dataclass(frozen=True, eq=False)
class RunningInState:
    """All that the next cycle needs, and the record so far.

    heights : of the lower and the upper body; the moving one may be longer along x than the grid.
    offset : cells that the moving body has slid. pressure : of the last cycle, None before the first.
    removed : what left from each column of the (first) wearing body in the last cycle [m], None before the first.
    memories : what the criterion keeps of the material of the lower and the upper body, (planes, rows, ny) on the
        heights' own rows; None for nothing. rubbing : of the last cycle; None in gross sliding. strip : the fraction of
    each row (nx,) within the strip in contact of the last cycle; None takes whole rows by the pressure.
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


def pack_state(state: RunningInState) -> dict[str, Any]:
    """A state as plain arrays and numbers, for a checkpoint."""
    return {
        "cycle": state.cycle,
        "lower_heights": state.heights[LOWER],
        "upper_heights": state.heights[UPPER],
        "offset": state.offset,
        "pressure": state.pressure,
        "removed": state.removed,
        "lower_memory": state.memories[LOWER],
        "upper_memory": state.memories[UPPER],
        "rubbing": None if state.rubbing is None else pack_rubbing(state.rubbing),
        "strip": state.strip,
        **{name: pack_table(getattr(state, name)) for name in ("cycles", "particles", "times")},
    }


def unpack_state(packed: dict[str, Any]) -> RunningInState:
    """The state that was packed."""
    return RunningInState(
        cycle=int(packed["cycle"]),
        heights=(packed["lower_heights"], packed["upper_heights"]),
        offset=int(packed["offset"]),
        pressure=packed["pressure"],
        removed=packed["removed"],
        cycles=unpack_table(packed["cycles"], CYCLE_FIELDS),
        particles=unpack_table(packed["particles"], PARTICLE_FIELDS),
        times=unpack_table(packed["times"], TIME_FIELDS),
        memories=(packed["lower_memory"], packed["upper_memory"]),
        rubbing=None if packed["rubbing"] is None else unpack_rubbing(packed["rubbing"]),
        strip=packed.get("strip"),
    )


def pack_rubbing(rubbing: Rubbing) -> dict[str, Any]:
    """What friction did in a cycle, as plain arrays, numbers and words."""
    return {**vars(rubbing), "status": rubbing.status.value, "notes": [note.packed() for note in rubbing.notes]}


def unpack_rubbing(packed: dict[str, Any]) -> Rubbing:
    """What was packed."""
    return Rubbing(
        **{**packed, "status": Status(packed["status"]), "notes": tuple(unpacked(one) for one in packed["notes"])}
    )


def pack_table(table: NDArray[np.void]) -> dict[str, NDArray[Any]]:
    """A table as one plain array per column."""
    return {name: np.ascontiguousarray(table[name]) for name in table.dtype.names or ()}


def unpack_table(columns: dict[str, NDArray[Any]], fields: np.dtype[np.void]) -> NDArray[np.void]:
    """The table of those columns."""
    table = np.zeros(len(next(iter(columns.values()))), fields)
    for name in fields.names or ():
        table[name] = columns[name]
    return table


def initial_state(lower_heights: FloatArray, upper_heights: FloatArray) -> RunningInState:
    """The state before the first cycle."""
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
