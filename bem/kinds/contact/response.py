"""Response of the bodies of a contact to its load, from which a run takes its results: base class of all laws.

`ElasticResponse` (elastic, or capped at the hardness) is in `elastic`, `AdhesiveResponse` in `adhesive`,
`RelaxedResponse` (a path in time, or steady motion) in `viscoelastic`, `CurvedRailResponse` (on the curved rail) in
`curved_rail`. `solve_response` in `laws` chooses by the scene.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from bem.grid import FloatArray, Grid
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import standing_off
from bem.notes import Note
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.contact import ContactSolution
    from bem.stress import StressSummary


class Response(ABC):
    """Solved contact of one law; the defaults are those of an elastic contact without results of its own.

    differentiable : True if derivatives of the solution give its change with inputs.
    """

    differentiable: ClassVar[bool] = False

    @property
    @abstractmethod
    def contact(self) -> ContactSolution:
        """Contact at the end of a path, with counts and status of the whole."""

    @property
    def traction(self) -> FloatArray:
        """Normal traction (nx, ny) that stresses the bodies [Pa]: the pressure, less attraction where there is any."""
        return self.contact.pressure

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """Return the notes on the law."""
        return ()

    def notes_apart(self) -> tuple[Note, ...]:
        """Return the note on bodies that do not touch."""
        return standing_off(self.contact)

    def where(self, scene: ContactScene, grid: Grid) -> str:
        """Return what the status of the contact means, shown where it is not converged."""
        return f"contact solve: {self.contact.status.message}, residual {self.contact.residual:.2g}"

    def figures(self, scene: ContactScene) -> Mapping[str, Any]:
        """Return figures that replace those of the pressure, or that only this law has."""
        return {}

    def arrays(self, scene: ContactScene) -> Mapping[str, Any]:
        """Return arrays that only this law has."""
        return {}

    @abstractmethod
    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """Return the error bars of the contact and, where the law has them, of the stresses below it."""
