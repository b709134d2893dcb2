"""Fields piece by piece: the bits that numpy gives of the whole, and little memory."""

import gc
import sys
import tracemalloc

import numpy as np
import pytest

from bem import pieces


@pytest.mark.parametrize("shape", [(1,), (7,), (64, 64), (1024, 1024), (997, 1201), (3, 400_001), (2050, 769)])
def test_sums_have_the_bits_of_the_whole_field(shape):
    field = np.random.default_rng(len(shape)).standard_normal(shape) ** 3
    assert pieces.total(field) == field.sum()
    assert pieces.mean(field) == field.mean()
    assert pieces.deviation(field) == field.std()
    assert pieces.mean(field, lambda piece: np.maximum(piece, 0)) == np.maximum(field, 0).mean()


def test_nothing_of_a_field_is_held_until_garbage_is_collected():
    field = np.ones(3 * pieces.PIECE)
    held = sys.getrefcount(field)
    gc.disable()
    try:
        pieces.deviation(field)
        assert sys.getrefcount(field) == held
    finally:
        gc.enable()


def test_means_hold_no_second_field():
    field = np.random.default_rng(0).standard_normal((1500, 1500))
    tracemalloc.start()
    try:
        pieces.deviation(field)
        pieces.mean(field, np.abs)
        assert tracemalloc.get_traced_memory()[1] < 0.5 * field.nbytes
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("shape", [(5, 3), (1200, 700), (700, 1200), (1, 9), (9, 1)])
@pytest.mark.parametrize("axis", [0, 1])
def test_rows_with_what_lies_beside_them_are_those_of_the_rolled_field(shape, axis):
    field = np.random.default_rng(1).standard_normal(shape)
    blocks = list(pieces.row_blocks(shape))
    assert [first for first, _ in blocks] == [0, *(last for _, last in blocks[:-1])]
    assert blocks[-1][1] == shape[0]
    for first, last in blocks:
        found = pieces.around(field, axis, first, last, 2)
        count = found.shape[0] - 4
        for shift in (-2, 0, 1):
            rolled = np.moveaxis(found[2 - shift : 2 - shift + count], 0, axis)
            np.testing.assert_array_equal(rolled, np.roll(field, shift, axis)[first:last])
