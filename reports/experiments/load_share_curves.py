"""Load share over Lambda of a rolling bearing's contact against exp(-B Lambda^C) with published constants.

    python -m reports.experiments.load_share_curves

Two minutes. The contact is about that of the tapered roller bearing of Schwarz et al. (2023): roller on raceway, 1 GPa,
Sq 160 nm of both surfaces, a mineral oil of 50 C, pure rolling. Lambda is the central film between smooth surfaces
over Sq, as in the sources. The rough patch is longer than Hertz' contact, and oil is counted, as `PATCHES`
has it. The result is stored in `reports/results/load_share_curves.json`, which the validation page shows.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Lubricant, Material, generate_surface, solve_line_film, solve_mixed
from bem.friction.share_fit import fit_load_share
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "load_share_curves.json"
STEEL = Material("steel", youngs_modulus=207e9, poissons_ratio=0.3, hardness=7e9)
OIL = Lubricant(0.06, pressure_viscosity=20e-9, shear_law="eyring", shear_stress_limit=5e6)
RADIUS, WIDTH, PRESSURE, ROUGHNESS, WAVES = 8e-3, 10e-3, 1.0e9, 160e-9, 30e-6
PATCHES = ((1.25, "patch"), (1.5, "patch"), (2.0, "patch"), (1.5, "loaded"), (2.0, "loaded"))
"""Length over Hertz' contact, and where the oil is counted (`bem.friction.oil_volume`)."""
CELLS = (192, 64)
SPEEDS = tuple(float(speed) for speed in np.geomspace(0.005, 10.0, 10))


def row(length: float, oil_volume: str, speed: float, modulus: float) -> dict[str, float | str]:
    """Balance at a speed of both surfaces on a patch that is so many times as long as Hertz' contact."""
    half_width = 2 * PRESSURE * RADIUS / modulus
    spacing = 2 * half_width * length / CELLS[0]
    grid = Grid(CELLS, (spacing, spacing), periodic=(False, True))
    around = Grid(grid.shape, grid.spacing, periodic=(True, True))
    contact: dict[str, Any] = {"radius": RADIUS, "speeds": (speed, speed), "lubricant": OIL}
    load = math.pi * PRESSURE**2 * RADIUS * WIDTH / modulus
    solution = solve_mixed(
        height=generate_surface(around, rms_height=ROUGHNESS, seed=4, correlation_length=WAVES / 2),
        grid=grid,
        bodies=(Body(STEEL), Body(STEEL)),
        width=WIDTH,
        load=load,
        boundary_friction=0.12,
        hardness=7e9,
        oil_volume=oil_volume,
        **contact,
    )
    film = solve_line_film(load=load / WIDTH, contact_modulus=modulus, **contact)
    return {
        "length_over_hertz": length,
        "speed": speed,
        "lambda": film.central_thickness / ROUGHNESS,
        "contact_share": float(solution.contact_load / (solution.contact_load + solution.film_load)),
        "status": str(solution.status.value),
    }


def main() -> None:
    """Solve, fit, print, store."""
    modulus = STEEL.plane_strain_modulus / 2
    found = []
    for length, oil_volume in PATCHES:
        rows = [row(length, oil_volume, speed, modulus) for speed in SPEEDS]
        good = [one for one in rows if one["status"] == "converged"]
        fit = fit_load_share([one["lambda"] for one in good], [one["contact_share"] for one in good])
        constants = {"B": fit.b, "C": fit.c, "B_error": fit.b_error, "C_error": fit.c_error, "largest": fit.largest}
        found.append({"length_over_hertz": length, "oil_volume": oil_volume, "rows": rows, **constants})
        print(length, oil_volume, constants)
        for one in rows:
            print(" ", one)
    keep(RESULT, found)


if __name__ == "__main__":
    main()
