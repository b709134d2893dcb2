"""The sparse inverse's rows against G by its definition: a dense matrix, each row by a linear solve of its own."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from bem.contact.sparse_inverse import NEIGHBOURS, OFFSETS, REACH, sparse_inverse

pytestmark = pytest.mark.internal

FREE, HALF_X, HALF_Y, PERIODIC = (False, False), (True, False), (False, True), (True, True)


def near_field():
    far = np.arange(-2 * REACH, 2 * REACH + 1)
    return 1 / np.sqrt(0.3 + far[:, None] ** 2 + 0.8 * far[None, :] ** 2)


def neighbours_of(cell, shape, periodic, cells, offsets):
    """Offsets of the neighbours that are among the cells, and their numbers."""
    there = []
    for way in offsets:
        place = np.array(divmod(int(cell), shape[1])) + way
        place = np.where(periodic, place % shape, place)
        flat = int(place[0] * shape[1] + place[1])
        if (place >= 0).all() and (place < shape).all() and flat in cells:
            there.append((tuple(way), int(np.searchsorted(cells, flat))))
    return there


def dense(shape, periodic, cells, kernel, offsets, diagonal):
    """G by definition: row k is the last of the inverse on a cell and its earlier neighbours, over the root of its
    last entry."""
    matrix, middle = np.zeros((cells.size, cells.size)), kernel.shape[0] // 2
    for k, cell in enumerate(cells):
        there = [*neighbours_of(cell, shape, periodic, cells, offsets), ((0, 0), k)]
        ways = np.array([way for way, _ in there])
        between = ways[:, None] - ways[None, :] + middle
        system = kernel[between[..., 0], between[..., 1]] + np.diag(diagonal[[number for _, number in there]])
        row = np.linalg.solve(system, np.eye(len(there))[-1])
        for (_, number), value in zip(there, row / np.sqrt(row[-1]), strict=True):
            matrix[k, number] += value
    return matrix


@pytest.mark.parametrize("periodic", [FREE, HALF_X, HALF_Y, PERIODIC])
@pytest.mark.parametrize(
    "shape", [(19, 23), (12, 5), (5, 40), (4, 17), (21, 3), (1, 30), (30, 1), (15, 16), (9, 14), (5, 5), (2, 2)]
)
@pytest.mark.parametrize("diagonal", [False, True])
def test_products_with_the_rows(shape, periodic, diagonal):
    kernel = near_field()
    inverse = sparse_inverse(shape, periodic, kernel)
    rng = np.random.default_rng(7)
    for share in (0.02, 0.3, 0.8, 1.0):
        cells = np.sort(rng.permutation(shape[0] * shape[1])[: round(share * shape[0] * shape[1])])
        added = rng.uniform(0, 2, cells.size) * (rng.random(cells.size) < 0.4) if diagonal else np.zeros(cells.size)
        on = inverse.on(cells, added if diagonal else None)
        matrix = dense(shape, periodic, cells, kernel, inverse.patterns.offsets, added)
        values = rng.standard_normal(cells.size)
        spread, collected = np.full((2, cells.size), np.nan)
        on.spread(values, spread)
        total = on.collect(values, collected)
        # rows have up to eleven entries of order one
        assert spread == pytest.approx(matrix @ values, abs=1e-12)
        assert collected == pytest.approx(matrix.T @ values, abs=1e-12)
        assert total == pytest.approx(float(collected.sum()), abs=1e-11)
        assert on.row_sums() == pytest.approx(matrix.sum(1), abs=1e-12)


@pytest.mark.parametrize("periodic", [FREE, HALF_X, HALF_Y, PERIODIC])
def test_rows_have_the_numbers_of_their_neighbours(periodic):
    shape = (40, 50)
    cells = np.sort(np.random.default_rng(3).permutation(2000)[:900])
    rows = sparse_inverse(shape, periodic, near_field()).on(cells).rows
    offsets = [tuple(way) for way in OFFSETS]
    assert len(offsets) == NEIGHBOURS
    for k, cell in enumerate(cells):
        there = {offsets.index(way): number for way, number in neighbours_of(cell, shape, periodic, cells, OFFSETS)}
        assert rows.columns[k].tolist() == [there.get(a, k) for a in range(NEIGHBOURS)]
        assert rows.pattern[k] == sum(1 << a for a in there)


def test_contacts_side_by_side_share_patterns_that_are_whole():
    """Each thread begins with patterns that another may be at; G by both is the same."""
    kernel = near_field() + 1e-3  # of no other test: nothing is solved yet
    cells = np.sort(np.random.default_rng(6).permutation(3600)[:1700])
    values = np.ones(1700)

    def product(_):
        out = np.empty(1700)
        sparse_inverse((60, 60), PERIODIC, kernel).on(cells).spread(values, out)
        return out

    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(product, range(8))
    assert np.isfinite(first).all()
    for other in others:
        np.testing.assert_array_equal(first, other)
