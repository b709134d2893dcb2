"""The front door of dry contact: checks, units, coarse to fine, certificate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from bem.contact import cascade, passes
from bem.contact.certificate import certify, elastic_length
from bem.contact.controls import ApproachControl, Control, LoadControl
from bem.contact.feasible import below
from bem.contact.level import Effort, LevelResult, is_flat
from bem.contact.one_grid import (
    COARSE_TOLERANCE,
    OF_FIRST,
    Problem,
    Report,
    Shared,
    Start,
    pressed_flat,
    solve_on_grid,
    without_contact,
)
from bem.contact.request import Units, checked_request
from bem.contact.several_answers import note_on_several_answers
from bem.contact.solution import ContactSolution
from bem.convolution import DisplacementOperator
from bem.errors import Status
from bem.materials import Body
from bem.plausibility import body_arguments, notes_on_arguments
from bem.threads import one_blas_thread

FloatArray = NDArray[np.float64]
Callback = Callable[[int, float, float], object]

_TIGHTER = 0.9
"""Share of the tolerance that the solver aims at, so that rounding in SI units cannot spoil the certificate."""

_COARSEST = 32
"""Cells along the longer side of a coarser grid up to which it is solved on without another: one of 16 takes as long as
one of 32, and saves that no round (six rough contacts of 256 cells in 0.965 of the processor time without, and 10.69
convolutions for 10.70; begun at 64 cells they take 10.93)."""


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
    """Pressure between two bodies that may not overlap, elastic or capped at a hardness.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap of the two surfaces [m]; its constant matters only when `approach` is given.
    operator : from `displacement_operator`.
    load, approach, mean_gap : exactly one of total load [N], approach [m] and the mean over the grid of the positive
        part of the deformed gap [m]. On a doubly periodic grid displacements are mean-free: `approach` is by how
        much the means of the undeformed surfaces come closer than `gap` says.
    hardness : cap on the pressure [Pa]; None for purely elastic.
    tolerance : bound on the residual, see `ContactSolution`.
    initial_pressure : (nx, ny), a start near the solution; the coarser grids are then skipped.
    max_iterations : limit on iterations of conjugate gradients over all grids.
    callback : called with iterations, residual and fraction of cells in contact after each round on the grid itself.

    Notes
    -----
    An elastic contact on a free axis may have no answer for a `mean_gap`, or several: a layer much stiffer than its
    base bends and stands off somewhere, however hard it is pressed, and the mean gap then grows with the load. Where a
    larger or smaller load is found to have the same mean gap, `notes` says so; the search begins without contact and
    returns, as a rule, the answer of the smallest load. Where it is proved that there is none the status is
    "infeasible", and `notes` has a bound on the mean gaps there are.

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
    before = operator.count.weighted
    datum, mean, roughness = (float(value) for value in passes.moments(request.gap.reshape(-1)))
    request.refuse_infeasible(mean, _TIGHTER * tolerance * roughness)
    units = Units.of(request, roughness, datum)
    rough = roughness / units.length
    shared = Shared(_TIGHTER * tolerance * rough if rough > 0 else tolerance, rough, Effort(max_iterations))
    problem = Problem(
        shared,
        operator,
        _scaled(request.gap.reshape(-1), units),
        request.cap / units.pressure,
        _report(callback, shared, operator),
    )
    start = None if initial_pressure is None else np.asarray(initial_pressure, np.float64).reshape(-1) / units.pressure
    flat = is_flat(roughness, elastic_length(request))
    result = _solution(problem, units.control(request), start, flat=flat)
    solution = certify(
        request,
        units,
        roughness,
        result,
        unmet=_unmet(result, shared.effort),
        iterations=shared.effort.iterations,
        convolutions_before=before,
    )
    said = _notes_on_arguments(operator, load, hardness)
    if mean_gap is not None and solution.status is Status.CONVERGED:
        several = note_on_several_answers(request.gap, operator, solution, mean_gap, hardness)
        return replace(solution, notes=said + solution.notes + several) if said + several else solution
    return replace(solution, notes=said + solution.notes) if said else solution


def _notes_on_arguments(operator: DisplacementOperator, load: float | None, hardness: float | None) -> tuple[str, ...]:
    """Notes on arguments of `solve_contact` outside their usual ranges."""
    own = notes_on_arguments({"load": ("load", load), "hardness": ("hardness", hardness)})
    return own + _notes_on_operator(operator.bodies, operator.grid.spacing)


@lru_cache(maxsize=64)
def _notes_on_operator(bodies: tuple[Body, ...], spacing: tuple[float, float]) -> tuple[str, ...]:
    """Notes on bodies and cells [m] of an operator; contacts of a loop share them."""
    return notes_on_arguments({"grid.spacing": ("cell of the grid", spacing)} | body_arguments(bodies))


def _scaled(gap: FloatArray, units: Units) -> FloatArray:
    """The gap (flat) in the solver's units, lowest at zero: not copied where those are its own."""
    if units.datum == 0.0 and units.length == 1.0:
        return gap
    scaled = np.empty(gap.size)
    passes.rescale(gap, units.datum, 1 / units.length, scaled)
    return scaled


def _solution(problem: Problem, control: Control, start: FloatArray | None, *, flat: bool) -> LevelResult:
    """In the solver's units, from a pressure or from coarser grids; nothing is solved where that is not needed.

    flat : whether the gap is flat beside what the load does to a cell."""
    known = without_contact(control, problem.gap)
    known = known or pressed_flat(problem.operator, problem.gap, control, problem.cap, flat=flat)
    if known is not None:
        return known
    if start is None:
        begin = _from_coarser(problem, control)
    else:
        begin = Start(np.clip(start, 0.0, problem.cap, out=start), -math.inf)  # nobody else has it
    return solve_on_grid(problem, control, begin, problem.shared.tolerance)


def _unmet(result: LevelResult, effort: Effort) -> Status:
    """The status of a result that does not pass the certificate."""
    if result.least_mean_gap is not None:
        return Status.INFEASIBLE
    return Status.MAX_ITERATIONS if effort.left <= 0 else Status.STALLED


def _report(callback: Callback | None, shared: Shared, operator: DisplacementOperator) -> Report | None:
    """The user's callback as the rounds call it."""
    if callback is None:
        return None

    def report(iterations: int, violation: float, cells: int) -> None:
        callback(iterations, violation / shared.scale, cells / operator.grid.cells)

    return report


def _from_coarser(problem: Problem, control: Control) -> Start:
    """Pressure interpolated from the solution on the next coarser grid, itself begun in the same way."""
    nothing = Start(None, -math.inf)
    operator = problem.operator
    coarse = operator.coarsened()
    if coarse is None or coarse.grid.cells == operator.grid.cells:
        return nothing
    shape, periodic = coarse.grid.shape, operator.grid.periodic
    # the kernel's unit may differ by a power of two between grids
    factor = coarse.unit / operator.unit
    gap = cascade.sample(problem.gap.reshape(operator.grid.shape), shape, periodic)
    shared = replace(problem.shared, of_first=OF_FIRST)
    there = Problem(shared, coarse, gap.reshape(-1), problem.cap * factor)
    asked = _on_coarser(control, problem, there, factor)
    if without_contact(asked, there.gap) is not None:
        return nothing
    start = _from_coarser(there, asked) if max(shape) > _COARSEST else nothing
    tolerance = max(problem.shared.tolerance, COARSE_TOLERANCE * problem.shared.scale)
    result = solve_on_grid(there, asked, start, tolerance)
    cells, pressure = cascade.prolong(
        result.pressure.reshape(shape),
        result.displacement.reshape(shape),
        gap,
        result.approach,
        there.cap,
        operator.grid.shape,
        periodic,
    )
    pressure /= factor
    return Start(below(cells, pressure, problem.cap), result.approach)


def _on_coarser(control: Control, fine: Problem, coarse: Problem, factor: float) -> Control:
    """What is prescribed on the coarser grid, `factor` the ratio of the kernels' units."""
    if isinstance(control, ApproachControl) and fine.operator.mean_free:
        # what matters is how far it is from the mean gap: beyond that, elastic contact would have no solution
        return ApproachControl(control.approach + float(coarse.gap.mean() - fine.gap.mean()))
    if isinstance(control, LoadControl):  # a force is a sum over cells
        return LoadControl(control.force * factor * fine.operator.grid.cell_area / coarse.operator.grid.cell_area)
    return control
