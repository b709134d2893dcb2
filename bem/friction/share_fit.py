"""Least-squares fit of the contact share of the load over the lambda ratio, exp(-B Lambda^C), with standard errors.

The film carries the rest. Verified in tests/friction/test_load_share.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import InputError
from bem.grid import FloatArray

LEAST_POINTS = 4
_EDGE = 1e-3
_APART = 0.01
_STEPS = 100


@dataclass(frozen=True)
class LoadShare:
    """Contact share exp(-B Lambda^C); film share 1 - exp(-B Lambda^C).

    b, c : the constants. b_error, c_error : their standard errors. rms, largest : of the residuals of the share.
    points : number of points of the fit.
    """

    b: float
    c: float
    b_error: float
    c_error: float
    rms: float
    largest: float
    points: int

    def contact(self, lambda_ratio: ArrayLike) -> FloatArray:
        """Return the share of the load on the surfaces in contact."""
        return _share(np.array([math.log(self.b), self.c]), np.asarray(lambda_ratio, dtype=np.float64))

    def film(self, lambda_ratio: ArrayLike) -> FloatArray:
        """Return the share of the load on the film."""
        return 1 - self.contact(lambda_ratio)


def fit_load_share(lambda_ratio: ArrayLike, contact_share: ArrayLike) -> LoadShare:
    """Fit the contact share by the damped Gauss-Newton method, from the straight line of ln(-ln share) over ln Lambda.

    Parameters
    ----------
    lambda_ratio : (n,) film over roughness, positive.
    contact_share : (n,) of the load, 0 to 1.

    Returns
    -------
    LoadShare; errors from the residuals and the Jacobian, as of any non-linear least squares.

    Raises
    ------
    InputError : arrays of other shapes; fewer than four finite points; fewer than two where both carry, 1 % apart.
    """
    ratio, share = (np.asarray(values, dtype=np.float64).ravel() for values in (lambda_ratio, contact_share))
    if ratio.shape != share.shape:
        raise InputError(f"fit_load_share: {ratio.size} lambda ratios and {share.size} shares; give as many of each")
    good = np.isfinite(ratio) & np.isfinite(share) & (ratio > 0) & (share >= -1e-9) & (share <= 1 + 1e-9)
    ratio, share = ratio[good], np.clip(share[good], 0.0, 1.0)
    inside = (share > _EDGE) & (share < 1 - _EDGE)
    apart = inside.any() and np.ptp(np.log(ratio[inside])) > _APART
    if ratio.size < LEAST_POINTS or not apart:
        raise InputError(
            f"no fit of the load share to {ratio.size} point{'s' * (ratio.size != 1)}, {int(inside.sum())} of them "
            f"mixed; allowed: {LEAST_POINTS} or more (speeds or runs), two or more where film and contact both carry, "
            "at lambda ratios more than 1 % apart"
        )
    slope, line = np.polyfit(np.log(ratio[inside]), np.log(-np.log(share[inside])), 1)
    found = np.array([line, max(slope, 0.05)])
    for _ in range(_STEPS):
        residual, jacobian = share - _share(found, ratio), _jacobian(found, ratio)
        step = np.linalg.lstsq(jacobian, residual, rcond=None)[0]
        damping = 1.0
        while damping > 1e-6 and _square(share - _share(found + damping * step, ratio)) > _square(residual):
            damping /= 2
        found = found + damping * step
        if np.abs(damping * step).max() < 1e-12:
            break
    residual, jacobian = share - _share(found, ratio), _jacobian(found, ratio)
    variance = _square(residual) / max(ratio.size - 2, 1)
    errors = np.sqrt(variance * np.diag(np.linalg.pinv(jacobian.T @ jacobian)))
    b = math.exp(found[0])
    return LoadShare(
        b=b,
        c=float(found[1]),
        b_error=b * float(errors[0]),
        c_error=float(errors[1]),
        rms=math.sqrt(_square(residual) / ratio.size),
        largest=float(np.abs(residual).max()),
        points=int(ratio.size),
    )


class SharedCurve(Protocol):
    """Friction curve over its speeds (n,): lambda ratio, contact load and film load [N]."""

    @property
    def lambda_ratio(self) -> FloatArray:
        """Minimum of the film under the whole load over the rms height."""

    @property
    def contact_load(self) -> FloatArray:
        """Load of the rough contact [N]."""

    @property
    def film_load(self) -> FloatArray:
        """Load of the film [N]."""


def curves_load_share(curves: Iterable[SharedCurve | None]) -> LoadShare | None:
    """Fit the load share to the points of all curves that did not fail; None where there are too few points."""
    curves = [one for one in curves if one is not None]
    if not curves:
        return None
    ratio, contact, film = (
        np.concatenate([getattr(one, name) for one in curves]) for name in ("lambda_ratio", "contact_load", "film_load")
    )
    try:
        return fit_load_share(ratio, contact / (contact + film))
    except InputError:
        return None


def _share(constants: FloatArray, ratio: FloatArray) -> FloatArray:
    """Return exp(-B Lambda^C) from (ln B, C)."""
    return np.exp(-np.exp(np.minimum(constants[0] + constants[1] * np.log(ratio), 50.0)))


def _jacobian(constants: FloatArray, ratio: FloatArray) -> FloatArray:
    """Return the Jacobian (n, 2) of the share in (ln B, C)."""
    exponent = np.exp(np.minimum(constants[0] + constants[1] * np.log(ratio), 50.0))
    slope = -np.exp(-exponent) * exponent
    return np.stack([slope, slope * np.log(ratio)], axis=1)


def _square(values: FloatArray) -> float:
    return float(values @ values)
