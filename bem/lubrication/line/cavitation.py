"""The two models of a ruptured film, as what one time step asks of them.

Pressure is complementary to the void that opens (Swift and Stieber), or to the empty fraction of the gap, which is
carried along (Jakobsson, Floberg, Olsson).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation

Nodes = NDArray[np.bool_]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Iterate:
    """Pressure, film, datum and filled fraction of the gap at the nodes."""

    pressure: FloatArray
    film: FloatArray
    datum: float
    fraction: FloatArray


class Rupture(Protocol):
    """What a model of the ruptured film decides. `scaled` is the excess of the volumes' balances by their own scale,
    `share` the pressure over its largest, `full` which nodes carry pressure."""

    def start(self, fraction: FloatArray) -> FloatArray:
        """The filled fraction to begin with, of that at the last time; a copy."""

    def measure(self, film: FloatArray) -> FloatArray:
        """The film that a volume's balance is measured by."""

    def carrying(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """Nodes that should carry pressure."""

    def violations(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes) -> list[float]:
        """By how much balance and complementarity are missed."""

    def balanced(self, full: Nodes) -> Indices:
        """Nodes whose volumes balance."""

    def empty(self, full: Nodes) -> Indices:
        """Nodes whose fraction is unknown."""

    def filling(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """What nodes that enter the film are filled by."""

    def leave(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """Fill the outlet, the first of two nodes at the end, as the one before it; in place."""


class SwiftStieber:
    """Reynolds' equation or no pressure; what is behind the rupture is forgotten."""

    def start(self, fraction: FloatArray) -> FloatArray:
        """Full."""
        return np.ones_like(fraction)

    def measure(self, film: FloatArray) -> FloatArray:
        """Its own."""
        return film

    def carrying(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """A node carries pressure unless that vanishes and a void opens; both measured by their own scale."""
        return np.asarray(share > scaled)

    def violations(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes) -> list[float]:
        """Balance where there is pressure, voids that shrink where there is none."""
        return [
            float(np.max(np.abs(scaled[full]), initial=0.0)),
            -float(np.where(full, 0.0, scaled)[1:-1].min(initial=0.0)),
        ]

    def balanced(self, full: Nodes) -> Indices:
        """Those with pressure."""
        return np.flatnonzero(full)

    def empty(self, full: Nodes) -> Indices:
        """None."""
        return np.arange(0)

    def filling(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """Nothing."""
        return np.zeros(len(full))

    def leave(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """Nothing is kept behind the film."""


class MassConserving:
    """A balance at every node; pressure or an empty fraction."""

    def start(self, fraction: FloatArray) -> FloatArray:
        """That of the last time."""
        return fraction.copy()

    def measure(self, film: FloatArray) -> FloatArray:
        """What is carried through a ruptured gap is as thin as the exit, however wide the gap."""
        return np.minimum(film, 10 * film.min())

    def carrying(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """A node carries pressure unless that vanishes and the gap empties."""
        return np.asarray(share > 1 - fraction)

    def violations(self, share: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes) -> list[float]:
        """Balance everywhere, fractions above one, and the complementarity."""
        return [
            float(np.max(np.abs(scaled[1:-1]))),
            float(np.max(fraction[1:-1])) - 1,
            float(np.max(np.abs(np.where(full, 1 - fraction, share))[1:-1])),
        ]

    def balanced(self, full: Nodes) -> Indices:
        """All but the ends."""
        return np.arange(1, len(full) - 1)

    def empty(self, full: Nodes) -> Indices:
        """All but the ends that carry no pressure."""
        return self.balanced(full)[~full[1:-1]]

    def filling(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """All that is missing."""
        return np.where(full, 1 - fraction, 0.0)

    def leave(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """What flows out is what came."""
        outlet, last = ends
        at.fraction[outlet] = min(mass[last] / (density[outlet] * at.film[outlet]), 1.0)
        mass[outlet] = at.fraction[outlet] * density[outlet] * at.film[outlet]


RUPTURES: dict[Cavitation, Rupture] = {
    Cavitation.SWIFT_STIEBER: SwiftStieber(),
    Cavitation.MASS_CONSERVING: MassConserving(),
}
