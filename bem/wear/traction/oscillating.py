"""Partial slip: a tangential force or displacement that oscillates along x, below gross sliding or through it."""

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
from bem.wear.criterion import Criterion, LocalWear
from bem.wear.traction.base import Rubbing, TractionLaw

if TYPE_CHECKING:
    from bem.tangential import TangentialSolution
    from bem.wear.setup import WearSetup

TOLERANCE = 1e-6
"""Relative tolerance of the displacements in `solve_partial_slip`, far below the discretisation error."""


@dataclass(frozen=True, kw_only=True)
class Oscillating(TractionLaw):
    """Base class: load each cycle's contact to a peak, to the opposite peak and back, in one step each.

    Coulomb's friction with the local pressure (Cattaneo 1938; Mindlin and Deresiewicz 1953). Under constant pressure
    the first reversal erases the memory of earlier loops (except for lateral slip), so the loop is the steady one, and
    one step each gives its energy where slip keeps its direction. Pieces leave under the tractions at the end of the
    loop; a local law wears by the slip distance of `loops` of them.

    The pressure is that of the contact before the loop, which the tractions do not change. Between elastically
    different bodies, the loop's own dry contact has the normal displacement by friction x pressure along +x in it, as
    in gross sliding.
    """

    loops: float = parameter(
        "number of loops to and fro that a computed cycle stands for, with a local wear law", default=1.0, above=0
    )

    @property
    def loops_per_cycle(self) -> float:
        """Loops that one computed cycle stands for, as given."""
        return self.loops

    def misfits(self, criterion: Criterion, stress_range: bool) -> tuple[str, ...]:
        """Return messages on a sliding distance and on ranges of stress between cycles, which loops replace."""
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
        """Return the control of `solve_partial_slip` at the peak, `force` or `shift` along x, by its name.

        limit : friction x load, with its sign [N].
        """

    def rub(self, pressure: FloatArray, friction: float, setup: WearSetup) -> Rubbing | None:
        """Solve the loop; see `TractionLaw`."""
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
        return self._with_notes(_loop(pressure, steps))

    def _with_notes(self, rubbing: Rubbing) -> Rubbing:
        """Add notes of this control to a loop."""
        return rubbing


def _loop(pressure: FloatArray, steps: list[TangentialSolution]) -> Rubbing:
    """Return the loop from the steps of a first push, the way back and the way forth again."""
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
    cites: ClassVar[tuple[str, ...]] = ("cattaneo1938", "mindlin1949")
    share: float = parameter("largest tangential force over friction coefficient x load", above=0, below=1)

    def peak(self, limit: float) -> dict[str, float]:
        """Return the force: that share of the limit."""
        return {"force": self.share * limit}

    def _with_notes(self, rubbing: Rubbing) -> Rubbing:
        return rubbing if rubbing.stick_share > 0 else replace(rubbing, notes=(*rubbing.notes, LOOP_ALL_SLIPS()))


@register
@dataclass(frozen=True, kw_only=True)
class OscillatingShift(Oscillating):
    """A movement of the bodies between plus and minus an amplitude: partial slip where it is short, gross where long
    (fretting; Vingsbo and Soderberg 1988)."""

    name: ClassVar[str] = "oscillating_shift"
    cites: ClassVar[tuple[str, ...]] = ("cattaneo1938", "mindlin1949")
    amplitude: float = parameter("displacement amplitude of the bodies, far from the contact", "m", above=0)

    def peak(self, limit: float) -> dict[str, float]:
        """Return the shift: the amplitude along the friction."""
        return {"shift": float(np.copysign(self.amplitude, limit))}
