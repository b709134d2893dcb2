"""Error bars of the highest von Mises stress below a contact, of its depth, and of the volume that yields.

The coarser solution is the pressure on the grid of twice the cell, at every second depth. The depths leave an error of
their own: the rise of the stress between the depths next to its highest.

Verified in tests/accuracy/test_contact_bars.py and test_shares_without_order.py; judged by the experiments that `RULES`
names.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.accuracy.bars import DEPTHS, GRID, PRESSING, PRESSING_FACTOR, ErrorBars
from bem.accuracy.coarsened import Coarser, ContactCase, edge_fraction, regime_of, widest_cell
from bem.accuracy.contact import touches_sharply
from bem.accuracy.edge import EDGE
from bem.accuracy.richardson import Table, rows
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes.accuracy import NoBar
from bem.stress import StressSummary, summarise_stress, von_mises_planes
from bem.stress.stress_summary import yield_stresses

NAMES = ("max_von_mises", "max_von_mises_depth")
RULES = Table(
    "contact_error_bars sticking_error_bars",
    rows(
        "max_von_mises",
        (0.33, 0.67),
        "Second order below the surface. Friction makes the stress highest at the trailing edge, towards which it "
        "rises like x / a (Hamilton): the nearest cell lies up to half a cell inside, h / 2a, a quarter of what lies "
        "within a cell of the edge.",
        edge=(0.008, 0.025),
        rubbed=0.25,
    ),
    rows(
        "max_von_mises_depth",
        1.0,
        "First order: the highest stress lies on a cell, where it is not interpolated, or under another spot.",
        order=1,
    ),
    rows("yielded_volume", (0.95, 1.1), "First order: what yields ends on whole cells and depths.", order=1),
)
"""Factors on the difference, and floors on the stress times the fraction within a cell of the edge, of all contacts
(edge) and of rubbed ones whose highest stress is at the surface (rubbed)."""

_RISE, _DEPTH, _WIDE = 0.3, 0.05, 0.4
"""Of an interpolated highest stress: errors over its rise above the depths, and over the interval of the depths. A
cubic through four depths is of third order, so that the latter falls with the square of the interval below `_WIDE`
times the depth."""
_STEEPER = 2.0
"""Factor on the rise of a straight line through two depths to an interface: stresses steepen towards it."""
_FAR = 0.8
"""Highest stress over the yield stress, below which a depth yields on no grid."""


def stress_bars(
    case: ContactCase,
    coarser: Coarser,
    body: Body,
    below: StressSummary,
    friction: float = 0.0,
    traction: FloatArray | None = None,
    fewer: tuple[FloatArray, FloatArray] | None = None,
) -> ErrorBars:
    """Return error bars from the coarser pressure at every second depth, and from the depths of the highest stress.

    Parameters
    ----------
    case, coarser : contact and its coarser solution.
    body, friction : as `bem.stress.summarise_stress` takes them.
    below : summary of the stresses of the contact.
    traction : (2, nx, ny) [Pa] on the coarser grid where `below` is that of given tractions.
    fewer : pressure (nx, ny) and traction [Pa] on the coarser grid with half of the loading steps.
    """
    rubbed = {"friction": friction, "traction": traction}
    return _of_highest_stress(case, coarser, body, below, rubbed, fewer) | _of_volume(
        case, coarser, body, below, rubbed
    )


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
    first, last = max(near[0] - 2, 0), min(near[-1] + 2, len(depths) - 1)  # deeper and shallower nothing yields
    few = depths[sorted({*range(first, last, 2), last})]
    there = summarise_stress(coarser.solution.pressure, coarser.grid, body, few, **rubbed).yielded_volume
    volumes = {"yielded_volume": found}, {"yielded_volume": there}
    return ErrorBars.together({GRID: RULES.errors(*volumes, regime=regime_of(case))})


def _of_highest_stress(
    case: ContactCase,
    coarser: Coarser,
    body: Body,
    below: StressSummary,
    rubbed: dict[str, Any],
    fewer: tuple[FloatArray, FloatArray] | None,
) -> ErrorBars:
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars(dict.fromkeys(NAMES))
    depths, highest, few = below.depths, below.highest, len(below.depths) < 3  # one or two are chosen, not searched
    k = 0 if below.highest_at_edge else int(np.argmax(highest))
    if k == len(depths) - 1 and not few:
        return ErrorBars.unknown(NAMES, NoBar.DEEPEST_DEPTH)
    near = bool(depths[k] < widest_cell(case.grid))
    if case.hardness is not None and near and (case.solution.pressure >= case.hardness).any():
        return ErrorBars.unknown(NAMES, NoBar.STRESS_OF_CAPPED)
    if near and touches_sharply(case):
        return ErrorBars.unknown(NAMES, NoBar.STRESS_OF_SHARP)
    if k == 0 and depths[0] > 0 and not few:
        return ErrorBars.unknown(NAMES, NoBar.SHALLOWEST_DEPTH)
    kept = depths[sorted({*range(k % 2, len(depths), 2), max(k - 1, 0), min(k + 1, len(depths) - 1)})]
    if below.highest_at_edge:
        there = summarise_stress(coarser.solution.pressure, coarser.grid, body, depths[:1], **rubbed)
    else:
        there = _highest_below(coarser.solution.pressure, coarser.grid, body, kept, rubbed)
    rise, interval = (0.0, 0.0) if few else _between(below, k, body)
    own = below.max_von_mises if below.highest_at_edge else highest[k]
    for interface in () if few else body.interfaces:
        above = _STEEPER * (_extrapolated(depths, highest, interface) - own)
        if above > 0:
            rise, interval = max(rise, float(above)), max(interval, abs(interface - float(depths[k])))
    edge = {"max_von_mises": edge_fraction(case) * below.max_von_mises}
    found, coarse = ({name: getattr(one, name) for name in NAMES} for one in (below, there))
    indicators = {"edge": edge, "rubbed": edge if near and _is_rubbed(rubbed) else {}}
    parts = {
        GRID: RULES.errors(found, coarse, indicators, regime=regime_of(case)),
        DEPTHS: {"max_von_mises": rise, "max_von_mises_depth": interval},
    }
    if below.edge is not None and below.highest_at_edge:
        cusp, whole = below.max_von_mises - float(highest[0]), edge["max_von_mises"]
        sizes = {"cusp": cusp, "pressed": below.edge.von_mises_pressure, "edge": whole}
        difference = below.max_von_mises - there.max_von_mises
        parts[GRID]["max_von_mises"] = EDGE.error(difference, sizes, regime_of(case))
    if fewer is not None:
        half = _highest_below(fewer[0], coarser.grid, body, kept, {"traction": fewer[1]})
        parts[PRESSING] = {n: PRESSING_FACTOR * abs(getattr(there, n) - getattr(half, n)) for n in NAMES}
    return ErrorBars.together(parts)


def _is_rubbed(rubbed: dict[str, Any]) -> bool:
    """Return True if tractions act on the surface."""
    return bool(rubbed["friction"]) or rubbed["traction"] is not None


def _highest_below(
    pressure: FloatArray, grid: Grid, body: Body, depths: FloatArray, rubbed: dict[str, Any]
) -> StressSummary:
    """Return the stresses next to the depth where they are highest; other planes are not kept."""
    planes = von_mises_planes(pressure, grid, body, depths, **rubbed, out=np.empty(grid.shape))
    k = int(np.argmax([plane.max() for plane in planes]))
    return summarise_stress(pressure, grid, body, depths[max(k - 2, 0) : k + 3], **rubbed)


def _between(below: StressSummary, k: int, body: Body) -> tuple[float, float]:
    """Return the errors of the highest stress [Pa] and of its depth [m] between the depths next to the k-th.

    Next to an interface, where stress jumps, only depths of the same layer count; `_extrapolated` judges the rise
    towards the interface.
    """
    depths = below.depths
    if below.max_von_mises_depth == depths[k]:  # not interpolated
        own = [i for i in (k - 1, k + 1) if i >= 0 and body.medium_at(depths[i]) == body.medium_at(depths[k])]
        if k > 0 and len(own) < 2:
            return 0.0, float(max((abs(depths[i] - depths[k]) for i in own), default=0.0)) / 2
        return _highest_between(depths, below.highest, k)
    interval = float(max(depths[k] - depths[k - 1], depths[k + 1] - depths[k]))
    order = min(interval / (_WIDE * float(depths[k])), 1.0) ** 2
    return _RISE * float(below.max_von_mises - below.highest[k]), _DEPTH * order * interval


def _highest_between(depths: FloatArray, highest: FloatArray, k: int) -> tuple[float, float]:
    """Return the rise of a parabola through the highest stress and its neighbours above that stress [Pa], and half of
    the wider interval next to its depth [m]."""
    if k == 0:
        return 0.0, float(depths[1] - depths[0]) / 2
    z, s = depths[k - 1 : k + 2] - depths[k], highest[k - 1 : k + 2] - highest[k]
    bend, slope = np.polyfit(z, s, 2)[:2] if np.ptp(s) > 0 else (0.0, 0.0)
    rise = -slope * slope / (4 * bend) if bend < 0 else 0.0
    return float(rise), float(max(-z[0], z[2])) / 2


def _extrapolated(depths: FloatArray, highest: FloatArray, interface: float) -> float:
    """Return the highest stress at an interface, extrapolated from two depths on either side [Pa]: stress jumps there,
    and its highest may lie between depths."""
    found = 0.0
    for side in (np.flatnonzero(depths <= interface)[-2:], np.flatnonzero(depths >= interface)[:2]):
        if len(side) == 2:
            (a, b), (one, other) = depths[side], highest[side]
            found = max(found, one + (other - one) * (interface - a) / (b - a))
    return float(found)
