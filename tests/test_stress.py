"""Subsurface stress: against direct sums, Hertz (Hamilton), McEwen; transforms counted; the bound never violated."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bem.stress as room
from bem import Body, Grid, InputError, Layer, Material, subsurface_stress, von_mises
from bem.kernels.coefficients import stress_coefficients
from bem.kernels.loads import STRESS_PARITY, Load
from bem.kernels.spectral import stress_response
from bem.numerics.cache import KeptValues
from bem.reference_solutions.hamilton import sphere_stress
from bem.reference_solutions.mcewen import cylinder_stress
from bem.stress import (
    von_mises_field,
    von_mises_planes,
    von_mises_upper_bound,
)
from bem.threads import set_threads
from bem.transforms import COUNT as TRANSFORMS

NU = 0.3
BODY = Body(Material("solid", youngs_modulus=210e9, poissons_ratio=NU))
ALL_PERIODIC = [(False, False), (False, True), (True, False), (True, True)]


def direct(pressure, grid, depth, friction):
    """Every cell on every other one, by loops over offsets."""
    nx, ny = grid.shape
    stress = np.zeros((6, nx, ny))
    i, j = np.arange(nx), np.arange(ny)
    di = i[:, None, None, None] - i[None, None, :, None]
    dj = j[None, :, None, None] - j[None, None, None, :]
    for load, factor in ((Load.NORMAL, 1.0), (Load.TANGENTIAL, friction)):
        if all(grid.periodic):
            response = stress_response(grid, BODY, depth, load)
            table = np.zeros((6, nx, ny))
            waves_x = np.exp(2j * np.pi * np.outer(i, np.fft.fftfreq(nx)))
            waves_y = np.exp(2j * np.pi * np.outer(j, np.arange(ny // 2 + 1)) / ny)
            weight = np.where((np.arange(ny // 2 + 1) == 0) | (2 * np.arange(ny // 2 + 1) == ny), 1, 2)
            for c, (px, py) in enumerate(STRESS_PARITY[load]):
                spectrum = response[c] * weight * (1 if px * py > 0 else 1j)
                table[c] = (waves_x @ spectrum @ waves_y.T).real / (nx * ny)
        else:
            table = stress_coefficients(grid, BODY, depth, load)
        for c, (px, py) in enumerate(STRESS_PARITY[load]):
            sign = np.where(di < 0, px, 1) * np.where(dj < 0, py, 1)
            stress[c] += factor * np.einsum("abcd,cd->ab", table[c][abs(di), abs(dj)] * sign, pressure)
    return stress


@pytest.mark.internal
@pytest.mark.parametrize("periodic", ALL_PERIODIC)
@pytest.mark.parametrize("shape", [(7, 6), (8, 5), (1, 4), (5, 1), (2, 2), (1, 1)])
def test_transforms_do_what_direct_summation_does(shape, periodic):
    grid = Grid(shape, (1e-6, 0.7e-6), periodic=periodic)
    pressure = 1e9 * np.random.default_rng(1).random(shape)
    depths = [0.0, 0.4e-6, 5e-6]
    for friction in (0.0, 0.3, -1.0):
        stress = subsurface_stress(pressure, grid, BODY, depths, friction=friction)
        assert stress.shape == (6, 3, *shape)
        for index, depth in enumerate(depths):
            want = direct(pressure, grid, depth, friction)
            assert np.abs(stress[:, index] - want).max() < 1e-14 * 1e9 * 10  # round-off of transforms
        field = von_mises_field(pressure, grid, BODY, depths, friction=friction)
        assert np.abs(field - von_mises(stress)).max() < 1e-14 * 1e9 * 10


def cell_means(grid, function, parts=8):
    """Mean over each cell of a function of (x, y)."""
    offsets = (np.arange(parts) + 0.5) / parts - 0.5
    x = (grid.x[:, None] + offsets * grid.spacing[0]).ravel()
    y = (grid.y[:, None] + offsets * grid.spacing[1]).ravel()
    values = function(x[:, None], y[None, :])
    return values.reshape(grid.shape[0], parts, grid.shape[1], parts).mean(axis=(1, 3))


@pytest.mark.parametrize("friction", [0.0, 0.25])
def test_hertz_on_and_off_axis_with_observed_order(friction):
    depths = np.array([0.3, 0.48, 1.0, 2.5])
    errors = []
    for cells in (31, 61, 121):  # odd: a point on the axis
        grid = Grid((cells, cells), (3.1 / cells, 3.1 / cells))
        pressure = cell_means(grid, lambda x, y: np.sqrt(np.maximum(1 - x * x - y * y, 0)))
        stress = subsurface_stress(pressure, grid, BODY, depths, friction=friction)
        want = sphere_stress(
            grid.x[:, None], grid.y[None, :], depths[:, None, None],
            contact_radius=1.0, maximum_pressure=1.0, poissons_ratio=NU, friction=friction,
        )  # fmt: skip
        errors.append(np.abs(stress - want).max())
    # means over cells: second order, anywhere on the grid, all components and depths
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert np.log2(errors[1] / errors[2]) > 1.8
    assert errors[2] < 1e-3
    if friction == 0:
        middle = cells // 2
        shear = 0.5 * (stress[0, 1, middle, middle] - stress[2, 1, middle, middle])
        assert shear == pytest.approx(0.31, abs=0.001)  # Johnson (1985), section 3.4: 0.31 p0 at 0.48 a


@pytest.mark.parametrize("friction", [0.0, 0.25])
def test_mcewens_cylinder_is_one_periodic_cell_wide(friction):
    depths = np.array([0.3, 0.786, 2.0])
    errors = []
    for cells in (65, 129, 257):
        grid = Grid((cells, 1), (4.1 / cells, 10.0), periodic=(False, True))
        pressure = cell_means(grid, lambda x, y: np.sqrt(np.maximum(1 - x * x, 0)) + 0 * y, parts=64)
        stress = subsurface_stress(pressure, grid, BODY, depths, friction=friction)
        want = cylinder_stress(
            grid.x, depths[:, None], half_width=1.0, maximum_pressure=1.0, poissons_ratio=NU, friction=friction
        )
        errors.append(np.abs(stress[..., 0] - want).max())
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert np.log2(errors[1] / errors[2]) > 1.8
    assert errors[2] < 2e-4


def test_uniform_pressure_on_a_doubly_periodic_grid():
    grid = Grid((6, 5), (1.0, 1.0), periodic=(True, True))
    stress = subsurface_stress(np.full((6, 5), 2.0), grid, BODY, [0.0, 7.0], friction=0.5)
    lateral = -NU / (1 - NU) * 2
    for component, value in enumerate((lateral, lateral, -2, 0, -1, 0)):
        np.testing.assert_allclose(stress[component], value, atol=1e-14)


@pytest.mark.internal
def test_counts_of_transforms_and_spectra():
    room.set_stress_memory(1 << 28)
    grid = Grid((12, 9), (1.1e-6, 1e-6))
    pressure = np.random.default_rng(2).random(grid.shape)
    depths = [0.0, 1e-6, 2e-6]
    TRANSFORMS.reset()
    room.COUNT.reset()
    subsurface_stress(pressure, grid, BODY, depths)
    assert (TRANSFORMS.forward, TRANSFORMS.inverse) == (1, 18)
    assert (room.COUNT.spectra, TRANSFORMS.kernels) == (3, 18)  # no friction: no tangential kernels
    von_mises_field(pressure, grid, BODY, depths)
    assert (TRANSFORMS.forward, TRANSFORMS.inverse) == (2, 18 + 15)  # von Mises does not need the trace
    assert (room.COUNT.spectra, TRANSFORMS.kernels) == (3, 18)  # from the cache
    stiffer = Body(Material("stiffer", youngs_modulus=1e12, poissons_ratio=NU))
    subsurface_stress(pressure, grid, stiffer, depths[:1])
    assert room.COUNT.spectra == 3  # stress of a homogeneous body knows nu only
    subsurface_stress(pressure, grid, BODY, depths[:1], friction=0.1)
    assert (room.COUNT.spectra, TRANSFORMS.kernels) == (4, 18 + 12)
    planes = von_mises_planes(pressure, grid, BODY, [3e-6, 4e-6])
    assert room.COUNT.spectra == 4
    next(planes)
    assert room.COUNT.spectra == 5  # a plane is computed when it is asked for


@pytest.mark.internal
def test_memory_of_spectra_is_bounded_and_a_long_sweep_keeps_what_fits():
    grid = Grid((12, 9), (1.2e-6, 1e-6))
    pressure = np.random.default_rng(3).random(grid.shape)
    depths = np.arange(8) * 1e-6
    room.set_stress_memory(0)
    assert room.stress_memory() == 0
    want = von_mises_field(pressure, grid, BODY, depths)
    assert room.stress_memory() == 0
    try:
        room.set_stress_memory(1 << 28)
        von_mises_field(pressure, grid, BODY, depths[:1])
        each = room.stress_memory()
        room.set_stress_memory(5 * each + each // 2)
        von_mises_field(pressure, grid, BODY, depths)
        assert room.stress_memory() == 5 * each
        room.COUNT.reset()
        again = von_mises_field(pressure, grid, BODY, depths)
        assert room.COUNT.spectra == 3
        np.testing.assert_array_equal(again, want)
        # another grid takes over once the first is two sweeps old
        other = Grid((12, 9), (1.3e-6, 1e-6))
        for _ in range(3):
            von_mises_field(pressure, other, BODY, depths[:5])
        room.COUNT.reset()
        von_mises_field(pressure, other, BODY, depths[:5])
        assert room.COUNT.spectra == 0
    finally:
        room.set_stress_memory(1 << 29)


@pytest.mark.internal
def test_bits_do_not_depend_on_threads_cache_or_output_array():
    grid = Grid((150, 40), (1e-6, 1e-6), periodic=(False, True))
    pressure = np.random.default_rng(4).random(grid.shape)
    depths = [0.0, 2e-6]
    first = subsurface_stress(pressure, grid, BODY, depths, friction=0.2)
    field = von_mises_field(pressure, grid, BODY, depths, friction=0.2)
    try:
        set_threads(2)
        np.testing.assert_array_equal(subsurface_stress(pressure, grid, BODY, depths, friction=0.2), first)
        np.testing.assert_array_equal(von_mises_field(pressure, grid, BODY, depths, friction=0.2), field)
    finally:
        set_threads(1)
    room.set_stress_memory(0)
    room.set_stress_memory(1 << 29)
    out = np.full((6, 2, 150, 40), np.nan)
    assert subsurface_stress(pressure, grid, BODY, depths, friction=0.2, out=out) is out
    np.testing.assert_array_equal(out, first)
    plane = np.full((150, 40), np.nan)
    for index, got in enumerate(von_mises_planes(pressure, grid, BODY, depths, friction=0.2, out=plane)):
        assert got is plane
        np.testing.assert_array_equal(got, field[index])


def rough(rng, shape, fraction):
    return np.where(rng.random(shape) < fraction, rng.random(shape), 0.0)


@pytest.mark.parametrize("periodic", ALL_PERIODIC)
@pytest.mark.parametrize("friction", [0.0, -0.4])
def test_the_limit_is_never_exceeded(periodic, friction):
    rng = np.random.default_rng(15)
    depths = [0.0, 0.3, 2.0, 10.0]
    for shape in ((7, 6), (1, 14), (15, 1), (23, 31)):
        grid = Grid(shape, (1.0, 0.7), periodic=periodic)
        blob = np.zeros(shape)
        blob[: (shape[0] + 1) // 2, : (shape[1] + 1) // 2] = 2.0
        for pressure in (rough(rng, shape, 0.2), rough(rng, shape, 1) * rng.choice([-1, 1], shape), blob):
            limit = von_mises_upper_bound(pressure, grid, BODY, depths, friction=friction)
            field = von_mises_field(pressure, grid, BODY, depths, friction=friction)
            # round-off of the transforms
            assert (field.max(axis=(1, 2)) <= limit + 1e-14 * np.abs(pressure).max()).all()


@pytest.mark.internal
def test_the_limit_is_near_for_one_loaded_cell_and_costs_one_pass_a_depth():
    grid = Grid((40, 36), (1.0, 1.0), periodic=(False, True))
    one, many = np.zeros((2, *grid.shape))
    one[11, 27] = 3.0
    many[5:11, 6:12] = 1.0
    depths = [0.5, 3.0]
    room.COUNT.reset()
    for pressure, factor in ((one, 1.6), (many, 3.0)):
        limit = von_mises_upper_bound(pressure, grid, BODY, depths, friction=0.2)
        peak = von_mises_field(pressure, grid, BODY, depths, friction=0.2).max(axis=(1, 2))
        # one cell: sqrt(5) at most if the largest d, e, yz, xz, xy were equal and apart; as measured, rounded up
        assert (limit < factor * peak).all()
    assert room.COUNT.bounds == 2
    TRANSFORMS.reset()
    assert not von_mises_upper_bound(0 * many, grid, BODY, depths[::-1], friction=0.2).any()
    assert (room.COUNT.bounds, TRANSFORMS.forward, TRANSFORMS.inverse) == (2, 0, 0)


def test_planes_go_where_they_are_wanted():
    grid = Grid((9, 6), (1.0, 1.0), periodic=(False, True))
    pressure = np.random.default_rng(16).random(grid.shape)
    whole = von_mises_field(pressure, grid, BODY, [0.0, 1.0, 2.0], friction=0.1)
    stack = np.full((3, 9, 6), np.nan)
    sweep = von_mises_planes(pressure, grid, BODY, [0.0, 1.0, 2.0], friction=0.1, out=stack)
    next(sweep)
    next(sweep)
    np.testing.assert_array_equal(stack[:2], whole[:2])
    assert np.isnan(stack[2]).all()  # not asked for, not touched
    with pytest.raises(InputError, match="out"):
        von_mises_planes(pressure, grid, BODY, [0.0, 1.0], out=stack)


def test_a_layer_of_the_same_material_changes_nothing():
    same = Body(BODY.material, layer=Layer(Material("skin", youngs_modulus=210e9, poissons_ratio=NU), 1e-6))
    pressure = np.random.default_rng(8).random((6, 5))
    for periodic in ALL_PERIODIC:
        grid = Grid((6, 5), (1e-6, 1e-6), periodic=periodic)
        plain = subsurface_stress(pressure, grid, BODY, [0.0, 0.5e-6, 2e-6], friction=0.2)
        coated = subsurface_stress(pressure, grid, same, [0.0, 0.5e-6, 2e-6], friction=0.2)
        np.testing.assert_allclose(coated, plain, rtol=0, atol=1e-12)  # the layered kernels' own 1e-13, 30 cells


components = st.lists(st.floats(-1e9, 1e9), min_size=6, max_size=6)


@settings(max_examples=100, deadline=None)
@given(components, components, st.floats(-1e3, 1e3))
def test_von_mises_is_a_seminorm_blind_to_mean_stress(a, b, mean):
    a, b = np.array(a), np.array(b)
    # textbook form
    xx, yy, zz, yz, xz, xy = a
    want = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (yz**2 + xz**2 + xy**2))
    assert von_mises(a) == pytest.approx(want, rel=1e-12, abs=1e-6)  # abs: round-off of 1e9
    assert von_mises(a + b) <= von_mises(a) + von_mises(b) + 1e-5
    assert von_mises(-2 * a) == pytest.approx(2 * von_mises(a), rel=1e-12)
    assert von_mises(a + mean * np.array([1, 1, 1, 0, 0, 0])) == pytest.approx(float(von_mises(a)), rel=1e-9, abs=1e-6)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 9), st.integers(1, 9), st.sampled_from(ALL_PERIODIC), st.floats(-1, 1), st.integers(0, 2**32 - 1))
def test_linearity_mirror_and_scale(nx, ny, periodic, friction, seed):
    rng = np.random.default_rng(seed)
    grid = Grid((nx, ny), (1.0, 0.5), periodic=periodic)
    p, q = rng.random((2, nx, ny))

    def stress(pressure, f=friction, g=grid, z=(0.0, 0.8)):
        return subsurface_stress(pressure, g, BODY, np.array(z), friction=f)

    close = {"rtol": 0, "atol": 1e-12}  # round-off: pressures up to 3, up to 81 cells
    np.testing.assert_allclose(stress(2 * p - q), 2 * stress(p) - stress(q), **close)
    signs = np.array([1, 1, 1, -1, 1, -1])[:, None, None, None]
    np.testing.assert_allclose(stress(p[:, ::-1]), signs * stress(p)[..., ::-1], **close)
    signs = np.array([1, 1, 1, 1, -1, -1])[:, None, None, None]
    np.testing.assert_allclose(stress(p[::-1], -friction), signs * stress(p)[:, :, ::-1], **close)
    small = Grid((nx, ny), (1e-9, 0.5e-9), periodic=periodic)
    np.testing.assert_allclose(stress(1e9 * p, g=small, z=(0.0, 0.8e-9)), 1e9 * stress(p), rtol=0, atol=1e-3)


@pytest.mark.internal
def test_bad_input_is_refused_with_every_mistake_named():
    grid = Grid((4, 4), (1, 1))
    pressure = np.ones((4, 4))
    for function in (subsurface_stress, von_mises_field, von_mises_upper_bound, von_mises_planes):
        with pytest.raises(InputError) as caught:
            function(pressure, grid, "steel", [-1.0], friction=np.nan)
        assert len(caught.value.messages) == 3
        for depths in ([np.nan], [[1.0]], 1.0, ["deep"], [np.inf]):
            with pytest.raises(InputError, match="depths"):
                function(pressure, grid, BODY, depths)
        with pytest.raises(InputError, match="shape"):
            function(np.ones((4, 5)), grid, BODY, [1.0])
        with pytest.raises(InputError, match="finite"):
            function(np.full((4, 4), np.nan), grid, BODY, [1.0])
    with pytest.raises(InputError, match="out"):
        subsurface_stress(pressure, grid, BODY, [1.0], out=np.empty((6, 2, 4, 4)))
    with pytest.raises(InputError, match="6 components"):
        von_mises(np.ones((5, 2)))
    with pytest.raises(InputError, match="limit"):
        room.set_stress_memory(-1)
    assert subsurface_stress(pressure, grid, BODY, []).shape == (6, 0, 4, 4)


@pytest.mark.internal
def test_a_cache_of_sweeps_keeps_the_first_values_of_a_sweep_that_does_not_fit():
    """Least recently used values would each be evicted just before their next use."""

    def misses(cache, keys, sweep):
        made = []
        for key in keys:
            cache.of(key, lambda key=key: made.append(key) or np.zeros(4), sweep)  # 32 bytes each
        return made

    cache = KeptValues(3 * 32)
    assert misses(cache, range(5), cache.begin_sweep()) == [0, 1, 2, 3, 4]
    assert misses(cache, range(5), cache.begin_sweep()) == [3, 4]
    assert cache.nbytes == 3 * 32
    assert misses(cache, [7, 8], cache.begin_sweep()) == [7, 8]  # the sweep before used all that is held
    assert misses(cache, [7, 8], cache.begin_sweep()) == [7, 8]
    assert misses(cache, [7, 8], cache.begin_sweep()) == []  # what two sweeps did not use has given way
    least_recent = KeptValues(3 * 32)
    assert misses(least_recent, range(5), None) == [0, 1, 2, 3, 4]
    assert misses(least_recent, range(5), None) == [0, 1, 2, 3, 4]
