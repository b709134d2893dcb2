"""What the next solve can use of a point film, and what is recomputed of a film's own pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.point import loops
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import flows
from bem.lubrication.point.newton import State, balance, own_film, partly_filled
from bem.lubrication.point.setting import Setting

AROUND = 4
"""Cells on either side that the central film is interpolated from."""
OVERSHOT = 0.5
"""Of the lowest of them, what it lies above unless their spline overshoots."""
ASYMPTOTIC = 0.2
"""Relative difference up to which it is of second order."""
PASSING = (0.05, 0.15)
"""Of what either film changes by, what is left of the central and of the minimum film at least."""
RECTANGLE, REACH_POWER, LARGEST_REACH = 0.004, 5, 2.0
"""Relative error of films on the default rectangle, and the power of its reach that the error falls with, from half to
twice as far: of 11 random films on rectangles of 0.7 to 3 times the default, along an axis up to 0.24 % on the default
one, at an angle up to 0.67 % (`tests/lubrication/point/test_rectangle.py`)."""
NARROW = 0.12
"""Of a minimum, its error over (r - 1)^2/r where beside the lowest cell the film is r times as thick: a ball at 6 mm/s
was off by 15, 7 and 2 % where r was 4.1, 2.4 and 1.6."""


@dataclass(frozen=True)
class KeptPoint:
    """Setting, grid and state of a film."""

    setting: Setting
    level: Level
    state: State


@dataclass(frozen=True)
class Certificate:
    """Of a pressure and H0 alone: the film, the largest relative error of cells and load, differences in oil through
    lines across, load over M."""

    film: FloatArray
    residual: float
    mass: float
    load: float


def certificate(level: Level, pressure: FloatArray, datum: float) -> Certificate:
    """Everything anew from pressures >= 0 and H0."""
    film = own_film(level, pressure, datum)
    if not film.min() > 0:
        return Certificate(film, np.inf, np.inf, np.nan)
    at = balance(level, State(pressure, film, datum), np.zeros(level.shape))
    total = level.problem.load
    share = at.load / total
    residual = max(float(np.abs(at.wrong).max()), abs(share))
    # a cell without pressure whose balance is negative is free: it is among the wrong ones
    return Certificate(film, residual, at.mass, level.problem.wanted(datum)[0] / total + share)


def film_fraction(level: Level, pressure: FloatArray, film: FloatArray) -> FloatArray:
    """Share of the gap filled (nx, ny): where it is full oil flows as solved for, behind it goes on with what comes
    in (Jakobsson and Floberg 1957, Olsson 1965)."""
    flow, stencil = flows(level, pressure, film)
    if level.problem.layer is not None:
        content = partly_filled(level, pressure, flow, stencil)[1]
        return np.minimum(content / stencil[8], 1.0)
    full = pressure > 0
    share = np.ones(level.shape)
    loops.carry_on(flow, stencil[8], full, level.problem.drag, level.spacing, share)
    return share


def film_errors(
    films: tuple[float, float], coarse: tuple[float, float], thickness: FloatArray, setting: Setting
) -> tuple[float, float]:
    """Estimates of the errors of central and minimum film: of the rectangle (`rectangle_error`), and of the cells, from
    films on half as many: of second order a third of
    the difference is left (`order_missed`), and a share of what the other film changes by, since a difference may pass
    zero. Where cells do not resolve the constriction (nx, ny), no order shows, and the minimum's is by how steep it
    is."""
    differences = [abs(a - b) for a, b in zip(films, coarse, strict=True)]
    changed = max(one / value for one, value in zip(differences, films, strict=True))
    central, least = (
        one / 3 * order_missed(one, value) + share * changed * value
        for one, value, share in zip(differences, films, PASSING, strict=True)
    )
    ends = rectangle_error(setting)
    return central + ends * films[0], max(least, narrow_error(thickness) * films[1]) + ends * films[1]


def rectangle_error(setting: Setting) -> float:
    """Relative error of films by where the grid begins; up to twice as large where the flow is oblique to its axes."""
    reach, (along, across) = min(max(setting.reach, 1 / LARGEST_REACH), LARGEST_REACH), setting.problem.drag
    return RECTANGLE * (1 + 2 * along * across) * reach**-REACH_POWER


def narrow_error(thickness: FloatArray) -> float:
    """Relative error of a minimum by how steep its constriction is on the cells, of a film (nx, ny)."""
    rise = rise_beside_lowest(thickness)
    return NARROW * (rise - 1) ** 2 / rise


def order_missed(difference: float, value: float) -> float:
    """1 where a difference to half as many cells is small enough to be of second order, so that a third of it is left;
    up to 3 where it is not and all of it may be."""
    return min(max(abs(difference / (ASYMPTOTIC * value)), 1.0), 3.0) if value else 3.0


def central_film(level: Level, film: FloatArray) -> float:
    """At the origin, by the cubic spline (without a knot beside its ends) through the cells around it; by that through
    their logarithms where it falls far below them and the bodies, undeformed, would overlap there: a contact of a cell,
    whose film the spline would have below zero."""
    i, j = (int(np.clip(np.searchsorted(a, 0.0), AROUND, len(a) - AROUND)) for a in (level.x, level.y))
    near, nearest = np.s_[i - AROUND : i + AROUND, j - AROUND : j + AROUND], np.s_[i - 1 : i + 1, j - 1 : j + 1]
    along, across, around = _at_origin(level.x[near[0]]), _at_origin(level.y[near[1]]), film[near]
    value, lowest = float(along @ around @ across), float(around.min())
    apart = bool((film[nearest] > level.gap[nearest]).all())
    return value if apart or value > OVERSHOT * lowest or not lowest > 0 else math.exp(along @ np.log(around) @ across)


def _at_origin(x: FloatArray) -> FloatArray:
    """Weights (n,) of values at abscissae (n,) in their cubic spline at 0."""
    size = x[-1] - x[0]
    places = np.append(x, 0.0)[:, None] / size
    # powers, and one cubic from each knot on
    basis = np.hstack([places ** np.arange(4), np.maximum(places - x[2:-2] / size, 0.0) ** 3])
    return np.asarray(np.linalg.solve(basis[:-1].T, basis[-1]))


def least_film(film: FloatArray) -> float:
    """Smallest value of the paraboloid through the logarithms of the lowest cell and those around it: one through the
    films themselves overshot narrow constrictions, below zero even (three times the error of the lowest cell's own)."""
    nx, ny = film.shape
    i, j = np.unravel_index(int(film.argmin()), film.shape)
    if not (0 < i < nx - 1 and 0 < j < ny - 1 and film[i, j] > 0):
        return float(film[i, j])
    f = np.log(film[i - 1 : i + 2, j - 1 : j + 2] / film[i, j])
    slope = 0.5 * np.array([f[2, 1] - f[0, 1], f[1, 2] - f[1, 0]])
    cross = 0.25 * (f[2, 2] + f[0, 0] - f[2, 0] - f[0, 2])
    curve = np.array([[f[2, 1] + f[0, 1], cross], [cross, f[1, 2] + f[1, 0]]])
    if np.linalg.eigvalsh(curve)[0] <= 0:
        return float(film[i, j])
    step = np.clip(-np.linalg.solve(curve, slope), -1, 1)
    return float(film[i, j] * np.exp(min(slope @ step + 0.5 * step @ curve @ step, 0.0)))


def rise_beside_lowest(film: FloatArray) -> float:
    """Largest film of the four cells around the lowest one, over that."""
    i, j = (int(k) for k in np.unravel_index(int(film.argmin()), film.shape))
    beside = film[max(i - 1, 0) : i + 2, j].max(), film[i, max(j - 1, 0) : j + 2].max()
    return float(max(beside) / film[i, j])
