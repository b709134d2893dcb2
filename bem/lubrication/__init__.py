"""Rheology and the film of line and point contacts, steady and in time.

1. The oil: laws in `viscosity`, `density` and `shear`, gathered in `lubricant.Lubricant`; grades and correlations in
   `oils`; a shear law across the film in `shear_profile`.
2. Films: `line` and `point`, each with its own equations, solvers and cost in its docstring. With heat: `thermal`.
3. Public functions: `solve.solve_line_film` chooses between no heat, lumped and full heat. All names below are public.
4. Rough films by waves, from a smooth film: `waves`.
5. Shared by lines and points: `results` (of lines), `supply` (starvation), `cavitation` (models), `flow_factors` (rough
   walls), `time_stepping` (BDF2 with halving), `inlet_heating`, `checks` (validity, as notes).

Imports run from `solve` over `thermal` to `line` and `point`, and from there to the shared parts and the oil; an import
contract checks it. Names are loaded at first use, so that laws load no solver. Sees grids, laws and the dry contact of
smooth bodies, no scene. Verified in tests/lubrication: Martin's and Hertz' limits, both equations by plain quadrature,
order of convergence, closed forms of cavitation, conservation of mass.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.cavitation import Cavitation
    from bem.lubrication.line.transient import march_line_film
    from bem.lubrication.lubricant import Lubricant
    from bem.lubrication.oils import Oil, find_oil
    from bem.lubrication.point.film import PointFilmSolution
    from bem.lubrication.point.moving_surfaces import Dent, MeasuredHeights, MovingSurface, Waves
    from bem.lubrication.point.rough_film import RoughPointFilm, solve_rough_point_film
    from bem.lubrication.point.steady import solve_point_film
    from bem.lubrication.point.transient import march_point_film
    from bem.lubrication.results import FilmSolution
    from bem.lubrication.solve import solve_line_film
    from bem.lubrication.supply import InletDistance, OilLayer
    from bem.lubrication.thermal import (
        FullThermalFilm,
        ThermalFilm,
        solve_full_thermal_line_film,
        solve_thermal_line_film,
    )

__all__ = [
    "Cavitation",
    "Dent",
    "FilmSolution",
    "FullThermalFilm",
    "InletDistance",
    "Lubricant",
    "MeasuredHeights",
    "MovingSurface",
    "Oil",
    "OilLayer",
    "PointFilmSolution",
    "RoughPointFilm",
    "ThermalFilm",
    "Waves",
    "find_oil",
    "march_line_film",
    "march_point_film",
    "solve_full_thermal_line_film",
    "solve_line_film",
    "solve_point_film",
    "solve_rough_point_film",
    "solve_thermal_line_film",
]

__getattr__ = loader(
    __name__,
    {
        "cavitation": ["Cavitation"],
        "line.transient": ["march_line_film"],
        "lubricant": ["Lubricant"],
        "oils": ["Oil", "find_oil"],
        "point.film": ["PointFilmSolution"],
        "point.moving_surfaces": ["Dent", "MeasuredHeights", "MovingSurface", "Waves"],
        "point.rough_film": ["RoughPointFilm", "solve_rough_point_film"],
        "point.steady": ["solve_point_film"],
        "point.transient": ["march_point_film"],
        "results": ["FilmSolution"],
        "solve": ["solve_line_film"],
        "supply": ["InletDistance", "OilLayer"],
        "thermal": ["FullThermalFilm", "ThermalFilm", "solve_full_thermal_line_film", "solve_thermal_line_film"],
    },
)
