"""Growth of roughness by wear although running-in removes summits: later results are then results of holes.

Knows facts and a summary. Verified in tests/scenes/test_checks.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.scenes.checks.facts import Facts
from bem.scenes.checks.words import numbers
from bem.scenes.common import BODIES
from bem.scenes.context import Outcome

_GROWN, _BEYOND_BOTH = 1.5, 1.1
"""A surface grew rough where its Sq is this many times as large as unworn, and this many times that of the unworn strip
and the counterface together: what touches may take over the counterface's roughness, not more."""


@dataclass(frozen=True)
class Roughened:
    """Rms heights [nm]: of both unworn surfaces together, of the wearing surface before each loop, and before and after
    of the surfaces that grew rough."""

    both: float = 0.0
    before: tuple[float, ...] = ()
    grown: tuple[tuple[float, float], ...] = ()


def with_pieces(facts: Facts) -> bool:
    """Return True if material leaves in pieces: a scar worn by pressure is meant to grow."""
    return all(case.wear is None or case.wear.criterion.needs_strength for case in facts.cases)


def roughened(facts: Facts, outcome: Outcome) -> Roughened:
    """Return the wear loops of a result whose surface grew rough; none without particles, or between smooth
    surfaces."""
    if not facts.of_kind("wear", "running-in") or not with_pieces(facts):
        return Roughened()
    rough = dict.fromkeys(("lower", "upper"), 0.0)
    for _, surface in facts.surfaces:
        rough[surface.body] = max(rough[surface.body], surface.rms_height)
    both = 1e9 * math.hypot(*rough.values())
    counterface = max((rough[name] for name in _counterfaces(facts)), default=0.0)
    before, after = (numbers(outcome.summary.get(f"Sq_{when}_nm")) for when in ("initial", "final"))
    grown = (
        (b, a)
        for b, a in zip(before, after, strict=False)
        if a > max(_GROWN * b, _BEYOND_BOTH * math.hypot(b, 1e9 * counterface)) > 0
    )
    return Roughened(both, tuple(before), tuple(grown) if both > 0 else ())


def _counterfaces(facts: Facts) -> set[str]:
    """The bodies whose heights are not those that Sq is reported of."""
    reported = {BODIES[case.wearing_bodies[0]] for case in facts.cases if case.wearing_bodies}
    return {"lower", "upper"} - reported
