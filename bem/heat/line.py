"""Temperature of a half-space under bands of heat that stand still while the body moves along x.

Per unit flux from x1 to x2 the surface is warmer by

    1/(pi k) integral exp(w (x - x')) K0(|w (x - x')|) dx',    w = U/(2 kappa),

Jaeger (1942); Carslaw and Jaeger, Conduction of Heat in Solids (1959), section 10.7, with the integral in closed form
(Abramowitz and Stegun, 11.3.16). Under a line of heat a body at rest has no steady temperature. Verified in
tests/heat/test_line_heat.py.
"""

from __future__ import annotations

import numpy as np
from scipy.special import k0e, k1e

from bem.errors import InputError
from bem.grid import FloatArray
from bem.heat.bodies import Conductor

_FAR_UPSTREAM = 20.0
"""From there on nothing is left of the heat, to rounding."""


def band_temperatures(edges: FloatArray, body: Conductor) -> FloatArray:
    """Rise at the middles of cells for a unit flux into each, (m, m) [K m^2/W].

    Parameters
    ----------
    edges : (m+1,) of the cells, ascending [m].
    body : a half-space that moves.

    Raises
    ------
    InputError : a body at rest.
    """
    if body.wavenumber == 0:
        raise InputError(
            "band_temperatures: the body is at rest (speed 0): under a line of heat no steady state exists"
        )
    middle = 0.5 * (edges[1:] + edges[:-1])
    at = body.wavenumber * (middle[:, None] - edges[None, :])
    risen = _primitive(at)
    return np.asarray((risen[:, :-1] - risen[:, 1:]) / (np.pi * body.conductivity * body.wavenumber))


def _primitive(t: FloatArray) -> FloatArray:
    """Of exp(s) K0(|s|), zero at 0."""
    out = np.where(t == 0, 0.0, -1.0)
    near = (t != 0) & (t > -_FAR_UPSTREAM)
    at = t[near]
    size = np.abs(at)
    zeroth, first = k0e(size), k1e(size)
    downstream = size * (zeroth + first) - 1
    upstream = -1 - size * np.exp(-2 * size) * (zeroth - first)
    out[near] = np.where(at > 0, downstream, upstream)
    return out
