"""Hankel transforms of layered responses, g(r) = 1/(2 pi) integral of f(q) J_n(q r) q dq, as tables over r.

The spectrum f decays like exp(-q d) and is analytic to the right of the imaginary axis except for poles at some angle
from the real axis. `frequency_response.quadrature_scales` gives the decay, the angle, and the scale near q = 0.

1. Table. g is smooth on the scale of hypot(r, d): the edges of the panels of r grow by a factor of two from d/8 on, by
   sqrt(2) if poles are near (step 3). Each panel has a polynomial through 20 Chebyshev nodes (`interpolate_panels`).
2. Nodes with r < d/8 (`_transform_near`): Gauss quadrature on the real axis of q, on panels halved towards 0, as far as
   exp(-q d) = exp(-40).
3. Nodes with r > d/8 (`_transform_far`): on the real axis as far as q r = 4, on panels halved towards 0. The rest of
   J_n is the real part of the Hankel function H_n, which decays above the real axis, so its path leaves the axis
   (Cauchy): along an arc about 0, then along a ray from 0 at 30 degrees, where H_n decays like exp(-|q| r / 2), as far
   as exp(-40). If poles are near, the ray is at 15 degrees and all panels are half as wide (`Path`). No oscillation is
   left to resolve.
4. Panels of r and of q r grow by the same factor, so that all r need the spectrum at common values of q. Only the arc
   has values of q of its own. So f is computed once for each panel of q, an eighth of the evaluations.

No part of the integral is cut off or aliased. Error: 1e-14 of the largest value on a panel.

A load that is uniform along one axis needs a Fourier integral over the other in place of the Hankel transform: cos(q r)
or sin(q r) replaces J_n and exp(i q r) replaces H_n (`fourier`).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.kernels.layered import frequency_response, waves
from bem.kernels.layered.frequency_response import QuadratureScales, quadrature_scales
from bem.kernels.loads import Load
from bem.materials import Body

ComplexArray = NDArray[np.complex128]
SpectrumFunction = Callable[[NDArray], NDArray]
"""Spectra at wavenumbers: (n,) -> (tables, n), for real or complex q."""

PANEL_NODES = 20
"""Chebyshev nodes in a panel of r: an interpolant on [b/2, b] with singularities at 0 errs by 5.8^-20 = 5e-16."""

CUTOFF_EXPONENT = 40.0
"""Exponentials are integrated as far as exp(-40) = 4e-18."""

TURN = 4.0
"""Value of q r at which the path of integration leaves the real axis."""

_ABSCISSAE, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(14)


@dataclass(frozen=True)
class Path:
    """Path of integration in the complex plane of q that avoids the poles.

    Attributes
    ----------
    angle : angle of the ray from the real axis [rad].
    cuts : number of panels in a doubling of q on the real axis, and of r.
    ray_edges : edges of the panels along a ray that starts on the real axis, in units of 1/r.
    """

    angle: float
    cuts: int
    ray_edges: tuple[float, ...]

    @property
    def slope(self) -> complex:
        """Direction of the ray."""
        return complex(np.exp(1j * self.angle))

    def doubling(self, first: float, last: float) -> FloatArray:
        """Return edges from `first` to `last` or a little beyond, with `cuts` panels in each doubling."""
        doublings = max(0, int(np.ceil(np.log2(last / first))))
        return np.asarray(first * 2.0 ** (np.arange(doublings * self.cuts + 1) / self.cuts), dtype=np.float64)

    def graded(self, smallest: float, end: float) -> FloatArray:
        """Return edges from 0 to `end`; a panel is 1/cuts as wide as its distance from 0, down to about `smallest`."""
        halvings = max(0, int(np.ceil(np.log2(end / smallest))))
        return np.concatenate([[0.0], end * 2.0 ** (np.arange(-halvings * self.cuts, 1) / self.cuts)])


_RAY_AT_30_DEGREES = Path(np.pi / 6, 1, (0.0, 2.0, 4.0, 8.0, 14.0, 22.0, 34.0, 50.0, 80.0))
# a panel is a quarter of its distance from the origin wide; a pole at 30 degrees is as far, so 14 nodes reach round-off
_RAY_AT_15_DEGREES = Path(
    np.pi / 12, 2, (0.0, *np.cumsum(1.25 ** np.arange(16)).tolist(), CUTOFF_EXPONENT / np.sin(np.pi / 12))
)  # fmt: skip


def path_for(angle: float) -> Path:
    """Return the path for a spectrum without poles within `angle` [rad] of the real axis."""
    return _RAY_AT_30_DEGREES if angle > np.deg2rad(45) else _RAY_AT_15_DEGREES


@dataclass(frozen=True)
class HankelSpectra:
    """Spectra whose Hankel transforms make up one response, with the order of each and their scales.

    Attributes
    ----------
    values : spectra at (n,) wavenumbers: (tables, n).
    orders : order of the Bessel function of each spectrum.
    decay : d [m]; the spectra decay like exp(-q d).
    smallest : wavenumber [rad/m] below which the spectra are smooth.
    path : path of integration.
    key : all that the spectra depend on (response, body, depth, load, period), for the cache of tables; None: not
    cached.
    """

    values: SpectrumFunction = field(compare=False)
    orders: tuple[int, ...]
    decay: float
    smallest: float
    path: Path
    key: tuple[Any, ...] | None = None


class RadialTable(NamedTuple):
    """Functions of r as piecewise polynomials up to the last edge.

    Where the functions go on beyond it as zero, callers compare r with the last edge: `evaluate` would extrapolate.

    edges : (panels + 1,), edges of the panels of r [m].
    coefficients : (panels, powers, tables), of powers of t in (-1, 1) on each panel.
    decay : d [m]; the functions are smooth on the scale of hypot(r, d).
    wavenumber : wavenumber [rad/m] of ripples that a window in q leaves; 0 without a window.
    width : the ripples decay like exp(-(width r)^2) [1/m].
    """

    edges: FloatArray
    coefficients: FloatArray
    decay: float
    wavenumber: float = 0.0
    width: float = 0.0


def surface_spectra(body: Body, load: Load) -> HankelSpectra:
    """Return the spectra of the remainder of the normal surface displacement; angular terms: see `cells`."""
    row = waves.NORMAL_W if load is Load.NORMAL else waves.TANGENTIAL_W
    scale = 0.5 / body.surface_material.shear_modulus

    def values(q: NDArray) -> NDArray:
        f = frequency_response.wave_frame_response(q, body, 0.0, remainder=True, load=load)
        return f[row : row + 1] * (scale / q)

    orders = (0,) if load is Load.NORMAL else (1,)
    return _with_scales(values, orders, quadrature_scales(body, 0.0), ("normal", body, load))


def in_plane_spectra(body: Body) -> HankelSpectra:
    """Return the spectra of the remainder of the in-plane surface displacements; angular terms: see `cells`."""
    scale = 0.25 / body.surface_material.shear_modulus

    def values(q: NDArray) -> NDArray:
        f = frequency_response.wave_frame_response(q, body, 0.0, remainder=True, load=Load.TANGENTIAL)
        along, across = -f[waves.TANGENTIAL_U], f[waves.ACROSS_U]
        return np.stack([along + across, along - across]) * (scale / q)

    return _with_scales(values, (0, 2), quadrature_scales(body, 0.0), ("in plane", body))


def stress_spectra(body: Body, depth: float, load: Load) -> HankelSpectra:
    """Return the spectra of the six stresses at a depth: the remainder in the outermost layer, the whole below it."""
    scales = quadrature_scales(body, depth)

    def normal(q: NDArray) -> NDArray:
        f = frequency_response.wave_frame_response(q, body, depth, remainder=scales.remainder, load=load)
        ee, tt = f[waves.NORMAL_EE], f[waves.NORMAL_TT]
        return np.stack([f[waves.NORMAL_SIGMA], f[waves.NORMAL_TAU], 0.5 * (ee + tt), 0.5 * (ee - tt)])

    def tangential(q: NDArray) -> NDArray:
        f = frequency_response.wave_frame_response(q, body, depth, remainder=scales.remainder, load=load)
        tau, ee, tt = f[waves.TANGENTIAL_TAU], f[waves.TANGENTIAL_EE], f[waves.TANGENTIAL_TT]
        across, below = f[waves.ACROSS_ET], f[waves.ACROSS_TZ]
        return np.stack(
            [
                f[waves.TANGENTIAL_SIGMA],
                0.5 * (below - tau),
                0.5 * (tau + below),
                0.25 * (3 * ee + tt) + 0.5 * across,
                0.25 * (ee + 3 * tt) - 0.5 * across,
                0.25 * (ee - tt) - 0.5 * across,
            ]
        )

    key = ("stress", body, depth, load)
    if load is Load.NORMAL:
        return _with_scales(normal, (0, 1, 0, 2), scales, key)
    return _with_scales(tangential, (1, 0, 2, 1, 1, 3), scales, key)


def _with_scales(
    values: SpectrumFunction, orders: tuple[int, ...], scales: QuadratureScales, key: tuple[Any, ...]
) -> HankelSpectra:
    return HankelSpectra(values, orders, scales.decay, scales.smallest, path_for(scales.angle), key)


def radial_table(spectra: HankelSpectra, r_max: float, *, fourier: bool = False) -> RadialTable:
    """Return the table of the Hankel transforms for 0 <= r <= r_max [m], from the cache if the spectra have a key.

    fourier : tabulate 1/pi integral of f(q) cos(q r) dq (order 0) or of f(q) sin(q r) dq (order 1) instead.
    """
    panels = len(spectra.path.doubling(spectra.decay / 8, max(r_max, spectra.decay / 8)))
    return (_tabulate if spectra.key is None else _cached_table)(spectra, panels, fourier)


def _tabulate(spectra: HankelSpectra, panels: int, fourier: bool) -> RadialTable:
    """Compute a table with a number of panels (a whole number of doublings, so that grids of similar size share it)."""
    cuts = spectra.path.cuts
    edges = np.concatenate([[0.0], spectra.decay / 8 * 2.0 ** (np.arange(panels) / cuts)])
    nodes = [panel_nodes(a, b) for a, b in itertools.pairwise(edges)]
    values = _transform_near(spectra, nodes[0], fourier)[None]
    if panels > 1:
        values = np.concatenate([values, _transform_far(spectra, np.array(nodes[1:]), fourier)])
    return RadialTable(edges, interpolate_panels(values), spectra.decay)


_cached_table = lru_cache(maxsize=64)(_tabulate)
"""`_tabulate` with a cache of 64 tables of about 40 kB: coarser grids of a contact need the same table."""


def panel_nodes(a: float, b: float) -> FloatArray:
    """Return the Chebyshev nodes of the panel (a, b)."""
    return 0.5 * (a + b) + 0.5 * (b - a) * _CHEBYSHEV


_CHEBYSHEV = np.cos(np.pi * (np.arange(PANEL_NODES) + 0.5) / PANEL_NODES)
_TO_CHEBYSHEV = (np.where(np.arange(PANEL_NODES) == 0, 1.0, 2.0) / PANEL_NODES)[:, None] * np.cos(
    np.outer(np.arange(PANEL_NODES), np.arccos(_CHEBYSHEV))
)
_TO_POWERS = np.zeros((PANEL_NODES, PANEL_NODES))
for _k in range(PANEL_NODES):
    _TO_POWERS[: _k + 1, _k] = np.polynomial.chebyshev.cheb2poly(np.eye(PANEL_NODES)[_k])[: _k + 1]


def interpolate_panels(values: FloatArray) -> FloatArray:
    """Return the coefficients (panels, powers, tables) of the polynomials through values (panels, nodes, tables).

    In two steps, by Chebyshev coefficients: the entries of `_TO_POWERS` reach 1e5, so they multiply the decaying
    coefficients and not the values.
    """
    chebyshev = np.einsum("kn,pnt->pkt", _TO_CHEBYSHEV, values)
    return np.ascontiguousarray(np.einsum("jk,pkt->pjt", _TO_POWERS, chebyshev))


def gauss_rule(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points and weights of a 14-point Gauss rule on each of consecutive panels."""
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    return (middle[:, None] + half[:, None] * _ABSCISSAE).ravel(), (half[:, None] * _GAUSS_WEIGHTS).ravel()


def graded(smallest: float, end: float) -> FloatArray:
    """Return edges from 0 to `end`; a panel is as wide as its distance from 0, down to about `smallest`."""
    return _RAY_AT_30_DEGREES.graded(smallest, end)


def matrix_product(matrix: NDArray, vector: NDArray) -> NDArray:
    """Return matrix @ vector without BLAS, whose rounding depends on the number of threads."""
    product: NDArray = np.einsum("ij,j->i", matrix, vector)
    return product


def _transform_kernel(order: int, s: FloatArray, fourier: bool) -> FloatArray:
    """Return the kernel of the transform at s = q r on the real axis.

    It is J_n(s) s / 2 pi of g = r^-2 integral f ds; of a Fourier integral, cos(s) / pi or sin(s) / pi of
    g = r^-1 integral f ds.
    """
    if fourier:
        return (np.sin(s) if order else np.cos(s)) / np.pi
    values: FloatArray = special.jv(order, s) * s / (2 * np.pi)
    return values


def _transform_near(spectra: HankelSpectra, r: FloatArray, fourier: bool) -> FloatArray:
    """Return the transforms at r <= d/8, by quadrature on the real axis alone: (nodes, tables)."""
    edges = spectra.path.graded(min(spectra.smallest, 1 / spectra.decay), CUTOFF_EXPONENT / spectra.decay)
    q, weights = gauss_rule(edges)
    f = spectra.values(q) * weights
    scale = (1 / r if not fourier else np.ones_like(r))[:, None]
    kernels = {order: _transform_kernel(order, np.outer(r, q), fourier) * scale for order in set(spectra.orders)}
    return np.stack([matrix_product(kernels[order], f[table]) for table, order in enumerate(spectra.orders)], axis=1)


class _PathPart(NamedTuple):
    """Part of the path in s = q r: nodes (panels, 14), and for each order the transform's kernel times the weights."""

    nodes: NDArray[Any]
    kernels: tuple[NDArray[Any], ...]


@lru_cache(maxsize=8)
def _path_parts(path: Path, fourier: bool, panels: int) -> tuple[_PathPart, _PathPart, _PathPart]:
    """Return the parts of the path: real axis (so many panels from TURN towards 0), arc, ray (panels half as wide)."""
    falling = TURN * 2.0 ** (-np.arange(panels + 1) / path.cuts)
    s, weights = gauss_rule(falling[::-1])
    axis = _PathPart(s, tuple(_transform_kernel(order, s, fourier) * weights for order in range(2 if fourier else 4)))
    turn, angles = gauss_rule(np.array([0.0, path.angle]))
    doublings = np.log2(CUTOFF_EXPONENT / np.sin(path.angle) / TURN)
    rising = TURN * 2.0 ** (np.arange(int(np.ceil(2 * path.cuts * doublings)) + 1) / (2 * path.cuts))
    along, steps = gauss_rule(rising)
    bent = np.asarray(TURN * np.exp(1j * turn), dtype=np.complex128)
    arc = _off_axis_part(bent, 1j * bent * angles, fourier)
    ray = _off_axis_part(along * path.slope, path.slope * steps, fourier)

    def rows(part: _PathPart, order: int) -> _PathPart:
        def split(values: NDArray[Any]) -> NDArray[Any]:
            return values.reshape(-1, _GAUSS_WEIGHTS.size)[::order]

        return _PathPart(split(part.nodes), tuple(split(wave) for wave in part.kernels))

    return rows(axis, -1), rows(arc, 1), rows(ray, 1)


def _off_axis_part(s: NDArray[Any], weights: NDArray[Any], fourier: bool) -> _PathPart:
    """Return a part of the path off the real axis, with the Hankel function (Fourier: exp(i s)) as the kernel."""
    if fourier:
        wave = np.exp(1j * s) * weights / np.pi
        return _PathPart(s, (wave, -1j * wave))
    return _PathPart(s, tuple(special.hankel1(n, s) * s * weights / (2 * np.pi) for n in range(4)))


def _transform_far(spectra: HankelSpectra, r: FloatArray, fourier: bool) -> FloatArray:
    """Return the transforms at r > d/8: (panels, nodes, tables).

    r : (panels, nodes), each panel 2^(1/cuts) times as far as the one before.
    """
    (panels, _), cuts, first = r.shape, spectra.path.cuts, r[0][:, None]
    # the smallest q is common to all r; for the largest r it is q r = 1 or less
    down = int(np.ceil(cuts * np.log2(TURN / (spectra.smallest * r[0].min()))))
    axis, arc, ray = _path_parts(spectra.path, fourier, max(down, panels + 2 * cuts))
    rest, weights = gauss_rule(np.array([0.0, TURN * 2.0 ** (-len(axis.nodes) / cuts)]))
    f_axis = _spectrum(spectra, axis.nodes[:, None] / first)  # (tables, panels of q, r, 14)
    f_rest = _spectrum(spectra, rest / first)
    q_ray, before = ray.nodes[:, None] / first, 2.0 ** (np.arange(2 - 2 * panels, 0) / (2 * cuts))
    f_ray = _spectrum(spectra, np.concatenate([before[:, None, None] * q_ray[0], q_ray]))
    out = np.empty((*r.shape, len(spectra.orders)))
    for k in range(panels):  # r grown by 2^(k/cuts): panels of q from the k-th on; of the ray, 2 k before
        f_arc = _spectrum(spectra, arc.nodes[:, None] / r[k][:, None])
        here, start, grown = len(axis.nodes) - k, 2 * (panels - 1 - k), 2.0 ** (k / cuts)
        for table, order in enumerate(spectra.orders):
            total = np.einsum("prs,ps->r", f_axis[table, k:], axis.kernels[order][:here])
            total += np.einsum(
                "rs,s->r", f_rest[table], _transform_kernel(order, grown * rest, fourier) * (grown * weights)
            )
            total += np.einsum("prs,ps->r", f_arc[table], arc.kernels[order]).real
            total += np.einsum("prs,ps->r", f_ray[table, start : start + len(ray.nodes)], ray.kernels[order]).real
            out[k, :, table] = total / (r[k] if fourier else r[k] ** 2)
    return out


def _spectrum(spectra: HankelSpectra, q: NDArray[Any]) -> NDArray[Any]:
    """Return the spectra at q of any shape: (tables, *q.shape)."""
    return spectra.values(np.ascontiguousarray(q).ravel()).reshape(-1, *q.shape)


@compiled
def panel_of(r: float, edges: FloatArray) -> int:
    """Return the number of the panel that contains r; beyond the last edge, the last panel."""
    low, high = 0, edges.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if r >= edges[middle]:
            low = middle
        else:
            high = middle
    return low


@compiled
def evaluate(r: float, edges: FloatArray, coefficients: FloatArray, out: FloatArray) -> None:
    """Evaluate all tables at r into `out` (tables,), by Horner's rule; r is at most the last edge."""
    low = panel_of(r, edges)
    t = (2.0 * r - edges[low] - edges[low + 1]) / (edges[low + 1] - edges[low])
    powers = coefficients.shape[1]
    for table in range(coefficients.shape[2]):
        out[table] = coefficients[low, powers - 1, table]
    for power in range(powers - 2, -1, -1):
        for table in range(coefficients.shape[2]):
            out[table] = out[table] * t + coefficients[low, power, table]


@compiled
def _evaluate_all(r: FloatArray, edges: FloatArray, coefficients: FloatArray, out: FloatArray) -> None:
    for i in range(r.size):
        evaluate(r[i], edges, coefficients, out[i])


def evaluate_table(table: RadialTable, r: FloatArray) -> FloatArray:
    """Return the values of all tables at r of any shape: (*r.shape, tables)."""
    out = np.empty((r.size, table.coefficients.shape[2]))
    _evaluate_all(np.ascontiguousarray(r).ravel(), table.edges, table.coefficients, out)
    return out.reshape(*r.shape, -1)
