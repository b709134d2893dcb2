"""Which pieces of fluid reach round a periodic patch."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.flow.percolation import label_clusters

pytestmark = pytest.mark.internal


def drawn(*rows):
    """Rows run along y; # is closed."""
    return np.array([[c != "#" for c in row] for row in rows])


@pytest.mark.parametrize(
    ("picture", "along_x", "along_y"),
    [
        (drawn("....", "....", "...."), True, True),
        (drawn("####", "####"), False, False),
        (drawn("#.##", "#.##", "#.##"), True, False),
        (drawn("####", "....", "####"), False, True),
        (drawn("####", "#..#", "####"), False, False),
        # only over the seams
        (drawn("..#.", "####", "..#."), False, False),
        # steps down the diagonal join both seams: flow along either axis
        (drawn("..##", "#..#", "##..", ".##."), True, True),
        # the same without the corner cells hangs together through corners only, which carry nothing
        (drawn(".###", "#.##", "##.#", "###."), False, False),
    ],
)
def test_reaching_round(picture, along_x, along_y):
    clusters = label_clusters(picture)
    assert (clusters.wraps_x.any(), clusters.wraps_y.any()) == (along_x, along_y)
    assert ((clusters.label >= 0) == picture).all()


def flooded(is_open, axis):
    """Cells of pieces that meet their own image, by flooding three copies of the patch along each axis."""
    tiled = np.tile(is_open, (3, 3))
    label = -np.ones(tiled.shape, dtype=int)
    for seed in zip(*np.nonzero(tiled), strict=True):
        if label[seed] >= 0:
            continue
        label[seed] = mark = label.max() + 1
        stack = [seed]
        while stack:
            i, j = stack.pop()
            for k, m in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
                near = (k % tiled.shape[0], m % tiled.shape[1])
                if tiled[near] and label[near] < 0:
                    label[near] = mark
                    stack.append(near)
    # in copies that are joined periodically a winding of 1 or 2 patches (of 3) joins all copies along the axis
    n = is_open.shape[axis]
    first, second = np.take(label, range(n), axis), np.take(label, range(n, 2 * n), axis)
    other = is_open.shape[1 - axis]
    return np.take((first == second) & (first >= 0), range(other), 1 - axis)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 9), st.integers(2, 9), st.floats(0.45, 0.8))
def test_against_flooded_copies(seed, nx, ny, share):
    """A path that winds thrice, or an equal number of times round both, is beyond what nine copies tell: left out."""
    is_open = np.random.default_rng(seed).random((nx, ny)) < share
    clusters = label_clusters(is_open)
    for axis in (0, 1):
        seen = flooded(is_open, axis)
        assert not (seen & ~clusters.percolating_cells(axis)).any()
        alone = clusters.percolating_cells(axis) & ~clusters.percolating_cells(1 - axis)
        assert (seen[alone]).all()
