"""The gap between bem and its reference shrinks at the expected order, and images add up to a periodic axis."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import stress_coefficients, surface_coefficients
from bem.kernels.loads import STRESS_PARITY, SURFACE_PARITY, Load, Parities
from bem.materials import Body, Layer, Material
from bem.reference_solutions.hertz import sphere_contact
from bem.verification import disc, stored, strip
from bem.verification.closed_forms import curve
from bem.verification.rows import Curve, Gate

STEPS = (1 / 20, 1 / 40, 1 / 80)
ORDER_REASON = "steps of cells and points make single orders irregular by about a third"


def errors(solve: Callable[[float], FloatArray], reference: FloatArray, steps: tuple[float, ...]) -> list[float]:
    """Root of the mean square of the relative difference on each grid."""
    scale = float(np.max(np.abs(reference)))
    return [float(np.sqrt(np.mean((solve(step) - reference) ** 2))) / scale for step in steps]


def order_of(steps: tuple[float, ...], found: list[float]) -> float:
    """Slope of ln(error) over ln(step) by least squares."""
    return float(np.polyfit(np.log(steps), np.log(found), 1)[0])


def _order(quantity: str, steps: tuple[float, ...], found: list[float], expected: float, spread: float) -> Curve:
    """A row for the order: both orders, and how far apart they may be over the expected one."""
    return curve(
        f"order of {quantity}",
        f"errors {', '.join(f'{e:.1e}' for e in found)} with cells of {', '.join(f'{s:.3g}' for s in steps)}",
        "order",
        np.zeros(3),
        order_of(steps, found),
        expected,
        spread,
        ORDER_REASON,
    )


def _disc(name: str) -> list[Curve]:
    """Displacement and stresses of a stored Hertzian disc as the cells shrink."""
    case = stored.read(name)
    tangential = case.problem == "disc-tangential"
    found = []
    for quantity in ("normal_displacement", "stress_zz", "stress_xz"):
        curves = [c for c in case.curves if c.name == quantity and (quantity[0] == "n" or c.side in ("", "substrate"))]
        kept = [c.only(c.coordinates[:, 2] >= (0.29 if c.name[0] == "s" else 0)) for c in curves]
        # away from the edge, where it is not of the second order
        kept = [c.only(np.abs(np.hypot(*c.coordinates[:, :2].T) - 1) > 0.12) for c in kept]

        def solve(step: float, kept: list[stored.StoredCurve] = kept) -> FloatArray:
            side = disc.Disc(case.body, case.parameters["pressure"], tangential=tangential, step=step, glass=False)
            return np.concatenate([side.values(c) for c in kept])

        reference = np.concatenate([c.values for c in kept])
        found.append(_order(quantity, STEPS, errors(solve, reference, STEPS), 2.0, 0.3))
    return found


def _strip(name: str) -> list[Curve]:
    """Displacement of a stored strip as the cells shrink."""
    case = stored.read(name)
    kept = next(c for c in case.curves if c.name == "normal_displacement")
    kept = kept.only(np.abs(kept.coordinates[:, 0] - 1) > 0.12)
    steps = (1 / 20, 1 / 60, 1 / 180)
    found = errors(lambda step: strip.Strip(case, step).displacement(kept.coordinates[:, 0]), kept.values, steps)
    return [_order("normal_displacement", steps, found, 2.0, 0.3)]


def _sphere() -> list[Curve]:
    """Approach and central pressure of a ball as the cells shrink."""
    steel = Material("steel", youngs_modulus=1.0, poissons_ratio=0.3)
    exact = sphere_contact(radius=1.0, contact_modulus=steel.plane_strain_modulus, load=1e-3)
    radius = exact.semi_axes[0]
    cells = (16, 32, 64)
    approach, pressure = [], []
    for n in cells:
        half = math.ceil(1.2 * n)
        grid = Grid((2 * half + 1, 2 * half + 1), (radius / n, radius / n))
        x = np.arange(-half, half + 1) * radius / n
        gap = np.add.outer(x**2, x**2) / 2
        solution = solve_contact(gap, displacement_operator(grid, Body(steel)), load=1e-3, tolerance=1e-10)
        approach.append(abs(solution.approach / exact.approach - 1))
        inside = np.add.outer(x**2, x**2) < (0.8 * radius) ** 2
        difference = (solution.pressure - exact.pressure(x[:, None], x[None, :]))[inside] / exact.maximum_pressure
        pressure.append(float(np.sqrt(np.mean(difference**2))))
    steps = tuple(1 / n for n in cells)
    return [
        _order("approach", steps, approach, 2.0, 0.4),
        _order("pressure", steps, pressure, 1.75, 0.4),
    ]


PERIOD, IMAGES = 6, 400
IMAGE_REASON = (
    "images beyond the four hundredth are left out: their sum falls like 1/400 where traction sinks the surface"
)


def _images(layer: bool, axis: int) -> list[Curve]:
    """Coefficients along a periodic axis against the sum of free ones over 400 images on each side."""
    body = Body(Material("substrate", youngs_modulus=1.0, poissons_ratio=0.3))
    if layer:
        body = Body(body.material, layer=Layer(Material("layer", youngs_modulus=0.2, poissons_ratio=0.4), 1.2))
    cells = 4
    shape = (PERIOD, cells) if axis == 0 else (cells, PERIOD)
    reach = PERIOD * IMAGES + PERIOD
    long = (reach, cells) if axis == 0 else (cells, reach)
    periodic = Grid(shape, (1.0, 1.0), periodic=(axis == 0, axis == 1))
    free = Grid(long, (1.0, 1.0))
    found = []
    for load in Load:
        sums = _sum(surface_coefficients(free, body, load)[None], (SURFACE_PARITY[load],), axis, shape)[0]
        table = surface_coefficients(periodic, body, load)
        # a plane problem has no datum: from the farthest cell of the first row
        far = (PERIOD // 2, 0) if axis == 0 else (0, PERIOD // 2)
        name = f"normal_displacement, {load.name.lower()}"
        found.append(_same(name, table - table[far], sums - sums[far], 5e-5 if load is Load.NORMAL else 2e-3))
        for depth in (0.8, 1.6):
            stress = stress_coefficients(periodic, body, depth, load)
            sums = _sum(stress_coefficients(free, body, depth, load), STRESS_PARITY[load], axis, shape)
            for component, label in enumerate(stored.STRESS_NAMES):
                name = f"{label}, {load.name.lower()}"
                found.append(_same(name, stress[component], sums[component], 5e-4))
    return found


def _sum(table: FloatArray, parities: Parities, axis: int, shape: tuple[int, int]) -> FloatArray:
    """Sum free coefficients (parts, ...) over the images along an axis: offsets j + n PERIOD, n of both signs."""
    lines = np.moveaxis(table, axis + 1, 1)
    out = np.zeros((table.shape[0], PERIOD, lines.shape[2]))
    for part, parity in enumerate(parities):
        for j in range(PERIOD):
            ahead = lines[part, j : j + PERIOD * IMAGES + 1 : PERIOD]
            behind = lines[part, PERIOD - j : PERIOD * IMAGES - j + 1 : PERIOD]
            out[part, j] = ahead.sum(axis=0) + parity[axis] * behind.sum(axis=0)
    return np.moveaxis(out, 1, axis + 1)


def _same(name: str, values: FloatArray, sums: FloatArray, allowance: float) -> Curve:
    return curve(name, "cells", "1", np.zeros(3), values.ravel(), sums.ravel(), allowance, IMAGE_REASON)


def gates() -> list[Gate]:
    """Gates of refinement and of images."""
    family = "refinement"
    found = [
        Gate(f"refinement-{name}", family, f"Order of the gap to {name} as bem's cells shrink.", partial(_disc, name))
        for name in ("disc-hertz", "disc-hertz-soft", "disc-tangential-hertz-soft")
    ]
    found += [
        Gate(f"refinement-{name}", family, f"Order of the gap to {name} as bem's cells shrink.", partial(_strip, name))
        for name in ("strip-normal", "strip-normal-stiff")
    ]
    found.append(Gate("refinement-hertz-sphere", family, "Order of a ball's approach and pressure.", _sphere))
    for layer, body in ((False, "bare"), (True, "coated")):
        for axis in (0, 1):
            found.append(
                Gate(
                    f"images-{body}-{'xy'[axis]}",
                    family,
                    f"Coefficients of a {body} body periodic along {'xy'[axis]}: the sum over free images.",
                    partial(_images, layer, axis),
                )
            )
    return found
