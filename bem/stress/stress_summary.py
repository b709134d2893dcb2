"""Figures of the stress below one contact: maximum von Mises stress, its depth, yielded area and volume.

Every given depth is computed as a whole plane. The maximum is that of a surface through the highest point: a paraboloid
in the plane, then the cubic through the neighbouring depths (`bem.numerics.subcell`). The yielded area has the contour
of the yield stress inside cells, and the yielded volume is its integral over depth.

The maximum falls back to fewer dimensions in three cases:

- within one cell of the surface the stress below constant cell pressures is not smooth: maximum of the points, or, with
  a depth at the surface, the stress at the edge of the contact where that is higher (`edge_tension`);
- at the edge of a free grid, or where the paraboloid has no maximum within a cell: maximum of the points;
- next to an interface of layers, where stresses jump, or next to a depth without such a paraboloid: maximum of the
  plane, at the depth of the points.

The package knows the yield stresses of bodies. Verified in tests/stress/test_stress_summary.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.numerics.subcell import area_above, around, highest_along, top
from bem.stress.edge_tension import EdgeTension, edge_tension
from bem.stress.fields import subsurface_stress, von_mises, von_mises_planes

_DEPTHS_BESIDE = 2
"""Number of depths above and below the depth of the maximum through which the cubic may pass."""
_SUBINTERVALS = 4
"""Subintervals between two depths in the integral of the yielded area."""
_NEARLY_YIELDED = 0.9
"""Intervals with von Mises stress below this fraction of the yield stress at both ends add no yielded volume."""


@dataclass(frozen=True, eq=False)
class StressSummary:
    """Stresses of a body at depths below its surface, and their figures.

    depths : (nz,) [m].
    von_mises : (nz, nx, ny) [Pa].
    stress : (6, nz, nx, ny) [Pa], or None where the components were not requested.
    highest : (nz,) maximum von Mises stress of the points of each depth [Pa].
    yielded_area : (nz,) area above the yield stress of the material at each depth, with a boundary between points
        [m^2]; None where no depth has a yield stress.
    counted_yielded_area : the same area in whole cells (nz,) [m^2].
    max_von_mises, max_von_mises_depth : maximum von Mises stress between points and depths [Pa], and its depth [m].
    yielded_volume : integral of the yielded area from the first to the last depth [m^3]; None where no depth has a
        yield stress.
    edge : highest stresses at the edges of the contact; None without a depth at the surface, and of a body without
        layers and traction, whose von Mises stress is never highest there.
    counted_yielded_volume : integral of the counted area by the trapezoidal rule [m^3].
    """

    depths: FloatArray
    von_mises: FloatArray
    stress: FloatArray | None
    highest: FloatArray
    yielded_area: FloatArray | None
    counted_yielded_area: FloatArray | None
    max_von_mises: float
    max_von_mises_depth: float
    yielded_volume: float | None
    edge: EdgeTension | None = None

    @property
    def highest_at_edge(self) -> bool:
        """True if the maximum von Mises stress is that at the edge of the contact, higher than at all points."""
        return self.edge is not None and self.edge.von_mises >= self.max_von_mises

    @property
    def most_stressed_depth(self) -> float:
        """Depth [m] whose points, or edge of the contact, have the maximum von Mises stress."""
        return float(self.depths[0 if self.highest_at_edge else int(np.argmax(self.highest))])

    @property
    def max_von_mises_of_points(self) -> float:
        """Maximum von Mises stress of all points [Pa]."""
        return float(self.highest.max())

    @property
    def counted_yielded_volume(self) -> float | None:
        """Integral of the counted area by the trapezoidal rule [m^3]."""
        counted = self.counted_yielded_area
        return None if counted is None else float(np.trapezoid(counted, self.depths))


def summarise_stress(
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    traction: FloatArray | None = None,
    components: bool = False,
    out: FloatArray | None = None,
    components_out: FloatArray | None = None,
    after: Callable[[int], None] | None = None,
) -> StressSummary:
    """Compute von Mises stress at depths, on request the six components, and summarise them.

    Parameters
    ----------
    pressure : (nx, ny) on the grid [Pa].
    grid, body : grid of the pressure, and the body below it.
    depths : (nz,) [m], rising.
    friction : coefficient of the traction friction x pressure along +x.
    traction : (2, nx, ny) [Pa], instead of friction x pressure.
    components : True to compute the six components too.
    out : (nz, nx, ny) for von Mises stress; a new array if None.
    components_out : (6, nz, nx, ny) for the components; a new array if None.
    after : called after each plane with the number of computed planes.
    """
    places = np.asarray(depths, dtype=np.float64)
    field = np.empty((len(places), *grid.shape)) if out is None else out
    asked: dict[str, Any] = {"friction": friction, "traction": traction}
    stress = subsurface_stress(pressure, grid, body, places, **asked, out=components_out) if components else None
    limits = yield_stresses(body, places)
    highest, yielded, counted = np.empty((3, len(places)))
    planes: Iterator[FloatArray]
    if stress is None:
        planes = von_mises_planes(pressure, grid, body, places, **asked, out=np.empty(grid.shape))
    else:
        planes = (von_mises(stress[:, i]) for i in range(len(places)))
    for i, plane in enumerate(planes):
        field[i] = plane
        highest[i] = plane.max()
        counted[i] = np.count_nonzero(plane > limits[i]) * grid.cell_area
        yielded[i] = area_above(plane, limits[i], grid) if counted[i] > 0 else 0.0
        if after is not None:
            after(i + 1)
    limited = bool(np.isfinite(limits).any())
    stress_top, depth_top = _highest(field, places, highest, grid, body)
    edge = None
    if places[0] == 0 and (friction != 0 or traction is not None or body.layers):
        surface = subsurface_stress(pressure, grid, body, places[:1], **asked) if stress is None else stress
        edge = edge_tension(surface[:, 0], pressure, grid, body, **asked)
        if edge.von_mises > stress_top:
            stress_top, depth_top = edge.von_mises, 0.0
    return StressSummary(
        depths=places,
        von_mises=field,
        stress=stress,
        highest=highest,
        yielded_area=yielded if limited else None,
        counted_yielded_area=counted if limited else None,
        max_von_mises=stress_top,
        max_von_mises_depth=depth_top,
        yielded_volume=_volume(field, places, yielded, highest, limits, grid, body) if limited else None,
        edge=edge,
    )


def _highest(field: FloatArray, depths: FloatArray, highest: FloatArray, grid: Grid, body: Body) -> tuple[float, float]:
    """Return the maximum von Mises stress between points and depths [Pa], and its depth [m].

    field : (nz, nx, ny) [Pa]. highest : (nz,), maximum of the points of each depth [Pa].
    """
    k = int(np.argmax(highest))
    of_points = float(highest[k]), float(depths[k])
    if depths[k] < math.sqrt(grid.cell_area):
        return of_points
    ix, iy = np.unravel_index(int(np.argmax(field[k])), grid.shape)
    place = int(ix), int(iy)
    in_plane = _top(field[k], grid, place)
    if in_plane is None:
        return of_points
    first = max(k - _DEPTHS_BESIDE, 0)
    near = depths[first : k + _DEPTHS_BESIDE + 1]
    tops = np.array([_top(plane, grid, place) for plane in field[first : k + _DEPTHS_BESIDE + 1]], dtype=np.float64)
    beside = slice(max(k - first - 1, 0), k - first + 2)
    if np.isnan(tops[beside]).any() or _crosses(body, near[beside][0], near[beside][-1]):
        return in_plane, of_points[1]
    return highest_along(near[~np.isnan(tops)], tops[~np.isnan(tops)])


def _crosses(body: Body, above: float, below: float) -> bool:
    """Return True if an interface of layers lies between two depths [m]."""
    return any(above <= interface <= below for interface in body.interfaces)


def _top(plane: FloatArray, grid: Grid, place: tuple[int, int]) -> float | None:
    """Return the maximum of the paraboloid around a cell; None at a free edge, or if it has none within a cell."""
    patch = around(plane, grid, place)
    return None if patch is None else top(patch)


def _volume(
    field: FloatArray,
    depths: FloatArray,
    areas: FloatArray,
    highest: FloatArray,
    limits: FloatArray,
    grid: Grid,
    body: Body,
) -> float:
    """Integrate the yielded area over depth [m^3].

    Trapezoidal rule over four subintervals of each interval. At the inner nodes von Mises stress is interpolated by the
    cubic through up to four depths of the same yield stress, or linearly within one cell of the surface and beside an
    interface. An interval that contains an interface has no subintervals.

    areas : (nz,) yielded area [m^2]. limits : (nz,) yield stress [Pa].
    """
    scratch, volume, cell = np.empty(grid.shape), 0.0, math.sqrt(grid.cell_area)
    for k in range(len(depths) - 1):
        if max(highest[k] / limits[k], highest[k + 1] / limits[k + 1]) < _NEARLY_YIELDED:
            continue
        step, inner = float(depths[k + 1] - depths[k]), 0.0
        parts = 1 if _crosses(body, depths[k], depths[k + 1]) else _SUBINTERVALS
        own = [m for m in range(k - 1, k + 3) if 0 <= m < len(depths) and limits[m] == limits[k]]
        if depths[k] < cell or _crosses(body, depths[own[0]], depths[own[-1]]):
            own = [k, k + 1]
        for part in range(1, parts):
            _blend(field, own, _weights(depths[own], depths[k] + step * part / parts), scratch)
            inner += area_above(scratch, limits[k], grid)
        volume += step / parts * (0.5 * (areas[k] + areas[k + 1]) + inner)
    return volume


def _weights(nodes: FloatArray, place: float) -> FloatArray:
    """Return the Lagrange weights of the values at `nodes` for the value at `place` [m]."""
    return np.array([np.prod([(place - b) / (a - b) for b in nodes if b != a]) for a in nodes])


def _blend(field: FloatArray, own: list[int], weights: FloatArray, out: FloatArray) -> None:
    """Write the weighted sum of the planes `own` of `field` (nz, nx, ny) to `out` (nx, ny)."""
    np.multiply(field[own[0]], weights[0], out=out)
    for m, weight in zip(own[1:], weights[1:], strict=True):
        out += weight * field[m]


def yield_stresses(body: Body, depths: FloatArray) -> FloatArray:
    """Return the yield stress of the material at each depth (nz,) [Pa]; infinite where none is known."""
    here = (body.material_at(depth) for depth in depths.tolist())
    return np.array([np.inf if material.yield_stress is None else material.yield_stress for material in here])
