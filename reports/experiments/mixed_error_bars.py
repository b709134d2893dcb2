"""Error bars of random load sharing against references on four times finer grids and films: how many cover, and by how
much they are larger.

    python -m reports.experiments.mixed_error_bars [CASES]

Cylinders on flats are drawn from a seed: radii 2 to 30 mm, Hertz pressures 0.2 to 1.2 GPa, roughnesses of 20 to 300 nm
with 2 to 12 cells to the shortest wave, film ratios from boundary to full film, slide-roll ratios 0.05 to 2, elastic,
capped and uncoupled asperities, alike and unlike bodies, films of 120 to 500 points. The result is stored in
`reports/results/mixed_error_bars.json`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bem import Body, Grid, Lubricant, Material, solve_line_film
from bem.accuracy import MixedCase, mixed_bars, mixed_figures, solve_coarser_mixed
from bem.errors import InputError, Status
from bem.friction.models import films_of
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.surfaces import generate_surface
from reports.experiments.contact_error_bars import FloatArray, waves_through
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4


@dataclass(frozen=True)
class Problem:
    """A rough contact: set-up, heights [m], and a function that finds the speeds of both bodies [m/s]."""

    setup: MixedSetup
    heights: FloatArray
    speeds: Callable[[], tuple[float, float]]


def draw(rng: np.random.Generator) -> Problem:
    """A random contact."""
    steel = Material("steel", youngs_modulus=206e9, poissons_ratio=0.3)
    other = steel if rng.random() < 0.7 else Material("bronze", youngs_modulus=110e9, poissons_ratio=0.34)
    radius, hertz = 10 ** rng.uniform(-2.7, -1.5), 10 ** rng.uniform(8.3, 9.1)
    model = str(rng.choice(["capped", "elastic", "uncoupled"], p=[0.5, 0.3, 0.2]))
    modulus = 1 / ((1 - 0.3**2) / 206e9 + (1 - other.poissons_ratio**2) / other.youngs_modulus)
    half_width = 2 * hertz * radius / modulus
    load = math.pi * radius * hertz**2 / modulus * 1e-3  # on a width of 1 mm
    cells = (int(rng.integers(48, 65)), int(rng.integers(24, 41)))
    spacing = 2 * half_width * rng.uniform(1.2, 1.6) / cells[0]
    grid = Grid(cells, (spacing, spacing), periodic=(False, True))
    shortest = 2.0 if rng.random() < 0.2 else 10 ** rng.uniform(math.log10(4), math.log10(12))
    rms = 10 ** rng.uniform(math.log10(20e-9), math.log10(300e-9))
    heights = generate_surface(
        grid, seed=int(rng.integers(1 << 30)), hurst=0.8, cutoff_wavelength=shortest * spacing, rms_height=rms
    )
    # slopes of more than 0.2 are none of rolled or ground surfaces
    slope = float(np.sqrt(np.mean((np.diff(heights, axis=0) / spacing) ** 2)))
    heights = waves_through(heights * min(1.0, 0.2 / slope), 1)
    lubricant = Lubricant(
        10 ** rng.uniform(-2, -0.5), pressure_viscosity=rng.uniform(0.8, 2.2) * 1e-8, density_law="incompressible"
    )
    sliding = rng.uniform(0.05, 2)
    setup = MixedSetup(
        grid=grid,
        bodies=(Body(steel), Body(other)),
        radius=radius,
        width=1e-3,
        load=load,
        lubricant=lubricant,
        boundary_friction=float(rng.uniform(0.05, 0.2)),
        hardness=None if model == "elastic" else float(rng.uniform(1.5, 8)) * 1e9,
        film_points=int(10 ** rng.uniform(math.log10(120), math.log10(500))),
        contact_model="uncoupled" if model == "uncoupled" else "coupled",
    )
    wanted = 10 ** rng.uniform(-1.3, 0.5) * float(heights.std())

    def speeds() -> tuple[float, float]:
        # films go like the speed to the power of about 0.7
        mean = 0.1
        for _ in range(3):
            film = solve_line_film(
                load=load / 1e-3,
                radius=radius,
                contact_modulus=modulus,
                speeds=(mean, mean),
                lubricant=lubricant,
                points=200,
            )
            mean *= min(max((wanted / film.minimum_thickness) ** 1.4, 1e-3), 1e3)
        return mean * (1 + sliding / 2), mean * (1 - sliding / 2)

    return Problem(setup, heights, speeds)


def finer(setup: MixedSetup) -> MixedSetup:
    """Each cell cut into 4 x 4, films of four times the points and, where lumped heat is found, cells."""
    (nx, ny), (dx, dy) = setup.grid.shape, setup.grid.spacing
    grid = Grid((FINER * nx, FINER * ny), (dx / FINER, dy / FINER), periodic=setup.grid.periodic)
    mesh = 1.0 if setup.thermal == "off" else float(FINER)
    return replace(setup, grid=grid, heat_mesh=mesh, tolerance=setup.tolerance / 10).with_film(
        FINER * setup.film_resolution
    )


def solve(problem: Problem) -> Comparison | None:
    """Figures of load sharing, their bars, and figures on a finer grid and film."""
    setup, heights, speeds = problem.setup, problem.heights, problem.speeds()
    try:
        solution = solve_setup(setup, heights, speeds)
        reference = solve_setup(finer(setup), waves_through(heights, FINER), speeds)
    except InputError:  # the load is outside the range of the film solver
        return None
    if {solution.status, reference.status} != {Status.CONVERGED}:
        return None
    case = MixedCase(setup, heights, solution)
    bars = mixed_bars(case, solve_coarser_mixed(case))
    found, truth = mixed_figures(solution), mixed_figures(reference)
    # load sharing solves the film under the whole load on few points where it does not clear the roughness
    films = films_of(setup, speeds, resolution=FINER * setup.film_resolution)
    whole = films.under(setup.load, len(films.level_errors) - 1, None)
    truth["lambda_ratio"] = whole.minimum_thickness / float(heights.std())
    return Comparison(found, truth, bars.values, bars.parts)


EXPERIMENT = Experiment("mixed_error_bars", draw, solve, cases=60, seed=2613)

if __name__ == "__main__":
    main(EXPERIMENT)
