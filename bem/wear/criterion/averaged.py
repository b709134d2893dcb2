"""Yield of a stress averaged over a length of the material along the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.laws import parameter, register
from bem.wear.criterion.stresses import VonMises

if TYPE_CHECKING:
    from bem.wear.loads import BodyCycle, BodyWear


@register
@dataclass(frozen=True)
class AveragedVonMises(VonMises):
    """Von Mises stress of stresses averaged over a disc parallel to the surface, as a grain sees them.

    Stress is linear in pressure and alike along the surface, so the average of the stresses is the stress of the
    averaged pressure: one pass over the cells in contact, and no transform more. Along depth nothing is averaged.
    """

    name: ClassVar[str] = "averaged_von_mises"
    cites: ClassVar[tuple[str, ...]] = ("akchurin2017",)
    length_key: ClassVar[str] = "averaging_length"
    averaging_length: float = parameter(
        "diameter of the disc over which stresses are averaged",
        "m",
        default=300e-9,
        above=0,
        source="a choice: of the order of the strain-gradient length of metals, a quarter to five micrometres (Fleck, "
        "Muller, Ashby and Hutchinson 1994), and of the grains below a run-in surface",
    )

    @property
    def sizes_converge(self) -> bool:
        """True: the disc sets the size."""
        return True

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return the pieces that yield under the averaged loads."""
        from bem.wear.lengths import averaged_loads
        from bem.wear.yielding import yielded_pieces

        loads = averaged_loads(cycle.loads, cycle.setup.grid, self.averaging_length)
        return yielded_pieces(loads, cycle.setup, cycle.model, cycle.body)
