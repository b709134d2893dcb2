"""The one balance of load sharing: the film load at which the rough surfaces, under the rest, hold the film's oil.

The more a film carries the thinner it is, and the more the surfaces open under what it leaves them, so that what they
hold over the film's oil rises with its load. The ends are looked at by one rule each:

- *full film*: a film under the whole load that clears the roughness, or is thicker than what the surfaces leave open
  under next to no load; nothing else is to be done;
- *boundary*: a film that is left with a negligible share of the load, a tenth of the tolerance, and is even then
  thinner than what the surfaces leave open when they carry all the rest. It would be left with less still, and the
  rest is known to within the tolerance: the contact under that load is the answer. So it is where the film's model
  ends before the oil fits, the film there being thinner than a few molecules: it is none.

Between them a secant within a bracket, in ln(film load / rest): next to either end one of them changes by its own size.
Where the opening jumps with the load (cells at the hardness) the surfaces are pressed to an approach in between. A
contact under a load is one solve; pressing surfaces together until they hold a volume, and looking for the film load at
which both carry the load, took four to five times its convolutions. Nothing here knows what a film or a contact is made
of.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from bem.errors import Status
from bem.friction.falling_zero import falling_zero
from bem.friction.film import Film, PatchFilm
from bem.friction.rough_contact import Pressed, RoughContact
from bem.grid import FloatArray
from bem.lubrication.validity import THINNEST_FILM
from bem.notes import Note
from bem.notes.friction import BOUNDARY_LUBRICATION, FILM_MODEL_ENDS

MAX_TRIALS = 60
ONE_LOAD = 0.1
"""Of the tolerance: how far apart film loads are one."""
COARSE_TRIALS, FINEST_CONTACT = 20, 1e-9
"""Films after which a contact is solved more finely, down to that tolerance: openings that jump with its own tolerance
keep film and contact from their balance."""
CONTACT_SHARE = 0.1
"""Of the goal with coarse films: what their contacts are solved to, relative to the gap that they flatten."""
AHEAD = 0.3
"""Of the goal with coarse films: what a secant must be expected to leave, the product of the mismatches it is through,
for its place to be tried with finer ones at once."""
KNOWN_SLOPE = 0.1
"""How well a slope is known from a similar balance."""
NEGLIGIBLE = 0.1
"""Share of the load, over the tolerance of the balance, below which a film is left with nothing that counts."""
KEPT_FILMS = 3
"""As starts for others, besides the one under the whole load."""
LEAST_REST = 1e-12
"""Share of the load left to the surfaces, below which nothing is looked for."""
_LEAST_BEGUN = 1e-6
"""Share of the load left to the surfaces where a search begins."""
_SAME = 1e-9
"""Logarithms of loads that are one and the same."""


class Regime(StrEnum):
    """Which end of the balance, or neither, a solution is at."""

    FULL_FILM = "full film"
    MIXED = "mixed"
    BOUNDARY = "boundary"


@dataclass(frozen=True, eq=False)
class BalanceStart:
    """Where to look first: film load [N], slope of ln(opening / film thickness) with ln(film load), and a pressure [Pa]
    nearby. known : whether the slope is that of a similar balance. refinement : as of `Balance`, of that one."""

    film_load: float
    slope: float = 1.0
    pressure: FloatArray | None = None
    known: bool = False
    refinement: float = 0.0

    @classmethod
    def after(
        cls, share: float, slope: float, load: float, film_load: float, pressure: FloatArray | None
    ) -> BalanceStart:
        """At a film load [N], from the slope where films had another share of the load: that with ln(film load / rest)
        is about the same from full film to contact, that with ln(film load) goes like the inverse of the rest."""
        rest, before = max(1 - film_load / load, LEAST_REST), max(1 - share, LEAST_REST)
        return cls(film_load, slope * before / rest, pressure, known=True)


@dataclass(frozen=True, eq=False)
class Balance:
    """Film and contact that carry the load together.

    contact : None in full film. imbalance : (film + contact - load) / load, of these two. slope : of ln(opening / film
    thickness) with ln(film load). refinement : of ln(film load / rest), what the last films changed in the coarser
    ones' balance. oil_imbalance : (mean opening of the surfaces - mean thickness of the film) / the
    latter, where oil is counted; 0 at the ends. films,
    contacts : evaluated on the way; convolutions : of the contacts. status : converged where both imbalances are within
    the tolerance (that of the oil, or what the contact's own tolerance leaves of it) and film and contact are converged
    themselves. notes : what to tell the user. film_neglected : whether the film's model ends before the balance, where
    the film is so thin that the contact was solved under all the load.
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
    notes: tuple[Note, ...] = ()
    oil_imbalance: float = 0.0
    refinement: float = 0.0
    film_neglected: bool = False


def share_load(
    film: Film, rough: RoughContact, load: float, tolerance: float, whole: PatchFilm, start: BalanceStart
) -> Balance:
    """The balance of a load [N] to `tolerance`; `whole` is the film under all of it, or under the largest there is."""
    effort = _Effort(films_known=(whole,), pressure=start.pressure)
    if whole.load >= load and rough.clears(whole):
        trial = _Trial(math.log(load), whole, None, _excess(whole, None, load))
        return _certified(trial, rough, load, tolerance, Regime.FULL_FILM, effort, start.slope)
    top = math.log(min(load, film.largest_load))
    bottom = min(math.log(NEGLIGIBLE * tolerance * load), top)
    at, slope = min(max(math.log(start.film_load), bottom), top, math.log(load) - _LEAST_BEGUN), start.slope
    if at <= bottom + _SAME and top < math.log(load):
        at = top  # where the last one was at the boundary since the film's model ends, its end says so again
    regime = Regime.MIXED
    for level, error in enumerate(film.errors):
        search = _Search(film, rough, load, max(tolerance, error), level, bottom, top, effort)
        effort.contact_tolerance = min(effort.contact_tolerance, search.contact_tolerance)
        coarse = at
        if level > 0 and regime is Regime.MIXED:
            at = search.under_odds(search.odds(at) + start.refinement)
        found = search.run(at, slope, known=start.known and level == 0)
        trial, slope, regime, at = found.trial, found.slope, found.regime, found.ahead
        if search.too_little(trial):
            at = trial.logarithm
            effort.contact_tolerance = min(effort.contact_tolerance, rough.tolerance)
            finest = replace(search, level=len(film.errors) - 1)  # a film as good as was asked for
            if search.is_no_film(trial):
                probe = finest.under_the_rest()
                return _certified(probe, rough, load, tolerance, Regime.BOUNDARY, effort, slope, short=True)
            return _certified(finest.under_the_rest(at), rough, load, tolerance, regime, effort, slope, short=True)
    balance = _certified(trial, rough, load, tolerance, regime, effort, slope)
    if regime is not Regime.MIXED or len(film.errors) == 1 or balance.status is not Status.CONVERGED:
        return balance
    return replace(balance, refinement=search.odds(at) - search.odds(coarse))


@dataclass(frozen=True, eq=False)
class _Trial:
    """A film load, by its logarithm, its film and contact, and what they carry beyond the load, relative to it."""

    logarithm: float
    film: PatchFilm
    contact: Pressed | None
    excess: float


@dataclass(frozen=True, eq=False)
class _Found:
    """Last trial of a level, slope there, regime, and logarithm of the film load where the next level begins."""

    trial: _Trial
    slope: float
    regime: Regime
    ahead: float


@dataclass
class _Effort:
    """What all levels share: films and the last pressure as starts, the contact's tolerance, and counts.

    films_known : that under the whole load and the last `KEPT_FILMS`.
    """

    films_known: tuple[PatchFilm, ...]
    contact_tolerance: float = math.inf
    pressure: FloatArray | None = None
    films: int = 0
    contacts: int = 0
    convolutions: float = 0.0

    def keep(self, film: PatchFilm) -> None:
        """A film that was solved, to start others from."""
        self.films += 1
        self.films_known = (self.films_known[0], *self.films_known[1:][1 - KEPT_FILMS :], film)

    def nearest(self, load: float) -> PatchFilm:
        """The known film under a load nearest to one [N], the latest of several: the last trial may lie at the other
        end."""
        return min(reversed(self.films_known), key=lambda one: abs(math.log(load / one.load)))

    def count(self, contact: Pressed) -> None:
        self.contacts += 1
        self.convolutions += contact.convolutions
        self.pressure = contact.pressure


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

    @property
    def contact_tolerance(self) -> float:
        """What a contact is solved to at first: as was asked for with the last films, before them no better than the
        balance needs of an opening as small as the film's oil."""
        asked, film = self.rough.tolerance, self.effort.films_known[-1]
        if self.level == len(self.film.errors) - 1 or asked == 0:
            return asked
        share = self.rough.oil(film) / max(float(film.gap.std()), 1e-300)
        return max(asked, CONTACT_SHARE * self.goal * min(share, 1.0))

    def run(self, at: float, slope: float, *, known: bool = False) -> _Found:
        """From a film load by its logarithm and `BalanceStart.slope`, and whether that is `BalanceStart.known`."""
        beyond = self.load - self.rough.largest_load  # what surfaces that yield everywhere leave to the film at least
        yielded = math.log(beyond) + 1e-9 if beyond > 0 else -math.inf
        ends = self.odds(max(self.bottom, yielded)), self.odds(self.top)
        last: list[tuple[_Trial, bool]] = []
        sides: dict[bool, _Trial] = {}
        missed: list[float] = [KNOWN_SLOPE] if known else []

        def evaluate(place: float) -> tuple[float, bool]:
            trial = self.under_the_rest(self.under_odds(place))
            value = self.mismatch(trial)
            met = _holds_oil(trial, self.rough, self.goal) or self.next_will_do(value, missed)
            missed.append(value)
            last[:], sides[value > 0] = [(trial, met)], trial
            return value, met or self.one_load(sides)

        while True:
            coarse = self.effort.contact_tolerance > FINEST_CONTACT
            rest = -math.expm1(at - math.log(self.load))
            found = falling_zero(evaluate, self.odds(at), slope * rest, ends, COARSE_TRIALS if coarse else MAX_TRIALS)
            ((trial, met),) = last
            if not met and self.one_load(sides):
                pressed = self.between(sides[True], sides[False])
                if _holds_oil(pressed, self.rough, self.goal) or not coarse:
                    return _Found(pressed, slope, Regime.MIXED, pressed.logarithm)
                sides.clear()
            at, inside = trial.logarithm, ends[0] < self.odds(trial.logarithm) < ends[1]
            if met or not (coarse and inside):
                break
            self.effort.contact_tolerance *= 0.01  # what it makes of the opening may be too much
            missed.clear()
        slope = found.slope / max(1 - trial.film.load / self.load, LEAST_REST)
        if at >= math.log(self.load) - _SAME and self.mismatch(trial) > self.goal:
            return _Found(self.trial(at, trial.film, None), slope, Regime.FULL_FILM, at)
        at_bottom = at <= self.bottom + _SAME and self.is_boundary(trial)
        ahead = self.under_odds(found.ahead) if met and inside else at
        return _Found(trial, slope, Regime.BOUNDARY if at_bottom else Regime.MIXED, ahead)

    def next_will_do(self, mismatch: float, before: Sequence[float]) -> bool:
        """Whether, by a secant, the next trial would meet the goal; with finer films to come it is made with those."""
        finest = self.level == len(self.film.errors) - 1
        return not finest and any(abs(mismatch * one) <= AHEAD * self.goal for one in before)

    def under_odds(self, place: float) -> float:
        """Logarithm of the film load of a place of `odds`."""
        return math.log(self.load) - math.log1p(math.exp(-place))

    def one_load(self, sides: Mapping[bool, _Trial]) -> bool:
        """Whether trials with films that are too thick (True) and too thin are under loads as good as one: the opening
        jumps there, cells that yield sinking under one load until the next ones touch."""
        if len(sides) < 2:
            return False
        one, other = sides[True].film.load, sides[False].film.load
        return abs(one - other) <= ONE_LOAD * self.goal * min(one, other)

    def between(self, thick: _Trial, thin: _Trial) -> _Trial:
        """The film of one of two trials under one load, and the surfaces as near as they hold its oil."""
        assert thick.contact is not None
        assert thin.contact is not None
        nearest, farthest = thick.contact.approach, thin.contact.approach
        last = [thick]

        def evaluate(place: float) -> tuple[float, bool]:
            contact = self.rough.at_approach(
                thick.film,
                nearest + place * (farthest - nearest),
                self.effort.contact_tolerance,
                self.effort.pressure,
            )
            self.effort.count(contact)
            last[:] = [self.trial(thick.logarithm, thick.film, contact)]
            return self.mismatch(last[0]), _holds_oil(last[0], self.rough, self.goal)

        falling_zero(evaluate, 0.5, self.mismatch(thick) - self.mismatch(thin), (0.0, 1.0), COARSE_TRIALS)
        return last[0]

    def odds(self, logarithm: float) -> float:
        """ln(film load / rest) of a film load, by its logarithm."""
        share = math.exp(min(logarithm - math.log(self.load), 0.0))
        return math.log(share / max(1 - share, LEAST_REST))

    def under_the_rest(self, logarithm: float | None = None) -> _Trial:
        """A film, by default one with a negligible load, and the surfaces under what it leaves them, or as much of that
        as they can carry."""
        logarithm = self.bottom if logarithm is None else logarithm
        film = self.film_at(logarithm)
        rest = min(self.load - film.load, self.rough.largest_load)
        contact = self.rough.at_load(film, rest, self.effort.contact_tolerance, self.effort.pressure)
        self.effort.count(contact)
        return self.trial(logarithm, film, contact)

    def film_at(self, logarithm: float) -> PatchFilm:
        load = math.exp(logarithm)
        film = self.film.under(load, self.level, self.effort.nearest(load))
        self.effort.keep(film)
        return film

    def trial(self, logarithm: float, film: PatchFilm, contact: Pressed | None) -> _Trial:
        return _Trial(logarithm, film, contact, _excess(film, contact, self.load))

    def too_little(self, trial: _Trial) -> bool:
        """Whether the largest film that the model has is thicker than what the surfaces leave open under the rest."""
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
        return math.log(self.rough.oil(trial.film) / max(trial.contact.opening, 1e-300))


def _excess(film: PatchFilm, contact: Pressed | None, load: float) -> float:
    return (film.load + (0.0 if contact is None else contact.load) - load) / load


def _holds_oil(trial: _Trial, rough: RoughContact, goal: float) -> bool:
    """Whether the surfaces hold the film's oil, to a goal or to what is known of their opening."""
    assert trial.contact is not None
    oil, opening = rough.oil(trial.film), trial.contact.opening
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
    carry too little at the end of the film's range, or, at the boundary, where the film there is taken for none."""
    film, contact = trial.film, trial.contact
    imbalance = _excess(film, contact, load)
    notes = [*film.notes, *(() if contact is None else contact.notes)]
    oil_imbalance, held = 0.0, True
    if contact is not None and regime is Regime.MIXED:
        oil_imbalance, held = contact.opening / rough.oil(film) - 1, _holds_oil(trial, rough, tolerance)
    if regime is Regime.BOUNDARY:
        left = BOUNDARY_LUBRICATION(share=float(film.load / load), reason="load")
        notes.append(BOUNDARY_LUBRICATION(limit=THINNEST_FILM, reason="thin") if short else left)
        if contact is not None:
            film = film.left_in(contact.opening, rough.oil(film))
    elif short:
        notes.append(FILM_MODEL_ENDS(load=float(film.load), reason="balance"))
    status = Status.CONVERGED
    if film.status is not Status.CONVERGED:
        status = film.status
    elif contact is not None and contact.status is not Status.CONVERGED:
        status = contact.status
    elif abs(imbalance) > tolerance or not held:
        status = Status.INFEASIBLE if short and regime is not Regime.BOUNDARY else Status.STALLED
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
        film_neglected=short and regime is Regime.BOUNDARY,
    )
