"""Stress where pieces can reach: whole planes wherever it matters; no row, depth or transform more than is needed."""

import itertools

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, transforms
from bem.stress import clear_other_rows, connected_stress, set_stress_memory, von_mises_field
from bem.threads import set_threads
from bem.wear import WearModel, WearSetup, yielded_pieces
from bem.wear.criterion import VonMises
from bem.wear.removal import Cap
from bem.wear.yielding import piece_stress, pieces_above, yielded_stress

STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9))
CELL = 100e-9
DEPTHS = np.arange(20) * 95e-9


def rough_pressure(shape, seed):
    """Spots of some cells, far from each other and near: what they load goes together below the surface, or not."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(*(np.arange(n) for n in shape), indexing="ij")
    pressure = np.zeros(shape)
    for _ in range(9):
        i, j, radius = random.integers(shape[0]), random.integers(shape[1]), random.uniform(1.5, 6)
        pressure += 1.6e9 * np.sqrt(np.maximum(1 - ((x - i) ** 2 + (y - j) ** 2) / radius**2, 0))
    return np.minimum(pressure, 1.8e9)


def zeroed(found):
    """The planes with zeros in rows that were left out."""
    return clear_other_rows(found.planes, found.computed)


def setup(shape, periodic):
    grid = Grid(shape, (CELL, CELL), periodic=periodic)
    return WearSetup(grid, (STEEL, STEEL), np.zeros(shape), 1.0, 0.16, DEPTHS)


@pytest.mark.parametrize("periodic", [(False, True), (False, False), (True, True)])
@pytest.mark.parametrize("shape", [(64, 48), (61, 40), (5, 40)])
def test_rows_that_are_computed_are_those_of_whole_planes_and_what_exceeds_the_limit_ends_in_them(periodic, shape):
    grid = Grid(shape, (CELL, CELL), periodic=periodic)
    pressure = rough_pressure(shape, 3)
    whole = von_mises_field(pressure, grid, STEEL, DEPTHS, friction=0.3)
    limit = 0.45 * whole.max()
    found = connected_stress(pressure, grid, STEEL, DEPTHS, limit, friction=0.3, depths_beside=2)
    used = len(found.planes)
    # round-off of transforms in other portions
    error = np.abs(zeroed(found) - whole[:used])[found.computed].max()
    assert error <= 1e-13 * whole.max()
    assert not zeroed(found)[~found.computed].any()
    assert found.computed[0].all()
    above = (zeroed(found) > limit).any(axis=2)
    assert above.any()
    assert np.array_equal(found.exceeding, (zeroed(found) > limit).any(axis=0))
    for depth, row in np.argwhere(above):
        for other, beside in itertools.product(range(depth - 2, depth + 3), range(row - 1, row + 2)):
            if 0 <= other < DEPTHS.size and (periodic[0] or 0 <= beside < shape[0]):
                assert found.computed[other, beside % shape[0]]


@pytest.mark.internal
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("choice", [{}, {"refinement": "linear"}, {"connectivity": 26, "removal": "top_run"}])
def test_pieces_are_those_of_whole_planes(seed, choice):
    fixed, model = setup((96, 48), (seed % 2 == 0, True)), WearModel(**choice)
    pressure = rough_pressure(fixed.grid.shape, seed)
    found = yielded_pieces(pressure, fixed, model, 0)
    everything = yielded_stress(pressure, fixed, model, 0)
    whole = pieces_above(everything.stress, everything.depths, fixed.yield_stress(0), fixed, model)
    assert whole.count > 0
    assert np.array_equal(found.pieces.labels, whole.labels)
    assert np.abs(found.pieces.thickness - whole.thickness).max() <= 1e-12 * DEPTHS[-1]


def test_what_lies_deeper_and_wider_than_the_surface_shows_is_found_by_a_second_pass():
    """A piece that begins in few rows and spreads below them, under a limit that only a spot's middle exceeds."""
    grid = Grid((96, 32), (CELL, CELL), periodic=(False, True))
    x, y = np.meshgrid(np.arange(96) - 47.5, np.arange(32) - 15.5, indexing="ij")
    pressure = 1e9 * np.sqrt(np.maximum(1 - (x**2 + y**2) / 14**2, 0))
    pressure[46:50, 14:18] += 1e9
    depths = np.arange(14) * 90e-9
    whole = von_mises_field(pressure, grid, STEEL, depths)
    limit = 0.55e9
    above = (whole > limit).any(axis=2).sum(axis=1)
    assert above.argmax() > 3  # wider below than at the surface
    found = connected_stress(pressure, grid, STEEL, depths, limit, depths_beside=2)
    used = len(found.planes)
    assert found.passes >= used
    both = whole[:used] > limit
    rows = both.any(axis=2)
    connected = found.computed & rows
    assert connected.sum() == rows.sum()  # one region, all of it joined to the surface


@pytest.mark.internal
def test_half_of_the_rows_are_left_out_and_each_depth_takes_five_transforms_along_x():
    fixed = setup((96, 48), (False, True))
    pressure = np.zeros(fixed.grid.shape)
    pressure[40:48, 20:28] = 1.8e9
    transforms.COUNT.reset()
    found = yielded_pieces(pressure, fixed, WearModel(), 0)
    assert found.pieces.count == 1
    assert found.depths_computed > 3
    assert transforms.COUNT.inverse == 5 * found.depths_computed
    all_rows = 96 * (1 + 5 * found.depths_computed)
    assert transforms.COUNT.rows < 0.5 * all_rows
    first = piece_stress(pressure, fixed, WearModel(), 0).stress
    assert np.count_nonzero(first[1].any(axis=1)) <= 32  # eight rows loaded, groups of eight on either side


@pytest.mark.internal
def test_a_pressure_that_is_no_number_is_refused_as_whole_planes_of_it_are():
    """What is noted to yield is not searched again: it must have what compares with nothing among it."""
    fixed = setup((96, 48), (False, True))
    pressure = np.zeros(fixed.grid.shape)
    pressure[40:48, 20:28] = 1.8e9
    pressure[44, 24] = np.nan
    with np.errstate(invalid="ignore"), pytest.raises(InputError, match="finite"):
        yielded_pieces(pressure, fixed, WearModel(), 0)
    strength = fixed.yield_stress(0)
    stack = np.full((3, 4, 4), 2 * strength)
    stack[1, 2, 2] = np.nan
    columns = np.ones((4, 4), np.bool_)
    with pytest.raises(InputError, match="not finite"):
        pieces_above(stack, np.arange(3) * 1e-7, strength, fixed, WearModel(), columns)


@pytest.mark.internal
def test_several_threads_give_the_same():
    grid = Grid((256, 256), (CELL, CELL))
    pressure = np.zeros(grid.shape)
    pressure[100:140, 100:140] = rough_pressure((40, 40), 1)
    depths = DEPTHS[:3]
    set_stress_memory(1 << 29)
    whole = von_mises_field(pressure, grid, STEEL, depths, friction=0.2)
    limit = 0.5 * whole.max()
    one = connected_stress(pressure, grid, STEEL, depths, limit, friction=0.2)
    set_threads(2)
    try:
        two = connected_stress(pressure, grid, STEEL, depths, limit, friction=0.2)
    finally:
        set_threads(1)
    assert np.array_equal(zeroed(one), zeroed(two))
    assert np.abs(zeroed(one) - whole[: len(one.planes)])[one.computed].max() <= 1e-13 * whole.max()


@pytest.mark.internal
def test_a_law_that_looks_at_all_runs_gets_all_of_them():
    class Everything(Cap):  # does not say that it follows pieces, though Cap does
        def remove(self, *given):
            return super().remove(*given)

    fixed = setup((64, 48), (False, True))
    pressure = rough_pressure(fixed.grid.shape, 0)
    model = WearModel()
    object.__setattr__(model, "removal", Everything())
    whole, asked = yielded_stress(pressure, fixed, model, 0), piece_stress(pressure, fixed, model, 0)
    assert np.array_equal(whole.stress, asked.stress)


@pytest.mark.internal
def test_a_criterion_derived_from_von_mises_with_a_stress_of_its_own_is_asked_for_it():
    class Twice(VonMises):
        def equivalent_stress(self, stress):
            return 2 * super().equivalent_stress(stress)

    fixed, pressure, model = setup((64, 48), (False, True)), rough_pressure((64, 48), 0), WearModel()
    once = yielded_stress(pressure, fixed, model, 0).stress
    object.__setattr__(model, "criterion", Twice())
    twice = piece_stress(pressure, fixed, model, 0).stress
    # the same transforms in other portions
    assert twice[: len(once)] == pytest.approx(2 * once, rel=1e-10, abs=1e-10 * once.max())


@pytest.mark.internal
def test_rows_that_were_left_out_are_never_looked_at():
    """They are not even written: pieces are found from the others."""
    fixed, model = setup((96, 48), (False, True)), WearModel()
    pressure = np.zeros(fixed.grid.shape)
    pressure[40:48, 20:28] = 1.8e9
    wanted = yielded_pieces(pressure, fixed, model, 0).pieces
    found = piece_stress(pressure, fixed, model, 0)
    assert not found.rows.all()
    found.planes[~found.rows] = np.nan
    strength = fixed.yield_stress(0)
    pieces = pieces_above(found.planes, found.depths, strength, fixed, model, found.yielding, found.rows)
    assert np.array_equal(pieces.labels, wanted.labels)
    assert np.array_equal(pieces.thickness, wanted.thickness)
    assert not found.stress[~found.rows].any()  # zeros where they are asked for
