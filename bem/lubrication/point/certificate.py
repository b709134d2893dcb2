"""Judgement of a point film by its pressures and H0 alone: residuals, characteristic films, error estimates.

1. `certify` recomputes films and all residuals from the pressures and H0 that the result shows; it decides whether a
   film is converged.
2. `central_film` and `minimum_film` interpolate between cells.
3. `film_errors` estimates their discretisation errors by Richardson extrapolation from the grid of half as many cells.

Cost: one convolution and one evaluation of the residuals.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.point import cavitation
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.linear_system import BoolArray
from bem.lubrication.point.newton import PointFilmState, Residual, fill_partially, residual_of
from bem.lubrication.point.problem import ScaledCase

AROUND = 4
"""Cells on either side of the origin that the central film is interpolated from."""
OVERSHOOT = 0.5
"""Ratio of the central film to the lowest cell around it below which the spline may have overshot."""
ASYMPTOTIC = 0.2
"""Relative difference of two grids up to which films are taken to be of second order."""
ZERO_CROSSING = (0.05, 0.15)
"""Smallest errors of central and of minimum film, over the relative change of either film between both grids."""
RECTANGLE, EXTENT_POWER, LARGEST_EXTENT = 0.004, 5, 2.0
"""Relative error of films by the default rectangle, and the power of its relative extent with which the error falls,
for extents from half to twice the default: of 11 random films on rectangles of 0.7 to 3 times the default the error is
up to 0.24 % with entrainment along an axis, up to 0.67 % at an angle (tests/lubrication/point/test_rectangle.py)."""
NARROW = 0.12
"""Relative error of the minimum film over (r - 1)^2/r, r the ratio of the film beside the lowest cell to that cell's: a
ball at 6 mm/s has errors of 15, 7 and 2 % with r 4.1, 2.4 and 1.6."""


@dataclass(frozen=True)
class SolvedPointCase:
    """Grid solution behind a result, for resampling, error bars and warm starts.

    case : the case in similarity variables.
    level : the grid.
    state : pressures, film and H0 on it.
    """

    case: ScaledCase
    level: GridLevel
    state: PointFilmState


@dataclass(frozen=True)
class Certificate:
    """Residuals recomputed from pressures and H0.

    film : (nx, ny) of the pressure.
    contact : (nx, ny) cells where the whole pressure exceeds the oil's.
    residual : largest relative residual of cells, load and complementarity.
    complementarity : largest violation of the film's bound, over the least film; zero of a problem without contact.
    mass : largest difference of flow through lines across the flow, over the throughput.
    load : load carried over M.
    sound : whether films are positive and surfaces do not touch on outermost cells.
    admissible : whether neither the oil's nor the contact's pressure is negative.
    """

    film: FloatArray
    contact: BoolArray
    residual: float
    complementarity: float
    mass: float
    load: float
    sound: bool
    admissible: bool

    def meets(self, tolerance: float) -> bool:
        """Return True if the state solves the equations to a tolerance."""
        return self.sound and self.admissible and max(self.residual, self.mass) <= tolerance


def certify(level: GridLevel, state: PointFilmState) -> Certificate:
    """Recompute film, contact and residuals from the pressures and H0 of a state.

    Residuals of a state that is not sound are those with its own film where surfaces may touch, and infinite else.
    """
    least = level.problem.least_film
    film = level.film(state.pressure, state.separation)
    contact = state.pressure > state.oil_pressure
    sound = bool(film.min() > 0) and not bool((contact & level.boundary).any())
    complementarity = 0.0
    if least is not None:
        violation = np.where(contact, np.abs(film - least), np.maximum(least - film, 0.0))
        complementarity = float(violation.max()) / least
    elif not sound:
        return Certificate(film, contact, np.inf, 0.0, np.inf, np.nan, sound, admissible=True)
    shown = replace(state, film=film if sound else state.film, contact=contact & ~level.boundary)
    at: Residual = residual_of(level, shown, np.zeros(level.shape))
    total = level.problem.load
    missing = at.load / total
    # a cell without pressure whose balance is negative is free, so the balance counts
    residual = max(float(np.abs(at.relative_balance).max()), abs(missing), complementarity)
    load = level.problem.required_load(state.separation)[0] / total + missing
    negative = float(np.minimum(state.oil_pressure, state.pressure - state.oil_pressure).min()) < 0
    return Certificate(shown.film, contact, residual, complementarity, at.mass, load, sound, not negative)


def film_fraction(level: GridLevel, pressure: FloatArray, film: FloatArray) -> FloatArray:
    """Return the share of the gap (nx, ny) that is filled with oil (Jakobsson and Floberg 1957, Olsson 1965)."""
    flux, derivatives = level.flux(pressure, film)
    if level.problem.layer is not None:
        content = fill_partially(level, pressure, flux, derivatives)[1]
        return np.minimum(content / derivatives[8], 1.0)
    return swift_stieber_fraction(level, flux, derivatives, pressure)


def swift_stieber_fraction(
    level: GridLevel, flux: FloatArray, derivatives: FloatArray, pressure: FloatArray
) -> FloatArray:
    """Return the film fraction (nx, ny) that follows from a flux with Swift and Stieber's condition."""
    fraction = np.ones(level.shape)
    cavitation.film_fraction(flux, derivatives[8], pressure > 0, level.problem.entrainment, level.spacing, fraction)
    return fraction


# ---- characteristic films


def central_film(level: GridLevel, film: FloatArray) -> float:
    """Return the film at the origin, by a cubic spline (not-a-knot) through the cells around it.

    The spline of the logarithms replaces it where it falls far below the cells and undeformed bodies would overlap
    there: a contact of about one cell, in which the spline of the films may be negative.
    """
    i, j = (int(np.clip(np.searchsorted(a, 0.0), AROUND, len(a) - AROUND)) for a in (level.x, level.y))
    near, nearest = np.s_[i - AROUND : i + AROUND, j - AROUND : j + AROUND], np.s_[i - 1 : i + 1, j - 1 : j + 1]
    along, across, around = _spline_weights(level.x[near[0]]), _spline_weights(level.y[near[1]]), film[near]
    value, lowest = float(along @ around @ across), float(around.min())
    apart = bool((film[nearest] > level.gap[nearest]).all())
    return value if apart or value > OVERSHOOT * lowest or not lowest > 0 else math.exp(along @ np.log(around) @ across)


def _spline_weights(x: FloatArray) -> FloatArray:
    """Return the weights (n,) of values at abscissae (n,) in their not-a-knot cubic spline at 0."""
    size = x[-1] - x[0]
    places = np.append(x, 0.0)[:, None] / size
    # powers, and a truncated cube from each knot on
    basis = np.hstack([places ** np.arange(4), np.maximum(places - x[2:-2] / size, 0.0) ** 3])
    return np.asarray(np.linalg.solve(basis[:-1].T, basis[-1]))


def minimum_film(film: FloatArray) -> float:
    """Return the minimum of the paraboloid through the logarithms of the lowest cell and its neighbours.

    A paraboloid through the films themselves overshoots narrow constrictions, even below zero, with three times the
    error of the lowest cell.
    """
    nx, ny = film.shape
    i, j = np.unravel_index(int(film.argmin()), film.shape)
    if not (0 < i < nx - 1 and 0 < j < ny - 1 and film[i, j] > 0):
        return float(film[i, j])
    f = np.log(film[i - 1 : i + 2, j - 1 : j + 2] / film[i, j])
    slope = 0.5 * np.array([f[2, 1] - f[0, 1], f[1, 2] - f[1, 0]])
    cross = 0.25 * (f[2, 2] + f[0, 0] - f[2, 0] - f[0, 2])
    hessian = np.array([[f[2, 1] + f[0, 1], cross], [cross, f[1, 2] + f[1, 0]]])
    if np.linalg.eigvalsh(hessian)[0] <= 0:
        return float(film[i, j])
    step = np.clip(-np.linalg.solve(hessian, slope), -1, 1)
    return float(film[i, j] * np.exp(min(slope @ step + 0.5 * step @ hessian @ step, 0.0)))


def constriction_steepness(film: FloatArray) -> float:
    """Return the largest film of the four cells around the lowest cell over that cell's."""
    i, j = (int(k) for k in np.unravel_index(int(film.argmin()), film.shape))
    beside = film[max(i - 1, 0) : i + 2, j].max(), film[i, max(j - 1, 0) : j + 2].max()
    return float(max(beside) / film[i, j])


# ---- error estimates


def film_errors(
    films: tuple[float, float], coarse: tuple[float, float], thickness: FloatArray, case: ScaledCase
) -> tuple[float, float]:
    """Return estimates of the errors of central and minimum film.

    1. Of second order, a third of the difference to half as many cells is left (`order_missed`).
    2. A share of the change of either film, since a difference may pass zero.
    3. Where cells do not resolve the constriction no order shows; the minimum's error follows from its steepness.
    4. The error of the rectangle is added.

    Parameters
    ----------
    films, coarse : (central, minimum) film, and on the coarser grid.
    thickness : (nx, ny) film.
    case : the case.
    """
    differences = [abs(a - b) for a, b in zip(films, coarse, strict=True)]
    changed = max(one / value for one, value in zip(differences, films, strict=True))
    central, least = (
        one / 3 * order_missed(one, value) + share * changed * value
        for one, value, share in zip(differences, films, ZERO_CROSSING, strict=True)
    )
    rectangle = rectangle_error(case)
    least = max(least, narrow_error(thickness) * films[1])
    return central + rectangle * films[0], least + rectangle * films[1]


def rectangle_error(case: ScaledCase) -> float:
    """Return the relative error of films by where the rectangle ends; twice as large for flow at 45 degrees."""
    extent = min(max(case.relative_extent, 1 / LARGEST_EXTENT), LARGEST_EXTENT)
    along, across = case.problem.entrainment
    return RECTANGLE * (1 + 2 * along * across) * extent**-EXTENT_POWER


def narrow_error(thickness: FloatArray) -> float:
    """Return the relative error of the minimum film by the steepness of its constriction on the cells (nx, ny)."""
    rise = constriction_steepness(thickness)
    return NARROW * (rise - 1) ** 2 / rise


def order_missed(difference: float, value: float) -> float:
    """Return the factor on a third of the difference to half as many cells: 1 of second order, up to 3 without order.

    A relative difference up to `ASYMPTOTIC` counts as second order.
    """
    return min(max(abs(difference / (ASYMPTOTIC * value)), 1.0), 3.0) if value else 3.0
