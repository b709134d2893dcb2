"""Textbook corner sums of a loaded rectangle, in as many digits as mpmath is told to carry.

In sixty digits cancellation does not matter, so they are exact at any distance, depth and aspect ratio; that they are
the right sums is for the quadrature of point forces to say.
"""

import mpmath as mp
import numpy as np


def rectangle(x, y, z, a, b, nu):
    """Stress (6,) under unit pressure and under unit traction, and G times the displacement (3,) under each; z > 0."""
    x, y, z, a, b, nu = (mp.mpf(float(v)) for v in (x, y, z, a, b, nu))
    k = 1 - 2 * nu
    total = [[mp.mpf(0)] * n for n in (6, 6, 3, 3)]
    for u, su in ((x + a, 1), (x - a, -1)):
        for v, sv in ((y + b, 1), (y - b, -1)):
            r = mp.sqrt(u * u + v * v + z * z)
            s = r + z
            angle = mp.atan(u * v / (z * r))
            v_xx, v_yy = -u * v / (r * (u * u + z * z)), -u * v / (r * (v * v + z * z))
            c_xx, c_yy = mp.atan(v / u) - mp.atan(z * v / (u * r)), mp.atan(u / v) - mp.atan(z * u / (v * r))
            v_x, v_y, c_xy = mp.log(v + r), mp.log(u + r), mp.log(s)
            newton = u * v_x + v * v_y - z * angle
            c_x = v * c_xy - v + z * v_x + u * c_xx
            c_y = u * c_xy - u + z * v_y + v * c_yy
            f_xx, f_xy = -u * v_x + z * c_xx, z * c_xy - r
            values = (
                (
                    -2 * nu * angle - z * v_xx - k * c_xx,
                    -2 * nu * angle - z * v_yy - k * c_yy,
                    -angle + z * (v_xx + v_yy),
                    z * z * u / (r * (v * v + z * z)),
                    z * z * v / (r * (u * u + z * z)),
                    -k * c_xy - z / r,
                ),
                (
                    2 * v_x + (2 * nu + z / r) * v / s - z * z * v / (r * (u * u + z * z)),
                    2 * nu * v_x - (2 * nu + z / r) * v / s,
                    z * z * v / (r * (u * u + z * z)),
                    -z / r,
                    -angle - z * v_xx,
                    v_y - (2 * nu + z / r) * u / s,
                ),
                (-k * c_x - z * v_x, -k * c_y - z * v_y, 2 * (1 - nu) * newton + z * angle),
                (2 * newton + 2 * nu * f_xx - z * c_xx, 2 * nu * f_xy - z * c_xy, k * c_x - z * v_x),
            )
            for sums, terms in zip(total, values, strict=True):
                for n, term in enumerate(terms):
                    sums[n] += su * sv * term
    scales = (2 * mp.pi, 2 * mp.pi, 4 * mp.pi, 4 * mp.pi)
    return [np.array([float(t / scale) for t in sums]) for sums, scale in zip(total, scales, strict=True)]
