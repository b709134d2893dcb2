"""Tribofilms: stress-activated growth, wear, and the substrate worn with them (thesis, paper E).

`growth` and `properties` are the laws, `evolution` one point over time, `local` a field of them, `grow` with the
contact that the film changes (`contact_growth`, `balance`), `calibrate` fits constants to measurements. Names are
loaded when first used, so that the laws cost no solver.

Sees contacts and operators, no lubrication and no scene. Verified in tests/tribofilm: closed forms of growth and steady
thickness, stiff limits, constants found again; against paper E in the validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.tribofilm.contact_growth import ContactSample, FilmContact, GrowthTable, solve_film_contact
    from bem.tribofilm.evolution import FilmHistory, evolve_film, steady_thickness
    from bem.tribofilm.grow import TribofilmGrowth, grow_tribofilm
    from bem.tribofilm.growth import GrowthLaw, StressActivatedGrowth
    from bem.tribofilm.local import LocalFilm, grow_local_film
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
        "grow": ["TribofilmGrowth", "grow_tribofilm"],
        "growth": ["GrowthLaw", "StressActivatedGrowth"],
        "local": ["LocalFilm", "grow_local_film"],
        "properties": ["Constant", "FadingSubstrate", "FilmProperty", "PropertyLaw", "Table"],
    },
)
