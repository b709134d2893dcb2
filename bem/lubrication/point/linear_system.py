"""The linear system of a Newton step of a point film, and its solution by GMRES with multigrid cycles.

Unknowns are the changes of the pressures of free cells and of H0. Equations are the balances of inner free cells, the
far pressure of outermost cells, and the load.

In contact a cell has two unknowns, the whole pressure and the oil's, and two equations: the film is the least one, and
the balance of the oil. The oil's pressures are eliminated by a sparse factorisation, so one pressure a cell is left, as
without contact, and the same cycles serve: lines relax the film's residual in contact (`line_relaxation`), and coarser
grids do not feel the oil there.

1. Preconditioner: one V-cycle of multigrid (`NewtonSystem.cycle`), with line relaxation as the smoother, on the grids
   of `grid`; the coarsest grid is solved directly, together with H0 and the load (Venner and Lubrecht, *Multilevel
   methods in lubrication*, 2000).
2. Solver: flexible GMRES (Saad 1993), since a cycle is no linear map in single precision (`solve_step`).

Derivatives, factors and Krylov vectors are kept in single precision: a step is solved to a thousandth, and films are
judged by residuals in double precision.

Cost of a cycle: two to four sweeps and as many convolutions on the finest grid, 4/3 of that with all grids.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.point import cavitation, line_relaxation, reynolds
from bem.lubrication.point.grid import LIGHT_LOAD, GridLevel

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
HalfArray = NDArray[np.float32]

DISTRIBUTED_BELOW = 1.0
"""Ratio of Poiseuille conductance to Couette flow by deflection below which a cell has distributed changes."""
SMOOTH_DAMPING, ROUGH_DAMPING = (1.0, 1.0), (0.9, 0.7)
"""Damping of changes of a cell alone and of distributed changes, of smooth and of rough surfaces. Lines of rough
surfaces do not feel the films that earlier lines changed (`line_relaxation.relax`): with them as many random rough
balls have a film, but others."""


@dataclass(frozen=True)
class Change:
    """Change of the pressures (nx, ny) and of H0."""

    pressure: FloatArray
    separation: float


@compiled
def _fill_oil_jacobian(
    derivatives: HalfArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    number: IntArray,
    split: FloatArray,
    wet: Any,
    ruptured: Any,
    at: IntArray,
    values: FloatArray,
) -> int:
    """Assemble the Jacobian of the balances of numbered cells (number >= 0) and return its number of entries.

    Unknowns are the oil's pressures in wet cells and, in ruptured cells, the change of the balance, which they pass on
    (`cavitation.pass_downstream`). Rows and columns go to `at` (2, 10 n), entries to `values`.
    """
    nx, ny = number.shape
    rows = np.zeros((2, 7))
    count = 0
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            n = number[i, j]
            if n < 0:
                continue
            reynolds.jacobian_row(derivatives, spacing, entrainment, storage_rate, 0, False, i, j, rows)
            for t in range(7):
                k = i + t - 2 if t < 4 else i
                m = j if t < 4 else j + (t - 6 if t < 6 else 1)
                if k >= 0 and m >= 0 and number[k, m] >= 0 and wet[k, m] and rows[0, t] != 0.0:
                    at[0, count], at[1, count], values[count] = n, number[k, m], rows[0, t]
                    count += 1
            if ruptured[i, j]:
                at[0, count], at[1, count], values[count] = n, n, -1.0
                count += 1
            if ruptured[i - 1, j] and number[i - 1, j] >= 0:
                at[0, count], at[1, count], values[count] = n, number[i - 1, j], split[i - 1, j]
                count += 1
            if ruptured[i, j - 1] and number[i, j - 1] >= 0 and split[i, j - 1] < 1.0:
                at[0, count], at[1, count], values[count] = n, number[i, j - 1], 1.0 - split[i, j - 1]
                count += 1
    return count


@dataclass(frozen=True)
class NewtonSystem:
    """The equations of a Newton step on one grid, around a state.

    level : the grid.
    pressure, film : (nx, ny) of the oil, around which the equations are linear.
    derivatives : of the flux, see `reynolds`, in single precision.
    ruptured : (nx, ny) cells where the oil has neither pressure nor balance.
    contact : (nx, ny) cells where surfaces touch: the film is the least one.
    far : (nx, ny) far pressure times h^2.
    load_slope : derivative of load outside the rectangle less inertia with H0.
    split : (nx, ny) share of a ruptured cell's outflow along x (`cavitation`); None with Swift and Stieber's condition.
    eliminates_oil : whether the oil's pressures in contact follow; not on coarser grids.
    """

    level: GridLevel
    pressure: FloatArray
    film: FloatArray
    derivatives: HalfArray
    ruptured: BoolArray
    contact: BoolArray
    far: FloatArray
    load_slope: float
    split: FloatArray | None
    eliminates_oil: bool = True

    @cached_property
    def touches(self) -> bool:
        """Return True if surfaces touch anywhere."""
        return bool(self.contact.any())

    @cached_property
    def fixed(self) -> BoolArray:
        """Cells (nx, ny) whose whole pressure has no equation: ruptured and not in contact."""
        return self.ruptured & ~self.contact

    @cached_property
    def far_slope(self) -> FloatArray:
        """Derivative of pressure less far pressure of outermost cells with their film."""
        return np.where(self.level.boundary, 2 * self.far / self.film**3, 0.0)

    @cached_property
    def squeeze_slope(self) -> FloatArray:
        """Derivative of pressure less far pressure of outermost cells with H0, by the squeeze alone."""
        slope = self.level.problem.squeeze_slope
        return np.where(self.level.boundary & (self.far > 0), -slope / self.film**2, 0.0)

    @cached_property
    def film_scale(self) -> FloatArray:
        """Factor (nx, ny) from a film's residual to a balance of about the same relative size."""
        problem, (dx, dy) = self.level.problem, self.level.spacing
        carried = problem.entrainment[0] / dx + problem.entrainment[1] / dy + problem.storage_rate
        return np.asarray(6 * carried * self.derivatives[8] / self.film)

    @cached_property
    def kinds(self) -> NDArray[np.int8]:
        """Kinds of cells (nx, ny) for the relaxation, see `line_relaxation`."""
        level, problem, (dx, dy) = self.level, self.level.problem, self.level.spacing
        free = ~(self.fixed | level.boundary)
        inside = free.copy()
        inside[1:-1, 1:-1] &= free[:-2, 1:-1] & free[2:, 1:-1] & free[1:-1, :-2] & free[1:-1, 2:]
        poiseuille = np.zeros(level.shape)
        reynolds.poiseuille_diagonal(self.derivatives, level.spacing, poiseuille)
        couette = (
            6
            * (problem.entrainment[0] / dx + problem.entrainment[1] / dy + problem.storage_rate)
            * self.derivatives[8]
            * self.derivatives[9]
            * level.near_influence[0, 0, 0]
        )
        distributed = inside & (poiseuille < DISTRIBUTED_BELOW * couette)
        own = np.where(distributed, line_relaxation.DISTRIBUTED, line_relaxation.OWN)
        kinds = np.where(free, own, line_relaxation.FIXED)
        if self.touches:
            own = np.where(inside, line_relaxation.CONTACT_DISTRIBUTED, line_relaxation.CONTACT)
            kinds = np.where(self.contact, np.where(free, own, line_relaxation.FIXED), kinds)
        return kinds.astype(np.int8)

    # ---- the matrix

    def balance_change(self, pressure: FloatArray, film: FloatArray) -> FloatArray:
        """Return the change of the balances of inner cells (nx, ny) under changes of oil pressure and film."""
        level, out = self.level, np.zeros(self.level.shape)
        problem = level.problem
        reynolds.apply_jacobian(
            self.derivatives, level.spacing, problem.entrainment, problem.storage_rate, pressure, film, out
        )
        if self.split is not None:
            cavitation.pass_downstream(self.ruptured, self.split, out)
        return out

    def eliminate_oil(self, pressure: FloatArray, film: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the change of balances, and of the oil's pressure in contact that keeps the balances there (nx, ny).

        pressure, film : changes of the whole pressure and of the film.
        """
        if not self.touches:
            return self.balance_change(pressure, film), np.zeros(self.level.shape)
        oil = np.where(self.contact, 0.0, pressure)
        out = self.balance_change(oil, film)
        change = self.oil_change(out)
        if self._oil_factors is not None:
            out = self.balance_change(oil + change, film)
        return out, change

    def apply(self, change: Change) -> tuple[FloatArray, float]:
        """Return the product of the matrix and a change: balances or films (nx, ny), zero for fixed cells, and load."""
        level = self.level
        film = level.deflection(change.pressure) + change.separation
        out, _ = self.eliminate_oil(change.pressure, film)
        if self.touches:
            np.copyto(out, self.film_scale * film, where=self.contact)
        far = change.pressure + self.far_slope * film + self.squeeze_slope * change.separation
        np.copyto(out, far, where=level.boundary)
        out[self.fixed] = 0.0
        return out, float(change.pressure.sum()) * level.cell_area + self.load_slope * change.separation

    @cached_property
    def _oil_factors(self) -> tuple[SuperLU, BoolArray, BoolArray] | None:
        """Factors of the balances in contact by the oil's pressures there; the wet cells; the cells with an unknown.

        Ruptured cells, which pass on their inflow, are among the unknowns.
        """
        wet = self.contact & ~self.ruptured
        if not self.eliminates_oil or not wet.any():
            return None
        level, problem = self.level, self.level.problem
        passing, split = np.zeros(level.shape, dtype=bool), np.ones(level.shape)
        if self.split is not None:
            passing, split = self.ruptured & ~level.boundary, self.split
        unknown = wet | passing
        count = int(unknown.sum())
        number = np.full(level.shape, -1, dtype=np.int64)
        number[unknown] = np.arange(count)
        at, values = np.zeros((2, 10 * count), dtype=np.int64), np.zeros(10 * count)
        n = _fill_oil_jacobian(
            self.derivatives, level.spacing, problem.entrainment, problem.storage_rate, number, split, wet, passing,
            at, values,
        )  # fmt: skip
        matrix = csc_matrix((values[:n], (at[0, :n], at[1, :n])), shape=(count, count))
        return splu(matrix), wet, unknown

    def oil_change(self, balances: FloatArray) -> FloatArray:
        """Return the change of the oil's pressure in contact (nx, ny) that makes the balances there vanish."""
        out = np.zeros(self.level.shape)
        if self.touches and self._oil_factors is not None:
            factors, wet, unknown = self._oil_factors
            out[unknown] = factors.solve(np.where(wet, -balances, 0.0)[unknown])
            out[~wet] = 0.0
        return out

    # ---- the smoother

    def relax_lines(self, residual: FloatArray, backward: bool) -> FloatArray:
        """Return the change of pressure (nx, ny) by one sweep over lines, forward or backward.

        With oblique entrainment both sweeps go with the flow, the second over lines along y.
        """
        level, out = self.level, np.zeros(self.level.shape)
        problem = level.problem
        if self.touches:
            residual = np.where(self.contact, residual / self.film_scale, residual)
        along_y = int(backward and problem.entrainment[1] > 0)
        factors = self._lines_along_y if along_y else self._lines_along_x
        near = level.near_influence_across if along_y else level.near_influence
        smooth = problem.heights is None
        line_relaxation.relax(
            factors, self.derivatives, level.spacing, problem.entrainment, problem.storage_rate, along_y, near,
            self.kinds, residual, backward and not along_y, SMOOTH_DAMPING if smooth else ROUGH_DAMPING, smooth, out,
        )  # fmt: skip
        np.copyto(out, residual, where=level.boundary)
        out[self.fixed] = 0.0
        return out

    @cached_property
    def _lines_along_x(self) -> HalfArray:
        return self._factorise_lines(0, self.level.near_influence)

    @cached_property
    def _lines_along_y(self) -> HalfArray:
        return self._factorise_lines(1, self.level.near_influence_across)

    def _factorise_lines(self, along_y: int, near: FloatArray) -> HalfArray:
        level, problem = self.level, self.level.problem
        factors = np.zeros((level.shape[1 - along_y], level.shape[along_y], line_relaxation.FACTORS), np.float32)
        line_relaxation.factorise(
            self.derivatives, level.spacing, problem.entrainment, problem.storage_rate, along_y, near, self.kinds,
            factors,
        )  # fmt: skip
        return factors

    # ---- coarser grids

    @cached_property
    def coarser(self) -> NewtonSystem | None:
        """The system on the coarser grid, around mean pressures and films; None on the coarsest."""
        level, coarse = self.level, self.level.coarser
        if coarse is None:
            return None
        fixed = level.restrict(self.fixed.astype(float)) > 0.5
        contact = level.restrict(self.contact.astype(float)) > 0.5 if self.touches else np.zeros(coarse.shape, bool)
        pressure, film = level.restrict(self.pressure), level.restrict(self.film)
        derivatives = coarse.flux(pressure, film)[1]
        split = None
        if self.split is not None:
            cavitation.remove_couette(fixed, derivatives)
            split = level.restrict(self.split)
        far = level.restrict(self.far)
        return NewtonSystem(
            coarse, pressure, film, to_single_precision(derivatives), fixed & ~contact, contact & ~coarse.boundary,
            far, self.load_slope, split, eliminates_oil=False,
        )  # fmt: skip

    def restrict(self, residual: FloatArray) -> FloatArray:
        """Return a residual (nx, ny) on the coarser grid: balances, and films where the coarser grid has contact."""
        level, coarse = self.level, self.coarser
        assert coarse is not None
        if not self.touches:
            return level.restrict(residual)
        balances = level.restrict(np.where(self.contact, 0.0, residual))
        share = level.restrict(self.contact.astype(float))
        films = level.restrict(np.where(self.contact, residual / self.film_scale, 0.0)) / np.maximum(share, 0.5)
        return np.where(coarse.contact, films * coarse.film_scale, balances)

    def cycle(self, residual: FloatArray, load: float) -> Change:
        """Return the change by one multigrid V-cycle from zero.

        Two sweeps before and two after the coarse-grid correction for heavily loaded contacts and oblique entrainment
        (half the cycles then, in five sixths of the time on 256 cells a side), one and one for others.
        """
        coarse = self.coarser
        if coarse is None:
            return self.solve_directly(residual, load)
        level = self.level
        problem = level.problem
        hard = problem.heights is None and (problem.load > LIGHT_LOAD or problem.entrainment[1] > 0)
        sweeps = 2 if hard else 1
        pressure, rest, carried = np.zeros(level.shape), residual, 0.0
        for backward in (False, True)[:sweeps]:
            pressure += self.relax_lines(rest, backward)
            product, carried = self.apply(Change(pressure, 0.0))
            rest = residual - product
        rest[level.boundary | self.fixed] = 0.0
        coarse_residual = self.restrict(rest)
        coarse_residual[coarse.level.boundary] = 0.0
        correction = coarse.cycle(coarse_residual, load - carried)
        fine = level.prolong(correction.pressure)
        fine[self.fixed | level.boundary] = 0.0
        pressure += fine
        for backward in (True, False)[:sweeps]:
            product, _ = self.apply(Change(pressure, correction.separation))
            pressure += self.relax_lines(residual - product, backward)
        return Change(pressure, correction.separation)

    # ---- direct solution

    def fill_dense_rows(self, matrix: FloatArray | HalfArray) -> tuple[IntArray, FloatArray]:
        """Assemble the derivatives of all equations with pressures, films fixed, into zeros (n, n) or larger.

        Returns
        -------
        Columns and derivatives (n, 7) with the films of those cells.
        """
        level, n = self.level, self.film.size
        columns, by_film = np.zeros((n, 7), np.int64), np.zeros((n, 7))
        problem = level.problem
        reynolds.fill_jacobian(
            self.derivatives, level.spacing, problem.entrainment, problem.storage_rate, matrix, columns, by_film
        )
        index = np.flatnonzero(level.boundary)
        matrix[index, index] = 1.0
        columns[index, 0], by_film[index, 0] = index, self.far_slope.ravel()[index]
        if self.touches:
            contact = np.flatnonzero(self.contact.ravel())
            matrix[:, contact], matrix[contact], by_film[contact] = 0.0, 0.0, 0.0
            columns[contact, 0], by_film[contact, 0] = contact, self.film_scale.ravel()[contact]
        return columns, by_film

    @cached_property
    def _dense_factors(self) -> tuple[FloatArray | HalfArray, NDArray[np.int32], FloatArray]:
        """LU factors of all equations, pivots and row scales; in single precision on a coarse grid."""
        level, n = self.level, self.film.size
        matrix = np.zeros((n + 1, n + 1), np.float32 if level.is_coarse else np.float64)
        columns, by_film = self.fill_dense_rows(matrix)
        if level.influence is not None:
            reynolds.add_deflection(columns, by_film, level.influence, matrix)
        matrix[:n, n] = by_film.sum(axis=1) + self.squeeze_slope.ravel()
        matrix[n, :n] = level.cell_area
        matrix[n, n] = self.load_slope
        fixed = np.flatnonzero(self.fixed.ravel())
        matrix[fixed] = 0.0
        matrix[:, fixed] = 0.0
        matrix[fixed, fixed] = 1.0
        # rows of one size: equations of different kinds
        scale = np.maximum(matrix.max(axis=1), -matrix.min(axis=1))
        scale[scale == 0] = 1.0  # where no cell is full the load has no equation
        matrix /= scale[:, None]
        with warnings.catch_warnings():  # a singular matrix gives no finite solution, which `solve_step` detects
            warnings.simplefilter("ignore", LinAlgWarning)
            lu, pivots = lu_factor(matrix.T, overwrite_a=True, check_finite=False)
        return lu, pivots, scale

    def solve_directly(self, residual: FloatArray, load: float) -> Change:
        """Return the solution by LU factors, on a grid small enough."""
        lu, pivots, scale = self._dense_factors
        right = (np.append(np.where(self.fixed, 0.0, residual).ravel(), load) / scale).astype(lu.dtype)
        solution = lu_solve((lu, pivots), right, trans=1, check_finite=False).astype(np.float64)
        return Change(solution[:-1].reshape(self.level.shape), float(solution[-1]))


def to_single_precision(derivatives: FloatArray) -> HalfArray:
    """Return derivatives in single precision, limited to its range.

    A trial state may hold oil that hardly resists; infinite derivatives would make the next product not a number.
    """
    most = float(np.finfo(np.float32).max)
    half = np.empty(derivatives.shape, np.float32)
    return np.clip(derivatives, -most, most, out=half, casting="same_kind")


@dataclass(frozen=True)
class StepSolution:
    """Solution of the linear system of a Newton step.

    change : of pressures and H0.
    cycles : multigrid cycles.
    residual : 2-norm of the weighted residual over that at first.
    """

    change: Change
    cycles: int
    residual: float


def solve_step(
    system: NewtonSystem, right: FloatArray, load: float, weight: FloatArray, tolerance: float, most: int
) -> StepSolution:
    """Solve a system by flexible GMRES, preconditioned by one multigrid cycle (Saad 1993).

    Parameters
    ----------
    system : the equations.
    right, load : right-hand side (nx, ny) of cells, and that of the load.
    weight : (nx, ny) weights of the residuals of cells; that of the load is 1/M.
    tolerance : reduction of the weighted residual at which to stop.
    most : largest number of cycles.
    """
    level = system.level
    if level.coarser is None:
        return StepSolution(system.solve_directly(right, load), 1, 0.0)
    total = level.problem.load

    def weighted(residual: FloatArray, carried: float) -> FloatArray:
        return np.append((residual * weight).ravel(), carried / total)

    first = weighted(right, load)
    size = float(np.linalg.norm(first))
    if size == 0:
        return StepSolution(Change(np.zeros(level.shape), 0.0), 0, 0.0)
    basis, images = [(first / size).astype(np.float32)], []
    hessenberg = np.zeros((most + 1, most))
    target = np.zeros(most + 1)
    target[0] = size
    count, left = 0, 1.0
    y: FloatArray = np.zeros(0)
    while count < most and left > tolerance:
        v = basis[-1].astype(np.float64)
        image = system.cycle(v[:-1].reshape(level.shape) / weight, float(v[-1]) * total)
        half = image.pressure.astype(np.float32)
        w: FloatArray = weighted(*system.apply(Change(half.astype(np.float64), image.separation)))
        if not np.isfinite(w).all():  # a singular line or coarse grid: return the solution so far
            break
        images.append((half, image.separation))
        for k, b in enumerate(basis):
            hessenberg[k, count] = w @ b
            w -= hessenberg[k, count] * b
        hessenberg[count + 1, count] = np.linalg.norm(w)
        basis.append((w / hessenberg[count + 1, count]).astype(np.float32))
        count += 1
        h = hessenberg[: count + 1, :count]
        y = np.linalg.lstsq(h, target[: count + 1], rcond=None)[0].astype(np.float64)
        left = float(np.linalg.norm(target[: count + 1] - h @ y)) / size
    pressure, separation = np.zeros(level.shape), 0.0
    for factor, (half, by) in zip(y, images, strict=True):
        pressure += factor * half
        separation += factor * by
    return StepSolution(Change(pressure, separation), count, left)
