"""Frictional heating of the rough contact, and boundary friction at the temperature of the contact.

Friction of the contact and of the oil between its cells heats both bodies: moving half-spaces with the temperature of
the arriving oil far away (`bem.heat`). Oil sheared by the sliding makes the heat tau_m abs(u1 - u2) an area, tau_m the
shear stress in the middle of the film: a pressure gradient adds to the stress on one wall and takes from that on the
other. The heat of the flow that the pressure gradient drives is left out. Oil is sheared on the fraction of a cell that
does not touch, as in the film's friction. A body at rest under a cylinder is cool at
the distance of the cylinder's radius. A law of boundary friction over temperature takes the mean temperature of the
contact, weighted by pressure. That mean depends on the coefficient in turn. Temperatures are linear in the coefficient:
two heat conductions, one bracketed root in the coefficient and a third conduction close the loop. The distribution of
the shear stress over the cells is that at the oil's temperature. Of repeated cells under a cylinder the heat is the
mean at each place, so that flashes of single asperities are left out. Other laws take one conduction and no root. A law
that rises with temperature may have no such coefficient: the heat runs away. Verified in
tests/friction/test_hot_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.errors import Status
from bem.friction.boundary import BoundaryFriction, filled_part
from bem.friction.film import PatchFilm
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray, Grid
from bem.heat.bodies import conductors_of
from bem.heat.solution import TemperatureSolution
from bem.heat.steady import surface_temperature
from bem.lubrication.thermal.model import FilmHeat
from bem.notes import Note
from bem.notes.friction import REPEATED_PATCH
from bem.notes.lubrication import HEAT_NOT_FOUND

TOLERANCE = 1e-6
"""Relative error: temperature difference of both surfaces over their rise, and coefficient of friction."""
LARGEST_COEFFICIENT = 1e3
"""Largest coefficient of friction that is tried."""
LEAST_CELL_PRESSURE = 1e-3
"""Mean pressure of repeated cells over its maximum from which a place counts as in contact."""
_HALF = 0.5


@dataclass(frozen=True)
class ContactHeat:
    """Temperatures of the surfaces in contact.

    Temperatures are not-a-number and the status is stalled where the shear stress of the oil is not known, or where no
    coefficient reproduces itself. Law and coefficient are then those at the oil's temperature; of heat that runs away
    the coefficient is not-a-number.

    mean, maximum : over the cells in contact [K], the mean weighted by pressure. temperature : (nx, ny) [K]. law : of
    boundary friction at the mean temperature. coefficient : of this law. status : of the first heat conduction that is
    not converged. notes : of the last one.
    """

    mean: float
    maximum: float
    temperature: FloatArray
    law: BoundaryFriction
    coefficient: float
    status: Status
    notes: tuple[Note, ...] = ()


def contact_heat(film: PatchFilm, contact: Pressed, setup: MixedSetup, speeds: tuple[float, float]) -> ContactHeat:
    """Return the temperatures of a contact with a load, between surfaces sliding at a pair of speeds (u1, u2) [m/s]."""
    heat, law, slide = setup.smooth.heat, setup.boundary_law, abs(speeds[0] - speeds[1])
    assert heat is not None
    bulk = float(setup.lubricant.temperature or 0.0)
    moving = speeds if setup.radius is None else _moving(heat, setup.radius, speeds)
    pressure, touching = contact.pressure, contact.pressure > 0
    grid, cells = setup.film_grid, contact.cells
    of_oil = np.abs(_middle_stress(film, grid)) * slide * (1 - contact.touching_fraction)
    if cells is None:
        filled = filled_part(pressure, contact.area / setup.slices, grid)
    else:
        touching = pressure > LEAST_CELL_PRESSURE * pressure.max()

    def coefficient_of(law: BoundaryFriction) -> float:
        if cells is not None:
            return cells.mean_coefficient(law, pressure, slide)
        return law.mean_coefficient(pressure, filled, slide)

    cold = coefficient_of(law)
    # boundary shear stress over the coefficient; of repeated cells the mean pressure
    if law.constant is not None or cold == 0 or cells is not None:
        shape = pressure
    else:
        shape = law.cell_stress(pressure, filled, slide) / cold

    def solve_heat(coefficient: float) -> TemperatureSolution:
        made = of_oil + coefficient * slide * shape
        return surface_temperature(made, grid, heat.bodies, speeds=moving, bulk=(bulk, bulk), tolerance=TOLERANCE)

    def mean(found: TemperatureSolution) -> float:
        return float((found.temperature * pressure).sum() / pressure.sum())

    unknown = np.full(pressure.shape, math.nan)
    if not np.isfinite(of_oil).all():  # a film whose heat was not found has no shear stress; its notes say so
        return ContactHeat(math.nan, math.nan, unknown, law, cold, Status.STALLED)
    found = solve_heat(cold)
    coefficient, status = cold, found.status
    if law.needs_temperature:
        cooler = solve_heat(_HALF * cold)
        at, less = mean(found), mean(cooler)
        slope = (at - less) / (cold - _HALF * cold) if cold > 0 else 0.0

        def law_at(value: float) -> BoundaryFriction:
            return law.at_temperature(at + slope * (value - cold))

        def excess(value: float) -> float:
            return coefficient_of(law_at(value)) - value

        consistent = _consistent_coefficient(excess, cold)
        if consistent is None:
            runaway = (HEAT_NOT_FOUND(reason="boundary"),)
            return ContactHeat(math.nan, math.nan, unknown, law, math.nan, Status.STALLED, runaway)
        coefficient, law = consistent, law_at(consistent)
        found = solve_heat(coefficient)
        statuses = (status, cooler.status, found.status)
        status = next((one for one in statuses if one is not Status.CONVERGED), Status.CONVERGED)
    return ContactHeat(
        mean=mean(found),
        maximum=float(found.temperature[touching].max()),
        temperature=found.temperature,
        law=law,
        coefficient=coefficient,
        status=status,
        notes=found.notes if cells is None else (*found.notes, REPEATED_PATCH(reason="flash")),
    )


def _middle_stress(film: PatchFilm, grid: Grid) -> FloatArray:
    """Return the shear stress in the middle of the film [Pa], (nx, ny) or (nx, 1).

    That of the film model. Where it gives none, the stress on the flat less its part h/2 dp/dx, with the pressure
    gradient on the patch.
    """
    if film.sliding_stress is not None:
        return film.sliding_stress
    if grid.shape[0] == 1:
        return film.shear_stress
    gradient = np.gradient(film.pressure, grid.x, axis=0)
    return np.where(film.pressure > 0, film.shear_stress - 0.5 * film.thickness * gradient, 0.0 * film.shear_stress)


def _consistent_coefficient(excess: Callable[[float], float], near: float) -> float | None:
    """Return the coefficient of friction that reproduces itself through the temperature; None if none is found.

    Temperature rises with the coefficient, so a law that falls with temperature has exactly one such coefficient. A law
    that rises may have none, or several, of which one next to the coefficient at the oil's temperature is returned.
    """
    from scipy.optimize import brentq  # a sixth of a second, for laws that temperature changes

    high = max(near, 1e-12)
    while excess(high) > 0:
        high *= 2
        if high > LARGEST_COEFFICIENT:
            return None
    return float(brentq(excess, 0.0, high, xtol=TOLERANCE * max(near, 1e-12)))


def _moving(heat: FilmHeat, radius: float, speeds: tuple[float, float]) -> tuple[float, float]:
    """Return the speeds [m/s]; a body at rest moves just so fast that it is cool at the distance of the radius."""
    bodies = conductors_of("thermal", heat.bodies, speeds, (0.0, 0.0))
    least = [2 * body.diffusivity / radius for body in bodies]
    first, second = (
        speed if abs(speed) > slow else math.copysign(slow, speed or sum(speeds))
        for speed, slow in zip(speeds, least, strict=True)
    )
    return first, second
