"""Pressures that pull brought to zero, against dense matrices: what their neighbours make up for, and what is left."""

import numpy as np
import pytest
from contact_oracles import FREE, HALF_X, HALF_Y, PERIODIC, active_cells, notes_surface, operator

from bem.contact import bounds
from bem.contact.bounds import _TENSION_ITERATIONS, eliminate_tension
from bem.contact.grid_workspace import GridWorkspace, SolverParameters
from bem.contact.sparse_inverse import sparse_inverse

pytestmark = pytest.mark.internal

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
    workspace = GridWorkspace(op, np.zeros(N * N), np.inf, SolverParameters())
    matrix = kernel(op, cells) + 1e-6 * np.eye(cells.size)  # a doubly periodic grid has none for a uniform pressure
    closing = height[cells] - height[cells].min()
    return active_cells(workspace, cells).near, matrix, np.linalg.solve(matrix, closing)


def dense_rows(near, size):
    """G as a matrix, by its products with unit vectors; these are held against its definition in test_sparse_rows."""
    rows = np.empty((size, size))
    for k, unit in enumerate(np.eye(size)):
        column = np.empty(size)
        near.spread(unit, column)
        rows[:, k] = column
    return rows


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("share", [0.1, 0.4])
@pytest.mark.parametrize("seed", [1, 2])
def test_neighbours_make_up_for_what_is_taken_off(periodic, share, seed):
    near, matrix, raw = contact_of(periodic, share, seed)
    pulls = raw < 0
    assert 0.02 < pulls.mean() < 0.5
    found = raw.copy()
    eliminate_tension(near, found)
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
    rows = dense_rows(near, size)
    inverse = rows.T @ rows
    raw = np.full(size, 5.0)
    raw[size // 2] = -1.0
    found = raw.copy()
    eliminate_tension(near, found)
    expected = raw - inverse[:, size // 2] * (-1.0 / inverse[size // 2, size // 2])
    expected[size // 2] = 0.0
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_pressures_that_push_are_left_as_they_are():
    near, _, raw = contact_of(FREE, 0.1, 1)
    pushing = np.abs(raw)
    found = pushing.copy()
    eliminate_tension(near, found)
    assert np.array_equal(found, pushing)


def plainly(inverse, raw):
    """`eliminate_tension` with a dense inverse B, in numpy: what two conjugate gradients for B y = p take off those
    that pull."""

    def take_off(pulls, taken):
        missed = (raw - taken)[pulls]
        way = missed.copy()
        for _ in range(_TENSION_ITERATIONS):
            if not missed @ missed > 0:
                break
            response = inverse[:, pulls] @ way
            squares = missed @ missed
            step = squares / (way @ response[pulls])
            taken = taken + step * response
            missed = missed - step * response[pulls]
            way = missed + missed @ missed / squares * way
        return taken

    pulls = raw < 0
    taken = take_off(pulls, np.zeros(raw.size))
    more = pulls | (raw < taken)
    if (more != pulls).any():
        taken = take_off(more, taken)
    return np.where(more, 0.0, raw - taken)


@pytest.mark.parametrize("periodic", [FREE, HALF_X, HALF_Y, PERIODIC])
@pytest.mark.parametrize("shape", [(2, 9), (9, 2), (3, 11), (11, 3), (5, 7), (1, 30), (30, 1), (19, 23)])
def test_rows_across_edges_and_at_the_ends_of_the_list_take_part(shape, periodic):
    """On narrow and periodic grids most rows have neighbours across an edge."""
    rng = np.random.default_rng(shape[0])
    near = sparse_inverse(shape, periodic, operator((24, 24), (1.0, 1.0), FREE).near_field(4))
    for share in (0.05, 0.3, 0.7, 1.0):
        cells = np.sort(rng.permutation(shape[0] * shape[1])[: max(1, round(share * shape[0] * shape[1]))])
        on = near.on(cells)
        raw = rng.standard_normal(cells.size) + rng.uniform(-0.5, 1.5)
        found = raw.copy()
        eliminate_tension(on, found)
        rows = dense_rows(on, cells.size)
        # a few hundred products of order one
        np.testing.assert_allclose(found, plainly(rows.T @ rows, raw), rtol=0, atol=1e-12 * np.abs(raw).max())


def test_rows_take_off_by_the_arithmetic_of_their_text():
    """Bit for bit what the interpreter makes of the loop. Of its sums of products the compiler fused one or another, by
    what had been compiled in the same process, and contacts had other bits."""
    near, _, raw = contact_of(PERIODIC, 0.4, 1)
    listed = bounds._rows_reaching(near.rows, (raw < 0).astype(np.uint8))
    found = np.zeros((2, raw.size))
    bounds._add_response(near.rows, listed, raw, found[0])
    bounds._add_response.py_func(near.rows, listed, raw, found[1])
    assert listed.size > 10
    assert found[0].any()
    assert found[0].tobytes() == found[1].tobytes()
