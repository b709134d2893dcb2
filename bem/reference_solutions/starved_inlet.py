"""Film of a starved line contact over the length of its inlet, where Hertz' contact is parallel (Grubin 1949).

Outside Hertz' contact of half-width b under a cylinder of radius R the gap is H = (b^2/2R) [s sqrt(s^2 - 1) -
arcosh s], s = |x|/b, and next to its edge (2/3) sqrt(8b) d^1.5/(2R), d = |x| - b. The reduced pressure reaches 1/alpha
at the edge: 6 mu (u1 + u2) integral H/(h + H)^3 = 1/alpha over the inlet. With d = t l(h), l(h) the length at which
H = h, the integral is l(h)/h^2 G(t), G(t) = integral of t^1.5/(1 + t^1.5)^3, and goes like h^(-4/3) G(t). So

    film / flooded film = (G(t)/G(inf))^(3/4),   inlet / l(flooded film) = t (film / flooded film)^(2/3):

one curve for all loads, speeds and oils, that of Wolveridge, Baglin and Archard, Proc. IMechE 185 (1971) 1159. Verified
in tests/reference_solutions/test_starved_inlet.py against the integral over the whole gap.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray

_FLOODED = math.gamma(5 / 3) * math.gamma(4 / 3) / 3
"""G(inf): 2/3 of the beta function of 5/3 and 4/3."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(80)


def inlet_length(half_width: float, radius: float, thickness: float) -> float:
    """How far before Hertz' contact the gap is as wide as a film is thick [m], all lengths [m]; near its edge."""
    return float((3 * radius * thickness / math.sqrt(8 * half_width)) ** (2 / 3))


def starved_film(lengths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A curve: inlets before Hertz' contact over `inlet_length` of the flooded film, and the film over that.

    lengths : t (n,), inlets over `inlet_length` of the film itself, positive.
    """
    t = np.asarray(lengths, dtype=np.float64)
    reduction = (_filled(t) / _FLOODED) ** 0.75
    return t * reduction ** (2 / 3), reduction


def _filled(t: FloatArray) -> FloatArray:
    """G: by Gauss on v = sqrt(t/(1 + t)), of which the integrand is smooth."""
    end = np.sqrt(t / (1 + t))
    v = 0.5 * end[..., None] * (1 + _NODES)
    root = v / np.sqrt(1 - v * v)  # sqrt of the place
    integrand = root**3 / (1 + root**3) ** 3 * 2 * v / (1 - v * v) ** 2
    return np.asarray(0.5 * end * (integrand @ _WEIGHTS))
