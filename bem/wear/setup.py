"""Parts of a wear loop that stay the same over all cycles, and the choices of its model that a criterion may read.

Knows bodies and grids; no law. Verified in tests/wear/test_cycle.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.materials import Body, softer_hardness

if TYPE_CHECKING:
    from bem.wear.film_defect import FilmDefect
    from bem.wear.removal import RemovalLaw

LOWER, UPPER = 0, 1


class WearChoices(Protocol):
    """Choices of a wear model (`bem.wear.WearModel`) that criteria and segmentation read."""

    @property
    def criterion_law(self) -> Any:
        """Criterion."""

    @property
    def removal(self) -> str | RemovalLaw:
        """Removal law."""

    @property
    def wears(self) -> str:
        """Which bodies wear, as in `wearing_bodies`."""

    @property
    def film_defect_model(self) -> FilmDefect | None:
        """Fractional film defect of a boundary film; None for unprotected surfaces."""

    @property
    def refine(self) -> int:
        """Fine voxels per depth interval."""

    @property
    def refinement(self) -> str:
        """Interpolation of the stress between depths."""

    @property
    def connectivity(self) -> int:
        """Neighbours of a voxel: 6, 18 or 26."""

    @property
    def within_layer(self) -> bool:
        """True if pieces of a coated body end at the interface."""


def wearing_bodies(bodies: tuple[Body, Body], wears: str) -> tuple[int, ...]:
    """Return the indices of the bodies (lower, upper) that wear.

    wears : "lower", "upper", "both", or "softer", the body of lower yield stress, the lower one where equal.
    """
    if wears != "softer":
        return {"lower": (LOWER,), "upper": (UPPER,), "both": (LOWER, UPPER)}[wears]
    known = [body.surface_material.yield_stress for body in bodies]
    lower, upper = (float("inf") if value is None else value for value in known)
    return (LOWER,) if lower <= upper else (UPPER,)


@dataclass(frozen=True, eq=False)
class WearSetup:
    """Parts of a wear loop that stay the same over all cycles.

    grid : of the contact. bodies : (lower, upper). gap : macroscopic gap of the smooth bodies, (nx, ny) [m].
    load : on the grid [N]. friction : of the contact, traction over pressure. depths : (nz,) [m], increasing, >= 0.
    hardness : cap of the contact pressure [Pa]; None takes the softer surface's, which may be None (elastic).
    """

    grid: Grid
    bodies: tuple[Body, Body]
    gap: FloatArray
    load: float
    friction: float
    depths: FloatArray
    hardness: float | None = None

    def __post_init__(self) -> None:
        depths = np.asarray(self.depths, dtype=np.float64)
        if depths.ndim != 1 or depths.size < 2 or depths[0] < 0 or not (np.diff(depths) > 0).all():
            raise InputError("WearSetup: depths must be at least two increasing values >= 0 [m]")
        object.__setattr__(self, "depths", depths)
        object.__setattr__(self, "gap", self.grid.check_field(self.gap, "gap"))
        if self.hardness is None:
            object.__setattr__(self, "hardness", softer_hardness(*self.bodies))

    def yield_stress(self, body: int) -> float:
        """Return the yield stress of a body's surface material [Pa]; infinite where none is given."""
        value = self.bodies[body].surface_material.yield_stress
        return np.inf if value is None else value
