"""Error bars of a rolling and sliding line contact, with or without heat: half the points, and half the cells of heat.

Full heat is solved on half the columns and half the layers. The inlet's heating adds by how much the film misses what
its formula leaves of it. What the lumped model of heat leaves out is a matter of the model and not in the bar.

The table was judged on 159 figures of 16 random contacts (0.2 to 1.6 GPa, 0.1 to 20 m/s, slide-to-roll ratios 0 to 2,
20 to 127 degrees Celsius, 200 to 800 points) against 4000 points and 600 cells: one was beyond its bar, by a sixth.
Verified in tests/scenes/test_traction_kind.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from bem.accuracy.bars import POINTS, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import other_points
from bem.accuracy.film import FEWEST, FilmCase, film_change, spike_is_unresolved
from bem.accuracy.richardson import Table, relative, residual_errors, rows
from bem.arguments import named
from bem.errors import Status
from bem.lubrication import (
    FilmSolution,
    FullThermalFilm,
    Lubricant,
    ThermalFilm,
    solve_full_thermal_line_film,
    solve_line_film,
    solve_thermal_line_film,
)
from bem.lubrication.supply import Supply
from bem.materials import Body
from bem.notes.accuracy import NoBar
from bem.plausibility import without_argument_notes
from bem.reference_solutions.starved_inlet import inlet_length

RULES = Table(
    "",
    rows(
        "traction_coefficient sliding_traction minimum_thickness central_thickness maximum_pressure friction_power "
        "lambda_ratio film_reduction oil_layer flooded_layer meniscus_position inlet heat_factor "
        "share_of_lower share_of_upper share_of_oil",
        2.0,
        "First order in the cells of heat, second in the points: twice the difference, and the film's change, since "
        "figures follow the film where their own differences pass zero.",
        order=1,
        film=1.0,
    ),
    rows(
        "film_temperature lower_temperature upper_temperature film_rise",
        2.0,
        "As the others; the rise goes with the shear rate and the viscosity, each of which follows the film.",
        order=1,
        film=2.0,
    ),
)
"""Factors on the difference, and a floor on the relative change of the film times the figure, of temperatures the rise
over the bulk (film)."""
CELLS, MOST_CELLS = 200, 2000
"""Cells of lumped heat along the film on up to 1000 points, and at most."""
COLUMNS, LAYERS = 160, 16
"""Columns of full heat along the film on up to 960 points, and layers across it."""
WITHOUT_BAR = ("energy_imbalance", "inlet_factor", "highest_film_temperature", "hottest_oil")
"""A rounding error, a formula that no mesh changes, and temperatures at the pressure spike in pure rolling."""
_TEMPERATURES = ("film_temperature", "lower_temperature", "upper_temperature")
"""Figures that count from the bulk temperature."""

Found = FilmSolution | ThermalFilm | FullThermalFilm


@dataclass(frozen=True)
class TractionCase:
    """Arguments of `bem.solve_line_film`, or of a solver with heat.

    width : of the friction power [m].
    bodies, bulk : with heat; bulk temperatures [K].
    supply : none with full heat.
    roughness : for the lambda ratio [m].
    thermal : "lumped" or "full" heat.
    """

    load: float
    radius: float
    contact_modulus: float
    speeds: tuple[float, float]
    lubricant: Lubricant
    points: int
    width: float = 1.0
    bodies: tuple[Body, Body] | None = None
    bulk: tuple[float, ...] = ()
    supply: Supply | None = None
    roughness: float | None = None
    thermal: str = "lumped"

    @property
    def hot(self) -> bool:
        """Return True if heat is solved for."""
        return self.bodies is not None

    @property
    def cells(self) -> int:
        """Return the cells of lumped heat, more of them with more points."""
        return min(max(CELLS, self.points // 5), MOST_CELLS)

    def on(self, points: int, coarseness: int = 1, initial: Found | None = None) -> Any:
        """Solve the film on a mesh of so many points.

        coarseness : factor by which the cells, columns and layers of heat are fewer.
        initial : solution of a similar case to start from.
        """
        start = initial if initial is None or isinstance(initial, FilmSolution) else initial.as_film()
        asked = named(self, "load radius contact_modulus speeds lubricant") | {"points": points, "initial": start}
        if self.bodies is None:
            film = solve_line_film(**asked, supply=self.supply)
            return replace(film, notes=without_argument_notes(film.notes))
        asked |= {"bodies": self.bodies, "bulk": self.bulk}
        if self.thermal == "full":
            columns = min(max(COLUMNS, self.points // 6), MOST_CELLS) // coarseness
            return solve_full_thermal_line_film(**asked, columns=columns, layers=LAYERS // coarseness)
        return solve_thermal_line_film(**asked, supply=self.supply, cells=self.cells // coarseness)


def traction_figures(case: TractionCase, found: Found) -> dict[str, float]:
    """Return the headline figures, SI units; the power is that on the case's width."""
    film, force = film_of(found), found.shear_force
    sliding = force - film.rolling_force if isinstance(found, FilmSolution) else found.sliding_force
    figures = {
        "traction_coefficient": force / film.load,
        "sliding_traction": sliding / film.load,
        "minimum_thickness": film.minimum_thickness,
        "central_thickness": film.central_thickness,
        "maximum_pressure": float(film.pressure.max()),
        "friction_power": _power(film, sliding) * case.width,
    }
    if case.roughness is not None:
        figures["lambda_ratio"] = film.minimum_thickness / case.roughness
    if film.starvation is not None:
        figures |= _of_supply(case, film)
    if isinstance(found, FilmSolution):
        return figures
    if isinstance(found, ThermalFilm):
        figures["inlet_factor"] = found.inlet.factor
    else:
        figures["hottest_oil"] = float(found.temperature.max())
        figures["heat_factor"] = film.central_thickness / found.isothermal.central_thickness
    power = found.friction_power or 1.0
    return figures | {
        "film_temperature": found.mean_film_temperature,
        "film_rise": found.mean_film_temperature - min(case.bulk),
        "highest_film_temperature": found.highest_film_temperature,
        "lower_temperature": float(found.surface_temperatures[0].max()),
        "upper_temperature": float(found.surface_temperatures[1].max()),
        "friction_power": found.friction_power * case.width,
        "share_of_lower": found.power_into[0] / power,
        "share_of_upper": found.power_into[1] / power,
        "share_of_oil": found.power_carried / power,
        "energy_imbalance": found.energy_imbalance,
    }


def film_of(found: Found) -> FilmSolution:
    """Return the film without its heat."""
    return found if isinstance(found, FilmSolution) else found.film


def _power(film: FilmSolution, sliding: float) -> float:
    """Return the power of friction [W/m]: of sliding, and of the rolling force on either surface."""
    return sliding * (film.speeds[0] - film.speeds[1]) + rolling_power(film)


def rolling_power(found: Found) -> float:
    """Return the power of the rolling force on both surfaces [W/m], a part of the power of friction."""
    film = film_of(found)
    return film.rolling_force * sum(film.speeds)


def _of_supply(case: TractionCase, film: FilmSolution) -> dict[str, float]:
    """Return the figures of a film with a supply; a flooded film has no meniscus."""
    found = film.starvation
    assert found is not None
    figures = {"film_reduction": found.reduction, "oil_layer": found.layer, "flooded_layer": found.flooded_layer}
    if found.flooded:
        return figures
    half = math.sqrt(4 * case.load * case.radius / (math.pi * case.contact_modulus))
    length = inlet_length(half, case.radius, film.central_thickness / found.reduction)
    place = found.meniscus_position
    return figures | {"meniscus_position": place, "inlet": (abs(place) - half) / length}


def traction_bars(case: TractionCase, found: Found) -> ErrorBars:
    """Return the error bars of the figures of a solution on all points."""
    figures = {name: value for name, value in traction_figures(case, found).items() if name not in WITHOUT_BAR}
    film = film_of(found)
    other = case.on(other_points(case.points, FEWEST), coarseness=2, initial=found)
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, NoBar.COARSER_UNSOLVED)
    there = figures | traction_figures(case, other)  # a nearly flooded film may have a meniscus on one mesh alone
    # temperatures count from the bulk
    sizes = {
        name: abs(value - min(case.bulk)) if name in _TEMPERATURES else abs(value) for name, value in figures.items()
    }
    # whatever the points, the heat has half the cells
    points = RULES.errors(figures, there, {"film": relative(film_change(figures, there), sizes)}, ratio=0.5)
    # the film misses its thinning in the inlet as it misses its points
    missed = found.inlet_missed if isinstance(found, ThermalFilm) else 0.0
    residual = RULES.errors(figures, figures, {"film": relative(missed, sizes)})
    left = residual_errors(found.residual if isinstance(found, FullThermalFilm) else film.residual, sizes)
    residual = {name: error + left[name] for name, error in residual.items()}
    bars = ErrorBars.together({POINTS: points, RESIDUAL: residual})
    of_film = FilmCase(film, case.load, case.radius, case.contact_modulus, case.speeds, case.lubricant, case.points)
    coarser = replace(of_film, solution=film_of(other))
    if any(spike_is_unresolved(one) for one in (of_film, coarser)):
        return bars.without("maximum_pressure", NoBar.SPIKE)
    return bars
