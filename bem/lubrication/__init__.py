"""Rheology and the film of a line contact, steady and transient."""

from bem.lubrication.cavitation import Cavitation
from bem.lubrication.film import FilmSolution
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.steady import solve_line_film
from bem.lubrication.transient import march_line_film

__all__ = ["Cavitation", "FilmSolution", "Lubricant", "march_line_film", "solve_line_film"]
