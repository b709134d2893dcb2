"""What the bodies of a contact do under its load: one object for each law, from which a run takes its results.

`ElasticResponse` (elastic, or capped at the hardness) is here; `AdhesiveResponse` is in `adhesive`, `RelaxedResponse`
(a path in time, or steady motion) in `viscoelastic`, `CurvedRailResponse` (on the curved rail) in `curved_rail`.
`solve_response` chooses.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.contact.adhesive import AdhesiveResponse
from bem.kinds.contact.curved_rail import CurvedRailResponse, solve_on_curved_rail
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import level_before, solve_adhesive, solve_scene, standing_off
from bem.kinds.contact.viscoelastic import RelaxedResponse, solve_relaxing
from bem.notes import Note
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.contact import ContactSolution
    from bem.stress import StressSummary


class Response(Protocol):
    """Solved contact of one law."""

    @property
    def contact(self) -> ContactSolution:
        """Contact at the end of a path, with counts and status of the whole."""

    @property
    def traction(self) -> FloatArray:
        """Normal traction (nx, ny) that stresses the bodies [Pa]: the pressure, less attraction where there is any."""

    @property
    def differentiable(self) -> bool:
        """Return True if derivatives of the solution give its change with inputs."""

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """Return the notes on the law."""

    def notes_apart(self) -> tuple[Note, ...]:
        """Return the note on bodies that do not touch."""

    def figures(self, scene: ContactScene) -> Mapping[str, Any]:
        """Return figures that replace those of the pressure, or that only this law has."""

    def arrays(self, scene: ContactScene) -> Mapping[str, Any]:
        """Return arrays that only this law has."""

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """Return the error bars of the contact and, where the law has them, of the stresses below it."""


@dataclass(frozen=True, eq=False)
class ElasticResponse:
    """Elastic contact, or one capped at the hardness; a `Response`.

    history : (n, 2) iterations and residuals.
    """

    contact: ContactSolution
    history: FloatArray

    differentiable = True

    @property
    def traction(self) -> FloatArray:
        """See `Response`."""
        return self.contact.pressure

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """See `Response`."""
        return ()

    def notes_apart(self) -> tuple[Note, ...]:
        """See `Response`."""
        return standing_off(self.contact)

    def figures(self, scene: ContactScene) -> Mapping[str, Any]:
        """See `Response`."""
        return {}

    def arrays(self, scene: ContactScene) -> Mapping[str, Any]:
        """See `Response`."""
        if not len(self.history):
            return {}
        return {"iteration": self.history[:, 0].astype(np.int64), "residual_history": self.history[:, 1]}

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`."""
        from bem.accuracy import coarser_before, coating_bars, contact_bars, solve_coarser, stress_bars

        before = level_before(context)
        nested = None if before is None else coarser_before(case, before)
        coarser = nested or solve_coarser(case, scene.contact.max_iterations)
        bars = contact_bars(case, coarser)
        if below is None:
            return bars
        body, sign = scene.stressed()
        friction = sign * scene.contact.friction
        bars |= stress_bars(case, coarser, body, below, friction)
        if not body.layers or below.stress is None:
            return bars
        from bem.accuracy.coating import with_one_estimate

        return with_one_estimate(bars | coating_bars(case, coarser, body, below, friction), below, body)


def solve_response(scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context) -> Response:
    """Solve the contact by the law of its bodies, or take it from the checkpoint where it was solved before."""
    if scene.shape.conforming:
        return CurvedRailResponse(solve_on_curved_rail(scene, grid, undeformed, scene.contact.tolerance))
    relaxed = solve_relaxing(scene, grid, undeformed, context)
    if relaxed is not None:
        return RelaxedResponse(relaxed)
    if scene.contact.adhesion is not None:
        return AdhesiveResponse(solve_adhesive(scene, grid, undeformed, context))
    return ElasticResponse(*solve_scene(scene, grid, undeformed, context))
