"""Error bars of contacts that stick and slip, pushed or rolling: the same on the grid of twice the cell.

Pushed contacts are near second order, rolling ones of first. Parts of the bar: the grid, the loading steps (the
difference to half of them), and the residual. Figures that count cells have floors by lattice theory: energy is
dissipated in a ring at the edge, which may be narrower than a cell; stiffnesses and the sticking area count cells.

Verified in tests/accuracy/test_shares_without_order.py; judged by the experiment that the tables name.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping

import numpy as np
from numpy.typing import NDArray

from bem.accuracy.bars import GRID, PRESSING, PRESSING_FACTOR, RESIDUAL, STEPS, ErrorBars
from bem.accuracy.coarsened import ContactCase, edge_fraction, regime_of
from bem.accuracy.richardson import Table, residual_errors, rows
from bem.notes.accuracy import NoBar

_FORCES = ("force", "force_across")
_CARRIED = (*_FORCES, "traction_coefficient")
_CREEPAGES = ("creepage", "creepage_across")

PUSH_RULES = Table(
    "sticking_error_bars",
    rows(
        "force shift first_stiffness moment",
        (1.0, 0.6),
        "Second order; three times Richardson, as the border of the sticking area moves by whole cells.",
        edge=(0.005, 0.02),
    ),
    rows(
        "stick_fraction",
        (1.5, 1.0),
        "First order: the sticking area errs as a count of cells does. A count in a circle of r cells misses "
        "0.43 r^(-3/2) of it in the root mean square (Kendall 1948): twice that is 0.152 times (edge fraction over the "
        "root of what sticks)^(3/2).",
        order=1,
        counted=0.152,
    ),
    rows(
        "dissipated dissipated_in_cycle",
        0.8,
        "Energy of a ring goes with the square of the cells across it: errors were 0.18 of the energy in rings of less "
        "than a cell, and at most 0.15 over that square in 48 wider ones.",
        edge=0.005,
        ring=0.1,
    ),
    rows(
        "normal_stiffness tangential_stiffness",
        0.5,
        "Stiffness goes with the root of the area, a count of cells: points of a lattice miss the area of a circle of "
        "r cells by 0.676 sqrt(r) (Kendall, Quart. J. Math. 19 (1948) 1), by 1.594 sqrt(r) where the centre is a "
        "symmetry point of the lattice (Cramer, Math. Z. 15 (1922) 201). One and a half times either.",
        counted=0.057,
        centred=0.134,
    ),
)
"""Pushed contacts. Floors on the figure's fraction within a cell of the edge (edge), on that fraction to the power 3/2
(counted, centred), and over the square of the cells across the slipping ring (ring)."""
LIMITED_RULES = Table(
    "sticking_error_bars",
    {
        name: row
        for name, row in PUSH_RULES.items()
        if name not in ("stick_fraction", "dissipated", "dissipated_in_cycle")
    },
    rows(
        "force shift first_stiffness moment",
        (2.0, 1.5),
        "First order: a shear strength jumps to zero at the edge of contact, which moves by whole cells. Against 100 "
        "cells, four balls under shear strengths on 36 and 45 cells missed by at most half of this bar.",
        order=1,
        edge=(0.05, 0.06),
    ),
    rows(
        "stick_fraction",
        2.0,
        "First order. The ring that slips under a shear strength begins with the root of the traction's singularity: "
        "it may be missed up to the cells at the edge.",
        order=1,
        edge=1.0,
    ),
    rows(
        "dissipated dissipated_in_cycle",
        2.0,
        "First order. Rings of less than a cell have no bar.",
        order=1,
        ring=0.5,
    ),
)
"""Pushed contacts whose traction is bounded by a law other than friction x pressure."""
ROLL_RULES = Table(
    "sticking_error_bars",
    rows(
        "force force_across traction_coefficient",
        1.3,
        "First order. The floor covers edges whose differences cancel.",
        order=1,
        edge=(0.01, 0.03),
    ),
    rows(
        "creepage creepage_across",
        1.5,
        "First order. Parts of one vector: spin and the edge turn it, so that the edge counts of its length.",
        order=1,
        edge=(0.05, 0.08),
    ),
    rows(
        "friction_work",
        1.2,
        "First order; 51 of 53 contacts drawn at random and 21 of 21 others were covered.",
        order=1,
        edge=(0.04, 0.064),
    ),
    rows(
        "stick_fraction",
        (1.5, 1.2),
        "First order. The border of the sticking area is shorter than the edge by the root of what sticks. What sticks "
        "along less than one and a half cells at the leading edge may go unnoticed.",
        order=1,
        edge=0.12,
        shortest=1.0,
    ),
)
"""Rolling contacts, with the same floors, and one on the sticking area that cells may miss (shortest)."""
_SHORTEST = 1.5
"""Cells along the rolling over which a contact may stick without a cell that sticks."""
_PART, _SHORT = 0.65, 6.0
"""Part of a cell along its width by which a sticking area of fewer cells (`_SHORT`) along the rolling is wrong, in
30 rolling balls of 7 to 12 cells to the radius with falling friction."""
_CRESCENT = 0.2
"""Fraction of the contact up to which what sticks is a crescent."""
_ROUND_OFF = 1e-9
"""Part of the creepage over its length, below which it is zero by symmetry."""


def sticking_bars(
    rules: Table,
    case: ContactCase,
    fine: Mapping[str, float],
    coarse: Mapping[str, float],
    residual: float,
    fewer: Mapping[str, float] | None = None,
    given: Container[str] = (),
    limit: float = 0.0,
) -> ErrorBars:
    """Return the error bars of the figures that have a rule.

    Parameters
    ----------
    rules : `PUSH_RULES`, `LIMITED_RULES` or `ROLL_RULES`.
    case : the contact without friction.
    fine, coarse : figures on its grid and on that of twice the cell, SI units.
    residual : the largest of all steps and of the contact.
    fewer : figures on the coarser grid with half the loading steps, or a quarter of a step of rolling earlier; None
        where the load comes at once.
    given : prescribed figures, which have no error.
    limit : friction x load [N], to which the residuals of forces are relative.
    """
    found = {name: value for name, value in fine.items() if name in rules and math.isfinite(value)}
    grid = rules.errors(found, coarse, _indicators(case, fine, found), regime=regime_of(case))
    if rules is ROLL_RULES:
        for name, least in _held_back(case, fine, coarse, limit).items():
            if name in grid:
                grid[name] = max(grid[name], least)
    sizes = {name: max(abs(value), limit if name in _FORCES else 0.0) for name, value in found.items()}
    parts = {GRID: grid, RESIDUAL: residual_errors(residual, sizes)}
    if fewer is not None:
        steps = {name: PRESSING_FACTOR * abs(coarse[name] - fewer[name]) for name in found}
        parts[STEPS if rules is ROLL_RULES else PRESSING] = steps
    bars = ErrorBars.together(parts).with_prescribed([name for name in found if name in given])
    if rules is LIMITED_RULES and cells_across_ring(fine["stick_fraction"], edge_fraction(case)) < 1:
        for name in ("dissipated", "dissipated_in_cycle"):
            bars = bars.without(name, NoBar.NARROW_RING) if name in bars.values else bars
    return bars


def _indicators(
    case: ContactCase, fine: Mapping[str, float], found: Mapping[str, float]
) -> dict[str, dict[str, float]]:
    """Return the indicators of the floors by figure."""
    fraction = edge_fraction(case)
    edge = {name: fraction * abs(value) for name, value in found.items()}
    length = math.hypot(*(fine.get(part, 0.0) for part in _CREEPAGES))
    edge |= {name: fraction * length for name in _CREEPAGES if abs(found.get(name, 0.0)) > _ROUND_OFF * length}
    counted = {name: math.sqrt(fraction) * size for name, size in edge.items()}
    centred: dict[str, float] = {}
    if _is_centred(case.solution.pressure > 0):
        counted, centred = {}, counted
    sticks, ring, shortest = found.get("stick_fraction", 0.0), {}, {}
    if "stick_fraction" in found:
        shortest["stick_fraction"] = _missed_stick(case, sticks)
        # the border of the sticking area is no shorter than a cell
        edge["stick_fraction"] = fraction * math.sqrt(sticks) + fraction**2
        counted["stick_fraction"] = (fraction / math.sqrt(sticks)) ** 1.5 * sticks if sticks > 0 else 0.0
        across = cells_across_ring(sticks, fraction)
        ring = {name: abs(value) / (0.5 + across**2) for name, value in found.items()}
    return {"edge": edge, "counted": counted, "centred": centred, "ring": ring, "shortest": shortest}


def _missed_stick(case: ContactCase, sticks: float) -> float:
    """Return the fraction of the contact by which a short sticking area at the leading edge may be wrong.

    By strip theory the area of a circle of r cells that sticks over a length s along the rolling is the crescent
    between the circle and the same circle moved by s, 2 sqrt(s r) wide and of the area 2/3 of both. Of a strip it has
    one width. An area of up to `_SHORTEST` cells may have no cell; a longer one errs by part of a cell on its width.
    """
    fraction = edge_fraction(case)
    if fraction == 0:
        return 0.0
    if 1 in case.grid.shape:
        length, missed = 2 * sticks / fraction, 0.5 * fraction
        shortest = _SHORTEST * missed
    else:
        length = (3 * math.pi * sticks / (math.sqrt(2) * fraction**1.5)) ** (2 / 3)
        missed = math.sqrt(0.5 * length * fraction**3) / math.pi
        shortest = 4 / (3 * math.pi) * (0.5 * _SHORTEST * fraction) ** 1.5
    if sticks <= shortest:
        return shortest
    return _PART * missed if length < _SHORT and sticks < _CRESCENT else 0.0


def _held_back(
    case: ContactCase, fine: Mapping[str, float], coarse: Mapping[str, float], limit: float
) -> dict[str, float]:
    """Return the least errors of rolling forces and their coefficient from the difference of the sticking areas.

    Forces fall short of friction x load by what sticks holds back, which goes with the square of its length (Carter
    1926: F = 1 - (c / a)^2 of a strip of which c / a sticks): its relative error is twice that of what sticks. With
    spin forces fall short by opposite tractions, too. What sticks holds back no more than twice friction x pressure on
    its area, from one direction to the opposite, and its pressure is at most the largest.
    """
    sticks = fine.get("stick_fraction", 0.0)
    force = math.hypot(*(fine.get(name, 0.0) for name in _FORCES))
    if not (sticks > 0 and 0 < force < limit):
        return {}
    pressure = case.solution.pressure
    sharpness = float(pressure.max() / pressure[pressure > 0].mean())
    most = min(limit / force - 1, 2 * sharpness * sticks * limit / force)
    held = 2 * min(abs(sticks - coarse["stick_fraction"]) / sticks, 1.0) * most
    return {name: ROLL_RULES[name].error(held * fine[name], {}) for name in _CARRIED if name in fine}


def _is_centred(touching: NDArray[np.bool_]) -> bool:
    """Return True if the cells that touch (nx, ny) mirror themselves along both axes, as under a ball whose middle is
    that of a cell or of four."""
    box = touching[np.ix_(touching.any(axis=1), touching.any(axis=0))]
    return bool((box == box[::-1]).all() and (box == box[:, ::-1]).all())


def cells_across_ring(stick_fraction: float, edge: float) -> float:
    """Return the cells across the slipping ring of the mean spot, a circle in which a circle sticks.

    edge : fraction of the area within a cell of its edge.
    """
    return 2 * (1 - math.sqrt(min(max(stick_fraction, 0.0), 1.0))) / edge if edge > 0 else math.inf
