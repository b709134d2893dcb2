"""Checks of the oil and of tribofilm growth; usual ranges of their constants are in `plausible.py`."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.notes import Note
from bem.notes.checks import (
    GROWTH_WITHOUT_BARRIER,
)
from bem.plausibility import ELECTRON_VOLT
from bem.scenes.checks.facts import Facts
from bem.scenes.checks.registry import scene_check


@scene_check
def oil_outside_its_range(facts: Facts) -> Iterator[Note]:
    """Viscosities extrapolated, an oil above its flash point or too thick to flow."""
    oil = getattr(facts.scene, "oil", None)
    yield from () if oil is None else oil.build().notes


@scene_check
def growth_without_a_barrier(facts: Facts) -> Iterator[Note]:
    """Note that growth runs at its prefactor, whatever the heat, once friction x pressure x activation volume
    reaches the barrier."""
    if not facts.of_kind("tribofilm"):
        return
    film = facts.scene.film
    for case in facts.cases:
        pressure = case.cap if case.cap is not None else (case.smooth.maximum_pressure if case.smooth else 0.0)
        lowered = case.friction * pressure * film.activation_volume
        if lowered > film.activation_energy and math.isfinite(lowered):
            yield GROWTH_WITHOUT_BARRIER(
                case.note_place("film"),
                stress=case.friction * pressure,
                lowered=lowered / ELECTRON_VOLT,
                barrier=film.activation_energy / ELECTRON_VOLT,
            )
            return
