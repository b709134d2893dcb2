"""Fatigue damage of a body's voxels: added cycle by cycle, moved up with the material as the surface wears.

A stack of planes (planes, nx, ny) at the depths of the stresses below the current surface; zero beyond the last.
Verified in tests/wear/test_criteria_with_length.py.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.materials import Material
from bem.wear.lengths import averaged_loads
from bem.wear.loads import BodyCycle, BodyWear
from bem.wear.yielding import depths_for, no_pieces, pieces_above, yielded_stress


def fatigue_removal(
    cycle: BodyCycle, averaging_length: float, damage_of: Callable[[FloatArray, Material], FloatArray]
) -> BodyWear:
    """Return pieces of voxels with damage above one that reach the surface, and the damage of the remaining material.

    Parameters
    ----------
    cycle : of the body.
    averaging_length : diameter of the disc over which stresses are averaged [m]; 0 for none.
    damage_of : (von Mises stress [Pa], material) -> damage of the cycle, of the stress' shape.
    """
    setup, model, body = cycle.setup, cycle.model, cycle.body
    loads = averaged_loads(cycle.loads, setup.grid, averaging_length) if averaging_length > 0 else cycle.loads
    found = yielded_stress(loads, setup, model, body)
    start = time.perf_counter()
    depths = depths_for(setup, model, body)
    known = 0 if cycle.memory is None else len(cycle.memory)
    new = len(found.depths)
    damage = np.zeros((max(known, new), *setup.grid.shape))
    if cycle.memory is not None:
        damage[:known] = cycle.memory
    if new:
        stress = found.stress
        counted = _planes_above_sound(stress, setup.yield_stress(body))
        damage[:counted] += damage_of(stress[:counted], cycle.solid.surface_material)
    pieces = no_pieces(setup.grid.shape)
    if len(damage) >= 2 and damage[0].max() > 1.0:
        pieces = pieces_above(damage, depths[: len(damage)], 1.0, setup, model)
        move_up(damage, depths[: len(damage)], pieces.thickness)
        # a piece ends where the damage is one; linear interpolation may lie above the cubic that found the depth
        np.minimum(damage[0], 1.0, out=damage[0], where=pieces.thickness > 0)
    return BodyWear(body, pieces, found.computed, found.seconds, time.perf_counter() - start, damage)


def _planes_above_sound(stress: FloatArray, strength: float) -> int:
    """Return the number of leading planes of a stack (nz, nx, ny) before the first plane that yields nowhere.

    Stress may be known below that plane, for the slope of the interpolation alone.
    """
    sound = np.flatnonzero(stress.reshape(len(stress), -1).max(axis=1) <= strength)
    return int(sound[0]) if sound.size else len(stress)


@compiled
def move_up(stack, depths, thickness):
    """Move the columns of a stack (nz, nx, ny) up in place by the depth that left them (nx, ny) [m].

    Linear between depths, so no value exceeds its neighbours; zero below the last depth.
    """
    nz, nx, ny = stack.shape
    column = np.empty(nz)
    for i in range(nx):
        for j in range(ny):
            if thickness[i, j] <= 0.0:
                continue
            for k in range(nz):
                column[k] = stack[k, i, j]
            below = 0
            for k in range(nz):
                depth = depths[k] + thickness[i, j]
                while below < nz and depths[below] < depth:
                    below += 1
                if below == nz:
                    stack[k, i, j] = 0.0
                elif below == 0:
                    stack[k, i, j] = column[0]
                else:
                    share = (depth - depths[below - 1]) / (depths[below] - depths[below - 1])
                    stack[k, i, j] = column[below - 1] + share * (column[below] - column[below - 1])
