"""Scenes beyond what any half-space can be: refused before any work, where a warning would stand beside nonsense.

A contact larger than the body whose it is, or strains beyond one over all of the grid: no figure of such a run means
anything, and it is a slip of a unit or of a power of ten. What is only large is warned of (`contact.py`). Knows closed
forms. Verified in tests/scenes/test_refusals.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.materials import contact_modulus
from bem.quantities import si
from bem.scenes.checks.facts import Case, Facts
from bem.scenes.checks.units_of import suspected_units

_REMEDY = "lower the load, or check the units of load, modulus and lengths"


def refusals(facts: Facts) -> list[str]:
    """Return the reasons to refuse a scene, at most one sentence for each contact or each suspected unit; empty if
    it can run."""
    why = list(dict.fromkeys(words for case in facts.cases for words in _why(case)))
    return (suspected_units(facts.scene) or why) if why else []


def _why(case: Case) -> Iterator[str]:
    pressure, limit = case.mean_pressure, _most(case)
    if pressure is not None and pressure > limit[0]:
        yield (
            f"load: a mean pressure of {si(pressure, 'Pa')} over the grid{case.at} is {pressure / limit[0]:.2g} times "
            f"{limit[1]}, {si(limit[0], 'Pa')}: strains would be beyond one, and no half-space has them; {_REMEDY}"
        )
    elif case.smooth is not None and case.smooth.ratio > 1:
        yield (
            f"load: a contact radius {case.smooth.ratio:.2g} times the body's{case.at}: the contact would be larger "
            f"than the body; {_REMEDY}"
        )


def _most(case: Case) -> tuple[float, str]:
    """The mean pressure [Pa] at which strains are of order one, and what it is in words.

    A patch with free edges is pushed in by its own diameter where a pressure of E* is on it (2 p a / E* in the middle
    of a circle, Johnson 1985, eq. 3.29). What repeats along both axes cannot give way to the sides: there the softer
    body is pressed to nothing at its uniaxial modulus, far above E* where Poisson's ratio is near half.
    """
    materials = [body.material for body in case.bodies.values()]
    if case.grid is not None and any(m.surface_tension is not None for m in materials):
        # a wave as long as the grid is stiffer by the tension
        stiffer = 1 + max(m.elastocapillary_length for m in materials) * math.pi / min(case.grid.lengths)
        return stiffer * contact_modulus(*materials), "the contact modulus with surface tension"
    if case.grid is not None and all(case.grid.periodic):
        uniaxial = [
            m.youngs_modulus * (1 - m.poissons_ratio) / ((1 + m.poissons_ratio) * (1 - 2 * m.poissons_ratio))
            for m in materials
        ]
        return min(uniaxial), "the softer body's uniaxial modulus"
    return contact_modulus(*materials), "the contact modulus"
