"""Growth of a tribofilm of uniform mean thickness: contact, growth and wear together (thesis, paper E)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

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
    contacts : the contacts that were solved, by increasing thickness.
    film_map : local thickness at the end (nx, ny) [m].
    steady : thickness at which growth and wear balance [m]; infinite where they do not (no self-limitation).
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
        """Thickness at which growth and wear balance [m]; None where they do not."""
        return None if math.isinf(self.steady) else self.steady

    @property
    def film_pressure(self) -> FloatArray:
        """Pressure (nx, ny) of the contact whose film is nearest to that at the end [Pa]."""
        return min(self.contacts, key=lambda one: abs(one.thickness - self.history.thickness[-1])).pressure

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
    times : increasing, from the start of rubbing [s]; in cycles where the rates are per cycle.
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

    table = GrowthTable(sample, tolerance=reuse_tolerance)
    growth = table if reuse_tolerance > 0 else (lambda h: sample(h, None).growth)
    history = evolve_film(
        times,
        growth,
        wear_coefficient=wear_coefficient,
        lag=lag,
        concentration_constant=concentration_constant,
        initial_thickness=initial_thickness,
        tolerance=tolerance,
    )
    return TribofilmGrowth(
        history=history,
        contacts=tuple(table.samples),
        film_map=film_map(history, table, wear_coefficient, lag, initial_thickness),
        steady=steady_thickness(growth, wear_coefficient, longest=_reach(history)),
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
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    total: dict[float, float] = {}
    for begin, end in zip(history.time[:-1], history.time[1:], strict=True):
        for node, weight in zip(nodes.tolist(), weights.tolist(), strict=True):
            when = 0.5 * (begin + end) + 0.5 * (end - begin) * node
            thickness = float(np.interp(when, history.time, history.thickness))
            kept = float(0.5 * (end - begin) * weight * survival(history.time[-1] - when, wear_coefficient, lag))
            for sample, fraction in table.weights(thickness):
                total[sample.thickness] = total.get(sample.thickness, 0.0) + kept * fraction
    remains = initial_thickness * survival(history.time[-1] - history.time[0], wear_coefficient, lag)
    result = np.full(table.samples[0].growth_map.shape, max(remains, 0.0))
    for sample in table.samples:
        weight = total.get(sample.thickness, 0.0)
        if weight:
            result += weight * sample.growth_map
    return np.maximum(result, 0.0)


def survival(time: float, wear_coefficient: float, lag: float) -> float:
    """Return the fraction of film left after a time [s] of wear: the solution of K' = -alpha K(t - lag), K(0) = 1,
    K(<0) = 0.

    Method of steps: sum over k of (-alpha)^k (t - k lag)^k / k! while t > k lag. It is used for alpha lag < 1, where
    the terms do not cancel badly before K has died out.
    """
    if lag <= 0:
        return math.exp(-wear_coefficient * time)
    value, k = 0.0, 0
    while time >= k * lag and k < 60:
        value += (-wear_coefficient * (time - k * lag)) ** k / math.factorial(k)
        k += 1
    if k == 60 or abs(value) > 1e3:
        return 0.0  # many lags ago: nothing of it is left
    return value


def _reach(history: FilmHistory) -> float:
    """Return the upper end of the search for a balance, slightly above the largest thickness [m]."""
    return float(history.thickness.max()) * 1.02 + 1e-12
