"""Pressures within their bounds that carry the load: the first one, and what brings others back there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes, sets
from bem.contact.controls import Control, LoadControl, MeanGapControl
from bem.contact.imposing import impose
from bem.contact.level import Begin, Iterate, Level

FloatArray = NDArray[np.float64]

_REGION = 8
"""Cells along a region that keeps its load where pressures are clipped; 4 to 16 count alike."""


def held(pressure: FloatArray, cap: float) -> Iterate:
    """A pressure within the bounds, without its zeros; its array may go."""
    return Iterate(*sets.held(pressure, cap))


def below(cells: NDArray[np.int64], values: FloatArray, cap: float) -> Iterate:
    """Cells with pressure, and their pressures, told from those at the cap."""
    capped = values >= cap
    if not capped.any():
        return Iterate(cells, values, cells[:0])
    return Iterate(cells[~capped], values[~capped], cells[capped])


def first_pressure(level: Level, control: Control, start: Begin) -> Iterate:
    """A feasible pressure to begin with."""
    cells = level.gap.size
    nothing = np.empty(0, np.int64)
    if start is None:
        if isinstance(control, LoadControl):
            return Iterate(np.arange(cells), np.full(cells, control.force / cells), nothing)
        # the mean displacement is not known, nor negative
        least = float(level.gap.mean()) - control.mean_gap if isinstance(control, MeanGapControl) else control.approach
        overlapping = np.flatnonzero(level.gap < least)
        return Iterate(overlapping, np.zeros(overlapping.size), nothing)
    iterate = start if isinstance(start, Iterate) else held(start, level.cap)
    if isinstance(control, LoadControl):
        if iterate.cells.size == 0 and iterate.capped.size == 0:
            return first_pressure(level, control, None)
        return restore_load(level, control, iterate, iterate.values)
    return iterate


def clip(level: Level, control: Control, iterate: Iterate, raw: FloatArray) -> Iterate:
    """Back into the bounds, with the load restored; `raw` is overwritten.

    The neighbours of a cell that pulls make up for what is taken off it (`imposing`). What a cap takes off, the other
    cells of the region do: of load moved across the surface the elastic bodies make waves far longer, and higher, than
    the cells at the bounds are. So they do where displacements have no mean, and no load is given: nothing would answer
    to the load that is lost.
    """
    near = level.near_on(iterate.cells)
    keeps = math.isfinite(level.cap) or (level.operator.mean_free and not isinstance(control, LoadControl))
    if near is None or keeps:
        sets.settle(iterate.cells, raw, level.cap, level.operator.grid.shape, _REGION)
    else:
        impose(near, raw)
    if isinstance(control, LoadControl):
        return restore_load(level, control, iterate, raw)
    below = raw <= 0
    above = raw >= level.cap
    if not (below.any() or above.any()):
        return Iterate(iterate.cells, raw, iterate.capped)
    inside = ~(below | above)
    capped = np.sort(np.concatenate([iterate.capped, iterate.cells[above]])) if above.any() else iterate.capped
    return Iterate(iterate.cells[inside], raw[inside], capped)


def restore_load(level: Level, control: LoadControl, iterate: Iterate, raw: FloatArray) -> Iterate:
    """Clip, and bring the sum to the given force."""
    cap = level.cap
    cells, capped = iterate.cells, iterate.capped
    if math.isinf(cap):
        cells, raw, total = sets.positive(cells, raw)
        return Iterate(cells, raw * (control.force / total), capped)
    wanted = control.force - cap * capped.size
    if not 0 <= wanted <= cap * cells.size:
        # the cells at the cap alone are too many, or not enough with all others: let them take part in the shift
        raw = np.concatenate([raw, np.full(capped.size, cap)])
        cells = np.concatenate([cells, capped])
        order = np.argsort(cells, kind="stable")
        cells, raw = cells[order], raw[order]
        capped = np.empty(0, np.int64)
        wanted = control.force
        if wanted > cap * cells.size:
            everything = np.zeros(level.gap.size)
            everything[cells] = raw
            cells, raw = np.arange(level.gap.size), everything
    values = shifted(raw, wanted, cap)
    above = values >= cap
    inside = (values > 0) & ~above
    if above.any():
        capped = np.sort(np.concatenate([capped, cells[above]]))
    cells, values = cells[inside], values[inside]
    return Iterate(cells, values, capped)


def shifted(raw: FloatArray, wanted: float, cap: float) -> FloatArray:
    """clip(raw + s, 0, cap) with the s that makes its sum the one wanted; `wanted` is within what the bounds allow.

    A safeguarded Newton iteration on a piecewise linear function. Counted from the largest number, which takes part
    whatever the sum, s has all its digits however small the sum is beside the numbers.
    """
    if not wanted > 0:
        return np.zeros(raw.size)
    top = float(raw.max())
    below = raw - top
    high = cap - float(below.min())
    below += passes.shift_to(below, max(top, 0.0), high, float(wanted), float(cap), passes.BLOCK)
    return np.clip(below, 0.0, cap, out=below)


def everywhere(level: Level, iterate: Iterate) -> FloatArray:
    """A pressure as a field."""
    full = np.zeros(level.gap.size)
    full[iterate.cells] = iterate.values
    full[iterate.capped] = level.cap
    return full


def project(level: Level, control: Control, raw: FloatArray) -> Iterate:
    """The nearest pressure within the bounds that carries the load."""
    if isinstance(control, LoadControl):
        values = shifted(raw, control.force, level.cap if math.isfinite(level.cap) else control.force)
    else:
        values = np.clip(raw, 0.0, level.cap)
    return held(values, level.cap)


def between(level: Level, control: Control, old: Iterate, new: Iterate, share: float) -> Iterate:
    """Part of the way from one pressure to another; feasible because the bounds and the load are convex."""
    return project(level, control, (1 - share) * everywhere(level, old) + share * everywhere(level, new))


def gradient_step(level: Level, control: Control, iterate: Iterate, approach: float, step: float) -> Iterate:
    """A projected gradient step; one over the largest eigenvalue cannot raise the energy."""
    raw = np.empty(level.gap.size)
    passes.in_blocks(raw.size, 0, sets.descend, level.flat["displacement"], level.gap, approach, step, raw)
    raw[iterate.cells] += iterate.values
    raw[iterate.capped] += level.cap
    return project(level, control, raw)


def lift(level: Level, iterate: Iterate, mean: float) -> Iterate | None:
    """Change the pressure of doubly periodic full contact uniformly until a cell reaches a bound; None if one is there.

    This leaves the displacement as it is, so it is the only way out of a mean gap that is not the wanted one.
    """
    values = iterate.values
    first, bound = (values.min(), 0.0) if mean > 0 else (values.max(), level.cap)
    if first == bound:
        return None
    values = bound + (values - first)
    inside = (values > 0) & (values < level.cap)
    capped = iterate.cells[values >= level.cap]
    return Iterate(iterate.cells[inside], values[inside], capped)
