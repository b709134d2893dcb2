"""Bands of heat on a moving half-space: quadrature of Jaeger's line source, and the solver on a grid."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0
from unit_body import UNIT

from bem.errors import InputError
from bem.grid import Grid
from bem.heat import surface_temperature
from bem.heat.bodies import Conductor
from bem.heat.line_contact import band_temperatures

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("speed", [0.3, 4.0, -4.0, 60.0])
def test_bands_are_quadrature_of_the_line_source(speed):
    body = Conductor(conductivity=2.0, diffusivity=0.5, speed=speed, bulk=0.0)
    edges = np.array([-1.0, -0.4, 0.1, 0.8])
    found = band_temperatures(edges, body)
    middle, w = 0.5 * (edges[1:] + edges[:-1]), speed / (2 * 0.5)
    for i, x in enumerate(middle):
        for j in range(3):
            inside = [x] if i == j else None
            value = quad(
                lambda s, x=x: math.exp(w * (x - s)) * k0(abs(w * (x - s))), *edges[j : j + 2], points=inside, limit=200
            )[0]
            assert found[i, j] == pytest.approx(value / (math.pi * 2.0), rel=1e-7, abs=1e-12)


@pytest.mark.parametrize("speed", [2.0, -20.0])
def test_bands_are_those_of_a_grid_that_goes_on_along_y(speed):
    """The solver on a grid, by another integral (over time), of the same unit body."""
    grid = Grid((64, 2), spacing=(0.1, 0.1), periodic=(False, True))
    heat = np.exp(-((grid.x / 1.1) ** 2))
    expected = surface_temperature(heat[:, None] * np.ones((1, 2)), grid, UNIT, speeds=speed).temperature[:, 0]
    edges = np.append(grid.x - 0.05, grid.x[-1] + 0.05)
    found = band_temperatures(edges, Conductor(1.0, 1.0, speed, 0.0)) @ heat
    # the same cells under the same flux
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


def test_a_body_at_rest_is_refused():
    with pytest.raises(InputError, match="at rest"):
        band_temperatures(np.array([0.0, 1.0]), Conductor(1.0, 1.0, 0.0, 0.0))
