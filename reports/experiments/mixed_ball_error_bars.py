"""Error bars of random load sharing under balls and ellipsoids against references on four times finer grids and films.

    python -m reports.experiments.mixed_ball_error_bars [CASES]

As `mixed_error_bars`, of points: radii 3 to 15 mm, Rx/Ry 0.5 to 2, Hertz pressures 0.3 to 1 GPa, roughnesses of 20 to
150 nm with 3 to 12 cells to the shortest wave, films of 40 to 64 cells, oil counted where the film carries or on the
patch. The result is stored in `reports/results/mixed_ball_error_bars.json`.
"""

from __future__ import annotations

import math

import numpy as np

from bem import Body, Grid, Lubricant, Material
from bem.friction.setup import MixedSetup
from bem.lubrication.point.similarity import nijenbanning_film, point_scales
from bem.reference_solutions.hertz import ellipse_contact
from bem.surfaces import generate_surface
from reports.experiments.contact_error_bars import waves_through
from reports.experiments.judging import Experiment, main
from reports.experiments.mixed_error_bars import Problem, solve

STEEL = Material("steel", youngs_modulus=206e9, poissons_ratio=0.3)
MODULUS = 206e9 / 2 / (1 - 0.3**2)


def draw(rng: np.random.Generator) -> Problem:
    """A random ball or ellipsoid."""
    along, hertz = 10 ** rng.uniform(-2.5, -1.8), 10 ** rng.uniform(8.5, 9)
    radii = (along, along * 2 ** rng.uniform(-1, 1))
    one = ellipse_contact(radii=radii, contact_modulus=MODULUS, load=1.0)
    load = (hertz / one.maximum_pressure) ** 3
    model = str(rng.choice(["capped", "elastic", "uncoupled"], p=[0.5, 0.35, 0.15]))
    cells, longer = int(rng.integers(44, 57)), rng.uniform(1.25, 1.5)
    spacing = [2 * half * load ** (1 / 3) * longer / cells for half in one.semi_axes]
    grid = Grid((cells, cells), (spacing[0], spacing[1]))
    whole = Grid(grid.shape, grid.spacing, periodic=(True, True))
    shortest = 10 ** rng.uniform(math.log10(3), math.log10(12))
    heights = generate_surface(
        whole,
        seed=int(rng.integers(1 << 30)),
        hurst=0.8,
        cutoff_wavelength=shortest * max(spacing),
        rms_height=10 ** rng.uniform(math.log10(20e-9), math.log10(150e-9)),
    )
    # slopes of more than 0.2 are none of rolled or ground surfaces
    slope = float(np.sqrt(np.mean((np.diff(heights, axis=0) / spacing[0]) ** 2)))
    heights = waves_through(heights * min(1.0, 0.2 / slope), 1)
    lubricant = Lubricant(
        10 ** rng.uniform(-1.7, -0.5), pressure_viscosity=rng.uniform(0.8, 2.2) * 1e-8, density_law="incompressible"
    )
    counted = str(rng.choice(["loaded", "patch"]))
    setup = MixedSetup(
        grid=grid,
        bodies=(Body(STEEL), Body(STEEL)),
        radii=radii,
        load=load,
        lubricant=lubricant,
        boundary_friction=float(rng.uniform(0.05, 0.2)),
        hardness=None if model == "elastic" else float(rng.uniform(2, 8)) * 1e9,
        film_cells=int(rng.integers(40, 65)),
        contact_model="uncoupled" if model == "uncoupled" else "coupled",
        oil_volume=counted,
    )
    wanted, mean = 10 ** rng.uniform(-1.1, 0.4) * float(heights.std()), 0.1
    for _ in range(3):  # films go like the speed to the power of about 0.7
        scales = point_scales(load, radii, MODULUS, 2 * mean, lubricant.viscosity)
        film = scales.film * nijenbanning_film(
            scales.load, lubricant.pressure_viscosity * scales.pressure, scales.ratio
        )
        mean *= (wanted / film) ** 1.4
    slide = mean * rng.uniform(0.05, 2) / 2
    return Problem(setup, heights, lambda: (mean + slide, mean - slide))


EXPERIMENT = Experiment("mixed_ball_error_bars", draw, solve, cases=16)

if __name__ == "__main__":
    main(EXPERIMENT)
