"""Solve a dry contact: check the arguments, scale, solve from coarse to fine grids, and certify the result.

Step 1 of `bem.contact`, and the calls of steps 2, 3, 4 and 12.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from bem.contact import reductions
from bem.contact.active_set import Report
from bem.contact.certificate import CERTIFICATE_MARGIN, certify, displacement_scale
from bem.contact.controls import Control
from bem.contact.grid_workspace import GridResult, IterationBudget, is_flat
from bem.contact.nested_iteration import start_from_coarser
from bem.contact.problem import GridProblem, Settings, Units, checked_request
from bem.contact.solution import ContactSolution
from bem.contact.solve_on_grid import Start, pressed_flat, solve_on_grid, without_contact
from bem.convolution import DisplacementOperator
from bem.errors import Status
from bem.materials import Body
from bem.notes import Note
from bem.plausibility import body_arguments, notes_on_arguments
from bem.threads import one_blas_thread

FloatArray = NDArray[np.float64]
Callback = Callable[[int, float, float], object]


@one_blas_thread
def solve_contact(
    gap: FloatArray,
    operator: DisplacementOperator,
    *,
    load: float | None = None,
    approach: float | None = None,
    mean_gap: float | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-8,
    initial_pressure: FloatArray | None = None,
    max_iterations: int = 5000,
    callback: Callback | None = None,
) -> ContactSolution:
    """Solve for the pressure between two bodies that may not overlap, elastic or capped at a hardness.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap of the two surfaces [m]; a constant added to it counts
        against a prescribed approach; under a load or a mean gap it moves the returned approach alone.
    operator : from `displacement_operator`.
    load, approach, mean_gap : exactly one of total load [N], approach [m] and the mean over the grid of the positive
        part of the deformed gap [m]. On a doubly periodic grid displacements are mean-free: `approach` is by how
        much the means of the undeformed surfaces come closer than `gap` says.
    hardness : cap on the pressure [Pa]; None for purely elastic.
    tolerance : bound on the residual, see `ContactSolution`.
    initial_pressure : (nx, ny), warm start [Pa]; coarser grids are then skipped.
    max_iterations : limit of CG iterations on all grids.
    callback : called with iterations, an approximate residual and the fraction of cells in contact for each pressure
        that is judged on the finest grid: the first one and those of fallbacks included.

    Notes
    -----
    An elastic contact on a free axis may have no solution for a `mean_gap`, or several: a layer much stiffer than its
    base bends and stands off somewhere, however hard it is pressed, and the mean gap then grows with the load. Where
    another load has the same mean gap, `notes` says so; the solver starts without contact and usually returns the
    solution of the smallest load. Where no solution is proved to exist the status is "infeasible", and `notes` has a
    lower bound on the mean gap.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond the
        mean of the gap.
    """
    request = checked_request(
        gap,
        operator,
        {"load": load, "approach": approach, "mean_gap": mean_gap},
        hardness=hardness,
        tolerance=tolerance,
        initial_pressure=initial_pressure,
        max_iterations=max_iterations,
    )
    convolutions_before = operator.count.weighted
    datum, mean, rms_gap = (float(value) for value in reductions.moments(request.gap.reshape(-1)))
    request.refuse_infeasible(mean, CERTIFICATE_MARGIN * tolerance * rms_gap)
    units = Units.of(request, rms_gap, datum)
    scaled_rms_gap = rms_gap / units.length
    inner_tolerance = CERTIFICATE_MARGIN * tolerance * (scaled_rms_gap or 1.0)
    settings = Settings(inner_tolerance, scaled_rms_gap, IterationBudget(max_iterations))
    problem = GridProblem(
        settings,
        operator,
        _scaled(request.gap.reshape(-1), units),
        request.cap / units.pressure,
        _report(callback, settings, displacement_scale(request) / units.length, operator),
    )
    start = None if initial_pressure is None else np.asarray(initial_pressure, np.float64).reshape(-1) / units.pressure
    flat = is_flat(rms_gap, displacement_scale(request))
    result = _solve_scaled(problem, units.control(request), start, flat=flat)
    solution = certify(
        request,
        units,
        rms_gap,
        result,
        status_if_unmet=_unmet_status(result, settings.budget),
        iterations=settings.budget.iterations,
        convolutions_before=convolutions_before,
    )
    notes = _notes_on_arguments(operator, load, hardness)
    if mean_gap is not None and solution.status is Status.CONVERGED:
        from bem.contact.mean_gap_multiplicity import note_on_several_answers  # other controls have one answer

        several = note_on_several_answers(request.gap, operator, solution, mean_gap, hardness, solve_contact)
        return replace(solution, notes=notes + solution.notes + several) if notes + several else solution
    return replace(solution, notes=notes + solution.notes) if notes else solution


def _notes_on_arguments(operator: DisplacementOperator, load: float | None, hardness: float | None) -> tuple[Note, ...]:
    """Return notes on arguments of `solve_contact` outside their usual ranges."""
    own = notes_on_arguments({"load": ("load", load), "hardness": ("hardness", hardness)})
    grid = operator.grid
    return own + _notes_on_operator(operator.bodies, tuple(grid.spacing[axis] for axis in grid.varying_axes))


@lru_cache(maxsize=64)
def _notes_on_operator(bodies: tuple[Body, ...], spacing: tuple[float, ...]) -> tuple[Note, ...]:
    """Return notes on the bodies and the cell size [m] of an operator, cached for loops over contacts."""
    return notes_on_arguments({"grid.spacing": ("cell of the grid", spacing)} | body_arguments(bodies))


def _scaled(gap: FloatArray, units: Units) -> FloatArray:
    """Return the gap (one-dimensional) in the solver's units, lowest value zero; not copied where the units are one."""
    if units.datum == 0.0 and units.length == 1.0:
        return gap
    scaled = np.empty(gap.size)
    reductions.rescale(gap, units.datum, 1 / units.length, scaled)
    return scaled


def _solve_scaled(problem: GridProblem, control: Control, start: FloatArray | None, *, flat: bool) -> GridResult:
    """Solve in the solver's units, from an initial pressure or from coarser grids.

    flat : True if the gap is flat compared with the scale of the displacement under the mean pressure.
    """
    known = without_contact(control, problem.gap)
    known = known or pressed_flat(problem.operator, problem.gap, control, problem.cap, flat=flat)
    if known is not None:
        return known
    if start is None:
        begin = start_from_coarser(problem, control)
    else:
        begin = Start(np.clip(start, 0.0, problem.cap, out=start), -math.inf)
    return solve_on_grid(problem, control, begin, problem.settings.tolerance)


def _unmet_status(result: GridResult, budget: IterationBudget) -> Status:
    """Return the status of a result that does not pass the certificate."""
    if result.least_mean_gap is not None:
        return Status.INFEASIBLE
    return Status.MAX_ITERATIONS if budget.left <= 0 else Status.STALLED


def _report(
    callback: Callback | None, settings: Settings, scale: float, operator: DisplacementOperator
) -> Report | None:
    """Return the user's callback with the arguments of an outer iteration.

    The residual approximates that of the certificate: the largest displacement is that of the cells between the bounds
    only, and the relative error of the load is left out.

    scale : scale of the displacement under the prescribed mean pressure, in the solver's length.
    """
    if callback is None:
        return None

    def report(iterations: int, violation: float, displacement: float, cells: int) -> None:
        displacement = max(displacement, scale)
        reference = displacement if is_flat(settings.rms_gap, displacement) else settings.rms_gap
        callback(iterations, violation / reference if reference > 0 else violation, cells / operator.grid.cells)

    return report
