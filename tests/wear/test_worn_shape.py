"""Worn shape in the film of a wear loop: balance, volume, effort, checkpoint, shapes without a film."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from bem import CATALOGUE, Body, Grid, InputError, Lubricant, Status, generate_surface
from bem.friction.balance import Regime
from bem.friction.contact_heat import ContactHeat
from bem.friction.load_sharing import SharedLoad
from bem.friction.models import rough_contact
from bem.friction.setup import MixedSetup
from bem.friction.worn_film import ShapeSolver, extended
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.shaped import ShapedContact
from bem.lubrication.line.steady import line_film
from bem.notes import Level, has_code
from bem.notes.contact import CONTACT_AT_EDGE
from bem.notes.heat import SURFACE_HOT
from bem.notes.wear import FILM_OF_OTHER_SHAPE
from bem.wear import WearModel, pack_state, run_in, unpack_state
from bem.wear.mixed import MixedContact, MixedCycles, shared_film_table
from bem.wear.worn_shape import smoothed

GRID = Grid((64, 32), (0.7e-6, 0.7e-6), periodic=(False, True))
BODIES = (Body(CATALOGUE["steel-disk-110HV"].material), Body(CATALOGUE["steel-cylinder"].material))
OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
CASE = {
    "grid": GRID,
    "bodies": BODIES,
    "radius": 2e-3,
    "width": 6e-3,
    "load": 5.5,
    "lubricant": OIL,
    "boundary_friction": 0.15,
    "hardness": 1.08e9,
    "film_points": 300,
    "tolerance": 5e-4,
    "contact_tolerance": 1e-4,
}
SPEED = 0.05
CYCLES = 30
LOWER = generate_surface(GRID, rms_height=120e-9, correlation_length=1e-6, seed=4)
UPPER = generate_surface(GRID, rms_height=55e-9, correlation_length=2e-6, seed=5)


def contact_of(speed=SPEED, film_shape="worn", **changes):
    return MixedContact(MixedSetup(**CASE | changes), (speed, 0.0), film_shape=film_shape)


def loop(step, cycles=CYCLES, frame="disk", **more):
    """Load sharing over the cycles of a wear loop, and the loop."""
    setup = step.setup
    result = run_in(
        LOWER,
        UPPER,
        grid=GRID,
        bodies=BODIES,
        load=setup.load / setup.slices,
        depths=90e-9 * np.arange(24),
        friction=0.15,
        hardness=1.08e9,
        cycles=cycles,
        model=WearModel(criterion={"kind": "von_mises", "skin_depth": 90e-9}, frame=frame),
        contact_step=step,
        **more,
    )
    return MixedCycles(step, result.state.sharing, result.state.contact), result


@cache
def worn_loop(counted="loaded"):
    return loop(contact_of(oil_volume=counted))


@pytest.mark.parametrize("counted", ["loaded", "patch"])
def test_film_and_contact_of_the_last_cycle_carry_the_load(counted):
    """Both parts solved apart: the film under its load on its own mesh, the oil between the surfaces."""
    shared, _ = worn_loop(counted)
    setup, worn, balance = shared.contact.setup, shared.worn, shared.last.balance
    assert worn.shape is not None
    assert balance.status is Status.CONVERGED
    film, contact = balance.film, balance.contact
    assert film.load + contact.load == pytest.approx(setup.load, rel=5e-4)
    assert contact.load == pytest.approx(float(contact.pressure.sum()) * GRID.cell_area * setup.slices, rel=1e-6)
    assert setup.mean_counted(film.thickness, film) == pytest.approx(contact.opening, rel=2e-3)
    modulus = setup.smooth.film_modulus(film.load)
    case = LineCase(film.load / setup.width, setup.radius, modulus, (SPEED, 0.0), OIL, points=1000)
    shaped = ShapedContact.of(case, line_film(case), 3 * GRID.x[-1], cells=1200)
    solved = shaped.solve(extended(worn.shape, GRID.x, shaped.position), shaped.unworn)
    assert film.minimum_thickness == pytest.approx(solved.film.minimum_thickness, rel=1e-2)
    assert film.thickness[:, 0] == pytest.approx(solved.film.at(GRID.x)[1], rel=1e-2)


def test_films_are_fewer_than_cycles():
    shared, result = loop(contact_of(speed=0.1), 80)
    assert shared.worn.updates > 0
    assert shared.worn.solves < len(result.cycles)


def test_every_film_is_found():
    for counted in ("loaded", "patch"):
        shared, _ = worn_loop(counted)
        assert shared.worn.updates > 1
        assert shared.worn.kept == shared.worn.clamped == 0


def test_the_worn_depth_holds_the_volume_that_left():
    shared, result = worn_loop()
    depth = shared.worn.unworn - result.lower_heights.mean(axis=1)
    lost = float(depth.sum()) * GRID.cell_area * GRID.shape[1]
    assert lost == pytest.approx(float(result.cycles["volume"].sum()), rel=1e-9)
    hill = np.exp(-((GRID.x / 8e-6) ** 2)) + 0.2 * np.random.default_rng(1).standard_normal(64) * (
        np.abs(GRID.x) < 1e-5
    )
    smooth = smoothed(hill, shared.contact.setup)
    assert smooth.sum() == pytest.approx(hill.sum(), rel=1e-3)
    assert np.abs(np.diff(smooth)).max() < 0.5 * np.abs(np.diff(hill)).max()
    # the films' shape is the worn depth up to what they do not follow
    assert shared.worn.shape.sum() == pytest.approx(depth.sum(), rel=0.25)


def test_the_rough_contact_sees_what_the_film_does_not():
    shared, result = worn_loop()
    heights = result.lower_heights + UPPER
    left = shared.worn.with_groove_filled(heights)
    assert left - heights == pytest.approx(np.broadcast_to(shared.worn.shape[:, None], GRID.shape), abs=1e-18)


def test_the_worn_shape_changes_film_and_friction():
    shared, _ = worn_loop()
    unworn, _ = loop(contact_of(film_shape="unworn"), 15)
    assert unworn.worn.shape is None
    assert unworn.rows["total_friction"][0] == shared.rows["total_friction"][0]
    assert unworn.rows["total_friction"][14] != shared.rows["total_friction"][14]
    films, plain = (each.contact.films(each.worn).under(3.0, 0, None).thickness for each in (shared, unworn))
    assert np.abs(films / shared.contact.table.under(3.0).thickness - 1).max() > 0.05
    assert np.array_equal(plain, unworn.contact.table.under(3.0).thickness)


def test_the_rms_height_of_each_cycle_is_that_of_its_rough_contact():
    """Films that follow the worn shape change the film of the whole load and not the heights of earlier cycles."""
    heights = []
    shared, _ = loop(contact_of(), callback=lambda state: heights.append(state.contact.last.heights))
    assert shared.worn.updates > 1
    assert np.array_equal(shared.roughness_over_cycles, [each.std() for each in heights])


def test_where_the_standing_body_keeps_its_shape_both_choices_are_one():
    """The disk moves through the contact, and the harder cylinder does not wear."""
    one, other = (loop(contact_of(film_shape=shape), 6, frame="cylinder")[0] for shape in ("worn", "unworn"))
    assert one.worn.updates == 0
    assert np.array_equal(one.rows, other.rows)
    assert one.notes == other.notes


@pytest.mark.parametrize("stop", [1, 13, 22])
def test_a_loop_goes_on_to_the_same_bits(stop):
    whole, result = worn_loop()
    state = loop(contact_of(), stop)[1].state
    second, again = loop(contact_of(), state=unpack_state(pack_state(state)))
    assert np.array_equal(again.lower_heights, result.lower_heights)
    assert np.array_equal(second.rows, whole.rows)
    assert np.array_equal(second.worn.shape, whole.worn.shape)
    assert second.worn.solves == whole.worn.solves
    assert second.notes == whole.notes


def test_a_table_of_another_version_is_refused():
    state = loop(contact_of(), 1)[1].state
    fewer = state.sharing[list(state.sharing.dtype.names[:-1])]
    with pytest.raises(InputError, match="another version of the program; start the run anew"):
        loop(contact_of(), 2, state=replace(state, sharing=fewer))


def test_where_no_film_is_found_the_last_shape_stays(monkeypatch):
    """After some cycles no film of a new shape is found: the loop goes on, and says so."""
    step = contact_of()
    before, first = loop(step, 8)
    shape = before.worn.shape
    assert shape is not None
    monkeypatch.setattr("bem.lubrication.line.shaped.ShapedContact.solve", lambda self, profile, start: None)
    shared, result = loop(step, 20, state=first.state)
    assert len(result.cycles) == 20
    assert result.status is Status.CONVERGED
    assert np.array_equal(shared.worn.shape, shape)
    assert shared.worn.kept > 0
    assert shared.worn.updates > 0
    (note,) = [note for note in shared.notes if has_code([note], FILM_OF_OTHER_SHAPE, reason="earlier")]
    assert note.level is Level.OUTSIDE_MODEL
    assert (note.values["kept"], note.values["cycles"]) == (shared.worn.kept, 20)


def test_a_cycle_counts_once_where_one_of_two_films_is_missing(monkeypatch):
    """The balance is repeated with the film that is found, and the other one is missing again."""
    whole, result = worn_loop()
    step, memory = contact_of(), whole.memory
    solved, found = ShapeSolver.film, []

    def only_first(solver, index, shape, starts):
        found[:] = found or [index]
        return solved(solver, index, shape, starts) if index in found else None

    monkeypatch.setattr(ShapeSolver, "film", only_first)
    worn = replace(memory.worn, changes={0: memory.worn.changes[0]}, starts={0: memory.worn.starts[0]}, clamped=3)
    rough = rough_contact(step.setup, whole.last.heights, step.speeds)
    _, after = step.share_load_on_worn_film(whole.last.heights, rough, replace(memory, worn=worn), result.pressure)
    assert set(after.worn.changes) == {0, *found}
    assert after.worn.clamped == 4


def test_films_next_to_a_negligible_load_are_not_solved(monkeypatch):
    """In boundary lubrication only the film under the whole load follows: a film that is missing next to a load of
    nearly nothing kept the last shape."""
    shared, _ = worn_loop()
    follower, memory, indices = shared.contact.follower, shared.memory, []
    solved = ShapeSolver.film

    def count(solver, index, shape, starts):
        indices.append(index)
        return solved(solver, index, shape, starts) if index == 0 else None

    monkeypatch.setattr(ShapeSolver, "film", count)
    film = replace(shared.film, load=1e-4 * CASE["load"])  # thin films of a slow contact
    last = replace(shared.last.balance, film=film, regime=Regime.BOUNDARY)
    deeper = memory.worn.unworn - 3 * memory.worn.shape
    after = follower.followed(memory.worn, deeper, last)
    assert indices == [0]
    assert after.updates == memory.worn.updates + 1
    assert after.kept == memory.worn.kept


def test_notes_of_the_contact_and_its_heat_are_shown():
    """Those of the last cycle; the notes of the balance on its end are counted over the cycles."""
    shared, _ = loop(contact_of(), 1)
    assert not has_code(shared.notes, CONTACT_AT_EDGE, SURFACE_HOT)
    last = shared.last
    pressed = replace(last.balance.contact, notes=(CONTACT_AT_EDGE(axes="x", reason="pressed"),))
    hot = (SURFACE_HOT(temperature=250.0, reason="softens"),)
    heat = ContactHeat(400.0, 800.0, np.zeros(GRID.shape), None, 0.1, Status.CONVERGED, hot)
    step = shared.contact
    again = SharedLoad(
        step.setup,
        last.heights,
        rough_contact(step.setup, last.heights, step.speeds),
        step.film_under_load(shared.worn),
        step.film_under_load(shared.worn),
        replace(last.balance, contact=pressed),
        replace(last.forces, heat=heat),
    )
    cycles = MixedCycles(step, shared.rows, step.outcome(again, shared.memory).memory)
    found = [note for note in cycles.notes if has_code([note], CONTACT_AT_EDGE, SURFACE_HOT)]
    assert [note.where for note in found] == ["last cycle", "last cycle"]


def test_a_limited_supply_keeps_the_unworn_film():
    shared, _ = loop(contact_of(supply=1e-6), 8)
    assert shared.worn.shape is None
    assert has_code(shared.notes, FILM_OF_OTHER_SHAPE, reason="unworn")


def test_an_unknown_shape_is_refused():
    with pytest.raises(InputError, match="film_shape: 'round' is unknown; choose from worn, unworn"):
        contact_of(film_shape="round")


def test_sets_of_films_are_shared_by_equal_set_ups_only():
    """Films on meshes of other points have other shear forces, so they are two tables."""
    speeds = (0.3, 0.0)
    tables = [shared_film_table(MixedSetup(**CASE | {"film_points": n}), speeds) for n in (200, 200, 400)]
    assert tables[1] is tables[0]
    coarse, fine = (table.under(table.largest_load).shear_force for table in tables[1:])
    assert abs(fine - coarse) > 1e-6 * abs(fine) > 0
