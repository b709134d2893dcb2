"""Frictionless contact on a curved surface by constrained conjugate gradients (Polonsky and Keer 1999).

The upper body approaches along a fixed direction by `approach`, a row's gap closes by its component along the row's
normal, c = cos(angle to the direction):

    gap + displacement - c approach = 0 where p > 0,   >= 0 where p = 0,   load = area x sum of c p.

In q = c p and with displacement and gap over c this is a contact problem with one approach: the operator stays
symmetric, and the algorithm is that of flat surfaces. The residual is recomputed from the pressure that is returned.
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
_TIGHTER = 0.3
"""Tolerance of the iteration over that of the residual, which is recomputed."""


@dataclass(frozen=True)
class CurvedContact:
    """A contact on a curved surface.

    Attributes
    ----------
    contact : as of a flat surface: pressure along the normals, gap and displacement (nx, ny); `load` and `approach` are
        those along the direction.
    lateral_force : resultant of the pressures on the lower body to the right of the direction, in the tangent plane
        across it [N].
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
    """Solve the contact.

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
    direction = surface.direction(angle)
    if direction.min() < math.cos(STEEPEST_ROW):
        raise InputError(
            "curved contact: the surface turns by more than "
            f"{math.degrees(STEEPEST_ROW):.0f} degrees from the direction of the load; allowed: a narrower grid"
        )
    scaled_gap, area = gap / direction, surface.grid.cell_area
    force = _start(scaled_gap, load, approach, surface) if start is None else start * direction
    if start is not None and load is not None:
        force *= load / (area * float(force.sum()))
    goal = _TIGHTER * tolerance * (float(np.std(gap)) or 1.0)
    search, old_square, restart = np.zeros_like(gap), 1.0, True
    status, iterations = Status.MAX_ITERATIONS, max_iterations
    closing = 0.0 if approach is None else approach
    for iteration in range(1, max_iterations + 1):
        touching = force > 0
        slack = surface(force / direction) / direction + scaled_gap
        if load is not None:
            closing = float(slack[touching].mean())
        slack -= closing
        overlap = float(-np.minimum(np.where(touching, 0.0, slack), 0.0).min())
        if max(float(np.abs(slack[touching]).max(initial=0.0)), overlap) <= goal:
            status, iterations = Status.CONVERGED, iteration
            break
        residual = np.where(touching, slack, 0.0)
        square = float((residual * residual).sum())
        search = np.where(touching, residual + (0.0 if restart else square / old_square) * search, 0.0)
        old_square = square
        change = surface(search / direction) / direction
        if load is not None and touching.any():
            change -= float(change[touching].mean())
        bend = float((search * change)[touching].sum())
        step = float((residual * search).sum()) / bend if bend > 0 else 1 / surface.diagonal
        trial = force - step * search
        force = np.maximum(trial, 0.0)
        joining = ~touching & (slack < 0)
        force = np.where(joining, -step * slack, force)
        restart = bool(joining.any() or (trial < 0).any())
        if load is not None:
            force *= load / (area * float(force.sum()))
    return certified_contact(
        gap, surface, angle, force / direction, closing, load, tolerance=tolerance, iterations=iterations, status=status
    )


def _start(scaled_gap: FloatArray, load: float | None, approach: float | None, surface: CurvedSurface) -> FloatArray:
    """Return pressures to start from: as a bed of springs that carries the load, or at the approach."""
    stiffness = 0.05 / surface.diagonal
    if approach is not None:
        return stiffness * np.maximum(approach - scaled_gap, 0.0)
    assert load is not None
    wanted = load / (surface.grid.cell_area * stiffness)
    values = np.sort(scaled_gap.ravel())
    # sum of (level - gap) over the lowest n gaps
    below = np.arange(1, len(values) + 1) * values - np.cumsum(values)
    count = max(int(np.searchsorted(below, wanted)), 1)
    level = (wanted + float(values[:count].sum())) / count
    return stiffness * np.maximum(level - scaled_gap, 0.0)


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
    approach : [m].
    load : prescribed [N], or None.
    iterations, status : of the iteration.
    """
    direction, prescribed, closing = surface.direction(angle), load, approach
    grid = surface.grid
    displacement = surface(pressure)
    touching = pressure > 0
    if prescribed is not None:  # the last approach of the iteration is of the pressure before its last step
        closing = float(((gap + displacement) / direction)[touching].mean())
    deformed = gap + displacement - closing * direction
    violation = max(
        float(np.abs(deformed[touching]).max(initial=0.0)),
        float(-np.minimum(deformed[~touching], 0.0).min(initial=0.0)),
    )
    load = float((pressure * direction).sum()) * grid.cell_area
    residual = violation / (float(np.std(gap)) or 1.0)
    if prescribed is not None:
        residual = max(residual, abs(load / prescribed - 1))
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
        approach=closing,
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
