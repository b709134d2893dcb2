"""Laws of boundary friction over pressure, speed and temperature: closed forms, at each cell, in scenes."""

import math

import numpy as np
import pytest
from mixed_case import mixed_case

from bem import InputError, Lubricant, solve_mixed
from bem.friction.boundary import (
    ActivatedShear,
    FrictionOverPressure,
    PressureDependentShear,
    boundary_law,
    filled_part,
)
from bem.lubrication.shear import Newtonian
from bem.physical_constants import BOLTZMANN
from bem.scenes import load_scene

CASE = mixed_case(48, 2e-6, 6e-6, speeds=(0.003, 0.0))
GRID = CASE["grid"]
OIL = Lubricant(0.01, pressure_viscosity=20e-9, shear_law=Newtonian(), temperature=333.15, density_law="incompressible")
P = np.array([1e6, 3e8, 5e9])


@pytest.mark.internal
@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (
            {
                "kind": "pressure_limited",
                "shear_strength": 1e6,
                "pressure_coefficient": 0.1,
                "largest_shear_stress": 4e8,
            },
            np.minimum(1e6 + 0.1 * P, 4e8),
        ),
        (
            {"kind": "speed_dependent", "static_friction": 0.15, "kinetic_friction": 0.05, "speed_scale": 0.02},
            (0.05 + 0.10 * math.exp(-0.5)) * P,
        ),
        (
            {
                "kind": "temperature_dependent",
                "friction": 0.12,
                "softening": 0.004,
                "reference_temperature": 293.15,
            },
            0.12 * math.exp(-0.004 * 40) * P,
        ),
        (
            {"kind": "table_over_pressure", "pressures": [0, 1e9], "coefficients": [0.2, 0.1]},
            np.array([0.2 - 0.1 * 1e-3, 0.17, 0.1]) * P,
        ),
        ({"kind": "table_over_speed", "sliding_speeds": [0, 0.02], "coefficients": [0.2, 0.1]}, 0.15 * P),
        (
            {"kind": "table_over_temperature", "temperatures": [293.15, 373.15], "coefficients": [0.2, 0.1]},
            0.15 * P,
        ),
    ],
    ids=lambda value: value["kind"] if isinstance(value, dict) else "",
)
def test_closed_forms_at_one_centimetre_per_second_and_60_degrees(law, expected):
    stress = boundary_law(law).at_temperature(333.15).shear_stress(P, 0.01)
    np.testing.assert_allclose(stress, expected, rtol=1e-14)


@pytest.mark.internal
def test_activated_shear_rises_with_pressure_and_log_speed_and_falls_with_temperature():
    # a barrier of 0.6 eV and volumes of molecules; Briscoe and Evans found tau linear in p, T and ln u
    law = ActivatedShear(
        activation_energy=1e-19, pressure_volume=1e-29, shear_volume=4e-27, reference_speed=20.0
    ).at_temperature(300.0)
    at = law.shear_stress(np.array([1e8, 2e8]), 0.1)
    assert (at[1] - at[0]) / 1e8 == pytest.approx(1e-29 / 4e-27, rel=1e-9)
    faster = law.shear_stress(np.array([1e8]), 0.1 * math.e)
    assert faster[0] - at[0] == pytest.approx(BOLTZMANN * 300 / 4e-27, rel=1e-9)
    hotter = law.at_temperature(330.0).shear_stress(np.array([1e8]), 0.1)
    assert hotter[0] - at[0] == pytest.approx(BOLTZMANN * 30 * math.log(0.1 / 20) / 4e-27, rel=1e-9)
    assert law.at_temperature(3000.0).shear_stress(np.array([1e5]), 1e-9)[0] == 0.0


@pytest.mark.internal
@pytest.mark.parametrize("model", ["coupled", "uncoupled"])
def test_the_law_is_taken_at_every_cells_own_pressure(model):
    law = {
        "kind": "pressure_limited",
        "shear_strength": 50e6,
        "pressure_coefficient": 0.08,
        "largest_shear_stress": 2e8,
    }
    point = solve_mixed(**CASE, lubricant=OIL, boundary_friction=law, contact_model=model)
    filled = filled_part(point.contact.pressure, point.contact.contact_area, GRID)
    local = point.contact_pressure[point.contact_pressure > 0] / filled
    stress = np.minimum(50e6 + 0.08 * local, 2e8)
    slices = 6e-3 / GRID.lengths[1]
    # sums of two thousand cells
    assert point.boundary_force == pytest.approx(filled * stress.sum() * GRID.cell_area * slices, rel=1e-9)
    assert (stress == 2e8).any()
    assert (stress < 2e8).any()
    uncut = PressureDependentShear(shear_strength=50e6, pressure_coefficient=0.08)
    assert solve_mixed(**CASE, lubricant=OIL, boundary_friction=uncut, contact_model=model).friction > point.friction


@pytest.mark.internal
def test_a_table_of_a_constant_is_the_coefficient_and_temperature_reaches_the_contact():
    table = FrictionOverPressure(pressures=(0.0, 1e10), coefficients=(0.1, 0.1))
    one, other = (solve_mixed(**CASE, lubricant=OIL, boundary_friction=law) for law in (table, 0.1))
    assert one.friction == pytest.approx(other.friction, rel=1e-9)
    law = {"kind": "table_over_temperature", "temperatures": [293.15, 373.15], "coefficients": [0.2, 0.1]}
    warm = solve_mixed(**CASE, lubricant=OIL, boundary_friction=law)
    assert warm.boundary_force == pytest.approx(0.15 * warm.contact_load, rel=1e-9)
    total = warm.boundary_shear_stress.sum() * GRID.cell_area * 6e-3 / GRID.lengths[1]
    assert total == pytest.approx(warm.boundary_force, rel=1e-9)
    with pytest.raises(InputError, match="needs the temperature of the oil") as caught:
        solve_mixed(**CASE, lubricant=Lubricant(0.01, density_law="incompressible"), boundary_friction=law)
    assert len(caught.value.messages) == 1


@pytest.mark.internal
@pytest.mark.parametrize(
    ("law", "words"),
    [
        ({"kind": "table_over_speed", "sliding_speeds": [0, 1], "coefficients": [0.1]}, "2 values and 1 coefficients"),
        ({"kind": "table_over_speed", "sliding_speeds": [1, 0], "coefficients": [0.1, 0.2]}, "do not rise"),
        ({"kind": "table_over_speed", "sliding_speeds": [0, 1]}, "coefficients is missing"),
        ({"kind": "speed_dependant"}, "did you mean 'speed_dependent'"),
        ({"kind": "pressure_limited", "shear_strength": 1, "pressure_coefficient": 0.1}, "largest_shear_stress"),
    ],
)
def test_bad_laws_are_one_message(law, words):
    with pytest.raises(InputError) as caught:
        boundary_law(law)
    assert len(caught.value.messages) == 1
    assert words in caught.value.messages[0]


def test_laws_in_scenes_with_units():
    law = '{ kind = "table_over_temperature", temperatures = ["20 C", "100 C"], coefficients = [0.2, 0.1] }'
    oil = '{ grade = "ISO VG 68", temperature = "60 C" }'
    scene = load_scene("stribeck-mineral-oil", [f"contact.boundary_friction={law}", f"oil={oil}"])
    made = scene.contact.boundary_friction
    assert made.temperatures == (293.15, 373.15)
    assert scene.contact.nominal_friction(5.5, 115e9, (0.1, 0.0), scene.oil.temperature) == pytest.approx(0.15)
