"""Height distributions with given skewness and kurtosis, as a sorted, standardised sample."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq
from scipy.special import betaincinv, gammaincinv, ndtri

from bem.grid import FloatArray


def standard_quantiles(count: int, skewness: float, kurtosis: float) -> FloatArray:
    """`count` increasing values of zero mean and unit rms from a distribution with these moments.

    Below the gamma line, kurtosis < 3 + 1.5 skewness^2: Pearson's type I (beta), whose parameters are closed forms of
    the moments. Above the lognormal line: Johnson's unbounded system, x = sinh((N - g)/d). Between: mixtures of the
    gamma and the lognormal of that skewness, quantile by quantile. kurtosis = skewness^2 + 1 is the two-point
    distribution, which the beta tends to. A finite sample has a little less in its tails than the distribution.
    """
    probability = (np.arange(count) + 0.5) / count
    sign = -1.0 if skewness < 0 else 1.0
    # below a thousandth the skewness is lost in the differences of nearly equal parameters: taken as none
    s, k = abs(skewness) if abs(skewness) > 1e-3 else 0.0, kurtosis
    if k < 3 + 1.5 * s * s - 1e-9:
        values = _beta(probability, s, k)
    else:
        omega = _lognormal_omega(s)
        lognormal_kurtosis = omega**4 + 2 * omega**3 + 3 * omega**2 - 3
        if k > lognormal_kurtosis + 1e-9:
            values = _johnson_unbounded(probability, s, k, omega)
        else:
            lower = 3 + 1.5 * s * s
            fraction = (k - lower) / (lognormal_kurtosis - lower) if lognormal_kurtosis > lower + 1e-9 else 0.0
            values = (1 - fraction) * _gamma(probability, s) + fraction * _lognormal(probability, omega)
    values = sign * values
    if sign < 0:
        values = values[::-1]
    values = values - values.mean()
    return np.asarray(values / np.sqrt(np.mean(values**2)))


def _beta(probability: FloatArray, s: float, k: float) -> FloatArray:
    """Pearson type I by moments (Johnson, Kotz & Balakrishnan, *Continuous Univariate Distributions* 2, 25.4)."""
    r = 6 * (k - s * s - 1) / (6 + 3 * s * s - 2 * k)  # sum of both exponents
    r = max(r, 1e-6)
    root = (r + 2) * s / math.sqrt((r + 2) ** 2 * s * s + 16 * (r + 1))
    p, q = r / 2 * (1 - root), r / 2 * (1 + root)  # skewed to the right for p < q
    return np.asarray(betaincinv(max(p, 1e-9), max(q, 1e-9), probability))


def _gamma(probability: FloatArray, s: float) -> FloatArray:
    if s < 1e-6:
        return np.asarray(ndtri(probability))
    shape = 4 / (s * s)
    return np.asarray((gammaincinv(shape, probability) - shape) / math.sqrt(shape))


def _lognormal_omega(s: float) -> float:
    """omega with (omega - 1)(omega + 2)^2 = skewness^2."""
    root = (1 + s * s / 2 + s * math.sqrt(1 + s * s / 4)) ** (1 / 3)
    return root + 1 / root - 1


def _lognormal(probability: FloatArray, omega: float) -> FloatArray:
    width = math.sqrt(math.log(omega)) if omega > 1 + 1e-12 else 0.0
    normal = ndtri(probability)
    if width < 1e-6:
        return np.asarray(normal)
    return np.asarray((np.exp(width * normal) - math.sqrt(omega)) / math.sqrt(omega * (omega - 1)))


def _johnson_unbounded(probability: FloatArray, s: float, k: float, omega_lognormal: float) -> FloatArray:
    """Johnson SU with omega = exp(1/d^2) and Omega = g/d found from the moments.

    Tuenter, *J. Stat. Comput. Simul.* 70 (2001) 325, solves the same pair of equations.
    """

    def shape(omega: float, big: float) -> tuple[float, float]:
        variance = 0.5 * (omega - 1) * (omega * math.cosh(2 * big) + 1)
        third = 0.25 * math.sqrt(omega) * (omega - 1) ** 2
        third *= omega * (omega + 2) * math.sinh(3 * big) + 3 * math.sinh(big)
        fourth = omega**2 * (omega**4 + 2 * omega**3 + 3 * omega**2 - 3) * math.cosh(4 * big)
        fourth = (fourth + 4 * omega**2 * (omega + 2) * math.cosh(2 * big) + 3 * (2 * omega + 1)) * (omega - 1) ** 2 / 8
        return third / variance**1.5, fourth / variance**2

    def skew_angle(omega: float) -> float:
        if s == 0:
            return 0.0
        return float(brentq(lambda big: shape(omega, big)[0] - s, 0.0, 40.0, xtol=1e-14))

    # omega of the symmetric member with this kurtosis bounds it from above
    upper = math.sqrt(math.sqrt(2 * k - 2) - 1)
    lower = omega_lognormal * (1 + 1e-9)
    if s == 0:
        omega = upper
    else:
        while shape(lower, 40.0)[0] <= s:
            lower = 1 + (lower - 1) * (1 + 1e-6)
        omega = float(brentq(lambda w: shape(w, skew_angle(w))[1] - k, lower, upper, xtol=1e-13))
    big = skew_angle(omega)
    delta = 1 / math.sqrt(math.log(omega))
    # positive skewness: x = sinh(N/delta + Omega)
    return np.asarray(np.sinh(ndtri(probability) / delta + big))
