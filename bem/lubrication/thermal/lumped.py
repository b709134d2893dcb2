"""Lumped heat of a line film: inlet shear heating thins the film, sliding heats the oil in it.

1. `_solve_thinned` finds the oil whose isothermal film is thinned by the factor of inlet heating, on coarse films, and
   solves that film on all points.
2. `_with_temperatures` solves the energy balance along it (`lumped_energy`), with viscosity over pressure and
   temperature (`hot_viscosity`). The heat generated is

       tau_m (u1 - u2) + dp/dx (h (u1 + u2)/2 - q),

   whose integral is the friction power.

Heat inside the contact does not act on the thickness; conductivity and heat capacity of the oil are those without
pressure. Verified in tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.lubrication.flow_factors import WallFactors, notes_on_factors
from bem.lubrication.inlet_heating import InletHeating, hertz_over_modulus, inlet_heating_factor
from bem.lubrication.line.case import LineCase, load_range
from bem.lubrication.line.problem import line_scales
from bem.lubrication.line.state import FilmState, without_factors
from bem.lubrication.line.steady import line_film, solve_coarse_film
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution, HeatedFilm
from bem.lubrication.shear_profile import middle_stress
from bem.lubrication.supply import Supply
from bem.lubrication.thermal.bodies import moving_bodies
from bem.lubrication.thermal.checks import heat_limits, notes_of_film, notes_of_heat
from bem.lubrication.thermal.columns import FilmColumns, cell_edges, cell_slopes, film_columns_of, sum_in_cells
from bem.lubrication.thermal.hot_viscosity import HotViscosity
from bem.lubrication.thermal.inlet_thinning import FACTOR_TOLERANCE, find_thinning, thinned_oil
from bem.lubrication.thermal.lumped_energy import Channel, Temperatures, film_temperatures
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import HEAT_NOT_FOUND
from bem.quantities import with_unit
from bem.reference_solutions.line_film import moes_central
from bem.threads import one_blas_thread

_TYPICAL, _SLIGHTEST, _ROUNDS = 0.7, -1e-3, 3
"""First exponent of the film in the viscosity; smallest ln of a viscosity ratio at which Moes' fit is evaluated;
evaluations of the fit."""
CELLS = 200
"""Cells along the film."""
MOST_FILMS = 6
"""Largest number of films of the search, the isothermal one included."""
NEAR = 1e-3
"""Logarithmic difference of load and pressure unit, in Moes' units, up to which a film on all points is a better start
than a coarse film of the case."""
LARGEST_STRESS = 1e12
"""Bound of stresses during the iteration [Pa]: cold oil without a limit would exceed floating point."""


@dataclass(frozen=True)
class ThermalFilm(HeatedFilm):
    """A film with lumped heat: one mean temperature across the film in each cell along it.

    `film` is the film of the oil thinned by inlet heating. `sliding_stress` is (m,) in the cells.

    Attributes
    ----------
    film_temperature : (m,) mean across the film [K].
    inlet : factor of inlet heating.
    inlet_missed : deviation of the film from that factor, relative, of coarse films.
    inlet_viscosity : at ambient pressure, of the thinned oil [Pa s].
    films : number of films solved.
    """

    film_temperature: FloatArray
    inlet: InletHeating
    inlet_missed: float
    inlet_viscosity: float
    films: int


def solve_thermal_line_film(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    speeds: Sequence[float],
    lubricant: Lubricant,
    bodies: Sequence[Body],
    bulk: Sequence[float] | None = None,
    points: int = 2000,
    initial: FilmSolution | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 40,
    flow_factors: WallFactors | str = "off",
    cells: int = CELLS,
    supply: Supply | float | None = None,
) -> ThermalFilm:
    """Solve the steady film between a cylinder and a flat with lumped heat: one temperature across the film.

    Parameters
    ----------
    load, radius, contact_modulus, speeds, lubricant : as of `solve_line_film`. The lubricant has a temperature, that of
        the oil supplied, and its heat constants, as those of the catalogue have.
    bodies : flat and cylinder, whose materials have `thermal_conductivity`, `density` and `heat_capacity`. A body at
        rest is taken as cool at a distance of the radius.
    bulk : temperatures of both far from the contact [K]; the oil's by default.
    points, initial, tolerance, max_iterations, flow_factors : as of `solve_line_film`.
    cells : along the film, where temperatures are found.
    supply : as of `solve_line_film`: inlet heating thins what a flooded contact would take, of which the supply lets as
        much through as there is; the oil has the temperature of the supply where the gap begins to be full.

    Returns
    -------
    ThermalFilm, converged where the film, its temperatures and what inlet heating leaves of the film are.

    Raises
    ------
    InputError : as `solve_line_film`; a lubricant without temperature and heat constants, bodies without theirs, a bulk
        temperature above 300 degrees Celsius; inlet heating that leaves an oil too thin for a film to be looked for.

    Notes
    -----
    Jaeger (1942) for moving heat, Crook (1961) for heat across the film, Gupta et al. (1992) for the inlet.
    """
    case = LineCase(
        load, radius, contact_modulus, speeds, lubricant, points, tolerance, initial, max_iterations, flow_factors
    )
    return thermal_film(case, bodies, bulk, cells, supply)


@one_blas_thread
def thermal_film(
    case: LineCase,
    bodies: Sequence[Body],
    bulk: Sequence[float] | None,
    cells: int,
    supply: Supply | float | None,
) -> ThermalFilm:
    """Solve as `solve_thermal_line_film`."""
    if not (isinstance(cells, int) and 20 <= cells <= 2000):
        raise InputError(f"solve_thermal_line_film: cells {cells!r} must be an integer from 20 to 2000")
    case.scaled()
    lubricant, speeds = case.lubricant, case.speeds
    conductors = moving_bodies("solve_thermal_line_film", lubricant, bodies, speeds, bulk, case.radius)
    assert lubricant.temperature_viscosity is not None
    assert lubricant.thermal_conductivity is not None
    inlet = inlet_heating_factor(
        lubricant.viscosity,
        lubricant.temperature_viscosity,
        lubricant.thermal_conductivity,
        (float(speeds[0]), float(speeds[1])),
        hertz_over_modulus(case.load, case.radius, case.contact_modulus),
    )
    thinned = _solve_thinned(case, inlet)
    if supply is not None:
        thinned.starve(case, supply)
    thermal = _with_temperatures(thinned, lubricant, conductors, cells)
    found = thermal.film.status is Status.CONVERGED
    notes = notes_of_film(
        thermal.film,
        lubricant,
        case.radius,
        case.contact_modulus,
        temperature=thermal.mean_film_temperature,
        found=found,
    )
    notes += notes_on_factors(case.flow_factors, thermal.minimum_thickness)
    return replace(thermal, notes=notes + _limits(thermal, lubricant, starved=supply is not None) + thermal.notes)


@dataclass
class _ThinnedFilms:
    """Films of ever thinner oils, the first of them isothermal, the last one thinned by inlet heating.

    deviation : of the last film from the wanted film, relative; infinite where a film did not converge.
    steps : Newton steps of all films.
    """

    inlet: InletHeating
    films: list[FilmSolution] = field(default_factory=list)
    deviation: float = math.inf
    steps: int = 0

    def add(self, film: FilmSolution) -> None:
        """Append a film."""
        self.films.append(film)
        self.steps += film.iterations

    def starve(self, case: LineCase, supply: Supply | float) -> None:
        """Append the film of the thinned oil with its supply."""
        hot = self.films[-1]
        start = hot if case.initial is None or case.initial.starvation is None else case.initial
        self.add(line_film(replace(case, lubricant=hot.lubricant, initial=start), supply=supply))


def _solve_thinned(case: LineCase, inlet: InletHeating) -> _ThinnedFilms:
    """Solve for the film that inlet heating leaves: the viscosity from coarse films, then the film on all points."""
    initial = case.initial
    found = _search(solve_coarse_film, replace(case, initial=_coarse_start(initial)), inlet)
    if math.isinf(found.deviation):
        spent, found = found.steps, _search(line_film, case, inlet)
        found.steps += spent
        return found
    coarse = found.films[-1]
    start = initial if initial is not None and _is_near(initial, coarse) else coarse
    found.add(line_film(replace(case, lubricant=coarse.lubricant, initial=start)))
    return found


def _is_near(film: FilmSolution, other: FilmSolution) -> bool:
    """Return True if two films are so nearly of one case that the film on all points is the better start."""
    one, there = film.state, other.state
    if not (isinstance(one, FilmState) and isinstance(there, FilmState)):
        return False
    ratios = (one.load / there.load, one.scales.pressure / there.scales.pressure)
    return max(abs(math.log(ratio)) for ratio in ratios) < NEAR


def _search(solve: Callable[[LineCase], FilmSolution], case: LineCase, inlet: InletHeating) -> _ThinnedFilms:
    """Return the films of a search for the viscosity that inlet heating leaves, all on one kind of mesh."""
    found = _ThinnedFilms(inlet)
    found.add(solve(case))
    isothermal, wanted = found.films[0], math.log(inlet.factor)
    if isothermal.status is not Status.CONVERGED:
        return found
    found.deviation = abs(math.expm1(-wanted))
    if found.deviation <= FACTOR_TOLERANCE:
        return found

    def log_film(log_viscosity: float) -> float:
        thinner = thinned_oil(case.lubricant, math.exp(log_viscosity))
        _check_load(case, thinner, inlet)
        found.add(solve(replace(case, lubricant=thinner, initial=found.films[-1])))
        film = found.films[-1]
        converged = film.status is Status.CONVERGED
        return math.log(film.central_thickness / isothermal.central_thickness) if converged else math.nan

    exponent = _fitted_exponent(case, wanted)
    found.deviation = find_thinning(log_film, wanted, exponent, MOST_FILMS - 1, FACTOR_TOLERANCE).deviation
    return found


def _coarse_start(initial: FilmSolution | None) -> FilmSolution | None:
    """Return the start of the coarse films: of a film with lumped heat, its coarse film without heat."""
    heat = None if initial is None else initial.heat
    return heat.isothermal if isinstance(heat, ThermalFilm) else initial


def _fitted_exponent(case: LineCase, wanted: float) -> float:
    """Return the exponent of the film in the viscosity by Moes' fit (`moes_central`), down to a film whose ln is
    `wanted` less."""
    entrainment = abs(sum(case.speeds))
    scales = line_scales(case.load, case.radius, case.contact_modulus, entrainment, case.lubricant.viscosity)
    piezo = case.lubricant.pressure_viscosity * scales.pressure

    def film(ratio: float) -> float:
        return 0.5 * ratio + math.log(
            moes_central(scales.load * math.exp(-0.5 * ratio), piezo * math.exp(0.25 * ratio))
        )

    exponent = _TYPICAL
    for _ in range(_ROUNDS):
        ratio = min(wanted / exponent, _SLIGHTEST)
        exponent = (film(ratio) - film(0.0)) / ratio
    return exponent


def _check_load(case: LineCase, thinner: Lubricant, inlet: InletHeating) -> None:
    """Refuse a load that the thinned oil cannot carry."""
    highest = load_range(case.radius, case.contact_modulus, case.speeds, thinner)[1]
    if case.load > highest:
        raise InputError(
            f"thermal: shear heating in the inlet leaves {inlet.factor:.2g} of the film, as of an oil "
            f"of {with_unit(thinner.viscosity, 'Pa*s')}, which carries {with_unit(highest, 'N/m')} at most: load "
            f"{with_unit(case.load, 'N/m')} is beyond it. Lower the load or the speeds."
        )


def _with_temperatures(
    thinned: _ThinnedFilms, lubricant: Lubricant, bodies: tuple[Conductor, Conductor], cells: int
) -> ThermalFilm:
    """Solve for the temperatures of the last film and return the result."""
    film = thinned.films[-1]
    film_columns, viscosity = film_columns_of(film, partial(cell_edges, cells=cells)), HotViscosity.of(lubricant)
    middle, width = 0.5 * (film_columns.edges[1:] + film_columns.edges[:-1]), np.diff(film_columns.edges)
    pieces = np.diff(film_columns.x)

    def stresses(temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        at = np.interp(film_columns.x, middle, temperature)
        value, slope = viscosity(film_columns.pressure, at)
        rate, extra = film_columns.sliding / film_columns.thickness, 1e-4
        stress, warmer = (
            middle_stress(
                lubricant, mu * rate, film_columns.pressure, film_columns.thickness, film_columns.gradient, warm
            )
            for mu, warm in ((value, at), (value + extra * slope, at + extra))
        )
        slopes = np.where(np.abs(stress) < LARGEST_STRESS, (warmer - stress) / extra, 0.0)
        return np.clip(stress, -LARGEST_STRESS, LARGEST_STRESS), slopes

    ambient = lubricant.viscosity * film_columns.sliding * film_columns.inlet_shear
    poiseuille_heat = film_columns.pressure_power - film_columns.flow * film_columns.pressure_work

    by_width = np.stack([np.append(0.0, 1 / width[:-1]), 1 / width, np.append(1 / width[1:], 0.0)])

    def heat(temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        stress, slope = stresses(temperature)
        generated = sum_in_cells(film_columns.cell, 0.5 * pieces * (stress[1:] + stress[:-1]), len(width))
        generated[0] += ambient
        derivative = cell_slopes(film_columns, middle, 0.5 * pieces * slope[:-1], 0.5 * pieces * slope[1:])
        return (
            film_columns.sliding * generated + poiseuille_heat
        ) / width, film_columns.sliding * derivative * by_width

    density, capacity = lubricant.density or 0.0, lubricant.heat_capacity or 0.0
    flow = 0.5 * abs(sum(film.speeds)) * float(film_columns.thickness[-1])
    supply = float(lubricant.temperature or 0.0)
    thickness = (
        sum_in_cells(
            film_columns.cell, 0.5 * pieces * (film_columns.thickness[1:] + film_columns.thickness[:-1]), len(width)
        )
        / width
    )
    channel = Channel(
        film_columns.edges, thickness, lubricant.thermal_conductivity or 0.0, density * capacity * flow, supply, bodies
    )
    found = film_temperatures(channel, heat)
    stress = stresses(found.oil)[0]
    along = sum_in_cells(film_columns.cell, 0.5 * pieces * (stress[1:] + stress[:-1]), len(width))
    return _result(thinned, lubricant, film_columns, channel, found, along / width, float(along.sum()) + ambient)


def _result(
    thinned: _ThinnedFilms,
    lubricant: Lubricant,
    film_columns: FilmColumns,
    channel: Channel,
    found: Temperatures,
    stress: FloatArray,
    couette: float,
) -> ThermalFilm:
    """Return the result with signs along +x, and NaN where it did not converge."""
    film, inlet = thinned.films[-1], thinned.inlet
    width = np.diff(film_columns.edges)
    into = found.into @ width
    carried = channel.capacity_flow * float(found.oil[-1] - channel.supply)
    power = film_columns.sliding * couette + sum(film.speeds) * film.rolling_force
    imbalance = abs(power - float(into.sum()) - carried) / max(abs(power), 1e-300)
    state = film.state
    assert isinstance(state, FilmState)
    sign = -1.0 if state.reversed else 1.0
    converged = found.residual <= 1e-6 and thinned.deviation <= FACTOR_TOLERANCE
    status = film.status if film.status is not Status.CONVERGED or converged else Status.STALLED
    order = slice(None, None, -1) if state.reversed else slice(None)
    lost: tuple[Note, ...]
    mask, lost = (1.0, ()) if status is Status.CONVERGED else (math.nan, (HEAT_NOT_FOUND(reason="lumped"),))
    hottest = mask * max(float(found.oil.max()), float(found.surfaces.max()))
    couette, power = mask * couette, mask * power
    return ThermalFilm(
        film=without_factors(film),
        isothermal=without_factors(thinned.films[0]),
        position=sign * (0.5 * (film_columns.edges[1:] + film_columns.edges[:-1]))[order],
        width=width[order],
        film_temperature=mask * found.oil[order],
        surface_temperatures=mask * found.surfaces[:, order],
        sliding_stress=mask * sign * stress[order],
        heat_made=mask * found.heat[order],
        heat_into=mask * found.into[:, order],
        shear_force=sign * couette + film.rolling_force,
        sliding_force=sign * couette,
        friction_power=power,
        power_into=(mask * float(into[0]), mask * float(into[1])),
        power_carried=mask * carried,
        energy_imbalance=imbalance,
        inlet=inlet,
        inlet_missed=thinned.deviation,
        inlet_viscosity=film.lubricant.viscosity,
        films=len(thinned.films),
        iterations=thinned.steps,
        status=status,
        notes=(*notes_of_heat(lubricant, hottest), *lost),
    )


def _limits(found: ThermalFilm, lubricant: Lubricant, *, starved: bool) -> tuple[Note, ...]:
    """Return notes where lumped heat is inaccurate; a starved film has no full heat to be sent to."""
    remedy = "Take film and friction as estimates." if starved else 'Set thermal = "full".'
    rise = found.mean_film_temperature - float(lubricant.temperature or 0.0)
    return heat_limits(found.inlet, found.film.speeds, rise, remedy)
