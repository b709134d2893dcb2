"""Frequency response of a bonded layer on a half-space: three displacements and six stresses at any depth.

Derivation. With fields proportional to exp(i k.x), q = |k|, e along k, t across it and z into the body, write
u_e = i u, u_z = w, sigma_ez = i tau, sigma_zz = sigma. In the plane (e, z) Hooke's law and equilibrium are
y' = q M y for y = (u, w, tau / 2 G q, sigma / 2 G q), with c = 1/(1 - nu) and

    M = [[0, -1, 2, 0], [c-1, 0, 0, 2-c], [c, 0, 0, 1-c], [0, 0, 1, 0]],     (M^2 - 1)^2 = 0,

so that exp(M s) is made of cosh s, sinh s, s sinh s and s cosh s - sinh s only, and nothing is singular at nu = 1/2.
The in-plane direct stresses follow from the state: sigma_ee = -c u + (c-1) sigma, sigma_tt = (c-1)(sigma - u), in
units of 2 G q. In the sums and differences p = u + w, n = u - w, P = tau + sigma, N = tau - sigma (kappa = 3 - 4 nu):

- waves that decay downwards, at distance s (times q): p, n - 2 s p / kappa, P = -p / kappa, N = -n, all times exp(-s);
- waves that decay upwards: n, p - 2 s n / kappa, P = p, N = n / kappa, all times exp(-s);
- the interface reflects p and n independently, with factors l / kappa1 and kappa1 k,
  l = (m kappa2 - kappa1)/(m kappa2 + 1), k = (m - 1)/(m + kappa1), m = G1/G2.

With x = q h and E = exp(-2 x) the surface condition is a 2 x 2 system of determinant
(1 - l E)(1 - k E) - 4 x^2 k E: the closed form of the literature for the normal displacement comes out of it. Only
decaying exponentials occur, so nothing overflows. For x < 1 that system cancels when the moduli differ much (by eps m^2
as x -> 0), and the waves do near the interface of a soft layer; there the state is carried up from the interface by
exp(-M s) instead, which keeps its relative accuracy for any ratio. Across the plane (anti-plane shear) there is one
reflection r = (m - 1)/(m + 1).

Everything here is analytic in q, and the core takes complex q: the free-space coefficients turn the path of integration
into the complex plane. The largest stress and displacement are right to some 1e-13 (`tests/kernels/test_layered.py`).
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError
from bem.materials import Body

FloatArray = NDArray[np.float64]

# Rows of `wave_functions`: under unit pressure, then under unit traction along k, then under unit traction across k.
NORMAL_U, NORMAL_W, NORMAL_TAU, NORMAL_SIGMA, NORMAL_EE, NORMAL_TT = range(6)
TANGENTIAL_U, TANGENTIAL_W, TANGENTIAL_TAU, TANGENTIAL_SIGMA, TANGENTIAL_EE, TANGENTIAL_TT = range(6, 12)
ACROSS_U, ACROSS_ET, ACROSS_TZ = range(12, 15)
ROWS = 15


_SERIES = tuple(
    2 * j / math.factorial(2 * j + 1) for j in range(10, 0, -1)
)  # the last term is 1e-18 of the sum at s = 1


@numba.njit(cache=True, error_model="numpy")
def _s_cosh_less_sinh(s):  # type: ignore[no-untyped-def]
    """s cosh s - sinh s for |s| <= 1 by its series, free of cancellation."""
    s2 = s * s
    total = s2 * 0.0
    for coefficient in _SERIES:
        total = total * s2 + coefficient
    return total * s2 * s


@numba.njit(cache=True, error_model="numpy")
def _wave(q, z, h, g1, nu1, g2, nu2, remainder, out):  # type: ignore[no-untyped-def]
    """Fill `out` (ROWS,) for one wavenumber; see `wave_functions`."""
    m = g1 / g2
    g = g2 / g1
    kappa1 = 3.0 - 4.0 * nu1
    kappa2 = 3.0 - 4.0 * nu2
    c1 = 1.0 / (1.0 - nu1)
    c2 = 1.0 / (1.0 - nu2)
    x = q * h
    in_layer = z <= h
    small = abs(x) < 1.0
    sinh_x, cosh_x = np.sinh(x) if small else x * 0.0, np.cosh(x) if small else x * 0.0
    decay = np.exp(-x)
    decay_z = np.exp(-q * z)
    zeta = (2.0 - 2.0 * nu2) / kappa2  # the substrate's impedance is [[-zeta, eta], [eta, -zeta]] (times 2 G2 q)
    eta = (1.0 - 2.0 * nu2) / kappa2
    k = (m - 1.0) / (m + kappa1)  # reflected parts of n and p (over and times kappa1), and the parts that pass
    ell = (m * kappa2 - kappa1) / (m * kappa2 + 1.0)
    through_n = (1.0 + kappa1) * m / (m + kappa1)
    through_p = (1.0 + kappa1) / kappa1 * m * kappa2 / (m * kappa2 + 1.0)

    # by waves far above the interface, else carried up from it: the waves cancel where the layer is soft
    carried = small or (abs(q * (h - z)) < 1.0 and not remainder)
    for load in range(2):
        tau0 = float(load)  # traction along k
        sigma0 = load - 1.0  # pressure
        total0 = tau0 + sigma0
        difference0 = tau0 - sigma0
        p0, n0 = -kappa1 * total0, -difference0  # the half-space of the layer's material
        dp, dn, p_interface, n_interface = x * 0.0, x * 0.0, x * 0.0, x * 0.0
        if small:
            gamma = 0.5 * c1 * x * sinh_x
            delta = 0.5 * c1 * _s_cosh_less_sinh(x)
            tt, ts = cosh_x + gamma, (c1 - 1.0) * sinh_x + delta
            st, ss = -sinh_x - delta, cosh_x - gamma
            a11 = -c1 * sinh_x - delta + g * (-tt * zeta + ts * eta)
            a12 = -gamma + g * (tt * eta - ts * zeta)
            a21 = gamma + g * (-st * zeta + ss * eta)
            a22 = delta + g * (st * eta - ss * zeta)
            determinant = a11 * a22 - a12 * a21
            u = (a22 * tau0 - a12 * sigma0) / determinant
            w = (a11 * sigma0 - a21 * tau0) / determinant
        else:
            square = decay * decay
            a11 = 1.0 - (ell + 4.0 * x * x * k) * square
            a12 = 2.0 * x * k * kappa1 * square
            a21 = 2.0 * x * k * square / kappa1
            a22 = 1.0 - k * square
            determinant = a11 * a22 - a12 * a21
            r1 = (1.0 - a11) * p0 - a12 * n0
            r2 = (1.0 - a22) * n0 - a21 * p0
            dp = (a22 * r1 - a12 * r2) / determinant
            dn = (a11 * r2 - a21 * r1) / determinant
            p_interface = (p0 + dp) * decay
            n_interface = (n0 + dn - 2.0 * x * (p0 + dp) / kappa1) * decay
            p = through_p * p_interface
            n = through_n * n_interface
            u, w = 0.5 * (p + n), 0.5 * (p - n)
        tau = g * (-zeta * u + eta * w)
        sigma = g * (eta * u - zeta * w)
        if in_layer and carried:
            s = q * (h - z)
            sinh_s, cosh_s = np.sinh(s), np.cosh(s)
            gamma = 0.5 * c1 * s * sinh_s
            delta = 0.5 * c1 * _s_cosh_less_sinh(s)
            u, w, tau, sigma = (
                (cosh_s + gamma) * u + (sinh_s + delta) * w - (2.0 * sinh_s + delta) * tau - gamma * sigma,
                -((c1 - 1.0) * sinh_s + delta) * u
                + (cosh_s - gamma) * w
                + gamma * tau
                + (delta - (2.0 - c1) * sinh_s) * sigma,
                -(c1 * sinh_s + delta) * u - gamma * w + (cosh_s + gamma) * tau + ((c1 - 1.0) * sinh_s + delta) * sigma,
                gamma * u + delta * w - (sinh_s + delta) * tau + (cosh_s - gamma) * sigma,
            )
            if remainder:
                p, n = p0 * decay_z, (n0 - 2.0 * q * z * p0 / kappa1) * decay_z
                u -= 0.5 * (p + n)
                w -= 0.5 * (p - n)
                tau -= 0.5 * (-p / kappa1 - n)
                sigma -= 0.5 * (-p / kappa1 + n)
        elif in_layer:
            s = q * (h - z)
            back = np.exp(-s)
            p_up, n_up = ell / kappa1 * p_interface, kappa1 * k * n_interface
            p_up, n_up = (p_up - 2.0 * s * n_up / kappa1) * back, n_up * back
            p_down, n_down = (dp, dn) if remainder else (p0 + dp, n0 + dn)
            p_down, n_down = p_down * decay_z, (n_down - 2.0 * q * z * p_down / kappa1) * decay_z
            total = -p_down / kappa1 + p_up
            difference = -n_down + n_up / kappa1
            u, w = 0.5 * (p_down + p_up + n_down + n_up), 0.5 * (p_down + p_up - n_down - n_up)
            tau, sigma = 0.5 * (total + difference), 0.5 * (total - difference)
        c, ratio = c1, 1.0
        if not in_layer:
            c, ratio = c2, g
            s = q * (z - h)
            rho = -(u + w) / kappa2 * s
            fall = np.exp(-s)
            u, w = (u + rho) * fall, (w - rho) * fall
            tau, sigma = (tau - g * rho) * fall, (sigma + g * rho) * fall
        row = 6 * load
        out[row] = u
        out[row + 1] = w
        out[row + 2] = tau
        out[row + 3] = sigma
        out[row + 4] = -c * ratio * u + (c - 1.0) * sigma
        out[row + 5] = (c - 1.0) * (sigma - ratio * u)

    r = (m - 1.0) / (m + 1.0)
    if small:
        denominator = 2.0 / (m + 1.0) + 2.0 * r * decay * sinh_x
    else:
        denominator = 1.0 - r * decay * decay
    if in_layer:
        s = q * (h - z)
        back = np.exp(-s)
        towards = decay_z * (r * decay * decay) if remainder else decay_z
        away = r * decay * back
        if carried and not remainder:  # the sums below, free of cancellation as r -> 1 or -1
            rise = 2.0 * r * back * np.sinh(s)
            out[13] = decay_z * (2.0 * m / (m + 1.0) - rise) / denominator
            out[14] = -decay_z * (2.0 / (m + 1.0) + rise) / denominator
        else:
            out[13] = (towards + away) / denominator
            out[14] = -(towards - away) / denominator
        out[12] = 2.0 * out[13]
    else:
        out[12] = 4.0 * m / (m + 1.0) * decay_z / denominator
        out[13] = 2.0 / (m + 1.0) * decay_z / denominator
        out[14] = -out[13]


@numba.njit(cache=True, error_model="numpy")
def _waves(q, z, h, g1, nu1, g2, nu2, remainder, out):  # type: ignore[no-untyped-def]
    column = np.empty(15, out.dtype)
    for i in range(q.size):
        _wave(q[i], z, h, g1, nu1, g2, nu2, remainder, column)
        out[:, i] = column


def wave_functions(wavenumber: NDArray, body: Body, depth: float, *, remainder: bool = False) -> NDArray:
    """Response of a coated body to unit tractions exp(i k.x) on its surface, in the frame of the wavevector.

    Parameters
    ----------
    wavenumber : (n,) q [rad/m], real and not negative, or complex with a positive real part.
    body : with a layer.
    depth : z [m], not negative; the interface itself counts as layer.
    remainder : leave out the half-space of the layer's material (only for depths in the layer). What is left decays
        like exp(-q (2 h - z)), is computed without cancellation, and vanishes for identical materials.

    Returns
    -------
    (15, n) of the type of `wavenumber`; the names of the rows stand in this module. Rows 0-5 are u, w, tau, sigma,
    sigma_ee, sigma_tt under a unit pressure; rows 6-11 the same under tau = 1 on the surface; rows 12-14 are V,
    sigma_et / i and sigma_tz under sigma_tz = -1. Displacements are multiplied by 2 G1 q.
    """
    layer = _layer(body)
    if remainder and depth > layer.thickness:
        raise InputError(f"depth {depth!r}: the remainder is defined in the layer only (0 to {layer.thickness!r} m)")
    q = np.ascontiguousarray(wavenumber).ravel()
    out = np.empty((ROWS, q.size), dtype=q.dtype)
    _waves(
        q,
        float(depth),
        layer.thickness,
        layer.material.shear_modulus,
        layer.material.poissons_ratio,
        body.material.shear_modulus,
        body.material.poissons_ratio,
        remainder,
        out,
    )
    return out


def surface_response(
    kx: ArrayLike, ky: ArrayLike, body: Body, *, tangential: bool, remainder: bool = False
) -> FloatArray:
    """Normal surface displacement [m/Pa] under a unit traction exp(i k.x): pressure, or a traction along +x.

    kx and ky [rad/m] broadcast. Under pressure the spectrum is the result; under a tangential traction it is i times
    the result (odd in kx). Zero where k = 0: there is no limit. `remainder` as in `wave_functions`.
    """
    cosine, _, q = _directions(kx, ky)
    functions = wave_functions(q, body, 0.0, remainder=remainder)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(q > 0, 0.5 / (_layer(body).material.shear_modulus * q), 0.0)
    if tangential:
        return scale * cosine * functions[TANGENTIAL_W].reshape(q.shape)
    return scale * functions[NORMAL_W].reshape(q.shape)


def stress_response(
    kx: ArrayLike, ky: ArrayLike, body: Body, depth: float, *, tangential: bool, remainder: bool = False
) -> FloatArray:
    """Six stresses at `depth` under a unit traction exp(i k.x): pressure, or a traction along +x.

    kx and ky [rad/m] broadcast; -> (6, ...) in the order xx yy zz yz xz xy, real. The spectrum is the result where the
    stress is even under (x, y) -> (-x, -y), and i times the result where it is odd: yz and xz under pressure, the other
    four under traction. At k = 0: the laterally constrained uniform state. `remainder` as in `wave_functions`.
    """
    cosine, sine, q = _directions(kx, ky)
    f = wave_functions(q, body, depth, remainder=remainder).reshape(ROWS, *q.shape)
    stress = np.empty((6, *q.shape))
    if tangential:
        tau, sigma, ee, tt = f[TANGENTIAL_TAU], f[TANGENTIAL_SIGMA], f[TANGENTIAL_EE], f[TANGENTIAL_TT]
        across, below = f[ACROSS_ET], f[ACROSS_TZ]
        stress[0] = cosine * (cosine**2 * ee + sine**2 * (tt + 2 * across))
        stress[1] = cosine * (sine**2 * (ee - 2 * across) + cosine**2 * tt)
        stress[2] = cosine * sigma
        stress[3] = -sine * cosine * (tau + below)
        stress[4] = sine**2 * below - cosine**2 * tau
        stress[5] = sine * (cosine**2 * (ee - tt) - (cosine**2 - sine**2) * across)
        uniform = (0.0, 0.0, 0.0, 0.0, -1.0, 0.0)
    else:
        tau, sigma, ee, tt = f[NORMAL_TAU], f[NORMAL_SIGMA], f[NORMAL_EE], f[NORMAL_TT]
        stress[0] = cosine**2 * ee + sine**2 * tt
        stress[1] = sine**2 * ee + cosine**2 * tt
        stress[2] = sigma
        stress[3] = sine * tau
        stress[4] = cosine * tau
        stress[5] = sine * cosine * (ee - tt)
        layer = _layer(body)
        nu = (layer.material if depth <= layer.thickness else body.material).poissons_ratio
        lateral = -nu / (1 - nu)
        uniform = (lateral, lateral, -1.0, 0.0, 0.0, 0.0)
    at_rest = q == 0
    for component in range(6):
        stress[component][at_rest] = 0.0 if remainder else uniform[component]
    return stress


def _layer(body: Body):  # type: ignore[no-untyped-def]
    if body.layer is None:
        raise InputError(f"body of {body.material.name!r}: has no layer; the homogeneous kernels serve it")
    return body.layer


def _directions(kx: ArrayLike, ky: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Cosine and sine of the wavevector's direction (1, 0 where k = 0) and its length."""
    kx, ky = np.broadcast_arrays(np.asarray(kx, dtype=np.float64), np.asarray(ky, dtype=np.float64))
    q = np.hypot(kx, ky)
    divisor = np.where(q > 0, q, 1.0)
    return np.where(q > 0, kx / divisor, 1.0), ky / divisor, q
