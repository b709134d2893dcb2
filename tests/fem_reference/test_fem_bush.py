"""Shaft and bush in the finite-element reference: the stored figures against the closed form of equal bodies."""

import numpy as np
import pytest
from interpreter import STORED, fem

from bem.reference_solutions.pin_in_hole import load_of_angle, pressure_at
from fem_reference.results import read

CASES = ("bush-plain", "bush-peek", "bush-peek-wide", "bush-low-nu", "bush-high-nu-rigid")


@pytest.mark.parametrize("case", CASES)
def test_the_case_passes_its_checks_with_clean_orders(case):
    result = read(STORED / f"{case}.json")
    assert len(result.checks) == 3 * len(result.parameters["loads"])
    for check in result.checks.values():
        assert abs(check["value"] - check["expected"]) <= check["tolerance"]
    half_angle, central = result.quantity("half_angle"), result.quantity("central_pressure")
    # the edge is known to a part of a cell, the pressure in the middle to its square
    assert 0.8 < half_angle.order < 1.5
    assert 1.7 < central.order < 2.3
    assert max(half_angle.error_bar) < 1e-3 * max(half_angle.values)
    assert max(central.error_bar) < 1e-4 * max(central.values)
    for curve in result.quantities[2:]:
        assert len(curve.values) > 4
        assert max(curve.error_bar) < 5e-4 * max(curve.values)


def test_equal_bodies_are_the_closed_form():
    """Persson's pressure of a pin in a hole of its own material, from 20 to 47 degrees."""
    result = read(STORED / "bush-plain.json")
    stiffness, unit = 1 / (1 - 0.3**2), 0.5 / (1 - 0.3**2)  # of one body, and E* of both
    for index, load in enumerate(result.parameters["loads"]):
        low, high = 0.01, 1.5
        for _ in range(60):
            half = 0.5 * (low + high)
            found = load_of_angle(half, modulus=stiffness, alpha=0.0, clearance=1.0)
            low, high = (half, high) if found < unit * load else (low, half)
        edge = result.quantity("half_angle")
        assert abs(edge.values[index] - half) < 1.5 * edge.error_bar[index]
        curve = result.quantity("pressure", f"surface at load {load:g}")
        angles = np.array(curve.coordinates)[:, 0]
        exact = pressure_at(angles, half_angle=half, load=load, radius=1.0)
        assert np.all(np.abs(curve.values - exact) < 1.5 * np.array(curve.error_bar))


@pytest.mark.fem
def test_a_stored_bush_reproduces():
    assert "reproduces" in fem(
        "-m", "fem_reference", "bush-high-nu-rigid", "--check", str(STORED / "bush-high-nu-rigid.json")
    )


@pytest.mark.fem
def test_bad_input_is_refused():
    assert "a housing needs a wall" in fem("-m", "fem_reference", "bush", "--housing", "2", "0.3", code=2)
    assert "of more than 80 degrees" in fem("-m", "fem_reference", "bush", "--loads", "50", code=2)
