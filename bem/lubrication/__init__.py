"""Rheology and the film of a line contact, steady and transient."""

from bem.lubrication.film import FilmSolution
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.steady import solve_line_film

__all__ = ["FilmSolution", "Lubricant", "solve_line_film"]
