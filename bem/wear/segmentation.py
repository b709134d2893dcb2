"""Segmentation of a stack of equivalent stress into the pieces that come off.

1. Find the columns in which anything yields (`yielding_columns`), unless the caller knows them.
2. Refine these columns along depth; the part of a column that yields is a short list of *runs* of fine voxels
   (`find_runs`).
3. Join runs of neighbouring columns that touch, by union-find (`connect`).
4. Let the removal law choose runs that leave, and group them to pieces (`bem.wear.removal`).

Runs give the same pieces as labels of all voxels of the refined stack, at the cost of the yielded columns alone.

Knows a stack of any equivalent stress and its depths. Verified in tests/wear/test_segmentation.py against labels of the
refined stack.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.laws import make_laws
from bem.particles.particle import Particle
from bem.wear.removal import RemovalLaw
from bem.wear.yielded_runs import connect, find_runs, gather_columns, yielding_columns

REFINEMENTS = {"linear": 1, "monotone_cubic": 3}
CONNECTIVITIES = (6, 18, 26)
_NOT_FINITE = "equivalent stress: some values are not finite"


@dataclass(frozen=True, eq=False)
class Segmentation:
    """Pieces that reach the free surface, that is, yield at the first depth of the stack.

    labels : (nx, ny) int32, 0 where nothing leaves, else 1..count.
    thickness : (nx, ny) depth that leaves each column, from the surface down [m]; at least the first depth of the
        stack where a piece leaves by `top_run` or `cap`.
    count : number of pieces.
    reaches_bottom : (count + 1,) True for pieces that leave down to the last depth: their thickness is a lower bound,
        unless that depth is the interface at which pieces of a layer end.
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
    removal: str | RemovalLaw = "cap",
    columns: NDArray[np.int64] | None = None,
    rows: NDArray[np.bool_] | None = None,
) -> Segmentation:
    """Find the connected regions above yield that reach the free surface.

    A region reaches the surface if it yields at the first depth, above which no stress is known.

    Parameters
    ----------
    equivalent_stress : (nz, nx, ny) [Pa] at `depths`.
    depths : (nz,) increasing, >= 0 [m]; the stress above the first depth is taken as that at the first depth.
    yield_stress : [Pa], one value or one per column (nx, ny).
    periodic : True where pieces continue across the edges along x and y.
    refine : fine voxels per depth interval, >= 1.
    refinement : "monotone_cubic" (Fritsch-Butland; never above the values at the depths it lies between, so a depth at
        which nothing yields ends every piece above it) or "linear".
    connectivity : 6 (faces), 18 (faces and edges) or 26 (corners too).
    removal : "cap": a piece takes all material above its yielded part in a column along; two pieces that meet in a
        column leave as one. "top_run": only the part connected to the surface within the column leaves; parts
        joined by yielded material that stays count as one piece. Or a law of `bem.wear.removal`.
    columns : increasing numbers in the flattened map of all columns in which anything yields or is not a number; None
        searches for them.
    rows : (nz, nx) True for rows of the stack that count; others count as zero. Only with `columns`; the first depth
        must count entirely.

    Raises
    ------
    InputError : shapes that do not match, depths not increasing or negative, unknown names.
    """
    stack = np.asarray(equivalent_stress, dtype=np.float64)
    levels = np.asarray(depths, dtype=np.float64)
    _check(stack, levels, refine, refinement, connectivity, looked_at=columns is not None)
    law = make_laws("segment", {"removal": removal}, {})["removal"]
    assert isinstance(law, RemovalLaw)
    nz, nx, ny = stack.shape
    strength = np.broadcast_to(np.asarray(yield_stress, dtype=np.float64), (nx, ny))
    if not (np.isfinite(strength).all() and (strength > 0).all()):
        raise InputError(f"yield_stress {yield_stress!r} must be positive and finite [Pa]")

    flat, limits = stack.reshape(nz, -1), np.ascontiguousarray(strength).ravel()
    at_surface = bool((stack[0] > strength).any())
    candidates = columns
    if candidates is None:
        candidates = yielding_columns(flat, limits) if at_surface else np.empty(0, np.int64)
    counted = np.ones((nz, 1), dtype=np.bool_) if rows is None else np.ascontiguousarray(rows)
    values, cubic = gather_columns(flat, candidates, counted), REFINEMENTS[refinement] == 3
    if columns is not None and not _is_finite(values.ravel()):
        raise InputError(_NOT_FINITE)
    labels = np.zeros((nx, ny), dtype=np.int32)
    thickness = np.zeros((nx, ny))
    if candidates.size == 0 or not at_surface:
        return Segmentation(labels, thickness, 0, np.zeros(1, dtype=np.bool_))

    runs = find_runs(candidates, values, levels, limits[candidates], refine, cubic)
    parent = connect(runs, (nx, ny), (bool(periodic[0]), bool(periodic[1])), connectivity)
    count = law.remove(runs, parent, labels.reshape(-1), thickness.reshape(-1))
    # a column is removed down to the last depth, not only yielded there
    lowest = np.repeat(runs.columns, np.diff(runs.first))[runs.bottom == (nz - 1) * refine]
    lowest = lowest[thickness.reshape(-1)[lowest] >= levels[-1]]
    reaches_bottom = np.zeros(count + 1, dtype=np.bool_)
    reaches_bottom[labels.reshape(-1)[lowest]] = True
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
    removal: str | RemovalLaw = "cap",
    cycle: int = 0,
) -> list[Particle]:
    """Wear particles of one cycle: regions above yield that reach the free surface, with the cap above them.

    Parameters as in `segment`; `von_mises` may be any equivalent stress (nz, nx, ny) [Pa] on `grid`, whose periodic
    axes particles go on across. Thesis, paper C, section 2.4.

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
    """Return sizes and positions of the pieces of a segmentation on a grid."""
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
    """Return the fine depths ((nz - 1) refine + 1,) [m]; every `refine`-th one is a given depth."""
    fine = np.interp(np.arange((len(depths) - 1) * refine + 1) / refine, np.arange(len(depths)), depths)
    fine[::refine] = depths
    return fine


def _check(
    stack: FloatArray, depths: FloatArray, refine: int, refinement: str, connectivity: int, *, looked_at: bool
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
    if not looked_at and not all(_is_finite(plane.ravel()) for plane in stack):
        messages.append(_NOT_FINITE)
    if refine != int(refine) or refine < 1:
        messages.append(f"refine {refine!r} must be an integer >= 1")
    for key, value, allowed in (
        ("refinement", refinement, list(REFINEMENTS)),
        ("connectivity", connectivity, list(CONNECTIVITIES)),
    ):
        if value not in allowed:
            messages.append(f"{key} {value!r} must be one of {allowed}")
    if messages:
        raise InputError(messages)


@compiled
def _is_finite(values):
    bad = 0
    for i in range(values.size):
        bad += values[i] - values[i] != 0.0  # infinity minus itself is not a number either
    return bad == 0


@compiled
def _extents(cells, starts, shape, periodic):
    """Return the first cell and the number of cells along x and y of each piece, (count, 2) each.

    On a periodic axis the rectangle is the shortest around the piece: it begins after the widest run of empty rows.
    """
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
