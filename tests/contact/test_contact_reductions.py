"""Each compiled reduction and projection against its plain form in numpy; both a single block and many."""

import numpy as np
import pytest
from contact_oracles import FREE, PERIODIC, notes_surface, operator

from bem.contact import bounds, coarse_correction, reductions
from bem.contact.cell_states import CAPPED, ELASTIC, OPEN
from bem.contact.grid_workspace import GridWorkspace, SolverParameters

pytestmark = pytest.mark.internal

SIZE = 500
# sums of a few hundred numbers of order one in another order
ROUND_OFF = 1e-12


@pytest.fixture(params=[1 << 15, 77], ids=["one block", "many blocks"])
def fields(request, monkeypatch):
    monkeypatch.setattr(reductions, "BLOCK", request.param)
    rng = np.random.default_rng(0)
    cells = np.sort(rng.permutation(SIZE)[:200])
    return rng.standard_normal(SIZE), rng.standard_normal(SIZE), cells, rng.uniform(0, 1, cells.size)


def test_contact_sums(fields):
    displacement, gap, cells, values = fields
    capped, cap, nothing = np.setdiff1d(np.arange(150), cells), 1.5, cells[:0]
    other = cells[::3], values[::3] ** 2, capped[::2]
    seen = reductions.contact_sums(displacement, gap, (cells, values, nothing), cap, other)
    u, g = displacement[cells], gap[cells]
    plain = (
        (g + u).sum(), (g + u).max(), (g + u).min(), np.abs(u).max(), (values * (g + u / 2)).sum(),
        (np.abs(values * g) + np.abs(values * u)).sum(), values.sum(), (values * (g + u)).sum(),
        (values**2 * (g + u))[::3].sum() + cap * (gap + displacement)[capped[::2]].sum(),
    )  # fmt: skip
    assert np.allclose(seen, plain, rtol=0, atol=ROUND_OFF * seen.energy_size)
    both = reductions.contact_sums(displacement, gap, (cells, values, capped), cap)
    more = reductions.contact_sums(displacement, gap, (capped, np.full(capped.size, cap), nothing), cap)
    assert both[:4] == seen[:4]
    assert np.allclose(both[4:8], np.add(seen[4:8], more[4:8]), rtol=0, atol=ROUND_OFF * seen.energy_size)
    assert both.work_of_other == 0
    alone = reductions.contact_sums(displacement, gap, (nothing, values[:0], capped), cap)
    assert alone[1:3] == (-np.inf, np.inf)
    assert alone.largest_displacement == np.abs(displacement[capped]).max()


def test_the_largest_and_the_smallest_separation_skip_not_a_number(fields):
    displacement, gap, cells, values = fields
    displacement[cells[:6]] = np.inf, -np.inf, np.nan, -np.nan, -0.0, 3.5
    gap[cells[4:6]] = 0.0, -3.5
    opening, capped = gap + displacement, np.setdiff1d(np.arange(150), cells)
    # what is no number counts for nothing: it is told by the sum
    known = opening[cells][~np.isnan(opening[cells])]
    seen = reductions.contact_sums(displacement, gap, (cells, values, cells[:0]), 1.5)
    assert seen[1:4] == (known.max(), known.min(), np.inf)
    assert np.isnan(seen.separation_sum)
    finite = cells[6:], values[6:], cells[:0]
    assert reductions.contact_sums(displacement, gap, finite, 1.5)[1:4] == (
        opening[cells[6:]].max(), opening[cells[6:]].min(), np.abs(displacement[cells[6:]]).max()
    )  # fmt: skip
    state = np.zeros(SIZE, np.uint8)
    reductions.mark_states(state, cells, capped)
    pressed, open_to = np.union1d(cells, capped), np.setdiff1d(np.arange(SIZE), capped)
    wanted = np.nanmax(opening[pressed]), np.nanmin(opening[open_to])
    assert reductions.separations(displacement, gap, state) == wanted
    state[:] = CAPPED
    assert reductions.separations(displacement, gap, state)[1] == np.inf


@pytest.mark.parametrize("cap", [0.6, np.inf])
def test_a_field_is_split_by_its_bounds(cap, fields):
    displacement, gap, _, _ = fields
    pressure = np.clip(displacement, 0, cap)
    cells, values, capped = bounds.split_by_bounds(pressure, cap)
    assert np.array_equal(cells, np.flatnonzero((pressure > 0) & (pressure < cap)))
    assert np.array_equal(values, pressure[cells])
    assert np.array_equal(capped, np.flatnonzero(pressure >= cap))
    out = np.empty(SIZE)
    reductions.run_blocks(SIZE, 0, bounds.descend, displacement, gap, 0.3, 0.7, out)
    assert np.array_equal(out, -(0.7 * (gap + displacement - 0.3)))


@pytest.mark.parametrize(("cap", "share"), [(0.3, 1e-9), (1e3, 0.1), (0.3, 0.9)])
def test_shifting_to_a_sum(cap, share, fields):
    raw, _, _, _ = fields
    wanted = share * (cap * raw.size if cap < 1 else 50.0)
    plain = _plain_shift(raw - raw.max(), max(raw.max(), 0.0), wanted, cap)
    values = bounds.shift_to_sum(raw, wanted, cap)
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
    state[found[::2]] = CAPPED
    *merged, mean = bounds.merge((cells, values), found, state, 2.0, (displacement, gap, 0.3))
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
    found, largest = reductions.find_violations(displacement, gap, state, pressure, 0.1)
    plain = np.zeros(SIZE)
    plain[pressure[0]], plain[pressure[2]] = ELASTIC, CAPPED
    assert np.array_equal(state, plain)
    value = 0.1 - gap - displacement
    wrong = ((state == OPEN) & (value > 0)) | ((state == CAPPED) & (value < 0))
    assert np.array_equal(found, np.flatnonzero(wrong))
    assert largest == pytest.approx(np.abs(value[wrong]).max(), rel=1e-14)


def test_cells_with_positive_values_are_kept(fields):
    _, way, cells, values = fields
    way = way[: cells.size]
    out = np.empty(cells.size)
    out[:] = values - 0.7 * (way + 0.2 * values)
    kept, raw, total = bounds.keep_positive(cells, out)
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
    found = reductions.assemble((pressure, moved, gap), (2.0, 0.25), 0.1, cap, (deformed, depth))
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
        largest, reach, *_ = reductions.assemble(fields, (1.0, 1.0), 0.0, np.inf, (np.empty(size), np.zeros(size)))
        assert not largest / reach <= 1e-8 if value != np.inf else reach == np.inf


def test_regions_keep_their_load_where_pressures_are_clipped():
    cap, side, shape = 0.7, 8, (21, 35)  # regions at the ends are cut off
    rng = np.random.default_rng(5)
    cells = np.sort(rng.choice(shape[0] * shape[1], 600, replace=False))
    raw = rng.uniform(-0.1, 0.8, cells.size)
    raw[cells // shape[1] < 4] -= 0.5  # more below zero there than half of what is left can make up for
    values = raw.copy()
    bounds.redistribute_clipped_load(cells, values, cap, shape, side)
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
def test_the_coarse_correction_is_the_plain_conjugate_gradients(periodic):
    n = 96
    op = operator((n, n), (1 / n, 1 / n), periodic)
    workspace = GridWorkspace(op, np.zeros(n * n), np.inf, SolverParameters())
    height = notes_surface(n, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 0.8))
    near = workspace.sparse_inverse().on(cells)
    far = workspace.coarse.on(cells, near.row_sums())
    values = np.random.default_rng(3).standard_normal(cells.size)
    before = op.count.applications
    result = values.copy()
    far.apply(result)
    applications = op.count.applications - before

    given = np.bincount(far.blocks, far.weights * values, far.root.size) * far.inverse_root
    solution, residual, direction = np.zeros(given.size), given.copy(), np.zeros(given.size)
    share, made = 0.0, 0
    while residual @ residual > coarse_correction._REDUCTION**2 * (given @ given):
        direction = residual + share * direction
        field = (far.root * direction).astype(np.float32).reshape(workspace.coarse.workspace.field.shape)
        workspace.coarse.convolution.apply(field, field)
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


def test_two_pressures_are_blended():
    rng = np.random.default_rng(8)
    size, cap, share = 300, 0.8, 0.3
    fields = [np.where(rng.random(size) < 0.5, np.minimum(rng.random(size), cap), 0.0) for _ in range(2)]
    sides = [(np.flatnonzero(field), field[field > 0]) for field in fields]
    cells, values = bounds.blend(*sides, share, cap)
    plain = (1 - share) * fields[0] + share * fields[1]
    plain[(fields[0] == cap) & (fields[1] == cap)] = cap
    assert (plain == cap).any()
    assert np.array_equal(cells, np.flatnonzero(plain))
    assert np.array_equal(values, plain[cells])
