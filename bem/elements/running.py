"""A machine element at operating conditions: thermal films at all positions, friction power, wear, micropitting.

Film, friction and temperatures are those of kind traction, called; wear is Archard's law at each place, k p by distance
slid, whose depth over one pass of the contact is closed: k W |u1 - u2| / |u_i|, W the load by length, since every
point of body i sees all of W in the time that it takes to cross at u_i.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bem.elements.contact import ElementContact
from bem.elements.element import Element
from bem.errors import InputError, Status
from bem.notes import Note
from bem.notes.merge import merge
from bem.particles import particle_number
from bem.quantities import plain_digits
from bem.scenes.load import load_scene

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution, Lubricant

_ROLLS = "none by sliding: both surfaces roll at one speed"
POINTS = 500
"""Of each film: of the templates' elements figures are within 0.1 % of those on 2000, and places are many."""


@dataclass(frozen=True)
class Running:
    """One contact at operating conditions; None where a value is not known.

    minimum_film : [m]. film_ratio : that over the rms roughness of both.
    friction : force over load. power : of friction [W].
    oil : mean temperature in the contact [K]. surface : the hotter surface at its hottest, flash included [K].
    notes : what the film says of its own limits.
    scatter : of the friction to smaller and larger values from the oil's constants; None but with shear_law "base_oil".
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
    from bem.kinds.traction.run import case_of
    from bem.kinds.traction.scene import TractionScene

    scene = load_scene(element.scene(contact, "traction"))
    assert isinstance(scene, TractionScene)
    case = case_of(scene)
    found = case.on(POINTS)
    figures = traction_figures(case, found)
    hottest = max((figures[f"{body}_temperature"] for body in ("lower", "upper")), default=None) if case.hot else None
    return Running(
        contact,
        found.status,
        figures["minimum_thickness"],
        figures.get("lambda_ratio"),
        figures["traction_coefficient"],
        figures["friction_power"],
        figures.get("film_temperature"),
        hottest,
        tuple(found.notes),
        _scatter(found, scene.oil.build()),
    )


def _scatter(film: FilmSolution, oil: Lubricant) -> tuple[float, float] | None:
    """Scatter of the film's friction from the oil's constants, down and up; None where none is known."""
    from bem.lubrication.oil_scatter import oil_scatter
    from bem.lubrication.shear import BaseOilShear

    if film.status is not Status.CONVERGED or not isinstance(oil.shear_law, BaseOilShear):
        return None
    found = oil_scatter(film, oil)
    return found.down, found.up


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
}


def columns(element: Element, runs: Sequence[Running]) -> dict[str, list[float]]:
    """A row for each contact as in `Element.columns`; not a number where nothing is known, or no film was found.
    Wear needs no film, only what it slides."""
    found = {one.contact: one for one in runs if one.converged}
    at = [found.get(contact) for contact in element.found.contacts]

    def number(value: float | None) -> float:
        return math.nan if value is None else value

    films = {name: [number(None if one is None else of(one)) for one in at] for name, of in _COLUMNS.items()}
    worn = [wear_per_pass(element, contact) for contact in element.found.contacts]
    return films | {f"wear_per_pass_{body} [m]": [number(both[body - 1]) for both in worn] for body in (1, 2)}


def notes(runs: Sequence[Running]) -> tuple[Note, ...]:
    """Return the notes of the films that converged, each once, with the number of places it applies to."""
    of_runs = [one.notes if one.converged else () for one in runs]
    return tuple(merge(of_runs, lambda at: f"at {len(at)} of {len(runs)} positions"))


def summary(element: Element, solved: Sequence[Running]) -> tuple[tuple[str, str], ...]:
    """Sum up the element as a whole, in words: power, thinnest film, micropitting, wear per hour, particles; of the
    films that converged."""
    lost, runs = [one for one in solved if not one.converged], [one for one in solved if one.converged]
    missed = [("not converged", f"{len(lost)} of {len(solved)} films, the first at {one.contact.name}") for one in lost]
    if not runs:
        return tuple(missed[:1])
    found, places = element.found, len(element.found.contacts)
    power = sum(one.power for one in runs) / places * found.at_once
    rows = [
        (
            "friction power",
            f"{power:.4g} W{_scatter_of_power(runs, places, found.at_once)}: mean of one contact{_of(runs, places)} x "
            f"{found.at_once:.4g} contacts at once",
        )
    ]
    hot = [one for one in runs if one.surface is not None]
    if hot:
        hottest = max(hot, key=lambda one: one.surface or 0.0)
        rows.append(
            ("highest surface temperature", f"{(hottest.surface or 0.0) - 273.15:.4g} degC at {hottest.contact.name}")
        )
    thinnest = min(runs, key=lambda one: one.minimum_film)
    rows.append(("minimum film thickness", f"{1e9 * thinnest.minimum_film:.4g} nm at {thinnest.contact.name}"))
    thin = [one for one in runs if one.film_ratio is not None and one.film_ratio < 1]
    if thin:
        rows.append(
            (
                "mixed lubrication",
                f"lambda is below 1 at {len(thin)} of {len(runs)} positions; friction and heat above leave asperity "
                "contact out. With it, position by position: --scene mixed.toml --kind friction --at NUMBER",
            )
        )
    rows.append(("micropitting", _micropitting(element, thinnest)))
    rows.append(("wear per hour", _wear(element)))
    rows.append(("particles per hour", _particles(element)))
    return (*rows, *missed[:1])


def _scatter_of_power(runs: Sequence[Running], places: int, at_once: float) -> str:
    """Scatter of the power from the oil's constants, which are those of one oil at all places; nothing without one."""
    if any(one.scatter is None for one in runs):
        return ""
    slid = [one.contact.load * abs(one.contact.speeds[0] - one.contact.speeds[1]) / places * at_once for one in runs]
    down, up = (sum(s * one.scatter[k] for s, one in zip(slid, runs, strict=True) if one.scatter) for k in (0, 1))
    if 0.0 in (down, up):  # pure rolling
        return ""
    return f" (-{plain_digits(down)}, +{plain_digits(up)} W between oils of this base)"


def _of(runs: Sequence[Running], places: int) -> str:
    return (
        ""
        if len(runs) == places
        else f" (those {places - len(runs)} of {places} without a steady film that converged count none)"
    )


def _micropitting(element: Element, thinnest: Running) -> str:
    """Safety of the film ratio, as ISO/TS 6336-22 judges: the smallest over what a test permits."""
    if thinnest.film_ratio is None:
        return "not known: give rms_roughness, of both surfaces together"
    ratio, permitted = thinnest.film_ratio, element.model.permissible_film_ratio
    said = f"smallest lambda {ratio:.3g}"
    if permitted is None:
        return (
            f"{said}; for a safety give permissible_film_ratio, the smallest lambda without micropitting in a test "
            "with this oil and finish"
        )
    return (
        f"{said} over {permitted:.3g} permitted: safety {ratio / permitted:.3g}. Concept of ISO/TS 6336-22, not its "
        "procedure: the film is solved with its heat instead of a film formula, and roughness is Sq instead of Ra"
    )


def _wear(element: Element) -> str:
    contacts, rates = element.found.contacts, element.found.passes
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, measured with this oil and load share"
    if worn_volume_rate(element) == 0:
        return _ROLLS
    said = []
    for body, rate in enumerate(rates):
        if rate is None:
            said.append(f"body {body + 1} not known: how often a place is passed, and how fast, is not one number")
            continue
        depth, where = max((wear_per_pass(element, one)[body] or 0.0, one.name) for one in contacts)
        said.append(f"body {body + 1} {3600 * rate * depth * 1e6:.3g} um at {where}")
    return ", ".join(said) + "; Archard's law with the whole load, the rate being that of this lubrication"


def worn_volume_rate(element: Element) -> float:
    """Of both bodies together [m^3/s]: Archard's rate x load x sliding speed on each, the mean over the places times
    how many there are at once; 0 without a wear rate."""
    found = element.found
    slid = [one.load * abs(one.speeds[0] - one.speeds[1]) for one in found.contacts]
    return 2 * (element.model.specific_wear_rate or 0.0) * sum(slid) / len(slid) * found.at_once


def _particles(element: Element) -> str:
    """How many come off, of a worn volume and their mean one; a smooth contact has neither."""
    rate, one = 3600 * worn_volume_rate(element), element.model.mean_particle_volume
    if element.model.specific_wear_rate is None:
        return "not known: give specific_wear_rate, and mean_particle_volume"
    if rate == 0:
        return _ROLLS
    worn = f"{1e9 * rate:.3g} mm^3 of both bodies"
    if one is None:
        return f"{worn}; with mean_particle_volume, measured or of kinds wear and running-in, it becomes a number"
    return f"{worn}, {particle_number(rate, one):.3g} of {1e18 * one:.3g} um^3 each"
