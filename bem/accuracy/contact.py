"""Error bars of a contact: the same bodies on a grid of twice the cell, and what the residual may hide.

The coarser grid takes every second height, the same surface where it is band-limited, and begins from the finer
pressure. On a free axis its cells are centred on every second of the finer ones, so that it ends elsewhere by half a
cell: means over the grid are compared over the same points. Where an accuracy is refined to, the level before serves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars, Rule
from bem.accuracy.sharp import is_sharp
from bem.contact import ContactSolution, solve_contact
from bem.contact.certificate import free_edges_reached
from bem.contact.contact_area import plastic_region
from bem.contact.nested_iteration import sample
from bem.contact.regions import count_spots
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, Status
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar
from bem.numerics import blocks
from bem.numerics.subcell import around, top

_AREA = Rule(0.33, 0.4, edge=0.02, rough_edge=0.05, sampled=0.33, sampled_edge=0.03)
RULES: dict[str, Rule] = {
    "contact_area": _AREA,
    "contact_area_fraction": _AREA,
    "contact_perimeter": Rule(0.5, 3.0, edge=0.02, rough_edge=0.02, sampled=0.67, sampled_edge=0.02),
    "plastic_area_fraction": Rule(1.0, 1.3, edge=0.02, rough_edge=0.05, sampled=0.67, sampled_edge=0.03),
    "mean_contact_pressure": _AREA,
    "max_pressure": Rule(0.15, 1.3, edge=0.004, rough_edge=0.03, sampled=0.2, sampled_edge=0.008),
    "load": Rule(0.5, 0.5, edge=0.005, rough_edge=0.01, sampled=0.5, sampled_edge=0.005),
    "approach": Rule(0.33, 0.33, edge=0.005, rough_edge=0.01, sampled=0.33, sampled_edge=0.005),
    "mean_gap": Rule(0.5, 0.5, edge=0.002, rough_edge=0.003, sampled=0.67, sampled_edge=0.002),
}
"""Figures of a contact that have bars; set by `reports/experiments/contact_error_bars.py` with seeds that it does not
store."""

_TOLERANCE = 1e-6
"""Of the coarser solution: far below the differences between the two grids."""
_RESOLVED = 0.7
"""Surfaces whose curvature changes from cell to cell by less than this share of itself (rms) are resolved by a grid of
twice the cell: 2 sin(pi / n) of waves of n cells, about 9 cells to a wave, 5 on the coarser grid."""
_SAMPLED = 1.1
"""Surfaces whose curvature changes by less than this share of itself have waves of four cells and more: of 340 that
were drawn it was at most 1.03 with such waves, and from 1.17 on where there were shorter ones."""
SPOT = 6.0
"""Fewest cells across the mean spot (4 area / perimeter) for contact areas to be of second order."""
_TOUCH = 2.0
"""Factor on the height by which a parabola rises above first touch."""
_PEAK, _ROUGH_PEAK = 0.3, 0.7
"""Factors on what lies between the highest pressure and that of a cell, on a surface that is resolved or not."""
_BENT = 1 / 3
"""Of what bent surfaces lose in cells (`_bend_in_cells`): the rest the edge gives back, which ends on whole cells. Left
were 0.34 (scatter over the place of the centre 0.2 to 0.3) in 200 contacts 3 to 9 cells wide: balls, ellipses, lines,
coated, cells up to three times as long as wide."""

_FEWEST_ACROSS = 3
"""Cells. Under a ball on fewer the highest pressure was 5 to 99 % low, with bars from a thousandth of the error on: the
grid of twice the cell has the same one or four cells in contact. On three and four bars are near the error."""


@dataclass(frozen=True)
class ContactCase:
    """A contact that was solved: operator, undeformed gap (nx, ny) [m], solution, and what was prescribed.

    from_touch : the undeformed gap is zero at first touch, which another grid finds elsewhere.
    """

    operator: DisplacementOperator
    undeformed: FloatArray
    solution: ContactSolution
    load: float | None = None
    approach: float | None = None
    mean_gap: float | None = None
    hardness: float | None = None
    from_touch: bool = False

    @property
    def grid(self) -> Grid:
        """Where."""
        return self.operator.grid


@dataclass(frozen=True)
class Coarser:
    """The same contact on the grid of twice the cell, or why there is none.

    nested : each of its cells is four of the finer grid, over the same rectangle.
    """

    grid: Grid | None
    solution: ContactSolution | None
    why: NoBar = NoBar.COARSER_UNSOLVED
    nested: bool = False


def coarser_before(case: ContactCase, solution: ContactSolution) -> Coarser | None:
    """The contact as it was solved before each cell was cut in four; None where that was another, or cannot serve."""
    (nx, ny), (dx, dy) = case.grid.shape, case.grid.spacing
    halved = solution.pressure.shape == (nx / 2, ny / 2) and solution.status is Status.CONVERGED
    periodic = case.grid.periodic
    if not halved or any(free_edges_reached(periodic, each.pressure) for each in (solution, case.solution)):
        return None
    grid = Grid((nx // 2, ny // 2), (2 * dx, 2 * dy), periodic=case.grid.periodic)
    return Coarser(grid, solution, nested=True)


def _is_narrow(case: ContactCase) -> bool:
    """Return True if all that touches is one or two cells wide along an axis that it does not fill."""
    touching = case.solution.pressure > 0
    widths = [int(np.count_nonzero(touching.any(axis=1 - axis))) for axis in (0, 1)]
    return any(0 < width < min(_FEWEST_ACROSS, n) for width, n in zip(widths, case.grid.shape, strict=True))


def solve_coarser(case: ContactCase, max_iterations: int = 2000) -> Coarser:
    """Solve the case on the grid of twice the cell, from its own pressure."""
    if free_edges_reached(case.grid.periodic, case.solution.pressure):
        return Coarser(None, None, NoBar.FREE_EDGE)
    if _is_narrow(case):
        return Coarser(None, None, NoBar.FEW_CELLS_WIDE)
    operator = case.operator.coarsened()
    if operator is None:
        return Coarser(None, None, NoBar.TOO_SMALL)
    grid = operator.grid
    gap = sample(case.undeformed, grid.shape, grid.periodic)
    if case.from_touch:
        gap = gap - gap.min()
    mean_gap = case.mean_gap
    if mean_gap is not None and not all(grid.periodic):
        mean_gap = mean_opening(sample(case.solution.gap, grid.shape, grid.periodic))
    start: FloatArray | None = np.clip(sample(case.solution.pressure, grid.shape, grid.periodic), 0.0, case.hardness)
    for _ in range(2):  # once more from coarser grids where that start leads nowhere
        try:
            solution = solve_contact(
                gap,
                operator,
                load=case.load,
                approach=case.approach,
                mean_gap=mean_gap,
                hardness=case.hardness,
                tolerance=_TOLERANCE,
                initial_pressure=start,
                max_iterations=max_iterations,
            )
        except InfeasibleError:  # an approach in full contact, a mean gap that other cells do not have
            return Coarser(None, None, NoBar.IMPOSSIBLE)
        if solution.status is Status.CONVERGED:
            return Coarser(grid, solution)
        start = None
    return Coarser(None, None, NoBar.COARSER_UNSOLVED)


def figures_of(solution: ContactSolution, area: float) -> dict[str, float]:
    """Headline figures of a contact on a grid of that area [m^2], SI units."""
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
    """What whole cells have, to compare with."""
    return {
        "counted_contact_area_fraction": solution.counted_area / grid.area,
        "counted_plastic_area_fraction": solution.counted_plastic_area / grid.area,
        "contact_spots": count_spots(solution.pressure, grid),
        "max_pressure_of_cells": float(solution.pressure.max()),
    }


def contact_bars(case: ContactCase, coarser: Coarser) -> ErrorBars:
    """Bars of the figures of a contact."""
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars.unknown(RULES, coarser.why)
    fine = figures_of(case.solution, case.grid.area)
    coarse = figures_of(coarser.solution, case.grid.area)
    if not all(case.grid.periodic) and not coarser.nested:
        shared = sample(case.solution.gap, coarser.grid.shape, coarser.grid.periodic)
        coarse["mean_gap"] += fine["mean_gap"] - mean_opening(shared)
    resolved, sampled = is_resolved(case), _is_smooth(case.undeformed, case.grid, _SAMPLED)
    further = _further(case, resolved=resolved)
    edge, edges = share_at_edge(case), {"plastic_area_fraction": _share_at_plastic_edge(case)}
    algebraic = _algebraic(case, fine)
    # what is prescribed has no error but the residual's
    given = {n for n in ("approach", "mean_gap", "load") if getattr(case, n) is not None}
    known = {"resolved": resolved, "sampled": sampled}
    grid = {
        name: rule.bar(fine[name] - coarse[name], edges.get(name, edge) * fine[name], **known) + further.get(name, 0.0)
        for name, rule in RULES.items()
        if name not in given
    }
    if case.hardness is not None and "mean_gap" in grid:
        grid["mean_gap"] += _overlap_bar(case, coarser, known, grid.get("approach", 0.0))
    if case.load is not None and not case.from_touch:
        # a load displaces the mean by so much: the mean gap misses what the approach does, not a share of itself
        grid["mean_gap"] = max(grid["mean_gap"], grid["approach"])
    sharp = touches_sharply(case)
    if sharp and case.hardness is not None:  # the cap is the limit, which finer cells would come to
        grid["max_pressure"] = max(case.hardness - fine["max_pressure"], 0.0)
    if fine["plastic_area_fraction"] > grid["plastic_area_fraction"]:  # some of it is at the hardness, beyond doubt
        grid["max_pressure"] = 0.0
    bars = ErrorBars.together({GRID: grid | dict.fromkeys(given, 0.0), RESIDUAL: algebraic})
    return bars.without("max_pressure", NoBar.SHARP_PRESSURE) if sharp and case.hardness is None else bars


def _overlap_bar(case: ContactCase, coarser: Coarser, known: Mapping[str, bool], approach: float) -> float:
    """Part of the mean gap's bar that the mean overlap at the hardness leaves [m].

    The mean gap is the mean signed gap plus the mean overlap of cells at the hardness, whose differences between grids
    may cancel in their sum. On a free axis these cells also sink by what the approach [m] is off.
    """
    assert coarser.solution is not None
    assert coarser.grid is not None
    fine, coarse = case.solution.gap, coarser.solution.gap
    if not coarser.nested:
        fine = sample(fine, coarser.grid.shape, coarser.grid.periodic)
    difference = mean_opening(-coarse) - mean_opening(-fine)
    sunk = 0.0 if all(case.grid.periodic) else case.solution.plastic_area / case.grid.area * approach
    return RULES["mean_gap"].bar(difference, 0.0, **known) + sunk


def is_resolved(case: ContactCase) -> bool:
    """Return True if figures converge with their order from the grid of twice the cell on: surface and spots are
    resolved."""
    solution = case.solution
    across = 4 * solution.contact_area / solution.contact_perimeter if solution.contact_perimeter > 0 else math.inf
    return surface_is_resolved(case.undeformed, case.grid) and across > SPOT * math.sqrt(case.grid.cell_area)


def surface_is_resolved(gap: FloatArray, grid: Grid) -> bool:
    """Return True if a grid of twice the cell resolves the surface: its curvature changes little from cell to cell."""
    return _is_smooth(gap, grid, _RESOLVED)


def _is_smooth(gap: FloatArray, grid: Grid, share: float) -> bool:
    """Return True if a surface's curvature changes from cell to cell by no more than this share of itself (rms)."""
    turns, bends = 0.0, 0.0
    for axis in (0, 1):
        n = grid.shape[axis]
        if n < 4:
            continue
        lines, square, across = np.moveaxis(gap, axis, 0), grid.spacing[axis] ** 2, gap.size // n
        for first, last in blocks.row_blocks(lines.shape):
            second = np.diff(lines[first : last + 3], 2, axis=0) / square  # one more than those of the block
            third = np.diff(second, axis=0)
            bends += float(np.sum(second[: last - first] ** 2)) / ((n - 2) * across)
            turns += float(np.sum(third[: last - first] ** 2)) / ((n - 3) * across)
    return turns <= share**2 * bends


def touches_sharply(case: ContactCase) -> bool:
    """Return True if the highest pressure may have no limit: at a sharp edge, ridge or tip."""
    modulus = case.operator.modulus_at(math.pi / math.sqrt(case.grid.cell_area))
    return is_sharp(case.undeformed, case.solution.pressure, case.grid, modulus)


def mean_opening(gap: FloatArray) -> float:
    """Mean of the positive part of a gap."""
    return blocks.mean(gap, lambda block: np.maximum(block, 0))


def share_at_edge(case: ContactCase) -> float:
    """Share of the contact area within a cell of its edge."""
    solution = case.solution
    if not solution.contact_area > 0:
        return 0.0
    return solution.contact_perimeter * math.sqrt(case.grid.cell_area) / solution.contact_area


def _share_at_plastic_edge(case: ContactCase) -> float:
    """The same of what is at the hardness, whose edge is not that of the contact."""
    solution, cell = case.solution, math.sqrt(case.grid.cell_area)
    if case.hardness is None or not solution.plastic_area > 0:
        return 0.0
    modulus = case.operator.modulus_at(0.5 * math.pi / cell)
    region = plastic_region(solution.pressure, solution.gap, case.undeformed, case.hardness, case.grid, modulus)
    return region.perimeter * cell / solution.plastic_area


def _further(case: ContactCase, *, resolved: bool) -> dict[str, float]:
    """What a difference between grids may miss: peaks between cells, and the rule for means on free axes."""
    cap = math.inf if case.hardness is None else case.hardness
    highest = case.solution.maximum_pressure
    peak = (_PEAK if resolved else _ROUGH_PEAK) * abs(highest - float(case.solution.pressure.max()))
    touch = _TOUCH * _rise_below(case.undeformed, case.grid) if case.from_touch else 0.0
    # N spots of width d that know nothing of one another are as stiff as N E* d, which is E* perimeter / pi
    perimeter = case.solution.contact_perimeter
    spot = math.pi * case.solution.contact_area / perimeter if perimeter > 0 else math.sqrt(case.grid.cell_area)
    stiffness = case.operator.modulus_at(1 / spot) * perimeter / math.pi
    bent = _BENT * _bend_in_cells(case)
    missed = touch + bent
    found = {"max_pressure": min(peak, cap - highest), "approach": missed, "mean_gap": _ends(case)}
    if case.mean_gap is not None:
        found |= _at_mean_gap(case, found["mean_gap"], bent, touch)
    if case.approach is not None:
        found |= {"load": stiffness * missed, "mean_gap": found["mean_gap"] + missed}
        if case.solution.load > 0:  # under rough surfaces areas grow with the load
            grown = min(stiffness * touch / case.solution.load, 1.0) * case.solution.contact_area
            found |= {"contact_area": grown, "contact_area_fraction": grown / case.grid.area}
    return found


def _bend_in_cells(case: ContactCase) -> float:
    """By how much a surface that is bent in the contact lies further off for cells than for bodies [m].

    A pressure that is constant in cells h wide has waves k weaker by sinc(k h / 2) = 1 - (k h)^2 / 24, on any body, so
    that it displaces their centres by u + h^2 / 24 u'' where it was to displace them by u; in the contact u is the
    approach less the undeformed gap g, and a mean of h^2 g'' / 24, by axes, is what the approach misses: at a given
    load it is too small. Cells across a difference that passes zero do not show it. On a periodic axis waves are what
    they are; where a surface is not resolved it has no curvature.
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


def rise(field: FloatArray, grid: Grid) -> float:
    """By how much a paraboloid through the highest value and its neighbours rises above it."""
    place = np.unravel_index(int(np.argmax(field)), field.shape)
    patch = around(field, grid, (int(place[0]), int(place[1])))
    found = None if patch is None else top(patch)
    return 0.0 if found is None else found - float(field[place])


def _rise_below(field: FloatArray, grid: Grid) -> float:
    """The same of the lowest value, and below it."""
    row, column = (int(i) for i in np.unravel_index(int(np.argmin(field)), field.shape))
    patch = around(field, grid, (row, column))
    found = None if patch is None else top(-patch)
    return 0.0 if found is None else found + float(field[row, column])


def _ends(case: ContactCase) -> float:
    """Error of the mean over cells as an integral [m]: the midpoint rule's (Euler and Maclaurin), h^2 / 24 times the
    change of slope between the ends of a free axis."""
    error = 0.0
    for axis in (0, 1):
        n, spacing = case.grid.shape[axis], case.grid.spacing[axis]
        if case.grid.periodic[axis] or n < 3:
            continue
        ends = np.moveaxis(np.take(case.solution.gap, (0, 1, -2, -1), axis), axis, 0)
        opened = np.maximum(ends, 0)
        turn = (opened[3] - opened[2] - opened[1] + opened[0]) / spacing
        # slopes are known a cell inside the ends: that they go on turning is n / (n - 2) of their change
        error += abs(float(turn.mean())) * spacing**2 / 24 / ((n - 2) * spacing)
    return error


def _at_mean_gap(case: ContactCase, ends: float, bent: float, touch: float) -> dict[str, float]:
    """What load, pressure, contact and approach miss at a given mean gap, [m] of `_ends` and `_bend_in_cells` known.

    Where a load P pushes the contact in by u = c P and the whole grid by U = C P in the mean, an approach greater by t
    takes a load greater by t / c and closes the mean gap by t (1 - C / c). A mean that is wrong by `ends`, and cells
    that are too soft by `bent`, thus leave (ends + bent) / (c - C) of the load, and (c ends + C bent) / (c - C) of the
    approach: several times as much where contact takes up most of the grid. c and C are those of an even pressure on
    what touches, at which u is 8 % more than under a rigid circle (Johnson, *Contact Mechanics*, section 3.4). Where
    first touch lies moves only the approach.
    """
    solution = case.solution
    inside = solution.pressure > 0
    if not ends + bent > 0 or not inside.any():  # bodies that stand off do so by what their mean is off, too
        return {"approach": touch + ends}
    even = inside.astype(np.float64)
    displaced = case.operator(even)
    pushed, mean = float(displaced[inside].mean()), float(displaced.mean())
    load = (ends + bent) / (pushed - mean) * float(even.sum()) * case.grid.cell_area
    share = min(load / solution.load, 1.0) if solution.load > 0 else 0.0
    # of a ball's load P its contact area goes as P^(2/3) and pressures as P^(1/3), of a cylinder's as P and P^(1/2)
    grown = share * solution.contact_area
    return {
        "load": load,
        "approach": touch + (abs(pushed) * ends + abs(mean) * bent) / (pushed - mean),
        "contact_area": grown,
        "contact_area_fraction": grown / case.grid.area,
        "mean_contact_pressure": 0.5 * share * solution.load / solution.contact_area,
    }


def _algebraic(case: ContactCase, fine: Mapping[str, float]) -> dict[str, float]:
    """What surfaces that miss contact by the residual change at most: as much of the approach and of gaps, and the
    pressure that waves of two cells of that height take, E* q h / 2."""
    size = blocks.deviation(case.undeformed) or float(np.abs(case.solution.displacement).max())
    height = case.solution.residual * size
    wavenumber = math.pi / math.sqrt(case.grid.cell_area)
    pressure = 0.5 * case.operator.modulus_at(wavenumber) * wavenumber * height
    mean = fine["mean_contact_pressure"]
    share = min(pressure / mean, 1.0) if mean > 0 else 0.0
    lengths = {"approach": height, "mean_gap": 2 * height}
    pressures = {"max_pressure": pressure, "mean_contact_pressure": pressure}
    loads = {"load": (case.solution.residual if case.load is not None else share) * fine["load"]}
    known = lengths | pressures | loads
    return {name: known.get(name, share * fine[name]) for name in RULES}
