r"""The inlet of an elastohydrodynamic contact under waves of roughness: the flow that they let through.

The smooth inlet is that of Ertel and Grubin: the dry gap beside Hertz' contact, lifted by the film h. With the distance
s before the edge, over the length l at which the dry gap has opened to h,

    H = h0/h = 1 + s^(3/2),    d(p_r)/dX = 12 mu0 u l/h^2 (H - 1)/H^3,    X = -s,    p_r = (1 - exp(-alpha p))/alpha,

and p_r has come to 1/alpha at the edge, where nothing changes it. A wave of the surface, a exp(i(K X + Ky Y - W t)) in
units of l and of l/u with the mean speed u, W = r K and r = u_j/u, changes the film by d exp(i(Ky Y - W t)) and p_r by
phi. Reynolds' equation, linear in both, is

    d/dX [(3/H - 2) d - H^3 dphi/dX] = i W d - Ky^2 H^3 phi,    phi = 0 at the edge and far away.

Multiply by psi with (H^3 psi')' = Ky^2 H^3 psi, psi = 1 at the edge and 0 far away, and integrate: the flow into the
contact, over the mean speed, is a linear functional of the film,

    J = integral [(3/H - 2) psi' + i W psi] d dX.

The film before the edge follows from the displacement inside. A half-space displaced by exp(i kappa X) inside the edge
and free of pressure before it is displaced before it by (Wiener and Hopf's method for the kernel 1/|k|)

    F(kappa, s) = exp(-i kappa s) erfc(sqrt((|Ky| - i kappa) s)).

So d = a exp(i K X) + v_p F(K) + v_c F(W), with v_p, v_c the displacements of the particular and the complementary wave,
and J equals the flow of both waves inside. Where the oil is too stiff for the particular wave (v_p = -a), long waves
leave nothing of themselves, and short ones the amplitude a sqrt(r): before the edge the surface bends as the two waves
inside it make it bend, over lengths in proportion to theirs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, RectBivariateSpline
from scipy.linalg import solve_banded
from scipy.special import wofz

from bem.grid import FloatArray

ComplexArray = NDArray[np.complex128]

FARTHEST = 14.0
"""Distance before the edge, in lengths of the inlet, at which integrals end: psi is below 2e-4 there."""
PANELS, ORDER = 16, 8
"""Of Gauss' rule in the root of the distance: 1e-4 of a wave of K = 20."""
NODES = 2000
"""Elements of psi: 1e-6 of it."""
WAVES = np.geomspace(1e-3, 40.0, 40)
TRANSVERSE = np.geomspace(1e-3, 40.0, 24)
"""Tabulated K and |Ky|. Longer waves pass as the longest, shorter ones as the shortest."""


@dataclass(frozen=True, eq=False)
class InletFlow:
    """Flow into the contact over mean speed and amplitude, by its three parts.

    of_roughness : of the undeformed wave a exp(iKX).
    of_particular : of a displacement exp(iKX) inside the contact.
    of_complementary : of a displacement exp(iWX) inside the contact.
    """

    of_roughness: ComplexArray
    of_particular: ComplexArray
    of_complementary: ComplexArray


def transverse_weight(ky: float, root: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return psi and dpsi/ds at s = root^2, by linear elements in s on nodes that are even in the root of s."""
    nodes = np.linspace(0.0, math.sqrt(FARTHEST), NODES + 1)
    length = np.diff(nodes**2)
    cube = (1 + (0.5 * (nodes[1:] + nodes[:-1])) ** 3) ** 3
    stiff, mass = cube / length, ky**2 * cube * length / 6
    diagonal = np.zeros(NODES + 1)
    diagonal[:-1] += stiff + 2 * mass
    diagonal[1:] += stiff + 2 * mass
    beside = mass - stiff
    inner = np.zeros((3, NODES - 1))
    inner[0, 1:] = inner[2, :-1] = beside[1:-1]
    inner[1] = diagonal[1:-1]
    right = np.zeros(NODES - 1)
    right[0] = -beside[0]
    spline = CubicSpline(nodes, np.concatenate([[1.0], solve_banded((1, 1), inner, right), [0.0]]))
    return spline(root), spline(root, 1) / (2 * root)


def displacement_before_edge(wave: FloatArray, ky: float, distance: FloatArray) -> ComplexArray:
    """Return F(wave, distance): displacement before the edge of waves exp(i wave X) inside it."""
    decay = np.sqrt((ky - 1j * wave) * distance + 0j)
    return np.asarray(np.exp(-ky * distance) * wofz(1j * decay))


def inlet_flow(waves: FloatArray, ky: float, speed_ratio: float) -> InletFlow:
    """Return the flow that waves let into the contact.

    Parameters
    ----------
    waves : (n,) K.
    ky : |Ky|.
    speed_ratio : r, speed of the rough body over the mean speed.
    """
    point, weight = leggauss(ORDER)
    edges = np.linspace(0.0, math.sqrt(FARTHEST), PANELS + 1)
    half = 0.5 * np.diff(edges)[:, None]
    root = (0.5 * (edges[1:] + edges[:-1])[:, None] + half * point).ravel()
    distance, step = root**2, 2 * root * (half * weight).ravel()
    psi, slope = transverse_weight(ky, root)
    wave = np.asarray(waves, dtype=np.float64)[:, None]
    film = 1 + distance**1.5
    functional = (-(3 / film - 2) * slope + 1j * speed_ratio * wave * psi) * step
    return InletFlow(
        (functional * np.exp(-1j * wave * distance)).sum(axis=1),
        (functional * displacement_before_edge(wave, ky, distance)).sum(axis=1),
        (functional * displacement_before_edge(speed_ratio * wave, ky, distance)).sum(axis=1),
    )


@lru_cache(maxsize=64)
def _table(speed_ratio: float) -> tuple[tuple[RectBivariateSpline, RectBivariateSpline], ...]:
    """Return splines of the parts of the flow over ln K and ln |Ky|."""
    rows = [inlet_flow(WAVES, float(ky), speed_ratio) for ky in TRANSVERSE]
    parts = [
        np.array([getattr(row, name) for row in rows]).T
        for name in ("of_roughness", "of_particular", "of_complementary")
    ]
    axes = np.log(WAVES), np.log(TRANSVERSE)
    return tuple((RectBivariateSpline(*axes, part.real), RectBivariateSpline(*axes, part.imag)) for part in parts)


def tabulated_inlet_flow(kx: FloatArray, ky: FloatArray, speed_ratio: float) -> InletFlow:
    """Return the flow for waves (n,) of any sign, interpolated in a table of the speed ratio, which is cached."""
    at = np.log(np.clip(np.abs(kx), WAVES[0], WAVES[-1])), np.log(np.clip(np.abs(ky), TRANSVERSE[0], TRANSVERSE[-1]))
    sign = np.where(kx < 0, -1.0, 1.0)
    return InletFlow(
        *(real.ev(*at) + 1j * sign * imaginary.ev(*at) for real, imaginary in _table(round(speed_ratio, 12)))
    )
