"""Base class of traction laws: shear traction and slip for the pressure of a cycle's contact.

Knows fields; no solver.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.laws import Law
from bem.notes import Note

if TYPE_CHECKING:
    from bem.wear.criterion import Criterion
    from bem.wear.setup import WearSetup


@dataclass(frozen=True, eq=False)
class Rubbing:
    """One loop of the bodies against each other in partial slip, forth and back.

    traction : (2, nx, ny) on the lower body at the end of the loop [Pa], where its force has the sign of the friction.
    slid : (nx, ny) slip distance at each place in the loop [m].
    way : path of the bodies against each other in the loop, four amplitudes [m].
    stick_share : fraction of the cells in contact that slip in no part of the loop.
    energy : dissipated by friction in the loop [J].
    residual, status : the worst of the steps.
    notes : on where the loop is outside its model.
    """

    traction: FloatArray
    slid: FloatArray
    way: float
    stick_share: float
    energy: float
    residual: float = 0.0
    status: Status = Status.CONVERGED
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class TractionLaw(Law):
    """Base class: shear traction between the surfaces in a cycle."""

    family: ClassVar[str] = "traction"

    @property
    def slides(self) -> bool:
        """True if the traction is friction x pressure along +x everywhere (gross sliding)."""
        return False

    @property
    def loops_per_cycle(self) -> float:
        """Loops of the bodies that one computed cycle stands for, for wear by the slip distance."""
        return 1.0

    def misfits(self, criterion: Criterion, stress_range: bool) -> tuple[str, ...]:
        """Return messages on choices of a wear model that do not go with the law; none by default."""
        return ()

    def check(self, friction: float) -> None:
        """Raise InputError if the law needs a traction and the friction is zero."""
        if friction == 0 and not self.slides:
            raise InputError(f"traction {self.name}: friction is 0, which no force can be a part of; allowed: not 0")

    @abstractmethod
    def rub(self, pressure: FloatArray, friction: float, setup: WearSetup) -> Rubbing | None:
        """Solve the loop of partial slip under a pressure (nx, ny) [Pa]; None in gross sliding.

        friction : traction over pressure in sliding, along +x on the lower body where positive.
        """
