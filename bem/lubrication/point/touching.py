"""The equations of a Newton step of a point film whose surfaces touch, see `touching_newton`.

Where they touch, a cell has two unknowns, the whole pressure and the oil's, and two equations: the film is the least
one, and the balance of the oil. The oil's are eliminated by a sparse factorisation, so what is left has a pressure a
cell as a film without contact has, and the same cycles: lines relax where surfaces touch what is missing to the least
film (`lines`), coarser grids do not feel the oil there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.point import loops, supply_loops
from bem.lubrication.point.linear import BoolArray, Change, HalfArray, Linear, flows, shortened

IntArray = NDArray[np.int64]


@compiled
def _oil_rows(
    stencil: HalfArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    number: IntArray,
    split: FloatArray,
    wet: Any,
    carries: Any,
    at: IntArray,
    values: FloatArray,
) -> int:
    """Derivatives of the balances of numbered cells (number >= 0) with the oil's pressures in wet ones and with what
    those carry on that are not full, into rows and columns `at` (2, 9 n) and `values`; how many there are. The
    unknown of a cell that is not full is the change of its balance, which it passes on (`supply_loops.carried`)."""
    nx, ny = number.shape
    rows = np.zeros((2, 7))
    count = 0
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            n = number[i, j]
            if n < 0:
                continue
            loops.fill_row(stencil, spacing, drag, 0.0, 0, False, i, j, rows)
            for t in range(7):
                k = i + t - 2 if t < 4 else i
                m = j if t < 4 else j + (t - 6 if t < 6 else 1)
                if k >= 0 and m >= 0 and number[k, m] >= 0 and wet[k, m] and rows[0, t] != 0.0:
                    at[0, count], at[1, count], values[count] = n, number[k, m], rows[0, t]
                    count += 1
            if carries[i, j]:
                at[0, count], at[1, count], values[count] = n, n, -1.0
                count += 1
            if carries[i - 1, j] and number[i - 1, j] >= 0:
                at[0, count], at[1, count], values[count] = n, number[i - 1, j], split[i - 1, j]
                count += 1
            if carries[i, j - 1] and number[i, j - 1] >= 0 and split[i, j - 1] < 1.0:
                at[0, count], at[1, count], values[count] = n, number[i, j - 1], 1.0 - split[i, j - 1]
                count += 1
    return count


@dataclass(frozen=True)
class TouchingLinear(Linear):
    """The equations on one grid, around the oil's pressures and films. touching : cells (nx, ny) of the least film;
    dry : those of them whose oil stays at pressure zero. `held` are cells whose whole pressure stays."""

    touching: BoolArray
    dry: BoolArray
    coarse: bool = False

    @cached_property
    def scale(self) -> FloatArray:
        """From films (nx, ny) that are missing to balances of about the same share of what is dragged along."""
        drag, (dx, dy) = self.level.problem.drag, self.level.spacing
        return np.asarray(6 * (drag[0] / dx + drag[1] / dy) * self.stencil[8] / self.film)

    @cached_property
    def kinds(self) -> NDArray[np.int8]:
        """Of relaxation, see `lines.relax`."""
        level = self.level
        free = ~(self.held | level.border)
        inside = free.copy()
        inside[1:-1, 1:-1] &= free[:-2, 1:-1] & free[2:, 1:-1] & free[1:-1, :-2] & free[1:-1, 2:]
        kinds = self.flowing_kinds()
        touching = np.where(inside, 4, np.where(free, 3, 0))
        return np.where(self.touching, touching, kinds).astype(np.int8)

    @property
    def not_full(self) -> BoolArray:
        """Cells whose oil is carried on to those downstream."""
        return self.held | self.dry

    def relaxed(self, residual: FloatArray, back: bool) -> FloatArray:
        """Pressures that a sweep over lines adds."""
        return super().relaxed(np.where(self.touching, residual / self.scale, residual), back)

    @cached_property
    def _oil(self) -> tuple[SuperLU, BoolArray, BoolArray] | None:
        """Factors of what the oil's pressures where surfaces touch make of the balances there, those cells, and them
        with those that are not full and pass on what they get."""
        wet = self.touching & ~self.dry
        if self.coarse or not wet.any():
            return None
        level = self.level
        carries, split = np.zeros(level.shape, dtype=bool), np.ones(level.shape)
        if self.split is not None:
            carries, split = self.not_full & ~level.border, self.split
        some = wet | carries
        count = int(some.sum())
        number = np.full(level.shape, -1, dtype=np.int64)
        number[some] = np.arange(count)
        at, values = np.zeros((2, 10 * count), dtype=np.int64), np.zeros(10 * count)
        n = _oil_rows(self.stencil, level.spacing, level.problem.drag, number, split, wet, carries, at, values)
        matrix = csc_matrix((values[:n], (at[0, :n], at[1, :n])), shape=(count, count))
        return splu(matrix), wet, some

    def oil_change(self, balances: FloatArray) -> FloatArray:
        """Changes of the oil's pressure where surfaces touch (nx, ny) that make balances there vanish."""
        out = np.zeros(self.level.shape)
        if self._oil is not None:
            factors, wet, some = self._oil
            found = factors.solve(np.where(wet, -balances, 0.0)[some])
            out[some] = found
            out[~wet] = 0.0
        return out

    def answered(self, pressure: FloatArray, film: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Change of the balances (nx, ny) with pressures and films, and of the oil's pressures where surfaces touch,
        which keep the balances there."""
        oil = np.where(self.touching, 0.0, pressure)
        out = self.balances(oil, film)
        change = self.oil_change(out)
        if self._oil is not None:
            out = self.balances(oil + change, film)
        return out, change

    def applied(self, change: Change) -> tuple[FloatArray, float]:
        """Left side: balances or films (nx, ny), with zero for held cells, and the load."""
        level = self.level
        film = level.deflection(change.pressure) + change.datum
        out, _ = self.answered(change.pressure, film)
        np.copyto(out, self.scale * film, where=self.touching)
        np.copyto(out, change.pressure + self.far_slope * film, where=level.border)
        out[self.held] = 0.0
        return out, float(change.pressure.sum()) * level.cell + self.tail_slope * change.datum

    def restricted(self, rest: FloatArray) -> FloatArray:
        """Balances, and films where the coarser grid touches."""
        level, coarse = self.level, self.coarser
        assert isinstance(coarse, TouchingLinear)
        mean = level.averaged(np.where(self.touching, 0.0, rest))
        share = level.averaged(self.touching.astype(float))
        films = level.averaged(np.where(self.touching, rest / self.scale, 0.0)) / np.maximum(share, 0.5)
        return np.where(coarse.touching, films * coarse.scale, mean)

    @cached_property
    def coarser(self) -> TouchingLinear | None:
        """The same on the coarser grid."""
        level, coarse = self.level, self.level.coarser
        if coarse is None:
            return None
        held = level.averaged(self.held.astype(float)) > 0.5
        touching = level.averaged(self.touching.astype(float)) > 0.5
        pressure, film = level.averaged(self.pressure), level.averaged(self.film)
        stencil = flows(coarse, pressure, film)[1]
        far = level.averaged(self.far)
        split = None
        if self.split is not None:
            supply_loops.nothing_dragged(held, stencil)
            split = level.averaged(self.split)
        return TouchingLinear(
            coarse, pressure, film, held & ~touching, shortened(stencil), far, self.tail_slope, split,
            touching & ~coarse.border, np.zeros(coarse.shape, dtype=bool), True,
        )  # fmt: skip

    def dense_rows(self, matrix: FloatArray | HalfArray) -> tuple[IntArray, FloatArray]:
        """As `Linear`; of cells that touch the film."""
        places, by_film = super().dense_rows(matrix)
        touching = np.flatnonzero(self.touching.ravel())
        matrix[:, touching], matrix[touching], by_film[touching] = 0.0, 0.0, 0.0
        places[touching, 0], by_film[touching, 0] = touching, self.scale.ravel()[touching]
        return places, by_film
