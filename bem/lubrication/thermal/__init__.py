"""Heat in line films: lumped across the film, `solve_thermal_line_film` (in `lumped`), or along and across it,
`solve_full_thermal_line_film` (in `full`).

Lumped: `bem.lubrication.inlet_heating` has the factor of inlet heating, `columns` the film in cells, `lumped_energy`
their balance with two moving half-spaces. Full: `layers` what temperatures across the film do to its flow, `cross_film`
speeds, stress and heat across it, `heat_source` that in columns and layers, `field` their temperatures, `coupling` film
and temperatures at once; their warm start is `bem.lubrication.line.state`. Both: `hot_viscosity` the oil over
pressure and temperature, `bodies` the bodies, `checks` where the models end, `model` chooses one. Names are loaded when
they are first used. Verified in tests/lubrication/test_thermal_film.py, test_full_thermal.py and
test_thermal_warm_start.py.
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
