"""Highest values and areas between the centres of cells, against fields that are known everywhere."""

import numpy as np
import pytest

from bem.grid import Grid
from bem.numerics.subcell import area_above, around, highest_along, top

pytestmark = pytest.mark.internal


def field_at(shape, centre, function, angle=0.0):
    x = np.arange(shape[0])[:, None] - shape[0] / 2 - centre[0]
    y = np.arange(shape[1])[None, :] - shape[1] / 2 - centre[1]
    return function(x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle))


def test_the_top_of_a_paraboloid_is_exact_and_of_other_fields_of_fourth_order():
    rng, errors = np.random.default_rng(0), []
    for radius in (4.0, 8.0, 16.0):
        worst = 0.0
        for _ in range(20):
            centre, angle = rng.uniform(-0.5, 0.5, 2), rng.uniform(0, np.pi)
            grid = Grid((8, 8), (1.0, 1.0))
            bowl = field_at(grid.shape, centre, lambda u, v: 3 - u**2 - 0.5 * v**2, angle)
            place = np.unravel_index(bowl.argmax(), bowl.shape)
            assert top(around(bowl, grid, place)) == pytest.approx(3, rel=1e-12)
            bell = field_at(grid.shape, centre, lambda u, v, r=radius: np.exp(-(u**2 + 2 * v**2) / r**2), angle)
            place = np.unravel_index(bell.argmax(), bell.shape)
            worst = max(worst, abs(top(around(bell, grid, place)) - 1))
        errors.append(worst)
    # measured 3e-3, 2e-4, 1.3e-5
    assert errors[0] < 6e-3
    assert errors[0] / errors[2] > 100


def test_no_top_is_made_up():
    assert top(np.array([[0.0, 0.0, 9.0], [0.0, 2.0, 0.0], [9.0, 0.0, 0.0]])) is None  # a saddle along the diagonals
    ridge = np.array([[1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [1.5, 1.5, 1.5]])  # a cylinder: flat along its axis
    assert top(ridge) == pytest.approx(2 + 0.25**2 / (2 * 1.5))
    assert top(np.full((3, 3), 7.0)) == 7.0


def test_neighbours_wrap_where_the_grid_repeats_and_are_missing_at_free_edges():
    field = np.arange(12.0).reshape(4, 3)
    assert around(field, Grid((4, 3), (1.0, 1.0)), (0, 1)) is None
    patch = around(field, Grid((4, 3), (1.0, 1.0), periodic=(True, False)), (0, 1))
    assert np.array_equal(patch, field[[3, 0, 1]])
    line = around(field[:, :1], Grid((4, 1), (1.0, 1.0)), (2, 0))
    assert np.array_equal(line, np.repeat(field[1:4, :1], 3, axis=1))


def test_highest_along_uneven_depths():
    depths = np.linspace(0, 1, 24) ** 2

    def bulb(z):
        return z / (0.05 + z**2)

    value, place = highest_along(depths, bulb(depths))
    # the exact top is 1 / (2 sqrt 0.05) at sqrt 0.05; missed by 6e-5 and 0.2 %, by the highest value 3e-4 and 2 %
    assert value == pytest.approx(0.5 / np.sqrt(0.05), rel=1e-4)
    assert place == pytest.approx(np.sqrt(0.05), rel=1e-2)
    assert highest_along(depths, -depths) == (0.0, 0.0)
    three = highest_along(np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, -3.0]))
    assert three == (pytest.approx(1.0), pytest.approx(1.0))


@pytest.mark.parametrize(("radius", "tolerance"), [(1.0, 0.08), (2.0, 0.012), (4.0, 3e-3), (16.0, 2e-4)])
def test_area_of_discs_and_ellipses(radius, tolerance):
    rng, cells = np.random.default_rng(1), int(4 * radius + 8)
    grid = Grid((cells, cells + 3), (1e-6, 1e-6))
    errors, counts = [], []
    for _ in range(20):
        centre, angle = rng.uniform(-0.5, 0.5, 2), rng.uniform(0, np.pi)
        # an ellipse of that mean radius, the sides 1.22 and 0.82 of it
        field = field_at(grid.shape, centre, lambda u, v: 5 - (u**2 / 1.5 + v**2 * 1.5) / radius**2, angle)
        exact = np.pi * radius**2 * 1e-12
        errors.append(area_above(field, 4.0, grid) / exact - 1)
        counts.append(np.sum(field > 4.0) * 1e-12 / exact - 1)
    # measured: scatter of 3.9, 0.5, 0.1 and 0.005 %; of a count 20, 8, 2.6 and 0.3 %
    assert np.abs(errors).max() < tolerance
    assert np.std(errors) < 0.3 * np.std(counts)


def test_area_of_half_planes_all_and_nothing():
    grid = Grid((8, 6), (2.0, 1.0), periodic=(False, True))
    slope = np.arange(8.0)[:, None] + np.zeros(6)
    assert area_above(slope, 2.75, grid) == pytest.approx((7.5 - 2.75) * 2 * 6)
    assert area_above(slope, -1.0, grid) == pytest.approx(grid.area)
    assert area_above(slope, 9.0, grid) == 0.0
