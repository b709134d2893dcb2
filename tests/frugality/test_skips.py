"""What a scene does not need is not computed: each skip has a count that shows it and an equality that allows it."""

import subprocess
import sys

import numpy as np
import pytest
from mixed_case import STEEL, mixed_case

import bem.convolution as convolution
import bem.kernels.coefficients as coefficients
import bem.stress as stress
import bem.stress.request as stress_request
import bem.stress.spectra as stress_spectra
import bem.transforms as transforms
from bem import (
    Body,
    Grid,
    Layer,
    Lubricant,
    Material,
    displacement_operator,
    generate_surface,
    run_in,
    solve_contact,
    solve_mixed,
)
from bem.contact.solution import ContactSolution
from bem.convolution import set_spectra_memory
from bem.kernels.coefficients import Load
from bem.stress import set_stress_memory, subsurface_stress, von_mises, von_mises_field
from bem.wear import WearModel, WearSetup, dry_contact, yielded_pieces

DLC = Material("dlc", youngs_modulus=200e9, poissons_ratio=0.25)
SOFT = Body(Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9))
HARD = Body(Material("cylinder", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9))
GRID = Grid((36, 40), (100e-9, 100e-9), periodic=(False, True))
GAP = -generate_surface(GRID, rms_height=40e-9, correlation_length=0.5e-6, seed=5)
LOAD = 1e-3


@pytest.fixture(autouse=True)
def no_caches():
    """Every test starts without cached spectra, so that a kernel that is needed is also counted."""
    for forget, limit in ((set_spectra_memory, 1 << 29), (set_stress_memory, 1 << 29)):
        forget(0)
        forget(limit)
    convolution.COUNT.reset()
    stress.COUNT.reset()
    transforms.COUNT.reset()


def solved(bodies, friction=0.0, **change) -> ContactSolution:
    arguments = {"load": LOAD, "hardness": 6e9} | change
    return solve_contact(GAP, displacement_operator(GRID, bodies, friction=friction), **arguments)


@pytest.mark.internal
def test_no_friction_no_tangential_kernel_and_friction_of_unlike_bodies_needs_one():
    pair = (Body(STEEL), Body(DLC))
    without = solved(pair)
    grids = convolution.COUNT.normal
    assert convolution.COUNT.tangential == 0
    with_friction = solved(pair, friction=0.3)
    assert 0 < convolution.COUNT.tangential <= grids  # at most one a grid of the cascade: the check can fail
    assert np.abs(with_friction.pressure - without.pressure).max() > 1e-3 * without.pressure.max()


@pytest.mark.internal
def test_steel_on_steel_builds_no_coupling_kernel_and_gives_the_bits_of_no_friction():
    without = solved((Body(STEEL), Body(STEEL)))
    set_spectra_memory(0)  # nothing may come from a cache
    set_spectra_memory(1 << 29)
    with_friction = solved((Body(STEEL), Body(STEEL)), friction=0.3)
    assert convolution.COUNT.tangential == 0
    assert np.array_equal(with_friction.pressure, without.pressure)


@pytest.mark.internal
def test_two_homogeneous_bodies_need_one_kernel():
    operator = displacement_operator(GRID, (Body(STEEL), Body(DLC)))
    found = operator(np.full(GRID.shape, 1e8))
    assert convolution.COUNT.normal == 1
    apart = sum(displacement_operator(GRID, Body(m))(np.full(GRID.shape, 1e8)) for m in (STEEL, DLC))
    assert np.abs(found - apart).max() <= 1e-13 * np.abs(apart).max()  # round-off of a sum of two


@pytest.mark.internal
@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_without_a_coating_no_layered_kernel_is_computed(monkeypatch, periodic):
    def forbidden(*arguments, **keywords):
        raise AssertionError("a layered kernel was asked for")

    import bem.kernels.layered.frequency_response as frequency_response

    monkeypatch.setattr(frequency_response, "wave_frame_response", forbidden)
    monkeypatch.setattr(coefficients, "_layered", forbidden)
    grid = Grid((16, 16), (1e-6, 1e-6), periodic=periodic)
    pressure = np.full(grid.shape, 1e8)
    pressure[3, 4] = 3e8
    displacement_operator(grid, (Body(STEEL), Body(STEEL)), friction=0.2)(pressure)
    subsurface_stress(pressure, grid, Body(STEEL), [1e-6], friction=0.2)
    with pytest.raises(AssertionError, match="layered kernel"):
        displacement_operator(grid, Body(STEEL, layer=Layer(DLC, 1e-6)))(pressure)


def test_a_layer_of_the_base_material_is_computed_as_layered_and_agrees_with_the_skip():
    film = Body(STEEL, layer=Layer(Material("film", youngs_modulus=210e9, poissons_ratio=0.3), 2e-7))
    layered, plain = solved(film), solved(Body(STEEL))
    # two ways to the same kernel: layered coefficients hold to 1e-12, the contact is solved to 1e-8 of the roughness
    assert np.abs(layered.pressure - plain.pressure).max() <= 1e-5 * plain.pressure.max()


CASE = mixed_case(
    60,
    1.5e-6,
    6e-6,
    lubricant=Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
    boundary_friction=0.15,
)


@pytest.mark.internal
def test_friction_alone_computes_no_stress_and_no_coupling():
    point = solve_mixed(**CASE, speeds=(0.03, 0.0))
    assert 0 < point.contact_load < 5.5  # mixed: contact and film both matter
    assert (stress.COUNT.spectra, stress.COUNT.bounds) == (0, 0)
    assert convolution.COUNT.tangential == 0
    assert convolution.COUNT.normal > 0


def test_friction_alone_does_not_load_the_room_of_stresses():
    code = "import sys, bem.friction; print('bem.stress' in sys.modules, 'bem.wear' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


@pytest.mark.internal
def test_full_film_needs_no_transform_at_all():
    point = solve_mixed(**CASE, speeds=(0.6, 0.0))
    assert point.full_film
    assert (transforms.COUNT.forward, transforms.COUNT.inverse, transforms.COUNT.kernels) == (0, 0, 0)
    assert (convolution.COUNT.normal, convolution.COUNT.tangential) == (0, 0)


def test_full_film_is_what_the_sharing_finds_with_an_unmoved_contact():
    """The same speed with the rough contact solved at the film's volume: it carries nothing."""
    point = solve_mixed(**CASE, speeds=(0.6, 0.0))
    x = CASE["grid"].x
    film = np.interp(x, point.film.position, point.film.thickness)
    gap = film[:, None] - (CASE["height"] - CASE["height"].mean())
    contact = solve_contact(
        gap, displacement_operator(CASE["grid"], CASE["bodies"]), mean_gap=float(gap.mean()), hardness=6e9
    )
    assert contact.load == 0


def setup(**change):
    arguments = {
        "grid": GRID,
        "bodies": (SOFT, HARD),
        "gap": np.zeros(GRID.shape),
        "load": LOAD,
        "friction": 0.16,
        "depths": np.arange(24) * 95e-9,
    }
    return WearSetup(**(arguments | change))


@pytest.mark.internal
def test_wear_transforms_only_depths_that_can_still_yield_and_loses_no_piece():
    fixed = setup()
    pressure = dry_contact(fixed)(-GAP, None).pressure
    transforms.COUNT.reset()
    stress.COUNT.reset()
    found = yielded_pieces(pressure, fixed, WearModel(), 0)
    assert 2 <= found.depths_computed < fixed.depths.size / 2
    assert stress.COUNT.spectra == found.depths_computed
    # one transform of the pressure; five components a depth, not six
    assert (transforms.COUNT.forward, transforms.COUNT.inverse) == (1, 5 * found.depths_computed)
    # the rest, computed all the same, holds nothing that reaches the surface
    everything = von_mises_field(pressure, GRID, SOFT, fixed.depths, friction=0.16)
    quiet = everything[: found.depths_computed].max(axis=(1, 2))
    assert quiet[-2] <= fixed.yield_stress(0) or quiet[-1] <= fixed.yield_stress(0)
    assert found.pieces.count > 0


@pytest.mark.internal
def test_von_mises_alone_takes_five_transforms_a_depth_and_six_components_six():
    pressure = np.zeros(GRID.shape)
    pressure[10:20, 12:22] = 1e9
    depths = [1e-7, 3e-7, 8e-7]
    alone = von_mises_field(pressure, GRID, SOFT, depths, friction=0.2)
    assert (transforms.COUNT.forward, transforms.COUNT.inverse) == (1, 15)
    six = subsurface_stress(pressure, GRID, SOFT, depths, friction=0.2)
    assert (transforms.COUNT.forward, transforms.COUNT.inverse) == (2, 33)
    assert stress.COUNT.spectra == 3  # made once for both
    assert np.abs(alone - von_mises(six)).max() <= 1e-12 * alone.max()  # the same sums in another order


@pytest.mark.internal
def test_without_traction_no_tangential_stress_coefficient_is_evaluated(monkeypatch):
    asked = []
    inner = coefficients.stress_coefficients

    def counted(grid, body, depth, load):
        asked.append(load)
        return inner(grid, body, depth, load)

    monkeypatch.setattr(stress.spectra, "stress_coefficients", counted)
    pressure = np.full(GRID.shape, 1e8)
    still = subsurface_stress(pressure, GRID, SOFT, [1e-7])
    assert asked == [Load.NORMAL]
    vanishing = subsurface_stress(pressure, GRID, SOFT, [1e-7], friction=1e-300)
    assert asked == [Load.NORMAL, Load.NORMAL, Load.TANGENTIAL]
    assert np.array_equal(still, vanishing)


@pytest.mark.internal
def test_a_sweep_shares_spectra_and_plans():
    for load in (LOAD, 2 * LOAD, 3 * LOAD):
        solved((Body(STEEL), Body(STEEL)), load=load)
        if load == LOAD:
            made = convolution.COUNT.normal
            plans = transforms.transform_of(GRID.shape, (72, 40))
            kernels = transforms.COUNT.kernels
    assert convolution.COUNT.normal == made  # each grid of the cascade once, for all loads
    assert transforms.COUNT.kernels == kernels
    assert transforms.transform_of(GRID.shape, (72, 40)) is plans


@pytest.mark.internal
def test_a_shared_spectrum_gives_the_bits_of_a_fresh_one():
    first = solved((Body(STEEL), Body(STEEL)))
    cached = solved((Body(STEEL), Body(STEEL)))
    set_spectra_memory(0)
    set_spectra_memory(1 << 29)
    fresh = solved((Body(STEEL), Body(STEEL)))
    assert np.array_equal(first.pressure, cached.pressure)
    assert np.array_equal(first.pressure, fresh.pressure)


def test_a_next_cycle_starts_from_the_last_pressure_skips_coarse_grids_and_ends_at_the_same_contact():
    grid = Grid((128, 120), (100e-9, 100e-9), periodic=(False, True))  # large enough for coarser grids to pay
    gap = -generate_surface(grid, rms_height=40e-9, correlation_length=0.5e-6, seed=5)
    operator = displacement_operator(grid, SOFT)
    first = solve_contact(gap, operator, load=LOAD)
    little = gap.copy()
    little[first.pressure > 0] += 1e-10  # what a cycle removes, here and there
    cold = solve_contact(little, operator, load=LOAD)
    warm = solve_contact(little, operator, load=LOAD, initial_pressure=first.pressure)
    assert warm.convolutions < cold.convolutions
    assert warm.convolutions == int(warm.convolutions)  # whole applications: no coarse grid was visited
    assert cold.convolutions != int(cold.convolutions)
    # both are certified to 1e-8 of the roughness
    assert np.abs(warm.pressure - cold.pressure).max() <= 1e-5 * cold.pressure.max()
    assert warm.load == pytest.approx(cold.load, rel=1e-12)


def test_a_wear_loop_hands_each_cycle_the_pressure_of_the_last():
    starts, pressures = [], []
    fixed = setup()
    inner = dry_contact(fixed)

    def step(heights, start, compliance):
        starts.append(start.pressure)
        found = inner(heights, start)
        pressures.append(found.pressure)
        return found

    arguments = {"grid": GRID, "bodies": (SOFT, HARD), "load": LOAD, "depths": fixed.depths, "friction": 0.16}
    run_in(-GAP, np.zeros(GRID.shape), cycles=3, model=WearModel(shift=0), contact_step=step, **arguments)
    assert starts[0] is None
    assert np.array_equal(starts[1], pressures[0])
    assert np.array_equal(starts[2], pressures[1])


@pytest.mark.internal
def test_running_in_makes_kernels_once_for_all_cycles():
    lower, upper = -GAP, np.zeros(GRID.shape)
    made = []
    run_in(
        lower,
        upper,
        grid=GRID,
        bodies=(SOFT, HARD),
        load=LOAD,
        depths=np.arange(12) * 95e-9,
        friction=0.16,
        cycles=5,
        callback=lambda state: made.append((convolution.COUNT.normal, convolution.COUNT.tangential)),
    )
    assert made[0] == made[-1]
    assert made[0][1] == 0


def test_a_load_of_zero_and_a_gap_that_stays_open_need_no_convolution():
    operator = displacement_operator(GRID, Body(STEEL))
    nothing = solve_contact(GAP, operator, load=0.0)
    assert nothing.convolutions <= 1  # the certificate
    apart = solve_contact(GAP, operator, mean_gap=1.0)
    assert apart.load == nothing.load == 0
    assert (nothing.pressure == 0).all()


@pytest.mark.internal
def test_waves_that_do_not_reach_a_depth_are_not_transformed(monkeypatch):
    """On a periodic axis a wave falls like exp(-q z): at 30 cells down only a third of the wavenumbers are left."""
    grid = Grid((240, 240), (100e-9, 100e-9), periodic=(False, True))
    pressure = np.random.default_rng(3).random(grid.shape) * 1e9
    depths = np.array([0.0, 0.5e-6, 2e-6, 3e-6, 6e-6])

    def columns_and_stress():
        found = []
        for depth in depths:
            transforms.COUNT.reset()
            six = subsurface_stress(pressure, grid, SOFT, [depth], friction=0.2)[:, 0]
            found.append((transforms.COUNT.columns, six))
        return zip(*found, strict=True)

    columns, found = columns_and_stress()
    monkeypatch.setattr(stress_spectra, "_SIGNIFICANT", 0.0)
    set_stress_memory(0)
    set_stress_memory(1 << 29)
    every, expected = columns_and_stress()
    assert columns[:2] == every[:2] == (7 * 121, 7 * 121)  # of the pressure, and of six components
    # whole blocks of columns are left out
    assert columns[3] < 0.7 * every[3]
    assert columns[4] < 0.5 * every[4]
    for k in range(len(depths)):
        # the transforms round off as much
        np.testing.assert_allclose(found[k], expected[k], rtol=0, atol=1e-14 * np.abs(expected[k]).max())


@pytest.mark.internal
@pytest.mark.parametrize("stretch", [0.3, 1.0])
def test_waves_along_a_periodic_axis_are_padded_by_their_reach_alone(monkeypatch, stretch):
    """A wave falls like exp(-q x) along a free axis, too: fewer numbers are transformed, for the same bits but the
    last."""
    grid = Grid((120, 120), (100e-9, stretch * 100e-9), periodic=(False, True))
    pressure = np.random.default_rng(5).random(grid.shape) * 1e9
    pressure[30:90] = 0
    depths = np.array([0.0, 0.3e-6, 2e-6])
    coated = Body(SOFT.material, layer=Layer(DLC, 0.2e-6))

    def stresses(body):
        set_stress_memory(0)
        set_stress_memory(1 << 29)
        transforms.COUNT.reset()
        found = subsurface_stress(pressure, grid, body, depths, friction=0.2)
        return found, transforms.COUNT.numbers

    found, numbers = stresses(SOFT)
    layered, under_layers = stresses(coated)
    for room in (stress_spectra, stress_request):
        monkeypatch.setattr(room, "column_lengths", lambda grid, body: None)
    whole, most = stresses(SOFT)
    assert numbers < {0.3: 0.64, 1.0: 0.75}[stretch] * most
    # of the largest stress, as the transforms round off
    assert np.abs(found - whole).max(axis=(0, 2, 3)) == pytest.approx(0, abs=4e-15 * np.abs(whole).max())
    np.testing.assert_array_equal(stresses(coated)[0], layered)  # may fall more slowly: padded as ever
    assert under_layers > numbers


@pytest.mark.internal
def test_tractions_at_many_depths_take_one_field_each_to_be_added_from(monkeypatch):
    made = []
    real = transforms.PaddedTransform.empty_field
    monkeypatch.setattr(transforms.PaddedTransform, "empty_field", lambda self: made.append(1) or real(self))
    rng = np.random.default_rng(4)
    subsurface_stress(rng.random(GRID.shape), GRID, SOFT, np.arange(6) * 1e-7, traction=rng.random((2, *GRID.shape)))
    assert len(made) == 2
