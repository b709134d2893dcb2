"""What is counted beside the wear of a life: pieces that a criterion finds, fatigue below the surface.

Verified in tests/scenes/test_running_in_life_kind.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.life.fatigue import RollingFatigue, pitted_share
from bem.life.march import LifeState
from bem.life.pieces import PieceSizes, carried_away
from bem.life.surfaces import LifeCase
from bem.notes import Level, Note
from bem.notes.checks import NOTHING_CAME_OFF
from bem.wear.setup import LOWER

FIGURES = (
    *("particles", "particle_equivalent_radius", "particles_over_cycles"),
    *(
        "micropitted_share",
        "micropitted_at_most",
        "micropitted_at_least",
        "largest_damage",
        "micropitted_over_cycles",
        "damage_map",
    ),
)


@dataclass
class Beside:
    """Counts of a life, in the callback of `run_life`.

    sizes, fatigue : None where not asked for. friction : as the lower body feels it. pieces : rows of cycles, pieces
    and volume worn of the lower body [m^3] per jump; pits : of cycles and micropitted share. last : state before.
    """

    case: LifeCase
    sizes: PieceSizes | None
    fatigue: RollingFatigue | None
    friction: float
    pieces: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    pits: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    last: LifeState | None = None

    def begun(self, state: LifeState) -> LifeState:
        """A life's first state."""
        self.last = state if self.fatigue is None else self.fatigue.begun(self.case, state)
        return self.last

    def after(self, now: LifeState) -> LifeState:
        """A state after a step, with its damage; what came off in it is counted."""
        before = self.last
        assert before is not None
        if self.fatigue is not None:
            now = self.fatigue.after(self.case, before, now)
            self.pits = np.vstack([self.pits, [now.cycles, pitted_share(now)]])
        if self.sizes is not None:
            worn = now.surfaces.volume[LOWER] - before.surfaces.volume[LOWER]
            number = carried_away(self.sizes.volumes(now.passes, self.friction), worn)
            self.pieces = np.vstack([self.pieces, [now.cycles, number, worn]])
        self.last = now
        return now

    def notes(self) -> tuple[Note, ...]:
        """Return a note where the criterion finds no piece in any pass, so that particles have no size."""
        if self.sizes is None or (self.pieces[:, 1] > 0).any():
            return ()
        law = self.sizes.model.law.name
        takes = "Wear goes on by its law; particles have no sizes and numbers."
        return (NOTHING_CAME_OFF("particles", level=Level.INFO, law=law, takes=takes),)

    def figures(self, cycle: FloatArray, end: LifeState) -> dict[str, Any]:
        """Figures of a record at its cycles (n,); None of what was not counted."""
        found: dict[str, Any] = dict.fromkeys(FIGURES)
        rows = self.pieces[np.isfinite(self.pieces[:, 1])]
        if len(rows) and rows[:, 1].sum() > 0:
            total = np.concatenate([[0.0], np.cumsum(rows[:, 1])])
            volume = float(rows[:, 2].sum() / total[-1])
            found["particles"] = float(total[-1])
            found["particle_equivalent_radius"] = float(np.cbrt(3 * volume / (4 * np.pi)))
            found["particles_over_cycles"] = np.interp(cycle, np.concatenate([[0.0], rows[:, 0]]), total)
        if end.damage is not None:
            highest = end.damage[0].max(axis=0)
            found["micropitted_share"] = pitted_share(end)
            found["micropitted_at_most"], found["micropitted_at_least"] = (pitted_share(end, of) for of in (1, 2))
            found["largest_damage"] = float(highest.max())
            found["micropitted_over_cycles"] = np.interp(cycle, self.pits[:, 0], self.pits[:, 1])
            found["damage_map"] = highest[: self.case.grid.shape[0]]
        return found
