"""Contact with adhesion: figures, arrays, notes and error bars of its path."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bem.adhesion.figures import mean_contact_traction
from bem.grid import FloatArray, Grid
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import adhesion_tolerance
from bem.notes import Note
from bem.notes.contact import ADHESION_JUMPS, ADHESIVE_ZONE_UNRESOLVED
from bem.scenes import build
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.adhesion import AdhesionLaw, AdhesiveHistory
    from bem.contact import ContactSolution
    from bem.stress import StressSummary

FEWEST_CELLS = 2.0
"""Cells across the adhesive zone at an edge, below which the edge is held by the grid."""


def adhesive_zone(law: AdhesionLaw, modulus: float) -> float:
    """Return the width of the zone in which attraction acts at the edge of a wide contact [m].

    pi E* w / (4 strength^2), with strength = w / range: Dugdale's zone of a crack whose energy is the work of adhesion
    (Maugis 1992). Infinite for a range so long that its square overflows.
    modulus : E* [Pa].
    """
    return math.pi * modulus * law.range * law.range / (4 * law.work)


@dataclass(frozen=True, eq=False)
class AdhesiveResponse:
    """Contact with adhesion along its path; a `Response`."""

    path: AdhesiveHistory

    differentiable = False

    @property
    def contact(self) -> ContactSolution:
        """See `Response`."""
        last = self.path.last
        return replace(
            last.contact,
            residual=max(last.contact.residual, last.residual),
            convolutions=last.convolutions,
            iterations=last.steps,
            status=self.path.status,
        )

    @property
    def traction(self) -> FloatArray:
        """See `Response`."""
        return self.path.last.traction

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """See `Response`."""
        return adhesion_notes(scene, grid, self.path)

    def notes_apart(self) -> tuple[Note, ...]:
        """Return none: bodies that attract one another bear load without touching."""
        return ()

    def figures(self, scene: ContactScene) -> dict[str, Any]:
        """See `Response`."""
        path, law = self.path, scene.contact.adhesion
        assert law is not None
        found = {
            "load": path.last.load,
            "adhesive_energy": path.last.energy,
            "mean_contact_traction": mean_contact_traction(path.last, law),
        }
        return found | {"lowest_load": path.lowest_load} if len(path.load) > 1 else found

    def arrays(self, scene: ContactScene) -> dict[str, Any]:
        """Return the map of attraction and the path."""
        path = self.path
        found: dict[str, Any] = {"attraction": path.last.attraction}
        if len(path.load) > 1:
            found |= {
                "path_load": path.load,
                "path_approach": path.approach,
                "path_contact_area": path.contact_area,
                "path_jump": path.jumped.astype("int8"),
            }
        return found

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`; those of stresses are not known."""
        from bem.accuracy.adhesion import adhesive_bars

        law = scene.contact.adhesion
        assert law is not None
        path = scene.contact.path(case.grid.area)
        return adhesive_bars(case, law, self.path, path, adhesion_tolerance(scene))


def zone_is_resolved(scene: ContactScene, grid: Grid) -> bool:
    """Return True if the cells resolve the adhesive zone, and without adhesion."""
    law = scene.contact.adhesion
    return law is None or adhesive_zone(law, build.modulus_of(scene)) >= FEWEST_CELLS * _longest_cell(grid)


def _longest_cell(grid: Grid) -> float:
    """Return the longer side of a cell [m], along an axis of several cells."""
    return max(d for n, d in zip(grid.shape, grid.spacing, strict=True) if n > 1)


def adhesion_notes(scene: ContactScene, grid: Grid, path: AdhesiveHistory) -> tuple[Note, ...]:
    """Return notes on jumps, and on an adhesive zone that the cells do not resolve."""
    law, notes = scene.contact.adhesion, []
    assert law is not None
    zone, cell = adhesive_zone(law, build.modulus_of(scene)), _longest_cell(grid)
    if not zone_is_resolved(scene, grid):
        notes.append(ADHESIVE_ZONE_UNRESOLVED(zone=zone, cell=cell, wanted=zone / FEWEST_CELLS))
    if path.jumped.any():
        first = int(path.jumped.argmax())
        notes.append(ADHESION_JUMPS(jumps=int(path.jumped.sum()), load=float(path.load[first]), steps=len(path.load)))
    return tuple(notes)
