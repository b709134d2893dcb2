"""Wear of machine elements by Archard's law: depth per hour, worn volume, number of particles."""

from __future__ import annotations

import math
from collections.abc import Sequence

from bem.elements.contact import ElementContact
from bem.elements.element import Element
from bem.elements.passes import NAMES
from bem.elements.piston_ring import PistonRingModel
from bem.elements.plain_bush import PlainBushModel
from bem.elements.running import wear_per_pass
from bem.particles import particle_number

CITES = ("archard1953",)
"""Source of the wear law, a key of `bem/references.bib`."""
_LAW = "; Archard's law with the whole load and the given wear rate"
_ROLLS = "none: both surfaces roll at one speed without sliding"
_BALLS_ROLL = "not known: both surfaces roll at one speed, and wear where balls slide within their contacts is left out"


def wear_per_hour(element: Element) -> str:
    """Return the depth that an hour takes off each body, in words."""
    contacts, rates = element.found.contacts, element.found.passes
    if all(one.speeds[0] == one.speeds[1] for one in contacts):
        return _rolling_words(contacts)
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, measured with this oil at a like lambda ratio"
    if isinstance(element.model, PistonRingModel):
        return _ring_wear(element, element.model) + _LAW
    said = []
    names = NAMES.get(element.model.element, ("body 1", "body 2"))
    for body, (name, rate) in enumerate(zip(names, rates, strict=True)):
        if rate is None:
            said.append(f"{name} not known: its places are not passed equally often")
            continue
        depth, where = max((wear_per_pass(element, one)[body] or 0.0, one.name) for one in contacts)
        said.append(f"{name} {3600 * rate * depth * 1e6:.3g} um at {where}")
    return ", ".join(said) + _LAW


def _rolling_words(contacts: Sequence[ElementContact]) -> str:
    """Return the wear of contacts that roll at one speed in words."""
    return _ROLLS if all(one.length is not None for one in contacts) else _BALLS_ROLL


def _ring_wear(element: Element, ring: PistonRingModel) -> str:
    """Return the depth that an hour takes off liner and ring, in words.

    A place of the liner is passed at crank angles t and -t of each turn; a pass takes off wear rate times line load.
    The contact stays on the ring's face: the mean depth over its height is wear rate x line load x speed over the
    height, the mean over the cycle, and at the line of contact of a new face wear rate x Hertz pressure x speed.
    """
    rate, turns = ring.specific_wear_rate or 0.0, round(ring.cycle / (2 * math.pi))
    cycles = 3600 * ring.speed / ring.cycle

    def passes(angle: float) -> float:
        angles = [2 * math.pi * turn + side for turn in range(turns) for side in (angle, 2 * math.pi - angle)]
        return rate * sum(max(ring.line_load(one), 0.0) for one in angles)

    downwards = [one for one in element.found.contacts if 0 < one.place % (2 * math.pi) < math.pi]
    depth, where = max((passes(one.place % (2 * math.pi)), one.place % (2 * math.pi)) for one in downwards)
    lost = len(element.found.contacts) / ring.points
    mean = element.found.mean(lambda one: one.line_load(element.modulus) * abs(one.speeds[0])) * lost
    peak = element.found.mean(lambda one: one.hertz(element.modulus).maximum_pressure * abs(one.speeds[0])) * lost
    hour = 3600 * rate * 1e6
    return (
        f"liner {1e6 * cycles * depth:.3g} um at the ring's place of crank angle {math.degrees(where):.3g} deg, ring "
        f"{hour * mean / ring.height:.3g} um on the mean over its face ({hour * peak:.3g} um at the line of contact "
        "while the face is new)"
    )


def worn_volume_rate(element: Element) -> float:
    """Return the worn volume per time [m^3/s], by Archard's law, of both bodies; of a bush that of the bush alone.

    It is wear rate x load x sliding speed for each body, the mean over the positions times the number of contacts at
    once; 0 without a wear rate.
    """
    found = element.found
    slid = found.mean(lambda one: one.carried * abs(one.speeds[0] - one.speeds[1]))
    bodies = 1 if isinstance(element.model, PlainBushModel) else 2
    return bodies * (element.model.specific_wear_rate or 0.0) * slid * found.at_once


def particles_per_hour(element: Element) -> str:
    """Return worn volume per hour in words, and the number of particles by their mean volume where it is given."""
    rate, one = 3600 * worn_volume_rate(element), element.model.mean_particle_volume
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, and mean_particle_volume"
    if rate == 0:
        return _rolling_words(element.found.contacts)
    worn = f"{1e9 * rate:.3g} mm^3 of {'the bush' if isinstance(element.model, PlainBushModel) else 'both bodies'}"
    if one is None:
        return f"{worn}; for a number of particles give mean_particle_volume, measured or from kind wear"
    return f"{worn}, {particle_number(rate, one):.3g} particles of {1e18 * one:.3g} um^3 each"
