"""Frictionless contact on a curved surface by constrained conjugate gradients (Polonsky and Keer 1999).

The upper body moves by the approach along a fixed direction. The gap of a row is measured along the row's normal, and
closes by the component of the approach along it, c approach with c the cosine of the angle between both:

    gap + displacement - c approach = 0 where p > 0,   >= 0 where p = 0,   load = area x sum of c p.

In the projected pressure q = c p, and with displacement and gap over c, this is a contact problem with one approach:
the operator stays symmetric, and the algorithm is that of flat surfaces. The residual gap of the iteration is (gap +
displacement)/c - approach. The residual of the result is computed anew from the pressure that is returned.
Verified in tests/profiles/test_curved_contact.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.contact.certificate import free_edges_reached
from bem.contact.contact_area import contact_region
from bem.contact.peak_pressure import highest_pressure
from bem.contact.solution import ContactSolution
from bem.errors import InfeasibleError, InputError, Status
from bem.grid import FloatArray
from bem.notes import Note
from bem.notes.contact import CONTACT_AT_EDGE
from bem.profiles.curved_surface import CurvedSurface

STEEPEST_ROW = math.radians(80)
"""Largest angle between a row's normal and the direction of approach: the component along it is 0.17."""
ITERATION_TOLERANCE = 0.3
"""Tolerance of the iteration over that of the residual. The residual is computed anew, with the approach of the last
pressure and not of the one before, and may be larger than what the iteration ended with."""
SPRING_STIFFNESS = 0.05
"""Stiffness of the springs that give the first pressure, over that of a cell loaded alone: cells around it yield, too.
It affects cost and rounding only."""


@dataclass(frozen=True)
class CurvedContact:
    """A contact on a curved surface.

    Attributes
    ----------
    contact : as of a flat surface: pressure, gap and displacement along the rows' normals, (nx, ny); `load` and
        `approach` are those along the direction of approach.
    lateral_force : resultant of the pressures on the lower body, to the right in the plane normal to that direction
        [N].
    """

    contact: ContactSolution
    lateral_force: float


def solve_curved_contact(
    gap: FloatArray,
    surface: CurvedSurface,
    angle: float,
    *,
    load: float | None = None,
    approach: float | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 2000,
    start: FloatArray | None = None,
) -> CurvedContact:
    """Solve for the pressure between two bodies on a curved surface, frictionless and elastic.

    Parameters
    ----------
    gap : undeformed gap along the rows' normals (nx, ny) [m].
    surface : the curved surface.
    angle : of the normal along which the bodies approach [rad].
    load : along that normal [N]; or
    approach : along it [m].
    tolerance : of the largest violation over the standard deviation of the undeformed gap.
    max_iterations : of the conjugate gradients.
    start : pressure to start from (nx, ny) [Pa]; affects cost and rounding only.

    Raises
    ------
    InputError : not one of load and approach, values that are not finite, a gap of another shape than the grid, or rows
        too steep for the direction.
    InfeasibleError : a load that is not positive.
    """
    if (load is None) == (approach is None):
        raise InputError(f"curved contact: give exactly one of load ({load!r}) and approach ({approach!r})")
    if load is not None and not load > 0:
        raise InfeasibleError(f"curved contact: load {load!r} N must be positive")
    if not math.isfinite(load if load is not None else approach or 0.0):
        raise InputError(f"curved contact: load {load!r} N, approach {approach!r} m; allowed: a finite number")
    if np.shape(gap) != surface.grid.shape or not np.isfinite(gap).all():
        raise InputError(
            f"curved contact: gap of shape {np.shape(gap)}; allowed: finite numbers of shape {surface.grid.shape}"
        )
    cosines = surface.cosines(angle)
    if cosines.min() < math.cos(STEEPEST_ROW):
        raise InputError(
            "curved contact: the surface turns by more than "
            f"{math.degrees(STEEPEST_ROW):.0f} degrees from the direction of the load; allowed: a narrower grid"
        )
    scaled_gap, area = gap / cosines, surface.grid.cell_area
    if start is None:
        projected_pressure = _initial_projected_pressure(scaled_gap, load, approach, surface)
    else:
        projected_pressure = start * cosines
        if load is not None:
            projected_pressure *= load / (area * float(projected_pressure.sum()))
    goal = ITERATION_TOLERANCE * tolerance * (float(np.std(gap)) or 1.0)
    search_direction, last_square, restart = np.zeros_like(gap), 1.0, True
    status, iterations = Status.MAX_ITERATIONS, max_iterations
    trial_approach = 0.0 if approach is None else approach
    for iteration in range(1, max_iterations + 1):
        touching = projected_pressure > 0
        residual_gap = surface(projected_pressure / cosines) / cosines + scaled_gap
        if load is not None:
            trial_approach = float(residual_gap[touching].mean())
        residual_gap -= trial_approach
        penetration = float(-np.minimum(np.where(touching, 0.0, residual_gap), 0.0).min())
        if max(float(np.abs(residual_gap[touching]).max(initial=0.0)), penetration) <= goal:
            status, iterations = Status.CONVERGED, iteration
            break
        residual = np.where(touching, residual_gap, 0.0)
        square = float((residual * residual).sum())
        search_direction = np.where(
            touching, residual + (0.0 if restart else square / last_square) * search_direction, 0.0
        )
        last_square = square
        response = surface(search_direction / cosines) / cosines
        if load is not None and touching.any():
            response -= float(response[touching].mean())
        curvature = float((search_direction * response)[touching].sum())
        step = float((residual * search_direction).sum()) / curvature if curvature > 0 else 1 / surface.diagonal
        trial = projected_pressure - step * search_direction
        projected_pressure = np.maximum(trial, 0.0)
        penetrating = ~touching & (residual_gap < 0)
        projected_pressure = np.where(penetrating, -step * residual_gap, projected_pressure)
        restart = bool(penetrating.any() or (trial < 0).any())
        if load is not None:
            projected_pressure *= load / (area * float(projected_pressure.sum()))
    return certified_contact(
        gap,
        surface,
        angle,
        projected_pressure / cosines,
        trial_approach,
        load,
        tolerance=tolerance,
        iterations=iterations,
        status=status,
    )


def _initial_projected_pressure(
    scaled_gap: FloatArray, load: float | None, approach: float | None, surface: CurvedSurface
) -> FloatArray:
    """Return q = c p of a bed of independent springs that carries the load, or that is pressed to the approach.

    scaled_gap : gap along the direction of approach, (nx, ny) [m].
    """
    stiffness = SPRING_STIFFNESS / surface.diagonal
    if approach is not None:
        return stiffness * np.maximum(approach - scaled_gap, 0.0)
    assert load is not None
    compression_sum = load / (surface.grid.cell_area * stiffness)
    gaps = np.sort(scaled_gap.ravel())
    # sums of (gap of cell n - gap) over the lower n gaps: compressions where the bed reaches cell n
    sums_at_gaps = np.arange(1, len(gaps) + 1) * gaps - np.cumsum(gaps)
    pressed = max(int(np.searchsorted(sums_at_gaps, compression_sum)), 1)
    bed_approach = (compression_sum + float(gaps[:pressed].sum())) / pressed
    return stiffness * np.maximum(bed_approach - scaled_gap, 0.0)


def certified_contact(
    gap: FloatArray,
    surface: CurvedSurface,
    angle: float,
    pressure: FloatArray,
    approach: float,
    load: float | None,
    *,
    tolerance: float,
    iterations: int,
    status: Status,
) -> CurvedContact:
    """Return the solution with the residual recomputed from its pressure.

    Parameters
    ----------
    gap, surface, angle, tolerance : as for `solve_curved_contact`.
    pressure : (nx, ny) [Pa].
    approach : of the iteration [m]; under a prescribed load it is computed anew.
    load : prescribed [N], or None where the approach is.
    iterations, status : of the iteration.
    """
    grid, cosines, prescribed_load = surface.grid, surface.cosines(angle), load
    displacement = surface(pressure)
    touching = pressure > 0
    if prescribed_load is not None:  # the last approach of the iteration is of the pressure before its last step
        approach = float(((gap + displacement) / cosines)[touching].mean())
    deformed = gap + displacement - approach * cosines
    violation = max(
        float(np.abs(deformed[touching]).max(initial=0.0)),
        float(-np.minimum(deformed[~touching], 0.0).min(initial=0.0)),
    )
    load = float((pressure * cosines).sum()) * grid.cell_area
    residual = violation / (float(np.std(gap)) or 1.0)
    if prescribed_load is not None:
        residual = max(residual, abs(load / prescribed_load - 1))
    if residual <= tolerance:
        status = Status.CONVERGED
    elif status is Status.CONVERGED:
        status = Status.STALLED
    deformed[~touching] = np.maximum(deformed[~touching], 0.0)
    region = contact_region(pressure, deformed, gap, grid, surface.modulus)
    reached = " and ".join("xy"[axis] for axis in free_edges_reached(grid.periodic, pressure))
    notes: tuple[Note, ...] = (CONTACT_AT_EDGE(axes=reached, reason="pressed"),) if reached else ()
    contact = ContactSolution(
        pressure=pressure,
        displacement=displacement,
        gap=deformed,
        approach=approach,
        load=load,
        contact_area=region.area,
        plastic_area=0.0,
        counted_area=region.counted_area,
        counted_plastic_area=0.0,
        contact_perimeter=region.perimeter,
        maximum_pressure=highest_pressure(pressure, grid),
        plastic_depth=np.zeros_like(gap),
        iterations=iterations,
        convolutions=float(surface.applications[0]),
        residual=residual,
        status=status,
        notes=notes,
    )
    # the pressure pushes the lower body along minus its normal (sin a, -cos a)
    across = -np.sin(surface.angles - angle)
    return CurvedContact(contact, float((pressure * across).sum()) * grid.cell_area)
