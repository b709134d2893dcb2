"""What a contact is judged by: the pressure that is returned, and nothing else that the solver believes.

The displacement is the operator applied to that pressure; load, approach or mean gap, bounds and complementarity are
formed anew from both. `converged` is said of that.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes
from bem.contact.edge import Region, contact_region, plastic_region
from bem.contact.level import LevelResult, is_flat
from bem.contact.peak import highest_pressure
from bem.contact.request import Request, Units
from bem.contact.solution import ContactSolution
from bem.errors import Status
from bem.grid import Grid

FloatArray = NDArray[np.float64]

_ROUND_OFF = 1e-15
"""Of the sum of lengths that an approach is made of: what units and datum leave of one that was asked for. Bodies that
are flat and do not touch have no other length that it could be held against."""


def elastic_length(request: Request) -> float:
    """By how much a cell gives way under the mean pressure asked for [m]; zero where no load is. On a doubly periodic
    grid an even pressure displaces nothing, and yet displacements are rounded as if by this."""
    return 0.0 if request.load is None else request.load / request.operator.grid.area * request.operator.unit


def certify(
    request: Request,
    units: Units,
    roughness: float,
    result: LevelResult,
    *,
    unmet: Status,
    iterations: int,
    convolutions_before: float,
) -> ContactSolution:
    """Judge the pressure by itself, and put everything in SI units; `unmet` is the status if it does not pass."""
    operator, grid = request.operator, request.operator.grid
    pressure = result.pressure.reshape(grid.shape)
    displacement = result.displacement.reshape(grid.shape)
    if not result.fresh:
        operator.scaled().apply(pressure, displacement)
    approach = _approach(request, units, result)
    deformed = np.empty(grid.shape)
    depth = np.zeros(grid.shape)
    largest, reach, force, _, capped, volume = passes.assemble(
        (pressure.reshape(-1), displacement.reshape(-1), request.gap.reshape(-1)),
        (units.pressure, units.length),
        approach,
        request.cap,
        (deformed.reshape(-1), depth.reshape(-1)),
    )
    load = force * grid.cell_area
    missed = 0.0
    if request.mean_gap is not None:
        largest = max(largest, abs(volume / grid.cells - request.mean_gap))
        reach = max(reach, request.mean_gap)
    elif request.approach is not None:
        largest = max(largest, abs(approach - request.approach))
    elif request.load is not None:
        missed = _relative(abs(load - request.load), request.load)
    contact, plastic, doubt = _regions(request, pressure, deformed, load, capped=capped > 0)
    reach = max(reach, elastic_length(request))
    residual = max(_relative(largest, reach if is_flat(roughness, reach) else roughness), missed)
    status = Status.CONVERGED if residual <= request.tolerance else unmet
    return ContactSolution(
        pressure=pressure,
        displacement=displacement,
        gap=deformed,
        approach=approach,
        load=load,
        contact_area=contact.area,
        plastic_area=min(plastic.area, contact.area),  # both are sums of all cells where all are at the cap
        counted_area=contact.counted_area,
        counted_plastic_area=plastic.counted_area,
        contact_perimeter=contact.perimeter,
        maximum_pressure=highest_pressure(pressure, grid, request.cap),
        plastic_depth=depth,
        iterations=iterations,
        convolutions=operator.count.weighted - convolutions_before,
        residual=residual,
        status=status,
        notes=_notes(grid, pressure) + doubt + _why(request, units, result, status, volume / grid.cells),
    )


def _approach(request: Request, units: Units, result: LevelResult) -> float:
    """In SI units; the one asked for where only these are between."""
    approach = result.approach * units.length + units.datum
    asked = request.approach
    if asked is not None and abs(approach - asked) <= _ROUND_OFF * (abs(asked) + abs(units.datum)):
        return asked
    return approach


_SHORT, _MANY = 0.98, 1.1
"""Of load / cap: where the area by elastic edges is less and the cells in contact are more, spots are a cell or two
wide and the area is not known to a tenth."""


def _regions(
    request: Request, pressure: FloatArray, deformed: FloatArray, load: float, *, capped: bool
) -> tuple[Region, Region, tuple[str, ...]]:
    """Return the contact, the part of it that is at the cap, and a sentence where the cells do not tell the area.

    capped : whether a cell is at the cap."""
    operator, grid, cap = request.operator, request.operator.grid, request.cap
    modulus = operator.modulus_at(0.5 * math.pi / math.sqrt(grid.cell_area))
    contact = contact_region(pressure, deformed, request.gap, grid, modulus, cap=cap, compliance=operator.compliance)
    least = load / cap  # the pressure is nowhere above the cap
    doubt: tuple[str, ...] = ()
    if contact.elastic_edge_area < _SHORT * least and contact.counted_area > _MANY * least:
        doubt = (
            "spots of contact are too small for these cells: the contact area lies between the least that carries the "
            f"load at the hardness and the cells in contact, {contact.counted_area / least:.2f} times as many; take a "
            "finer grid",
        )
    if not capped:
        return contact, Region(0.0, 0.0, 0.0, 0.0, 0.0), doubt
    plastic = plastic_region(pressure, deformed, request.gap, cap, grid, modulus)
    # the rest carries the remaining load
    return contact, plastic.of_area(min(plastic.area, least)), doubt


def _relative(error: float, reference: float) -> float:
    if error == 0:
        return 0.0
    return error / reference if reference > 0 else math.inf


def free_edges_reached(periodic: tuple[bool, bool], pressure: FloatArray) -> tuple[int, ...]:
    """Return the free axes (0: x, 1: y) at whose ends cells carry pressure (nx, ny); axes of one cell do not count."""
    free = [axis for axis in range(2) if not periodic[axis] and pressure.shape[axis] > 1]
    return tuple(axis for axis in free if (np.take(pressure, (0, -1), axis) > 0).any())


def _notes(grid: Grid, pressure: FloatArray) -> tuple[str, ...]:
    """What a user should know of a contact whatever its status."""
    reached = " and ".join("xy"[axis] for axis in free_edges_reached(grid.periodic, pressure))
    if not reached:
        return ()
    return (
        f"the contact reaches the edge of the grid along {reached}, where the bodies end for this solver: "
        f"if they do not, make the grid longer or periodic along {reached}",
    )


def _why(request: Request, units: Units, result: LevelResult, status: Status, opening: float) -> tuple[str, ...]:
    """What there is to say of a mean gap that was not found; `opening` is the one of this contact."""
    if request.mean_gap is None:
        return ()
    if result.least_mean_gap is not None:
        return (
            f"no approach gives a mean gap of {request.mean_gap:.4g} m: the bodies cannot be pressed flat, and "
            f"{result.least_mean_gap * units.length:.4g} m is a lower bound on every mean gap",
        )
    if result.least_found is None and status is not Status.STALLED:
        return ()
    least = None if result.least_found is None else result.least_found * units.length
    has = f"{opening:.4g} m" if least is None else f"the least that was found, {least:.4g} m"
    return (
        f"a mean gap of {request.mean_gap:.4g} m was not found, nor proved not to exist: this contact has {has}. Ask "
        "for more, or give a load",
    )
