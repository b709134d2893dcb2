"""Fields block by block: the bits that numpy gives of the whole, and little memory."""

import gc
import sys
import tracemalloc

import numpy as np
import pytest

from bem.numerics import blocks

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("shape", [(1,), (7,), (64, 64), (1024, 1024), (997, 1201), (3, 400_001), (2050, 769)])
def test_sums_have_the_bits_of_the_whole_field(shape):
    field = np.random.default_rng(len(shape)).standard_normal(shape) ** 3
    assert blocks.total(field) == field.sum()
    assert blocks.mean(field) == field.mean()
    assert blocks.deviation(field) == field.std()
    assert blocks.mean(field, lambda block: np.maximum(block, 0)) == np.maximum(field, 0).mean()


def test_nothing_of_a_field_is_held_until_garbage_is_collected():
    field = np.ones(3 * blocks.BLOCK)
    held = sys.getrefcount(field)
    gc.disable()
    try:
        blocks.deviation(field)
        assert sys.getrefcount(field) == held
    finally:
        gc.enable()


def test_means_hold_no_second_field():
    field = np.random.default_rng(0).standard_normal((1500, 1500))
    tracemalloc.start()
    try:
        blocks.deviation(field)
        blocks.mean(field, np.abs)
        assert tracemalloc.get_traced_memory()[1] < 0.5 * field.nbytes
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("shape", [(5, 3), (1200, 700), (700, 1200), (1, 9), (9, 1)])
@pytest.mark.parametrize("axis", [0, 1])
def test_rows_with_what_lies_beside_them_are_those_of_the_rolled_field(shape, axis):
    field = np.random.default_rng(1).standard_normal(shape)
    rows = list(blocks.row_blocks(shape))
    assert [first for first, _ in rows] == [0, *(last for _, last in rows[:-1])]
    assert rows[-1][1] == shape[0]
    for first, last in rows:
        found = blocks.around(field, axis, first, last, 2)
        count = found.shape[0] - 4
        for shift in (-2, 0, 1):
            rolled = np.moveaxis(found[2 - shift : 2 - shift + count], 0, axis)
            np.testing.assert_array_equal(rolled, np.roll(field, shift, axis)[first:last])
