"""Full heat of a line film: energy and Reynolds' equation along and across the film, coupled.

The temperature along and across the film follows from conduction, convection, compression and dissipation (`field`,
`heat_source`), that of the surfaces from the heat that enters them. Viscosity and density at those temperatures change
the flow (`layers`), and with it pressure and thickness; where the film follows its shear law, it acts in every layer
(`layered_shear`). `coupling` iterates until both hold. Nothing is fitted. Conductivity and heat capacity of the oil are
those without pressure at the temperature of the supply; the model ends at the exit. Verified in
tests/lubrication/test_full_thermal.py and test_layers_sheared.py.
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
from bem.lubrication.thermal.coupling import Coupling, HotNeighbour, ThermalIterate, solve_coupled
from bem.lubrication.thermal.field import LEAST_RISE, heat_carried
from bem.lubrication.thermal.layers import HeatedOil, expansion_of
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import HEAT_NOT_FOUND, OIL_DATA_SHORT
from bem.representation import readable
from bem.threads import one_blas_thread

COLUMNS = 160
"""Columns along the film, at most."""
LAYERS = 16
"""Layers across the film."""
ENERGY_TOLERANCE = 1e-6
"""Largest relative friction power that is missing in bodies and oil, and largest deviation of the surfaces from the
temperatures of their heat, over the largest rise."""


@readable
@dataclass(frozen=True)
class FullThermalFilm(HeatedFilm):
    """A film with full heat: temperatures in columns along and layers across it.

    `sliding_stress` is (n,) at the positions of the film. `heat_made` includes the heat of compression.

    Attributes
    ----------
    height : (K,) centres of the layers over the film's thickness, from the flat (0) to the cylinder (1).
    temperature : (m, K) of the oil [K].
    residual : of Reynolds' equation at these temperatures, relative to the film.
    surface_residual : deviation of the surfaces from the temperatures of the heat into them, over the largest rise.
    rounds : number of temperature fields solved.
    """

    height: FloatArray
    temperature: FloatArray
    residual: float
    surface_residual: float
    rounds: int

    @property
    def film_temperature(self) -> FloatArray:
        """Mean temperature across the film (m,) [K]."""
        return np.asarray(self.temperature.mean(axis=1))

    @property
    def highest_oil_temperature(self) -> float:
        """Highest temperature of the oil [K]."""
        return float(self.temperature.max())

    @property
    def stress_at_nodes(self) -> FloatArray:
        """`sliding_stress` (n,) [Pa]."""
        return self.sliding_stress

    def as_film(self) -> FilmSolution:
        """Return the film with its friction and temperatures, as `solve_line_film` does."""
        return replace(super().as_film(), residual=self.residual)


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
    """Solve the steady film between a cylinder and a flat with full heat: temperatures along and across it.

    Parameters
    ----------
    load, radius, contact_modulus, speeds, lubricant, bodies, bulk : as of `solve_thermal_line_film`.
    points, initial, tolerance, max_iterations, flow_factors : as of `solve_line_film`.
    columns, layers : of the temperatures along and across the film, at most.

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
    """Solve as `solve_full_thermal_line_film`."""
    for name, value, most in (("columns", columns, 2000), ("layers", layers, 200)):
        if not (isinstance(value, int) and 6 <= value <= most):
            raise InputError(f"solve_full_thermal_line_film: {name} {value!r} must be an integer from 6 to {most}")
    units = case.scaled()
    lubricant, tolerance = case.lubricant, case.tolerance
    name = "solve_full_thermal_line_film"
    conductors = moving_bodies(name, lubricant, bodies, case.speeds, bulk, case.radius)
    initial_state = None if case.initial is None else case.initial.state
    heat = initial_state.heat if isinstance(initial_state, FilmState) else None
    cold = line_film(case if heat is None else replace(case, initial=heat.isothermal))
    cold_state = cold.state
    assert isinstance(cold_state, FilmState)
    first, second = float(case.speeds[0]), float(case.speeds[1])
    coupling = Coupling(
        problem=case.problem(cold_state.scales),
        oil=HeatedOil.of(lubricant),
        bodies=conductors,
        slide=(second - first) / (first + second),
        unit=cold_state.scales.pressure,
        film_of=lambda outcome: build_solution(outcome, outcome, case, units),
        columns=columns,
        layers=layers,
        tolerance=tolerance,
        limit=case.max_iterations,
    )
    start = Outcome(cold_state.state, cold.iterations, cold.residual, cold.status is Status.CONVERGED)
    near = None
    if heat is not None and isinstance(initial_state, FilmState):
        near = HotNeighbour(initial_state.neighbour(cold_state.scales), heat)
    found = solve_coupled(coupling, start, near)
    if found.met(tolerance):
        film = found.film
        assert isinstance(film.state, FilmState)
        film = replace(film, state=replace(film.state, heat=found.state_for(without_factors(cold), columns)))
        found = replace(found, film=film)
    thermal = _result(found, cold, tolerance, cold_state.reversed)
    stress = found.source.cross_film_flow(found.field.oil).newtonian_stress
    notes = notes_of_film(
        found.film,
        lubricant,
        case.radius,
        case.contact_modulus,
        stress,
        thermal.mean_film_temperature,
        found=start.converged,
    )
    notes += notes_on_factors(case.flow_factors, found.film.minimum_thickness)
    return replace(thermal, notes=notes + thermal.notes)


def _result(found: ThermalIterate, cold: FilmSolution, tolerance: float, reversed_: bool) -> FullThermalFilm:
    """Return the result, all figures recomputed from film and temperatures, with signs along +x, and NaN where it did
    not converge."""
    film, film_columns, geometry, field = found.film, found.film_columns, found.geometry, found.field
    lubricant, oil, width = film.lubricant, found.field.oil, found.geometry.width
    sources = found.source(oil)
    stress = found.source.cross_film_flow(oil).middle_stress
    couette = found.source.sliding_force(stress)
    into = geometry.wall_heat(field.rise)
    surfaces = field.temperature[:, [0, -1]].T
    rise = max(float(np.ptp(field.rise)), LEAST_RISE)
    surface_residual = float(np.abs(geometry.surface_temperatures(into) - surfaces).max()) / rise
    carried_out = heat_carried(geometry, sources.flux, field.rise[:, 1:-1])
    power = film_columns.sliding * couette + sum(film.speeds) * film.rolling_force
    imbalance = abs(power - float(into.sum()) - carried_out) / max(abs(power), 1e-300)
    converged = max(imbalance, surface_residual) <= ENERGY_TOLERANCE and found.residual <= tolerance
    order = slice(None, None, -1) if reversed_ else slice(None)
    sign = -1.0 if reversed_ else 1.0
    # temperatures that did not converge may be arbitrary: they and all that follows from them are NaN
    mask = 1.0 if converged else math.nan
    made = mask * sources.heat.sum(axis=1)
    oil, surfaces, stress, into = mask * oil, mask * surfaces, mask * stress, mask * into
    couette, carried_out, power = mask * couette, mask * carried_out, mask * power
    notes = notes_of_heat(lubricant, mask * float(field.temperature.max()))
    if expansion_of(lubricant) is None:
        notes += (OIL_DATA_SHORT(reason="expansion"),)
    return FullThermalFilm(
        film=without_factors(film),
        isothermal=without_factors(cold),
        position=sign * geometry.centres[order],
        width=width[order],
        height=0.5 * (1 + layer_centres(geometry.layers)),
        temperature=oil[order],
        surface_temperatures=surfaces[:, order],
        sliding_stress=-sign * stress[order],
        heat_made=(made / width)[order],
        heat_into=(into / width)[:, order],
        shear_force=sign * couette + film.rolling_force,
        sliding_force=sign * couette,
        friction_power=power,
        power_into=(float(into[0].sum()), float(into[1].sum())),
        power_carried=carried_out,
        energy_imbalance=imbalance,
        residual=found.residual,
        surface_residual=surface_residual,
        rounds=found.rounds,
        iterations=found.steps,
        status=Status.CONVERGED if converged else Status.STALLED,
        notes=notes if converged else (*notes, _not_followed(lubricant)),
    )


def _not_followed(lubricant: Lubricant) -> Note:
    """Return the note on a film that was not found, with a remedy for a pressure spike without limit."""
    incompressible = lubricant.density_law.name == "incompressible"
    blunter = 'Take density_law = "dowson_higginson": it blunts the pressure spike, whose heat has no limit.'
    return HEAT_NOT_FOUND(remedy=blunter if incompressible else "", reason="full")
