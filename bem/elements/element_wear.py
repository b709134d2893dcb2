"""Wear of machine elements by Archard's law: depth per hour, worn volume, number of particles."""

from __future__ import annotations

from bem.elements.element import Element
from bem.elements.gear_pair import GearModel
from bem.elements.plain_bush import PlainBushModel
from bem.elements.running import wear_per_pass
from bem.particles import particle_number

CITES = ("archard1953",)
"""Source of the wear law, a key of `bem/references.bib`."""
_ROLLS = "none: both surfaces roll at one speed without sliding"


def wear_per_hour(element: Element) -> str:
    """Return the depth that an hour takes off each body, in words."""
    contacts, rates = element.found.contacts, element.found.passes
    if all(one.speeds[0] == one.speeds[1] for one in contacts):
        return _ROLLS
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, measured with this oil at a like lambda ratio"
    said = []
    names = ("pinion", "wheel") if isinstance(element.model, GearModel) else ("body 1", "body 2")
    for body, (name, rate) in enumerate(zip(names, rates, strict=True)):
        if rate is None:
            said.append(f"{name} not known: its places are not passed equally often")
            continue
        depth, where = max((wear_per_pass(element, one)[body] or 0.0, one.name) for one in contacts)
        said.append(f"{name} {3600 * rate * depth * 1e6:.3g} um at {where}")
    return ", ".join(said) + "; Archard's law with the whole load and a wear rate of this lubrication"


def worn_volume_rate(element: Element) -> float:
    """Return the worn volume per time [m^3/s], by Archard's law, of both bodies; of a bush that of the bush alone.

    It is wear rate x load x sliding speed for each body, the mean over the positions times the number of contacts at
    once; 0 without a wear rate.
    """
    found = element.found
    slid = found.mean(lambda one: one.load * abs(one.speeds[0] - one.speeds[1]))
    bodies = 1 if isinstance(element.model, PlainBushModel) else 2
    return bodies * (element.model.specific_wear_rate or 0.0) * slid * found.at_once


def particles_per_hour(element: Element) -> str:
    """Return the number of particles per hour in words: worn volume over mean particle volume."""
    rate, one = 3600 * worn_volume_rate(element), element.model.mean_particle_volume
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, and mean_particle_volume"
    if rate == 0:
        return _ROLLS
    worn = f"{1e9 * rate:.3g} mm^3 of {'the bush' if isinstance(element.model, PlainBushModel) else 'both bodies'}"
    if one is None:
        return f"{worn}; for a number of particles give mean_particle_volume, measured or from kind wear"
    return f"{worn}, {particle_number(rate, one):.3g} of {1e18 * one:.3g} um^3 each"
