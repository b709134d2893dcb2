"""Error bars of a rolling and sliding line contact, with or without heat: the same on half the points, and half the
cells of the heat.

The bar is twice the difference to these and a share of what the film changes by, since differences may pass zero: an
estimate and no proved bound, of the meshes alone. Of 159 figures of 16 random contacts (0.2 to 1.6 GPa, 0.1 to 20 m/s,
slide-to-roll ratios 0 to 2, 20 to 127 degrees Celsius, 200 to 800 points) against 4000 points and 600 cells one was
beyond it, by a sixth. By how much the film misses what inlet heating leaves of it is added. What the lumped model of
heat leaves out is not in it. Full heat is on half the columns and half the layers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from bem.accuracy.bars import POINTS, RESIDUAL, ErrorBars
from bem.accuracy.film import FEWEST, FilmCase, spike_is_unresolved
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

FILM_SHARE = 1.0
"""Of the relative change of the film, in the bar of every figure that is no temperature."""
RISE_SHARE = 2.0
"""Of the same, over the rise, in that of temperatures."""
DIFFERENCE = 2.0
"""Of what half the cells of the heat change, which are of first order, and half the points, which are of second."""
CELLS, MOST_CELLS = 200, 2000
"""Of the heat along the film: on up to 1000 points, and the most."""
COLUMNS, LAYERS = 160, 16
"""Of the full heat along the film, on up to 960 points, and across it."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residual of the equations, relative to the film."""
_BARE = ("energy_imbalance", "inlet_factor", "highest_film_temperature", "hottest_oil")
"""Rounding, a formula that no mesh changes, and what stands at a spike of pressure in pure rolling."""
_TEMPERATURES = ("film_temperature", "lower_temperature", "upper_temperature")

Found = FilmSolution | ThermalFilm | FullThermalFilm


@dataclass(frozen=True)
class TractionCase:
    """Arguments of `bem.solve_line_film`, or with `bodies` of the solver of its heat, `thermal`; `bulk` [K] then, and
    no supply with "full"; the power is that on a width [m]; roughness [m] for the lambda ratio."""

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
        """Of lumped heat; more of them go with more points."""
        return min(max(CELLS, self.points // 5), MOST_CELLS)

    def on(self, points: int, coarseness: int = 1, initial: Found | None = None) -> Any:
        """The film on a mesh of so many points: a `ThermalFilm` or a `FullThermalFilm` with its heat, on as many times
        fewer cells, else a `FilmSolution`; from one of a similar case."""
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
    """Headline figures, SI units; the power is that on the case's width."""
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
    """The film alone."""
    return found if isinstance(found, FilmSolution) else found.film


def _power(film: FilmSolution, sliding: float) -> float:
    """Of friction [W/m]: of sliding, and of the rolling force on either surface."""
    return sliding * (film.speeds[0] - film.speeds[1]) + film.rolling_force * sum(film.speeds)


def _of_supply(case: TractionCase, film: FilmSolution) -> dict[str, float]:
    """Figures of a film with a supply; a flooded one has no meniscus."""
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
    """Bars of the figures of a solution on all points."""
    figures = {name: value for name, value in traction_figures(case, found).items() if name not in _BARE}
    film = film_of(found)
    other = case.on(case.points // 2 if case.points >= 2 * FEWEST else 2 * case.points, coarseness=2, initial=found)
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, NoBar.COARSER_UNSOLVED)
    there = figures | traction_figures(case, other)  # nearly flooded, one mesh may have no meniscus
    changed = max(abs(there[name] / figures[name] - 1) for name in ("minimum_thickness", "central_thickness"))
    missed = found.inlet_missed if isinstance(found, ThermalFilm) else 0.0
    left = found.residual if isinstance(found, FullThermalFilm) else film.residual
    points, residual = {}, {}
    for name, value in figures.items():
        if name in _TEMPERATURES:
            size, share = abs(value - min(case.bulk)), RISE_SHARE
        elif name == "film_rise":
            size, share = abs(value), RISE_SHARE
        else:
            size, share = abs(value), FILM_SHARE
        points[name] = DIFFERENCE * abs(there[name] - value) + share * changed * size
        residual[name] = (_ALGEBRAIC * left + share * missed) * size
    bars = ErrorBars.together({POINTS: points, RESIDUAL: residual})
    of_film = FilmCase(film, case.load, case.radius, case.contact_modulus, case.speeds, case.lubricant, case.points)
    coarser = replace(of_film, solution=film_of(other))
    if any(spike_is_unresolved(one) for one in (of_film, coarser)):
        return bars.without("maximum_pressure", NoBar.SPIKE)
    return bars
