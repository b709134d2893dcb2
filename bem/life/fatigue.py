"""Rolling contact fatigue: damage of a body's voxels by the stresses of the roughness that passes, while it wears.

A place's path of stresses is that of the positions of a round, in the order in which it passes, and rest. Damage adds
up (Miner), lies with the material and comes up as the surface wears; a column with a voxel that has reached one counts
as micropitted. The model is that of Morales-Espejel and Brizmer (2011), but pits are not taken out of the surface.

Verified in tests/life/test_fatigue.py.
"""

from __future__ import annotations

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
from bem.wear.loads import LOWER


@dataclass(frozen=True, eq=False)
class RollingFatigue:
    """Of one body of a life.

    body : LOWER or UPPER. solid : it. depths : (nz,) [m], increasing. limit : what its material bears. friction :
    traction of the contact over its pressure, as the lower body feels it. The oil's pressure presses, too; its shear is
    left out.
    """

    body: int
    solid: Body
    depths: FloatArray
    limit: FatigueLimit
    friction: float

    def equivalent_shear(self, case: LifeCase, rows: tuple[int, int], passes: Sequence[Pass]) -> FloatArray:
        """(nz, rows, ny) [Pa] of the body's material, of a round of passes."""
        whole, (nx, ny) = rows[self.body], case.grid.shape
        moved = [each[self.body] for each in case.passing.offsets(rows)]
        path = np.zeros((6, len(passes) + 1, len(self.depths), whole, ny))
        sign = 1.0 if self.body == LOWER else -1.0
        for place, number in enumerate(np.argsort(moved, kind="stable")):
            one = passes[number]
            traction = np.stack([sign * self.friction * one.pressure, np.zeros((nx, ny))])
            stress = subsurface_stress(
                one.pressure + one.film_pressure, case.grid, self.solid, self.depths, traction=traction
            )
            path[:, place, :, facing(moved[number], nx, whole)] = np.moveaxis(stress, 2, 0)
        return self.limit.equivalent_shear(path)

    def begun(self, case: LifeCase, state: LifeState) -> LifeState:
        """With no damage yet, and the damage that a cycle does now: (2, nz, rows, ny)."""
        rate = self._rate(case, state)
        return replace(state, damage=np.stack([np.zeros_like(rate), rate]))

    def after(self, case: LifeCase, before: LifeState, now: LifeState) -> LifeState:
        """A state after a step, with the damage of the one before it carried on: half of the step at either end's
        stresses, and what wore in it taken off the top."""
        assert before.damage is not None
        half, rate = 0.5 * (now.cycles - before.cycles), self._rate(case, now)
        damage = before.damage[0] + half * before.damage[1]
        worn = before.surfaces.heights[self.body] - now.surfaces.heights[self.body]
        move_up(damage, self.depths, np.ascontiguousarray(worn))
        return replace(now, damage=np.stack([damage + half * rate, rate]))

    def _rate(self, case: LifeCase, state: LifeState) -> FloatArray:
        lower, upper = state.surfaces.heights
        return self.limit.damage(self.equivalent_shear(case, (len(lower), len(upper)), state.passes))


def pitted_share(state: LifeState) -> float:
    """Share of the columns with a voxel that has no life left."""
    assert state.damage is not None
    return float((state.damage[0].max(axis=0) >= 1).mean())
