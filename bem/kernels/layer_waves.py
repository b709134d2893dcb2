"""Waves in a stack of bonded layers on a half-space, one wavenumber at a time: impedances upwards, displacements down.

The equations stand in `layered`. In each medium the state (u, w, tau, sigma) is in units of its own 2 G q; `g` is a
modulus over that of the outermost layer. All 2 x 2 matrices that relate displacement to traction are symmetric
(reciprocity) and held as three numbers (uu, uw, ww).

- `_climb` goes up: from the impedance Z of what lies below a layer, (tau, sigma) = Z (u, w), to that on its top. A
  layer of q h < 1 takes the matrix exponential (`_climb_thin`), a thicker one the reflection below it and a round
  trip of decaying waves (`_climb_thick`).
- `_loaded_layer` and `_pass_layer` go down: from the load on the surface to the displacement on the interface below
  the medium asked for. Only displacements are handed on: (Zu - Z)^-1 of two definite matrices cannot cancel,
  whatever the moduli.
- `_in_plane` gives the state at a depth: carried up from the interface by the matrix exponential within 1/q of it
  (where the waves of a soft layer cancel), else the sum of the two waves.
"""

from __future__ import annotations

import math

import numpy as np

from bem.compiled import compiled

# Rows of a response: under unit pressure, then under unit traction along k, then under unit traction across k.
NORMAL_U, NORMAL_W, NORMAL_TAU, NORMAL_SIGMA, NORMAL_EE, NORMAL_TT = range(6)
TANGENTIAL_U, TANGENTIAL_W, TANGENTIAL_TAU, TANGENTIAL_SIGMA, TANGENTIAL_EE, TANGENTIAL_TT = range(6, 12)
ACROSS_U, ACROSS_ET, ACROSS_TZ = range(12, 15)
ROWS = 15

# Columns of the table of media, outermost first, the half-space last (its thickness is not read).
THICKNESS, MODULUS, KAPPA = range(3)

# What `_climb` leaves for each layer: impedance below (over its g); the displacements' way through (thin: the 2 x 2
# matrix from the bottom to the top, thick: transmission uu, uw, ww); reflection and round trip pp, pn, nn (thick);
# tractions on the top of a thin outermost layer from the displacement below it; one over the determinant that solves
# for what is below; exp(-q h) and sinh q h (thin).
_BELOW, _WAY, _REFLECTED, _ROUND, _TRACTIONS, _SOLVE, _DECAY, _SINH = 0, 3, 7, 10, 13, 17, 18, 19
_KEPT = 20

# What belongs to the depth: distances (times q) below the top and above the bottom of its medium and their decays,
# and what exp(-M s) of the second is made of where the state is carried up.
_DOWN, _UP, _FALL, _BACK, _EXPONENTIAL = 0, 1, 2, 3, 4
_PLACE = 8

_SERIES = tuple(
    2 * j / math.factorial(2 * j + 1) for j in range(10, 0, -1)
)  # the last term is 1e-18 of the sum at s = 1


@compiled
def _s_cosh_less_sinh(s):
    """s cosh s - sinh s for |s| <= 1 by its series, free of cancellation."""
    s2 = s * s
    total = s2 * 0.0
    for coefficient in _SERIES:
        total = total * s2 + coefficient
    return total * s2 * s


@compiled
def _exponential(s, c):
    """What exp(-M s) is made of, |s| <= 1: sinh, cosh, c/2 s sinh s, c/2 (s cosh s - sinh s)."""
    sinh = np.sinh(s)
    return sinh, np.cosh(s), 0.5 * c * s * sinh, 0.5 * c * _s_cosh_less_sinh(s)


@compiled
def _carry(place, c, u, w, tau, sigma):
    """The state above from that on the interface."""
    sinh, cosh, gamma, delta = (
        place[_EXPONENTIAL],
        place[_EXPONENTIAL + 1],
        place[_EXPONENTIAL + 2],
        place[_EXPONENTIAL + 3],
    )
    return (
        (cosh + gamma) * u + (sinh + delta) * w - (2.0 * sinh + delta) * tau - gamma * sigma,
        -((c - 1.0) * sinh + delta) * u + (cosh - gamma) * w + gamma * tau + (delta - (2.0 - c) * sinh) * sigma,
        -(c * sinh + delta) * u - gamma * w + (cosh + gamma) * tau + ((c - 1.0) * sinh + delta) * sigma,
        gamma * u + delta * w - (sinh + delta) * tau + (cosh - gamma) * sigma,
    )


@compiled
def _climb_thin(x, c, number, kept):
    """Through a thin layer: what takes (u, w) below to (u, w) and (tau, sigma) above; the impedance on its top."""
    sinh, cosh, gamma, delta = _exponential(x, c)
    kept[number, _SINH] = sinh
    uu, uw, ww = kept[number, _BELOW], kept[number, _BELOW + 1], kept[number, _BELOW + 2]
    tt, ts = cosh + gamma, (c - 1.0) * sinh + delta
    st, ss = -sinh - delta, cosh - gamma
    a11 = -c * sinh - delta + tt * uu + ts * uw
    a12 = -gamma + tt * uw + ts * ww
    a21 = gamma + st * uu + ss * uw
    a22 = delta + st * uw + ss * ww
    if number == 0:
        (
            kept[number, _TRACTIONS],
            kept[number, _TRACTIONS + 1],
            kept[number, _TRACTIONS + 2],
            kept[number, _TRACTIONS + 3],
        ) = a11, a12, a21, a22
        kept[number, _SOLVE] = 1.0 / (a11 * a22 - a12 * a21)
        return uu, uw, ww
    by_shear, by_stress = -2.0 * sinh - delta, delta - (2.0 - c) * sinh
    f11 = cosh + gamma + by_shear * uu - gamma * uw
    f12 = sinh + delta + by_shear * uw - gamma * ww
    f21 = -ts + gamma * uu + by_stress * uw
    f22 = cosh - gamma + gamma * uw + by_stress * ww
    kept[number, _WAY], kept[number, _WAY + 1], kept[number, _WAY + 2], kept[number, _WAY + 3] = f11, f12, f21, f22
    solve = 1.0 / (f11 * f22 - f12 * f21)
    kept[number, _SOLVE] = solve
    return (a11 * f22 - a12 * f21) * solve, (a12 * f11 - a11 * f12) * solve, (a22 * f11 - a21 * f12) * solve


@compiled
def _reflect(kappa, number, kept):
    """Transmission and reflection of the waves of a thick layer by the impedance below it.

    With Zd, Zu the impedances of waves that decay downwards and upwards, Zu - Zd = 1 + 1/kappa (times the unit
    matrix): the displacement on the interface is (1 + 1/kappa) (Zu - Z)^-1 of the incoming one, reflected is
    (Zu - Z)^-1 (Z - Zd) of it, and a layer that continues below itself reflects nothing, to the last digit.
    """
    uu, uw, ww = kept[number, _BELOW], kept[number, _BELOW + 1], kept[number, _BELOW + 2]
    zeta, eta = 0.5 * (1.0 + 1.0 / kappa), 0.5 * (1.0 - 1.0 / kappa)  # Zd = [[-zeta, eta], ..], Zu = [[zeta, eta], ..]
    w11, w12, w22 = zeta - uu, eta - uw, zeta - ww
    b11, b12, b22 = uu + zeta, uw - eta, ww + zeta
    over = 1.0 / (w11 * w22 - w12 * w12)
    twice = 2.0 * zeta * over
    kept[number, _WAY], kept[number, _WAY + 1], kept[number, _WAY + 2] = twice * w22, -twice * w12, twice * w11
    r11 = over * (w22 * b11 - w12 * b12)
    r12 = over * (w22 * b12 - w12 * b22)
    r22 = over * (w11 * b22 - w12 * b12)
    # from (u, w) to the sum and the difference (p, n)
    mean = 0.5 * (r11 + r22)
    kept[number, _REFLECTED], kept[number, _REFLECTED + 1], kept[number, _REFLECTED + 2] = (
        mean + r12,
        0.5 * (r11 - r22),
        mean - r12,
    )


@compiled
def _climb_thick(x, kappa, number, kept):
    """Through a thick layer, whose reflection is known: the round trip of its waves and the impedance on its top."""
    pp, pn, nn = kept[number, _REFLECTED], kept[number, _REFLECTED + 1], kept[number, _REFLECTED + 2]
    square = kept[number, _DECAY] * kept[number, _DECAY]
    turn = (2.0 / kappa) * x
    step = pn - turn * nn
    pp, pn, nn = (pp - turn * (pn + step)) * square, step * square, nn * square
    kept[number, _ROUND], kept[number, _ROUND + 1], kept[number, _ROUND + 2] = pp, pn, nn
    if number == 0:  # the load is known: 1 + Zd^-1 Zu R'
        kept[number, _SOLVE] = 1.0 / ((1.0 - kappa * pp) * (1.0 - nn / kappa) - pn * pn)
        return pp, pn, nn
    solve = 1.0 / ((1.0 + pp) * (1.0 + nn) - pn * pn)
    kept[number, _SOLVE] = solve
    less = pp * nn - pn * pn
    pp, pn, nn = (pp + less) * solve, pn * solve, (nn + less) * solve
    zeta, eta = 0.5 * (1.0 + 1.0 / kappa), 0.5 * (1.0 - 1.0 / kappa)
    return -zeta + zeta * (pp + 2.0 * pn + nn), eta + zeta * (pp - nn), -zeta + zeta * (pp - 2.0 * pn + nn)


@compiled
def _from_below(media, number, uu, uw, ww, kept):
    """The impedance below a layer, in its own units."""
    over = 1.0 / media[number, MODULUS]
    kept[number, _BELOW], kept[number, _BELOW + 1], kept[number, _BELOW + 2] = uu * over, uw * over, ww * over


@compiled
def _rest(media, kept):
    """What is the same for every wavenumber: the half-space below the lowest layer, and how it reflects."""
    bottom = media.shape[0] - 1
    kappa, g = media[bottom, KAPPA], media[bottom, MODULUS]
    zeta, eta = -0.5 * g * (1.0 + 1.0 / kappa), 0.5 * g * (1.0 - 1.0 / kappa)
    _from_below(media, bottom - 1, zeta, eta, zeta, kept)


@compiled
def _climb(q, media, reflected, kept):
    """Fill `kept` (media, _KEPT) from the lowest layer up; `reflected`: transmission and reflection of that one."""
    lowest = media.shape[0] - 2
    for number in range(lowest, -1, -1):
        g, kappa = media[number, MODULUS], media[number, KAPPA]
        x = q * media[number, THICKNESS]
        kept[number, _DECAY] = np.exp(-x)
        if abs(x) < 1.0:
            uu, uw, ww = _climb_thin(x, 4.0 / (1.0 + kappa), number, kept)
        else:
            if number < lowest:
                _reflect(kappa, number, kept)
            else:
                for k in range(3):  # a smaller wavenumber may have left those of a thin layer there
                    kept[number, _WAY + k] = reflected[k]
            uu, uw, ww = _climb_thick(x, kappa, number, kept)
        if number > 0:
            _from_below(media, number - 1, uu * g, uw * g, ww * g, kept)


@compiled
def _loaded_layer(q, media, kept, tau0, sigma0, waves):
    """Displacement below the outermost layer; into `waves` the amplitudes on its top less those of a half-space."""
    x = q * media[0, THICKNESS]
    kappa = media[0, KAPPA]
    solve = kept[0, _SOLVE]
    if abs(x) < 1.0:
        a11, a12, a21, a22 = (
            kept[0, _TRACTIONS],
            kept[0, _TRACTIONS + 1],
            kept[0, _TRACTIONS + 2],
            kept[0, _TRACTIONS + 3],
        )
        return (a22 * tau0 - a12 * sigma0) * solve, (a11 * sigma0 - a21 * tau0) * solve
    p0, n0 = -kappa * (tau0 + sigma0), sigma0 - tau0
    over = 1.0 / kappa
    pp, pn, nn = kappa * kept[0, _ROUND], kept[0, _ROUND + 1], over * kept[0, _ROUND + 2]
    r1, r2 = pp * p0 + pn * (kappa * n0), nn * n0 + pn * (over * p0)
    dp = ((1.0 - nn) * r1 + kappa * pn * r2) * solve
    dn = ((1.0 - pp) * r2 + over * pn * r1) * solve
    waves[0], waves[1] = dp, dn
    return _transmitted(x, over, p0 + dp, n0 + dn, 0, kept, waves)


@compiled
def _transmitted(x, over, p, n, number, kept, waves):
    """Displacement below a thick layer from the amplitudes of its downward waves on its top; `over`: 1 / kappa.

    Into `waves` what arrives at the interface.
    """
    p = p * kept[number, _DECAY]
    n = n * kept[number, _DECAY] - (2.0 * over) * x * p
    waves[2], waves[3] = p, n
    u, w = 0.5 * (p + n), 0.5 * (p - n)
    return kept[number, _WAY] * u + kept[number, _WAY + 1] * w, kept[number, _WAY + 1] * u + kept[number, _WAY + 2] * w


@compiled
def _pass_layer(q, media, kept, number, u, w, waves):
    """Displacement below a layer from that on its top; into `waves` the amplitudes there."""
    x = q * media[number, THICKNESS]
    solve = kept[number, _SOLVE]
    if abs(x) < 1.0:
        f11, f12, f21, f22 = kept[number, _WAY], kept[number, _WAY + 1], kept[number, _WAY + 2], kept[number, _WAY + 3]
        return (f22 * u - f12 * w) * solve, (f11 * w - f21 * u) * solve
    p, n = u + w, u - w
    pp, pn, nn = kept[number, _ROUND], kept[number, _ROUND + 1], kept[number, _ROUND + 2]
    p, n = ((1.0 + nn) * p - pn * n) * solve, ((1.0 + pp) * n - pn * p) * solve
    waves[0], waves[1] = p, n
    return _transmitted(x, 1.0 / media[number, KAPPA], p, n, number, kept, waves)


@compiled
def _falling(place, over, p, n):
    """State of waves that decay downwards, amplitudes (p, n) on the top of the medium; `over`: 1 / kappa."""
    p = p * place[_FALL]
    n = n * place[_FALL] - (2.0 * over) * place[_DOWN] * p
    q = over * p
    return 0.5 * (p + n), 0.5 * (p - n), 0.5 * (-q - n), 0.5 * (n - q)


@compiled
def _waves_inside(place, over, medium, kept, p, n, waves):
    """State in a thick layer: downward waves of amplitudes p, n on its top, and what its interface reflects."""
    p_sent, n_sent = waves[2], waves[3]
    p_up = (kept[medium, _REFLECTED] * p_sent + kept[medium, _REFLECTED + 1] * n_sent) * place[_BACK]
    n_up = (kept[medium, _REFLECTED + 1] * p_sent + kept[medium, _REFLECTED + 2] * n_sent) * place[_BACK]
    p_up = p_up - (2.0 * over) * place[_UP] * n_up
    u, w, tau, sigma = _falling(place, over, p, n)
    less = over * n_up
    return (
        u + 0.5 * (p_up + n_up),
        w + 0.5 * (p_up - n_up),
        tau + 0.5 * (p_up + less),
        sigma + 0.5 * (p_up - less),
    )


@compiled
def _in_plane(q, medium, carried, remainder, media, place, kept, load, waves):
    """u, w and the medium's own tau, sigma under pressure (load 0) or traction along k (1)."""
    tau0, sigma0 = float(load), load - 1.0
    bottom = media.shape[0] - 1
    over = 1.0 / media[medium, KAPPA]
    p0, n0 = -media[0, KAPPA] * (tau0 + sigma0) + q * 0.0, sigma0 - tau0 + q * 0.0
    if bottom == 0:
        return _falling(place, over, p0, n0)
    u, w = _loaded_layer(q, media, kept, tau0, sigma0, waves)
    for number in range(1, min(medium + 1, bottom)):
        u, w = _pass_layer(q, media, kept, number, u, w, waves)
    if medium == bottom:
        return _falling(place, over, u + w, u - w)
    if carried:
        tau = kept[medium, _BELOW] * u + kept[medium, _BELOW + 1] * w
        sigma = kept[medium, _BELOW + 1] * u + kept[medium, _BELOW + 2] * w
        u, w, tau, sigma = _carry(place, 4.0 / (1.0 + media[medium, KAPPA]), u, w, tau, sigma)
        if remainder:
            u0, w0, tau_0, sigma_0 = _falling(place, over, p0, n0)
            return u - u0, w - w0, tau - tau_0, sigma - sigma_0
        return u, w, tau, sigma
    p, n = waves[0], waves[1]
    if medium == 0 and not remainder:
        p, n = p + p0, n + n0
    return _waves_inside(place, over, medium, kept, p, n, waves)


@compiled
def _even_odd(decay, sinh, small):
    """1 + exp(-2 s) and 1 - exp(-2 s) from exp(-s) and, where s is small, sinh s."""
    square = decay * decay
    return 1.0 + square, 2.0 * decay * sinh if small else 1.0 - square


@compiled
def _anti_plane(q, medium, remainder, media, place, kept, impedances, out):
    """Shear across the plane: sums of positive terms only, at any thickness and ratio of moduli."""
    bottom = media.shape[0] - 1
    impedance = media[bottom, MODULUS] + q * 0.0
    for number in range(bottom - 1, 0, -1):
        g = media[number, MODULUS]
        impedances[number] = impedance / g
        even, odd = _even_odd(kept[number, _DECAY], kept[number, _SINH], abs(q * media[number, THICKNESS]) < 1.0)
        impedance = g * (impedance * even + g * odd) / (g * even + impedance * odd)
    if bottom > 0:
        impedances[0] = impedance
    v = 1.0 + q * 0.0  # displacement on top of the medium, times G1 q under a unit traction on the surface
    fall = place[_FALL]
    for number in range(min(medium + 1, bottom)):
        zeta = impedances[number]
        even, odd = _even_odd(kept[number, _DECAY], kept[number, _SINH], abs(q * media[number, THICKNESS]) < 1.0)
        through = even + zeta * odd
        # over the traction on the surface, or the displacement on the top of an inner layer
        scale = 1.0 / (odd + zeta * even) if number == 0 else v / through
        if remainder:
            scale = (1.0 - zeta) * scale
            square, up = kept[number, _DECAY] * kept[number, _DECAY] * fall, kept[number, _DECAY] * place[_BACK]
            out[ACROSS_ET], out[ACROSS_TZ] = scale * (square + up), -scale * (square - up)
            out[ACROSS_U] = 2.0 * out[ACROSS_ET]
            return
        if number == medium:
            even, odd = _even_odd(place[_BACK], place[_EXPONENTIAL], abs(place[_UP]) < 1.0)
            scale = scale * fall
            out[ACROSS_U] = 2.0 * scale * (even + zeta * odd)
            out[ACROSS_ET] = 0.5 * media[medium, MODULUS] * out[ACROSS_U]
            out[ACROSS_TZ] = -media[medium, MODULUS] * scale * (odd + zeta * even)
            return
        v = 2.0 * kept[number, _DECAY] * scale
    v = v * fall
    out[ACROSS_U], out[ACROSS_ET] = 2.0 * v, media[bottom, MODULUS] * v
    out[ACROSS_TZ] = -out[ACROSS_ET]


@compiled
def _find_place(q, above, thickness, inside, carried, c, place):
    """Fill `place` (_PLACE,) for a wavenumber and a depth `above` below the top of its medium."""
    place[_DOWN] = q * above
    place[_FALL] = np.exp(-place[_DOWN])
    if inside:
        up = q * (thickness - above)
        place[_UP], place[_BACK] = up, np.exp(-up)
        if carried:
            sinh, cosh, gamma, delta = _exponential(up, c)
            place[_EXPONENTIAL], place[_EXPONENTIAL + 1] = sinh, cosh
            place[_EXPONENTIAL + 2], place[_EXPONENTIAL + 3] = gamma, delta


@compiled
def fill(q, above, medium, media, remainder, pressed, sheared, out):
    """Fill `out` (ROWS, n) for the wavenumbers q (n,) at the distance `above` below the top of a medium.

    `pressed`: the rows under pressure; `sheared`: those under tractions. The others are left as they are.
    """
    bottom = media.shape[0] - 1
    kept = np.zeros((media.shape[0], _KEPT), out.dtype)
    impedances, waves = np.empty(media.shape[0], out.dtype), np.empty(4, out.dtype)
    place, column = np.zeros(_PLACE, out.dtype), np.empty(ROWS, out.dtype)
    g, c, thickness = media[medium, MODULUS], 4.0 / (1.0 + media[medium, KAPPA]), media[medium, THICKNESS]
    if bottom > 0:
        _rest(media, kept)
        _reflect(media[bottom - 1, KAPPA], bottom - 1, kept)
    reflected = kept[max(bottom - 1, 0), _WAY : _WAY + 3].copy()
    for i in range(q.size):
        inside = medium < bottom
        carried = inside and (abs(q[i] * thickness) < 1.0 or (abs(q[i] * (thickness - above)) < 1.0 and not remainder))
        _find_place(q[i], above, thickness, inside, carried, c, place)
        if bottom > 0:
            _climb(q[i], media, reflected, kept)
        for load in range(0 if pressed else 1, 2 if sheared else 1):
            u, w, tau, sigma = _in_plane(q[i], medium, carried, remainder, media, place, kept, load, waves)
            row = 6 * load
            column[row], column[row + 1], column[row + 2], column[row + 3] = u, w, g * tau, g * sigma
            column[row + 4] = g * ((c - 1.0) * sigma - c * u)
            column[row + 5] = g * (c - 1.0) * (sigma - u)
        if sheared:
            _anti_plane(q[i], medium, remainder, media, place, kept, impedances, column)
        for row in range(0 if pressed else 6, ROWS if sheared else 6):
            out[row, i] = column[row]
