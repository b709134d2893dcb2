"""Monitors of a life: pieces that a criterion would find, and fatigue below the surface, beside the wear.

Verified in tests/scenes/test_running_in_life_kind.py and tests/life/test_life.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.life.fatigue import RollingFatigue, pitted_share
from bem.life.march import LifeState
from bem.life.positions import PositionContact
from bem.life.surfaces import LifeCase
from bem.materials import Body
from bem.notes import Level, Note
from bem.notes.checks import NOTHING_CAME_OFF
from bem.notes.wear import MICROPITS_EARLY, PIECES_IN_SOME_STEPS
from bem.wear.criterion import Criterion
from bem.wear.loads import BodyCycle, SurfaceLoad
from bem.wear.model import WearModel
from bem.wear.segmentation import describe_pieces
from bem.wear.setup import LOWER, WearSetup

HIGH_CYCLES = 1e4
"""Fewest cycles at which a criterion of high-cycle fatigue holds: below, cyclic plasticity decides."""
PITTED_EARLY = 0.005
"""Share of the surface that may fail in fewer cycles than that without a note."""
_LEFT_OUT = 0.02
"""Share of the worn volume that the number of particles may leave out without a note."""
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


@dataclass(frozen=True, eq=False)
class PieceSizes:
    """Sizes of the pieces that a criterion finds in the lower body of a contact, without removing them."""

    setup: WearSetup
    model: WearModel

    @classmethod
    def of(
        cls,
        grid: Grid,
        bodies: tuple[Body, Body],
        criterion: str | Criterion,
        depths: FloatArray,
        hardness: float | None,
        load: float,
    ) -> PieceSizes:
        """Return the sizes of a criterion at depths (nz,) [m]; load : on the grid [N].

        Raises
        ------
        InputError : a lower body without yield stress, a length that the grid has no room for, a criterion that sums
            over passes.
        """
        setup = WearSetup(grid, bodies, np.zeros(grid.shape), load, 0.0, depths, hardness)
        model = WearModel(criterion=criterion, wears="lower", shift=0)
        if model.criterion_law.counts_passes:
            raise InputError(
                f"criterion {model.criterion_law.name} finds pieces after many passes, and a life looks for pieces in "
                "single passes; allowed: a criterion of stress or junction, or the life's own fatigue"
            )
        model.checked_wearing_bodies(setup)
        return cls(setup, model)

    def volumes(self, contacts: Sequence[PositionContact], distance: float) -> FloatArray:
        """Return the volumes [m^3] of the pieces in all contacts of a round.

        distance : slid by a place in a pass [m], over which junctions are dragged.
        """
        volumes: list[float] = []
        for contact in contacts:
            load = SurfaceLoad(contact.pressure, contact.traction_ratio)
            cycle = BodyCycle(contact.pressure, (load,), self.setup, self.model, LOWER, distance)
            removal = self.model.criterion_law.detach(cycle)
            volumes += [piece.volume for piece in describe_pieces(removal.pieces, self.setup.grid)]
        return np.array(volumes)


def number_of_pieces(volumes: FloatArray, worn: float) -> float:
    """Return the number of pieces of the mean volume that make up a worn volume [m^3]; nan without pieces."""
    return worn / float(volumes.mean()) if volumes.size else float("nan")


@dataclass
class Monitors:
    """Monitors of a life, called after every step of `run_life`.

    sizes, fatigue : None where not asked for.
    pieces : rows of cycles, number of pieces and volume worn of the lower body [m^3], one per step.
    pits : rows of cycles and micropitted share. last : state before the step.
    """

    case: LifeCase
    sizes: PieceSizes | None
    fatigue: RollingFatigue | None
    pieces: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    pits: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    last: LifeState | None = None

    def start(self, state: LifeState) -> LifeState:
        """Return a life's first state, with the damage where fatigue is monitored."""
        self.last = state if self.fatigue is None else self.fatigue.initial_state(self.case, state)
        return self.last

    def record(self, now: LifeState) -> LifeState:
        """Return the state after a step with its damage, and record pieces and micropits of the step."""
        before = self.last
        assert before is not None
        if self.fatigue is not None:
            now = self.fatigue.add_damage(self.case, before, now)
            self.pits = np.vstack([self.pits, [now.cycles, pitted_share(now)]])
        if self.sizes is not None:
            worn = now.surfaces.volume[LOWER] - before.surfaces.volume[LOWER]
            number = number_of_pieces(self.sizes.volumes(now.contacts, self.case.distance), worn)
            self.pieces = np.vstack([self.pieces, [now.cycles, number, worn]])
        self.last = now
        return now

    def notes(self) -> tuple[Note, ...]:
        """Return the notes on micropits and pieces."""
        return (*self._early_micropits(), *self._no_pieces())

    def _early_micropits(self) -> tuple[Note, ...]:
        """Return a note where part of the surface fails in so few cycles that no fatigue law holds."""
        early = self.pits[self.pits[:, 0] <= HIGH_CYCLES]
        if not len(early) or early[-1, 1] <= PITTED_EARLY:
            return ()
        cycles, share = early[-1]
        return (MICROPITS_EARLY(share=float(share), cycles=float(cycles), limit=HIGH_CYCLES),)

    def _no_pieces(self) -> tuple[Note, ...]:
        """Return a note where the criterion finds no piece in any pass, so that particles have no size, or none in
        steps that wear more than a little, which the number of particles leaves out."""
        if self.sizes is None:
            return ()
        law, (number, worn) = self.sizes.model.criterion_law.name, self.pieces[:, 1:].T
        if (number > 0).any():
            share = float(worn[np.isnan(number)].sum() / worn.sum())
            return (PIECES_IN_SOME_STEPS(law=law, share=share),) if share > _LEFT_OUT else ()
        takes = "Wear goes on by its law; particles have no sizes and numbers."
        return (NOTHING_CAME_OFF("particles", level=Level.INFO, law=law, takes=takes, beside="", reason="weak"),)

    def figures(self, cycle: FloatArray, end: LifeState) -> dict[str, Any]:
        """Return the figures of a record at its cycles (n,); None for figures without a monitor."""
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
