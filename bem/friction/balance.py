"""The one balance of load sharing: the film load at which film and rough contact together carry the load.

The sum of both grows with the film load, so its ends are looked at by one rule each:

- *full film*: a film under the whole load that clears the roughness, or is thicker than what the surfaces leave open
  under next to no load; nothing else is to be done;
- *boundary*: a film that is left with a negligible share of the load, a tenth of the tolerance, and is even then
  thinner than what the surfaces leave open when they carry all the rest. It would be left with less still, and the
  rest is known to within the tolerance: the contact under that load is the answer. So it is where the film's model
  ends before film and contact carry the load, the film there being thinner than a few molecules: it is none.

Between them a secant within a bracket, in logarithms: films and contacts follow powers of the load. Where the contact's
load changes steeply with the film's (rough surfaces under small loads), and where the oil is counted over the loaded
part of the film, the surfaces are pressed together by what a film leaves them instead, and the film load is found for
which they hold its oil. Nothing here knows what a film or a contact is made of.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum

from bem.errors import Status
from bem.friction.falling_zero import falling_zero
from bem.friction.film import Film, PatchFilm
from bem.friction.oil_volume import OilVolume, mean_where_counted
from bem.friction.rough_contact import Pressed, RoughContact
from bem.grid import FloatArray
from bem.lubrication.validity import THINNEST_FILM

MAX_TRIALS = 60
NEGLIGIBLE = 0.1
"""Share of the load, over the tolerance of the balance, below which a film is left with nothing that counts."""
FINEST_CONTACT = 1e-9
"""Tolerance of the contact below which it is not tightened any further."""
FAR = 4.0
"""A step in ln(film load) larger than that goes to the boundary end at once: there the contact is solved for the load,
which is easier than pressing surfaces far too close."""
STEEP = 10.0
"""Slope of the balance from which it is looked for by the opening: there the contact's load changes so steeply with the
film's, and the opening so little with the contact's load, that the film's thickness alone decides."""
OPENING_TRIALS = 8
LEAST_REST = 1e-12
"""Share of the load left to the surfaces, below which nothing is looked for."""
_SAME = 1e-9
"""Logarithms of loads that are one and the same."""
NEAR = 0.1
"""Imbalance below which secant steps are exact enough to need no margin for a bracket."""


class Regime(StrEnum):
    """Which end of the balance, or neither, a solution is at."""

    FULL_FILM = "full film"
    MIXED = "mixed"
    BOUNDARY = "boundary"


@dataclass(frozen=True, eq=False)
class BalanceStart:
    """Where to look first: film load [N], slope of ln(carried) with ln(film load), and a pressure [Pa] nearby."""

    film_load: float
    slope: float = 1.0
    pressure: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class Balance:
    """Film and contact that carry the load together.

    contact : None in full film. imbalance : (film + contact - load) / load, of these two. slope : of ln(carried) with
    ln(film load); where the oil is counted over the loaded film, of ln(opening / film thickness). oil_imbalance : (mean
    opening of the surfaces - mean thickness of the film) / the latter, where oil is counted; 0 at the ends. films,
    contacts : evaluated on the way; convolutions : of the contacts. status : converged where both imbalances are within
    the tolerance (that of the oil, or what the contact's own tolerance leaves of it) and film and contact are converged
    themselves. notes : what to tell the user.
    """

    film: PatchFilm
    contact: Pressed | None
    imbalance: float
    slope: float
    regime: Regime
    films: int
    contacts: int
    convolutions: float
    status: Status
    notes: tuple[str, ...] = ()
    oil_imbalance: float = 0.0


def share_load(
    film: Film, rough: RoughContact, load: float, tolerance: float, whole: PatchFilm, start: BalanceStart
) -> Balance:
    """The balance of a load [N] to `tolerance`; `whole` is the film under all of it, or under the largest there is."""
    effort = _Effort(contact_tolerance=rough.tolerance, film=whole, pressure=start.pressure)
    if whole.load >= load and rough.clears(whole):
        trial = _Trial(math.log(load), whole, None, _excess(whole, None, load))
        return _certified(trial, rough, load, tolerance, Regime.FULL_FILM, effort, start.slope)
    top = math.log(min(load, film.largest_load))
    bottom = min(math.log(NEGLIGIBLE * tolerance * load), top)
    at, slope = min(max(math.log(start.film_load), bottom), top - 1e-3), start.slope
    for level, error in enumerate(film.errors):
        search = _Search(film, rough, load, max(tolerance, error), level, bottom, top, effort)
        trial, slope, regime = search.run(at, slope) if rough.counted is OilVolume.PATCH else search.by_oil(at, slope)
        at = trial.logarithm
        if search.too_little(trial):
            if not search.is_no_film(trial):
                return _certified(trial, rough, load, tolerance, regime, effort, slope, short=True)
            trial = replace(search, level=len(film.errors) - 1).under_the_rest()
            return _certified(trial, rough, load, tolerance, Regime.BOUNDARY, effort, slope)
    return _certified(trial, rough, load, tolerance, regime, effort, slope)


@dataclass(frozen=True, eq=False)
class _Trial:
    """A film load, by its logarithm, its film and contact, and what they carry beyond the load, relative to it."""

    logarithm: float
    film: PatchFilm
    contact: Pressed | None
    excess: float

    @property
    def value(self) -> float:
        """What is brought to zero."""
        return math.log1p(self.excess)


@dataclass
class _Effort:
    """What all levels share: the last film and pressure as starts, the contact's tolerance, and counts."""

    contact_tolerance: float = 0.0
    film: PatchFilm | None = None
    pressure: FloatArray | None = None
    films: int = 0
    contacts: int = 0
    convolutions: float = 0.0

    def count(self, contact: Pressed) -> None:
        self.contacts += 1
        self.convolutions += contact.convolutions
        self.pressure = contact.pressure


@dataclass
class _Bracket:
    """Film loads, by their logarithms, with too little (low) and too much (high) carried, and those values."""

    low: tuple[float, float] | None = None
    high: tuple[float, float] | None = None
    seen: list[_Trial] = field(default_factory=list)

    def take(self, trial: _Trial) -> None:
        self.seen.append(trial)
        if trial.value < 0:
            self.low = (trial.logarithm, trial.value)
        else:
            self.high = (trial.logarithm, trial.value)

    @property
    def width(self) -> float:
        return math.inf if self.low is None or self.high is None else self.high[0] - self.low[0]

    def slope(self, trial: _Trial, before: float) -> float:
        """Slope to the nearest trial so far; closer ones than 1e-4 say more about the contact's tolerance."""
        others = [other for other in self.seen if abs(other.logarithm - trial.logarithm) > 1e-4]
        if not others:
            return before
        other = min(others, key=lambda t: abs(t.logarithm - trial.logarithm))
        found = (trial.value - other.value) / (trial.logarithm - other.logarithm)
        return found if found > 0 else before


@dataclass
class _Search:
    """The balance at one level of the film's accuracy."""

    film: Film
    rough: RoughContact
    load: float
    goal: float
    level: int
    bottom: float
    top: float
    effort: _Effort

    def run(self, at: float, slope: float) -> tuple[_Trial, float, Regime]:
        """Best trial, slope there, and regime."""
        bracket = _Bracket()
        best: _Trial | None = None
        step = 0.0
        steep_tried = False
        for _ in range(MAX_TRIALS):
            if at <= self.bottom and bracket.low is None:
                bracket.low = (self.bottom, -math.inf)
                short = self.top < math.log(self.load)
                at, slope = self.top if short else 0.5 * (self.bottom + self.top), 1.0
                if self.load - math.exp(self.bottom) <= self.rough.largest_load:
                    probe = self.under_the_rest()
                    if self.is_boundary(probe):
                        return probe, slope, Regime.BOUNDARY
                    if not short:
                        at, slope = min(self.bottom + self.mismatch(probe), self.top), STEEP
            if slope >= STEEP and not steep_tried:
                steep_tried = True
                found = self.by_opening(at)
                if found is not None:
                    return found, STEEP, Regime.MIXED
                slope = 1.0
            trial = self.at_volume(at)
            slope = bracket.slope(trial, slope)
            bracket.take(trial)
            if best is None or abs(trial.excess) < abs(best.excess):
                best = trial
            if abs(trial.excess) <= self.goal or self.too_little(trial):
                return trial, slope, Regime.MIXED
            if bracket.width < 1e-13:
                break
            at, step = self.next(trial, slope, bracket, step)
        assert best is not None
        return best, slope, Regime.MIXED

    def by_opening(self, at: float) -> _Trial | None:
        """Film load at which the surfaces, under what the film leaves them, hold its oil: secant in logarithms.

        What the contact's tolerance makes of its opening may be too much: it is then solved better.
        """
        while True:
            slope, before = -1.0, None
            for _ in range(OPENING_TRIALS):
                if not self.bottom <= at < self.top or self.load - math.exp(at) > self.rough.largest_load:
                    return None
                trial = self.under_the_rest(at)
                mismatch = self.mismatch(trial)
                if abs(mismatch) <= self.goal:
                    return trial
                if before is not None and abs(at - before[0]) > 1e-9:
                    slope = min((mismatch - before[1]) / (at - before[0]), -0.1)
                before = (at, mismatch)
                at = min(at - mismatch / slope, 0.5 * (at + self.top))
            if self.effort.contact_tolerance <= FINEST_CONTACT:
                return None
            self.effort.contact_tolerance *= 0.01

    def by_oil(self, at: float, slope: float) -> tuple[_Trial, float, Regime]:
        """As `run`, of the opening alone, in ln(film load / rest): next to either end one of them changes by its own
        size. `slope` : of ln(opening / film thickness) with ln(film load)."""
        beyond = self.load - self.rough.largest_load  # what surfaces that yield everywhere leave to the film at least
        yielded = math.log(beyond) + 1e-9 if beyond > 0 else -math.inf
        bottom = self.odds(max(self.bottom, yielded))
        last: list[_Trial] = []

        def evaluate(place: float) -> tuple[float, bool]:
            trial = self.under_the_rest(math.log(self.load) - math.log1p(math.exp(-place)))
            last[:] = [trial]
            return self.mismatch(trial), _holds_oil(trial, self.rough, self.goal)

        rest = -math.expm1(at - math.log(self.load))
        found = falling_zero(evaluate, self.odds(at), slope * rest, (bottom, self.odds(self.top)), MAX_TRIALS)
        (trial,) = last
        slope = found / max(1 - trial.film.load / self.load, LEAST_REST)
        if trial.logarithm >= math.log(self.load) - _SAME and self.mismatch(trial) > self.goal:
            return self.trial(trial.logarithm, trial.film, None), slope, Regime.FULL_FILM
        at_bottom = trial.logarithm <= self.bottom + _SAME and self.is_boundary(trial)
        return trial, slope, Regime.BOUNDARY if at_bottom else Regime.MIXED

    def odds(self, logarithm: float) -> float:
        """ln(film load / rest) of a film load, by its logarithm."""
        share = math.exp(min(logarithm - math.log(self.load), 0.0))
        return math.log(share / max(1 - share, LEAST_REST))

    def at_volume(self, logarithm: float) -> _Trial:
        """Film at a load, and the surfaces holding its oil."""
        film = self.film_at(logarithm)
        contact = None
        if not self.rough.clears(film):
            contact = self.rough.at_volume(film, self.effort.contact_tolerance, self.effort.pressure)
            self.effort.count(contact)
        return self.trial(logarithm, film, contact)

    def under_the_rest(self, logarithm: float | None = None) -> _Trial:
        """A film, by default one with a negligible load, and the surfaces under what it leaves them."""
        logarithm = self.bottom if logarithm is None else logarithm
        film = self.film_at(logarithm)
        rest = self.load - film.load
        contact = self.rough.at_load(film, rest, self.effort.contact_tolerance, self.effort.pressure)
        self.effort.count(contact)
        return self.trial(logarithm, film, contact)

    def film_at(self, logarithm: float) -> PatchFilm:
        film = self.film.under(math.exp(logarithm), self.level, self.effort.film)
        self.effort.films += 1
        self.effort.film = film
        return film

    def trial(self, logarithm: float, film: PatchFilm, contact: Pressed | None) -> _Trial:
        return _Trial(logarithm, film, contact, _excess(film, contact, self.load))

    def too_little(self, trial: _Trial) -> bool:
        """Whether all that the film's model can carry is not enough."""
        if self.rough.counted is OilVolume.PATCH:
            return trial.excess < -self.goal and trial.logarithm >= self.top
        at_end = trial.logarithm >= self.top - _SAME and self.top < math.log(self.load)
        return at_end and self.mismatch(trial) > self.goal

    def is_no_film(self, trial: _Trial) -> bool:
        """Whether a film is so thin that the surfaces carry the load without it, and can."""
        return trial.film.carrying_thickness < THINNEST_FILM and self.load <= self.rough.largest_load

    def is_boundary(self, probe: _Trial) -> bool:
        """Whether the film, negligible as it is, is thinner than the surfaces leave open."""
        return self.mismatch(probe) <= 0

    def mismatch(self, trial: _Trial) -> float:
        """ln(film thickness / opening of the surfaces). Thin films go like the inverse of their load: that much is
        about what ln(film load) lacks."""
        assert trial.contact is not None
        return math.log(_oil(trial.film, self.rough) / max(trial.contact.opening, 1e-300))

    def next(self, trial: _Trial, slope: float, bracket: _Bracket, before: float) -> tuple[float, float]:
        """Logarithm to try next, and the step there where it goes down without a bracket."""
        at, value, low, high = trial.logarithm, trial.value, bracket.low, bracket.high
        wanted = at - value / slope
        if low is None:
            step = value / slope
            if value > NEAR or len(bracket.seen) > 4:
                step = max(1.05 * step, 1.5 * before)  # a little beyond, and by more than last time
            if step > FAR or at - step <= self.bottom:
                return self.bottom, step
            return at - step, step
        if high is None:
            if self.top < math.log(self.load) and wanted >= self.top:
                return self.top, 0.0  # the film's model ends there: nothing says that it can carry the rest
            half = 0.5 * (at + self.top)
            if wanted >= self.top:
                return min(max(wanted, at + 1e-3), half), 0.0
            margin = 0.05 * (wanted - at) if abs(value) > NEAR or len(bracket.seen) > 4 else 0.0
            return min(wanted + margin, 0.5 * (wanted + self.top)), 0.0
        width = bracket.width
        if low[0] + 0.02 * width < wanted < high[0] - 0.02 * width:
            return wanted, 0.0
        secant = 0.5 * (low[0] + high[0])
        if math.isfinite(low[1]):
            secant = low[0] - low[1] * width / (high[1] - low[1])
        return min(max(secant, low[0] + 0.1 * width), high[0] - 0.1 * width), 0.0


def _excess(film: PatchFilm, contact: Pressed | None, load: float) -> float:
    return (film.load + (0.0 if contact is None else contact.load) - load) / load


def _oil(film: PatchFilm, rough: RoughContact) -> float:
    """Mean thickness of a film [m] where its oil is counted."""
    return mean_where_counted(film.thickness, film, rough.counted)


def _holds_oil(trial: _Trial, rough: RoughContact, goal: float) -> bool:
    """Whether the surfaces hold the film's oil, to a goal or to what is known of their opening."""
    assert trial.contact is not None
    oil, opening = _oil(trial.film, rough), trial.contact.opening
    if abs(opening - oil) <= trial.contact.opening_error * (1 + 1e-9):
        return True
    return opening > 0 and abs(math.log(oil / opening)) <= goal


def _certified(
    trial: _Trial,
    rough: RoughContact,
    load: float,
    tolerance: float,
    regime: Regime,
    effort: _Effort,
    slope: float,
    *,
    short: bool = False,
) -> Balance:
    """Judge film and contact by themselves, and whether they carry the load and hold the same oil; `short` where they
    carry too little at the end of the film's range."""
    film, contact = trial.film, trial.contact
    imbalance = _excess(film, contact, load)
    notes = [*film.notes, *(() if contact is None else contact.notes)]
    oil_imbalance, held = 0.0, True
    if contact is not None and regime is Regime.MIXED:
        oil_imbalance, held = contact.opening / _oil(film, rough) - 1, _holds_oil(trial, rough, tolerance)
    if regime is Regime.BOUNDARY:
        notes.append(boundary_note(film.load / load))
    if short:
        notes.append(_short_note(film.load, load, imbalance, rough.counted))
    status = Status.CONVERGED
    if film.status is not Status.CONVERGED:
        status = film.status
    elif contact is not None and contact.status is not Status.CONVERGED:
        status = contact.status
    elif abs(imbalance) > tolerance or not held:
        status = Status.INFEASIBLE if short else Status.STALLED
    return Balance(
        film=film,
        contact=contact,
        imbalance=imbalance,
        slope=slope,
        regime=regime,
        films=effort.films,
        contacts=effort.contacts,
        convolutions=effort.convolutions,
        status=status,
        notes=tuple(notes),
        oil_imbalance=oil_imbalance,
    )


def _short_note(film_load: float, load: float, imbalance: float, counted: OilVolume) -> str:
    """What to say where the film's model ends before the balance."""
    there = (
        f"surfaces and film carry {load * (1 + imbalance):.3g} N there"
        if counted is OilVolume.PATCH
        else "the film is thicker there than the surfaces leave open under the rest"
    )
    return (
        f"the film's model ends at a load of {film_load:.3g} N (at this speed and viscosity), and {there}; raise speed "
        "or viscosity, or lower the load"
    )


def boundary_note(share: float) -> str:
    """What to say of the boundary end, the film being left with a share of the load."""
    return (
        f"boundary lubrication: the film is left with less than {share:.1g} of the load, so the contact was solved "
        "under all the rest"
    )
