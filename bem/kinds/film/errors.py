"""Error bars of kind `film`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.accuracy.bars import POINTS, STEPS
from bem.scenes.resolutions import counted

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars, MarchCase


def bars_of(case: MarchCase, width: float) -> ErrorBars:
    """Estimate errors of the films, with the friction force on the whole width."""
    from bem.accuracy import march_bars

    bars = march_bars(case)
    return bars | bars.renamed({"largest_shear_force": "largest_friction_force"}, lambda force: force * width)


RESOLUTIONS = (counted("march.points", POINTS, 201, 5000), counted("march.steps", STEPS, 50, 100_000))
"""Resolutions that are refined to a requested accuracy."""
