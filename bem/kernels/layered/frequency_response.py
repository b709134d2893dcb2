"""Frequency response of a stack of bonded layers on a half-space: three displacements, six stresses, at any depth.

Derivation. With fields proportional to exp(i k.x), q = |k|, e along k, t across it and z into the body, write
u_e = i u, u_z = w, sigma_ez = i tau, sigma_zz = sigma. In the plane (e, z) Hooke's law and equilibrium are
y' = q M y for y = (u, w, tau / 2 G q, sigma / 2 G q), with c = 1/(1 - nu) and

    M = [[0, -1, 2, 0], [c-1, 0, 0, 2-c], [c, 0, 0, 1-c], [0, 0, 1, 0]],     (M^2 - 1)^2 = 0,

so that exp(M s) is made of cosh s, sinh s, s sinh s and s cosh s - sinh s only, and nothing is singular at nu = 1/2.
The in-plane direct stresses follow from the state: sigma_ee = -c u + (c-1) sigma, sigma_tt = (c-1)(sigma - u), in
units of 2 G q. In the sums and differences p = u + w, n = u - w, P = tau + sigma, N = tau - sigma (kappa = 3 - 4 nu):

- waves that decay downwards, at distance s (times q): p, n - 2 s p / kappa, P = -p / kappa, N = -n, all times exp(-s);
- waves that decay upwards: n, p - 2 s n / kappa, P = p, N = n / kappa, all times exp(-s).

So the impedances (tau, sigma) = Z (u, w) of the two kinds, Zd = -diag(1/kappa, 1) and Zu = diag(1, 1/kappa) in (p, n),
differ by the same number in both. The solution at one wavenumber (`waves`) starts with the impedance Zd of the half-
space. The impedance Z of the media below is carried up to the lower side of the outermost layer. A layer of q h >= 1
reflects the waves at its lower interface by R = (Zu - Z)^-1 (Z - Zd), which is R' = P^T R P on its top, with P = exp(-q
h) [[1, 0], [-2 q h / kappa, 1]]. A thinner layer takes exp(-M q h), because the waves in it cancel if moduli differ
much. Then displacements are carried from the load through the outermost layer (q h >= 1: as waves down; q h < 1: from
its lower side, whose state the load gives, up to the depth) and down through the others. Only decaying exponentials
occur and nothing overflows. With one layer the result is the closed form of O'Sullivan and King (1988) for the normal
displacement. Across the plane (anti-plane shear) every impedance is a sum of positive terms, Z = G (Z + G tanh q h)/(G
+ Z tanh q h).

All responses are analytic in q, and `wave_frame_response` takes complex q: `hankel` moves the path of integration into
the complex plane. Error: 1e-13 of the largest stress and displacement (tests/kernels/test_layered.py,
tests/kernels/test_stacks.py).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError
from bem.kernels.layered import waves
from bem.kernels.loads import Load
from bem.materials import Body

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class QuadratureScales:
    """Scales that the quadrature of a response over q has to resolve.

    Attributes
    ----------
    remainder : True in the outermost layer, where the half-space of its material is left out of the response.
    decay : d [m]; the response decays like exp(-q d).
    smallest : wavenumber [rad/m] below which the response is smooth.
    angle : angle [rad] from the real axis of q within which the response has no pole.
    """

    remainder: bool
    decay: float
    smallest: float
    angle: float


def quadrature_scales(body: Body, depth: float) -> QuadratureScales:
    """Return the scales of the response of a layered body at a depth [m].

    A stiff layer changes the response down to wavenumbers of q = G_below / (G h), G_below the lowest modulus below the
    layer. Poles: 52 degrees from the real axis or more for every ratio of moduli with one layer (a stiff plate on a
    half-space has them at 60). In the limit of thin layers the energy of a stack is a sum of powers of q from -2 (a
    soft, incompressible film between stiff media) to 4 (bending) with positive coefficients, which cannot vanish within
    180 / (4 + 2) = 30 degrees; a stiff plate on such a film on a stiff base comes near that.
    """
    outermost = body.medium_at(depth) == 0
    moduli = [solid.shear_modulus for solid in body.media]
    below = [min(moduli[number + 1 :]) for number in range(len(body.layers))]
    length = sum(
        layer.thickness * max(1.0, modulus / softest)
        for layer, modulus, softest in zip(body.layers, moduli, below, strict=False)
    )
    decay = 2 * body.interfaces[0] - depth if outermost else depth
    return QuadratureScales(outermost, decay, 1 / (8 * length), np.deg2rad(52.0 if len(body.layers) == 1 else 30.0))


def _media(body: Body) -> FloatArray:
    """Return thickness [m], modulus over that of the outermost medium, and kappa of each medium: (layers + 1, 3)."""
    thicknesses = [*(layer.thickness for layer in body.layers), 0.0]
    first = body.surface_material.shear_modulus
    return np.array(
        [
            (thickness, solid.shear_modulus / first, 3 - 4 * solid.poissons_ratio)
            for thickness, solid in zip(thicknesses, body.media, strict=True)
        ]
    )


def wave_frame_response(
    wavenumber: NDArray, body: Body, depth: float, *, remainder: bool = False, load: Load | None = None
) -> NDArray:
    """Compute the response of a body to unit tractions exp(i k.x) on its surface, in the frame of the wavevector.

    Parameters
    ----------
    wavenumber : (n,) q [rad/m], real and not negative, or complex with a positive real part.
    body : with any number of layers.
    depth : z [m], not negative; an interface itself counts as the layer above it.
    remainder : subtract the response of a half-space of the outermost material (only for depths in that layer). The
        remainder decays like exp(-q (2 h - z)). For q h >= 1 it is computed without cancellation; for q h < 1 it is the
        difference of both responses. For identical materials it vanishes, to round-off where q h < 1.
    load : compute the rows under pressure only, or the rows under tractions only; the other rows are zero.

    Returns
    -------
    (15, n) of the type of `wavenumber`; `waves` names the rows. Rows 0-5: u, w, tau, sigma, sigma_ee, sigma_tt under a
    unit pressure. Rows 6-11: these six under tau = 1 on the surface. Rows 12-14: transverse displacement,
    sigma_et / i and sigma_tz under sigma_tz = -1 on the surface. Displacements are multiplied by 2 G1 q, G1 the modulus
    of the outermost material; stresses are per unit load.

    Raises
    ------
    InputError : the remainder below the outermost layer.
    """
    medium = body.medium_at(depth)
    if remainder and (medium > 0 or body.homogeneous):
        outermost = body.interfaces[0] if body.interfaces else 0.0
        raise InputError(
            f"depth {depth!r}: the remainder is defined in the outermost layer only (0 to {outermost!r} m)"
        )
    above = depth - (body.interfaces[medium - 1] if medium else 0.0)
    q = np.ascontiguousarray(wavenumber).ravel()
    out = np.zeros((waves.ROWS, q.size), dtype=q.dtype)
    pressed, sheared = load is not Load.TANGENTIAL, load is not Load.NORMAL
    waves.fill_response(q, float(above), medium, _media(body), remainder, pressed, sheared, out)
    return out


def surface_response(kx: ArrayLike, ky: ArrayLike, body: Body, load: Load, *, remainder: bool = False) -> FloatArray:
    """Compute the normal surface displacement [m/Pa] under a unit load exp(i k.x): pressure, or traction along +x.

    kx and ky [rad/m] broadcast. The spectrum is the result under pressure, and i times the result (odd in kx) under
    traction. Zero at k = 0, where the response has no limit. `remainder` as in `wave_frame_response`.
    """
    cosine, _, q = _directions(kx, ky)
    functions = wave_frame_response(q, body, 0.0, remainder=remainder, load=load)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(q > 0, 0.5 / (body.surface_material.shear_modulus * q), 0.0)
    if load is Load.TANGENTIAL:
        return scale * cosine * functions[waves.TANGENTIAL_W].reshape(q.shape)
    return scale * functions[waves.NORMAL_W].reshape(q.shape)


def in_plane_response(kx: ArrayLike, ky: ArrayLike, body: Body, *, remainder: bool = False) -> FloatArray:
    """Compute the in-plane surface displacements [m/Pa] under unit tractions exp(i k.x): (3, ...), real.

    Components: ux under traction along x, uy under traction along y, ux under traction along y (equal to uy under
    traction along x). kx and ky [rad/m] broadcast. Zero at k = 0, where the response has no limit. `remainder` as in
    `wave_frame_response`.
    """
    cosine, sine, q = _directions(kx, ky)
    functions = wave_frame_response(q, body, 0.0, remainder=remainder, load=Load.TANGENTIAL).reshape(
        waves.ROWS, *q.shape
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(q > 0, 0.5 / (body.surface_material.shear_modulus * q), 0.0)
    along, across = -scale * functions[waves.TANGENTIAL_U], scale * functions[waves.ACROSS_U]
    return np.stack(
        [
            cosine**2 * along + sine**2 * across,
            sine**2 * along + cosine**2 * across,
            sine * cosine * (along - across),
        ]
    )


def stress_response(
    kx: ArrayLike, ky: ArrayLike, body: Body, depth: float, load: Load, *, remainder: bool = False
) -> FloatArray:
    """Compute the six stresses at `depth` [m] under a unit load exp(i k.x): pressure, or traction along +x.

    kx and ky [rad/m] broadcast. Returns (6, ...), real, in the order xx yy zz yz xz xy. The spectrum is the result of a
    stress that is even under (x, y) -> (-x, -y), and i times the result of an odd one: yz and xz under pressure, the
    other four under traction. At k = 0: the laterally constrained uniform state. `remainder` as in
    `wave_frame_response`.
    """
    cosine, sine, q = _directions(kx, ky)
    f = wave_frame_response(q, body, depth, remainder=remainder, load=load).reshape(waves.ROWS, *q.shape)
    stress = np.empty((6, *q.shape))
    if load is Load.TANGENTIAL:
        tau, sigma, ee, tt = (
            f[waves.TANGENTIAL_TAU],
            f[waves.TANGENTIAL_SIGMA],
            f[waves.TANGENTIAL_EE],
            f[waves.TANGENTIAL_TT],
        )
        across, below = f[waves.ACROSS_ET], f[waves.ACROSS_TZ]
        stress[0] = cosine * (cosine**2 * ee + sine**2 * (tt + 2 * across))
        stress[1] = cosine * (sine**2 * (ee - 2 * across) + cosine**2 * tt)
        stress[2] = cosine * sigma
        stress[3] = -sine * cosine * (tau + below)
        stress[4] = sine**2 * below - cosine**2 * tau
        stress[5] = sine * (cosine**2 * (ee - tt) - (cosine**2 - sine**2) * across)
        uniform = (0.0, 0.0, 0.0, 0.0, -1.0, 0.0)
    else:
        tau, sigma, ee, tt = f[waves.NORMAL_TAU], f[waves.NORMAL_SIGMA], f[waves.NORMAL_EE], f[waves.NORMAL_TT]
        stress[0] = cosine**2 * ee + sine**2 * tt
        stress[1] = sine**2 * ee + cosine**2 * tt
        stress[2] = sigma
        stress[3] = sine * tau
        stress[4] = cosine * tau
        stress[5] = sine * cosine * (ee - tt)
        nu = body.material_at(depth).poissons_ratio
        lateral = -nu / (1 - nu)
        uniform = (lateral, lateral, -1.0, 0.0, 0.0, 0.0)
    at_rest = q == 0
    for component in range(6):
        stress[component][at_rest] = 0.0 if remainder else uniform[component]
    return stress


def _directions(kx: ArrayLike, ky: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return cosine and sine of the wavevector's direction (1, 0 where k = 0) and its length."""
    kx, ky = np.broadcast_arrays(np.asarray(kx, dtype=np.float64), np.asarray(ky, dtype=np.float64))
    q = np.hypot(kx, ky)
    divisor = np.where(q > 0, q, 1.0)
    return np.where(q > 0, kx / divisor, 1.0), ky / divisor, q
