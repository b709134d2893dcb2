"""Tribofilms: stress-activated growth, wear, and the substrate worn with them (thesis, paper E)."""

from bem.tribofilm.contact_growth import ContactSample, FilmContact, GrowthTable, solve_film_contact
from bem.tribofilm.evolution import FilmHistory, evolve_film, steady_thickness
from bem.tribofilm.grow import TribofilmGrowth, grow_tribofilm
from bem.tribofilm.growth import StressActivatedGrowth
from bem.tribofilm.local import LocalFilm, grow_local_film
from bem.tribofilm.properties import Constant, FadingSubstrate, FilmProperty, Table

__all__ = [
    "Constant",
    "ContactSample",
    "FadingSubstrate",
    "FilmContact",
    "FilmHistory",
    "FilmProperty",
    "GrowthTable",
    "LocalFilm",
    "StressActivatedGrowth",
    "Table",
    "TribofilmGrowth",
    "evolve_film",
    "grow_local_film",
    "grow_tribofilm",
    "solve_film_contact",
    "steady_thickness",
]
