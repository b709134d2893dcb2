"""Rheology and the film of line and point contacts, steady and in time.

Laws of the oil: `viscosity`, `density`, `shear`, gathered in `lubricant`; grades of it in `oils`; what a shear law does
across a film: `shear_profile`. Films: of line contacts `line`, of point contacts `point`, with heat `thermal`; `solve`
chooses the model of heat. Shared: `results`, `supply`, `cavitation`, `flow_factors`, `time_stepping`, `inlet_heating`;
`checks` says where a model ends. Names are loaded when first used, so that laws cost no solver.

Sees grids, laws and the dry contact of smooth bodies, no scene. Verified in tests/lubrication: Martin's and Hertz'
limits, both equations by plain quadrature, order of convergence, closed forms of cavitation, conservation.
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
