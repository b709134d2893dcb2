"""Why less of the load is the surfaces' on finer cells: rough films on cells halved three times.

    nice python -m reports.experiments.touching_cells

Two minutes of one core; stored in `reports/results/touching_cells.json`. Bumps of `touching_films` at 3 mm/s with a
least film of 1 nm; at 30 mm/s, whose film is four times as thick, with one of 4.3 nm; and there with 1 nm, so that
nothing touches and the minimum is the film's own. With each grid: where surfaces touch, how many cells wide that is
across the flow, what half as many cells give as an error bar, and the opening in cells: the length over which the dry
gap beside Hertz' contact opens to the mean film.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.ndimage import label

from bem import RoughPointFilm
from bem.accuracy.rough_point import RoughPointCase, at_rim, opening, rough_point_bars
from reports.experiments.kept import keep, result_of, rounded
from reports.experiments.rough_films import BOUNDARY, MODULUS, OIL
from reports.experiments.touching_films import BALL, HALF, SURFACES

CELLS = (36, 72, 144, 288)
FILMS = ((0.003, 1e-9), (0.03, 4.3e-9), (0.03, 1e-9))
"""Speed [m/s] and least film [m]."""


def cells_wide(film: RoughPointFilm) -> float:
    """Cells across the flow of a run of touching ones, weighed by their number."""
    numbers, count = label(film.touching, structure=[[0, 0, 0], [1, 1, 1], [0, 0, 0]])
    sizes = np.bincount(numbers.ravel(), minlength=count + 1)[1:]
    return float((sizes**2).sum() / max(int(sizes.sum()), 1))


def row(speed: float, least_film: float, cells: int) -> dict[str, Any]:
    """Of a film on so many cells a side."""
    case = RoughPointCase(
        **BALL,
        contact_modulus=MODULUS,
        speeds=((0.0, 0.0), (speed, 0.0)),
        lubricant=OIL,
        heights=SURFACES[0].heights,
        least_film=least_film,
        boundary_friction=BOUNDARY,
    )
    film = case.on((cells, cells))
    area = math.pi * HALF**2
    # on the coarsest grid half as many cells are too few for bars
    bars = rough_point_bars(case, film, area).values
    width = opening(case, film.mean_thickness)[0]
    return {
        "cells": cells,
        "status": film.status.value,
        "share": film.contact_share,
        "share_bar": bars["contact_load_share"],
        "area": film.contact_area / area,
        "area_bar": bars["contact_area_share"],
        "mean": film.mean_thickness,
        "minimum": film.minimum_thickness,
        "mean_bar": bars["mean_thickness"],
        "friction": film.friction(BOUNDARY),
        "opening": width / float(film.x[1] - film.x[0]),
        "at_rim": at_rim(case, film),
        "cells_wide": cells_wide(film),
    }


def main() -> None:
    """A film after the other, stored after each."""
    found: list[dict[str, Any]] = []
    for speed, least_film in FILMS:
        found.append({"speed": speed, "least_film": least_film, "rows": []})
        for cells in CELLS:
            found[-1]["rows"].append(rounded(row(speed, least_film, cells)))
            keep(result_of("touching_cells"), {"asked": len(FILMS) * len(CELLS), "films": found})


if __name__ == "__main__":
    main()
