"""Particles between surfaces: closed forms of one and many between flats, shares of the load, limits, what they cut."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, generate_surface
from bem.wear import WearModel, WearSetup, dry_contact, run_in
from bem.wear.criterion import ArchardOverHardness
from bem.wear.third_bodies import ThirdBodies, with_third_bodies

SOFT, HARD = 2e9, 6e9
GRID = Grid((32, 32), (0.5e-6, 0.5e-6), periodic=(True, True))
LOAD = 2e8 * GRID.area
D = 400e-9


def bodies(lower=SOFT, upper=HARD):
    return tuple(
        Body(Material(name, youngs_modulus=210e9, poissons_ratio=0.3, hardness=hardness))
        for name, hardness in (("lower", lower), ("upper", upper))
    )


def setup(gap=None, load=LOAD, **hardness):
    flat = np.zeros(GRID.shape) if gap is None else gap
    return WearSetup(GRID, bodies(**hardness), flat, load, 0.1, np.array([0.0, 1e-7, 2e-7]))


def rough(rms=60e-9):
    return generate_surface(GRID, rms_height=rms, seed=4, correlation_length=2e-6)


@pytest.mark.internal
def test_equal_hardnesses_share_the_depth_and_press_as_far_as_the_closed_form_says():
    z = 30e-9
    force, (lower, upper) = ThirdBodies(D, 1.0).indented(np.array([D - 2 * z]), (SOFT, SOFT))
    assert lower == pytest.approx(z, rel=1e-12)
    assert upper == pytest.approx(z, rel=1e-12)
    assert force == pytest.approx(SOFT * np.pi * z * (D - z), rel=1e-12)


@pytest.mark.internal
@pytest.mark.parametrize("hardnesses", [(SOFT, HARD), (HARD, SOFT), (SOFT, 1.001 * SOFT)])
def test_forces_on_both_sides_are_equal_and_depths_add_up_to_what_is_too_large(hardnesses):
    gap = np.linspace(0.0, 1.1 * D, 45)
    force, depths = ThirdBodies(D, 1.0).indented(gap, hardnesses)
    assert sum(depths) == pytest.approx(np.maximum(D - gap, 0), abs=1e-18)
    for depth, hardness in zip(depths, hardnesses, strict=True):
        area = np.pi * np.where(depth < D / 2, depth * (D - depth), D**2 / 4)
        # half a sphere has a flat top: next to it depths are known to the root of round-off
        assert force == pytest.approx(hardness * area, rel=1e-6)
    assert (np.diff(force) <= 1e-12 * force.max()).all()
    assert (force[gap >= D] == 0).all()


@pytest.mark.internal
def test_a_soft_particle_yields_itself_and_cuts_nothing():
    particle = ThirdBodies(D, 1.0, hardness=1e9, removed=1.0)
    force, depths = particle.indented(np.array([0.8 * D]), (SOFT, HARD))
    assert depths[0] == pytest.approx(depths[1], rel=1e-12)
    assert force == pytest.approx(1e9 * np.pi * 0.1 * D * 0.9 * D, rel=1e-9)
    assert not particle.cut(depths[0], SOFT, 1e-6).any()


@pytest.mark.internal
def test_many_between_flats_hold_them_apart_as_far_as_one_would():
    particles = ThirdBodies(D, 3e12)
    outcome = with_third_bodies(dry_contact(setup(upper=SOFT)), particles, 0.0)(np.zeros(GRID.shape), None)
    assert outcome.status == "converged"
    assert outcome.load == 0 == outcome.pressure.max()
    assert outcome.third_bodies.load == pytest.approx(LOAD, rel=1e-6)
    # each carries load / number: pi H z (d - z)
    each = LOAD / (particles.number_per_area * GRID.area) / (np.pi * SOFT)
    depth = 0.5 * (D - np.sqrt(D**2 - 4 * each))
    force, _ = particles.indented(np.array([D - 2 * depth]), (SOFT, SOFT))
    assert force * particles.number_per_area * GRID.area == pytest.approx(LOAD, rel=1e-9)


@pytest.mark.internal
def test_few_between_flats_carry_what_fills_the_area_below_them():
    # the flats touch, and every particle is pressed in whole: hardness times half a sphere's area
    particles = ThirdBodies(D, 2e10)
    outcome = with_third_bodies(dry_contact(setup(upper=SOFT)), particles, 0.0)(np.zeros(GRID.shape), None)
    expected = particles.number_per_area * GRID.area * SOFT * np.pi * D**2 / 4
    assert expected < LOAD
    assert outcome.third_bodies.load == pytest.approx(expected, rel=1e-9)
    assert outcome.load + outcome.third_bodies.load == pytest.approx(LOAD, rel=1e-6)


@pytest.mark.internal
def test_rough_surfaces_share_the_load_with_them_and_none_is_as_it_was():
    heights, dry = rough(), dry_contact(setup())
    alone = dry(heights, None)
    none = with_third_bodies(dry_contact(setup()), ThirdBodies(D, 0.0), 0.0)(heights, None)
    assert np.array_equal(none.pressure, alone.pressure)
    assert none.third_bodies is None
    before = 0.0
    for number_per_area in (1e9, 1e10, 4e10):
        found = with_third_bodies(dry_contact(setup()), ThirdBodies(D, number_per_area), 0.0)(heights, None)
        assert found.status == "converged"
        assert found.load + found.third_bodies.load == pytest.approx(LOAD, rel=1e-6)
        assert found.third_bodies.load > before
        before = found.third_bodies.load
    # so few that the gap stays: as much as the gap of the contact alone says
    from bem.contact import solve_contact
    from bem.convolution import displacement_operator

    operator = displacement_operator(GRID, bodies(), friction=0.1)
    gap = solve_contact(-heights, operator, load=LOAD, hardness=SOFT, tolerance=1e-6).gap
    few = ThirdBodies(D, 1e6)
    expected = few.number_per_area * few.indented(gap, (SOFT, HARD))[0].sum() * GRID.cell_area
    assert with_third_bodies(dry_contact(setup()), few, 0.0)(heights, None).third_bodies.load == pytest.approx(
        expected, rel=1e-3
    )


@pytest.mark.internal
def test_a_cell_that_sinks_at_the_hardness_does_not_keep_them_from_their_share():
    # it sinks under one load until the next one touches, and the gap jumps with the load
    heights = rough()
    alone = np.unravel_index(heights.argmax(), heights.shape)
    heights[alone] = np.sort(heights, axis=None)[-2] + 20e-9
    found = with_third_bodies(dry_contact(setup()), ThirdBodies(D, 8.3e11), 0.0)(heights, None)
    assert found.status == "converged"
    assert found.load == pytest.approx(SOFT * GRID.cell_area, rel=1e-6)
    assert found.load + found.third_bodies.load == pytest.approx(LOAD, rel=1e-6)
    # of all contacts tried, not of the last
    assert found.convolutions > 20


@pytest.mark.internal
def test_a_groove_is_a_segment_of_the_sphere_along_half_the_slide():
    particles = ThirdBodies(D, 1e10, removed=0.25)
    whole = particles.cut(np.array([D / 2, 0.0]), SOFT, 2e-6)
    assert whole[0] == pytest.approx(0.25 * 1e10 * 1e-6 * np.pi * D**2 / 8, rel=1e-12)
    assert whole[1] == 0
    place = np.linspace(0, 1, 20_001) * np.sqrt(0.1 * D * 0.9 * D)
    half = np.sqrt((D / 2) ** 2 - place**2) - 0.4 * D
    segment = 2 * np.sum(0.5 * (half[1:] + half[:-1])) * (place[1] - place[0])
    assert particles.cut(np.array([0.1 * D]), SOFT, 2e-6)[0] == pytest.approx(0.25e10 * 1e-6 * segment, rel=1e-6)


def loop(distance=1e-6, **model):
    lower, upper = rough(), np.zeros(GRID.shape)
    return run_in(
        *(lower, upper),
        grid=GRID,
        bodies=bodies(),
        load=LOAD,
        depths=np.array([0.0, 1e-7, 2e-7]),
        friction=0.1,
        cycles=2,
        model=WearModel(criterion={"kind": "archard", "specific_wear_rate": 0.0, "distance": distance}, **model),
    )


def test_a_loop_loses_what_they_cut_off_and_without_them_keeps_its_bits():
    table = {"diameter": D, "number_per_area": 1e10, "removed": 0.1}
    cut = loop(third_bodies=table)
    lost = (rough() - cut.lower_heights).sum() - cut.upper_heights.sum()
    assert lost > 0
    assert lost * GRID.cell_area == pytest.approx(cut.cycles["volume"].sum(), rel=1e-9)
    assert np.array_equal(cut.cycles["cut_volume"], cut.cycles["volume"])
    assert (cut.cycles["third_body_load"] + cut.cycles["contact_load"]) == pytest.approx(LOAD, rel=1e-6)
    plain, none = loop(), loop(third_bodies=table | {"number_per_area": 0.0})
    assert np.array_equal(plain.pressure, none.pressure)
    assert np.array_equal(plain.lower_heights, none.lower_heights)
    pushed = loop(third_bodies=table | {"removed": 0.0})
    assert np.array_equal(pushed.lower_heights, plain.lower_heights)


def test_they_roll_as_far_as_a_cycle_stands_for_and_not_out_of_their_grooves():
    table = {"diameter": D, "number_per_area": 1e10, "removed": 0.1}
    near, far = (loop(distance, third_bodies=table).cycles["volume"][0] for distance in (1e-8, 2e-8))
    assert far == pytest.approx(2 * near, rel=1e-9)
    with pytest.raises(InputError, match=r"cut deeper than they lie; allowed: 5 mm"):
        loop(6e-3, third_bodies=table)


@pytest.mark.internal
def test_particles_that_become_too_many_for_their_grooves_end_the_loop():
    """Only the number of the first cycle was checked: from none, a cycle could cut hundreds of times their depth."""
    table = {"diameter": D, "number_per_area": 0.0, "removed": 0.1, "shed": 1.0}
    arguments = {
        "grid": GRID,
        "bodies": bodies(),
        "load": LOAD,
        "depths": np.array([0.0, 1e-7]),
        "friction": 0.1,
        "criterion": {"kind": "archard", "specific_wear_rate": 1e-15, "distance": 0.1},
        "model": WearModel(third_bodies=table),
    }
    first = run_in(rough(), np.zeros(GRID.shape), cycles=1, **arguments)
    number = first.cycles["volume"][0] / (GRID.area * np.pi / 6 * D**3)
    assert first.cycles["third_bodies_per_area"][0] == 0
    assert 2 / (0.1 * number * D) < 0.1
    with pytest.raises(InputError, match="cut deeper than they lie; allowed"):
        run_in(rough(), np.zeros(GRID.shape), cycles=2, **arguments)


@pytest.mark.internal
def test_a_surface_without_hardness_has_that_of_its_yield_stress():
    """The cap of the contact pressure had it, third bodies and Archard's law refused the same material."""
    given = Body(Material("given", youngs_modulus=210e9, poissons_ratio=0.3, yield_stress=1e9))
    assert ThirdBodies(D, 1.0).hardnesses((given, given)) == (2.8e9, 2.8e9)
    law = ArchardOverHardness(archard_coefficient=1e-3, distance=1.0)
    assert law.rate(given, 0.1) == pytest.approx(1e-3 / 2.8e9, rel=1e-12)


@pytest.mark.internal
def test_partial_slip_has_none():
    with pytest.raises(InputError, match="third bodies roll where surfaces slide"):
        WearModel(third_bodies=ThirdBodies(D, 1e10), traction={"kind": "oscillating_force", "share": 0.5})


@pytest.mark.internal
@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"diameter": 0.0}, "diameter 0.0 must be more than 0"),
        ({"number_per_area": -1.0}, "number_per_area -1.0 must be at least 0"),
        ({"number_per_area": np.inf}, "number_per_area must be finite"),
        ({"removed": 1.5}, "removed 1.5 must be at least 0 and at most 1"),
        ({"number_per_area": 1e14}, "covers 12.6 times the area"),
    ],
)
def test_what_are_no_particles_is_refused(changes, message):
    with pytest.raises(InputError, match=message):
        ThirdBodies(**{"diameter": D, "number_per_area": 1e10} | changes)


@pytest.mark.internal
def test_a_loop_takes_them_around_a_dry_contact_that_is_given():
    plain, model = setup(), WearModel(third_bodies=ThirdBodies(D, 1e10))
    arguments = {
        "grid": GRID, "bodies": bodies(), "load": LOAD, "depths": plain.depths, "friction": 0.1, "cycles": 2,
        "gap": plain.gap, "model": model,
    }  # fmt: skip
    one, other = (
        run_in(rough(), np.zeros(GRID.shape), contact_step=step, **arguments) for step in (None, dry_contact(plain))
    )
    assert one.cycles["third_body_load"].min() > 0
    assert np.array_equal(one.cycles, other.cycles)


@pytest.mark.internal
def test_surfaces_without_hardness_and_films_are_refused():
    soft = (bodies()[0], Body(Material("upper", youngs_modulus=210e9, poissons_ratio=0.3)))
    plain = setup()
    without_hardness = dry_contact(WearSetup(GRID, soft, plain.gap, LOAD, 0.1, plain.depths))
    with pytest.raises(InputError, match="each surface needs a hardness"):
        with_third_bodies(without_hardness, ThirdBodies(D, 1e10), 0.0)
    with pytest.raises(InputError, match="share the load of dry contacts and of a MixedContact"):
        run_in(
            *(rough(), np.zeros(GRID.shape)),
            grid=GRID,
            bodies=bodies(),
            load=LOAD,
            depths=plain.depths,
            model=WearModel(third_bodies=ThirdBodies(D, 1e10)),
            contact_step=lambda heights, start, compliance: dry_contact(plain)(heights, start),
        )
