"""Contact of a ball with a half-space under surface tension against a one-dimensional integral equation."""

from __future__ import annotations

import math

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.grid import Grid
from bem.materials import Body, Material
from bem.reference_solutions.tense_ball import tense_ball
from bem.verification.closed_forms import curves_over
from bem.verification.rows import Curve, Gate

_RATIOS = (0.1, 1.0, 10.0)
"""Elastocapillary lengths over the contact radius: from Hertz' contact to a film."""


def ball_on_a_tense_gel() -> list[Curve]:
    """A rigid ball under the load that gives one contact radius."""
    radius, contact, cells = 1.0, 0.1, 128
    found, exact = [], []
    for ratio in _RATIOS:
        tension = 0.5 * ratio * contact
        one = tense_ball(contact, radius, 1.0, tension, 40)
        gel = Material("gel", youngs_modulus=1.0, poissons_ratio=0.0, surface_tension=tension)
        areas = []
        for count in (cells // 2, cells):
            grid = Grid((count, count), (2.6 * contact / count,) * 2)
            gap = (grid.x[:, None] ** 2 + grid.y**2) / (2 * radius)
            touching = solve_contact(gap, displacement_operator(grid, Body(gel)), load=one.load)
            areas.append(touching.contact_area)
        middle = touching.pressure[cells // 2 - 1 : cells // 2 + 1, cells // 2 - 1 : cells // 2 + 1].mean()
        found.append((touching.approach, middle, 2 * areas[1] - areas[0]))
        exact.append((one.approach, one.maximum_pressure, math.pi * contact**2))
    reason = "49 cells over the contact radius; elastocapillary lengths of 0.1, 1 and 10 contact radii"
    area = f"{reason}, and half as many: the pressure ends on a step, so that the area is extrapolated at first order"
    figures = (
        ("approach", "m", 5e-5, reason),
        ("pressure in the middle", "Pa", 2e-4, reason),
        ("contact area", "m^2", 3e-3, area),
    )
    return curves_over("over elastocapillary length", _RATIOS, figures, found, exact)


def gates() -> list[Gate]:
    """Gates of surface tension."""
    sentence = "A ball on a half-space with surface tension (integral equation)."
    return [Gate("surface-tension-ball", "closed_forms", sentence, ball_on_a_tense_gel)]
