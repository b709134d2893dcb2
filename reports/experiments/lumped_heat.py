"""What the lumped model of heat misses of the full one, over Moes' M and L and the slide-to-roll ratio.

    python -m reports.experiments.lumped_heat

Some two minutes. ISO VG 68 at 60 degrees Celsius between steel bodies of 10 mm, Eyring's law; speed and load follow
from L and M. The result is stored in `reports/results/lumped_heat.json`, which the documentation shows.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from bem import Lubricant, solve_full_thermal_line_film, solve_thermal_line_film
from bem.errors import InputError, Status
from bem.materials import CATALOGUE, Body
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "lumped_heat.json"
MODULUS, RADIUS, SUPPLY = 115.5e9, 0.01, 333.15
LOADS = (0.02, 0.1, 0.5, 1.5, 5.0, 30.0, 200.0)
OILS = (8.0, 12.0, 16.0, 20.0)
RATIOS = (0.0, 0.02, 0.1, 0.5, 1.0, 2.0)


def case(load: float, oil: float, ratio: float, points: int) -> dict[str, Any]:
    """Arguments of either solver at M, L and a slide-to-roll ratio."""
    lubricant = Lubricant.of(
        "ISO VG 68", temperature=SUPPLY, density_law="dowson_higginson", shear_law="eyring", shear_stress_limit=5e6
    )
    return of_moes(lubricant, load, oil, ratio) | {"points": points}


def of_moes(lubricant: Lubricant, load: float, oil: float, ratio: float) -> dict[str, Any]:
    """Of any oil between these bodies."""
    twice, steel = 2 * MODULUS, Body(CATALOGUE["steel-52100"].material)
    number = (oil / (lubricant.pressure_viscosity * twice)) ** 4
    mean = 0.5 * number * twice * RADIUS / lubricant.viscosity
    return {
        "load": load * math.sqrt(number) * twice * RADIUS,
        "radius": RADIUS,
        "contact_modulus": MODULUS,
        "speeds": (mean * (1 + ratio / 2), mean * (1 - ratio / 2)),
        "lubricant": lubricant,
        "bodies": (steel, steel),
    }


def row(load: float, oil: float, ratio: float, points: int = 400) -> dict[str, Any]:
    """Both models' film, friction and rise of the oil's mean temperature; a status that is not converged is told."""
    asked = case(load, oil, ratio, points)
    hertz = math.sqrt(asked["load"] * MODULUS / (math.pi * RADIUS))
    out: dict[str, Any] = {"M": load, "L": oil, "slide_roll_ratio": ratio, "hertz_pressure": hertz}
    out["mean_speed"] = 0.5 * sum(asked["speeds"])
    for name, solve in (("full", solve_full_thermal_line_film), ("lumped", solve_thermal_line_film)):
        try:
            found: Any = solve(**asked)
        except InputError as error:
            out[name] = {"status": str(error)}
            continue
        out[name] = {
            "status": str(found.status.value),
            "central_thickness": found.central_thickness,
            "traction": found.shear_force / asked["load"],
            "rise": found.mean_film_temperature - SUPPLY,
            "steps": found.iterations,
        }
    both = all(out[name]["status"] == Status.CONVERGED.value for name in ("full", "lumped"))
    if both:
        full, lumped = out["full"], out["lumped"]
        out["film_error"] = lumped["central_thickness"] / full["central_thickness"] - 1
        out["traction_error"] = lumped["traction"] / full["traction"] - 1
        out["rise_error"] = lumped["rise"] - full["rise"]
    return out


def main() -> None:
    """Solve, print, store."""
    rows = []
    for oil in OILS:
        for load in LOADS:
            for ratio in RATIOS:
                rows.append(row(load, oil, ratio))
                print({key: value for key, value in rows[-1].items() if not isinstance(value, dict)}, flush=True)
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
