"""Thermal film of a line contact, lumped: inlet shear heating thins the film, sliding heats the oil in it.

The film is that of an oil as much thinner as `inlet` says that shear in the inlet makes the film; what sliding makes of
temperature and friction then follows from `energy`, one mean temperature across the film at each place, with viscosity
over pressure and temperature (`hot_viscosity`). Heat is made by the stresses that the film has at its temperature:

    made = tau_m (u1 - u2) + dp/dx (h (u1 + u2)/2 - q),

the integral of which is the power of the friction. What the heat inside the contact does to the film's thickness is not
in it, and the oil's conductivity and heat capacity are those without pressure. Verified in
tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

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
from bem.lubrication.thermal.columns import Strip, cell_edges, derivative_of, strip_of, summed
from bem.lubrication.thermal.hot_viscosity import HotViscosity
from bem.lubrication.thermal.lumped_energy import Channel, Temperatures, film_temperatures
from bem.lubrication.viscosity import ViscosityLaw
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import HEAT_NOT_FOUND
from bem.reference_solutions.line_film import moes_central
from bem.threads import one_blas_thread

_TYPICAL, _SLIGHTEST, _ROUNDS = 0.7, -1e-3, 3
"""Exponent that the fitted one is found from, the least ln of a share that it is looked up for, and how often."""
FACTOR_TOLERANCE = 5e-3
"""Of the film that inlet heating leaves; the factor itself is good to some 0.05."""
CELLS = 200
"""Along the film."""
MOST_FILMS = 6
NEAR = 1e-3
"""Of load and pressure in Moes' units, from which a sharp spike has left its fine cells: from its own sketch a film
then takes half the steps."""
LARGEST_STRESS = 1e12
"""On the way to the temperatures [Pa]: cold oil that has no limit would carry more than can be computed with."""


@dataclass(frozen=True)
class ThermalFilm(HeatedFilm):
    """A film with the heat that is made in it, along the entrainment where positions are.

    Attributes
    ----------
    film : solution of the film, of the oil as thin as inlet heating makes it; its own shear force is isothermal.
    isothermal : the film without heat, a sketch (`bem.lubrication.line.steady`).
    position : (m,) middles of cells [m].
    width : (m,) of them [m].
    film_temperature : (m,) mean across the film [K].
    surface_temperatures : (2, m) of flat and cylinder [K].
    sliding_stress : (m,) of the oil in the middle of the film [Pa], signed like the force.
    heat_made : (m,) [W/m^2].
    heat_into : (2, m) into flat and cylinder [W/m^2].
    shear_force : as of `FilmSolution`, at these temperatures [N/m].
    sliding_force : its part from sliding [N/m].
    friction_power, power_into, power_carried : per unit length [W/m]: of the friction; (2,) into flat and cylinder;
        carried on by the oil.
    energy_imbalance : of the three, relative to the friction.
    inlet : factor of inlet heating.
    inlet_missed : by how much the film misses it, relative, of sketches.
    inlet_viscosity : at ambient pressure that leaves such a film [Pa s].
    films : solved.
    iterations : Newton steps of all films.
    notes : sentences.
    status : of film and temperatures. Where it is not converged, temperatures, heat flows, stresses and friction are
        NaN: what was not found may be -3865 K.
    """

    film_temperature: FloatArray
    surface_temperatures: FloatArray
    sliding_stress: FloatArray
    heat_made: FloatArray
    heat_into: FloatArray
    shear_force: float
    sliding_force: float
    friction_power: float
    power_into: tuple[float, float]
    power_carried: float
    energy_imbalance: float
    inlet: InletHeating
    inlet_missed: float
    inlet_viscosity: float
    films: int
    iterations: int
    status: Status
    notes: tuple[Note, ...]

    def as_film(self) -> FilmSolution:
        """The film with its friction and temperatures, as `solve_line_film` gives it."""
        return replace(
            self.film,
            shear_force=self.shear_force,
            striated_shear_force=math.nan,
            sliding_stress=np.interp(self.film.position, self.position, self.sliding_stress),
            mean_temperature=self.mean_film_temperature,
            maximum_temperature=self.highest_film_temperature,
            iterations=self.iterations,
            status=self.status,
            notes=self.notes,
            heat=self,
        )


@dataclass(frozen=True)
class ThinnedLaw(ViscosityLaw):
    """A law over pressure of an oil as it is, for one whose viscosity at ambient pressure is a share of it."""

    name: ClassVar[str] = "thinned"
    law: ViscosityLaw
    share: float

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """That of the oil as it is."""
        return self.law.log_viscosity_ratio(pressure, viscosity / self.share, pressure_viscosity)


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
    """Steady thermal film between a cylinder and a flat, lumped over the film's thickness.

    Parameters
    ----------
    load, radius, contact_modulus, speeds, lubricant : as of `solve_line_film`. The lubricant has a temperature, that of
        the oil supplied, and its heat constants, as those of the catalogue have.
    bodies : flat and cylinder, whose materials have `thermal_conductivity`, `density` and `heat_capacity`. One at rest
        is taken as cool at a distance of the radius.
    bulk : temperatures of both far from the contact [K]; the oil's by default.
    points, initial, tolerance, max_iterations, flow_factors : as of `solve_line_film`.
    cells : along the film, where temperatures are found.
    supply : as of `solve_line_film`: inlet heating thins what a flooded contact would take, of which the supply lets as
        much through as there is; the oil is as warm as the bodies' oil where the gap begins to be full.

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
    """As `solve_thermal_line_film`."""
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
    thinned = _thinned(case, inlet)
    if supply is not None:
        thinned.starve(case, supply)
    thermal = _heated(thinned, lubricant, conductors, cells)
    found = thermal.film.status is Status.CONVERGED
    notes = notes_of_film(thermal.film, lubricant, case.radius, case.contact_modulus, found=found)
    notes += notes_on_factors(case.flow_factors, thermal.minimum_thickness)
    return replace(thermal, notes=notes + _limits(thermal, lubricant) + thermal.notes)


@dataclass
class _Thinned:
    """Films of ever thinner oils, the first of them isothermal; the last one is as thin as inlet heating leaves it but
    for `missed`, relative, which is infinite where one did not converge."""

    inlet: InletHeating
    films: list[FilmSolution] = field(default_factory=list)
    missed: float = math.inf
    steps: int = 0

    def add(self, film: FilmSolution) -> None:
        """One more."""
        self.films.append(film)
        self.steps += film.iterations

    def starve(self, case: LineCase, supply: Supply | float) -> None:
        """The last one once more, with its supply."""
        hot = self.films[-1]
        start = hot if case.initial is None or case.initial.starvation is None else case.initial
        self.add(line_film(replace(case, lubricant=hot.lubricant, initial=start), supply=supply))


def _thinned(case: LineCase, inlet: InletHeating) -> _Thinned:
    """How thin the oil must be is found of sketches, where there are; only the last film is on all points."""
    initial = case.initial
    found = _search(solve_coarse_film, replace(case, initial=_sketch_start(initial)), inlet)
    if math.isinf(found.missed):
        spent, found = found.steps, _search(line_film, case, inlet)
        found.steps += spent
        return found
    sketch = found.films[-1]
    start = initial if initial is not None and _is_near(initial, sketch) else sketch
    found.add(line_film(replace(case, lubricant=sketch.lubricant, initial=start)))
    return found


def _is_near(film: FilmSolution, other: FilmSolution) -> bool:
    """Return True if films are so nearly of one case that one on all points is a better start than a sketch of the
    case."""
    one, there = film.state, other.state
    if not (isinstance(one, FilmState) and isinstance(there, FilmState)):
        return False
    ratios = (one.load / there.load, one.scales.pressure / there.scales.pressure)
    return max(abs(math.log(ratio)) for ratio in ratios) < NEAR


def _search(solve: Callable[[LineCase], FilmSolution], case: LineCase, inlet: InletHeating) -> _Thinned:
    """All on one mesh, with the exponent of the film in the viscosity between the last two films, of a fit at first."""
    found = _Thinned(inlet)
    found.add(solve(case))
    isothermal, wanted, ratio, last = found.films[0], math.log(inlet.factor), 0.0, (0.0, 0.0)
    exponent = _fitted_exponent(case, wanted)
    while found.films[-1].status is Status.CONVERGED:
        reached = math.log(found.films[-1].central_thickness / isothermal.central_thickness)
        found.missed = abs(math.expm1(reached - wanted))
        if found.missed <= FACTOR_TOLERANCE or len(found.films) == MOST_FILMS:
            return found
        if reached != last[1] and ratio != last[0]:
            exponent = (reached - last[1]) / (ratio - last[0])
        last = ratio, reached
        ratio += (wanted - reached) / exponent
        thinner = thinned_oil(case.lubricant, math.exp(ratio))
        _check_load(case, thinner, inlet)
        found.add(solve(replace(case, lubricant=thinner, initial=found.films[-1])))
    found.missed = math.inf
    return found


def _sketch_start(initial: FilmSolution | None) -> FilmSolution | None:
    """Of a film with lumped heat: its own sketch without heat."""
    heat = None if initial is None else initial.heat
    return heat.isothermal if isinstance(heat, ThermalFilm) else initial


def _fitted_exponent(case: LineCase, wanted: float) -> float:
    """Of the film in the viscosity, down to a film whose ln is `wanted` less; of Moes' fit (`moes_central`)."""
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


def thinned_oil(lubricant: Lubricant, share: float) -> Lubricant:
    """The oil with a share of its viscosity at every pressure."""
    law = ThinnedLaw(lubricant.viscosity_law, share)
    return replace(lubricant, viscosity=lubricant.viscosity * share, viscosity_law=law)


def _check_load(case: LineCase, thinner: Lubricant, inlet: InletHeating) -> None:
    """Refuse a load that the oil as thin as inlet heating makes it cannot carry."""
    highest = load_range(case.radius, case.contact_modulus, case.speeds, thinner)[1]
    if case.load > highest:
        raise InputError(
            f"solve_thermal_line_film: shear heating in the inlet leaves {inlet.factor:.2g} of the film, as of an oil "
            f"of {thinner.viscosity:.3g} Pa s, with which a film is looked for up to {highest:.4g} N/m: load "
            f"{case.load!r} N/m is beyond it. Lower the load or the speeds."
        )


def _heated(thinned: _Thinned, lubricant: Lubricant, bodies: tuple[Conductor, Conductor], cells: int) -> ThermalFilm:
    """Temperatures and friction of the last film."""
    film = thinned.films[-1]
    strip, viscosity = strip_of(film, partial(cell_edges, cells=cells)), HotViscosity.of(lubricant)
    middle, width = 0.5 * (strip.edges[1:] + strip.edges[:-1]), np.diff(strip.edges)
    pieces = np.diff(strip.x)

    def stresses(temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        at = np.interp(strip.x, middle, temperature)
        value, slope = viscosity(strip.pressure, at)
        rate, extra = strip.sliding / strip.thickness, 1e-4
        stress, warmer = (
            middle_stress(lubricant, mu * rate, strip.pressure, strip.thickness, strip.gradient, warm)
            for mu, warm in ((value, at), (value + extra * slope, at + extra))
        )
        slopes = np.where(np.abs(stress) < LARGEST_STRESS, (warmer - stress) / extra, 0.0)
        return np.clip(stress, -LARGEST_STRESS, LARGEST_STRESS), slopes

    ambient = lubricant.viscosity * strip.sliding * strip.upstream
    rolling = strip.pushed - strip.flow * strip.work

    by_width = np.stack([np.append(0.0, 1 / width[:-1]), 1 / width, np.append(1 / width[1:], 0.0)])

    def heat(temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        stress, slope = stresses(temperature)
        made = summed(strip.cell, 0.5 * pieces * (stress[1:] + stress[:-1]), len(width))
        made[0] += ambient
        derivative = derivative_of(strip, middle, 0.5 * pieces * slope[:-1], 0.5 * pieces * slope[1:])
        return (strip.sliding * made + rolling) / width, strip.sliding * derivative * by_width

    density, capacity = lubricant.density or 0.0, lubricant.heat_capacity or 0.0
    flow = 0.5 * abs(sum(film.speeds)) * float(strip.thickness[-1])
    supply = float(lubricant.temperature or 0.0)
    thickness = summed(strip.cell, 0.5 * pieces * (strip.thickness[1:] + strip.thickness[:-1]), len(width)) / width
    channel = Channel(
        strip.edges, thickness, lubricant.thermal_conductivity or 0.0, density * capacity * flow, supply, bodies
    )
    found = film_temperatures(channel, heat)
    stress = stresses(found.oil)[0]
    along = summed(strip.cell, 0.5 * pieces * (stress[1:] + stress[:-1]), len(width))
    return _result(thinned, lubricant, strip, channel, found, along / width, float(along.sum()) + ambient)


def _result(
    thinned: _Thinned,
    lubricant: Lubricant,
    strip: Strip,
    channel: Channel,
    found: Temperatures,
    stress: FloatArray,
    couette: float,
) -> ThermalFilm:
    film, inlet = thinned.films[-1], thinned.inlet
    width = np.diff(strip.edges)
    into = found.into @ width
    carried = channel.capacity_flow * float(found.oil[-1] - channel.supply)
    power = strip.sliding * couette + sum(film.speeds) * film.rolling_force
    imbalance = abs(power - float(into.sum()) - carried) / max(abs(power), 1e-300)
    kept = film.state
    assert isinstance(kept, FilmState)
    sign = -1.0 if kept.reversed else 1.0
    right = found.residual <= 1e-6 and thinned.missed <= FACTOR_TOLERANCE
    status = film.status if film.status is not Status.CONVERGED or right else Status.STALLED
    order = slice(None, None, -1) if kept.reversed else slice(None)
    lost: tuple[Note, ...]
    known, lost = (1.0, ()) if status is Status.CONVERGED else (math.nan, (HEAT_NOT_FOUND(reason="lumped"),))
    hottest = known * max(float(found.oil.max()), float(found.surfaces.max()))
    couette, power = known * couette, known * power
    return ThermalFilm(
        film=without_factors(film),
        isothermal=without_factors(thinned.films[0]),
        position=sign * (0.5 * (strip.edges[1:] + strip.edges[:-1]))[order],
        width=width[order],
        film_temperature=known * found.oil[order],
        surface_temperatures=known * found.surfaces[:, order],
        sliding_stress=known * sign * stress[order],
        heat_made=known * found.made[order],
        heat_into=known * found.into[:, order],
        shear_force=sign * couette + film.rolling_force,
        sliding_force=sign * couette,
        friction_power=power,
        power_into=(known * float(into[0]), known * float(into[1])),
        power_carried=known * carried,
        energy_imbalance=imbalance,
        inlet=inlet,
        inlet_missed=thinned.missed,
        inlet_viscosity=film.lubricant.viscosity,
        films=len(thinned.films),
        iterations=thinned.steps,
        status=status,
        notes=(*notes_of_heat(lubricant, hottest), *lost),
    )


def _limits(found: ThermalFilm, lubricant: Lubricant) -> tuple[Note, ...]:
    """Return notes where lumped heat was seen to be inaccurate."""
    rise = found.mean_film_temperature - float(lubricant.temperature or 0.0)
    return heat_limits(found.inlet, found.film.speeds, rise)
