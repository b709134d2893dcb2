"""Problem 4: a strip of pressure or of traction on a homogeneous or layered half-plane, plane strain.

Half of the body, x >= 0, is meshed; a pressure makes u_x odd in x, a traction along x makes u_z odd. A traction along y
(antiplane shear) is a problem of its own with one field. Plane problems have no datum: displacements grow like ln R, so
those along the load are given relative to the point x = 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from fem_reference.convergence import Curve, Method, Statement, equilibrium, study
from fem_reference.disc import SURFACE, depths, interfaces, off_mesh_lines
from fem_reference.elasticity import Solution, WeakForm, cartesian_components, isotropic_stress, solve
from fem_reference.layers import LAYERS, STACKS, bodies, describe_body
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import STRESS_NAMES, Result
from meshes.grids import half_space_grid

Array = NDArray[np.float64]
DEGREE = 4
LOADS = ("normal", "tangential", "antiplane")
DATUM = 4.0
FAR_FIELD = (
    "Box of 3000 half-widths (more for thick layers) held at its outer boundary; on the coarsest mesh the box is "
    "widened twice by a factor of 8 and the figures extrapolated with their leading power of 1/R; the departure of the "
    "third box from the law is part of the error bar. Displacements along the load are relative to x = 4."
)


def strain_plane(u: Any, x: Any) -> Any:
    """Plane strain over (x, y, z) of the fields (u_x, u_z)."""
    g = ufl.grad(u)
    shear = (g[0, 1] + g[1, 0]) / 2
    return ufl.as_tensor([[g[0, 0], 0, shear], [0, 0, 0], [shear, 0, g[1, 1]]])


def strain_antiplane(u: Any, x: Any) -> Any:
    """Strain over (x, y, z) of the single field (u_y,)."""
    g = ufl.grad(u)
    return ufl.as_tensor([[0, g[0, 0] / 2, 0], [g[0, 0] / 2, 0, g[0, 1] / 2], [0, g[0, 1] / 2, 0]])


def evaluate(solution: Solution, points: Array, load: str, side: str | None = None) -> tuple[Array, Array]:
    """Displacement (3, n) and the six stresses (6, n) over (x, y, z) at points (n, 3) of the meshed half."""
    points = np.atleast_2d(points)
    u, g, lame, shear = solution.sample(points[:, [0, 2]], side)
    strain = np.zeros((len(points), 3, 3))
    displacement = np.zeros((3, len(points)))
    if load == "antiplane":
        displacement[1] = u[:, 0]
        strain[:, 0, 1] = strain[:, 1, 0] = g[:, 0, 0] / 2
        strain[:, 1, 2] = strain[:, 2, 1] = g[:, 0, 1] / 2
    else:
        displacement[[0, 2]] = u.T
        strain[:, 0, 0], strain[:, 2, 2] = g[:, 0, 0], g[:, 1, 1]
        strain[:, 0, 2] = strain[:, 2, 0] = (g[:, 0, 1] + g[:, 1, 0]) / 2
    return displacement, cartesian_components(isotropic_stress(strain, lame, shear))


def components(load: str, *, on_axis: bool) -> set[str]:
    """Stresses that do not vanish identically; on_axis: on the plane of symmetry x = 0."""
    if load == "antiplane":
        return {"stress_yz"} if on_axis else {"stress_yz", "stress_xy"}
    if on_axis:
        return {"stress_xz"} if load == "tangential" else {"stress_xx", "stress_yy", "stress_zz"}
    return {"stress_xx", "stress_yy", "stress_zz", "stress_xz"}


def held_on_axis(load: str) -> list[int] | None:
    """Field that is odd in x."""
    return {"normal": [0], "tangential": [1], "antiplane": None}[load]


def _curves(solution: Solution, load: str, thicknesses: Sequence[float]) -> list[Curve]:
    surface = np.array([[x, 0.0, 0.0] for x in SURFACE])
    displacement, _ = evaluate(solution, surface, load)
    datum = SURFACE.index(DATUM)
    along = {"normal": 2, "tangential": 0, "antiplane": 1}[load]
    names = {0: "tangential_displacement", 1: "transverse_displacement", 2: "normal_displacement"}
    unit = "p a / E_substrate"
    keep = [i for i in range(len(SURFACE)) if i != datum]
    relative = displacement[along] - displacement[along, datum]
    note = f"relative to the point x = {DATUM:g} of the surface"
    found = [Curve(names[along], unit, "surface", surface[keep], relative[keep], note=note)]
    if load != "antiplane":
        other = 2 - along
        found.append(Curve(names[other], unit, "surface", surface[1:], displacement[other, 1:]))
    lines: list[tuple[str, Array, str]] = []
    for side, levels in depths(thicknesses).items():
        label = f" ({side})" if side else ""
        for x in (0.0, 0.7, 1.3):
            lines.append((f"depth at x = {x:g}{label}", np.array([[x, 0.0, z] for z in levels]), side))
    across = np.array([0.0, 0.25, 0.5, 0.75, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0])
    for words, side, depth in interfaces(thicknesses):
        lines.append((f"{words} ({side})", np.array([[x, 0.0, depth] for x in across]), side))
    for name, points, side in lines:
        _, stress = evaluate(solution, off_mesh_lines(points, thicknesses), load, side or None)
        free = components(load, on_axis=not points[:, 0].any())
        found += [
            Curve(kind, "p", name, points, values, derivative=True)
            for kind, values in zip(STRESS_NAMES, stress, strict=True)
            if kind in free
        ]
    return found


def _box_order(load: str, name: str) -> float:
    """Power k of the leading error 1/R^k of a box held at distance R.

    Under pressure the walls keep u_x from its constant far away: a uniform strain, 1/R, which does not bend the
    surface. Under traction along x they do that to u_z: a rotation, 1/R, free of stress. All else is of the next order.
    """
    if load == "normal":
        return 2.0 if name == "normal_displacement" else 1.0
    if load == "tangential":
        return 1.0 if name == "normal_displacement" else 2.0
    return 2.0


def solve_strip(*, nu: float, layer: Sequence[float] | None, load: str, finer: int = 0) -> Result:
    """A loaded strip: see the module."""
    materials, thicknesses = bodies(nu, layer)
    antiplane = load == "antiplane"
    held = held_on_axis(load)

    def solve_on(builder: Any) -> Solution:
        direction = 1 if load == "normal" else 0
        form = WeakForm(
            fields=1 if antiplane else 2,
            degree=DEGREE,
            strain=strain_antiplane if antiplane else strain_plane,
            weight=lambda x: 1.0,
            load=lambda v, x: v[direction],
            held={"end": None, "bottom": None} | ({} if held is None else {"axis": held}),
            rigid=[tuple(float(i == direction) for i in range(1 if antiplane else 2))],
        )
        return solve(builder, materials, form)

    kind = {"normal": "pressure", "tangential": "traction along x", "antiplane": "traction along y"}[load]
    statement = Statement(
        problem="strip",
        sentence=f"A uniform {kind} on a strip of half-width a (plane strain), on {describe_body(nu, layer, 'a')}.",
        parameters={"nu": nu, "layer": None if layer is None else list(layer), "load": load},
        normalisation="Half-width a = 1, traction p = 1, Young's modulus of the substrate 1.",
        far_field=FAR_FIELD,
    )
    method = Method(
        grid=lambda level, boxes=0: half_space_grid(thickness=thicknesses, level=level, boxes=boxes),
        solve=solve_on,
        curves=lambda solution: _curves(solution, load, thicknesses),
        degree=DEGREE,
        box_order=lambda curve: _box_order(load, curve.name),
        # half of the strip is meshed: the resultant is 1
        checks=lambda solution: equilibrium(solution, [1.0]),
        finer=finer,
    )
    return study(statement, method)


def _stored() -> dict[str, dict[str, Any]]:
    cases: dict[str, dict[str, Any]] = {}
    for load in LOADS:
        names = ["", "soft", "stiff", "stiff-thin", "soft-thick", "film-15GPa-200nm"]
        if load == "antiplane":
            names = names[:3]
        for name in names:
            case = f"strip-{load}" + (f"-{name}" if name else "")
            cases[case] = {"load": load} | ({"layer": LAYERS[name]} if name else {})
        name = "soft-on-stiff" if load == "tangential" else "stiff-on-soft"
        cases[f"strip-{load}-{name}"] = {"load": load, "layer": STACKS[name]}
    cases["strip-normal-high-nu-stiff"] = {"nu": 0.49, "load": "normal", "layer": LAYERS["stiff"]}
    cases["strip-tangential-low-nu-soft"] = {"nu": 0.05, "load": "tangential", "layer": LAYERS["soft"]}
    return cases


PROBLEMS = (
    Problem(
        "strip",
        "uniform pressure or traction on a strip, plane strain, homogeneous or layered half-plane",
        (POISSONS_RATIO, LAYER, Parameter("load", "normal", "direction of the traction", choices=LOADS)),
        solve_strip,
        _stored(),
        quick=("strip-tangential",),
    ),
)
