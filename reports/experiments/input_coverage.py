"""First-order errors by uncertain inputs against Monte Carlo draws of the inputs.

A rough contact and one mixed point of a Stribeck curve are run with `uncertain`, and then 200 times with inputs drawn
from normal distributions of these deviations. The table has, for each figure, the standard deviation of the draws over
the first-order one, the fraction of draws within one and two first-order deviations of the central value (68 and 95 %
of a normal distribution), and the shift of the mean of the draws, in first-order deviations.

    python -m reports.experiments.input_coverage
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bem.campaigns import campaign_of, compute
from bem.scenes import get_kind, load_scene
from bem.scenes.records import INPUTS
from bem.scenes.uncertain import deviations, moved
from reports.experiments.kept import keep, result_of, rounded

DRAWS, SEED = 200, 46
CASES: Mapping[str, tuple[str, Sequence[str], Sequence[str]]] = {
    "contact": (
        "uncertain-contact",
        ["grid.shape=64"],
        ["contact_area_fraction", "max_pressure", "mean_contact_pressure", "mean_gap", "approach"],
    ),
    "mixed point": (
        "stribeck-mineral-oil",
        [
            "repetitions=1",
            'speeds=["0.05 m/s"]',
            'sharing.models=["capped"]',
            "grid.shape=100",
            "film.points=400",
            'uncertain={"oil.viscosity"="5 %","lower.surface.rms_height"="5 %","contact.boundary_friction"="0.005",'
            '"contact.loads"="2 %"}',
        ],
        ["friction", "contact_load", "film_load", "minimum_film", "lambda_ratio", "contact_area_fraction"],
    ),
}


def judged(name: str) -> dict[str, dict[str, float]]:
    """Return the comparison of a case by its figures."""
    scene_name, settings, figures = CASES[name]
    scene = get_kind("contact" if name == "contact" else "friction").resolved(
        load_scene(scene_name, [*settings, "outputs.errors=false"])
    )
    central = compute(campaign_of(scene)).outcome.variables
    rng = np.random.default_rng(SEED)
    drawn: dict[str, list[float]] = {figure: [] for figure in figures}
    for _ in range(DRAWS):
        one: Any = scene
        for key, deviation in deviations(scene).items():
            one = moved(one, key, deviation, float(rng.standard_normal()))
        values = compute(campaign_of(one.model_copy(update={"uncertain": None}))).outcome.variables
        for figure in figures:
            drawn[figure].append(_value(values, figure))
    found = {}
    for figure in figures:
        values = np.array(drawn[figure])
        middle, deviation = _value(central, figure), _value(central, f"{figure}{INPUTS}")
        distance = np.abs(values - middle) / deviation
        found[figure] = {
            "relative deviation": deviation / abs(middle),
            "draws over first order": float(values.std(ddof=1)) / deviation,
            "within one deviation": float(np.mean(distance <= 1)),
            "within two deviations": float(np.mean(distance <= 2)),
            "shift of the mean": float(values.mean() - middle) / deviation,
        }
    return found


def _value(variables: Mapping[str, Any], name: str) -> float:
    return float(np.ravel(variables[name].values)[0])


def main() -> None:
    """Run all cases and store the table."""
    tables = {name: judged(name) for name in CASES}
    for name, table in tables.items():
        print(name)
        for figure, row in table.items():
            print(f"  {figure:24s}", "  ".join(f"{key} {value:.3g}" for key, value in row.items()))
    keep(result_of("input_coverage"), rounded({"draws": DRAWS, **tables}))


if __name__ == "__main__":
    main()
