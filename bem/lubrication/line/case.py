"""Arguments of a steady line film, their checks, and the range of loads with a film."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.arguments import is_finite
from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.checks import check_oil
from bem.lubrication.flow_factors import WallFactors, walls_of
from bem.lubrication.line.problem import Problem, Scales, line_scales, scaled_problem
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution
from bem.quantities import with_unit

MOES_LOADS = (1e-5, 3e5)
"""Smallest and largest load M that is accepted. Films converge there for L from 0 to 10, independent of the mesh within
0.05 % (tests/lubrication/test_line_film_steady.py)."""


@dataclass(frozen=True)
class LineCase:
    """Arguments of a steady line film; all fields as of `bem.lubrication.solve_line_film`."""

    load: float
    radius: float
    contact_modulus: float
    speeds: Sequence[float]
    lubricant: Lubricant
    points: int = 2000
    tolerance: float = 1e-8
    initial: FilmSolution | None = None
    max_iterations: int = 40
    flow_factors: WallFactors | str = "off"

    def scaled(self, position: FloatArray | None = None) -> tuple[Scales, bool]:
        """Check the arguments; return Moes' units, and True if the entrainment is along -x.

        position : abscissae at which the film is to be returned [m], checked too.

        Raises
        ------
        InputError : with one message per mistake.
        """
        messages = []
        for name, value, unit in (("load", self.load, "N/m"), ("radius", self.radius, "m")):
            if not (is_finite(value) and value > 0):
                messages.append(f"{name}: {value!r} must be positive and finite [{unit}]")
        rigid = isinstance(self.contact_modulus, float) and self.contact_modulus == math.inf
        if not (rigid or (is_finite(self.contact_modulus) and self.contact_modulus > 0)):
            messages.append(f"contact_modulus: {self.contact_modulus!r} must be positive [Pa]; math.inf is rigid")
        messages += check_speeds(self.speeds)
        if not isinstance(self.lubricant, Lubricant):
            messages.append(f"lubricant: {type(self.lubricant).__name__} is not a Lubricant")
        if not (isinstance(self.points, (int, np.integer)) and 100 <= self.points <= 20000):
            messages.append(f"points: {self.points!r} must be an integer from 100 to 20000")
        if not (isinstance(self.max_iterations, (int, np.integer)) and self.max_iterations >= 1):
            messages.append(f"max_iterations: {self.max_iterations!r} must be an integer of 1 or more")
        if not (is_finite(self.tolerance) and 1e-11 <= self.tolerance <= 1e-2):
            messages.append(f"tolerance: {self.tolerance!r} must lie between 1e-11 and 1e-2")
        if position is not None:
            array = np.asarray(position, dtype=np.float64)
            if array.ndim != 1 or len(array) < 2 or not np.isfinite(array).all() or not (np.diff(array) > 0).all():
                messages.append("position: must be a one-dimensional, ascending array of finite abscissae [m]")
        if not (self.initial is None or isinstance(self.initial, FilmSolution)):
            messages.append(f"initial: {type(self.initial).__name__} is not a FilmSolution")
        if messages:
            raise InputError(messages)
        entrainment = check_entrainment(self.speeds)
        case = float(self.load), float(self.radius), float(self.contact_modulus)
        scales = line_scales(*case, abs(entrainment), self.lubricant.viscosity)
        low, high = MOES_LOADS
        if not low <= scales.load <= high:
            advice = "Raise the load, or lower speed or viscosity."
            if scales.load > high:
                advice = "The film cannot carry that: lower the load, or raise speed or viscosity."
            raise InputError(
                f"load: {with_unit(case[0], 'N/m')} is outside the films that can be solved: M = w / sqrt(2 E* R mu "
                f"(u1+u2)), Moes' parameter of the load, is {scales.load:.3g}; allowed: {low:g} to {high:g}. {advice}"
            )
        if not rigid:
            check_oil(self.lubricant, scales.pressure)
        return scales, entrainment < 0

    def problem(self, scales: Scales) -> Problem:
        """Return the similarity problem with the flow factors of the case."""
        walls = walls_of(self.flow_factors, scales.film, self.speeds)
        sliding = float(self.speeds[0]) - float(self.speeds[1])
        return scaled_problem(scales, scales.load, self.lubricant, walls, sliding)


def check_entrainment(speeds: Sequence[float]) -> float:
    """Return the sum of a pair of speeds [m/s].

    Raises
    ------
    InputError : not a pair of finite speeds, or a sum of zero.
    """
    messages = check_speeds(speeds)
    if messages:
        raise InputError(messages)
    entrainment = float(speeds[0]) + float(speeds[1])
    if abs(entrainment) <= 1e-12 * (abs(speeds[0]) + abs(speeds[1])):
        raise InputError(
            f"speeds: {tuple(speeds)!r} entrain no oil (their sum is zero), so no steady film exists; give a sum other "
            "than zero, or use march_line_film for a squeeze film"
        )
    return entrainment


def load_range(
    radius: float, contact_modulus: float, speeds: Sequence[float], lubricant: Lubricant
) -> tuple[float, float]:
    """Return the smallest and the largest load per unit length [N/m] that `solve_line_film` accepts.

    A smaller load has the film of rigid bodies (contact_modulus = math.inf), for which any load is accepted.
    """
    if math.isinf(contact_modulus):
        return 0.0, math.inf
    unit = 1 / line_scales(1.0, radius, contact_modulus, abs(check_entrainment(speeds)), lubricant.viscosity).load
    # so far inside that rounding does not refuse a load at the very end
    return MOES_LOADS[0] * unit * (1 + 1e-9), MOES_LOADS[1] * unit * (1 - 1e-9)


def check_speeds(speeds: Sequence[float]) -> list[str]:
    """Return messages about a pair of speeds."""
    try:
        first, second = speeds
        if math.isfinite(first) and math.isfinite(second):
            return []
    except (TypeError, ValueError):
        pass
    return [f"speeds: {speeds!r} must be a pair (u1, u2) of finite speeds [m/s]"]
