"""Particles on a plate, from a height map of any microscope (thesis, paper B, section 2.5).

The plate is levelled, what stands out of it is labelled (by watershed where touching particles are to be separated) and
measured. Knows maps, no contact. Verified in tests/particles/test_particle_height_map.py on synthetic maps whose
particles are known, and against scipy's labels.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray
from bem.particles.particle import Particle
from bem.surfaces.filter import trend
from bem.surfaces.surface import check_map

BACKGROUNDS = ("plane", "curvature", "offset", "none")
RECTANGLES = ("axis_aligned", "minimum_area")
BORDERS = ("exclude", "include")


def particles_from_height_map(
    heights: FloatArray,
    spacing: tuple[float, float],
    *,
    threshold: float,
    background: str = "plane",
    level_lines: bool = False,
    separate: float | None = None,
    border: str = "exclude",
    rectangle: str = "axis_aligned",
    smallest_columns: int = 1,
    smallest_radius: float = 0.0,
    connectivity: int = 8,
) -> list[Particle]:
    """Find the particles that stand out of a plate by more than a threshold.

    A particle is a connected region above the threshold. Its volume is counted down to the background, since a
    microscope sees no undercut. Its flanks below the threshold do not count, and flatter particles are not found.

    Parameters
    ----------
    heights, spacing : (nx, ny) [m] and (dx, dy) [m].
    threshold : height above the background [m]; 50 nm in the source.
    background : how the plate is levelled, see `level_background`: "plane", "curvature", "offset" or "none".
    level_lines : also take out an offset for each scan line (each iy), as an AFM needs.
    separate : None: what touches is one particle. A relative prominence s between 0 and 1: two summits are two
        particles where the pass between them is lower than (1 - s) times the lower summit (watershed); 0.3 is a good
        start.
    border : "exclude" leaves out particles that touch the edge of the map, "include" keeps them, marked `truncated`.
    rectangle : length and width from the bounding rectangle along x and y ("axis_aligned"), or from the one of
        smallest area at any angle ("minimum_area"). The source has "the square which encompasses the particle".
    smallest_columns, smallest_radius : smaller ones (in grid columns; in equivalent radius [m]) are left out as noise.
    connectivity : 8 (corners connect) or 4.

    Returns
    -------
    list of Particle, from the first row of the map to the last.

    Raises
    ------
    InputError : heights that are not a finite map, names or values out of range.
    """
    array, cell = check_map(heights, spacing)
    _check(threshold, background, separate, border, rectangle, smallest_columns, smallest_radius, connectivity)
    level = level_background(array, cell, threshold=threshold, method=background, lines=level_lines)
    labels = label_particles(level, threshold, separate, connectivity)
    return _measure(level, labels, cell, border, rectangle, smallest_columns, smallest_radius)


def level_background(
    heights: FloatArray,
    spacing: tuple[float, float],
    *,
    threshold: float,
    method: str = "plane",
    lines: bool = False,
) -> FloatArray:
    """Return the heights above the plate (nx, ny) [m], its plane or second-order surface fitted to points without
    particles.

    Starts from a plane through the medians of rows and columns, then fits repeatedly to the points within half the
    threshold of the median of the remainder until these stay the same. "offset" takes out the median only.

    Raises
    ------
    InputError : heights that are not a finite map, an unknown method.
    """
    array, _ = check_map(heights, spacing)
    if method not in BACKGROUNDS:
        raise InputError(f"background {method!r} is not one of {', '.join(BACKGROUNDS)}")
    level = array.copy()
    if method in ("plane", "curvature"):
        level = level - _median_slope(level)
        plate = np.ones(level.shape, dtype=bool)
        for _ in range(30):
            middle = float(np.median(level[plate]))
            new = np.abs(level - middle) < 0.5 * threshold
            if new.sum() < 0.05 * new.size or np.array_equal(new, plate):
                break
            plate = new
            level = level - trend(np.where(plate, level, np.nan), curved=method == "curvature")
    if method != "none":
        level = level - _plate_median(level, threshold)
    if lines:
        offsets = np.array([_plate_median(level[:, iy], threshold) for iy in range(level.shape[1])])
        level = level - offsets[None, :]
    return level


def _median_slope(heights: FloatArray) -> FloatArray:
    """Return a plane through the medians of columns and rows, on which particles have little effect."""
    surface = np.zeros_like(heights)
    for axis in (0, 1):
        n = heights.shape[axis]
        if n < 3:
            continue
        medians = np.median(heights, axis=1 - axis)
        place = np.arange(n) - 0.5 * (n - 1)
        steps = np.subtract.outer(medians[n - n // 3 :], medians[: n // 3])
        distances = np.subtract.outer(place[n - n // 3 :], place[: n // 3])
        line = float(np.median(steps / distances)) * place
        surface = surface + (line[:, None] if axis == 0 else line[None, :])
    return surface


def _plate_median(heights: FloatArray, threshold: float) -> float:
    """Return the median of the points without particles, those within half a threshold of it."""
    middle = float(np.median(heights))
    for _ in range(30):
        near = heights[np.abs(heights - middle) < 0.5 * threshold]
        if near.size == 0:
            break
        new = float(np.median(near))
        if new == middle:
            break
        middle = new
    return middle


def label_particles(
    level: FloatArray, threshold: float, separate: float | None = None, connectivity: int = 8
) -> NDArray[np.int64]:
    """Number the particles of a levelled map (nx, ny): 0 below the threshold, else 1.. in order of first column."""
    flat = np.ascontiguousarray(level).ravel()
    above = np.flatnonzero(flat > threshold)
    # from the top down; equal heights in order of place, so the same map always gives the same labels
    order = above[np.argsort(-flat[above], kind="stable")]
    prominence = 2.0 if separate is None else separate
    roots = _flood(flat, order, level.shape[0], level.shape[1], prominence, connectivity == 8)
    labels = np.zeros(flat.size, dtype=np.int64)
    if above.size:
        _, first, inverse = np.unique(roots[above], return_index=True, return_inverse=True)
        rank = np.empty(len(first), dtype=np.int64)
        rank[np.argsort(first, kind="stable")] = np.arange(1, len(first) + 1)
        labels[above] = rank[inverse]
    return labels.reshape(level.shape)


@compiled
def _root(parent: NDArray[np.int64], i: int) -> int:
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@compiled
def _flood(
    heights: FloatArray, order: NDArray[np.int64], nx: int, ny: int, prominence: float, corners: bool
) -> NDArray[np.int64]:
    """Watershed from the summits down; return the root of each column. A prominence of 2 merges all that touch."""
    parent = np.full(heights.size, -1, dtype=np.int64)  # the root of a particle is its summit
    for n in range(order.size):
        here = order[n]
        ix, iy = here // ny, here % ny
        # the highest neighbour's particle takes the column
        best = -1
        best_height = -np.inf
        for jx in range(max(ix - 1, 0), min(ix + 2, nx)):
            for jy in range(max(iy - 1, 0), min(iy + 2, ny)):
                there = jx * ny + jy
                if parent[there] < 0 or (not corners and jx != ix and jy != iy):
                    continue
                if heights[there] > best_height:
                    best, best_height = there, heights[there]
        if best < 0:
            parent[here] = here
            continue
        mine = _root(parent, best)
        parent[here] = mine
        for jx in range(max(ix - 1, 0), min(ix + 2, nx)):
            for jy in range(max(iy - 1, 0), min(iy + 2, ny)):
                there = jx * ny + jy
                if parent[there] < 0 or (not corners and jx != ix and jy != iy):
                    continue
                other = _root(parent, there)
                if other == mine:
                    continue
                # heights[here] is the pass between both summits
                if heights[here] >= (1 - prominence) * min(heights[mine], heights[other]):
                    if heights[other] > heights[mine] or (heights[other] == heights[mine] and other < mine):
                        parent[mine] = other
                        mine = other
                    else:
                        parent[other] = mine
    for n in range(order.size):
        parent[order[n]] = _root(parent, order[n])
    return parent


def _measure(
    level: FloatArray,
    labels: NDArray[np.int64],
    spacing: tuple[float, float],
    border: str,
    rectangle: str,
    smallest_columns: int,
    smallest_radius: float,
) -> list[Particle]:
    """Return sizes and positions of the labelled particles that pass the filters."""
    nx, ny = level.shape
    ix, iy = np.nonzero(labels)
    names = labels[ix, iy]
    order = np.argsort(names, kind="stable")
    ix, iy, names = ix[order], iy[order], names[order]
    thickness = level[ix, iy]
    bounds = np.flatnonzero(np.r_[True, names[1:] != names[:-1], True]) if names.size else np.zeros(1, dtype=np.int64)
    particles = []
    for start, stop in pairwise(bounds):
        cx, cy, t = ix[start:stop], iy[start:stop], thickness[start:stop]
        cut = bool(cx.min() == 0 or cy.min() == 0 or cx.max() == nx - 1 or cy.max() == ny - 1)
        if (cut and border == "exclude") or len(t) < smallest_columns:
            continue
        sides = (
            ((int(np.ptp(cx)) + 1) * spacing[0], (int(np.ptp(cy)) + 1) * spacing[1])
            if rectangle == "axis_aligned"
            else minimum_area_rectangle(cx, cy, spacing)
        )
        particle = Particle(
            volume=float(t.sum()) * spacing[0] * spacing[1],
            length=max(sides),
            width=min(sides),
            thickness=float(t.max()),
            columns=np.stack([cx, cy], axis=1),
            column_thickness=t.copy(),
            position=(
                float((cx * t).sum() / t.sum() - 0.5 * (nx - 1)) * spacing[0],
                float((cy * t).sum() / t.sum() - 0.5 * (ny - 1)) * spacing[1],
            ),
            truncated=cut,
        )
        if particle.equivalent_radius >= smallest_radius:
            particles.append(particle)
    return particles


def minimum_area_rectangle(
    ix: NDArray[np.int64], iy: NDArray[np.int64], spacing: tuple[float, float]
) -> tuple[float, float]:
    """Return the sides of the rectangle of smallest area around whole cells, at any angle [m].

    One of its sides lies along one side of the convex hull (Freeman & Shapira, *Commun. ACM* 18 (1975) 409).
    """
    from scipy.spatial import ConvexHull

    corners = np.concatenate([np.stack([ix + a, iy + b], axis=1) for a in (0, 1) for b in (0, 1)]).astype(np.float64)
    points = np.unique(corners, axis=0)  # in cells: a well conditioned hull
    hull = points[ConvexHull(points).vertices] * np.asarray(spacing)
    edges = np.roll(hull, -1, axis=0) - hull
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    along = hull @ edges.T
    across = hull @ np.stack([-edges[:, 1], edges[:, 0]])
    first, second = np.ptp(along, axis=0), np.ptp(across, axis=0)
    best = int(np.argmin(first * second))
    return float(first[best]), float(second[best])


def _check(
    threshold: float,
    background: str,
    separate: float | None,
    border: str,
    rectangle: str,
    smallest_columns: int,
    smallest_radius: float,
    connectivity: int,
) -> None:
    messages = []
    if not (math.isfinite(threshold) and threshold > 0):
        messages.append(f"particles_from_height_map: threshold {threshold!r} must be positive and finite [m]")
    for name, value, allowed in (
        ("background", background, BACKGROUNDS),
        ("border", border, BORDERS),
        ("rectangle", rectangle, RECTANGLES),
        ("connectivity", connectivity, (4, 8)),
    ):
        if value not in allowed:
            choices = ", ".join(str(a) for a in allowed)
            messages.append(f"particles_from_height_map: {name} {value!r} is not one of {choices}")
    if separate is not None and not 0 < separate < 1:
        messages.append(f"particles_from_height_map: separate {separate!r} must lie between 0 and 1, or be None")
    if smallest_columns < 1:
        messages.append(f"particles_from_height_map: smallest_columns {smallest_columns!r} must be at least 1")
    if not (math.isfinite(smallest_radius) and smallest_radius >= 0):
        messages.append(f"particles_from_height_map: smallest_radius {smallest_radius!r} must not be negative [m]")
    if messages:
        raise InputError(messages)
