"""Heights that the film of a line contact has flattened, against the particular wave and in rolling."""

from dataclasses import replace

import numpy as np
import pytest

from bem import Grid, Lubricant, solve_line_film
from bem.lubrication.waves.flattening import flatten_heights
from bem.lubrication.waves.plateau import wave_amplitudes
from bem.lubrication.waves.ripples import plateau_of
from bem.reference_solutions.hertz import cylinder_contact


@pytest.fixture(scope="module")
def line():
    """Return a line film at 1 GPa with its contact, and a grid around it, free along x."""
    modulus, radius = 1.15e11, 0.01
    load = np.pi * radius * 1e9**2 / modulus
    hertz = cylinder_contact(radius=radius, contact_modulus=modulus, load=load)
    oil = Lubricant(0.04, pressure_viscosity=20e-9)
    film = solve_line_film(
        load=load, radius=radius, contact_modulus=modulus, speeds=(0.0, 2.0), lubricant=oil, points=300
    )
    grid = Grid((240, 4), (4 * hertz.half_width / 240, 1e-5), periodic=(False, True))
    return film, hertz, grid


def test_a_ridge_at_rest_keeps_the_amplitude_of_its_wave(line):
    """Ridges across the flow: -d of the particular wave in the contact, their own height outside."""
    film, hertz, grid = line
    number = 2 * np.pi * 5 / grid.lengths[0]
    heights = 1e-8 * np.cos(number * grid.x)[:, None] + np.zeros(grid.shape)
    found = flatten_heights(film, hertz, (heights, None), grid)
    wave = wave_amplitudes(plateau_of(film, hertz), np.array([number]), np.zeros(1), 0.0).particular_film[0]
    inner, outer = np.abs(grid.x) < 0.3 * hertz.half_width, np.abs(grid.x) > 1.05 * hertz.half_width
    expected = 1e-8 * np.real(-wave * np.exp(1j * number * grid.x))[:, None]
    # stiff oil leaves 6 % of it; the inlet raises or lowers all of the film, and the continued patch is no pure wave
    assert 0.01 < abs(wave) < 0.1
    missed = (found.heights - expected)[inner]
    assert np.abs(missed - missed.mean()).max() < 0.1 * abs(wave) * 1e-8
    assert found.heights[outer] == pytest.approx((heights - heights.mean())[outer], rel=1e-9, abs=1e-20)


def test_rolling_without_sliding_flattens_less(line):
    film, hertz, grid = line
    heights = 1e-8 * np.cos(2 * np.pi * 20 * grid.x / grid.lengths[0])[:, None] + np.zeros(grid.shape)
    rolling = flatten_heights(replace(film, speeds=(1.0, 1.0)), hertz, (heights, None), grid)
    at_rest = flatten_heights(film, hertz, (heights, None), grid)
    assert 0.5 < rolling.amplitude_ratio < 1.1
    assert at_rest.amplitude_ratio < 0.3 * rolling.amplitude_ratio
    assert rolling.lambda_ratio == pytest.approx(at_rest.lambda_ratio, rel=1e-9)
