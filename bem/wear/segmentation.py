"""From a stack of equivalent stress to the pieces that come off.

The stack is refined along depth, column by column; the part of a column that yields is a short list of *runs* of fine
voxels; runs of neighbouring columns that touch belong to one piece. Working on runs instead of voxels gives the same
pieces as labelling the refined stack (the tests do just that), at the cost of the yielded columns alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.particles.particle import Particle

REFINEMENTS = {"linear": 1, "monotone_cubic": 3}
REMOVALS = {"cap": 0, "top_run": 1}
CONNECTIVITIES = (6, 18, 26)


@dataclass(frozen=True, eq=False)
class Segmentation:
    """Pieces that reach the free surface.

    labels : (nx, ny) int32, 0 where nothing leaves, else 1..count.
    thickness : (nx, ny) what leaves from each column, measured down from the surface [m].
    count : number of pieces.
    reaches_bottom : (count + 1,) bool, whether a piece yields at the last depth: its thickness is then a lower bound.
    """

    labels: NDArray[np.int32]
    thickness: FloatArray
    count: int
    reaches_bottom: NDArray[np.bool_]


def segment(
    equivalent_stress: FloatArray,
    depths: FloatArray,
    *,
    yield_stress: float | FloatArray,
    periodic: tuple[bool, bool] = (False, False),
    refine: int = 10,
    refinement: str = "monotone_cubic",
    connectivity: int = 6,
    removal: str = "cap",
) -> Segmentation:
    """Find the connected regions above yield that reach the free surface.

    Parameters
    ----------
    equivalent_stress : (nz, nx, ny) [Pa] at `depths`.
    depths : (nz,) increasing, >= 0 [m]; the stress above the first depth is taken as that at the first depth.
    yield_stress : [Pa], one value or one per column (nx, ny).
    periodic : whether pieces go on across the edges along x and y.
    refine : fine voxels per depth interval, >= 1.
    refinement : "monotone_cubic" (Fritsch-Butland; never above the values at the depths it lies between, so a depth at
        which nothing yields ends every piece above it) or "linear".
    connectivity : 6 (faces), 18 (faces and edges) or 26 (corners too).
    removal : "cap": a piece takes with it all that lies above its yielded part in the same column; two pieces that meet
        in a column leave as one. "top_run": only the part connected to the surface within the column leaves.

    Raises
    ------
    InputError : shapes that do not match, depths not increasing or negative, unknown names.
    """
    stack = np.asarray(equivalent_stress, dtype=np.float64)
    levels = np.asarray(depths, dtype=np.float64)
    _check(stack, levels, refine, refinement, connectivity, removal)
    nz, nx, ny = stack.shape
    strength = np.broadcast_to(np.asarray(yield_stress, dtype=np.float64), (nx, ny))
    if not (np.isfinite(strength).all() and (strength > 0).all()):
        raise InputError(f"yield_stress {yield_stress!r} must be positive and finite [Pa]")

    flat, limits = stack.reshape(nz, -1), np.ascontiguousarray(strength).ravel()
    candidates = _yielding_columns(flat, limits) if (stack[0] > strength).any() else np.empty(0, np.int64)
    labels = np.zeros((nx, ny), dtype=np.int32)
    thickness = np.zeros((nx, ny))
    if candidates.size == 0:
        return Segmentation(labels, thickness, 0, np.zeros(1, dtype=np.bool_))

    first, top, bottom, bottom_depth = _runs(
        _columns(flat, candidates), levels, limits[candidates], refine, REFINEMENTS[refinement] == 3
    )
    last_sample = (nz - 1) * refine
    slot = np.full(nx * ny, -1, dtype=np.int64)
    slot[candidates] = np.arange(candidates.size)
    parent = _connect(candidates, slot, first, top, bottom, nx, ny, bool(periodic[0]), bool(periodic[1]), connectivity)
    count = _remove(
        candidates,
        first,
        top,
        bottom,
        bottom_depth,
        parent,
        REMOVALS[removal] == 0,
        labels.reshape(-1),
        thickness.reshape(-1),
    )
    reaches_bottom = np.zeros(count + 1, dtype=np.bool_)
    run_column = np.repeat(candidates, np.diff(first))
    reaches_bottom[labels.reshape(-1)[run_column[bottom == last_sample]]] = True
    reaches_bottom[0] = False
    return Segmentation(labels, thickness, count, reaches_bottom)


def find_particles(
    von_mises: FloatArray,
    depths: FloatArray,
    grid: Grid,
    *,
    yield_stress: float | FloatArray,
    refine: int = 10,
    refinement: str = "monotone_cubic",
    connectivity: int = 6,
    removal: str = "cap",
    cycle: int = 0,
) -> list[Particle]:
    """Wear particles of one cycle: regions above yield that reach the free surface, with the cap above them.

    Parameters as in `segment`; `von_mises` may be any equivalent stress (nz, nx, ny) [Pa] on `grid`, whose periodic
    axes particles go on across. Thesis, paper C, section on particles.

    Returns
    -------
    list of Particle, in the order of their first column.

    Raises
    ------
    InputError : shapes that do not match, depths not increasing or negative, unknown names.
    """
    stack = np.asarray(von_mises)
    if stack.ndim != 3 or stack.shape[1:] != grid.shape:
        raise InputError(
            f"von_mises: shape {stack.shape} must be (number of depths, {grid.shape[0]}, {grid.shape[1]}) on this grid"
        )
    pieces = segment(
        stack,
        depths,
        yield_stress=yield_stress,
        periodic=grid.periodic,
        refine=refine,
        refinement=refinement,
        connectivity=connectivity,
        removal=removal,
    )
    return describe_pieces(pieces, grid, cycle=cycle)


def describe_pieces(pieces: Segmentation, grid: Grid, *, cycle: int = 0) -> list[Particle]:
    """Sizes and places of the pieces of a segmentation on `grid`."""
    if pieces.count == 0:
        return []
    flat = np.flatnonzero(pieces.labels)
    label = pieces.labels.ravel()[flat]
    order = np.argsort(label, kind="stable")
    flat, label = flat[order], label[order]
    starts = np.searchsorted(label, np.arange(1, pieces.count + 2))
    cells = np.stack(np.divmod(flat, grid.shape[1]), axis=1)
    thickness = pieces.thickness.ravel()[flat]
    origin, extent = _extents(cells, starts, np.array(grid.shape), np.array(grid.periodic))
    sides = extent * np.array(grid.spacing)
    total = np.add.reduceat(thickness, starts[:-1])
    deepest = np.maximum.reduceat(thickness, starts[:-1])
    unwrapped = (cells - origin[label - 1]) % np.array(grid.shape) + origin[label - 1]
    weighted = np.add.reduceat(thickness[:, None] * unwrapped, starts[:-1])
    centre = weighted / np.where(total > 0, total, 1.0)[:, None] % np.array(grid.shape)
    position = (centre - 0.5 * (np.array(grid.shape) - 1)) * np.array(grid.spacing)
    particles = []
    for number in range(pieces.count):
        own = slice(starts[number], starts[number + 1])
        particles.append(
            Particle(
                volume=float(total[number] * grid.cell_area),
                length=float(sides[number].max()),
                width=float(sides[number].min()),
                thickness=float(deepest[number]),
                columns=cells[own],
                column_thickness=thickness[own],
                position=(float(position[number, 0]), float(position[number, 1])),
                cycle=cycle,
                truncated=bool(pieces.reaches_bottom[number + 1]),
            )
        )
    return particles


def refine_depths(depths: FloatArray, refine: int) -> FloatArray:
    """The fine depths, shape ((nz-1) refine + 1,) [m]; every `refine`-th one is a given depth."""
    fine = np.interp(np.arange((len(depths) - 1) * refine + 1) / refine, np.arange(len(depths)), depths)
    fine[::refine] = depths
    return fine


def _check(
    stack: FloatArray, depths: FloatArray, refine: int, refinement: str, connectivity: int, removal: str
) -> None:
    messages = []
    if stack.ndim != 3:
        messages.append(f"equivalent stress: expected (depths, nx, ny), got shape {stack.shape}")
    elif depths.shape != (stack.shape[0],):
        messages.append(f"depths: {depths.shape} values for {stack.shape[0]} depths of stress")
    elif len(depths) < 2:
        messages.append("depths: at least two are needed to tell how thick a particle is")
    if depths.ndim == 1 and depths.size and not (depths[0] >= 0 and (np.diff(depths) > 0).all()):
        messages.append("depths: must be >= 0 and increasing [m]")
    if not all(_is_finite(plane.ravel()) for plane in stack):
        messages.append("equivalent stress: some values are not finite")
    if refine != int(refine) or refine < 1:
        messages.append(f"refine {refine!r} must be an integer >= 1")
    for key, value, allowed in (
        ("refinement", refinement, list(REFINEMENTS)),
        ("removal", removal, list(REMOVALS)),
        ("connectivity", connectivity, list(CONNECTIVITIES)),
    ):
        if value not in allowed:
            messages.append(f"{key} {value!r} must be one of {allowed}")
    if messages:
        raise InputError(messages)


@njit(cache=True, error_model="numpy")
def _is_finite(values):  # type: ignore[no-untyped-def]
    bad = 0
    for i in range(values.size):
        bad += values[i] - values[i] != 0.0  # infinity minus itself is not a number either
    return bad == 0


@njit(cache=True, error_model="numpy")
def _yielding_columns(stack, strength):  # type: ignore[no-untyped-def]
    """Columns of (nz, columns) in which any value exceeds its strength."""
    above = np.zeros(strength.size, np.bool_)
    for k in range(stack.shape[0]):
        for column in range(strength.size):
            above[column] |= stack[k, column] > strength[column]
    return np.flatnonzero(above)


@njit(cache=True)
def _columns(stack, candidates):  # type: ignore[no-untyped-def]
    """(candidates, nz): depth runs fastest."""
    out = np.empty((candidates.size, stack.shape[0]))
    for k in range(stack.shape[0]):
        for own in range(candidates.size):
            out[own, k] = stack[k, candidates[own]]
    return out


@njit(cache=True)
def _extents(cells, starts, shape, periodic):  # type: ignore[no-untyped-def]
    """First cell and number of cells along x and y of each piece, (count, 2) each; on a periodic axis the rectangle is
    the shortest that holds the piece, so it begins after the widest run of empty rows."""
    count = starts.size - 1
    origin = np.zeros((count, 2), np.int64)
    extent = np.zeros((count, 2), np.int64)
    for axis in range(2):
        size = shape[axis]
        used = np.zeros(size, np.bool_)
        for piece in range(count):
            low, high = size, -1
            for k in range(starts[piece], starts[piece + 1]):
                cell = cells[k, axis]
                used[cell] = True
                low, high = min(low, cell), max(high, cell)
            origin[piece, axis] = low
            extent[piece, axis] = high - low + 1
            if periodic[axis] and low == 0 and high == size - 1:
                widest, run = 0, 0
                for cell in range(size):
                    run = 0 if used[cell] else run + 1
                    if run > widest:
                        widest = run
                        origin[piece, axis] = cell + 1
                if widest > 0:
                    extent[piece, axis] = size - widest
            for k in range(starts[piece], starts[piece + 1]):
                used[cells[k, axis]] = False
    return origin, extent


@njit(cache=True)
def _slope(values, depths, k):  # type: ignore[no-untyped-def]
    """Fritsch-Butland slope at sample k: harmonic mean inside, one-sided three-point formula, limited, at the ends."""
    n = values.size
    if n == 2:
        return (values[1] - values[0]) / (depths[1] - depths[0])
    if 0 < k < n - 1:
        before, after = depths[k] - depths[k - 1], depths[k + 1] - depths[k]
        rise, fall = (values[k] - values[k - 1]) / before, (values[k + 1] - values[k]) / after
        if rise * fall <= 0.0:
            return 0.0
        first, second = 2 * after + before, after + 2 * before
        return (first + second) / (first / rise + second / fall)
    if k == 0:
        near, far = depths[1] - depths[0], depths[2] - depths[1]
        own, other = (values[1] - values[0]) / near, (values[2] - values[1]) / far
    else:
        near, far = depths[n - 1] - depths[n - 2], depths[n - 2] - depths[n - 3]
        own, other = (values[n - 1] - values[n - 2]) / near, (values[n - 2] - values[n - 3]) / far
    slope = ((2 * near + far) * own - near * other) / (near + far)
    if slope * own <= 0.0:
        return 0.0
    if own * other <= 0.0 and abs(slope) > 3 * abs(own):
        return 3 * own
    return slope


@njit(cache=True)
def _runs(columns, depths, strength, refine, cubic):  # type: ignore[no-untyped-def]
    """Runs of fine samples above yield in each column.

    Returns first (n+1) - where a column's runs begin -, top and bottom sample of each run, and the depth at which the
    stress falls back to yield below it, by linear interpolation between the two fine samples.

    Between two depths the interpolant is monotone: an interval with both ends above or both below yield needs no
    sample, one with an end on either side is sampled from above until the side changes.
    """
    n, nz = columns.shape
    first = np.zeros(n + 1, np.int64)
    capacity = n * 2 + 16
    top = np.empty(capacity, np.int64)
    bottom = np.empty(capacity, np.int64)
    bottom_depth = np.empty(capacity, np.float64)
    used = 0
    for column in range(n):
        values = columns[column]
        limit = strength[column]
        if used + nz > capacity:
            grown = 2 * capacity + nz
            top = np.append(top, np.empty(grown - capacity, np.int64))
            bottom = np.append(bottom, np.empty(grown - capacity, np.int64))
            bottom_depth = np.append(bottom_depth, np.empty(grown - capacity, np.float64))
            capacity = grown
        if values[0] > limit:
            top[used] = 0
        for k in range(nz - 1):
            above, below = values[k] > limit, values[k + 1] > limit
            if above == below:
                continue
            span = depths[k + 1] - depths[k]
            upper = lower = 0.0
            if cubic and refine > 1:
                upper, lower = span * _slope(values, depths, k), span * _slope(values, depths, k + 1)
            previous, previous_depth = values[k], depths[k]
            for step in range(1, refine + 1):
                t = step / refine
                if step == refine:
                    value = values[k + 1]
                elif cubic:
                    value = (
                        (1 + 2 * t) * (1 - t) * (1 - t) * values[k]
                        + t * (1 - t) * (1 - t) * upper
                        + t * t * (3 - 2 * t) * values[k + 1]
                        - t * t * (1 - t) * lower
                    )
                else:
                    value = (1 - t) * values[k] + t * values[k + 1]
                depth = depths[k] + t * span
                if (value > limit) == below:
                    if below:
                        top[used] = k * refine + step
                    else:
                        bottom[used] = k * refine + step - 1
                        bottom_depth[used] = previous_depth + (previous - limit) / (previous - value) * (
                            depth - previous_depth
                        )
                        used += 1
                    break
                previous, previous_depth = value, depth
        if values[nz - 1] > limit:
            bottom[used] = (nz - 1) * refine
            bottom_depth[used] = depths[nz - 1]
            used += 1
        first[column + 1] = used
    return first, top[:used], bottom[:used], bottom_depth[:used]


@njit(cache=True)
def _root(parent, run):  # type: ignore[no-untyped-def]
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@njit(cache=True)
def _join(parent, a, b):  # type: ignore[no-untyped-def]
    a, b = _root(parent, a), _root(parent, b)
    if a < b:
        parent[b] = a
    else:
        parent[a] = b


@njit(cache=True)
def _connect(candidates, slot, first, top, bottom, nx, ny, wrap_x, wrap_y, connectivity):  # type: ignore[no-untyped-def]
    """Union-find over runs that touch; half of the neighbours suffice, the relation being symmetric."""
    parent = np.arange(top.size)
    for own in range(candidates.size):
        i, j = candidates[own] // ny, candidates[own] % ny
        for neighbour in range(4):
            di = 0 if neighbour == 0 else 1
            dj = 1 if neighbour == 0 else neighbour - 2
            diagonal = di != 0 and dj != 0
            if diagonal and connectivity == 6:
                continue
            reach = 0  # how far apart in depth two runs may be and still touch
            if connectivity == 26 or (connectivity == 18 and not diagonal):
                reach = 1
            ii, jj = i + di, j + dj
            if ii >= nx:
                if not wrap_x:
                    continue
                ii -= nx
            if jj < 0 or jj >= ny:
                if not wrap_y:
                    continue
                jj %= ny
            other = slot[ii * ny + jj]
            if other < 0:
                continue
            for a in range(first[own], first[own + 1]):
                for b in range(first[other], first[other + 1]):
                    if top[a] <= bottom[b] + reach and top[b] <= bottom[a] + reach:
                        _join(parent, a, b)
    return parent


@njit(cache=True)
def _remove(candidates, first, top, bottom, bottom_depth, parent, cap, labels, thickness):  # type: ignore[no-untyped-def]
    """Fill labels and thickness in place; returns the number of pieces."""
    reaches_surface = np.zeros(top.size, np.bool_)
    for run in range(top.size):
        if top[run] == 0:
            reaches_surface[_root(parent, run)] = True
    if cap:
        for column in range(candidates.size):  # pieces that share a column leave together
            last = -1
            for run in range(first[column], first[column + 1]):
                if reaches_surface[_root(parent, run)]:
                    if last >= 0:
                        _join(parent, last, run)
                        reaches_surface[_root(parent, run)] = True
                    last = run
    name = np.zeros(top.size, np.int32)
    count = 0
    for column in range(candidates.size):
        for run in range(first[column], first[column + 1]):
            root = _root(parent, run)
            if not reaches_surface[root] or (not cap and top[run] != 0):
                continue
            if name[root] == 0:
                count += 1
                name[root] = count
            labels[candidates[column]] = name[root]
            thickness[candidates[column]] = max(thickness[candidates[column]], bottom_depth[run])
    return count
