"""A start for bodies that are pushed straight for the first time: all that slips then slips one way.

Where no cell slips sideways, tractions q along the push and their displacements A q along it are a normal contact's:
p* = g - q >= 0 is what of the bound g is not used, and where p* > 0 the surfaces stick, that is A (g - p*) = shift:

    -A g + A p* = -shift where p* > 0,    -A g + A p* >= -shift elsewhere,

a contact of the gap -A g, under the load that is left, sum g - force, or at the approach -shift. Of homogeneous like
bodies of Poisson's ratio 0 it is the whole answer; of others all but what slip sideways changes.

Ciavarella, J. Mech. Phys. Solids 46 (1998); Jaeger, Arch. Appl. Mech. 68 (1998).
"""

from __future__ import annotations

import math

import numpy as np

from bem.contact import solve_contact
from bem.grid import FloatArray
from bem.tangential.along import AlongOperator
from bem.tangential.rounds import Slipping

_ENOUGH = 1e-2
"""Tolerance of that contact. Counted: 0.1 and 0.001 both take a twentieth more convolutions in all."""


def pushed_straight(problem: Slipping) -> FloatArray | None:
    """Wanted tractions (2, nx, ny) of a force, outside their discs by the slip times the stiffness; None where it is
    not a force alone, on an operator without coupling, that pushes.
    """
    force, bound = problem.force, problem.bound
    if force is None or problem.imposed.any() or not force.any():
        return None
    size = math.hypot(*force)
    direction = force / size
    operator = AlongOperator.of(problem.operator, (float(direction[0]), float(direction[1])))
    left = (float(bound.sum()) - size) * operator.grid.cell_area
    spare = solve_contact(-operator(bound), operator, load=left, tolerance=_ENOUGH)
    slips = (spare.pressure <= 0) & (bound > 0)
    used = np.maximum(bound - spare.pressure, 0.0)
    wanted = np.where(slips, bound + problem.stiffness * np.maximum(spare.gap, 0.0), used)
    return direction[:, None, None] * wanted
