"""Thermal response of layers on a half-space that moves under a heat source.

Of a wave exp(i (q_x x + q_y y)) of heat a medium of conductivity k and diffusivity kappa has the decay
m = sqrt(q^2 + i U q_x / kappa) with depth and the impedance 1 / (k m), temperature over heat flux. A layer of thickness
h on a medium of impedance Z has the impedance of a transmission line,

    Z' = Z_l (Z + Z_l tanh(m h)) / (Z_l + Z tanh(m h)),   Z_l = 1 / (k m),

exact for any thickness and number of layers (Carslaw and Jaeger 1959, section 3.7; quadrupoles of Maillet et al. 2000).
Thin layers add h/k [1 - (k m / (k_s m_s))^2] to the impedance: h/k of a layer that conducts badly, nothing that depends
on speed. Its square is (k / k_s)^2 at rest and the ratio of both k rho c at high speed.

What layers add is local: it falls over a few thicknesses. On a free axis the flux is constant in cells. Verified in
tests/heat/test_layered_heat.py against finite volumes over depth, a Hankel integral under a disc, and a thick layer.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.heat.bodies import Conductor

_ASIDE, _WAKE = 20.0, 5.0
"""Width of the periodic grid over what layers reach aside, and along the motion in their wake."""
_MOST_CELLS = 2**24
"""Most cells of the periodic grid: 1 GB of memory."""
_NEAR_ZERO = 1e-3
"""Wavenumber over the first one along x at which the mean is evaluated, where the impedance has no limit."""


def added_impedance(body: Conductor, squares: FloatArray, along: FloatArray) -> NDArray[np.complex128]:
    """Return what the layers of a body add to the impedance of its half-space [K m^2/W].

    squares : q^2 of waves [1/m^2], above zero. along : q_x [1/m].
    """
    bare = 1 / (body.conductivity * np.sqrt(squares + 1j * body.speed * along / body.diffusivity))
    impedance = bare
    for layer in reversed(body.layers):
        decay = np.sqrt(squares + 1j * body.speed * along / layer.diffusivity)
        own, fall = 1 / (layer.conductivity * decay), np.tanh(decay * layer.thickness)
        impedance = own * (impedance + own * fall) / (own + impedance * fall)
    return np.asarray(impedance - bare)


def _reach(body: Conductor) -> tuple[float, float]:
    """Return the widths along x and y of the grid that holds what layers add [m].

    They act as far as they are thick, and as many times further as they conduct better than the body and carry heat
    aside; along the motion as far as the body goes while heat passes them, U h^2 / kappa.
    """
    aside = max(layer.thickness * max(1.0, layer.conductivity / body.conductivity) for layer in body.layers)
    wake = max(abs(body.speed) * layer.thickness**2 / layer.diffusivity for layer in body.layers)
    return max(_ASIDE * aside, _WAKE * wake), _ASIDE * aside


def added_table(grid: Grid, body: Conductor) -> FloatArray:
    """Return the temperature that layers add around one cell of unit flux [K m^2/W], (2 nx - 1, ny).

    Rows are offsets from 1 - nx to nx - 1 along the motion +x, columns offsets from 0, or all of a periodic axis. It is
    the sum of its waves on a grid that goes on periodically, free axes so wide that the images do not reach the table.

    Raises
    ------
    InputError : layers that act much further than the grid.
    """
    shape = []
    for n, spacing, periodic, reach in zip(grid.shape, grid.spacing, grid.periodic, _reach(body), strict=True):
        shape.append(n if periodic else 2 * n * math.ceil(max(1.0, reach / (2 * n * spacing))))
    if math.prod(shape) > _MOST_CELLS:
        raise InputError(
            f"surface_temperature: layers of {sum(layer.thickness for layer in body.layers):g} m at {body.speed:g} m/s "
            f"act over {max(_reach(body)):.3g} m, too far for {grid.shape} cells of {grid.spacing} m; take the layer's "
            "material as that of the body, or larger cells"
        )
    (nx, ny), (dx, dy), (wide_x, wide_y) = grid.shape, grid.spacing, shape
    along = np.repeat(2 * math.pi * np.fft.rfftfreq(wide_x, dx)[:, None], wide_y, axis=1)
    across = 2 * math.pi * np.fft.fftfreq(wide_y, dy)
    along[0, 0] = _NEAR_ZERO * 2 * math.pi / (wide_x * dx)
    moving = replace(body, speed=abs(body.speed))
    added = added_impedance(moving, along**2 + across**2, along)
    for wavenumber, spacing, periodic in zip((along, across), grid.spacing, grid.periodic, strict=True):
        if not periodic:
            added = added * np.sinc(wavenumber * spacing / (2 * math.pi))
    if wide_x % 2 == 0:
        added[-1].imag = 0.0  # an odd function has no component at the highest wavenumber
    table = np.fft.irfft(np.fft.ifft(added, axis=1), wide_x, axis=0)
    rows = np.arange(1 - nx, nx) % wide_x
    return np.ascontiguousarray(table[rows, :ny])
