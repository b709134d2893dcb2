"""Long ellipses against line contacts: what of the difference is the grid's, the inlet's, the ends'.

    python -m reports.experiments.long_ellipse

Some two minutes. An ellipse has in its middle the film of the line contact that carries as much per length there. Its
grid is refined along and across, and moved out at the inlet and at the ends with cells of one size. The result is
stored in `reports/results/long_ellipse.json`: a row for each grid, errors relative to the line contact's central film.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bem import Lubricant, PointFilmSolution, solve_line_film, solve_point_film
from bem.reference_solutions.hertz import ellipse_contact
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "long_ellipse.json"
MODULUS, RADIUS, ALPHA, VISCOSITY = 1.15e11, 0.01, 22e-9, 0.04
LOAD, OIL = 200.0, 8.0
"""Moes' M of a ball, which goes with Rx/Ry to the power -0.8 so that the load per length stays, and L."""
RATIOS = (0.01, 0.0013)
"""Rx/Ry: Hertz' ellipse is 18 and 59 times as long as wide."""
SHAPES = ((128, 64), (128, 128), (256, 64), (256, 128))


def arguments(ratio: float) -> dict[str, Any]:
    """Of `bem.solve_point_film`, but for the grid."""
    number = (OIL / (ALPHA * 2 * MODULUS)) ** 4
    half = 0.5 * number * 2 * MODULUS * RADIUS / VISCOSITY
    return {
        "load": LOAD * ratio**-0.8 * 2 * MODULUS * RADIUS**2 * number**0.75,
        "radii": (RADIUS, RADIUS / ratio),
        "contact_modulus": MODULUS,
        "speeds": (half, half),
        "lubricant": Lubricant(VISCOSITY, pressure_viscosity=ALPHA, density_law="dowson_higginson"),
    }


def error(case: dict[str, Any], film: PointFilmSolution) -> float:
    """Of the central film over that of a line contact with the load per length that the middle has."""
    per_length = float(np.interp(0.0, film.y, film.pressure.sum(axis=0))) * (film.x[1] - film.x[0])
    line = solve_line_film(
        load=per_length,
        radius=RADIUS,
        contact_modulus=MODULUS,
        speeds=case["speeds"],
        lubricant=case["lubricant"],
    )
    return film.central_thickness / line.central_thickness - 1


def row(ratio: float, shape: tuple[int, int], further: tuple[float, float] = (1.0, 1.0)) -> dict[str, Any]:
    """A grid of cells as large as those of `shape` on the grid's own rectangle, whose inlet and ends are so many times
    as far away."""
    case = arguments(ratio)
    plain = solve_point_film(**case, shape=shape)
    film = plain
    if further != (1.0, 1.0):
        (dx, dy), (nx, ny) = ((a[1] - a[0] for a in (plain.x, plain.y)), shape)
        before, beside = (
            round((f - 1) * -a[0] / d) for f, a, d in zip(further, (plain.x, plain.y), (dx, dy), strict=True)
        )
        x0, x1 = plain.x[0] - dx / 2 - before * dx, plain.x[-1] + dx / 2
        y0, y1 = plain.y[0] - dy / 2 - beside * dy, plain.y[-1] + dy / 2 + beside * dy
        film = solve_point_film(**case, shape=(nx + before, ny + 2 * beside), extent=(x0, x1, y0, y1))
    a, b = ellipse_contact(radii=case["radii"], contact_modulus=MODULUS, load=case["load"]).semi_axes
    return {
        "length_over_width": float(b / a),
        "cells": list(film.pressure.shape),
        "cells_across_half_width": float(a / (film.x[1] - film.x[0])),
        "inlet_over_half_width": float(-film.x[0] / a),
        "ends_over_half_length": float(film.y[-1] / b),
        "status": film.status.value,
        "error": error(case, film),
        "bar": None if film.central_thickness_error is None else film.central_thickness_error / film.central_thickness,
        "cycles": film.cycles,
    }


def main() -> None:
    """Solve, print, store."""
    rows = []
    for ratio in RATIOS:
        for shape in SHAPES:
            rows.append(row(ratio, shape))
            print(rows[-1], flush=True)
        for further in ((1.5, 1.0), (1.0, 1.3)):
            rows.append(row(ratio, SHAPES[0], further))
            print(rows[-1], flush=True)
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
