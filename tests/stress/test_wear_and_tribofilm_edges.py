"""Wear with all cells yielding, none, one; tribofilms from 0 to 400 degrees Celsius; balances hold throughout."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import Body, Grid, Material, grow_tribofilm, run_in
from bem.benchmarks.surface_change_cases import tip
from bem.tribofilm import Constant
from bem.wear import WearModel, WearSetup, yielded_pieces
from bem.wear.segmentation import segment

GRID = Grid((20, 18), (1e-7, 1e-7), periodic=(False, True))
DEPTHS = np.arange(10) * 95e-9


def setup(yield_stress, friction=0.16):
    soft = Body(Material("soft", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=yield_stress))
    hard = Body(Material("hard", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9))
    return WearSetup(
        grid=GRID, bodies=(soft, hard), gap=np.zeros(GRID.shape), load=1e-4, friction=friction, depths=DEPTHS
    )


def pressed(value=1.8e9):
    pressure = np.zeros(GRID.shape)
    pressure[5:12, 4:11] = value
    return pressure


def test_none_yields():
    found = yielded_pieces(pressed(), setup(1e15), WearModel(), 0)
    assert found.pieces.count == 0
    assert found.depths_computed == 0
    assert not found.pieces.thickness.any()


def test_all_yield_as_one_piece_of_the_whole_depth():
    found = yielded_pieces(np.full(GRID.shape, 1.8e9), setup(1e3), WearModel(), 0)
    assert found.pieces.count == 1
    assert (found.pieces.labels == 1).all()
    assert np.allclose(found.pieces.thickness, DEPTHS[-1] + 0.0, rtol=0.1)
    assert found.pieces.reaches_bottom[1]


def test_one_cell_yields():
    stack = np.zeros((10, *GRID.shape))
    stack[0, 7, 8] = 2.0
    found = segment(stack, DEPTHS, yield_stress=1.0, periodic=GRID.periodic)
    assert found.count == 1
    assert np.count_nonzero(found.thickness) == 1
    assert 0 < found.thickness[7, 8] < DEPTHS[1]


@pytest.mark.parametrize("value", [0.0, 5e-324, 1e-300, 1e300])
def test_stresses_at_the_ends_of_the_range_of_numbers(value):
    found = segment(np.full((10, *GRID.shape), value), DEPTHS, yield_stress=1e9, periodic=GRID.periodic)
    assert found.count == (1 if value > 1e9 else 0)
    assert np.isfinite(found.thickness).all()


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 999),
    strength=st.floats(0.01, 4.0),
    periodic=st.tuples(st.booleans(), st.booleans()),
    connectivity=st.sampled_from([6, 18, 26]),
    removal=st.sampled_from(["cap", "top_run"]),
)
def test_pieces_of_noise_are_whole_and_never_deeper_than_the_stack(seed, strength, periodic, connectivity, removal):
    stack = np.abs(np.random.default_rng(seed).standard_normal((10, 11, 13)))
    found = segment(
        stack, DEPTHS, yield_stress=strength, periodic=periodic, connectivity=connectivity, removal=removal, refine=4
    )
    assert ((found.thickness > 0) == (found.labels > 0)).all()
    assert found.thickness.max() <= DEPTHS[-1] * (1 + 1e-12) + DEPTHS[1]
    assert set(np.unique(found.labels)) - {0} == set(range(1, found.count + 1))


@pytest.mark.parametrize("yield_stress", [1e5, 0.64e9, 1e12])
def test_a_loop_at_the_edges_keeps_its_balance(yield_stress):
    fixed = setup(yield_stress)
    rng = np.random.default_rng(3)
    lower, upper = 2e-8 * rng.standard_normal(GRID.shape), 1e-8 * rng.standard_normal(GRID.shape)
    result = run_in(
        lower, upper, grid=GRID, bodies=fixed.bodies, load=fixed.load, depths=DEPTHS, friction=0.16, cycles=4
    )
    lost = (lower - result.lower_heights).sum() * GRID.cell_area
    assert result.particles["volume"].sum() == pytest.approx(lost, rel=1e-10, abs=1e-40)
    assert np.isfinite(result.lower_heights).all()
    if yield_stress == 1e12:
        assert lost == 0


@pytest.mark.parametrize("celsius", [0, 25, 100, 200, 300, 400])
@pytest.mark.parametrize("wear", [0.0, 3e-3])
def test_tribofilm_from_freezing_to_four_hundred_degrees(celsius, wear):
    contact = replace(tip(16), hardness=Constant(2e9), temperature=273.15 + celsius)
    film = grow_tribofilm(np.linspace(0, 1000, 6), contact, wear_coefficient=wear)
    history = film.history
    assert np.isfinite(history.thickness).all()
    assert (history.thickness >= 0).all()
    assert np.allclose(history.grown - history.worn, history.thickness, rtol=1e-12, atol=1e-24)
    if wear == 0:
        assert (np.diff(history.thickness) >= 0).all()
