"""Choice of a model of heat; importing it loads no solver.

`bem.lubrication.solve` applies it to lines, `bem.friction.point_film` to points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from bem.materials import Body

HEAT = ("lumped", "full")
"""Names of the models of heat."""


@dataclass(frozen=True)
class FilmHeat:
    """Model of the heat of a film, and the bodies that take the heat.

    model : "lumped" or "full", as `thermal` of `bem.lubrication.solve_line_film`.
    bodies : flat and cylinder, with heat constants.
    mesh : factor on the usual columns and layers of full heat, or on the cells of lumped heat of a line; lumped heat of
        a point has the cells of its film.
    bulk : temperatures of the bodies far away [K]; None for that of the oil.
    """

    model: str
    bodies: Sequence[Body]
    mesh: float = 1.0
    bulk: Sequence[float] | None = None
