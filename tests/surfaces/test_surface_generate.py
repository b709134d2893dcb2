"""Generated surfaces: statistics, spectrum, periodicity, bits, refusals."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bem import Grid, InputError, describe_surface, generate_surface
from bem.surfaces import radial_spectrum
from bem.surfaces.distributions import standard_quantiles
from bem.surfaces.generate import SAMPLE_LENGTH_TOLERANCE
from bem.surfaces.moments import STATISTICS_TOLERANCE
from bem.surfaces.ranks import in_order_of

CELL = 1e-7
PERIODIC = (True, True)


def square(n, cell=CELL):
    return Grid((n, n), (cell, cell), periodic=PERIODIC)


def describe(heights, grid):
    return describe_surface(heights, grid.spacing, periodic=PERIODIC)


@pytest.mark.internal
@pytest.mark.parametrize("model", ["gaussian", "exponential"])
@pytest.mark.parametrize(
    ("skewness", "kurtosis"),
    [(0, 3), (-0.27, 8.6), (-0.84, 4.46), (-1, 4.94), (0.5, 2.0), (0, 1.9)],  # the thesis' surfaces, and lighter tails
)
def test_statistics_and_correlation_are_met(model, skewness, kurtosis):
    grid = square(128)
    length = 8 * CELL
    heights = generate_surface(
        grid,
        rms_height=50e-9,
        seed=7,
        correlation_length=length,
        skewness=skewness,
        kurtosis=kurtosis,
        autocorrelation=model,
    )
    got = describe(heights, grid)
    assert got.Sq == pytest.approx(50e-9, rel=1e-12)
    assert got.Ssk == pytest.approx(skewness, abs=STATISTICS_TOLERANCE)
    assert got.Sku == pytest.approx(kurtosis, abs=STATISTICS_TOLERANCE)
    assert abs(heights.mean()) < 1e-12 * 50e-9
    # the spectrum gives way to the height distribution by a few per cent: documented
    assert got.autocorrelation_length_x == pytest.approx(length, rel=0.05)
    assert got.autocorrelation_length_y == pytest.approx(length, rel=0.05)


def test_unequal_correlation_lengths_on_unequal_cells():
    grid = Grid((96, 150), (1e-7, 2e-7))
    heights = generate_surface(grid, rms_height=1e-7, seed=3, correlation_length=(1e-6, 4e-6))
    got = describe(heights, grid)
    assert got.autocorrelation_length_x == pytest.approx(1e-6, rel=0.05)
    assert got.autocorrelation_length_y == pytest.approx(4e-6, rel=0.05)


@pytest.mark.internal
@pytest.mark.parametrize(("skewness", "kurtosis"), [(-0.84, 4.46), (-1.0, 4.94)])
def test_few_waves_still_have_the_thesis_statistics(skewness, kurtosis):
    """Paper C's patch at 2.5 N is four correlation lengths of its disk wide."""
    grid = square(120)
    length = 30 * CELL
    heights = generate_surface(
        grid, rms_height=1e-7, seed=2, correlation_length=length, skewness=skewness, kurtosis=kurtosis
    )
    got = describe(heights, grid)
    assert got.Ssk == pytest.approx(skewness, abs=STATISTICS_TOLERANCE)
    assert got.Sku == pytest.approx(kurtosis, abs=STATISTICS_TOLERANCE)
    assert got.autocorrelation_length_x == pytest.approx(length, rel=SAMPLE_LENGTH_TOLERANCE)
    assert got.autocorrelation_length_y == pytest.approx(length, rel=SAMPLE_LENGTH_TOLERANCE)


def test_gaussian_slope():
    """A Gaussian autocorrelation has slope 2 Sq / l; differences of cells lose (dx/l)^2 / 2 of it."""
    grid = square(256)
    heights = generate_surface(grid, rms_height=1e-8, seed=1, correlation_length=10 * CELL)
    assert describe(heights, grid).Sdq == pytest.approx(2 * 1e-8 / (10 * CELL), rel=0.02)


@pytest.mark.parametrize("hurst", [0.5, 0.8, 1.0])
def test_self_affine_spectrum(hurst):
    n = 256
    grid = square(n)
    rolloff, cutoff = n * CELL / 8, 6 * CELL
    heights = generate_surface(
        grid, rms_height=1e-7, seed=5, hurst=hurst, rolloff_wavelength=rolloff, cutoff_wavelength=cutoff
    )
    kx, ky = grid.wavevectors()
    q = np.hypot(kx, ky)
    power = np.abs(np.fft.rfft2(heights)) ** 2
    beyond = q > 2 * np.pi / cutoff * (1 + 1e-6)
    # round-off of the transform
    assert power[beyond].max() < 1e-24 * power.max()
    spectrum = radial_spectrum(heights, grid.spacing, periodic=PERIODIC)
    flat = (spectrum.wavenumber < 2 * np.pi / rolloff * 0.9) & (spectrum.modes > 10)
    power_law = (spectrum.wavenumber > 2 * np.pi / rolloff * 1.2) & (spectrum.wavenumber < 2 * np.pi / cutoff * 0.95)
    slope = np.polyfit(np.log(spectrum.wavenumber[power_law]), np.log(spectrum.density[power_law]), 1)[0]
    # amplitudes are prescribed, not drawn; what is left is the correction of the moments and the averaging over rings
    assert slope == pytest.approx(-2 - 2 * hurst, abs=0.02)
    assert np.ptp(np.log(spectrum.density[flat])) < 0.15


def test_rms_slope_instead_of_rms_height():
    grid = square(128)
    heights = generate_surface(grid, rms_slope=0.1, seed=5, hurst=0.8, cutoff_wavelength=16 * CELL)
    kx, ky = grid.wavevectors()
    spectrum = np.fft.rfft2(heights)
    slopes = [np.fft.irfft2(1j * k * spectrum, grid.shape) for k in (kx, ky)]
    # the cut-off is far from Nyquist, so derivatives are exact
    assert np.sqrt(np.mean(slopes[0] ** 2 + slopes[1] ** 2)) == pytest.approx(0.1, rel=1e-10)


def test_rms_slope_counts_each_of_the_shortest_waves_once():
    """By the whole transform, which has each wave once; waves of two cells are their own mirror image."""
    grid = Grid((8, 6), (CELL, 1.5 * CELL), periodic=(True, True))
    heights = generate_surface(grid, rms_slope=0.1, seed=5, hurst=0.8)
    power = np.abs(np.fft.fft2(heights)) ** 2
    assert power[:, 3].sum() > 1e-3 * power.sum()
    kx, ky = (2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(grid.shape, grid.spacing, strict=True))
    squares = float((power * (kx[:, None] ** 2 + ky[None, :] ** 2)).sum())
    assert np.sqrt(squares) / grid.cells == pytest.approx(0.1, rel=1e-10)


def test_same_seed_same_bits_in_another_process():
    code = (
        "import hashlib, bem; g = bem.Grid((64, 48), (1e-7, 1e-7));"
        "h = bem.generate_surface(g, rms_height=1e-7, seed=11, correlation_length=5e-7, skewness=-1, kurtosis=5);"
        "print(hashlib.sha256(h.tobytes()).hexdigest())"
    )
    there = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    grid = Grid((64, 48), (1e-7, 1e-7))
    here = generate_surface(grid, rms_height=1e-7, seed=11, correlation_length=5e-7, skewness=-1, kurtosis=5)
    assert there == hashlib.sha256(here.tobytes()).hexdigest() + "\n"


def test_seeds_differ_and_are_uncorrelated():
    grid = square(128)
    surfaces = [
        generate_surface(grid, rms_height=1.0, seed=seed, correlation_length=3 * CELL)
        for seed in (0, 1, 2**64, 2**64 + 1)
    ]
    for i in range(4):
        for j in range(i):
            # about 128^2 / (pi 3^2) independent patches: correlation of the order 0.04
            assert abs(np.mean(surfaces[i] * surfaces[j])) < 0.15


@pytest.mark.internal
def test_phases_are_uniform():
    from bem.surfaces.spectrum import phases

    phases = phases((200, 200), 3)[1:, 1:-1]
    # mean of n random unit vectors is 1/sqrt(n) long; four standard deviations
    for power in (1, 2, 3):
        assert abs(np.mean(phases**power)) < 4 / np.sqrt(phases.size)
    assert abs(np.mean(phases[1:] * phases[:-1].conj())) < 4 / np.sqrt(phases.size)
    assert abs(np.mean(phases[:, 1:] * phases[:, :-1].conj())) < 4 / np.sqrt(phases.size)


def test_finer_grid_of_the_same_size_has_the_same_waves():
    coarse, fine = square(64, 2 * CELL), square(128, CELL)
    kwargs = {"seed": 4, "hurst": 0.8, "rolloff_wavelength": 3.2e-6, "cutoff_wavelength": 8e-7, "rms_height": 1e-7}
    a, b = (np.fft.rfft2(generate_surface(g, **kwargs)) / g.cells for g in (coarse, fine))
    rows = np.r_[0:32, 33:64]
    both = a[rows, :32]
    same = b[np.r_[0:32, 97:128], :32]
    # phases turned by half a cell of either grid; the correction of the moments differs a little with the grid
    turn = np.exp(1j * np.pi * np.r_[0:32, -31:0] / 128)[:, None] * np.exp(1j * np.pi * np.arange(32) / 128)
    assert np.abs(both - same * turn).max() < 0.02 * np.abs(both).max()


@pytest.mark.parametrize("shape", [(64, 48), (63, 47)])
def test_finer_grid_has_the_same_waves_at_the_same_places(shape):
    """They stood still under the first cell, and moved by half a cell under a body in the middle of the grid."""
    lengths = (64 * CELL, 48 * CELL)
    kwargs = {"seed": 4, "hurst": 0.8, "rolloff_wavelength": 3.2e-6, "cutoff_wavelength": 8e-7, "rms_height": 1e-7}
    here, finer = (
        generate_surface(Grid(cells, (lengths[0] / cells[0], lengths[1] / cells[1]), periodic=PERIODIC), **kwargs)
        for cells in (shape, (3 * shape[0], 3 * shape[1]))
    )
    # a third of an odd number of cells has a cell's middle in common; 3e-4 is the correction of the moments
    assert np.abs(finer[1::3, 1::3] - here).max() < 1e-3 * 1e-7


def test_repeats_with_the_grid():
    """Periodic: the step across the edge is like any other."""
    grid = square(96)
    heights = generate_surface(grid, rms_height=1e-7, seed=2, correlation_length=8 * CELL)
    inside = np.sqrt(np.mean(np.diff(heights, axis=0) ** 2))
    across = np.sqrt(np.mean((heights[0] - heights[-1]) ** 2))
    assert across == pytest.approx(inside, rel=0.5)


def test_profiles_and_odd_shapes():
    for shape in ((1, 300), (300, 1), (75, 101), (2, 200)):
        grid = Grid(shape, (CELL, CELL))
        heights = generate_surface(grid, rms_height=1e-7, seed=2, hurst=0.8)
        assert heights.shape == shape
        assert np.sqrt(np.mean(heights**2)) == pytest.approx(1e-7, rel=1e-12)
    profile = generate_surface(
        Grid((1, 512), (CELL, CELL)), rms_height=1e-7, seed=2, hurst=0.7, rolloff_wavelength=128 * CELL
    )
    power = np.abs(np.fft.rfft(profile[0])) ** 2
    k = np.arange(1, 256)
    law = slice(8, 250)
    slope = np.polyfit(np.log(k[law]), np.log(power[1:256][law]), 1)[0]
    assert slope == pytest.approx(-1 - 2 * 0.7, abs=0.1)  # a profile's spectrum; moments corrected


def test_few_waves_keep_the_default_silently_but_refuse_what_was_asked():
    grid = square(8)
    kwargs = {"rms_height": 1e-7, "seed": 1, "hurst": 0.8, "cutoff_wavelength": 8 * CELL}
    heights = generate_surface(grid, **kwargs)  # four waves: cannot be Gaussian
    assert np.sqrt(np.mean(heights**2)) == pytest.approx(1e-7, rel=1e-12)
    with pytest.raises(InputError, match="cannot be had with this spectrum"):
        generate_surface(grid, skewness=-1, kurtosis=9, **kwargs)


GOOD = {"rms_height": 1e-7, "seed": 1, "correlation_length": 8e-7}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kurtosis": 1.5, "skewness": 1.0}, "skewness\\^2 \\+ 1"),
        ({"kurtosis": 0.5}, "no distribution"),
        ({"hurst": 0.8}, "exactly one of correlation_length"),
        ({"correlation_length": None}, "exactly one of correlation_length"),
        ({"rms_height": -1e-7}, "rms_height"),
        ({"rms_height": float("nan")}, "rms_height"),
        ({"rms_height": "50 nm"}, "rms_height"),
        ({"rms_height": None}, "exactly one of rms_height"),
        ({"rms_slope": 0.1}, "exactly one of rms_height"),
        ({"seed": -1}, "seed"),
        ({"seed": 1.5}, "seed"),
        ({"seed": True}, "seed"),
        ({"correlation_length": 1e-9}, "1 nm along x and y is shorter than a cell"),
        ({"correlation_length": 1e-3}, "1 mm along x and y is longer than half the grid"),
        ({"correlation_length": (1e-6,)}, "a pair"),
        ({"correlation_length": (1e-6, -1e-6)}, "correlation_length"),
        ({"correlation_length": 2.2e-6}, "cannot be had on a grid"),
        ({"rolloff_wavelength": 1e-6}, "belongs to hurst"),
        ({"autocorrelation": "cosine"}, "gaussian, exponential"),
        ({"cutoff_wavelength": 1e-8}, "two cells"),
        ({"cutoff_wavelength": 1e-3}, "must not exceed"),
        ({"correlation_length": None, "hurst": 1.2}, "hurst"),
        ({"correlation_length": None, "hurst": 0.0}, "hurst"),
        ({"correlation_length": None, "hurst": 0.8, "rolloff_wavelength": 1e-8}, "rolloff_wavelength"),
        (
            {"correlation_length": None, "hurst": 0.8, "rolloff_wavelength": 1e-6, "cutoff_wavelength": 2e-6},
            "rolloff_wavelength \\(1 um",
        ),
        ({"kurtosis": float("inf")}, "finite"),
    ],
)
def test_refusals(change, message):
    with pytest.raises(InputError, match=message):
        generate_surface(square(64), **(GOOD | change))


def test_all_mistakes_at_once():
    with pytest.raises(InputError) as caught:
        generate_surface(square(64), rms_height=-1, seed=-1, correlation_length=1e-6, hurst=0.8, kurtosis=0.5)
    assert len(caught.value.messages) == 4
    with pytest.raises(InputError) as caught:  # one length for both axes is one mistake
        generate_surface(square(64), rms_height=1e-7, seed=1, correlation_length=-1e-6)
    assert len(caught.value.messages) == 1


def test_grid_is_checked():
    with pytest.raises(InputError, match="grid"):
        generate_surface((64, 64), **GOOD)
    with pytest.raises(InputError, match="too small"):
        generate_surface(Grid((1, 3), (CELL, CELL)), **GOOD)


@pytest.mark.internal
@settings(max_examples=25, deadline=None)
@given(
    st.floats(-2.5, 2.5),
    st.floats(0.02, 8),
)
def test_distribution_has_the_moments(skewness, excess_over_bound):
    kurtosis = skewness**2 + 1 + excess_over_bound
    values = standard_quantiles(2**15, skewness, kurtosis)
    assert (np.diff(values) >= 0).all()
    assert np.mean(values) == pytest.approx(0, abs=1e-12)
    assert np.mean(values**2) == pytest.approx(1, rel=1e-12)
    # midpoint quantiles cut the tails off at 1/2^16: the fourth moment of a heavy tail loses a few per cent
    assert np.mean(values**3) == pytest.approx(skewness, abs=0.02 + 0.02 * abs(skewness))
    assert np.mean(values**4) == pytest.approx(kurtosis, rel=0.1)


@pytest.mark.internal
@settings(max_examples=30, deadline=None)
@given(
    st.integers(4, 40),
    st.integers(4, 40),
    st.floats(1e-10, 1e-2),
    st.integers(0, 2**70),
    st.floats(0.05, 1.0),
    st.floats(-3, 3),
    st.floats(0, 15),
)
def test_any_request_is_met_or_refused(nx, ny, rms, seed, hurst, skewness, kurtosis):
    grid = Grid((nx, ny), (1e-6, 2e-6))
    try:
        heights = generate_surface(grid, rms_height=rms, seed=seed, hurst=hurst, skewness=skewness, kurtosis=kurtosis)
    except InputError:
        return
    z = heights / rms
    assert np.mean(z**2) == pytest.approx(1, rel=1e-9)
    assert np.mean(z**3) == pytest.approx(skewness, abs=2 * STATISTICS_TOLERANCE)
    assert np.mean(z**4) == pytest.approx(kurtosis, abs=2 * STATISTICS_TOLERANCE)


@pytest.mark.internal
@settings(max_examples=40, deadline=None)
@given(
    st.integers(1, 40),
    st.integers(1, 40),
    st.floats(0.5, 20),
    st.floats(0.5, 20),
    st.sampled_from(["gaussian", "exponential"]),
    st.one_of(st.none(), st.floats(1, 30)),
    st.sampled_from([(0.0, 3.0), (-0.84, 4.46), (1.0, 2.5)]),
)
def test_any_correlation_is_met_or_refused(nx, ny, length_x, length_y, model, cutoff, moments):
    grid = Grid((nx, ny), (1e-6, 2e-6), periodic=PERIODIC)
    lengths = (length_x * 1e-6, length_y * 2e-6)
    try:
        heights = generate_surface(
            grid,
            rms_height=1e-7,
            seed=9,
            correlation_length=lengths,
            autocorrelation=model,
            cutoff_wavelength=None if cutoff is None else cutoff * 1e-6,
            skewness=moments[0],
            kurtosis=moments[1],
        )
    except InputError:
        return
    got = describe(heights, grid)
    assert got.Sq == pytest.approx(1e-7, rel=1e-9)
    if moments != (0.0, 3.0):
        assert got.Ssk == pytest.approx(moments[0], abs=2 * STATISTICS_TOLERANCE)
        assert got.Sku == pytest.approx(moments[1], abs=2 * STATISTICS_TOLERANCE)
        for n, wanted, given_ in zip(
            grid.shape, lengths, (got.autocorrelation_length_x, got.autocorrelation_length_y), strict=True
        ):
            if n > 1:
                assert given_ == pytest.approx(wanted, rel=SAMPLE_LENGTH_TOLERANCE + 1e-9)


@pytest.mark.internal
@given(arrays(np.float64, st.tuples(st.integers(1, 9), st.integers(1, 300)), elements=st.floats(-2, 2, width=16)))
def test_values_are_put_in_the_order_of_a_stable_sort(heights):
    """Few different heights, so that many are equal; zeros of both signs are one height."""
    target = np.arange(heights.size, dtype=float)
    expected = np.empty(heights.size)
    expected[np.argsort(heights, axis=None, kind="stable")] = target
    assert (in_order_of(heights.copy(), target).reshape(-1) == expected).all()
