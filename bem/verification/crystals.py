"""Contacts of crystals against the closed form of paraboloids on anisotropic half-spaces."""

from __future__ import annotations

import math

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.grid import Grid
from bem.materials import CATALOGUE, Body, Material
from bem.reference_solutions.crystal_hertz import crystal_hertz
from bem.verification.closed_forms import curves_over
from bem.verification.rows import Curve, Gate

_ORIENTATIONS = (((0, 0, 1), (1, 0, 0)), ((1, 1, 0), (0, 0, 1)), ((1, 1, 1), (1, -1, 0)), ((1, 2, 3), (1, 1, -1)))
"""Normal and direction along x of the surfaces; the last does not respond alike on both sides of the x axis."""


def crystal_ball() -> list[Curve]:
    """A rigid ball on the (001), (110), (111) and (123) surfaces of copper."""
    copper, load, radius = CATALOGUE["copper-crystal"].material.stiffness, 0.05, 1e-3
    assert copper is not None
    found, exact = [], []
    for normal, along_x in _ORIENTATIONS:
        stiffness = copper.oriented(normal, along_x)
        one = crystal_hertz([stiffness], (radius, radius), load)
        cells = 96
        grid = Grid((cells, cells), (2.4 * max(one.semi_axes) / cells,) * 2)
        gap = (grid.x[:, None] ** 2 + grid.y**2) / (2 * radius)
        contact = solve_contact(
            gap, displacement_operator(grid, Body(Material("copper", stiffness=stiffness))), load=load
        )
        found.append((contact.approach, contact.maximum_pressure, contact.contact_area))
        exact.append((one.approach, one.maximum_pressure, math.pi * one.semi_axes[0] * one.semi_axes[1]))
    reason = "40 cells over the radius; surfaces (001), (110), (111) and (123)"
    figures = (
        ("approach", "m", 2e-4, reason),
        ("maximum pressure", "Pa", 5e-4, reason),
        ("contact area", "m^2", 3e-3, reason),
    )
    return curves_over("over surfaces", range(len(_ORIENTATIONS)), figures, found, exact)


def gates() -> list[Gate]:
    """Gates against the closed form of paraboloids on crystals."""
    return [Gate("crystal-ball", "closed_forms", "A ball on four surfaces of a copper crystal (Willis).", crystal_ball)]
