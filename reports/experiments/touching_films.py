"""Load on the surfaces of a rough ball over speed: roughness in Reynolds' equation beside load sharing.

    nice python -m reports.experiments.touching_films

A minute or two of one core; a row a speed into `reports/results/touching_films.json`. Bumps of 50 nm rms, 0.74 of
Hertz' radius long, under the ball of `rough_films`: `solve_rough_point_film` (oil kept account of, least film 1 nm) on
three grids, and `solve_mixed` of the same heights with the oil counted where the film is loaded.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem import Grid, solve_point_film, solve_rough_point_film
from reports.experiments.kept import keep, result_of, rounded
from reports.experiments.rough_films import (
    BALL_CELLS,
    BALL_LOAD,
    BOUNDARY,
    MODULUS,
    OIL,
    PATCH,
    RADIUS,
    bumps,
    load_shared,
)

RMS, WAVELENGTH = 50e-9, 0.74
"""[m], and over Hertz' radius."""
SPEEDS = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003)
"""[m/s]."""
SHAPES = ((64, 64), (96, 96), (144, 144))


def row(speed: float) -> dict[str, Any]:
    """Figures at a speed [m/s]."""
    half = (0.75 * BALL_LOAD * RADIUS / MODULUS) ** (1 / 3)
    surface = bumps(WAVELENGTH * half)
    ball = {"load": BALL_LOAD, "radii": (RADIUS, RADIUS)}
    shared: dict[str, Any] = {"contact_modulus": MODULUS, "speeds": (0.0, speed), "lubricant": OIL, **ball}
    smooth = solve_point_film(shape=SHAPES[0], **shared).central_thickness
    films = []
    for shape in SHAPES:
        film = solve_rough_point_film(heights=lambda x, y: RMS * surface(x, y), shape=shape, errors=False, **shared)
        films.append(
            {
                "cells": list(shape),
                "status": film.status.value,
                "share": film.contact_share,
                "area": film.contact_area / (np.pi * half**2),
                "friction": film.friction(BOUNDARY),
                "mean": film.mean_thickness,
                "minimum": film.minimum_thickness,
            }
        )
    spacing = 2 * PATCH * half / BALL_CELLS[0]
    grid = Grid(BALL_CELLS, (spacing, spacing))
    height = RMS * surface(grid.x[:, None], grid.y[None, :])
    mixed = load_shared(np.asarray(height), speed, "loaded", ball | {"grid": grid})
    return {"speed": speed, "lambda": smooth / RMS, "films": films, "loaded": mixed}


def main() -> None:
    """A row a speed, stored after each, so that what was cut short says so."""
    rows = []
    for speed in SPEEDS:
        rows.append(rounded(row(speed)))
        keep(result_of("touching_films"), {"asked": len(SPEEDS), "rms": RMS, "wavelength": WAVELENGTH, "rows": rows})


if __name__ == "__main__":
    main()
