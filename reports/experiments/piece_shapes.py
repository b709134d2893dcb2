"""Length and width of wear pieces by several definitions: steel pair of paper C at 10 and 2.5 N.

    python -m reports.experiments.piece_shapes

A minute. One pair of surfaces of scene `wear-steel-steel`, pieces of the last 50 of 200 cycles, found with 6, 18 and 26
neighbours. Length and width of a piece are, seen from above:

- sides of the rectangle along x and y that holds the piece, the definition of `bem.particles`;
- sides of the turned rectangle of least area;
- greatest and least distance of two parallel lines that hold it (Feret's diameters);
- axes of the ellipse with the same second moments;
- the longest chord, and the width across it.

Outlines are those of whole cells. Means are by number, area and volume, with weights 1, R^2, R^3 of the equivalent
radius R. The result is stored in `reports/results/piece_shapes.json`, which remarks of the validation page read.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from scipy.spatial import ConvexHull

from bem import run_in
from bem.grid import FloatArray
from bem.particles import Particle
from bem.particles.statistics import WEIGHTS
from bem.scenes import PlainContext
from bem.scenes.build import heights_of, modulus_of
from bem.scenes.load import load_scene
from bem.wear import WearModel
from bem.wear.criterion import VonMises
from bem.wear.loads import BodyCycle, BodyWear
from bem.wear.segmentation import describe_pieces
from reports.experiments.kept import keep, rounded

if TYPE_CHECKING:
    from bem.kinds.wear.scene import WearScene

RESULT = Path(__file__).resolve().parents[1] / "results" / "piece_shapes.json"
SCENE = "wear-steel-steel"
LOADS, CONNECTIVITIES = (10.0, 2.5), (6, 18, 26)
SHOWN_WEIGHTS = ("number", "area", "volume")
CORNERS = np.array(list(itertools.product((-0.5, 0.5), repeat=2)))


@dataclass(frozen=True)
class RecordedVonMises(VonMises):
    """The source's criterion; what leaves in each cycle is appended to `seen`."""

    seen: list[BodyWear] = field(default_factory=list, kw_only=True)

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return the yielded pieces."""
        removal = super().detach(cycle)
        self.seen.append(removal)
        return removal


def hull_of(cells: FloatArray) -> FloatArray:
    """Corners (n, 2) of the convex hull of whole cells (m, 2), in cells, counter-clockwise."""
    corners = np.unique((cells[:, None, :] + CORNERS).reshape(-1, 2), axis=0)
    return np.asarray(corners[ConvexHull(corners).vertices])


def spans(hull: FloatArray, angles: FloatArray) -> FloatArray:
    """Distance of the parallel lines that hold a hull (n, 2), across directions at these angles [rad]."""
    along = hull @ np.stack([np.cos(angles), np.sin(angles)])
    return np.asarray(along.max(axis=0) - along.min(axis=0))


def definitions(cells: FloatArray) -> dict[str, tuple[float, float]]:
    """Length and width of a piece of cells (m, 2) in cells, by definition."""
    hull = hull_of(cells)
    edges = np.roll(hull, -1, axis=0) - hull
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    along, across = spans(hull, angles), spans(hull, angles + 0.5 * math.pi)
    least = int(np.argmin(along * across))
    chords = (hull[:, None, :] - hull[None, :, :]).reshape(-1, 2)
    longest = chords[int(np.argmax((chords**2).sum(axis=1)))]
    chord = math.hypot(*longest)
    across_chord = spans(hull, np.array([math.atan2(longest[1], longest[0]) + 0.5 * math.pi]))[0]
    moments = np.linalg.eigvalsh(np.cov(cells.T, bias=True).reshape(2, 2) + np.eye(2) / 12)
    sides = spans(hull, np.array([0.0, 0.5 * math.pi]))
    found = {
        "rectangle along x and y": (sides.max(), sides.min()),
        "turned rectangle": (max(along[least], across[least]), min(along[least], across[least])),
        "Feret's diameters": (chord, across.min()),
        "second moments": (4 * math.sqrt(moments[1]), 4 * math.sqrt(moments[0])),
        "longest chord": (chord, across_chord),
    }
    return {name: (float(length), float(width)) for name, (length, width) in found.items()}


def unwrapped(piece: Particle, rows: int) -> FloatArray:
    """Cells (m, 2) of a piece, in one part where it goes on across the edge along y of so many rows."""
    cells = piece.columns.astype(np.float64)
    used = np.unique(cells[:, 1])
    if used[0] == 0 and used[-1] == rows - 1 and len(used) < rows:
        widest = int(np.argmax(np.diff(used)))
        cells[cells[:, 1] <= used[widest], 1] += rows
    return cells


def pieces_of(load: float, connectivity: int) -> tuple[list[Particle], float, int]:
    """Pieces of the settled cycles at a load [N], the cell [m], and the rows along y."""
    scene = cast("WearScene", load_scene(SCENE))
    cylinder = scene.cylinder.model_copy(update={"loads": [load]})
    grid, share = scene.domain.at(cylinder, modulus_of(scene))
    context = PlainContext(scene_seed=scene.seed)
    lower, upper = (
        heights_of(getattr(scene, body).surface, grid, context.seed(body, 0)) for body in ("lower", "upper")
    )
    criterion = RecordedVonMises(skin_depth=scene.wear.criterion.skin_depth)  # type: ignore[attr-defined]
    run_in(
        lower,
        upper,
        grid=grid,
        bodies=(scene.lower.build(), scene.upper.build()),
        load=share,
        gap=np.broadcast_to(grid.x[:, None] ** 2 / (2 * cylinder.radius), grid.shape),
        depths=scene.depths.build(),
        friction=cylinder.friction,
        cycles=scene.cycles.count,
        model=WearModel(criterion=criterion, connectivity=connectivity, frame=scene.wear.frame, shift=scene.wear.shift),
    )
    late = [describe_pieces(removal.pieces, grid) for removal in criterion.seen[-scene.cycles.settled :]]
    return [piece for cycle in late for piece in cycle], grid.spacing[0], grid.shape[1]


def row(load: float, connectivity: int) -> dict[str, Any]:
    """Mean length, width and thickness [nm] by definition and weight."""
    pieces, cell, rows = pieces_of(load, connectivity)
    known: dict[bytes, dict[str, tuple[float, float]]] = {}
    sides: dict[str, list[tuple[float, float]]] = {}
    for piece in pieces:
        cells = unwrapped(piece, rows)
        cells -= cells.min(axis=0)
        shape = cells.astype(np.int32).tobytes()
        if shape not in known:
            known[shape] = definitions(cells)
        for name, both in known[shape].items():
            sides.setdefault(name, []).append(both)
    radius = np.array([piece.equivalent_radius for piece in pieces])
    thickness = 1e9 * np.array([piece.thickness for piece in pieces])
    found: dict[str, Any] = {}
    for name, both in sides.items():
        values = np.column_stack([1e9 * cell * np.array(both), thickness])
        found[name] = {w: list(np.average(values, axis=0, weights=radius ** WEIGHTS[w])) for w in SHOWN_WEIGHTS}
    counts = {"load_N": load, "connectivity": connectivity, "pieces": len(pieces)}
    return counts | dict(rounded({"sizes_nm": found}))


def main() -> None:
    """Run the loops, print and store."""
    rows = []
    for load, connectivity in itertools.product(LOADS, CONNECTIVITIES):
        rows.append(row(load, connectivity))
        print(rows[-1], flush=True)
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
