"""Highest stresses at the surface, at the edge of the contact: between the centres of cells.

Towards the edge the pressure falls like p = K sqrt(d), with d the distance inside. Inside, the stress along the surface
is a local part, proportional to the pressure of the point, plus a part that is smooth up to the edge. Under pressure
the smooth part continues outside with the same slope; under the traction friction x p it falls outside like
-2 friction K sqrt(d). The tension therefore has a cusp at the edge, and its maximum over the centres of cells is low by
a term in sqrt(h): of a ball of eight cells to the radius, rubbed with friction of 0.4, by 28 %. The smooth part at the
edge leaves 1 %.

At each cell at an edge, on the link of centres from it (1) out to its neighbour without pressure (0) and in to the
next cell (2):

1. The edge lies a fraction s of the link outside cell 1. Of a straight edge p1 = (a + b s) K sqrt(h) and
   p2 = (c + d s) K sqrt(h), so that the ratio gives s.
2. Stress under pressure: the smooth part of cell 1, S - p1 L, and the stress at cell 0, which has no local part,
   interpolated to the edge. L is the response to the shortest wave of the grid: with n along the normal of the edge and
   t along the edge, -1 in nn and -2 nu in tt under a body without layers.
3. Stress under friction: smooth part at cells 1 and 2, extrapolated to the edge. A pressure that is constant on cells
   (or is a sum of waves) leaves an error at both, which is linear in p1 and p2, since all are linear in s; the error is
   subtracted. Traction along the normal has twice the nn of the nt under traction along the edge.
4. The highest principal stress and the von Mises stress of the sum. Beside the contact the surface carries no traction.

Under a given traction q in place of friction x p, the ratio q / p of cell 1 is the friction there. Edges at which that
of cell 2 is another one stick, and are left out.

The constants are those of a cylinder (cells) and of a wave (waves) with 60 cells to half the contact's width, on twenty
places of the edge between cells: p1 and p2 are linear in s to 1e-3, the error in p1 and p2 to 1e-4 of K sqrt(h).

Sources: pressure and traction at an edge, Johnson, *Contact Mechanics* (1985), sections 5.1, 7.1 and 2.5 (surface
stress 2 friction x p0 at the trailing edge of a cylinder). Verified in tests/stress/test_edge_tension.py against the
closed forms of cylinder and ball.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.kernels.layered import frequency_response
from bem.kernels.loads import Load
from bem.materials import Body
from bem.stress.fields import subsurface_stress


@dataclass(frozen=True)
class _EdgeLaw:
    """Pressures and errors next to a straight edge, over K sqrt(h).

    first, second : (value at s = 0, slope in s) of the pressure of the cells 1 and 2.
    first_error, second_error : (factor on p1, factor on p2) of the error of the stress nn under traction at 1 and 2.
    """

    first: tuple[float, float]
    second: tuple[float, float]
    first_error: tuple[float, float]
    second_error: tuple[float, float]


_CELLS = _EdgeLaw((0.1667, 0.9515), (1.0215, 0.3993), (1.2531, -1.0152), (0.1029, -0.1882))
_WAVES = _EdgeLaw((0.1810, 0.9537), (1.0282, 0.3929), (1.2647, -0.7173), (-0.4968, 0.2519))
"""Of pressures constant on cells, and of waves (`bem.kernels.spectral`)."""
_FARTHEST_IN, _FARTHEST_OUT = -0.2, 1.2
"""Positions of the edge, in links from cell 1, between which the law of a straight edge holds."""
_LEAST_SLOPE = 1e-3
"""Slope of the ratio of pressures in s, over K sqrt(h), below which the edge is at its farthest position."""
_ALONG_NORMAL = 0.7
"""Least cosine between link and normal of the edge: one of two axes has it."""


_SLIPPING = 0.1
"""Difference of traction over pressure between cells 1 and 2, over that of cell 1, up to which an edge slips."""
_UNKNOWN = (math.nan, math.nan)


@dataclass(frozen=True)
class EdgeTension:
    """Highest stresses at the edges of the contact.

    tension : highest principal stress [Pa]; minus infinity where no edge is resolved.
    pressure : of the second cell inside the edge with the highest tension, about K sqrt(h) [Pa].
    von_mises, von_mises_pressure : highest von Mises stress, and the pressure as above [Pa].
    place, von_mises_place : x and y of the highest tension and von Mises stress [m]; not a number without an edge.
    """

    tension: float = -math.inf
    pressure: float = 0.0
    von_mises: float = -math.inf
    von_mises_pressure: float = 0.0
    place: tuple[float, float] = _UNKNOWN
    von_mises_place: tuple[float, float] = _UNKNOWN


@dataclass(frozen=True)
class _Local:
    """Local response at the surface to the wave of two cells, over that of a body without layers where it is a factor.

    along, across : nn and tt under pressure; -1 and -2 nu without layers.
    pulled, pulled_across : nn and tt under traction along the normal; 2 and 2 nu without layers.
    sheared : nt under traction along the edge; 1 without layers.
    """

    along: float
    across: float
    pulled: float
    pulled_across: float
    sheared: float

    @classmethod
    def of(cls, body: Body, spacing: float) -> _Local:
        """Return the response on cells of a width [m]."""
        wave, none = np.array([math.pi / spacing]), np.zeros(1)
        pressed = frequency_response.stress_response(wave, none, body, 0.0, Load.NORMAL)
        pulled = frequency_response.stress_response(wave, none, body, 0.0, Load.TANGENTIAL)
        sheared = frequency_response.stress_response(none, wave, body, 0.0, Load.TANGENTIAL)
        return cls(*(float(one[0]) for one in (pressed[0], pressed[1], pulled[0], pulled[1], sheared[5])))


def edge_tension(
    surface: FloatArray,
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    friction: float = 0.0,
    traction: FloatArray | None = None,
) -> EdgeTension:
    """Return the highest stresses at the edges of the contact, of edges with two cells of rising pressure inside.

    Parameters
    ----------
    surface : (6, nx, ny), stress at the surface [Pa].
    pressure, grid, body, friction, traction : of the stress, as `bem.stress.subsurface_stress` takes them.
    """
    pressed = surface
    if traction is None and friction != 0:
        traction = np.array([friction * pressure, np.zeros_like(pressure)])
    if traction is not None:
        pressed = subsurface_stress(pressure, grid, body, [0.0])[:, 0]
    stresses = pressed[_IN_PLANE], (surface - pressed)[_IN_PLANE]
    padded = pressure
    for axis, periodic in enumerate(grid.periodic):
        width = [(_MARGIN, _MARGIN) if one == axis else (0, 0) for one in (0, 1)]
        padded = np.pad(padded, width, mode="wrap" if periodic else "constant")
    found = [
        _at_edges(_edge_links(padded, grid, axis, outwards), stresses, grid, body, traction)
        for axis in (0, 1)
        for outwards in (-1, 1)
    ]
    highest, von_mises = max(found, key=lambda one: one.tension), max(found, key=lambda one: one.von_mises)
    return replace(
        highest,
        von_mises=von_mises.von_mises,
        von_mises_pressure=von_mises.von_mises_pressure,
        von_mises_place=von_mises.von_mises_place,
    )


_IN_PLANE = [0, 1, 5]
"""Components xx, yy, xy among the six."""
_MARGIN = 3
"""Cells around a padded pressure."""


@dataclass(frozen=True)
class _EdgeLinks:
    """Links of centres along an axis that cross edges, m of them.

    axis, outwards : 0 or 1, and the direction out of the contact along it: -1 or 1.
    beyond, first, second : (2, m) indices of the cells 0, 1 and 2.
    pressures : (3, m) of cells 1 and 2, and of the next one inside [Pa].
    normal : (2, m) unit vectors into the contact.
    """

    axis: int
    outwards: int
    beyond: NDArray[np.intp]
    first: NDArray[np.intp]
    second: NDArray[np.intp]
    pressures: FloatArray
    normal: FloatArray


def _edge_links(padded: FloatArray, grid: Grid, axis: int, outwards: int) -> _EdgeLinks:
    """Return the links along an axis that cross edges outwards in one direction.

    padded : pressure with `_MARGIN` cells around.
    """
    step = np.zeros((2, 1), dtype=np.intp)
    step[axis] = outwards
    middle = padded[_MARGIN:-_MARGIN, _MARGIN:-_MARGIN]
    cells = np.array(np.nonzero(middle > 0))
    if not grid.periodic[axis]:  # beyond a free edge of the grid no stress is known
        cells = cells[:, cells[axis] != (grid.shape[axis] - 1 if outwards > 0 else 0)]

    def pressures_at(offset: NDArray[np.intp]) -> FloatArray:
        values: FloatArray = padded[tuple(cells + _MARGIN + offset)]
        return values

    first, second, third = (pressures_at(-number * step) for number in range(3))
    # equal pressures are at the hardness, where they follow no root
    crossed = (pressures_at(step) == 0) & (second > first) & (third != second)
    cells = cells[:, crossed]
    gradient = np.zeros((2, cells.shape[1]))
    for along in (-1, 1):
        for across, weight in ((-1, 0.25), (0, 0.5), (1, 0.25)):
            gradient[0] += along * weight * pressures_at(np.array([[along], [across]])) / (2 * grid.spacing[0])
            gradient[1] += along * weight * pressures_at(np.array([[across], [along]])) / (2 * grid.spacing[1])
    length = np.hypot(*gradient)
    normal = np.divide(gradient, length, out=np.zeros_like(gradient), where=length > 0)
    facing = -outwards * normal[axis] >= _ALONG_NORMAL
    cells, normal = cells[:, facing], normal[:, facing]
    pressures = np.array([pressures_at(-number * step) for number in range(3)])
    shape = np.array(grid.shape)[:, None]
    return _EdgeLinks(axis, outwards, (cells + step) % shape, cells, (cells - step) % shape, pressures, normal)


def _at_edges(
    links: _EdgeLinks,
    stresses: tuple[FloatArray, FloatArray],
    grid: Grid,
    body: Body,
    traction: FloatArray | None,
) -> EdgeTension:
    """Return the highest stresses at the edges that links cross.

    stresses : (3, nx, ny) xx, yy, xy at the surface under pressure, and under the traction [Pa].
    traction : (2, nx, ny) [Pa]; None without one.
    """
    if not links.first.size:
        return EdgeTension()
    pressed, rubbed = stresses
    law = _WAVES if all(grid.periodic) else _CELLS
    local = _Local.of(body, grid.spacing[links.axis])
    first, second, third = links.pressures
    position = _edge_position(first / second, law)
    inside = _at(pressed, links.first) - first * _tensor(links.normal, local.along, local.across, 0.0)
    share = np.clip(position, 0.0, 1.0)
    total = (1 - share) * inside + share * _at(pressed, links.beyond)
    slips = np.full(first.shape, True)
    if traction is not None:
        (qx, qy), other = _at(traction, links.first) / first, _at(traction, links.second) / second
        slips = np.hypot(qx - other[0], qy - other[1]) <= _SLIPPING * np.hypot(qx, qy)
        nx, ny = links.normal
        along, across = 0.5 * (qx * nx + qy * ny), 0.5 * (qy * nx - qx * ny)
        pulled = _tensor(links.normal, along * local.pulled, along * local.pulled_across, across * local.sheared)
        near, far = (
            _at(rubbed, cells) - (error[0] * first + error[1] * second) * pulled
            for cells, error in ((links.first, law.first_error), (links.second, law.second_error))
        )
        total += near + np.where(third > second, position, 0.0) * (near - far)
    if not slips.any():
        return EdgeTension()
    xx, yy, xy = total
    tension = np.where(slips, 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy), -np.inf)
    von_mises = np.where(slips, np.sqrt(xx * xx - xx * yy + yy * yy + 3 * xy * xy), -np.inf)
    best, highest = int(np.argmax(tension)), int(np.argmax(von_mises))

    def place_of(k: int) -> tuple[float, float]:
        place = [float(grid.x[links.first[0, k]]), float(grid.y[links.first[1, k]])]
        place[links.axis] += float(position[k]) * links.outwards * grid.spacing[links.axis]
        return place[0], place[1]

    return EdgeTension(
        float(tension[best]),
        float(second[best]),
        float(von_mises[highest]),
        float(second[highest]),
        place_of(best),
        place_of(highest),
    )


def _at(field: FloatArray, cells: NDArray[np.intp]) -> FloatArray:
    """Return a field (n, nx, ny) at cells (2, m)."""
    values: FloatArray = field[:, cells[0], cells[1]]
    return values


def _edge_position(ratio: FloatArray, law: _EdgeLaw) -> FloatArray:
    """Return the positions of edges outside the last cell [links] from the pressures of that cell over the next."""
    (at_first, first), (at_second, second) = law.first, law.second
    position = (ratio * at_second - at_first) / np.maximum(first - ratio * second, _LEAST_SLOPE)
    return np.asarray(np.clip(position, _FARTHEST_IN, _FARTHEST_OUT))


def _tensor(normal: FloatArray, nn: FloatArray | float, tt: FloatArray | float, nt: FloatArray | float) -> FloatArray:
    """Return xx, yy, xy (3, m) of tensors given along the normal n and the tangent t = (-n_y, n_x)."""
    x, y = normal
    return np.array(
        [
            nn * x * x + tt * y * y - 2 * nt * x * y,
            nn * y * y + tt * x * x + 2 * nt * x * y,
            (nn - tt) * x * y + nt * (x * x - y * y),
        ]
    )
