"""Lumped heat of a point film: the oil thinned by inlet heating, and temperatures along lines of cells.

As of line contacts (`lumped`), line by line: on each line of cells along x heat goes across the film into two moving
half-spaces, as of bands that reach far along y, or is carried by the oil (`lumped_energy`). Flow and conduction between
the lines are left out; a note says so of conduction where it matters (`LARGEST_SPREAD`). A body that hardly moves is
cool at the half-axis across. Sources are sliding at the stress of the hot oil, and the Poiseuille flow,
h^3/(12 mu) |grad p|^2 with mu of the thinned oil that makes the film. A long ellipse is the line contact. Verified in
tests/lubrication/test_thermal_point.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.line_contact import band_temperatures
from bem.lubrication.checks import friction_limited
from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.thermal.bodies import moving_bodies
from bem.lubrication.thermal.checks import LARGEST_RISE, heat_limits, notes_of_heat
from bem.lubrication.thermal.hot_viscosity import HotViscosity
from bem.lubrication.thermal.inlet_thinning import FACTOR_TOLERANCE, find_thinning, thinned_oil
from bem.lubrication.thermal.lumped_energy import Channel, film_temperatures
from bem.materials import Body
from bem.notes import without
from bem.notes.friction import POINT_FILM_SCALED
from bem.notes.lubrication import HEAT_LEFT_OUT, HEAT_NOT_FOUND, LUMPED_HEAT_LIMIT, SHEAR_LIMITED
from bem.threads import one_blas_thread

MOST_THINNED_FILMS = 6
"""Largest number of thinned films."""
LEAST_PRESSURE = 1e-3
"""Pressure over its maximum, above which a line of cells gets temperatures."""
_WARMER = 1e-3
"""Step [K] of the derivative of stresses with temperature."""
RESIDUAL = 1e-6
"""Largest residual of temperatures."""
LARGEST_SPREAD = 0.5
"""Spread of heat in a body while it crosses the contact, over the half-axis across, up to which the surfaces are within
10 % of those with conduction across; 5 % too warm at 0.3, 22 % at 0.76 (balls), 42 % at 1.2."""


@dataclass(frozen=True)
class PointHeat:
    """Heat of a film on its cells.

    temperature : (nx, ny) mean across the film [K].
    surfaces, fluxes : (2, nx, ny) of flat and ball [K], and into them [W/m^2].
    stress : (nx, ny) in the middle of the film [Pa], along the slide of the ball over the flat.
    power, into, carried : generated, (2,) into both bodies, carried out by the oil [W], of lines with temperatures.
    residual : of the temperatures, largest of all lines.
    """

    temperature: FloatArray
    surfaces: FloatArray
    fluxes: FloatArray
    stress: FloatArray
    power: float
    into: tuple[float, float]
    carried: float
    residual: float


@dataclass(frozen=True)
class OilThinning:
    """Dependence of the central film on the viscosity, down to the film that inlet heating leaves.

    exponent : films go with this power of the viscosity.
    deviation : of the thinned film from the wanted film, relative; infinite where there was no film.
    """

    exponent: float
    deviation: float

    def between(self, other: OilThinning, weight: float) -> OilThinning:
        """Return (1 - weight) of this exponent and weight of another; the larger deviation of both."""
        exponent = (1 - weight) * self.exponent + weight * other.exponent
        return OilThinning(exponent, max(self.deviation, other.deviation))

    def oil(self, lubricant: Lubricant, inlet: InletHeating) -> Lubricant:
        """Return the oil whose film is thinned by the factor of inlet heating."""
        return thinned_oil(lubricant, inlet.factor ** (1 / self.exponent))


def find_oil_thinning(
    lubricant: Lubricant, inlet: InletHeating, central: Callable[[Lubricant], float], exponent: float
) -> OilThinning:
    """Find how films depend on the viscosity, from the central films of ever thinner oils.

    central : returns the central film of an oil [m], NaN where there is none. exponent : of films in the viscosity, to
    begin with; it is enough where the inlet thins the film by less than the tolerance, and no film is solved.
    """
    wanted = math.log(inlet.factor)
    if abs(wanted) <= FACTOR_TOLERANCE:
        return OilThinning(exponent, abs(math.expm1(wanted)))
    cold = central(lubricant)

    def log_film(log_viscosity: float) -> float:
        return math.log(central(thinned_oil(lubricant, math.exp(log_viscosity))) / cold)

    found = find_thinning(log_film, wanted, exponent, MOST_THINNED_FILMS, FACTOR_TOLERANCE)
    return OilThinning(wanted / found.log_viscosity if found.log_viscosity else exponent, found.deviation)


def add_heat(
    film: PointFilmSolution,
    lubricant: Lubricant,
    bodies: Sequence[Body],
    half_axes: tuple[float, float],
    inlet: InletHeating,
    deviation: float,
) -> PointFilmSolution:
    """Return a film of the thinned oil with its temperatures, and stresses and forces of the unthinned oil at these.

    Pressure and thickness stay.

    film : with speeds along x. half_axes : of the contact, along and across the flow [m]. deviation : of the film from
        the factor of inlet heating, relative.
    """
    first, second = film.speeds[0][0], film.speeds[1][0]
    conductors = moving_bodies("thermal", lubricant, bodies, (first, second), None, half_axes[1])
    heat = point_heat(film, lubricant, conductors)
    middle = np.zeros((2, *film.pressure.shape))
    middle[0] = heat.stress
    weights = film.pressure / film.pressure.sum()
    mean = float((weights * heat.temperature).sum())
    scaled = any(note.code == POINT_FILM_SCALED.code for note in film.notes)  # its thinnest places are not known
    hottest = max(mean if scaled else float(heat.temperature.max()), float(heat.surfaces.max()))
    rise = mean - float(lubricant.temperature or 0.0)
    right = heat.residual <= RESIDUAL and deviation <= FACTOR_TOLERANCE
    status = film.status if film.status is not Status.CONVERGED or right else Status.STALLED
    known = 1.0 if status is Status.CONVERGED else math.nan  # as of a line
    notes = without(film.notes, HEAT_LEFT_OUT)
    if status is Status.CONVERGED:
        # the limiting stress is that at the temperature of the film
        warm = friction_limited(lubricant, mean)
        notes = tuple(warm if note.code == SHEAR_LIMITED.code else note for note in notes)
    made = replace(
        film,
        middle_stress=known * middle,
        temperature=known * heat.temperature,
        mean_temperature=known * mean,
        maximum_temperature=known * float(heat.temperature.max()),
        status=status,
        notes=(
            *notes,
            *heat_limits(inlet, (first, second), rise, "Take film and friction as estimates."),
            *(
                (LUMPED_HEAT_LIMIT(reason="spreads"),)
                if rise > LARGEST_RISE and _spread(conductors, half_axes) > LARGEST_SPREAD
                else ()
            ),
            *notes_of_heat(lubricant, known * hottest),
            *(() if status is Status.CONVERGED else (HEAT_NOT_FOUND(reason="lumped"),)),
        ),
    )
    forces, rolling = made.forces()
    return replace(made, shear_force=forces, rolling_force=rolling)


def _spread(bodies: tuple[Conductor, Conductor], half_axes: tuple[float, float]) -> float:
    """Return the spread of heat in the bodies while they cross the contact, over the half-axis across; 0 of bodies
    taken as cool there."""
    along, across = half_axes
    moving = [body for body in bodies if abs(body.peclet_per_length) * across > 1 + 1e-9]
    return max((math.sqrt(along / abs(body.peclet_per_length)) / across for body in moving), default=0.0)


@one_blas_thread  # systems of a few hundred unknowns, one for each line of cells
def point_heat(film: PointFilmSolution, lubricant: Lubricant, bodies: tuple[Conductor, Conductor]) -> PointHeat:
    """Solve for the temperatures on lines of cells along x."""
    reverse = film.speeds[0][0] + film.speeds[1][0] < 0
    steps = slice(None, None, -1 if reverse else 1)
    x = -film.x[::-1] if reverse else film.x
    pressure, thickness = film.pressure[steps], film.thickness[steps]
    gradient = np.gradient(pressure, x, film.y)
    poiseuille_heat = (
        thickness**3 / (12 * film.lubricant.viscosity_at(pressure)) * (gradient[0] ** 2 + gradient[1] ** 2)
    )
    poiseuille_heat = np.where(pressure > 0, poiseuille_heat, 0.0)
    density = film.lubricant.density_ratio(pressure)[0]
    slide, mean = film.speeds[1][0] - film.speeds[0][0], 0.5 * abs(film.speeds[0][0] + film.speeds[1][0])
    viscosity, supply = HotViscosity.of(lubricant), float(lubricant.temperature or 0.0)
    capacity = (lubricant.density or 0.0) * (lubricant.heat_capacity or 0.0)
    width = float(x[1] - x[0])
    edges = np.append(x, x[-1] + width) - 0.5 * width
    kernels = [band_temperatures(edges, body) for body in bodies]
    temperature, surfaces = np.full(pressure.shape, supply), np.full((2, *pressure.shape), supply)
    stress, fluxes = np.zeros(pressure.shape), np.zeros(surfaces.shape)
    into, carried, power, residual = np.zeros(2), 0.0, 0.0, 0.0

    def stresses(j: int, at: FloatArray) -> FloatArray:
        newtonian = viscosity(pressure[:, j], at)[0] * abs(slide) / thickness[:, j]
        return np.where(pressure[:, j] > 0, lubricant.shear_stress(newtonian, pressure[:, j], at), 0.0)

    highest = pressure.max(axis=0)
    for j in range(pressure.shape[1]):
        if highest[j] <= LEAST_PRESSURE * highest.max():
            stress[:, j] = stresses(j, temperature[:, j])
            continue
        top = int(pressure[:, j].argmax())
        flow = mean * float(thickness[top, j] * density[top, j])

        def heat(at: FloatArray, j: int = j) -> tuple[FloatArray, FloatArray]:
            value, slope = stresses(j, at), np.zeros((3, at.size))
            slope[1] = abs(slide) * (stresses(j, at + _WARMER) - value) / _WARMER
            return abs(slide) * value + poiseuille_heat[:, j], slope

        channel = Channel(
            edges, thickness[:, j], lubricant.thermal_conductivity or 0.0, capacity * flow, supply, bodies
        )
        found = film_temperatures(channel, heat, kernels)
        temperature[:, j], surfaces[:, :, j], stress[:, j] = found.oil, found.surfaces, stresses(j, found.oil)
        fluxes[:, :, j] = found.into
        into += found.into.sum(axis=1) * width
        carried += channel.capacity_flow * float(found.oil[-1] - supply)
        power += float(found.heat.sum()) * width
        residual = max(residual, found.residual)
    line = float(film.y[1] - film.y[0])
    return PointHeat(
        temperature=temperature[steps],
        surfaces=surfaces[:, steps],
        fluxes=fluxes[:, steps],
        stress=math.copysign(1.0, slide) * stress[steps],
        power=power * line,
        into=(float(into[0]) * line, float(into[1]) * line),
        carried=carried * line,
        residual=residual,
    )
