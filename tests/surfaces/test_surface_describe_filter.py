"""Description and filters against surfaces whose answers are known."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bem import Grid, InputError, Surface, describe_surface, generate_surface
from bem.surfaces import (
    MirrorWarning,
    crop,
    detrend,
    fill_missing,
    high_pass,
    low_pass,
    mirror_to_periodic,
    radial_spectrum,
    resample,
    scale_to_rms,
)

PERIODIC = (True, True)


def wave(nx=96, ny=64, dx=1e-7, dy=2e-7, amplitude=3e-8, waves=(3, 0)):
    grid = Grid((nx, ny), (dx, dy), periodic=PERIODIC)
    phase = (
        2 * np.pi * (waves[0] * (np.arange(nx)[:, None] + 0.5) / nx + waves[1] * (np.arange(ny)[None, :] + 0.5) / ny)
    )
    return grid, amplitude * np.cos(phase)


def test_sinusoid():
    grid, heights = wave()
    got = describe_surface(heights + 5e-6, grid.spacing, periodic=PERIODIC)
    amplitude, k, dx = 3e-8, 2 * np.pi * 3 / grid.lengths[0], grid.spacing[0]
    assert got.Sq == pytest.approx(amplitude / math.sqrt(2), rel=1e-9)
    assert got.Sa == pytest.approx(2 * amplitude / math.pi, rel=2e-3)  # sampled mean of |cos|
    assert got.Sz == pytest.approx(2 * amplitude, rel=6e-3)  # cells do not sit on the crests
    assert got.Ssk == pytest.approx(0, abs=1e-9)
    assert got.Sku == pytest.approx(1.5, rel=1e-9)
    # a difference over dx of a wave: sin(k dx/2) / (k dx/2)
    assert got.slope_x == pytest.approx(got.Sq * 2 * math.sin(k * dx / 2) / dx, rel=1e-9)
    assert got.slope_y == pytest.approx(0, abs=1e-9)
    assert got.Sdq == pytest.approx(got.slope_x, rel=1e-9)
    # cos(k lag) = level, linear between lags a tenth of a radian apart
    assert got.autocorrelation_length_x == pytest.approx(math.acos(math.exp(-1)) / k, rel=2e-3)
    assert got.decay_length_x == pytest.approx(math.acos(0.2) / k, rel=2e-3)
    assert math.isnan(got.autocorrelation_length_y)
    assert got.autocorrelation_length == got.autocorrelation_length_x


@pytest.mark.parametrize("axis", [0, 1])
def test_long_lags_of_a_free_axis_are_means_over_the_pairs_that_exist(axis):
    """A step in the middle of n cells: of the n - k pairs at lag k, k have opposite signs: r = (n - 3 k) / (n - k)."""
    n, cell = 400, (1e-7, 3e-7)
    step = np.where(np.arange(n) < n // 2, -1e-9, 1e-9)
    got = describe_surface(np.repeat(np.expand_dims(step, 1 - axis), 3, axis=1 - axis), cell)
    lengths = (got.autocorrelation_length_x, got.decay_length_x), (got.autocorrelation_length_y, got.decay_length_y)
    expected = [n * (1 - level) / (3 - level) * cell[axis] for level in (math.exp(-1), 0.2)]
    # linear between lags: r changes by 2 / n a lag, and its slope by a few times 1 / n of that
    assert lengths[axis] == pytest.approx(expected, rel=1e-4)


def test_flat_and_profile():
    flat = describe_surface(np.full((5, 5), 1e-3), (1e-6, 1e-6))
    assert flat.Sq == 0
    assert flat.Sdq == 0
    assert math.isnan(flat.Ssk)
    assert math.isnan(flat.Sku)
    profile = describe_surface(np.sin(np.arange(50.0))[None, :], (1.0, 1.0))
    assert math.isnan(profile.slope_x)
    assert profile.Sdq == profile.slope_y


@settings(max_examples=40, deadline=None)
@given(
    arrays(np.float64, st.tuples(st.integers(2, 9), st.integers(2, 9)), elements=st.floats(-1, 1)),
    st.floats(1e-9, 1e3),
    st.floats(-1, 1),
)
def test_units_offset_and_transposition(heights, unit, offset):
    a = describe_surface(heights, (1.0, 2.0))
    if a.Sq < 1e-3:
        return
    b = describe_surface(unit * (heights + offset), (unit, 2 * unit))
    t = describe_surface(heights.T, (2.0, 1.0))
    for name in ("Sq", "Sa", "Sz"):
        # offset / Sq up to 1e3 costs three digits
        assert getattr(b, name) == pytest.approx(unit * getattr(a, name), rel=1e-9, abs=0)
        assert getattr(t, name) == pytest.approx(getattr(a, name), rel=1e-9)
    assert b.Sdq == pytest.approx(a.Sdq, rel=1e-9)
    assert t.slope_x == pytest.approx(a.slope_y, rel=1e-9)
    assert b.Sku == pytest.approx(a.Sku, rel=1e-8)
    assert a.Sku >= a.Ssk**2 + 1 - 1e-9


def test_spectrum_keeps_the_variance():
    grid = Grid((192, 128), (1e-7, 1.5e-7))
    heights = generate_surface(grid, rms_height=2e-8, seed=3, correlation_length=1.2e-6)
    for periodic in (PERIODIC, (False, False)):
        s = radial_spectrum(heights, grid.spacing, periodic=periodic)
        variance = (s.density * s.modes).sum() / (grid.lengths[0] * grid.lengths[1])
        # periodic: what lies in the corners beyond the last ring; free: a window sees one sample of the surface
        assert math.sqrt(variance) == pytest.approx(2e-8, rel=1e-4 if periodic == PERIODIC else 0.1)
        integral = np.trapezoid(s.density * s.wavenumber, s.wavenumber) / (2 * np.pi)
        assert math.sqrt(integral) == pytest.approx(2e-8, rel=0.1)  # rings are coarse near q = 0
    # Gaussian autocorrelation: density pi l^2 Sq^2 exp(-q^2 l^2 / 4)
    s = radial_spectrum(heights, grid.spacing, periodic=PERIODIC)
    middle = (s.wavenumber > 1e6) & (s.wavenumber < 3e6)
    expected = np.pi * 1.2e-6**2 * 4e-16 * np.exp(-((s.wavenumber * 1.2e-6) ** 2) / 4)
    np.testing.assert_allclose(s.density[middle], expected[middle], rtol=0.1)  # ring averages of a steep function


@pytest.mark.parametrize("bad", [np.zeros(3), np.array([[1.0, np.nan]]), np.array([["a"]]), np.zeros((0, 3))])
def test_describe_refuses(bad):
    with pytest.raises(InputError, match="heights"):
        describe_surface(bad, (1.0, 1.0))
    with pytest.raises(InputError, match="spacing"):
        describe_surface(np.eye(3), (0.0, 1.0))
    with pytest.raises(InputError, match="at least"):
        radial_spectrum(np.eye(3), (1.0, 1.0))


# --- Surface -----------------------------------------------------------------------------------------------------


def test_surface_can_be_pickled():
    surface = Surface(np.arange(6.0).reshape(2, 3), (1e-6, 2e-6), {"a": 1})
    again = pickle.loads(pickle.dumps(surface))
    np.testing.assert_array_equal(again.heights, surface.heights)
    assert again.spacing == surface.spacing
    assert again.metadata == surface.metadata
    assert not again.heights.flags.writeable


def test_surface_is_frozen():
    heights = np.arange(6.0).reshape(2, 3)
    surface = Surface(heights, (1e-6, 2e-6), {"a": 1})
    heights[0, 0] = 99
    assert surface.heights[0, 0] == 0
    with pytest.raises(ValueError, match="read-only"):
        surface.heights[0, 0] = 1
    with pytest.raises(AttributeError):
        surface.spacing = (1, 1)
    with pytest.raises(TypeError):
        surface.metadata["a"] = 2
    assert surface.shape == (2, 3)
    assert surface.lengths == (2e-6, 6e-6)
    assert surface.grid(periodic=(False, True)) == Grid((2, 3), (1e-6, 2e-6), periodic=(False, True))
    with pytest.raises(InputError):
        Surface(np.array([[np.inf, 1.0]]), (1.0, 1.0))


# --- levelling and filling ---------------------------------------------------------------------------------------


def test_detrend_takes_out_what_it_says():
    rng = np.random.default_rng(0)
    x, y = np.arange(40)[:, None] * 1e-6, np.arange(30)[None, :] * 2e-6
    plane = 3e-3 + 0.02 * x - 0.01 * y
    bow = 5.0 * x**2 - 3.0 * x * y + 2.0 * y**2
    rough = rng.normal(size=(40, 30)) * 1e-9
    rough_p = detrend(rough, (1e-6, 2e-6), "plane")
    # the offset is a million times the roughness: nine digits of it remain
    np.testing.assert_allclose(detrend(plane + rough, (1e-6, 2e-6), "plane"), rough_p, atol=1e-16)
    np.testing.assert_allclose(
        detrend(plane + bow + rough, (1e-6, 2e-6), "curvature"), detrend(rough, (1e-6, 2e-6), "curvature"), atol=1e-16
    )
    np.testing.assert_array_equal(detrend(plane, (1e-6, 2e-6), "none"), plane)
    np.testing.assert_allclose(detrend(rough_p, (1e-6, 2e-6), "plane"), rough_p, atol=1e-22)  # once is enough
    with pytest.raises(InputError, match="plane, curvature, none"):
        detrend(plane, (1e-6, 2e-6), "cubic")


def test_detrend_does_not_see_missing_points():
    x, y = np.arange(20.0)[:, None], np.arange(10.0)[None, :]
    heights = 2 * x + 3 * y
    heights[3:6, 2:5] = np.nan
    level = detrend(heights, (1.0, 1.0), "plane")
    assert np.isnan(level).sum() == 9
    assert np.nanmax(np.abs(level)) < 1e-12


def test_filling_is_harmonic():
    x, y = np.arange(30)[:, None] * 1e-6, np.arange(25)[None, :] * 2e-6
    harmonic = x**2 - y**2 + 3 * x * y  # its five-point Laplacian is zero on any cells
    holes = harmonic.copy()
    holes[5:12, 6:15] = np.nan
    holes[20, 3] = np.nan
    np.testing.assert_allclose(fill_missing(holes, (1e-6, 2e-6)), harmonic, atol=1e-12 * np.abs(harmonic).max())


@settings(max_examples=40, deadline=None)
@given(
    arrays(np.float64, st.tuples(st.integers(2, 12), st.integers(2, 12)), elements=st.floats(-1, 1)),
    st.integers(0, 2**32 - 1),
    st.floats(0, 0.5),
)
def test_filling_makes_no_new_extremes_and_leaves_the_rest(heights, seed, share):
    mask = np.random.default_rng(seed).random(heights.shape) < share
    if mask.mean() > 0.5:
        return
    holes = np.where(mask, np.nan, heights)
    filled = fill_missing(holes, (1.0, 3.0))
    np.testing.assert_array_equal(filled[~mask], heights[~mask])
    assert filled.min() >= np.nanmin(holes)
    assert filled.max() <= np.nanmax(holes)


def test_filling_refuses_mostly_missing():
    heights = np.full((10, 10), np.nan)
    heights[:4] = 1.0
    with pytest.raises(InputError, match="60 of 100 points are missing"):
        fill_missing(heights, (1.0, 1.0))


# --- crop, resample, mirror --------------------------------------------------------------------------------------


def test_crop():
    surface = Surface(np.arange(100.0).reshape(10, 10), (1.0, 2.0))
    middle = crop(surface, (4.0, 8.0))
    np.testing.assert_array_equal(middle.heights, surface.heights[3:7, 3:7])
    corner = crop(surface, (2.0, 4.0), centre=(-4.0, 8.0))
    np.testing.assert_array_equal(corner.heights, surface.heights[0:2, 8:10])
    for lengths, centre in (
        ((11.0, 4.0), (0, 0)),
        ((0.1, 4.0), (0, 0)),
        ((4.0, 4.0), (9, 0)),
        ((math.nan, 4.0), (0, 0)),
    ):
        with pytest.raises(InputError, match="crop"):
            crop(surface, lengths, centre=centre)


def test_resample_on_its_own_grid_is_the_identity():
    grid, heights = wave(waves=(3, 2))
    surface = Surface(heights, grid.spacing)
    for method in ("spline", "fourier"):
        got = resample(surface, grid, method=method)
        np.testing.assert_allclose(got.heights, heights, atol=1e-13 * np.abs(heights).max())


def test_resample_orders():
    """Cubic spline between cells: fourth order. Fourier: exact."""
    errors = []
    for factor in (1, 2):
        grid, heights = wave(nx=48 * factor, ny=32 * factor, dx=2e-7 / factor, dy=4e-7 / factor, waves=(3, 2))
        target, expected = wave(nx=500, ny=410, dx=48 * 2e-7 / 500, dy=32 * 4e-7 / 410, waves=(3, 2))
        surface = Surface(heights, grid.spacing)
        inner = (slice(50, 450), slice(40, 370))  # away from edges, where a spline has no neighbours
        errors.append(np.abs(resample(surface, target).heights - expected)[inner].max())
        fourier = resample(surface, target, method="fourier").heights
        np.testing.assert_allclose(fourier, expected, atol=1e-13 * np.abs(expected).max())
    assert math.log2(errors[0] / errors[1]) > 3.7
    assert errors[1] < 2e-4 * 3e-8


def test_resample_coarser_removes_what_cannot_be_held():
    grid, low = wave(nx=128, ny=16, dy=1e-7, waves=(2, 0))
    _, high = wave(nx=128, ny=16, dy=1e-7, waves=(50, 0))
    coarse = Grid((32, 16), (4e-7, 1e-7))
    both = resample(Surface(low + high, grid.spacing), coarse).heights
    only = resample(Surface(low, grid.spacing), coarse).heights
    # a wave cut at a free edge is not one cosine: a few per cent leak near the edges
    assert np.abs(both - only)[4:-4].max() < 0.03 * 3e-8


def test_resample_off_centre_and_refusals():
    surface = Surface(np.add.outer(np.arange(20.0), 2 * np.arange(30.0)), (1.0, 1.0))
    got = resample(surface, Grid((4, 4), (0.5, 0.5)), centre=(3.0, -2.0))
    x = 9.5 + 3.0 + (np.arange(4) - 1.5) * 0.5
    y = 14.5 - 2.0 + (np.arange(4) - 1.5) * 0.5
    np.testing.assert_allclose(got.heights, np.add.outer(x, 2 * y), rtol=1e-12)
    assert got.spacing == (0.5, 0.5)
    with pytest.raises(InputError, match="mirror_to_periodic") as caught:
        resample(surface, Grid((50, 50), (1.0, 1.0)))
    (message,) = caught.value.messages
    assert "along x" in message
    assert "along y" in message
    with pytest.raises(InputError, match="as long as the map"):
        resample(surface, Grid((4, 4), (1.0, 1.0)), method="fourier")
    with pytest.raises(InputError, match="spline, fourier"):
        resample(surface, Grid((4, 4), (1.0, 1.0)), method="linear")


def test_fourier_keeps_a_generated_surface_and_refines_it():
    coarse = Grid((63, 64), (2e-7, 2e-7))
    heights = generate_surface(coarse, rms_height=1e-8, seed=1, hurst=0.8, cutoff_wavelength=1e-6)
    fine = Grid((189, 192), (2e-7 / 3, 2e-7 / 3))
    refined = resample(Surface(heights, coarse.spacing), fine, method="fourier")
    np.testing.assert_allclose(refined.heights[1::3, 1::3], heights, atol=1e-13 * 1e-8 * 10)  # same centres


def test_mirror_warns_and_is_periodic():
    surface = Surface(np.random.default_rng(0).normal(size=(7, 5)), (1.0, 1.0))
    with pytest.warns(MirrorWarning, match="symmetric"):
        both = mirror_to_periodic(surface)
    assert both.shape == (14, 10)
    np.testing.assert_array_equal(both.heights[0], both.heights[-1])
    np.testing.assert_array_equal(both.heights[:, 0], both.heights[:, -1])
    with pytest.warns(MirrorWarning):
        one = mirror_to_periodic(surface, axes=(False, True))
    assert one.shape == (7, 10)


@pytest.mark.parametrize("periodic", [PERIODIC, (False, False), (False, True)])
def test_low_and_high_pass_add_up(periodic):
    surface = Surface(np.random.default_rng(1).normal(size=(30, 41)), (1.0, 2.0))
    for kind in ("gaussian", "sharp"):
        low = low_pass(surface, 8.0, periodic=periodic, kind=kind)
        high = high_pass(surface, 8.0, periodic=periodic, kind=kind)
        np.testing.assert_allclose(low.heights + high.heights, surface.heights, atol=1e-14)
        assert high.heights.mean() == pytest.approx(0, abs=1e-14)
    again = low_pass(low, 8.0, periodic=periodic, kind="sharp")
    np.testing.assert_allclose(again.heights, low.heights, atol=1e-13)


def test_gaussian_filter_transmits_half_at_the_cutoff():
    grid, heights = wave(waves=(0, 4))
    surface = Surface(heights, grid.spacing)
    half = low_pass(surface, grid.lengths[1] / 4, periodic=PERIODIC)
    np.testing.assert_allclose(half.heights, 0.5 * heights, atol=1e-13 * np.abs(heights).max())
    with pytest.raises(InputError, match="wavelength"):
        low_pass(surface, 0.0)
    with pytest.raises(InputError, match="gaussian, sharp"):
        low_pass(surface, 1.0, kind="butterworth")


@pytest.mark.parametrize("axis", [0, 1])
def test_a_filter_of_free_axes_transmits_half_of_a_cosine_at_the_cutoff(axis):
    """A cosine with its crests on both edges, of which a map of n cells holds one for every half wave."""
    shape, spacing, half_waves = (18, 25), (1e-6, 2e-6), 6
    place = (np.arange(shape[axis]) + 0.5) / shape[axis]
    heights = np.zeros(shape) + np.expand_dims(np.cos(np.pi * half_waves * place), 1 - axis)
    passed = low_pass(Surface(heights, spacing), 2 * shape[axis] * spacing[axis] / half_waves)
    np.testing.assert_allclose(passed.heights, 0.5 * heights, atol=1e-13)


def test_scale_to_rms():
    surface = scale_to_rms(Surface(np.random.default_rng(1).normal(size=(9, 8)) + 3, (1.0, 1.0)), 5e-8)
    assert describe_surface(surface.heights, surface.spacing).Sq == pytest.approx(5e-8, rel=1e-13)
    with pytest.raises(InputError, match="flat"):
        scale_to_rms(Surface(np.ones((3, 3)), (1.0, 1.0)), 1.0)
    with pytest.raises(InputError, match="rms_height"):
        scale_to_rms(surface, -1.0)
