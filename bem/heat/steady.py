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
from bem.heat.partition import TOLERANCE, BodyPair, solve_partition
from bem.heat.solution import TemperatureSolution, build_solution
from bem.materials import Body


def surface_temperature(
    heat: ArrayLike,
    grid: Grid,
    bodies: Body | Sequence[Body],
    *,
    speeds: float | Sequence[float],
    bulk: float | Sequence[float] = (0.0, 0.0),
    tolerance: float = TOLERANCE,
) -> TemperatureSolution:
    """Compute the steady surface temperature under a heat source: Jaeger's moving source for any map of the heat.

    The bodies are half-spaces, bare or under layers. A single body takes all heat. Two bodies share the heat of each
    cell so that both surfaces are equally hot where heat is generated; elsewhere they exchange none.

    Parameters
    ----------
    heat : generated flux (nx, ny) [W/m^2], such as friction x pressure x sliding speed.
    grid : free along x; along y free or periodic.
    bodies : one Body or a pair, whose materials have `thermal_conductivity`, `density` and `heat_capacity`.
    speeds : of each body along +x relative to the heat source [m/s]; negative along -x.
    bulk : temperature of each body far below the surface [K]; with zeros the result is the rise.
    tolerance : bound on the difference of the two surfaces where heat is generated, over the largest rise.

    Returns
    -------
    TemperatureSolution : temperature, partition, maximum, status, ...

    Raises
    ------
    InputError : an argument that cannot be used; a material without thermal constants; layers that act much further
        than the grid is wide; a grid on which no steady temperature exists (periodic along x, or along y under a body
        at rest): the heat in it would warm the body for ever.

    Notes
    -----
    Carslaw and Jaeger, Conduction of Heat in Solids (1959), sections 10.2 and 10.7; J. C. Jaeger, Proc. R. Soc. NSW 76
    (1942) 203.
    """
    conductors = conductors_of("surface_temperature", bodies, speeds, bulk, layered=True)
    field = grid.check_field(heat, "surface_temperature: heat")
    check_steady(grid, conductors)
    if not 0 < tolerance < 1:
        raise InputError(f"surface_temperature: tolerance {tolerance!r} must lie between 0 and 1, both excluded")
    if len(conductors) == 1:
        (body,) = conductors
        surface = body.bulk + heat_operator(grid, body)(field)
        return build_solution(field, field[None], surface[None], conductors, 1, 0.0, Status.CONVERGED)
    first = heat_operator(grid, conductors[0])
    alike = _response(conductors[0]) == _response(conductors[1])
    pair = BodyPair(
        conductors,
        (first, first if alike else heat_operator(grid, conductors[1])),
        approximate_inverse(grid, conductors),
    )
    background = [np.full(grid.shape, body.bulk) for body in conductors]
    return solve_partition(field, pair, background, None, tolerance)


def _response(body: Conductor) -> tuple[object, ...]:
    """Return the properties that determine a body's operator: conductivity, Peclet number per length, layers."""
    return body.conductivity, body.peclet_per_length, body.layers, body.speed if body.layers else 0.0


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
    """Compute the flash temperature: `surface_temperature` under the heat |friction (u1 - u2)| x pressure.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], of a contact solution.
    grid, bulk, tolerance : as of `surface_temperature`.
    bodies : a pair, or one Body under a counterface that takes no heat.
    friction : coefficient, one number or (nx, ny).
    speeds : (first, second) of both surfaces along x relative to the contact [m/s]; of one Body its own, then that of
        the counterface.

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
