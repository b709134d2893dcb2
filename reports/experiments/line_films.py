"""Steady line films, smooth or rough, by differences and dense matrices of their own: experiments compare with them.

A rough surface at rest, a smooth one moving over it: the film is steady, so roughness stands in Reynolds' equation as
it is. Only oils and a first film come from bem. Verified in tests/reports/test_rough_films.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem import Lubricant, solve_line_film
from bem.grid import FloatArray
from bem.lubrication.line.problem import Scales, line_scales, scaled_problem

STEPS, SHORTEST, SETTLED, BALANCED = 60, 1e-4, 1e-9, 1e-7
"""Newton steps, the least part of one that is taken, the change of pressures that ends them, and what they may leave of
flows and load."""
KEPT = 0.3
"""Of a film at a place, what a step leaves of it at least."""
Oil = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]


@dataclass(frozen=True, eq=False)
class Line:
    """A steady line film in Moes' units on a uniform grid: abscissae and pressures (n,), H0, load M, half-width of
    Hertz' contact, the oil as (ln m, its slope, rho, its slope) of pressures, deflection (n, n), heights (n,) of the
    body at rest."""

    x: FloatArray
    pressure: FloatArray
    datum: float
    load: float
    half: float
    oil: Oil
    bending: FloatArray
    heights: FloatArray

    @property
    def film(self) -> FloatArray:
        """Of the pressures."""
        return self.datum + 0.5 * self.x**2 + self.bending @ self.pressure - self.heights

    @property
    def cell(self) -> float:
        """Length of a cell."""
        return float(self.x[1] - self.x[0])

    @property
    def residual(self) -> float:
        """Largest flow that is lost in a free cell over what is dragged along where pressure is highest, or load that
        is missing over the load."""
        right, _, _, mass = line_matrices(self)
        lost = float(np.abs(np.where(held_cells(self, right), 0.0, right)).max()) * self.cell
        missing = abs(self.load - float(self.pressure.sum()) * self.cell) / self.load
        return max(lost / (6 * float(mass[np.argmax(self.pressure)])), missing)


def _bending(x: FloatArray) -> FloatArray:
    """Films under pressures of cells: -(4/pi) integral ln|x - s| ds over each."""
    dx = x[1] - x[0]
    edge = np.subtract.outer(x, x)[:, :, None] + 0.5 * dx * np.array([1.0, -1.0])
    part = edge * (np.log(np.abs(edge)) - 1)
    return -4 / np.pi * (part[:, :, 0] - part[:, :, 1])


def line_matrices(line: Line) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Balances of cells (n,), their derivatives with pressures and with films (n, n), and rho h."""
    p, h, x = line.pressure, line.film, line.x
    n, dx = len(x), x[1] - x[0]
    log, slope, rho, rho_slope = line.oil(p)
    fluid = rho * h**3 * np.exp(-log)
    by_p, by_h = fluid * (rho_slope / rho - slope), 3 * fluid / h
    flow_p, flow_h, flow = np.zeros((n + 1, n)), np.zeros((n + 1, n)), np.zeros(n + 1)
    face, before, behind = np.arange(1, n), np.arange(n - 1), np.arange(1, n)
    mean, gradient = 0.5 * (fluid[:-1] + fluid[1:]), np.diff(p) / dx
    flow[1:n] = -mean * gradient
    flow_p[face, before] = mean / dx - 0.5 * by_p[:-1] * gradient
    flow_p[face, behind] = -mean / dx - 0.5 * by_p[1:] * gradient
    flow_h[face, before] = -0.5 * by_h[:-1] * gradient
    flow_h[face, behind] = -0.5 * by_h[1:] * gradient
    # two cells upstream: second order; at the first face one
    near = np.where(face == 1, 1.0, 1.5)
    for faces, cells, share in ((face, before, near), (face[1:], before[:-1], np.full(n - 2, -0.5))):
        flow[faces] += 6 * share * rho[cells] * h[cells]
        flow_p[faces, cells] += 6 * share * rho_slope[cells] * h[cells]
        flow_h[faces, cells] += 6 * share * rho[cells]
    return np.diff(flow) / dx, np.diff(flow_p, axis=0) / dx, np.diff(flow_h, axis=0) / dx, rho * h


def held_cells(line: Line, right: FloatArray) -> Any:
    """Cells (n,) without pressure that stay so, and both ends; `right` are the balances."""
    held = (line.pressure <= 0) & (right > 0)
    held[[0, -1]] = True
    return held


def line_film(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    entrainment: float,
    lubricant: Lubricant,
    points: int,
    reach: tuple[float, float] = (4.5, 1.6),
) -> tuple[Line, Scales]:
    """The steady film between smooth bodies, begun from `solve_line_film`, and its units.

    Parameters
    ----------
    load : per unit length [N/m]. radius : [m]. contact_modulus : [Pa]. entrainment : u1 + u2 [m/s]. lubricant : the
        oil. points : of the grid, which goes from the first of `reach` half-widths before the centre to the second
        behind it.

    Raises
    ------
    RuntimeError : Newton's method found none.
    """
    known = solve_line_film(
        load=load,
        radius=radius,
        contact_modulus=contact_modulus,
        speeds=(0.5 * entrainment, 0.5 * entrainment),
        lubricant=lubricant,
    )
    scales = line_scales(load, radius, contact_modulus, entrainment, lubricant.viscosity)
    problem = scaled_problem(scales, scales.load, lubricant)
    half = math.sqrt(8 * scales.load / math.pi)

    def oil(pressure: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        return *problem.log_viscosity(pressure), *problem.density(pressure)

    x = np.linspace(-reach[0] * half, reach[1] * half, points)
    pressure = np.interp(x, known.position / scales.length, known.pressure / scales.pressure)
    pressure[0] = pressure[-1] = 0.0
    line = Line(x, pressure, 0.0, scales.load, half, oil, _bending(x), np.zeros(points))
    middle = int(np.argmin(np.abs(x)))
    datum = known.central_thickness / scales.film - float(line.film[middle])
    found = solved(replace(line, datum=datum))
    if found is None:
        raise RuntimeError(f"no line film at M {scales.load:g} on {points} points")
    return found, scales


def solved(line: Line) -> Line | None:
    """The film by Newton's method from one near it; None where none is found."""
    for _ in range(STEPS):
        right, by_p, by_h, _ = line_matrices(line)
        held = held_cells(line, right)
        matrix, rest = bordered(by_p + by_h @ line.bending, by_h.sum(axis=1), held, line.cell)
        missing = line.load - float(line.pressure.sum()) * line.cell
        step = np.linalg.solve(matrix, np.append(np.where(held, -line.pressure, -right), missing) / rest)
        before, share = line.film, 1.0
        while True:
            pressure = np.maximum(line.pressure + share * step[:-1], 0.0)
            trial = replace(line, pressure=pressure, datum=line.datum + share * float(step[-1]))
            if bool((trial.film > KEPT * before).all()):
                break
            share *= 0.5
            if share < SHORTEST:
                return None
        change = float(np.abs(trial.pressure - line.pressure).max())
        line = trial
        if change < SETTLED * float(line.pressure.max()):
            return line if line.residual < BALANCED else None
    return None


def roughened(line: Line, heights: FloatArray, factor: float) -> Line | None:
    """The film of other heights, from one of heights so near that no film loses more than a step may take; None where
    that is not so, or none is found. `factor` of the heights is what is looked for."""
    start = replace(line, heights=factor * heights)
    return solved(start) if bool((start.film > KEPT * line.film).all()) else None


def bordered(matrix: Any, by_datum: Any, held: Any, cell: float) -> tuple[Any, Any]:
    """With the load below and H0 beside, held cells out of it, rows of one size; and these sizes."""
    n = len(matrix)
    whole = np.zeros((n + 1, n + 1), dtype=matrix.dtype)
    whole[:n, :n], whole[:n, n], whole[n, :n] = matrix, by_datum, cell
    index = np.flatnonzero(held)
    whole[index] = 0.0
    whole[index, index] = 1.0
    size = np.abs(whole).max(axis=1)
    return whole / size[:, None], size
