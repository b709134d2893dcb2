"""Each compiled pass against its plain form in numpy; both a single block and many."""

import numpy as np
import pytest
from contact_oracles import FREE, PERIODIC, notes_surface, operator

from bem.contact import at_once, face, feasible, gradients, inner, judging, long_waves, passes, sets
from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.level import Effort, Iterate, Level, Stride, Tuning

pytestmark = pytest.mark.internal

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
    capped, cap, nothing = np.setdiff1d(np.arange(150), cells), 1.5, cells[:0]
    other = cells[::3], values[::3] ** 2, capped[::2]
    seen = judging.survey(displacement, gap, (cells, values, nothing), cap, other)
    u, g = displacement[cells], gap[cells]
    plain = (
        (g + u).sum(), (g + u).max(), (g + u).min(), np.abs(u).max(), (values * (g + u / 2)).sum(),
        (np.abs(values * g) + np.abs(values * u)).sum(), values.sum(), (values * (g + u)).sum(),
        (values**2 * (g + u))[::3].sum() + cap * (gap + displacement)[capped[::2]].sum(),
    )  # fmt: skip
    assert np.allclose(seen, plain, rtol=0, atol=ROUND_OFF * seen.size)
    both = judging.survey(displacement, gap, (cells, values, capped), cap)
    more = judging.survey(displacement, gap, (capped, np.full(capped.size, cap), nothing), cap)
    assert both[:4] == seen[:4]
    assert np.allclose(both[4:8], np.add(seen[4:8], more[4:8]), rtol=0, atol=ROUND_OFF * seen.size)
    assert both.work_of_other == 0
    alone = judging.survey(displacement, gap, (nothing, values[:0], capped), cap)
    assert alone[1:3] == (-np.inf, np.inf)
    assert alone.reach == np.abs(displacement[capped]).max()


def test_the_deepest_and_the_nearest_are_those_of_numbers(fields):
    displacement, gap, cells, values = fields
    displacement[cells[:6]] = np.inf, -np.inf, np.nan, -np.nan, -0.0, 3.5
    gap[cells[4:6]] = 0.0, -3.5
    opening, capped = gap + displacement, np.setdiff1d(np.arange(150), cells)
    # what is no number counts for nothing: it is told by the sum
    known = opening[cells][~np.isnan(opening[cells])]
    seen = judging.survey(displacement, gap, (cells, values, cells[:0]), 1.5)
    assert seen[1:4] == (known.max(), known.min(), np.inf)
    assert np.isnan(seen.total)
    finite = cells[6:], values[6:], cells[:0]
    assert judging.survey(displacement, gap, finite, 1.5)[1:4] == (
        opening[cells[6:]].max(), opening[cells[6:]].min(), np.abs(displacement[cells[6:]]).max()
    )  # fmt: skip
    state = np.zeros(SIZE, np.uint8)
    judging.mark(state, cells, capped)
    pressed, open_to = np.union1d(cells, capped), np.setdiff1d(np.arange(SIZE), capped)
    wanted = np.nanmax(opening[pressed]), np.nanmin(opening[open_to])
    assert judging.separations(displacement, gap, state) == wanted
    state[:] = judging.CAPPED
    assert judging.separations(displacement, gap, state)[1] == np.inf


@pytest.mark.parametrize("cap", [0.6, np.inf])
def test_what_is_held_of_a_field(cap, fields):
    displacement, gap, _, _ = fields
    pressure = np.clip(displacement, 0, cap)
    cells, values, capped = sets.held(pressure, cap)
    assert np.array_equal(cells, np.flatnonzero((pressure > 0) & (pressure < cap)))
    assert np.array_equal(values, pressure[cells])
    assert np.array_equal(capped, np.flatnonzero(pressure >= cap))
    out = np.empty(SIZE)
    passes.in_blocks(SIZE, 0, sets.descend, displacement, gap, 0.3, 0.7, out)
    assert np.array_equal(out, -(0.7 * (gap + displacement - 0.3)))


@pytest.mark.parametrize(("cap", "share"), [(0.3, 1e-9), (1e3, 0.1), (0.3, 0.9)])
def test_shifting_to_a_sum(cap, share, fields):
    raw, _, _, _ = fields
    wanted = share * (cap * raw.size if cap < 1 else 50.0)
    plain = _plain_shift(raw - raw.max(), max(raw.max(), 0.0), wanted, cap)
    values = feasible.shifted(raw, wanted, cap)
    assert values.min() >= 0
    assert values.max() <= cap
    assert values.sum() == pytest.approx(wanted, rel=1e-14)
    assert np.allclose(values, np.clip(raw - raw.max() + plain, 0, cap), rtol=0, atol=1e-14 * plain)


def _plain_shift(values, shift, wanted, cap):
    """Newton's method between bounds, step by step."""
    low, high = 0.0, cap - values.min()
    for _ in range(100):
        moved = values + shift
        error, inside = np.clip(moved, 0, cap).sum() - wanted, np.count_nonzero((moved > 0) & (moved < cap))
        if abs(error) <= 4e-16 * wanted:
            break
        low, high = (low, shift) if error > 0 else (shift, high)
        trial = shift - error / inside if inside else np.nan
        trial = trial if low < trial < high else 0.5 * (low + high)
        if trial == shift:
            break
        shift = trial
    return shift


def test_merge(fields):
    displacement, gap, cells, values = fields
    found = np.setdiff1d(np.arange(0, SIZE, 7), cells).astype(np.int32)
    state = np.zeros(SIZE, np.uint8)
    state[found[::2]] = judging.CAPPED
    *merged, mean = sets.merge((cells, values), found, state, 2.0, (displacement, gap, 0.3))
    everywhere = np.zeros(SIZE)
    everywhere[cells], everywhere[found[::2]] = values, 2.0
    both = np.union1d(cells, found)
    assert np.array_equal(merged[0], both)
    assert np.array_equal(merged[1], everywhere[both])
    assert np.allclose(merged[2], (gap + displacement - 0.3)[both], rtol=0, atol=1e-15)
    assert mean == pytest.approx(merged[2].mean(), abs=ROUND_OFF)


def test_violations_of_free_and_of_capped_cells(fields):
    displacement, gap, cells, values = fields
    state = np.full(SIZE, 7, np.uint8)
    pressure = cells[:100], values[:100], cells[100:]
    found, largest = judging.find_violations(displacement, gap, state, pressure, 0.1)
    plain = np.zeros(SIZE)
    plain[pressure[0]], plain[pressure[2]] = judging.CONTACT, judging.CAPPED
    assert np.array_equal(state, plain)
    value = 0.1 - gap - displacement
    wrong = ((state == judging.FREE) & (value > 0)) | ((state == judging.CAPPED) & (value < 0))
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
    kept, raw, total = sets.positive(cells, out)
    assert np.array_equal(kept, cells[out > 0])
    assert np.array_equal(raw, out[out > 0])
    assert total == pytest.approx(raw.sum(), rel=1e-13)


@pytest.mark.parametrize(("cap", "wrong"), [(np.inf, None), (1.4, None), (np.inf, -1e-3), (1.4, 2.0), (np.inf, np.nan)])
def test_what_is_returned_is_judged_cell_by_cell(fields, cap, wrong):
    displacement, gap, cells, values = fields
    scaled = np.zeros(SIZE)
    scaled[cells] = np.minimum(values, 0.7)  # half the cap
    if wrong is not None:
        scaled[cells[3]] = wrong
    pressure, moved = scaled.copy(), displacement.copy()
    deformed, depth = np.empty(SIZE), np.zeros(SIZE)
    found = passes.assemble((pressure, moved, gap), (2.0, 0.25), 0.1, cap, (deformed, depth))
    p, u = np.minimum(2.0 * scaled, cap), 0.25 * displacement
    opening = gap + u - 0.1
    free, capped = p <= 0, p >= cap
    violation = np.where(free, -opening, np.where(capped, opening, np.abs(opening)))
    assert found[0] == (np.inf if wrong is not None and not 0 <= wrong <= cap / 2 else violation.max())
    assert found[1] == np.abs(u).max()
    assert found[2] == pytest.approx(p[~free].sum(), rel=1e-14, nan_ok=True)
    assert found[3:5] == (np.count_nonzero(~free), np.count_nonzero(capped))
    assert found[5] == pytest.approx(opening[free & (opening > 0)].sum(), rel=1e-13)
    assert np.array_equal(pressure, p, equal_nan=True)
    assert np.array_equal(moved, u)
    assert np.array_equal(deformed, np.where(free, np.maximum(opening, 0.0), opening))
    assert np.array_equal(depth, np.where(capped, np.maximum(-opening, 0.0), 0.0))


@pytest.mark.parametrize("value", [np.nan, -np.nan, np.inf, -np.inf])
def test_no_displacement_that_is_no_number_passes(value):
    for size in (5, 300):
        displacement = np.full(size, 0.5)
        displacement[size - 2] = value
        fields = np.zeros(size), displacement, np.ones(size)
        largest, reach, *_ = passes.assemble(fields, (1.0, 1.0), 0.0, np.inf, (np.empty(size), np.zeros(size)))
        assert not largest / reach <= 1e-8 if value != np.inf else reach == np.inf


def test_regions_keep_their_load_where_pressures_are_clipped():
    cap, side, shape = 0.7, 8, (21, 35)  # regions at the ends are cut off
    rng = np.random.default_rng(5)
    cells = np.sort(rng.choice(shape[0] * shape[1], 600, replace=False))
    raw = rng.uniform(-0.1, 0.8, cells.size)
    raw[cells // shape[1] < 4] -= 0.5  # more below zero there than half of what is left can make up for
    values = raw.copy()
    sets.settle(cells, values, cap, shape, side)
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
    near = level.sparse.on(cells)
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


def test_values_are_carried_from_cells_to_cells():
    before, values = np.array([2, 3, 7, 9]), np.array([1.0, 2.0, 3.0, 4.0])
    out = np.empty(5)
    assert gradients.carry(before, values, 10.0, np.array([0, 3, 7, 9, 11]), out) == 15.0
    np.testing.assert_array_equal(out, [3.0, 2.0, 3.0, 4.0, 3.0])
    assert gradients.carry(before, values, 10.0, np.array([0, 3, 4, 9, 11]), out) == 0.0  # most are new
    fallen = np.array([1.0, 0.1, 0.1, 0.1])  # those known have too little of the sum
    assert gradients.carry(before, fallen, 1.3, np.array([3, 7, 9]), out[:3]) == 0.0


@pytest.mark.parametrize("size", [1, 1000, 2 * passes.BLOCK + 5])
def test_a_weighed_mean_is_taken_off(size):
    rng = np.random.default_rng(size)
    values, weights, out = rng.standard_normal(size), rng.random(size), np.empty(size)
    gradients.weighed_free(values, weights, weights.sum(), out)
    np.testing.assert_allclose(out, values - (weights @ values) / weights.sum(), rtol=0, atol=1e-13)


@pytest.mark.parametrize("n", [24, 96])
def test_no_cells_take_no_iteration(n):
    level = Level(operator((n, n), (1 / n, 1 / n), PERIODIC), np.zeros(n * n), np.inf, Tuning())
    nothing = np.empty(0)
    iterate = Iterate(np.empty(0, np.int64), nothing, np.empty(0, np.int64))
    effort = Effort(9)
    found = face.solve_on_cells(level, iterate, face.Opening(nothing, 0.0), ApproachControl(0.1), 1e-6, effort)
    assert found.size == effort.iterations == level.operator.count.applications == 0


@pytest.mark.parametrize(  # 24 cells have no long waves
    ("n", "control", "alone"),
    [
        *((24, LoadControl(30.0), True), (96, ApproachControl(0.1), True)),
        *((24, ApproachControl(0.1), False), (96, LoadControl(30.0), False)),
    ],
)
def test_conjugate_gradients_in_one_call_are_those_pass_by_pass(n, control, alone, monkeypatch):
    op = operator((n, n), (1 / n, 1 / n), PERIODIC)
    level = Level(op, np.zeros(n * n), np.inf, Tuning())
    height = notes_surface(n, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 0.8))
    iterate = Iterate(cells, 5 + np.random.default_rng(6).random(cells.size), cells[:0])
    monkeypatch.setattr(inner, "threads_for", lambda _: 1 if alone else 2)
    calls = []
    monkeypatch.setattr(
        face, "_pass_by_pass", lambda *given, plain=face._pass_by_pass: (calls.append(1), plain(*given))[1]
    )
    results = []
    for block in (passes.BLOCK, 100):
        monkeypatch.setattr(passes, "BLOCK", block)
        level.rise = level.sparse = None
        level.stride = Stride()
        before, effort = op.count.weighted, Effort(50)
        opening = 0.01 * np.sin(np.arange(cells.size))
        found = face.solve_on_cells(level, iterate, face.Opening(opening, float(opening.mean())), control, 1e-6, effort)
        results.append((effort.iterations, level.stride.taken, op.count.weighted - before, level.stride.length, found))
    assert calls == [1]
    assert results[0][0] >= 3
    assert results[0][:3] == results[1][:3]
    for one, plain in zip(results[0][3:], results[1][3:], strict=True):
        # the transforms are in single precision
        np.testing.assert_allclose(one, plain, rtol=0, atol=1e-6 * np.abs(plain).max())


@pytest.mark.parametrize(
    ("n", "control", "cap"),
    [
        *((24, LoadControl(30.0), 8.0), (96, ApproachControl(0.1), 8.0)),
        *((24, ApproachControl(0.1), np.inf), (96, LoadControl(30.0), np.inf)),
    ],
)
def test_two_calls_close_the_gap_as_the_passes_one_by_one_do(n, control, cap):
    op = operator((n, n), (1 / n, 1 / n), PERIODIC)
    height, rng = notes_surface(n, rolloff=4).ravel(), np.random.default_rng(7)
    cells, lower = (np.flatnonzero(height > np.quantile(height, share)) for share in (0.8, 0.7))
    more = np.setdiff1d(lower, cells)
    found = more[rng.random(more.size) < 0.3].astype(np.int32)
    capped = more[:0] if np.isinf(cap) else found[::3].astype(np.int64)
    iterate = Iterate(cells, 5 + rng.random(cells.size), capped)
    displacement, results = 0.01 * rng.standard_normal(n * n), []
    levels = [Level(op, 0.1 - 0.1 * height, cap, Tuning(clipping=0.0)) for _ in range(2)]
    for level, plain in zip(levels, (False, True), strict=True):
        effort = Effort(50)
        for turn in range(2):  # the second has the rise of the first
            level.flat["displacement"][:] = displacement
            judging.mark(level.state, iterate.cells, iterate.capped)
            level.stride.trusted = turn == 1
            before, made = op.count.weighted, effort.iterations
            given = level, iterate, found[turn:], 0.02
            if plain:
                taken, opening = face.take_in(*given)
                raw = face.solve_on_cells(level, taken, opening, control, 1e-6, effort)
            else:
                assert at_once.fits(level, iterate, found[turn:], control)
                taken, raw = at_once.close(*given, control, 1e-6, effort)
            near, rise = level.near_on(taken.cells), level.rise or ()
            stride, state = (level.stride.length, level.stride.taken), level.state.copy()
            counts = effort.iterations - made, op.count.weighted - before
            results.append(
                (taken.cells, taken.values, taken.capped, raw, *near.rows, *near.seam, *rise, stride, state, counts)
            )
    assert results[0][-1][0] >= 2
    for one, plain in zip(results[:2], results[2:], strict=True):
        assert len(one) == len(plain)
        for ours, theirs in zip(one, plain, strict=True):
            np.testing.assert_array_equal(ours, theirs)


def test_what_is_not_closed_in_two_calls(monkeypatch):
    n = 24
    level = Level(operator((n, n), (1 / n, 1 / n), PERIODIC), np.zeros(n * n), np.inf, Tuning())
    cells = np.arange(n * n - 1)
    iterate, one = Iterate(cells, np.ones(cells.size), cells[:0]), np.array([n * n - 1], np.int32)
    nothing = Iterate(cells[:0], np.empty(0), cells[:0])
    assert at_once.fits(level, iterate, one, LoadControl(1.0))
    assert not at_once.fits(level, iterate, one, ApproachControl(0.1))  # full contact has ways of its own
    assert not at_once.fits(level, nothing, one, LoadControl(1.0))  # one cell has all the load
    assert not at_once.fits(level, nothing, one[:0], ApproachControl(0.1))
    monkeypatch.setattr(passes, "BLOCK", cells.size)
    assert not at_once.fits(level, iterate, one, LoadControl(1.0))
    monkeypatch.setattr(at_once, "threads_for", lambda _: 2)
    assert not at_once.fits(level, iterate, one[:0], LoadControl(1.0))


def test_two_pressures_are_blended():
    rng = np.random.default_rng(8)
    size, cap, share = 300, 0.8, 0.3
    fields = [np.where(rng.random(size) < 0.5, np.minimum(rng.random(size), cap), 0.0) for _ in range(2)]
    sides = [(np.flatnonzero(field), field[field > 0]) for field in fields]
    cells, values = sets.blend(*sides, share, cap)
    plain = (1 - share) * fields[0] + share * fields[1]
    plain[(fields[0] == cap) & (fields[1] == cap)] = cap
    assert (plain == cap).any()
    assert np.array_equal(cells, np.flatnonzero(plain))
    assert np.array_equal(values, plain[cells])
