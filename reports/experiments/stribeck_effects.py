"""What the thesis' Stribeck curves neglect, one effect at a time: shear law, heat, starvation, rough walls, and all.

    python -m reports.experiments.stribeck_effects

Minutes. Two contacts of paper A, a 2 mm cylinder 6 mm wide in 0.36 Pa s, pure sliding, boundary friction 0.09: that of
figures 8 to 10 (5.5 N, Sq 100 nm, capped at the hardness, 0.13 GPa), and that of figures 5 and 6 at 1 GPa (Sq 240 nm,
waves of 34 um, elastic; Dowson-Higginson's density, without which the spike of such a film has no limit). As in the
source (Newtonian, at one temperature, flooded, smooth walls), with a shear law (at most 3 MPa + 0.08 p, the default, or
Eyring's of 5 MPa), and, with the Newtonian oil or at 1 GPa with the limited one,

- heat: inlet heating, temperatures of film and contact (a mineral oil's heat constants, 0.06 1/K, bodies of steel);
- starvation: a layer of 0.5 um;
- flow factors of the same surfaces, as deformed in their contact;
- limit, heat and flow factors together (a starved film has no heat here).

The result is stored in `reports/results/stribeck_effects.json`, which the validation page shows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Lubricant, Material, generate_surface, stribeck_curve
from bem.flow import factors_for_films
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "stribeck_effects.json"
SEED = 1
STEEL = Material(
    "steel", youngs_modulus=210.21e9, poissons_ratio=0.3, thermal_conductivity=46.0, density=7800.0, heat_capacity=470.0
)
SOURCE, LIMIT = "as in the source", "limiting shear stress"
LAYER = 0.5e-6
CAPPED, RADIUS, WIDTH = 6e9, 2e-3, 6e-3
MODULUS = STEEL.plane_strain_modulus / 2
LIMITED: dict[str, Any] = {"viscosity": 0.36, "pressure_viscosity": 25e-9, "density_law": "incompressible"}
NEWTONIAN: dict[str, Any] = LIMITED | {"shear_law": "newtonian"}
EYRING: dict[str, Any] = NEWTONIAN | {"shear_law": "eyring", "shear_stress_limit": 5e6}
WARM: dict[str, Any] = {
    "temperature": 296.15, "density": 880.0, "heat_capacity": 1900.0, "thermal_conductivity": 0.13,
    "temperature_viscosity": 0.06,
}  # fmt: skip


@dataclass(frozen=True)
class Compared:
    """A contact: cells along and across, their size [m], its surface (keywords of `generate_surface`), load [N], cap of
    the pressure [Pa], speeds [m/s], keywords of its oil; `base`, the curve that all but shear laws are beside."""

    cells: int
    spacing: float
    surface: dict[str, float]
    load: float
    hardness: float | None
    speeds: tuple[float, ...]
    oil: dict[str, Any]
    base: str

    @property
    def grid(self) -> Grid:
        """Of the patch."""
        return Grid((self.cells, self.cells), (self.spacing, self.spacing), periodic=(False, True))

    def height(self) -> Any:
        """Of both surfaces together (nx, ny) [m]."""
        around = Grid(self.grid.shape, self.grid.spacing, periodic=(True, True))
        return generate_surface(around, seed=SEED, **self.surface)


CONTACTS = {
    "5.5 N (0.13 GPa), Sq 100 nm": Compared(
        200, 0.45e-6, {"rms_height": 100e-9, "hurst": 0.8, "rolloff_wavelength": 20e-6, "cutoff_wavelength": 3e-6},
        5.5, CAPPED, tuple(float(speed) for speed in np.geomspace(1e-3, 1.0, 10)), {}, SOURCE,
    ),
    "1 GPa, Sq 240 nm": Compared(
        136, 3e-6, {"rms_height": 240e-9, "correlation_length": 34e-6}, math.pi * RADIUS * 1e18 / MODULUS * WIDTH, None,
        tuple(float(speed) for speed in np.geomspace(3e-3, 3.0, 7)), {"density_law": "dowson_higginson"}, LIMIT,
    ),
}  # fmt: skip


def effects(contact: Compared, factors: Any) -> dict[str, dict[str, Any]]:
    """What each curve has beside the source's, as arguments of `stribeck_curve`."""
    newtonian, limited, eyring = (law | contact.oil for law in (NEWTONIAN, LIMITED, EYRING))
    base = newtonian if contact.base == SOURCE else limited
    return {
        SOURCE: {"lubricant": Lubricant(**newtonian)},
        LIMIT: {"lubricant": Lubricant(**limited)},
        "Eyring's law": {"lubricant": Lubricant(**eyring)},
        "heat": {"lubricant": Lubricant(**base, **WARM), "thermal": "lumped"},
        "starved, a layer of 0.5 um": {"lubricant": Lubricant(**base), "supply": LAYER},
        "flow factors": {"lubricant": Lubricant(**base), "flow_factors": factors},
        "limit, heat, flow factors": {
            "lubricant": Lubricant(**limited, **WARM), "thermal": "lumped", "flow_factors": factors
        },
    }  # fmt: skip


def curves(
    contact: Compared, names: Sequence[str] | None = None, speeds: Sequence[float] | None = None
) -> list[dict[str, Any]]:
    """All curves of one contact, or the named ones, at all its speeds or at these [m/s]."""
    speeds = contact.speeds if speeds is None else speeds
    bodies, height = (Body(STEEL), Body(STEEL)), contact.height()
    factors = factors_for_films(height, np.zeros_like(height), contact.grid, bodies, hardness=contact.hardness)
    given: dict[str, Any] = {
        "height": height, "grid": contact.grid, "bodies": bodies, "radius": RADIUS, "width": WIDTH,
        "load": contact.load, "boundary_friction": 0.09, "hardness": contact.hardness, "film_points": 800,
        "oil_volume": "patch",
    }  # fmt: skip
    found = []
    for name, changes in effects(contact, factors).items():
        if names is not None and name not in names:
            continue
        points = stribeck_curve(speeds, **given, **changes)
        rows = {
            "friction": [float(point.friction) for point in points],
            "contact_share": [float(point.contact_load / point.load) for point in points],
            "minimum_film": [float(point.minimum_film) for point in points],
            "status": [str(point.status.value) for point in points],
        }
        found.append({"name": name, "speeds": list(speeds), **rows})
        print(name, rows)
    return found


def main() -> None:
    """Solve all curves, print, store."""
    keep(RESULT, {name: {"base": one.base, "curves": curves(one)} for name, one in CONTACTS.items()})


if __name__ == "__main__":
    main()
