"""Load share over lambda fitted to exp(-B Lambda^C): synthetic data of known constants, with and without noise."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import curve_fit

from bem import InputError
from bem.friction.share_fit import curves_load_share, fit_load_share


class CurveRows(NamedTuple):
    lambda_ratio: np.ndarray
    contact_load: np.ndarray
    film_load: np.ndarray


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


@pytest.mark.parametrize("b", [0.2, 3.0])
def test_errors_are_those_of_least_squares_in_the_constants_themselves(b):
    """A fit in (B, C) instead of (ln B, C) has the same least squares, and the same errors of either constant."""
    noise = np.random.default_rng(11).normal(0, 0.01, RATIO.size)
    share = np.clip(np.exp(-b * RATIO**1.4) + noise, 0, 1)
    fit = fit_load_share(RATIO, share)
    best, covariance = curve_fit(lambda ratio, b, c: np.exp(-b * ratio**c), RATIO, share, (b, 1.4))
    # derivatives of the other fit are differences
    assert (fit.b, fit.c) == pytest.approx(tuple(best), rel=1e-5)
    assert (fit.b_error, fit.c_error) == pytest.approx(tuple(np.sqrt(np.diag(covariance))), rel=1e-4)


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


@pytest.mark.internal
def test_a_stribeck_curves_fit_is_in_the_summary_for_each_model():
    from types import SimpleNamespace

    from bem.kinds.friction.record import summarise

    def record(b):
        share = np.exp(-b * RATIO**1.4)
        return SimpleNamespace(
            lambda_ratio=RATIO, contact_load=5.5 * share, film_load=5.5 * (1 - share), friction=0.09 * share
        )

    axes = [SimpleAxis((5.5,)), SimpleAxis(("",)), SimpleAxis(("capped", "uncoupled")), SimpleAxis((0, 1))]
    records = [record(0.6), record(0.6), record(0.9), None]
    rows = summarise(None, axes, records)["load_share"]
    assert [row["model"] for row in rows] == ["capped", "uncoupled"]
    assert [row["b"] for row in rows] == pytest.approx([0.6, 0.9], rel=1e-7)
    assert [row["points"] for row in rows] == [50, 25]
    assert "load_share" not in summarise(None, axes, [None] * 4)


class SimpleAxis:
    """Values of an axis, and how many."""

    def __init__(self, values):
        self.values = values

    def __len__(self):
        return len(self.values)


@pytest.mark.internal
def test_curves_are_fitted_together_and_too_few_points_give_no_fit():
    share = np.exp(-0.6 * RATIO**1.4)
    parts = [
        CurveRows(RATIO[part], 5.5 * share[part], 5.5 * (1 - share[part])) for part in (slice(0, 12), slice(12, 25))
    ]
    fit = curves_load_share(parts)
    assert fit.points == RATIO.size
    assert (fit.b, fit.c) == pytest.approx((0.6, 1.4), rel=1e-7)  # round-off, as above
    assert curves_load_share([]) is None
    assert curves_load_share([CurveRows(RATIO[:3], share[:3], 1 - share[:3])]) is None
