"""Summits and plasticity indices against caps and waves in closed form and Nayak's Gaussian surface."""

import math

import numpy as np
import pytest

from bem import Grid, InputError, generate_surface
from bem.surfaces import describe_asperities, plasticity_index, slope_plasticity_index
from bem.surfaces.asperities import _ROWS

PERIODIC = (True, True)


def waves(nx, ny, cell, number, amplitude):
    """Crossed cosines: number^2 crests at (0, 0), with curvature amplitude k^2 / 2 along each axis."""
    x, y = np.arange(nx)[:, None] * number / nx, np.arange(ny)[None, :] * number / ny
    return amplitude / 2 * (np.cos(2 * np.pi * x) + np.cos(2 * np.pi * y)), 2 * np.pi * number / (nx * cell)


def test_crossed_waves():
    cell, amplitude = 1e-7, 2e-8
    heights, k = waves(320, 320, cell, 5, amplitude)
    found = describe_asperities(heights, (cell, cell), periodic=PERIODIC)
    # crests lie on cells (64 cells a wave); second differences miss (k d)^2 / 12 of the curvature
    second = (2 * math.sin(k * cell / 2) / cell) ** 2
    assert found.density == pytest.approx(25 / (320 * cell) ** 2)
    assert found.radius == pytest.approx(1 / (amplitude / 2 * second), rel=1e-6)
    assert found.mean_height == pytest.approx(amplitude, rel=1e-9)
    assert found.rms_height < 1e-6 * amplitude
    # moments of one profile of the sum: m0 = a^2/4, m2 = a^2 k^2/8, m4 = a^2 k^4/8; alpha = m0 m4 / m2^2 = 2
    assert found.bandwidth == pytest.approx(2, rel=1e-3)
    assert found.rms_curvature == pytest.approx(amplitude / 4 * second, rel=1e-9)


def test_gaussian_surface_has_nayaks_statistics():
    """exp(-(r/l)^2): m0 : m2 : m4 = 1 : 2/l^2 : 12/l^4, alpha = 3, summits m4 / (6 sqrt(3) pi m2) an area."""
    grid, length = Grid((768, 768), (1e-7, 1e-7), periodic=PERIODIC), 1.5e-6
    heights = generate_surface(grid, rms_height=5e-8, seed=1, correlation_length=length)
    found = describe_asperities(heights, grid.spacing, periodic=PERIODIC)
    # some 1,500 summits: 1 / sqrt(n) of scatter, and (l / L) of the moments
    assert found.density == pytest.approx(6 / length**2 / (6 * math.sqrt(3) * math.pi), rel=0.06)
    assert found.bandwidth == pytest.approx(3, rel=0.1)


def test_does_not_depend_on_where_a_periodic_map_begins_or_on_bands_of_rows():
    heights = np.random.default_rng(5).standard_normal((_ROWS + 70, 41))
    one = describe_asperities(heights, (1.0, 2.0), periodic=PERIODIC)
    other = describe_asperities(np.roll(heights, (133, 17), (0, 1)), (1.0, 2.0), periodic=PERIODIC)
    turned = describe_asperities(heights.T, (2.0, 1.0), periodic=PERIODIC)
    for found in (other, turned):
        assert found.density == one.density
        assert found.radius == pytest.approx(one.radius, rel=1e-9)
        assert found.bandwidth == pytest.approx(one.bandwidth, rel=1e-9)
        assert found.rms_height == pytest.approx(one.rms_height, rel=1e-9)


def test_a_free_edge_has_no_summits():
    heights = np.zeros((5, 7))
    heights[0, 3] = heights[2, 2] = 1e-9
    found = describe_asperities(heights, (1e-6, 1e-6))
    assert found.density == pytest.approx(1 / (3 * 5 * 1e-12))
    assert describe_asperities(heights, (1e-6, 1e-6), periodic=PERIODIC).density == pytest.approx(2 / (35 * 1e-12))
    with pytest.raises(InputError, match="at least"):
        describe_asperities(np.zeros((2, 9)), (1e-6, 1e-6))


def test_plasticity_indices():
    grid = Grid((128, 128), (1e-7, 1e-7), periodic=PERIODIC)
    heights = generate_surface(grid, rms_height=5e-8, seed=1, correlation_length=1e-6)
    found = describe_asperities(heights, grid.spacing, periodic=PERIODIC)
    one = plasticity_index(found, 110e9, 8e9)
    # heights times four: sigma times four, curvature times four
    other = plasticity_index(describe_asperities(4 * heights, grid.spacing, periodic=PERIODIC), 110e9, 8e9)
    assert other == pytest.approx(4 * one, rel=1e-9)
    assert one == pytest.approx(110 / 8 * math.sqrt(found.rms_height / found.radius))
    assert slope_plasticity_index(0.1, 110e9, 11e9) == pytest.approx(1.0)
    flat = describe_asperities(np.zeros((8, 8)), grid.spacing)
    assert math.isnan(plasticity_index(flat, 110e9, 8e9))
