"""Base classes of wear criteria: from the loads on a body in a cycle to the material that comes off."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.laws import Law, parameter

if TYPE_CHECKING:
    from bem.materials import Material
    from bem.wear.loads import BodyCycle, BodyWear
    from bem.wear.setup import WearSetup


FEWEST_CELLS = 2.9
"""Fewest cells to a length of the material for sizes within five per cent (`reports/experiments/wear_lengths.py`)."""

_SHORTEST_LENGTH = 300e-9
"""Default of the length over which a criterion averages stresses [m]."""


def resolved_length(cell: float) -> float:
    """Return the length of a criterion [m] that cells of a side [m] resolve: three cells, and its default at least."""
    return max(_SHORTEST_LENGTH, 3 * cell)


SKIN_DEPTH = 100e-9
"""Default thickness of the skin that leaves with the material below it [m]."""


@dataclass(frozen=True)
class Criterion(Law):
    """Base class: material that comes off a body in a cycle."""

    family: ClassVar[str] = "criterion"
    length_key: ClassVar[str] = ""
    """Name of the parameter that is a length of the material; empty for none."""

    @property
    def passes_per_cycle(self) -> float:
        """Passes of the counterface over a place that one computed cycle stands for; one by default."""
        return 1.0

    def distance_per_cycle(self, shift_distance: float) -> float:
        """Return the sliding distance that one computed cycle stands for [m], all its passes together.

        shift_distance : distance that the moving body slides between two computed cycles [m].
        """
        return shift_distance * self.passes_per_cycle

    def compliance(self, setup: WearSetup, body: int) -> float:
        """Return the depth that a cycle wears by pressure [m/Pa], for an implicit step; zero by default."""
        return 0.0

    @property
    def wears_by_pressure(self) -> bool:
        """True for local laws: a depth in proportion to pressure and distance at each place, without pieces."""
        return False

    @property
    def counts_passes(self) -> bool:
        """True if no single pass brings pieces off: the memory of the material sums over passes."""
        return False

    @property
    def needs_strength(self) -> bool:
        """True if a wearing body needs a yield stress."""
        return True

    @property
    def sizes_converge(self) -> bool:
        """True if sizes by number and the number of pieces converge with the mesh, as
        `reports/experiments/wear_lengths.py` shows."""
        return False

    def length(self, material: Material) -> float:
        """Return the length of a material that sets the size of pieces [m]; 0 where only the cell sets it."""
        return float(getattr(self, self.length_key)) if self.length_key else 0.0

    def resolved(self, material: Material, grid: Grid) -> bool:
        """Return True if a grid has enough cells for the length, or there is no length."""
        length = self.length(material)
        return length == 0.0 or length >= FEWEST_CELLS * max(grid.spacing) * (1 - 1e-9)

    def check_length(self, grid: Grid) -> None:
        """Raise InputError if the length is more than half of the grid's longer side."""
        most = 0.5 * max(grid.lengths)
        if self.length_key and getattr(self, self.length_key) > most:
            raise InputError(
                f"criterion {self.name}: {self.length_key} {getattr(self, self.length_key):g} m is more than half of "
                f"the grid's longer side; allowed: up to {most:g} m, or a larger grid"
            )

    def check_depths(self, depths: FloatArray) -> None:
        """Raise InputError if the depths (nz,) [m] do not resolve the stress that the law compares."""

    @abstractmethod
    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return the pieces that come off a body in a cycle, and the memory of its material for the next cycle."""


@dataclass(frozen=True)
class StressCriterion(Criterion):
    """Material whose equivalent stress exceeds the yield stress comes off where it reaches the surface.

    The skin is the material nearer to the surface than `skin_depth`. Its stress counts as that at this depth, so it
    leaves with the material below it. Without a skin, material under a single asperity can yield while a layer of no
    thickness above it does not (von Mises stress under a uniform pressure p is 0.2 p at the surface and up to 0.6 p
    below), so that the pieces depend on the cell. The skin is a length of the criterion and the same on every mesh.
    """

    skin_depth: float = parameter(
        "depth below the surface down to which the stress counts as that at this depth",
        "m",
        default=SKIN_DEPTH,
        at_least=0,
        source="a choice: the depth spacing of the grids of Akchurin (2017), 90 and 95 nm, whose first plane of stress "
        "is not stated; half of it gives the same friction and particle sizes",
        keyword_only=True,
    )

    @property
    def is_von_mises(self) -> bool:
        """True if the equivalent stress is von Mises' own, for which a faster transform exists."""
        return False

    @property
    def von_mises_factor(self) -> float | None:
        """Largest ratio of the equivalent stress to the von Mises stress of the same state, by which a bound on von
        Mises stress bounds it too; None where no such ratio exists."""
        return None

    @abstractmethod
    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Return the equivalent stress (...) of stresses (6, ...), order xx, yy, zz, yz, xz, xy, both [Pa]."""

    def check_depths(self, depths: FloatArray) -> None:
        """Raise InputError unless at least one depth [m] lies below the skin."""
        if depths[-1] <= self.skin_depth * 1.001:
            raise InputError(
                f"criterion {self.name}: the deepest depth, {depths[-1]:g} m, lies within skin_depth "
                f"{self.skin_depth:g} m; give deeper depths or a thinner skin"
            )

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return the pieces above yield that reach the surface."""
        from bem.wear.yielding import yielded_pieces  # kernels and transforms are not loaded for a name

        return yielded_pieces(cycle.loads, cycle.setup, cycle.model, cycle.body)
