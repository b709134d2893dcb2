"""Rolling contact fatigue: damage of a body's voxels by the stresses of the roughness that passes, while it wears.

1. The stress path of a place is that of the positions of a round, in the order in which the place passes, and rest.
2. Where both bodies pass, this path meets as many places in one cycle as there are positions, while in reality a place
   rolls with one. So damage is also counted of each position by itself and rest, which leaves out the rest of the pass.
   The two counts bracket the path; the larger or smaller rate of both ends of a step brackets the step.
3. Equivalent shear stress of the path (fatigue_limit.py) and its damage per cycle; damage adds up (Miner).
4. Damage moves up with the material as the surface wears (`bem.wear.damage.move_up`).
5. A column with a voxel of damage one counts as micropitted.

Source: Morales-Espejel and Brizmer (2011), but pits are not removed from the surface. Cost: one stress stack per
position and step.

Verified in tests/life/test_fatigue.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.life.fatigue_limit import FatigueLimit
from bem.life.march import LifeState
from bem.life.positions import PositionContact, facing
from bem.life.surfaces import LifeCase
from bem.materials import Body
from bem.stress import subsurface_stress
from bem.wear.damage import move_up
from bem.wear.setup import LOWER


@dataclass(frozen=True, eq=False)
class RollingFatigue:
    """Rolling contact fatigue of one body of a life.

    body : LOWER or UPPER. solid : the body. depths : (nz,) [m], increasing. limit : fatigue limit of its material.
    hardness : cap of contact and oil pressure together [Pa]. Shear tractions are those of the rough contact in each
    position (`PositionContact.traction_ratio`). The oil's pressure loads the body; its shear stress is left out.
    """

    body: int
    solid: Body
    depths: FloatArray
    limit: FatigueLimit
    hardness: float = math.inf

    def equivalent_shear(
        self, case: LifeCase, row_counts: tuple[int, int], contacts: Sequence[PositionContact]
    ) -> FloatArray:
        """Return the equivalent shear stress (nz, rows, ny) [Pa] of the path through all positions of a round, and
        rest."""
        return self.limit.equivalent_shear(self._path(case, row_counts, contacts))

    def damage_rates(self, case: LifeCase, state: LifeState) -> FloatArray:
        """Return the damage per cycle (2, nz, rows, ny): all positions as one path, and the mean of each by itself and
        rest."""
        lower, upper = state.surfaces.heights
        path = self._path(case, (len(lower), len(upper)), state.contacts)
        alone = np.mean([self._damage(path[:, [place, -1]]) for place in range(len(state.contacts))], axis=0)
        return np.stack([self._damage(path), alone])

    def initial_state(self, case: LifeCase, state: LifeState) -> LifeState:
        """Return a life's first state with zero damage and the first rates; see `LifeState.damage_rates`."""
        rates = self.damage_rates(case, state)
        return replace(state, damage=np.zeros((3, *rates.shape[1:])), damage_rates=rates)

    def add_damage(self, case: LifeCase, before: LifeState, now: LifeState) -> LifeState:
        """Return the state after a step with the damage of the step added.

        Half of the step counts at the rates of either end, and the depth worn in it moves the damage up. The upper and
        lower bracket count all of it at the larger and smaller rate.
        """
        assert before.damage is not None
        assert before.damage_rates is not None
        cycles, rates = now.cycles - before.cycles, self.damage_rates(case, now)
        (path_before, alone_before), (one, alone) = before.damage_rates, rates
        worn = np.ascontiguousarray(before.surfaces.heights[self.body] - now.surfaces.heights[self.body])
        most, least = 0.5 * np.maximum(one, path_before), 0.5 * np.minimum(alone, alone_before)
        found = []
        for damage, first, last in zip(
            before.damage, (0.5 * path_before, most, least), (0.5 * one, most, least), strict=True
        ):
            damage = damage + cycles * first
            move_up(damage, self.depths, worn)
            found.append(damage + cycles * last)
        return replace(now, damage=np.stack(found), damage_rates=rates)

    def _damage(self, path: FloatArray) -> FloatArray:
        return self.limit.damage(self.limit.equivalent_shear(path))

    def _path(self, case: LifeCase, row_counts: tuple[int, int], contacts: Sequence[PositionContact]) -> FloatArray:
        """Return the stresses (6, positions + 1, nz, rows, ny) [Pa] of the material along its path; the last is
        rest, which leaves residual stresses."""
        whole, (nx, ny) = row_counts[self.body], case.grid.shape
        moved = [each[self.body] for each in case.passing.offsets(row_counts)]
        path = np.zeros((6, len(contacts) + 1, len(self.depths), whole, ny))
        residual = np.array([self.solid.residual_stress_at(depth) for depth in self.depths.tolist()])
        path[:2] += residual[:, None, None]
        sign = 1.0 if self.body == LOWER else -1.0
        for place, number in enumerate(np.argsort(moved, kind="stable")):
            one = contacts[number]
            # what presses is not above the cap where oil lies on a contact that is at it
            pressure = np.minimum(one.pressure + one.oil_pressure, self.hardness)
            traction = np.stack([sign * one.traction_ratio * one.pressure, np.zeros((nx, ny))])
            stress = subsurface_stress(pressure, case.grid, self.solid, self.depths, traction=traction)
            path[:, place, :, facing(moved[number], nx, whole)] = np.moveaxis(stress, 2, 0)
        return path


def pitted_share(state: LifeState, of: int = 0) -> float:
    """Return the fraction of columns with a voxel of damage one; of : 0, 1 upper, 2 lower bracket."""
    assert state.damage is not None
    return float((state.damage[of].max(axis=0) >= 1).mean())
