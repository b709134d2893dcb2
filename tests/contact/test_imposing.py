"""Pressures that pull brought to zero, against dense matrices: what their neighbours make up for, and what is left."""

import numpy as np
import pytest
from contact_oracles import FREE, PERIODIC, notes_surface, operator

from bem.contact.imposing import impose
from bem.contact.level import Level, Tuning

N = 32


def kernel(op, cells):
    """On some cells, by the operator itself: shape (n, n)."""
    columns = []
    for cell in cells:
        unit = np.zeros(N * N)
        unit[cell] = 1.0
        columns.append(op(unit.reshape(N, N)).ravel()[cells] / op.unit)
    return np.stack(columns, axis=1)


def contact_of(periodic, share, seed):
    """Of a rough surface: the sparse inverse on its cells, the kernel there, and pressures that close a gap."""
    op = operator((N, N), (1 / N, 1 / N), periodic)
    height = notes_surface(N, seed, rolloff=3).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 1 - share))
    level = Level(op, np.zeros(N * N), np.inf, Tuning())
    level.preconditioner(cells)
    matrix = kernel(op, cells) + 1e-6 * np.eye(cells.size)  # a doubly periodic grid has none for a uniform pressure
    closing = height[cells] - height[cells].min()
    return level.near_on(cells), matrix, np.linalg.solve(matrix, closing)


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("share", [0.1, 0.4])
@pytest.mark.parametrize("seed", [1, 2])
def test_neighbours_make_up_for_what_is_taken_off(periodic, share, seed):
    near, matrix, raw = contact_of(periodic, share, seed)
    pulls = raw < 0
    assert 0.02 < pulls.mean() < 0.5
    found = raw.copy()
    impose(near, found)
    assert (found[pulls] == 0).all()
    stays = found != 0
    exact = np.zeros(raw.size)
    exact[stays] = np.linalg.solve(matrix[np.ix_(stays, stays)], (matrix @ raw)[stays])

    def missed(pressure):
        """Energy above that of the exact pressure on the same cells."""
        error = pressure - exact
        return float(error @ matrix @ error)

    clipped = np.where(stays, raw, 0.0)
    assert missed(found) < 0.5 * missed(clipped)


def test_a_single_cell_is_taken_off_as_the_sparse_inverse_says():
    near, _, raw = contact_of(FREE, 0.4, 3)
    size = raw.size
    g = np.empty((size, size))
    for k, unit in enumerate(np.eye(size)):
        column = np.empty(size)
        near.spread(unit, column)
        g[:, k] = column
    inverse = g.T @ g
    raw = np.full(size, 5.0)
    raw[size // 2] = -1.0
    found = raw.copy()
    impose(near, found)
    expected = raw - inverse[:, size // 2] * (-1.0 / inverse[size // 2, size // 2])
    expected[size // 2] = 0.0
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_pressures_that_push_are_left_as_they_are():
    near, _, raw = contact_of(FREE, 0.1, 1)
    pushing = np.abs(raw)
    found = pushing.copy()
    impose(near, found)
    assert np.array_equal(found, pushing)
