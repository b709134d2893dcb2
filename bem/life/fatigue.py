"""Rolling contact fatigue: damage of a body's voxels by the stresses of the roughness that passes, while it wears.

A place's path of stresses is that of the positions of a round, in the order in which it passes, and rest. Where both
bodies pass, that has it meet as many other places as there are positions in one cycle, where it rolls with one: damage
is counted, too, of each position by itself and rest, which leaves out what else of its pass a place feels. The two
bracket the path, and the larger or smaller rate of a jump's ends what lies between them.

Damage adds up (Miner), lies with the material and comes up as the surface wears; a column with a voxel that has reached
one counts as micropitted. The model is that of Morales-Espejel and Brizmer (2011), but pits are not taken out of the
surface.

Verified in tests/life/test_fatigue.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.life.criteria import FatigueLimit
from bem.life.march import LifeState
from bem.life.passes import Pass, facing
from bem.life.surfaces import LifeCase
from bem.materials import Body
from bem.stress import subsurface_stress
from bem.wear.damage import move_up
from bem.wear.setup import LOWER


@dataclass(frozen=True, eq=False)
class RollingFatigue:
    """Of one body of a life.

    body : LOWER or UPPER. solid : it. depths : (nz,) [m], increasing. limit : what its material bears. friction :
    traction of the contact over its pressure, as the lower body feels it. The oil's pressure presses, too; its shear is
    left out. hardness : cap of both together [Pa].
    """

    body: int
    solid: Body
    depths: FloatArray
    limit: FatigueLimit
    friction: float
    hardness: float = math.inf

    def equivalent_shear(self, case: LifeCase, rows: tuple[int, int], passes: Sequence[Pass]) -> FloatArray:
        """(nz, rows, ny) [Pa] of the body's material, of all positions of a round as one path, and rest."""
        return self.limit.equivalent_shear(self._path(case, rows, passes))

    def damage_rates(self, case: LifeCase, state: LifeState) -> FloatArray:
        """(2, nz, rows, ny) per cycle: with all positions as one path, and the mean of each by itself and rest."""
        lower, upper = state.surfaces.heights
        path = self._path(case, (len(lower), len(upper)), state.passes)
        alone = np.mean([self._damage(path[:, [place, -1]]) for place in range(len(state.passes))], axis=0)
        return np.stack([self._damage(path), alone])

    def begun(self, case: LifeCase, state: LifeState) -> LifeState:
        """With no damage yet: `LifeState.damage`."""
        rates = self.damage_rates(case, state)
        return replace(state, damage=np.concatenate([np.zeros((3, *rates.shape[1:])), rates]))

    def after(self, case: LifeCase, before: LifeState, now: LifeState) -> LifeState:
        """A state after a step, with the damage of the one before it carried on: half of the step at either end's
        stresses, and what wore in it taken off the top. Of the brackets all of it at the larger, or smaller, rate."""
        assert before.damage is not None
        cycles, (one, alone) = now.cycles - before.cycles, self.damage_rates(case, now)
        path_before, alone_before = before.damage[3:]
        worn = np.ascontiguousarray(before.surfaces.heights[self.body] - now.surfaces.heights[self.body])
        most, least = 0.5 * np.maximum(one, path_before), 0.5 * np.minimum(alone, alone_before)
        found = []
        for damage, first, last in zip(
            before.damage[:3], (0.5 * path_before, most, least), (0.5 * one, most, least), strict=True
        ):
            damage = damage + cycles * first
            move_up(damage, self.depths, worn)
            found.append(damage + cycles * last)
        return replace(now, damage=np.stack([*found, one, alone]))

    def _damage(self, path: FloatArray) -> FloatArray:
        return self.limit.damage(self.limit.equivalent_shear(path))

    def _path(self, case: LifeCase, rows: tuple[int, int], passes: Sequence[Pass]) -> FloatArray:
        """Stresses (6, positions + 1, nz, rows, ny) [Pa] of the body's material as it passes; the last is rest."""
        whole, (nx, ny) = rows[self.body], case.grid.shape
        moved = [each[self.body] for each in case.passing.offsets(rows)]
        path = np.zeros((6, len(passes) + 1, len(self.depths), whole, ny))
        sign = 1.0 if self.body == LOWER else -1.0
        for place, number in enumerate(np.argsort(moved, kind="stable")):
            one = passes[number]
            # what presses is not above the cap where oil lies on a contact that is at it
            pressure = np.minimum(one.pressure + one.film_pressure, self.hardness)
            traction = np.stack([sign * self.friction * one.pressure, np.zeros((nx, ny))])
            stress = subsurface_stress(pressure, case.grid, self.solid, self.depths, traction=traction)
            path[:, place, :, facing(moved[number], nx, whole)] = np.moveaxis(stress, 2, 0)
        return path


def pitted_share(state: LifeState, of: int = 0) -> float:
    """Share of the columns with a voxel that has no life left; `of` 1 at most, 2 at least."""
    assert state.damage is not None
    return float((state.damage[of].max(axis=0) >= 1).mean())
