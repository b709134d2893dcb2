"""Jumps and the lowest load of adhesive paths, and the load of bodies that have parted."""

import functools
import itertools

import numpy as np
import pytest
from test_adhesion import DEPTH, FORCE, MODULUS, SIZE, WORK, maugis_state, range_of, sphere

from bem import Grid
from bem.accuracy import ContactCase
from bem.accuracy.adhesion import adhesive_bars
from bem.accuracy.bars import RESIDUAL
from bem.adhesion import DugdaleAdhesion, ExponentialAdhesion, follow_path, solve_adhesive_contact
from bem.adhesion.figures import load_between_steps
from bem.adhesion.zone import adhesive_zone, is_resolved

# Maugis' lambda of the attraction: with 1.65 the sphere jumps, with 0.8 it does not
JUMPS, SMOOTH = 1.65, 0.8


def path_of(parameter, *approaches, refined=False, cells=64):
    gap, operator = sphere(cells, 5.0)
    law = ExponentialAdhesion(WORK, range_of(parameter))
    return follow_path(gap, operator, law, approaches=[one * DEPTH for one in approaches], refined=refined)


def test_a_load_that_turns_within_a_step_is_no_jump():
    """From an approach of 0 to -0.85 the load falls by 0.2 pi w R to its least, rises again and ends as it began."""
    path = path_of(JUMPS, 1.0, 0.0, -0.85)
    assert path.load[1] == pytest.approx(path.load[2], abs=0.02 * FORCE)
    assert not path.jumped.any()
    assert lowest_of_fine_path() < path.load.min() - 0.15 * FORCE


@functools.cache
def lowest_of_fine_path():
    return path_of(JUMPS, 2.0, *np.linspace(-0.35, -0.65, 13)).lowest_load


@pytest.mark.parametrize("steps", [(1.0, -0.9, -1.6), (1.5, -1.4), (0.5, -6.0), (-1.6, 0.0), (-3.0, 2.0)])
def test_a_jump_is_found_in_steps_of_any_length(steps):
    """In long steps the load also turns, and changes more without the jump than by it."""
    assert path_of(JUMPS, *steps).jumped.tolist() == [False] * (len(steps) - 1) + [True]
    assert not path_of(SMOOTH, *steps).jumped.any()


@pytest.mark.parametrize("inner", [(0.2, -0.2, -0.85), (0.0, -2.0), (0.0, -0.9, -1.3)])
def test_the_lowest_load_lies_between_the_points_of_a_path(inner):
    """A fine path has its least at the same load; the way in has touched at a load below those of the way out."""
    path = (-3.0, -0.8, 2.0, *inner, -3.0)
    given, found, fine = path_of(JUMPS, *path), path_of(JUMPS, *path, refined=True), lowest_of_fine_path()
    # the cells make ripples of some 0.5 %
    assert found.lowest_load == pytest.approx(fine, abs=0.01 * FORCE)
    assert found.lowest_load - found.lowest_load_error < fine + 0.005 * FORCE
    assert found.lowest_load_error < 0.02 * FORCE
    assert given.lowest_load - given.lowest_load_error < fine
    assert given.lowest_load > fine + 0.05 * FORCE
    assert found.passes_pull_off
    assert given.passes_pull_off is (inner[0] > 0)
    assert found.lowest.load == found.lowest_load
    # all given states are on the refined path, in their order
    assert [one for one in found.approach if np.isclose(one, given.approach, rtol=1e-12, atol=0).any()] == list(
        given.approach
    )
    assert found.jumped.sum() == given.jumped.sum() == 2


def test_chords_beside_a_step_bound_a_convex_load_from_below():
    approach = np.array([4.0, 3.0, 1.5, 0.5, -1.0, -2.0])
    load = (approach - 0.8) ** 2 - 5
    bound = load_between_steps(load, approach)
    inside = [np.linspace(*ends, 101) for ends in itertools.pairwise(approach)]
    assert np.all(bound <= [np.min((one - 0.8) ** 2 - 5) + 1e-12 for one in inside])
    # the lowest bound is of second order in the step
    near = [
        -5 - load_between_steps((one - 0.8) ** 2 - 5, one).min() for one in (np.linspace(4, -2, n) for n in (31, 61))
    ]
    assert 0 < near[1] < 0.4 * near[0] < 0.05
    # a parted end: the chord of the load that has jumped says nothing, the one before the jump does
    load[4:] = 0.0
    bound = load_between_steps(load, approach)
    assert bound[3] == pytest.approx(load[3] + (load[3] - load[2]) * 1.5)
    assert bound[4] == 0
    # a way in is gone back later
    there_and_back = load_between_steps(np.r_[load[::-1], load[1:]], np.r_[approach[::-1], approach[1:]])
    assert there_and_back[1] == min(load[3:5])
    assert load_between_steps(np.array([1.0]), np.array([0.0])).size == 0


def test_bodies_apart_carry_the_attraction_that_is_left_and_no_noise_of_the_solver():
    """At 4 to 12 ranges the load is that of the way in; at 40 ranges, and beyond Dugdale's, it is zero."""
    reach = range_of(JUMPS) / DEPTH
    apart = [-4.0 * reach, -8.0 * reach, -12.0 * reach]
    path = path_of(JUMPS, *apart[::-1], 1.0, *apart, -40 * reach)
    assert path.load[4:7] == pytest.approx(path.load[2::-1], rel=1e-5, abs=0)
    # Bradley: rigid spheres, from 8 ranges on
    assert path.load[5:7] == pytest.approx(-2 * FORCE * np.exp([-8.0, -12.0]), rel=2e-3, abs=0)
    assert path.load[7] == 0
    gap, operator = sphere(64, 5.0)
    law = DugdaleAdhesion(WORK, range_of(JUMPS))
    held = follow_path(gap, operator, law, approaches=[1.0 * DEPTH, -3.0 * DEPTH])
    assert held.load[0] != 0
    assert held.load[1] == 0
    far = solve_adhesive_contact(gap, operator, law, approach=-3.0 * DEPTH)
    assert far.load == 0
    assert not far.attraction.any()


def test_two_cells_in_the_adhesive_zone_give_the_pull_off_force_and_one_does_not():
    """Maugis' sphere at lambda 1.07: the rule of plans, checks and notes on the zone, by the error that it leaves."""
    law = DugdaleAdhesion(WORK, range_of(1.07))
    exact = min(maugis_state(1.07, ratio)[1] for ratio in np.geomspace(1.05, 4, 400))
    zone = adhesive_zone(law, MODULUS) / SIZE
    errors = {}
    for across in (1, 2, 4):
        cells = 2 * round(4.6 / zone * across / 2)
        gap, operator = sphere(cells, cells * zone / across)
        out = [0.5, 0.0, -0.5, -1.0, -3.0]
        path = follow_path(gap, operator, law, approaches=[one * DEPTH for one in out], refined=True)
        errors[across] = abs(path.lowest_load / FORCE / exact - 1)
        assert is_resolved(law, MODULUS, Grid((cells, cells), (zone * SIZE / across * (1 - 1e-9),) * 2)) is (across > 1)
    assert errors[1] > 0.2
    assert errors[2] < 0.06
    assert errors[4] < 0.02


def test_the_error_bar_of_the_lowest_load_has_what_the_steps_leave():
    """A path of approaches that is not refined errs by its steps; one of loads does not."""
    gap, operator = sphere(64, 5.0)
    law, asked = ExponentialAdhesion(WORK, range_of(SMOOTH)), {"approaches": [0.5 * DEPTH, -0.2 * DEPTH, -0.9 * DEPTH]}
    path = follow_path(gap, operator, law, approaches=asked["approaches"])
    case = ContactCase(operator, gap, path.last.contact, approach=asked["approaches"][-1])
    bars = adhesive_bars(case, law, path, asked)
    assert path.lowest_load_error > 0.05 * FORCE
    assert bars.parts[RESIDUAL]["lowest_load"] >= path.lowest_load_error
    finer = follow_path(gap, operator, law, approaches=asked["approaches"], refined=True)
    assert finer.lowest_load < path.lowest_load - 0.05 * FORCE
    assert path.lowest_load - finer.lowest_load < bars.values["lowest_load"]
    loads = {"loads": [FORCE, -0.5 * FORCE]}
    path = follow_path(gap, operator, law, loads=loads["loads"])
    case = ContactCase(operator, gap, path.last.contact, load=loads["loads"][-1])
    assert adhesive_bars(case, law, path, loads).parts[RESIDUAL]["lowest_load"] < 1e-3 * FORCE
