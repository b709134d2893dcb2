"""What a traction law is: given the pressure of a cycle's contact, it says what the surfaces do to each other along it.

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
    from bem.wear.criterion import Detachment
    from bem.wear.setup import WearSetup


@dataclass(frozen=True, eq=False)
class Rubbing:
    """What friction does in one loop of the bodies against each other, there and back.

    traction : (2, nx, ny) [Pa] on the lower body at the loop's end, where its force has the sign of the friction.
    slid : (nx, ny) [m], what the surfaces slide over each other at each place in the loop, there and back.
    way : [m], by which the bodies move against each other in the loop, there and back: four amplitudes.
    stick_share : of the cells in contact, those that slip in no part of the loop.
    energy : [J] of friction in the loop. residual, status : the worst of its steps. notes : on what not to believe.
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
    """What acts along the surfaces in a cycle."""

    family: ClassVar[str] = "traction"

    @property
    def slides(self) -> bool:
        """Whether traction is friction x pressure along +x everywhere, and the surfaces slide all of the way."""
        return False

    @property
    def loops_per_cycle(self) -> float:
        """Loops of the bodies that one computed cycle stands for, of wear by what each place slides."""
        return 1.0

    def misfits(self, criterion: Detachment, stress_range: bool) -> tuple[str, ...]:
        """Messages on what does not go together with the law in a wear model; none by default."""
        return ()

    def check(self, friction: float) -> None:
        """Raises InputError where surfaces without friction can carry no traction, and the law needs one."""
        if friction == 0 and not self.slides:
            raise InputError(f"traction {self.name}: friction is 0, which no force can be a part of; allowed: not 0")

    @abstractmethod
    def rub(self, pressure: FloatArray, friction: float, setup: WearSetup) -> Rubbing | None:
        """Under a pressure (nx, ny) [Pa] and a friction, along +x on the lower body where positive; None where the
        surfaces slide everywhere."""
