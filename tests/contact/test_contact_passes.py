"""Each compiled pass against its plain form in numpy; both a single block and many."""

import numpy as np
import pytest
from contact_oracles import FREE, PERIODIC, notes_surface, operator

from bem.contact import face, gradients, long_waves, passes, preconditioner
from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.inverse import Step
from bem.contact.level import Iterate, Level, Tuning

SIZE = 500
# sums of a few hundred numbers of order one in another order
ROUND_OFF = 1e-12
BALANCE = ("kept", "rise", "share", "shifted")


@pytest.fixture(params=[1 << 15, 77], ids=["one block", "many blocks"])
def fields(request, monkeypatch):
    monkeypatch.setattr(passes, "BLOCK", request.param)
    rng = np.random.default_rng(0)
    cells = np.sort(rng.permutation(SIZE)[:200])
    return rng.standard_normal(SIZE), rng.standard_normal(SIZE), cells, rng.uniform(0, 1, cells.size)


def test_survey(fields):
    displacement, gap, cells, values = fields
    seen = passes.survey(displacement, gap, cells, values)
    u, g = displacement[cells], gap[cells]
    plain = (
        (g + u).sum(), (g + u).max(), (g + u).min(), np.abs(u).max(), (values * (g + u / 2)).sum(),
        (np.abs(values * g) + np.abs(values * u)).sum(), values.sum(), (values * (g + u)).sum(),
    )  # fmt: skip
    assert np.allclose(seen, plain, rtol=0, atol=ROUND_OFF * seen.size)
    assert passes.survey(displacement, gap, cells[:0], values[:0])[1:3] == (-np.inf, np.inf)


def test_merge(fields):
    displacement, gap, cells, values = fields
    found = np.setdiff1d(np.arange(0, SIZE, 7), cells).astype(np.int32)
    new = np.full(found.size, 2.0)
    merged = (
        np.empty(cells.size + found.size, np.int64),
        np.empty(cells.size + found.size),
        np.empty(700)[: cells.size + found.size],
    )
    total = passes.merge((cells, values), (found, new), (displacement, gap, 0.3), merged)
    everywhere = np.zeros(SIZE)
    everywhere[cells], everywhere[found] = values, new
    both = np.union1d(cells, found)
    assert np.array_equal(merged[0], both)
    assert np.array_equal(merged[1], everywhere[both])
    assert np.allclose(merged[2], (gap + displacement - 0.3)[both], rtol=0, atol=1e-15)
    assert total == pytest.approx(merged[2].sum(), abs=ROUND_OFF * SIZE)


def test_violations_of_free_and_of_capped_cells(fields):
    displacement, gap, cells, _ = fields
    state = np.zeros(SIZE, np.uint8)
    passes.mark(state, cells[:100], cells[100:])
    value = 0.1 - gap - displacement
    wrong = ((state == passes.FREE) & (value > 0)) | ((state == passes.CAPPED) & (value < 0))
    found, largest = passes.find_violations(displacement, gap, state, 0.1)
    assert np.array_equal(found, np.flatnonzero(wrong))
    assert largest == pytest.approx(np.abs(value[wrong]).max(), rel=1e-14)


def test_stride_and_positive(fields):
    _, way, cells, values = fields
    way = way[: cells.size]
    out = np.empty(cells.size)
    outside, largest = gradients.stride(values, (way, values, 0.2), 0.7, 0.9, way, out)
    assert np.allclose(out, values - 0.7 * (way + 0.2 * values), rtol=0, atol=1e-15)
    assert outside == pytest.approx(max(-out.min(), out.max() - 0.9), rel=1e-14)
    assert largest == np.abs(way).max()
    kept, raw, total = passes.positive(cells, out)
    assert np.array_equal(kept, cells[out > 0])
    assert np.array_equal(raw, out[out > 0])
    assert total == pytest.approx(raw.sum(), rel=1e-13)


def test_regions_keep_their_load_where_pressures_are_clipped():
    cap, side, shape = 0.7, 8, (21, 35)  # regions at the ends are cut off
    rng = np.random.default_rng(5)
    cells = np.sort(rng.choice(shape[0] * shape[1], 600, replace=False))
    raw = rng.uniform(-0.1, 0.8, cells.size)
    raw[cells // shape[1] < 4] -= 0.5  # more below zero there than half of what is left can make up for
    values = raw.copy()
    passes.settle(cells, values, cap, shape, side)
    inside = (raw > 0) & (raw < cap)
    assert np.array_equal(values[~inside], raw[~inside])
    region = cells // shape[1] // side * 100 + cells % shape[1] // side
    made_up = 0
    for name in np.unique(region):
        here = region == name
        share = values[here & inside] / raw[here & inside]
        assert np.ptp(share) <= 1e-14
        if 0.51 < share[0] < 1.49:
            made_up += 1
            clipped = np.where(inside, values, np.clip(raw, 0, cap))
            assert clipped[here].sum() == pytest.approx(raw[here].sum(), rel=1e-13)
        else:
            assert share[0] == pytest.approx(0.5, rel=1e-14)
    assert 5 < made_up < np.unique(region).size


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
def test_long_waves_are_the_plain_conjugate_gradients(periodic):
    n = 96
    op = operator((n, n), (1 / n, 1 / n), periodic)
    level = Level(op, np.zeros(n * n), np.inf, Tuning())
    height = notes_surface(n, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 0.8))
    level.preconditioner(cells)
    near = level.sparse.on(cells, cells)
    far = level.smooth.on(cells, near.row_sums())
    values = np.random.default_rng(3).standard_normal(cells.size)
    before = op.count.applications
    result = values.copy()
    far.apply(result)
    applications = op.count.applications - before

    given = np.bincount(far.blocks, far.weights * values, far.root.size) * far.inverse_root
    solution, residual, direction = np.zeros(given.size), given.copy(), np.zeros(given.size)
    share, made = 0.0, 0
    while residual @ residual > long_waves._REDUCTION**2 * (given @ given):
        direction = residual + share * direction
        field = (far.root * direction).astype(np.float32).reshape(level.smooth.workspace.field.shape)
        level.smooth.convolution.apply(field, field)
        response = far.root * field.ravel() + direction
        squares = residual @ residual
        step = squares / (direction @ response)
        solution += step * direction
        residual = residual - step * response
        share = residual @ residual / squares
        made += 1
    plain = values - far.weights * ((given - solution) * far.inverse_root)[far.blocks]
    assert applications == made
    # the transforms are in single precision
    assert np.abs(result - plain).max() <= 1e-5 * np.abs(plain).max()


def test_entries_that_leave_a_block_are_told_from_the_rest(monkeypatch):
    n = 64
    op = operator((n, n), (1 / n, 1 / n), PERIODIC)
    cells = np.sort(np.random.default_rng(4).permutation(n * n)[:2500])
    results = []
    for block in (1 << 15, 300):
        monkeypatch.setattr(passes, "BLOCK", block)
        near = preconditioner.sparse_inverse((n, n), PERIODIC, op.near_field(4), 5).on(cells, None)
        out = np.empty(cells.size)
        total = near.collect(np.sin(np.arange(cells.size)), out)
        results.append((out, total))
        if block == 300:
            # a block's entries look back two rows at most: far fewer than its cells leave it
            assert 0 < near.outside.targets.size < near.rows.columns.size / 2
            assert (near.outside.inner < np.minimum(300 * np.arange(1, 10), cells.size)).any()
    assert np.allclose(results[0][0], results[1][0], rtol=0, atol=1e-13)
    assert results[0][1] == pytest.approx(results[1][1], abs=1e-11)


def test_values_are_carried_from_cells_to_cells():
    before, values = np.array([2, 3, 7, 9]), np.array([1.0, 2.0, 3.0, 4.0])
    cells = np.array([0, 3, 4, 9, 11])
    out = np.empty(5)
    assert gradients.carry(before, values, cells, out) == (2, 6.0)
    np.testing.assert_array_equal(out, [np.nan, 2.0, np.nan, 4.0, np.nan])


@pytest.mark.parametrize("size", [1, 1000, 2 * passes.BLOCK + 5])
def test_a_weighed_mean_is_taken_off(size):
    rng = np.random.default_rng(size)
    values, weights, out = rng.standard_normal(size), rng.random(size), np.empty(size)
    gradients.weighed_free(values, weights, weights.sum(), out)
    np.testing.assert_allclose(out, values - (weights @ values) / weights.sum(), rtol=0, atol=1e-13)


@pytest.mark.parametrize("n", [24, 96])
def test_no_cells_have_no_descent(n):
    level = Level(operator((n, n), (1 / n, 1 / n), PERIODIC), np.zeros(n * n), np.inf, Tuning())
    inverse, nothing = level.preconditioner(np.empty(0, np.int64)), np.empty((6, 0))
    before = level.operator.count.applications
    balance = nothing[0], 0.0, nothing[1]
    assert inverse.descend(tuple(nothing[:3]), tuple(nothing[3:]), balance, Step(2.0, 0.3, 0.9)) == (0, 0, 0, 0)
    assert level.operator.count.applications == before


@pytest.mark.parametrize("n", [24, 96])  # the smaller has no long waves
@pytest.mark.parametrize("control", [LoadControl(30.0), ApproachControl(0.1)])
def test_a_descent_in_one_call_is_its_passes(n, control, monkeypatch):
    op = operator((n, n), (1 / n, 1 / n), PERIODIC)
    level = Level(op, np.zeros(n * n), np.inf, Tuning())
    height = notes_surface(n, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 0.8))
    rng = np.random.default_rng(6)
    pressure, residual, previous, direction = rng.random((4, cells.size))
    iterate = Iterate(cells, pressure, cells[:0])
    balance = face.Balance.of(level, iterate, face.Opening(residual, float(residual.mean())), control)
    assert (balance.inverse.far is None) == (n == 24)
    results = []
    for block in (passes.BLOCK, 100):
        monkeypatch.setattr(passes, "BLOCK", block)
        level.sparse_cells = None
        own = face.Balance(level.preconditioner(cells), *[getattr(balance, name) for name in BALANCE])
        out, ahead = np.empty((2, cells.size))
        before = op.count.applications
        found = own.descend((pressure, residual, previous), (out, direction, ahead), Step(2.0, 0.3, 0.9))
        results.append((*found, op.count.applications - before, out, ahead))
    assert results[0][4] == results[1][4]
    for one, plain in zip(*results, strict=True):
        np.testing.assert_allclose(one, plain, rtol=0, atol=ROUND_OFF * cells.size)
