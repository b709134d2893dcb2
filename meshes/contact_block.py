"""A quarter-plane block under a contact patch: fine there, geometrically graded to a boundary very far away.

Two to four transfinite rectangles of quadrilaterals: x (or r) from 0 to `patch` uniform, from there to `reach` in
geometric progression; z from the surface down through the layer, if any, and on to `depth`, in geometric progression.
Each level halves every cell of the level before (twice the cells, the square root of the ratio), so that successive
meshes are nested but for round-off and errors fall in clean orders. With `reach == patch` the block is one column:
half a period of a periodic row.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

Segment = tuple[float, int, float]
"""(end, cells, ratio of successive cells)."""


@dataclass(frozen=True)
class ContactBlock:
    """Parameters of the block; all lengths in the problem's own length.

    patch : extent of the uniform part of the surface, where contact may be.
    cells : number of cells over the patch at level 0.
    reach : distance to the far side; equal to `patch` for half a period.
    depth : distance to the bottom.
    layer : thickness of the layer, None for a homogeneous body.
    growth : ratio of successive cells away from the patch at level 0.
    layer_cells : least number of cells through the layer at level 0.
    level : how often all cells are halved.
    """

    patch: float
    cells: int
    reach: float
    depth: float
    layer: float | None = None
    growth: float = 1.5
    layer_cells: int = 3
    level: int = 0

    dimension: ClassVar[int] = 2
    cell_tags: ClassVar[dict[str, int]] = {"layer": 1, "substrate": 2}
    facet_tags: ClassVar[dict[str, int]] = {"axis": 11, "loaded": 12, "surface": 13, "side": 14, "bottom": 15}

    def segments(self) -> tuple[list[Segment], list[Segment]]:
        """Segments along the surface and along the depth, at this level."""
        size = self.patch / self.cells
        across: list[Segment] = [(self.patch, self.cells, 1.0)]
        if self.reach > self.patch:
            across.append((self.reach, *progression(self.reach - self.patch, size, self.growth)))
        down: list[Segment] = []
        start = 0.0
        if self.layer is not None:
            first = min(size, self.layer / self.layer_cells)
            number, ratio = progression(self.layer, first, self.growth)
            if number < self.layer_cells:
                number, ratio = self.layer_cells, 1.0
            down.append((self.layer, number, ratio))
            start = self.layer
            size = self.layer * ratio ** (number - 1) * _first_share(number, ratio)
        down.append((self.depth, *progression(self.depth - start, size, self.growth)))
        scale = 2**self.level
        across, down = ([(end, n * scale, q ** (1 / scale)) for end, n, q in part] for part in (across, down))
        return across, down

    def lines(self) -> tuple[list[float], list[float]]:
        """Coordinates of the mesh lines across and down, which the evaluation of stresses needs."""
        both = []
        for segments in self.segments():
            lines, start = [0.0], 0.0
            for end, number, ratio in segments:
                step = (end - start) * _first_share(number, ratio)
                for i in range(number - 1):
                    lines.append(lines[-1] + step * ratio**i)
                lines.append(end)
                start = end
            both.append(lines)
        return both[0], both[1]

    def build(self, model: Any) -> None:
        """Draw, tag and mesh in the current gmsh model."""
        across, down = self.segments()
        xs = [0.0] + [end for end, _, _ in across]
        zs = [0.0] + [end for end, _, _ in down]
        geo = model.geo
        points = [[geo.addPoint(x, z, 0) for z in zs] for x in xs]
        along = [[geo.addLine(points[i][j], points[i + 1][j]) for j in range(len(zs))] for i in range(len(across))]
        sinking = [[geo.addLine(points[i][j], points[i][j + 1]) for j in range(len(down))] for i in range(len(xs))]
        faces = {}
        for i in range(len(across)):
            for j in range(len(down)):
                loop = geo.addCurveLoop([along[i][j], sinking[i + 1][j], -along[i][j + 1], -sinking[i][j]])
                faces[i, j] = geo.addPlaneSurface([loop])
        geo.synchronize()
        for i, (_, number, ratio) in enumerate(across):
            for line in along[i]:
                model.mesh.setTransfiniteCurve(line, number + 1, "Progression", ratio)
        for column in sinking:
            for line, (_, number, ratio) in zip(column, down, strict=True):
                model.mesh.setTransfiniteCurve(line, number + 1, "Progression", ratio)
        for face in faces.values():
            model.mesh.setTransfiniteSurface(face)
            model.mesh.setRecombine(2, face)
        coat = 1 if self.layer is not None else 0
        for name, chosen in (("layer", range(coat)), ("substrate", range(coat, len(down)))):
            group = [faces[i, j] for i in range(len(across)) for j in chosen]
            if group:
                model.addPhysicalGroup(2, group, self.cell_tags[name])
        edges = {
            "axis": sinking[0],
            "loaded": [along[0][0]],
            "surface": [lines[0] for lines in along[1:]],
            "side": sinking[-1],
            "bottom": [lines[-1] for lines in along],
        }
        for name, group in edges.items():
            if group:
                model.addPhysicalGroup(1, group, self.facet_tags[name])
        model.mesh.generate(2)


def _first_share(number: int, ratio: float) -> float:
    """First cell over the whole length of a geometric progression."""
    return 1 / number if ratio == 1 else (ratio - 1) / (ratio**number - 1)


def progression(length: float, first: float, growth: float) -> tuple[int, float]:
    """Number of cells and exact ratio that fill `length`.

    Beginning with cells of about `first`, growing by `growth`.
    """
    if length <= first:
        return 1, 1.0
    number = max(1, math.ceil(math.log1p(length / first * (growth - 1)) / math.log(growth)))
    low, high = 1.0, growth**2
    for _ in range(200):
        middle = (low + high) / 2
        total = number if middle == 1 else math.expm1(number * math.log(middle)) / (middle - 1)
        low, high = (middle, high) if total * first < length else (low, middle)
    return number, (low + high) / 2
