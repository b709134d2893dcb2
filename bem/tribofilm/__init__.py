"""Tribofilms: stress-activated growth, wear, and the substrate worn with them (thesis, paper E).

Algorithm of `grow_tribofilm` (mean_film.py), for the mean thickness as in the source:

1. Solve the contact under a uniform film of a given thickness, with the film's stiffness and hardness
   (contact_growth.py, properties.py), and average the growth law over it (growth.py).
2. Tabulate the growth over the thickness by bisection, contacts solved only where they are needed (contact_growth.py).
3. Integrate growth, wear and substrate wear over time (evolution.py, with the balance of balance.py).
4. Superpose the growth maps of the solved contacts to a map of the film (mean_film.py).

`grow_local_film` (local_film.py) lets the local film raise the surface: each time step solves the contact anew. Under
oil the load is shared first (under_oil.py). calibrate.py fits the constants to measurements without a contact.

Source: thesis, paper E. Cost: some ten to thirty contacts for the mean film, one per time step for the local one. Names
are loaded when first used, so that the laws cost no solver.

Sees contacts and operators, no lubrication and no scene. Verified in tests/tribofilm: closed forms of growth and steady
thickness, stiff limits, constants found again; against paper E in the validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.tribofilm.contact_growth import ContactSample, FilmContact, GrowthTable, solve_film_contact
    from bem.tribofilm.evolution import FilmHistory, evolve_film, steady_thickness
    from bem.tribofilm.growth import GrowthLaw, StressActivatedGrowth
    from bem.tribofilm.local_film import LocalFilm, grow_local_film
    from bem.tribofilm.mean_film import TribofilmGrowth, grow_tribofilm
    from bem.tribofilm.properties import Constant, FadingSubstrate, FilmProperty, PropertyLaw, Table

__all__ = [
    "Constant",
    "ContactSample",
    "FadingSubstrate",
    "FilmContact",
    "FilmHistory",
    "FilmProperty",
    "GrowthLaw",
    "GrowthTable",
    "LocalFilm",
    "PropertyLaw",
    "StressActivatedGrowth",
    "Table",
    "TribofilmGrowth",
    "evolve_film",
    "grow_local_film",
    "grow_tribofilm",
    "solve_film_contact",
    "steady_thickness",
]

__getattr__ = loader(
    __name__,
    {
        "contact_growth": ["ContactSample", "FilmContact", "GrowthTable", "solve_film_contact"],
        "evolution": ["FilmHistory", "evolve_film", "steady_thickness"],
        "mean_film": ["TribofilmGrowth", "grow_tribofilm"],
        "growth": ["GrowthLaw", "StressActivatedGrowth"],
        "local_film": ["LocalFilm", "grow_local_film"],
        "properties": ["Constant", "FadingSubstrate", "FilmProperty", "PropertyLaw", "Table"],
    },
)
