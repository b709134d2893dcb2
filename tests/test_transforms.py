"""Pruned real transforms against numpy's full ones; counts; bits across threads and processes."""

import gc
import hashlib
import itertools
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
import scipy.fft
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import Body, Grid, Material, displacement_operator, solve_contact, threads, transforms
from bem.errors import InputError
from bem.stress import von_mises_field
from bem.transforms import plans

SHAPES = [
    ((7, 11), (7, 11)),
    ((8, 8), (16, 16)),
    ((13, 6), (13, 12)),
    ((1, 9), (1, 18)),
    ((5, 1), (10, 1)),
    ((1, 1), (1, 1)),
    ((97, 64), (200, 64)),
    ((48, 131), (96, 270)),
]
PARITIES = [(1, 1), (-1, 1), (1, -1), (-1, -1)]
# a transform loses a few units in the last place times the logarithm of its length
ROUND_OFF = {np.float64: 1e-14, np.float32: 2e-6}


@pytest.fixture
def one_thread():
    before = threads.get_threads()
    yield
    threads.set_threads(before)


def wrapped(coefficients, padded, parity):
    """A full periodic kernel from non-negative offsets; where an odd one meets itself it is zero."""
    full = np.zeros(padded)
    for i in range(padded[0]):
        for j in range(padded[1]):
            a, b = min(i, padded[0] - i), min(j, padded[1] - j)
            value = coefficients[a, b]
            for along, (offset, length) in enumerate(((i, padded[0]), (j, padded[1]))):
                if parity[along] == -1:
                    value *= 0 if 2 * offset % length == 0 else (1 if 2 * offset < length else -1)
            full[i, j] = value
    return full


@pytest.mark.internal
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(("shape", "padded"), SHAPES)
def test_forward_and_inverse_match_numpy(shape, padded, dtype):
    transform = transforms.PaddedTransform(shape, padded, dtype)
    field = np.random.default_rng(1).standard_normal(shape).astype(dtype)
    expected = np.fft.rfft2(field.astype(float), s=padded).T
    spectrum = transform.forward(field)
    assert np.abs(spectrum - expected).max() <= ROUND_OFF[dtype] * np.abs(expected).max()
    assert np.abs(transform.inverse(spectrum) - field).max() <= ROUND_OFF[dtype] * np.abs(field).max()


@pytest.mark.internal
@pytest.mark.parametrize(("shape", "padded"), [case for case in SHAPES if case[1][0] * case[1][1] < 500])
def test_convolution_with_even_and_odd_kernels(shape, padded):
    for parity in PARITIES:
        check_convolution(shape, padded, parity)


def check_convolution(shape, padded, parity):
    rng = np.random.default_rng(2)
    field = rng.standard_normal(shape)
    coefficients = rng.standard_normal((padded[0] // 2 + 1, padded[1] // 2 + 1))
    kernel = wrapped(coefficients, padded, parity)
    expected = np.fft.irfft2(np.fft.rfft2(field, s=padded) * np.fft.rfft2(kernel), s=padded)[: shape[0], : shape[1]]
    factor = transforms.multiplier([(transforms.kernel_spectrum(coefficients, padded, parity), parity, 1.0)])
    transform = transforms.PaddedTransform(shape, padded)
    scale = np.abs(kernel).sum() * np.abs(field).max()
    assert np.abs(transform.convolve(field, factor) - expected).max() <= 1e-14 * scale
    assert np.abs(transform.inverse(transform.forward(field), factor) - expected).max() <= 1e-14 * scale


@pytest.mark.internal
@pytest.mark.parametrize(("shape", "padded"), [*SHAPES, ((700, 64), (1400, 64)), ((300, 250), (300, 500))])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_a_convolution_of_cells_is_that_of_their_field(shape, padded, dtype, one_thread):
    for share in (0.0, 0.02, 0.3, 1.0):
        check_convolution_of_cells(shape, padded, dtype, share)


def check_convolution_of_cells(shape, padded, dtype, share):
    rng = np.random.default_rng(11)
    kernel = transforms.multiplier([(rng.standard_normal((padded[1] // 2 + 1, padded[0] // 2 + 1)), (1, 1), 1.0)])
    kernel = kernel.astype(dtype)
    transform = transforms.PaddedTransform(shape, padded, dtype)
    touching = rng.random(shape) < share
    touching[: shape[0] // 2] &= share > 0.02  # blocks of rows without a cell
    cells = np.flatnonzero(touching)
    values, field = rng.standard_normal(cells.size), np.zeros(shape, dtype)
    field.reshape(-1)[cells] = values
    threads.set_threads(1)
    alone = transform.convolve(field, kernel)
    tiny = ROUND_OFF[dtype] * max(np.abs(alone).max(), np.abs(field).max())
    for threads_used in (1, 2):
        threads.set_threads(threads_used)
        plain = transform.convolve(field, kernel)
        assert np.abs(plain - alone).max() <= tiny
        of_cells = transform.convolve_cells(cells, values, kernel, np.empty(shape, dtype))
        assert np.abs(of_cells - plain).max() <= tiny
        np.testing.assert_array_equal(transform.convolve(field, kernel), plain)  # scratch is as it was


@pytest.mark.internal
def test_even_and_odd_parts_add_to_one_multiplier():
    rng = np.random.default_rng(3)
    shape, padded = (6, 5), (12, 10)
    field, even, odd = rng.standard_normal(shape), rng.standard_normal((7, 6)), rng.standard_normal((7, 6))
    parts = [(transforms.kernel_spectrum(c, padded, p), p, f) for c, p, f in ((even, (1, 1), 1.0), (odd, (-1, 1), 0.3))]
    transform = transforms.PaddedTransform(shape, padded)
    both = transform.convolve(field, transforms.multiplier(parts))
    apart = sum(transform.convolve(field, transforms.multiplier([part])) for part in parts)
    # three convolutions of the same numbers; only round-off differs
    assert np.abs(both - apart).max() <= 1e-13 * np.abs(both).max()


@pytest.mark.internal
@pytest.mark.parametrize(
    ("shape", "padded"), [((6, 5), (12, 10)), ((6, 5), (11, 9)), ((8, 7), (8, 7)), ((8, 6), (8, 6))]
)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_kernels_even_and_odd_along_both_axes_add_to_a_whole_multiplier(shape, padded, dtype, one_thread):
    rng = np.random.default_rng(3)
    field = rng.standard_normal(shape).astype(dtype)
    halves = [rng.standard_normal((padded[0] // 2 + 1, padded[1] // 2 + 1)) for _ in range(2)]
    parts = [
        (transforms.kernel_spectrum(c, padded, p), p, 1.0) for c, p in zip(halves, ((1, 1), (-1, -1)), strict=True)
    ]
    kernel = wrapped(halves[0], padded, (1, 1)) + wrapped(halves[1], padded, (-1, -1))
    expected = np.fft.irfft2(np.fft.rfft2(field, s=padded) * np.fft.rfft2(kernel), s=padded)[: shape[0], : shape[1]]
    transform, factor = transforms.PaddedTransform(shape, padded, dtype), transforms.multiplier(parts, padded[0])
    tiny = ROUND_OFF[dtype] * np.abs(kernel).sum() * np.abs(field).max()
    for number in (1, 2):
        threads.set_threads(number)
        assert np.abs(transform.convolve(field, factor) - expected).max() <= tiny
    assert np.abs(transform.inverse(transform.forward(field), factor) - expected).max() <= tiny
    cells = np.arange(0, field.size, 3)
    few = np.zeros_like(field)
    few.flat[cells] = field.flat[cells]
    of_cells = transform.convolve_cells(cells, field.flat[cells], factor, np.empty(shape, dtype))
    assert np.abs(of_cells - transform.convolve(few, factor)).max() <= tiny


@pytest.mark.internal
def test_parts_of_different_parity_are_refused():
    quarter = np.ones((3, 3))
    with pytest.raises(InputError, match="parity"):
        transforms.multiplier([(quarter, (-1, 1), 1.0), (quarter, (1, -1), 1.0)])
    with pytest.raises(InputError, match="parity"):  # without the length of the transforms
        transforms.multiplier([(quarter, (1, 1), 1.0), (quarter, (-1, -1), 1.0)])


@pytest.mark.internal
def test_only_the_rows_that_matter_are_transformed():
    transform = transforms.PaddedTransform((30, 20), (60, 40))
    field = np.ones((30, 20))
    transforms.COUNT.reset()
    spectrum = transform.forward(field)
    assert (transforms.COUNT.forward, transforms.COUNT.rows, transforms.COUNT.columns) == (1, 30, 21)
    transform.inverse(spectrum)
    assert (transforms.COUNT.inverse, transforms.COUNT.rows, transforms.COUNT.columns) == (1, 60, 42)


@pytest.mark.internal
@pytest.mark.parametrize(("shape", "padded"), [*SHAPES, ((6, 4), (6, 4)), ((64, 96), (64, 96)), ((9, 5), (17, 12))])
def test_columns_in_pairs_are_those_of_real_rows(shape, padded):
    """Of even multipliers and even lengths along y, where rows are taken as complex ones half as long."""
    for dtype in (np.float64, np.float32):
        check_columns_in_pairs(shape, padded, dtype)


def check_columns_in_pairs(shape, padded, dtype):
    rng = np.random.default_rng(2)
    transform = transforms.PaddedTransform(shape, padded, dtype)
    # far more of long waves than of short ones, as of surfaces: what pairs mix are the two ends
    even = rng.random((padded[1] // 2 + 1, padded[0] // 2 + 1)) / (1 + np.arange(padded[1] // 2 + 1)[:, None]) ** 2
    factor, odd = transforms.Multiplier(even.astype(dtype)), transforms.Multiplier(None, even.astype(dtype))
    field = transform.empty_field()
    field[...] = rng.standard_normal(shape)
    before = field.copy()
    paired = transform.convolve(field, factor)
    assert np.array_equal(field, before)
    real = transform.inverse(transform.forward(field), factor)
    assert np.abs(paired - real).max() <= ROUND_OFF[dtype] * np.abs(field).max()
    cells = np.flatnonzero(field > 0.5)
    some = np.where(field > 0.5, field, 0).astype(dtype)
    listed = transform.convolve_cells(
        cells, some.reshape(-1)[cells].astype(np.float64), factor, transform.empty_field()
    )
    assert np.abs(listed - transform.convolve(some, factor)).max() <= ROUND_OFF[dtype] * np.abs(field).max()
    assert (transform.plan_for(factor.factor(transform.dtype)) is not transform.plan) == (padded[1] % 2 == 0)
    assert transform.plan_for(odd.factor(transform.dtype)) is transform.plan


@pytest.mark.internal
def test_plans_are_destroyed_while_no_other_thread_can_make_one(monkeypatch):
    fftw, found = plans.library(np.dtype(np.float64)), []

    def watched(plan):
        other = threading.Thread(target=lambda: found.append(plans._PLANNER.acquire(blocking=False)))
        other.start()
        other.join()
        destroy(plan)

    destroy = fftw._destroy
    monkeypatch.setattr(fftw, "_destroy", watched)
    transform = transforms.PaddedTransform((8, 6), (16, 12))
    transform.forward(np.ones((8, 6)))
    number = transform.plan.row_plans.size
    del transform
    gc.collect()
    assert len(found) > number  # those of columns besides
    assert not any(found)


@pytest.mark.internal
@pytest.mark.usefixtures("one_thread")
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_threads_leave_a_convolution_alone(dtype):
    transform = transforms.PaddedTransform((200, 150), (400, 300), dtype)
    field = np.random.default_rng(5).standard_normal((200, 150)).astype(dtype)
    factor = transforms.Multiplier(np.random.default_rng(6).standard_normal((151, 201)))
    results = []
    for count in (1, 2, 3):
        threads.set_threads(count)
        results.append(transform.convolve(field, factor))
    assert all(np.abs(results[0] - other).max() <= ROUND_OFF[dtype] * np.abs(results[0]).max() for other in results[1:])


def _digest():
    transform = transforms.PaddedTransform((120, 77), (240, 77))
    field = np.random.default_rng(7).standard_normal((120, 77))
    return hashlib.sha256(transform.forward(field).tobytes()).hexdigest()


@pytest.mark.internal
@pytest.mark.parametrize("columns", [None, 20])
@pytest.mark.parametrize(("shape", "padded"), [((240, 90), (480, 90)), ((300, 64), (600, 128)), ((64, 48), (64, 48))])
def test_squares_are_those_of_the_fields(shape, padded, columns, one_thread):
    rng = np.random.default_rng(4)
    transform = transforms.transform_of(shape, padded)
    spectrum = transform.forward(rng.random(shape))
    every = [
        transforms.Multiplier(*rng.random((2, padded[1] // 2 + 1, padded[0] // 2 + 1)), *pair)
        for pair in ((1, -1), (-1, 1), (1, 1))
    ]
    weights = (0.75, 1.0, 3.0)
    first, second, third = (transform.inverse(spectrum, one, columns=columns) for one in every)
    wanted = np.sqrt((0.75 * first * first + second * second) + 3.0 * third * third)
    for count in (1, 2):
        threads.set_threads(count)
        sums = np.empty(shape)
        for stage, (one, weight) in enumerate(zip(every, weights, strict=True)):
            transform.inverse_squared(spectrum, one, sums, weight=weight, stage=stage, columns=columns)
        assert np.abs(sums - wanted).max() <= ROUND_OFF[np.float64] * wanted.max()


@pytest.mark.internal
def test_another_process_gives_the_same_bits():
    here = str(Path(__file__).parent)
    code = f"import sys; sys.path.insert(0, {here!r}); import test_transforms as t; print(t._digest())"
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    assert other == _digest()


@pytest.mark.internal
def test_cached_transforms_are_bounded():
    transforms.set_transform_memory(1 << 20)
    try:
        for size in range(100, 400, 20):
            transforms.transform_of((size, size), (size, size)).forward(np.zeros((size, size)))
        transforms.transform_of((16, 16), (16, 16)).forward(np.zeros((16, 16)))
        assert transforms.transform_memory() <= 1 << 20
    finally:
        transforms.set_transform_memory(1 << 29)
    assert transforms.transform_of((16, 16), (16, 16)) is transforms.transform_of((16, 16), (16, 16))


@pytest.mark.internal
@pytest.mark.parametrize(
    "arguments", [((4, 4), (3, 4)), ((0, 4), (4, 4)), ((4, 4), (4, 4), np.int32)], ids=["short", "empty", "integers"]
)
def test_what_cannot_be_transformed_is_refused(arguments):
    with pytest.raises(InputError):
        transforms.transform_of(*arguments)


@pytest.mark.internal
@pytest.mark.parametrize("count", [0, -1, 1.5, True, "2"])
def test_thread_counts_are_positive_integers(count):
    with pytest.raises(InputError, match="set_threads"):
        threads.set_threads(count)


@pytest.mark.internal
@settings(deadline=None, max_examples=30)
@given(nx=st.integers(1, 40), ny=st.integers(1, 40), px=st.integers(0, 40), py=st.integers(0, 40))
def test_any_shape_and_padding_round_trips(nx, ny, px, py):
    transform = transforms.PaddedTransform((nx, ny), (nx + px, ny + py))
    field = np.random.default_rng(nx + 41 * ny).standard_normal((nx, ny))
    assert np.abs(transform.inverse(transform.forward(field)) - field).max() <= 1e-13


@pytest.mark.internal
def test_errors_in_threads_are_raised():
    before = threads.get_threads()
    threads.set_threads(2)

    def work(worker, block):
        if block == 3:
            raise ZeroDivisionError

    try:
        with pytest.raises(ZeroDivisionError):
            threads.share(work, 4, 4)
    finally:
        threads.set_threads(before)


@pytest.mark.internal
def test_what_is_small_or_shared_already_is_not_shared(monkeypatch, one_thread):
    monkeypatch.setattr(threads, "SHARED_FROM", 1000)
    monkeypatch.setattr(threads, "cores", lambda: 2)
    threads.set_threads(2)
    seen, meeting = [], threading.Barrier(2, timeout=60)

    def inner(worker, block):
        seen.append((threading.get_ident(), worker, threads.get_threads()))

    threads.share(inner, 4, 999)
    assert seen == [(threading.get_ident(), 0, 2)] * 4
    seen.clear()
    # both are there: who comes first takes all there is
    threads.share(lambda worker, block: (meeting.wait(), threads.share(inner, 3, 5000)), 2, 1000)
    assert len(seen) == 6
    assert len({who for who, _, _ in seen}) == 2
    assert {(worker, count) for _, worker, count in seen} == {(0, 1)}  # each does its own blocks, on one thread
    assert threads.get_threads() == 2
    assert threads.threads_for(999) == 1
    assert threads.threads_for(1000) == 2


@pytest.mark.internal
@pytest.mark.usefixtures("one_thread", "shared_as_it_is")
def test_threads_share_nothing_that_takes_less_than_handing_it_over(monkeypatch):
    """Contacts of 256 and 512 cells lost a fifth to two threads, as did stresses at 32 depths: 2 to 16 hand-overs a
    pass or component."""
    handed = []
    plain = threads._Pool.submit
    monkeypatch.setattr(
        threads._Pool, "submit", lambda pool, take, helpers: (handed.append(helpers), plain(pool, take, helpers))[1]
    )
    monkeypatch.setattr(threads, "cores", lambda: 2)
    threads.set_threads(2)
    body = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
    grid = Grid((512, 512), (1e-6, 1e-6), periodic=(True, True))
    bump = np.cos(2 * np.pi * grid.x / grid.lengths[0])[:, None] * np.cos(2 * np.pi * grid.y / grid.lengths[1])
    contact = solve_contact(-1e-7 * bump, displacement_operator(grid, body), load=1e-2)
    assert contact.status == "converged"
    assert handed == []
    small = Grid((64, 64), (1e-6, 1e-6))
    von_mises_field(np.ones(small.shape), small, body, np.linspace(0, 1e-5, 16))
    assert handed == [1]  # all depths at once


@pytest.mark.internal
def test_padded_lengths_hold_every_offset_and_prefer_powers_of_two_that_are_little_longer():
    for cells in range(2, 1100):
        length = transforms.padded_length(cells, False)
        fast = 2 * int(scipy.fft.next_fast_len(cells, real=True))
        assert length % 2 == 0
        assert length >= 2 * cells - 1
        assert length == fast or (length in (512, 1024, 2048) and length <= 1.1 * fast)
        assert transforms.padded_length(cells, True) == cells
    chosen = {cells: transforms.padded_length(cells, False) for cells in (120, 240, 480, 500, 1000)}
    assert chosen == {120: 240, 240: 512, 480: 960, 500: 1024, 1000: 2048}


WAVES = 40  # along a periodic y


def falling(nx, decay, parity):
    """(nx, WAVES): a kernel whose waves along y fall as a half-space's do, with their powers; none of wave zero."""
    waves = np.arange(1, WAVES // 2 + 1)
    reach = decay * np.outer(np.abs(np.arange(nx)), waves)
    along_x = np.exp(-reach) * (reach if parity[0] == -1 else 1 + reach)
    along_y = 2 * np.pi / WAVES * np.outer(waves, np.arange(WAVES))
    return along_x @ (np.sin(along_y) if parity[1] == -1 else np.cos(along_y))


@pytest.mark.internal
@pytest.mark.parametrize("parity", PARITIES)
@pytest.mark.parametrize("decay", [0.03, 0.15, 2.0])
def test_short_waves_are_padded_by_their_reach_alone_and_lose_nothing(decay, parity):
    nx = 61
    padded = (transforms.padded_length(nx, False), WAVES)
    lengths = transforms.narrowed_lengths(nx, padded, decay)
    assert lengths[0] == padded[0]
    assert all(a >= b >= nx for a, b in itertools.pairwise(lengths))
    for wave, length in enumerate(lengths[1:], 1):
        assert length == padded[0] or np.exp(-decay * wave * (length - nx)) < 2.0**-53
    kernel = falling(nx, decay, parity)
    field = np.random.default_rng(4).standard_normal((nx, WAVES))
    found, numbers = [], []
    for own in (None, lengths):
        transform = transforms.PaddedTransform((nx, WAVES), padded, lengths=own)
        factor = transforms.multiplier([(transforms.kernel_spectrum(kernel, padded, parity, own), parity, 1.0)])
        transforms.COUNT.reset()
        found.append(transform.convolve(field, factor))
        again = transform.inverse(transform.forward(field), factor)
        assert np.abs(again - found[-1]).max() <= 1e-14 * np.abs(again).max()  # as ROUND_OFF
        numbers.append(transforms.COUNT.numbers)
    assert np.abs(found[1] - found[0]).max() <= 1e-14 * np.abs(found[0]).max()
    # waves of small decay need all of it, others a little more than the field
    assert numbers[1] == 4 * sum(lengths)
    assert numbers[0] == 4 * padded[0] * len(lengths)
    assert numbers[1] <= {0.03: 1.0, 0.15: 0.85, 2.0: 0.7}[decay] * numbers[0]


@pytest.mark.internal
@pytest.mark.parametrize("decay", [1e-2, 1e-6, 1e-300])
def test_waves_that_hardly_fall_are_padded_as_ever(decay):
    """Cells far shorter along x than along y: the reach is beyond any length on the list."""
    assert transforms.narrowed_lengths(61, (128, WAVES), decay) == (128,) * (WAVES // 2 + 1)


@pytest.mark.internal
def test_lengths_that_hold_no_field_are_refused():
    with pytest.raises(InputError, match="must be 5, from 6 to 12"):
        transforms.transform_of((6, 8), (12, 8), lengths=(12, 12, 8, 5, 6))
    with pytest.raises(InputError, match="must be 5, from 6 to 12"):
        transforms.transform_of((6, 8), (12, 8), lengths=(12, 12, 8))


@pytest.mark.internal
def test_both_precisions_take_turns_in_one_buffer():
    shape, padded = (48, 131), (96, 270)
    double, single = transforms.transform_of(shape, padded), transforms.transform_of(shape, padded, np.float32)
    assert single is transforms.transform_of(shape, padded, np.float32)
    assert np.shares_memory(double.plan.row_spectra, single.plan.row_spectra)
    assert double.nbytes > 0
    assert single.nbytes == 0
    alone = transforms.PaddedTransform(shape, padded, np.float32)
    field = np.random.default_rng(0).random(shape)
    spectrum, narrow = double.forward(field), single.forward(field.astype(np.float32))
    np.testing.assert_array_equal(narrow, alone.forward(field.astype(np.float32)))
    np.testing.assert_allclose(double.inverse(spectrum), field, atol=1e-14)
    np.testing.assert_array_equal(single.inverse(narrow), alone.inverse(narrow))
