"""Stresses below one contact, and what is asked of them: the highest von Mises stress, where it is, what yields.

The highest stress lies between points and depths (`bem.numerics.subcell`), and what yields ends between them, unless
the highest stress lies within a cell of the surface, where a pressure that is constant on cells, or ends, leaves no
smooth stress: then it is that of a point. Along the depth nothing is looked for across an interface of layers, where
stresses jump.

A pressure that is bilinear between cells would leave less in the half cell next to the surface, more below it, and as
much at the edge of contact, where errors are largest: cells stay. An eighth of a cell below Hertz' contact of 8 cells
in radius the largest error of the von Mises stress, against Hamilton's, is 4.5 % of the largest pressure with cells and
4.0 % with a bilinear pressure.

Knows `stress.sweeps` and bodies' yield stresses. Verified in tests/stress/test_stress_below.py.
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
from bem.stress.sweeps import subsurface_stress, von_mises, von_mises_planes

_REACH = 2
"""Depths on either side of the highest one that are looked at."""
_PARTS = 4
"""Of an interval between two depths, where what yields is looked for."""
_NEARLY = 0.9
"""Of the yield stress, at either end of an interval: less is not looked into."""


@dataclass(frozen=True, eq=False)
class StressBelow:
    """Stresses of a body at depths below its surface.

    depths : (nz,) [m]. von_mises : (nz, nx, ny) [Pa]. stress : (6, nz, nx, ny) [Pa], or None where not asked for.
    highest : (nz,) highest von Mises stress at the points of each depth [Pa].
    yielded_area, counted_yielded_area : (nz,) [m^2] beyond the yield stress of the material there, and that of whole
        cells; None where no depth has a yield stress.
    max_von_mises, max_von_mises_depth : the highest von Mises stress between points and depths [Pa], and where [m].
    yielded_volume, counted_yielded_volume : beyond the yield stress between the first and the last depth [m^3], and
        that of whole cells by the trapezoidal rule; None where no depth has a yield stress.
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

    @property
    def max_von_mises_of_points(self) -> float:
        """The highest von Mises stress of all points [Pa]."""
        return float(self.highest.max())

    @property
    def counted_yielded_volume(self) -> float | None:
        """As above [m^3]."""
        counted = self.counted_yielded_area
        return None if counted is None else float(np.trapezoid(counted, self.depths))


def stress_below(
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    traction: FloatArray | None = None,
    components: bool = False,
    out: FloatArray | None = None,
    after: Callable[[int], None] | None = None,
) -> StressBelow:
    """Von Mises stress plane by plane, and the six components where asked for; see `subsurface_stress`.

    Parameters
    ----------
    pressure : (nx, ny) on the grid [Pa].
    grid, body : where, and whose stresses.
    depths : (nz,) [m], rising.
    friction : of the traction along +x.
    traction : (2, nx, ny) [Pa] instead.
    components : whether the six are kept.
    out : (nz, nx, ny) for von Mises, made if not given.
    after : called with the number of planes that are done, after each.
    """
    places = np.asarray(depths, dtype=np.float64)
    field = np.empty((len(places), *grid.shape)) if out is None else out
    asked: dict[str, Any] = {"friction": friction, "traction": traction}
    stress = subsurface_stress(pressure, grid, body, places, **asked) if components else None
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
    return StressBelow(
        depths=places,
        von_mises=field,
        stress=stress,
        highest=highest,
        yielded_area=yielded if limited else None,
        counted_yielded_area=counted if limited else None,
        max_von_mises=stress_top,
        max_von_mises_depth=depth_top,
        yielded_volume=_volume(field, places, yielded, highest, limits, grid, body) if limited else None,
    )


def _highest(field: FloatArray, depths: FloatArray, highest: FloatArray, grid: Grid, body: Body) -> tuple[float, float]:
    """The highest von Mises stress between points and depths [Pa], and its depth [m]."""
    k = int(np.argmax(highest))
    raw = float(highest[k]), float(depths[k])
    if depths[k] < math.sqrt(grid.cell_area):
        return raw
    ix, iy = np.unravel_index(int(np.argmax(field[k])), grid.shape)
    place = int(ix), int(iy)
    own = _top(field[k], grid, place)
    if own is None:
        return raw
    first = max(k - _REACH, 0)
    near = depths[first : k + _REACH + 1]
    tops = np.array([_top(plane, grid, place) for plane in field[first : k + _REACH + 1]], dtype=np.float64)
    beside = slice(max(k - first - 1, 0), k - first + 2)
    if np.isnan(tops[beside]).any() or _crosses(body, near[beside][0], near[beside][-1]):
        return own, raw[1]
    return highest_along(near[~np.isnan(tops)], tops[~np.isnan(tops)])


def _crosses(body: Body, above: float, below: float) -> bool:
    return any(above <= interface <= below for interface in body.interfaces)


def _top(plane: FloatArray, grid: Grid, place: tuple[int, int]) -> float | None:
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
    """Integral of the areas that yield over depth [m^3], by the trapezoidal rule over parts of the intervals, in which
    von Mises stress is a cubic of the depth: a line in the first cell's depth, and areas themselves in an interval with
    an interface."""
    scratch, volume, cell = np.empty(grid.shape), 0.0, math.sqrt(grid.cell_area)
    for k in range(len(depths) - 1):
        if max(highest[k] / limits[k], highest[k + 1] / limits[k + 1]) < _NEARLY:
            continue
        step, inner = float(depths[k + 1] - depths[k]), 0.0
        parts = 1 if _crosses(body, depths[k], depths[k + 1]) else _PARTS
        own = [m for m in range(k - 1, k + 3) if 0 <= m < len(depths) and limits[m] == limits[k]]
        if depths[k] < cell or _crosses(body, depths[own[0]], depths[own[-1]]):
            own = [k, k + 1]
        for part in range(1, parts):
            _blend(field, own, _weights(depths[own], depths[k] + step * part / parts), scratch)
            inner += area_above(scratch, limits[k], grid)
        volume += step / parts * (0.5 * (areas[k] + areas[k + 1]) + inner)
    return volume


def _weights(nodes: FloatArray, place: float) -> FloatArray:
    """Lagrange's of values at the nodes for that at a place."""
    return np.array([np.prod([(place - b) / (a - b) for b in nodes if b != a]) for a in nodes])


def _blend(field: FloatArray, own: list[int], weights: FloatArray, out: FloatArray) -> None:
    np.multiply(field[own[0]], weights[0], out=out)
    for m, weight in zip(own[1:], weights[1:], strict=True):
        out += weight * field[m]


def yield_stresses(body: Body, depths: FloatArray) -> FloatArray:
    """The yield stress of the material at each depth [Pa]; infinite where none is known."""
    here = (body.material_at(depth) for depth in depths.tolist())
    return np.array([np.inf if material.yield_stress is None else material.yield_stress for material in here])
