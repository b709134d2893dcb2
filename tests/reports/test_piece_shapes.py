"""Length and width of wear pieces by definition: closed forms of rectangles and rows, pieces across the edge."""

import math

import numpy as np
import pytest

from bem.particles import Particle
from reports import piece_shapes as section
from reports.experiments.piece_shapes import definitions, unwrapped


def cells_of(mask):
    return np.argwhere(np.asarray(mask)).astype(float)


def test_a_rectangle_of_cells():
    found = definitions(cells_of(np.ones((6, 2))))
    diagonal = math.hypot(6, 2)
    assert found["rectangle along x and y"] == pytest.approx((6, 2))
    assert found["turned rectangle"] == pytest.approx((6, 2))
    assert found["Feret's diameters"] == pytest.approx((diagonal, 2))
    assert found["longest chord"] == pytest.approx((diagonal, 2 * 6 * 2 / diagonal))  # twice a triangle's height
    assert found["second moments"] == pytest.approx((4 * 6 / 12**0.5, 4 * 2 / 12**0.5))


def test_a_row_along_the_diagonal_is_long_and_narrow_when_turned():
    found = definitions(cells_of(np.eye(5)))
    assert found["rectangle along x and y"] == pytest.approx((5, 5))
    assert found["turned rectangle"] == pytest.approx((5 * 2**0.5, 2**0.5))
    assert found["Feret's diameters"] == pytest.approx((5 * 2**0.5, 2**0.5))


def test_one_cell():
    found = definitions(np.array([[3.0, 4.0]]))
    assert found["rectangle along x and y"] == pytest.approx((1, 1))
    assert found["second moments"] == pytest.approx((4 / 12**0.5,) * 2)


def test_a_piece_across_the_periodic_edge_is_in_one_part():
    columns = np.array([[0, 9], [0, 0], [0, 1]])
    piece = Particle(1.0, 3.0, 1.0, 1.0, columns, np.ones(3))
    assert sorted(unwrapped(piece, 10)[:, 1]) == [9, 10, 11]
    assert definitions(unwrapped(piece, 10))["rectangle along x and y"] == pytest.approx((3, 1))


def test_all_three_sizes_must_lie_within_the_factor():
    assert section.is_within((442, 245, 197), section.SOURCE[10.0])
    assert section.is_within((442 * 1.16, 245 / 1.16, 197), section.SOURCE[10.0])
    assert not section.is_within((442, 245 * 1.18, 197), section.SOURCE[10.0])
