"""Surface temperature over time: one-dimensional heating, a disc at rest, waves, and the steady state in the end."""

import itertools
import math

import numpy as np
import pytest
from scipy.special import erfc
from unit_body import UNIT, body

from bem import Grid, InputError, Status, surface_temperature, surface_temperature_history
from bem.verification.patches import disc_means, free_grid


@pytest.mark.parametrize("speed", [0.0, 3.0])
def test_uniform_heat_is_one_dimensional(speed):
    """2 q sqrt(kappa t / pi) / k: Carslaw and Jaeger, section 2.9; motion along the surface does nothing."""
    grid = Grid((6, 4), (0.1, 0.2), periodic=(True, True))
    times = np.linspace(0.0, 2.0, 9)
    found = surface_temperature_history(times, np.ones((8, 6, 4)), grid, body(2.0, 5.0), speeds=speed)
    exact = 2 * np.sqrt(2.0 / 5.0 * times[1:] / math.pi) / 2.0
    assert np.abs([one.temperature - t for one, t in zip(found, exact, strict=True)]).max() < 1e-13


def test_uniform_heat_between_two_bodies_goes_by_their_effusivities():
    grid = Grid((4, 4), (0.1, 0.1), periodic=(True, True))
    found = surface_temperature_history([0.0, 1.0, 2.0], np.ones((2, 4, 4)), grid, (body(4.0), UNIT), speeds=(0.0, 9.0))
    for one in found:
        assert np.abs(one.partition - 2 / 3).max() < 1e-8
        assert one.status is Status.CONVERGED


def test_middle_of_a_disc_at_rest():
    """2 q sqrt(kappa t) / k [1/sqrt(pi) - ierfc(a / (2 sqrt(kappa t)))]: Carslaw and Jaeger, section 10.5."""
    where = free_grid(1 / 40, (-1.0, 1.0), (-1.0, 1.0))
    heat = disc_means(where, "uniform")
    times = np.linspace(0.0, 4.0, 5)
    found = [one.temperature[where.origin] for one in
             surface_temperature_history(times, [heat] * 4, where.grid, UNIT, speeds=0.0)]  # fmt: skip
    z = 1 / (2 * np.sqrt(times[1:]))
    ierfc = np.exp(-(z**2)) / math.sqrt(math.pi) - z * erfc(z)
    exact = 2 * np.sqrt(times[1:]) * (1 / math.sqrt(math.pi) - ierfc)
    assert np.abs(found / exact - 1).max() < 5e-4  # cells of 1/40 of the radius


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_steps_do_not_matter_while_the_heat_is_the_same(periodic):
    grid = Grid((10, 6), (0.1, 0.2), periodic=periodic)
    heat = np.random.default_rng(3).random(grid.shape)
    one = surface_temperature_history([0.0, 1.6], heat[None], grid, UNIT, speeds=3.0)[-1]
    many = surface_temperature_history(np.linspace(0.0, 1.6, 9), lambda t: heat, grid, UNIT, speeds=3.0)[-1]
    assert np.abs(one.temperature - many.temperature).max() < 1e-12 * one.maximum


@pytest.mark.parametrize("periodic", [(False, False), (False, True)])
@pytest.mark.parametrize("speeds", [(4.0, 30.0), (-4.0, 30.0)])
def test_in_the_end_it_is_steady(periodic, speeds):
    """What is left decays like exp(-U^2 t / 4 kappa): e^-36 of the slower body."""
    grid = Grid((12, 6), (0.2, 0.3), periodic=(False, periodic[1]))
    heat = 1 + np.random.default_rng(4).random(grid.shape)
    bodies = (UNIT, body(7.0))
    steady = surface_temperature(heat, grid, bodies, speeds=speeds)
    found = surface_temperature_history(np.linspace(0, 9.0, 10), [heat] * 9, grid, bodies, speeds=speeds)
    assert np.abs(found[-1].temperature - steady.temperature).max() < 1e-6 * steady.maximum
    assert np.abs(found[0].temperature - steady.temperature).max() > 1e-3 * steady.maximum
    assert all(one.status is Status.CONVERGED for one in found)


def test_a_wave_on_a_periodic_grid_lags_as_it_should():
    """In the end exp(iqx) / (k sqrt(q^2 + iUq/kappa))."""
    grid = Grid((32, 2), (1 / 32, 1.0), periodic=(True, True))
    q, speed = 2 * math.pi, 5.0
    heat = np.repeat(np.cos(q * grid.x)[:, None], 2, axis=1)
    found = surface_temperature_history([0.0, 5.0], heat[None], grid, UNIT, speeds=speed)[-1].temperature[:, 0]
    exact = (np.exp(1j * q * grid.x) / np.sqrt(q**2 + 1j * speed * q)).real
    assert np.abs(found - exact).max() < 1e-12


def test_a_pulse_fades():
    grid = Grid((8, 8), (0.25, 0.25))
    heat = np.zeros((6, 8, 8))
    heat[0] = 1.0
    found = surface_temperature_history(np.linspace(0, 3, 7), heat, grid, (UNIT, UNIT), speeds=(0.0, 1.0))
    hottest = [one.surfaces.max() for one in found]
    assert all(later < 0.8 * earlier for earlier, later in itertools.pairwise(hottest))


@pytest.mark.parametrize(
    ("times", "count", "periodic", "word"),
    [
        ([0.0], 0, (False, False), "two or more"),
        ([0.0, 1.0, 3.0], 2, (False, False), "equal steps"),
        ([1.0, 0.0], 1, (False, False), "equal steps"),
        ([0.0, 1.0], 2, (False, False), "2 maps for 1 steps"),
        ([0.0, 1.0], 1, (True, False), "periodic along x"),
    ],
)
def test_each_mistake_has_its_message(times, count, periodic, word):
    grid = Grid((4, 4), (0.1, 0.1), periodic=periodic)
    with pytest.raises(InputError, match=word):
        surface_temperature_history(times, np.ones((count, 4, 4)), grid, UNIT, speeds=1.0)
