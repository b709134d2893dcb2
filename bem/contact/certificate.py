"""Certificate of a contact, recomputed from the returned pressure and approach.

Step 12 of `bem.contact`. The displacement is the operator applied to that pressure, computed again unless the solver's
displacement is that already; load or mean gap, bounds and complementarity follow from the three. The approach is the
solver's. The residual is the larger of the largest violation over the rms gap (over the displacement where the gap is
flat) and the relative error of a prescribed load. The status "converged" refers to this residual and the user's
tolerance, not to what the solver reached inside. "max_iterations" is the limit of CG iterations only: the limit of
outer iterations ends as "stalled".
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.contact import reductions
from bem.contact.contact_area import Region, contact_region, plastic_region
from bem.contact.grid_workspace import GridResult, is_flat
from bem.contact.peak_pressure import highest_pressure
from bem.contact.problem import Request, Units
from bem.contact.regions import narrow_share
from bem.contact.solution import ContactSolution
from bem.convolution import DisplacementOperator
from bem.errors import Status
from bem.grid import Grid
from bem.notes import Note
from bem.notes.contact import CONTACT_AT_EDGE, CONTACT_UNRESOLVED, MEAN_GAP_NOT_MET
from bem.quantities import si

FloatArray = NDArray[np.float64]

CERTIFICATE_MARGIN = 0.9
"""Fraction of the tolerance that a solver aims at, so that rounding cannot spoil the certificate."""
_ROUND_OFF = 1e-15
"""Round-off of an approach by the change of units, relative to the lengths that it is a sum of."""


def displacement_scale(request: Request) -> float:
    """Return the scale of the displacement under the mean prescribed pressure [m]; zero unless a load is prescribed.

    It is the mean pressure times the largest value of the operator's spectrum, rounded to a power of two: an order of
    magnitude. On a doubly periodic grid a uniform pressure displaces nothing, but displacements are rounded on this
    scale.
    """
    return 0.0 if request.load is None else request.load / request.operator.grid.area * request.operator.unit


def certify(
    request: Request,
    units: Units,
    rms_gap: float,
    result: GridResult,
    *,
    status_if_unmet: Status,
    iterations: int,
    convolutions_before: float,
) -> ContactSolution:
    """Recompute the residual from the pressure and the solver's approach, and convert everything to SI units.

    status_if_unmet : status if the residual exceeds the tolerance.
    """
    operator, grid = request.operator, request.operator.grid
    pressure = result.pressure.reshape(grid.shape)
    displacement = result.displacement.reshape(grid.shape)
    if not result.exact_displacement:
        operator.scaled().apply(pressure, displacement)
    approach = _approach(request, units, result)
    deformed = np.empty(grid.shape)
    depth = np.zeros(grid.shape)
    largest, largest_displacement, force, _, capped, volume = reductions.assemble(
        (pressure.reshape(-1), displacement.reshape(-1), request.gap.reshape(-1)),
        (units.pressure, units.length),
        approach,
        request.cap,
        (deformed.reshape(-1), depth.reshape(-1)),
    )
    load = force * grid.cell_area
    load_error = 0.0
    if request.mean_gap is not None:
        largest = max(largest, abs(volume / grid.cells - request.mean_gap))
        largest_displacement = max(largest_displacement, request.mean_gap)
    elif request.approach is not None:
        largest = max(largest, abs(approach - request.approach))
    elif request.load is not None:
        load_error = _relative(abs(load - request.load), request.load)
    contact, plastic, doubt = regions_of(
        operator,
        request.gap,
        pressure,
        deformed,
        load=load,
        cap=request.cap,
        modulus=operator.modulus_at(area_wavenumber(grid)),
        capped=capped > 0,
    )
    largest_displacement = max(largest_displacement, displacement_scale(request))
    reference = largest_displacement if is_flat(rms_gap, largest_displacement) else rms_gap
    residual = max(_relative(largest, reference), load_error)
    status = Status.CONVERGED if residual <= request.tolerance else status_if_unmet
    return ContactSolution(
        pressure=pressure,
        displacement=displacement,
        gap=deformed,
        approach=approach,
        load=load,
        contact_area=contact.area,
        plastic_area=min(plastic.area, contact.area),  # equal up to round-off where all cells are at the cap
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


def _approach(request: Request, units: Units, result: GridResult) -> float:
    """Return the approach in SI units; exactly the prescribed one where they differ by the change of units only."""
    approach = result.approach * units.length + units.datum
    asked = request.approach
    if asked is not None and abs(approach - asked) <= _ROUND_OFF * (abs(asked) + abs(units.datum)):
        return asked
    return approach


_SHORT, _MANY = 0.98, 1.1
"""Fractions of load / cap: if the area with elastic edges is below the first and the area of cells above the second,
spots are one or two cells wide and the area is uncertain by more than a tenth."""


def area_wavenumber(grid: Grid) -> float:
    """Return the wavenumber of four cells [rad/m], at which the law of the contact's edge takes the modulus."""
    return 0.5 * math.pi / math.sqrt(grid.cell_area)


def regions_of(
    operator: DisplacementOperator,
    undeformed: FloatArray,
    pressure: FloatArray,
    deformed: FloatArray,
    *,
    load: float,
    cap: float,
    modulus: float,
    capped: bool,
) -> tuple[Region, Region, tuple[Note, ...]]:
    """Return the contact, its part at the cap, and a note where the cells do not determine the area.

    undeformed, pressure, deformed : (nx, ny) gap [m], pressure [Pa] and deformed gap [m]. load [N], cap [Pa].
    modulus : E* at the wavenumber of four cells [Pa]. capped : True if a cell is at the cap.
    """
    grid = operator.grid
    contact = contact_region(pressure, deformed, undeformed, grid, modulus, cap=cap, compliance=operator.compliance)
    least = load / cap  # the pressure is nowhere above the cap
    doubt: tuple[Note, ...] = ()
    if contact.elastic_edge_area < _SHORT * least and contact.counted_area > _MANY * least:
        doubt = (unresolved_spots(pressure > 0, contact.counted_area / least, grid.periodic),)
    if not capped:
        return contact, Region(0.0, 0.0, 0.0, 0.0, 0.0), doubt
    plastic = plastic_region(pressure, deformed, undeformed, cap, grid, modulus)
    # cells at the cap carry no more than the load
    return contact, plastic.of_area(min(plastic.area, least)), doubt


def unresolved_spots(touching: NDArray[np.bool_], times: float, periodic: tuple[bool, bool], of: str = "") -> Note:
    """Return the note on an area of contact that the cells do not determine.

    It calls the spots one or two cells wide where those are most of the area, else the edges unresolved.

    touching : (nx, ny), cells in contact. times : their area over the load over the hardness. of : which contact.
    """
    narrow = narrow_share(touching, periodic)
    counted = 100 * float(touching.mean())
    return CONTACT_UNRESOLVED(
        times=times,
        of=of,
        narrow=narrow,
        least=counted / times,
        counted=counted,
        reason="spots" if narrow > _MOSTLY else "edges",
    )


_MOSTLY = 0.5
"""Share of the contact area in spots of one or two cells above which these, and not the edges, are said to decide."""


def _relative(error: float, reference: float) -> float:
    if error == 0:
        return 0.0
    return error / reference if reference > 0 else math.inf


def free_edges_reached(periodic: tuple[bool, bool], pressure: FloatArray) -> tuple[int, ...]:
    """Return the free axes (0: x, 1: y) at whose ends cells carry pressure (nx, ny); axes of one cell do not count."""
    free = [axis for axis in range(2) if not periodic[axis] and pressure.shape[axis] > 1]
    return tuple(axis for axis in free if (np.take(pressure, (0, -1), axis) > 0).any())


def _notes(grid: Grid, pressure: FloatArray) -> tuple[Note, ...]:
    """Return a note if the contact reaches a free edge of the grid."""
    reached = " and ".join("xy"[axis] for axis in free_edges_reached(grid.periodic, pressure))
    if not reached:
        return ()
    return (CONTACT_AT_EDGE(axes=reached, reason="pressed"),)


def _why(request: Request, units: Units, result: GridResult, status: Status, opening: float) -> tuple[Note, ...]:
    """Return a note if the prescribed mean gap was not found; `opening` is the mean gap of this contact [m]."""
    if request.mean_gap is None:
        return ()
    if result.least_mean_gap is not None:
        return (
            MEAN_GAP_NOT_MET(asked=request.mean_gap, least=result.least_mean_gap * units.length, reason="impossible"),
        )
    if result.least_found is None and status is not Status.STALLED:
        return ()
    least = None if result.least_found is None else result.least_found * units.length
    has = si(opening, "m") if least is None else f"the least that was found, {si(least, 'm')}"
    return (MEAN_GAP_NOT_MET(asked=request.mean_gap, found=has, reason="not-found"),)
