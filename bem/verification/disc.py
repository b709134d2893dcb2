"""A disc of pressure or traction: cells under the mean pressure of each, through the operator and the stresses."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.kernels.loads import Load
from bem.materials import Body
from bem.stress import subsurface_stress
from bem.verification.patches import PointGrid, disc_means, free_grid, surface_displacement, window
from bem.verification.rows import Curve
from bem.verification.stored import STRESS_NAMES, StoredCase, StoredCurve, on_side

STEP = 1 / 80
"""Side of a cell over the radius. With 1/40 a stress beside the edge, where layers meet, was 2.3e-3 of the largest off,
with 1/80 a quarter of that and with 1/160 a sixteenth: the cells' own error, of the second order."""
GLASS = 9
"""Smaller cells by that factor (odd) around points at the surface or below the load's edge."""
WINDOW, NEAR = 0.15, 0.1625
"""How far on each side of a point they go, and of points how near: lengths, whatever the cells, as what a staircase of
cells does at the edge is told by their distance."""
REASON = (
    "cells of 1/80 of the radius, 1/160 over thin layers, smaller ones near points at the surface or at the load's edge"
)
STRESS = (1e-3, 1.5e-3)
"""Under pressure, under traction (whose direct stresses along the surface are logarithmic at the load's edge)."""
COUPLED = 7.5e-4
"""Displacements across the load are a few times smaller and bend sharply at its edge."""


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored disc."""
    tangential = case.problem == "disc-tangential"
    solution = Disc(case.body, case.parameters["pressure"], tangential=tangential, step=_step(case))
    found = []
    for curve in case.curves:
        curve = curve.only(_compared(case, curve))
        values = solution.values(curve)
        stress, across = curve.name.startswith("stress"), curve.name != _along(case)
        quantity = curve.name + (f" ({curve.side})" if curve.side else "")
        if curve.name == "tangential_displacement" and tangential:
            quantity += f", {curve.along.partition(', ')[2]}"
        allowance = STRESS[tangential] if stress else COUPLED if across else 2.5e-4
        found.append(curve.beside(quantity, values, allowance, REASON))
    return found


def _along(case: StoredCase) -> str:
    """The displacement along the load."""
    return "normal_displacement" if case.problem == "disc" else "tangential_displacement"


def _compared(case: StoredCase, curve: StoredCurve) -> NDArray[np.bool_]:
    """Which points of a curve are compared."""
    x, y, z = curve.coordinates.T
    if curve.name.startswith("stress"):
        return z > STEP / GLASS  # nearer to the surface than the smallest cell, shear is that of the cell's own edges
    if curve.name != _along(case) and case.parameters["pressure"] == "uniform":
        return np.abs(np.hypot(x, y) - 1) > 1e-9  # the slope jumps at the edge of the load, which the cells round
    return np.ones(x.size, dtype=bool)


def _step(case: StoredCase) -> float:
    """Half as wide over layers thinner than nine cells (with 4.5 to a soft one displacements are 0.4 % off), and on
    layers twenty times softer than their base, whose small shear across is 0.7 % off with 1/40.
    """
    body = case.body
    thinnest = min((layer.thickness for layer in body.layers), default=1.0)
    softest = min((layer.material.youngs_modulus for layer in body.layers), default=math.inf)
    fine = thinnest >= 9 * STEP and softest >= body.material.youngs_modulus / 20
    return STEP if fine else STEP / 2


class Disc:
    """bem's side: a grid for the surface, one for the stresses, and a magnifying glass.

    Where a point is nearer to the surface than a few cells, or on the surface nearer to the load's edge, the cells
    around it are taken away and replaced by GLASS times smaller ones: all of it linear, all of it the same operator.
    """

    def __init__(self, body: Body, profile: str, *, tangential: bool, step: float, glass: bool = True) -> None:
        self.body, self.profile, self.tangential, self.step, self.glass = body, profile, tangential, step, glass
        self.friction = 1.0 if tangential else 0.0
        self.planes: dict[float, FloatArray] = {}
        self.points: dict[tuple[float, float, float], FloatArray] = {}
        self.below = free_grid(step, (-1.2, 3.0), (-1.0, 1.0))
        self.pressure = disc_means(self.below, profile)

    def values(self, curve: StoredCurve) -> FloatArray:
        """The stored curve's points."""
        x, y, z = curve.coordinates.T
        if not curve.name.startswith("stress"):
            return self.displacement(curve.name, x, y)
        component = STRESS_NAMES.index(curve.name)
        x, y, z = on_side(self.body, curve)
        return np.array(
            [self.stress(*point)[component] for point in zip(x.tolist(), y.tolist(), z.tolist(), strict=True)]
        )

    def displacement(self, name: str, x: FloatArray, y: FloatArray) -> FloatArray:
        """Of the surface at points, through the operators."""
        load = Load.TANGENTIAL if self.tangential else Load.NORMAL

        def surface(where: PointGrid) -> FloatArray:
            return surface_displacement(name, where.grid, self.body, disc_means(where, self.profile), load)

        where = free_grid(self.step, (-1.0, max(1.0, float(x.max()))), (-1.0, max(1.0, float(y.max()))))
        values = surface(where)[where.at(x, y)]
        for i in self.near_edge(x, y):
            fine, coarse = self.windows((x[i], y[i]))
            for part, sign in ((fine, 1), (coarse, -1)):
                values[i] += sign * surface(part)[part.origin]
        return values

    def stress(self, x: float, y: float, z: float) -> FloatArray:
        """Six stresses at a point, through `subsurface_stress` plane by plane."""
        key = (x, y, z)
        if key not in self.points:
            if z not in self.planes:
                self.planes[z] = self.plane(self.below, self.pressure, z)
            values = self.planes[z][:, *self.below.at(np.array(x), np.array(y))].copy()
            if self.glass and z < NEAR:
                for part, sign in zip(self.windows((x, y)), (1, -1), strict=True):
                    values += sign * self.plane(part, disc_means(part, self.profile), z)[:, *part.origin]
            self.points[key] = values
        return self.points[key]

    def plane(self, where: PointGrid, pressure: FloatArray, depth: float) -> FloatArray:
        """(6, nx, ny) at a depth."""
        stress = subsurface_stress(pressure, where.grid, self.body, [depth], friction=self.friction)[:, 0]
        if self.tangential:
            stress = stress - subsurface_stress(pressure, where.grid, self.body, [depth])[:, 0]
        return stress

    def near_edge(self, x: FloatArray, y: FloatArray) -> list[int]:
        """Indices of points near the circle."""
        if not self.glass:
            return []
        return np.flatnonzero(np.abs(np.hypot(x, y) - 1) < NEAR + 1e-9).tolist()

    def windows(self, point: tuple[float, float]) -> tuple[PointGrid, PointGrid]:
        """Small cells around a point, and the cells they stand for."""
        half = round(WINDOW / self.step)
        return window(self.step / GLASS, half * GLASS + GLASS // 2, point), window(self.step, half, point)
