"""Fit of the hardness curve of scene `tribofilm-macro` to the two wear depths of the source's table 3.

    python -m reports.experiments.tribofilm_hardness

About two minutes. The source only plots the curve. Film hardness and decay length are bounded by its words: 2 to 4 GPa,
fading over 100 to 300 nm. The contact of the scene is solved on a table of film thicknesses and hardnesses. Growth is
interpolated in that table, so that a fit costs no further contact. Wear at 80 degrees Celsius is not fitted.

`reports/results/tribofilm_hardness.json` has the fitted numbers, which of them lie on a bound, films and wear depths at
60, 80 and 100 degrees Celsius; the same with the factor of temperature on the film's part only; and both steady
thicknesses that wear as the source says.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import brentq, least_squares

from bem.grid import FloatArray
from bem.kinds.tribofilm.scene import TribofilmScene
from bem.runs import plan_scene
from bem.scenes import build
from bem.scenes.context import PlainContext
from bem.tribofilm import Constant, FadingSubstrate, evolve_film, solve_film_contact
from reports.experiments.kept import keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "tribofilm_hardness.json"
TEMPERATURES = (333.15, 353.15, 373.15)
MEASURED = {0: 86.3e-9, 2: 45.8e-9}
"""Wear depth between 45 and 120 minutes, table 3 of the source, by place in `TEMPERATURES` [m]."""
BOUNDS = ((2e9, 100e-9), (4e9, 300e-9))
"""Lower and upper bounds of film hardness [Pa] and decay length [m]."""
SUBSTRATE, SLOPE = 6e9, 1e-3
WEAR, CONCENTRATION = 6.9e-4, 1.24e7
THICKNESSES = 1e-9 * np.array([0, 20, 60, 110, 160, 220, 300, 400])
HARDNESSES = 1e9 * np.array([1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6])
TIMES = 60.0 * np.array([0, 22.5, 45, 82.5, 120])


def growth_table() -> list[RectBivariateSpline]:
    """Logarithm of the mean growth rate [m/s] over thickness and hardness, for each temperature."""
    scene = cast("TribofilmScene", plan_scene("tribofilm-macro", ['rubbing.temperatures=["60 degC"]'])[0])
    grid = build.grid_of(scene.grid)
    contact = scene.contact(grid, *build.both_heights(scene, grid, PlainContext(scene_seed=scene.seed)))
    logs = np.empty((len(TEMPERATURES), len(THICKNESSES), len(HARDNESSES)))
    for row, thickness in enumerate(THICKNESSES):
        pressure = None
        for column, hardness in enumerate(HARDNESSES):
            sample = solve_film_contact(replace(contact, hardness=Constant(hardness)), float(thickness), pressure)
            pressure = sample.pressure
            stress = contact.friction * pressure[pressure > 0]
            for place, temperature in enumerate(TEMPERATURES):
                logs[place, row, column] = math.log(contact.growth.rate(stress, temperature).mean())
    return [RectBivariateSpline(THICKNESSES, HARDNESSES, values) for values in logs]


def rate_of(spline: RectBivariateSpline, curve: FadingSubstrate, temperature: float) -> Callable[[float], float]:
    """Growth rate [m/s] as a function of thickness [m]."""
    return lambda h: math.exp(float(spline(max(h, 0.0), curve(h, temperature))[0, 0]))


def wear_and_films(table: list[RectBivariateSpline], curve: FadingSubstrate) -> FloatArray:
    """Film thickness after 120 minutes and wear depth from 45 to 120 minutes, (temperatures, 2) [m]."""
    rows = []
    for spline, temperature in zip(table, TEMPERATURES, strict=True):
        rate = rate_of(spline, curve, temperature)
        film = evolve_film(TIMES, rate, wear_coefficient=WEAR, concentration_constant=CONCENTRATION)
        rows.append((film.thickness[-1], film.wear_depth(TIMES[2], TIMES[-1])))
    return np.array(rows)


def fit(table: list[RectBivariateSpline], substrate_slope: float) -> dict[str, Any]:
    """Film hardness and decay length within `BOUNDS`, by relative least squares from the middle of both."""

    def curve(x: FloatArray) -> FadingSubstrate:
        return FadingSubstrate(SUBSTRATE, 1e9 * x[0], 1e-9 * x[1], SLOPE, substrate_temperature_slope=substrate_slope)

    def residuals(x: FloatArray) -> FloatArray:
        found = wear_and_films(table, curve(x))
        return np.array([found[place, 1] / depth - 1 for place, depth in MEASURED.items()])

    low, high = np.array(BOUNDS) * (1e-9, 1e9)
    found = least_squares(residuals, (low + high) / 2, bounds=(low, high), x_scale=(1.0, 100.0), diff_step=1e-3)
    films = 1e9 * wear_and_films(table, curve(found.x))
    return {
        "film_hardness_GPa": float(found.x[0]),
        "length_nm": float(found.x[1]),
        "on_a_bound": [
            name
            for name, x, *ends in zip(("film_hardness", "length"), found.x, low, high, strict=True)
            if any(math.isclose(x, end, rel_tol=1e-3) for end in ends)
        ],
        "film_nm": films[:, 0].tolist(),
        "wear_depth_nm": films[:, 1].tolist(),
    }


def steady_thicknesses(depth: float) -> list[float]:
    """Both steady films [nm] that wear a depth of substrate [m] from 45 to 120 minutes, at either side of 1/C1."""
    rate = depth / (TIMES[-1] - TIMES[2])

    def excess(h: float) -> float:
        return WEAR * h * math.exp(-CONCENTRATION * h) - rate

    return [1e9 * brentq(excess, *ends) for ends in ((0.0, 1 / CONCENTRATION), (1 / CONCENTRATION, 1e-6))]


def main() -> None:
    """Solve, fit, print, store."""
    table = growth_table()
    found = rounded(
        {
            "factor_on_the_whole_curve": fit(table, SLOPE),
            "factor_on_the_film": fit(table, 0.0),
            "steady_films_nm": {f"{1e9 * depth:.1f} nm": steady_thicknesses(depth) for depth in MEASURED.values()},
        }
    )
    for name, values in found.items():
        print(name, values)
    keep(RESULT, found)


if __name__ == "__main__":
    main()
