"""Flow factors of rough surfaces: Patir and Cheng's curves, perturbation theory, grooves and the effective medium.

The surface pattern parameter gamma (Peklenik's number) is the ratio of the correlation lengths along and across the
flow: 0 are grooves across it, 1 isotropic, infinity grooves along. H is separation over the rms height of both
surfaces.

Patir and Cheng's curves are fits to means of flow simulations on small patches with sealed sides, heights above the
separation being cut off. Isotropic patches of `bem.flow` (24 correlation lengths a side, 4 cells each, means of three)
lie within 0.05 of their phi_x from H = 2 on and 0.1 above it at H = 1; patches scatter by 0.1 there among themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray


@dataclass(frozen=True)
class PatirChengFit:
    """One row of the tables of Patir and Cheng, Journal of Lubrication Technology 100 (1978) 12 (pressure: C, r, least
    H) and 101 (1979) 220 (shear: A1, alpha1, alpha2, alpha3, A2)."""

    pressure: tuple[float, float, float]
    shear: tuple[float, float, float, float, float]


PATIR_CHENG: dict[float, PatirChengFit] = {
    1 / 9: PatirChengFit((1.48, 0.42, 1.0), (2.046, 1.12, 0.78, 0.03, 1.856)),
    1 / 6: PatirChengFit((1.38, 0.42, 1.0), (1.962, 1.08, 0.77, 0.03, 1.754)),
    1 / 3: PatirChengFit((1.18, 0.42, 0.75), (1.858, 1.01, 0.76, 0.03, 1.561)),
    1.0: PatirChengFit((0.90, 0.56, 0.5), (1.899, 0.98, 0.92, 0.05, 1.126)),
    3.0: PatirChengFit((0.225, 1.5, 0.5), (1.560, 0.85, 1.13, 0.08, 0.556)),
    6.0: PatirChengFit((0.520, 1.5, 0.5), (1.290, 0.62, 1.09, 0.08, 0.388)),
    9.0: PatirChengFit((0.870, 1.5, 0.5), (1.011, 0.54, 1.07, 0.08, 0.295)),
}


def patir_cheng_pressure(ratio: FloatArray, gamma: float = 1.0) -> FloatArray:
    """phi_x at H = `ratio` for a gamma of `PATIR_CHENG`: 1 - C exp(-r H) up to gamma = 1, 1 + C H^-r above. Fitted from
    H = 0.5 (0.75 for 1/3, 1 for less); below it the fit is not theirs.

    Raises
    ------
    InputError : a gamma they give no constants for.
    """
    c, r, _ = _row(gamma).pressure
    h = np.asarray(ratio, dtype=np.float64)
    return np.asarray(1 - c * np.exp(-r * h) if gamma <= 1 else 1 + c * h**-r)


def patir_cheng_shear(ratio: FloatArray, gamma: float = 1.0) -> FloatArray:
    """Phi_s of roughness on one wall: A1 H^alpha1 exp(-alpha2 H + alpha3 H^2) up to H = 5, A2 exp(-H/4) beyond.

    Raises
    ------
    InputError : a gamma they give no constants for.
    """
    a1, one, two, three, a2 = _row(gamma).shear
    h = np.asarray(ratio, dtype=np.float64)
    return np.asarray(np.where(h <= 5, a1 * h**one * np.exp(-two * h + three * h * h), a2 * np.exp(-0.25 * h)))


def perturbed_factors(ratio: FloatArray, gamma: float = 1.0) -> tuple[FloatArray, FloatArray]:
    """(phi_x, phi_s) to second order in 1/H: 1 + 3 (gamma - 2)/((gamma + 1) H^2) and 3/((1 + gamma) H).

    With h = d (1 + e), h^3 is 1 + 3 e + 3 e^2: the mean gives 1 + 3 <e^2>; the fluctuation 3 e takes away
    9 <e^2> <q_x^2/q^2>, the last mean being over the power spectrum, 1/(1 + gamma) of an elliptic one. After Tripp,
    Journal of Lubrication Technology 105 (1983) 458; programs that have 1 + gamma^2 there are right for gamma = 1 only.
    """
    h = np.asarray(ratio, dtype=np.float64)
    return np.asarray(1 + 3 * (gamma - 2) / ((gamma + 1) * h * h)), np.asarray(3 / ((1 + gamma) * h))


def patir_cheng_friction(ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(phi_f, phi_fp) of isotropic surfaces.

    phi_f is the mean of d/h over heights with the density 35/96 (1 - (z/3s)^2)^3, gaps under s/100 left out, in closed
    form; phi_fp = 1 - 1.40 exp(-0.66 H).
    """
    h = np.asarray(ratio, dtype=np.float64)
    z = h / 3
    near = np.polyval([147, 60, -405, -160, 345, 132, -55], z) / 60
    rest = (1 - z**2) ** 3
    far = z / 15 * (66 + z**2 * (30 * z**2 - 80))
    with np.errstate(divide="ignore", invalid="ignore"):
        log = np.where(z <= 1, np.log(300 * (z + 1)), np.log((z + 1) / (z - 1)))
    part = np.where(rest == 0, 0.0, rest * np.where(np.isfinite(log), log, 0.0))
    # the far form cancels: 66 z/15 - ... against the logarithm, to 1e-16 z^7
    return np.asarray(35 / 32 * z * (part + np.where(z <= 1, near, far))), np.asarray(1 - 1.40 * np.exp(-0.66 * h))


def groove_factors(gap: FloatArray) -> tuple[float, float, float]:
    """(K across, K along, M across) of grooves with equally wide steps of `gap`: flow across meets <h^-3>, along <h^3>;
    a wall that slides across drags <h^-2>/<h^-3>. Any unit; 0 across where a gap is 0."""
    h = np.asarray(gap, dtype=np.float64).reshape(-1)
    along = float((h**3).mean())
    if (h <= 0).any():
        return 0.0, along, 0.0
    across = 1 / float((h**-3).mean())
    return across, along, across * float((h**-2).mean())


def effective_medium(gap: FloatArray) -> float:
    """K of an isotropic patch whose h^3 are as found, without correlation: <(h^3 - K)/(h^3 + K)> = 0 (Bruggeman 1935).

    Zero from half the area in contact on, where continuous isotropic fields percolate.
    """
    from scipy.optimize import brentq

    cube = np.asarray(gap, dtype=np.float64).reshape(-1) ** 3
    if (cube > 0).mean() <= 0.5:
        return 0.0
    largest = float(cube.max())
    share = cube / largest
    return largest * float(brentq(lambda k: float(((share - k) / (share + k)).mean()), 1e-12, 1.0))


def _row(gamma: float) -> PatirChengFit:
    found = [row for value, row in PATIR_CHENG.items() if abs(value / gamma - 1) < 1e-6]
    if not found:
        allowed = ", ".join(f"{value:.4g}" for value in PATIR_CHENG)
        raise InputError(f"patir_cheng: gamma {gamma!r} is not tabulated; allowed: {allowed}")
    return found[0]
