"""Error bars of a contact: differences to the grid of twice the cell, physical floors, and the residual.

Where an accuracy is asked for, the level before serves as the coarser grid. Differences between two grids do not show
peaks between cells, the curvature that cells lose, first touch between cells, and means over a grid that ends on whole
cells: these are estimated from the finer solution alone and added.

Verified in tests/accuracy/test_contact_bars.py; judged by the experiments that `RULES` names.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import (
    Coarser,
    ContactCase,
    edge_cell,
    edge_fraction,
    mean_opening,
    regime_of,
    surface_is_resolved,
    widest_cell,
)
from bem.accuracy.richardson import Regime, Table, relative, rows
from bem.accuracy.sharp import is_sharp
from bem.contact import ContactSolution
from bem.contact.contact_area import plastic_region
from bem.contact.nested_iteration import sample
from bem.contact.regions import count_spots
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar
from bem.numerics import blocks
from bem.numerics.subcell import around, top

RULES = Table(
    "contact_error_bars small_contact_error_bars",
    rows(
        "contact_area contact_area_fraction mean_contact_pressure",
        (0.33, 0.33, 0.4),
        "Second order once spots are several cells wide; the load is given, so that the pressure follows the area.",
        edge=(0.02, 0.03, 0.05),
    ),
    rows(
        "contact_perimeter",
        (0.5, 0.67, 3.0),
        "The edge has waves as short as the surface has: on an unresolved one it is another curve on each grid.",
        edge=0.02,
    ),
    rows(
        "plastic_area_fraction", 1.0, "First order: it ends on whole cells. The edge is its own.", order=1, edge=0.025
    ),
    rows(
        "max_pressure",
        (0.15, 0.2, 1.3),
        "The peak is interpolated between cells, which is of fourth order where the surface is resolved.",
        edge=(0.004, 0.008, 0.03),
    ),
    rows("load", 0.5, "Second order, at a given approach or mean gap.", edge=(0.005, 0.01)),
    rows("approach", 0.33, "Second order: a mean over the contact.", edge=(0.005, 0.01)),
    rows("mean_gap", 0.5, "Second order: a mean over the grid.", edge=0.002),
)
"""Factors on the difference, and a floor on the figure's fraction within a cell of the contact's edge (edge)."""

_TOUCH = 2.0
"""Factor on the height of a parabola above first touch: rough summits are sharper than parabolas through cells."""
_PEAK, _ROUGH_PEAK = 0.3, 0.7
"""Factors on the rise of the interpolated peak above the highest cell, resolved or not: it is of the peak's next
order."""
_FIRST_ORDER = 1.2
"""Factor on the difference of figures of first order, whose error on the finer grid is the whole difference."""
_STRIP = 0.2
"""Width of the strip by which the area under a pressure that ends on a step is too large, over the cell: balls with 12
to 98 cells over the radius and elastocapillary lengths of 0.1 to 10 radii have 0.13 to 0.15."""
_BENT = 1 / 3
"""Part of the height that cells lose of bent surfaces (`_bend_in_cells`); edges on whole cells give back the rest. 200
contacts 3 to 9 cells wide left 0.34, with a scatter of 0.2 to 0.3 over the place of the centre."""


def figures_of(solution: ContactSolution, area: float) -> dict[str, float]:
    """Return the headline figures of a contact on a grid of that area [m^2], SI units."""
    contact_area = float(solution.contact_area)
    return {
        "contact_area_fraction": contact_area / area,
        "plastic_area_fraction": float(solution.plastic_area) / area,
        "contact_area": contact_area,
        "contact_perimeter": float(solution.contact_perimeter),
        "mean_contact_pressure": float(solution.load) / contact_area if contact_area > 0 else 0.0,
        "max_pressure": float(solution.maximum_pressure),
        "load": float(solution.load),
        "approach": float(solution.approach),
        "mean_gap": mean_opening(solution.gap),
    }


def counted_figures(solution: ContactSolution, grid: Grid) -> dict[str, float]:
    """Return the figures counted over whole cells, for comparison."""
    return {
        "counted_contact_area_fraction": solution.counted_area / grid.area,
        "counted_plastic_area_fraction": solution.counted_plastic_area / grid.area,
        "contact_spots": count_spots(solution.pressure, grid),
        "max_pressure_of_cells": float(solution.pressure.max()),
    }


def contact_bars(case: ContactCase, coarser: Coarser) -> ErrorBars:
    """Return the error bars of the figures of a contact."""
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars.unknown(RULES, coarser.why, prescribed=case.prescribed)
    fine = figures_of(case.solution, case.grid.area)
    coarse = figures_of(coarser.solution, case.grid.area)
    if not all(case.grid.periodic) and not coarser.nested:
        shared = sample(case.solution.gap, coarser.grid.shape, coarser.grid.periodic)
        coarse["mean_gap"] += fine["mean_gap"] - mean_opening(shared)
    regime = regime_of(case)
    edge = relative(edge_fraction(case), fine)
    edge["plastic_area_fraction"] = _plastic_edge_fraction(case) * fine["plastic_area_fraction"]
    grid = RULES.errors(fine, coarse, {"edge": edge}, regime=regime)
    for name, missed in missed_by_differences(case, resolved=regime is Regime.RESOLVED).items():
        grid[name] += missed
    if any(body.material.surface_tension is not None for body in case.operator.bodies):
        _widen_under_tension(grid, case, fine, coarse)
    grid |= dict.fromkeys(case.prescribed, 0.0)
    if case.hardness is not None and case.mean_gap is None:
        grid["mean_gap"] += _overlap_error(case, coarser, regime, grid["approach"])
    if case.load is not None and not case.from_touch:
        # the load displaces the mean: the mean gap misses as much as the approach, not a fraction of itself
        grid["mean_gap"] = max(grid["mean_gap"], grid["approach"])
    sharp = touches_sharply(case)
    if sharp and case.hardness is not None:  # the hardness is the limit on finer cells
        grid["max_pressure"] = max(case.hardness - fine["max_pressure"], 0.0)
    if fine["plastic_area_fraction"] > grid["plastic_area_fraction"]:  # some of the contact is at the hardness
        grid["max_pressure"] = 0.0
    parts = {GRID: grid, RESIDUAL: _residual_errors(case, fine)}
    bars = ErrorBars.together(parts).with_prescribed(case.prescribed)
    return bars.without("max_pressure", NoBar.SHARP_PRESSURE) if sharp and case.hardness is None else bars


def _widen_under_tension(
    grid: dict[str, float], case: ContactCase, fine: Mapping[str, float], coarse: Mapping[str, float]
) -> None:
    """Widen the errors of a contact under surface tension, whose pressure ends on a step at the edge.

    Its area is then of first order, so that the whole difference is left, and too large by a strip along the edge; and
    cells within two of the edge may carry more than those inside.
    """
    cell = widest_cell(case.grid)
    length = max(body.material.elastocapillary_length for body in case.operator.bodies)
    strip = _STRIP * cell * min(1.0, 4 * length / cell) * fine["contact_perimeter"]
    share = strip / fine["contact_area"] if fine["contact_area"] > 0 else 0.0
    for name in ("contact_area", "contact_area_fraction", "mean_contact_pressure", "contact_perimeter"):
        grid[name] = max(grid[name], _FIRST_ORDER * abs(fine[name] - coarse[name]), share * abs(fine[name]))
    inside = case.solution.pressure > 0
    for _ in range(2):
        touching = inside.copy()
        for axis in (0, 1):
            if case.grid.shape[axis] > 1:
                for step in (-1, 1):
                    inside &= np.roll(touching, step, axis)
    highest = float(case.solution.pressure.max(initial=0.0, where=inside))
    grid["max_pressure"] += _FIRST_ORDER * (fine["max_pressure"] - min(highest, fine["max_pressure"]))


def touches_sharply(case: ContactCase) -> bool:
    """Return True if the highest pressure may have no limit: at a sharp edge, ridge or tip."""
    modulus = case.operator.modulus_at(math.pi / math.sqrt(case.grid.cell_area))
    return is_sharp(case.undeformed, case.solution.pressure, case.grid, modulus)


def peak_rise(values: FloatArray, grid: Grid, *, lowest: bool = False) -> float:
    """Return the rise of the paraboloid through the highest cell and its neighbours above that cell; of the lowest cell
    its fall below."""
    sign = -1.0 if lowest else 1.0
    place = np.unravel_index(int(values.argmin() if lowest else values.argmax()), values.shape)
    patch = around(values, grid, (int(place[0]), int(place[1])))
    highest = None if patch is None else top(sign * patch)
    return 0.0 if highest is None else highest - sign * float(values[place])


def _overlap_error(case: ContactCase, coarser: Coarser, regime: Regime, approach: float) -> float:
    """Return the error of the mean gap that the mean overlap at the hardness leaves [m].

    The mean gap is the mean signed gap plus the mean overlap of cells at the hardness, whose differences between grids
    may cancel in their sum. On a free axis these cells also sink by the error of the approach [m].
    """
    assert coarser.solution is not None
    assert coarser.grid is not None
    fine, coarse = case.solution.gap, coarser.solution.gap
    if not coarser.nested:
        fine = sample(fine, coarser.grid.shape, coarser.grid.periodic)
    difference = mean_opening(-coarse) - mean_opening(-fine)
    sunk = 0.0 if all(case.grid.periodic) else case.solution.plastic_area / case.grid.area * approach
    return float(RULES["mean_gap"].error(difference, {}, regime)) + sunk


def _plastic_edge_fraction(case: ContactCase) -> float:
    """Return the fraction of the plastic area within a cell of its edge, which is not that of the contact."""
    solution = case.solution
    if case.hardness is None or not solution.plastic_area > 0:
        return 0.0
    modulus = case.operator.modulus_at(0.5 * math.pi / math.sqrt(case.grid.cell_area))
    region = plastic_region(solution.pressure, solution.gap, case.undeformed, case.hardness, case.grid, modulus)
    cell = edge_cell(solution.pressure, case.grid, above=math.nextafter(case.hardness, 0.0))
    return region.perimeter * cell / solution.plastic_area


def missed_by_differences(case: ContactCase, *, resolved: bool) -> dict[str, float]:
    """Return errors that a difference between grids may miss: peaks between cells, lost curvature, first touch between
    cells, and means over free axes."""
    cap = math.inf if case.hardness is None else case.hardness
    highest = case.solution.maximum_pressure
    peak = (_PEAK if resolved else _ROUGH_PEAK) * abs(highest - float(case.solution.pressure.max()))
    touch = _TOUCH * peak_rise(case.undeformed, case.grid, lowest=True) if case.from_touch else 0.0
    bent, ends = _BENT * _bend_in_cells(case), _mean_error_at_ends(case)
    missed = {"max_pressure": min(peak, cap - highest), "approach": touch + bent, "mean_gap": ends}
    if case.mean_gap is not None:
        missed |= _missed_at_mean_gap(case, ends, bent, touch)
    if case.approach is not None:
        missed |= _missed_at_approach(case, ends, bent, touch)
    return missed


def _missed_at_approach(case: ContactCase, ends: float, bent: float, touch: float) -> dict[str, float]:
    """Return the errors of load, area and mean gap at a given approach that is wrong by `bent` + `touch` [m].

    N spots of width d apart from one another are as stiff as N E* d = E* perimeter / pi.
    """
    perimeter, load = case.solution.contact_perimeter, case.solution.load
    spot = math.pi * case.solution.contact_area / perimeter if perimeter > 0 else math.sqrt(case.grid.cell_area)
    stiffness = case.operator.modulus_at(1 / spot) * perimeter / math.pi
    missed = {"load": stiffness * (touch + bent), "mean_gap": ends + touch + bent}
    if load > 0:  # under rough surfaces areas grow with the load
        grown = min(stiffness * touch / load, 1.0) * case.solution.contact_area
        missed |= {"contact_area": grown, "contact_area_fraction": grown / case.grid.area}
    return missed


def _missed_at_mean_gap(case: ContactCase, ends: float, bent: float, touch: float) -> dict[str, float]:
    """Return the errors of load, pressure, contact and approach at a given mean gap.

    A load P pushes the contact in by u = c P and the mean of the grid by U = C P. An approach greater by t takes a load
    greater by t / c and closes the mean gap by t (1 - C / c). A mean gap wrong by `ends` and cells too soft by `bent`
    [m] thus leave (ends + bent) / (c - C) of the load and (c ends + C bent) / (c - C) of the approach: several times
    `ends` and `bent` where the contact takes up most of the grid. c and C are those of an even pressure on the contact,
    whose u is 8 % more than under a rigid circle (Johnson, Contact Mechanics, section 3.4). First touch moves the
    approach alone.
    """
    solution = case.solution
    inside = solution.pressure > 0
    if not ends + bent > 0 or not inside.any():  # bodies apart are apart by as much as their mean is wrong, too
        return {"approach": touch + ends}
    even = inside.astype(np.float64)
    displaced = case.operator(even)
    pushed, mean = float(displaced[inside].mean()), float(displaced.mean())
    load = (ends + bent) / (pushed - mean) * float(even.sum()) * case.grid.cell_area
    fraction = min(load / solution.load, 1.0) if solution.load > 0 else 0.0
    # contact area and pressure go as P^(2/3) and P^(1/3) under a ball, as P and P^(1/2) under a cylinder
    grown = fraction * solution.contact_area
    return {
        "load": load,
        "approach": touch + (abs(pushed) * ends + abs(mean) * bent) / (pushed - mean),
        "contact_area": grown,
        "contact_area_fraction": grown / case.grid.area,
        "mean_contact_pressure": 0.5 * fraction * solution.load / solution.contact_area,
    }


def _bend_in_cells(case: ContactCase) -> float:
    """Return the mean height that cells lose of a bent surface in the contact [m].

    A pressure constant in cells h wide has waves k weaker by sinc(k h / 2) = 1 - (k h)^2 / 24 on any body. It displaces
    the centres of cells by u + h^2 / 24 u'' instead of u; in the contact u is the approach less the undeformed gap g.
    The approach misses the mean of h^2 g'' / 24, summed over axes: at a given load it is too small. A periodic axis
    loses nothing, and an unresolved surface has no curvature.
    """
    inside = case.solution.pressure > 0
    if not inside.any() or not surface_is_resolved(case.undeformed, case.grid):
        return 0.0
    bend = 0.0
    for axis in (0, 1):
        if case.grid.periodic[axis] or case.grid.shape[axis] < 3:
            continue
        lines, touching = np.moveaxis(case.undeformed, axis, 0), np.moveaxis(inside, axis, 0)[1:-1]
        second = [
            np.diff(lines[first : last + 2], 2, axis=0)[touching[first:last]]
            for first, last in blocks.row_blocks(touching.shape)
        ]
        bend += float(np.concatenate(second).sum()) / 24 / np.count_nonzero(inside)
    return abs(bend)


def _mean_error_at_ends(case: ContactCase) -> float:
    """Return the error of the mean gap as an integral over free axes [m].

    It is that of the midpoint rule (Euler and Maclaurin): h^2 / 24 times the change of slope between the ends.
    """
    error = 0.0
    for axis in (0, 1):
        n, spacing = case.grid.shape[axis], case.grid.spacing[axis]
        if case.grid.periodic[axis] or n < 3:
            continue
        ends = np.moveaxis(np.take(case.solution.gap, (0, 1, -2, -1), axis), axis, 0)
        opened = np.maximum(ends, 0)
        turn = (opened[3] - opened[2] - opened[1] + opened[0]) / spacing
        # slopes are those a cell inside the ends: at the ends they differ by n / (n - 2) of that
        error += abs(float(turn.mean())) * spacing**2 / 24 / ((n - 2) * spacing)
    return error


def _residual_errors(case: ContactCase, fine: Mapping[str, float]) -> dict[str, float]:
    """Return the largest errors that the residual leaves.

    Surfaces that miss contact by a height change approach and gaps by as much, and pressures by that of waves of two
    of the narrower cells of this height, E* q h / 2.
    """
    size = blocks.deviation(case.undeformed) or float(np.abs(case.solution.displacement).max())
    height = case.solution.residual * size
    long = [d for n, d in zip(case.grid.shape, case.grid.spacing, strict=True) if n > 1]
    wavenumber = math.pi / min(long, default=min(case.grid.spacing))
    pressure = 0.5 * case.operator.modulus_at(wavenumber) * wavenumber * height
    mean = fine["mean_contact_pressure"]
    fraction = min(pressure / mean, 1.0) if mean > 0 else 0.0
    lengths = {"approach": height, "mean_gap": 2 * height}
    pressures = {"max_pressure": pressure, "mean_contact_pressure": pressure}
    loads = {"load": (case.solution.residual if case.load is not None else fraction) * fine["load"]}
    known = lengths | pressures | loads
    return {name: known.get(name, fraction * fine[name]) for name in RULES}
