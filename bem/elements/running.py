"""A machine element at operating conditions: thermal films at all positions, friction power, wear, micropitting.

Film, friction and temperatures are those of kind traction, called; wear is Archard's law at each place, k p by distance
slid, whose depth over one pass of the contact is closed: k W |u1 - u2| / |u_i|, W the load by length, since every
point of body i sees all of W in the time that it takes to cross at u_i.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from bem.elements.bush_answer import journal_beside
from bem.elements.contact import ElementContact
from bem.elements.differential_sliding import DifferentialSliding, sliding_in_film
from bem.elements.element import AT_MARK, Element
from bem.elements.plain_bush import PlainBushModel
from bem.elements.scuffing import flash_of_heat, flash_temperature
from bem.errors import InputError, Status
from bem.notes import Note
from bem.notes.lubrication import FILM_SPIKE, OIL_TOO_HOT
from bem.notes.merge import merge
from bem.scenes.load import load_scene

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution, Lubricant

CITES = ("zhou1991",)
"""Source of the estimated load share of asperities, a key of `bem/references.bib`."""
_SHARE_FACTOR, _SHARE_POWER = 1.8, 1.2
_SAME = 1e-9
"""Distance of contacts along a path [m] below which they are one."""
LIGHTER, LIGHTEST = 8.0, 2
"""Films of lighter slices of rollers are solved at the highest load over this ratio to the powers 0 to 2. Friction
powers of five bearings are within 0.3 % of those with films at ratios of 2 down to 1/4096 of the highest load."""
_THIN_POWER = 0.5
"""Exponent of a film's power in its load below these films: rolling resistance of rigid bodies is as sqrt(R / h), and
their film h as 1 / load (Martin)."""
POINTS = 500
"""Of each film: of the templates' elements figures are within 0.1 % of those on 2000, and places are many."""


@dataclass(frozen=True)
class Running:
    """One contact at operating conditions; None where a value is not known.

    minimum_film : [m]. film_ratio : that over the rms roughness of both.
    friction : force over load. power : of friction [W]. rolling_power : its part from rolling resistance [W].
    oil : mean temperature in the contact [K]. surface : the hotter surface at its hottest, flash included [K].
    notes : what the film says of its own limits.
    scatter : of the friction to smaller and larger values from the oil's constants; None but with shear_law "base_oil".
    asperity_share : share of the load on asperities, of a bush by kind friction, of others estimated; None without
    roughness. flash : flash temperature under the film's friction [K]; None without the bodies' thermal constants.
    mixed_friction : friction coefficient of film and asperities by kind friction; None where the share is an estimate.
    impossible_film : of a bush, the film of the equivalent cylinder [m] where it is thicker than the radial clearance;
    film and friction are then those of a journal bearing, an estimate, and temperatures are not known.
    sliding : of a ball, its sliding within the curved contact, whose power is in `power`; None of other contacts and of
    films that did not converge.
    lighter : of a roller, films of lighter slices on the same ring, as if they were on its whole length; `power` and
        `friction` are likewise of the most loaded slice, and `over_slices` sums up.
    """

    contact: ElementContact
    status: Status
    minimum_film: float
    film_ratio: float | None
    friction: float
    power: float
    oil: float | None
    surface: float | None
    notes: tuple[Note, ...] = ()
    scatter: tuple[float, float] | None = None
    asperity_share: float | None = None
    flash: float | None = None
    mixed_friction: float | None = None
    rolling_power: float = 0.0
    impossible_film: float | None = None
    sliding: DifferentialSliding | None = None
    lighter: tuple[Running, ...] = ()

    @property
    def slid(self) -> float:
        """Load times sliding speed [W], of a ball the mean speed within the contact."""
        within = 0.0 if self.sliding is None else self.sliding.speed
        return self.contact.load * (abs(self.contact.speeds[0] - self.contact.speeds[1]) + within)

    @property
    def converged(self) -> bool:
        """Return True if film and heat are those of their equations; what is not is no figure of the element."""
        return self.status is Status.CONVERGED


def run_contact(element: Element, contact: ElementContact) -> Running:
    """Solve the film of one contact, with the heat of the element's `thermal` where both materials have its constants.

    Raises
    ------
    InputError : no oil, or surfaces that run against each other.
    """
    from bem.accuracy import traction_figures
    from bem.accuracy.traction import rolling_power
    from bem.kinds.traction.run import case_of
    from bem.kinds.traction.scene import TractionScene

    scene = load_scene(element.scene(contact, "traction"))
    assert isinstance(scene, TractionScene)
    case = case_of(scene)
    found = case.on(POINTS)
    figures = traction_figures(case, found)
    hottest = max((figures[f"{body}_temperature"] for body in ("lower", "upper")), default=None) if case.hot else None
    film = figures["minimum_thickness"]
    if isinstance(element.model, PlainBushModel) and film > element.model.radial_clearance:
        return _as_journal(element.model, contact, found.status, film)
    power, scatter, oil = figures["friction_power"], _scatter(found, scene.oil.build()), figures.get("film_temperature")
    flash = flash_temperature(contact, figures["traction_coefficient"], modulus=element.modulus, bodies=element.bodies)
    sliding = None
    if contact.length is None and found.status is Status.CONVERGED:
        sliding = sliding_in_film(contact, element.modulus, case.lubricant, figures["central_thickness"], oil)
        power += sliding.power
        flash = flash_of_heat(contact, sliding.heat, element.bodies)
        if sliding.scatter is not None:
            down, up = (each / (contact.load * sliding.speed) for each in sliding.scatter)
            scatter = down, up
    shared = element.shared_friction(contact)
    if shared is not None and shared.hottest is not None:
        hottest = max(shared.hottest, hottest or 0.0)
    return Running(
        contact,
        found.status,
        film,
        figures.get("lambda_ratio"),
        figures["traction_coefficient"],
        power,
        oil,
        hottest,
        _film_notes(element, found.notes),
        scatter,
        _asperity_share(element, figures["central_thickness"]) if shared is None else shared.asperity_share,
        flash,
        None if shared is None else shared.friction,
        rolling_power(found) * case.width,
        sliding=sliding,
    )


def _as_journal(model: PlainBushModel, contact: ElementContact, status: Status, film: float) -> Running:
    """Return a bush with the estimated film of a journal bearing in place of one thicker than the clearance [m]."""
    journal = journal_beside(model, film)
    assert journal is not None
    thickness, friction = journal.minimum_thickness, journal.friction
    power = friction * model.radial_load * model.sliding_speed
    ratio = None if model.rms_roughness is None else thickness / model.rms_roughness
    share = None if ratio is None or ratio < 1 else 0.0  # no estimate of shaft and bush that touch
    return Running(
        contact, status, thickness, ratio, friction, power, None, None, asperity_share=share, impossible_film=film
    )


def _film_notes(element: Element, notes: Sequence[Note]) -> tuple[Note, ...]:
    """Return the notes on a film, without that on a hot liquid where the bush's own answer says when it boils."""
    model = element.model
    told = isinstance(model, PlainBushModel) and model.liquid_limits is not None
    return tuple(note for note in notes if not (told and note.code == OIL_TOO_HOT.code))


def _asperity_share(element: Element, central_film: float) -> float | None:
    """Estimate the share of the load on asperities, exp(-B Lambda^C) of ground surfaces after running-in.

    Zhou and Hoeprich (1991), Lambda the central film over the rms roughness; None without roughness.
    """
    roughness = element.model.rms_roughness
    if roughness is None:
        return None
    return math.exp(-_SHARE_FACTOR * (central_film / roughness) ** _SHARE_POWER)


def _scatter(film: FilmSolution, oil: Lubricant) -> tuple[float, float] | None:
    """Return the scatter of the film's friction from the oil's constants, down and up; None where none is known."""
    from bem.lubrication.oil_scatter import oil_scatter
    from bem.lubrication.shear import BaseOilShear

    if film.status is not Status.CONVERGED or not isinstance(oil.shear_law, BaseOilShear):
        return None
    found = oil_scatter(film, oil)
    return found.down, found.up


def wear_per_pass(element: Element, contact: ElementContact) -> tuple[float | None, float | None]:
    """Return the depth that one pass wears off each body [m].

    None without a wear rate, and of a body that stands under the load.
    """
    rate, slid = element.model.specific_wear_rate, abs(contact.speeds[0] - contact.speeds[1])
    if rate is None:
        return None, None
    first, second = (
        rate * contact.line_load(element.modulus) * slid / abs(speed) if speed else None for speed in contact.speeds
    )
    return first, second


def operating_places(element: Element, most: int | None = None) -> tuple[ElementContact, ...]:
    """Return the contacts with a steady film, in their order: all, or about `most` of them.

    A selection is even along the path, or each ring of a bearing, and holds the contacts at marks, the one of highest
    pressure and the one of the thinnest film. `most` counts contacts that differ in more than their place; those that
    are equal to a chosen one, as on the other side of a bearing's load, are in it.

    Raises
    ------
    InputError : no place with a steady film.
    """
    contacts = element.found.contacts
    steady = [i for i, one in enumerate(contacts) if abs(one.slide_roll_ratio) <= 2]
    if not steady:
        raise InputError(
            f"{element.model.name}: nowhere do the surfaces go the same way, so no place has a steady film"
        )
    alike: dict[ElementContact, list[int]] = {}
    for i in steady:
        alike.setdefault(_anywhere(contacts[i]), []).append(i)
    if most is None or len(alike) <= most:
        return tuple(contacts[i] for i in steady)
    paths: dict[str, list[ElementContact]] = {}
    for one in alike:
        paths.setdefault(one.path, []).append(one)
    each = max(2, math.ceil(most / len(paths)))
    even = {
        i for own in paths.values() for k in range(each) for i in alike[own[round(k * (len(own) - 1) / (each - 1))]]
    }
    films, modulus = element.columns().get("minimum_film [m]"), element.modulus
    extreme = {max(steady, key=lambda i: contacts[i].hertz(modulus).maximum_pressure)}
    if films is not None:
        extreme.add(min(steady, key=lambda i: films[i]))
    extreme = {like for i in extreme for like in alike[_anywhere(contacts[i])]}
    chosen = [contacts[i] for i in sorted(even | extreme)]
    marked = [
        one for one in element.found.marked.values() if all(abs(one.place - other.place) > _SAME for other in chosen)
    ]
    return tuple(sorted([*chosen, *marked], key=lambda one: one.place) if marked else chosen)


def _anywhere(contact: ElementContact) -> ElementContact:
    """Return a contact without its place: equal for those on both sides of a bearing's load."""
    return replace(contact, name="", place=0.0, load=float(f"{contact.load:.12g}"), slices=())


def run_all(
    element: Element,
    told: Callable[[int, int], None] = lambda done, total: None,
    *,
    most: int | None = None,
) -> tuple[Running, ...]:
    """Solve the films of all places with a steady one, or of about `most`, in their order; `told` how many are done.

    Contacts that differ in their place alone, as on both sides of a bearing's load, are solved once. Of rollers films
    of lighter slices are solved, too.

    Raises
    ------
    InputError : no oil, or no place with a steady film.
    """
    steady = operating_places(element, most)
    light = _lighter_slices(element)
    every = dict.fromkeys([*map(_anywhere, steady), *(one for own in light.values() for one in own)])
    first = {_anywhere(one): one for one in reversed(steady)}
    solved: dict[ElementContact, Running] = {}
    for done, alike in enumerate(every):
        told(done, len(every))
        solved[alike] = run_contact(element, first.get(alike, alike))
    lighter = {path: tuple(solved[one] for one in own) for path, own in light.items()}
    return tuple(replace(solved[_anywhere(one)], contact=one, lighter=lighter.get(one.path, ())) for one in steady)


def _lighter_slices(element: Element) -> dict[str, list[ElementContact]]:
    """Return contacts with the loads of lighter slices of rollers, without place, by ring; none of other elements.

    The heaviest of each ring is the most loaded contact of all, whether its film is chosen or not.
    """
    found: dict[str, list[ElementContact]] = {}
    for path in dict.fromkeys(one.path for one in element.found.contacts if one.slices):
        heaviest = max((one for one in element.found.contacts if one.path == path), key=lambda one: one.load)
        loads = [heaviest.load / LIGHTER**k for k in range(LIGHTEST + 1)]
        found[path] = [_anywhere(replace(heaviest, load=load)) for load in loads]
    return found


def over_slices(contact: ElementContact, runs: Sequence[Running], value: Callable[[Running], float]) -> float:
    """Return a value of a contact, of a roller its mean over slices [the value's unit].

    A slice has the value of a film with its load on the whole length: a monotone cubic in the logarithm of the load
    through the films on the same ring, and as the root of the load below the lightest.

    runs : films that converged, with that of the contact if it is no roller.
    """
    import numpy as np
    from scipy.interpolate import PchipInterpolator

    if not contact.slices or contact.length is None:
        return value(next(one for one in runs if one.contact == contact))
    own = [one for one in runs if one.contact.path == contact.path] or runs
    films = [*own, *(each for one in own for each in one.lighter if each.converged)]
    known = {float(f"{one.contact.load:.9g}"): value(one) for one in films}
    at = np.log(sorted(known))
    values = np.array([known[load] for load in sorted(known)])
    loads = contact.length * np.array([one for one in contact.slices if one > 0])
    x = np.log(loads)
    inside = np.clip(x, at[0], at[-1])
    found = PchipInterpolator(at, values)(inside) if len(at) > 1 else np.full_like(x, values[0])
    thin = np.exp(_THIN_POWER * np.minimum(x - at[0], 0.0))
    return float(np.sum(found * thin)) / len(contact.slices)


_COLUMNS: dict[str, Callable[[Running], float | None]] = {
    "solved_minimum_film [m]": lambda one: one.minimum_film,
    "solved_film_over_roughness": lambda one: one.film_ratio,
    "oil_temperature [K]": lambda one: one.oil,
    "surface_temperature [K]": lambda one: one.surface,
    "flash_temperature [K]": lambda one: one.flash,
    "asperity_load_share": lambda one: one.asperity_share,
}


def friction_sums(contact: ElementContact, runs: Sequence[Running]) -> tuple[float, float, float]:
    """Return friction coefficient, friction power and rolling loss of a contact [1, W, W], sums over its slices.

    runs : as of `over_slices`.
    """
    force, power, rolling = (
        over_slices(contact, runs, value)
        for value in (
            lambda one: one.friction * one.contact.load,
            lambda one: one.power,
            lambda one: one.rolling_power,
        )
    )
    return force / contact.carried, power, rolling


def columns(element: Element, runs: Sequence[Running]) -> dict[str, list[float]]:
    """Return a row for each contact, as `Element.columns`; not a number where nothing is known, or no film was found.
    Wear needs no film, only what it slides."""
    known = [one for one in runs if one.converged]
    found = {one.contact: one for one in known}
    at = [found.get(contact) for contact in element.found.contacts]

    def number(value: float | None) -> float:
        return math.nan if value is None else value

    films = {name: [number(None if one is None else of(one)) for one in at] for name, of in _COLUMNS.items()}
    sums = [(math.nan,) * 3 if one is None else friction_sums(one.contact, known) for one in at]
    films |= {
        name: [each[k] for each in sums]
        for k, name in enumerate(("friction", "friction_power [W]", "rolling_loss [W]"))
    }
    worn = [wear_per_pass(element, contact) for contact in element.found.contacts]
    return films | {f"wear_per_pass_{body} [m]": [number(both[body - 1]) for both in worn] for body in (1, 2)}


def notes(runs: Sequence[Running], marks: Mapping[str, float] | None = None) -> tuple[Note, ...]:
    """Return the notes of the films that converged, each once, with the places it applies to: their number and names.

    Without notes on the pressure spike: no figure of an element is the film's highest pressure.

    marks : letters of places along the path [m], which stand for the names of contacts there.
    """
    letters = {place: letter for letter, place in (marks or {}).items()}

    def name(index: int) -> str:
        contact = runs[index].contact
        return next((one for place, one in letters.items() if abs(place - contact.place) < AT_MARK), contact.name)

    def words(at: list[int]) -> str:
        starts = [i for i in at if i - 1 not in at]
        ends = [i for i in at if i + 1 not in at]
        spans = [name(a) if a == b else f"{name(a)} to {name(b)}" for a, b in zip(starts, ends, strict=True)]
        return f"at {len(at)} of {len(runs)} positions ({', '.join(spans)})"

    of_runs = [[note for note in one.notes if note.code != FILM_SPIKE.code] if one.converged else () for one in runs]
    return tuple(merge(of_runs, words))
