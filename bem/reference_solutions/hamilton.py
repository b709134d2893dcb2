"""Stresses below a spherical Hertz contact, at rest and sliding; all six components, on and below the surface.

Hamilton, *Proc. Inst. Mech. Eng.* 197C (1983) 53; Sackfield & Hills, *J. Strain Anal.* 18 (1983) 101 and 195;
Johnson, *Contact Mechanics* (1985), 3.19 and 7.1. The printed formulas are long; here they follow from one family of
harmonic functions. With lengths in contact radii, w = z + i t, R = sqrt(r^2 + w^2), S = R + w:

    V = (pi p0/2) integral_{-1}^{1} (1 - t^2) / R dt     is the potential of p0 sqrt(1 - r^2),
    V = dF/dz, F = dG/dz                                  (ln S and w ln S - R instead of 1/R),

    pressure p:    xx = [2 nu V_z - z V_xx - (1-2nu) F_xx] / 2pi, zz = [V_z - z V_zz] / 2pi,
                   yz = -z V_yz / 2pi, xz = -z V_xz / 2pi, xy = -[z V_xy + (1-2nu) F_xy] / 2pi
    traction p:    xx = [2(1+nu) V_x + 2nu G_xxx - z F_xxx] / 2pi, yy = [2nu V_x + 2nu G_xyy - z F_xyy] / 2pi,
    along +x       zz = -z V_xz / 2pi, yz = -z V_xy / 2pi, xz = [V_z - z V_xx] / 2pi,
                   xy = [V_y + 2nu G_xxy - z F_xxy] / 2pi

Derivatives are taken with D = (1/r) d/dr. Near the contact the integral over t is done by parts (antiderivatives in w);
beyond four radii, where that cancels, by 16 Gauss-Jacobi points, which are exact to round-off there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import roots_jacobi

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_FAR = 4.0


class _Potentials(NamedTuple):
    """V_z, D V, D V_z, D^2 V, D F, D^2 F, D^3 F, D^2 G, D^3 G; those with singular edges are already times z."""

    v_z: FloatArray
    d_v: FloatArray
    z_d_vz: FloatArray
    z_d2_v: FloatArray
    d_f: FloatArray
    d2_f: FloatArray
    z_d3_f: FloatArray
    d2_g: FloatArray
    d3_g: FloatArray


def sphere_stress(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    *,
    contact_radius: float,
    maximum_pressure: float,
    poissons_ratio: float,
    friction: float = 0.0,
) -> FloatArray:
    """Stress (6, ...) [Pa], order xx yy zz yz xz xy; shapes of x, y and z >= 0 [m] are broadcast.

    Traction friction x pressure along +x on the body; z into it; tension positive.
    """
    arrays = np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) / contact_radius for v in (x, y, z)))
    shape = arrays[0].shape
    flat_x, flat_y, flat_z = (v.ravel() for v in arrays)
    sphere = _sphere_stress(flat_x, flat_y, flat_z, poissons_ratio, friction)
    return (maximum_pressure * sphere).reshape(6, *shape)


def _sphere_stress(x: FloatArray, y: FloatArray, z: FloatArray, nu: float, friction: float) -> FloatArray:
    z = np.abs(z)
    r2 = x * x + y * y
    fields = np.empty((9, x.size))
    near = r2 + z * z < _FAR**2
    fields[:, near] = _near(r2[near], z[near])
    fields[:, ~near] = _far(r2[~near], z[~near])
    p = _Potentials(*fields)
    z_v_zz = -(2 * z * p.d_v + r2 * p.z_d2_v)
    z_v_xx = z * p.d_v + x * x * p.z_d2_v
    z_v_yy = z * p.d_v + y * y * p.z_d2_v
    z_v_xy = x * y * p.z_d2_v
    normal = np.stack(
        [
            2 * nu * p.v_z - z_v_xx - (1 - 2 * nu) * (p.d_f + x * x * p.d2_f),
            2 * nu * p.v_z - z_v_yy - (1 - 2 * nu) * (p.d_f + y * y * p.d2_f),
            p.v_z - z_v_zz,
            -y * p.z_d_vz,
            -x * p.z_d_vz,
            -z_v_xy - (1 - 2 * nu) * x * y * p.d2_f,
        ]
    )
    if friction:
        sliding = np.stack(
            [
                x
                * (2 * (1 + nu) * p.d_v + 2 * nu * (3 * p.d2_g + x * x * p.d3_g) - (3 * z * p.d2_f + x * x * p.z_d3_f)),
                x * (2 * nu * p.d_v + 2 * nu * (p.d2_g + y * y * p.d3_g) - (z * p.d2_f + y * y * p.z_d3_f)),
                -x * p.z_d_vz,
                -z_v_xy,
                p.v_z - z_v_xx,
                y * (p.d_v + 2 * nu * (p.d2_g + x * x * p.d3_g) - (z * p.d2_f + x * x * p.z_d3_f)),
            ]
        )
        normal = normal + friction * sliding
    # (pi p0 / 2) of the potential times 1 / 2 pi of the stress
    return 0.25 * normal


def _near(r2: FloatArray, z: FloatArray) -> FloatArray:
    w = z + 1j
    root = np.sqrt(r2 + w * w)
    s = root + w
    log_s = np.log(s)
    with np.errstate(divide="ignore", invalid="ignore"):
        z_over_root = np.where(z > 0, z / root, 0.0)

    def by_parts(second: ComplexArray, third: ComplexArray) -> FloatArray:
        return 4 * (third.imag - second.real)

    return np.stack(
        [
            by_parts(log_s, w * log_s - root),
            by_parts(-1 / s, -0.5 * log_s - 0.5 * w / s),
            by_parts(z_over_root / s, -z / s),
            by_parts(z_over_root / s**2, -0.5 * z / s**2),
            by_parts(
                -0.5 * log_s - 0.5 * w / s,
                -0.5 * w * log_s + s / 8 + r2 / (4 * s) - r2**2 / (24 * s**3),
            ),
            by_parts(-0.5 / s**2, 1 / (4 * s) + r2 / (12 * s**3)),
            by_parts(z_over_root / s**3, -z / (3 * s**3)),
            by_parts(
                1 / (4 * s) + r2 / (12 * s**3),
                log_s / 8 - r2 / (12 * s**2) - r2**2 / (96 * s**4),
            ),
            by_parts(-1 / (3 * s**3), 1 / (12 * s**2) + r2 / (24 * s**4)),
        ]
    )


def _far(r2: FloatArray, z: FloatArray) -> FloatArray:
    nodes, weights = roots_jacobi(16, 1, 1)
    total = np.zeros((9, z.size))
    for node, weight in zip(nodes, weights, strict=True):
        w = z + 1j * node
        root = np.sqrt(r2 + w * w)
        s = root + w
        total += (
            weight
            * np.stack(
                [
                    -w / root**3,
                    -1 / root**3,
                    3 * z * w / root**5,
                    3 * z / root**5,
                    1 / (root * s),
                    -1 / (root**3 * s) - 1 / (root * s) ** 2,
                    z * (3 / (root**5 * s) + 3 / (root**4 * s**2) + 2 / (root * s) ** 3),
                    1 / (s**2 * root),
                    -1 / (s**2 * root**3) - 2 / (s**3 * root**2),
                ]
            ).real
        )
    return total
