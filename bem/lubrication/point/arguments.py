"""Checks of the arguments of point films, with messages that name the argument and what to do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from bem.arguments import is_finite, is_positive
from bem.errors import InputError
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.problem import Rectangle, ScaledCase
from bem.quantities import with_unit

MOES_LOADS = (1e-2, 1e5)
"""Smallest and largest load M of elastic bodies: below, the bodies are rigid."""
RATIOS = (1e-3, 1e3)
"""Smallest and largest ratio of radii Rx/Ry: beyond, a contact is a line contact."""
SHORTEST, LONGEST = 32, 2048
"""Smallest and largest number of cells along an axis."""

Speeds = tuple[tuple[float, float], tuple[float, float]]
"""Speeds ((u1x, u1y), (u2x, u2y)) of flat and ball [m/s]."""


def entrainment(speeds: Speeds) -> tuple[float, float]:
    """Return the sum of both speeds along x and y [m/s]."""
    return speeds[0][0] + speeds[1][0], speeds[0][1] + speeds[1][1]


def checked_edges(extent: Sequence[float] | None) -> Rectangle | None:
    """Return the edges of the grid [m] as floats; None of the default rectangle."""
    if extent is None:
        return None
    x0, x1, y0, y1 = (float(v) for v in extent)
    return x0, x1, y0, y1


def check_load(case: ScaledCase, load: float) -> None:
    """Refuse loads that no film carries, or that contradict the units [InputError]."""
    scales = case.scales
    low, high = MOES_LOADS
    if not scales.rigid and not low <= scales.load <= high:
        advice = "Raise the load, or lower speed or viscosity."
        if scales.load > high:
            advice = "The film cannot carry that: lower the load, or raise speed or viscosity."
        raise InputError(
            f"load: {with_unit(load, 'N')} is outside the films that can be solved: Moes' parameter M of the load is "
            f"{scales.load:.3g}; allowed: {low:g} to {high:g}. {advice}"
        )
    if case.hertz is None:
        return
    along, across = (half * scales.film / scales.length for half in case.hertz.semi_axes)  # over the radius along
    larger = max(along, across * scales.ratio)
    if larger > 1:
        raise InputError(
            f"load: {with_unit(load, 'N')} makes a contact {larger:.3g} times as large as the radius of the body: "
            "check the units of load, radii and contact_modulus [N, m, Pa]"
        )


def check_extent(case: ScaledCase, cells: tuple[int, int] | None = None) -> None:
    """Refuse grids that do not hold the contact, and cells larger than the contact and its film [InputError]."""
    scales, axes = case.scales, case.axes
    x0, x1, y0, y1 = case.problem.rectangle
    a, b = (0.0, 0.0) if case.hertz is None else case.hertz.semi_axes
    if not (x0 < -a and x1 > a and y0 < -b and y1 > b):
        size = " x ".join(f"{v * scales.length:.3g}" for v in axes.exchange((a, b)))
        raise InputError(f"extent: must hold the contact, half-axes {size} m in x and y, with room for the inlet")
    if cells is None or case.hertz is None:  # pressure of rigid bodies is far wider than their film
        return
    film, curvatures = case.problem.typical_film, case.problem.curvatures
    names = ("y", "x") if axes.exchanged else ("x", "y")
    for name, half, curvature, length, n in zip(
        names, (a, b), curvatures, (x1 - x0, y1 - y0), axes.exchange(cells), strict=True
    ):
        room = half + math.sqrt(2 * film / curvature)
        if length / n > room:
            raise InputError(
                f"extent: cells of {length / n * scales.length:.3g} m along {name} are larger than the contact and the "
                f"film around it, {room * scales.length:.3g} m; make the grid smaller, or leave extent out"
            )


def check_arguments(
    load: float,
    radii: Sequence[float],
    contact_modulus: float,
    speeds: Any,
    lubricant: Lubricant,
    shape: Any,
    tolerance: float,
    extent: Any,
) -> Speeds:
    """Return both speeds as vectors [m/s].

    Raises
    ------
    InputError : with a message for each mistake.
    """
    messages = []
    if not is_positive(load):
        messages.append(f"load: {load!r} must be positive and finite [N]")
    pair = finite_numbers(radii, 2)
    if pair is None or not all(r > 0 for r in pair):
        messages.append(f"radii: {radii!r} must be two positive, finite radii (Rx, Ry) [m]")
    elif not RATIOS[0] <= pair[0] / pair[1] <= RATIOS[1]:
        messages.append(
            f"radii: Rx/Ry {pair[0] / pair[1]:.3g} must lie between {RATIOS[0]:g} and {RATIOS[1]:g}; beyond, a contact "
            "is a line contact (solve_line_film)"
        )
    if not is_positive(contact_modulus, finite=False):
        messages.append(f"contact_modulus: {contact_modulus!r} must be positive [Pa]; math.inf is rigid")
    both = speed_vectors(speeds)
    if both is None:
        messages.append(
            f"speeds: {speeds!r} must be a pair (u1, u2) of finite speeds along x, or of vectors ((u1x, u1y), (u2x, "
            "u2y)) [m/s]"
        )
    elif math.hypot(*entrainment(both)) <= 1e-12 * sum(math.hypot(*v) for v in both):
        messages.append(
            f"speeds: {speeds!r} entrain no oil (their sum is zero), so no steady film exists; give a sum other than "
            "zero"
        )
    if not isinstance(lubricant, Lubricant):
        messages.append(f"lubricant: {type(lubricant).__name__} is not a Lubricant")
    elif lubricant.shears_film:
        messages.append(
            'lubricant: film_rheology "shear_law" is not there for point contacts; use "newtonian", with which the '
            "shear law acts on friction alone"
        )
    cells = (SHORTEST, SHORTEST) if shape is None else shape
    if finite_numbers(cells, 2) is None or not all(float(n).is_integer() and SHORTEST <= n <= LONGEST for n in cells):
        messages.append(f"shape: {shape!r} must be two integers from {SHORTEST} to {LONGEST}")
    if not (is_finite(tolerance) and 1e-11 <= tolerance <= 1e-2):
        messages.append(f"tolerance: {tolerance!r} must lie between 1e-11 and 1e-2")
    edges = (-1, 1, -1, 1) if extent is None else finite_numbers(extent, 4)
    if edges is None or not (edges[0] < 0 < edges[1] and edges[2] < 0 < edges[3]):
        messages.append(f"extent: {extent!r} must be (x0, x1, y0, y1) around the origin [m]")
    if messages:
        raise InputError(messages)
    assert both is not None
    return both


def finite_numbers(values: Any, count: int) -> tuple[float, ...] | None:
    """Return `count` finite numbers; None if the values are not that."""
    try:
        listed = tuple(values)
    except TypeError:
        return None
    good = len(listed) == count and all(is_finite(v) for v in listed)
    return tuple(float(v) for v in listed) if good else None


def speed_vectors(speeds: Any) -> Speeds | None:
    """Return two speeds, numbers along x or vectors, as vectors; None if they are neither."""
    plain = finite_numbers(speeds, 2)
    if plain is not None:
        return (plain[0], 0.0), (plain[1], 0.0)
    try:
        found = [finite_numbers(one, 2) for one in speeds]
    except TypeError:
        return None
    if len(found) != 2 or found[0] is None or found[1] is None:
        return None
    return (found[0][0], found[0][1]), (found[1][0], found[1][1])
