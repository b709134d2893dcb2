"""Temperature of a line contact: bands of heat that extend without end along y, in closed form.

A unit flux from x1 to x2 raises the surface of a body that moves along +x with the speed U by

    1/(pi k) integral exp(w (x - x')) K0(|w (x - x')|) dx',    w = U/(2 kappa)

(Jaeger 1942; Carslaw and Jaeger, Conduction of Heat in Solids (1959), section 10.7), with the integral in closed form
(Abramowitz and Stegun, 11.3.16). A body at rest has no steady temperature under a line of heat.

`bem.lubrication` uses it for the walls of line films. Verified in tests/heat/test_line_heat.py.
"""

from __future__ import annotations

import numpy as np
from scipy.special import k0e, k1e

from bem.errors import InputError
from bem.grid import FloatArray
from bem.heat.bodies import Conductor

_FAR_UPSTREAM = 20.0
"""Peclet number upstream of which the heat of a band is below round-off."""


def band_temperatures(edges: FloatArray, body: Conductor) -> FloatArray:
    """Return the temperature rise at the centres of m cells per unit flux into each cell, (m, m) [K m^2/W].

    Parameters
    ----------
    edges : (m + 1,) edges of the cells, ascending [m].
    body : a half-space that moves.

    Raises
    ------
    InputError : a body at rest.
    """
    if body.peclet_per_length == 0:
        raise InputError(
            "band_temperatures: the body is at rest (speed 0): under a line of heat no steady state exists"
        )
    centres = 0.5 * (edges[1:] + edges[:-1])
    primitive = _primitive(body.peclet_per_length * (centres[:, None] - edges[None, :]))
    return np.asarray((primitive[:, :-1] - primitive[:, 1:]) / (np.pi * body.conductivity * body.peclet_per_length))


def _primitive(t: FloatArray) -> FloatArray:
    """Return the integral of exp(s) K0(|s|) from 0 to t."""
    out = np.where(t == 0, 0.0, -1.0)
    near = (t != 0) & (t > -_FAR_UPSTREAM)
    size = np.abs(t[near])
    zeroth, first = k0e(size), k1e(size)
    downstream = size * (zeroth + first) - 1
    upstream = -1 - size * np.exp(-2 * size) * (zeroth - first)
    out[near] = np.where(t[near] > 0, downstream, upstream)
    return out
