"""The displacement operator: against direct sums, what it shares, what it skips."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import convolution, transforms
from bem.convolution import displacement_operator
from bem.errors import InputError
from bem.grid import Grid
from bem.kernels.coefficients import Load, surface_coefficients
from bem.kernels.spectral import surface_response
from bem.materials import Body, Layer, Material

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
BRASS = Material("brass", youngs_modulus=88e9, poissons_ratio=0.35)
PERIODICITY = [(False, False), (True, False), (False, True)]


@pytest.fixture(autouse=True)
def _fresh_cache():
    convolution.set_spectra_memory(0)
    convolution.set_spectra_memory(1 << 29)
    convolution.COUNT.reset()


def direct(grid, bodies, friction, pressure):
    """Sum over all pairs of cells, straight from the coefficients of either body."""
    i, j = np.indices(grid.shape).reshape(2, -1)
    di, dj = i[:, None] - i[None, :], j[:, None] - j[None, :]
    sign = np.sign(di)
    if grid.periodic[0]:
        di = di % grid.shape[0]
        sign = np.ones_like(di)
    if grid.periodic[1]:
        dj = dj % grid.shape[1]
    index = np.abs(di), np.abs(dj)
    matrix = sum(surface_coefficients(grid, body, Load.NORMAL) for body in bodies)[index]
    if friction:
        shear = surface_coefficients(grid, bodies[0], Load.TANGENTIAL)
        if len(bodies) == 2:
            shear = shear - surface_coefficients(grid, bodies[1], Load.TANGENTIAL)
        matrix = matrix + friction * sign * shear[index]
    return (matrix @ pressure.ravel()).reshape(grid.shape)


@pytest.mark.internal
@pytest.mark.parametrize("periodic", PERIODICITY)
@pytest.mark.parametrize("bodies", [(Body(STEEL),), (Body(STEEL), Body(BRASS)), (Body(BRASS), Body(STEEL))])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_direct_sums(periodic, bodies, friction):
    grid = Grid((9, 14), (1e-6, 3e-6), periodic=periodic)
    pressure = np.random.default_rng(0).uniform(0, 1e9, grid.shape)
    expected = direct(grid, bodies, friction, pressure)
    found = displacement_operator(grid, bodies if len(bodies) > 1 else bodies[0], friction=friction)(pressure)
    assert np.abs(found - expected).max() <= 1e-13 * np.abs(expected).max()  # round-off of a sum over 126 cells


@pytest.mark.internal
@pytest.mark.parametrize("shape", [(8, 10), (9, 7), (1, 12), (12, 1)])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_doubly_periodic_waves_come_out_as_waves(shape, friction):
    grid = Grid(shape, (1e-6, 2e-6), periodic=(True, True))
    bodies = (Body(STEEL), Body(BRASS))
    op = displacement_operator(grid, bodies, friction=friction)
    kx, ky = grid.wavevectors()
    normal = sum(surface_response(grid, body, Load.NORMAL) for body in bodies)
    shear = surface_response(grid, bodies[0], Load.TANGENTIAL) - surface_response(grid, bodies[1], Load.TANGENTIAL)
    x, y = np.arange(shape[0])[:, None] * 1e-6, np.arange(shape[1])[None, :] * 2e-6
    for i, j in ((1 % shape[0], 0), (0, 1 % (shape[1] // 2 + 1)), (2 % shape[0], 1 % (shape[1] // 2 + 1))):
        phase = kx[i, 0] * x + ky[0, j] * y
        expected = normal[i, j] * np.cos(phase) - friction * shear[i, j] * np.sin(phase)
        assert np.abs(op(np.cos(phase)) - expected).max() <= 1e-13 * np.abs(normal).max()
    assert abs(op(np.ones(shape))).max() <= 1e-15 * np.abs(normal).max()  # a mean pressure moves the datum only


@pytest.mark.internal
def test_steel_on_steel_never_builds_a_coupling_kernel():
    grid = Grid((8, 8), (1e-6, 1e-6))
    op = displacement_operator(grid, (Body(STEEL), Body(STEEL)), friction=0.4)
    assert op.symmetric
    assert convolution.COUNT.tangential == 0
    pressure = np.random.default_rng(1).uniform(0, 1, grid.shape)
    expected = direct(grid, (Body(STEEL), Body(STEEL)), 0.4, pressure)  # the same answer with it
    assert np.abs(op(pressure) - expected).max() <= 1e-13 * np.abs(expected).max()
    displacement_operator(grid, (Body(STEEL), Body(BRASS)), friction=0.4)(pressure)
    assert convolution.COUNT.tangential == 1


@pytest.mark.internal
def test_no_friction_builds_no_coupling_kernel():
    displacement_operator(Grid((8, 8), (1e-6, 1e-6)), (Body(STEEL), Body(BRASS)))(np.ones((8, 8)))
    assert convolution.COUNT.tangential == 0


@pytest.mark.internal
def test_two_homogeneous_bodies_cost_one_kernel():
    displacement_operator(Grid((8, 8), (1e-6, 1e-6)), (Body(STEEL), Body(BRASS)))(np.ones((8, 8)))
    assert convolution.COUNT.normal == 1


@pytest.mark.internal
def test_equal_layered_bodies_do_not_couple_and_different_ones_do():
    coated = Body(STEEL, layer=Layer(BRASS, 1e-6))
    assert not convolution.couples((coated, Body(STEEL, layer=Layer(BRASS, 1e-6))))
    assert convolution.couples((coated, Body(STEEL)))
    assert convolution.couples((coated,))


@pytest.mark.internal
def test_operators_share_spectra_and_forget_within_bounds():
    grid = Grid((32, 32), (1e-6, 1e-6))
    first = displacement_operator(grid, Body(STEEL))
    first(np.ones((32, 32)))
    hard = Material("the same, hard", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
    displacement_operator(grid, Body(hard))(np.ones((32, 32)))
    assert convolution.COUNT.normal == 1
    size = convolution.spectra_memory()
    assert size == 33 * 33 * 8  # a quarter of the padded spectrum, in reals
    convolution.set_spectra_memory(3 * size)
    for k in range(2, 9):
        displacement_operator(Grid((32, 32), (k * 1e-6, 1e-6)), Body(STEEL))(np.ones((32, 32)))
        assert convolution.spectra_memory() <= 3 * size


@pytest.mark.internal
def test_one_transform_each_way_with_and_without_friction():
    grid = Grid((20, 12), (1e-6, 1e-6))
    for friction in (0.0, 0.3):
        op = displacement_operator(grid, (Body(STEEL), Body(BRASS)), friction=friction)
        op(np.ones(grid.shape))
        transforms.COUNT.reset()
        op(np.ones(grid.shape))
        assert (transforms.COUNT.forward, transforms.COUNT.inverse, transforms.COUNT.kernels) == (1, 1, 0)
        assert transforms.COUNT.rows == 2 * 20  # only the rows that are not padding
        assert op.count.applications == 2


@pytest.mark.internal
def test_near_field_is_the_kernel():
    grid = Grid((16, 16), (1e-6, 2e-6))
    op = displacement_operator(grid, Body(STEEL), friction=0.2)
    near = op.near_field(3) * op.unit
    expected = surface_coefficients(grid, Body(STEEL), Load.NORMAL)[:4, :4]
    assert np.abs(near[3:, 3:] - expected).max() <= 1e-14 * expected.max()
    assert np.abs(near[3::-1, 3::-1] - expected).max() <= 1e-14 * expected.max()


def test_single_precision_twin_and_the_operator_without_friction():
    grid = Grid((24, 18), (1e-6, 1e-6))
    op = displacement_operator(grid, Body(STEEL), friction=0.5)
    pressure = np.random.default_rng(2).uniform(0, 1, grid.shape)
    single = op.scaled(np.float32).apply(pressure.astype(np.float32), np.empty(grid.shape, np.float32))
    exact = op.scaled().apply(pressure, np.empty(grid.shape))
    assert np.abs(single - exact).max() <= 2e-6 * np.abs(exact).max()  # single precision, 432 terms
    symmetric = op.frictionless.scaled().apply(pressure, np.empty(grid.shape)) * op.unit
    expected = displacement_operator(grid, Body(STEEL))(pressure)
    assert np.abs(symmetric - expected).max() <= 1e-14 * np.abs(expected).max()


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_symmetry_is_known_without_spectra(friction):
    op = displacement_operator(Grid((8, 8), (1e-6, 1e-6)), Body(STEEL), friction=friction)
    assert op.symmetric == (friction == 0)
    assert convolution.COUNT.normal == convolution.COUNT.tangential == 0


def test_the_operator_without_friction_has_the_even_part_of_given_spectra():
    """Spectra of a kernel twice as soft as the bodies, with an odd part: without it, twice their displacement."""
    grid = Grid((12, 10), (1e-6, 1e-6))
    plain = displacement_operator(grid, Body(STEEL))
    rubbed = displacement_operator(grid, Body(STEEL), friction=0.5)

    def twice(other):
        assert other == grid
        return convolution.KernelSpectra(2 * rubbed._spectra.even, 2 * rubbed._spectra.odd, rubbed.unit)

    op = replace(plain, spectra_on=twice)
    assert not op.symmetric
    assert op.frictionless.symmetric
    assert op.frictionless.count is op.count
    pressure = np.random.default_rng(3).uniform(0, 1, grid.shape)
    expected = 2 * plain(pressure)
    assert np.abs(op.frictionless(pressure) - expected).max() <= 1e-14 * np.abs(expected).max()
    assert np.abs(op(pressure) - expected).max() > 0.01 * np.abs(expected).max()


@pytest.mark.parametrize("shape", [(12, 15), (15, 12), (1, 12), (12, 1)])
@pytest.mark.parametrize("friction", [0.0, -2.0])
def test_inverse_on_a_doubly_periodic_grid(shape, friction):
    grid = Grid(shape, (1e-6, 1e-6), periodic=(True, True))
    op = displacement_operator(grid, Body(STEEL), friction=friction)
    pressure = np.random.default_rng(3).standard_normal(grid.shape)
    pressure -= pressure.mean()
    there = op.scaled().apply(pressure, np.empty(grid.shape))
    back = op.scaled_inverse().apply(there, np.empty(grid.shape))
    assert np.abs(back - pressure).max() <= 1e-13


def test_coarser_operators_cover_the_same_rectangle():
    op = displacement_operator(Grid((64, 45), (1e-6, 1e-6), periodic=(False, True)), Body(STEEL))
    coarse = op.coarsened()
    assert coarse.grid.shape == (32, 23)
    assert coarse.grid.lengths == pytest.approx((64e-6, 45e-6))
    assert coarse is op.coarsened()
    coarse(np.ones(coarse.grid.shape))
    assert op.count.weighted == pytest.approx(32 * 23 / (64 * 45))
    assert displacement_operator(Grid((8, 8), (1, 1)), Body(STEEL)).coarsened() is None


@pytest.mark.parametrize(
    ("grid", "bodies", "friction", "word"),
    [
        (None, Body(STEEL), 0.0, "Grid"),
        (Grid((4, 4), (1, 1)), STEEL, 0.0, "bodies"),
        (Grid((4, 4), (1, 1)), (Body(STEEL),) * 3, 0.0, "bodies"),
        (Grid((4, 4), (1, 1)), Body(STEEL), np.nan, "friction"),
        (Grid((4, 4), (1, 1)), Body(STEEL), "much", "friction"),
    ],
)
def test_bad_input_is_refused(grid, bodies, friction, word):
    with pytest.raises(InputError, match=word):
        displacement_operator(grid, bodies, friction=friction)


@pytest.mark.parametrize("pressure", [np.ones((4, 5)), np.full((4, 4), np.nan), np.ones((4, 4), complex)])
def test_bad_pressures_are_refused(pressure):
    with pytest.raises(InputError, match="pressure"):
        displacement_operator(Grid((4, 4), (1, 1)), Body(STEEL))(pressure)


@settings(deadline=None, max_examples=25)
@given(
    nx=st.integers(1, 9),
    ny=st.integers(1, 9),
    modulus=st.floats(1e3, 1e12),
    size=st.floats(1e-9, 1.0),
    periodic=st.tuples(st.booleans(), st.booleans()),
)
def test_linear_symmetric_and_free_of_units(nx, ny, modulus, size, periodic):
    material = Material("any", youngs_modulus=modulus, poissons_ratio=0.3)
    op = displacement_operator(Grid((nx, ny), (size, 2 * size), periodic=periodic), Body(material))
    unit = displacement_operator(
        Grid((nx, ny), (1, 2), periodic=periodic), Body(Material("unit", youngs_modulus=1, poissons_ratio=0.3))
    )
    a, b = np.random.default_rng(nx * 10 + ny).standard_normal((2, nx, ny))
    ua, ub = op(a), op(b)
    scale = np.abs(ua).max() + np.abs(ub).max()
    assert np.vdot(b, ua) == pytest.approx(np.vdot(a, ub), abs=1e-12 * scale * nx * ny)
    assert np.abs(op(a + b) - ua - ub).max() <= 1e-13 * scale
    if not any(periodic):  # the datum of a half-periodic kernel is a length of its own
        assert np.abs(ua * modulus / size - unit(a)).max() <= 1e-11 * np.abs(unit(a)).max() + 1e-300


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_a_compliance_of_each_place_adds_its_own_pressure(periodic):
    grid = Grid((20, 24), (1e-6, 2e-6), periodic=periodic)
    body = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
    pressure = np.random.default_rng(5).random(grid.shape) * 1e9
    give = 3e-18 if all(periodic) else 3e-17
    plain, soft = displacement_operator(grid, body), displacement_operator(grid, body, compliance=give)
    own = pressure - pressure.mean() if all(periodic) else pressure
    expected = plain(pressure) + give * own
    assert np.allclose(soft(pressure), expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    assert soft.coarsened() is None or soft.coarsened().compliance == give
    with pytest.raises(InputError, match="compliance"):
        displacement_operator(grid, body, compliance=-1.0)


def test_without_friction_the_compliance_stays():
    grid = Grid((20, 24), (1e-6, 2e-6))
    pair = (Body(STEEL), Body(Material("soft", youngs_modulus=5e9, poissons_ratio=0.2)))
    pressure = np.random.default_rng(6).random(grid.shape) * 1e9
    rubbed = displacement_operator(grid, pair, friction=0.3, compliance=3e-17)
    expected = displacement_operator(grid, pair, compliance=3e-17)(pressure)
    assert not np.array_equal(rubbed(pressure), expected)
    assert np.array_equal(rubbed.frictionless(pressure), expected)


def test_moduli_are_of_plane_strain_and_of_the_layer_for_short_waves_alone():
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    soft = Material("soft", youngs_modulus=20e9, poissons_ratio=0.4)
    grid = Grid((16, 16), (1e-6, 1e-6))
    pair = displacement_operator(grid, (Body(steel), Body(soft)))
    of_both = 1 / ((1 - 0.3**2) / 210e9 + (1 - 0.4**2) / 20e9)
    assert pair.contact_modulus == pytest.approx(of_both, rel=1e-14)
    assert pair.modulus_at(2e6) == pytest.approx(of_both, rel=1e-12)
    coated = displacement_operator(grid, Body(steel, layer=Layer(soft, 1e-6)))
    assert coated.contact_modulus == pytest.approx(20e9 / (1 - 0.4**2), rel=1e-14)
    assert coated.modulus_at(40e6) == pytest.approx(20e9 / (1 - 0.4**2), rel=1e-12)  # exp(-2 q h) is left of the base
    assert coated.modulus_at(1.0) == pytest.approx(210e9 / (1 - 0.3**2), rel=1e-4)  # q h of the layer's part


@pytest.mark.parametrize("moved", [copy.deepcopy, lambda operator: pickle.loads(pickle.dumps(operator))])
def test_an_operator_that_was_moved_counts_its_own_with_its_coarser_ones(moved):
    operator = displacement_operator(Grid((64, 64), (1.0, 1.0)), Body(STEEL), friction=0.1)
    operator(np.ones((64, 64)))
    operator.coarsened()(np.ones((32, 32)))
    other = moved(operator)
    assert other == operator
    assert (other.count.applications, other.count.weighted) == (0, 0.0)
    other(np.ones((64, 64)))
    other.coarsened()(np.ones((32, 32)))
    other.frictionless(np.ones((64, 64)))
    assert (other.count.applications, other.count.weighted) == (3, 2.25)
    assert (operator.count.applications, operator.count.weighted) == (2, 1.25)


def test_each_thread_is_told_its_own_applications():
    operator = displacement_operator(Grid((64, 64), (1.0, 1.0)), Body(STEEL))
    operator(np.ones((64, 64)))

    def beside():
        before = operator.count.applications
        operator(np.ones((64, 64)))
        return before, operator.count.applications

    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(beside).result() == (0, 1)
    assert operator.count.applications == 1
