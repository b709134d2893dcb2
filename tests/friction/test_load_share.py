"""Load share over lambda fitted to exp(-B Lambda^C): synthetic data of known constants, with and without noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import InputError
from bem.friction.load_share import fit_load_share

RATIO = np.geomspace(0.05, 5.0, 25)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.2, 3.0), st.floats(0.3, 3.0))
def test_exact_data_give_their_constants(b, c):
    fit = fit_load_share(RATIO, np.exp(-b * RATIO**c))
    # exact data: round-off of the normal equations alone
    assert fit.b == pytest.approx(b, rel=1e-7)
    assert fit.c == pytest.approx(c, rel=1e-7)
    assert fit.rms < 1e-9
    np.testing.assert_allclose(fit.contact(RATIO) + fit.film(RATIO), 1.0, rtol=1e-15)


def test_noise_is_in_the_errors():
    noise, misses = np.random.default_rng(7), 0
    for _ in range(60):
        share = np.clip(np.exp(-0.6 * RATIO**1.4) + noise.normal(0, 0.01, RATIO.size), 0, 1)
        fit = fit_load_share(RATIO, share)
        misses += (abs(fit.b - 0.6) > 2 * fit.b_error) + (abs(fit.c - 1.4) > 2 * fit.c_error)
    # two standard errors are missed by 5 % of 120; noise is cut at the ends, which makes it a few more or fewer
    assert 0 < misses < 20


def test_points_out_of_range_do_not_count_and_too_few_are_refused():
    share = np.exp(-0.6 * RATIO**1.4)
    fit = fit_load_share(np.r_[RATIO, np.inf, np.nan, -1], np.r_[share, 0.0, 0.5, 0.5])
    assert fit.points == 25
    with pytest.raises(InputError, match="2 points"):
        fit_load_share([0.1, 1.0], [0.9, 0.4])
    with pytest.raises(InputError, match="0 of them mixed"):
        fit_load_share(RATIO, np.zeros(25))
    with pytest.raises(InputError, match="as many"):
        fit_load_share(RATIO, share[:3])
