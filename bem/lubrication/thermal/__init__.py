"""Heat in line films, lumped across the film: `solve_thermal_line_film` (in `lumped`).

`inlet` has the factor of inlet heating, `strip` the film in cells, `energy` their balance with two moving half-spaces,
`hot_viscosity` the oil over pressure and temperature. Sees films, oils and `bem.heat`. Names are loaded when they are
first used. Verified in tests/lubrication/test_thermal_film.py.
"""

from typing import TYPE_CHECKING

from bem.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.thermal.lumped import ThermalFilm, solve_thermal_line_film

__all__ = ["ThermalFilm", "solve_thermal_line_film"]

__getattr__ = loader(__name__, {"lumped": ["ThermalFilm", "solve_thermal_line_film"]})
