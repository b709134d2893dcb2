"""What `bem element` answers on one screen: critical contact, film, friction, temperatures and safety.

Rows of words from numbers that other modules compute: `running` the films, `bearing_life` and `gear_scuffing` the
ratings, `element_wear` wear. A friction power with asperity contact is an estimate from the load share of Zhou and
Hoeprich; of a bush it is that of kind friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

from bem.elements.bearing_life import bearing_life, life_notes, life_rows
from bem.elements.bush_answer import (
    JOURNAL,
    FilmOfBush,
    bush_notes,
    bush_rows,
    bush_temperature,
    friction_power_of,
    journal_of,
    pressure_words,
    thick_film_words,
)
from bem.elements.cam_follower import CamModel
from bem.elements.contact import EVEN, ElementContact
from bem.elements.element import AT_MARK, LIFE, MIXED, Element
from bem.elements.element_wear import particles_per_hour, wear_per_hour, worn_volume_rate
from bem.elements.gear_pair import GearModel
from bem.elements.gear_scuffing import (
    estimated_bulk,
    friction_of_gear_tests,
    scuffing_of,
    sliding_power,
    tooth_loss_power,
)
from bem.elements.model import FULL_FILM, LEAST_ASPERITY_SHARE
from bem.elements.plain_bush import PlainBushModel
from bem.elements.rolling_bearing import USUAL_BALL_FRICTION, BearingModel, usual_ball_moment
from bem.elements.rough_scenes import FINISHES
from bem.elements.running import Running, columns, over_slices, run_all
from bem.elements.running import notes as film_notes
from bem.errors import InputError
from bem.notes import Note
from bem.notes.elements import (
    BALANCE_BELOW_USUAL,
    BUSH_BOUNDS,
    BUSH_CONFORMS,
    BUSH_FLOATS,
    BUSH_LEAKS,
    BUSH_LIQUID_LOST,
    BUSH_ROUGHNESS_MISSING,
    BUSH_SWINGS,
    BUSH_TOUCHES,
    BUSH_WARMER_THAN_OIL,
    BUSH_WEARS_IN_FILM,
    FILM_BY_SQUEEZE,
    GLYCOL_ASSUMED,
    NO_HEAT,
    OIL_FOLLOWS_BALANCE,
    SURFACES_TOUCH,
    VISCOSITY_FIXED,
)
from bem.notes.note import has_code, percent, without
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import plain_digits, with_unit

Rows = tuple[tuple[str, str], ...]

FORMULA_FILMS = ("minimum_film [m]", "film_over_roughness")
"""Columns of films by the formula."""
_OF_FILMS = (
    *(BUSH_LEAKS, BUSH_SWINGS, BUSH_FLOATS, BUSH_BOUNDS, BUSH_TOUCHES, BUSH_LIQUID_LOST, BUSH_WARMER_THAN_OIL),
    *(
        BUSH_WEARS_IN_FILM,
        BUSH_ROUGHNESS_MISSING,
        GLYCOL_ASSUMED,
        NO_HEAT,
        OIL_FOLLOWS_BALANCE,
        VISCOSITY_FIXED,
        SURFACES_TOUCH,
    ),
    FILM_BY_SQUEEZE,
)
"""Notes that a scene of the dry contact has no use for."""
PLACES = 11
"""Films that are solved for an answer on one screen, beside marked and extreme contacts; `--running` solves all."""
_LEAST_SCATTER = 0.005
"""Scatter of the friction power, over it, below which it is left out."""
_LEAST_RATIO, _LEAST_RATIO_SUPERFINISHED = 2.0, 1.0
"""Lambda ratio below which scenes of new ground and honed surfaces have a much larger load share of asperities than the
estimate (5 % estimated against 51 % at 1.5, 20 against 59 % at 0.80, 36 against 84 % at 0.6), and of superfinished ones
often a smaller one."""
_NEW_SURFACES = (
    ". The estimate is a fit for ground, run-in surfaces: asperities of new ones with random roughness, as in scenes "
    "of kind friction, carry {more}, and friction lies between both"
)
_SUPERFINISHED = (
    ". The estimate is a fit for ground, run-in surfaces; on the long waves of superfinished ones, as in scenes of "
    "kind friction, asperities often carry less"
)
"""Of roller bearings 51 % estimated against 35 % in the scene at a lambda ratio of 0.40, 26 against 20 % at 0.71."""
_FAR_MORE = 1.25
"""Usual friction power of ball bearings over that of their films from which a heat balance is said to be too cold."""
_NEARLY_ALL = 0.9
"""Estimated load share of asperities above which new surfaces, which carry more, are said to carry nearly all."""
_BALANCE_ROUNDS, _BALANCE_STEP, _HALVINGS = 20, 0.2, 6
"""Rounds of a heat balance at most, the difference of temperature [K] at which it is found, and how often a step is
halved that leaves the temperatures of the oil."""


@dataclass(frozen=True)
class FrictionPower:
    """Friction power of an element [W].

    film : of the oil films. within_contacts : part of `film` in which balls slide within their curved contacts.
    with_asperities : estimate with asperity contact, which is boundary friction where there is no steady film; None
    without roughness.
    down, up : scatter of `film` from the oil's constants; None but with the law of base oils.
    counted : share of the places that have a steady film.
    """

    film: float
    within_contacts: float
    with_asperities: float | None
    down: float | None
    up: float | None
    counted: float


def friction_power(element: Element, runs: Sequence[Running]) -> FrictionPower:
    """Sum up the friction power of all contacts at a time; places without a solved film between others interpolate.

    runs : solved films; those that did not converge are left out.
    """
    import numpy as np

    found = element.found
    known = sorted((one for one in runs if one.converged), key=lambda one: one.contact.place)

    def steady(one: ElementContact) -> bool:
        return abs(one.slide_roll_ratio) <= 2

    def mean(value: Callable[[Running], float]) -> float:
        """Return the mean over all places of value per load times load, of rollers summed over slices.

        Places that are on both rings of a bearing keep their own values.
        """
        own = {one.contact: value(one) for one in known}

        def power(one: ElementContact) -> float:
            if one.slices:
                return over_slices(one, known, value)
            if one in own:
                return own[one]
            like = [run for run in known if run.contact.path == one.path] or known
            per_load = [value(run) / run.contact.load for run in like]
            return one.load * float(np.interp(one.place, [run.contact.place for run in like], per_load))

        return found.mean(power, steady) * found.at_once

    mixed = None
    if all(one.asperity_share is not None for one in known):
        boundary = element.model.boundary_friction
        mixed = mean(lambda one: _power_with_asperities(one, boundary))
        rubbing = found.mean(
            lambda one: one.load * abs(one.speeds[0] - one.speeds[1]), counts=lambda one: not steady(one)
        )
        mixed = max(mixed, 0.0) + boundary * rubbing * found.at_once
    down = up = None
    if all(one.scatter is not None for one in known):
        down, up = (mean(partial(_scattered, k)) for k in (0, 1))
    return FrictionPower(
        mean(lambda one: one.power),
        mean(lambda one: 0.0 if one.sliding is None else one.sliding.power),
        mixed,
        down,
        up,
        1 - found.mean(lambda one: 1.0, lambda one: not steady(one)),
    )


def _power_with_asperities(one: Running, boundary: float) -> float:
    """Return the friction power of film and asperities [W]: by kind friction, or from the estimated share.

    Asperities take their share of the sliding friction. Rolling resistance arises in the inlet, before the asperities
    touch, and is that of the whole film. So does SKF's model of the frictional moment (catalogue of rolling bearings),
    which weights the coefficient of sliding friction by the share of asperities, and not the rolling moment.
    """
    if one.mixed_friction is not None:
        return one.mixed_friction * one.slid
    return one.power + (one.asperity_share or 0.0) * (boundary * one.slid - (one.power - one.rolling_power))


def _scattered(side: int, one: Running) -> float:
    """Return the scatter of a contact's friction power [W]: side 0 down, 1 up."""
    return one.slid * (one.scatter or (0.0, 0.0))[side]


def likely_power(element: Element, runs: Sequence[Running]) -> float:
    """Return the likely friction power [W]: of gears with roughness by the fit to gear tests, of a bush by a given
    friction coefficient, of others with asperity contact, without roughness that of the films."""
    if (known := _power_without_films(element)) is not None:
        return known
    power = friction_power(element, runs)
    return power.film if power.with_asperities is None else power.with_asperities


def _power_without_films(element: Element) -> float | None:
    """Return the likely friction power [W] where no film decides it, else None."""
    if isinstance(element.model, GearModel):
        tests = friction_of_gear_tests(element)
        if tests is not None:
            return sliding_power(element, tests.power)
    if isinstance(element.model, PlainBushModel) and element.model.friction is not None:
        return element.model.friction * element.model.radial_load * element.model.sliding_speed
    return None


def balance_heat(
    element: Element, *, most: int = PLACES, told: Callable[[int, int], None] = lambda done, total: None
) -> Element:
    """Return the element with the bulk temperature of its heat balance, or of gears without one an estimate.

    The bulk temperature is that of the surroundings plus friction power (`likely_power`) over conductance,
    found by secants; with `thermal = "full"` from the balance with lumped heat on. Films of gears are at their bulk
    temperature, as ISO/TS 6336-22 takes the viscosity in its film thickness (known from textbooks; the standard was not
    read): without one of the file it is that of scuffing, `bem.elements.gear_scuffing.estimated_bulk`. A lubricated
    bush without a balance has the usual conductance. Other elements without a balance are returned as they are.
    `told` says how many films of a round are solved.
    """
    balance = element.model.heat_balance
    if isinstance(element.model, PlainBushModel):
        return _balance_bush(element, element.model, told)
    if isinstance(element.model, GearModel) and (estimate := estimated_bulk(element)) is not None:
        return element.at_bulk(estimate, estimated=True)
    if balance is None or element.model.oil is None or element.model.oil.temperature is None:
        return element
    around = element.model.oil.temperature if balance.ambient is None else balance.ambient
    conductance = balance.conductance
    assert conductance is not None

    def excess_with(heat: Element, temperature: float) -> float:
        at = heat.at_bulk(temperature)
        power = _power_without_films(at)
        if power is None:
            power = likely_power(at, run_all(at, told, most=most))
        return around + power / conductance - temperature

    def balanced(heat: Element, start: float) -> float:
        try:
            return _balanced(partial(excess_with, heat), start)
        except InputError as error:
            raise InputError(
                f"heat_balance: with {conductance:g} W/K friction warms the bodies beyond what the oil stands; check "
                f"conductance, load and speed. {error}"
            ) from None

    start = around
    if element.model.thermal == "full" and _power_without_films(element) is None:
        lumped = replace(
            element,
            model=element.model.model_copy(update={"thermal": "lumped"}),
            table={**element.table, "thermal": "lumped"},
        )
        start = balanced(lumped, around)
    return element.at_bulk(balanced(element, start))


def _balance_bush(element: Element, model: PlainBushModel, told: Callable[[int, int], None]) -> Element:
    """Return a lubricated bush at the temperature of its heat balance, with the usual conductance if none is given.

    A dry bush, one of given temperature, and one whose liquid has no temperature are returned as they are: their
    friction does not depend on it. So is one without a film that converges.
    """
    if model.oil is None or model.oil.temperature is None or model.bulk_temperature is not None:
        return element
    if model.friction is not None:  # no film decides it
        return element.at_bulk(model.surroundings + likely_power(element, ()) / model.conductance)

    def excess(temperature: float) -> float:
        at = element.at_bulk(temperature)
        runs = [one for one in run_all(at, told) if one.converged]
        if not runs:
            raise _NoFilm
        return model.surroundings + likely_power(at, runs) / model.conductance - temperature

    try:
        return element.at_bulk(_balanced(excess, model.surroundings))
    except _NoFilm:
        return element
    except InputError:
        jump = _jump(excess, model.surroundings)
        if jump is None:
            raise
        return element.at_bulk(jump)


def _jump(excess: Callable[[float], float], around: float) -> float | None:
    """Return the temperature [K] at which an excess over it jumps past zero; None without a change of sign.

    The friction of a bush jumps where its film becomes thicker than the radial clearance.
    """
    low, high = around, around + excess(around)
    try:
        high, above = _within_oil(excess, low, high)
        if not (low < high and above < 0):
            return None
        while high - low > _BALANCE_STEP:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
    except InputError:
        return None
    return high


class _NoFilm(Exception):
    """No film of a heat balance converged."""


def _balanced(excess: Callable[[float], float], around: float) -> float:
    """Return the temperature [K] at which an excess over it [K] vanishes, by secants from that of the surroundings.

    Raises
    ------
    InputError : no such temperature is found.
    """
    low, error = around, excess(around)
    high = low + error
    for _ in range(_BALANCE_ROUNDS):
        if abs(error) < _BALANCE_STEP:
            return high
        high, now = _within_oil(excess, low, high)
        if now == error:
            break
        low, high, error = high, high - now * (high - low) / (now - error), now
    if abs(error) < _BALANCE_STEP:
        return high
    raise InputError(
        "heat_balance: no temperature is found at which friction power equals conductance times rise; the last one, "
        f"{low - ZERO_CELSIUS:.0f} degC, misses by {abs(error):.2g} K; allowed: another conductance, or "
        "bulk_temperature"
    )


def _within_oil(excess: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Return a temperature and its excess [K]: `high`, or halfway to `low` as often as the oil is not defined there.

    Raises
    ------
    InputError : that of the oil near `low`.
    """
    for _ in range(_HALVINGS):
        try:
            return high, excess(high)
        except InputError:
            high = 0.5 * (low + high)
    return high, excess(high)


def answer(element: Element, solved: Sequence[Running]) -> Rows:
    """Return the answer in rows of name and words.

    solved : films of all places or of a selection.
    """
    runs = [one for one in solved if one.converged]
    if isinstance(element.model, PlainBushModel):
        return _bush(element, element.model, runs, solved)
    rows: list[tuple[str, str]] = [("critical contact", contact_words(element, element.critical()))]
    if element.model.oil is None:
        rows.append(("lubrication", "dry: the file has no [oil], so films, friction and temperatures are left out"))
    if runs:
        rows += [
            ("lambda ratio", _film(element, runs)),
            *_marked(element, runs),
            *_friction_rows(element, runs),
            ("temperatures", _temperatures(element, runs)),
        ]
    if isinstance(element.model, GearModel) and runs:
        rows.append(("scuffing", _scuffing(element, runs)))
    if isinstance(element.model, BearingModel):
        rows += life_rows(element, least_film_ratio(runs))
    if runs and (isinstance(element.model, GearModel | CamModel) or element.model.permissible_film_ratio is not None):
        rows.append(("micropitting", _micropitting(element, runs)))
    rows.append(("wear per hour", wear_per_hour(element)))
    if worn_volume_rate(element) > 0:
        rows.append(("worn volume per hour", particles_per_hour(element)))
    return (*rows, *_lost(element, solved))


def _lost(element: Element, solved: Sequence[Running]) -> Rows:
    """Return the row of the films that did not converge, none where all did."""
    lost = [one for one in solved if not one.converged]
    if not lost:
        return ()
    said = f"{len(lost)} of {len(solved)} films, the first at {place_words(element, lost[0].contact)}"
    return (("not converged", said),)


def _bush(element: Element, model: PlainBushModel, runs: Sequence[Running], solved: Sequence[Running]) -> Rows:
    """Return the rows of the answer of a bush."""
    film_of_it = film_of_bush(element, runs)
    said = None if film_of_it is None else thick_film_words(model, film_of_it)
    film = [("lambda ratio", said or _film(element, runs))] if runs else []
    rows = bush_rows(model, film_of_it)
    if model.mean_particle_volume is not None:
        rows.append(("worn volume per hour", particles_per_hour(element)))
    return (("critical contact", pressure_words(model)), *film, *rows, *_lost(element, solved))


def least_film_ratio(solved: Sequence[Running]) -> float | None:
    """Return the smallest lambda ratio of the films that converged; None without roughness or films."""
    return min((one.film_ratio for one in solved if one.converged and one.film_ratio is not None), default=None)


def film_of_bush(element: Element, runs: Sequence[Running]) -> FilmOfBush | None:
    """Return the film of a bush from its solved films that converged; None without one."""
    if not runs:
        return None
    warm, own = element.model.film_temperature, friction_power(element, runs)
    slid = sum(one.slid for one in runs)
    hottest = max((one.surface for one in runs if one.surface is not None), default=None)
    return FilmOfBush(
        likely_power(element, runs),
        max(one.asperity_share or 0.0 for one in runs),
        share_known=all(one.asperity_share is not None for one in runs),
        solved=all(one.mixed_friction is not None for one in runs),
        touching=any((one.film_ratio or 1.0) < 1 for one in runs),
        rise=0.0 if hottest is None or warm is None else max(hottest - warm, 0.0),
        thickness=min(one.impossible_film or one.minimum_film for one in runs),
        friction=(own.film if own.with_asperities is None else own.with_asperities) / slid,
    )


def _balance_below_usual(element: Element, runs: Sequence[Running]) -> Note | None:
    """Return a note on a heat balance of balls whose films have far less friction than such bearings usually have."""
    model, start = element.model, element.balanced_from
    assert isinstance(model, BearingModel)
    if not runs or start is None or model.bulk_temperature is None or model.length is not None:
        return None
    films = likely_power(element, runs)
    usual = usual_ball_moment(bearing_life(element).rating.load, model.bore) * model.speed
    if usual < _FAR_MORE * films:
        return None
    celsius = start + (model.bulk_temperature - start) * usual / films - ZERO_CELSIUS
    return BALANCE_BELOW_USUAL(celsius=celsius, usual=usual, films=films)


def answer_notes(element: Element, solved: Sequence[Running]) -> tuple[Note, ...]:
    """Return notes on limits that the answer exceeds; `solved` as in `answer`."""
    runs = [one for one in solved if one.converged]
    if isinstance(element.model, BearingModel):
        cold = _balance_below_usual(element, runs)
        return (*([] if cold is None else [cold]), *life_notes(element, least_film_ratio(runs)))
    if not isinstance(element.model, PlainBushModel):
        return ()
    return bush_notes(element.model, film_of_bush(element, runs))


def all_notes(element: Element, solved: Sequence[Running]) -> tuple[Note, ...]:
    """Return the notes on an element, on its answer and on its solved films; `solved` as in `answer`.

    Where the film of a bush is outside the model or between bounds, the weaker cautions that take it for an estimate or
    an upper bound are left out. Where films are solved, places with a lambda ratio below one are counted by them.
    """
    own = element.notes()
    if any(one.converged and one.film_ratio is not None for one in solved):
        touching = element.touching_note(_ratios_by_films(element, solved))
        own = (*without(own, SURFACES_TOUCH), *([] if touching is None else [touching]))
    found = (*own, *answer_notes(element, solved), *film_notes(solved, element.found.marks))
    if has_code(found, BUSH_FLOATS):
        return without(found, BUSH_CONFORMS, BUSH_LEAKS)
    return without(found, BUSH_LEAKS) if has_code(found, BUSH_BOUNDS) else found


def _ratios_by_films(element: Element, solved: Sequence[Running]) -> list[float]:
    """Return the lambda ratios of all contacts: those of the solved films, and elsewhere that of the formula times what
    the film of the nearest solved place is of its own formula; without a steady film, the formula's."""
    contacts, formula = element.found.contacts, element.columns()["film_over_roughness"]
    own = {one.contact: one.film_ratio for one in solved if one.converged and one.film_ratio is not None}
    over = [(one, own[one] / ratio) for one, ratio in zip(contacts, formula, strict=True) if one in own]

    def ratio(one: ElementContact, by_formula: float) -> float:
        if one in own:
            return own[one]
        if abs(one.slide_roll_ratio) > 2 or not over:
            return by_formula
        return by_formula * min(over, key=lambda each: abs(each[0].place - one.place))[1]

    return [ratio(one, by_formula) for one, by_formula in zip(contacts, formula, strict=True)]


def scene_notes(element: Element, solved: Sequence[Running], kind: str) -> tuple[Note, ...]:
    """Return the notes on an element that matter to a scene of a kind; those on its film come with the run.

    solved : film of a bush, of which its scene has the limits.
    """
    found = all_notes(element, [replace(one, notes=()) for one in solved])
    if kind == "contact":
        return without(found, *_OF_FILMS)
    if kind in (*MIXED, LIFE):  # the run has the load share of asperities
        found = without(found, SURFACES_TOUCH, BUSH_TOUCHES)
    found = without(found, BUSH_WEARS_IN_FILM, BUSH_ROUGHNESS_MISSING)
    return tuple(
        BUSH_FLOATS(**{**note.values, "reason": "beyond-scene"})
        if has_code([note], BUSH_FLOATS, reason="beyond")
        else note
        for note in found
    )


def table_columns(element: Element, runs: Sequence[Running]) -> dict[str, list[float]]:
    """Return the columns of solved films, see `bem.elements.running.columns`; none without films.

    Of a bush the friction power with asperities, the bush's temperature and, beside a film that reaches far around, the
    estimated film of a journal bearing stand beside them; a film by the formula is left out where the solved one is
    thicker than the clearance. It has no wear per pass: the load stays on one place of the bush.
    """
    found = columns(element, runs) if runs else {}
    if not isinstance(element.model, PlainBushModel):
        return found
    found = {name: values for name, values in found.items() if not name.startswith("wear_per_pass")}
    film = film_of_bush(element, [one for one in runs if one.converged])
    journal = None if film is None else journal_of(element.model, film)
    if journal is not None:
        found[JOURNAL] = [journal.minimum_thickness]
    if any(one.impossible_film for one in runs):
        found |= {name: [math.nan] for name in FORMULA_FILMS if name in element.columns()}
    power = friction_power_of(element.model, film)[0]
    if power is None:
        return found
    temperature = bush_temperature(element.model, power)
    return found | {"friction_power_with_asperities [W]": [power], "bush_temperature [K]": [temperature]}


def place_words(element: Element, one: ElementContact) -> str:
    """Return where a contact is: on a path of contact its distance from C, with the mark that it is the nearest
    contact to; of a cam or ring the angle; of a bearing the ring and the angle from the load."""
    model = element.model
    if isinstance(model, BearingModel):
        return one.name
    if isinstance(model, PlainBushModel):
        return one.name
    if not isinstance(model, GearModel):
        return f"{'cam' if isinstance(model, CamModel) else 'crank'} angle {one.name}"
    distance = f"{1e3 * abs(one.place):.3g} mm {'before' if one.place < 0 else 'after'} C"
    for mark, place in element.found.marks.items():
        if abs(one.place - place) < AT_MARK:
            return f"{mark} ({distance})" if mark != "C" else "C"
        if min(element.found.contacts, key=lambda other: abs(other.place - place)) == one:
            return f"near {mark} ({distance})"
    return distance


def contact_words(element: Element, one: ElementContact) -> str:
    """Return a contact's pressure, load, radius and speeds in words."""
    if isinstance(element.model, PlainBushModel):
        return pressure_words(element.model)
    hertz = one.hertz(element.modulus)
    sliding = abs(one.speeds[0] - one.speeds[1])
    moves = f"entrainment {one.mean_speed:.3g} m/s" + (f", sliding {sliding:.3g} m/s" if sliding else ", pure rolling")
    uneven = one.load / one.carried
    slice_words = f" in its most loaded slice ({uneven:.3g} x its mean load per length)" if uneven > EVEN else ""
    if isinstance(element.model, BearingModel):
        slice_words += element.model.edge_words
    return (
        f"{place_words(element, one)}: Hertz pressure {with_unit(hertz.maximum_pressure, 'Pa')}{slice_words}, "
        f"load {with_unit(one.carried, 'N')}, radius {with_unit(one.radius, 'm')}, {moves}"
    )


def _film(element: Element, runs: Sequence[Running]) -> str:
    """Return the lambda ratio of the thinnest film in words, with its regime and the load share of asperities."""
    thinnest = min(runs, key=lambda one: one.minimum_film)
    film = f"minimum film {with_unit(thinnest.minimum_film, 'm')} at {place_words(element, thinnest.contact)}"
    if thinnest.film_ratio is None:
        return f"not known: give rms_roughness, of both surfaces together; {film}"
    ratio = thinnest.film_ratio
    regime = (
        "full film"
        if ratio >= FULL_FILM
        else "mixed lubrication"
        if ratio < 1
        else "thin film, highest asperities touch"
    )
    share = max(one.asperity_share or 0.0 for one in runs)
    touching = (
        f"; asperities carry some {percent(share)} of the load, an estimate" if share >= LEAST_ASPERITY_SHARE else ""
    )
    if touching and thinnest.mixed_friction is not None:
        touching = f"; asperities carry {percent(share)} of the load"
        film += ", if the film carried the whole load"
    cool = ""
    if element.bulk_estimated:
        cool = f"; about {_ratio_at_oil(element, thinnest):.3g} if the flanks were only as warm as the oil"
    smoother = FINISHES.get(element.model.element) == "superfinished"
    more = "nearly all of the load" if share > _NEARLY_ALL else "far more"
    rougher = ""
    least = _LEAST_RATIO_SUPERFINISHED if smoother else _LEAST_RATIO
    if touching and ratio < least and thinnest.mixed_friction is None:
        rougher = _SUPERFINISHED if smoother else _NEW_SURFACES.format(more=more)
    return f"{ratio:.3g} ({regime}{touching}), {film}{cool}{_unsolved_words(element)}{rougher}"


def unsolved_ratio(element: Element) -> tuple[float, ElementContact] | None:
    """Return the smallest lambda ratio by the formula of the places without a steady film, and its contact.

    None without such places, or without roughness.
    """
    ratios = element.columns().get("film_over_roughness")
    if ratios is None:
        return None
    against = [i for i, one in enumerate(element.found.contacts) if abs(one.slide_roll_ratio) > 2]
    if not against:
        return None
    least = min(against, key=lambda i: ratios[i])
    return ratios[least], element.found.contacts[least]


def _unsolved_words(element: Element) -> str:
    """Return what the formula gives where the surfaces run against each other; empty without such places."""
    found = unsolved_ratio(element)
    if found is None:
        return ""
    ratio, one = found
    contacts = element.found.contacts
    against = sum(abs(each.slide_roll_ratio) > 2 for each in contacts)
    said = f"{ratio:.2g} at {place_words(element, one)}"
    worst = element.worst()
    if abs(worst.slide_roll_ratio) > 2 and worst != one:
        said += (
            f", {element.columns()['film_over_roughness'][contacts.index(worst)]:.2g} at {place_words(element, worst)}"
        )
    return (
        f". Not solved at {against} of {len(contacts)} positions, where the surfaces run against each other: by the "
        f"formula lambda is {said}"
    )


_NEAR = 0.02
"""Distance from a marked place over the path's length up to which a film stands for it."""


def _marked(element: Element, runs: Sequence[Running]) -> list[tuple[str, str]]:
    """Return a row for each marked place, A to E of gears, that has a solved film."""
    rows = []
    for mark, place in element.found.marks.items():
        one = min(runs, key=lambda run: abs(run.contact.place - place))
        if abs(one.contact.place - place) > _NEAR * (runs[-1].contact.place - runs[0].contact.place):
            continue
        said = [f"minimum film {with_unit(one.minimum_film, 'm')}"]
        said += [] if one.film_ratio is None else [f"lambda {one.film_ratio:.3g}"]
        said.append(f"film friction {abs(one.friction):.2g}")
        said += [] if one.oil is None else [f"oil {one.oil - ZERO_CELSIUS:.3g} °C"]
        said += [] if one.surface is None else [f"hotter surface {one.surface - ZERO_CELSIUS:.3g} °C"]
        exact = abs(one.contact.place - place) < AT_MARK
        rows.append((f"at {mark}" if exact else f"near {mark}", ", ".join(said)))
    return rows


def _ratio_at_oil(element: Element, one: Running) -> float:
    """Return the lambda ratio of a contact with bodies as warm as the oil: the solved one times that of the fits."""
    model, modulus = element.model, element.modulus
    assert model.oil is not None
    assert model.film_oil is not None
    assert one.film_ratio is not None
    cool, warm = (one.contact.minimum_film(modulus, oil.build()) for oil in (model.oil, model.film_oil))
    return one.film_ratio * cool / warm


def _friction_rows(element: Element, runs: Sequence[Running]) -> list[tuple[str, str]]:
    """Return the rows of friction power, coefficient and losses."""
    power, model = friction_power(element, runs), element.model
    film = f"{plain_digits(power.film, 3)} W if oil films carry the whole load"
    if power.with_asperities is None or power.with_asperities <= 1.01 * power.film:
        film = f"{plain_digits(power.film, 3)} W in the oil films"
    if power.down and power.up and max(power.down, power.up) > _LEAST_SCATTER * power.film:
        least = max(power.film - power.down, 0.0)
        film += f" ({plain_digits(least)} to {plain_digits(power.film + power.up)} W with other oils of this base)"
    losses, said = [power.film], [film]
    if power.with_asperities is not None and power.with_asperities > 1.01 * power.film:
        losses.append(power.with_asperities)
        unsolved = ", and the whole load where no film is solved," if power.counted < 1 else ""
        said.append(
            f"{plain_digits(power.with_asperities, 3)} W if the estimated share of asperities{unsolved} rubs with "
            f"boundary friction {model.boundary_friction:g}"
        )
    if power.counted < 1:
        counts = "are left out" if power.with_asperities is None else "are left out of the former"
        contacts = element.found.contacts
        against = sum(abs(one.slide_roll_ratio) > 2 for one in contacts)
        said.append(
            f"{against} of {len(contacts)} positions {counts}: surfaces that run against each other have no steady film"
        )
    if isinstance(model, CamModel):
        said.append("means over the whole turn, without contact on the base circle")
    rows = []
    if isinstance(model, GearModel):
        tests = friction_of_gear_tests(element)
        if tests is not None:
            losses.append(sliding_power(element, tests.power))
            by_tests = plain_digits(losses[-1], 3)
            sharing = "even along all lines of contact" if model.helix_angle else "shared by the teeth (ISO/TR 15144-1)"
            best = (
                f"{by_tests} W by a fit to gear tests (Schlenk, mean friction coefficient {tests.power:.3g}) with the "
                f"load {sharing}, {plain_digits(tooth_loss_power(model, tests.power), 3)} W with the tooth loss factor "
                "H_v of textbooks (compare helical with spur gears by the latter)"
            )
            said.insert(0, best)
        given = model.pinion_torque * model.speed
        least, most = (100 * (1 - loss / given) for loss in (max(losses), min(losses)))
        span = f"{least:.2f} to {most:.2f} %" if f"{least:.2f}" != f"{most:.2f}" else f"{least:.2f} %"
        rows.append(
            (
                "efficiency",
                f"{span} of {with_unit(given, 'W')}: tooth friction alone, without churning, bearings, seals",
            )
        )
    elif isinstance(model, BearingModel):
        rows.append(("friction moment", _moment(element, model, power)))
    return [("friction power", "; ".join(said)), *rows]


def _moment(element: Element, model: BearingModel, power: FrictionPower) -> str:
    """Return the friction moment of a bearing in words: of the films, and what is missing."""

    def moment(part: float) -> str:
        return f"{plain_digits(1e3 * part / model.speed, 3)} N mm"

    said = f"{moment(power.film)} of the oil films"
    if model.length is not None:
        return f"{said}, without cage, roller ends, churning and seals"
    said += (
        f": {moment(power.film - power.within_contacts)} of rolling, {moment(power.within_contacts)} of sliding within "
        "the curved contacts (Heathcote"
    ) + (" and spin)" if model.axial_load else ")")
    usual = plain_digits(1e3 * usual_ball_moment(bearing_life(element).rating.load, model.bore), 3)
    load = "P" if model.axial_load else "load"
    return (
        f"{said}; without cage, churning and seals. The usual estimate of all, {USUAL_BALL_FRICTION:g} x {load} x bore "
        f"/ 2, is {usual} N mm"
    )


def _temperatures(element: Element, runs: Sequence[Running]) -> str:
    """Return the temperatures of oil, surfaces and bodies in words."""
    model = element.model
    assert model.oil is not None
    if model.oil.temperature is None:
        return "not known: give oil.temperature"
    said = f"oil {model.oil.temperature - ZERO_CELSIUS:.4g} °C, "
    if model.bulk_temperature is None:
        said += "films solved with bodies as warm as the oil (give bulk_temperature or heat_balance if warmer)"
    else:
        bulk = f"bodies {model.bulk_temperature - ZERO_CELSIUS:.4g} °C"
        if element.bulk_estimated:
            bulk = (
                f"flanks {model.bulk_temperature - ZERO_CELSIUS:.3g} °C (estimate: oil + 0.7 x mean flash temperature; "
                "give bulk_temperature or heat_balance if you know better)"
            )
        if element.ambient is not None:
            said = "oil and "
            bulk += f" by the heat balance with surroundings of {element.ambient - ZERO_CELSIUS:.4g} °C"
        said += f"{bulk}, at which films are solved"
        if model.viscosity_fixed and not model.viscosity_notes():
            said += " (the viscosity given is taken at this temperature)"
    hot = [one for one in runs if one.flash is not None]
    if not hot:
        return f"{said}; flash temperature not known: thermal constants of a body are missing"
    hottest = max(hot, key=lambda one: one.flash or 0.0)
    against = any(abs(one.slide_roll_ratio) > 2 for one in element.found.contacts)
    unsolved = ", of the solved places; not known where the surfaces run against each other" if against else ""
    if not hottest.flash:
        warmest = max((one.surface for one in runs if one.surface is not None), default=math.nan)
        rise = warmest - (model.film_temperature or math.nan)
        warmer = f"rolling warms the surfaces by up to {rise:.2g} K" if rise >= 1 else "flash temperature below 1 K"
        return f"{said}; {warmer}, as both surfaces roll at one speed"
    within = "" if hottest.sliding is None else " of sliding within the contact"
    return (
        f"{said}; highest flash temperature{within} {hottest.flash:.3g} K at {place_words(element, hottest.contact)} "
        f"(Blok, with the film's friction, one temperature for both surfaces){unsolved}"
    )


def _scuffing(element: Element, runs: Sequence[Running]) -> str:
    """Return the safety against scuffing of a gear pair in words."""
    model = element.model
    assert isinstance(model, GearModel)
    found = scuffing_of(element, runs)
    if found is None:
        return "not known: give oil.temperature and thermal constants of both materials"
    bulk = f"bulk temperature {found.bulk - ZERO_CELSIUS:.3g} °C"
    if found.estimated and not element.bulk_estimated:
        bulk += " (estimate: oil + 0.7 x mean flash temperature)"
    said = (
        f"contact temperature {found.contact - ZERO_CELSIUS:.3g} °C at {place_words(element, found.flash_at)}, {bulk}"
    )
    if found.integral is not None and found.friction is not None:
        said += (
            f"; integral temperature {found.integral - ZERO_CELSIUS:.3g} °C; both with {found.friction:.3g}, the mean "
            "friction coefficient of ISO/TR 13989 for scuffing, which is not Schlenk's for the power loss"
        )
    else:
        said += "; with the film's friction, too low where surfaces touch: give rms_roughness"
    if found.contact_safety is None:
        return f"{said}. For a safety factor give scuffing_load_stage, the FZG load stage (A/8.3/90) that the oil fails"
    safety = f"{found.contact_safety:.3g} by contact temperature"
    if found.integral_safety is not None:
        safety += (
            f", {found.integral_safety:.3g} by integral temperature (the former compares rises over the oil's "
            "temperature, the latter temperatures, so that they may rank oils differently)"
        )
    return f"safety factor {safety}; {said}. Concepts of ISO/TS 6336-20 and -21"


def _micropitting(element: Element, runs: Sequence[Running]) -> str:
    """Return the safety of the lambda ratio, as ISO/TS 6336-22 judges: the smallest over what a test permits."""
    thinnest = min(runs, key=lambda one: one.minimum_film)
    if thinnest.film_ratio is None:
        return "not known: give rms_roughness, of both surfaces together"
    ratio, permitted = thinnest.film_ratio, element.model.permissible_film_ratio
    unsolved = unsolved_ratio(element)
    if unsolved is not None and unsolved[0] < ratio:
        return (
            f"not known: the thinnest films are not solved, where the surfaces run against each other; by the formula "
            f"lambda is {unsolved[0]:.2g} at {place_words(element, unsolved[1])}, the smallest solved {ratio:.3g}"
        )
    said = f"smallest specific film thickness (lambda) {ratio:.3g}"
    if permitted is None:
        return f"{said}; for a safety factor give permissible_film_ratio, from a test with this oil and surface finish"
    return (
        f"{said} over {permitted:.3g} permitted: safety factor {ratio / permitted:.3g}. Concept of ISO/TS 6336-22, not "
        f"its procedure: the film is solved with its heat, and roughness is Sq of both surfaces together; over the "
        f"mean Ra of two like ones lambda is {math.sqrt(math.pi):.3g} times that, {math.sqrt(math.pi) * ratio:.3g}"
    )
