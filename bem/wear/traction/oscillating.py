"""Partial slip: the bodies are pushed to and fro along x by less than makes everything slide, or by a short way."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.laws import parameter, register
from bem.notes.contact import PRESSING_PATH
from bem.notes.wear import LOOP_ALL_SLIPS
from bem.wear.criterion import Detachment, LocalWear
from bem.wear.traction.base import Rubbing, TractionLaw

if TYPE_CHECKING:
    from bem.tangential import TangentialSolution
    from bem.wear.setup import WearSetup

TOLERANCE = 1e-6
"""Of the displacements, as `solve_partial_slip` takes it: far below what the cells leave open."""


@dataclass(frozen=True, kw_only=True)
class Oscillating(TractionLaw):
    """What both have in common: each cycle's contact is touched anew, pushed to a peak, back to its opposite and to the
    peak again, a step each; traction and slip are of that loop.

    Coulomb's friction with the local pressure (Cattaneo 1938; Mindlin and Deresiewicz 1953). Under a pressure that
    stays, the first way back erases what was before (but for what slips sideways), so the loop is the steady one, and
    a step each gives its energy where slip keeps its direction. Pieces leave under the tractions at its end; a local
    law wears by what each place slides in `loops` of them.
    """

    loops: float = parameter("loops that one computed cycle stands for, of a local law", default=1.0, above=0)

    @property
    def loops_per_cycle(self) -> float:
        """As given."""
        return self.loops

    def misfits(self, criterion: Detachment, stress_range: bool) -> tuple[str, ...]:
        """Distances are those of loops, and stresses change most within one."""
        found = []
        if isinstance(criterion, LocalWear) and criterion.distance > 0:
            found.append(
                f"criterion {criterion.name}: distance {criterion.distance:g} m with traction {self.name}: what each "
                "place slides follows from its loops; allowed: no distance, and traction.loops"
            )
        if stress_range:
            found.append(
                f"stress_range with traction {self.name}: stresses change more within a loop than from cycle to cycle; "
                "allowed: one of the two"
            )
        return tuple(found)

    @abstractmethod
    def peak(self, limit: float) -> dict[str, float]:
        """What `solve_partial_slip` is given along x, by its name; `limit` : friction x load, with its sign [N]."""

    def rub(self, pressure: FloatArray, friction: float, setup: WearSetup) -> Rubbing | None:
        """There and back."""
        from bem.tangential import solve_partial_slip

        grid, none = setup.grid, np.zeros(setup.grid.shape)
        if not pressure.any():
            return Rubbing(np.zeros((2, *grid.shape)), none, 0.0, 0.0, 0.0)
        self.check(friction)
        ((name, along),) = self.peak(friction * float(pressure.sum()) * grid.cell_area).items()
        asked: dict[str, Any] = {"friction": abs(friction), "tolerance": TOLERANCE}
        steps: list[TangentialSolution] = []
        for sign in (1.0, -1.0, 1.0):
            asked[name] = (sign * along, 0.0)
            before = steps[-1] if steps else None
            steps.append(solve_partial_slip(pressure, grid, setup.bodies, previous=before, **asked))
        return self._told(_loop(pressure, steps))

    def _told(self, rubbing: Rubbing) -> Rubbing:
        """With what this control has to say of it."""
        return rubbing


def _loop(pressure: FloatArray, steps: list[TangentialSolution]) -> Rubbing:
    """Of a first push, the way back and the way forth again."""
    _, back, forth = steps
    slid = np.hypot(*back.slip) + np.hypot(*forth.slip)
    failed = [step.status for step in steps if step.status is not Status.CONVERGED]
    touching = np.count_nonzero(pressure > 0)
    return Rubbing(
        traction=forth.traction,
        slid=slid,
        way=2 * abs(float(forth.shift[0] - back.shift[0])),
        stick_share=np.count_nonzero((pressure > 0) & (slid == 0)) / touching,
        energy=back.dissipated_energy + forth.dissipated_energy,
        residual=max(step.residual for step in steps),
        status=failed[0] if failed else Status.CONVERGED,
        notes=(PRESSING_PATH(reason="cycle"),) if steps[0].notes else (),
    )


@register
@dataclass(frozen=True, kw_only=True)
class OscillatingForce(Oscillating):
    """A tangential force between plus and minus a share of friction x load: the contact always sticks somewhere."""

    name: ClassVar[str] = "oscillating_force"
    share: float = parameter("largest force over friction x load", above=0, below=1)

    def peak(self, limit: float) -> dict[str, float]:
        """That share of the limit."""
        return {"force": self.share * limit}

    def _told(self, rubbing: Rubbing) -> Rubbing:
        return rubbing if rubbing.stick_share > 0 else replace(rubbing, notes=(*rubbing.notes, LOOP_ALL_SLIPS()))


@register
@dataclass(frozen=True, kw_only=True)
class OscillatingShift(Oscillating):
    """A movement of the bodies between plus and minus an amplitude: partial slip where it is short, gross where long
    (fretting; Vingsbo and Soderberg 1988)."""

    name: ClassVar[str] = "oscillating_shift"
    amplitude: float = parameter("of the bodies' movement against each other, far from the contact", "m", above=0)

    def peak(self, limit: float) -> dict[str, float]:
        """The amplitude, the way that friction points."""
        return {"shift": float(np.copysign(self.amplitude, limit))}
