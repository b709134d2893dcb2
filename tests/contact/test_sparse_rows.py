"""The sparse inverse's rows against G by its definition: a dense matrix, each row by a linear solve of its own."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from bem.contact.sparse_inverse import ENTRIES, Patterns, neighbours, sparse_inverse, stencil

pytestmark = pytest.mark.internal

FREE, HALF_X, HALF_Y, PERIODIC = (False, False), (True, False), (False, True), (True, True)


def near_field(squared_radius):
    reach = 2 * int(np.sqrt(squared_radius))
    far = np.arange(-reach, reach + 1)
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


def dense(shape, periodic, cells, kernel, offsets):
    """G by definition: row k is the last of the inverse on a cell and its earlier neighbours, over the root of its
    last entry."""
    matrix, middle = np.zeros((cells.size, cells.size)), kernel.shape[0] // 2
    for k, cell in enumerate(cells):
        there = [*neighbours_of(cell, shape, periodic, cells, offsets), ((0, 0), k)]
        ways = np.array([way for way, _ in there])
        between = ways[:, None] - ways[None, :] + middle
        row = np.linalg.solve(kernel[between[..., 0], between[..., 1]], np.eye(len(there))[-1])
        for (_, number), value in zip(there, row / np.sqrt(row[-1]), strict=True):
            matrix[k, number] += value
    return matrix


@pytest.mark.parametrize("periodic", [FREE, HALF_X, HALF_Y, PERIODIC])
@pytest.mark.parametrize(
    ("shape", "squared_radius"),
    [
        *(((19, 23), 5), ((12, 5), 5), ((5, 40), 5), ((4, 17), 5), ((21, 3), 5)),
        *(((1, 30), 5), ((30, 1), 5), ((15, 16), 2), ((9, 14), 8)),
    ],
)
def test_products_with_the_rows(shape, squared_radius, periodic):
    kernel = near_field(squared_radius)
    inverse = sparse_inverse(shape, periodic, kernel, squared_radius)
    rng = np.random.default_rng(7)
    for share in (0.02, 0.3, 0.8, 1.0):
        cells = np.sort(rng.permutation(shape[0] * shape[1])[: round(share * shape[0] * shape[1])])
        on = inverse.on(cells)
        matrix = dense(shape, periodic, cells, kernel, inverse.patterns.offsets)
        values = rng.standard_normal(cells.size)
        spread, collected = np.full((2, cells.size), np.nan)
        on.spread(values, spread)
        total = on.collect(values, collected)
        # rows have up to eleven entries of order one
        assert spread == pytest.approx(matrix @ values, abs=1e-12)
        assert collected == pytest.approx(matrix.T @ values, abs=1e-12)
        assert total == pytest.approx(float(collected.sum()), abs=1e-11)
        assert on.row_sums() == pytest.approx(matrix.sum(1), abs=1e-12)


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
def test_few_rows_are_of_the_seam_and_the_rest_know_their_neighbours(periodic):
    shape = (40, 50)
    cells = np.sort(np.random.default_rng(3).permutation(2000)[:900])
    inverse = sparse_inverse(shape, periodic, near_field(5))
    on = inverse.on(cells)
    x, y = np.divmod(cells, 50)
    ends = (np.arange(900) < 2) | (np.arange(900) >= 896)
    across = (x < 2) | (y < 2) | (y >= 48) if periodic == PERIODIC else np.zeros(900, bool)
    assert on.irregular.cells.tolist() == np.flatnonzero(ends | across).tolist()
    found = np.empty(10, np.int64)
    offsets = [tuple(way) for way in stencil(5)]
    for k in np.setdiff1d(np.arange(900), on.irregular.cells):
        neighbours(on.rows, int(k), found)
        there = neighbours_of(cells[k], shape, periodic, cells, inverse.patterns.offsets)
        assert on.rows.pattern[k] == sum(1 << offsets.index(way) for way, _ in there)
        for way, number in there:
            assert found[offsets.index(way)] == number


def test_contacts_side_by_side_share_patterns_that_are_whole():
    """Each thread begins with patterns that another may be at; G by both is the same."""
    kernel = near_field(5) + 1e-3  # of no other test: nothing is solved yet
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


def test_a_packed_row_says_its_sum():
    known: Patterns = sparse_inverse((30, 30), FREE, near_field(5)).patterns
    every = known.packed.shape[0] // 2 - 1
    assert known.packed.shape[1] == ENTRIES
    np.testing.assert_array_equal(known.packed[every, :11], known.table[every])
    assert known.packed[every, 11] == pytest.approx(known.table[every].sum(), rel=1e-14)
