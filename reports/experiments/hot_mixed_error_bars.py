"""What points, columns and layers of full heat leave of load sharing, against its bars' part of the film.

    python -m reports.experiments.hot_mixed_error_bars [CASES]

Contacts of `mixed_error_bars` with full heat: steel, ISO VG 10 to 320 at 40 to 100 degrees Celsius, 2 to 20 m/s,
roughness of 25 to 320 nm. References have 2.5 times the points, columns and layers on the same
rough patch, whose cells are judged there; what they leave themselves is added. The result is stored in
`reports/results/hot_mixed_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from bem import Body, Grid, Lubricant
from bem.accuracy import MixedCase, mixed_bars, mixed_figures, solve_coarser_mixed
from bem.accuracy.bars import POINTS
from bem.accuracy.mixed import BALANCE, TEMPERATURES
from bem.errors import InputError, Status
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.materials import CATALOGUE
from bem.surfaces import generate_surface
from reports.experiments.judging import Comparison, Experiment, main

FINER = 2.5
LEFT = 1 / (1 - 1 / FINER)
"""Of the difference to the reference: columns and layers are of first order."""
OF_CONTACT = ("boundary_part", "contact_load", "film_load", "contact_area_fraction", *TEMPERATURES)
"""Figures of the contact, and of the load that it takes from the film."""
GRADES = ("ISO VG 10", "ISO VG 32", "ISO VG 100", "ISO VG 320")


def draw(rng: np.random.Generator) -> tuple[MixedSetup, Any, tuple[float, float]]:
    """Set-up, heights and speeds."""
    steel = CATALOGUE["steel-52100"].material
    radius, hertz = 10 ** rng.uniform(-2.3, -1.5), 10 ** rng.uniform(8.5, 9.1)
    modulus = steel.plane_strain_modulus / 2
    half_width, cells = 2 * hertz * radius / modulus, (48, 24)
    spacing = 3 * half_width / cells[0]
    grid = Grid(cells, (spacing, spacing), periodic=(False, True))
    heights = generate_surface(
        grid,
        seed=int(rng.integers(1 << 30)),
        hurst=0.8,
        cutoff_wavelength=6 * spacing,
        rms_height=10 ** rng.uniform(-7.6, -6.5),
    )
    sliding, mean = rng.uniform(0.05, 2), 10 ** rng.uniform(0.3, 1.3)
    setup = MixedSetup(
        grid=grid,
        bodies=(Body(steel), Body(steel)),
        radius=radius,
        width=1e-3,
        load=math.pi * radius * hertz**2 / modulus * 1e-3,
        lubricant=Lubricant.of(
            str(rng.choice(GRADES)), temperature=float(rng.uniform(313, 373)), density_law="incompressible"
        ),
        boundary_friction=0.12,
        hardness=6e9,
        film_points=int(rng.integers(200, 401)),
        thermal="full",
    )
    return setup, heights, (mean * (1 + sliding / 2), mean * (1 - sliding / 2))


def solve(drawn: tuple[MixedSetup, Any, tuple[float, float]]) -> Comparison | None:
    """Figures, the film's part of their bars, and figures on 2.5 times the mesh of the film."""
    setup, heights, speeds = drawn
    finer = replace(setup, heat_mesh=FINER, tolerance=1e-5).with_film(round(FINER * setup.film_resolution))
    try:
        solution = solve_setup(setup, heights, speeds)
        reference = solve_setup(finer, heights, speeds, solution)
    except InputError:  # the load is outside the range of the film solver
        return None
    if {solution.status, reference.status} != {Status.CONVERGED}:
        return None
    case = MixedCase(setup, heights, solution)
    coarser = solve_coarser_mixed(case)
    bars = mixed_bars(case, coarser)
    found, finest = mixed_figures(solution), mixed_figures(reference)
    truth = {name: found[name] + LEFT * (finest[name] - found[name]) for name in found}
    # balances on the coarser cells that do not touch tell nothing of the contact: its bar is then that of the cells
    touches = solution.contact_load > 0
    apart = touches and coarser.contact is not None and coarser.contact.figures["contact_load"] == 0
    of_film = {
        name: bars.parts[POINTS][name] + bars.parts[BALANCE][name]
        if bar is not None and not (apart and name in OF_CONTACT)
        else None
        for name, bar in bars.values.items()
    }
    return Comparison(found, truth, of_film)


EXPERIMENT = Experiment("hot_mixed_error_bars", draw, solve, cases=8, seed=20)

if __name__ == "__main__":
    main(EXPERIMENT)
