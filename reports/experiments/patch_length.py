"""How the load share at creeping speed follows the length of the rough patch: the oil beside the contact fills it.

    python -m reports.experiments.patch_length

A roller at 1.5 GPa and 0.1 mm/s. Under volume control the rough surfaces hold as much oil as the smooth film does on
the patch, and at low speed nearly all of that lies beside Hertz' contact: a longer patch lets the film, thinner there
than a molecule, carry more. The result is stored in `reports/results/patch_length.json`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

from bem import Body, Grid, Lubricant, Material, generate_surface, solve_mixed

RESULT = Path(__file__).resolve().parents[1] / "results" / "patch_length.json"
STEEL = Material("steel", youngs_modulus=207e9, poissons_ratio=0.3, hardness=7e9)
RADIUS, WIDTH, PRESSURE, SPACING = 6e-3, 10e-3, 1.5e9, 3.2e-6


def row(cells: int) -> dict[str, float | str]:
    """The balance on a patch of so many cells along and across."""
    modulus = STEEL.plane_strain_modulus / 2
    grid = Grid((cells, cells), (SPACING, SPACING), periodic=(False, True))
    around = Grid(grid.shape, grid.spacing, periodic=(True, True))
    solution = solve_mixed(
        height=generate_surface(around, rms_height=100e-9, seed=4, correlation_length=15e-6),
        grid=grid,
        bodies=(Body(STEEL), Body(STEEL)),
        radius=RADIUS,
        width=WIDTH,
        load=math.pi * PRESSURE**2 * RADIUS * WIDTH / modulus,
        speeds=(1e-4, 0.0),
        lubricant=Lubricant(0.02, pressure_viscosity=21e-9),
        boundary_friction=0.12,
        hardness=7e9,
    )
    half_width = 2 * PRESSURE * RADIUS / modulus
    return {
        "length_over_hertz": float(cells * SPACING / (2 * half_width)),
        "contact_share": float(solution.contact_load / (solution.contact_load + solution.film_load)),
        "friction": float(solution.friction),
        "status": str(solution.status.value),
    }


def main() -> None:
    """Solve, print, store."""
    rows = [row(cells) for cells in (102, 128, 160, 224)]
    for one in rows:
        print(one)
    RESULT.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
