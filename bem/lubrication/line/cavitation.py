"""The two models of a ruptured film, as complementarity problems of one time step.

Swift and Stieber: the pressure is complementary to the void that opens. Mass-conserving (Jakobsson and Floberg 1957,
Olsson 1965): the pressure is complementary to the empty fraction of the gap, which is carried along.
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
    """Iterate of a time step: pressure, film and filled fraction of the gap at the nodes (n+1,), and H0."""

    pressure: FloatArray
    film: FloatArray
    rigid_separation: float
    fraction: FloatArray


class CavitationModel(Protocol):
    """Decisions that differ between the models.

    Common arguments: `scaled` is the excess of the balances over their scale, `relative_pressure` the pressure over its
    maximum, `full` the active set of nodes with pressure.
    """

    def initial_fraction(self, fraction: FloatArray) -> FloatArray:
        """Return the filled fraction at the start of a step, from that at the last time; a copy."""

    def reference_film(self, film: FloatArray) -> FloatArray:
        """Return the film by which the balance of a volume is divided."""

    def active_set(self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """Return the nodes that should carry pressure."""

    def violations(
        self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes
    ) -> list[float]:
        """Return the violations of balance and complementarity."""

    def balanced_nodes(self, full: Nodes) -> Indices:
        """Return the nodes whose volumes balance."""

    def partly_filled_nodes(self, full: Nodes) -> Indices:
        """Return the nodes whose filled fraction is unknown."""

    def fraction_change(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """Return the change of the fraction at nodes that enter the full film."""

    def fill_outlet(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """Fill the outlet, the first of the two nodes `ends`, like the node before it, in place."""


class SwiftStieber:
    """Reynolds' equation or no pressure; oil behind the rupture is not tracked."""

    def initial_fraction(self, fraction: FloatArray) -> FloatArray:
        """Return full nodes."""
        return np.ones_like(fraction)

    def reference_film(self, film: FloatArray) -> FloatArray:
        """Return the film itself."""
        return film

    def active_set(self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """Return the nodes with pressure, unless it vanishes and a void opens, both relative to their scales."""
        return np.asarray(relative_pressure > scaled)

    def violations(
        self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes
    ) -> list[float]:
        """Return the violation of the balance at nodes with pressure, and of shrinking voids at the others."""
        return [
            float(np.max(np.abs(scaled[full]), initial=0.0)),
            -float(np.where(full, 0.0, scaled)[1:-1].min(initial=0.0)),
        ]

    def balanced_nodes(self, full: Nodes) -> Indices:
        """Return the nodes with pressure."""
        return np.flatnonzero(full)

    def partly_filled_nodes(self, full: Nodes) -> Indices:
        """Return no nodes."""
        return np.arange(0)

    def fraction_change(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """Return zero."""
        return np.zeros(len(full))

    def fill_outlet(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """Leave the outlet as it is."""


class MassConserving:
    """A balance at every node; pressure or an empty fraction."""

    def initial_fraction(self, fraction: FloatArray) -> FloatArray:
        """Return the fraction at the last time."""
        return fraction.copy()

    def reference_film(self, film: FloatArray) -> FloatArray:
        """Return the film, limited to ten times its minimum: the flow through a ruptured gap is as thin as the exit,
        however wide the gap."""
        return np.minimum(film, 10 * film.min())

    def active_set(self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray) -> Nodes:
        """Return the nodes with pressure, unless it vanishes and the gap empties."""
        return np.asarray(relative_pressure > 1 - fraction)

    def violations(
        self, relative_pressure: FloatArray, fraction: FloatArray, scaled: FloatArray, full: Nodes
    ) -> list[float]:
        """Return the violations of the balance, of fractions up to one, and of the complementarity."""
        return [
            float(np.max(np.abs(scaled[1:-1]))),
            float(np.max(fraction[1:-1])) - 1,
            float(np.max(np.abs(np.where(full, 1 - fraction, relative_pressure))[1:-1])),
        ]

    def balanced_nodes(self, full: Nodes) -> Indices:
        """Return all nodes but the ends."""
        return np.arange(1, len(full) - 1)

    def partly_filled_nodes(self, full: Nodes) -> Indices:
        """Return the nodes without pressure, but not the ends."""
        return self.balanced_nodes(full)[~full[1:-1]]

    def fraction_change(self, fraction: FloatArray, full: Nodes) -> FloatArray:
        """Return the empty fraction of the nodes of the full film."""
        return np.where(full, 1 - fraction, 0.0)

    def fill_outlet(self, at: Iterate, density: FloatArray, mass: FloatArray, ends: tuple[int, int]) -> None:
        """Let the outlet carry the mass that arrives."""
        outlet, last = ends
        at.fraction[outlet] = min(mass[last] / (density[outlet] * at.film[outlet]), 1.0)
        mass[outlet] = at.fraction[outlet] * density[outlet] * at.film[outlet]


CAVITATION_MODELS: dict[Cavitation, CavitationModel] = {
    Cavitation.SWIFT_STIEBER: SwiftStieber(),
    Cavitation.MASS_CONSERVING: MassConserving(),
}
