"""Particles between surfaces in oil, and a number of them that changes: flats, sums, limits, recursions, resuming."""

from dataclasses import replace

import numpy as np
import pytest
from mixed_case import mixed_case

from bem import Body, InputError, Layer, Lubricant, Material, run_in
from bem.errors import ConvergenceError, Status
from bem.friction.load_sharing import LoadSharing
from bem.friction.setup import MixedSetup
from bem.notes import has_code
from bem.notes.friction import OIL_COUNTED
from bem.notes.wear import THIRD_BODIES_MANY
from bem.wear import ContactStart, DryContact, WearModel, pack_state, unpack_state
from bem.wear.contact_step import contact_rows
from bem.wear.mixed import MixedContact, MixedCycles
from bem.wear.third_bodies import ThirdBodies, with_third_bodies

pytestmark = pytest.mark.internal

ELASTIC = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
SOFT, HARD = (Body(Material(str(h), **ELASTIC, hardness=h)) for h in (2e9, 6e9))
OIL = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
CASE = mixed_case(64, 0.8e-6, 3e-6, lubricant=OIL, boundary_friction=0.1, bodies=(SOFT, HARD), hardness=2e9)
ROUGH = CASE.pop("height")
D = 600e-9


def step(speeds=(0.01, 0.0), **changes):
    return MixedContact(MixedSetup(**CASE | {"tolerance": 1e-4} | changes), speeds)


def shared(heights, number, speeds=(0.01, 0.0), **particle):
    contact = step(speeds)
    found = with_third_bodies(contact, ThirdBodies(D, number, **particle), 1e-6)(heights)
    return found, MixedCycles(contact, found.sharing, found.memory)


def test_between_flats_film_and_particles_carry_the_load_in_the_film_s_own_gap():
    flat = np.zeros_like(ROUGH)
    found, cycles = shared(flat, 1e10, friction=0.03)
    row, setup = cycles.rows[-1], cycles.contact.setup
    assert found.status == "converged"
    assert found.load == 0
    borne = found.third_bodies.load * setup.slices
    assert row["film_load"] + borne == pytest.approx(setup.load, rel=2e-4)
    assert 0.05 < borne / setup.load < 0.95
    gap = np.broadcast_to(cycles.film.thickness, flat.shape)
    each, _ = ThirdBodies(D, 1e10).indented(gap, (2e9, 6e9))
    # the surfaces hold the film's oil to the tolerance of the balance
    assert found.third_bodies.load == pytest.approx(1e10 * each.sum() * setup.grid.cell_area, rel=2e-3)
    assert row["boundary_force"] == pytest.approx(0.03 * borne, rel=1e-9)


def test_rough_surfaces_share_with_both_and_few_or_small_ones_change_nothing():
    plain = ROUGH
    before = step()(plain)
    none = shared(plain, 0.0)[0]
    assert np.array_equal(none.pressure, before.pressure)
    kept = step()
    with_third_bodies(kept, ThirdBodies(D, 1e10), 1e-6)(plain)
    assert np.array_equal(kept(plain).pressure, before.pressure)  # the contact with particles is another step
    small = with_third_bodies(step(), ThirdBodies(1e-9, 1e12), 1e-6)(plain)
    assert small.load == pytest.approx(before.load, rel=2e-3)
    last = 0.0
    for number in (1e8, 1e9, 1e10):
        found, cycles = shared(plain, number)
        row, setup = cycles.rows[-1], cycles.contact.setup
        assert found.status == "converged"
        total = row["film_load"] + row["width_contact_load"] + found.third_bodies.load * setup.slices
        assert total == pytest.approx(setup.load, rel=2e-4)
        assert row["width_contact_load"] == pytest.approx(found.load * setup.slices, rel=1e-12)
        assert found.third_bodies.load > last
        last = found.third_bodies.load
    assert found.load < 0.7 * before.load


def test_what_hangs_on_the_oil_beside_the_contact_is_said_with_particles_too():
    few, many = (shared(ROUGH, number)[1] for number in (1e5, 1e11))
    contact = step()
    outcome = contact(ROUGH)
    alone = MixedCycles(contact, outcome.sharing, outcome.memory)
    # so few that they count for nothing: judged as without them
    assert few.oil().contact_share == pytest.approx(alone.oil().contact_share, rel=1e-2)
    assert many.oil() is None
    assert has_code(many.notes, OIL_COUNTED, reason="particles")


@pytest.mark.parametrize("counted", ["patch", "loaded"])
def test_a_film_that_clears_the_roughness_by_less_than_a_particle_is_no_full_film(counted):
    fast = step((2.0, 0.0), oil_volume=counted)
    without = fast(ROUGH)
    assert without.load == 0  # without them it is
    gap = float((without.memory.last.balance.film.thickness - ROUGH).min())
    found = with_third_bodies(step((2.0, 0.0), oil_volume=counted), ThirdBodies(gap + 300e-9, 1e10), 1e-6)(ROUGH)
    assert found.status == "converged"
    assert found.third_bodies.load > 0


def test_halves_of_the_last_step_are_no_cycles_of_a_contact_in_oil():
    setup, contact = step().setup, step()
    law = {"kind": "archard", "specific_wear_rate": 1e-15, "distance": 1e-3}
    found = run_in(
        *(ROUGH, np.zeros_like(ROUGH)), grid=setup.grid, bodies=(SOFT, HARD), load=setup.load / setup.slices,
        depths=np.array([0.0, 1e-7]), gap=np.broadcast_to(setup.grid.x[:, None] ** 2 / 4e-3, setup.grid.shape),
        friction=0.1, hardness=2e9, cycles=2, criterion=law, contact_step=contact,
    )  # fmt: skip
    assert found.step_error > 0
    assert len(found.state.sharing) == 2


def test_halves_of_the_last_step_begin_with_the_film_of_that_step():
    """The film's shape follows the standing body as it was before the cycle, not as the cycle left it."""
    contact, profiles = step(), []

    def recorded(heights, start, compliance):
        profiles.append(start.standing_profile)
        return contact(heights, start, compliance)

    setup = contact.setup
    law = {"kind": "archard", "specific_wear_rate": 1e-15, "distance": 1e-3}
    run_in(
        *(ROUGH, np.zeros_like(ROUGH)), grid=setup.grid, bodies=(SOFT, HARD), load=setup.load / setup.slices,
        depths=np.array([0.0, 1e-7]), gap=np.broadcast_to(setup.grid.x[:, None] ** 2 / 4e-3, setup.grid.shape),
        friction=0.1, hardness=2e9, cycles=2, criterion=law, contact_step=recorded,
        model=WearModel(wears="both"),
    )  # fmt: skip
    first, last, half, second = profiles
    assert np.abs(last - first).max() > 0  # the first cycle wore it
    assert half == pytest.approx(last, abs=1e-9 * np.abs(last - first).max() + 1e-22)
    assert second is None


def test_an_error_says_which_part_of_load_sharing_did_not_converge(monkeypatch):
    contact = step()
    good = LoadSharing.balance
    monkeypatch.setattr(
        LoadSharing, "balance", lambda *given: replace(good(*given), status=Status.STALLED, oil_imbalance=-0.02)
    )
    outcome = contact(ROUGH)
    assert outcome.residual < 1e-3
    assert "an imbalance of oil of 2.0e-02" in outcome.failure
    with pytest.raises(ConvergenceError, match=r"load sharing, .* an imbalance of oil of 2\.0e-02, ended"):
        loop(1)


def test_the_strip_of_coated_bodies_in_oil_is_that_of_their_dry_contact():
    """It took the contact modulus of the substrates, where the dry contact takes that of waves of four cells."""
    coated = Body(SOFT.material, layer=Layer(Material("soft layer", **ELASTIC | {"youngs_modulus": 40e9}), 5e-6))
    contact = step(bodies=(coated, HARD))
    outcome = contact(ROUGH)
    setup, solution = contact.setup, outcome.memory.last.balance.contact.solution
    dry = DryContact(setup.grid, (coated, HARD), np.zeros(setup.grid.shape), setup.load, hardness=setup.hardness)
    expected = dry.outcome(solution, 0.0).strip
    substrates = contact_rows(solution, setup.grid, setup.smooth.contact_modulus, cap=setup.hardness)
    assert np.abs(substrates - expected).max() > 1e-2
    assert outcome.strip == pytest.approx(expected, abs=1e-3)


def test_a_contact_in_oil_keeps_no_state():
    contact = step()
    first = contact(ROUGH)
    start = ContactStart(first.pressure, first.memory)
    one, other = contact(ROUGH, start), contact(ROUGH, start)
    assert np.array_equal(one.pressure, other.pressure)
    assert np.array_equal(one.sharing, other.sharing)
    assert np.array_equal(contact(ROUGH).sharing, first.sharing)


def loop(cycles, state=None, callback=None, contact=True, **particle):
    law = {"kind": "archard", "specific_wear_rate": 1e-15, "distance": 1e-3}
    table = {"diameter": D, "number_per_area": 1e8, "shed": 0.5, "leaving": 0.25} | particle
    given = step() if contact else None
    setup = step().setup
    return run_in(
        *(ROUGH, np.zeros_like(ROUGH)),
        grid=setup.grid,
        bodies=(SOFT, HARD),
        load=setup.load / setup.slices,
        depths=np.array([0.0, 1e-7]),
        gap=np.broadcast_to(setup.grid.x[:, None] ** 2 / 4e-3, setup.grid.shape),
        friction=0.1,
        hardness=2e9,
        cycles=cycles,
        model=WearModel(criterion=law, third_bodies=table),
        contact_step=given,
        state=state,
        callback=callback,
    )


@pytest.mark.parametrize("contact", [True, False], ids=["in oil", "dry"])
def test_what_wears_feeds_them_and_some_leave_every_cycle(contact):
    kept = []
    found = loop(4, callback=kept.append, contact=contact, removed=0.01)
    number, worn = found.cycles["third_bodies_per_area"], found.cycles["volume"]
    area, each = step().setup.grid.area, np.pi / 6 * D**3
    assert number[0] == 1e8
    assert number[1:] == pytest.approx(0.75 * number[:-1] + 0.5 * worn[:-1] / (area * each), rel=1e-12)
    assert number[-1] > number[0]
    assert found.step_error > 0
    again = loop(4, state=unpack_state(pack_state(kept[1])), contact=contact, removed=0.01)
    assert np.array_equal(again.lower_heights, found.lower_heights)
    assert np.array_equal(again.cycles["third_bodies_per_area"], number)


def test_they_cover_the_area_once_at_most_and_that_is_said():
    found = loop(3, contact=False, removed=1e-4, shed=1.0, leaving=0.0, number_per_area=(1 - 1e-9) * 4 / (np.pi * D**2))
    assert found.cycles["third_bodies_per_area"][-1] == pytest.approx(4 / (np.pi * D**2), rel=1e-12)
    assert has_code(found.notes, THIRD_BODIES_MANY, reason="area")


def test_nothing_is_cut_in_pure_rolling():
    sliding, rolling = (shared(ROUGH, 1e10, speeds, removed=0.1)[0] for speeds in ((0.01, 0.0), (0.005, 0.005)))
    assert all(cut.max() > 0 for cut in sliding.third_bodies.cut)
    assert rolling.third_bodies.load > 0
    assert not any(cut.any() for cut in rolling.third_bodies.cut)


@pytest.mark.parametrize("changes", [{"shed": 1.5}, {"leaving": -0.1}])
def test_shares_lie_between_nothing_and_all(changes):
    (name,) = changes
    with pytest.raises(InputError, match=name):
        ThirdBodies(D, 1e8, **changes)
