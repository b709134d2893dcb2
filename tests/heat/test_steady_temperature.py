"""Steady surface temperature against quadrature and closed forms, over Peclet numbers, edges and pairs."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import k0e
from unit_body import UNIT, body

from bem import Body, Grid, InputError, Layer, Material, Status, flash_temperature, surface_temperature
from bem.heat.coefficients import TransverseBasis, temperature_table
from bem.notes.heat import SURFACE_HOT
from bem.reference_solutions import heat_sources
from bem.verification.patches import disc_means, free_grid


def square(cells, peclet, **options):
    grid = Grid((cells, cells), (2 / cells, 2 / cells))
    return surface_temperature(np.ones(grid.shape), grid, UNIT, speeds=2 * peclet, **options)


def disc(cells, peclet, profile):
    where = free_grid(1 / cells, (-1.0, 1.0), (-1.0, 1.0))
    heat = disc_means(where, profile)
    return surface_temperature(heat, where.grid, UNIT, speeds=2 * peclet)


@pytest.mark.internal
@pytest.mark.parametrize("wavenumber", [0.0, 1e-13, 0.3, 60.0, 1000.0])
def test_a_cell_is_the_integral_of_moving_point_sources(wavenumber):
    """Another integral than the production's: over the cell, of exp(-w (r - x)) / (2 pi r)."""
    cells, across = 9, 0.7
    table = temperature_table(cells, 1.0, TransverseBasis(6, across, False), wavenumber, 0.0, math.inf)
    random = np.random.default_rng(11)
    offsets = [(random.integers(-8, 9), random.integers(1, 6)) for _ in range(3)] + [(1, 0), (-1, 0)]

    def source(x, y):
        r = mpmath.hypot(x, y)
        return mpmath.exp(-wavenumber * (r - x)) / (2 * mpmath.pi * r)

    for i, j in offsets:
        x, y = float(i), j * across
        exact = mpmath.quad(source, [x - 0.5, x, x + 0.5], [y - across / 2, y, y + across / 2])
        # 1e-14 are measured; quadrature of the narrow wakes of fast sources is what is left
        assert abs(table[cells - 1 + i, j] - exact) < 1e-11 * table.max()


@pytest.mark.internal
def test_a_cell_at_rest_is_the_potential_of_a_rectangle():
    table = temperature_table(7, 2.0, TransverseBasis(5, 0.3, False), 0.0, 0.0, math.inf)
    x, y = 2.0 * np.arange(-6, 7)[:, None], 0.3 * np.arange(5)
    exact = heat_sources.rectangle_at_rest(x, y, (1.0, 0.15))
    assert np.abs(table - exact).max() < 1e-13 * exact.max()


@pytest.mark.parametrize("peclet", [0.01, 1.0, 30.0, 1000.0, 1e5])
def test_band_of_jaeger(peclet):
    """Uniform heat is represented exactly on cells, so round-off is what is left."""
    grid = Grid((64, 2), (2 / 64, 1.0), periodic=(False, True))
    found = surface_temperature(np.ones(grid.shape), grid, UNIT, speeds=2 * peclet).temperature[:, 0]
    exact = heat_sources.moving_band(grid.x, peclet)
    assert np.abs(found - exact).max() < 1e-9 * exact.max()


def test_fast_band_is_blok_and_jaegers_limit():
    """Axial conduction is lost like 1/Peclet at the edges: 1e-3 of the maximum at 1000."""
    grid = Grid((400, 1), (2 / 400, 1.0), periodic=(False, True))
    found = surface_temperature(np.ones(grid.shape), grid, UNIT, speeds=2e4)
    assert found.maximum * 100 == pytest.approx(heat_sources.FAST_MAXIMUM, rel=1e-3)
    assert found.mean * 100 == pytest.approx(heat_sources.FAST_MEAN, rel=1e-3)
    # with sqrt(kappa / (U a)) for a length: the 1.064 of Jaeger's mean
    assert found.mean * math.sqrt(2e4) == pytest.approx(1.064, rel=2e-3)


@pytest.mark.parametrize("wave", [1, 3])
def test_waves_across_the_motion_on_a_periodic_axis_are_exact(wave):
    """A band whose flux varies like cos(q y) has the kernel exp(w x) K0(|x| sqrt(w^2 + q^2)) / pi."""
    grid = Grid((20, 16), (0.1, 0.2), periodic=(False, True))
    speed, q = 5.0, 2 * math.pi * wave / grid.lengths[1]
    heat = np.cos(q * grid.y)[None, :] * np.ones((20, 1))
    found = surface_temperature(heat, grid, UNIT, speeds=speed).temperature
    w = speed / 2
    b = math.hypot(w, q)

    def kernel(u):
        return math.exp(w * u - b * abs(u)) * k0e(b * abs(u)) / math.pi

    for i in (0, 7, 19):
        x = grid.x[i]
        parts = [quad(kernel, x - 1, 0, epsabs=0, epsrel=1e-11)[0], quad(kernel, 0, x + 1, epsabs=0, epsrel=1e-11)[0]]
        assert np.abs(found[i] - sum(parts) * np.cos(q * grid.y)).max() < 1e-9 * abs(found).max()


def test_patches_at_rest_have_their_closed_maxima_and_means():
    found = square(64, 0.0)
    assert found.maximum == pytest.approx(heat_sources.SQUARE_MAXIMUM, rel=2e-4)  # the middle is a corner of cells
    assert found.mean == pytest.approx(heat_sources.SQUARE_MEAN, rel=3e-4)
    found = disc(40, 0.0, "uniform")
    assert found.maximum == pytest.approx(heat_sources.DISC_MAXIMUM, rel=3e-4)
    assert found.mean == pytest.approx(heat_sources.DISC_MEAN, rel=1e-3)
    assert disc(40, 0.0, "hertz").maximum == pytest.approx(heat_sources.HERTZ_MAXIMUM, rel=3e-4)


def test_second_order_in_the_cell():
    errors = [abs(square(n, 3.0).mean - square(256, 3.0).mean) for n in (16, 32, 64)]
    exact = heat_sources.SQUARE_MAXIMUM
    centre = [abs(square(n, 0.0).maximum / exact - 1) for n in (16, 32, 64)]
    for coarse, fine in itertools.pairwise(centre):
        assert 3.8 < coarse / fine < 4.2
    assert errors[0] > 2.5 * errors[1] > 2.5 * 2.5 * errors[2]  # means sample the edges' singular slopes


@pytest.mark.parametrize("peclet", [0.0, 0.1, 1.0, 10.0, 100.0, 1000.0])
def test_interpolations_of_tian_and_kennedy(peclet):
    """Exact at both ends by construction; between them up to 4 % off (measured at Peclet 1, the disc's mean)."""
    uniform, hertz = disc(40, peclet, "uniform"), disc(40, peclet, "hertz")
    for found, patch in (
        (uniform.maximum, "disc maximum"),
        (uniform.mean, "disc mean"),
        (square(64, peclet).maximum, "square maximum"),
        (1.5 * hertz.maximum, "hertz maximum"),
    ):
        assert found == pytest.approx(heat_sources.tian_kennedy(patch, peclet), rel=0.05)


def test_motion_the_other_way_mirrors_the_map():
    grid = Grid((12, 8), (0.1, 0.2))
    heat = np.random.default_rng(5).random(grid.shape)
    there = surface_temperature(heat, grid, (UNIT, body(3.0)), speeds=(2.0, -7.0)).temperature
    back = surface_temperature(heat[::-1], grid, (UNIT, body(3.0)), speeds=(-2.0, 7.0)).temperature
    assert np.abs(there - back[::-1]).max() < 1e-7 * there.max()


def test_units_do_not_matter():
    """The same contact in millimetres and milliseconds; powers of two change no digit."""
    grid, small = Grid((10, 6), (0.1, 0.2)), Grid((10, 6), (0.1 / 1024, 0.2 / 1024))
    heat = np.random.default_rng(6).random(grid.shape)
    one = surface_temperature(heat, grid, UNIT, speeds=3.0).temperature
    other = surface_temperature(1024 * heat, small, UNIT, speeds=3.0 * 1024).temperature
    assert np.abs(one - other).max() < 1e-12 * one.max()


# pairs ---------------------------------------------------------------------------------------------------------------


def spot(cells=24):
    grid = Grid((cells, cells), (2.4 / cells, 2.4 / cells))
    heat = np.sqrt(np.maximum(0.0, 1 - grid.x[:, None] ** 2 - grid.y**2))
    return heat, grid


def check_pair(found, heat, grid, bodies, speeds, bulk=(0.0, 0.0), tolerance=1e-8):
    """Recomputed from the heat alone: energy is kept, both surfaces are equally hot where heat is made."""
    made = heat != 0
    assert np.array_equal(found.heat[0][~made], np.zeros((~made).sum()))
    assert np.abs(found.heat.sum(axis=0) - heat).max() <= 1e-15 * np.abs(found.heat).max()
    first, second = (
        surface_temperature(into, grid, one, speeds=speed, bulk=b).temperature
        for into, one, speed, b in zip(found.heat, bodies, speeds, bulk, strict=True)
    )
    scale = max(np.abs(first - bulk[0]).max(), np.abs(second - bulk[1]).max(), abs(bulk[1] - bulk[0]))
    assert np.abs(first - second)[made].max() <= 1.01 * tolerance * scale
    assert np.abs(found.temperature - first)[made].max() <= 1.01 * tolerance * scale
    assert found.residual <= tolerance
    assert found.status is Status.CONVERGED


def test_equal_bodies_share_equally_and_a_pair_at_rest_by_conductivity():
    heat, grid = spot()
    assert np.array_equal(surface_temperature(heat, grid, (UNIT, UNIT), speeds=(5.0, 5.0)).partition, 0.5 + 0 * heat)
    found = surface_temperature(heat, grid, (UNIT, body(3.0)), speeds=(0.0, 0.0))
    assert np.abs(found.partition - 0.25).max() < 1e-6
    assert found.share == pytest.approx(0.25, rel=1e-8)


def test_all_heat_goes_where_it_is_conducted():
    heat, grid = spot()
    found = surface_temperature(heat, grid, (UNIT, body(1e-9, capacity=1e-9)), speeds=(4.0, 4.0))
    assert found.share == pytest.approx(1.0, abs=1e-8)
    alone = surface_temperature(heat, grid, UNIT, speeds=4.0)
    assert found.maximum == pytest.approx(alone.maximum, rel=1e-7)


def test_fast_pairs_share_by_their_effusivities():
    """Blok: without conduction along the surface, share / sqrt(k rho c U) is the same of both bodies, everywhere."""
    heat, grid = spot()
    bodies, speeds = (body(2.0, 3.0), body(1.0, 1.0)), (2e5, 1e5)
    found = surface_temperature(heat, grid, bodies, speeds=speeds)
    first, second = math.sqrt(2 * 3 * 2e5), math.sqrt(1e5)
    assert found.share == pytest.approx(first / (first + second), rel=1e-4)
    check_pair(found, heat, grid, bodies, speeds)


@settings(max_examples=25, deadline=None)
@given(
    speeds=st.tuples(st.floats(-2000.0, 2000.0), st.floats(-2000.0, 2000.0)),
    conductivity=st.floats(1e-3, 1e3),
    bulk=st.tuples(st.floats(0.0, 2.0), st.floats(0.0, 2.0)),
    periodic=st.booleans(),
    seed=st.integers(0, 1000),
)
def test_any_pair_converges_and_says_so_truthfully(speeds, conductivity, bulk, periodic, seed):
    grid = Grid((16, 12), (0.15, 0.2), periodic=(False, periodic))
    random = np.random.default_rng(seed)
    heat = random.random(grid.shape) * (random.random(grid.shape) < 0.4)
    heat[3, 3] = 1.0
    if periodic:
        speeds = tuple(speed if abs(speed) > 1e-3 else 1e-3 for speed in speeds)
    bodies = (UNIT, body(conductivity))
    found = surface_temperature(heat, grid, bodies, speeds=speeds, bulk=bulk)
    check_pair(found, heat, grid, bodies, speeds, bulk)
    assert found.iterations <= 120  # some ten to forty are seen


def test_few_iterations_whatever_the_grid():
    counts = []
    for cells in (32, 64, 128):
        heat, grid = spot(cells)
        counts.append(surface_temperature(heat, grid, (UNIT, body(40.0)), speeds=(10.0, 200.0)).iterations)
    assert max(counts) <= 40


def test_bulk_temperatures_raise_the_surface():
    heat, grid = spot()
    bodies, speeds = (UNIT, body(3.0)), (1.0, 20.0)
    cold = surface_temperature(heat, grid, bodies, speeds=speeds)
    warm = surface_temperature(heat, grid, bodies, speeds=speeds, bulk=(300.0, 300.0))
    assert np.abs(warm.temperature - 300.0 - cold.temperature).max() < 1e-7
    assert warm.maximum == pytest.approx(300 + cold.maximum, abs=1e-7)
    unequal = surface_temperature(heat, grid, bodies, speeds=speeds, bulk=(1.0, 2.0))
    check_pair(unequal, heat, grid, bodies, speeds, (1.0, 2.0))
    assert unequal.share > cold.share  # the colder body takes more


def test_no_heat_is_bulk_temperature():
    grid = Grid((4, 4), (0.1, 0.1))
    found = surface_temperature(np.zeros((4, 4)), grid, (UNIT, UNIT), speeds=(1.0, 2.0), bulk=(300.0, 310.0))
    assert (found.surfaces[0] == 300).all()
    assert (found.surfaces[1] == 310).all()
    assert found.status is Status.CONVERGED


STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
COATED = Body(UNIT.material, layer=Layer(STEEL, 1e-6))


@pytest.mark.parametrize(
    ("bodies", "options", "words"),
    [
        (Body(STEEL), {"speeds": 1.0}, ["thermal_conductivity", "density", "heat_capacity"]),
        (COATED, {"speeds": 1.0}, ["layer of steel", "density", "heat_capacity"]),
        ((UNIT, COATED), {"speeds": (1.0, 1.0)}, ["body 2", "density", "heat_capacity"]),
        (UNIT, {"speeds": (1.0, 2.0)}, ["speeds"]),
        ((UNIT, UNIT), {"speeds": 1.0}, ["2 finite numbers"]),
        ((UNIT, UNIT), {"speeds": (1.0, math.nan)}, ["speeds"]),
        ((UNIT, UNIT), {"speeds": (1.0, 1.0), "bulk": "20 C"}, ["bulk"]),
        ((UNIT, UNIT, UNIT), {"speeds": (1.0, 1.0)}, ["a Body or a pair"]),
        ("steel", {"speeds": 1.0}, ["a Body or a pair"]),
        (UNIT, {"speeds": 1.0, "tolerance": 0.0}, ["tolerance"]),
    ],
)
def test_each_mistake_has_its_message(bodies, options, words):
    grid = Grid((4, 4), (0.1, 0.1))
    with pytest.raises(InputError) as raised:
        surface_temperature(np.ones((4, 4)), grid, bodies, **options)
    assert len(raised.value.messages) == len(words)
    for message, word in zip(raised.value.messages, words, strict=True):
        assert word in message


@pytest.mark.parametrize(
    ("periodic", "speed"), [((True, True), 0.0), ((True, True), 5.0), ((True, False), 5.0), ((False, True), 0.0)]
)
def test_what_has_no_steady_temperature_is_refused_with_a_way_out(periodic, speed):
    grid = Grid((4, 4), (0.1, 0.1), periodic=periodic)
    with pytest.raises(InputError, match="surface_temperature_history"):
        surface_temperature(np.ones((4, 4)), grid, UNIT, speeds=speed)


@pytest.mark.parametrize(
    ("bulk", "scale", "reason"),
    [
        (0.0, 10.0, None),
        (0.0, 1e4, "rise"),
        (293.15, 1e3, "transforms"),
        (293.15, 200.0, "softens"),
        (293.15, 10.0, None),
        (600.0, 1.0, "bulk"),
    ],
)
def test_temperatures_that_no_material_stands_are_said(bulk, scale, reason):
    grid = Grid((8, 8), (0.25, 0.25))
    found = surface_temperature(scale * np.ones((8, 8)), grid, UNIT, speeds=0.0, bulk=bulk)
    reasons = [] if reason is None else [reason]
    assert [(note.code, note.values["reason"]) for note in found.notes] == [(SURFACE_HOT.code, one) for one in reasons]
    expected = {"rise": found.maximum, "bulk": bulk - 273.15, "limit": 300.0, "temperature": found.maximum - 273.15}
    for note in found.notes:
        numbers = {name: value for name, value in note.values.items() if name != "reason"}
        assert numbers == pytest.approx({name: expected[name] for name in numbers})


def test_flash_temperature_is_that_of_the_heat_of_friction():
    pressure, grid = spot(12)
    bodies = (UNIT, body(3.0))
    friction = 0.1 + 0.1 * np.random.default_rng(1).random(grid.shape)
    found = flash_temperature(pressure, grid, bodies, friction=friction, speeds=(1.0, -2.0))
    heat = surface_temperature(3 * friction * pressure, grid, bodies, speeds=(1.0, -2.0))
    assert np.allclose(found.temperature, heat.temperature, rtol=1e-12)
    alone = flash_temperature(pressure, grid, UNIT, friction=-0.5, speeds=(0.0, 2.0))
    assert np.allclose(alone.temperature, surface_temperature(pressure, grid, UNIT, speeds=0.0).temperature, rtol=1e-12)
    for mistake in ({"friction": 0.1, "speeds": 1.0}, {"friction": np.ones(3), "speeds": (1.0, 2.0)}):
        with pytest.raises(InputError, match="flash_temperature"):
            flash_temperature(pressure, grid, bodies, **mistake)
