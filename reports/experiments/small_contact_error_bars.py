"""Error bars of contacts 3 to 9 cells wide against references four times finer.

    python -m reports.experiments.small_contact_error_bars [CASES]

Balls, ellipses and cylinders, bare and coated, with their centre anywhere in a cell; cells up to three times as long as
wide. The result is stored in `reports/results/small_contact_error_bars.json`.
"""

from __future__ import annotations

import math

import numpy as np

from bem import Body, Grid, Layer, Material
from bem.reference_solutions.hertz import ellipse_contact
from reports.experiments.contact_error_bars import Problem, solve
from reports.experiments.judging import Experiment, main

_RADIUS, _SMALLEST, _LARGEST = 1e-3, 32, 80
"""Of the bodies [m]; cells along an axis: a grid of twice the cell needs so many, the reference four times more."""


def draw(rng: np.random.Generator) -> Problem:
    """A random contact; one that would take too many cells is drawn again."""
    steel = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)
    modulus = steel.plane_strain_modulus
    form = str(rng.choice(["ball", "ellipse", "coated", "line"]))
    ratio = float(3 ** rng.uniform(-1, 1)) if form in ("ellipse", "coated") else 1.0
    hertz = ellipse_contact(radii=(ratio * _RADIUS, _RADIUS), contact_modulus=modulus, load=1.0)
    widths = np.array([2 * a for a in hertz.semi_axes])
    sides = np.array([1.0, float(3 ** rng.uniform(-1, 1)) if rng.random() < 0.5 else 1.0])
    body, line = Body(steel), form == "line"
    sides *= (widths[0] if line else min(widths / sides)) / rng.uniform(3, 9)
    if form == "coated":
        coat = Material("coat", youngs_modulus=200e9 * 10 ** rng.uniform(-0.5, 0.5), poissons_ratio=0.25)
        body = Body(steel, layers=(Layer(coat, float(widths[0] / 2 * 10 ** rng.uniform(-1, 0.5))),))
    shape = [max(_SMALLEST, math.ceil(rng.uniform(1.5, 2.2) * n)) for n in widths / sides]
    centre = rng.uniform(-0.5, 0.5, 2) * sides
    if max(shape) > _LARGEST:
        return draw(rng)
    grid = Grid((shape[0], 4 if line else shape[1]), (float(sides[0]), float(sides[1])), periodic=(False, line))
    curvature = (1 / (ratio * _RADIUS), 0.0 if line else 1 / _RADIUS)
    load = math.pi / 4 * hertz.semi_axes[0] ** 2 * modulus / _RADIUS * grid.lengths[1] if line else 1.0
    given = {"load": load}
    place = (float(centre[0]), float(centre[1]))
    heights = np.zeros(grid.shape)
    control = "approach" if rng.random() < 0.5 else "load"
    return Problem(grid, body, curvature, heights, given, None, 0, control, place, settled_on=4)


EXPERIMENT = Experiment("small_contact_error_bars", draw, solve, cases=100)

if __name__ == "__main__":
    main(EXPERIMENT)
