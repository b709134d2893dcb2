"""Error bars of kind `contact`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.grid import FloatArray
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.resolutions import CELLS, DEPTHS

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.stress import StressSummary


def bars_of(
    scene: ContactScene,
    undeformed: FloatArray,
    response: Response,
    below: StressSummary | None,
    context: Context,
    *,
    rough: bool,
) -> ErrorBars:
    """Return the bars of the contact, and of the stresses below it where there are any."""
    from bem.accuracy import ContactCase

    grid = build.grid_of(scene.grid)
    operator = build.operator_of(scene, grid, scene.contact.friction)
    prescribed = scene.contact.prescribed(grid.area)
    case = ContactCase(operator, undeformed, response.contact, **prescribed, from_touch=rough)
    return response.bars(scene, case, below, context)


RESOLUTIONS = (CELLS, DEPTHS)
"""Resolutions that are refined to a requested accuracy."""
