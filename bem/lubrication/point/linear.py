"""The equations of a Newton step of the point contact, and a multigrid cycle for them.

Unknowns are the changes of the pressures of free cells and of H0; equations are the balances of inner free cells, the
far pressure of the outermost ones, and the load. A cycle relaxes lines on each grid, and what changes H0 is solved for
on the coarsest one, as a whole.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.point import lines, loops, supply_loops
from bem.lubrication.point.levels import LIGHT, Level
from bem.lubrication.point.rough_loops import rough_flows

BoolArray = NDArray[np.bool_]
HalfArray = NDArray[np.float32]

SPREADING = 1.0
"""Pressure flow over what deflection drags, below which a cell is relaxed with a counterpart around it."""
SMOOTH, ROUGH = (1.0, 1.0), (0.9, 0.7)
"""Damping of changes of a cell's own, and of those with a counterpart, of smooth surfaces and of rough ones, whose
lines hear less of each other (`lines.relax`): with films heard of, too, as many random rough balls are found, but not
the same."""


@dataclass(frozen=True)
class Change:
    """Of pressures (nx, ny) and of H0."""

    pressure: FloatArray
    datum: float


@dataclass(frozen=True)
class Linear:
    """The equations on one grid, around pressures and films there. held : cells without a balance (nx, ny), where the
    pressure stays; stencil : see `loops`, in half the digits (`shortened`); far : pressure times film squared far away
    (nx, ny); tail_slope : derivative of the load outside the rectangle, less what accelerates, with H0; split : share
    (nx, ny) that leaves cells that are not full along x (`supply_loops`), None where no account is kept of them."""

    level: Level
    pressure: FloatArray
    film: FloatArray
    held: BoolArray
    stencil: HalfArray
    far: FloatArray
    tail_slope: float
    split: FloatArray | None

    @cached_property
    def far_slope(self) -> FloatArray:
        """Derivative of pressure - far pressure of the outermost cells with their film."""
        return np.where(self.level.border, 2 * self.far / self.film**3, 0.0)

    @cached_property
    def squeezed(self) -> FloatArray:
        """Derivative of pressure - far pressure of the outermost cells with H0, by the squeeze alone."""
        slope = self.level.problem.squeeze_slope
        return np.where(self.level.border & (self.far > 0), -slope / self.film**2, 0.0)

    @property
    def not_full(self) -> BoolArray:
        """Cells whose oil is carried on to those downstream."""
        return self.held

    @cached_property
    def kinds(self) -> NDArray[np.int8]:
        """Of relaxation, see `lines.relax`."""
        return self.flowing_kinds()

    def flowing_kinds(self) -> NDArray[np.int8]:
        """Of cells that have a balance."""
        free = ~(self.held | self.level.border)
        inside = free.copy()
        inside[1:-1, 1:-1] &= free[:-2, 1:-1] & free[2:, 1:-1] & free[1:-1, :-2] & free[1:-1, 2:]
        driven = np.zeros(self.level.shape)
        loops.own_flow(self.stencil, self.level.spacing, driven)
        problem, (dx, dy) = self.level.problem, self.level.spacing
        drag, storing = problem.drag, problem.storing
        wedge = (
            6 * (drag[0] / dx + drag[1] / dy + storing) * self.stencil[8] * self.stencil[9] * self.level.near[0, 0, 0]
        )
        spread = inside & (driven < SPREADING * wedge)
        return np.where(free, np.where(spread, 2, 1), 0).astype(np.int8)

    def applied(self, change: Change) -> tuple[FloatArray, float]:
        """Left side: balances (nx, ny), with zero for held cells, and the load."""
        level = self.level
        film = level.deflection(change.pressure) + change.datum
        out = self.balances(change.pressure, film)
        far = change.pressure + self.far_slope * film + self.squeezed * change.datum
        np.copyto(out, far, where=level.border)
        out[self.held] = 0.0
        return out, float(change.pressure.sum()) * level.cell + self.tail_slope * change.datum

    def balances(self, pressure: FloatArray, film: FloatArray) -> FloatArray:
        """Change of the balances of inner cells (nx, ny) with pressures and films."""
        level, out = self.level, np.zeros(self.level.shape)
        problem = level.problem
        loops.applied(self.stencil, level.spacing, problem.drag, problem.storing, pressure, film, out)
        if self.split is not None:
            supply_loops.carried(self.not_full, self.split, out)
        return out

    def relaxed(self, residual: FloatArray, back: bool) -> FloatArray:
        """Pressures that a sweep over lines adds, there or back; of oil that comes at an angle both go with it, the way
        back over lines along the other axis."""
        level, out = self.level, np.zeros(self.level.shape)
        problem = level.problem
        along_y = int(back and problem.drag[1] > 0)
        factors, near = (self._lines_across, level.near_across) if along_y else (self._lines, level.near)
        smooth = problem.heights is None
        lines.relax(
            factors, self.stencil, level.spacing, problem.drag, problem.storing, along_y, near, self.kinds, residual,
            back and not along_y, SMOOTH if smooth else ROUGH, smooth, out,
        )  # fmt: skip
        np.copyto(out, residual, where=level.border)
        out[self.held] = 0.0
        return out

    @cached_property
    def _lines(self) -> HalfArray:
        """Factors of the lines along x; half the digits are enough for what GMRES puts right."""
        return self._factorised(0, self.level.near)

    @cached_property
    def _lines_across(self) -> HalfArray:
        """Those of the lines along y."""
        return self._factorised(1, self.level.near_across)

    def _factorised(self, along_y: int, near: FloatArray) -> HalfArray:
        level, problem = self.level, self.level.problem
        factors = np.zeros((level.shape[1 - along_y], level.shape[along_y], lines.KEPT), np.float32)
        lines.factorise(self.stencil, level.spacing, problem.drag, problem.storing, along_y, near, self.kinds, factors)
        return factors

    @cached_property
    def coarser(self) -> Linear | None:
        """The same on the coarser grid, around mean pressures and films."""
        level, coarse = self.level, self.level.coarser
        if coarse is None:
            return None
        held = level.averaged(self.held.astype(float)) > 0.5
        pressure, film = level.averaged(self.pressure), level.averaged(self.film)
        stencil = flows(coarse, pressure, film)[1]
        split = None
        if self.split is not None:
            supply_loops.nothing_dragged(held, stencil)
            split = level.averaged(self.split)
        far = level.averaged(self.far)
        return Linear(coarse, pressure, film, held, shortened(stencil), far, self.tail_slope, split)

    def dense_rows(self, matrix: FloatArray | HalfArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Derivatives of the equations with pressures, films held, into a matrix (n, n) or more of zeros, on a grid
        small enough; cells and derivatives (n, 7) with their films."""
        level, n = self.level, self.film.size
        places, by_film = np.zeros((n, 7), np.int64), np.zeros((n, 7))
        problem = level.problem
        loops.fill_rows(self.stencil, level.spacing, problem.drag, problem.storing, matrix, places, by_film)
        index = np.flatnonzero(level.border)
        matrix[index, index] = 1.0
        places[index, 0], by_film[index, 0] = index, self.far_slope.ravel()[index]
        return places, by_film

    @cached_property
    def _factors(self) -> tuple[FloatArray | HalfArray, NDArray[np.int32], FloatArray]:
        """Of all equations, in half the digits where they only help a finer grid."""
        level, n = self.level, self.film.size
        matrix = np.zeros((n + 1, n + 1), np.float32 if level.part else np.float64)
        places, by_film = self.dense_rows(matrix)
        if level.deflections is not None:
            loops.add_deflected(places, by_film, level.deflections, matrix)
        matrix[:n, n] = by_film.sum(axis=1) + self.squeezed.ravel()
        matrix[n, :n] = level.cell
        matrix[n, n] = self.tail_slope
        held = np.flatnonzero(self.held.ravel())
        matrix[held] = 0.0
        matrix[:, held] = 0.0
        matrix[held, held] = 1.0
        # rows of one size: they are of different kinds
        scale = np.maximum(matrix.max(axis=1), -matrix.min(axis=1))
        scale[scale == 0] = 1.0  # where no cell is full the load has no equation
        matrix /= scale[:, None]
        with warnings.catch_warnings():  # of a singular matrix: nothing finite comes of it, and `solve` sees that
            warnings.simplefilter("ignore", LinAlgWarning)
            lu, pivots = lu_factor(matrix.T, overwrite_a=True, check_finite=False)
        return lu, pivots, scale

    def solved(self, residual: FloatArray, load: float) -> Change:
        """The solution, on a grid small enough."""
        lu, pivots, scale = self._factors
        right = (np.append(np.where(self.held, 0.0, residual).ravel(), load) / scale).astype(lu.dtype)
        found = lu_solve((lu, pivots), right, trans=1, check_finite=False).astype(np.float64)
        return Change(found[:-1].reshape(self.level.shape), float(found[-1]))

    def restricted(self, rest: FloatArray) -> FloatArray:
        """What is left of balances, on the coarser grid."""
        return self.level.averaged(rest)

    def cycle(self, residual: FloatArray, load: float) -> Change:
        """About the solution: one multigrid cycle from nothing, two sweeps before and two behind for heavy contacts
        and oil at an angle (half the cycles then, in five sixths of the time on 256 cells a side; light ones lose)."""
        coarse = self.coarser
        if coarse is None:
            return self.solved(residual, load)
        level = self.level
        problem = level.problem
        hard = problem.heights is None and (problem.load > LIGHT or problem.drag[1] > 0)
        sweeps = 2 if hard else 1
        pressure, rest, carried = np.zeros(level.shape), residual, 0.0
        for back in (False, True)[:sweeps]:
            pressure += self.relaxed(rest, back)
            done, carried = self.applied(Change(pressure, 0.0))
            rest = residual - done
        rest[level.border | self.held] = 0.0
        mean = self.restricted(rest)
        mean[coarse.level.border] = 0.0
        correction = coarse.cycle(mean, load - carried)
        fine = level.refined(correction.pressure)
        fine[self.held | level.border] = 0.0
        pressure += fine
        for back in (True, False)[:sweeps]:
            done, _ = self.applied(Change(pressure, correction.datum))
            pressure += self.relaxed(residual - done, back)
        return Change(pressure, correction.datum)


def flows(level: Level, pressure: FloatArray, film: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Flow through the faces (2, nx, ny) and its stencil (13, nx, ny), see `loops`; (12, nx, ny) of
    flooded contacts whose oil comes along x, where nothing is dragged along y."""
    problem = level.problem
    parts = 12 if problem.drag[1] == 0 and problem.layer is None else 13
    flow, stencil = np.zeros((2, *level.shape)), np.zeros((parts, *level.shape))
    oil = problem.oil(pressure)
    if problem.walls is None:
        loops.flows(pressure, film, oil, level.spacing, problem.drag, flow, stencil)
    else:
        walls = problem.walls.on(film)
        rough_flows(pressure, film, oil, walls, level.spacing, problem.drag, flow, stencil)
    return flow, stencil


def shortened(stencil: FloatArray) -> HalfArray:
    """Derivatives as `Linear` has them: a step's equations are solved to a thousandth, and what is right is judged by
    flows of all digits. Where a trial's oil hardly resists, they are the most that half the digits hold.
    """
    most = float(np.finfo(np.float32).max)
    half = np.empty(stencil.shape, np.float32)
    return np.clip(stencil, -most, most, out=half, casting="same_kind")


@dataclass(frozen=True)
class Solved:
    """A change, cycles spent, and the residual left over that at first."""

    change: Change
    cycles: int
    left: float


def solve(linear: Linear, right: FloatArray, load: float, weight: FloatArray, tolerance: float, most: int) -> Solved:
    """By flexible GMRES with cycles before it (Saad 1993); residuals weighted (nx, ny), the load over M."""
    level = linear.level
    if level.coarser is None:
        return Solved(linear.solved(right, load), 1, 0.0)
    total = level.problem.load

    def vector(rest: FloatArray, carried: float) -> FloatArray:
        return np.append((rest * weight).ravel(), carried / total)

    first = vector(right, load)
    size = float(np.linalg.norm(first))
    if size == 0:
        return Solved(Change(np.zeros(level.shape), 0.0), 0, 0.0)
    basis, steps = [(first / size).astype(np.float32)], []
    hessenberg = np.zeros((most + 1, most))
    wanted = np.zeros(most + 1)
    wanted[0] = size
    count, left = 0, 1.0
    y: FloatArray = np.zeros(0)
    while count < most and left > tolerance:
        v = basis[-1].astype(np.float64)
        step = linear.cycle(v[:-1].reshape(level.shape) / weight, float(v[-1]) * total)
        half = step.pressure.astype(np.float32)
        w: FloatArray = vector(*linear.applied(Change(half.astype(np.float64), step.datum)))
        if not np.isfinite(w).all():  # lines or a coarse grid without a solution: what there is must do
            break
        steps.append((half, step.datum))
        for k, b in enumerate(basis):
            hessenberg[k, count] = w @ b
            w -= hessenberg[k, count] * b
        hessenberg[count + 1, count] = np.linalg.norm(w)
        basis.append((w / hessenberg[count + 1, count]).astype(np.float32))
        count += 1
        h = hessenberg[: count + 1, :count]
        y = np.linalg.lstsq(h, wanted[: count + 1], rcond=None)[0].astype(np.float64)
        left = float(np.linalg.norm(wanted[: count + 1] - h @ y)) / size
    pressure, datum = np.zeros(level.shape), 0.0
    for share, (half, by) in zip(y, steps, strict=True):
        pressure += share * half
        datum += share * by
    return Solved(Change(pressure, datum), count, left)
