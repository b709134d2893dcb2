"""The contact problem: checked arguments in SI units, the solver's units, and the problem on one grid.

Step 1 of `bem.contact` (`checked_request`, `Units`), and the call of the active set in step 4 (`GridProblem.solve`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bem.arguments import is_finite, is_positive
from bem.contact.active_set import Report, solve_active_set
from bem.contact.controls import Control, scaled_control
from bem.contact.grid_workspace import GridResult, InitialPressure, IterationBudget, SolverParameters, Tolerance
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, InputError

FloatArray = NDArray[np.float64]

LARGE = 1 << 22
"""Cells from which on copying the gap is avoided where possible."""

_FAR = 1e-15
"""Lengths [m] below this, or above its inverse, approach the range of single precision."""


@dataclass(frozen=True)
class Request:
    """Checked arguments of `solve_contact` in SI units.

    gap : (nx, ny) [m]. load [N], approach [m], mean_gap [m] : exactly one is not None. cap : highest pressure [Pa], may
    be infinite. tolerance : of the residual.
    """

    gap: FloatArray
    operator: DisplacementOperator
    load: float | None
    approach: float | None
    mean_gap: float | None
    cap: float
    tolerance: float

    @property
    def controls(self) -> dict[str, float | None]:
        """Return the three quantities by name."""
        return {"load": self.load, "approach": self.approach, "mean_gap": self.mean_gap}

    def refuse_infeasible(self, mean: float, slack: float) -> None:
        """Refuse a request that no pressure can meet.

        mean : of the gap [m]. slack : of the approach [m].

        Raises
        ------
        InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond
            the mean of the gap.
        """
        if self.load is not None and math.isfinite(self.cap):
            most = self.cap * self.operator.grid.area
            if self.load > most * (1 + 1e-12):
                raise InfeasibleError(
                    f"solve_contact: load {self.load:.6g} N is more than hardness x area = {most:.6g} N can carry; "
                    "lower the load or raise the hardness"
                )
        beyond = self.approach is not None and self.approach > mean + slack
        if beyond and math.isinf(self.cap) and self.operator.mean_free:
            raise InfeasibleError(
                f"solve_contact: approach {self.approach!r} m is beyond the mean gap {mean!r} m; on a doubly periodic "
                "grid elastic bodies in full contact cannot come closer"
            )


@dataclass(frozen=True)
class Units:
    """The solver's units: gaps are `length` [m] above `datum` [m], pressures `pressure` [Pa]."""

    length: float
    pressure: float
    datum: float

    @classmethod
    def of(cls, request: Request, rms_gap: float, datum: float) -> Units:
        """Choose a power of two [m] near the rms gap; near the expected displacement where the rms gap is zero.

        The unit is one for a large gap with lowest value zero, which then need not be copied.
        """
        length = _length_unit(request, rms_gap, datum)
        if request.gap.size >= LARGE and datum == 0.0 and _FAR < length < 1 / _FAR:
            length = 1.0
        return cls(length, length / request.operator.unit, datum)

    def control(self, request: Request) -> Control:
        """Return the prescribed quantity in these units."""
        return scaled_control(
            **request.controls,
            cell_force=self.pressure * request.operator.grid.cell_area,
            length=self.length,
            datum=self.datum,
        )


@dataclass(frozen=True)
class Settings:
    """Settings that all grids of one problem share.

    tolerance, rms_gap : in the solver's length. coarse_reduction : as in `Tolerance`, on coarse grids.
    """

    tolerance: float
    rms_gap: float
    budget: IterationBudget
    parameters: SolverParameters = field(default_factory=SolverParameters)
    coarse_reduction: float = math.inf

    @property
    def scale(self) -> float:
        """Return the rms gap, or one where it is zero."""
        return self.rms_gap or 1.0

    def allowed(self, tolerance: float) -> Tolerance:
        """Return the tolerance of the violation: tolerance x min(1, displacement / rms gap), in the solver's length.

        Where the gap is exactly flat the tolerance is relative to the displacement alone.
        """
        if not self.rms_gap > 0:
            return Tolerance(math.inf, tolerance)
        return Tolerance(tolerance, tolerance / self.rms_gap, self.coarse_reduction, self.tolerance)


@dataclass(frozen=True)
class GridProblem:
    """The problem on one grid: operator, gap (one-dimensional) and cap.

    The lowest gap is zero on the finest grid only: coarse grids sample the gap, and lagged friction changes it.
    """

    settings: Settings
    operator: DisplacementOperator
    gap: FloatArray
    cap: float
    report: Report | None = None

    def solve(
        self, control: Control, start: InitialPressure, allowed: Tolerance, parameters: SolverParameters
    ) -> GridResult:
        """Solve by the active set, without fallbacks."""
        budget = self.settings.budget
        return solve_active_set(
            self.operator, self.gap, control, self.cap, start, allowed, budget, parameters, self.report
        )


def _length_unit(request: Request, rms_gap: float, datum: float) -> float:
    length = rms_gap
    if not length > 0:
        if request.load is not None:
            length = request.load / request.operator.grid.area * request.operator.unit
        elif request.approach is not None:
            length = abs(request.approach - datum)
        elif request.mean_gap is not None:
            length = request.mean_gap
    if not (length > 0 and math.isfinite(length)):
        return 1.0
    return 2.0 ** round(math.log2(length))


def checked_request(
    gap: FloatArray,
    operator: DisplacementOperator,
    controls: dict[str, float | None],
    *,
    hardness: float | None,
    tolerance: float,
    initial_pressure: FloatArray | None,
    max_iterations: int,
) -> Request:
    """Check the arguments of `solve_contact`.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    """
    if not isinstance(operator, DisplacementOperator):
        raise InputError(f"solve_contact: operator {operator!r} must come from displacement_operator")
    messages: list[str] = []
    checked = _checked_fields(gap, initial_pressure, operator, messages)
    given = {name: value for name, value in controls.items() if value is not None}
    if len(given) != 1:
        messages.append(
            f"solve_contact: give exactly one of load, approach and mean_gap, not {', '.join(given) or 'none of them'}"
        )
    for name, value in given.items():
        if not is_finite(value) or (name != "approach" and value < 0):
            bound = "" if name == "approach" else " and not negative"
            messages.append(f"solve_contact: {name} {value!r} must be finite{bound}")
    if hardness is not None and not is_positive(hardness):
        messages.append(f"solve_contact: hardness {hardness!r} must be positive and finite [Pa], or None")
    if not (is_finite(tolerance) and 0 < tolerance < 1):
        messages.append(f"solve_contact: tolerance {tolerance!r} must lie between 0 and 1")
    if isinstance(max_iterations, bool) or not isinstance(max_iterations, int) or max_iterations < 1:
        messages.append(f"solve_contact: max_iterations {max_iterations!r} must be a positive integer")
    if messages:
        raise InputError(messages)
    cap = math.inf if hardness is None else float(hardness)
    numbers = {name: None if value is None else float(value) for name, value in controls.items()}
    return Request(checked, operator, **numbers, cap=cap, tolerance=tolerance)


def _checked_fields(
    gap: FloatArray, initial_pressure: FloatArray | None, operator: DisplacementOperator, messages: list[str]
) -> FloatArray:
    """Return the gap as an array of floats; append the mistakes of both fields to the messages."""
    checked = gap
    try:
        checked = operator.grid.check_field(gap, "solve_contact: gap")
    except InputError as error:
        messages.extend(error.messages)
    if initial_pressure is not None:
        try:
            array = operator.grid.check_field(initial_pressure, "solve_contact: initial_pressure")
            if array.min() < 0:
                messages.append(f"solve_contact: initial_pressure has a minimum of {array.min()!r} Pa; it must be >= 0")
        except InputError as error:
            messages.extend(error.messages)
    return checked
