"""Films with heat from nothing: random contacts over loads, oils, slide-to-roll ratios and temperatures.

    python -m reports.experiments.thermal_films

A quarter of an hour for each model. What converges is solved once more on twice the points: a film or a friction that
then differs by more than `FALSE` did not converge, whatever was said. The result is stored in
`reports/results/thermal_films.json`: a row for each contact, and counts.
"""

from __future__ import annotations

import math
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from bem import Lubricant, solve_full_thermal_line_film, solve_line_film, solve_thermal_line_film
from bem.errors import InputError, Status
from reports.experiments.kept import keep
from reports.experiments.lumped_heat import MODULUS, RADIUS, of_moes

RESULT = Path(__file__).resolve().parents[1] / "results" / "thermal_films.json"
MODELS = {"lumped": solve_thermal_line_film, "full": solve_full_thermal_line_film}
LOADS, OILS, RATIOS, TEMPERATURES = (0.01, 5000.0), (0.0, 25.0), (0.0, 2.0), (293.15, 423.15)
"""Moes' M (evenly over its logarithm) and L, slide-to-roll ratio, temperature of oil and bodies [K]."""
NAMES = ("ISO VG 10", "ISO VG 32", "ISO VG 68", "ISO VG 100", "ISO VG 320", "PAO 4")
DENSITIES, SHEARS = ("incompressible", "dowson_higginson"), ("limited", "eyring")
CONTACTS, SEED, POINTS = 120, 16, 400
FALSE = 0.05
MACHINES = (4e9, 50.0)
"""Hertz pressure [Pa] and mean speed [m/s] up to which a contact is one that machines have."""


def case(rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, Any]]:
    """What describes a contact, and the arguments of either solver."""
    load, oil = math.exp(rng.uniform(*np.log(LOADS))), rng.uniform(*OILS)
    ratio, temperature, name = rng.uniform(*RATIOS), rng.uniform(*TEMPERATURES), str(rng.choice(NAMES))
    laws: dict[str, Any] = {"density_law": str(rng.choice(DENSITIES)), "shear_law": str(rng.choice(SHEARS))}
    strength = {"shear_stress_limit": 5e6} if laws["shear_law"] == "eyring" else {}
    lubricant = Lubricant.of(name, temperature=temperature, **laws, **strength)
    asked = of_moes(lubricant, load, oil, ratio)
    hertz = math.sqrt(asked["load"] * MODULUS / (math.pi * RADIUS))
    said = {"M": load, "L": oil, "slide_roll_ratio": ratio, "temperature_C": temperature - 273.15, "oil": name, **laws}
    return said | {"hertz_pressure_GPa": hertz / 1e9, "mean_speed": 0.5 * sum(asked["speeds"])}, asked


def tried(model: str, asked: dict[str, Any]) -> dict[str, Any]:
    """A contact with a model of heat: how it ends, at what cost, and what twice the points say of it."""
    cold = solve_line_film(**{name: value for name, value in asked.items() if name != "bodies"}, points=POINTS)
    try:
        found: Any = MODELS[model](**asked, points=POINTS)
    except InputError as error:
        return {"status": "refused", "words": str(error)}
    row = {
        "status": found.status.value,
        "central_thickness": found.central_thickness,
        "traction": found.shear_force / asked["load"],
        "steps": found.iterations,
        "isothermal_steps": cold.iterations,
        "isothermal": cold.status.value,
        "hottest_K": float(max(found.film_temperature.max(), found.surface_temperatures.max())),
    }
    if model == "full":
        row |= {"rounds": found.rounds, "residual": found.residual, "energy_imbalance": found.energy_imbalance}
    if found.status is not Status.CONVERGED:
        return row | {"words": found.notes[-1] if found.notes else ""}
    finer: Any = MODELS[model](**asked, points=2 * POINTS)
    return row | {
        "finer": finer.status.value,
        "film_change": finer.central_thickness / found.central_thickness - 1,
        "friction_change": (finer.shear_force - found.shear_force) / abs(found.shear_force),
    }


def is_false(row: dict[str, Any]) -> bool:
    """Whether a film is called converged and is another one on twice the points."""
    if row["status"] != Status.CONVERGED.value or row["finer"] != Status.CONVERGED.value:
        return False
    return max(abs(row["film_change"]), abs(row["friction_change"])) > FALSE


def counts(contacts: list[dict[str, Any]], model: str) -> dict[str, Any]:
    """How many end in which way; of those that machines have; falsely converged; and at which cost."""
    pressure, speed = MACHINES
    ordinary = [one for one in contacts if one["hertz_pressure_GPa"] * 1e9 <= pressure and one["mean_speed"] <= speed]
    ends = [Counter(one[model]["status"] for one in some) for some in (contacts, ordinary)]
    cost = [
        one[model]["steps"] / one[model]["isothermal_steps"]
        for one in contacts
        if one[model]["status"] == Status.CONVERGED.value
    ]
    return {
        "all": dict(ends[0]),
        "of_machines": dict(ends[1]),
        "falsely_converged": sum(is_false(one[model]) for one in contacts),
        "steps_over_isothermal_median_and_most": [float(np.median(cost)), max(cost)] if cost else [],
    }


def main(count: int = CONTACTS) -> None:
    """Try them all and store what came out."""
    rng, contacts = np.random.default_rng(SEED), []
    for _ in range(count):
        said, asked = case(rng)
        contacts.append(said | {model: tried(model, asked) for model in MODELS})
        print(contacts[-1], flush=True)
    keep(RESULT, {"contacts": contacts, "counts": {model: counts(contacts, model) for model in MODELS}})


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CONTACTS)
