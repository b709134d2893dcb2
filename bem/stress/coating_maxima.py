"""Highest stresses at the depths of a coating: those of points, with what lies between points and beyond the grid.

Four stresses are not those of points:

1. Tension and von Mises stress at the surface have a cusp at the edge of the contact (`edge_tension`).
2. Tension across an interface may be highest beyond a free edge of the grid (`layer_stresses.with_tension_beyond`).
3. So may the highest principal stress of a layer, where that of the points is on the outermost row of a free axis.
4. On a doubly periodic grid the pressure is a sum of waves. Beside the contact it alternates around zero between the
   centres of cells, and so does zz less than about a cell below: interfaces there seem to be in tension. The mean with
   weights 1, 2, 1 along both axes has no waves of two cells. Less than `_RINGING` cells below the surface a point
   counts with the lower of its zz and this mean. There, on 18 random contacts, the tension of points was two to two
   thousand times that of four times the cells in 14; the lower one was nearer in 14.

Verified in tests/stress/test_coating_maxima.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.edge_tension import EdgeTension, edge_tension
from bem.stress.layer_stresses import (
    DepthMaxima,
    depth_maxima,
    highest_principal,
    principal_beyond,
    with_tension_beyond,
)

_RINGING = 0.6
"""Depth over the cell above which zz of a doubly periodic grid is smoothed."""


@dataclass(frozen=True)
class CoatingMaxima:
    """Highest stresses of depths.

    highest : with those at the edge of the contact and beyond the grid.
    of_points : of points alone.
    smoothed : (nz,) tension across the plane without waves of two cells [Pa]; that of points on grids with a free axis.
    edge : highest stresses at the edge of the contact; minus infinity without a depth at the surface.
    """

    highest: DepthMaxima
    of_points: DepthMaxima
    smoothed: FloatArray
    edge: EdgeTension


def coating_maxima(
    stress: FloatArray,
    von_mises: FloatArray,
    depths: FloatArray,
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    friction: float = 0.0,
) -> CoatingMaxima:
    """Return the highest stresses of the depths that the layers need.

    Parameters
    ----------
    stress : (6, nz, nx, ny), in the order xx, yy, zz, yz, xz, xy [Pa].
    von_mises : (nz, nx, ny) [Pa].
    depths : (nz,) rising [m].
    pressure, grid, body, friction : of the stresses, as `bem.stress.subsurface_stress` takes them.
    """
    points = depth_maxima(stress, von_mises, depths, body)
    smoothed, edge = points.tension, EdgeTension()
    highest = points
    if all(grid.periodic):
        near = points.depths < math.sqrt(grid.cell_area)
        smoothed = np.array(
            [_smoothed_tension(stress[2, k]) if near[k] else points.tension[k] for k in range(len(near))]
        )
        shallow = points.depths < _RINGING * math.sqrt(grid.cell_area)
        highest = replace(highest, tension=np.where(shallow, smoothed, points.tension))
    else:
        highest = with_tension_beyond(highest, pressure, grid, body, friction)
        highest = _with_principal_beyond(highest, stress, pressure, grid, body, friction)
    if points.depths[0] == 0:
        edge = edge_tension(stress[:, 0], pressure, grid, body, friction)
        principal = highest.principal.copy()
        principal[0] = max(principal[0], edge.tension)
        von_mises_stress = highest.von_mises.copy()
        von_mises_stress[0] = max(von_mises_stress[0], edge.von_mises)
        highest = replace(highest, principal=principal, von_mises=von_mises_stress)
    return CoatingMaxima(highest, points, smoothed, edge)


def _smoothed_tension(plane: FloatArray) -> float:
    """Return the highest of the lower of zz (nx, ny) and its mean over neighbours, of periodic axes; at least zero."""
    mean = plane
    for axis in (0, 1):
        if plane.shape[axis] > 1:
            mean = 0.5 * mean + 0.25 * (np.roll(mean, 1, axis) + np.roll(mean, -1, axis))
    return max(float(np.minimum(plane, mean).max()), 0.0)


def _with_principal_beyond(
    maxima: DepthMaxima, stress: FloatArray, pressure: FloatArray, grid: Grid, body: Body, friction: float
) -> DepthMaxima:
    """Return the maxima with the principal stress beyond the grid at each layer's depth of the highest one, if that is
    on an outermost row of a free axis."""
    medium = np.array([body.medium_at(depth) for depth in maxima.depths.tolist()])
    reaching = []
    for number in range(len(body.layers)):
        own = np.flatnonzero(medium == number)
        if own.size:
            k = int(own[np.argmax(maxima.principal[own])])
            if maxima.principal[k] > 0 and _is_highest_at_ends(highest_principal(stress[:, k]), grid):
                reaching.append(k)
    if not reaching:
        return maxima
    principal = maxima.principal.copy()
    beyond = principal_beyond(pressure, grid, body, maxima.depths[reaching], friction)
    principal[reaching] = np.maximum(principal[reaching], beyond)
    return replace(maxima, principal=principal)


def _is_highest_at_ends(plane: FloatArray, grid: Grid) -> bool:
    """Return True if the highest value is on an outermost row of a free axis of several rows."""
    place = np.unravel_index(int(plane.argmax()), plane.shape)
    return any(
        not periodic and n > 1 and int(i) in (0, n - 1)
        for i, n, periodic in zip(place, grid.shape, grid.periodic, strict=True)
    )
