"""Error bars of random point films against references of four times the cells a side that begin twice as far out: how
many cover, and by how much they are larger.

    python -m reports.experiments.point_error_bars [CASES]

Films are drawn from a seed: Moes' loads M from 2 to 1000 and L from 0 to 15, ratios of radii Rx/Ry from 0.1 to 10,
entrainment along x or at any angle, slide-roll ratios 0 to 1.5, 32 to 72 cells a side, Roelands' and Barus'
viscosities, compressible and incompressible. What grids that begin twice as far out change is found with cells of the
same size, and added to what cells of a quarter change. The result is stored in
`reports/results/point_error_bars.json`.
"""

from __future__ import annotations

import math

import numpy as np

from bem import Lubricant, PointFilmSolution, solve_point_film
from bem.accuracy.point import PointCase, point_bars, point_figures
from bem.arguments import named
from bem.errors import InputError, Status
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4


def draw(rng: np.random.Generator) -> PointCase:
    """A random film."""
    load, material = 10 ** rng.uniform(math.log10(2), math.log10(1000)), rng.uniform(0, 15)
    modulus, radius, ratio = 10 ** rng.uniform(9.5, 11.1), 10 ** rng.uniform(-2.5, -1), 10 ** rng.uniform(-1, 1)
    pressure_viscosity, viscosity = rng.uniform(0.8, 2.5) * 1e-8, 10 ** rng.uniform(-2, 0)
    # Moes' L = alpha E' U^(1/4), M = w / (E' Rx^2 U^(3/4)), U = mu (u1 + u2) / (E' Rx)
    number = (max(material, 0.1) / (pressure_viscosity * 2 * modulus)) ** 4
    mean = 0.5 * number * 2 * modulus * radius / viscosity
    angle = float(rng.choice([0.0, rng.uniform(0, 2 * math.pi)]))
    slide = rng.uniform(0, 1.5) / 2
    density = str(rng.choice(["incompressible", "dowson_higginson"]))
    law = str(rng.choice(["roelands", "barus"]))
    cells = int(rng.integers(32, 73))
    first, second = (
        (mean * (1 + way) * math.cos(angle), mean * (1 + way) * math.sin(angle)) for way in (slide, -slide)
    )
    return PointCase(
        load=load * 2 * modulus * radius**2 * number**0.75,
        radii=(radius, radius / ratio),
        contact_modulus=modulus,
        speeds=(first, second),
        lubricant=Lubricant(viscosity, pressure_viscosity=pressure_viscosity, viscosity_law=law, density_law=density),
        cells=(cells, cells),
        roughness=50e-9,
    )


def further_out(case: PointCase, film: PointFilmSolution) -> PointFilmSolution:
    """The film on a grid that begins twice as far out, of the same cells and as many around them as lead there."""
    edges: list[float] = []
    shape: list[int] = []
    for axis in (film.x, film.y):
        cell = float(axis[1] - axis[0])
        ends = float(axis[0]) - cell / 2, float(axis[-1]) + cell / 2
        before, behind = (round(abs(end) / cell) for end in ends)
        edges += [ends[0] - before * cell, ends[1] + behind * cell]
        shape.append(len(axis) + before + behind)
    asked = named(case, "load radii contact_modulus speeds lubricant")
    return solve_point_film(**asked, shape=(shape[0], shape[1]), extent=edges, cavitation="mass_conserving")


def solve(case: PointCase) -> Comparison | None:
    """Figures of a film, their bars, and figures on finer and wider grids; None where a film is not found or asked."""
    nx, ny = case.cells
    try:
        film, reference = case.on(case.cells), case.on((FINER * nx, FINER * ny))
        wide = further_out(case, film)
    except InputError:  # across a narrow ellipse M is another, and may be out of range
        return None
    if {film.status, reference.status, wide.status} != {Status.CONVERGED}:
        return None
    found, finer, further = (point_figures(case, one) for one in (film, reference, wide))
    truth = {name: finer[name] + further[name] - found[name] for name in found}
    bars = point_bars(case, film)
    return Comparison(found, truth, bars.values, bars.parts)


EXPERIMENT = Experiment("point_error_bars", draw, solve, cases=30)

if __name__ == "__main__":
    main(EXPERIMENT)
