"""Error bars of the highest stresses of a coating: across each interface, and in each layer.

The coarser solution is the pressure on the grid of twice the cell, at the same depths. Errors that do not show in the
difference: the highest stress lies between points, and between depths; at the edge of the contact the law of a straight
edge (`bem.stress.edge_tension`) misses the same on both grids.

Verified in tests/accuracy/test_coating_bars.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.accuracy.bars import DEPTHS, GRID, ErrorBars
from bem.accuracy.coarsened import Coarser, ContactCase, edge_fraction, regime_of, widest_cell
from bem.accuracy.contact import peak_rise, touches_sharply
from bem.accuracy.edge import EDGE
from bem.accuracy.richardson import Table, rows
from bem.grid import FloatArray
from bem.materials import Body
from bem.notes.accuracy import NoBar, no_error_bar
from bem.stress import (
    CoatingMaxima,
    DepthMaxima,
    StressSummary,
    coating_maxima,
    highest_principal,
    subsurface_stress,
    von_mises,
)

ACROSS, INSIDE = ("interface_max_shear", "interface_max_tension"), ("layer_max_von_mises", "layer_max_tension")
SUBSTRATE = "substrate_max_von_mises"
NAMES = (*ACROSS, *INSIDE)
RULES = Table(
    "coating_error_bars",
    rows(
        "interface_max_shear",
        (0.45, 0.67, 0.5),
        "Second order below the surface; interfaces may lie less than a cell below it. Less than 0.7 cells below it the"
        " shear under the steps of the pressure between cells, which no centre has, counts most.",
        edge=(0.006, 0.01),
        surface=0.15,
        peak=1.0,
        steps=10.0,
    ),
    rows(
        "interface_max_tension",
        (1.2, 1.8, 1.2),
        "Tension lies beside the contact, where it is a small difference of what the spots around it cause: a "
        "thousandth of the shear stress. Less than a cell below the surface waves of two cells add to it.",
        edge=0.02,
        surface=0.2,
        peak=1.5,
        shear=0.001,
        waves=1.0,
    ),
    rows(
        "layer_max_von_mises",
        (0.4, 0.5, 0.67),
        "Second order below the surface.",
        edge=0.008,
        surface=0.15,
        peak=1.0,
    ),
    rows(
        "layer_max_tension",
        (0.75, 1.0, 1.0),
        "Second order below the surface, first order near it. At the edge of the contact `EDGE` counts.",
        order=1,
        edge=(0.01, 0.02, 0.07),
        surface=0.25,
        peak=1.0,
        pressed=0.02,
    ),
)
"""Factors on the difference, and floors: on the stress times the fraction within a cell of the edge, of all contacts
(edge) and of stresses less than a cell below the surface (surface), on the shear stress times that fraction (shear),
on the rise between points (peak), on what smoothing of waves of two cells takes off (waves), on the shear stress times
exp(-2 pi depth / cell) where pressures are constant on cells (steps), and, less than a cell below the surface, on the
pressure next to the edge (pressed).

Pressures that are constant on cells have waves of the length of a cell, whose shear stress is zero below the centres
and falls as exp(-2 pi depth / cell). Of cylinders and balls on one layer of 0.35 and 2.5 times the substrate's modulus,
0.3 to 0.7 cells thick, the highest shear at the centres is too low by 4 to 12 times that factor.
"""

_STEEPER = 3.0
"""Factor on the rise of a straight line through two depths to an end of their layer: tension steepens towards the edge
of the contact."""
_AT_END = 2e-3
"""Distance of a depth from an end of its layer, over the thickness, up to which it is at the end."""
_FAR = 0.5
"""Stress of a depth over the highest of its layer, below which its peak between points is no candidate."""

_FIELDS = {
    "interface_max_shear": "shear",
    "interface_max_tension": "tension",
    "layer_max_von_mises": "von_mises",
    "layer_max_tension": "principal",
}
"""Fields of `DepthMaxima` from which figures are."""


def coating_bars(
    case: ContactCase, coarser: Coarser, body: Body, below: StressSummary, friction: float = 0.0
) -> ErrorBars:
    """Return error bars of the stresses of layers and interfaces, arrays with the outermost first.

    A layer's highest stress is as wrong as that of its depth, or as another depth may be higher.

    Parameters
    ----------
    case, coarser : contact and its coarser solution.
    body, friction : as `bem.stress.summarise_stress` takes them.
    below : summary of the stresses of the contact, with components.
    """
    assert below.stress is not None
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars(dict.fromkeys((*NAMES, SUBSTRATE)))
    own = coating_maxima(below.stress, below.von_mises, below.depths, case.solution.pressure, case.grid, body, friction)
    maxima = own.highest
    there = subsurface_stress(coarser.solution.pressure, coarser.grid, body, maxima.depths, friction=friction)
    coarse = coating_maxima(
        there, von_mises(there), maxima.depths, coarser.solution.pressure, coarser.grid, body, friction
    )
    at_depths = _errors_at_depths(case, below, own, coarse, body)
    near = maxima.depths < widest_cell(case.grid)
    reason = _no_limit(case)
    if reason is not None:
        at_depths = {name: np.where(near, np.nan, error) for name, error in at_depths.items()}
    interfaces = _nearest(maxima.depths, body)
    grid = {name: at_depths[name][interfaces] for name in ACROSS}
    for name in INSIDE:
        values = getattr(maxima, _FIELDS[name])
        grid[name] = np.array([_of_highest(values[own], at_depths[name][own]) for own in _layers(maxima.depths, body)])
    bars = ErrorBars.together({GRID: grid, DEPTHS: _between_depths(maxima, body)})
    bars |= _substrate_bars(case, coarser, body, below, friction)
    lost = [name for name in (*NAMES, SUBSTRATE) if reason is not None and np.isnan(bars.values.get(name, 0.0)).any()]
    notes = () if reason is None or not lost else (no_error_bar(lost, reason),)
    return ErrorBars(bars.values, notes, bars.parts)


def _substrate_bars(
    case: ContactCase, coarser: Coarser, body: Body, below: StressSummary, friction: float
) -> ErrorBars:
    """Return the error bar of the highest von Mises stress below the layers, by the rule of that in layers; none
    without a depth there."""
    name, beneath = "layer_max_von_mises", np.flatnonzero(below.depths > body.interfaces[-1])
    if not beneath.size or coarser.solution is None or coarser.grid is None:
        return ErrorBars()
    depths, values = below.depths[beneath], below.highest[beneath]
    k = int(np.argmax(values))
    plane, value, depth = below.von_mises[beneath[k]], float(values[k]), float(depths[k])
    there = subsurface_stress(coarser.solution.pressure, coarser.grid, body, np.array([depth]), friction=friction)
    near, edge = depth < widest_cell(case.grid), edge_fraction(case) * value
    indicators = {"edge": {name: edge}, "surface": {name: edge if near else 0.0}}
    indicators["peak"] = {name: peak_rise(plane, case.grid)}
    coarse = {name: float(von_mises(there).max())}
    errors = RULES.errors({name: value}, coarse, indicators, regime=regime_of(case))
    error = math.nan if near and _no_limit(case) is not None else float(errors[name])
    rise = _rise_in_layer(depths, values, (body.interfaces[-1], float(depths[-1])))
    return ErrorBars.together({GRID: {SUBSTRATE: error}, DEPTHS: {SUBSTRATE: rise}})


def with_one_estimate(bars: ErrorBars, below: StressSummary, body: Body) -> ErrorBars:
    """Return the bars with one error for the highest von Mises stress of all and for that of its layer, or of the body
    below: the larger of both, as they are the same stress."""
    medium, layers = body.medium_at(below.most_stressed_depth), len(body.layers)
    name = SUBSTRATE if medium == layers else "layer_max_von_mises"
    own, whole = bars.values.get(name), bars.values.get("max_von_mises")
    if own is None or whole is None:
        return bars
    larger = _entry(own, medium, layers) < float(whole)
    parts = {}
    for origin, part in bars.parts.items():
        changed = dict(part)
        if larger:
            changed[name] = _with_entry(part.get(name, own * 0.0), medium, layers, part.get("max_von_mises", 0.0))
        else:
            changed["max_von_mises"] = _entry(part.get(name, own * 0.0), medium, layers)
        parts[origin] = changed
    values = dict(bars.values)
    if larger:
        values[name] = _with_entry(own, medium, layers, whole)
    else:
        values["max_von_mises"] = _entry(own, medium, layers)
    return ErrorBars(values, bars.notes, parts)


def _entry(errors: Any, medium: int, layers: int) -> float:
    """Return the error of a medium: of the body below a number, of layers an entry of an array."""
    return float(errors if medium == layers else errors[medium])


def _with_entry(errors: Any, medium: int, layers: int, error: Any) -> Any:
    """Return the errors with that of a medium replaced; see `_entry`."""
    if medium == layers:
        return float(error)
    changed = np.array(errors, dtype=np.float64)
    changed[medium] = error
    return changed


def _errors_at_depths(
    case: ContactCase, below: StressSummary, fine: CoatingMaxima, coarse: CoatingMaxima, body: Body
) -> dict[str, FloatArray]:
    """Return the errors of the grid at each depth (nz,) [Pa], by the figures that they are for."""
    regime, depths = regime_of(case), fine.highest.depths
    near = depths < widest_cell(case.grid)
    found, other = ({name: getattr(one.highest, field) for name, field in _FIELDS.items()} for one in (fine, coarse))
    edge = {name: edge_fraction(case) * value for name, value in found.items()}
    pressed = np.where(near, fine.edge.pressure, 0.0)
    indicators: dict[str, dict[str, Any]] = {
        "edge": edge,
        "surface": {name: np.where(near, value, 0.0) for name, value in edge.items()},
        "peak": _rises(case, below, fine.highest, body),
        "shear": {"interface_max_tension": edge["interface_max_shear"]},
        "waves": {"interface_max_tension": fine.of_points.tension - fine.smoothed},
        "steps": {"interface_max_shear": _steps(case, depths) * found["interface_max_shear"]},
        "pressed": {"layer_max_tension": pressed},
    }
    errors: dict[str, FloatArray] = RULES.errors(found, other, indicators, regime=regime)
    at_edge = (
        ("layer_max_tension", fine.edge.tension - fine.of_points.principal[0], fine.edge.pressure),
        ("layer_max_von_mises", fine.edge.von_mises - fine.of_points.von_mises[0], fine.edge.von_mises_pressure),
    )
    for name, cusp, next_to_edge in at_edge:
        if cusp > 0:
            sizes = {"cusp": float(cusp), "pressed": next_to_edge, "edge": edge[name][0]}
            errors[name][0] = EDGE.error(found[name][0] - other[name][0], sizes, regime)
    return errors


def _steps(case: ContactCase, depths: FloatArray) -> FloatArray:
    """Return what is left at each depth (nz,) of waves of the length of a cell; zero on grids whose pressures are sums
    of longer waves."""
    if all(case.grid.periodic):
        return np.zeros_like(depths)
    cell = max(d for d, count in zip(case.grid.spacing, case.grid.shape, strict=True) if count > 1)
    return np.asarray(np.exp(-2 * np.pi * depths / cell))


def _of_highest(values: FloatArray, errors: FloatArray) -> float:
    """Return the error of the highest of several values with errors; not a number where it has none."""
    own = float(errors[np.argmax(values)]) if len(values) else math.nan
    return own if math.isnan(own) else max(own, float(np.nanmax(values + errors) - values.max()))


def _rises(case: ContactCase, below: StressSummary, maxima: DepthMaxima, body: Body) -> dict[str, FloatArray]:
    """Return the rises of paraboloids through the highest points of each depth above these points (nz,) [Pa]."""
    stress, depths = below.stress, maxima.depths
    assert stress is not None
    planes: dict[str, Callable[[int], FloatArray]] = {
        "interface_max_shear": lambda k: np.hypot(stress[3, k], stress[4, k]),
        "interface_max_tension": lambda k: np.maximum(stress[2, k], 0.0),
        "layer_max_von_mises": lambda k: below.von_mises[k],
        "layer_max_tension": lambda k: highest_principal(stress[:, k]),
    }
    rises = {name: np.zeros(len(depths)) for name in planes}
    for name in ACROSS:
        for k in _nearest(depths, body).tolist():
            rises[name][k] = peak_rise(planes[name](k), case.grid)
    for name in INSIDE:
        values = getattr(maxima, _FIELDS[name])
        for own in _layers(depths, body):
            for k in own[values[own] > _FAR * values[own].max(initial=0.0)].tolist():
                rises[name][k] = peak_rise(planes[name](k), case.grid)
    return rises


def _nearest(depths: FloatArray, body: Body) -> NDArray[np.intp]:
    """Return the numbers of the depths nearest to the interfaces."""
    return np.array([int(np.argmin(np.abs(depths - interface))) for interface in body.interfaces])


def _layers(depths: FloatArray, body: Body) -> list[NDArray[np.intp]]:
    """Return the numbers of the depths in each layer."""
    medium = np.array([body.medium_at(depth) for depth in depths.tolist()])
    return [np.flatnonzero(medium == number) for number in range(len(body.layers))]


def _between_depths(maxima: DepthMaxima, body: Body) -> dict[str, FloatArray]:
    """Return the errors that depths leave of each figure [Pa]."""
    ends = list(itertools.pairwise((0.0, *body.interfaces)))
    layers, errors = _layers(maxima.depths, body), {}
    for name in INSIDE:
        values = getattr(maxima, _FIELDS[name])
        rises = [_rise_in_layer(maxima.depths[own], values[own], end) for own, end in zip(layers, ends, strict=True)]
        errors[name] = np.array(rises)
    for name in ACROSS:
        values = getattr(maxima, _FIELDS[name])
        missed = [
            _off_interface(maxima.depths, values, interface, layer.thickness)
            for interface, layer in zip(body.interfaces, body.layers, strict=True)
        ]
        errors[name] = np.array(missed)
    return errors


def _rise_in_layer(depths: FloatArray, values: FloatArray, ends: tuple[float, float]) -> float:
    """Return by how much the stress in a layer between two ends [m] may be higher than at its depths [Pa].

    It is the rise of the parabola through three depths above the highest of them, or, towards an end without a depth,
    that of a straight line. Not a number with fewer than two depths.
    """
    if len(depths) < 2:
        return math.nan
    k, thickness = int(np.argmax(values)), ends[1] - ends[0]
    rise = 0.0
    if len(depths) > 2:
        first = min(max(k - 1, 0), len(depths) - 3)
        rise = _parabola_rise(depths[first : first + 3], values[first : first + 3], k - first)
    for end, (near, next_one) in zip(ends, ((0, 1), (-1, -2)), strict=True):
        missing = abs(end - depths[near])
        if missing > _AT_END * thickness:
            slope = (values[near] - values[next_one]) / abs(depths[near] - depths[next_one])
            rise = max(rise, float(values[near] + _STEEPER * max(slope, 0.0) * missing - values[k]))
    return rise


def _parabola_rise(depths: FloatArray, values: FloatArray, k: int) -> float:
    """Return the rise of the parabola through three depths above the k-th, the highest, where it is next to it [Pa]."""
    z, s = (depths - depths[k]) / np.ptp(depths), values - values[k]
    bend, slope = np.polyfit(z, s, 2)[:2] if np.ptp(s) > 0 else (0.0, 0.0)
    if not bend < 0:
        return 0.0
    top = -slope / (2 * bend)
    return float(-slope * slope / (4 * bend)) if z[0] <= top <= z[-1] else 0.0


def _off_interface(depths: FloatArray, values: FloatArray, interface: float, thickness: float) -> float:
    """Return how far the stress across an interface may be from that of the nearest depth [Pa]: it is continuous."""
    nearest = int(np.argmin(np.abs(depths - interface)))
    missing = abs(float(depths[nearest]) - interface)
    if missing <= _AT_END * thickness:
        return 0.0
    beside = [k for k in (nearest - 1, nearest + 1) if 0 <= k < len(depths)]
    if not beside:
        return math.nan
    slopes = [abs(values[k] - values[nearest]) / abs(depths[k] - depths[nearest]) for k in beside]
    return float(_STEEPER * max(slopes) * missing)


def _no_limit(case: ContactCase) -> NoBar | None:
    """Return the reason why stresses less than a cell below the surface have no limit: it touches sharply, or pressures
    are at the hardness; None where they have one."""
    if case.hardness is not None and (case.solution.pressure >= case.hardness).any():
        return NoBar.STRESS_OF_CAPPED
    return NoBar.STRESS_OF_SHARP if touches_sharply(case) else None
