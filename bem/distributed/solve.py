"""Solve one dry contact on several ranks: check, start from a coarse grid, iterate, and certify the result."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.arguments import is_finite, is_positive
from bem.contact.certificate import CERTIFICATE_MARGIN
from bem.contact.grid_workspace import is_flat
from bem.distributed.bounded_cg import ApproachSearch, SlabProblem, solve_bounded, violations_of_rows
from bem.distributed.coarse_start import coarse_start
from bem.distributed.convolution import SlabConvolution, slab_convolution
from bem.distributed.ranks import Ranks, own_length, own_slice
from bem.distributed.spectra import responds_evenly
from bem.errors import InfeasibleError, InputError, Status
from bem.grid import Grid
from bem.materials import Body
from bem.threads import one_blas_thread

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class SlabSolution:
    """Contact of all ranks, with the fields of the own rows.

    Attributes
    ----------
    rows : own rows of the grid.
    pressure, displacement, gap : (own rows, ny) [Pa], [m], [m], as in `bem.contact.ContactSolution`.
    approach, load : [m], [N].
    counted_area : of the cells with pressure [m^2]; first-order accurate.
    maximum_pressure : of a cell [Pa].
    mean_gap : mean of the open gap [m].
    response_unit : power of two near the largest response of the bodies to a wave [m/Pa].
    residual : largest violation of the contact conditions, recomputed from `pressure` and `approach`, over the standard
        deviation of the undeformed gap (over the displacement where the gap is flat); or the relative error of the
        load, if that is larger.
    status : converged where the residual is at most the tolerance.
    iterations, convolutions : of all ranks together, preconditioning included.
    """

    rows: slice
    pressure: FloatArray
    displacement: FloatArray
    gap: FloatArray
    approach: float
    load: float
    counted_area: float
    maximum_pressure: float
    mean_gap: float
    response_unit: float
    residual: float
    status: Status
    iterations: int
    convolutions: int


@one_blas_thread
def solve_slabs(
    gap: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    ranks: Ranks,
    *,
    load: float | None = None,
    approach: float | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 5000,
    callback: Callable[[int, float, float], object] | None = None,
) -> SlabSolution:
    """Solve for the pressure between two bodies, elastic or capped at a hardness; every rank calls it.

    Parameters
    ----------
    gap : own rows of the undeformed gap [m]: rows `own_slice(nx, ranks)`, all ny columns.
    grid : of all rows.
    bodies : one Body (the other rigid), or (lower, upper); frictionless.
    ranks : `OneRank()`, or `bem.distributed.mpi.world()`.
    load, approach : exactly one of total load [N] and approach [m].
    hardness : cap on the pressure [Pa]; None for purely elastic.
    tolerance : bound on the residual, see `SlabSolution`.
    max_iterations : limit of iterations.
    callback : called with iterations, residual and the fraction of cells in contact, on all ranks.

    Raises
    ------
    InputError : arguments out of range, fewer rows than ranks, a crystal that does not respond alike on both sides of
        the x axis.
    InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond the
        mean of the gap.
    """
    pair = (bodies,) if isinstance(bodies, Body) else tuple(bodies)
    rows = own_slice(grid.shape[0], ranks)
    _check(gap, grid, pair, ranks, load, approach, hardness, tolerance)
    cap = math.inf if hardness is None else float(hardness)
    lowest, mean, rms = _moments(gap, grid, ranks)
    _refuse_infeasible(grid, load, approach, cap, mean, CERTIFICATE_MARGIN * tolerance * rms)
    convolution = slab_convolution(grid, pair, ranks)
    problem = SlabProblem(convolution, gap - lowest, cap)
    unit = 2.0 ** round(math.log2(convolution.spectra.largest)) if convolution.spectra.largest > 0 else 1.0
    scale = 0.0 if load is None else load / grid.area * unit

    def violation_scale(displacement: float) -> float:
        """Return the length [m] that violations are relative to, from the largest displacement [m]."""
        largest = max(displacement, scale)
        return (largest if is_flat(rms, largest) else rms) or 1.0

    iterations = 0
    if load == 0 or (approach is not None and approach <= lowest):
        pressure, above_lowest = np.zeros_like(gap), 0.0 if approach is None else approach - lowest
        status_if_unmet = Status.STALLED
    else:
        start, coarse_approach = coarse_start(gap, grid, pair, ranks, load=load, approach=approach, cap=cap)
        compliance = convolution.spectra.mean_compliance / grid.cells
        (first_sum,), _ = problem.reduce((start.sum(axis=1),))
        search = ApproachSearch(
            (coarse_approach if approach is None else approach) - lowest + compliance * first_sum,
            (load or 0.0) / grid.cell_area if approach is None else approach - lowest,
            approach is None,
            compliance,
            0.5 * rms or math.inf,
        )
        found = solve_bounded(
            problem,
            search,
            start,
            tolerance=CERTIFICATE_MARGIN * tolerance,
            violation_scale=violation_scale,
            max_iterations=max_iterations,
            callback=callback if ranks.rank == 0 else None,
        )
        pressure, above_lowest, iterations = found.iterate.pressure, found.approach, found.iterations
        status_if_unmet = Status.STALLED if found.stalled else Status.MAX_ITERATIONS
        del found
    return _certified(
        problem,
        pressure,
        above_lowest,
        lowest=lowest,
        load=load,
        violation_scale=violation_scale,
        tolerance=tolerance,
        status_if_unmet=status_if_unmet,
        rows=rows,
        iterations=iterations,
        unit=unit,
    )


def _check(
    gap: FloatArray,
    grid: Grid,
    bodies: tuple[Body, ...],
    ranks: Ranks,
    load: float | None,
    approach: float | None,
    hardness: float | None,
    tolerance: float,
) -> None:
    """Refuse arguments out of range. They are the same on all ranks; a mistake in one rank's gap is raised on all."""
    messages = []
    if ranks.size > grid.shape[0]:
        messages.append(f"{ranks.size} ranks for {grid.shape[0]} rows along x; allowed: at most one rank for each row")
    if not all(responds_evenly(body) for body in bodies):
        messages.append("solve_slabs: a crystal must respond alike on both sides of the x axis; allowed: solve_contact")
    if (load is None) == (approach is None):
        messages.append("solve_slabs: give exactly one of load and approach")
    if load is not None and not (is_finite(load) and load >= 0):
        messages.append(f"solve_slabs: load {load!r} must be finite and not negative [N]")
    if approach is not None and not is_finite(approach):
        messages.append(f"solve_slabs: approach {approach!r} must be finite [m]")
    if hardness is not None and not is_positive(hardness):
        messages.append(f"solve_slabs: hardness {hardness!r} must be positive and finite [Pa], or None")
    if not (is_finite(tolerance) and 0 < tolerance < 1):
        messages.append(f"solve_slabs: tolerance {tolerance!r} must lie between 0 and 1")
    if messages:
        raise InputError(messages)
    shape = (own_length(grid.shape[0], ranks, ranks.rank), grid.shape[1])
    wrong = gap.shape != shape or gap.dtype != np.float64 or not np.isfinite(gap).all()
    ranks_wrong = ranks.allgather_rows(np.full((1, 1), float(wrong)), ranks.size)
    if ranks_wrong.any():
        first = int(np.argmax(ranks_wrong))
        raise InputError(
            f"solve_slabs: gap of rank {first} must be finite floats of its rows of the grid's {grid.shape}: "
            f"{own_length(grid.shape[0], ranks, first)} rows"
        )


def _moments(gap: FloatArray, grid: Grid, ranks: Ranks) -> tuple[float, float, float]:
    """Return minimum, mean and standard deviation of the gap of all ranks [m]."""
    everywhere = ranks.allgather_rows(np.stack([gap.min(axis=1), gap.sum(axis=1)], axis=1), grid.shape[0])
    mean = float(everywhere[:, 1].sum()) / grid.cells
    about = gap - mean
    squares = ranks.allgather_rows(np.vecdot(about, about)[:, None], grid.shape[0])
    return float(everywhere[:, 0].min()), mean, math.sqrt(float(squares.sum()) / grid.cells)


def _refuse_infeasible(
    grid: Grid, load: float | None, approach: float | None, cap: float, mean: float, slack: float
) -> None:
    """Refuse a load above hardness x area, and an approach of elastic bodies beyond full contact on a period."""
    if load is not None and load > cap * grid.area * (1 + 1e-14):
        raise InfeasibleError(
            f"load {load:.6g} N is above hardness x area = {cap * grid.area:.6g} N; allowed: a lower load or a "
            "larger grid"
        )
    if approach is not None and all(grid.periodic) and math.isinf(cap) and approach > mean + slack:
        raise InfeasibleError(
            f"approach {approach!r} m is beyond the mean gap {mean!r} m; on a doubly periodic grid elastic bodies in "
            "full contact cannot come closer"
        )


def _certified(
    problem: SlabProblem,
    pressure: FloatArray,
    approach: float,
    *,
    lowest: float,
    load: float | None,
    violation_scale: Callable[[float], float],
    tolerance: float,
    status_if_unmet: Status,
    rows: slice,
    iterations: int,
    unit: float,
) -> SlabSolution:
    """Recompute displacement, violation and load from the pressure and the approach above the gap's lowest value."""
    convolution: SlabConvolution = problem.convolution
    grid, cap = convolution.grid, problem.cap
    displacement = convolution.displacement(pressure)
    if convolution.spectra.mean_compliance > 0:
        (pressure_sum,), _ = problem.reduce((pressure.sum(axis=1),))
        displacement -= convolution.spectra.mean_compliance / grid.cells * pressure_sum
    deformed = problem.gap + displacement - approach
    touching = pressure > 0
    opened = np.where(touching, 0.0, np.maximum(deformed, 0.0))
    (pressure_sum, loaded, volume), (largest, highest, displaced) = problem.reduce(
        (pressure.sum(axis=1), touching.sum(axis=1), opened.sum(axis=1)),
        (violations_of_rows(pressure, deformed, cap), pressure.max(axis=1), np.abs(displacement).max(axis=1)),
    )
    found_load = pressure_sum * grid.cell_area
    if load is None or found_load == load:
        load_error = 0.0
    else:
        load_error = abs(found_load - load) / load if load > 0 else math.inf
    residual = max(max(largest, 0.0) / violation_scale(displaced), load_error)
    return SlabSolution(
        rows=rows,
        pressure=pressure,
        displacement=displacement,
        gap=np.where(touching, deformed, opened),
        approach=approach + lowest,
        load=found_load,
        counted_area=loaded * grid.cell_area,
        maximum_pressure=highest,
        mean_gap=volume / grid.cells,
        response_unit=unit,
        residual=residual,
        status=Status.CONVERGED if residual <= tolerance else status_if_unmet,
        iterations=iterations,
        convolutions=convolution.count.number,
    )
