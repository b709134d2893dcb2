"""A film whose local thickness feeds back: it builds up where it grows, and the raised surface is what touches next.

With the mean thickness alone (`grow.grow_tribofilm`, as in the source) the film changes stiffness and hardness of the
contact; here it changes the surface too. Each step solves the contact under the surface raised by the film, stiffness
and hardness being those of the mean film in the contact, and advances every cell by the exponential trapezoidal rule
(ETD2RK, Cox and Matthews 2002): wear is integrated exactly, so no step, however long, makes a film negative.

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
from bem.tribofilm.balance import FilmBalance, checked_times
from bem.tribofilm.contact_growth import ContactSample, FilmContact, solve_film_contact
from bem.tribofilm.evolution import FilmHistory

_SAFETY, _SHRINK, _STRETCH = 0.9, 0.2, 3.0
_THIN = 1e-10
"""Films thinner than this [m] are integrated to an absolute instead of a relative tolerance."""


@dataclass(frozen=True, eq=False)
class LocalFilm:
    """A film with a local thickness.

    time (nt,) [s]; thickness, grown, worn, substrate_wear (nt,): means over the nominal area [m];
    film_map (nx, ny): local thickness at the end [m]; pressure (nx, ny): of the last contact [Pa];
    contacts: how many were solved; rejected: how many steps were repeated with a shorter one; balance: of the film.
    """

    time: FloatArray
    thickness: FloatArray
    grown: FloatArray
    worn: FloatArray
    substrate_wear: FloatArray
    film_map: FloatArray
    pressure: FloatArray
    contacts: int
    rejected: int
    balance: FilmBalance

    @property
    def history(self) -> FilmHistory:
        """The means over time as those of `grow_tribofilm`; rates of growth are differences of what has grown."""
        return FilmHistory(
            self.time,
            self.thickness,
            self.grown,
            self.worn,
            self.substrate_wear,
            growth_rate=np.gradient(self.grown, self.time),
            wear_rate=self.balance.wear_coefficient * self.thickness,
            concentration=self.balance.concentration(self.thickness),
            evaluations=self.contacts,
        )


def grow_local_film(
    times: FloatArray,
    contact: FilmContact,
    *,
    wear_coefficient: float,
    concentration_constant: float = math.inf,
    initial_thickness: float = 0.0,
    tolerance: float = 1e-2,
    callback: Callable[[float, ContactSample], None] | None = None,
) -> LocalFilm:
    """Grow a film cell by cell.

    Parameters as in `grow_tribofilm`; `tolerance` is the relative error of the mean film per step (second order in
    time). There is no delayed wear here. The means are over `contact.nominal_area` (all cells where None).

    Raises
    ------
    InputError : times that do not increase, negative constants. InfeasibleError : a load beyond hardness times area.
    ConvergenceError : a contact that did not converge, or steps that shrink without end.
    """
    balance = FilmBalance(wear_coefficient, 0.0, concentration_constant, initial_thickness)
    when = checked_times(times, balance, tolerance)
    area = np.ones(contact.grid.shape, bool) if contact.nominal_area is None else contact.nominal_area.astype(bool)
    contacts = _Contacts(contact, area, callback)
    film = np.full(contact.grid.shape, initial_thickness)
    films = _Films(film, np.zeros(film.shape), np.zeros(film.shape), contacts.solve(film, when[0]))
    rows = [(float(film[area].mean()), 0.0, 0.0, 0.0)]
    step = 0.01 * (when[-1] - when[0])
    rejected = 0
    now = when[0]
    for target in when[1:]:
        while now < target:
            step = min(step, target - now)
            tried, difference = _advance(films, contacts, balance, now, step)
            error = float(difference[area].mean())
            allowed = tolerance * max(float(tried.film[area].mean()), _THIN)
            factor = min(_STRETCH, max(_SHRINK, _SAFETY * math.sqrt(allowed / error))) if error > 0 else _STRETCH
            if error > allowed:
                rejected += 1
                step *= factor
                if step < 1e-9 * (when[-1] - when[0]):
                    raise ConvergenceError(f"tribofilm: time steps shrink without end at {now:.6g} s")
                continue
            films, now = tried, now + step
            step *= factor
        now = target
        thickness, grown, substrate = (float(each[area].mean()) for each in (films.film, films.grown, films.substrate))
        rows.append((thickness, grown, initial_thickness + grown - thickness, substrate))
    means, grown_means, worn_means, wear_means = np.array(rows).T
    return LocalFilm(
        when,
        means,
        grown_means,
        worn_means,
        wear_means,
        films.film,
        films.contact.pressure,
        contacts.solved,
        rejected,
        balance,
    )


@dataclass(frozen=True, eq=False)
class _Films:
    """At one time: local film, what has grown and how much substrate has left, (nx, ny) [m], and the contact there."""

    film: FloatArray
    grown: FloatArray
    substrate: FloatArray
    contact: ContactSample


class _Contacts:
    """Contacts under the surface raised by a film, counted; each starts from the pressure of the one before."""

    def __init__(
        self, contact: FilmContact, area: NDArray[np.bool_], callback: Callable[[float, ContactSample], None] | None
    ) -> None:
        self.contact = contact
        self.area = area
        self.callback = callback
        self.solved = 0
        self.last: ContactSample | None = None

    def solve(self, film: FloatArray, now: float) -> ContactSample:
        """The contact under this film."""
        raised = replace(self.contact, gap=self.contact.gap - film)
        touched = film[self.area if self.last is None else self.last.pressure > 0]
        mean = float(touched.mean()) if touched.size else 0.0
        self.last = solve_film_contact(raised, mean, None if self.last is None else self.last.pressure)
        self.solved += 1
        if self.callback is not None:
            self.callback(now, self.last)
        return self.last


def _advance(
    films: _Films, contacts: _Contacts, balance: FilmBalance, now: float, step: float
) -> tuple[_Films, FloatArray]:
    """Films after `step`, and how far they are from those predicted with the growth at the step's beginning."""
    start = films.contact
    decay = math.exp(-balance.wear_coefficient * step)
    first, second = _weights(balance.wear_coefficient * step)
    predicted = films.film * decay + step * first * start.growth_map
    end = contacts.solve(predicted, now + step)
    corrected = predicted + step * second * (end.growth_map - start.growth_map)
    corrected = np.maximum(corrected, 0.0)
    gained = 0.5 * step * (start.growth_map + end.growth_map)
    worn = films.film + gained - corrected
    concentration = 0.5 * (balance.concentration(films.film) + balance.concentration(corrected))
    tried = _Films(corrected, films.grown + gained, films.substrate + concentration * worn, end)
    return tried, np.abs(corrected - predicted)


def _weights(z: float) -> tuple[float, float]:
    """phi_1 = (1 - e^-z)/z and phi_2 = (e^-z - 1 + z)/z^2, by series where they would cancel."""
    if z < 1e-3:
        return 1 - z / 2 + z * z / 6, 0.5 - z / 6 + z * z / 24
    return -math.expm1(-z) / z, (math.expm1(-z) + z) / (z * z)
