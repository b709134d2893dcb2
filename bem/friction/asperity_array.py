"""Equal spherical asperities in a square array, pressed by a flat: load per asperity over how deep the tops go.

All asperities of an infinite array carry the same load, so one asperity on a doubly periodic cell represents the array.
Thesis, paper A, figures 3 and 4. Verified in tests/friction/test_asperity_array.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.contact import solve_contact
from bem.convolution import DisplacementOperator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.numerics.monotone import MonotoneCubic

LOADS = 14
"""Number of contacts solved for a curve; loads at depths in between are interpolated."""
SQUARE_LATTICE = 3.900264920001956
"""Minus the potential at one charge of a square lattice of unit charges in a neutralising background, times the
spacing; the charge itself is excluded. The value is 4 zeta(1/2) beta(1/2)."""
SQUARE_PATCH = 4 * math.asinh(1.0)
"""Integral of 1/r over a unit square, r from its centre."""


@dataclass(frozen=True, eq=False)
class ArrayLoads:
    """Loads per asperity [N] at depths (n,) [m] of the tops.

    alone : of a single asperity, by Hertz. mean_plane : depths from the deformed mean plane of the infinite array.
    from_flat : depths from the undeformed flat, of a finite array. pressure : (nx, ny) at the highest load [Pa].
    status : the worst of the contacts.
    """

    depth: FloatArray
    alone: FloatArray
    mean_plane: FloatArray
    from_flat: FloatArray
    pressure: FloatArray
    status: Status


@dataclass(frozen=True, eq=False)
class ArrayState:
    """Checkpoint of an array.

    approach : of the solved loads [m]. pressure : (nx, ny) under the last load [Pa]. status : worst of the contacts.
    """

    approach: tuple[float, ...] = ()
    pressure: FloatArray | None = None
    status: Status = Status.CONVERGED


def press_array(
    operator: DisplacementOperator,
    *,
    radius: float,
    height: float,
    contact_modulus: float,
    depths: FloatArray,
    window: float,
    state: ArrayState | None = None,
    callback: Callable[[ArrayState], None] | None = None,
) -> ArrayLoads:
    """Return the loads of an asperity of the array over the depths of the tops.

    Parameters
    ----------
    operator : of both bodies on the doubly periodic cell of one asperity, as wide as their spacing.
    radius, height : of the spheres, and how far they stand out of the flat [m].
    contact_modulus : E* [Pa].
    depths : ascending depths of the tops [m].
    window : side of the finite square array [m].
    state : checkpoint of the same array; results are the same to the last bit.
    callback : called after each contact.

    Raises
    ------
    InputError : depths that the loads do not reach.
    """
    grid = operator.grid
    depth = np.asarray(depths, dtype=np.float64)
    hertz = 4 / 3 * contact_modulus * math.sqrt(radius)  # Johnson (1985), eq. 4.23
    loads = hertz * np.geomspace(0.02 * depth[0], 1.6 * depth[-1], LOADS) ** 1.5
    gap = asperity_gap(grid, radius, height)
    now = state or ArrayState()
    for load in loads[len(now.approach) :]:
        solution = solve_contact(gap, operator, load=load, initial_pressure=now.pressure)
        worst = now.status if solution.status is Status.CONVERGED else solution.status
        now = ArrayState((*now.approach, solution.approach - float(gap.min())), solution.pressure, worst)
        if callback is not None:
            callback(now)
    assert now.pressure is not None
    inward = np.array(now.approach)
    # a finite square array sinks in as a whole by the mean pressure's own deflection at its middle
    spacing = grid.lengths[0]
    sunk = SQUARE_PATCH * window * loads / spacing**2 / (math.pi * contact_modulus)
    mean_plane, from_flat = (_at_depths(depth, values, loads, spacing) for values in (inward, inward + sunk))
    return ArrayLoads(depth, hertz * depth**1.5, mean_plane, from_flat, now.pressure, now.status)


def asperity_gap(grid: Grid, radius: float, height: float) -> FloatArray:
    """Return the gap (nx, ny) [m] of a sphere, approximated by a parabola, that stands out of a flat."""
    x, y = grid.x[:, None], grid.y[None, :]
    return np.minimum((x**2 + y**2) / (2 * radius), height)


def _at_depths(depth: FloatArray, inward: FloatArray, loads: FloatArray, spacing: float) -> FloatArray:
    """Return the loads [N] at depths [m]; InputError for depths that the loads do not reach."""
    if not (np.diff(inward) > 0).all() or inward[0] > depth[0] or inward[-1] < depth[-1]:
        raise InputError(
            f"array.interferences: {depth[0]:.3g} to {depth[-1]:.3g} m cannot be reached at a spacing of "
            f"{spacing:.3g} m; allowed: {max(inward[0], 0):.3g} to {inward[-1]:.3g} m"
        )
    return MonotoneCubic(inward, loads ** (2 / 3))(depth) ** 1.5
