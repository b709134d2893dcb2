"""Error bars of kind `particles`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray
from bem.kinds.particles.scene import ParticlesScene
from bem.notes import Note
from bem.notes.accuracy import NO_ERROR_BAR, named

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
    return replace(bars, notes=tuple(_of_rows(bars.notes, _NUMBERS if archard else ())))


def _of_rows(notes: Iterable[Note], numbers: Sequence[str]) -> Iterator[Note]:
    """Return the notes, those on the mean volume, which has no row, as notes on the figures that follow from it."""
    for note in notes:
        figures = note.values.get("figures", [])
        if "volume" not in figures:
            yield note
            continue
        rows = [name for name in figures if name != "volume"] + named(numbers)
        if rows:
            yield NO_ERROR_BAR(**{**note.values, "figures": rows})


def _of_number(number: float, volume: float, error: float) -> float:
    return number * error / volume


_NUMBERS = ("particle_number", "particles_per_mm_and_N")
