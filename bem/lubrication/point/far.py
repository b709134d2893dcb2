"""Pressure far away from a point contact, where only the gap of rigid paraboloids counts.

There h = r^2 g/2 with g = cos^2 t + lambda sin^2 t of the direction t, and Reynolds' equation has the solution
p = T(t)/r^3 with (g^3 T')' - 9 g^3 T = 48 (c_x cos t + lambda c_y sin t) and rupture where T would be negative. It is
close to what Kapitza (1955) found to hold for spheres at any distance, p = -(A_x x + A_y y)/h^2; rupture is
further downstream (for a sphere at 108 degrees from the inlet, where tan t = -3 tanh 3t, not at 90). It is taken in
Kapitza's form, p = r s(t)/h^2, to which it tends.

It falls with the third power of the distance, and carries a share of the load with the first: films that end at p = 0
on a rectangle would depend on its size by tenths.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import spsolve

from bem.grid import FloatArray

ANGLES = 2880
"""Directions; 0.1 % of their number in error."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(24)


@lru_cache(maxsize=64)
def far_profile(drag: tuple[float, float], ratio: float) -> FloatArray:
    """s(t) in directions t = 2 pi k / ANGLES."""
    step = 2 * np.pi / ANGLES
    angle = step * np.arange(ANGLES, dtype=np.float64)
    cube = _opening(angle, ratio) ** 3
    between = _opening(angle + 0.5 * step, ratio) ** 3 / step**2
    before = np.roll(between, 1)
    drive = -48 * (drag[0] * np.cos(angle) + ratio * drag[1] * np.sin(angle))
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
    return np.maximum(found, 0.0) * _opening(angle, ratio) ** 2 / 4


def _opening(angle: FloatArray, ratio: float) -> FloatArray:
    return np.cos(angle) ** 2 + ratio * np.sin(angle) ** 2


def far_source(x: FloatArray, y: FloatArray, drag: tuple[float, float], ratio: float) -> FloatArray:
    """Far pressure times film squared, r s(t), at points (nx, ny) of abscissae (nx,) and (ny,)."""
    angle = np.mod(np.arctan2(y[None, :], x[:, None]), 2 * np.pi)
    profile = far_profile(drag, ratio)
    share = np.interp(angle, 2 * np.pi * np.arange(ANGLES + 1) / ANGLES, np.append(profile, profile[0]))
    return np.hypot(x[:, None], y[None, :]) * share


def far_shear(drag: tuple[float, float], ratio: float) -> float:
    """Integral of dx dy/h over directions t with oil, by ln r: 2/g(t) dt. It has no limit with the distance."""
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    full = far_profile(drag, ratio) > 0
    return float((2 / _opening(angle[full], ratio)).sum()) * 2 * np.pi / ANGLES


def far_load(
    rectangle: tuple[float, float, float, float],
    drag: tuple[float, float],
    ratio: float,
    datum: float,
    load: float,
) -> tuple[float, float]:
    """Load of the far pressure outside a rectangle, and its derivative with H0; `load` of elastic bodies lifts the film
    there as one force would, that of rigid ones is zero."""
    x0, x1, y0, y1 = rectangle
    angle = 2 * np.pi / ANGLES * np.arange(ANGLES, dtype=np.float64)
    cos, sin = np.cos(angle), np.sin(angle)
    with np.errstate(divide="ignore"):
        edge = np.minimum(np.where(cos > 0, x1, -x0) / np.abs(cos), np.where(sin > 0, y1, -y0) / np.abs(sin))
    source = far_profile(drag, ratio)
    behind = source > 0
    edge, source, opening = edge[behind], source[behind], _opening(angle[behind], ratio)
    share = 0.5 * (_POINTS + 1)  # edge / r
    r = edge[:, None] / share
    gap = 0.5 * r**2 * opening[:, None]
    film = gap + datum + 2 / np.pi * load / r
    bounded = film > 0.1 * gap
    film = np.where(bounded, film, 0.1 * gap)
    value = source[:, None] * r**2 / film**2 * edge[:, None] / share**2
    weight = 0.5 * _WEIGHTS * 2 * np.pi / ANGLES
    return float((value @ weight).sum()), float((np.where(bounded, -2 * value / film, 0.0) @ weight).sum())
