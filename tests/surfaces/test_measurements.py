"""Several measurements of one surface: means, scatter, the averaged spectrum against a known one."""

import math

import numpy as np
import pytest

from bem.errors import InputError
from bem.grid import Grid
from bem.surfaces import Surface, describe_measurements, generate_surface, radial_spectrum
from bem.surfaces.measurements import mean_spectrum


def measured(seed, cells=128, spacing=1e-7, rms=1e-7):
    grid = Grid((cells, cells), (spacing, spacing), periodic=(True, True))
    heights = generate_surface(grid, rms_height=rms, seed=seed, hurst=0.7, rolloff_wavelength=3e-6)
    return Surface(heights, (spacing, spacing), {"periodic": [True, True], "detrend": "none"})


def test_means_and_scatter_are_those_of_the_values():
    found = describe_measurements([measured(1, rms=1e-7), measured(2, rms=1.1e-7), measured(3, rms=1.2e-7)])
    rms = found.parameters["Sq"]
    assert rms.values == pytest.approx((1e-7, 1.1e-7, 1.2e-7), rel=1e-9, abs=0)
    assert rms.mean == pytest.approx(1.1e-7, rel=1e-9, abs=0)
    assert rms.scatter == pytest.approx(1e-8, rel=1e-6, abs=0)
    assert 0 < rms.finite_size < rms.mean
    hurst = found.parameters["spectrum_hurst"]
    assert hurst.mean == pytest.approx(0.7, abs=0.03)
    assert 0 < hurst.scatter < 0.05
    with pytest.raises(InputError, match="1 map; give two or more"):
        describe_measurements([measured(1)])


def test_the_mean_spectrum_of_one_surface_twice_is_its_own_without_scatter():
    one = measured(4)
    mean = mean_spectrum([one, one])
    own = radial_spectrum(one.heights, one.spacing, periodic=(True, True))
    assert mean.scatter == pytest.approx(np.zeros(len(mean.scatter)), abs=1e-12)
    assert set(mean.measurements) == {2.0}
    # at long waves, where rings lie further apart than the wavenumbers
    first = np.interp(math.log(own.wavenumber[1]), np.log(mean.wavenumber), np.log(mean.density))
    assert math.exp(first) == pytest.approx(own.density[1], rel=0.15, abs=0)


def test_maps_of_two_sizes_join_to_one_spectrum_of_known_slope():
    """A fine small map and a coarse large one of one spectrum, amplitudes as of one surface: density ~ q^-3.4."""
    fine, coarse = measured(5, spacing=0.5e-7), measured(6, spacing=2e-7)
    spectra = [radial_spectrum(one.heights, one.spacing, periodic=(True, True)) for one in (fine, coarse)]
    level = [float(np.median(s.density[5:20] * s.wavenumber[5:20] ** 3.4)) for s in spectra]
    scaled = Surface(coarse.heights * math.sqrt(level[0] / level[1]), coarse.spacing, dict(coarse.metadata))
    mean = mean_spectrum([fine, scaled])
    assert mean.wavenumber[0] == pytest.approx(spectra[1].wavenumber[0], rel=1e-9, abs=0)
    assert mean.wavenumber[-1] == pytest.approx(spectra[0].wavenumber[-1], rel=1e-9, abs=0)
    assert (mean.measurements[0], mean.measurements[-1]) == (1, 1)
    assert math.isnan(mean.scatter[0])
    assert max(mean.measurements) == 2
    sloping = (mean.wavenumber > 2 * np.pi / 1.5e-6) & (mean.wavenumber < 2 * np.pi / 2e-7)
    slope = np.polyfit(np.log(mean.wavenumber[sloping]), np.log(mean.density[sloping]), 1)[0]
    assert slope == pytest.approx(-3.4, abs=0.1)


def test_the_scatter_of_random_amplitudes_falls_with_the_waves_of_a_ring():
    """Density of a ring of m waves, half of them mirrored, scatters by sqrt(2 / m)."""
    maps = [Surface(np.random.default_rng(seed).normal(size=(128, 128)), (1.0, 1.0), {}) for seed in range(24)]
    maps = [Surface(m.heights, m.spacing, {"periodic": [True, True]}) for m in maps]
    mean = mean_spectrum(maps)
    own = radial_spectrum(maps[0].heights, (1.0, 1.0), periodic=(True, True))
    edges = np.sqrt(mean.wavenumber[1:] * mean.wavenumber[:-1])
    modes = np.bincount(np.searchsorted(edges, own.wavenumber), own.modes, minlength=len(mean.wavenumber))
    many = modes > 200
    many[-1] = False  # the last ring alone ends the curve
    ratio = mean.scatter[many] / np.sqrt(2 / modes[many])
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.1)


def test_maps_that_are_not_self_affine_have_no_part_in_the_hurst_exponent():
    """The spectrum of a Gaussian autocorrelation falls faster than that of any self-affine surface."""
    grid = Grid((128, 128), (1e-7, 1e-7), periodic=(True, True))
    heights = generate_surface(grid, rms_height=1e-7, seed=3, correlation_length=1e-6)
    smooth = Surface(heights, (1e-7, 1e-7), {"periodic": [True, True]})
    found = describe_measurements([measured(1), smooth]).parameters
    alone = describe_measurements([measured(1), measured(1)]).parameters
    for name in ("spectrum_hurst", "spectrum_rolloff_wavelength"):
        assert found[name].known.size == 1
        assert found[name].mean == alone[name].mean
    assert found["Sq"].known.size == 2
