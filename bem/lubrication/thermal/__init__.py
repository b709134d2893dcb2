"""Heat in films: lumped across the film, or resolved along and across it.

Sliding and the pressure flow heat the oil; the heat enters two moving half-spaces or is carried out. Heat acts on the
film by the viscosity (and density) of the oil, on friction by its shear stress.

Lumped. For lines `lumped.thermal_film` takes all steps. For points `bem.friction.point_film.film_with_heat` takes
steps 1 and 2, with films of load sharing, and `lumped_point.add_heat` steps 3 and 4; `solve_point_film` has no heat:

1. `bem.lubrication.inlet_heating`: factor by which shear in the inlet thins the film (Gupta and others 1992).
2. `inlet_thinning`: viscosity whose isothermal film is as thin, by secants in its logarithm. Cost: two or three films,
   for lines on 250 cells, and the final film: 1.1 to 1.3 times the Newton steps of the isothermal film.
3. `columns` cuts the film into cells; `lumped_energy` balances their heat: generation, conduction across the film as of
   a parabola, two moving half-spaces (Jaeger 1942; Carslaw and Jaeger 1959), convection. Newton's method on one mean
   temperature per cell. Cost: some dense systems of 200 unknowns and one of 400, of a point one per line of cells.
4. Friction follows from the shear law at these temperatures. The film's thickness does not feel them.

Full, `full.full_thermal_film`, for lines:

1. `layers`: Dowson's generalised Reynolds equation (1962), with K layers of different viscosity and density; the line
   solver sees it as `line.problem.Layered`.
2. `cross_film`: speeds, stress and dissipation across the film at the nodes; with a shear law across the film by
   `layered_shear`. `heat_source` gathers them in columns and layers, with their derivatives.
3. `field`: the energy equation by finite volumes, second-order upwind, on 160 columns of 16 layers. Newton's method,
   one banded system and GMRES for the distant warming of the surfaces a step; damping where heat feeds itself.
4. `coupling`: film and temperatures in turn, with Anderson mixing (1965), coarse mesh first, until Reynolds' equation
   holds at the temperatures (Cheng and Sternlicht 1965). Cost: one to three times the Newton steps of the isothermal
   film, and 5 to 15 temperature fields, which take most of the time.

Both: `hot_viscosity` (Roelands 1966, Houpert 1985), `bodies` (half-spaces from materials), `checks` (limits of the
models), `model` (choice by name, applied by `bem.lubrication.solve` to lines and by `bem.friction.point_film` to
points). Results share
`bem.lubrication.results.HeatedFilm`, warm starts `bem.lubrication.line.state.FilmState`.

Names are loaded at first use. Verified in tests/lubrication/test_thermal_film.py, test_thermal_point.py,
test_full_thermal.py, test_layers_sheared.py and test_thermal_warm_start.py.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.thermal.full import FullThermalFilm, solve_full_thermal_line_film
    from bem.lubrication.thermal.lumped import ThermalFilm, solve_thermal_line_film

__all__ = ["FullThermalFilm", "ThermalFilm", "solve_full_thermal_line_film", "solve_thermal_line_film"]

__getattr__ = loader(
    __name__,
    {
        "full": ["FullThermalFilm", "solve_full_thermal_line_film"],
        "lumped": ["ThermalFilm", "solve_thermal_line_film"],
    },
)
