"""Derivatives of mixed points, against differences of balances solved anew."""

from dataclasses import replace

import numpy as np
import pytest
from mixed_case import STEEL, mixed_case

from bem import Body, Lubricant, Material, solve_mixed
from bem.friction.balance import Regime
from bem.friction.sensitivity import FIGURES, sensitivities

OIL = Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")
STEP = 3e-4
"""Between kinks: where a cell comes into contact the slope jumps, and steps of 1e-3 of a balance err by 4e-5 there."""


def case(speed, **more):
    return mixed_case(
        48, 1.5e-6, 12e-6, speeds=(speed, 0.0), boundary_friction=0.12, lubricant=OIL, tolerance=1e-9,
        contact_tolerance=1e-11, film_points=400,
    ) | more  # fmt: skip


def changed(arguments, name, factor):
    if name == "modulus":
        body = Body(replace(STEEL, youngs_modulus=factor * STEEL.youngs_modulus))
        return arguments | {"bodies": (body, body)}
    if name == "viscosity":
        return arguments | {"lubricant": replace(OIL, viscosity=factor * OIL.viscosity)}
    return arguments | {name: factor * arguments[name]}


def figures(solution):
    area = 0.0 if solution.contact is None else solution.contact.contact_area
    return {
        "friction": solution.friction,
        "boundary_part": solution.boundary_force / solution.load,
        "film_part": solution.film_force / solution.load,
        "contact_load": solution.contact_load,
        "film_load": solution.film_load,
        "minimum_film": solution.minimum_film,
        "lambda_ratio": solution.lambda_ratio,
        "contact_area_fraction": area / solution.grid.area,
    }


@pytest.mark.parametrize(
    ("speed", "more", "regime", "within"),
    [
        (0.5, {}, Regime.MIXED, 1e-5),
        (0.02, {"hardness": 1.2e9}, Regime.MIXED, 1e-5),
        (0.5, {"oil_volume": "loaded"}, Regime.MIXED, 1e-5),
        (3.0, {}, Regime.FULL_FILM, 1e-6),
    ],
)
def test_mixed_points_against_differences(speed, more, regime, within):
    """Measured: at most 6e-6, of the contact area with the loaded zone's oil; 2e-6 of all other figures."""
    arguments = case(speed, **more)
    solution = solve_mixed(**arguments)
    assert solution.regime is regime
    found, sizes = sensitivities(solution, **arguments), figures(solution)
    modulus = STEEL.youngs_modulus / (1 - STEEL.poissons_ratio**2) / 2
    inputs = {"height": 1.0, "modulus": modulus, "viscosity": OIL.viscosity}
    for name in ("load", "height", "modulus", "hardness", "viscosity"):
        value = inputs.get(name) or arguments[name]
        ends = [figures(solve_mixed(**changed(arguments, name, 1 + sign * STEP), initial=solution)) for sign in (-1, 1)]
        for figure in FIGURES:
            expected = (ends[1][figure] - ends[0][figure]) / (2 * STEP)
            assert abs(getattr(getattr(found, name), figure) * value - expected) <= within * (sizes[figure] or 1.0)


def test_elastic_surfaces_have_no_derivative_by_hardness_and_hot_films_have_others():
    lubricant = Lubricant.of("ISO VG 32", temperature=353.15)
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, thermal_conductivity=46, density=7850,
                     heat_capacity=460)  # fmt: skip
    arguments = case(
        1.0, hardness=None, thermal="lumped", lubricant=lubricant, bodies=(Body(steel), Body(steel)), tolerance=1e-4,
        contact_tolerance=1e-6,
    )  # fmt: skip
    solution = solve_mixed(**arguments)
    found = sensitivities(solution, **arguments)
    assert found.hardness is None
    step = 0.05
    ends = [
        solve_mixed(**arguments | {"lubricant": replace(lubricant, viscosity=(1 + sign * step) * lubricant.viscosity)})
        for sign in (-1, 1)
    ]
    expected = (ends[1].friction - ends[0].friction) / (2 * step * lubricant.viscosity)
    assert found.viscosity.friction == pytest.approx(expected, rel=0.1, abs=0)
    assert np.sign(found.viscosity.lambda_ratio) == 1
