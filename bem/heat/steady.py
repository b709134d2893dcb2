"""Steady surface temperature of a heat source at rest over one or two moving half-spaces."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import InputError, Status
from bem.grid import Grid
from bem.heat.bodies import Conductor, check_steady, conductors_of
from bem.heat.operators import approximate_inverse, heat_operator
from bem.heat.partition import Pair, TemperatureSolution, solve_partition, temperature_solution
from bem.materials import Body

TOLERANCE = 1e-8
"""Default bound on the difference of the two surfaces, over the largest rise."""


def surface_temperature(
    heat: ArrayLike,
    grid: Grid,
    bodies: Body | Sequence[Body],
    *,
    speeds: float | Sequence[float],
    bulk: float | Sequence[float] = (0.0, 0.0),
    tolerance: float = TOLERANCE,
) -> TemperatureSolution:
    """Surface temperature of heat made in a contact: Jaeger's moving source for any map, speed and pair of materials.

    Steady, on bare half-spaces. Of one body all heat enters it; of a pair the heat of every cell is shared so that both
    surfaces are equally hot where it is made; elsewhere they exchange none.

    Parameters
    ----------
    heat : flux made (nx, ny) [W/m^2], such as friction x pressure x sliding speed.
    grid : free along x; along y free or periodic.
    bodies : one Body or a pair, whose materials have `thermal_conductivity`, `density` and `heat_capacity`.
    speeds : over the contact [m/s], along +x (negative: along -x), one a body.
    bulk : temperature far below the surface [K], one a body; with zeros the result is the rise.
    tolerance : largest difference of the two surfaces where heat is made, over the largest rise.

    Returns
    -------
    TemperatureSolution : temperature, partition, maximum, status, ...

    Raises
    ------
    InputError : an argument that cannot be used; a body with layers; a grid on which no steady temperature exists
        (periodic along x, or along y under a body at rest): the heat in it would warm the body for ever.

    Carslaw and Jaeger, Conduction of Heat in Solids (1959), sections 10.2 and 10.7; J. C. Jaeger, Proc. R. Soc. NSW 76
    (1942) 203.
    """
    conductors = conductors_of("surface_temperature", bodies, speeds, bulk)
    field = grid.check_field(heat, "surface_temperature: heat")
    check_steady(grid, conductors)
    if not 0 < tolerance < 1:
        raise InputError(f"surface_temperature: tolerance {tolerance!r} must lie between 0 and 1, both excluded")
    if len(conductors) == 1:
        (body,) = conductors
        surface = body.bulk + heat_operator(grid, body)(field)
        return temperature_solution(field, field[None], surface[None], conductors, 1, 0.0, Status.CONVERGED)
    first = heat_operator(grid, conductors[0])
    alike = _response(conductors[0]) == _response(conductors[1])
    pair = Pair(
        conductors,
        (first, first if alike else heat_operator(grid, conductors[1])),
        approximate_inverse(grid, conductors),
    )
    before = [np.full(grid.shape, body.bulk) for body in conductors]
    return solve_partition(field, pair, before, None, tolerance)


def _response(body: Conductor) -> tuple[float, float]:
    """Return the properties that determine a body's operator: conductivity and wavenumber."""
    return body.conductivity, body.wavenumber


def flash_temperature(
    pressure: ArrayLike,
    grid: Grid,
    bodies: Body | Sequence[Body],
    *,
    friction: ArrayLike,
    speeds: Sequence[float],
    bulk: float | Sequence[float] = (0.0, 0.0),
    tolerance: float = TOLERANCE,
) -> TemperatureSolution:
    """Surface temperature of a rubbing contact: `surface_temperature` of the heat |friction (u1 - u2)| x pressure.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], of a contact solution.
    grid, bulk, tolerance : as of `surface_temperature`.
    bodies : a pair, or one Body whose counterface takes no heat.
    friction : coefficient, one number or (nx, ny).
    speeds : of both surfaces over the contact [m/s], along x; of one Body its own first, then its counterface's.

    Raises
    ------
    InputError : as `surface_temperature`, not two speeds, or a friction that is not finite or of another shape.
    """
    if not isinstance(speeds, Sequence) or len(speeds) != 2 or not all(isinstance(u, Real) for u in speeds):
        raise InputError(f"flash_temperature: speeds {speeds!r} must be a pair [m/s]: heat needs the sliding speed")
    coefficient = np.asarray(friction)
    if coefficient.shape not in ((), grid.shape) or coefficient.dtype.kind not in "fiu":
        raise InputError(f"flash_temperature: friction must be a number or of the grid's shape {grid.shape}")
    pressures = grid.check_field(pressure, "flash_temperature: pressure")
    heat = np.abs(coefficient * (speeds[0] - speeds[1])) * pressures
    own = speeds[0] if isinstance(bodies, Body) else speeds
    return surface_temperature(heat, grid, bodies, speeds=own, bulk=bulk, tolerance=tolerance)
