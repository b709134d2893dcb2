"""Radial tables: Hankel transforms of layered responses, g(r) = 1/(2 pi) integral of f(q) J_n(q r) q dq.

The spectrum f decays like exp(-q d) and is analytic to the right of the imaginary axis except for poles at some angle
from the real axis; `layered.features` says which, and on what scale it varies near q = 0. So:

- g is smooth on the scale of hypot(r, d): panels of doubling width from d/8 on, a polynomial on each;
- for r > d/8, J_n is integrated on the real axis up to q r = 4, on panels halved towards 0, and the rest as the real
  part of the Hankel function: along an arc about 0, then a ray from 0 at 30 degrees, where it decays like
  exp(-|q| r/2), or at 15 where poles are near, with twice as many panels everywhere (`Path`). No oscillation is left to
  resolve;
- panels of r and of q r grow by the same factor, so that all r ask for the spectrum at the same q, but for the arc: it
  is computed once on each panel of q, eight times less often than on each of q r (a spectrum of 50 layers is dear);
- for r < d/8, exp(-q d) ends the real axis first.

Nothing is cut off or aliased; the tables are good to some 1e-14 of the largest value on a panel.
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
from bem.kernels.loads import Load
from bem.materials import Body

ComplexArray = NDArray[np.complex128]
Spectra = Callable[[NDArray], NDArray]

NODES = 20  # per panel of r; an interpolant on [b/2, b] with singularities at 0 converges like 5.8^-NODES
END = 40.0  # exponentials are cut at exp(-END)
TURN = 4.0  # q r where the path leaves the real axis

_ABSCISSAE, _GAUSS = np.polynomial.legendre.leggauss(14)


@dataclass(frozen=True)
class Path:
    """Path of integration in the complex plane of q that avoids the poles.

    Attributes
    ----------
    angle : of the ray that leaves the real axis [rad].
    cuts : panels a doubling, along the real axis and of r.
    ray_edges : of the panels along the ray, in lengths of 1/r: to where exp(-END) is left.
    """

    angle: float
    cuts: int
    ray_edges: tuple[float, ...]

    @property
    def slope(self) -> complex:
        """Direction of the ray."""
        return complex(np.exp(1j * self.angle))

    def doubling(self, first: float, last: float) -> FloatArray:
        """Edges from `first` to `last` or a little beyond, `cuts` panels a doubling."""
        doublings = max(0, int(np.ceil(np.log2(last / first))))
        return np.asarray(first * 2.0 ** (np.arange(doublings * self.cuts + 1) / self.cuts), dtype=np.float64)

    def graded(self, smallest: float, end: float) -> FloatArray:
        """Edges from 0 to `end`, each panel 1/cuts as wide as its distance from 0, down to about `smallest`."""
        halvings = max(0, int(np.ceil(np.log2(end / smallest))))
        return np.concatenate([[0.0], end * 2.0 ** (np.arange(-halvings * self.cuts, 1) / self.cuts)])


_STEEP = Path(np.pi / 6, 1, (0.0, 2.0, 4.0, 8.0, 14.0, 22.0, 34.0, 50.0, 80.0))
# a quarter of the distance from the origin wide: half of that from poles at 30 degrees, 14 nodes reach round-off
_FLAT = Path(
    np.pi / 12, 2, (0.0, *np.cumsum(1.25 ** np.arange(16)).tolist(), END / np.sin(np.pi / 12))
)  # fmt: skip


def path_for(angle: float) -> Path:
    """The path for a spectrum without poles within `angle` of the real axis [rad]."""
    return _STEEP if angle > np.deg2rad(45) else _FLAT


@dataclass(frozen=True)
class Kernels:
    """Spectra whose Hankel transforms make up one response, the order of each, and the scales on which they vary.

    Attributes
    ----------
    spectra : (n,) wavenumbers -> (tables, n).
    orders : order of the Bessel function of each.
    decay : d, they decay like exp(-q d) [m].
    smallest : wavenumber below which they are smooth [1/m].
    path : of their integration.
    key : what they are made of, by which a table that was made before is found; None: it is made anew.
    """

    spectra: Spectra = field(compare=False)
    orders: tuple[int, ...]
    decay: float
    smallest: float
    path: Path
    key: tuple[Any, ...] | None = None


class RadialTable(NamedTuple):
    """Piecewise polynomials: coefficients [panel, power, table] of t in (-1, 1) between `edges`; 0 beyond the last.

    A tuple, which compiled code takes whole.
    """

    edges: FloatArray
    coefficients: FloatArray
    decay: float
    wavenumber: float = 0.0  # where a window left ripples: theirs,
    width: float = 0.0  # and they fall off like exp(-(width r)^2)


def surface_kernels(body: Body, load: Load) -> Kernels:
    """Normal surface displacement less that of a half-space of the outermost material; signs: see `layered_cells`."""
    row = waves.NORMAL_W if load is Load.NORMAL else waves.TANGENTIAL_W
    scale = 0.5 / body.surface_material.shear_modulus

    def spectra(q: NDArray) -> NDArray:
        return frequency_response.wave_functions(q, body, 0.0, remainder=True, load=load)[row : row + 1] * (scale / q)

    return _kernels(
        spectra, (0 if load is Load.NORMAL else 1,), frequency_response.features(body, 0.0), ("normal", body, load)
    )


def in_plane_kernels(body: Body) -> Kernels:
    """In-plane surface displacements less those of a half-space of the outermost material, see `layered_cells`."""
    scale = 0.25 / body.surface_material.shear_modulus

    def spectra(q: NDArray) -> NDArray:
        f = frequency_response.wave_functions(q, body, 0.0, remainder=True, load=Load.TANGENTIAL)
        along, across = -f[waves.TANGENTIAL_U], f[waves.ACROSS_U]
        return np.stack([along + across, along - across]) * (scale / q)

    return _kernels(spectra, (0, 2), frequency_response.features(body, 0.0), ("in plane", body))


def stress_kernels(body: Body, depth: float, load: Load) -> Kernels:
    """Six stresses: in the outermost layer less those of a half-space of its material, below it whole."""
    found = frequency_response.features(body, depth)

    def normal(q: NDArray) -> NDArray:
        f = frequency_response.wave_functions(q, body, depth, remainder=found.remainder, load=load)
        ee, tt = f[waves.NORMAL_EE], f[waves.NORMAL_TT]
        return np.stack([f[waves.NORMAL_SIGMA], f[waves.NORMAL_TAU], 0.5 * (ee + tt), 0.5 * (ee - tt)])

    def tangential(q: NDArray) -> NDArray:
        f = frequency_response.wave_functions(q, body, depth, remainder=found.remainder, load=load)
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
        return _kernels(normal, (0, 1, 0, 2), found, key)
    return _kernels(tangential, (1, 0, 2, 1, 1, 3), found, key)


def _kernels(
    spectra: Spectra, orders: tuple[int, ...], found: frequency_response.Features, key: tuple[Any, ...]
) -> Kernels:
    return Kernels(spectra, orders, found.decay, found.smallest, path_for(found.angle), key)


def radial_table(kernels: Kernels, r_max: float, *, line: bool = False) -> RadialTable:
    """Table of the Hankel transforms for 0 <= r <= r_max.

    `line`: of 1/pi integral of f cos(q r) dq (order 0) or of sin (order 1) instead.
    """
    panels = len(kernels.path.doubling(kernels.decay / 8, max(r_max, kernels.decay / 8)))
    return (_made if kernels.key is None else _kept)(kernels, panels, line)


def _made(kernels: Kernels, panels: int, line: bool) -> RadialTable:
    """Compute a table of so many panels: a whole number of doublings, so that grids of similar size share it."""
    cuts = kernels.path.cuts
    edges = np.concatenate([[0.0], kernels.decay / 8 * 2.0 ** (np.arange(panels) / cuts)])
    nodes = [panel_nodes(a, b) for a, b in itertools.pairwise(edges)]
    values = _near(kernels, nodes[0], line)[None]
    if panels > 1:
        values = np.concatenate([values, _far(kernels, np.array(nodes[1:]), line)])
    return RadialTable(edges, fit(values), kernels.decay)


_kept = lru_cache(maxsize=64)(_made)
"""Cached tables, some 40 kB each: coarser grids of a contact are as long and use the same table."""


def panel_nodes(a: float, b: float) -> FloatArray:
    """Return the sample points of a panel of r."""
    return 0.5 * (a + b) + 0.5 * (b - a) * _CHEBYSHEV


_CHEBYSHEV = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
_TO_CHEBYSHEV = (np.where(np.arange(NODES) == 0, 1.0, 2.0) / NODES)[:, None] * np.cos(
    np.outer(np.arange(NODES), np.arccos(_CHEBYSHEV))
)
_TO_POWERS = np.zeros((NODES, NODES))
for _k in range(NODES):
    _TO_POWERS[: _k + 1, _k] = np.polynomial.chebyshev.cheb2poly(np.eye(NODES)[_k])[: _k + 1]


def fit(values: FloatArray) -> FloatArray:
    """Values [panel, node, table] -> coefficients [panel, power, table].

    In two steps: the entries of `_TO_POWERS` reach 1e5 and must meet the small coefficients, not the values.
    """
    chebyshev = np.einsum("kn,pnt->pkt", _TO_CHEBYSHEV, values)
    return np.ascontiguousarray(np.einsum("jk,pkt->pjt", _TO_POWERS, chebyshev))


def gauss_rule(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss points and weights on consecutive panels."""
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    return (middle[:, None] + half[:, None] * _ABSCISSAE).ravel(), (half[:, None] * _GAUSS).ravel()


def graded(smallest: float, end: float) -> FloatArray:
    """Edges from 0 to `end`, each panel as wide as its distance from 0, down to about `smallest`."""
    return _STEEP.graded(smallest, end)


def apply(matrix: NDArray, vector: NDArray) -> NDArray:
    """matrix @ vector without BLAS, whose sums depend on the number of threads."""
    product: NDArray = np.einsum("ij,j->i", matrix, vector)
    return product


def _wave(order: int, s: FloatArray, line: bool) -> FloatArray:
    """Return the wave that multiplies the spectrum on the real axis, over q (and over r^2, or r for a line)."""
    if line:
        return (np.sin(s) if order else np.cos(s)) / np.pi
    values: FloatArray = special.jv(order, s) * s / (2 * np.pi)
    return values


def _near(kernels: Kernels, r: FloatArray, line: bool) -> FloatArray:
    """Transforms at r <= d/8, all on the real axis: (nodes, tables)."""
    edges = kernels.path.graded(min(kernels.smallest, 1 / kernels.decay), END / kernels.decay)
    q, weights = gauss_rule(edges)
    f = kernels.spectra(q) * weights
    scale = (1 / r if not line else np.ones_like(r))[:, None]
    waves = {order: _wave(order, np.outer(r, q), line) * scale for order in set(kernels.orders)}
    return np.stack([apply(waves[order], f[table]) for table, order in enumerate(kernels.orders)], axis=1)


class _Piece(NamedTuple):
    """Part of a path in s = q r: nodes (panels, 14), and for every order what is integrated there with the spectrum."""

    nodes: NDArray[Any]
    waves: tuple[NDArray[Any], ...]


@lru_cache(maxsize=8)
def _pieces(path: Path, line: bool, panels: int) -> tuple[_Piece, _Piece, _Piece]:
    """So many panels of the real axis from TURN towards 0, the arc, and the ray, whose panels are half as wide."""
    falling = TURN * 2.0 ** (-np.arange(panels + 1) / path.cuts)
    s, weights = gauss_rule(falling[::-1])
    axis = _Piece(s, tuple(_wave(order, s, line) * weights for order in range(2 if line else 4)))
    turn, angles = gauss_rule(np.array([0.0, path.angle]))
    doublings = np.log2(END / np.sin(path.angle) / TURN)
    rising = TURN * 2.0 ** (np.arange(int(np.ceil(2 * path.cuts * doublings)) + 1) / (2 * path.cuts))
    along, steps = gauss_rule(rising)
    bent = np.asarray(TURN * np.exp(1j * turn), dtype=np.complex128)
    arc = _turned(bent, 1j * bent * angles, line)
    ray = _turned(along * path.slope, path.slope * steps, line)

    def rows(piece: _Piece, order: int) -> _Piece:
        def split(values: NDArray[Any]) -> NDArray[Any]:
            return values.reshape(-1, _GAUSS.size)[::order]

        return _Piece(split(piece.nodes), tuple(split(wave) for wave in piece.waves))

    return rows(axis, -1), rows(arc, 1), rows(ray, 1)


def _turned(s: NDArray[Any], weights: NDArray[Any], line: bool) -> _Piece:
    """Off the real axis, where the Hankel function or exp(i s) stands for the wave."""
    if line:
        wave = np.exp(1j * s) * weights / np.pi
        return _Piece(s, (wave, -1j * wave))
    return _Piece(s, tuple(special.hankel1(n, s) * s * weights / (2 * np.pi) for n in range(4)))


def _far(kernels: Kernels, r: FloatArray, line: bool) -> FloatArray:
    """Transforms at r (panels, nodes) from d/8 on, panels growing by 2^(1/cuts): (panels, nodes, tables)."""
    (panels, _), cuts, first = r.shape, kernels.path.cuts, r[0][:, None]
    # to the same smallest q for every r, and for the largest r to q r = 1
    down = int(np.ceil(cuts * np.log2(TURN / (kernels.smallest * r[0].min()))))
    axis, arc, ray = _pieces(kernels.path, line, max(down, panels + 2 * cuts))
    rest, weights = gauss_rule(np.array([0.0, TURN * 2.0 ** (-len(axis.nodes) / cuts)]))
    f_axis = _spectrum(kernels, axis.nodes[:, None] / first)  # (tables, panels of q, r, 14)
    f_rest = _spectrum(kernels, rest / first)
    q_ray, before = ray.nodes[:, None] / first, 2.0 ** (np.arange(2 - 2 * panels, 0) / (2 * cuts))
    f_ray = _spectrum(kernels, np.concatenate([before[:, None, None] * q_ray[0], q_ray]))
    out = np.empty((*r.shape, len(kernels.orders)))
    for k in range(panels):  # r grown by 2^(k/cuts): panels of q from the k-th on; of the ray, 2 k before
        f_arc = _spectrum(kernels, arc.nodes[:, None] / r[k][:, None])
        here, start, grown = len(axis.nodes) - k, 2 * (panels - 1 - k), 2.0 ** (k / cuts)
        for table, order in enumerate(kernels.orders):
            total = np.einsum("prs,ps->r", f_axis[table, k:], axis.waves[order][:here])
            total += np.einsum("rs,s->r", f_rest[table], _wave(order, grown * rest, line) * (grown * weights))
            total += np.einsum("prs,ps->r", f_arc[table], arc.waves[order]).real
            total += np.einsum("prs,ps->r", f_ray[table, start : start + len(ray.nodes)], ray.waves[order]).real
            out[k, :, table] = total / (r[k] if line else r[k] ** 2)
    return out


def _spectrum(kernels: Kernels, q: NDArray[Any]) -> NDArray[Any]:
    """(tables, *q.shape)."""
    return kernels.spectra(np.ascontiguousarray(q).ravel()).reshape(-1, *q.shape)


@compiled
def panel_of(r: float, edges: FloatArray) -> int:
    """Number of the panel that r lies in, the last one beyond them."""
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
    """Values of every table at r into `out` (tables,)."""
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


def table_values(table: RadialTable, r: FloatArray) -> FloatArray:
    """Values at every r: (*r.shape, tables)."""
    out = np.empty((r.size, table.coefficients.shape[2]))
    _evaluate_all(np.ascontiguousarray(r).ravel(), table.edges, table.coefficients, out)
    return out.reshape(*r.shape, -1)
