"""How the load share at creeping speed follows the length of the rough patch: the oil beside the contact fills it.

    python -m reports.experiments.patch_length

A roller at 1.5 GPa, at 0.1 and 10 mm/s, on patches cut from one surface. With one volume of oil on the patch the rough
surfaces hold as much as the smooth film does there, and at low speed nearly all of that lies beside Hertz' contact: a
longer patch lets the film, thinner there than a molecule, carry more. With the oil counted where the load is carried
(`oil_volume` "loaded") the length has no say. The result is stored in `reports/results/patch_length.json`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

from bem import Body, Grid, Lubricant, Material, generate_surface, solve_mixed
from bem.friction.oil_volume import OilVolume

RESULT = Path(__file__).resolve().parents[1] / "results" / "patch_length.json"
STEEL = Material("steel", youngs_modulus=207e9, poissons_ratio=0.3, hardness=7e9)
RADIUS, WIDTH, PRESSURE, SPACING = 6e-3, 10e-3, 1.5e9, 3.2e-6
CELLS, ACROSS = (102, 128, 160, 224), 128
SPEEDS = (1e-4, 1e-2)


def row(cells: int, speed: float, counted: OilVolume) -> dict[str, float | str]:
    """The balance on a patch of so many cells along."""
    modulus = STEEL.plane_strain_modulus / 2
    around = Grid((max(CELLS), ACROSS), (SPACING, SPACING), periodic=(True, True))
    surface = generate_surface(around, rms_height=100e-9, seed=4, correlation_length=15e-6)
    first = (max(CELLS) - cells) // 2
    solution = solve_mixed(
        height=surface[first : first + cells],
        grid=Grid((cells, ACROSS), (SPACING, SPACING), periodic=(False, True)),
        bodies=(Body(STEEL), Body(STEEL)),
        radius=RADIUS,
        width=WIDTH,
        load=math.pi * PRESSURE**2 * RADIUS * WIDTH / modulus,
        speeds=(speed, 0.0),
        lubricant=Lubricant(0.02, pressure_viscosity=21e-9),
        boundary_friction=0.12,
        hardness=7e9,
        oil_volume=counted,
    )
    half_width = 2 * PRESSURE * RADIUS / modulus
    return {
        "oil_volume": counted.value,
        "speed": speed,
        "length_over_hertz": float(cells * SPACING / (2 * half_width)),
        "contact_share": solution.oil.contact_share,
        "loaded_contact_share": solution.oil.loaded_contact_share,
        "oil_beside_contact": solution.oil.share,
        "friction": float(solution.friction),
        "status": str(solution.status.value),
    }


def main() -> None:
    """Solve, print, store."""
    rows = [row(cells, speed, counted) for counted in OilVolume for speed in SPEEDS for cells in CELLS]
    for one in rows:
        print(one)
    RESULT.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
