"""Yield of a region that can hold a sphere of a given diameter."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from bem.laws import parameter, register
from bem.wear.criterion.stresses import VonMises

if TYPE_CHECKING:
    from bem.wear.loads import BodyCycle, Removal


@register
@dataclass(frozen=True)
class Sphere(VonMises):
    """Pieces above von Mises yield that can hold a sphere of a given diameter; smaller pieces stay."""

    name: ClassVar[str] = "sphere"
    cites: ClassVar[tuple[str, ...]] = ()
    length_key: ClassVar[str] = "diameter"
    diameter: float = parameter(
        "diameter of the sphere that a wear particle must hold",
        "m",
        default=200e-9,
        above=0,
        source="a choice: of the order of the grains below a run-in surface, a tenth of a micrometre to one",
    )

    def detach(self, cycle: BodyCycle) -> Removal:
        """Return the yielded pieces that can hold the sphere."""
        from bem.wear.lengths import pieces_holding_sphere
        from bem.wear.yielding import yielded_pieces

        found = yielded_pieces(cycle.loads, cycle.setup, cycle.model, cycle.body)
        return replace(found, pieces=pieces_holding_sphere(found.pieces, cycle.setup.grid, self.diameter))
