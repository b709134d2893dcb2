"""Error bars of kind `particles`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray
from bem.kinds.particles.scene import ParticlesScene

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.particles import Particle


def bars_of(
    scene: ParticlesScene,
    found: list[Particle],
    heights: FloatArray,
    spacing: tuple[float, float],
    archard: Mapping[str, float],
) -> ErrorBars:
    """Estimate errors of particles, with those of their number, which goes as their mean volume to the power of -1."""
    from bem.accuracy import particle_bars

    bars = particle_bars(found, heights, spacing, scene.separation.model_dump())
    volume = float(np.mean([particle.volume for particle in found])) if archard else 0.0
    for name in _NUMBERS if archard else ():
        bars |= bars.renamed({"volume": name}, partial(_of_number, archard[name], volume))
    return bars


def _of_number(number: float, volume: float, error: float) -> float:
    return number * error / volume


_NUMBERS = ("particle_number", "particles_per_mm_and_N")
