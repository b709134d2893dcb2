"""Material ratio curve and its parameters against heights whose curve is known in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.stats import norm

from bem import InputError
from bem.surfaces import material_ratio


def gaussian_parameters():
    """Sk, Spk, Svk, Smr1 of a Gaussian of unit Sq: the flattest 40 % lie about the middle, by symmetry."""
    lower, upper = norm.ppf(0.3), norm.ppf(0.7)
    # least squares of z over the ratio r = 1 - Phi(z) in the middle span: slope = cov(z, r) / var(r)
    covariance = quad(lambda z: z * (0.5 - norm.cdf(z)) * norm.pdf(z), lower, upper)[0] / 0.4
    core = -covariance / (0.4**2 / 12)
    top = core / 2
    ratio = norm.sf(top)
    area = quad(lambda z: (z - top) * norm.pdf(z), top, 12)[0]
    return core, 2 * area / ratio, ratio


def test_gaussian_heights_have_the_parameters_of_their_quantiles():
    count = 400_001
    found = material_ratio(3e-7 * norm.ppf((np.arange(count) + 0.5) / count))
    core, peak, ratio = gaussian_parameters()
    # midpoint sums over n heights: second order in the core, the outermost heights miss a few times 1/n of the tails
    assert found.Sk == pytest.approx(3e-7 * core, rel=1e-6)
    assert [found.Spk, found.Svk] == pytest.approx([3e-7 * peak] * 2, rel=1e-4)
    assert [found.Smr1, 1 - found.Smr2] == pytest.approx([ratio] * 2, abs=2 / count)


def test_a_plateau_with_grooves_has_deep_valleys_and_no_peaks():
    """Uniform heights on a plateau of depth d over 80 %, and grooves that fall linearly to depth D over the rest."""
    plateau, groove = 1e-7, 1e-6
    heights = np.r_[-plateau * np.linspace(0, 1, 8001), -plateau - groove * np.linspace(0, 1, 2001)[1:]]
    found = material_ratio(np.random.default_rng(0).permutation(heights))
    assert found.Sk == pytest.approx(plateau / 0.8, rel=1e-3)
    assert found.Spk < 1e-3 * plateau
    # the core's line leaves the groove's at ratio 0.8 + x where 0.2 of the core is lost: linear in both
    bottom, slope = 0.2 * found.Sk, groove / 0.2
    start = 0.8 + bottom / slope
    assert found.Smr2 == pytest.approx(start, abs=1e-3)
    assert found.Svk == pytest.approx(groove - bottom, rel=1e-2)


def test_a_flat_surface_has_no_core_and_short_maps_are_refused():
    found = material_ratio(np.full((4, 5), 2.5))
    assert [found.Sk, found.Spk, found.Svk, found.Smr1, found.Smr2] == [0, 0, 0, 0, 1]
    with pytest.raises(InputError, match="at least 10"):
        material_ratio(np.zeros(9))
    with pytest.raises(InputError, match="finite"):
        material_ratio(np.r_[np.zeros(20), np.nan])


@given(st.integers(0, 2**32 - 1), st.floats(1e-9, 1e3), st.floats(-1e3, 1e3))
def test_heights_upside_down_exchange_peaks_and_valleys(seed, factor, offset):
    heights = factor * (np.random.default_rng(seed).gamma(2.0, size=500) + offset)
    one, other = material_ratio(heights), material_ratio(-heights)
    tolerance = 1e-9 * factor * (1 + abs(offset))
    assert one.Sk == pytest.approx(other.Sk, abs=tolerance)
    assert one.Spk == pytest.approx(other.Svk, abs=tolerance)
    assert one.Smr1 == pytest.approx(1 - other.Smr2, abs=1e-12)
    ratio, height = one.thinned(50)
    assert ratio[[0, -1]] == pytest.approx([0.001, 0.999])
    assert np.all(np.diff(height) <= 0)
