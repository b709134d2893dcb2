"""Tribofilm with local thickness: it raises the surface where it grows, which changes the next contact.

The mean film (`mean_film.grow_tribofilm`, as in the source) changes stiffness and hardness of the contact; the local
film changes the surface too. Per time step:

1. Predict the film of every cell with the growth at the start of the step; wear is integrated exactly, so no step makes
   a film negative (exponential trapezoidal rule ETD2RK, Cox and Matthews 2002).
2. Solve the contact under the surface raised by the predicted film, with stiffness and hardness of the mean predicted
   film over the cells in contact in the last step tried.
3. Correct the film with the mean growth. The difference to the prediction is the error; accept the step or shorten it.

Cost: one contact per step tried.

Knows the balance and the contact under a film; no scene. Verified in tests/tribofilm/test_local_film.py: order in time,
uniform films against the mean's equation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.errors import ConvergenceError
from bem.grid import FloatArray
from bem.notes import Note
from bem.tribofilm.balance import FilmBalance, checked_times
from bem.tribofilm.contact_growth import ContactSample, FilmContact, notes_on_growth, solve_film_contact
from bem.tribofilm.evolution import FilmHistory

_SAFETY, _SHRINK, _STRETCH = 0.9, 0.2, 3.0
_THIN = 1e-10
"""Films thinner than this [m] are integrated to an absolute instead of a relative tolerance."""


@dataclass(frozen=True, eq=False)
class LocalFilm:
    """A film with a local thickness.

    time (nt,) [s]; thickness, grown, worn, substrate_wear (nt,): means over the nominal area [m];
    film_map (nx, ny): local thickness at the end [m]; film_pressure (nx, ny): of the last contact [Pa];
    samples: the contacts that were solved, in that order, without their maps; rejected: how many steps were repeated
    with a shorter one; balance: of the film; notes: on arguments outside their usual ranges.
    """

    time: FloatArray
    thickness: FloatArray
    grown: FloatArray
    worn: FloatArray
    substrate_wear: FloatArray
    film_map: FloatArray
    film_pressure: FloatArray
    samples: tuple[ContactSample, ...]
    rejected: int
    balance: FilmBalance
    notes: tuple[Note, ...] = ()
    steady_thickness: None = None

    @property
    def contacts_solved(self) -> int:
        """Number of contacts solved."""
        return len(self.samples)

    @property
    def history(self) -> FilmHistory:
        """Means over time as those of `grow_tribofilm`; growth rates are differences of the film grown."""
        return FilmHistory(
            self.time,
            self.thickness,
            self.grown,
            self.worn,
            self.substrate_wear,
            growth_rate=np.gradient(self.grown, self.time),
            wear_rate=self.balance.wear_coefficient * self.thickness,
            concentration=self.balance.concentration(self.thickness),
            evaluations=self.contacts_solved,
        )


@dataclass(frozen=True, eq=False)
class Films:
    """State at one time: local film, film grown and substrate worn so far (nx, ny) [m], and the contact."""

    film: FloatArray
    grown: FloatArray
    substrate: FloatArray
    contact: ContactSample


@dataclass(frozen=True, eq=False)
class LocalState:
    """All that the next step needs, and the record so far.

    now, step : time and the step to try next [s]. last : pressure (nx, ny) [Pa] that the next contact starts from, of a
    step that was rejected perhaps. rows : means of thickness, grown, worn, substrate wear [m] at each time reached.
    """

    now: float
    step: float
    films: Films
    last: FloatArray
    rows: tuple[tuple[float, float, float, float], ...]
    samples: tuple[ContactSample, ...]
    rejected: int = 0


@dataclass(frozen=True, eq=False)
class _Case:
    """Constant parts: times (nt,) [s], contact, balance, cells of the means, tolerance of a step."""

    when: FloatArray
    contact: FilmContact
    balance: FilmBalance
    area: NDArray[np.bool_]
    tolerance: float

    def mean(self, values: FloatArray) -> float:
        return float(values[self.area].mean())


def grow_local_film(
    times: FloatArray,
    contact: FilmContact,
    *,
    wear_coefficient: float,
    concentration_constant: float = math.inf,
    initial_thickness: float = 0.0,
    tolerance: float = 1e-2,
    state: LocalState | None = None,
    callback: Callable[[LocalState], None] | None = None,
) -> LocalFilm:
    """Grow a film cell by cell.

    Parameters as in `grow_tribofilm`; `tolerance` is the relative error of the mean film per step (second order in
    time). There is no delayed wear here. The means are over `contact.nominal_area` (all cells where None).
    state : of the same film, to go on from to the same bits. callback : called with the state after every step tried.

    Raises
    ------
    InputError : times that do not increase, negative constants. InfeasibleError : a load beyond hardness times area.
    ConvergenceError : a contact that did not converge, or steps that shrink without end.
    """
    balance = FilmBalance(wear_coefficient, 0.0, concentration_constant, initial_thickness)
    when = checked_times(times, balance, tolerance)
    area = np.ones(contact.grid.shape, bool) if contact.nominal_area is None else contact.nominal_area.astype(bool)
    case = _Case(when, contact, balance, area, tolerance)
    state = _initial_state(case) if state is None else state
    while len(state.rows) < len(when):
        if state.now < when[len(state.rows)]:
            state = _try_step(case, state)
            if callback is not None:
                callback(state)
        else:
            state = _record_means(case, state)
    means, grown_means, worn_means, wear_means = np.array(state.rows).T
    return LocalFilm(
        when,
        means,
        grown_means,
        worn_means,
        wear_means,
        film_map=state.films.film,
        film_pressure=state.films.contact.pressure,
        samples=state.samples,
        rejected=state.rejected,
        balance=balance,
        notes=notes_on_growth(contact, wear_coefficient, initial_thickness),
    )


def _initial_state(case: _Case) -> LocalState:
    film = np.full(case.contact.grid.shape, case.balance.initial_thickness)
    found = _solve_contact(case, film, None)
    films = Films(film, np.zeros(film.shape), np.zeros(film.shape), found)
    step = 0.01 * (case.when[-1] - case.when[0])
    rows = ((case.mean(film), 0.0, 0.0, 0.0),)
    return LocalState(case.when[0], step, films, found.pressure, rows, (found.without_maps(),))


def _try_step(case: _Case, state: LocalState) -> LocalState:
    """Return the state after a trial step towards the next time, accepted or with a shorter next step."""
    now, step = state.now, min(state.step, case.when[len(state.rows)] - state.now)
    tried, difference = _advance(case, state, step)
    error = case.mean(difference)
    allowed = case.tolerance * max(case.mean(tried.film), _THIN)
    factor = min(_STRETCH, max(_SHRINK, _SAFETY * math.sqrt(allowed / error))) if error > 0 else _STRETCH
    found = tried.contact
    state = replace(state, step=step * factor, last=found.pressure, samples=(*state.samples, found.without_maps()))
    if error > allowed:
        if state.step < 1e-9 * (case.when[-1] - case.when[0]):
            raise ConvergenceError(f"tribofilm: time steps shrink without end at {now:.6g} s")
        return replace(state, rejected=state.rejected + 1)
    return replace(state, now=now + step, films=tried)


def _record_means(case: _Case, state: LocalState) -> LocalState:
    """Return the state at the next of the times, with a row of means."""
    films = state.films
    thickness, grown, substrate = (case.mean(each) for each in (films.film, films.grown, films.substrate))
    row = (thickness, grown, case.balance.initial_thickness + grown - thickness, substrate)
    return replace(state, now=case.when[len(state.rows)], rows=(*state.rows, row))


def _solve_contact(case: _Case, film: FloatArray, last: FloatArray | None) -> ContactSample:
    """Solve the contact under the surface raised by a film; last : pressure to start from."""
    raised = replace(case.contact, gap=case.contact.gap - film)
    touched = film[case.area if last is None else last > 0]
    mean = float(touched.mean()) if touched.size else 0.0
    return solve_film_contact(raised, mean, last)


def _advance(case: _Case, state: LocalState, step: float) -> tuple[Films, FloatArray]:
    """Return the films after a step, and their difference to those predicted with the growth at its start."""
    films, balance = state.films, case.balance
    start = films.contact
    decay = math.exp(-balance.wear_coefficient * step)
    first, second = _weights(balance.wear_coefficient * step)
    predicted = films.film * decay + step * first * start.growth_map
    end = _solve_contact(case, predicted, state.last)
    corrected = predicted + step * second * (end.growth_map - start.growth_map)
    corrected = np.maximum(corrected, 0.0)
    gained = 0.5 * step * (start.growth_map + end.growth_map)
    worn = films.film + gained - corrected
    concentration = 0.5 * (balance.concentration(films.film) + balance.concentration(corrected))
    tried = Films(corrected, films.grown + gained, films.substrate + concentration * worn, end)
    return tried, np.abs(corrected - predicted)


def _weights(z: float) -> tuple[float, float]:
    """Return phi_1 = (1 - e^-z)/z and phi_2 = (e^-z - 1 + z)/z^2, by series where they would cancel."""
    if z < 1e-3:
        return 1 - z / 2 + z * z / 6, 0.5 - z / 6 + z * z / 24
    return -math.expm1(-z) / z, (math.expm1(-z) + z) / (z * z)
