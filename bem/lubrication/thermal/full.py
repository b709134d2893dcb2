"""Thermal film of a line contact, with the temperature across it: energy and Reynolds' equation, each in the other.

The oil's temperature along and across the film follows from conduction, convection, compression and dissipation
(`field`, `made`), that of the surfaces from the heat that enters them; viscosity and density across the film at those
temperatures change what flows (`layers`), and with it pressure and thickness; where the film follows its shear law,
that acts in every layer (`section`). `coupled` goes from one to the other until both hold. Nothing is fitted.
Conductivity and heat capacity of the oil are those without pressure and at its own temperature; beyond the exit nothing
is followed. Verified in tests/lubrication/test_full_thermal.py and test_layers_sheared.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.flow_factors import WallFactors, notes_on_factors
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.newton import Outcome
from bem.lubrication.line.state import FilmState, layer_centres, without_factors
from bem.lubrication.line.steady import build_solution, line_film
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution, HeatedFilm
from bem.lubrication.thermal.bodies import moving_bodies
from bem.lubrication.thermal.checks import notes_of_film, notes_of_heat
from bem.lubrication.thermal.coupling import Coupling, Heated, HotNeighbour, coupled
from bem.lubrication.thermal.field import LEAST_RISE, carried
from bem.lubrication.thermal.layers import Oil, expansion_of
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import HEAT_NOT_FOUND, OIL_DATA_SHORT
from bem.representation import readable
from bem.threads import one_blas_thread

COLUMNS = 160
LAYERS = 16
ENERGY_TOLERANCE = 1e-6
"""Of the power of the friction that is not found again in the bodies and the oil, and of surfaces that are not as warm
as their heat makes them, over the largest rise."""


@readable
@dataclass(frozen=True)
class FullThermalFilm(HeatedFilm):
    """A film with its temperatures along and across, and the heat that is made in it; along the entrainment where
    positions are.

    Attributes
    ----------
    film : solution of the film at these temperatures; its own shear force is that of the oil at its own temperature.
    isothermal : the film without heat.
    position : (m,) middles of columns [m].
    width : (m,) of them [m].
    height : (K,) of the layers' middles over the film's thickness, from the flat (0) to the cylinder (1).
    temperature : (m, K) of the oil [K].
    surface_temperatures : (2, m) of flat and cylinder [K].
    sliding_stress : in the middle of the film at its positions [Pa], signed like the force.
    heat_made : (m,) [W/m^2], that of compression included.
    heat_into : (2, m) into flat and cylinder [W/m^2].
    shear_force : as of `FilmSolution`, at these temperatures [N/m].
    sliding_force : its part from sliding [N/m].
    friction_power, power_into, power_carried : per unit length [W/m]: of the friction; (2,) into flat and cylinder;
        carried on by the oil.
    energy_imbalance : of the three, relative to the friction, each from the result itself.
    residual : of Reynolds' equation at these temperatures, relative to the film.
    surface_residual : by how much the
        surfaces are not as warm as the heat into them makes them, over the largest rise.
    rounds : temperature fields solved for.
    iterations : Newton steps of all films.
    status : of film and temperatures;
        where it is not converged all temperatures,
        heat flows, stresses and friction are NaN.
    notes : sentences.
    """

    height: FloatArray
    temperature: FloatArray
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
    residual: float
    surface_residual: float
    rounds: int
    iterations: int
    status: Status
    notes: tuple[Note, ...]

    @property
    def film_temperature(self) -> FloatArray:
        """Mean across the film (m,) [K]."""
        return np.asarray(self.temperature.mean(axis=1))

    def as_film(self) -> FilmSolution:
        """The film with its friction and temperatures, as `solve_line_film` gives it."""
        return replace(
            self.film,
            shear_force=self.shear_force,
            striated_shear_force=math.nan,
            sliding_stress=self.sliding_stress,
            mean_temperature=self.mean_film_temperature,
            maximum_temperature=float(self.temperature.max()),
            iterations=self.iterations,
            residual=self.residual,
            status=self.status,
            notes=self.notes,
            heat=self,
        )


def solve_full_thermal_line_film(
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
    columns: int = COLUMNS,
    layers: int = LAYERS,
) -> FullThermalFilm:
    """Steady thermal film between a cylinder and a flat, with its temperature along and across.

    Parameters
    ----------
    load, radius, contact_modulus, speeds, lubricant, bodies, bulk : as of `solve_thermal_line_film`.
    points, initial, tolerance, max_iterations, flow_factors : as of `solve_line_film`.
    columns, layers : along and across the film, at most, where temperatures are found.

    Returns
    -------
    FullThermalFilm, converged where Reynolds' equation holds at its temperatures to the tolerance, energy closes and
    surfaces are as warm as their heat makes them to `ENERGY_TOLERANCE`.

    Raises
    ------
    InputError : as `solve_line_film`; a lubricant without temperature and heat constants, bodies without theirs, a bulk
        temperature above 300 degrees Celsius.

    Notes
    -----
    Dowson (1962) for the film, Carslaw and Jaeger (1959) for the bodies; Cheng and Sternlicht, J. Basic Eng. 87 (1965)
    695, for both together in a line contact.
    """
    case = LineCase(
        load, radius, contact_modulus, speeds, lubricant, points, tolerance, initial, max_iterations, flow_factors
    )
    return full_thermal_film(case, bodies, bulk, columns, layers)


@one_blas_thread
def full_thermal_film(
    case: LineCase, bodies: Sequence[Body], bulk: Sequence[float] | None, columns: int, layers: int
) -> FullThermalFilm:
    """As `solve_full_thermal_line_film`."""
    for name, value, most in (("columns", columns, 2000), ("layers", layers, 200)):
        if not (isinstance(value, int) and 6 <= value <= most):
            raise InputError(f"solve_full_thermal_line_film: {name} {value!r} must be an integer from 6 to {most}")
    units = case.scaled()
    lubricant, tolerance = case.lubricant, case.tolerance
    name = "solve_full_thermal_line_film"
    conductors = moving_bodies(name, lubricant, bodies, case.speeds, bulk, case.radius)
    before = None if case.initial is None else case.initial.state
    heat = before.heat if isinstance(before, FilmState) else None
    cold = line_film(case if heat is None else replace(case, initial=heat.isothermal))
    kept = cold.state
    assert isinstance(kept, FilmState)
    first, second = float(case.speeds[0]), float(case.speeds[1])
    coupling = Coupling(
        problem=case.problem(kept.scales),
        oil=Oil.of(lubricant),
        bodies=conductors,
        slide=(second - first) / (first + second),
        unit=kept.scales.pressure,
        film_of=lambda outcome: build_solution(outcome, outcome, case, units),
        columns=columns,
        layers=layers,
        tolerance=tolerance,
        limit=case.max_iterations,
    )
    start = Outcome(kept.state, cold.iterations, cold.residual, cold.status is Status.CONVERGED)
    near = None
    if heat is not None and isinstance(before, FilmState):
        near = HotNeighbour(before.neighbour(kept.scales), heat)
    found = coupled(coupling, start, near)
    if found.met(tolerance):
        film = found.film
        assert isinstance(film.state, FilmState)
        film = replace(film, state=replace(film.state, heat=found.kept(without_factors(cold), columns)))
        found = replace(found, film=film)
    thermal = _result(found, cold, tolerance, kept.reversed)
    stress = found.made.across(found.field.oil).newtonian
    notes = notes_of_film(found.film, lubricant, case.radius, case.contact_modulus, stress, found=start.converged)
    notes += notes_on_factors(case.flow_factors, found.film.minimum_thickness)
    return replace(thermal, notes=notes + thermal.notes)


def _result(found: Heated, cold: FilmSolution, tolerance: float, reversed_: bool) -> FullThermalFilm:
    """All figures anew from the film and the temperatures."""
    film, strip, duct, field = found.film, found.strip, found.duct, found.field
    lubricant, oil, width = film.lubricant, found.field.oil, found.duct.width
    sources = found.made(oil)
    stress = found.made.across(oil).stress
    couette = found.made.couette(stress)
    into = duct.into_walls(field.rise)
    surfaces = field.temperature[:, [0, -1]].T
    rise = max(float(np.ptp(field.rise)), LEAST_RISE)
    missed = float(np.abs(duct.surfaces(into) - surfaces).max()) / rise
    taken = carried(duct, sources.flux, field.rise[:, 1:-1])
    power = strip.sliding * couette + sum(film.speeds) * film.rolling_force
    imbalance = abs(power - float(into.sum()) - taken) / max(abs(power), 1e-300)
    right = max(imbalance, missed) <= ENERGY_TOLERANCE and found.residual <= tolerance
    order = slice(None, None, -1) if reversed_ else slice(None)
    sign = -1.0 if reversed_ else 1.0
    # a field that is not found may hold any number (6e29 K was seen): none of it is shown, nor what follows from it
    known = 1.0 if right else math.nan
    made = known * sources.made.sum(axis=1)
    oil, surfaces, stress, into = known * oil, known * surfaces, known * stress, known * into
    couette, taken, power = known * couette, known * taken, known * power
    notes = notes_of_heat(lubricant, known * float(field.temperature.max()))
    if expansion_of(lubricant) is None:
        notes += (OIL_DATA_SHORT(reason="expansion"),)
    return FullThermalFilm(
        film=without_factors(film),
        isothermal=without_factors(cold),
        position=sign * duct.middles[order],
        width=width[order],
        height=0.5 * (1 + layer_centres(duct.layers)),
        temperature=oil[order],
        surface_temperatures=surfaces[:, order],
        sliding_stress=-sign * stress[order],
        heat_made=(made / width)[order],
        heat_into=(into / width)[:, order],
        shear_force=sign * couette + film.rolling_force,
        sliding_force=sign * couette,
        friction_power=power,
        power_into=(float(into[0].sum()), float(into[1].sum())),
        power_carried=taken,
        energy_imbalance=imbalance,
        residual=found.residual,
        surface_residual=missed,
        rounds=found.rounds,
        iterations=found.steps,
        status=Status.CONVERGED if right else Status.STALLED,
        notes=notes if right else (*notes, _not_followed(lubricant)),
    )


def _not_followed(lubricant: Lubricant) -> Note:
    """Return the note on a film that was not found, with a remedy for a pressure spike without limit."""
    incompressible = lubricant.density_law.name == "incompressible"
    blunter = 'Take density_law = "dowson_higginson": it blunts the pressure spike, whose heat has no limit.'
    return HEAT_NOT_FOUND(remedy=blunter if incompressible else "", reason="full")
