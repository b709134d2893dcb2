"""Graded rectangles and blocks: tensor products of geometric progressions, drawn as transfinite blocks in gmsh.

Loads that jump at an edge, thin layers and unbounded bodies ask for cell sizes over ten orders of magnitude. A
geometric progression of ratio g does that with one row of
cells per factor g, whatever the sizes, so a block of 1e6 load widths costs forty rows more than one of a single width.

Refinement by a level n replaces the ratio g by its n-th root and multiplies the numbers of cells by n: meshes of levels
that divide each other are nested.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import Any

CELL_TAGS = {"substrate": 1, "layer": 2, "layer 2": 3, "layer 3": 4, "layer 4": 5}
FACET_TAGS = {"axis": 11, "loaded": 12, "surface": 13, "far": 14, "axis_y": 15, "end": 16, "bottom": 17}


def layer_names(count: int) -> list[str]:
    """Names of the layers of a stack, outermost first."""
    return ["layer", *(f"layer {number}" for number in range(2, count + 1))][:count]


@dataclass(frozen=True)
class Interval:
    """A stretch of one axis, cells growing geometrically away from one of its ends.

    Parameters
    ----------
    start, end : its ends, start < end.
    cells : number of cells.
    ratio : each cell's length over the one before it, from start to end.
    """

    start: float
    end: float
    cells: int
    ratio: float = 1.0

    def nodes(self) -> list[float]:
        """Coordinates of the cell boundaries, cells + 1 of them."""
        length = self.end - self.start
        if self.ratio == 1.0:
            return [self.start + length * i / self.cells for i in range(self.cells + 1)]
        total = self.ratio**self.cells - 1
        return [self.start + length * (self.ratio**i - 1) / total for i in range(self.cells + 1)]


def graded(
    start: float, end: float, first: float, growth: float, level: float, *, fine_at_end: bool = False
) -> Interval:
    """An interval whose cells grow from about `first` by `growth` a cell at level 1; higher levels subdivide it.

    Where the interval is shorter than `first` it gets one cell (times the level). A level that is no whole number gives
    the
    nearest number of cells, on the same progression.
    """
    length = end - start
    if not (length > 0 and first > 0 and growth > 1 and level > 0):
        raise ValueError(f"graded: start {start}, end {end}, first {first}, growth {growth}, level {level}")
    count = max(1, round(math.log1p(length / first * (growth - 1)) / math.log(growth)))
    # the ratio that starts with `first` exactly, by bisection on the sum of the progression; one cell needs none
    ratio = 1.0
    if count > 1:
        low, high = 1e-6, 4 * growth
        for _ in range(100):
            ratio = 0.5 * (low + high)
            total = count if abs(ratio - 1) < 1e-12 else (ratio**count - 1) / (ratio - 1)
            low, high = (ratio, high) if first * total < length else (low, ratio)
    cells = max(1, round(count * level))
    ratio **= count / cells
    if fine_at_end:
        ratio = 1 / ratio
    return Interval(start, end, cells, ratio)


def uniform(start: float, end: float, cells: int) -> Interval:
    """Equal cells."""
    return Interval(start, end, cells)


def _lattice(model: Any, axes: Sequence[Sequence[Interval]]) -> tuple[dict, list[list[float]]]:
    """Points at all block corners; returns their gmsh tags by index and the breakpoints of each axis."""
    breaks = [[axis[0].start, *(interval.end for interval in axis)] for axis in axes]
    tags = {}
    indices: list[tuple[int, ...]] = [()]
    for points in breaks:
        indices = [(*index, i) for index in indices for i in range(len(points))]
    for index in indices:
        place = [breaks[d][i] for d, i in enumerate(index)]
        tags[index] = model.geo.addPoint(*place, *([0.0] * (3 - len(place))))
    return tags, breaks


def _edges(model: Any, axes: Sequence[Sequence[Interval]], corners: dict) -> dict:
    """Transfinite lines between neighbouring block corners; by (direction, index of the lower corner)."""
    lines = {}
    for index in corners:
        for d, axis in enumerate(axes):
            if index[d] < len(axis):
                upper = tuple(i + (k == d) for k, i in enumerate(index))
                line = model.geo.addLine(corners[index], corners[upper])
                interval = axis[index[d]]
                model.geo.mesh.setTransfiniteCurve(line, interval.cells + 1, "Progression", interval.ratio)
                lines[d, index] = line
    return lines


def _face(model: Any, lines: dict, d: int, e: int, index: tuple[int, ...]) -> int:
    """A transfinite, recombined plane block face spanned by directions d < e at a lower corner."""
    right = tuple(i + (k == d) for k, i in enumerate(index))
    top = tuple(i + (k == e) for k, i in enumerate(index))
    loop = model.geo.addCurveLoop([lines[d, index], lines[e, right], -lines[d, top], -lines[e, index]])
    surface = model.geo.addPlaneSurface([loop])
    model.geo.mesh.setTransfiniteSurface(surface)
    model.geo.mesh.setRecombine(2, surface)
    return surface


@dataclass(frozen=True)
class PlaneGrid:
    """A rectangle in (x, z) of graded quadrilaterals; in axisymmetric problems x is the radius.

    Parameters
    ----------
    x, z : the intervals of each axis, joined end to end; z begins at the surface, 0.
    loaded : how many x intervals carry the load, from the first or, with `before`, after that many others.
    layers : how many z intervals belong to each layer, from the surface down.

    Facets: ``axis`` at the least x, ``end`` at the greatest, ``loaded`` and ``surface`` at z = 0, ``bottom`` at the
    greatest z.
    """

    x: tuple[Interval, ...]
    z: tuple[Interval, ...]
    loaded: int = 1
    layers: tuple[int, ...] = ()
    before: int = 0
    dimension: int = field(default=2, init=False)

    def build(self, model: Any) -> None:
        """Draw, tag and mesh in the current gmsh model."""
        axes = (self.x, self.z)
        corners, _ = _lattice(model, axes)
        lines = _edges(model, axes, corners)
        media = [
            name for name, count in zip(layer_names(len(self.layers)), self.layers, strict=True) for _ in range(count)
        ]
        media += ["substrate"] * (len(self.z) - len(media))
        cells: dict[str, list[int]] = {name: [] for name in media}
        for i in range(len(self.x)):
            for k, medium in enumerate(media):
                cells[medium].append(_face(model, lines, 0, 1, (i, k)))
        facets = {
            "axis": [lines[1, (0, k)] for k in range(len(self.z))],
            "end": [lines[1, (len(self.x), k)] for k in range(len(self.z))],
            "loaded": [lines[0, (i, 0)] for i in range(self.before, self.before + self.loaded)],
            "surface": [
                lines[0, (i, 0)] for i in range(len(self.x)) if not self.before <= i < self.before + self.loaded
            ],
            "bottom": [lines[0, (i, len(self.z))] for i in range(len(self.x))],
        }
        _tag_and_mesh(model, 2, cells, facets)


@dataclass(frozen=True)
class BlockGrid:
    """A block in (x, y, z) of graded hexahedra.

    Parameters
    ----------
    x, y, z : the intervals of each axis, joined end to end; z begins at the surface, 0.
    loaded : how many x and y intervals, from the first, carry the load.
    layers : how many z intervals, from the surface, belong to the layer.

    Facets: ``axis`` at the least x, ``axis_y`` at the least y, ``far`` at the greatest x, y and z, ``loaded`` and
    ``surface`` at z = 0.
    """

    x: tuple[Interval, ...]
    y: tuple[Interval, ...]
    z: tuple[Interval, ...]
    loaded: tuple[int, int] = (1, 1)
    layers: int = 0
    dimension: int = field(default=3, init=False)

    def build(self, model: Any) -> None:
        """Draw, tag and mesh in the current gmsh model."""
        axes = (self.x, self.y, self.z)
        corners, _ = _lattice(model, axes)
        lines = _edges(model, axes, corners)
        counts = [len(axis) for axis in axes]
        faces = {}
        for index in corners:
            for d, e in ((0, 1), (0, 2), (1, 2)):
                if index[d] < counts[d] and index[e] < counts[e]:
                    faces[d, e, index] = _face(model, lines, d, e, index)
        cells: dict[str, list[int]] = {"layer": [], "substrate": []}
        for i in range(counts[0]):
            for j in range(counts[1]):
                for k in range(counts[2]):
                    shell = model.geo.addSurfaceLoop(
                        [
                            faces[0, 1, (i, j, k)],
                            faces[0, 1, (i, j, k + 1)],
                            faces[0, 2, (i, j, k)],
                            faces[0, 2, (i, j + 1, k)],
                            faces[1, 2, (i, j, k)],
                            faces[1, 2, (i + 1, j, k)],
                        ]
                    )
                    volume = model.geo.addVolume([shell])
                    model.geo.mesh.setTransfiniteVolume(volume)
                    cells["layer" if k < self.layers else "substrate"].append(volume)
        facets: dict[str, list[int]] = {"axis": [], "axis_y": [], "loaded": [], "surface": [], "far": []}
        for (d, e, index), face in faces.items():
            normal = 3 - d - e
            if index[normal] == counts[normal]:
                facets["far"].append(face)
            elif index[normal] == 0:
                if normal == 2:
                    inside = index[0] < self.loaded[0] and index[1] < self.loaded[1]
                    facets["loaded" if inside else "surface"].append(face)
                else:
                    facets["axis" if normal == 0 else "axis_y"].append(face)
        _tag_and_mesh(model, 3, cells, facets)


def _tag_and_mesh(model: Any, dimension: int, cells: dict[str, list[int]], facets: dict[str, list[int]]) -> None:
    """Physical groups for everything that is there, then the mesh, nodes numbered without gaps."""
    model.geo.synchronize()
    for name, entities in facets.items():
        if entities:
            model.addPhysicalGroup(dimension - 1, entities, FACET_TAGS[name], name)
    for name, entities in cells.items():
        if entities:
            model.addPhysicalGroup(dimension, entities, CELL_TAGS[name], name)
    model.mesh.generate(dimension)
    model.mesh.renumberNodes()


EDGE = 2e-3
"""Size of the cells at a load's edge at level 1, over the smaller of the load's half-width and the layer's
thickness."""

GROWTH, FAR_GROWTH = 1.6, 3.0
"""Ratio of neighbouring cells at level 1: near the load, and beyond."""

REACH, WIDER = 3e3, 8.0
"""Distance of the outer boundary, and the factor from one box to the next in the study of the far field."""


def _outwards(near: float, boxes: int, level: int) -> list[Interval]:
    """From `near` to the outer boundary, and `boxes` further intervals beyond it that leave the inner mesh as it is."""
    reach = REACH * max(1.0, near / 4)
    intervals = [graded(near, reach, 0.5 * near * (FAR_GROWTH - 1), FAR_GROWTH, level)]
    for _ in range(boxes):
        intervals.append(graded(reach, WIDER * reach, 0.5 * reach * (FAR_GROWTH - 1), FAR_GROWTH, level))
        reach *= WIDER
    return intervals


def half_space_grid(*, thickness: Sequence[float] | float | None, level: int, boxes: int = 0) -> PlaneGrid:
    """Half of a half-plane, or the meridian of a half-space, loaded on 0 <= x <= 1.

    Parameters
    ----------
    thickness : of each layer, outermost first, over the load's half-width or radius; None for a homogeneous body.
    level : subdivision, 1, 2, 3, ...
    boxes : how many times the box is made wider by WIDER, the mesh inside staying the same.
    """
    stack = _stack(thickness)
    edge = EDGE * min(1.0, *stack, 1.0)
    near = max(4.0, 2 * sum(stack))
    beyond = _outwards(near, boxes, level)
    x = [graded(0.0, 1.0, edge, GROWTH, level, fine_at_end=True), graded(1.0, near, edge, GROWTH, level), *beyond]
    levels = [0.0, *accumulate(stack), near]
    z = [
        # below the first layer cells as large as progress from the surface would have made them
        graded(top, bottom, top * (GROWTH - 1) if top else edge, GROWTH, level)
        for top, bottom in pairwise(levels)
    ]
    return PlaneGrid(tuple(x), (*z, *beyond), loaded=1, layers=(1,) * len(stack))


def _stack(thickness: Sequence[float] | float | None) -> tuple[float, ...]:
    if thickness is None:
        return ()
    return tuple(thickness) if isinstance(thickness, Sequence) else (thickness,)


def harmonic_grid(*, thickness: Sequence[float] | float | None, level: int) -> PlaneGrid:
    """Half a wavelength of a layered body under a harmonic load: 0 <= x <= 1/2 in wavelengths, four wavelengths deep.

    The load is smooth: equal cells along x; downwards the cells grow from the surface, or from either side of the
    layer.
    A field that decays like exp(-2 pi z) has fallen to 1e-11 at the bottom.
    """
    deep = 4.0
    x = (uniform(0.0, 0.5, 4 * level),)
    stack = _stack(thickness)
    if not stack:
        return PlaneGrid(x, (graded(0.0, deep, 0.08, 1.4, level),), loaded=1)
    bottom = sum(stack)
    z: list[Interval] = []
    counts = []
    for top, below in pairwise((0.0, *accumulate(stack))):
        if below - top <= 0.16:
            intervals = [uniform(top, below, 2 * level)]
        else:
            middle, first = 0.5 * (top + below), min(0.08, 0.5 * (below - top))
            intervals = [
                graded(top, middle, first, 1.4, level),
                graded(middle, below, first, 1.4, level, fine_at_end=True),
            ]
        z += intervals
        counts.append(len(intervals))
    deep += min(bottom, 4.0)
    z.append(graded(bottom, max(deep, bottom + 1.0), min(0.08, 2 * stack[-1]), 1.4, level))
    return PlaneGrid(x, tuple(z), loaded=1, layers=tuple(counts))


def moving_band_grid(*, peclet: float, level: int) -> PlaneGrid:
    """The plane under a band -1 <= x <= 1 over which a body moves along +x; lengths in half-widths of the band.

    Upstream the temperature falls like exp(-2 peclet distance), in depth like exp(-peclet z^2 / (2 x)): the box ends
    where both are below 1e-15. Cells are small at both edges of the band and at the surface, over the width 1 / peclet
    in which heat is conducted against the motion.
    """
    # thinner cells are still solved on, but points on them are no longer found
    edge = max(5 * EDGE / max(1.0, peclet), 2e-4)
    # the end of the wake is far off: what its condition disturbs dies out over a few of the large cells there
    ahead, wake = max(1.0, 20 / peclet), 100 + 20 / peclet
    deep = max(12 * math.sqrt((1 + wake) / peclet), 40 / peclet)
    x = (
        graded(-1 - ahead, -1.0, edge, GROWTH, level, fine_at_end=True),
        graded(-1.0, 0.0, edge, GROWTH, level),
        graded(0.0, 1.0, edge, GROWTH, level, fine_at_end=True),
        graded(1.0, 5.0, edge, GROWTH, level),
        graded(5.0, wake, 4 * (GROWTH - 1), GROWTH, level),
    )
    z = (
        graded(0.0, 0.5, edge, GROWTH, level),
        graded(0.5, 5.0, 0.5 * (GROWTH - 1), GROWTH, level),
        graded(5.0, 5.0 + deep, 5 * (GROWTH - 1), GROWTH, level),
    )
    return PlaneGrid(x, z, loaded=2, before=1)


def progression(start: float, end: float, cells: int, spread: float, *, fine_at_end: bool = False) -> Interval:
    """An interval of `cells` cells whose ratio is spread^(1/cells):

    nested for numbers of cells that divide each other.
    """
    ratio = spread ** (1 / cells)
    return Interval(start, end, cells, 1 / ratio if fine_at_end else ratio)


BLOCK_REACH = 30.0


def rectangle_grid(
    *, half_length: float, half_width: float, level: int, thickness: float | None = None, boxes: int = 0
) -> BlockGrid:
    """A quarter of a block under a loaded rectangle: |x| <= half_length, |y| <= half_width.

    Few cells, meant for elements of degree four: one a level and direction over the load, two beyond it, two in
    depth, and one in a layer as thin as the half-width, where all meshes must differ: two that do not agree on what
    neither resolves. In a thicker layer the cells grow with depth, two a level: equal ones are too tall beside the load
    (u_y was 2 % off at half-width 0.375 and thickness 2.86). The box reaches BLOCK_REACH, and by WIDER further for each
    of `boxes`, the mesh inside staying the same.
    """
    beyond = []
    reach = BLOCK_REACH
    for _ in range(boxes):
        beyond.append(progression(reach, WIDER * reach, level, 8.0))
        reach *= WIDER

    def across(half: float) -> tuple[Interval, ...]:
        inside = progression(0.0, half, level, 4.0, fine_at_end=True)
        return (inside, progression(half, BLOCK_REACH, 2 * level, 200.0), *beyond)

    if thickness is None:
        depth = (progression(0.0, BLOCK_REACH, 2 * level, 200.0), *beyond)
        return BlockGrid(across(half_length), across(half_width), depth)
    below = progression(thickness, BLOCK_REACH, 3 * level // 2, 200.0)
    layer = uniform(0.0, thickness, level)
    if thickness > half_width:
        layer = progression(0.0, thickness, 2 * level, thickness / half_width)
    return BlockGrid(across(half_length), across(half_width), (layer, below, *beyond), layers=1)
