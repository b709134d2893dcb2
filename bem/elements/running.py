"""What a machine element does as it runs: films with their heat at all places, friction power, wear, micropitting.

Film, friction and temperatures are those of kind traction, called; wear is Archard's law at each place, k p by distance
slid, whose depth over one pass of the contact is closed: k W |u1 - u2| / |u_i|, W the load by length, since every
point of body i sees all of W in the time that it takes to cross at u_i.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from bem.elements.contact import ElementContact
from bem.elements.element import Element
from bem.errors import InputError, Status
from bem.scenes.load import load_scene

POINTS = 500
"""Of each film: of the templates' elements figures are within 0.1 % of those on 2000, and places are many."""


@dataclass(frozen=True)
class Running:
    """One place as it runs; None where it is not known.

    minimum_film : [m]. film_ratio : that over the rms roughness of both.
    friction : force over load. power : of friction [W].
    oil : mean temperature in the contact [K]. surface : the hotter surface at its hottest, flash included [K].
    wear : depth per pass of the lower and the upper body [m].
    """

    contact: ElementContact
    status: Status
    minimum_film: float
    film_ratio: float | None
    friction: float
    power: float
    oil: float | None
    surface: float | None
    wear: tuple[float | None, float | None]


def run_contact(element: Element, contact: ElementContact) -> Running:
    """Solve the film of one contact, with lumped heat where both materials have its constants.

    Raises
    ------
    InputError : no oil, or surfaces that run against each other.
    """
    from bem.accuracy import traction_figures
    from bem.accuracy.traction import film_of
    from bem.scenes.kinds.traction import TractionScene, case_of

    scene = load_scene(element.scene(contact, "traction"))
    assert isinstance(scene, TractionScene)
    case = case_of(scene)
    found = case.on(POINTS)
    figures = traction_figures(case, found)
    hottest = max((figures[f"{body}_temperature"] for body in ("lower", "upper")), default=None) if case.hot else None
    return Running(
        contact,
        film_of(found).status if found.status is Status.CONVERGED else found.status,
        figures["minimum_thickness"],
        figures.get("lambda_ratio"),
        figures["traction_coefficient"],
        figures["friction_power"],
        figures.get("film_temperature"),
        hottest,
        wear_per_pass(element, contact),
    )


def wear_per_pass(element: Element, contact: ElementContact) -> tuple[float | None, float | None]:
    """Depth that one pass takes off each body [m]; None without a wear rate, or of a body that stands under it."""
    rate, slid = element.model.specific_wear_rate, abs(contact.speeds[0] - contact.speeds[1])
    if rate is None:
        return None, None
    first, second = (
        rate * contact.line_load(element.modulus) * slid / abs(speed) if speed else None for speed in contact.speeds
    )
    return first, second


def run_all(element: Element, told: Callable[[int, int], None] = lambda done, total: None) -> tuple[Running, ...]:
    """All places with a steady film, in their order; `told` how many are done.

    Raises
    ------
    InputError : no oil, or no place with a steady film.
    """
    steady = [one for one in element.found.contacts if abs(one.slide_roll_ratio) <= 2]
    if not steady:
        raise InputError(
            f"{element.model.name}: nowhere do the surfaces go the same way, so no place has a steady film"
        )
    found = []
    for done, one in enumerate(steady):
        told(done, len(steady))
        found.append(run_contact(element, one))
    return tuple(found)


_COLUMNS: dict[str, Callable[[Running], float | None]] = {
    "solved_minimum_film [m]": lambda one: one.minimum_film,
    "solved_film_over_roughness": lambda one: one.film_ratio,
    "friction": lambda one: one.friction,
    "friction_power [W]": lambda one: one.power,
    "oil_temperature [K]": lambda one: one.oil,
    "surface_temperature [K]": lambda one: one.surface,
    "wear_per_pass_1 [m]": lambda one: one.wear[0],
    "wear_per_pass_2 [m]": lambda one: one.wear[1],
}


def columns(element: Element, runs: Sequence[Running]) -> dict[str, list[float]]:
    """A row for each contact as in `Element.columns`; not a number where nothing is known."""
    found = {one.contact: one for one in runs}
    at = [found.get(contact) for contact in element.found.contacts]

    def number(one: Running | None, of: Callable[[Running], float | None]) -> float:
        value = None if one is None else of(one)
        return math.nan if value is None else value

    return {name: [number(one, of) for one in at] for name, of in _COLUMNS.items()}


def summary(element: Element, runs: Sequence[Running]) -> tuple[tuple[str, str], ...]:
    """What the element does as a whole, in words: power, thinnest film, micropitting, wear by hour, particles."""
    found, places = element.found, len(element.found.contacts)
    power = sum(one.power for one in runs) / places * found.at_once
    rows = [("friction power", f"{power:.4g} W, mean over the places{_of(runs, places)}, {found.at_once:.4g} at once")]
    hot = [one for one in runs if one.surface is not None]
    if hot:
        hottest = max(hot, key=lambda one: one.surface or 0.0)
        rows.append(("hottest surface", f"{(hottest.surface or 0.0) - 273.15:.4g} degC at {hottest.contact.name}"))
    thinnest = min(runs, key=lambda one: one.minimum_film)
    rows.append(("thinnest film", f"{1e9 * thinnest.minimum_film:.4g} nm at {thinnest.contact.name}"))
    thin = [one for one in runs if one.film_ratio is not None and one.film_ratio < 1]
    if thin:
        rows.append(
            (
                "mixed lubrication",
                f"at {len(thin)} of {len(runs)} places the film is thinner than the roughness: friction and heat are "
                "those of the film alone there; kind friction shares the load with rough surfaces",
            )
        )
    rows.append(("micropitting", _micropitting(element, thinnest)))
    rows.append(("wear by hour", _wear(element, runs)))
    rows.append(
        (
            "particles by hour",
            "not known from smooth contacts: which pieces come off needs two rough surfaces and a criterion (kinds "
            "wear and running-in, whose results say how many by distance)",
        )
    )
    lost = [one for one in runs if one.status is not Status.CONVERGED]
    if lost:
        rows.append(("not converged", f"{len(lost)} of {len(runs)} films, the first at {lost[0].contact.name}"))
    return tuple(rows)


def _of(runs: Sequence[Running], places: int) -> str:
    return "" if len(runs) == places else f" (those {places - len(runs)} of {places} without a steady film count none)"


def _micropitting(element: Element, thinnest: Running) -> str:
    """Safety of the film ratio, as ISO/TS 6336-22 judges: the smallest over what a test permits."""
    if thinnest.film_ratio is None:
        return "not known: give rms_roughness, of both surfaces together"
    ratio, permitted = thinnest.film_ratio, element.model.permissible_film_ratio
    said = f"smallest film over roughness {ratio:.3g}"
    if permitted is None:
        return f"{said}; with permissible_film_ratio, of a test with this oil and finish, it becomes a safety"
    return (
        f"{said} over {permitted:.3g} permitted: safety {ratio / permitted:.3g}. ISO/TS 6336-22's idea, not its "
        "procedure: this film is solved with its heat and its roughness is rms, there both are fits and means Ra"
    )


def _wear(element: Element, runs: Sequence[Running]) -> str:
    rates = element.found.passes
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, measured with this oil and load share"
    if all(one.contact.speeds[0] == one.contact.speeds[1] for one in runs):
        return "none by sliding: both surfaces roll at one speed"
    if rates is None:
        return "not known: how often a place is passed is not one number here"
    said = []
    for body, name in enumerate(("body 1", "body 2")):
        depths = [(one.wear[body] or 0.0, one.contact.name) for one in runs]
        depth, where = max(depths)
        said.append(f"{name} {3600 * rates[body] * depth * 1e6:.3g} um at {where}")
    return ", ".join(said) + "; Archard's law with the whole load, the rate being that of this lubrication"
