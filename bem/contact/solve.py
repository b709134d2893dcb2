"""The front door of dry contact: checks, units, coarse to fine, certificate."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from bem.contact import cascade, passes
from bem.contact.active_set import Effort, LevelResult, Tuning, solve_level
from bem.contact.controls import Control, LoadControl, scaled_control
from bem.contact.solution import ContactSolution
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, InputError, Status

FloatArray = NDArray[np.float64]
Callback = Callable[[int, float, float], object]

_FLAT = 1e-6
"""A gap whose roughness is below this times the displacement is called flat; the residual is then of the latter."""

_COARSE_TOLERANCE = 3e-2
"""Violation over roughness that coarse grids are solved to: more is lost in the interpolation anyway."""


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
        part of the deformed gap [m]. On a doubly periodic grid displacements are mean-free: `approach` is the distance by
        which the means of the undeformed surfaces come closer than `gap` says.
    hardness : cap on the pressure [Pa]; None for purely elastic.
    tolerance : bound on the residual, see `ContactSolution`.
    initial_pressure : (nx, ny), a start near the solution; the coarser grids are then skipped.
    max_iterations : limit on iterations of conjugate gradients over all grids.
    callback : called with iterations, residual and fraction of cells in contact after each round on the grid itself.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond the
        mean of the gap.
    """
    gap, hardness_or_none = _check(
        gap, operator, load, approach, mean_gap, hardness, tolerance, initial_pressure, max_iterations
    )
    grid = operator.grid
    cap = math.inf if hardness_or_none is None else hardness_or_none
    datum = float(gap.min())
    relative = gap - datum
    mean = float(relative.mean())
    roughness = float(np.sqrt(np.mean((relative - mean) ** 2)))
    _refuse_infeasible(operator, load, approach, hardness_or_none, datum + mean)
    before = operator.count.weighted

    length = _length_unit(operator, roughness, load, approach, mean_gap, datum, cap)
    to_pressure = length / operator.unit
    control = scaled_control(
        load, approach, mean_gap, cell_force=to_pressure * grid.cell_area, length=length, datum=datum
    )
    scaled_cap = cap / to_pressure
    scaled_gap = (relative / length).reshape(-1)
    effort = Effort(max_iterations)
    tuning = Tuning()
    scale = roughness / length

    if control == LoadControl(0.0):
        result = LevelResult(np.zeros(grid.cells), np.zeros(grid.cells), 0.0, 0.0, True, 0)
    else:
        start = None
        if initial_pressure is not None:
            start = np.clip(initial_pressure.reshape(-1) / to_pressure, 0.0, scaled_cap)
        else:
            start = _from_coarser(operator, scaled_gap.reshape(grid.shape), control, scaled_cap, scale, effort, tuning)
        report = None
        if callback is not None:
            used = callback

            def report(iterations: int, violation: float, cells: int) -> None:
                used(iterations, violation / scale if scale > 0 else violation, cells / grid.cells)

        goal = _goal(tolerance, scale, start, operator)
        result = solve_level(operator, scaled_gap, control, scaled_cap, start, goal, effort, tuning, report)
    return _certify(operator, gap, result, length, to_pressure, datum, cap, roughness, tolerance, effort, before)


def _goal(tolerance: float, scale: float, start: FloatArray | None, operator: DisplacementOperator) -> float:
    return 0.9 * tolerance * (scale if scale > 0 else 1.0)


def _from_coarser(
    operator: DisplacementOperator,
    gap: FloatArray,
    control: Control,
    cap: float,
    scale: float,
    effort: Effort,
    tuning: Tuning,
) -> FloatArray | None:
    """Pressure (flat) interpolated from the solution on the next coarser grid, itself begun in the same way."""
    coarse = operator.coarsened()
    if not cascade.is_worth(gap.shape, coarse):
        return None
    assert coarse is not None
    periodic = operator.grid.periodic
    # the kernel's unit may differ by a power of two between grids
    factor = coarse.unit / operator.unit
    coarse_gap = cascade.sample(gap, coarse.grid.shape, periodic)
    area_ratio = coarse.grid.cell_area / operator.grid.cell_area
    there = control
    if isinstance(control, LoadControl):
        there = LoadControl(control.force * factor / area_ratio)
    start = _from_coarser(coarse, coarse_gap, there, cap * factor, scale, effort, tuning)
    flat = coarse_gap.reshape(-1)
    result = solve_level(coarse, flat, there, cap * factor, start, _COARSE_TOLERANCE * (scale or 1.0), effort, tuning)
    shape = coarse.grid.shape
    fine = cascade.prolong(
        result.pressure.reshape(shape),
        result.displacement.reshape(shape),
        coarse_gap,
        result.approach,
        cap * factor,
        gap.shape,
        periodic,
    )
    fine /= factor
    return fine.reshape(-1)


def _length_unit(
    operator: DisplacementOperator,
    roughness: float,
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    datum: float,
    cap: float,
) -> float:
    """Power of two [m] near the roughness; near the displacement to come where the gap is flat."""
    length = roughness
    if not length > 0:
        if load is not None:
            length = load / operator.grid.area * operator.unit
        elif approach is not None:
            length = abs(approach - datum)
        elif mean_gap is not None:
            length = mean_gap
    if not (length > 0 and math.isfinite(length)):
        return 1.0
    return 2.0 ** round(math.log2(length))


def _certify(
    operator: DisplacementOperator,
    gap: FloatArray,
    result: LevelResult,
    length: float,
    to_pressure: float,
    datum: float,
    cap: float,
    roughness: float,
    tolerance: float,
    effort: Effort,
    before: float,
) -> ContactSolution:
    """Judge the pressure by itself, and put everything in SI units."""
    grid = operator.grid
    pressure = (result.pressure * to_pressure).reshape(grid.shape)
    np.minimum(pressure, cap, out=pressure)
    displacement = (result.displacement * length).reshape(grid.shape)
    approach = result.approach * length + datum
    deformed = gap + displacement
    deformed -= approach
    largest = passes.complementarity(pressure.reshape(-1), displacement.reshape(-1), gap.reshape(-1), approach, cap)
    size = float(np.abs(displacement).max())
    reference = roughness if roughness > _FLAT * size else size
    residual = float(largest / reference) if reference > 0 else (0.0 if largest == 0 else math.inf)
    capped = pressure >= cap
    contact = pressure > 0
    np.maximum(deformed, 0.0, out=deformed, where=~contact)
    if residual <= tolerance:
        status = Status.CONVERGED
    else:
        status = Status.MAX_ITERATIONS if effort.left <= 0 else Status.STALLED
    return ContactSolution(
        pressure=pressure,
        displacement=displacement,
        gap=deformed,
        approach=approach,
        load=float(pressure.sum()) * grid.cell_area,
        contact_area=int(np.count_nonzero(contact)) * grid.cell_area,
        plastic_area=int(np.count_nonzero(capped)) * grid.cell_area,
        plastic_depth=np.where(capped, np.maximum(-deformed, 0.0), 0.0),
        iterations=effort.iterations,
        convolutions=operator.count.weighted - before,
        residual=residual,
        status=status,
    )


def _check(
    gap: FloatArray,
    operator: DisplacementOperator,
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    hardness: float | None,
    tolerance: float,
    initial_pressure: FloatArray | None,
    max_iterations: int,
) -> tuple[FloatArray, float | None]:
    if not isinstance(operator, DisplacementOperator):
        raise InputError(f"solve_contact: operator {operator!r} must come from displacement_operator")
    messages = []
    checked = gap
    for name, field in (("gap", gap), ("initial_pressure", initial_pressure)):
        if name == "gap" or field is not None:
            try:
                array = operator.grid.check_field(field, f"solve_contact: {name}")
                if name == "gap":
                    checked = array
                elif array.min() < 0:
                    messages.append(
                        f"solve_contact: initial_pressure has a minimum of {array.min()!r} Pa; it must be >= 0"
                    )
            except InputError as error:
                messages.extend(error.messages)
    controls = {"load": load, "approach": approach, "mean_gap": mean_gap}
    given = {name: value for name, value in controls.items() if value is not None}
    if len(given) != 1:
        messages.append(
            f"solve_contact: give exactly one of load, approach and mean_gap, not {', '.join(given) or 'none of them'}"
        )
    for name, value in given.items():
        if not _is_number(value) or (name != "approach" and value < 0):
            bound = "" if name == "approach" else " and not negative"
            messages.append(f"solve_contact: {name} {value!r} must be finite{bound}")
    if hardness is not None and not (_is_number(hardness) and hardness > 0):
        messages.append(f"solve_contact: hardness {hardness!r} must be positive and finite [Pa], or None")
    if not (_is_number(tolerance) and 0 < tolerance < 1):
        messages.append(f"solve_contact: tolerance {tolerance!r} must lie between 0 and 1")
    if isinstance(max_iterations, bool) or not isinstance(max_iterations, int) or max_iterations < 1:
        messages.append(f"solve_contact: max_iterations {max_iterations!r} must be a positive integer")
    if messages:
        raise InputError(messages)
    return checked, None if hardness is None else float(hardness)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.floating | np.integer) and math.isfinite(value)


def _refuse_infeasible(
    operator: DisplacementOperator, load: float | None, approach: float | None, hardness: float | None, mean: float
) -> None:
    if load is not None and hardness is not None:
        most = hardness * operator.grid.area
        if load > most * (1 + 1e-12):
            raise InfeasibleError(
                f"solve_contact: load {load!r} N is more than hardness x area = {most!r} N can carry; "
                "lower the load or raise the hardness"
            )
    if approach is not None and hardness is None and operator.mean_free and approach > mean:
        raise InfeasibleError(
            f"solve_contact: approach {approach!r} m is beyond the mean gap {mean!r} m; on a doubly periodic grid "
            "elastic bodies in full contact cannot come closer"
        )
