"""A uniformly loaded rectangle in three dimensions: one kernel at a point, and cells through operator and stresses."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import Load
from bem.kernels.subsurface import rectangle_stress
from bem.stress import subsurface_stress
from bem.verification.patches import DISPLACEMENTS, PointGrid, free_grid, surface_displacement
from bem.verification.rows import Curve
from bem.verification.stored import STRESS_NAMES, StoredCase, StoredCurve, on_side

STEP = 1 / 80
"""Side of a cell over the half-length."""
EXACT = "closed form; what is left is for error bars that three meshes in three dimensions estimate to a factor of two"
REASON = "cells of 1/80 of the half-length, halves along the rectangle's edges"


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored rectangle: the kernels at the points, and what production does with cells."""
    load = Load.NORMAL if case.parameters["load"] == "normal" else Load.TANGENTIAL
    sides = (2.0, 2.0 * case.parameters["width"])
    cells, bare = _Cells(case), case.body.homogeneous
    found = []
    for whole in case.curves:
        # cells have their middles at most points
        along_x, along_y = whole.coordinates[:, 0] / STEP, whole.coordinates[:, 1] / STEP
        curve = whole.only(np.maximum(np.abs(along_x - np.rint(along_x)), np.abs(along_y - np.rint(along_y))) < 1e-6)
        x, y, z = curve.coordinates.T
        name = curve.name + (f" ({curve.side})" if curve.side else "")
        pairs: list[tuple[str, FloatArray, float, str]] = []
        if curve.name.startswith("stress"):
            component = STRESS_NAMES.index(curve.name)
            pairs.append((name, cells.stress(curve, component), 2e-3 if load is Load.NORMAL else 3e-3, REASON))
            if bare:
                exact = rectangle_stress(x, y, z, sides, case.body.material.poissons_ratio, load)[component]
                pairs.append((name + ", kernel", exact, 2e-3, EXACT))
        else:
            pairs.append((name, cells.displacement(curve), 1e-3, REASON))
            if bare:
                field = rectangle_displacement(x, y, 0.0, sides, case.body.material, load)
                exact = field[DISPLACEMENTS.index(curve.name)]
                pairs.append((name + ", kernel", exact, 1e-3, EXACT))
        found += [
            Curve(name, curve.along, curve.unit, curve.coordinates, values, curve.values, curve.error_bar, share, why)
            for name, values, share, why in pairs
        ]
    return found


class _Cells:
    """The rectangle on a grid whose cells have their middles at the reference's points."""

    def __init__(self, case: StoredCase) -> None:
        self.body, self.width = case.body, case.parameters["width"]
        self.tangential = case.parameters["load"] == "tangential"
        self.planes: dict[float, FloatArray] = {}
        self.below = free_grid(STEP, (-1.0, 1.5), (-self.width, self.width))

    def pressure(self, where: PointGrid) -> FloatArray:
        """Share of each cell that is loaded."""
        x, y = (
            np.clip(np.minimum(at + STEP / 2, half) - np.maximum(at - STEP / 2, -half), 0, None) / STEP
            for at, half in zip(where.axes, (1.0, self.width), strict=True)
        )
        return np.outer(x, y)

    def displacement(self, curve: StoredCurve) -> FloatArray:
        """Through the operator."""
        x, y, _ = curve.coordinates.T
        where = free_grid(STEP, (-1.0, max(1.0, x.max())), (-self.width, max(self.width, y.max())))
        load = Load.TANGENTIAL if self.tangential else Load.NORMAL
        return surface_displacement(curve.name, where.grid, self.body, self.pressure(where), load)[where.at(x, y)]

    def stress(self, curve: StoredCurve, component: int) -> FloatArray:
        """Through `subsurface_stress`."""
        x, y, z = on_side(self.body, curve)
        pressure = self.pressure(self.below)
        for depth in set(z.tolist()) - set(self.planes):
            plane = subsurface_stress(pressure, self.below.grid, self.body, [depth], friction=float(self.tangential))
            if self.tangential:
                plane = plane - subsurface_stress(pressure, self.below.grid, self.body, [depth])
            self.planes[depth] = plane[:, 0]
        i, j = self.below.at(x, y)
        return np.array([self.planes[d][component, a, b] for a, b, d in zip(i, j, z.tolist(), strict=True)])
