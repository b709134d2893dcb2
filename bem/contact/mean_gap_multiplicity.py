"""Note on mean gaps that several loads give.

A stiff layer on a soft base bends on a free grid: the mean gap falls with the load until the bodies nearly fill it, and
grows again as the layer stands off beside the contact. A mean gap between the least one and the one without contact
then has two solutions. Contacts under loads around the solution are computed on a coarse grid; each change of sign of
(mean gap - prescribed mean gap) over the load is a solution. Called by `solve.solve_contact` after step 12 of
`bem.contact`. Verified in tests/contact/test_several_answers.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bem.contact.nested_iteration import sample
from bem.errors import InputError
from bem.notes import Note
from bem.notes.contact import MEAN_GAP_AMBIGUOUS

if TYPE_CHECKING:
    from bem.contact.solution import ContactSolution
    from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Solve = Callable[..., "ContactSolution"]
"""Arguments and result of `bem.solve_contact`."""

_MOST_CELLS = 48
"""Cells along an axis of the coarse grid."""

_STIFFER = 1.2
"""Ratio of the moduli at short and long wavelengths above which a layer may stand off; a half-space has 1."""

_STEP, _LIGHTER, _HEAVIER = 4.0, 4, 8
"""Ratio of successive trial loads, and their number below and above the load of the solution."""

_TOLERANCE = 1e-4
"""Tolerance of the trial contacts."""

_SAME = 0.05
"""Relative distance below which the order of two mean gaps on the coarse grid is uncertain."""


@dataclass(frozen=True)
class Trial:
    """A trial load [N] and its mean gap [m]."""

    load: float
    mean_gap: float


def note_on_several_answers(
    gap: FloatArray,
    operator: DisplacementOperator,
    found: ContactSolution,
    mean_gap: float,
    hardness: float | None,
    solve: Solve,
) -> tuple[Note, ...]:
    """Return a note if contacts under other loads have the prescribed mean gap as well.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap [m].
    operator : of the contact.
    found : the converged contact of the prescribed mean gap.
    mean_gap : the prescribed one [m].
    hardness : cap on the pressure [Pa], None if elastic.
    solve : `bem.solve_contact`, which calls this function.
    """
    if all(operator.grid.periodic) or not _may_stand_off(operator):
        return ()
    trials = _trials(gap, operator, found, mean_gap, hardness, solve)
    others = _brackets(trials, found.load, mean_gap)
    if not others:
        return ()
    first, last = others[0]
    place = "a larger load" if first >= found.load else "a smaller load" if last <= found.load else "a load nearby"
    return (MEAN_GAP_AMBIGUOUS(load=found.load, first=first, last=last, place=place),)


def _may_stand_off(operator: DisplacementOperator) -> bool:
    """Return True for a stiff layer on a soft base: the modulus is larger at short wavelengths than at long ones."""
    grid = operator.grid
    shortest = math.pi / math.sqrt(grid.cell_area)
    longest = 2 * math.pi / max(grid.lengths)
    return operator.modulus_at(shortest) > _STIFFER * operator.modulus_at(longest)


def _trials(
    gap: FloatArray,
    operator: DisplacementOperator,
    found: ContactSolution,
    mean_gap: float,
    hardness: float | None,
    solve: Solve,
) -> list[Trial]:
    """Return contacts on a coarse grid under rising loads, starting without load."""
    while max(operator.grid.shape) > _MOST_CELLS and (coarser := operator.coarsened()) is not None:
        if coarser.grid.cells == operator.grid.cells:
            break
        operator = coarser
    grid = operator.grid
    coarse = gap if gap.shape == grid.shape else sample(gap, grid.shape, grid.periodic)
    low, high = float(coarse.min()), float(coarse.max())
    trials = [Trial(0.0, float(coarse.mean()) - low)]
    load = found.load
    if not load > 0:  # a load that sinks a body as large as the grid by the height of the gap
        modulus = operator.modulus_at(2 * math.pi / max(grid.lengths))
        load = modulus * max(high - low, mean_gap) * min(grid.lengths)
    most = math.inf if hardness is None else 0.999 * hardness * grid.area
    for power in range(-_LIGHTER, _HEAVIER + 1):
        tried = load * _STEP**power
        if tried >= most:
            break
        try:
            contact = solve(coarse, operator, load=tried, hardness=hardness, tolerance=_TOLERANCE)
        except InputError:  # a load beyond what the solver takes
            break
        trials.append(Trial(tried, float(np.maximum(contact.gap, 0.0).mean())))
        if tried > found.load and min(one.mean_gap for one in trials[-2:]) > max(mean_gap, trials[0].mean_gap):
            break  # from there on the mean gap grows in proportion to the load
    return trials


def _brackets(trials: list[Trial], load: float, mean_gap: float) -> list[tuple[float, float]]:
    """Return pairs of loads [N] between which another contact has the prescribed mean gap.

    Trials too close to the prescribed mean gap are left out. Where the mean gaps at the loads next to that of the
    solution are both larger, another solution lies between them.
    """
    certain = [one for one in trials if abs(one.mean_gap - mean_gap) > _SAME * mean_gap]
    pairs = [
        (before.load, after.load)
        for before, after in pairwise(certain)
        if (before.mean_gap - mean_gap) * (after.mean_gap - mean_gap) < 0
    ]
    others = [(low, high) for low, high in pairs if not low <= load <= high]
    below = [one for one in certain if one.load < load]
    above = [one for one in certain if one.load > load]
    if below and above and min(below[-1].mean_gap, above[0].mean_gap) > mean_gap:
        others.insert(0, (below[-1].load, above[0].load))
    return others
