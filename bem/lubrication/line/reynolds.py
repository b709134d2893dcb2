"""Reynolds' equation of the steady line contact on cells, its derivatives, and a local solution around a spike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.flow_factors import RoughWalls
from bem.lubrication.line.deflection import DEFLECTION, LineOperator
from bem.lubrication.shear_profile import ShearFlow

SPIKE_REACH = 60
"""Nodes on either side of a spike that are solved for alone."""
LEAST_SHARE = 0.3
"""Of the residual at the spike in that of all other cells, from which it is worth while."""
LOCAL_STEPS = 12
SHORTEST = 0.2


class Layered(Protocol):
    """An oil that is not the same all the way across the film, at the nodes of one mesh: Dowson's generalised form.

    leaving : Couette flow over that of the oil as it comes, at the exit.
    """

    @property
    def leaving(self) -> float:
        """At the exit."""

    def drag(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Couette flow over that of the oil as it comes, and its slope, at the nodes."""

    def log_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of the uniform oil through which pressure drives as much, and its slope, at the nodes."""

    def log_sliding_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of the uniform oil that sliding shears at the same stress, and its slope, at the nodes."""

    @property
    def thinning(self) -> FloatArray:
        """ln of what pressure drives through the layers of an oil that its shear law thins, over what it drives through
        the uniform oils of the same stress, at the nodes."""

    def cut(self, nodes: slice) -> Layered:
        """At some of the nodes."""


@dataclass(frozen=True)
class Problem:
    """The similarity problem: load M, laws of the scaled pressure, flow factors of the walls (None: smooth), shear law
    across the film (None: Newtonian), what differs across the film (None: nothing)."""

    load: float
    log_viscosity: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    density: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    walls: RoughWalls | None = None
    shear: ShearFlow | None = None
    layered: Layered | None = None

    def flowing(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln of the viscosity against which pressure drives the oil, and its slope, at the nodes."""
        return self.log_viscosity(pressure) if self.layered is None else self.layered.log_viscosity(pressure)

    def cube(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What pressure flow goes with, h^3 between smooth walls, and half its derivative."""
        if self.walls is not None:
            return self.walls.cube(thickness)
        return thickness**3, 1.5 * thickness**2

    def dragged(self, film: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What Couette flow goes with, h between smooth walls, and its derivative."""
        return (film, np.ones_like(film)) if self.walls is None else self.walls.dragged(film)


@dataclass(frozen=True)
class Parts:
    """What residual and derivatives share. On the cells: pressure flow and its derivatives with the films at both ends,
    the gradient and, through viscosity and shear law, the pressures there; on the nodes: slope of the dragged
    mass with pressure, and of the dragged flow with the film; density and its slope."""

    flow: FloatArray
    by_film: FloatArray
    mobility: FloatArray
    left: FloatArray
    right: FloatArray
    mean_density: FloatArray
    mass_slope: FloatArray
    dragged_slope: FloatArray
    density: FloatArray
    density_slope: FloatArray


@dataclass(frozen=True)
class _Layers:
    """On the cells: what pressure drives through layers that a shear law thins over that of uniform oil; mean fluidity
    that sliding shears, and its derivatives with the pressures at both ends."""

    share: FloatArray
    fluidity: FloatArray
    left: FloatArray
    right: FloatArray


@dataclass(frozen=True)
class Flow:
    """The flow through n cells between n+1 nodes, relative to `scale` (n,): widths, and how much of the difference
    between the two nodes upstream extrapolates the nearer one."""

    problem: Problem
    width: FloatArray
    extrapolation: FloatArray
    scale: FloatArray

    def cut(self, first: int, last: int) -> Flow:
        """The cells first .. last - 1. The flow through the first of them lacks its second node upstream."""
        part, problem = slice(first, last), self.problem
        if problem.layered is not None:
            problem = replace(problem, layered=problem.layered.cut(slice(first, last + 1)))
        return Flow(problem, self.width[part], self.extrapolation[part], self.scale[part])

    def residual(self, pressure: FloatArray, film: FloatArray, exit_film: float) -> tuple[FloatArray, Parts]:
        """Pressure flow less Couette flow, plus what leaves at the exit."""
        positive = np.maximum(pressure, 0.0)
        log_viscosity, slope = self.problem.flowing(positive)
        density, density_slope = self.problem.density(positive)
        slope = np.where(pressure > 0, slope, 0.0)
        density_slope = np.where(pressure > 0, density_slope, 0.0)
        thickness = 0.5 * (film[1:] + film[:-1])
        mean_density = 0.5 * (density[1:] + density[:-1])
        fluid, left, right = mean_fluidity(log_viscosity)
        fluidity = mean_density * fluid / 6
        gradient = np.diff(pressure) / self.width
        cube, half_slope = self.problem.cube(thickness)
        left, right = left * slope[:-1] * mean_density / 6, right * slope[1:] * mean_density / 6
        mobility, by_film = cube * fluidity, half_slope * fluidity
        if self.problem.shear is None:
            flow, by_film, steep = mobility * gradient, by_film * gradient, cube * gradient
            left, right = steep * left, steep * right
        else:
            middle, layers = 0.5 * (positive[1:] + positive[:-1]), self._layers(positive, pressure > 0)
            own = fluid if layers is None else layers.fluidity
            driven = self.problem.shear.driven(gradient, thickness, own, middle)
            flow = mobility * driven.gradient
            by_film = by_film * driven.gradient + 0.5 * mobility * driven.by_film
            limited, softer = 0.5 * mobility * driven.by_pressure, mobility * driven.by_fluidity
            mobility = mobility * driven.by_gradient
            if layers is None:
                steep = cube * (driven.gradient + fluid * driven.by_fluidity)
                left, right = steep * left + limited, steep * right + limited
            else:
                steep = cube * driven.gradient
                left = layers.share * (steep * left + softer * layers.left + limited)
                right = layers.share * (steep * right + softer * layers.right + limited)
                flow, by_film, mobility = (layers.share * value for value in (flow, by_film, mobility))
        dragged, dragged_slope = self.problem.dragged(film)
        mass_slope = dragged * density_slope
        leaving = float(self.problem.dragged(np.array([exit_film]))[0][0])
        if self.problem.layered is not None:
            drag, steep_drag = self.problem.layered.drag(positive)
            mass_slope = mass_slope * drag + density * dragged * np.where(pressure > 0, steep_drag, 0.0)
            dragged, dragged_slope = dragged * drag, dragged_slope * drag
            leaving *= self.problem.layered.leaving
        mass = density * dragged
        carried = mass[:-1].copy()
        carried[1:] += self.extrapolation[1:] * (mass[1:-1] - mass[:-2])
        carried[0] = 0.5 * (mass[0] + mass[1])
        error = (flow - (carried - leaving)) / self.scale
        return error, Parts(
            flow=flow,
            by_film=by_film,
            mobility=mobility,
            left=left,
            right=right,
            mean_density=mean_density,
            mass_slope=mass_slope,
            dragged_slope=dragged_slope,
            density=density,
            density_slope=density_slope,
        )

    def _layers(self, pressure: FloatArray, loaded: NDArray[np.bool_]) -> _Layers | None:
        """Of an oil that differs across the film and that its shear law thins; None of one that does not differ."""
        layered = self.problem.layered
        if layered is None:
            return None
        logarithm, slope = layered.log_sliding_viscosity(pressure)
        slope, thinning = np.where(loaded, slope, 0.0), layered.thinning
        fluidity, left, right = mean_fluidity(logarithm)
        share = np.exp(0.5 * (thinning[1:] + thinning[:-1]))
        return _Layers(share, fluidity, left * slope[:-1], right * slope[1:])

    def derivatives(self, parts: Parts) -> tuple[FloatArray, ...]:
        """Of the residual of cell i: with the films at nodes i - 1, i, i + 1, then with the pressures there."""
        cells, row = len(self.width), 1 / self.scale
        density, density_slope, extrapolation = parts.density, parts.density_slope, self.extrapolation
        density = density * parts.dragged_slope
        through_film = parts.by_film
        before = np.zeros(cells)
        before[1:] = extrapolation[1:] * density[:-2]
        here = through_film - (1 + extrapolation) * density[:-1]
        after = through_film.copy()
        here[0] = through_film[0] - 0.5 * density[0]
        after[0] = through_film[0] - 0.5 * density[1]

        mobility, flow = parts.mobility, parts.flow
        from_left = -mobility / self.width + flow * 0.5 * density_slope[:-1] / parts.mean_density + parts.left
        from_right = mobility / self.width + flow * 0.5 * density_slope[1:] / parts.mean_density + parts.right
        carried = parts.mass_slope
        from_left -= (1 + extrapolation) * carried[:-1]
        from_left[0] += 0.5 * carried[0]
        from_right[0] -= 0.5 * carried[1]
        from_before = np.zeros(cells)
        from_before[1:] = extrapolation[1:] * carried[:-2]
        return before * row, here * row, after * row, from_before * row, from_left * row, from_right * row


def eased(
    flow: Flow, operator: LineOperator, pressure: FloatArray, film: FloatArray, error: FloatArray
) -> FloatArray | None:
    """Pressures with the flow around a spike put right, all else held, where that is what is wrong; else None.

    Newton's method on all cells takes many short steps where a spike lands some cells beside its place: only there
    are the equations far from linear, and there they are few (nonlinear elimination; Lanzkron, Rose and Wilkes 1996).
    """
    cells = len(flow.width)
    top = int(np.argmin(np.diff(pressure) / flow.width))
    first, last = max(top - SPIKE_REACH, 1), min(top + SPIKE_REACH, cells)
    rest = float(np.linalg.norm(error[:first])) + float(np.linalg.norm(error[last:]))
    start = float(np.linalg.norm(error[first:last]))
    if start < LEAST_SHARE * rest:
        return None
    local, nodes = flow.cut(first - 1, last), slice(first - 1, last + 1)
    response = -DEFLECTION * operator.factor * operator.block(first, last)
    exit_film, inner = float(film[-1]), slice(1, -1)
    p, h = pressure[nodes].copy(), film[nodes]
    wrong, parts = local.residual(p, h, exit_film)
    size, index = start, np.arange(last - first)
    for _ in range(LOCAL_STEPS):
        before, here, after, low, diagonal, high = (d[1:, None] for d in local.derivatives(parts))
        matrix = before * response[:-2] + here * response[1:-1] + after * response[2:]
        matrix[index, index] += diagonal[:, 0]
        matrix[index[:-1], index[1:]] += high[:-1, 0]
        matrix[index[1:], index[:-1]] += low[1:, 0]
        change = np.linalg.solve(matrix, -wrong[1:])
        film_change = response @ change
        length = 1.0
        while length > SHORTEST:
            new_p, new_h = p.copy(), h + length * film_change
            new_p[inner] += length * change
            if new_h.min() > 0:
                new_wrong, new_parts = local.residual(new_p, new_h, exit_film)
                new_size = float(np.linalg.norm(new_wrong[1:]))
                if new_size < (1 - 0.05 * length) * size:
                    break
            length *= 0.5
        else:
            break
        p, h, wrong, parts, size = new_p, new_h, new_wrong, new_parts, new_size
        if size < max(0.1 * rest, 1e-3 * start):
            break
    if size == start:
        return None
    better = pressure.copy()
    better[first:last] = p[inner]
    return better


def longest_step(film: FloatArray, change: FloatArray, share: float) -> float:
    """Length of a step, one at most, that takes no more than a share of any film."""
    shrinking = change < 0
    if not shrinking.any():
        return 1.0
    return min(1.0, share * float(np.min(-film[shrinking] / change[shrinking])))


def mean_fluidity(log_viscosity: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean of exp(-ln m) over the pressures of each cell, ln m linear in between, and its derivatives with ln m at
    both ends. A mean at the cell's middle would let a spike of one cell block the flow at any pressure behind it."""
    first, second = log_viscosity[:-1], log_viscosity[1:]
    half = 0.5 * (second - first)
    small = np.abs(half) < 0.05
    safe = np.where(small, 1.0, 2 * half)
    low, high = np.exp(-first), np.exp(-second)
    middle = np.exp(-0.5 * (first + second))
    series = 1 + half**2 / 6 + half**4 / 120
    mean = np.where(small, middle * series, (low - high) / safe)
    odd = 0.5 * middle * (half / 3 + half**3 / 30)
    left = np.where(small, -0.5 * mean - odd, (mean - low) / safe)
    right = np.where(small, -0.5 * mean + odd, (high - mean) / safe)
    return mean, left, right
