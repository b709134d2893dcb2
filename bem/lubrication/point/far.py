"""Pressure far away from a point contact, where only the gap of rigid paraboloids counts.

There h = r^2 g/2 with g = cos^2 t + lambda sin^2 t of the direction t, and Reynolds' equation has the solution
p = T(t)/r^3 with (g^3 T')' - 9 g^3 T = 48 (c_x cos t + lambda c_y sin t) and rupture where T would be negative. It is
close to what Kapitza (1955) found to hold for spheres at any distance, p = -(A_x x + A_y y)/h^2; rupture is
further downstream (for a sphere at 108 degrees from the inlet, where tan t = -3 tanh 3t, not at 90). It is taken in
Kapitza's form, p = r s(t)/h^2, to which it tends.

Where the bodies approach, p = A/h^2 comes on top, with A = -3/(1 + lambda) dH0/dT (in time), which holds at any
distance; in the ruptured region Kapitza's part is negative there. Curvatures are (1, lambda), others where radii
change in time.

It falls with the third power of the distance, and carries a share of the load with the first: films that end at p = 0
on a rectangle would depend on its size by tenths.
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
"""Directions; 0.1 % of their number in error."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(24)

Rectangle = tuple[float, float, float, float]
Pair = tuple[float, float]


@dataclass(frozen=True)
class Far:
    """What there is far away: entrainment, curvatures of the gap along x and y, and A = p h^2 of the squeeze."""

    drag: Pair
    curvatures: Pair
    squeeze: float = 0.0

    def source(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Far pressure times film squared at points of equal shapes; zero in the ruptured film."""
        angle = np.mod(np.arctan2(y, x), 2 * np.pi)
        profile = far_profile(self.drag, self.curvatures)
        share = np.interp(angle, 2 * np.pi * np.arange(ANGLES + 1) / ANGLES, np.append(profile, profile[0]))
        return self.together(np.hypot(x, y) * share, x, y)

    def together(self, wedge: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
        """Of entrainment and squeeze."""
        if self.squeeze == 0:
            return wedge
        (c, d), (k, m) = self.drag, self.curvatures
        drawn = -6 * (c * k * x / (3 * k + 2 * m) + d * m * y / (2 * k + 3 * m))
        return np.maximum(np.where(wedge > 0, wedge, np.minimum(drawn, 0.0)) + self.squeeze, 0.0)


@lru_cache(maxsize=64)
def _unit_profile(drag: Pair, curvatures: Pair) -> FloatArray:
    """`far_profile` of entrainment of size 1."""
    step = 2 * np.pi / ANGLES
    angle = step * np.arange(ANGLES, dtype=np.float64)
    cube = _opening(angle, curvatures) ** 3
    between = _opening(angle + 0.5 * step, curvatures) ** 3 / step**2
    before = np.roll(between, 1)
    drive = -48 * (curvatures[0] * drag[0] * np.cos(angle) + curvatures[1] * drag[1] * np.sin(angle))
    diagonal = between + before + 9 * cube
    free = drive > 0
    for _ in range(ANGLES):
        rows = np.where(free, 1.0, 0.0)
        matrix = diags_array(
            [
                np.where(free, diagonal, 1.0),
                -(rows * between)[:-1],
                -(rows * before)[1:],
                [-rows[0] * before[0]],
                [-rows[-1] * between[-1]],
            ],
            offsets=[0, 1, -1, ANGLES - 1, 1 - ANGLES],
            format="csc",
        )
        found = spsolve(matrix, np.where(free, drive, 0.0))
        left = drive - (diagonal * found - between * np.roll(found, -1) - before * np.roll(found, 1))
        now = np.where(free, found > 0, left > 1e-12 * np.abs(drive).max())
        if (now == free).all():
            break
        free = now
    return np.maximum(found, 0.0) * _opening(angle, curvatures) ** 2 / 4


def far_profile(drag: Pair, curvatures: Pair) -> FloatArray:
    """s(t) in directions t = 2 pi k / ANGLES."""
    speed = math.hypot(*drag)
    if speed == 0:
        return np.zeros(ANGLES)
    # in time speeds change and directions do not: rounded, so that one profile serves them all
    along = round(drag[0] / speed, 12), round(drag[1] / speed, 12)
    return speed * _unit_profile(along, curvatures)


def _opening(angle: FloatArray, curvatures: Pair) -> FloatArray:
    return curvatures[0] * np.cos(angle) ** 2 + curvatures[1] * np.sin(angle) ** 2


def far_shear(drag: Pair, curvatures: Pair) -> float:
    """Integral of dx dy/h over directions t with oil, by ln r: 2/g(t) dt. It has no limit with the distance."""
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    full = far_profile(drag, curvatures) > 0
    return float((2 / _opening(angle[full], curvatures)).sum()) * 2 * np.pi / ANGLES


def far_load(rectangle: Rectangle, far: Far, datum: float, load: float, squeeze_slope: float = 0.0) -> Pair:
    """Load of the far pressure outside a rectangle, and its derivative with H0, on which the squeeze depends with
    `squeeze_slope`; `load` of elastic bodies lifts the film there as one force would, that of rigid ones is zero."""
    x0, x1, y0, y1 = rectangle
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    cos, sin = np.cos(angle), np.sin(angle)
    with np.errstate(divide="ignore"):
        edge = np.minimum(np.where(cos > 0, x1, -x0) / np.abs(cos), np.where(sin > 0, y1, -y0) / np.abs(sin))
    profile = far_profile(far.drag, far.curvatures)
    if far.squeeze == 0 and squeeze_slope == 0:
        behind = profile > 0
        angle, edge, profile = angle[behind], edge[behind], profile[behind]
    share = 0.5 * (_POINTS + 1)  # edge / r
    r = edge[:, None] / share
    source = far.together(profile[:, None] * r, r * np.cos(angle)[:, None], r * np.sin(angle)[:, None])
    gap = 0.5 * r**2 * _opening(angle, far.curvatures)[:, None]
    film = gap + datum + 2 / np.pi * load / r
    bounded = film > 0.1 * gap
    film = np.where(bounded, film, 0.1 * gap)
    value = source * r / film**2 * edge[:, None] / share**2
    slope = np.where(bounded, -2 * value / film, 0.0)
    slope += np.where(source > 0, squeeze_slope * r / film**2 * edge[:, None] / share**2, 0.0)
    weight = 0.5 * _WEIGHTS * 2 * np.pi / ANGLES
    return float((value @ weight).sum()), float((slope @ weight).sum())
