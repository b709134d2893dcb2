"""Heights from lists of points: three columns x, y and z, one point a line, in any order, on a regular grid.

Verified in tests/surfaces/test_point_lists.py.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.errors import SurfaceFileError
from bem.grid import FloatArray

_OFF_GRID = 0.05
"""Distance of a coordinate from the regular grid over the step, up to which it counts as rounded."""
_SAME = 1e-6
"""Difference of coordinates over their range, up to which they are one."""
_LONGEST_MAP = 100
"""Rows of three numbers without names up to which they may be a map three points wide."""
_COLUMN = re.compile(
    r"(?<![^\W_])(x|y|z|h|height)(?![^\W_])\s*"
    r"(?:\[\s*([^\]\s]+)\s*\]|\(\s*([^)\s]+)\s*\)|/\s*([^\s,;]+)|_([^\s,;]+))?",
    re.IGNORECASE,
)
"""Name of a column with its unit, as x [um], y (um), z/nm or x_mm."""


@dataclass(frozen=True)
class PointList:
    """Points on a regular grid.

    Attributes
    ----------
    heights : (nx, ny), in the unit of the file; not-a-number where the list has no point.
    steps : between points along x and y, in the unit of the file.
    units : of x, y and z as the header writes them; empty where it says none.
    """

    heights: FloatArray
    steps: tuple[float, float]
    units: tuple[str, str, str]


def column_units(header: Sequence[str]) -> tuple[str, str, str] | None:
    """Return the units of columns named x, y and z (or height) in a line of a header; None if no line names them."""
    for line in header:
        found = _COLUMN.findall(line.replace("\udcb5", "\u00b5"))  # of an older encoding
        if [name.lower()[0] for name, *_ in found] in (["x", "y", "z"], ["x", "y", "h"]):
            units = [next(filter(None, unit), "").replace("\u03bc", "u").replace("\u00b5", "u") for _, *unit in found]
            return units[0], units[1], units[2]
    return None


def list_of_points(table: FloatArray, header: Sequence[str]) -> PointList | None:
    """Return the points of three columns (n, 3) on their grid; None if the columns may be a map three points wide.

    Raises
    ------
    SurfaceFileError : a list whose points do not lie on a regular grid, or that has two heights at a point.
    """
    units = column_units(header)
    axes = [_axis(table[:, k]) for k in (0, 1)]
    regular = all(isinstance(axis, _Axis) and axis.count > 1 for axis in axes)
    if units is None and len(table) <= _LONGEST_MAP and (len(table) < 4 or not regular or not _is_full(axes, table)):
        return None
    for name, axis in zip("xy", axes, strict=True):
        if isinstance(axis, str):
            raise SurfaceFileError(
                f"its points are not on a regular grid: {name} = {axis}; export heights on a regular grid"
            )
    x, y = (axis for axis in axes if isinstance(axis, _Axis))
    if x.count * y.count > max(2 * len(table), 4):
        raise SurfaceFileError(
            f"its {len(table)} points are not on a regular grid: they would leave most of {x.count} x {y.count} places "
            "without a height; export heights on a regular grid"
        )
    heights = np.full((x.count, y.count), np.nan)
    places = x.places * y.count + y.places
    twice = np.flatnonzero(np.bincount(places) > 1)
    if twice.size:
        first = table[places == twice[0]][0]
        raise SurfaceFileError(f"it has two heights at x = {first[0]:g}, y = {first[1]:g}; export each point once")
    heights.ravel()[places] = table[:, 2]
    return PointList(heights, (x.step, y.step), units or ("", "", ""))


@dataclass(frozen=True)
class _Axis:
    """Coordinates on a regular grid: number of places, their step, and the place of each point."""

    count: int
    step: float
    places: np.ndarray


def _axis(values: FloatArray) -> _Axis | str:
    """Return the regular grid of coordinates; a coordinate that is off it, in words, if there is none."""
    if not np.isfinite(values).all():
        return "nan"
    apart = np.unique(values)
    reach = float(apart[-1] - apart[0])
    gaps = np.diff(apart)
    gaps = gaps[gaps > _SAME * reach]
    if not gaps.size:
        return _Axis(1, 0.0, np.zeros(len(values), dtype=np.int64))
    steps = round(reach / float(np.median(gaps)))
    step = reach / steps
    exact = (values - apart[0]) / step
    places = np.rint(exact).astype(np.int64)
    off = np.abs(exact - places)
    if float(off.max()) > _OFF_GRID:
        worst = float(values[int(off.argmax())])
        return f"{worst:g} is not a whole number of steps of {step:.4g} from {apart[0]:g}"
    return _Axis(steps + 1, step, places)


def _is_full(axes: Sequence[_Axis | str], table: FloatArray) -> bool:
    """Return True if the points fill the grid, each place once."""
    x, y = axes
    if isinstance(x, str) or isinstance(y, str) or x.count * y.count != len(table):
        return False
    return len(np.unique(x.places * y.count + y.places)) == len(table)
