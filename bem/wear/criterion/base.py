"""What a wear criterion is: given what acts on a body in a cycle, it says what comes off."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.laws import Law, parameter

if TYPE_CHECKING:
    from bem.materials import Material
    from bem.wear.loads import BodyCycle, Removal
    from bem.wear.setup import WearSetup


FEWEST_CELLS = 2.9
"""Cells to a length of the material from which sizes were found to converge (`reports/experiments/wear_lengths.py`:
averaged over 1.5 cells, radii are a quarter too large; over 2.96, within five per cent)."""


SKIN_DEPTH = 100e-9
"""Default thickness of the skin that leaves with the material below it [m]."""


@dataclass(frozen=True)
class Detachment(Law):
    """What comes off a body in a cycle."""

    family: ClassVar[str] = "criterion"
    length_key: ClassVar[str] = ""
    """The parameter that is a length of the material, if one is."""

    @property
    def passes_per_cycle(self) -> float:
        """Passes of the counterface over a place that one computed cycle stands for: one."""
        return 1.0

    def distance_per_cycle(self, slide: float) -> float:
        """Distance slid that one computed cycle stands for [m]; `slide` : of the counterface from one to the next."""
        return slide * self.passes_per_cycle

    def compliance(self, setup: WearSetup, body: int) -> float:
        """Depth that a cycle wears by pressure [m/Pa], for a contact that is to be met at the end of the step."""
        return 0.0

    @property
    def needs_strength(self) -> bool:
        """Whether what wears must have a yield stress."""
        return True

    @property
    def sizes_converge(self) -> bool:
        """Whether sizes by number and the number of pieces were found to converge with the mesh: the guide's chapter on
        criteria, `reports/experiments/wear_lengths.py`."""
        return False

    def length(self, material: Material) -> float:
        """The length of a material that decides what comes off [m]; 0 where there is none but the cell."""
        return float(getattr(self, self.length_key)) if self.length_key else 0.0

    def resolved(self, material: Material, grid: Grid) -> bool:
        """Whether a grid has cells enough for the length, where there is one."""
        length = self.length(material)
        return length == 0.0 or length >= FEWEST_CELLS * max(grid.spacing) * (1 - 1e-9)

    def check_length(self, grid: Grid) -> None:
        """Raises InputError where the given length is more than half of the grid's longer side."""
        most = 0.5 * max(grid.lengths)
        if self.length_key and getattr(self, self.length_key) > most:
            raise InputError(
                f"criterion {self.name}: {self.length_key} {getattr(self, self.length_key):g} m is more than half of "
                f"the grid's longer side; allowed: up to {most:g} m, or a larger grid"
            )

    def check_depths(self, depths: FloatArray) -> None:
        """Raise InputError where the depths (nz,) [m] cannot show what the law judges."""

    @abstractmethod
    def detach(self, cycle: BodyCycle) -> Removal:
        """The pieces that come off a body in a cycle, and what is to be remembered of its material."""


@dataclass(frozen=True)
class WearCriterion(Detachment):
    """Material whose equivalent stress exceeds the yield stress comes off where it reaches the surface.

    The skin, the material nearer to the surface than `skin_depth`, is judged by the stress at that depth: it leaves
    with the material below it and does not hold it back. Without a skin, material under a single asperity can yield
    while a layer of no thickness above it does not (von Mises stress under a uniform pressure p is 0.2 p at the surface
    and up to 0.6 p below), so that what comes off depends on the cell. The skin is a stated length of the criterion
    and stays the same on every mesh.
    """

    skin_depth: float = parameter(
        "depth below the surface down to which stress counts as that at this depth, 0 for none",
        "m",
        default=SKIN_DEPTH,
        at_least=0,
        source="a choice: the depth spacing of the source's grids (90 and 95 nm), whose first plane of stress is not "
        "stated; half of it gives the same friction and particle sizes",
        keyword_only=True,
    )

    @property
    def is_von_mises(self) -> bool:
        """Whether the equivalent stress is von Mises' own, so that it need not be asked of all six components."""
        return False

    @property
    def von_mises_factor(self) -> float | None:
        """The largest ratio of this equivalent stress to the von Mises stress of the same state, so that a bound on
        von Mises bounds it too; None where there is none and nothing may be skipped by that bound."""
        return None

    @abstractmethod
    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Shape (...) of stresses (6, ...) in the order xx, yy, zz, yz, xz, xy, both [Pa]."""

    def check_depths(self, depths: FloatArray) -> None:
        """Raise InputError unless at least one depth [m] lies below the skin."""
        if depths[-1] <= self.skin_depth * 1.001:
            raise InputError(
                f"criterion {self.name}: the deepest depth, {depths[-1]:g} m, lies within skin_depth "
                f"{self.skin_depth:g} m; give deeper depths or a thinner skin"
            )

    def detach(self, cycle: BodyCycle) -> Removal:
        """The yielded pieces."""
        from bem.wear.yielding import yielded_pieces  # kernels and transforms are not loaded for a name

        return yielded_pieces(cycle.loads, cycle.setup, cycle.model, cycle.body)
