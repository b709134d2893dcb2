"""A loaded strip, plane strain: grids that repeat along the strip, and the closed kernels of the half-plane.

Traction along the strip (anti-plane) is a traction along x on a strip along x: the other semi-periodic grid.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kernels.half_plane import strip_displacement, strip_stress
from bem.kernels.loads import Load
from bem.stress import subsurface_stress
from bem.verification.patches import surface_displacement
from bem.verification.rows import CLOSED_FORM, Curve
from bem.verification.stored import STRESS_NAMES, StoredCase, StoredCurve, on_side

STEP = 1 / 120
"""Side of a cell over the half-width."""
ROWS = 2
"""Cells in a period along the strip; the load does not vary there."""
ACROSS = 20
"""Least cells over the thinnest layer: with six over a soft one its small shear is 10 % off, of second order."""
REASON = "cells of 1/120 of the half-width, 1/20 of the thinnest layer; halves at the strip's edges"
DATUM = 4.0
ANTIPLANE = (1, 0, 2, 4, 3, 5)
"""Stresses of the reference (x across, y along the strip) in bem's axes exchanged: yz is xz."""


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored strip."""
    found = []
    load = case.parameters["load"]
    thinnest = min((layer.thickness for layer in case.body.layers), default=1.0)
    solution = Strip(case, STEP / math.ceil(max(1.0, ACROSS * STEP / thinnest)))
    for stored in case.curves:
        curve = stored
        across = (curve.name == "normal_displacement") != (load == "normal")
        if across and not curve.name.startswith("stress"):
            # the slope jumps at the edge of the load, which cells (and elements) round
            curve = curve.only(np.abs(curve.coordinates[:, 0] - 1) > 1e-9)
        quantity = curve.name + (f" ({curve.side})" if curve.side else "")
        allowance = 1.5e-3 if curve.name.startswith("stress") else 5e-4
        found.append(curve.beside(quantity, solution.values(curve), allowance, REASON))
        if case.body.homogeneous and load != "antiplane":
            closed = _closed(case, curve)
            if closed is not None:
                found.append(curve.beside(f"{quantity}, half-plane kernel", closed, 1e-5, CLOSED_FORM))
    return found


class Strip:
    """bem's side through the production path; each depth is computed once."""

    def __init__(self, case: StoredCase, step: float) -> None:
        self.body, self.load, self.step = case.body, case.parameters["load"], step
        self.planes: dict[float, FloatArray] = {}

    def across(self, reach: float) -> tuple[Grid, FloatArray, FloatArray]:
        """A grid from -1 to `reach` across the strip, the pressure on it and the middles of its cells."""
        before = round(1 / self.step)
        count = before + int(np.ceil(reach / self.step - 1e-9)) + 1
        x: FloatArray = np.asarray((np.arange(count) - before) * self.step, dtype=np.float64)
        cover = np.clip(np.minimum(x + self.step / 2, 1) - np.maximum(x - self.step / 2, -1), 0, None) / self.step
        if self.load == "antiplane":
            grid = Grid((ROWS, count), (1.0, self.step), periodic=(True, False))
            return grid, np.tile(cover, (ROWS, 1)), x
        grid = Grid((count, ROWS), (self.step, 1.0), periodic=(False, True))
        return grid, np.tile(cover[:, None], (1, ROWS)), x

    def values(self, curve: StoredCurve) -> FloatArray:
        """The stored curve's points."""
        x, _, z = curve.coordinates.T
        if not curve.name.startswith("stress"):
            return self.displacement(x, curve.name)
        x, _, z = on_side(self.body, curve)
        component = STRESS_NAMES.index(curve.name)
        return np.array([self.stress(component, *point) for point in zip(x.tolist(), z.tolist(), strict=True)])

    def displacement(self, x: FloatArray, name: str) -> FloatArray:
        """Of the surface: along the load less that at the datum."""
        grid, given, at = self.across(max(DATUM, float(x.max())))
        load = Load.NORMAL if self.load == "normal" else Load.TANGENTIAL
        if self.load == "antiplane":
            field = surface_displacement("tangential_displacement", grid, self.body, given, load)[0]
        else:
            field = surface_displacement(name, grid, self.body, given, load)[:, 0]
        across = (name == "normal_displacement") != (load is Load.NORMAL)
        return np.interp(x, at, field) - (0.0 if across else np.interp(DATUM, at, field))

    def stress(self, component: int, x: float, z: float) -> float:
        """One stress at a point."""
        grid, pressure, at = self.across(3.0)
        if z not in self.planes:
            if self.load == "normal":
                plane = subsurface_stress(pressure, grid, self.body, [z])
            else:
                plane = subsurface_stress(pressure, grid, self.body, [z], friction=1.0)
                plane = plane - subsurface_stress(pressure, grid, self.body, [z])
            self.planes[z] = plane[:, 0, 0, :] if self.load == "antiplane" else plane[:, 0, :, 0]
        if self.load == "antiplane":
            component = ANTIPLANE[component]
        return float(self.planes[z][component][int(np.argmin(np.abs(at - x)))])


def _closed(case: StoredCase, curve: StoredCurve) -> FloatArray | None:
    """The half-plane kernels."""
    load = Load.NORMAL if case.parameters["load"] == "normal" else Load.TANGENTIAL
    x, _, z = curve.coordinates.T
    material = case.body.material
    if curve.name == "normal_displacement":
        values = strip_displacement(x, 2.0, material, load, reference_length=1.0)
        if load is Load.NORMAL:
            values = values - strip_displacement(DATUM, 2.0, material, load, reference_length=1.0)
        return values
    if curve.name.startswith("stress"):
        return strip_stress(x, z, 2.0, material.poissons_ratio, load)[STRESS_NAMES.index(curve.name)]
    return None
