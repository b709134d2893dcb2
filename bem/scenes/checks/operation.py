"""Checks of the oil and of tribofilm growth; usual ranges of their constants are in `plausible.py`."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.notes import Level, Note
from bem.notes.checks import GROWTH_WITHOUT_BARRIER, TRIBOFILM_ON_COATING
from bem.notes.contact import CREEPAGE_LARGE
from bem.notes.friction import PURE_ROLLING
from bem.physical_constants import ELECTRON_VOLT
from bem.scenes.checks.facts import Facts
from bem.scenes.checks.registry import outcome_check, scene_check
from bem.scenes.checks.words import numbers
from bem.scenes.common import SmoothSurface
from bem.scenes.context import Outcome

_LIKE = 1.5
"""Ratio of hardnesses up to which a film's curve begins at the coating's own."""


@scene_check
def oil_outside_its_range(facts: Facts) -> Iterator[Note]:
    """Viscosities extrapolated, an oil above its flash point or too thick to flow."""
    oil = getattr(facts.scene, "oil", None)
    yield from () if oil is None else oil.build().notes


_ROLLS = 1e-4
"""Slide-to-roll ratio below which surfaces creep elastically rather than slide, so that asperities hardly rub."""


@scene_check
def surfaces_only_roll(facts: Facts) -> Iterator[Note]:
    """In pure rolling asperities have no friction: a Stribeck curve is that of the film's rolling, and in running-in
    pressure alone would have to wear the surfaces."""
    if (ratio := pure_rolling(facts)) is not None:
        yield PURE_ROLLING("speeds", ratio=ratio, reason="wear" if facts.of_kind("running-in") else "curve")


def pure_rolling(facts: Facts) -> float | None:
    """Return the slide-to-roll ratio of a scene of mixed lubrication whose surfaces only roll; None of others."""
    if not facts.of_kind("friction", "running-in"):
        return None
    from bem.scenes.lubrication import slide_roll_ratio

    ratio = float(slide_roll_ratio(facts.scene.speeds.other_over_flat))
    return ratio if abs(ratio) < _ROLLS else None


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


@scene_check
def creepage_of_a_unit(facts: Facts) -> Iterator[Note]:
    """Creepage is a ratio: rolling contacts slide altogether from some 1 %, and 0.3 is 30 %, not 0.3 %."""
    roll = getattr(facts.scene, "roll", None)
    for name in ("creepage", "creepage_across"):
        value = getattr(roll, name, 0.0)
        if abs(value) > _MOST_CREEPAGE:
            yield CREEPAGE_LARGE(f"roll.{name}", value=value, share=100 * value, meant=value / 100)


_MOST_CREEPAGE = 0.1
"""Creepage above which it may be one in per cent: braked and driven wheels that spin."""


@scene_check
def tribofilm_on_a_coating(facts: Facts) -> Iterator[Note]:
    """Additives made for steel act otherwise on coatings (Neville, Morina, Haque & Voong, Tribol. Int. 40 (2007)
    1680)."""
    if not facts.of_kind("tribofilm") or not facts.cases:
        return
    scene, body = facts.scene, facts.cases[0].lower
    if not body.layers:
        return
    coating, temperature = body.surface_material, scene.rubbing.temperatures[0]
    yield TRIBOFILM_ON_COATING("lower.layers", material=coating.name, reason="growth")
    bare, own = scene.film.hardness(0.0, temperature), coating.indentation_hardness
    if own is not None and not 1 / _LIKE < bare / own < _LIKE and _pressures_reach(facts, _NEAR * min(bare, own)):
        key = "film.hardness.substrate" if scene.film.hardness.name == "fading_substrate" else "film.hardness"
        yield TRIBOFILM_ON_COATING(key, film=bare, material=coating.name, hardness=own, key=key, reason="hardness")
    if scene.rubbing.speeds is not None:
        yield TRIBOFILM_ON_COATING("rubbing.speeds", thickness=body.interfaces[-1], reason="heat")


_NEAR = 0.5
"""Hertz' pressure over a hardness from which the hardness may limit the pressure."""


def _pressures_reach(facts: Facts, limit: float) -> bool:
    """Return True if a pressure may reach a limit [Pa]: Hertz' maximum does, or roughness makes peaks of its own."""
    smooth = [case.smooth.maximum_pressure for case in facts.cases if case.smooth is not None]
    rough = any(not isinstance(table, SmoothSurface) for case in facts.cases for table in case.surfaces.values())
    return rough or not smooth or max(smooth) > limit


@outcome_check
def coating_taken_by_the_film(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Note wear of the outermost coating beneath a tribofilm, which the contact keeps at its thickness."""
    body = facts.cases[0].lower
    if not facts.of_kind("tribofilm") or body.layer is None:
        return
    worn = 1e-9 * max(numbers(outcome.summary.get("total_wear_depth_nm")), default=0.0)
    if worn > body.layer.thickness:
        yield TRIBOFILM_ON_COATING(
            level=Level.OUTSIDE_MODEL,
            worn=worn,
            material=body.layer.material.name,
            thickness=body.layer.thickness,
            reason="worn",
        )
