"""What is asked of a contact: checked, refused where nothing can carry it, and put in the solver's units."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.arguments import is_finite, is_positive
from bem.contact.controls import Control, scaled_control
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, InputError

FloatArray = NDArray[np.float64]


LARGE = 1 << 22
"""Cells from which on a gap is not copied where that can be helped."""

_FAR = 1e-15
"""Lengths [m] below this, or above its inverse, get near to what single precision can hold beside their errors."""


@dataclass(frozen=True)
class Request:
    """What was asked for, in SI units: gap (nx, ny), one of three quantities, the cap (infinite for none)."""

    gap: FloatArray
    operator: DisplacementOperator
    load: float | None
    approach: float | None
    mean_gap: float | None
    cap: float
    tolerance: float

    @property
    def controls(self) -> dict[str, float | None]:
        """The three quantities by name."""
        return {"load": self.load, "approach": self.approach, "mean_gap": self.mean_gap}

    def refuse_infeasible(self, mean: float, slack: float) -> None:
        """Refuse what no pressure can do; `mean` is that of the gap.

        Raises
        ------
        InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond
            the mean of the gap.
        """
        if self.load is not None and math.isfinite(self.cap):
            most = self.cap * self.operator.grid.area
            if self.load > most * (1 + 1e-12):
                raise InfeasibleError(
                    f"solve_contact: load {self.load!r} N is more than hardness x area = {most!r} N can carry; "
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
    def of(cls, request: Request, roughness: float, datum: float) -> Units:
        """A power of two [m] near the roughness, or near the displacement to come where the gap is flat; one where a
        large gap is zero at its lowest, so that it need not be copied: the same but for round-off."""
        length = _length_unit(request, roughness, datum)
        if request.gap.size >= LARGE and datum == 0.0 and _FAR < length < 1 / _FAR:
            length = 1.0
        return cls(length, length / request.operator.unit, datum)

    def control(self, request: Request) -> Control:
        """What is given, in these units."""
        return scaled_control(
            **request.controls,
            cell_force=self.pressure * request.operator.grid.cell_area,
            length=self.length,
            datum=self.datum,
        )


def _length_unit(request: Request, roughness: float, datum: float) -> float:
    length = roughness
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
    """The arguments of `solve_contact` as a request.

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
    """The gap as an array of floats; adds what is wrong with either field to the messages."""
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
