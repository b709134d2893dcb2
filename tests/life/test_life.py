"""A life of many cycles: volume, closed forms, cycle by cycle, order in the tolerance, the film's balance, resuming."""

import math
from dataclasses import replace

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, generate_surface
from bem.accuracy.life import POSITIONS, OtherLives, errors_of_jumps, fewer_positions, life_bars, two_rounds
from bem.life.fatigue import RollingFatigue
from bem.life.fatigue_limit import FatigueLimit
from bem.life.march import LifeState, advance, run_life
from bem.life.monitors import Monitors, PieceSizes
from bem.life.positions import Passing
from bem.life.surfaces import GrowingTribofilm, LifeCase, solve_round
from bem.packing import packed, unpacked
from bem.tribofilm import StressActivatedGrowth
from bem.tribofilm.balance import FilmBalance
from bem.wear import DryContact
from bem.wear.criterion import Junction, LowCycleFatigue

pytestmark = pytest.mark.internal

STEEL = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
DISTANCE, PRESSURE = 1e-2, 1e8
GRID = Grid((32, 16), (1e-6, 1e-6), periodic=(True, True))


def surfaces(seed=1):
    return tuple(generate_surface(GRID, rms_height=rms, seed=seed + k, correlation_length=4e-6)
                 for k, rms in enumerate((300e-9, 100e-9)))  # fmt: skip


def case(cycles, tolerance=0.05, positions=4, **changes):
    contact = DryContact(
        GRID, (STEEL, STEEL), np.zeros(GRID.shape), load=PRESSURE * GRID.area, friction=0.1, hardness=6e9
    )
    given = {"rates": (2e-17, 1e-17), "distance": DISTANCE, "first_step": 4.0} | changes
    return LifeCase(GRID, contact, Passing(positions, (True, True)), cycles=cycles, tolerance=tolerance, **given)


def test_positions_cover_both_bodies_evenly_in_pairs_of_their_own():
    for count in (1, 2, 5, 8, 12):
        pairs = Passing(count, (True, True)).offsets((24, 48))
        assert len(set(pairs)) == count
        lower, upper = (sorted(set(each)) for each in zip(*pairs, strict=True))
        assert lower == [round(24 * j / count) for j in range(count)]
        assert upper == [round(48 * j / count) for j in range(count)]
        # what meets is decided by the difference: even counts have no permutation with all of them (their sum is odd)
        apart = {(low - up) % count for low, up in Passing(count, (True, True)).offsets((count, count))}
        assert len(apart) >= count - (count % 2 == 0)
    assert {low for low, _ in Passing(4, (False, True)).offsets((8, 8))} == {0}


def test_volume_is_that_of_archard_s_law_and_that_of_the_heights():
    lower, upper = surfaces()
    end = run_life(case(300.0), lower, upper)
    assert end.cycles == 300.0
    for body, (rate, before) in enumerate(zip((2e-17, 1e-17), (lower, upper), strict=True)):
        # load, distance and cycles are exact; the contact meets its load to 1e-9
        assert end.surfaces.volume[body] == pytest.approx(rate * PRESSURE * GRID.area * DISTANCE * 300, rel=1e-8, abs=0)
        lost = (before - end.surfaces.heights[body]).sum() * GRID.cell_area
        assert lost == pytest.approx(end.surfaces.volume[body], rel=1e-9, abs=0)
    assert end.over("lower_rms")[-1] < end.over("lower_rms")[0]


def test_jumps_find_what_cycle_by_cycle_finds_and_know_their_error():
    lower, upper = surfaces()
    cycles, each = 512.0, case(512.0)
    truth = run_life(replace(each, cycles=1e-9, first_step=1e-9), lower, upper).surfaces
    for _ in range(128):  # four real cycles, one in each position
        truth = solve_round(each, truth, cycles / 128).surfaces
    worn = np.sqrt(np.mean((lower - truth.heights[0]) ** 2))
    errors, rounds = [], []
    for tolerance in (0.3, 0.1, 0.03):
        end = run_life(replace(each, tolerance=tolerance, first_step=64.0), lower, upper)
        errors.append(np.sqrt(np.mean((end.surfaces.heights[0] - truth.heights[0]) ** 2)) / worn)
        rounds.append(3 * (len(end.table) - 1) + 2 * end.rejected)
        assert errors[-1] < tolerance
    assert rounds[0] < 40  # instead of 128
    # of first order, steps in powers of two: a tenth of the tolerance leaves between a fifth and a tenth of the error;
    # what one step misses is what the next makes good, so that all is ten times better than the tolerance of a step
    assert errors[2] < 0.4 * errors[0]
    assert errors[1] < errors[0] < 0.03


def test_bars_hold_what_much_shorter_jumps_change():
    lower, upper = surfaces(7)
    columns = {"rms": "lower_rms", "area": "area_share"}
    coarse = run_life(case(300.0, tolerance=0.3), lower, upper)
    fine = run_life(case(300.0, tolerance=0.05), lower, upper)
    bars = errors_of_jumps(coarse, {**columns, "depth": "lower_depth", "other": "upper_depth"})
    # half of the upper body's wear rate is half of its error
    assert bars["depth"] == pytest.approx(2 * bars["other"], rel=1e-6, abs=0)
    assert bars["depth"] + bars["other"] == pytest.approx(coarse.over("depth_error")[-1], rel=1e-12, abs=0)
    # under load control the depth is exact, and nothing else is left to scale a bar by: the surface's own error
    missed = abs(coarse.over("lower_rms")[-1] - fine.over("lower_rms")[-1])
    assert missed < 0.05 * (fine.over("lower_rms")[0] - fine.over("lower_rms")[-1])


def test_bars_add_up_what_jumps_positions_cells_and_films_leave_open():
    lower, upper = surfaces(7)
    one = case(300.0, tolerance=0.3)
    end = run_life(one, lower, upper)
    rounds = two_rounds(one, end)
    same = life_bars(end, OtherLives(one.passing, end, end, rounds, rounds))
    # nothing differs: what jumps leave open, and what the positions scatter
    assert same.values["wear_volume"] == pytest.approx(end.over("depth_error")[-1] * GRID.area, rel=1e-9, abs=0)
    share = [found.area_share for found in end.contacts]
    scatter = 0.75 * np.std(share, ddof=1) / 2
    assert same.parts[POSITIONS]["contact_area_fraction"] == pytest.approx(scatter, rel=1e-12)
    assert not any(same.parts["grid"].values())
    assert not any(same.parts["film points"].values())
    other = run_life(case(300.0, tolerance=0.3, positions=2), lower, upper)
    halved = tuple({**each, "contact_share": 0.9 * each["contact_share"]} for each in rounds)
    apart = life_bars(end, OtherLives(one.passing, end, other, rounds, halved)).parts
    missed = abs(end.over("area_share")[-1] - other.over("area_share")[-1])
    assert apart[POSITIONS]["contact_area_fraction"] == pytest.approx(max(0.75 * missed, scatter), rel=1e-12)
    # heights need no other positions
    assert apart[POSITIONS]["Sq_final"] == same.parts[POSITIONS]["Sq_final"] > 0
    assert apart["film points"]["contact_share_final"] == pytest.approx(0.1 * rounds[1]["contact_share"], rel=1e-9)
    finer = life_bars(end, OtherLives(one.passing, end, other, rounds, halved, ratio=2.0)).parts["film points"]
    for name, error in apart["film points"].items():  # second order: half of the points would differ four times as much
        assert finer[name] == pytest.approx(4 * error, rel=1e-9, abs=0), name
    # a tenth less of the load in contact is a tenth less of what wears
    assert apart["film points"]["worn_depth"] == pytest.approx(0.1 * end.over("lower_depth")[-1], rel=1e-9, abs=0)
    assert fewer_positions(8) == 4
    assert fewer_positions(1) == 2
    assert set(life_bars(end, None).values.values()) == {None}


def film(**changes):
    given = {
        "growth": StressActivatedGrowth.from_electron_volts(1e-2, 0.665, 53.0),
        "balance": FilmBalance(wear_coefficient=2.0, concentration_constant=1e8),
        "friction": 0.1,
        "temperature": lambda pressure: 360.0,
        "cycle_time": 1e-3,
    }
    return GrowingTribofilm(**given | changes)


def test_a_film_alone_meets_its_closed_form_and_hides_the_substrate():
    flat = np.zeros(GRID.shape)
    law = film()
    end = run_life(case(5000.0, rates=(0.0, 0.0), tribofilm=law, positions=2), flat, flat)
    growth = float(law.growth.rate(np.array(0.1 * PRESSURE), 360.0))
    steady = growth / 2.0
    # pressure is uniform: h = g/alpha (1 - exp(-alpha t)), integrated exactly by every step
    assert end.surfaces.tribofilm == pytest.approx(np.full(GRID.shape, steady * -np.expm1(-2.0 * 5.0)), rel=1e-6, abs=0)
    worn = case(
        5000.0,
        tribofilm=film(balance=FilmBalance(0.0, 0.0, 1e9, 50e-9)),
        positions=2,
        rates=(1e-18, 0.0),
        distance=1e-6,
    )
    hidden = run_life(worn, flat, flat)
    assert hidden.surfaces.volume[0] < 1e-6 * 1e-18 * PRESSURE * GRID.area * 1e-6 * 5000
    # what wore instead is film, as much as the law says, but for what grew
    left = float(hidden.surfaces.tribofilm.mean())
    grown = growth * 5.0
    assert left == pytest.approx(50e-9 + grown - 1e-18 * PRESSURE * 1e-6 * 5000, rel=1e-9)


def test_a_film_without_c1_protects_as_one_of_the_largest_c1():
    """It protected nothing, and its friction did not count."""
    flat = np.zeros(GRID.shape)

    def end(constant):
        balance = FilmBalance(0.0, 0.0, constant, 50e-9)
        law = film(balance=balance, friction_on_film=0.05)
        return run_life(case(5000.0, tribofilm=law, positions=2, rates=(1e-18, 0.0), distance=1e-6), flat, flat)

    largest, none = end(1e12), end(math.inf)
    assert none.surfaces.volume[0] == largest.surfaces.volume[0] == 0
    assert none.surfaces.tribofilm == pytest.approx(largest.surfaces.tribofilm, rel=1e-12, abs=0)
    assert none.over("friction")[-1] == pytest.approx(0.05, rel=1e-12)


def test_a_thin_film_without_c1_wears_through_to_the_substrate():
    """Wear by pressure and distance takes the film first, and the substrate once there is none."""
    flat, deep = np.zeros(GRID.shape), 1e-17 * PRESSURE * 1e-3  # in a cycle
    law = film(balance=FilmBalance(0.0, 0.0, math.inf, 10 * deep), cycle_time=1e-30)
    end = run_life(case(100.0, tribofilm=law, positions=2, rates=(1e-17, 0.0), distance=1e-3), flat, flat)
    assert float(end.surfaces.tribofilm.max()) == pytest.approx(0.0, abs=1e-6 * deep)
    assert end.surfaces.volume[0] == pytest.approx(90 * deep * GRID.area, rel=1e-6, abs=0)


def test_a_place_of_a_longer_body_slides_less_in_a_cycle():
    """`distance` is that of the contact: the wear of a cycle is k F s, spread over all rows that pass."""
    flat, longer = np.zeros(GRID.shape), np.zeros((64, 16))
    end = run_life(case(100.0, rates=(1e-18, 1e-18), positions=8), longer, flat)
    depth = 1e-18 * PRESSURE * DISTANCE * 100
    assert -end.surfaces.heights[1] == pytest.approx(np.full(GRID.shape, depth), rel=1e-3, abs=0)
    assert -end.surfaces.heights[0] == pytest.approx(np.full(longer.shape, depth / 2), rel=1e-3, abs=0)


STRONG = Material("strong", youngs_modulus=210e9, poissons_ratio=0.3, yield_stress=1e9, hardness=2.8e9)


def pieces(criterion):
    return PieceSizes.of(
        GRID, (Body(STRONG), Body(STRONG)), criterion, 1e-7 * np.arange(4), 2.8e9, PRESSURE * GRID.area
    )


def hard_contacts(distance):
    """The contacts of a round at the hardness, before any wear."""
    contact = DryContact(
        *(GRID, (Body(STRONG), Body(STRONG)), np.zeros(GRID.shape)),
        load=PRESSURE * GRID.area,
        friction=-0.1,
        hardness=2.8e9,
    )
    one = replace(case(1e-9, distance=distance, first_step=1e-9), contact=contact)
    return run_life(one, *surfaces()).contacts


def test_a_life_finds_pieces_of_junctions_that_a_pass_drags_over_their_size():
    """A pass had no distance, so that no junction was ever dragged and no criterion of junctions found a piece."""
    criterion = Junction(surface_energy=1e-3)
    assert pieces(criterion).volumes(hard_contacts(1e-4), 1e-4).size > 0
    assert pieces(criterion).volumes(hard_contacts(1e-9), 1e-9).size == 0


@pytest.mark.parametrize(("left_out", "notes"), [(1.0, ["pieces-in-some-steps"]), (0.01, [])])
def test_a_life_says_how_much_wore_where_no_piece_was_found(left_out, notes):
    """The number of particles left that volume out without a word."""
    rows = np.array([[1.0, 5.0, 3.0], [2.0, math.nan, left_out]])
    found = Monitors(case(2.0), pieces("von_mises"), None, pieces=rows).notes()
    assert [note.code for note in found] == notes
    assert all(note.values["share"] == 0.25 for note in found)


def test_a_life_refuses_pieces_that_only_many_passes_bring_off():
    with pytest.raises(InputError, match="finds pieces after many passes"):
        pieces(LowCycleFatigue())


def test_stresses_of_pieces_and_fatigue_take_the_traction_of_their_pass():
    """They took one coefficient that was known before any contact."""
    (one, *_) = contacts = hard_contacts(1e-6)
    assert one.traction_ratio == -0.1
    assert one.boundary_friction == 0.1
    seen = pieces("von_mises")
    free = [replace(each, traction_ratio=0.0) for each in contacts]
    assert seen.volumes(contacts, 1e-6).sum() > seen.volumes(free, 1e-6).sum()
    model = RollingFatigue(0, STEEL, 1e-7 * np.arange(1, 4), FatigueLimit())
    rubbed, smooth = (model.equivalent_shear(case(1.0), (32, 32), each) for each in (contacts, free))
    assert rubbed.max() > 1.01 * smooth.max()


def test_friction_on_a_film_is_that_of_its_stresses():
    flat = np.zeros(GRID.shape)
    law = film(friction_on_film=0.05, balance=FilmBalance(0.0, 0.0, math.inf, 50e-9))
    (one, *_) = run_life(case(1.0, rates=(0.0, 0.0), tribofilm=law), flat, flat).contacts
    assert one.traction_ratio == pytest.approx(0.05, rel=1e-12)


def test_friction_goes_over_to_that_of_the_film():
    flat = np.zeros(GRID.shape)
    law = film(friction_on_film=0.05, cycle_time=0.1, balance=FilmBalance(0.0, 0.0, 1e9, 0.0))
    end = run_life(case(5e4, rates=(0.0, 0.0), tribofilm=law, positions=2, first_step=1e4), flat, flat)
    assert end.over("friction")[0] == pytest.approx(0.1, rel=1e-12)
    assert end.over("friction")[-1] == pytest.approx(0.05, rel=1e-3)


def test_it_goes_on_from_a_checkpoint_to_the_same_bits():
    lower, upper = surfaces()
    one = case(100.0, tribofilm=film())
    whole = run_life(one, lower, upper)
    kept: list[LifeState] = []
    run_life(one, lower, upper, callback=lambda now: kept.append(unpacked(packed(now))))
    again = run_life(one, lower, upper, state=kept[2])
    assert np.array_equal(again.table, whole.table)
    assert np.array_equal(again.surfaces.heights[0], whole.surfaces.heights[0])
    assert np.array_equal(again.surfaces.tribofilm, whole.surfaces.tribofilm)


def test_a_step_that_misses_is_made_shorter_and_used():
    lower, upper = surfaces()
    bold = case(1e5, tolerance=0.05, first_step=4096.0)
    started = replace(run_life(replace(bold, cycles=1e-9, first_step=1e-9), lower, upper), step=4096.0)
    state = advance(bold, started)
    assert state.rejected > 0
    assert state.over("step")[-1] < 4096.0
    assert state.over("step_error")[-1] <= 0.05


def test_steps_that_wear_less_than_the_heights_solve_roundf_grow_until_they_wear():
    """Cycles of 1e-12 wear 1e-24 m of heights known to 1e-22 m: it took 644 shorter steps, or ended the life."""
    end = run_life(case(1e-11, first_step=1e-12), *surfaces())
    assert end.rejected == 0
    assert len(end.table) == 5  # 1 + 2 + 4 + 3 of the first step


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"cycles": 0.0}, "cycles 0.0 must be positive"),
        ({"tolerance": 1.0}, "tolerance 1.0 must lie between 0 and 1"),
        ({"distance": -1.0}, "distance -1.0 must be >= 0"),
        ({"rates": (float("nan"), 0.0)}, "lower wear rate nan"),
    ],
)
def test_what_makes_no_life_is_refused(changes, message):
    with pytest.raises(InputError, match=message):
        replace(case(10.0), **changes)


def test_a_film_with_a_lag_is_refused():
    with pytest.raises(InputError, match="no lag"):
        film(balance=FilmBalance(1.0, 2.0, np.inf, 0.0))
