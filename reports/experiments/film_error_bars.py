"""Error bars of random steady line films against references of four times the points: how many cover, and by how much
they are larger.

    python -m reports.experiments.film_error_bars [CASES]

Films are drawn from a seed: Moes' loads M from 0.5 to 2000 and L from 1 to 20, slide-roll ratios 0 to 2, meshes of 100
to 500 points, Roelands' and Barus' viscosities, compressible and incompressible, rolling either way. The result is
stored in `reports/results/film_error_bars.json`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bem import Lubricant, solve_line_film
from bem.accuracy import FilmCase, film_bars, film_figures, solve_coarser_film
from bem.errors import Status
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random film as the arguments of `bem.solve_line_film`."""
    load = 10 ** rng.uniform(math.log10(0.5), math.log10(2000))
    material = rng.uniform(1, 20)
    modulus, radius = 10 ** rng.uniform(9.5, 11.1), 10 ** rng.uniform(-2.5, -1)
    pressure_viscosity, viscosity = rng.uniform(0.8, 2.5) * 1e-8, 10 ** rng.uniform(-2, 0)
    # Moes' L = alpha E' U^(1/4), M = w / sqrt(E' R mu (u1 + u2)), U = mu (u1 + u2) / (E' R)
    entrainment = (material / (pressure_viscosity * 2 * modulus)) ** 4 * 2 * modulus * radius / viscosity
    sliding = rng.uniform(0, 2)
    way = rng.choice([1.0, -1.0])
    density = str(rng.choice(["incompressible", "dowson_higginson"]))
    law = str(rng.choice(["roelands", "barus"]))
    points = int(10 ** rng.uniform(2, math.log10(500)))
    return {
        "load": load * math.sqrt(2 * modulus * radius * viscosity * entrainment),
        "radius": radius,
        "contact_modulus": modulus,
        "speeds": (way * entrainment / 2 * (1 + sliding / 2), way * entrainment / 2 * (1 - sliding / 2)),
        "lubricant": Lubricant(
            viscosity, pressure_viscosity=pressure_viscosity, viscosity_law=law, density_law=density
        ),
        "points": points,
    }


def solve(given: dict[str, Any]) -> Comparison | None:
    """Figures of a film, their bars, and figures on four times the points."""
    case = FilmCase(solve_line_film(**given), **given)
    bars = film_bars(case, solve_coarser_film(case))
    reference = solve_line_film(**{**given, "points": FINER * given["points"]}, initial=case.solution)
    if {case.solution.status, reference.status} != {Status.CONVERGED}:
        return None
    return Comparison(film_figures(case.solution), film_figures(reference), bars.values, bars.parts)


EXPERIMENT = Experiment("film_error_bars", draw, solve, cases=100)

if __name__ == "__main__":
    main(EXPERIMENT)
