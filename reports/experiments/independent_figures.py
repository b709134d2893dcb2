"""Figures that nobody here wrote beside ours: rolling resistance, area and gap of self-affine surfaces, capped contact.

    python -m reports.experiments.independent_figures

Two minutes; the result is stored in `reports/results/independent_figures.json`, which the validation page shows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from bem import (
    Body,
    ContactSolution,
    Grid,
    Lubricant,
    Material,
    displacement_operator,
    generate_surface,
    solve_contact,
    solve_line_film,
)
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "independent_figures.json"
FloatArray = NDArray[np.float64]
UNIT = Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)
"""Against a rigid body: the contact modulus is one."""

TWICE_MODULUS, RADIUS = 231e9, 0.01
MOES_LOADS = (0.01, 0.2, 1.0, 5.0, 20.0, 50.0, 200.0)
MOES_OILS = (4.0, 8.0, 16.0)


def rigid_constant() -> float:
    """F / (E' R) over sqrt(U W) of a rigid, isoviscous rolling contact, by quadrature of Reynolds' equation.

    U = mu (u1 + u2)/(E' R), W the load per length over E' R, F = 1/2 integral h dp/dx dx the resistance. With
    h = h0 (1 + t^2), x = t sqrt(2 R h0), the exit c has p = dp/dx = 0: dp/dt ~ (t^2 - c^2)/(1 + t^2)^3.
    """

    def pressure(c: float) -> float:
        return quad(lambda t: (t * t - c * c) / (1 + t * t) ** 3, -np.inf, c)[0]

    exit_ = brentq(pressure, 0.1, 2.0)
    load = -quad(lambda t: t * (t * t - exit_**2) / (1 + t * t) ** 3, -np.inf, exit_)[0]
    force = -quad(lambda t: (t * t - exit_**2) / (1 + t * t) ** 2, -np.inf, exit_)[0]
    return float(-3 * math.sqrt(2) * force / math.sqrt(12 * load))


def rolling(moes_load: float, moes_oil: float, points: int) -> float:
    """F/(E' R) of pure rolling, Barus' viscosity, Dowson and Higginson's density."""
    speed_number = 1e-11
    load = moes_load * math.sqrt(speed_number)  # M = W (2 U')^-1/2, L = G (2 U')^1/4, and 2 U' = U of the sum of speeds
    film = solve_line_film(
        load=load * TWICE_MODULUS * RADIUS,
        radius=RADIUS,
        contact_modulus=TWICE_MODULUS / 2,
        speeds=(1.0, 1.0),
        lubricant=Lubricant(
            speed_number * TWICE_MODULUS * RADIUS / 2,
            pressure_viscosity=moes_oil / speed_number**0.25 / TWICE_MODULUS,
            viscosity_law="barus",
            density_law="dowson_higginson",
            shear_law="newtonian",
        ),
        points=points,
    )
    return abs(film.shear_force) / (TWICE_MODULUS * RADIUS)


def rolling_rows() -> list[dict[str, float]]:
    """Ours over either asymptote, with the difference to half the points."""
    return [rolling_row(load, oil) for load in MOES_LOADS for oil in MOES_OILS]


def rolling_row(load: float, oil: float) -> dict[str, float]:
    """The same at one M and L."""
    fine, coarse = rolling(load, oil, 2000), rolling(load, oil, 1000)
    return {
        "M": load,
        "L": oil,
        "over_sqrt_UW": fine / math.sqrt(load * 1e-11**1.5),
        "over_U34": fine / 1e-11**0.75,
        "mesh_error": abs(fine - coarse) / fine,
    }


def waves(cells: int, seed: int, slope: float = 1.0) -> tuple[Grid, FloatArray]:
    """A self-affine surface with H = 0.8 between 1/4 and 1/64 of the square, of the rms slope asked for."""
    grid = Grid((cells, cells), (1.0 / cells, 1.0 / cells), periodic=(True, True))
    heights = generate_surface(
        grid, rms_height=1.0, seed=seed, hurst=0.8, rolloff_wavelength=0.25, cutoff_wavelength=1 / 64
    )
    return grid, heights * (slope / rms_slope(heights, 1.0 / cells))


def rms_slope(heights: FloatArray, spacing: float) -> float:
    """Of a periodic surface, from its spectrum."""
    nx, ny = heights.shape
    qx = 2 * np.pi * np.fft.fftfreq(nx, spacing)[:, None]
    qy = 2 * np.pi * np.fft.fftfreq(ny, spacing)[None, :]
    power = np.abs(np.fft.fft2(heights)) ** 2
    return float(math.sqrt(((qx**2 + qy**2) * power).sum()) / (nx * ny))


def self_affine_rows(
    cells: int = 512, seeds: int = 3, pressures: Sequence[float] = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
) -> list[dict[str, float]]:
    """Area and mean gap over pressure, means over surfaces."""
    found: dict[float, list[tuple[float, float, float]]] = {p: [] for p in pressures}
    for seed in range(seeds):
        grid, heights = waves(cells, seed)
        operator, rms = displacement_operator(grid, Body(UNIT)), float(heights.std())
        for p in pressures:  # slope one and E* one: pressures are in units of E* times the slope
            solution = solve_contact(-heights, operator, load=p)
            found[p].append((solution.contact_area, float(np.maximum(solution.gap, 0).mean()) / rms, solution.residual))
    return [
        {
            "pressure": p,
            "area": float(np.mean([row[0] for row in rows])),
            "area_spread": float(np.std([row[0] for row in rows], ddof=1)),
            "gap": float(np.mean([row[1] for row in rows])),
            "residual": max(row[2] for row in rows),
        }
        for p, rows in found.items()
    ]


def _figures(pressure: float, solution: ContactSolution) -> dict[str, Any]:
    return {
        "pressure": pressure,
        "status": str(solution.status.value),
        "convolutions": float(solution.convolutions),
        "residual": float(solution.residual),
        "area": float(solution.contact_area),
    }


def plastic_rows(
    cells: int = 512, pressures: Sequence[float] = (0.01, 0.03, 0.05, 0.07, 0.08, 0.09, 0.099)
) -> list[dict[str, Any]]:
    """Capped contacts at H = 0.1 E* and rms slope 0.08, to pressures at which other codes are known to stall."""
    grid, heights = waves(cells, 0, slope=0.08)
    operator = displacement_operator(grid, Body(UNIT))
    rows = []
    for pressure in pressures:
        solution = solve_contact(-heights, operator, load=pressure, hardness=0.1)
        rows.append({**_figures(pressure, solution), "plastic_area": float(solution.plastic_area)})
    return rows


def near_full_rows(cells: int = 2048, pressures: Sequence[float] = (0.5, 1.0, 1.5, 2.0, 3.0)) -> list[dict[str, Any]]:
    """Elastic contacts up to full contact: self-affine with H = 0.8, waves of 1/5 to 1/1000 of the square, slope 1."""
    grid = Grid((cells, cells), (1.0 / cells, 1.0 / cells), periodic=(True, True))
    heights = generate_surface(
        grid, rms_height=1.0, seed=0, hurst=0.8, rolloff_wavelength=0.2, cutoff_wavelength=1 / 1000
    )
    heights = heights / rms_slope(heights, 1.0 / cells)
    operator = displacement_operator(grid, Body(UNIT))
    rows = []
    for pressure in pressures:
        solution = solve_contact(-heights, operator, load=pressure)
        rows.append(_figures(pressure, solution))
    return rows


def main() -> None:
    """Compute, print, store."""
    result = {
        "rigid_constant": rigid_constant(),
        "rolling": rolling_rows(),
        "self_affine": self_affine_rows(),
        "plastic": plastic_rows(),
        "near_full": near_full_rows(),
    }
    for name, rows in result.items():
        print(name)
        for row in rows if isinstance(rows, list) else [rows]:
            print(" ", row)
    keep(RESULT, result)


if __name__ == "__main__":
    main()
