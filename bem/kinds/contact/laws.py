"""Choice of the law by which the bodies of a contact respond."""

from __future__ import annotations

from bem.grid import FloatArray, Grid
from bem.kinds.contact.adhesive import AdhesiveResponse
from bem.kinds.contact.curved_rail import CurvedRailResponse, solve_on_curved_rail
from bem.kinds.contact.elastic import ElasticResponse
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import solve_adhesive, solve_scene
from bem.kinds.contact.viscoelastic import RelaxedResponse, solve_relaxing
from bem.scenes.context import Context


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
