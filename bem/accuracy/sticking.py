"""Error bars of contacts that stick and slip, pushed or rolling: the same on the grid of twice the cell.

Parts: of the grid, the difference to the coarser one times a factor, and a share of the figure that grows with what of
the contact lies within a cell of its edge; of the steps in which a load comes, the difference to half of them; and what
the residual may hide. Pushed contacts are near second order, rolling ones of first. Some figures show no order where
they are small or coarse, and have a share that needs none: energy is spent in a ring at the edge, of a cell or less
where little slips; stiffnesses count whole cells, and what sticks of a pushed contact errs as if it did; forces of
rolling miss what the part that sticks holds back, though their difference may pass zero. Other factors
are set by `reports/experiments/sticking_error_bars.py` on seeds that it does not store: an estimate, no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping

import numpy as np
from numpy.typing import NDArray

from bem.accuracy.bars import GRID, PRESSING, PRESSING_FACTOR, RESIDUAL, ErrorBars, Rule
from bem.accuracy.contact import ContactCase, is_resolved, share_at_edge

_MOVED = Rule(1.0, 0.6, edge=0.005, rough_edge=0.02)
_SPENT = Rule(0.8, 0.8, edge=0.005, rough_edge=0.005)
_STIFF = Rule(0.5, 0.5)
PUSH_RULES = dict.fromkeys(("force", "shift", "first_stiffness", "moment"), _MOVED) | {
    "stick_fraction": Rule(1.5, 1.0),
    "dissipated": _SPENT,
    "dissipated_in_cycle": _SPENT,
    "normal_stiffness": _STIFF,
    "tangential_stiffness": _STIFF,
}
_CARRIED = Rule(1.3, 1.3, edge=0.01, rough_edge=0.03)
_CREPT = Rule(1.5, 1.5, edge=0.05, rough_edge=0.08)
_WORKED = Rule(1.2, 1.2, edge=0.04, rough_edge=0.064)
"""Of the work of friction in rolling: bars cover 51 of 53 contacts drawn at random, and 21 of 21 others."""
ROLL_RULES = dict.fromkeys(("force", "force_across", "traction_coefficient"), _CARRIED) | {
    "creepage": _CREPT,
    "creepage_across": _CREPT,
    "friction_work": _WORKED,
    "stick_fraction": Rule(1.5, 1.2, edge=0.12, rough_edge=0.12),
}
_SPENT_IN_RING = ("dissipated", "dissipated_in_cycle")
_RING = 0.1
"""Of the energy spent in a ring of one cell, which goes like the square of cells in its width: errors were 0.18 (root
mean square of 31) in rings of less than a cell, 0.15 over that square at most in 48 wider ones of like bodies."""
_COUNTED = ("normal_stiffness", "tangential_stiffness")
_MISCOUNT, _CENTRED = 0.057, 0.134
"""Of stiffness, times the share at the edge to the power 3/2: points of a lattice in a circle of r cells miss its area
by 0.676 sqrt(r) in the root mean square over its places (Kendall, Quart. J. Math. 19 (1948) 1) and, where its centre is
a point of the lattice or the middle of four, over its radii by 1.594 sqrt(r) (Cramer, Math. Z. 15 (1922) 201: the
square's integral to x = r^2 is 1.694 x^(3/2)), for waves of the lattice meet there. Stiffness goes with the root of
area, the share is 2 / r, and these are one and a half times what that leaves, 0.038 and 0.090; 180 balls had 0.036 and
0.079, and 93 to 100 % of each are covered."""
_STUCK = 0.152
"""Of the share that sticks where a contact is pushed, by the same law in the circle that sticks: twice what a count of
whole cells misses of its area, 0.43 of its radius in cells to the power -3/2, which is 2 / share at the edge times the
root of what sticks. Edges lie inside cells, but rings that slip are about as wide, and errors were those of a count:
the misses of 28, whose differences happened to pass zero, 1.7 to 3 times its root mean square."""
_FORCES = ("force", "force_across")
_CARRIES = (*_FORCES, "traction_coefficient")
_CREEPAGES = ("creepage", "creepage_across")
"""Parts of one vector: spin and the edge turn it, so that one part's error is a share of its length."""
_ROUND_OFF = 1e-9
"""Of that length: below it a part is zero by symmetry."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residuals."""


def sticking_bars(
    rules: Mapping[str, Rule],
    case: ContactCase,
    fine: Mapping[str, float],
    coarse: Mapping[str, float],
    residual: float,
    fewer: Mapping[str, float] | None = None,
    given: Container[str] = (),
    limit: float = 0.0,
) -> ErrorBars:
    """Bars of figures that have a rule.

    Parameters
    ----------
    rules : by the names of figures.
    case : the contact without friction.
    fine, coarse : figures on its grid and on that of twice the cell, SI units.
    residual : the largest of all steps and of the contact.
    fewer : figures on the coarser grid with half the pressing steps; None where the load comes at once.
    given : figures that are prescribed, which have no error but the residual's.
    limit : friction x load [N], which
        residuals of forces are relative to.
    """
    resolved, edge = is_resolved(case), share_at_edge(case)
    grid, steps, left = {}, {}, {}
    for name, value in fine.items():
        if name not in rules or not math.isfinite(value):
            continue
        inexact = 0.0 if name in given else 1.0
        # the edge of stick is as much shorter as the root of what sticks, and no shorter than a cell
        at_edge = edge * math.sqrt(value) + edge**2 if name == "stick_fraction" else edge * _size(name, fine)
        of_cells = rules[name].bar(value - coarse[name], at_edge, resolved=resolved)
        if name in _SPENT_IN_RING:
            of_cells += _RING * abs(value) / (0.5 + cells_across_ring(fine["stick_fraction"], edge) ** 2)
        elif name == "stick_fraction" and rules[name].edge == 0 < value:
            of_cells += min(_STUCK * (edge / math.sqrt(value)) ** 1.5, 1.0) * value
        elif name in _COUNTED:
            of_cells += (_CENTRED if _is_centred(case.solution.pressure > 0) else _MISCOUNT) * edge**1.5 * abs(value)
        grid[name] = inexact * of_cells
        left[name] = _ALGEBRAIC * residual * max(abs(value), limit if name in _FORCES else 0.0)
        if fewer is not None:
            steps[name] = inexact * PRESSING_FACTOR * abs(coarse[name] - fewer[name])
    if "creepage" in rules:
        for name, least in _held_back(fine, coarse, limit).items():
            grid[name] = max(grid[name], least) if name in grid and name not in given else grid.get(name, 0.0)
    parts = {GRID: grid, RESIDUAL: left} if fewer is None else {GRID: grid, PRESSING: steps, RESIDUAL: left}
    return ErrorBars.together(parts)


def _held_back(fine: Mapping[str, float], coarse: Mapping[str, float], limit: float) -> dict[str, float]:
    """What rolling forces and their coefficient miss at least where what sticks differs between grids.

    They fall short of friction x load by what sticks holds back, which goes with the square of its length (Carter 1926:
    F = 1 - (c / a)^2 of a strip of which c / a sticks): its relative error is twice that of what sticks.
    """
    sticks = fine.get("stick_fraction", 0.0)
    force = math.hypot(*(fine.get(name, 0.0) for name in _FORCES))
    if not (sticks > 0 and 0 < force < limit):
        return {}
    held = 2 * min(abs(sticks - coarse["stick_fraction"]) / sticks, 1.0) * (limit / force - 1)
    return {name: _CARRIED.resolved * held * abs(fine[name]) for name in _CARRIES if name in fine}


def _is_centred(touching: NDArray[np.bool_]) -> bool:
    """Return True if the cells that touch (nx, ny) are their own mirror images along both axes, as under a ball whose
    middle is that of a cell, or of four."""
    box = touching[np.ix_(touching.any(axis=1), touching.any(axis=0))]
    return bool((box == box[::-1]).all() and (box == box[:, ::-1]).all())


def _size(name: str, fine: Mapping[str, float]) -> float:
    """What a figure's share at the edge is of: its value, for a part of the creepage the length of the whole."""
    value = fine[name]
    if name not in _CREEPAGES:
        return value
    length = math.hypot(*(fine.get(part, 0.0) for part in _CREEPAGES))
    return length if abs(value) > _ROUND_OFF * length else value


def cells_across_ring(stick_fraction: float, edge: float) -> float:
    """Cells across the ring that slips in the mean spot, a circle in which a circle sticks; `edge` : what of its area
    lies within a cell of its edge."""
    return 2 * (1 - math.sqrt(min(max(stick_fraction, 0.0), 1.0))) / edge if edge > 0 else math.inf
