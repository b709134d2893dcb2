"""Fatigue of a body that passes: the line contact's closed path, convergence with cells and positions, Miner, wear."""

from dataclasses import replace

import numpy as np
import pytest

from bem import Body, Grid, Material
from bem.life.fatigue import RollingFatigue, pitted_share
from bem.life.fatigue_limit import FatigueLimit
from bem.life.march import advance, run_life
from bem.life.positions import Passing
from bem.life.surfaces import LifeCase
from bem.reference_solutions.mcewen import cylinder_stress
from bem.wear import DryContact

pytestmark = pytest.mark.internal

STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
RADIUS, PEAK = 5e-3, 2e9
MODULUS = 210e9 / (2 * (1 - 0.3**2))
HALF_WIDTH = 2 * RADIUS * PEAK / MODULUS
DEPTHS = HALF_WIDTH * np.array([0.2, 0.55, 1.0])


def smooth(cells, positions, rate=0.0, **changes):
    length = 8 * HALF_WIDTH
    grid = Grid((cells, 4), (length / cells, length / cells), periodic=(False, True))
    load = np.pi * RADIUS * PEAK**2 / MODULUS * grid.lengths[1]
    gap = np.broadcast_to((grid.x**2 / (2 * RADIUS))[:, None], grid.shape)
    contact = DryContact(grid, (STEEL, STEEL), gap, load=load)
    return LifeCase(grid, contact, Passing(positions, (True, False)), (rate, 0.0), 1e-6, **{"cycles": 1e4} | changes)


def first_state(case):
    flat = np.zeros(case.grid.shape)
    return run_life(replace(case, cycles=1e-9, first_step=1e-9), flat, flat)


def fatigue(limit=None):
    return RollingFatigue(0, STEEL, DEPTHS, limit or FatigueLimit())


def test_a_smooth_roller_does_what_the_closed_path_says_as_cells_and_positions_grow():
    place = np.linspace(-6, 6, 481) * HALF_WIDTH
    path = np.stack([cylinder_stress(place, z, half_width=HALF_WIDTH, maximum_pressure=PEAK, poissons_ratio=0.3)
                     for z in DEPTHS], axis=-1)  # fmt: skip
    exact = FatigueLimit().equivalent_shear(path)
    errors = []
    for cells, positions in ((32, 16), (64, 32), (128, 64)):
        case = smooth(cells, positions)
        found = fatigue().equivalent_shear(case, (cells, cells), first_state(case).contacts)
        middle = found[:, cells // 2, 0]
        errors.append(float(np.abs(middle / exact - 1).max()))
    # between positions the path's corners are cut
    assert errors[2] < 0.02
    assert errors[2] < errors[0]


def test_damage_adds_up_and_comes_up_with_the_material():
    case = smooth(32, 8, rate=2e-16, cycles=4000.0, first_step=4000.0, tolerance=0.5)
    model = fatigue(FatigueLimit(bending=700e6))
    first = model.initial_state(case, first_state(case))
    rate = first.damage_rates[0]
    still = replace(case, rates=(0.0, 0.0))
    steady = model.add_damage(still, first, advance(still, replace(first, step=4000.0, cycles=0.0)))
    # the same stresses all along: cycles times the damage of one; jumps leave nothing open. Contacts from other starts
    # differ by rounding, balls around paths by 1e-6, lives by ln(10) * 700/43 = 37 times that: 2.0e-5 seen, and 8e-8
    # where balls are found to 1e-8
    assert steady.damage[0] == pytest.approx(4000 * rate, rel=4e-5)
    assert steady.damage[1] == pytest.approx(steady.damage[0], rel=4e-5)
    assert steady.damage[2] == pytest.approx(4000 * first.damage_rates[1], rel=1e-6)
    so_far = np.ones_like(rate) * np.array([0.1, 0.4, 0.8])[:, None, None]
    deep = replace(first, damage=np.stack([so_far] * 3), damage_rates=np.stack([0 * rate] * 2))
    worn = advance(case, replace(deep, step=4000.0, cycles=0.0))
    lost = deep.surfaces.heights[0] - worn.surfaces.heights[0]
    after = model.add_damage(case, deep, worn)
    # what lay between the first two depths moved up by what wore
    own = after.damage[0] - 0.5 * 4000 * after.damage_rates[0]
    expected = 0.1 + 0.3 * lost / (DEPTHS[1] - DEPTHS[0])
    assert own[0] == pytest.approx(expected, rel=1e-9)
    assert lost.max() > 1e-10


def test_brackets_hold_the_path_and_what_lies_between_the_ends_of_a_jump():
    case = smooth(32, 8, rate=2e-16, cycles=4000.0, first_step=4000.0, tolerance=0.5)
    model = fatigue(FatigueLimit(bending=700e6))
    first = model.initial_state(case, first_state(case))
    # a path of fewer states needs no larger ball, and is as hot at rest; each of eight counts an eighth
    assert (first.damage_rates[1] <= first.damage_rates[0]).all()
    now = model.add_damage(case, first, advance(case, replace(first, step=4000.0, cycles=0.0)))
    assert (now.damage[2] <= now.damage[0]).all()
    assert (now.damage[0] <= now.damage[1]).all()
    assert (now.damage[0] < now.damage[1]).any()
    assert pitted_share(now, 2) <= pitted_share(now) <= pitted_share(now, 1)


def test_oil_on_a_contact_at_the_cap_presses_no_harder():
    case = smooth(32, 4)
    rows, solved = (32, 32), first_state(case)
    contacts = [replace(one, oil_pressure=0.2 * one.pressure[:, :1]) for one in solved.contacts]
    capped = replace(fatigue(), hardness=PEAK).equivalent_shear(case, rows, contacts)
    pressed = [replace(one, pressure=np.minimum(1.2 * one.pressure, PEAK)) for one in solved.contacts]
    # the smallest ball is found to a millionth
    assert capped == pytest.approx(fatigue().equivalent_shear(case, rows, pressed), rel=1e-5)
    assert capped.max() < fatigue().equivalent_shear(case, rows, contacts).max()


def test_pits_are_columns_without_life_left():
    case = smooth(32, 4)
    state = fatigue().initial_state(case, first_state(case))
    assert pitted_share(state) == 0
    gone = state.damage.copy()
    gone[0, 1, :8] = 1.0
    assert pitted_share(replace(state, damage=gone)) == 0.25
    assert pitted_share(replace(state, damage=gone), 1) == 0.0
