"""The wear cycle: what leaves is what the surface loses, nothing that matters is skipped, a stopped run goes on."""

from dataclasses import replace

import numpy as np
import pytest

from bem import (
    Body,
    ConvergenceError,
    Grid,
    InputError,
    Layer,
    Material,
    Status,
    find_particles,
    generate_surface,
    run_in,
    subsurface_stress,
    von_mises,
)
from bem.stress import von_mises_field
from bem.transforms import COUNT
from bem.wear import Settled, WearModel, WearSetup, dry_contact, pack_state, unpack_state, yielded_pieces
from bem.wear.contact_step import ContactOutcome
from bem.wear.segmentation import segment

HARD = Body(Material("cylinder", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9))
SOFT = Body(Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.64e9))
STIFF = Material("interlayer", youngs_modulus=300e9, poissons_ratio=0.2)
GRID = Grid((48, 40), (100e-9, 100e-9), periodic=(False, True))
DEPTHS = np.arange(24) * 95e-9
LOAD = 2.2e-3  # about 7 % of the grid at the hardness
NO_SKIN = {"kind": "von_mises", "skin_depth": 0.0}  # stress is judged from the surface down


def surfaces(seed=3, rms=(150e-9, 30e-9)):
    whole = Grid(GRID.shape, GRID.spacing)
    return tuple(
        generate_surface(whole, rms_height=r, correlation_length=0.4e-6, seed=seed + k) for k, r in enumerate(rms)
    )


ARGUMENTS = dict(grid=GRID, bodies=(SOFT, HARD), load=LOAD, depths=DEPTHS, friction=0.16)  # noqa: C408


def setup(**change):
    arguments = ARGUMENTS | {"gap": np.zeros(GRID.shape)} | change
    return WearSetup(**arguments)


def test_worn_volume_is_the_surfaces_loss_to_round_off():
    lower, upper = surfaces()
    result = run_in(lower, upper, cycles=6, **ARGUMENTS)
    assert result.particles.size > 10
    lost = (lower - result.lower_heights).sum() * GRID.cell_area
    # sums of some thousand heights of 1e-7 m: their round-off over the volume
    assert result.particles["volume"].sum() == pytest.approx(lost, rel=1e-11, abs=0)
    assert result.cycles["volume"].sum() == pytest.approx(lost, rel=1e-11, abs=0)
    assert np.array_equal(result.upper_heights, upper)
    assert (result.lower_heights <= lower).all()


def test_stopping_at_a_quiet_depth_gives_the_pieces_of_the_whole_stack():
    lower, upper = surfaces()
    fixed = setup()
    contact = dry_contact(fixed)(lower + upper, None)
    assert contact.status == Status.CONVERGED
    found = yielded_pieces(contact.pressure, fixed, WearModel(criterion=NO_SKIN), 0)
    stack = von_mises_field(contact.pressure, GRID, SOFT, DEPTHS, friction=0.16)
    whole = segment(stack, DEPTHS, yield_stress=0.64e9, periodic=GRID.periodic)
    assert whole.count > 3
    assert np.array_equal(found.pieces.labels, whole.labels)
    # rows and columns of transforms in other portions: the last digits of a stress
    assert np.abs(found.pieces.thickness - whole.thickness).max() <= 1e-12 * DEPTHS[-1]
    assert found.depths_computed < DEPTHS.size / 2


def test_a_bound_spares_every_transform_where_nothing_can_yield():
    gentle = np.zeros(GRID.shape)
    gentle[20:24, 20:24] = 1e8
    COUNT.reset()
    found = yielded_pieces(gentle, setup(), WearModel(), 0)
    assert found.pieces.count == 0
    assert found.depths_computed == 0
    assert COUNT.forward == COUNT.inverse == 0
    stack = von_mises_field(gentle, GRID, SOFT, DEPTHS, friction=0.16)
    assert stack.max() < 0.64e9  # and indeed nothing does


@pytest.mark.parametrize(("strength", "count"), [(0.99, 1), (1.01, 0)])
def test_the_bound_on_von_mises_hides_no_yield_by_tresca(strength, count):
    """Under the middle of a strip of half-width a with a uniform pressure p, at a depth of a, the principal stresses
    differ by 2 p / pi, more than anywhere else (Johnson 1985, section 2.5). The bound on von Mises stress there is
    within Tresca's factor of it."""
    grid, pressure = Grid((24, 1), (100e-9, 100e-9), periodic=(False, True)), 1e9
    strip = np.zeros(grid.shape)
    strip[12] = pressure
    disk = Body(replace(SOFT.material, yield_stress=strength * 2 / np.pi * pressure))
    depths = np.arange(1, 6) * 50e-9
    fixed = setup(grid=grid, gap=np.zeros(grid.shape), bodies=(disk, HARD), friction=0.0, depths=depths)
    model = WearModel(criterion={"kind": "tresca", "skin_depth": 50e-9})
    assert yielded_pieces(strip, fixed, model, 0).pieces.count == count


def test_only_the_cubic_needs_the_depth_below_the_quiet_one():
    lower, upper = surfaces()
    fixed = setup()
    pressure = dry_contact(fixed)(lower + upper, None).pressure
    cubic, linear = (
        yielded_pieces(pressure, fixed, WearModel(refinement=name, criterion=NO_SKIN), 0)
        for name in ("monotone_cubic", "linear")
    )
    assert linear.depths_computed == cubic.depths_computed - 1
    stack = von_mises_field(pressure, GRID, SOFT, DEPTHS, friction=0.16)
    whole = segment(stack, DEPTHS, yield_stress=0.64e9, periodic=GRID.periodic, refinement="linear")
    assert whole.count > 3
    assert np.array_equal(linear.pieces.labels, whole.labels)
    assert np.abs(linear.pieces.thickness - whole.thickness).max() <= 1e-12 * DEPTHS[-1]


def test_a_stopped_run_goes_on_to_the_same_bits():
    lower, upper = surfaces()
    whole = run_in(lower, upper, cycles=6, **ARGUMENTS)
    states = []
    run_in(lower, upper, cycles=3, callback=states.append, **ARGUMENTS)
    packed = pack_state(states[-1])
    rest = run_in(lower, upper, cycles=6, state=unpack_state(packed), **ARGUMENTS)
    assert np.array_equal(whole.lower_heights, rest.lower_heights)
    assert np.array_equal(whole.pressure, rest.pressure)
    assert np.array_equal(whole.particles, rest.particles)
    assert np.array_equal(whole.cycles, rest.cycles)


def test_a_settled_state_that_is_resumed_gets_no_cycle_more():
    lower, upper = surfaces()
    rule = Settled(window=1, tolerance=2.0)  # any two cycles agree
    whole = run_in(lower, upper, cycles=4, stop=rule, **ARGUMENTS)
    assert (whole.settled, whole.state.cycle) == (True, 2)
    again = run_in(lower, upper, cycles=4, stop=rule, state=unpack_state(pack_state(whole.state)), **ARGUMENTS)
    assert (again.settled, again.state.cycle) == (True, 2)
    assert np.array_equal(again.lower_heights, whole.lower_heights)


def test_interpolated_refinement_is_near_the_exact_one():
    lower, upper = surfaces()
    fixed = setup()
    pressure = dry_contact(fixed)(lower + upper, None).pressure
    cubic = yielded_pieces(pressure, fixed, WearModel(refine=4), 0).pieces
    linear = yielded_pieces(pressure, fixed, WearModel(refine=4, refinement="linear"), 0).pieces
    exact = yielded_pieces(pressure, fixed, WearModel(refine=4, refinement="exact"), 0).pieces
    volumes = [p.thickness.sum() for p in (cubic, linear, exact)]
    # 95 nm between depths under 100 nm cells is coarse; of twelve surfaces both were within 1 %, neither always nearer
    assert volumes[0] == pytest.approx(volumes[2], rel=0.02)
    assert volumes[1] == pytest.approx(volumes[2], rel=0.02)


@pytest.mark.parametrize(("frame", "way"), [("disk", 1), ("cylinder", -1)])
def test_the_moving_body_slides_and_may_be_longer_than_the_grid(frame, way):
    """The upper body moves in the frame of the disk, the lower one in that of the cylinder, against each other."""
    flat, upper = np.zeros(GRID.shape), surfaces()[1]
    longer = np.concatenate([upper, upper[::-1]])
    pair = (flat, longer) if frame == "disk" else (longer, flat)
    seen = []

    def contact(heights, start, compliance):
        seen.append(heights.copy())
        return ContactOutcome(np.zeros(GRID.shape), 0.0, 0.0, LOAD, 0.16, 0.0, 0, Status.CONVERGED)

    run_in(*pair, cycles=3, model=WearModel(shift=5, frame=frame), contact_step=contact, **ARGUMENTS)
    assert len(seen) == 3
    for step, heights in enumerate(seen):
        assert np.array_equal(heights, longer[(np.arange(48) - way * 5 * step) % 96])


@pytest.mark.parametrize("speeds", [1, -1])
def test_the_body_slides_as_the_speeds_say_where_a_film_leaves_no_friction(speeds):
    """A law of boundary friction has no coefficient without a contact: the body slid along +x until there was one."""
    flat, upper = np.zeros(GRID.shape), surfaces()[1]
    seen = []

    def contact(heights, start, compliance):
        seen.append(heights.copy())
        return ContactOutcome(np.zeros(GRID.shape), 0.0, 0.0, 0.0, 0.0, 0.0, 0, Status.CONVERGED, sliding=speeds)

    run_in(
        flat,
        upper,
        cycles=3,
        model=WearModel(shift=5, frame="disk"),
        contact_step=contact,
        **ARGUMENTS | {"friction": 0.0},
    )
    for step, heights in enumerate(seen):
        assert np.array_equal(heights, np.roll(upper, 5 * speeds * step, axis=0))


def test_roughness_of_a_cycle_without_a_contact_is_that_of_the_last_strip():
    """It was that of all rows, beside the strip of other cycles: the rule that a run has settled compared both."""
    lower, strip = surfaces()[0], np.zeros(GRID.shape)
    strip[18:30] = 1.0

    def contact(heights, start, compliance):
        touches = start is None or start.last_cycle is None or start.last_cycle["cycle"] != 1
        return ContactOutcome(1e8 * strip * touches, 0.0, 0.0, LOAD, 0.16, 0.0, 0, Status.CONVERGED)

    model = WearModel(shift=0, criterion={"kind": "archard", "specific_wear_rate": 0.0, "distance": 1e-3})
    rows = run_in(lower, np.zeros(GRID.shape), cycles=3, model=model, contact_step=contact, **ARGUMENTS).cycles
    assert rows["rms_height"] == pytest.approx(float(lower[18:30].std()), rel=1e-12)


def test_a_track_wears_alike_where_the_disk_moves_and_has_a_groove_where_it_stands_still():
    """Wear by pressure under a steady strip 12 of 48 cells wide: the same volume, along the whole track or in it."""
    flat, strip = np.zeros(GRID.shape), np.zeros(GRID.shape)
    strip[18:30] = 1.0

    def contact(heights, start, compliance):
        return ContactOutcome(1e8 * strip, 1e-12, 0.0, LOAD, 0.16, 0.0, 0, Status.CONVERGED)

    law = {"kind": "archard", "specific_wear_rate": 1e-13, "distance": 1e-3}
    worn = {}
    for frame in ("cylinder", "disk"):
        model = WearModel(frame=frame, shift=3, criterion=law, wears="lower")
        worn[frame] = -run_in(flat, flat, cycles=32, model=model, contact_step=contact, **ARGUMENTS).lower_heights
    assert worn["disk"].sum() == pytest.approx(worn["cylinder"].sum(), rel=1e-12)
    # 32 cycles of 3 cells take every place of the 48 twice through the contact, four cycles long each time
    np.testing.assert_allclose(worn["cylinder"], worn["cylinder"].mean(), rtol=1e-12)
    np.testing.assert_allclose(worn["disk"], 4 * worn["cylinder"].mean() * strip, rtol=1e-12)


def test_the_skin_leaves_with_what_yields_below_it():
    """A single cell at the hardness: 0.2 H and friction at the surface are below yield, at 50 nm it yields."""
    lone = np.zeros(GRID.shape)
    lone[24, 20] = 1.8e9
    surface = von_mises_field(lone, GRID, SOFT, [0.0, 50e-9], friction=0.16)
    assert surface[0].max() < 0.64e9 < surface[1].max()
    counts = {
        skin: yielded_pieces(lone, setup(), WearModel(criterion={"kind": "von_mises", "skin_depth": skin}), 0).pieces
        for skin in (0.0, 50e-9)
    }
    assert counts[0.0].count == 0
    assert counts[50e-9].count == 1
    assert counts[50e-9].thickness.max() > 50e-9


def test_the_skin_depth_is_the_first_depth_of_stress_wherever_planes_lie():
    """A plane at the surface changes nothing: the skin is a length of the criterion and not of the depths."""
    lower, upper = surfaces()
    model = WearModel(criterion={"kind": "von_mises", "skin_depth": DEPTHS[1]})
    with_surface = run_in(lower, upper, cycles=3, model=model, **ARGUMENTS)
    without = run_in(lower, upper, cycles=3, model=model, **(ARGUMENTS | {"depths": DEPTHS[1:]}))
    assert with_surface.particles.size > 3
    assert np.array_equal(with_surface.lower_heights, without.lower_heights)


def test_depths_that_end_within_the_skin_are_refused():
    with pytest.raises(InputError, match="skin_depth"):
        run_in(*surfaces(), cycles=1, **(ARGUMENTS | {"depths": np.array([0.0, 50e-9])}))


@pytest.mark.parametrize("turned", [False, True], ids=["mirrored", "upside down"])
def test_which_way_the_moving_body_slides_follows_from_friction(turned):
    """A contact in a mirror has friction along -x. Turned upside down (half a turn about y) bodies change places, x its
    sign, and friction on the lower one is along +x as before. Both are the same experiment."""
    lower, upper = surfaces()
    once = run_in(lower, upper, cycles=4, **ARGUMENTS)
    arguments, (low, high) = dict(ARGUMENTS), (lower[::-1], upper[::-1])
    if turned:
        arguments["bodies"], (low, high) = (HARD, SOFT), (high, low)
        arguments["model"] = WearModel(frame="disk")  # the soft body moves, which is the upper one now
    else:
        arguments["friction"] = -ARGUMENTS["friction"]
    again = run_in(low, high, cycles=4, **arguments)
    worn, still = again.lower_heights, again.upper_heights
    if turned:
        worn, still = still, worn
    assert once.cycles["volume"][-1] > 0  # beyond the first cycle, when nothing has slid yet
    # the contact is solved to 1e-6 of the roughness, and where it ends a piece ends by as much
    np.testing.assert_allclose(again.cycles["volume"], once.cycles["volume"], rtol=1e-3)
    np.testing.assert_allclose(worn[::-1], once.lower_heights, rtol=0, atol=1e-3 * np.ptp(lower - once.lower_heights))
    assert np.array_equal(still[::-1], upper)


def test_without_friction_the_upper_body_slides_along_x():
    lower, upper = surfaces()
    seen = []
    contact = dry_contact(setup(friction=0.0))

    def step(heights, start, compliance):
        seen.append(heights - lower)
        return contact(heights, start)

    run_in(
        lower,
        upper,
        cycles=2,
        contact_step=step,
        model=WearModel(shift=4, frame="disk"),
        **(ARGUMENTS | {"friction": 0.0}),
    )
    worn = seen[1] - np.roll(upper, 4, axis=0)
    assert worn.max() < 1e-20  # nothing but what was lost
    assert worn.min() < 0


@pytest.mark.parametrize("wears", ["lower", "upper", "both", "softer"])
def test_the_bodies_that_should_wear_do(wears):
    lower, upper = surfaces()
    result = run_in(lower, upper, cycles=2, model=WearModel(wears=wears), **(ARGUMENTS | {"bodies": (SOFT, SOFT)}))
    changed = (not np.array_equal(lower, result.lower_heights), not np.array_equal(upper, result.upper_heights))
    assert (
        changed
        == {"lower": (True, False), "upper": (False, True), "both": (True, True), "softer": (True, False)}[wears]
    )
    lost = (lower - result.lower_heights).sum() + (upper - result.upper_heights).sum()
    assert result.particles["volume"].sum() == pytest.approx(lost * GRID.cell_area, rel=1e-11, abs=0)


@pytest.mark.parametrize("below", [(), (Layer(STIFF, 200e-9),)], ids=["one layer", "two layers"])
def test_pieces_of_a_film_end_at_its_interface(below):
    film = Material("film", youngs_modulus=88e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.5e9)
    coated = Body(HARD.material, layers=(Layer(film, 100e-9), *below))
    lower, upper = surfaces()
    bodies = (coated, HARD)
    result = run_in(lower, upper, cycles=1, **(ARGUMENTS | {"bodies": bodies}))
    assert result.particles.size > 0
    assert result.particles["thickness"].max() <= 100e-9 * (1 + 1e-12)


@pytest.mark.parametrize("criterion", ["tresca", "maximum_tension"])
def test_other_criteria_run(criterion):
    lower, upper = surfaces()
    result = run_in(lower, upper, cycles=2, model=WearModel(criterion=criterion), **ARGUMENTS)
    base = run_in(lower, upper, cycles=1, **ARGUMENTS)
    if criterion == "tresca":  # Tresca yields no later than von Mises
        assert result.cycles["volume"][0] >= base.cycles["volume"][0] > 0
    assert result.cycles["cycle"][-1] == 2


def test_stress_range_of_a_contact_that_does_not_move_is_zero():
    lower, upper = surfaces()
    strong = Body(Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.95e9))
    arguments = ARGUMENTS | {"bodies": (strong, HARD)}
    result = run_in(lower, upper, cycles=3, model=WearModel(stress_range=True, shift=0), **arguments)
    # loading from nothing to p is half a range of p / 2: below yield; then nothing changes any more
    assert result.particles.size == 0


def test_stress_range_has_no_residual_stress():
    """A residual stress does not change; it was added in full to half the change."""
    lower, upper = surfaces()
    weak = Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.4e9)
    worn = []
    for residual in (-0.35e9, 0.0):
        coated = Body(SOFT.material, layers=(Layer(weak, 1e-6, residual_stress=residual),))
        arguments = ARGUMENTS | {"bodies": (coated, HARD)}
        model = WearModel(stress_range=True, shift=5, criterion=NO_SKIN, within_layer=False)
        worn.append(run_in(lower, upper, cycles=2, model=model, **arguments))
    assert worn[1].particles.size > 0
    assert np.array_equal(worn[0].lower_heights, worn[1].lower_heights)


@pytest.mark.parametrize("rows", [48, 96], ids=["as long as the grid", "longer"])
@pytest.mark.parametrize("frictions", [(0.16, 0.16, 0.16), (0.05, 0.25, 0.4)], ids=["steady friction", "changing"])
def test_stress_range_with_sliding_is_that_of_each_bodys_own_material(frictions, rows):
    """Against a plain recomputation: stresses of this cycle less those of the last, material point by material point.

    The moving body took its last pressure along, the other body kept it; both wear. Slid by less than the grid, its
    material that comes in had no pressure, unless it is as long as the grid and left at the other end.
    """
    lower, upper = surfaces()
    if rows == 96:
        upper = np.concatenate([upper, upper[::-1]])
    body = Body(Material("soft", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.4e9))
    arguments = ARGUMENTS | {"bodies": (body, body)}
    fixed = setup(bodies=(body, body))
    dry = dry_contact(fixed)
    used = iter(frictions)
    model = WearModel(stress_range=True, shift=5, wears="both", frame="disk", criterion=NO_SKIN)
    states = []

    def contact(heights, start, compliance):
        return replace(dry(heights, start), friction=next(used))

    run_in(lower, upper, cycles=3, model=model, contact_step=contact, callback=states.append, **arguments)
    before, now = states[1:]
    stresses = []  # of the lower and the upper body, at rows of their own material
    for state, friction in zip((before, now), frictions[1:], strict=True):
        on_lower = subsurface_stress(state.pressure, GRID, body, DEPTHS, friction=friction)
        # what leaves the grid is unloaded; row k of the counterface faces row k + offset of the grid
        carried = np.zeros((rows, GRID.shape[1]))
        carried[: GRID.shape[0]] = state.pressure
        carried = np.roll(carried, -state.offset, axis=0)
        facing = np.roll(carried, now.offset, axis=0)[: GRID.shape[0]]
        on_upper = subsurface_stress(facing, GRID, body, DEPTHS, friction=-friction)
        stresses.append((on_lower, on_upper))
    lost = (before.heights[0] - now.heights[0], np.roll(before.heights[1] - now.heights[1], now.offset, axis=0)[:48])
    for one in (0, 1):
        change = von_mises(0.5 * (stresses[1][one] - stresses[0][one]))
        pieces = segment(change, DEPTHS, yield_stress=0.4e9, periodic=GRID.periodic)
        assert pieces.count > 0
        # heights of 1e-7 m less thicknesses
        np.testing.assert_allclose(lost[one], pieces.thickness, rtol=0, atol=1e-20)


def test_settled_rule_stops_a_steady_run():
    def contact(heights, start, compliance):
        return ContactOutcome(np.zeros(GRID.shape), 0.0, 0.0, LOAD, 0.16, 0.0, 0, Status.CONVERGED)

    lower, upper = surfaces()
    result = run_in(lower, upper, cycles=50, stop=Settled(window=4), contact_step=contact, **ARGUMENTS)
    assert result.settled
    assert result.state.cycle == 8


def test_a_contact_that_does_not_converge_is_said_with_its_cycle():
    def contact(heights, start, compliance):
        return ContactOutcome(np.zeros(GRID.shape), 0.0, 0.0, LOAD, 0.16, 1e-2, 0, Status.MAX_ITERATIONS)

    lower, upper = surfaces()
    with pytest.raises(ConvergenceError, match="cycle 1"):
        run_in(lower, upper, cycles=5, contact_step=contact, **ARGUMENTS)


def test_a_contact_that_ends_without_numbers_is_not_blamed_on_its_stress():
    def contact(heights, start, compliance):
        return ContactOutcome(np.full(GRID.shape, np.nan), 0.0, 0.0, LOAD, 0.16, np.nan, 0, Status.MAX_ITERATIONS)

    lower, upper = surfaces()
    with pytest.raises(ConvergenceError, match="cycle 1: the contact"):
        run_in(lower, upper, cycles=5, contact_step=contact, **ARGUMENTS)


@pytest.mark.parametrize("criterion", ["von_mises", "averaged_von_mises", "tresca", "low_cycle_fatigue"])
@pytest.mark.parametrize(
    ("depths", "layer", "remedy", "mended"),
    [
        ((0, 50, 104), None, "below 105 nm", (0, 50, 106)),
        ((0, 30, 102), None, "below 103 nm", (0, 30, 102, 200)),
        ((95, 190, 285), 100, "at most 50 nm", (50, 145, 240)),
        ((95, 190, 285), 90, "at most 45 nm", (45, 135, 225)),
    ],
)
def test_a_single_depth_is_refused_before_the_contact_and_the_remedy_helps(criterion, depths, layer, remedy, mended):
    contacts = []

    def contact(heights, start, compliance):
        contacts.append(heights)
        return ContactOutcome(np.full(GRID.shape, 8e9), 0.0, 0.0, LOAD, 0.16, 0.0, 0, Status.CONVERGED)

    coating = Material("coating", youngs_modulus=210e9, poissons_ratio=0.3, hardness=8e9, yield_stress=1e9)
    body = SOFT if layer is None else Body(SOFT.material, layers=(Layer(coating, layer * 1e-9),))
    arguments = ARGUMENTS | {"bodies": (body, HARD), "contact_step": contact, "criterion": criterion, "cycles": 1}
    lower, upper = surfaces()
    with pytest.raises(InputError, match=remedy):
        run_in(lower, upper, **arguments | {"depths": np.array(depths) * 1e-9})
    assert not contacts
    model = WearModel(criterion=criterion)
    assert model.checked_wearing_bodies(setup(bodies=(body, HARD), depths=np.array(mended) * 1e-9)) == (0,)


def test_a_layer_much_thinner_than_the_depths_wears_down_to_its_interface():
    film = Material("film", youngs_modulus=210e9, poissons_ratio=0.3, hardness=8e9, yield_stress=1e9)
    coated = Body(HARD.material, layers=(Layer(film, 100e-9),))
    pressure = np.zeros(GRID.shape)
    pressure[20:28, 16:24] = 8e9
    found = yielded_pieces(
        pressure, setup(bodies=(coated, HARD), depths=np.arange(4) * 1e-6), WearModel(wears="lower"), 0
    )
    assert found.pieces.count == 1
    assert found.pieces.thickness.max() == pytest.approx(100e-9, rel=1e-12)


def test_periodic_in_both_axes_runs_and_particles_do_not_depend_on_the_origin():
    grid = Grid(GRID.shape, GRID.spacing, periodic=(True, True))
    lower, upper = surfaces()
    arguments = ARGUMENTS | {"grid": grid}
    here = run_in(lower, upper, cycles=1, **arguments)
    there = run_in(np.roll(lower, 7, 0), np.roll(upper, 7, 0), cycles=1, **arguments)
    # contact is solved to 1e-6 of the roughness: volumes follow to about that
    assert sorted(there.particles["volume"]) == pytest.approx(sorted(here.particles["volume"]), rel=1e-3, abs=0)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"lower_heights": np.zeros((3, 3))}, "lower_heights"),
        ({"upper_heights": np.full(GRID.shape, np.nan)}, "finite"),
        ({"depths": np.array([1e-7])}, "depths"),
        ({"bodies": (Body(Material("e", youngs_modulus=1e9, poissons_ratio=0.3)),) * 2}, "yield_stress"),
        ({"load": 1.0}, "hardness"),
    ],
)
def test_bad_input_is_named(change, word):
    lower, upper = surfaces()
    arguments = ARGUMENTS | {"lower_heights": lower, "upper_heights": upper} | change
    with pytest.raises(InputError, match=word):
        run_in(arguments.pop("lower_heights"), arguments.pop("upper_heights"), cycles=1, **arguments)
    with pytest.raises(InputError, match="criterion"):
        WearModel(criterion="magic")


def test_particles_of_the_cycle_are_those_of_the_public_function():
    lower, upper = surfaces()
    fixed = setup()
    pressure = dry_contact(fixed)(lower + upper, None).pressure
    stack = von_mises_field(pressure, GRID, SOFT, DEPTHS, friction=0.16)
    particles = find_particles(stack, DEPTHS, GRID, yield_stress=0.64e9)
    result = run_in(lower, upper, cycles=1, model=WearModel(criterion=NO_SKIN), **ARGUMENTS)
    assert sorted(p.volume for p in particles) == pytest.approx(sorted(result.particles["volume"]), rel=1e-12, abs=0)
