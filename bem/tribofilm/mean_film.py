"""Growth of a tribofilm of uniform mean thickness: contact, growth and wear together (thesis, paper E)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import InputError
from bem.grid import FloatArray
from bem.notes import Note
from bem.representation import tabled
from bem.tribofilm.balance import FilmBalance
from bem.tribofilm.contact_growth import (
    ContactSample,
    FilmContact,
    GrowthTable,
    notes_on_growth,
    solve_film_contact,
)
from bem.tribofilm.evolution import FilmHistory, evolve_film, steady_thickness
from bem.tribofilm.growth import GrowthLaw
from bem.tribofilm.properties import PropertyLaw


@tabled
@dataclass(frozen=True, eq=False)
class TribofilmGrowth:
    """Result of the growth of a film.

    history : thickness, growth, wear and substrate wear over the times asked for.
    contacts : all contacts that were solved, by increasing thickness; those of single evaluations (`reuse_tolerance`
        0) without maps.
    film_map : local thickness at the end (nx, ny) [m].
    steady : thickness at which growth and wear balance [m]; infinite where growth still exceeds wear at 1.02 times the
        largest thickness of the history.
    notes : on arguments outside their usual ranges.
    """

    history: FilmHistory
    contacts: tuple[ContactSample, ...]
    film_map: FloatArray
    steady: float
    notes: tuple[Note, ...] = ()

    @property
    def contacts_solved(self) -> int:
        """Number of contacts solved."""
        return len(self.contacts)

    @property
    def samples(self) -> tuple[ContactSample, ...]:
        """Contacts solved, as in `LocalFilm`."""
        return self.contacts

    @property
    def steady_thickness(self) -> float | None:
        """Thickness at which growth and wear balance [m]; None where the history does not come that far."""
        return None if math.isinf(self.steady) else self.steady

    @property
    def film_pressure(self) -> FloatArray:
        """Pressure (nx, ny) of the contact whose film is nearest to that at the end [Pa], among those with maps."""
        with_maps = [contact for contact in self.contacts if contact.pressure.size]
        return min(with_maps, key=lambda one: abs(one.thickness - self.history.thickness[-1])).pressure

    def wear_depth(self, start: float, end: float) -> float:
        """Depth of substrate worn between two times [s], within those of the history [m]."""
        return self.history.wear_depth(start, end)

    def __repr__(self) -> str:
        return (
            f"TribofilmGrowth({1e9 * self.history.thickness[-1]:.3g} nm after {self.history.time[-1]:.4g} s, "
            f"{len(self.contacts)} contacts solved)"
        )


def grow_tribofilm(
    times: FloatArray,
    contact: FilmContact,
    *,
    wear_coefficient: float,
    lag: float = 0.0,
    concentration_constant: float = math.inf,
    initial_thickness: float = 0.0,
    reuse_tolerance: float = 2e-3,
    tolerance: float = 1e-6,
    callback: Callable[[ContactSample], None] | None = None,
    known: Sequence[ContactSample] = (),
) -> TribofilmGrowth:
    """Grow a film in a contact (thesis, paper E, fig. 3, as a differential equation instead of a loop of samples).

    Parameters
    ----------
    times : increasing, from the start of rubbing [s]; in cycles where the rates are per cycle. The film's map is
        integrated over these times, and is only as good as they resolve growth and wear (`film_map`).
    contact : where it grows.
    wear_coefficient : alpha [1/s].
    lag : delay of the film's wear [s].
    concentration_constant : C1 [1/m], infinite for no substrate wear.
    initial_thickness : [m].
    reuse_tolerance : relative error of growth that is accepted from reusing contacts; 0 solves one at every evaluation.
    tolerance : of the time integration.
    callback : called with every contact as it is solved.
    known : contacts of an interrupted growth of the same film, in the order of the callback: they are not solved again,
        and the result has the same bits.

    Raises
    ------
    InputError : values out of range; a load beyond hardness times area (InfeasibleError).
    ConvergenceError : contact or time integration did not converge.
    """
    if not 0 <= reuse_tolerance < 1:
        raise InputError(f"reuse_tolerance {reuse_tolerance!r} must be >= 0 and below 1")

    stored = iter(known)

    def sample(thickness: float, last: ContactSample | None) -> ContactSample:
        before = next(stored, None)
        if before is not None:
            if before.thickness != thickness:
                raise InputError(f"known: a contact under {before.thickness:.6g} m of film where {thickness:.6g} m is")
            return before
        found = solve_film_contact(contact, thickness, None if last is None else last.pressure)
        if callback is not None:
            callback(found)
        return found

    single: list[ContactSample] = []

    def growth_of_contact(thickness: float) -> float:
        found = sample(thickness, None)
        single.append(found.without_maps())
        return found.growth

    table = GrowthTable(sample, tolerance=reuse_tolerance)
    growth = table if reuse_tolerance > 0 else growth_of_contact
    history = evolve_film(
        times,
        growth,
        wear_coefficient=wear_coefficient,
        lag=lag,
        concentration_constant=concentration_constant,
        initial_thickness=initial_thickness,
        tolerance=tolerance,
    )
    local = film_map(history, table, wear_coefficient, lag, initial_thickness)
    steady = steady_thickness(growth, wear_coefficient, longest=_reach(history))
    return TribofilmGrowth(
        history=history,
        contacts=tuple(sorted([*table.samples, *single], key=lambda contact: contact.thickness)),
        film_map=local,
        steady=steady,
        notes=notes_on_growth(contact, wear_coefficient, initial_thickness),
    )


def softest_film(
    hardness: PropertyLaw, growth: GrowthLaw, balance: FilmBalance, friction: float, temperature: float, duration: float
) -> float:
    """Return a lower bound of the hardness [Pa] of a film in a time [s] at a temperature [K].

    The pressure is at most the highest hardness at any thickness, and contacts are solved up to twice the thickness of
    the film.
    """
    fastest = float(growth.rate(np.array(friction * hardness.highest(temperature)), temperature))
    return hardness.lowest(2 * balance.thickest(fastest, duration), temperature)


def film_map(
    history: FilmHistory, table: GrowthTable, wear_coefficient: float, lag: float, initial_thickness: float
) -> FloatArray:
    """Return the local thickness (nx, ny) at the last time [m].

    Local growth and wear are linear once the mean thickness over time is known, so each point is the convolution of its
    own growth with the survival K(t) of grown film: exp(-alpha t), or with a delay the fundamental solution of the
    delay equation. The weights in time are collected per solved contact, so that each map is added once.

    The mean thickness is taken as linear between the times of the history, and each interval has four Gauss points: the
    times must resolve the growth and the time 1 / alpha of wear.
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    halves = 0.5 * np.diff(history.time)[:, None]
    when = (0.5 * (history.time[:-1] + history.time[1:])[:, None] + halves * nodes).ravel()
    thicknesses = np.interp(when, history.time, history.thickness)
    kept = (halves * weights).ravel() * survival(history.time[-1] - when, wear_coefficient, lag)
    total: dict[float, float] = {}
    for thickness, part in zip(thicknesses.tolist(), kept.tolist(), strict=True):
        for sample, fraction in table.weights(thickness):
            total[sample.thickness] = total.get(sample.thickness, 0.0) + part * fraction
    remains = initial_thickness * float(survival(history.time[-1] - history.time[0], wear_coefficient, lag))
    result = np.full(table.samples[0].growth_map.shape, max(remains, 0.0))
    for sample in table.samples:
        weight = total.get(sample.thickness, 0.0)
        if weight:
            result += weight * sample.growth_map
    return np.maximum(result, 0.0)


def survival(times: ArrayLike, wear_coefficient: float, lag: float) -> FloatArray:
    """Return the fraction of film left after times [s] of wear: the solution of K' = -alpha K(t - lag), K(0) = 1,
    K(<0) = 0.

    Method of steps: over each lag K is a polynomial of the time since the start of that lag, and its derivative is that
    of the lag before. Coefficients of order j fall as |z|^j / j!, with z + alpha lag exp(-z) = 0 for the slowest decay,
    and those beyond `_ORDERS` are left out. For alpha lag > pi/2 the solution oscillates with an amplitude that grows,
    which no film does: K counts as zero where it exceeds `_UNSTABLE`, and in the lags thereafter.
    """
    when = np.asarray(times, dtype=np.float64)
    if lag <= 0:
        return np.exp(-wear_coefficient * when)
    lags = when / lag
    index = np.maximum(np.floor(lags), 0).astype(int)
    divisors = -wear_coefficient * lag / np.arange(1, _ORDERS)
    coefficients = np.zeros((int(index.max(initial=0)) + 1, _ORDERS))
    coefficients[0, 0] = 1.0
    for before, after in pairwise(coefficients):
        after[0] = before.sum()
        if abs(after[0]) > _UNSTABLE:
            after[0] = 0.0
            break
        after[1:] = before[:-1] * divisors
    powers = (lags - index)[..., None] ** np.arange(_ORDERS)
    left = np.where(lags < 0, 0.0, (coefficients[index] * powers).sum(axis=-1))
    return np.where(np.abs(left) > _UNSTABLE, 0.0, left)


_ORDERS = 40
"""Number of coefficients of the polynomial over one lag: 2^40 / 40! is 1e-36."""

_UNSTABLE = 1e3
"""Largest fraction of film left: beyond it the delay equation has no film as its solution."""


def _reach(history: FilmHistory) -> float:
    """Return the upper end of the search for a balance, slightly above the largest thickness [m]."""
    return float(history.thickness.max()) * 1.02 + 1e-12
