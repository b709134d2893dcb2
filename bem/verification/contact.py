"""One asperity solved as contact: sphere, cylinder and sinusoidal row through `solve_contact` and what it needs."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import ConvergenceError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body, Material, contact_modulus
from bem.stress import subsurface_stress, von_mises
from bem.verification.patches import PointGrid, free_grid
from bem.verification.rows import Curve
from bem.verification.stored import STRESS_NAMES, StoredCase, StoredCurve

SPHERE_STEP, LINE_STEP, ROW_CELLS = 1 / 120, 1 / 400, 2000
"""Cells: of the sphere and the cylinder over the Hertz length (where the contact is about as large), of the row in a
wavelength. Half as many left the edge of a sphere on a soft thin layer 2.9e-3 off, these 9e-4, twice as many 7e-4."""
EDGE_CELLS = 8
"""So many cells next to the edge say where it is; the outermost two, which know it only to a cell, do not."""
BEND, THIN = 1 / 8, 0.16
"""Over the thickness of the thinnest layer: how far from the edge p^2 is read; and the thickness below which cells of
lines are half as wide, so that EDGE_CELLS of them are about as long. Over a layer 41 times as stiff and 0.081 thick,
p^2 read over 4 % of the half-width put the edge 4e-4 too far out on any cells, and on the usual ones 1e-3."""
CELLS_TO_EDGE = 120
"""Cells over the radius where only scalars are asked for (sphere)."""
REASONS = {
    "sphere": "cells of about 1/120 of the radius; the edge, where p^2 falls to zero, is known to a tenth of a cell",
    "cylinder": "cells of about 1/400 of the half-width; the edge from the fall of p^2 towards it",
    "row": "2000 cells in a wavelength; the edge from the fall of p^2 towards it",
}
ALLOWANCE = {
    "sphere": {"contact_radius": 1.5e-3, "approach": 1e-3, "normal_displacement": 1e-3, "pressure": 2e-3},
    "cylinder": {"contact_radius": 5e-4, "normal_displacement": 2e-4, "pressure": 5e-4},
    "row": {"contact_radius": 5e-4, "normal_displacement": 2e-4, "pressure": 5e-4, "mean_gap": 2e-4},
}
STRESS_ALLOWANCE = {"sphere": 2e-3, "cylinder": 1e-3, "row": 1e-3}


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored contact."""
    shape = case.problem.removeprefix("contact-")
    contact = _Contact(case, shape)
    found = []
    for curve in case.curves:
        if curve.name == "von_mises":
            curve = replace(curve, error_bar=np.maximum(curve.error_bar, _of_components(case, curve)))
        kind = "pressure" if curve.name == "central_pressure" else curve.name
        allowance = ALLOWANCE[shape].get(kind, STRESS_ALLOWANCE[shape])
        found.append(curve.beside(curve.name, contact.values(curve), allowance, REASONS[shape]))
    return found


def _of_components(case: StoredCase, curve: StoredCurve) -> FloatArray:
    """What the error bars of the stresses at the same points may move the reference's von Mises stress by.

    It is a norm of the stress, so it moves by no more than the von Mises stress of what the stresses do. Its own bar
    follows from its values on three meshes, which at a point may agree by chance: in a row under a soft layer, 6.5e-4
    of the largest where the stresses' bars allow 2.6e-3, and 1.7e-3 was missing.
    """
    bars = {c.name: c.error_bar for c in case.curves if c.along == curve.along and c.name in STRESS_NAMES}
    xx, yy, zz, yz, xz, xy = (bars.get(name, np.zeros(curve.values.size)) for name in STRESS_NAMES)
    # of any signs: differences of two are at most their sum
    direct = ((xx + yy) ** 2 + (yy + zz) ** 2 + (zz + xx) ** 2) / 2
    return np.asarray(np.sqrt(direct + 3 * (yz**2 + xz**2 + xy**2)))


@dataclass(frozen=True)
class _Solved:
    """A solution, where it lives, and the half-width of the contact.

    bend : length over which a layer bends p^2 beside the edge.
    """

    where: PointGrid
    solution: ContactSolution
    bend: float = np.inf

    @property
    def line(self) -> tuple[FloatArray, FloatArray]:
        """x and pressure of the row of cells through the middle."""
        return self.where.axes[0], self.solution.pressure[:, self.where.origin[1]]

    @cached_property
    def squared(self) -> CubicSpline:
        """p^2 over x, smooth in the contact."""
        x, p = self.line
        inside = p > 0
        return CubicSpline(x[inside], p[inside] ** 2)

    def pressure(self, x: FloatArray) -> FloatArray:
        """At points in the contact."""
        return np.sqrt(self.squared(x))

    @property
    def edge(self) -> float:
        """Where p^2, smooth in the contact, falls to zero."""
        x, p, degree = *self.line, 2
        if self.row:
            x = (x + 0.5) % 1.0 - 0.5
        elif not any(self.where.grid.periodic):
            x = np.hypot(x[:, None], self.where.axes[1][None, :]).ravel()
            p, degree = self.solution.pressure.ravel(), 4  # more cells, and layers that bend the curve
        outer = float(np.abs(x[p > 0]).max())
        step = self.where.grid.spacing[0]
        count = max(EDGE_CELLS, min(0.04 * outer, self.bend) / step)
        ring = (p > 0) & (np.abs(x) > outer - count * step) & (np.abs(x) < outer - 1.5 * step)
        at = np.sin(np.pi * x) ** 2 if self.row else np.abs(x)
        roots = np.polynomial.Polynomial.fit(at[ring], p[ring] ** 2, degree).roots()
        aim = np.sin(np.pi * outer) ** 2 if self.row else outer
        edge = float(roots[np.argmin(np.abs(np.subtract(roots, aim)))].real)
        return float(np.arcsin(np.sqrt(edge)) / np.pi) if self.row else edge

    @property
    def row(self) -> bool:
        """Return True if it repeats along x."""
        return self.where.grid.periodic[0]


class _Contact:
    """bem's side: each load is solved once."""

    def __init__(self, case: StoredCase, shape: str) -> None:
        self.case, self.shape = case, shape
        indenter = case.parameters.get("indenter")
        self.body = case.body
        self.bodies: Body | tuple[Body, Body] = self.body
        other = None
        if indenter is not None:
            other = Material("indenter", youngs_modulus=indenter[0], poissons_ratio=indenter[1])
            self.bodies = (self.body, Body(other))
        self.modulus = contact_modulus(self.body.material, other)
        self.curvature = {"sphere": np.pi / (2 * self.modulus), "cylinder": 2 / self.modulus}.get(shape, 0.0)
        self.amplitude = 1 / (np.pi * self.modulus)
        self.solved: dict[float, _Solved] = {}
        self.planes: dict[tuple[float, float], FloatArray] = {}
        radii = next(curve for curve in case.curves if curve.name == "contact_radius")
        self.edges = dict(zip(radii.coordinates[:, 0].tolist(), radii.values.tolist(), strict=True))
        self.thinnest = min((layer.thickness for layer in self.body.layers), default=np.inf)
        self.detailed = {_load(curve.along) for curve in case.curves if "at load" in curve.along}

    def values(self, curve: StoredCurve) -> FloatArray:
        """The stored curve's points."""
        if curve.along == "load":
            return np.array([self.scalar(curve.name, load) for load in curve.coordinates[:, 0].tolist()])
        load = _load(curve.along)
        x, _, z = curve.coordinates.T
        if curve.name == "pressure":
            return self.solve(load).pressure(x)
        if curve.name == "normal_displacement":
            return self.displacement(load, x)
        return np.array([self.stress(curve.name, load, *point) for point in zip(x.tolist(), z.tolist(), strict=True)])

    def scalar(self, name: str, load: float) -> float:
        """A figure of one load."""
        solved = self.solve(load)
        if name == "contact_radius":
            return solved.edge
        if name == "central_pressure":
            return float(solved.solution.pressure[solved.where.origin])
        if name == "approach":
            return solved.solution.approach / self.curvature
        return float(np.mean(np.maximum(solved.solution.gap, 0))) / self.amplitude

    def solve(self, load: float) -> _Solved:
        """The contact at a load."""
        if load not in self.solved:
            where = self.grid(load)
            x, y = where.axes
            if self.shape == "sphere":
                gap, force = self.curvature / 2 * np.add.outer(x**2, y**2), load * 2 * np.pi / 3
            elif self.shape == "cylinder":
                gap = np.tile((self.curvature / 2 * x**2)[:, None], (1, y.size))
                force = load * np.pi / 2 * where.grid.lengths[1]
            else:
                gap = np.tile((self.amplitude * (1 - np.cos(2 * np.pi * x)))[:, None], (1, y.size))
                force = load * where.grid.lengths[0] * where.grid.lengths[1]
            solution = solve_contact(gap, displacement_operator(where.grid, self.bodies), load=force, tolerance=1e-9)
            if solution.status is not Status.CONVERGED:
                raise ConvergenceError(f"{self.case.name} at load {load:g}: {solution.status.message}")
            self.solved[load] = _Solved(where, solution, BEND * self.thinnest)
        return self.solved[load]

    def grid(self, load: float) -> PointGrid:
        """A grid a little wider than the contact, with the reference's points on it where stresses are asked for."""
        if self.shape == "row":
            return PointGrid(Grid((ROW_CELLS, 2), (1 / ROW_CELLS, 0.25), periodic=(True, True)), (0, 0))
        if self.shape == "cylinder":
            cell = LINE_STEP / (2 if self.thinnest < THIN else 1)
            step = self._on_points(cell, load) if load in self.detailed else cell * self.edges[load]
            half = int(np.ceil(1.1 * self.edges[load] / step)) + 2
            return PointGrid(Grid((2 * half + 1, 2), (step, 1.0), periodic=(False, True)), (half, 0))
        step = self._on_points(SPHERE_STEP, load) if load in self.detailed else self.edges[load] / CELLS_TO_EDGE
        reach = 1.1 * self.edges[load]
        return free_grid(step, (-reach, reach), (-reach, reach))

    def _on_points(self, step: float, load: float) -> float:
        """A cell with the reference's points among its multiples, finer where the contact is small beside Hertz'."""
        return step / max(1, round(1 / self.edges[load]))

    def extended(self, load: float, x: tuple[float, float]) -> tuple[PointGrid, FloatArray]:
        """The grid and the pressure, widened along x to reach the points."""
        solved = self.solve(load)
        where, pressure = solved.where, solved.solution.pressure
        if self.shape == "row":
            return where, pressure
        step = where.grid.spacing[0]
        before = max(where.origin[0], int(np.ceil(-x[0] / step - 1e-9)))
        after = max(where.grid.shape[0] - where.origin[0], int(np.ceil(x[1] / step - 1e-9)) + 1)
        grid = Grid((before + after, where.grid.shape[1]), where.grid.spacing, periodic=where.grid.periodic)
        wide = np.zeros(grid.shape)
        start = before - where.origin[0]
        wide[start : start + where.grid.shape[0]] = pressure
        return PointGrid(grid, (before, where.origin[1])), wide

    def displacement(self, load: float, x: FloatArray) -> FloatArray:
        """Of the body alone."""
        where, pressure = self.extended(load, (0.0, float(x.max())))
        field = displacement_operator(where.grid, self.body)(pressure)
        values = field[where.at(x, np.zeros(x.size))]
        if self.shape == "sphere":
            return values / self.curvature
        scale = self.amplitude if self.shape == "row" else 1 / self.modulus
        return (values - field[where.origin]) / scale

    def stress(self, name: str, load: float, x: float, z: float) -> float:
        """A stress below, through `subsurface_stress`."""
        where, pressure = self.extended(load, (0.0, 1.5))
        if (load, z) not in self.planes:
            self.planes[load, z] = subsurface_stress(pressure, where.grid, self.body, [z])[:, 0]
        i, j = where.at(np.array(x), np.array(0.0))
        values = self.planes[load, z][:, i, j]
        return float(von_mises(values)) if name == "von_mises" else float(values[STRESS_NAMES.index(name)])


def _load(along: str) -> float:
    """The load in "... at load 0.5"."""
    match = re.search(r"at load ([\d.eE+-]+)$", along)
    assert match is not None
    return float(match[1])
