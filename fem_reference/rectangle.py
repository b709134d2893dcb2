"""Problem 1: a uniformly loaded rectangle, pressure or traction along x, on a plain or layered block, in 3D.

A quarter is meshed. Under pressure u_x is odd in x and u_y odd in y; under traction along x, u_y and u_z are odd in x
and u_y odd in y.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from fem_reference.convergence import Curve, Floors, Method, Statement, equilibrium, study
from fem_reference.elasticity import ProductGrid, Solution, WeakForm, cartesian_components, isotropic_stress, solve
from fem_reference.layers import LAYERS, bodies, describe_body, one_layer
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import STRESS_NAMES, Result
from meshes.grids import rectangle_grid

Array = NDArray[np.float64]
DEGREE = 4
FAR_FIELD = (
    "Block of 30 half-lengths held on its far faces; on the coarsest mesh it is widened twice by a factor of 8 and the "
    "displacement extrapolated with its 1/R law (stress: 1/R^2); the departure of the third block from the law is part "
    "of the error bar."
)


def evaluate(solution: Solution, points: Array, side: str | None = None) -> tuple[Array, Array]:
    """Displacement (3, n) and the six stresses (6, n) at points (n, 3) of the meshed quarter."""
    u, g, lame, shear = solution.sample(points, side)
    strain = (g + g.transpose(0, 2, 1)) / 2
    return u.T, cartesian_components(isotropic_stress(strain, lame, shear))


def _vanishing(load: str, points: Array) -> set[str]:
    """Stresses that are odd in x on x = 0, or odd in y on y = 0."""
    none: set[str] = set()
    if not points[:, 0].any():
        none |= {"stress_xy", "stress_xz"} if load == "normal" else {"stress_xx", "stress_yy", "stress_zz", "stress_yz"}
    if not points[:, 1].any():
        none |= {"stress_xy", "stress_yz"}
    return none


def _curves(solution: Solution, load: str, width: float, thickness: float | None) -> list[Curve]:
    """Surface displacements along both axes and a diagonal, stresses below four points."""
    steps = np.array([0.0, 0.2, 0.4, 0.6, 1.5, 2.0, 3.0, 5.0])
    lines = {
        "surface, y = 0": np.column_stack([steps, 0 * steps, 0 * steps]),
        "surface, x = 0": np.column_stack([0 * steps, width * steps, 0 * steps]),
        "surface, diagonal": np.column_stack([steps, width * steps, 0 * steps]),
    }
    unit = "p a / E_substrate"
    found = []
    for along, points in lines.items():
        u, _ = evaluate(solution, points)
        if load == "normal" or along != "surface, x = 0":
            found.append(Curve("normal_displacement", unit, along, points, u[2]))
        if load == "tangential" or along != "surface, x = 0":
            found.append(Curve("tangential_displacement", unit, along, points, u[0]))
        if along == "surface, diagonal":
            found.append(Curve("transverse_displacement", unit, along, points, u[1]))
    depths = {"": np.array([0.25, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0])}
    if thickness is not None:
        below = np.array([0.5, 0.75, 1.0, 1.5, 2.0, 3.0])
        substrate = np.concatenate([thickness * np.array([1.0, 1.25]), below[below > 1.25 * thickness]])
        depths = {"layer": thickness * np.array([0.5, 0.75, 1.0]), "substrate": substrate}
    for side, z in depths.items():
        label = f" ({side})" if side else ""
        for x, y in ((0.0, 0.0), (0.5, 0.0), (0.6, 0.6 * width), (1.4, 0.5 * width)):
            points = np.column_stack([0 * z + x, 0 * z + y, z])
            _, stress = evaluate(solution, points, side or None)
            none = _vanishing(load, points)
            found += [
                Curve(name, "p", f"depth at x = {x:g}, y = {y:g}{label}", points, values, derivative=True)
                for name, values in zip(STRESS_NAMES, stress, strict=True)
                if name not in none
            ]
    return found


def solve_rectangle(*, nu: float, layer: Sequence[float] | None, load: str, width: float, finer: int = 0) -> Result:
    """A loaded rectangle: see the module."""
    materials, _ = bodies(nu, layer)
    thickness = one_layer(layer)
    if not 0.1 <= width <= 1:
        raise ValueError(f"width {width}: the shorter half-side over the longer must lie between 0.1 and 1")
    direction = 2 if load == "normal" else 0

    def solve_on(builder: Any) -> Solution:
        form = WeakForm(
            fields=3,
            degree=DEGREE,
            strain=lambda u, x: ufl.sym(ufl.grad(u)),
            weight=lambda x: 1.0,
            load=lambda v, x: v[direction],
            held={"axis": [0] if load == "normal" else [1, 2], "axis_y": [1], "far": None},
            rigid=[tuple(float(i == direction) for i in range(3))],
        )
        return solve(builder, materials, form, ProductGrid(interface=thickness or 0.0))

    kind = "pressure" if load == "normal" else "traction along x"
    statement = Statement(
        problem="rectangle",
        sentence=(
            f"A uniform {kind} on the rectangle |x| <= a, |y| <= {width:g} a of {describe_body(nu, layer, 'a')}, "
            "in three dimensions."
        ),
        parameters={"nu": nu, "layer": None if layer is None else list(layer), "load": load, "width": width},
        normalisation="Half-length a = 1, traction p = 1, Young's modulus of the substrate 1.",
        far_field=FAR_FIELD,
    )
    method = Method(
        grid=lambda level, boxes=0: rectangle_grid(
            half_length=1.0, half_width=width, level=level, thickness=thickness, boxes=boxes
        ),
        solve=solve_on,
        curves=lambda solution: _curves(solution, load, width, thickness),
        degree=DEGREE,
        levels=(2, 3, 4),
        box_order=lambda curve: 2.0 if curve.derivative else 1.0,
        # a quarter of the rectangle is meshed
        checks=lambda solution: equilibrium(solution, [width]),
        finer=finer,
    )
    return study(statement, method, Floors(typical=1.0))


PROBLEMS = (
    Problem(
        "rectangle",
        "uniform pressure or traction on a rectangle of a homogeneous or layered block, in three dimensions",
        (
            POISSONS_RATIO,
            LAYER,
            Parameter("load", "normal", "direction of the traction", choices=("normal", "tangential")),
            Parameter("width", 0.5, "shorter half-side over the longer, which lies along x"),
        ),
        solve_rectangle,
        {
            "rectangle-normal": {"load": "normal"},
            "rectangle-tangential": {"load": "tangential"},
            "rectangle-normal-soft": {"load": "normal", "layer": LAYERS["soft"]},
            "rectangle-tangential-stiff": {"load": "tangential", "layer": LAYERS["stiff"]},
            "rectangle-normal-low-nu-soft": {"nu": 0.1, "load": "normal", "layer": LAYERS["soft"]},
        },
    ),
)
