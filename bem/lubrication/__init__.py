"""Rheology and the film of a line contact, steady and transient. Names are loaded when they are first used, so that the
laws alone cost no solver."""

from typing import TYPE_CHECKING

from bem.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.cavitation import Cavitation
    from bem.lubrication.film import FilmSolution
    from bem.lubrication.lubricant import Lubricant
    from bem.lubrication.oils import Oil, find_oil
    from bem.lubrication.steady import solve_line_film
    from bem.lubrication.transient import march_line_film

__all__ = ["Cavitation", "FilmSolution", "Lubricant", "Oil", "find_oil", "march_line_film", "solve_line_film"]

__getattr__ = loader(
    __name__,
    {
        "cavitation": ["Cavitation"],
        "film": ["FilmSolution"],
        "lubricant": ["Lubricant"],
        "oils": ["Oil", "find_oil"],
        "steady": ["solve_line_film"],
        "transient": ["march_line_film"],
    },
)
