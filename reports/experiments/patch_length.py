"""How load share and friction follow the length of the rough patch, by the area over which the oil is counted.

    python -m reports.experiments.patch_length

Two contacts, each on patches cut from one surface:

- a roller at 1.5 GPa, at 0.1 and 10 mm/s, on 1.0 to 2.3 Hertz contacts;
- the cylinder of the thesis' paper A under 5.5 N (0.13 GPa) with the surface of scene `stribeck-mineral-oil`, at 1 and
  50 mm/s, on 27 to 180 um: 3 to 20 Hertz contacts.

With the oil counted on the whole patch (`oil_volume` "patch") the rough surfaces hold as much as the smooth film does
there. At low speed nearly all of that oil lies beside the Hertz contact, and load share and friction follow the length.
Where the film is loaded ("loaded") they converge with it; over the nominal Hertz contact ("hertz") the length has no
influence. The result is stored in `reports/results/patch_length.json`, which the validation page shows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem import Body, Grid, Lubricant, Material, generate_surface, solve_mixed
from bem.friction.oil_volume import OilVolume
from bem.grid import FloatArray
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "patch_length.json"
ROLLER, CYLINDER = "roller, 1.5 GPa", "cylinder, 5.5 N (0.13 GPa)"


@dataclass(frozen=True)
class Case:
    """A contact and its patches: body, radius and width [m], largest Hertz pressure [Pa], oil, boundary friction,
    hardness [Pa], cell [m], cells along of each patch, cells across, speeds of the flat [m/s], and the surface
    (keywords of `generate_surface`)."""

    steel: Material
    radius: float
    width: float
    pressure: float
    oil: Lubricant
    boundary_friction: float
    hardness: float
    spacing: float
    cells: tuple[int, ...]
    across: int
    speeds: tuple[float, ...]
    surface: dict[str, Any]

    @property
    def modulus(self) -> float:
        """E* of the pair [Pa]."""
        return self.steel.plane_strain_modulus / 2

    @property
    def half_width(self) -> float:
        """Hertz half-width [m]; Johnson (1985), eq. 4.44."""
        return 2 * self.pressure * self.radius / self.modulus

    def height(self) -> FloatArray:
        """Return the heights (nx, ny) of the longest patch [m]."""
        around = Grid((max(self.cells), self.across), (self.spacing, self.spacing), periodic=(True, True))
        return generate_surface(around, **self.surface)


CASES = {
    ROLLER: Case(
        Material("steel", youngs_modulus=207e9, poissons_ratio=0.3, hardness=7e9), 6e-3, 10e-3, 1.5e9,
        Lubricant(0.02, pressure_viscosity=21e-9, density_law="incompressible"), 0.12,
        7e9, 3.2e-6, (102, 128, 160, 224), 128, (1e-4, 1e-2),
        {"rms_height": 100e-9, "seed": 4, "correlation_length": 15e-6},
    ),
    CYLINDER: Case(
        Material("steel", youngs_modulus=210e9, poissons_ratio=0.3), 2e-3, 6e-3,
        math.sqrt(5.5 / 6e-3 * 115.385e9 / (math.pi * 2e-3)),
        Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"), 0.09, 6e9,
        0.45e-6, (60, 100, 200, 400), 200, (1e-3, 5e-2),
        {"rms_height": 100e-9, "seed": 1, "hurst": 0.8, "rolloff_wavelength": 20e-6, "cutoff_wavelength": 1.8e-6},
    ),
}  # fmt: skip


def row(name: str, height: FloatArray, cells: int, speed: float, counted: OilVolume) -> dict[str, float | str]:
    """The balance on a patch of so many cells along, cut from the middle of the heights [m]."""
    case = CASES[name]
    first = (max(case.cells) - cells) // 2
    solution = solve_mixed(
        height=height[first : first + cells],
        grid=Grid((cells, case.across), (case.spacing, case.spacing), periodic=(False, True)),
        bodies=(Body(case.steel), Body(case.steel)),
        radius=case.radius,
        width=case.width,
        load=math.pi * case.pressure**2 * case.radius * case.width / case.modulus,
        speeds=(speed, 0.0),
        lubricant=case.oil,
        boundary_friction=case.boundary_friction,
        hardness=case.hardness,
        film_points=800,
        oil_volume=counted,
    )
    return {
        "contact": name,
        "oil_volume": counted.value,
        "speed": speed,
        "length_um": 1e6 * cells * case.spacing,
        "length_over_hertz": float(cells * case.spacing / (2 * case.half_width)),
        "contact_share": solution.oil.contact_share,
        "film_load": float(solution.film_load),
        "loaded_contact_share": solution.oil.loaded_contact_share,
        "oil_beside_contact": solution.oil.share,
        "friction": float(solution.friction),
        "status": str(solution.status.value),
    }


def main() -> None:
    """Solve, print, store."""
    rows = []
    for name, case in CASES.items():
        height = case.height()
        for counted in OilVolume:
            for speed in case.speeds:
                for cells in case.cells:
                    rows.append(row(name, height, cells, speed, counted))
                    print(rows[-1], flush=True)
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
