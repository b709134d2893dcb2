"""Balance of load between film and rough contact: the film load at which the rough surfaces hold the film's oil.

Unknown: x = ln(F_film / (F - F_film)), the log odds of the film load. Equation: the volume mismatch

    m(x) = ln(mean film thickness under F_film / mean opening of the rough surfaces under F - F_film) = 0.

A film that carries more is thinner, and surfaces that carry less are farther apart, so m decreases with x. In this
variable m is nearly linear: next to either end only one of both changes. The slope that warm starts carry is
-dm / d ln(F_film), positive; over x it is that times F_contact / F, the rest of the load.

1. Full film: the film under the whole load clears the roughness. Return it; no contact is solved. Step 2 finds full
   film too: at the upper end of the search the film is still thicker than the opening under the little that is left.
2. For each level of the film's accuracy, coarse to fine, find the root of m with `find_decreasing_root`. Each trial
   solves one film and one contact under a prescribed load. On coarse levels the contact is solved only as accurately as
   the balance needs, and the last trial is left to the next level where a secant predicts that it meets the goal.
3. Where the opening jumps with the load (cells at the hardness), two trials bracket one load. Keep the film and press
   the surfaces to an approach between those of the two contacts.
4. If the contact's own tolerance hides the root, or if the oil is held only within the error of the opening that this
   tolerance leaves, tighten the tolerance a hundredfold and repeat, down to `FINEST_CONTACT`.
5. Boundary lubrication: a film with a negligible fraction of the load (a tenth of the tolerance) is thinner than the
   opening under the rest. Return this film with the contact under the rest.
6. The largest film load that the film model covers may be too small. If the film there is thinner than a few molecules,
   the film is neglected: return the film and contact of step 5 (boundary lubrication); else the case is infeasible.
7. Certify: recompute both imbalances, of load and of oil, from the film and the contact that are returned. The contact
   load is the sum of its pressure; the film load is the one asked of the film model, for which the film's own status
   stands.

A trial whose film or contact is stalled takes part in the search like any other. If it is the last one, the balance has
its status; if it is not, it leaves no trace but its effect on later trials.

Cost in mixed lubrication from a start at a neighbouring speed: three or four films, coarse and fine, with a contact
each; six to eight from nothing. Nothing here depends on the kind of film or contact. Verified in
tests/friction/test_balance.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from bem.errors import Status
from bem.friction.film import Film, PatchFilm
from bem.friction.rough_contact import Pressed, RoughContact
from bem.grid import FloatArray
from bem.lubrication.checks import THINNEST_FILM
from bem.notes import Note
from bem.notes.friction import BOUNDARY_LUBRICATION, FILM_MODEL_ENDS
from bem.numerics.bracketed_root import find_decreasing_root

MAX_TRIALS = 60
LOAD_RESOLUTION = 0.1
"""Two film loads closer than this fraction of the tolerance count as equal."""
TRIALS_PER_TOLERANCE, FINEST_CONTACT = 20, 1e-9
"""Trials after which the contact's tolerance is tightened, and the tightest one."""
CONTACT_SHARE = 0.1
"""Error of the opening that a contact on coarse levels may have, as a fraction of the goal of the balance."""
SECANT_MARGIN = 0.3
"""Fraction of the goal that a secant must predict for its trial to be left to the next level.

A secant through the mismatches m1 and m2 of a function f leaves about f''/(2 f'^2) m1 m2. That factor is of order one
in the log odds, so the prediction is m1 m2. The smallest earlier mismatch of the level is taken for m1, although the
next step may pass through another trial; a slope that is known counts as one of `SLOPE_ERROR`. A wrong prediction costs
trials on the finer level, and no accuracy.
"""
SLOPE_ERROR = 0.1
"""Relative error of a slope that is known from a similar balance."""
NEGLIGIBLE = 0.1
"""Fraction of the load, over the tolerance of the balance, below which a film is negligible."""
STORED_FILMS = 3
"""Films that are stored as warm starts for others, besides the film under the whole load."""
LEAST_REST = 1e-12
"""Smallest fraction of the load left to the surfaces that the log odds resolve."""
_LEAST_STARTING_REST = 1e-6
"""Smallest fraction of the load left to the surfaces in a first trial."""
_FULLY_YIELDED = 1e-6
"""Relative distance from the largest load of the surfaces within which they yield everywhere."""
_EQUAL_LOGARITHMS = 1e-9
"""Difference below which two logarithms of loads are equal."""


class Regime(StrEnum):
    """Regime of lubrication: one of both ends of the balance, or between them."""

    FULL_FILM = "full film"
    MIXED = "mixed"
    BOUNDARY = "boundary"


@dataclass(frozen=True, eq=False)
class BalanceStart:
    """Warm start of a balance.

    It affects cost and rounding only, as long as m decreases with the film load and so has one root.

    `share_load` reads all but `whole_film`, from which the film under the whole load starts.

    Attributes
    ----------
    film_load : load of the first film [N]; None for half of the load.
    slope : -dm / d ln(film load), of ln(opening / film thickness) over ln(film load), at `film_load`.
    pressure : contact pressure of a similar case [Pa].
    slope_known : whether the slope is that of a similar balance.
    refinement : as of `Balance`, of a similar balance.
    whole_film : coarse film of a similar case under the whole load; None of a ball.
    """

    film_load: float | None = None
    slope: float = 1.0
    pressure: FloatArray | None = None
    slope_known: bool = False
    refinement: float = 0.0
    whole_film: PatchFilm | None = None

    @classmethod
    def from_similar(
        cls, similar_share: float, slope: float, load: float, film_load: float, pressure: FloatArray | None
    ) -> BalanceStart:
        """Return a start from a similar balance, with its slope converted to another film load.

        The slope over the log odds is about constant from full film to contact; that over ln(film load) is inversely
        proportional to the rest of the load.

        Parameters
        ----------
        similar_share : film load over load in the similar balance.
        slope : of the similar balance.
        load : on the whole contact [N].
        film_load : of the first film [N].
        pressure : contact pressure of the similar balance [Pa].
        """
        rest, before = max(1 - film_load / load, LEAST_REST), max(1 - similar_share, LEAST_REST)
        return cls(film_load, slope * before / rest, pressure, slope_known=True)


@dataclass(frozen=True, eq=False)
class Continuation:
    """Parts of the next speed's warm start beside film load, slope and pressure of a solution.

    Attributes
    ----------
    refinement : as of `Balance`.
    speed_power : power of the speed with which the odds of the film load changed between the last two speeds.
    whole_film : coarse film under the whole load; None of a ball.
    """

    refinement: float = 0.0
    speed_power: float = 1.0
    whole_film: PatchFilm | None = None


@dataclass(frozen=True, eq=False)
class Balance:
    """Film and contact that carry a load together.

    Attributes
    ----------
    film : film under its part of the load.
    contact : rough contact under the rest; None in full film.
    imbalance : (film load + contact load - load) / load, of these two.
    slope : -dm / d ln(film load), of ln(opening / film thickness) over ln(film load).
    regime : end of the balance that it is at, or mixed.
    films, contacts : solved in the search; in `SharedLoad.balance` with the films under the whole load.
    convolutions : of the contacts.
    status : converged where film and contact are converged, the load imbalance is within the tolerance, and the oil
        imbalance is within the tolerance or within the error of the opening that the contact's tolerance leaves.
    notes : of film, contact and balance.
    oil_imbalance : (mean opening - mean film thickness) / mean film thickness where oil is counted; not evaluated at
        the ends, where it is set to 0.
    refinement : change of the log odds of the film load from the coarse to the fine level.
    film_neglected : whether the film model ends before the balance, with a film so thin that it carries no load; its
        shear force is part of friction.
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
    films: Film, rough: RoughContact, load: float, tolerance: float, whole: PatchFilm, start: BalanceStart
) -> Balance:
    """Find the balance of a load between film and rough contact.

    Parameters
    ----------
    films : films as a function of their load.
    rough : contact of the rough surfaces.
    load : on the whole contact [N].
    tolerance : largest imbalance, of the load and of the oil; not evaluated for the oil at the ends.
    whole : film under the whole load, or under the largest load of the film model.
    start : warm start.
    """
    history = _SearchHistory(films_known=(whole,), pressure=start.pressure)
    if whole.load >= load and rough.clears(whole):
        trial = _Trial(math.log(load), whole, None, _load_excess(whole, None, load))
        return _certified(trial, rough, load, tolerance, Regime.FULL_FILM, history, start.slope)
    top = math.log(min(load, films.largest_load))
    bottom = min(math.log(NEGLIGIBLE * tolerance * load), top)
    first = 0.5 * load if start.film_load is None else start.film_load
    log_film_load, slope = min(max(math.log(first), bottom), top, math.log(load) - _LEAST_STARTING_REST), start.slope
    if log_film_load <= bottom + _EQUAL_LOGARITHMS and top < math.log(load):
        log_film_load = (
            top  # the start may be at the boundary because the film model ended there: its end decides again
        )
    regime = Regime.MIXED
    for level, error in enumerate(films.level_errors):
        search = _LevelSearch(films, rough, load, max(tolerance, error), level, bottom, top, history)
        history.contact_tolerance = min(history.contact_tolerance, search.starting_contact_tolerance)
        log_load_before = log_film_load
        if level > 0 and regime is Regime.MIXED:
            log_film_load = search.log_load(search.log_odds(log_film_load) + start.refinement)
        found = search.find(log_film_load, slope, slope_known=start.slope_known and level == 0)
        trial, slope, regime, log_film_load = found.trial, found.slope, found.regime, found.next_log_load
        if search.film_model_ends(trial):
            log_film_load = trial.log_load
            history.contact_tolerance = min(history.contact_tolerance, rough.tolerance)
            finest = replace(search, level=len(films.level_errors) - 1, goal=max(tolerance, films.level_errors[-1]))
            if search.film_is_molecular(trial):
                probe = finest.solve_trial()
                return _certified(probe, rough, load, tolerance, Regime.BOUNDARY, history, slope, model_ends=True)
            at_end = finest.solve_trial(log_film_load)
            if search.is_finest or finest.film_model_ends(at_end):
                return _certified(at_end, rough, load, tolerance, regime, history, slope, model_ends=True)
            # only the coarse film is too thick there: the finer levels decide
    balance = _certified(trial, rough, load, tolerance, regime, history, slope)
    if regime is not Regime.MIXED or len(films.level_errors) == 1 or balance.status is not Status.CONVERGED:
        return balance
    return replace(balance, refinement=search.log_odds(log_film_load) - search.log_odds(log_load_before))


@dataclass(frozen=True, eq=False)
class _Trial:
    """One film load with its film and contact.

    log_load : logarithm of the film load. excess : load of film and contact beyond the load, relative to it.
    """

    log_load: float
    film: PatchFilm
    contact: Pressed | None
    excess: float


@dataclass(frozen=True, eq=False)
class _LevelResult:
    """Result of the search at one level of accuracy.

    trial : the last one. slope : over ln(film load) there. next_log_load : logarithm of the film load at which the next
    level starts.
    """

    trial: _Trial
    slope: float
    regime: Regime
    next_log_load: float


@dataclass
class _SearchHistory:
    """Films and pressure that later trials start from, tolerance of the contact, and counts; shared by all levels.

    films_known : the film under the whole load and the last `STORED_FILMS` films.
    """

    films_known: tuple[PatchFilm, ...]
    contact_tolerance: float = math.inf
    pressure: FloatArray | None = None
    films: int = 0
    contacts: int = 0
    convolutions: float = 0.0

    def add_film(self, film: PatchFilm) -> None:
        """Count a solved film and store it as a warm start."""
        self.films += 1
        self.films_known = (self.films_known[0], *self.films_known[1:][1 - STORED_FILMS :], film)

    def nearest_film(self, load: float) -> PatchFilm:
        """Return the stored film whose load is nearest to a load [N], the latest of several.

        The last trial may lie at the other end of the range.
        """
        return min(reversed(self.films_known), key=lambda one: abs(math.log(load / one.load)))

    def add_contact(self, contact: Pressed) -> None:
        """Count a solved contact and store its pressure as the next warm start."""
        self.contacts += 1
        self.convolutions += contact.convolutions
        self.pressure = contact.pressure


@dataclass
class _LevelSearch:
    """Search for the balance at one level of the films' accuracy.

    films, rough : as of `share_load`. load : on the whole contact [N]. goal : largest volume mismatch. bottom, top :
    range of the logarithm of the film load.
    """

    films: Film
    rough: RoughContact
    load: float
    goal: float
    level: int
    bottom: float
    top: float
    history: _SearchHistory

    @property
    def is_finest(self) -> bool:
        """Return True if no finer level follows."""
        return self.level == len(self.films.level_errors) - 1

    @property
    def starting_contact_tolerance(self) -> float:
        """Tolerance of the contact at the start of the search; `_SearchHistory.contact_tolerance` is the current one.

        On the finest level the tolerance that was asked for. On coarse levels only what the balance needs:
        `CONTACT_SHARE` of the goal, times the film thickness over the gap that the contact flattens, at most one.
        """
        asked, film = self.rough.tolerance, self.history.films_known[-1]
        if self.is_finest or asked == 0:
            return asked
        flatness = self.rough.oil(film) / max(float(film.gap.std()), 1e-300)
        return max(asked, CONTACT_SHARE * self.goal * min(flatness, 1.0))

    def find(self, log_film_load: float, slope: float, *, slope_known: bool = False) -> _LevelResult:
        """Find the root of the volume mismatch from a logarithm of the film load; slope as of `BalanceStart`."""
        beyond = self.load - self.rough.largest_load  # load that yielding surfaces leave to the film at least
        yielded = math.log(beyond) + 1e-9 if beyond > 0 else -math.inf
        ends = self.log_odds(max(self.bottom, yielded)), self.log_odds(self.top)
        last: list[tuple[_Trial, bool]] = []
        sides: dict[bool, _Trial] = {}
        # of the next mismatch, as its product with this one: the error of a known slope, and earlier mismatches
        predictors: list[float] = [SLOPE_ERROR] if slope_known else []
        error_before = math.inf

        def evaluate(log_odds: float) -> tuple[float, bool]:
            trial = self.solve_trial(self.log_load(log_odds))
            value = self.mismatch(trial)
            met = _volumes_agree(trial, self.rough, self.goal) or self.next_level_will_do(value, predictors)
            predictors.append(value)
            last[:], sides[value > 0] = [(trial, met)], trial
            return value, met or self.brackets_one_load(sides)

        while True:
            can_tighten = self.history.contact_tolerance > FINEST_CONTACT
            # slope over ln(film load) times the rest is the slope over the log odds
            rest = -math.expm1(log_film_load - math.log(self.load))
            trials = TRIALS_PER_TOLERANCE if can_tighten else MAX_TRIALS
            root = find_decreasing_root(evaluate, self.log_odds(log_film_load), slope * rest, ends, trials)
            ((trial, met),) = last
            assert trial.contact is not None
            # part of the error may not depend on this tolerance, as of tabulated cells
            error_falls, error_before = trial.contact.opening_error <= 0.5 * error_before, trial.contact.opening_error
            log_film_load, inside = trial.log_load, ends[0] < self.log_odds(trial.log_load) < ends[1]
            if not met and self.brackets_one_load(sides):
                pressed = self.press_between(sides[True], sides[False])
                agree = _volumes_agree(pressed, self.rough, self.goal)
                if (agree and self.needs_no_tightening(pressed)) or not (can_tighten and inside):
                    return _LevelResult(pressed, slope, Regime.MIXED, pressed.log_load)
            if met and (self.needs_no_tightening(trial) or not error_falls):
                break
            if not (can_tighten and inside):
                break
            # the effect of the tolerance on the opening may hide the root; trials at another tolerance bracket nothing
            self.history.contact_tolerance = max(0.01 * self.history.contact_tolerance, FINEST_CONTACT)
            predictors.clear()
            sides.clear()
        slope = root.slope / max(1 - trial.film.load / self.load, LEAST_REST)
        touches = trial.contact.status is not Status.INFEASIBLE  # an infeasible contact decides nothing
        if touches and log_film_load >= math.log(self.load) - _EQUAL_LOGARITHMS and self.mismatch(trial) > self.goal:
            return _LevelResult(
                self.with_excess(log_film_load, trial.film, None), slope, Regime.FULL_FILM, log_film_load
            )
        at_bottom = log_film_load <= self.bottom + _EQUAL_LOGARITHMS and self.is_boundary(trial)
        next_log_load = self.log_load(root.next_trial) if met and inside else log_film_load
        return _LevelResult(trial, slope, Regime.BOUNDARY if at_bottom else Regime.MIXED, next_log_load)

    def needs_no_tightening(self, trial: _Trial) -> bool:
        """Return True if a trial that counts as met on this level needs no contact of a tighter tolerance.

        On coarse levels it never does. On the finest level it does where only the error of the opening accepts it.
        """
        return not self.is_finest or _volumes_agree(trial, self.rough, self.goal, within_error=False)

    def next_level_will_do(self, mismatch: float, before: Sequence[float]) -> bool:
        """Return True if a secant predicts that the next trial meets the goal, and a finer level can make that trial.

        before : mismatches of all earlier trials, of which any may predict it; see `SECANT_MARGIN`.
        """
        return not self.is_finest and any(abs(mismatch * one) <= SECANT_MARGIN * self.goal for one in before)

    def log_load(self, log_odds: float) -> float:
        """Return the logarithm of the film load from its log odds."""
        return math.log(self.load) - math.log1p(math.exp(-log_odds))

    def log_odds(self, log_load: float) -> float:
        """Return ln(film load / rest) from the logarithm of the film load."""
        share = math.exp(min(log_load - math.log(self.load), 0.0))
        return math.log(share / max(1 - share, LEAST_REST))

    def brackets_one_load(self, sides: Mapping[bool, _Trial]) -> bool:
        """Return True if a trial with too thick a film (True) and one with too thin a film have equal film loads.

        The opening jumps there: cells at the hardness sink under one load until their neighbours touch.
        """
        if len(sides) < 2:
            return False
        one, other = sides[True].film.load, sides[False].film.load
        return abs(one - other) <= LOAD_RESOLUTION * self.goal * min(one, other)

    def press_between(self, thick: _Trial, thin: _Trial) -> _Trial:
        """Press the surfaces to the approach at which they hold the oil, between two trials under one load."""
        assert thick.contact is not None
        assert thin.contact is not None
        nearest, farthest = thick.contact.approach, thin.contact.approach
        last = [thick]

        def evaluate(fraction: float) -> tuple[float, bool]:
            contact = self.rough.at_approach(
                thick.film,
                nearest + fraction * (farthest - nearest),
                self.history.contact_tolerance,
                self.history.pressure,
            )
            self.history.add_contact(contact)
            last[:] = [self.with_excess(thick.log_load, thick.film, contact)]
            return self.mismatch(last[0]), _volumes_agree(last[0], self.rough, self.goal)

        slope = self.mismatch(thick) - self.mismatch(thin)
        find_decreasing_root(evaluate, 0.5, slope, (0.0, 1.0), TRIALS_PER_TOLERANCE)
        return last[0]

    def solve_trial(self, log_load: float | None = None) -> _Trial:
        """Solve a film, by default one with a negligible load, and the contact under the rest of the load.

        Surfaces that cannot carry the rest carry as much as they can.
        """
        log_load = self.bottom if log_load is None else log_load
        film = self.solve_film(log_load)
        rest = min(self.load - film.load, self.rough.largest_load)
        contact = self.rough.at_load(film, rest, self.history.contact_tolerance, self.history.pressure)
        self.history.add_contact(contact)
        return self.with_excess(log_load, film, contact)

    def solve_film(self, log_load: float) -> PatchFilm:
        """Solve a film, and store it; the nearest stored one is offered as start (with lumped heat only to the films on
        250 cells, unless the loads agree to 1e-3)."""
        load = math.exp(log_load)
        film = self.films.under(load, self.level, self.history.nearest_film(load))
        self.history.add_film(film)
        return film

    def with_excess(self, log_load: float, film: PatchFilm, contact: Pressed | None) -> _Trial:
        """Return a trial with the load that film and contact carry beyond the load."""
        return _Trial(log_load, film, contact, _load_excess(film, contact, self.load))

    def film_model_ends(self, trial: _Trial) -> bool:
        """Return True if the film under the largest load of its model is still thicker than the opening under the
        rest."""
        if self.top >= math.log(self.load) - _EQUAL_LOGARITHMS:  # `find` takes that end for full film
            return False
        at_end = trial.log_load >= self.top - _EQUAL_LOGARITHMS
        return at_end and self.mismatch(trial) > self.goal

    def film_is_molecular(self, trial: _Trial) -> bool:
        """Return True if the film is thinner than a few molecules, and the surfaces can carry the load without it."""
        return trial.film.carrying_thickness < THINNEST_FILM and self.load <= self.rough.largest_load

    def is_boundary(self, probe: _Trial) -> bool:
        """Return True if a film with a negligible load is thinner than the opening of the surfaces."""
        return self.mismatch(probe) <= 0

    def mismatch(self, trial: _Trial) -> float:
        """Return the volume mismatch ln(film thickness / opening) where oil is counted."""
        assert trial.contact is not None
        return math.log(self.rough.oil(trial.film) / max(trial.contact.opening, 1e-300))


def _load_excess(film: PatchFilm, contact: Pressed | None, load: float) -> float:
    """Return the load of film and contact beyond a load [N], relative to it."""
    return (film.load + (0.0 if contact is None else contact.load) - load) / load


def _volumes_agree(trial: _Trial, rough: RoughContact, goal: float, *, within_error: bool = True) -> bool:
    """Return True if the opening holds the film's oil, to a goal or, by `within_error`, to the error of the opening."""
    assert trial.contact is not None
    oil, opening = rough.oil(trial.film), trial.contact.opening
    if within_error and abs(opening - oil) <= trial.contact.opening_error * (1 + 1e-9):
        return True
    return opening > 0 and abs(math.log(oil / opening)) <= goal


def _certified(
    trial: _Trial,
    rough: RoughContact,
    load: float,
    tolerance: float,
    regime: Regime,
    history: _SearchHistory,
    slope: float,
    *,
    model_ends: bool = False,
) -> Balance:
    """Build the balance of the last trial, with imbalances, status and notes recomputed from its film and contact.

    In boundary lubrication a starved film is sheared across the opening of the surfaces; a flooded one keeps its
    stress, an upper bound. `model_ends` says that the film
    model ended before the balance: the case is infeasible, or in boundary lubrication its film is neglected. Surfaces
    that yield everywhere under the rest, and still leave more open than the film fills, make it infeasible as well.
    """
    film, contact = trial.film, trial.contact
    imbalance = _load_excess(film, contact, load)
    notes = [*film.notes, *(() if contact is None else contact.notes)]
    oil_imbalance, held = 0.0, True
    if contact is not None and regime is Regime.MIXED:
        oil_imbalance, held = contact.opening / rough.oil(film) - 1, _volumes_agree(trial, rough, tolerance)
    if regime is Regime.BOUNDARY:
        left = BOUNDARY_LUBRICATION(share=float(film.load / load), reason="load")
        notes.append(BOUNDARY_LUBRICATION(limit=THINNEST_FILM, reason="thin") if model_ends else left)
        if contact is not None:
            film = film.sheared_in(contact.opening, rough.oil(film))
    elif model_ends:
        notes.append(FILM_MODEL_ENDS(load=float(film.load), reason="balance"))
    status = Status.CONVERGED
    if film.status is not Status.CONVERGED:
        status = film.status
    elif contact is not None and contact.status is not Status.CONVERGED:
        status = contact.status
    elif abs(imbalance) > tolerance or not held:
        yielded = contact is not None and not held and contact.load >= rough.largest_load * (1 - _FULLY_YIELDED)
        ends = (model_ends or yielded) and regime is not Regime.BOUNDARY
        status = Status.INFEASIBLE if ends else Status.STALLED
    return Balance(
        film=film,
        contact=contact,
        imbalance=imbalance,
        slope=slope,
        regime=regime,
        films=history.films,
        contacts=history.contacts,
        convolutions=history.convolutions,
        status=status,
        notes=tuple(notes),
        oil_imbalance=oil_imbalance,
        film_neglected=model_ends and regime is Regime.BOUNDARY,
    )
