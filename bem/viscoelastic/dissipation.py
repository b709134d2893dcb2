"""Power that the dashpots of a steady contact dissipate, by its waves, without influence coefficients.

A wave exp(i k.x) of pressure moves the surfaces of half-spaces by 2 / (E* |k|) of itself. Its delayed part c M with the
memory M = 1 / (1 + i kx l) is out of phase with it and dissipates the power

    (2 pi)^-2 integral of |P(k)|^2 2 / (E* |k|) sum of c / theta (kx l)^2 / (1 + (kx l)^2) over k,

P being the Fourier transform of the pressure, l = V theta. Waves of a periodic axis are those of its period, and the
integral is their sum. Waves shorter than two cells are left out.

It shares the pressure alone with the operator of the contact. A kernel whose memory is wrong far away still fulfils the
local equation K M = K - l d(K M)/dx. A power computed with that kernel therefore balances the friction it gives,
however wrong both are; this power does not.

Quadrature along a free axis: between two of the grid's waves the transform of a bounded pressure turns once at most, so
that `_NODES` Gauss points suffice (shifted Fourier transforms); around zero, where 1 / |k| and the memory vary, panels
grow geometrically from `_LOWEST` of the reciprocal of the longest memory.

Error, of a cylinder: first order in the cell where the memory is shorter than a cell, by the edges of the contact, and
second order where it is longer. Cost: some 20 Fourier transforms of the field on a free grid, 3 with one free axis.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.convolution import DisplacementOperator
from bem.grid import FloatArray
from bem.viscoelastic.compliance import DelayedTerm

_NODES = 6
"""Gauss points between two waves of the grid, and in a panel: about 1e-6 of the integral."""
_LOWEST = 1e-3
"""End of the first panel, over the reciprocal of the longest length."""
_GROWTH = 4.0
"""Ratio of the ends of a panel."""


@dataclass(frozen=True)
class _Waves:
    """Some of the waves along an axis, and the Fourier transform to them.

    wavenumbers, weights : (n,), of the integral [rad/m]. transformed : (n, cells along the other axis).
    """

    wavenumbers: FloatArray
    weights: FloatArray
    transformed: NDArray[np.complex128]


def dissipated_power(
    pressure: FloatArray, operator: DisplacementOperator, terms: Sequence[DelayedTerm], speeds: tuple[float, float]
) -> float:
    """Return the power that the dashpots of the delayed pressures dissipate [W].

    pressure : (nx, ny) [Pa]. operator : of homogeneous bodies. terms : of the pair. speeds : of the bodies [m/s].
    """
    grid = operator.grid
    moving = [(term.amount / term.time, abs(term.time * speeds[term.body])) for term in terms if speeds[term.body]]
    if not moving:
        return 0.0
    longest = max(length for _, length in moving)
    total = 0.0
    for along_x in _waves(pressure.astype(np.complex128), grid.spacing[0], grid.periodic[0], longest):
        # opposite waves of a real pressure have the same power
        right = along_x.wavenumbers > 0
        kx = along_x.wavenumbers[right]
        lost = sum(rate * (kx * length) ** 2 / (1 + (kx * length) ** 2) for rate, length in moving)
        rows = np.ascontiguousarray(along_x.transformed[right].T)
        for along_y in _waves(rows, grid.spacing[1], grid.periodic[1], longest):
            size = np.hypot(kx, along_y.wavenumbers[:, None])
            density = (along_y.transformed.real**2 + along_y.transformed.imag**2) / size
            total += 2 * float(np.sum(along_y.weights[:, None] * density * (along_x.weights[right] * lost)))
    return total * 2 / operator.contact_modulus * (grid.cell_area / (2 * np.pi)) ** 2


def _waves(values: NDArray[np.complex128], spacing: float, periodic: bool, longest: float) -> Iterator[_Waves]:
    """Yield the waves along the first axis of `values` (cells, others), group by group.

    longest : length of memory [m].
    """
    cells = len(values)
    unit = 2 * np.pi / (cells * spacing)
    if periodic:
        number = np.arange(-(cells // 2), cells // 2 + 1)
        weights = np.full(number.size, unit)
        if cells % 2 == 0:  # the wave of two cells is half on either side
            weights[[0, -1]] *= 0.5
        yield _Waves(number.astype(np.float64) * unit, weights, np.fft.fft(values, axis=0)[number % cells])
        return
    # the interval of waves longer than two cells is that of `cells` units about zero; `core` of them lie on panels
    core = 1.0 if cells % 2 == 0 else 0.5
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    position = np.arange(cells)
    whole = np.fft.fftfreq(cells, 1 / cells).astype(np.float64)
    if cells > 2 * core:
        for node, weight in zip(nodes, weights, strict=True):
            shift = 0.5 * (1 + node) - (1 - core)
            turned = values * np.exp(-2j * np.pi * shift / cells * position)[:, None]
            outer = np.abs(whole + shift) > core
            transformed = np.fft.fft(turned, axis=0)[outer]
            yield _Waves((whole[outer] + shift) * unit, np.full(outer.sum(), 0.5 * weight * unit), transformed)
    low = _LOWEST / max(longest, cells * spacing)
    panels = max(1, int(np.ceil(np.log(core * unit / low) / np.log(_GROWTH))))
    ends = np.concatenate([[0.0], core * unit * _GROWTH ** -np.arange(panels, -1.0, -1.0)])
    half = 0.5 * np.diff(ends)[:, None]
    k = (0.5 * (ends[1:] + ends[:-1])[:, None] + half * nodes).ravel()
    measure = (half * weights).ravel()
    both = np.concatenate([-k, k])
    phases = np.exp(-1j * spacing * both[:, None] * position)
    # einsum: no threads of a BLAS library, the same bits everywhere
    yield _Waves(both, np.concatenate([measure, measure]), np.einsum("kj,jm->km", phases, values))
