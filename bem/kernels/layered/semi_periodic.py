"""Remainder of the influence coefficients of a layered body on a grid with one periodic axis, by Ewald's splitting.

The spectrum is split at q0 = 48 / period by the smooth window chi(q) = erfc((q - q0) / w) / 2, w = 8 / period (Ewald
1921 splits a Coulomb sum in this way, with a Gaussian window):

1. Short-range part f (1 - chi), of large wavenumbers (`_short_range_table`). Near q = 0, where 1 - chi is below
   round-off, it is smooth, so its Hankel transform decays like exp(-(r w / 2)^2), below round-off beyond 1.5 periods.
   The loaded cell and its two neighbouring images are integrated as in `cells`. At an offset of half a period a further
   image, 1.5 periods away, is nearer by half a cell; it is left out, because its contribution is below 1e-14 of the
   largest value even with two cells in a period. The short-range part is below round-off altogether for a decay length
   of 1.6 periods and more.
2. Long-range part f chi, of small wavenumbers (`_long_range`). It ends at 96 / period: a sum over at most 16
   wavenumbers along the period, each integrated over the wavenumber along the free axis, with the exact average over a
   cell.
3. Mean along the period (`_add_long_wave_limits`). The remainder of a displacement behaves like limit / k at small k.
   The part limit exp(-k s) / k, s half a period, is left out of the integrals and added in closed form, with the datum.
4. Cells more than 8 periods away along the free axis (`_line_load_cells`) see a line load: the mean along the period
   alone, from a table of a Fourier integral (`hankel`).

The cost grows with the logarithm of period / thickness only: panels of r and pieces of cells are graded towards the
thickness. Tables are cached by body, load, depth and period. The error is round-off of the largest value.

Datum of the displacement under pressure, as in `bem.kernels.semi_periodic`: its mean along the period is zero at one
length of the grid's free axis from a line load, for the half-space of the layer's material and for the remainder. So a
vanishing layer has the coefficients of the substrate, a very thick one those of its own material, and identical
materials change nothing. Another reference length adds a constant to the displacement, proportional to the load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bem.grid import FloatArray, Grid
from bem.kernels.layered import frequency_response, waves
from bem.kernels.layered.cells import IN_PLANE, STRESS_KIND, SURFACE_KIND, add_cells
from bem.kernels.layered.hankel import (
    CUTOFF_EXPONENT,
    PANEL_NODES,
    TURN,
    HankelSpectra,
    Path,
    RadialTable,
    SpectrumFunction,
    evaluate_table,
    gauss_rule,
    in_plane_spectra,
    interpolate_panels,
    matrix_product,
    panel_nodes,
    radial_table,
    stress_spectra,
    surface_spectra,
)
from bem.kernels.loads import IN_PLANE_PARITY, STRESS_PARITY, SURFACE_PARITY, Load, Parities, clear_odd_offsets
from bem.materials import Body

ComplexArray = NDArray[np.complex128]
ResponseFunction = Callable[[FloatArray, FloatArray], FloatArray]
"""Frequency response: (kx, ky) [rad/m], broadcast -> (components, ...)."""

# wavenumbers in units of 1 / period, lengths in periods
_SPLIT, _SPLIT_WIDTH = 48.0, 8.0
"""Centre and width of the window chi."""
_SPLIT_END = _SPLIT + 6 * _SPLIT_WIDTH
"""Wavenumber from which chi is below round-off: erfc(6) = 2e-17."""
_SHORT_RANGE = 1.5
"""Distance from which the short-range part is below round-off."""
_PANEL_WIDTH = 0.125
"""Width of the outer panels of r."""
_NEGLIGIBLE_DECAY = 1.6
"""Decay length from which the whole short-range part is below round-off."""
_LINE_LOAD_DISTANCE = 8.0
"""Distance along the free axis from which only the mean along the period is left: exp(-2 pi 8) = 1e-22."""

_CELL_NODES, _CELL_WEIGHTS = np.polynomial.legendre.leggauss(16)


def surface_remainder(grid: Grid, body: Body, load: Load) -> FloatArray:
    """Compute the remainder of the normal surface displacement: (nx, ny) [m/Pa]; see `coefficients`."""
    tangential = load is Load.TANGENTIAL
    parities = (SURFACE_PARITY[load],)
    free, along = _axes(grid)
    half_period = 0.5 * grid.lengths[along]
    spectra = surface_spectra(body, load)
    limit = np.zeros(1) if tangential else _long_wave_limits(body)[:1]

    def response(kx: FloatArray, ky: FloatArray) -> FloatArray:
        return frequency_response.surface_response(kx, ky, body, load, remainder=True)[None]

    def mean_spectrum(k: NDArray) -> NDArray:
        if tangential and free == 1:
            return np.zeros((1, k.size), dtype=k.dtype)
        return spectra.values(k) - limit[:, None] * np.exp(-half_period * k) / k

    remainder = _Remainder(spectra, SURFACE_KIND[load], parities, response, mean_spectrum, limit)
    half = _half_period(grid, remainder)
    _add_long_wave_limits(half, grid, remainder)
    return _complete_by_parity(half, grid, parities)[0]


def in_plane_remainder(grid: Grid, body: Body) -> FloatArray:
    """Compute the remainder of the in-plane displacements: (3, nx, ny) [m/Pa]; see `coefficients`."""
    free, along = _axes(grid)
    half_period = 0.5 * grid.lengths[along]
    in_plane, across = _long_wave_limits(body)
    limit = np.zeros(3)
    limit[free], limit[along] = in_plane, across

    def response(kx: FloatArray, ky: FloatArray) -> FloatArray:
        return frequency_response.in_plane_response(kx, ky, body, remainder=True)

    def mean_spectrum(k: NDArray) -> NDArray:
        even, turned = spectra.values(k)
        out = np.zeros((3, k.size), dtype=k.dtype)
        out[free], out[along] = even + turned, even - turned
        return out - limit[:, None] * np.exp(-half_period * k) / k

    spectra = in_plane_spectra(body)
    remainder = _Remainder(spectra, IN_PLANE, IN_PLANE_PARITY, response, mean_spectrum, limit)
    half = _half_period(grid, remainder)
    _add_long_wave_limits(half, grid, remainder)
    return _complete_by_parity(half, grid, IN_PLANE_PARITY)


def _long_wave_limits(body: Body) -> FloatArray:
    """Return the limits of q times the remainder for q -> 0 [1/Pa], in plane and in anti-plane strain.

    Long waves see the half-space at the bottom in place of the outermost material: the limits are their difference.
    """
    one, two = body.surface_material, body.material
    plane = (1 - two.poissons_ratio) / two.shear_modulus - (1 - one.poissons_ratio) / one.shear_modulus
    return np.array([plane, 1 / two.shear_modulus - 1 / one.shear_modulus])


def _add_long_wave_limits(half: FloatArray, grid: Grid, remainder: _Remainder) -> None:
    """Add the part of the mean that is in closed form, and its datum, to the components that have a limit."""
    free, along = _axes(grid)
    height, reference = 0.5 * grid.lengths[along], grid.lengths[free]
    limited = [component for component in range(len(half)) if remainder.limit[component]]
    if not limited:
        return
    logarithm = _mean_log(grid.shape[free], grid.spacing[free], height, reference)
    at_reference = evaluate_table(_line_load_table(grid, remainder, reference), np.array([reference]))[0]
    for component in limited:
        limit = remainder.limit[component]
        line = -limit / np.pi * logarithm
        line -= at_reference[component]
        line += limit / np.pi * np.log(np.hypot(reference, height) / reference)
        line *= grid.cell_area / grid.lengths[along]
        half[component] += line[:, None] if free == 0 else line


def stress_remainder(grid: Grid, body: Body, depth: float, load: Load) -> FloatArray:
    """Compute the six stresses at `depth` [m]: the remainder in the outermost layer, else the whole.

    (6, nx, ny) [Pa/Pa]; see `coefficients`.
    """
    tangential = load is Load.TANGENTIAL
    parities = STRESS_PARITY[load]
    free, _ = _axes(grid)
    inside = body.medium_at(depth) == 0

    def response(kx: FloatArray, ky: FloatArray) -> FloatArray:
        return frequency_response.stress_response(kx, ky, body, depth, load, remainder=inside)

    def mean_spectrum(k: NDArray) -> NDArray:
        f = frequency_response.wave_frame_response(k, body, depth, remainder=inside, load=load)
        out = np.zeros((6, k.size), dtype=k.dtype)
        if tangential and free == 1:
            out[4], out[5] = f[waves.ACROSS_TZ], f[waves.ACROSS_ET]
            return out
        first = waves.TANGENTIAL_U if tangential else waves.NORMAL_U
        tau, sigma, ee, tt = f[first + 2 : first + 6]
        out[free], out[1 - free], out[2], out[4 - free] = ee, tt, sigma, -tau if tangential else tau
        return out

    remainder = _Remainder(
        stress_spectra(body, depth, load), STRESS_KIND[load], parities, response, mean_spectrum, np.zeros(6)
    )
    return _complete_by_parity(_half_period(grid, remainder), grid, parities)


def _mean_log(cells: int, side: float, height: float, reference: float) -> FloatArray:
    """Return the mean of ln(hypot(x, height) / reference) over each of the cells 0, 1, ...: (cells,)."""
    offsets = np.arange(cells)
    ends = (offsets[:, None] + np.array([-0.5, 0.5])) * (side / height)
    primitive = ends * (np.log(np.hypot(ends, 1.0) * (height / reference)) - 1) + np.arctan(ends)
    closed = np.diff(primitive, axis=1)[:, 0] * (height / side)
    at = np.hypot((offsets[:, None] + 0.5 * _CELL_NODES) * side, height) / reference
    # the closed form cancels far away, where the rule errs by (2 * 8)^-32
    return np.where(offsets < 8, closed, matrix_product(np.log(at), 0.5 * _CELL_WEIGHTS))


@dataclass(frozen=True)
class _Remainder:
    """Remainder of one response, as all parts of the sum need it.

    Attributes
    ----------
    spectra : spectra of its Hankel transforms.
    kind : kind of response, see `cells`.
    parities : parity of each component.
    response : frequency response, see `frequency_response`.
    mean_spectrum : spectrum of the mean along the period, at complex k along the free axis: (components, n), less
        limit exp(-k s) / k, s half a period.
    limit : (components,), limit of k times the spectrum of the mean for k -> 0; zero for all but displacements.
    """

    spectra: HankelSpectra
    kind: int
    parities: Parities
    response: ResponseFunction
    mean_spectrum: SpectrumFunction
    limit: FloatArray


def _axes(grid: Grid) -> tuple[int, int]:
    """Return the numbers of the free axis and of the periodic axis."""
    return (1, 0) if grid.periodic[0] else (0, 1)


def _half_period(grid: Grid, remainder: _Remainder) -> FloatArray:
    """Compute the coefficients at offsets up to half a period along the periodic axis: (components, ...)."""
    free, along = _axes(grid)
    period, side = grid.lengths[along], grid.spacing[free]
    cells = grid.shape[along] // 2 + 1
    near = min(grid.shape[free], int(np.ceil(_LINE_LOAD_DISTANCE * period / side + 0.5)))
    out = _long_range(grid, near, cells, remainder)
    if remainder.spectra.decay < _NEGLIGIBLE_DECAY * period:
        spectra = remainder.spectra
        table = (_short_range_table if spectra.key is None else _cached_short_range_table)(spectra, period)
        add_cells(out, grid, table, remainder.kind, (1, 0) if along == 0 else (0, 1))
    if near < grid.shape[free]:
        line = np.broadcast_to(
            _line_load_cells(grid, near, remainder)[..., None], (len(out), grid.shape[free] - near, cells)
        )
        out = np.concatenate([out, line if free == 0 else line.swapaxes(1, 2)], axis=1 + free)
    return out


def _line_load_cells(grid: Grid, near: int, remainder: _Remainder) -> FloatArray:
    """Compute the mean along the period of the cells from `near` on along the free axis: (components, cells)."""
    free, along = _axes(grid)
    side = grid.spacing[free]
    signs = [1.0 if parity == (1, 1) else -1.0 for parity in remainder.parities]
    table = _line_load_table(grid, remainder, (grid.shape[free] + 1) * side)
    # the origin is two half sides away or more: the rule errs by (2 + sqrt 3)^-32
    x = np.arange(near, grid.shape[free])[:, None] * side + 0.5 * side * _CELL_NODES
    means = np.einsum("xgt,g->tx", evaluate_table(table, x), 0.5 * _CELL_WEIGHTS)
    for component, parity in enumerate(remainder.parities):
        if parity[along] < 0:
            means[component] = 0.0
    return means * (np.array(signs)[:, None] * (grid.cell_area / grid.lengths[along]))


def _complete_by_parity(half: FloatArray, grid: Grid, parities: Parities) -> FloatArray:
    """Return the coefficients of the whole period, (components, nx, ny), from the first half by parity."""
    _, along = _axes(grid)
    cells = grid.shape[along]
    out = np.empty((len(parities), *grid.shape))
    for component, parity in enumerate(parities):
        source, target = np.moveaxis(half[component], along, 0), np.moveaxis(out[component], along, 0)
        target[: cells // 2 + 1] = source
        target[cells // 2 + 1 :] = parity[along] * source[1 : (cells + 1) // 2][::-1]
        if parity[along] < 0 and cells % 2 == 0:
            target[cells // 2] = 0.0
    return clear_odd_offsets(out, parities)


def _line_load_table(grid: Grid, remainder: _Remainder, reach: float) -> RadialTable:
    """Return the table of the mean along the period, less the closed form, over distances up to `reach` [m]."""
    free, along = _axes(grid)
    orders = tuple(0 if parity[free] > 0 else 1 for parity in remainder.parities)
    spectra, period = remainder.spectra, grid.lengths[along]
    decay = min(spectra.decay, 0.5 * period) if remainder.limit.any() else spectra.decay
    key = None if spectra.key is None else (*spectra.key, "mean along the period", free, period)
    mean = HankelSpectra(remainder.mean_spectrum, orders, decay, spectra.smallest, spectra.path, key)
    return radial_table(mean, reach, fourier=True)


def _long_range(grid: Grid, near: int, cells: int, remainder: _Remainder) -> FloatArray:
    """Compute the long-range part of the first `near` cells along the free axis, `cells` along the period.

    (components, near, cells), or transposed where the free axis is y. The average over a cell is a product of sinc.
    """
    free, along = _axes(grid)
    period = grid.lengths[along]
    width = min(4.0 / period, 6.0 / (near * grid.spacing[free]))
    inner = remainder.spectra.path.graded(min(remainder.spectra.smallest, width), width)
    last = _SPLIT_END / period
    k, weights = gauss_rule(np.concatenate([inner, np.linspace(width, last, int(np.ceil(last / width)) + 1)[1:]]))
    modes = 2 * np.pi / period * np.arange(int(_SPLIT_END / (2 * np.pi)) + 1, dtype=np.float64)
    along_free: FloatArray = k[:, None]
    along_period: FloatArray = modes[None, :]
    kx, ky = (along_free, along_period) if free == 0 else (along_period, along_free)
    spectrum = remainder.response(kx, ky)
    spectrum *= 0.5 * special.erfc((np.hypot(kx, ky) * period - _SPLIT) / _SPLIT_WIDTH)
    spectrum *= np.sinc(kx * grid.spacing[0] / (2 * np.pi)) * np.sinc(ky * grid.spacing[1] / (2 * np.pi))
    average = np.sinc(k * grid.spacing[free] / (2 * np.pi))
    for component, limit in enumerate(remainder.limit):
        if limit:
            spectrum[component, :, 0] -= limit * np.exp(-0.5 * period * k) / k * average
    spectrum *= weights[:, None] * np.where(modes > 0, 2.0, 1.0) * (grid.cell_area / (np.pi * period))
    phase_free = np.arange(near)[:, None] * grid.spacing[free] * k
    phase_along = np.arange(cells)[:, None] * grid.spacing[along] * modes
    waves_free = {1: np.cos(phase_free), -1: np.sin(phase_free)}
    waves_along = {1: np.cos(phase_along), -1: np.sin(phase_along)}
    out = np.empty((len(remainder.parities), near, cells))
    for component, parity in enumerate(remainder.parities):
        sign = 1.0 if parity == (1, 1) else -1.0  # i from an odd spectrum, i from each sine
        # without BLAS, see `apply`
        modes_at = np.einsum("xk,km->xm", waves_free[parity[free]], sign * spectrum[component])
        out[component] = np.einsum("xm,ym->xy", modes_at, waves_along[parity[along]])
    return out if free == 0 else np.ascontiguousarray(out.swapaxes(1, 2))


@dataclass(frozen=True)
class _BesselPanel:
    """Bessel functions times quadrature weights for one panel of r, in units of the period.

    Attributes
    ----------
    real_q : (points,), wavenumbers on the real axis, common to all nodes of r.
    real : for each order (nodes, points), J_n and the window 1 - chi.
    ray_q : (nodes, points), wavenumbers on the ray of each node.
    ray : for each order (nodes, points), H_n (1 - chi is 1 there).
    """

    real_q: FloatArray
    real: tuple[FloatArray, ...]
    ray_q: ComplexArray
    ray: tuple[ComplexArray, ...]


@lru_cache(maxsize=96)
def _bessel_panel(a: float, b: float, path: Path) -> _BesselPanel:
    """Return the Bessel functions for the panel (a, b) of r; cached, because they depend on no body."""
    r = panel_nodes(a, b)[:, None]
    # real axis to where the window ends and q r has reached TURN; near the origin until exp(-q d) ends, d >= 8 b
    last = CUTOFF_EXPONENT / (8 * b) if a == 0 else TURN / b
    edges = np.linspace(0.0, _SPLIT_END, 25)
    if last > _SPLIT_END:
        panels = path.cuts * int(np.ceil(np.log2(last / _SPLIT_END)))
        edges = np.concatenate([edges, np.geomspace(_SPLIT_END, last, panels + 1)[1:]])
    q, weights = gauss_rule(edges)
    window = 0.5 * special.erfc((_SPLIT - q) / _SPLIT_WIDTH)
    real = tuple(special.jv(order, r * q) * (q * weights * window / (2 * np.pi)) for order in range(4))
    if a == 0:
        return _BesselPanel(q, real, np.zeros((PANEL_NODES, 0), dtype=np.complex128), ())
    t, weights = gauss_rule(np.array(path.ray_edges))
    ray_q: ComplexArray = np.asarray(max(last, _SPLIT_END) + path.slope * t / r, dtype=np.complex128)
    s = ray_q * r
    hankel = [special.hankel1(0, s), special.hankel1(1, s)]
    for order in (1, 2):
        hankel.append(2 * order / s * hankel[order] - hankel[order - 1])
    factor = ray_q * path.slope * weights / r / (2 * np.pi)
    return _BesselPanel(q, real, ray_q, tuple(h * factor for h in hankel))


def _short_range_table(spectra: HankelSpectra, period: float) -> RadialTable:
    """Return the Hankel transforms of the short-range part over 0 <= r <= 1.5 periods."""
    decay = spectra.decay / period
    inner = spectra.path.graded(decay / 8, _PANEL_WIDTH)
    edges = np.concatenate([inner, _PANEL_WIDTH * np.arange(2, int(_SHORT_RANGE / _PANEL_WIDTH) + 1)])
    values = np.empty((edges.size - 1, PANEL_NODES, len(spectra.orders)))
    for number in range(edges.size - 1):
        panel = _bessel_panel(float(edges[number]), float(edges[number + 1]), spectra.path)
        f = spectra.values(panel.real_q / period)
        f_ray = spectra.values(panel.ray_q.ravel() / period).reshape(-1, *panel.ray_q.shape) if panel.ray else None
        for table, order in enumerate(spectra.orders):
            values[number, :, table] = matrix_product(panel.real[order], f[table])
            if f_ray is not None:
                values[number, :, table] += np.einsum("np,np->n", f_ray[table], panel.ray[order]).real
    return RadialTable(
        edges * period,
        interpolate_panels(values) / period**2,
        spectra.decay,
        _SPLIT / period,
        _SPLIT_WIDTH / (2 * period),
    )


_cached_short_range_table = lru_cache(maxsize=16)(_short_range_table)
"""`_short_range_table` with a cache: coarser grids of a contact have the same period and need the same table."""
