"""Uncoupled asperities: every summit a Hertz sphere of its own radius that does not feel the others.

The usual deterministic model (Greenwood and Williamson's summits without their statistics), here as the baseline that
the coupled contact is compared with.

Which carries more at a given film depends on what the separation is measured from. If both keep the volume of oil,
depths in the half-space are measured from its *deformed* mean plane, which the neighbours of a summit have pushed down:
the coupled contact carries more. If both are given the same separation of the *undeformed* planes, as in the thesis'
paper A, the half-space sinks in as a whole by the mean pressure - by an amount that grows with the size of the patch -
and carries less (`bem.friction.given_separation`). The first is what load sharing does everywhere else, so it is the
default here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray, Grid
from bem.representation import readable


@dataclass(frozen=True)
class Summits:
    """Cells (ix, iy) higher than their eight neighbours, their heights [m] and mean radii of curvature [m]."""

    index: tuple[np.ndarray, np.ndarray]
    height: FloatArray
    radius: FloatArray


@readable
@dataclass(frozen=True)
class AsperityContact:
    """Loads of uncoupled asperities; attributes as far as they exist for them as in `ContactSolution`.

    `pressure` is each summit's load spread over the cells within its contact radius. Laws of boundary friction over
    pressure, frictional heat and the oil on cells in contact take it.
    """

    pressure: FloatArray
    load: float
    contact_area: float
    plastic_area: float
    approach: float
    summit_load: FloatArray
    summit_area: FloatArray


def find_summits(height: FloatArray, grid: Grid) -> Summits:
    """Find the summits of heights (nx, ny); parabolas through the neighbours along x and y give tops and radii.

    Cells on the border of a free axis are left out.
    """
    padded = np.pad(height, 1, mode="wrap")
    for axis, periodic in enumerate(grid.periodic):
        if not periodic:
            edge: list[slice | int] = [slice(None), slice(None)]
            for side in (0, -1):
                edge[axis] = side
                padded[tuple(edge)] = np.inf
    centre = padded[1:-1, 1:-1]
    higher = np.ones(height.shape, dtype=bool)
    for i in range(3):
        for j in range(3):
            if (i, j) != (1, 1):
                other = padded[i : i + height.shape[0], j : j + height.shape[1]]
                # a plateau counts once: its first cell
                higher &= (centre > other) if (i, j) < (1, 1) else (centre >= other)
    ix, iy = np.nonzero(higher)
    dx, dy = grid.spacing
    top = height[ix, iy].copy()
    curvature = np.zeros(len(ix))
    for back, forth, step in (
        (padded[ix, iy + 1], padded[ix + 2, iy + 1], dx),
        (padded[ix + 1, iy], padded[ix + 1, iy + 2], dy),
    ):
        bend = (2 * height[ix, iy] - back - forth) / step**2
        slope = (forth - back) / (2 * step)
        top += np.where(bend > 0, slope**2 / (2 * np.where(bend > 0, bend, 1.0)), 0.0)
        curvature += 0.5 * bend
    kept = curvature > 0
    return Summits((ix[kept], iy[kept]), top[kept], 1 / curvature[kept])


def asperity_loads(
    interference: FloatArray, radius: FloatArray, contact_modulus: float, hardness: float | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return load [N], contact area [m^2] and plastic state of spheres at an `interference` [m] (negative: apart).

    Elastic: Hertz, 4/3 E* sqrt(R) d^(3/2) on pi R d. Once its mean pressure 4 E* sqrt(d/R) / (3 pi) reaches the
    hardness, at d_c, the load is hardness x area on pi R (2 d - d_c): the area at constant volume of the plastic part,
    Chang, Etsion and Bogy (1987); with the mean pressure as the measure load and area are continuous at d_c.
    """
    depth = np.maximum(interference, 0.0)
    load = 4 / 3 * contact_modulus * np.sqrt(radius) * depth**1.5
    area = math.pi * radius * depth
    plastic = np.zeros(len(depth), dtype=bool)
    if hardness is not None:
        critical = radius * (3 * math.pi * hardness / (4 * contact_modulus)) ** 2
        plastic = depth > critical
        area = np.where(plastic, math.pi * radius * (2 * depth - critical), area)
        load = np.where(plastic, hardness * area, load)
    return load, area, plastic


def shift_for_load(
    separation: FloatArray, summits: Summits, load: float, *, contact_modulus: float, hardness: float | None
) -> float:
    """Return the shift [m] of mean planes `separation` [m] apart at each summit, at which these carry `load` [N]."""

    from scipy.optimize import brentq

    def excess(shift: float) -> float:
        depth = summits.height - separation + shift
        return float(asperity_loads(depth, summits.radius, contact_modulus, hardness)[0].sum()) - load

    touch = float((separation - summits.height).min())
    # Hertz on the first summit alone takes at least this much more; plastic ones, and more of them, only carry more
    depth = float((0.75 * load / (contact_modulus * np.sqrt(summits.radius.min()))) ** (2 / 3))
    while excess(touch + depth) < 0:
        depth *= 2
    return float(brentq(excess, touch, touch + depth, xtol=1e-22, rtol=1e-15, maxiter=200))


def uncoupled_contact(
    separation: FloatArray,
    summits: Summits,
    grid: Grid,
    *,
    shift: float,
    contact_modulus: float,
    hardness: float | None,
) -> AsperityContact:
    """Return the contact of uncoupled summits at which the mean planes are `separation` less `shift` apart [m]."""
    ix, iy = summits.index
    depth = summits.height - separation + shift
    load, area, plastic = asperity_loads(depth, summits.radius, contact_modulus, hardness)
    pressure = np.zeros(grid.shape)
    for k in np.flatnonzero(load > 0):
        reach = math.sqrt(area[k] / math.pi)
        span_x, span_y = int(reach / grid.spacing[0]), int(reach / grid.spacing[1])
        i = np.arange(ix[k] - span_x, ix[k] + span_x + 1)
        j = np.arange(iy[k] - span_y, iy[k] + span_y + 1)
        inside = ((i - ix[k])[:, None] * grid.spacing[0]) ** 2 + ((j - iy[k])[None, :] * grid.spacing[1]) ** 2
        rows, columns = np.nonzero(inside <= reach**2)
        cells, on_grid = [i[rows], j[columns]], np.ones(len(rows), dtype=bool)
        for axis, (count, periodic) in enumerate(zip(grid.shape, grid.periodic, strict=True)):
            if periodic:
                cells[axis] = cells[axis] % count
            on_grid &= (cells[axis] >= 0) & (cells[axis] < count)
        rows, columns = cells[0][on_grid], cells[1][on_grid]
        np.add.at(pressure, (rows, columns), load[k] / (len(rows) * grid.cell_area))
    return AsperityContact(
        pressure=pressure,
        load=float(load.sum()),
        contact_area=float(area.sum()),
        plastic_area=float(area[plastic].sum()),
        approach=shift,
        summit_load=load,
        summit_area=area,
    )
