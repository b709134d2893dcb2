"""Elastic waves in a stack of layers at one wavenumber: impedances upward, then displacements downward.

The equations are derived in `frequency_response`. In each medium the state (u, w, tau, sigma) is in units of its own 2
G q; `g` is a modulus over that of the outermost layer. All 2 x 2 matrices that relate displacement to traction are
symmetric (reciprocity) and are stored as three numbers (uu, uw, ww). `fill_response` takes these steps for each
wavenumber:

1. `_impedances_upward` computes the impedance Z below each layer, (tau, sigma) = Z (u, w), from the half-space up. A
   layer with q h < 1 uses the matrix exponential (`_impedance_on_thin_layer`). A thicker layer uses the reflection at
   its lower interface and a round trip of decaying waves (`_impedance_on_thick_layer`).
2. `_through_loaded_layer` and `_through_layer` carry the displacement from the loaded surface down to the interface
   below the medium of the requested depth. Only displacements are carried: (Zu - Z)^-1 of two definite matrices cannot
   cancel, whatever the moduli.
3. `_state_at_depth` gives the state at the depth. In a layer with q h < 1, and for the whole response within 1/q of the
   lower interface of any layer, it is carried up from the interface by the matrix exponential, because the waves of a
   soft layer cancel there. Otherwise it is the sum of the waves of both directions. The remainder in a layer with
   q h >= 1 is always such a sum: the downward waves less those of the half-space, and the reflected waves.
4. `_anti_plane` gives the response across the plane from sums of positive terms.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from bem.compiled import compiled

# Rows of a response: under unit pressure, then under unit traction along k, then under unit traction across k.
NORMAL_U, NORMAL_W, NORMAL_TAU, NORMAL_SIGMA, NORMAL_EE, NORMAL_TT = range(6)
TANGENTIAL_U, TANGENTIAL_W, TANGENTIAL_TAU, TANGENTIAL_SIGMA, TANGENTIAL_EE, TANGENTIAL_TT = range(6, 12)
ACROSS_U, ACROSS_ET, ACROSS_TZ = range(12, 15)
ROWS = 15

# Columns of the table of media, outermost first, the half-space last (its thickness is not read).
THICKNESS, MODULUS, KAPPA = range(3)


# Columns of the table of layers (media, _COLUMNS) at one wavenumber, outermost first. p, n: sum and difference of u, w.
# Impedance of all that lies below a layer, over the layer's modulus.
_BELOW_UU, _BELOW_UW, _BELOW_WW = range(3)
# Thin layer: 2 x 2 matrix from the displacement on its bottom to that on its top.
_TRANSFER_11, _TRANSFER_12, _TRANSFER_21, _TRANSFER_22 = range(3, 7)
# Thick layer, in the same columns: transmission from the incoming waves to the displacement on its lower interface.
_TRANSMISSION_UU, _TRANSMISSION_UW, _TRANSMISSION_WW = range(3, 6)
# Thick layer: reflection at its lower interface, and the same seen from its top.
_REFLECTION_PP, _REFLECTION_PN, _REFLECTION_NN = range(7, 10)
_ROUND_TRIP_PP, _ROUND_TRIP_PN, _ROUND_TRIP_NN = range(10, 13)
# Thin outermost layer: 2 x 2 matrix from the displacement below it to the tractions on its top.
_TRACTION_11, _TRACTION_12, _TRACTION_21, _TRACTION_22 = range(13, 17)
# One over the determinant of the system for the displacement below; exp(-q h); sinh(q h) of a thin layer.
_INVERSE_DETERMINANT, _DECAY, _SINH = range(17, 20)
_COLUMNS = 20


class DepthFactors(NamedTuple):
    """Quantities of one depth at one wavenumber; those of the lower interface are 0 in the half-space.

    down, up : q times the distance below the top and above the bottom of the medium.
    decay_down, decay_up : exp(-down), exp(-up).
    sinh, cosh, gamma, delta : terms of exp(-M up), where the state is carried up from the interface; else 0.
    """

    down: Any
    up: Any
    decay_down: Any
    decay_up: Any
    sinh: Any
    cosh: Any
    gamma: Any
    delta: Any


_SERIES = tuple(
    2 * j / math.factorial(2 * j + 1) for j in range(10, 0, -1)
)  # the last term is 1e-18 of the sum at s = 1


@compiled
def _s_cosh_less_sinh(s):
    """Return s cosh s - sinh s for |s| <= 1 by its series, free of cancellation."""
    s2 = s * s
    total = s2 * 0.0
    for coefficient in _SERIES:
        total = total * s2 + coefficient
    return total * s2 * s


@compiled
def _exponential(s, c):
    """Return the terms of the matrix exponential exp(-M s), |s| <= 1.

    These are sinh s, cosh s, gamma = c/2 s sinh s and delta = c/2 (s cosh s - sinh s).
    """
    sinh = np.sinh(s)
    return sinh, np.cosh(s), 0.5 * c * s * sinh, 0.5 * c * _s_cosh_less_sinh(s)


@compiled
def _state_above_interface(factors, c, u, w, tau, sigma):
    """Carry the state from the interface up to the depth by the matrix exponential."""
    sinh, cosh, gamma, delta = factors.sinh, factors.cosh, factors.gamma, factors.delta
    return (
        (cosh + gamma) * u + (sinh + delta) * w - (2.0 * sinh + delta) * tau - gamma * sigma,
        -((c - 1.0) * sinh + delta) * u + (cosh - gamma) * w + gamma * tau + (delta - (2.0 - c) * sinh) * sigma,
        -(c * sinh + delta) * u - gamma * w + (cosh + gamma) * tau + ((c - 1.0) * sinh + delta) * sigma,
        gamma * u + delta * w - (sinh + delta) * tau + (cosh - gamma) * sigma,
    )


@compiled
def _impedance_on_thin_layer(x, c, number, layers):
    """Return the impedance on top of a thin layer; store its transfer matrix, or tractions of the outermost layer.

    What is returned for the outermost layer (number 0) has no meaning and is not used.
    """
    sinh, cosh, gamma, delta = _exponential(x, c)
    layers[number, _SINH] = sinh
    uu, uw, ww = layers[number, _BELOW_UU], layers[number, _BELOW_UW], layers[number, _BELOW_WW]
    tt, ts = cosh + gamma, (c - 1.0) * sinh + delta
    st, ss = -sinh - delta, cosh - gamma
    a11 = -c * sinh - delta + tt * uu + ts * uw
    a12 = -gamma + tt * uw + ts * ww
    a21 = gamma + st * uu + ss * uw
    a22 = delta + st * uw + ss * ww
    if number == 0:
        layers[number, _TRACTION_11], layers[number, _TRACTION_12] = a11, a12
        layers[number, _TRACTION_21], layers[number, _TRACTION_22] = a21, a22
        layers[number, _INVERSE_DETERMINANT] = 1.0 / (a11 * a22 - a12 * a21)
        return uu, uw, ww
    by_shear, by_stress = -2.0 * sinh - delta, delta - (2.0 - c) * sinh
    f11 = cosh + gamma + by_shear * uu - gamma * uw
    f12 = sinh + delta + by_shear * uw - gamma * ww
    f21 = -ts + gamma * uu + by_stress * uw
    f22 = cosh - gamma + gamma * uw + by_stress * ww
    layers[number, _TRANSFER_11], layers[number, _TRANSFER_12] = f11, f12
    layers[number, _TRANSFER_21], layers[number, _TRANSFER_22] = f21, f22
    solve = 1.0 / (f11 * f22 - f12 * f21)
    layers[number, _INVERSE_DETERMINANT] = solve
    return (a11 * f22 - a12 * f21) * solve, (a12 * f11 - a11 * f12) * solve, (a22 * f11 - a21 * f12) * solve


@compiled
def _reflect(kappa, number, layers):
    """Compute transmission and reflection of the waves of a thick layer at the impedance below it.

    Zd and Zu are the impedances of waves that decay downwards and upwards, Z the impedance of the media below, and
    Zu - Zd = (1 + 1/kappa) times the unit matrix. Transmission: the displacement on the interface is
    (1 + 1/kappa) (Zu - Z)^-1 times the incoming one. Reflection: (Zu - Z)^-1 (Z - Zd) times the incoming one. The
    reflection is exactly zero where the medium below is the layer's own.
    """
    uu, uw, ww = layers[number, _BELOW_UU], layers[number, _BELOW_UW], layers[number, _BELOW_WW]
    zeta, eta = 0.5 * (1.0 + 1.0 / kappa), 0.5 * (1.0 - 1.0 / kappa)  # Zd = [[-zeta, eta], ..], Zu = [[zeta, eta], ..]
    w11, w12, w22 = zeta - uu, eta - uw, zeta - ww
    b11, b12, b22 = uu + zeta, uw - eta, ww + zeta
    over = 1.0 / (w11 * w22 - w12 * w12)
    twice = 2.0 * zeta * over
    layers[number, _TRANSMISSION_UU] = twice * w22
    layers[number, _TRANSMISSION_UW] = -twice * w12
    layers[number, _TRANSMISSION_WW] = twice * w11
    r11 = over * (w22 * b11 - w12 * b12)
    r12 = over * (w22 * b12 - w12 * b22)
    r22 = over * (w11 * b22 - w12 * b12)
    # from (u, w) to the sum and the difference (p, n)
    mean = 0.5 * (r11 + r22)
    layers[number, _REFLECTION_PP], layers[number, _REFLECTION_PN], layers[number, _REFLECTION_NN] = (
        mean + r12,
        0.5 * (r11 - r22),
        mean - r12,
    )


@compiled
def _impedance_on_thick_layer(x, kappa, number, layers):
    """Return the impedance on top of a thick layer from its reflection; store the round-trip matrix of its waves.

    What is returned for the outermost layer (number 0) has no meaning and is not used.
    """
    pp, pn, nn = layers[number, _REFLECTION_PP], layers[number, _REFLECTION_PN], layers[number, _REFLECTION_NN]
    square = layers[number, _DECAY] * layers[number, _DECAY]
    turn = (2.0 / kappa) * x
    step = pn - turn * nn
    pp, pn, nn = (pp - turn * (pn + step)) * square, step * square, nn * square
    layers[number, _ROUND_TRIP_PP], layers[number, _ROUND_TRIP_PN], layers[number, _ROUND_TRIP_NN] = pp, pn, nn
    if number == 0:  # the load is known: 1 + Zd^-1 Zu R'
        layers[number, _INVERSE_DETERMINANT] = 1.0 / ((1.0 - kappa * pp) * (1.0 - nn / kappa) - pn * pn)
        return pp, pn, nn
    solve = 1.0 / ((1.0 + pp) * (1.0 + nn) - pn * pn)
    layers[number, _INVERSE_DETERMINANT] = solve
    less = pp * nn - pn * pn
    pp, pn, nn = (pp + less) * solve, pn * solve, (nn + less) * solve
    zeta, eta = 0.5 * (1.0 + 1.0 / kappa), 0.5 * (1.0 - 1.0 / kappa)
    return -zeta + zeta * (pp + 2.0 * pn + nn), eta + zeta * (pp - nn), -zeta + zeta * (pp - 2.0 * pn + nn)


@compiled
def _set_impedance_below(media, number, uu, uw, ww, layers):
    """Store the impedance below a layer in units of the layer's modulus."""
    over = 1.0 / media[number, MODULUS]
    layers[number, _BELOW_UU], layers[number, _BELOW_UW], layers[number, _BELOW_WW] = uu * over, uw * over, ww * over


@compiled
def _start_at_half_space(media, layers):
    """Store the impedance of the half-space below the lowest layer, which is the same for every wavenumber."""
    bottom = media.shape[0] - 1
    kappa, g = media[bottom, KAPPA], media[bottom, MODULUS]
    zeta, eta = -0.5 * g * (1.0 + 1.0 / kappa), 0.5 * g * (1.0 - 1.0 / kappa)
    _set_impedance_below(media, bottom - 1, zeta, eta, zeta, layers)


@compiled
def _impedances_upward(q, media, transmission, layers):
    """Fill the table of layers from the lowest layer up; `transmission` (3,): that of the lowest layer."""
    lowest = media.shape[0] - 2
    for number in range(lowest, -1, -1):
        g, kappa = media[number, MODULUS], media[number, KAPPA]
        x = q * media[number, THICKNESS]
        layers[number, _DECAY] = np.exp(-x)
        if abs(x) < 1.0:
            uu, uw, ww = _impedance_on_thin_layer(x, 4.0 / (1.0 + kappa), number, layers)
        else:
            if number < lowest:
                _reflect(kappa, number, layers)
            else:
                for k in range(3):  # a smaller wavenumber may have left the transfer matrix of a thin layer there
                    layers[number, _TRANSMISSION_UU + k] = transmission[k]
            uu, uw, ww = _impedance_on_thick_layer(x, kappa, number, layers)
        if number > 0:
            _set_impedance_below(media, number - 1, uu * g, uw * g, ww * g, layers)


@compiled
def _through_loaded_layer(q, media, layers, tau0, sigma0, waves):
    """Return the displacement below the outermost layer under tractions on its top.

    `waves` [0:2] receives the amplitudes on its top less those of a half-space, [2:4] those at its lower interface.
    """
    x = q * media[0, THICKNESS]
    kappa = media[0, KAPPA]
    solve = layers[0, _INVERSE_DETERMINANT]
    if abs(x) < 1.0:
        a11, a12 = layers[0, _TRACTION_11], layers[0, _TRACTION_12]
        a21, a22 = layers[0, _TRACTION_21], layers[0, _TRACTION_22]
        return (a22 * tau0 - a12 * sigma0) * solve, (a11 * sigma0 - a21 * tau0) * solve
    p0, n0 = -kappa * (tau0 + sigma0), sigma0 - tau0
    over = 1.0 / kappa
    pp, pn, nn = kappa * layers[0, _ROUND_TRIP_PP], layers[0, _ROUND_TRIP_PN], over * layers[0, _ROUND_TRIP_NN]
    r1, r2 = pp * p0 + pn * (kappa * n0), nn * n0 + pn * (over * p0)
    dp = ((1.0 - nn) * r1 + kappa * pn * r2) * solve
    dn = ((1.0 - pp) * r2 + over * pn * r1) * solve
    waves[0], waves[1] = dp, dn
    return _through_thick_layer(x, over, p0 + dp, n0 + dn, 0, layers, waves)


@compiled
def _through_thick_layer(x, over, p, n, number, layers, waves):
    """Return the displacement below a thick layer from the amplitudes of its downward waves on its top.

    `over`: 1 / kappa. `waves` [2:4] receives the amplitudes at the lower interface.
    """
    p = p * layers[number, _DECAY]
    n = n * layers[number, _DECAY] - (2.0 * over) * x * p
    waves[2], waves[3] = p, n
    u, w = 0.5 * (p + n), 0.5 * (p - n)
    return (
        layers[number, _TRANSMISSION_UU] * u + layers[number, _TRANSMISSION_UW] * w,
        layers[number, _TRANSMISSION_UW] * u + layers[number, _TRANSMISSION_WW] * w,
    )


@compiled
def _through_layer(q, media, layers, number, u, w, waves):
    """Return the displacement below a layer from that on its top; `waves` [0:2] receives the amplitudes on its top."""
    x = q * media[number, THICKNESS]
    solve = layers[number, _INVERSE_DETERMINANT]
    if abs(x) < 1.0:
        f11, f12 = layers[number, _TRANSFER_11], layers[number, _TRANSFER_12]
        f21, f22 = layers[number, _TRANSFER_21], layers[number, _TRANSFER_22]
        return (f22 * u - f12 * w) * solve, (f11 * w - f21 * u) * solve
    p, n = u + w, u - w
    pp, pn, nn = layers[number, _ROUND_TRIP_PP], layers[number, _ROUND_TRIP_PN], layers[number, _ROUND_TRIP_NN]
    p, n = ((1.0 + nn) * p - pn * n) * solve, ((1.0 + pp) * n - pn * p) * solve
    waves[0], waves[1] = p, n
    return _through_thick_layer(x, 1.0 / media[number, KAPPA], p, n, number, layers, waves)


@compiled
def _downward_waves(factors, over, p, n):
    """Return the state of waves that decay downwards, with amplitudes (p, n) on top of the medium."""
    p = p * factors.decay_down
    n = n * factors.decay_down - (2.0 * over) * factors.down * p
    q = over * p
    return 0.5 * (p + n), 0.5 * (p - n), 0.5 * (-q - n), 0.5 * (n - q)


@compiled
def _waves_of_both_directions(factors, over, medium, layers, p, n, waves):
    """Return the state in a thick layer: downward waves of amplitudes p, n on its top, and the reflected waves."""
    p_sent, n_sent = waves[2], waves[3]
    p_up = (layers[medium, _REFLECTION_PP] * p_sent + layers[medium, _REFLECTION_PN] * n_sent) * factors.decay_up
    n_up = (layers[medium, _REFLECTION_PN] * p_sent + layers[medium, _REFLECTION_NN] * n_sent) * factors.decay_up
    p_up = p_up - (2.0 * over) * factors.up * n_up
    u, w, tau, sigma = _downward_waves(factors, over, p, n)
    less = over * n_up
    return (
        u + 0.5 * (p_up + n_up),
        w + 0.5 * (p_up - n_up),
        tau + 0.5 * (p_up + less),
        sigma + 0.5 * (p_up - less),
    )


@compiled
def _state_at_depth(q, medium, carried, remainder, media, factors, layers, load, waves):
    """Return u, w and tau, sigma in the medium's own units under pressure (load 0) or traction along k (1)."""
    tau0, sigma0 = float(load), load - 1.0
    bottom = media.shape[0] - 1
    over = 1.0 / media[medium, KAPPA]
    p0, n0 = -media[0, KAPPA] * (tau0 + sigma0) + q * 0.0, sigma0 - tau0 + q * 0.0
    if bottom == 0:
        return _downward_waves(factors, over, p0, n0)
    u, w = _through_loaded_layer(q, media, layers, tau0, sigma0, waves)
    for number in range(1, min(medium + 1, bottom)):
        u, w = _through_layer(q, media, layers, number, u, w, waves)
    if medium == bottom:
        return _downward_waves(factors, over, u + w, u - w)
    if carried:
        tau = layers[medium, _BELOW_UU] * u + layers[medium, _BELOW_UW] * w
        sigma = layers[medium, _BELOW_UW] * u + layers[medium, _BELOW_WW] * w
        u, w, tau, sigma = _state_above_interface(factors, 4.0 / (1.0 + media[medium, KAPPA]), u, w, tau, sigma)
        if remainder:
            u0, w0, tau_0, sigma_0 = _downward_waves(factors, over, p0, n0)
            return u - u0, w - w0, tau - tau_0, sigma - sigma_0
        return u, w, tau, sigma
    p, n = waves[0], waves[1]
    if medium == 0 and not remainder:
        p, n = p + p0, n + n0
    return _waves_of_both_directions(factors, over, medium, layers, p, n, waves)


@compiled
def _even_odd(decay, sinh, small):
    """Return 1 + exp(-2 s) and 1 - exp(-2 s) from exp(-s) and, where s is small, sinh s."""
    square = decay * decay
    return 1.0 + square, 2.0 * decay * sinh if small else 1.0 - square


@compiled
def _anti_plane(q, medium, remainder, media, factors, layers, impedances, out):
    """Compute the anti-plane response (last three rows) by sums of positive terms only.

    impedances : (media,), scratch.
    out : (ROWS,), receives the rows `ACROSS_*`.
    """
    bottom = media.shape[0] - 1
    impedance = media[bottom, MODULUS] + q * 0.0
    for number in range(bottom - 1, 0, -1):
        g = media[number, MODULUS]
        impedances[number] = impedance / g
        even, odd = _even_odd(layers[number, _DECAY], layers[number, _SINH], abs(q * media[number, THICKNESS]) < 1.0)
        impedance = g * (impedance * even + g * odd) / (g * even + impedance * odd)
    if bottom > 0:
        impedances[0] = impedance
    v = 1.0 + q * 0.0  # displacement on top of the medium, times G1 q under a unit traction on the surface
    fall = factors.decay_down
    for number in range(min(medium + 1, bottom)):
        zeta = impedances[number]
        even, odd = _even_odd(layers[number, _DECAY], layers[number, _SINH], abs(q * media[number, THICKNESS]) < 1.0)
        through = even + zeta * odd
        # over the traction on the surface, or the displacement on the top of an inner layer
        scale = 1.0 / (odd + zeta * even) if number == 0 else v / through
        if remainder:
            scale = (1.0 - zeta) * scale
            decay = layers[number, _DECAY]
            square, up = decay * decay * fall, decay * factors.decay_up
            out[ACROSS_ET], out[ACROSS_TZ] = scale * (square + up), -scale * (square - up)
            out[ACROSS_U] = 2.0 * out[ACROSS_ET]
            return
        if number == medium:
            even, odd = _even_odd(factors.decay_up, factors.sinh, abs(factors.up) < 1.0)
            scale = scale * fall
            out[ACROSS_U] = 2.0 * scale * (even + zeta * odd)
            out[ACROSS_ET] = 0.5 * media[medium, MODULUS] * out[ACROSS_U]
            out[ACROSS_TZ] = -media[medium, MODULUS] * scale * (odd + zeta * even)
            return
        v = 2.0 * layers[number, _DECAY] * scale
    v = v * fall
    out[ACROSS_U], out[ACROSS_ET] = 2.0 * v, media[bottom, MODULUS] * v
    out[ACROSS_TZ] = -out[ACROSS_ET]


@compiled
def _depth_factors(q, above, thickness, inside, carried, c):
    """Return the quantities of a depth `above` below the top of its medium; `inside`: it has a lower interface."""
    zero, down = q * 0.0, q * above
    up, decay_up, sinh, cosh, gamma, delta = zero, zero, zero, zero, zero, zero
    if inside:
        up = q * (thickness - above)
        decay_up = np.exp(-up)
        if carried:
            sinh, cosh, gamma, delta = _exponential(up, c)
    return DepthFactors(down, up, np.exp(-down), decay_up, sinh, cosh, gamma, delta)


@compiled
def fill_response(q, above, medium, media, remainder, pressed, sheared, out):
    """Compute the rows of the response at a depth for each wavenumber.

    q : (n,), real or complex [rad/m].
    above : distance of the depth below the top of its medium [m].
    medium : number of the medium of the depth.
    media : (layers + 1, 3), see `frequency_response`.
    remainder : subtract the half-space of the outermost material.
    pressed, sheared : compute the rows under pressure; under tractions. Other rows of `out` are unchanged.
    out : (ROWS, n).
    """
    bottom = media.shape[0] - 1
    layers = np.zeros((media.shape[0], _COLUMNS), out.dtype)
    impedances, waves, column = np.empty(media.shape[0], out.dtype), np.empty(4, out.dtype), np.empty(ROWS, out.dtype)
    g, c, thickness = media[medium, MODULUS], 4.0 / (1.0 + media[medium, KAPPA]), media[medium, THICKNESS]
    if bottom > 0:
        _start_at_half_space(media, layers)
        _reflect(media[bottom - 1, KAPPA], bottom - 1, layers)
    transmission = layers[max(bottom - 1, 0), _TRANSMISSION_UU : _TRANSMISSION_WW + 1].copy()
    for i in range(q.size):
        inside = medium < bottom
        carried = inside and (abs(q[i] * thickness) < 1.0 or (abs(q[i] * (thickness - above)) < 1.0 and not remainder))
        factors = _depth_factors(q[i], above, thickness, inside, carried, c)
        if bottom > 0:
            _impedances_upward(q[i], media, transmission, layers)
        for load in range(0 if pressed else 1, 2 if sheared else 1):
            u, w, tau, sigma = _state_at_depth(q[i], medium, carried, remainder, media, factors, layers, load, waves)
            row = 6 * load
            column[row], column[row + 1], column[row + 2], column[row + 3] = u, w, g * tau, g * sigma
            column[row + 4] = g * ((c - 1.0) * sigma - c * u)
            column[row + 5] = g * (c - 1.0) * (sigma - u)
        if sheared:
            _anti_plane(q[i], medium, remainder, media, factors, layers, impedances, column)
        for row in range(0 if pressed else 6, ROWS if sheared else 6):
            out[row, i] = column[row]
