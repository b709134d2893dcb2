"""Waves in a stack of bonded layers on a half-space, one wavenumber at a time: impedances upwards, displacements down.

The equations stand in `layered`. In each medium the state (u, w, tau, sigma) is in units of its own 2 G q; `g` is a
modulus over that of the outermost layer. All 2 x 2 matrices that relate displacement to traction are symmetric
(reciprocity) and held as three numbers (uu, uw, ww).

- `_climb` goes up: from the impedance Z of what lies below a layer, (tau, sigma) = Z (u, w), to that on its top. A
  layer of q h < 1 takes the matrix exponential (`_Thin`), a thicker one reflection and a round trip of decaying waves.
- `_descend` goes down: from the load on the surface to the displacement on the interface below the medium asked for.
  Only displacements are handed on: (Zu - Z)^-1 of two definite matrices cannot cancel, whatever the moduli.
- `_state_inside` gives the state at a depth: carried up from the interface by the matrix exponential within 1/q of it
  (where the waves of a soft layer cancel), else the sum of the two waves.
"""

from __future__ import annotations

import math

import numba
import numpy as np

# Rows of a response: under unit pressure, then under unit traction along k, then under unit traction across k.
NORMAL_U, NORMAL_W, NORMAL_TAU, NORMAL_SIGMA, NORMAL_EE, NORMAL_TT = range(6)
TANGENTIAL_U, TANGENTIAL_W, TANGENTIAL_TAU, TANGENTIAL_SIGMA, TANGENTIAL_EE, TANGENTIAL_TT = range(6, 12)
ACROSS_U, ACROSS_ET, ACROSS_TZ = range(12, 15)
ROWS = 15

# Columns of the table of media, outermost first, the half-space last (its thickness is not read).
THICKNESS, MODULUS, KAPPA = range(3)
MEDIUM = 3

# What `_climb` leaves for each layer: impedance below (over its g), the displacements' way through (thin: the 2 x 2
# matrix from the bottom to the top; thick: transmission uu, uw, ww), reflection and round trip pp, pn, nn (thick).
_BELOW, _WAY, _REFLECTED, _ROUND, _TRACTIONS = 0, 3, 7, 10, 13
_KEPT = 17

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
def _exponential(s, c):  # type: ignore[no-untyped-def]
    """What exp(-M s) is made of, |s| <= 1: sinh, cosh, c/2 s sinh s, c/2 (s cosh s - sinh s)."""
    sinh = np.sinh(s)
    return sinh, np.cosh(s), 0.5 * c * s * sinh, 0.5 * c * _s_cosh_less_sinh(s)


@numba.njit(cache=True, error_model="numpy")
def _carry(s, c, u, w, tau, sigma):  # type: ignore[no-untyped-def]
    """The state a distance s (times q) above."""
    sinh, cosh, gamma, delta = _exponential(s, c)
    return (
        (cosh + gamma) * u + (sinh + delta) * w - (2.0 * sinh + delta) * tau - gamma * sigma,
        -((c - 1.0) * sinh + delta) * u + (cosh - gamma) * w + gamma * tau + (delta - (2.0 - c) * sinh) * sigma,
        -(c * sinh + delta) * u - gamma * w + (cosh + gamma) * tau + ((c - 1.0) * sinh + delta) * sigma,
        gamma * u + delta * w - (sinh + delta) * tau + (cosh - gamma) * sigma,
    )


@numba.njit(cache=True, error_model="numpy")
def _climb_thin(x, c, top, kept):  # type: ignore[no-untyped-def]
    """Through a thin layer: what takes (u, w) below to (u, w) and (tau, sigma) above; the impedance on its top."""
    sinh, cosh, gamma, delta = _exponential(x, c)
    uu, uw, ww = kept[_BELOW], kept[_BELOW + 1], kept[_BELOW + 2]
    tt, ts = cosh + gamma, (c - 1.0) * sinh + delta
    st, ss = -sinh - delta, cosh - gamma
    a11 = -c * sinh - delta + tt * uu + ts * uw
    a12 = -gamma + tt * uw + ts * ww
    a21 = gamma + st * uu + ss * uw
    a22 = delta + st * uw + ss * ww
    kept[_TRACTIONS], kept[_TRACTIONS + 1], kept[_TRACTIONS + 2], kept[_TRACTIONS + 3] = a11, a12, a21, a22
    if top:
        return uu, uw, ww
    by_shear, by_stress = -2.0 * sinh - delta, delta - (2.0 - c) * sinh
    f11 = cosh + gamma + by_shear * uu - gamma * uw
    f12 = sinh + delta + by_shear * uw - gamma * ww
    f21 = -ts + gamma * uu + by_stress * uw
    f22 = cosh - gamma + gamma * uw + by_stress * ww
    kept[_WAY], kept[_WAY + 1], kept[_WAY + 2], kept[_WAY + 3] = f11, f12, f21, f22
    determinant = f11 * f22 - f12 * f21
    return (
        (a11 * f22 - a12 * f21) / determinant,
        (a12 * f11 - a11 * f12) / determinant,
        (a22 * f11 - a21 * f12) / determinant,
    )


@numba.njit(cache=True, error_model="numpy")
def _climb_thick(x, kappa, top, kept):  # type: ignore[no-untyped-def]
    """Through a thick layer: transmission, reflection and round trip of its waves; the impedance on its top.

    With Zd, Zu the impedances of waves that decay downwards and upwards, Zu - Zd = 1 + 1/kappa (times the unit
    matrix): the displacement on the interface is (1 + 1/kappa) (Zu - Z)^-1 of the incoming one, reflected is
    (Zu - Z)^-1 (Z - Zd) of it, and a layer that continues below itself reflects nothing, to the last digit.
    """
    uu, uw, ww = kept[_BELOW], kept[_BELOW + 1], kept[_BELOW + 2]
    zeta, eta = 0.5 * (1.0 + 1.0 / kappa), 0.5 * (1.0 - 1.0 / kappa)  # Zd = [[-zeta, eta], ..], Zu = [[zeta, eta], ..]
    w11, w12, w22 = zeta - uu, eta - uw, zeta - ww
    b11, b12, b22 = uu + zeta, uw - eta, ww + zeta
    over = 1.0 / (w11 * w22 - w12 * w12)
    kept[_WAY], kept[_WAY + 1], kept[_WAY + 2] = (
        2.0 * zeta * over * w22,
        -2.0 * zeta * over * w12,
        2.0 * zeta * over * w11,
    )
    r11 = over * (w22 * b11 - w12 * b12)
    r12 = over * (w22 * b12 - w12 * b22)
    r22 = over * (w11 * b22 - w12 * b12)
    # from (u, w) to the sum and the difference (p, n)
    pp, pn, nn = 0.5 * (r11 + r22) + r12, 0.5 * (r11 - r22), 0.5 * (r11 + r22) - r12
    kept[_REFLECTED], kept[_REFLECTED + 1], kept[_REFLECTED + 2] = pp, pn, nn
    square = np.exp(-2.0 * x)
    turn = 2.0 * x / kappa
    pp, pn, nn = (pp - 2.0 * turn * pn + turn * turn * nn) * square, (pn - turn * nn) * square, nn * square
    kept[_ROUND], kept[_ROUND + 1], kept[_ROUND + 2] = pp, pn, nn
    if top:
        return uu, uw, ww
    determinant = (1.0 + pp) * (1.0 + nn) - pn * pn
    less = pp * nn - pn * pn
    spp, spn, snn = (pp + less) / determinant, pn / determinant, (nn + less) / determinant
    return (
        -zeta + zeta * (spp + 2.0 * spn + snn),
        eta + zeta * (spp - snn),
        -zeta + zeta * (spp - 2.0 * spn + snn),
    )


@numba.njit(cache=True, error_model="numpy")
def _climb(q, media, kept):  # type: ignore[no-untyped-def]
    """Fill `kept` (media, _KEPT) from the half-space up."""
    bottom = media.shape[0] - 1
    kappa = media[bottom, KAPPA]
    g = media[bottom, MODULUS]
    one = q * 0.0 + 1.0
    uu, uw, ww = -one * (0.5 * g * (1.0 + 1.0 / kappa)), one * (0.5 * g * (1.0 - 1.0 / kappa)), one * 0.0
    ww = uu
    for number in range(bottom - 1, -1, -1):
        g, kappa = media[number, MODULUS], media[number, KAPPA]
        here = kept[number]
        here[_BELOW], here[_BELOW + 1], here[_BELOW + 2] = uu / g, uw / g, ww / g
        x = q * media[number, THICKNESS]
        if abs(x) < 1.0:
            uu, uw, ww = _climb_thin(x, 4.0 / (1.0 + kappa), number == 0, here)
        else:
            uu, uw, ww = _climb_thick(x, kappa, number == 0, here)
        uu, uw, ww = uu * g, uw * g, ww * g


@numba.njit(cache=True, error_model="numpy")
def _loaded_layer(q, media, kept, tau0, sigma0, waves):  # type: ignore[no-untyped-def]
    """Displacement below the outermost layer; into `waves` the amplitudes on its top less those of a half-space."""
    here = kept[0]
    x = q * media[0, THICKNESS]
    kappa = media[0, KAPPA]
    if abs(x) < 1.0:
        a11, a12, a21, a22 = here[_TRACTIONS], here[_TRACTIONS + 1], here[_TRACTIONS + 2], here[_TRACTIONS + 3]
        determinant = a11 * a22 - a12 * a21
        return (a22 * tau0 - a12 * sigma0) / determinant, (a11 * sigma0 - a21 * tau0) / determinant
    p0, n0 = -kappa * (tau0 + sigma0), sigma0 - tau0
    pp, pn, nn = kappa * here[_ROUND], here[_ROUND + 1], here[_ROUND + 2] / kappa
    r1, r2 = pp * p0 + kappa * pn * n0, nn * n0 + pn / kappa * p0
    determinant = (1.0 - pp) * (1.0 - nn) - pn * pn
    dp = ((1.0 - nn) * r1 + kappa * pn * r2) / determinant
    dn = ((1.0 - pp) * r2 + pn / kappa * r1) / determinant
    waves[0], waves[1] = dp, dn
    return _transmitted(x, kappa, p0 + dp, n0 + dn, here)


@numba.njit(cache=True, error_model="numpy")
def _transmitted(x, kappa, p, n, here):  # type: ignore[no-untyped-def]
    """Displacement below a thick layer from the amplitudes of its downward waves on its top."""
    decay = np.exp(-x)
    p, n = p * decay, (n - 2.0 * x * p / kappa) * decay
    u, w = 0.5 * (p + n), 0.5 * (p - n)
    return here[_WAY] * u + here[_WAY + 1] * w, here[_WAY + 1] * u + here[_WAY + 2] * w


@numba.njit(cache=True, error_model="numpy")
def _pass_layer(q, media, kept, number, u, w, waves):  # type: ignore[no-untyped-def]
    """Displacement below a layer from that on its top; into `waves` the amplitudes there."""
    here = kept[number]
    x = q * media[number, THICKNESS]
    if abs(x) < 1.0:
        f11, f12, f21, f22 = here[_WAY], here[_WAY + 1], here[_WAY + 2], here[_WAY + 3]
        determinant = f11 * f22 - f12 * f21
        return (f22 * u - f12 * w) / determinant, (f11 * w - f21 * u) / determinant
    p, n = u + w, u - w
    pp, pn, nn = here[_ROUND], here[_ROUND + 1], here[_ROUND + 2]
    determinant = (1.0 + pp) * (1.0 + nn) - pn * pn
    p, n = ((1.0 + nn) * p - pn * n) / determinant, ((1.0 + pp) * n - pn * p) / determinant
    waves[0], waves[1] = p, n
    return _transmitted(x, media[number, KAPPA], p, n, here)


@numba.njit(cache=True, error_model="numpy")
def _half_space_waves(s, kappa, p, n):  # type: ignore[no-untyped-def]
    """State of waves that decay downwards, amplitudes (p, n) a distance s (times q) above."""
    fall = np.exp(-s)
    p, n = p * fall, (n - 2.0 * s * p / kappa) * fall
    return 0.5 * (p + n), 0.5 * (p - n), 0.5 * (-p / kappa - n), 0.5 * (-p / kappa + n)


@numba.njit(cache=True, error_model="numpy")
def _waves_inside(down, up, kappa, here, p, n, p_sent, n_sent):  # type: ignore[no-untyped-def]
    """State in a thick layer, `down` below its top and `up` above its bottom (times q).

    p, n: amplitudes of the downward waves to add; p_sent, n_sent: of those that the interface reflects.
    """
    x = down + up
    decay, back = np.exp(-x), np.exp(-up)
    n_sent, p_sent = (n_sent - 2.0 * x * p_sent / kappa) * decay, p_sent * decay
    p_up = here[_REFLECTED] * p_sent + here[_REFLECTED + 1] * n_sent
    n_up = here[_REFLECTED + 1] * p_sent + here[_REFLECTED + 2] * n_sent
    p_up, n_up = (p_up - 2.0 * up * n_up / kappa) * back, n_up * back
    u, w, tau, sigma = _half_space_waves(down, kappa, p, n)
    total, difference = p_up, n_up / kappa
    return (
        u + 0.5 * (p_up + n_up),
        w + 0.5 * (p_up - n_up),
        tau + 0.5 * (total + difference),
        sigma + 0.5 * (total - difference),
    )


@numba.njit(cache=True, error_model="numpy")
def _in_plane(q, above, medium, media, remainder, tau0, sigma0, kept, waves):  # type: ignore[no-untyped-def]
    """u, w and the medium's own tau, sigma under a load; `above`: depth below the top of `medium`."""
    bottom = media.shape[0] - 1
    kappa = media[medium, KAPPA]
    u, w = q * 0.0, q * 0.0
    for number in range(min(medium + 1, bottom)):
        if number == 0:
            u, w = _loaded_layer(q, media, kept, tau0, sigma0, waves)
        else:
            u, w = _pass_layer(q, media, kept, number, u, w, waves)
    down = q * above
    if medium == bottom:
        if bottom == 0:
            return _half_space_waves(down, kappa, -kappa * (tau0 + sigma0) + u, sigma0 - tau0 + w)
        return _half_space_waves(down, kappa, u + w, u - w)
    here = kept[medium]
    x = q * media[medium, THICKNESS]
    up = q * (media[medium, THICKNESS] - above)
    if abs(x) < 1.0 or (abs(up) < 1.0 and not remainder):
        tau = here[_BELOW] * u + here[_BELOW + 1] * w
        sigma = here[_BELOW + 1] * u + here[_BELOW + 2] * w
        u, w, tau, sigma = _carry(up, 4.0 / (1.0 + kappa), u, w, tau, sigma)
        if remainder:
            u0, w0, tau_0, sigma_0 = _half_space_waves(
                down, kappa, -kappa * (tau0 + sigma0) + u * 0.0, sigma0 - tau0 + u * 0.0
            )
            return u - u0, w - w0, tau - tau_0, sigma - sigma_0
        return u, w, tau, sigma
    p, n = waves[0], waves[1]
    if medium > 0:
        return _waves_inside(down, up, kappa, here, p, n, p, n)
    p0, n0 = -kappa * (tau0 + sigma0), sigma0 - tau0
    if remainder:
        return _waves_inside(down, up, kappa, here, p, n, p0 + p, n0 + n)
    return _waves_inside(down, up, kappa, here, p0 + p, n0 + n, p0 + p, n0 + n)


@numba.njit(cache=True, error_model="numpy")
def _rise(s):  # type: ignore[no-untyped-def]
    """1 + exp(-2 s) and 1 - exp(-2 s), free of cancellation."""
    fall = np.exp(-s)
    if abs(s) < 1.0:
        return 1.0 + fall * fall, 2.0 * fall * np.sinh(s)
    return 1.0 + fall * fall, 1.0 - fall * fall


@numba.njit(cache=True, error_model="numpy")
def _anti_plane(q, above, medium, media, remainder, impedances, out):  # type: ignore[no-untyped-def]
    """Shear across the plane: sums of positive terms only, at any thickness and ratio of moduli."""
    bottom = media.shape[0] - 1
    impedance = media[bottom, MODULUS] + q * 0.0
    for number in range(bottom - 1, -1, -1):
        g = media[number, MODULUS]
        impedances[number] = impedance / g
        if number > 0:
            even, odd = _rise(q * media[number, THICKNESS])
            impedance = g * (impedance * even + g * odd) / (g * even + impedance * odd)
    v = 1.0 + q * 0.0  # displacement on top of the medium, times G1 q under a unit traction on the surface
    for number in range(min(medium + 1, bottom)):
        x = q * media[number, THICKNESS]
        even, odd = _rise(x)
        zeta = impedances[number]
        if number == 0:
            loaded = odd + zeta * even
            v = (even + zeta * odd) / loaded
            if remainder:
                down, up = np.exp(-q * above), np.exp(-2.0 * x + q * above)
                square = np.exp(-2.0 * x)
                out[ACROSS_ET] = (1.0 - zeta) * (square * down + up) / loaded
                out[ACROSS_TZ] = -(1.0 - zeta) * (square * down - up) / loaded
                out[ACROSS_U] = 2.0 * out[ACROSS_ET]
                return
        if number == medium:
            fall = np.exp(-q * above)
            through = even + zeta * odd
            even, odd = _rise(q * (media[number, THICKNESS] - above))
            g = media[medium, MODULUS]
            out[ACROSS_U] = 2.0 * v * fall * (even + zeta * odd) / through
            out[ACROSS_ET] = 0.5 * g * out[ACROSS_U]
            out[ACROSS_TZ] = -g * v * fall * (odd + zeta * even) / through
            return
        v = v * (2.0 * np.exp(-x) / (even + zeta * odd))
    v = v * np.exp(-q * above)
    out[ACROSS_U], out[ACROSS_ET] = 2.0 * v, media[bottom, MODULUS] * v
    out[ACROSS_TZ] = -out[ACROSS_ET]


@numba.njit(cache=True, error_model="numpy")
def fill(q, above, medium, media, remainder, out):  # type: ignore[no-untyped-def]
    """Fill `out` (ROWS, n) for the wavenumbers q (n,) at the distance `above` below the top of a medium."""
    bottom = media.shape[0] - 1
    kept = np.empty((media.shape[0], _KEPT), out.dtype)
    impedances = np.empty(media.shape[0], out.dtype)
    waves = np.empty(2, out.dtype)
    column = np.empty(ROWS, out.dtype)
    g = media[medium, MODULUS]
    c = 4.0 / (1.0 + media[medium, KAPPA])
    for i in range(q.size):
        if bottom > 0:
            _climb(q[i], media, kept)
        for load in range(2):  # pressure, traction along k
            u, w, tau, sigma = _in_plane(q[i], above, medium, media, remainder, float(load), load - 1.0, kept, waves)
            row = 6 * load
            column[row], column[row + 1], column[row + 2], column[row + 3] = u, w, g * tau, g * sigma
            column[row + 4] = g * ((c - 1.0) * sigma - c * u)
            column[row + 5] = g * (c - 1.0) * (sigma - u)
        _anti_plane(q[i], above, medium, media, remainder, impedances, column)
        out[:, i] = column
