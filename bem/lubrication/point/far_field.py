"""Pressure far away from a point contact, where only the gap of rigid paraboloids counts.

There h = r^2 g/2 with g = cos^2 t + lambda sin^2 t of the direction t, and Reynolds' equation has the solution
p = T(t)/r^3 with (g^3 T')' - 9 g^3 T = 48 (c_x cos t + lambda c_y sin t) and rupture where T would be negative. It is
close to the solution of Kapitza (1955) for spheres at any distance, p = -(A_x x + A_y y)/h^2; rupture is further
downstream (for a sphere at 108 degrees from the inlet, where tan t = -3 tanh 3t, not at 90). The far pressure has
Kapitza's form, p = r s(t)/h^2, with the exact limit at large distance.

The approach of the bodies (in time) adds p = A/h^2 with A = -3/(1 + lambda) dH0/dT, which holds at any distance; in the
ruptured region Kapitza's part of the pressure is negative. Curvatures are (1, lambda), others where radii change in
time.

The far pressure decays with the third power of the distance, and the load that it carries with the first: films with
p = 0 on the edge of a rectangle would depend on the size of the rectangle by tenths.

Cost: one sparse solve of `ANGLES` equations a direction of entrainment, cached. Verified in
tests/lubrication/point/test_point_film.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import spsolve

from bem.grid import FloatArray

ANGLES = 2880
"""Number of directions; the error of the profile is 0.1 % with it."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(24)

Rectangle = tuple[float, float, float, float]
Pair = tuple[float, float]


@dataclass(frozen=True)
class FarField:
    """Far pressure of entrainment and squeeze.

    entrainment : along x and y, over that of its unit.
    curvatures : of the gap along x and y.
    squeeze : A = p h^2 of the approach of the bodies.
    """

    entrainment: Pair
    curvatures: Pair
    squeeze: float = 0.0

    def source(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return p h^2 at points of equal shapes; zero in the ruptured film."""
        angle = np.mod(np.arctan2(y, x), 2 * np.pi)
        profile = far_profile(self.entrainment, self.curvatures)
        s = np.interp(angle, 2 * np.pi * np.arange(ANGLES + 1) / ANGLES, np.append(profile, profile[0]))
        return self.add_squeeze(np.hypot(x, y) * s, x, y)

    def add_squeeze(self, wedge: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return p h^2 of entrainment and squeeze together; `wedge` is p h^2 of entrainment alone."""
        if self.squeeze == 0:
            return wedge
        (c, d), (k, m) = self.entrainment, self.curvatures
        kapitza = -6 * (c * k * x / (3 * k + 2 * m) + d * m * y / (2 * k + 3 * m))
        return np.maximum(np.where(wedge > 0, wedge, np.minimum(kapitza, 0.0)) + self.squeeze, 0.0)


@lru_cache(maxsize=64)
def _unit_profile(direction: Pair, curvatures: Pair) -> FloatArray:
    """Return `far_profile` of entrainment of size 1, by an active-set method on a ring of directions."""
    step = 2 * np.pi / ANGLES
    angle = step * np.arange(ANGLES, dtype=np.float64)
    cube = _gap_profile(angle, curvatures) ** 3
    behind = _gap_profile(angle + 0.5 * step, curvatures) ** 3 / step**2
    before = np.roll(behind, 1)
    drive = -48 * (curvatures[0] * direction[0] * np.cos(angle) + curvatures[1] * direction[1] * np.sin(angle))
    diagonal = behind + before + 9 * cube
    free = drive > 0
    for _ in range(ANGLES):
        rows = np.where(free, 1.0, 0.0)
        matrix = diags_array(
            [
                np.where(free, diagonal, 1.0),
                -(rows * behind)[:-1],
                -(rows * before)[1:],
                [-rows[0] * before[0]],
                [-rows[-1] * behind[-1]],
            ],
            offsets=[0, 1, -1, ANGLES - 1, 1 - ANGLES],
            format="csc",
        )
        solution = spsolve(matrix, np.where(free, drive, 0.0))
        residual = drive - (diagonal * solution - behind * np.roll(solution, -1) - before * np.roll(solution, 1))
        new_free = np.where(free, solution > 0, residual > 1e-12 * np.abs(drive).max())
        if (new_free == free).all():
            break
        free = new_free
    return np.maximum(solution, 0.0) * _gap_profile(angle, curvatures) ** 2 / 4


def far_profile(entrainment: Pair, curvatures: Pair) -> FloatArray:
    """Return s(t) in the directions t = 2 pi k / ANGLES."""
    speed = math.hypot(*entrainment)
    if speed == 0:
        return np.zeros(ANGLES)
    # rounded: in time the speed changes and the direction does not, one cached profile serves all steps
    direction = round(entrainment[0] / speed, 12), round(entrainment[1] / speed, 12)
    return speed * _unit_profile(direction, curvatures)


def _gap_profile(angle: FloatArray, curvatures: Pair) -> FloatArray:
    """Return g(t) = 2 h/r^2."""
    return curvatures[0] * np.cos(angle) ** 2 + curvatures[1] * np.sin(angle) ** 2


def far_shear(entrainment: Pair, curvatures: Pair) -> float:
    """Return the integral of 2/g(t) dt over the directions with oil, which is that of dx dy/h by ln r.

    The integral over the plane has no limit with the distance.
    """
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    full = far_profile(entrainment, curvatures) > 0
    return float((2 / _gap_profile(angle[full], curvatures)).sum()) * 2 * np.pi / ANGLES


def far_load(rectangle: Rectangle, far: FarField, separation: float, load: float, squeeze_slope: float = 0.0) -> Pair:
    """Return the load of the far pressure outside a rectangle, and its derivative with H0.

    Parameters
    ----------
    rectangle : edges (x0, x1, y0, y1).
    far : pressure far from the contact.
    separation : H0.
    load : of elastic bodies, which deflect the gap there as a point force; zero of rigid bodies.
    squeeze_slope : derivative of `far.squeeze` with H0.
    """
    x0, x1, y0, y1 = rectangle
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    cos, sin = np.cos(angle), np.sin(angle)
    with np.errstate(divide="ignore"):
        edge = np.minimum(np.where(cos > 0, x1, -x0) / np.abs(cos), np.where(sin > 0, y1, -y0) / np.abs(sin))
    profile = far_profile(far.entrainment, far.curvatures)
    if far.squeeze == 0 and squeeze_slope == 0:
        full = profile > 0
        angle, edge, profile = angle[full], edge[full], profile[full]
    ratio = 0.5 * (_POINTS + 1)  # edge / r
    r = edge[:, None] / ratio
    source = far.add_squeeze(profile[:, None] * r, r * np.cos(angle)[:, None], r * np.sin(angle)[:, None])
    gap = 0.5 * r**2 * _gap_profile(angle, far.curvatures)[:, None]
    film = gap + separation + 2 / np.pi * load / r
    bounded = film > 0.1 * gap
    film = np.where(bounded, film, 0.1 * gap)
    value = source * r / film**2 * edge[:, None] / ratio**2
    slope = np.where(bounded, -2 * value / film, 0.0)
    slope += np.where(source > 0, squeeze_slope * r / film**2 * edge[:, None] / ratio**2, 0.0)
    weight = 0.5 * _WEIGHTS * 2 * np.pi / ANGLES
    return float((value @ weight).sum()), float((slope @ weight).sum())
