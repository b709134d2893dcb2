"""Uncoupled asperities: summits, Hertz, hardness, volume."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mixed_case import mixed_case

from bem import Grid, Lubricant, Status, solve_mixed
from bem.friction.asperities import Summits, asperity_loads, find_summits, uncoupled_contact
from bem.friction.balance import Regime
from bem.friction.rough_contact import touching_fraction_of
from bem.notes import has_code
from bem.notes.friction import NO_SUMMITS
from reports.experiments.separation_datum import volume_shift


def bumps(grid, radius, centres):
    """Paraboloids of the same radius around centres, the highest of them everywhere."""
    x, y = grid.x[:, None], grid.y[None, :]
    return np.max([h - ((x - cx) ** 2 + (y - cy) ** 2) / (2 * radius) for cx, cy, h in centres], axis=0)


@pytest.mark.internal
def test_summits_have_their_heights_and_radii():
    grid = Grid((60, 60), (0.1e-6, 0.1e-6))
    # off the cells' centres, so that tops are interpolated
    centres = [(-1.03e-6, 0.27e-6, 50e-9), (1.5e-6, -1.21e-6, 30e-9)]
    summits = find_summits(bumps(grid, 10e-6, centres), grid)
    assert len(summits.height) == 2
    # a paraboloid is met exactly by parabolas
    np.testing.assert_allclose(np.sort(summits.height), [30e-9, 50e-9], rtol=1e-9)
    np.testing.assert_allclose(summits.radius, 10e-6, rtol=1e-6)


@pytest.mark.internal
def test_borders_are_summits_only_where_periodic():
    height = np.zeros((8, 8))
    height[0, 4] = height[4, 0] = 1e-9
    height -= 1e-12 * np.arange(64).reshape(8, 8)  # no plateaus
    free = find_summits(height, Grid((8, 8), (1e-7, 1e-7)))
    assert not (free.height > 0.5e-9).any()
    along_y = find_summits(height, Grid((8, 8), (1e-7, 1e-7), periodic=(False, True)))
    assert list(zip(*along_y.index, strict=True)) == [(4, 0)]
    both = find_summits(height, Grid((8, 8), (1e-7, 1e-7), periodic=(True, True)))
    assert np.sum(both.height > 0.5e-9) == 2


@pytest.mark.internal
def test_elastic_asperity_is_hertz():
    radius, modulus, depth = 30e-6, 115e9, 20e-9
    load, area, plastic = asperity_loads(np.array([depth]), np.array([radius]), modulus, None)
    contact_radius = math.sqrt(radius * depth)
    assert load[0] == pytest.approx(4 * modulus * contact_radius**3 / (3 * radius), rel=1e-12)
    assert area[0] == pytest.approx(math.pi * contact_radius**2, rel=1e-12, abs=0)
    assert not plastic[0]


@pytest.mark.internal
@given(depth=st.floats(-1e-7, 1e-5))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_plastic_asperities_grow_and_keep_below_the_hardness(depth):
    at = np.array([depth, depth + 1e-9])
    load, area, _ = asperity_loads(at, np.full(2, 30e-6), 115e9, 1e9)
    assert load[1] >= load[0] >= 0
    assert (load <= 1e9 * area * (1 + 1e-12)).all()


@pytest.mark.internal
def test_load_is_continuous_where_yield_begins():
    critical = 30e-6 * (3 * math.pi * 1e9 / (4 * 115e9)) ** 2
    load, area, plastic = asperity_loads(critical * np.array([1 - 1e-9, 1 + 1e-9]), np.full(2, 30e-6), 115e9, 1e9)
    assert list(plastic) == [False, True]
    np.testing.assert_allclose(load[0], load[1], rtol=1e-8)
    np.testing.assert_allclose(area[0], area[1], rtol=1e-8)


@given(seed=st.integers(0, 1000), share=st.floats(0.01, 3))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_volume_shift_keeps_the_volume(seed, share):
    gap = np.random.default_rng(seed).normal(1.0, 1.0, (12, 9))
    shift = volume_shift(gap, share)
    assert np.maximum(gap - shift, 0).mean() == pytest.approx(share, rel=1e-12)


@pytest.mark.internal
def test_pressure_map_carries_the_load():
    grid = Grid((40, 40), (0.2e-6, 0.2e-6), periodic=(False, True))
    height = bumps(grid, 30e-6, [(0.0, 0.0, 100e-9), (1.2e-6, -3.9e-6, 90e-9)])
    height -= height.mean()
    summits = find_summits(height, grid)
    planes = np.full(len(summits.height), 0.8 * height.max())
    contact = uncoupled_contact(planes, summits, grid, shift=0.0, contact_modulus=115e9, hardness=None)
    assert contact.load > 0
    assert contact.pressure.sum() * grid.cell_area == pytest.approx(contact.load, rel=1e-12)
    assert contact.summit_load.sum() == pytest.approx(contact.load, rel=1e-12)


@pytest.mark.internal
@pytest.mark.parametrize("periodic", [(False, False), (True, False), (False, True)])
def test_a_disc_at_an_edge_wraps_on_periodic_axes_only(periodic):
    """It went on at the opposite edge of a free axis along y, and was piled up at the edge of an axis along x."""
    grid = Grid((20, 20), (0.2e-6, 0.2e-6), periodic=periodic)
    summits = Summits((np.array([1]), np.array([18])), np.full(1, 200e-9), np.full(1, 30e-6))
    contact = uncoupled_contact(np.full(1, 170e-9), summits, grid, shift=0.0, contact_modulus=115e9, hardness=None)
    assert contact.pressure.sum() * grid.cell_area == pytest.approx(contact.load, rel=1e-12)
    touched = contact.pressure > 0  # a disc of radius 0.95 um is four cells to either side
    assert touched[1, 18]
    assert touched[19, 18] == periodic[0]
    assert touched[1, 0] == periodic[1]
    assert touched[0, 18]


@pytest.mark.internal
def test_overlapping_discs_cover_no_more_than_their_cells():
    """Areas add up to 1.3 times that of the cells they lie on: more film was taken off than the cells have."""
    grid = Grid((40, 40), (0.2e-6, 0.2e-6), periodic=(True, True))
    summits = Summits((np.array([20, 21]), np.array([20, 20])), np.full(2, 200e-9), np.full(2, 30e-6))
    contact = uncoupled_contact(np.full(2, 170e-9), summits, grid, shift=0.0, contact_modulus=115e9, hardness=None)
    assert contact.contact_area > 1.2 * np.count_nonzero(contact.pressure) * grid.cell_area
    assert touching_fraction_of(contact, grid).max() == 1.0


def test_ridges_have_no_summits_and_no_balance():
    """Without a summit the contact carries nothing: the film was taken for a full one, and converged."""
    case = mixed_case(64, 0.8e-6, 3e-6, lubricant=Lubricant(0.36, density_law="incompressible"), boundary_friction=0.1)
    ridges = np.broadcast_to(case["height"][:, :1], case["height"].shape)
    found = solve_mixed(**case | {"height": ridges, "contact_model": "uncoupled"}, speeds=(0.003, 0.0))
    assert found.status is Status.INFEASIBLE
    assert has_code(found.notes, NO_SUMMITS)
    coupled = solve_mixed(**case | {"height": ridges}, speeds=(0.003, 0.0))
    assert coupled.regime is Regime.MIXED
