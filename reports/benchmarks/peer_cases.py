"""What is timed beside other codes besides single contacts: a load-area curve, and stresses below a ball's pressure.

The ball's pressure is known, so are its stresses: alone (Hamilton), and in a square array of equal balls, whose Fourier
series is summed here from the ball's transform and the stresses of a pressure wave, by nothing that solvers use.
Verified in tests/reports/test_beside_peers.py.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from bem.benchmarks.cases import case_of_cells
from bem.benchmarks.contact_cases import (
    FREE,
    PERIODIC,
    POISSON,
    UNIT,
    common_residual,
    deformed_gap,
    rough,
    solve_curve,
)
from bem.benchmarks.measure import Outcome, Timed
from bem.benchmarks.physical_cases import rough_surface, size_and_digits
from bem.contact import ContactSolution
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid

RADIUS, DEEPEST = 0.25, 0.5
"""Of the loaded circle and of the depths, on a side of 1; the largest pressure is 1."""
AXES = {"periodic": PERIODIC, "free": FREE}
_SERIES = 256
"""Points a side that the series is summed on: e^(-kz) is 1e-21 for the last wave at the shallowest depth judged."""


def peer_tolerance(code: float) -> Timed:
    """Return the periodic rough contact of a size and tolerance given as cells + digits / 100."""
    n, digits = size_and_digits(code)
    return rough(n, tolerance=10.0**-digits)


def load_area(code: float) -> Timed:
    """`load_area_curve` on the surface without short waves; cells + digits / 100. What each load gives is kept."""
    n, digits = size_and_digits(code)
    gap = rough_surface(n)
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC), UNIT)

    def judge(curve: list[ContactSolution]) -> Outcome:
        values: dict[str, float] = {"converged": float(all(one.status == "converged" for one in curve))}
        for k, one in enumerate(curve):
            values[f"area_{k}"] = one.contact_area
            deformed = deformed_gap(one.pressure, gap, operator)
            values[f"counted_{k}"], values[f"gap_{k}"] = area_and_gap(one.pressure, deformed)
        residual = max(common_residual(one.pressure, gap, operator)[0] for one in curve)
        counts = {"convolutions_a_load": sum(one.convolutions for one in curve) / len(curve)}
        return Outcome({"residual": residual}, counts, values)

    return Timed(lambda: solve_curve(gap, operator, tolerance=10.0**-digits), judge, cells=n**2)


def area_and_gap(pressure: FloatArray, deformed: FloatArray) -> tuple[float, float]:
    """Share of the cells in contact, and the mean gap."""
    return float((pressure > 0).mean()), float(np.maximum(deformed, 0.0).mean())


def ball_depths(cells: int, axes: str) -> FloatArray:
    """cells / 8 equal steps down: tamaas begins at the surface, slippy has no stresses there."""
    count = cells // 8
    if axes == "periodic":
        return np.linspace(0.0, DEEPEST, count)
    return np.linspace(DEEPEST / count, DEEPEST, count)


def ball_pressure(cells: int) -> FloatArray:
    """At points 1 / cells apart, one of which is the middle."""
    x = np.arange(cells) / cells - 0.5
    return np.sqrt(np.maximum(1 - (x[:, None] ** 2 + x**2) / RADIUS**2, 0.0))


def ball_grid(cells: int, axes: str) -> Grid:
    """Of side 1."""
    return Grid((cells, cells), (1 / cells, 1 / cells), periodic=AXES[axes])


def _forget() -> None:
    """Kernels that are kept."""
    from bem.stress import set_stress_memory

    set_stress_memory(0)
    set_stress_memory(1 << 29)


def ball_stress(cells: float, *, axes: str, kept: bool) -> Timed:
    """Six stresses below the ball; kernels made anew, or kept."""
    from bem.stress import subsurface_stress

    n = int(cells)
    grid, pressure, depths = ball_grid(n, axes), ball_pressure(n), ball_depths(n, axes)

    def judge(found: FloatArray) -> Outcome:
        return Outcome({"stress_error": exact_error(found, n, axes)})

    return Timed(lambda: subsurface_stress(pressure, grid, UNIT, depths), judge, None if kept else _forget)


def ball_mises(cells: float, *, axes: str) -> Timed:
    """The highest von Mises stress below the ball, kernels made anew; the error is relative."""
    from bem.stress import summarise_stress

    n = int(cells)
    grid, pressure, depths = ball_grid(n, axes), ball_pressure(n), ball_depths(n, axes)

    def solve() -> float:
        return summarise_stress(pressure, grid, UNIT, depths).max_von_mises

    return Timed(solve, lambda found: Outcome({"mises_error": abs(found / highest_mises(axes) - 1)}), _forget)


def exact_error(stress: FloatArray, cells: int, axes: str) -> float:
    """The largest error of stresses (6, nz, n, n) from a quarter of the radius down, over the largest pressure: above,
    one sees the steps of the pressure at the edge."""
    errors = [
        float(np.abs(stress[:, k] - exact_stress(cells, float(depth), axes)).max())
        for k, depth in enumerate(ball_depths(cells, axes))
        if depth >= RADIUS / 4
    ]
    return max(errors)


def exact_stress(cells: int, depth: float, axes: str) -> FloatArray:
    """(6, n, n) at the points of `ball_pressure`, xx yy zz yz xz xy; depth >= RADIUS / 4 where periodic."""
    if axes == "free":
        from bem.reference_solutions.hamilton import sphere_stress

        x = np.arange(cells) / cells - 0.5
        return sphere_stress(
            x[:, None], x[None, :], depth, contact_radius=RADIUS, maximum_pressure=1.0, poissons_ratio=POISSON
        )
    n = max(_SERIES, cells)
    kx, ky, share = _waves(n)
    fields = np.fft.ifft2(_wave_stress(kx, ky, depth) * share).real * n**2
    shifted: FloatArray = np.roll(fields, (n // 2, n // 2), axis=(1, 2))
    return shifted[:, :: n // cells, :: n // cells]


@functools.cache
def _waves(n: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave numbers along x and y, and the coefficient of each in the pressure of balls one apart: the ball's transform
    2 pi a^2 (sin ka - ka cos ka) / (ka)^3."""
    k = 2 * np.pi * np.fft.fftfreq(n, 1 / n)
    kx, ky = np.broadcast_arrays(k[:, None], k[None, :])
    ka = np.hypot(kx, ky) * RADIUS
    safe = np.where(ka > 0, ka, 1.0)
    share = np.where(ka > 0, (np.sin(safe) - safe * np.cos(safe)) / safe**3, 1 / 3)
    return kx, ky, 2 * np.pi * RADIUS**2 * share


def _wave_stress(kx: FloatArray, ky: FloatArray, depth: float) -> NDArray[np.complex128]:
    """Stresses at a depth of the pressure exp(i(kx x + ky y)) on a half-space: zz = -(1 + kz) e^(-kz), xz = i kx z
    e^(-kz), xx = -(kx^2 (1 - kz) + 2 nu ky^2) e^(-kz) / k^2, xy = -kx ky (1 - 2 nu - kz) e^(-kz) / k^2. The mean has no
    strain along the surface."""
    k = np.hypot(kx, ky)
    square = np.where(k > 0, k, 1.0) ** 2
    kz, fall = k * depth, np.exp(-k * depth)
    xx = -(kx**2 * (1 - kz) + 2 * POISSON * ky**2) * fall / square
    yy = -(ky**2 * (1 - kz) + 2 * POISSON * kx**2) * fall / square
    xy = -kx * ky * (1 - 2 * POISSON - kz) * fall / square
    mean = k == 0
    xx, yy = (np.where(mean, -POISSON / (1 - POISSON), part) for part in (xx, yy))
    return np.stack([xx, yy, -(1 + kz) * fall, 1j * ky * depth * fall, 1j * kx * depth * fall, xy])


@functools.cache
def highest_mises(axes: str) -> float:
    """Below the middle, where xx = yy and nothing shears: |zz - xx|, over the largest pressure."""
    from scipy.optimize import minimize_scalar

    if axes == "free":

        def below(depth: float) -> float:
            stress = exact_stress(2, depth, axes)[:, 1, 1]
            return float(stress[0] - stress[2])
    else:
        kx, ky, share = _waves(_SERIES)

        def below(depth: float) -> float:
            xx, _, zz, *_ = _wave_stress(kx, ky, depth)
            return float(((xx - zz) * share).sum().real)

    found = minimize_scalar(lambda depth: -below(depth), bounds=(0.3 * RADIUS, 0.8 * RADIUS), method="bounded")
    return float(-found.fun)


PEER_CASES = {
    "peer-tolerance": case_of_cells("peer-tolerance", "Beside peers", peer_tolerance, warm_size=64.02),
    "peer-curve": case_of_cells("peer-curve", "Load-area curve beside peers", load_area, warm_size=64.02),
} | {
    name: case_of_cells(name, "Stresses beside peers", functools.partial(prepare, axes=axes, **more), warm_size=32)
    for axes in AXES
    for name, prepare, more in (
        (f"peer-stress-{axes}", ball_stress, {"kept": False}),
        (f"peer-stress-{axes}-kept", ball_stress, {"kept": True}),
        (f"peer-mises-{axes}", ball_mises, {}),
    )
}
"""Cases that are measured beside other codes."""
