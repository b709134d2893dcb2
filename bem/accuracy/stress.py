"""Error bars of the highest von Mises stress below a contact, of its depth, and of the volume that yields."""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.accuracy.bars import DEPTHS, GRID, PRESSING, PRESSING_FACTOR, ErrorBars, Rule
from bem.accuracy.contact import Coarser, ContactCase, is_resolved, share_at_edge, touches_sharply
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes.accuracy import NoBar
from bem.stress import StressSummary, summarise_stress, von_mises_planes
from bem.stress.stress_summary import yield_stresses

NAMES = ("max_von_mises", "max_von_mises_depth")
_VON_MISES = Rule(0.33, 0.67, edge=0.008, rough_edge=0.025)
_VOLUME = Rule(0.95, 1.1)
"""On the difference to the volume of the coarser pressure, on twice the cell and at every second depth."""
_RUBBED_EDGE = 0.25
"""Of the highest stress at the surface, times the share of the contact within a cell of its edge: friction makes it
highest at the edge that trails, towards which it rises like x / a (Hamilton), and the cell that is nearest lies up to
half a cell inside, h / (2 a), a quarter of that share. Differences between grids say where cells happen to lie."""
_LATERAL = 0.3
"""Of a cell squared over the depth: by how much the depth of the highest stress moves where its place along the surface
is known to a part of a cell: 0.1 to 0.5 under balls. Under rough surfaces the difference was larger than that. Where
the highest is looked for between points, on both grids, the place is known better and the difference alone is left."""
_LOOKED_MOVED = 0.5
"""Of that difference: order two leaves a third."""
_JUMP = 1.3
"""Factor on the depth's bar where the surface is not resolved: the highest stress may lie under another spot."""
_LOOKED, _LOOKED_DEPTH, _WIDE = 0.3, 0.05, 0.4
"""Where the highest stress was looked for between depths: factors on its rise above the points and on the interval, on
the latter times the square of the interval over so much of the depth where that is less: the place of the highest of a
cubic through four depths is of third order, and stresses change over the depth."""
_STEEPER = 2.0
"""Factor on what a straight line through two depths reaches at an interface: stresses rise the steeper the nearer."""

_FAR = 0.8
"""Of the yield stress: where none is higher nothing yields on any grid."""


def stress_bars(
    case: ContactCase,
    coarser: Coarser,
    body: Body,
    below: StressSummary,
    friction: float = 0.0,
    traction: FloatArray | None = None,
    fewer: tuple[FloatArray, FloatArray] | None = None,
) -> ErrorBars:
    """Bars from the coarser pressure at every second depth, and from the depths next to the highest stress.

    Parameters
    ----------
    case, coarser : the contact and its coarser solution, as `bem.accuracy.contact` makes them.
    body, friction : as `bem.stress.summarise_stress` takes them.
    below : what it gave for the contact.
    traction : the coarser one (2, nx, ny) [Pa] where `below` is that of tractions of their own.
    fewer : pressure (nx, ny) and traction [Pa] on the coarser grid with half of the steps in which the load comes.
    """
    rubbed = {"friction": friction, "traction": traction}
    return _of_stress(case, coarser, body, below, rubbed, fewer) | _of_volume(case, coarser, body, below, rubbed)


def _of_volume(
    case: ContactCase, coarser: Coarser, body: Body, below: StressSummary, rubbed: dict[str, Any]
) -> ErrorBars:
    found, depths = below.yielded_volume, below.depths
    if found is None:
        return ErrorBars()
    if coarser.solution is None or coarser.grid is None or len(depths) < 5:
        return ErrorBars({"yielded_volume": None})
    near = np.flatnonzero(below.highest > _FAR * yield_stresses(body, depths))
    if not near.size:
        return ErrorBars.together({GRID: {"yielded_volume": 0.0}})
    first, last = max(near[0] - 2, 0), min(near[-1] + 2, len(depths) - 1)  # what lies farther does not yield
    few = depths[sorted({*range(first, last, 2), last})]
    there = summarise_stress(coarser.solution.pressure, coarser.grid, body, few, **rubbed).yielded_volume
    assert there is not None
    return ErrorBars.together({GRID: {"yielded_volume": _VOLUME.bar(found - there, 0.0, resolved=is_resolved(case))}})


def _of_stress(
    case: ContactCase,
    coarser: Coarser,
    body: Body,
    below: StressSummary,
    rubbed: dict[str, Any],
    fewer: tuple[FloatArray, FloatArray] | None,
) -> ErrorBars:
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars(dict.fromkeys(NAMES))
    depths, highest = below.depths, below.highest
    k, few = int(np.argmax(highest)), len(depths) < 3  # one or two depths are where stresses are wanted, not a search
    if k == len(depths) - 1 and not few:
        return ErrorBars.unknown(NAMES, NoBar.DEEPEST_DEPTH)
    near = depths[k] < np.sqrt(case.grid.cell_area)
    if case.hardness is not None and near and (case.solution.pressure >= case.hardness).any():
        return ErrorBars.unknown(NAMES, NoBar.STRESS_OF_CAPPED)
    if near and touches_sharply(case):
        return ErrorBars.unknown(NAMES, NoBar.STRESS_OF_SHARP)
    if k == 0 and depths[0] > 0 and not few:
        return ErrorBars.unknown(NAMES, NoBar.SHALLOWEST_DEPTH)
    kept = depths[sorted({*range(k % 2, len(depths), 2), max(k - 1, 0), min(k + 1, len(depths) - 1)})]
    there = _highest_below(coarser.solution.pressure, coarser.grid, body, kept, rubbed)
    resolved, edge = is_resolved(case), share_at_edge(case)
    stress = _VON_MISES.bar(below.max_von_mises - there.max_von_mises, edge * below.max_von_mises, resolved=resolved)
    if near and (rubbed["friction"] or rubbed["traction"] is not None):
        stress += _RUBBED_EDGE * edge * below.max_von_mises
    jump = 1.0 if resolved else _JUMP
    top, error = (0.0, 0.0) if few else _between(below, k)
    for interface in () if few else body.interfaces:
        above = _STEEPER * (_beyond(depths, highest, interface) - highest[k])
        if above > 0:
            top, error = max(top, float(above)), max(error, abs(interface - float(depths[k])))
    moved = abs(below.max_von_mises_depth - there.max_von_mises_depth)
    looked = all(one.max_von_mises_depth not in one.depths for one in (below, there))
    if resolved and looked:
        moved *= _LOOKED_MOVED
    elif resolved and not near:
        moved += _LATERAL * case.grid.cell_area / float(depths[k])
    parts = {
        GRID: {"max_von_mises": float(stress), "max_von_mises_depth": float(jump * moved)},
        DEPTHS: {"max_von_mises": top, "max_von_mises_depth": jump * error},
    }
    if fewer is not None:
        half = _highest_below(fewer[0], coarser.grid, body, kept, {"traction": fewer[1]})
        parts[PRESSING] = {n: PRESSING_FACTOR * abs(getattr(there, n) - getattr(half, n)) for n in NAMES}
    return ErrorBars.together(parts)


def _highest_below(
    pressure: FloatArray, grid: Grid, body: Body, depths: FloatArray, rubbed: dict[str, Any]
) -> StressSummary:
    """Stresses next to the depth where they are highest; planes are not kept on the way to it."""
    planes = von_mises_planes(pressure, grid, body, depths, **rubbed, out=np.empty(grid.shape))
    k = int(np.argmax([plane.max() for plane in planes]))
    return summarise_stress(pressure, grid, body, depths[max(k - 2, 0) : k + 3], **rubbed)


def _between(below: StressSummary, k: int) -> tuple[float, float]:
    """What may be wrong with the highest stress [Pa] and its depth [m] between the depths next to the k-th."""
    depths = below.depths
    if below.max_von_mises_depth == depths[k]:  # nothing was looked for
        return _highest_between(depths, below.highest, k)
    interval = float(max(depths[k] - depths[k - 1], depths[k + 1] - depths[k]))
    order = min(interval / (_WIDE * float(depths[k])), 1.0) ** 2
    return _LOOKED * float(below.max_von_mises - below.highest[k]), _LOOKED_DEPTH * order * interval


def _highest_between(depths: FloatArray, highest: FloatArray, k: int) -> tuple[float, float]:
    """By how much a parabola through the highest stress and its neighbours rises above it [Pa], and how far the highest
    may lie from its depth: half-way to the neighbour it leans to [m]."""
    if k == 0:
        return 0.0, float(depths[1] - depths[0]) / 2
    z, s = depths[k - 1 : k + 2] - depths[k], highest[k - 1 : k + 2] - highest[k]
    bend, slope = np.polyfit(z, s, 2)[:2] if np.ptp(s) > 0 else (0.0, 0.0)
    rise = -slope * slope / (4 * bend) if bend < 0 else 0.0
    return float(rise), float(max(-z[0], z[2])) / 2


def _beyond(depths: FloatArray, highest: FloatArray, interface: float) -> float:
    """What the highest stresses of the two depths next to an interface, on either side, go on to at it [Pa]: there
    stress jumps, and its highest may lie between depths."""
    found = 0.0
    for side in (np.flatnonzero(depths <= interface)[-2:], np.flatnonzero(depths >= interface)[:2]):
        if len(side) == 2:
            (a, b), (one, other) = depths[side], highest[side]
            found = max(found, one + (other - one) * (interface - a) / (b - a))
    return float(found)
