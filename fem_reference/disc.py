"""Problems 2 and 3: a disc of pressure or of traction on a homogeneous or layered half-space, in the meridian plane.

Pressure: fields (u_r, u_z). Traction along x: the first Fourier harmonic, u_r = U cos t, u_theta = V sin t, u_z = W cos
t; the fields are S = U + V, D = U - V and W, so that what must vanish on the axis (S and W) is one condition each. The
Jacobian of the meridian is r; the integrals over the angle give the same factor, pi, everywhere and drop out.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import accumulate
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from fem_reference.convergence import Curve, Method, Statement, equilibrium, study
from fem_reference.elasticity import Solution, WeakForm, cartesian_components, isotropic_stress, solve
from fem_reference.layers import LAYERS, STACKS, bodies, describe_body
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import STRESS_NAMES, Result
from meshes.grids import half_space_grid, layer_names

Array = NDArray[np.float64]
DEGREE = 4
FAR_FIELD = (
    "Box of 3000 radii (more for thick layers) held at its outer boundary; on the coarsest mesh the box is widened "
    "twice by a factor of 8 and the displacement extrapolated with its 1/R law (stress: 1/R^2); the departure of the "
    "third box from the law is part of the error bar."
)
SURFACE = (
    0.0,
    0.1,
    0.25,
    0.5,
    0.7,
    0.8,
    0.9,
    0.95,
    1.0,
    1.05,
    1.1,
    1.2,
    1.35,
    1.5,
    1.75,
    2.0,
    2.5,
    3.0,
    4.0,
    6.0,
    10.0,
)
ACROSS = (0.0, 0.25, 0.5, 0.75, 0.825, 0.9, 1.025, 1.1, 1.25, 1.5, 1.875, 2.0, 2.125, 2.175, 3.0)
"""Distances from the axis on interfaces, with those of the highest stresses of a stiff layer on a soft one: shear
(0.825 and 1.025), tension along (1.875) and tension across the interfaces (2.125 and 2.175)."""


def _profile(pressure: str, radius: Any) -> Any:
    """The traction's profile, 1 or sqrt(1 - r^2), in UFL."""
    if pressure == "uniform":
        return 1.0
    return ufl.sqrt(ufl.max_value(1 - radius**2, 0.0))


def resultant(pressure: str) -> float:
    """Force of the unit profile: pi, or two thirds of it."""
    return np.pi if pressure == "uniform" else 2 * np.pi / 3


def strain_0(u: Any, x: Any) -> Any:
    """Strain over (r, theta, z) of the axisymmetric fields (u_r, u_z)."""
    g = ufl.grad(u)
    shear = (g[0, 1] + g[1, 0]) / 2
    return ufl.as_tensor([[g[0, 0], 0, shear], [0, u[0] / x[0], 0], [shear, 0, g[1, 1]]])


def strain_1(u: Any, x: Any) -> Any:
    """Amplitudes over (r, theta, z) of the first harmonic's strain for the fields (S, D, W).

    Each component carries cos t or sin t once: the products of equal components integrate to pi.
    """
    r, g = x[0], ufl.grad(u)
    grad_u, grad_v = (g[0, :] + g[1, :]) / 2, (g[0, :] - g[1, :]) / 2
    hoop = u[0] / r
    radial_hoop = (grad_v[0] - hoop) / 2
    hoop_axial = (grad_v[1] - u[2] / r) / 2
    radial_axial = (grad_u[1] + g[2, 0]) / 2
    return ufl.as_tensor(
        [
            [grad_u[0], radial_hoop, radial_axial],
            [radial_hoop, hoop, hoop_axial],
            [radial_axial, hoop_axial, g[2, 1]],
        ]
    )


def _over_radius(value: Array, slope: Array, radius: Array) -> Array:
    """value / r, or the radial slope on the axis, where the value vanishes."""
    near = radius < 1e-9
    return np.where(near, slope, value / np.where(near, 1.0, radius))


def evaluate(solution: Solution, points: Array, harmonic: int, side: str | None = None) -> tuple[Array, Array]:
    """Displacement (3, n) and the six stresses (6, n) over (x, y, z) at points (n, 3)."""
    points = np.atleast_2d(points)
    radius = np.hypot(points[:, 0], points[:, 1])
    angle = np.arctan2(points[:, 1], points[:, 0])
    cosine, sine = np.cos(angle), np.sin(angle)
    u, g, lame, shear = solution.sample(np.column_stack([radius, points[:, 2]]), side)
    strain = np.zeros((len(points), 3, 3))
    if harmonic == 0:
        cylindrical = np.array([u[:, 0], 0 * radius, u[:, 1]])
        strain[:, 0, 0], strain[:, 1, 1], strain[:, 2, 2] = (
            g[:, 0, 0],
            _over_radius(u[:, 0], g[:, 0, 0], radius),
            g[:, 1, 1],
        )
        strain[:, 0, 2] = strain[:, 2, 0] = (g[:, 0, 1] + g[:, 1, 0]) / 2
    else:
        radial, hoop = (u[:, 0] + u[:, 1]) / 2, (u[:, 0] - u[:, 1]) / 2
        cylindrical = np.array([radial * cosine, hoop * sine, u[:, 2] * cosine])
        grad_u, grad_v = (g[:, 0] + g[:, 1]) / 2, (g[:, 0] - g[:, 1]) / 2
        sum_over_r = _over_radius(u[:, 0], g[:, 0, 0], radius)
        axial_over_r = _over_radius(u[:, 2], g[:, 2, 0], radius)
        strain[:, 0, 0] = grad_u[:, 0] * cosine
        strain[:, 1, 1] = sum_over_r * cosine
        strain[:, 2, 2] = g[:, 2, 1] * cosine
        strain[:, 0, 1] = strain[:, 1, 0] = (grad_v[:, 0] - sum_over_r) / 2 * sine
        strain[:, 1, 2] = strain[:, 2, 1] = (grad_v[:, 1] - axial_over_r) / 2 * sine
        strain[:, 0, 2] = strain[:, 2, 0] = (grad_u[:, 1] + g[:, 2, 0]) / 2 * cosine
    stress = isotropic_stress(strain, lame, shear)
    rotation = np.zeros((len(points), 3, 3))
    rotation[:, 0, 0], rotation[:, 0, 1], rotation[:, 1, 0], rotation[:, 1, 1], rotation[:, 2, 2] = (
        cosine,
        -sine,
        sine,
        cosine,
        1.0,
    )
    displacement = np.einsum("nij,jn->in", rotation, cylindrical)
    return displacement, cartesian_components(rotation @ stress @ rotation.transpose(0, 2, 1))


def depths(thicknesses: Sequence[float]) -> dict[str, Array]:
    """Depths at which stresses are asked for, by medium.

    At least 0.1 below the surface's edge singularity or a tenth of the outermost layer.
    """
    if not thicknesses:
        return {"": np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0])}
    first, *others = thicknesses
    found = {"layer": first * np.array([0.1, 0.25, 0.5, 0.75, 0.9, 1.0])}
    bottom = first
    for name, thickness in zip(layer_names(len(thicknesses))[1:], others, strict=True):
        found[name] = bottom + thickness * np.array([0.0, 0.25, 0.5, 0.75, 1.0])
        bottom += thickness
    below = np.array([0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0])
    found["substrate"] = np.concatenate([bottom * np.array([1.0, 1.1, 1.5]), below[below > 1.5 * bottom]])
    return found


def interfaces(thicknesses: Sequence[float]) -> list[tuple[str, str, float]]:
    """(words, medium, depth) of both sides of every interface, from the surface down."""
    names = [*layer_names(len(thicknesses)), "substrate"]
    found = []
    for number, depth in enumerate(accumulate(thicknesses), 1):
        words = "interface" if number == 1 else f"interface {number}"
        found += [(words, names[number - 1], depth), (words, names[number], depth)]
    return found


def off_mesh_lines(points: Array, thicknesses: Sequence[float]) -> Array:
    """Points (n, 3) moved towards the centre of the load by 1e-9 of their distance, but not off an interface.

    On a line of the mesh rounding would choose the cell, in a wider box perhaps another one, and stresses jump from
    cell to cell: at a depth of 4, where cells grow wide, the far field's correction then took half of the jump.
    """
    moved = points * (1 - 1e-9)
    on_interface = np.isin(points[:, 2], list(accumulate(thicknesses)))
    moved[on_interface, 2] = points[on_interface, 2]
    return moved


def _curves(solution: Solution, harmonic: int, thicknesses: Sequence[float]) -> list[Curve]:
    """Surface displacements along x, stresses below the centre, off the axis, and along the interface."""
    surface = np.array([[x, 0.0, 0.0] for x in SURFACE])
    displacement, _ = evaluate(solution, surface, harmonic)
    unit = "p a / E_substrate"
    found = [
        Curve("normal_displacement", unit, "surface, y = 0", surface, displacement[2]),
        Curve("tangential_displacement", unit, "surface, y = 0", surface, displacement[0]),
    ]
    if harmonic:
        across = surface[:, [1, 0, 2]]
        found.append(
            Curve("tangential_displacement", unit, "surface, x = 0", across, evaluate(solution, across, 1)[0][0])
        )
    lines: list[tuple[str, Array, str]] = []
    for side, levels in depths(thicknesses).items():
        label = f" ({side})" if side else ""
        for x, y, name in (
            (0.0, 0.0, "depth at x = y = 0"),
            (0.6, 0.3, "depth at x = 0.6, y = 0.3"),
            (-1.2, 0.5, "depth at x = -1.2, y = 0.5"),
        ):
            lines.append((name + label, np.array([[x, y, z] for z in levels]), side))
    for words, side, depth in interfaces(thicknesses):
        lines.append((f"{words}, y = 0 ({side})", np.array([[x, 0.0, depth] for x in ACROSS]), side))
    for along, points, side in lines:
        _, stress = evaluate(solution, off_mesh_lines(points, thicknesses), harmonic, side or None)
        on_axis = {"stress_xz"} if harmonic else {"stress_xx", "stress_yy", "stress_zz"}
        in_plane = {"stress_xx", "stress_yy", "stress_zz", "stress_xz"}
        free = on_axis if not points[:, :2].any() else in_plane if not points[:, 1].any() else set(STRESS_NAMES)
        for name, values in zip(STRESS_NAMES, stress, strict=True):
            if name in free:  # the others vanish by symmetry
                found.append(Curve(name, "p", along, points, values, derivative=True))
    return found


def _weak_form(harmonic: int, pressure: str) -> WeakForm:
    form = partial(
        WeakForm,
        degree=DEGREE,
        weight=lambda x: x[0],
        load=lambda v, x: _profile(pressure, x[0]) * v[1],  # of traction tau (cos t, -sin t): works on U - V = D
        load_degree=None if pressure == "uniform" else 30,
    )
    if harmonic == 0:
        return form(fields=2, strain=strain_0, held={"axis": [0], "end": None, "bottom": None}, rigid=[(0.0, 1.0)])
    held = {"axis": [0, 2], "end": None, "bottom": None}
    return form(fields=3, strain=strain_1, held=held, rigid=[(0.0, 2.0, 0.0)])


def _solve(harmonic: int, *, nu: float, layer: Sequence[float] | None, pressure: str, finer: int) -> Result:
    materials, thicknesses = bodies(nu, layer)

    def grid(level: int, boxes: int = 0) -> Any:
        return half_space_grid(thickness=thicknesses, level=level, boxes=boxes)

    form = _weak_form(harmonic, pressure)
    # per meridian: 2 pi (harmonic 0) or pi (harmonic 1) times the integral is the force
    factor = 2 * np.pi if harmonic == 0 else np.pi

    along = "normal_displacement" if harmonic == 0 else "tangential_displacement"

    def checks(solution: Solution) -> dict[str, dict[str, float]]:
        return equilibrium(solution, [resultant(pressure) / factor])

    profile = "A uniform" if pressure == "uniform" else "A Hertzian (semi-ellipsoidal)"
    kind = "pressure" if harmonic == 0 else "traction along x"
    statement = Statement(
        problem="disc" if harmonic == 0 else "disc-tangential",
        sentence=f"{profile} {kind} on a disc of radius a, on {describe_body(nu, layer, 'a')}.",
        parameters={"nu": nu, "layer": None if layer is None else list(layer), "pressure": pressure},
        normalisation="Radius a = 1, largest traction p = 1, Young's modulus of the substrate 1.",
        far_field=FAR_FIELD,
    )
    method = Method(
        grid=grid,
        solve=lambda builder: solve(builder, materials, form),
        curves=lambda solution: _curves(solution, harmonic, thicknesses),
        degree=DEGREE,
        # the walls shift the middle by something like 1/R along the load and strain it by 1/R^2
        box_order=lambda curve: 1.0 if curve.name == along and not curve.derivative else 2.0,
        checks=checks,
        finer=finer,
    )
    return study(statement, method)


def solve_normal(*, nu: float, layer: Sequence[float] | None, pressure: str, finer: int = 0) -> Result:
    """A disc of pressure: see the module."""
    return _solve(0, nu=nu, layer=layer, pressure=pressure, finer=finer)


def solve_tangential(*, nu: float, layer: Sequence[float] | None, pressure: str, finer: int = 0) -> Result:
    """A disc of traction along x: see the module."""
    return _solve(1, nu=nu, layer=layer, pressure=pressure, finer=finer)


PARAMETERS = (
    POISSONS_RATIO,
    LAYER,
    Parameter("pressure", "uniform", "profile of the traction", choices=("uniform", "hertz")),
)


def _stored(prefix: str, uniform: Sequence[str], hertz: Sequence[str]) -> dict[str, dict[str, Any]]:
    cases: dict[str, dict[str, Any]] = {}
    for pressure, names in (("uniform", uniform), ("hertz", hertz)):
        for name in names:
            case = f"{prefix}-{pressure}" + (f"-{name}" if name else "")
            cases[case] = {"pressure": pressure} | ({"layer": (LAYERS | STACKS)[name]} if name else {})
    return cases


PROBLEMS = (
    Problem(
        "disc",
        "pressure on a disc, uniform or Hertzian, on a homogeneous or layered half-space (axisymmetric)",
        PARAMETERS,
        solve_normal,
        _stored(
            "disc",
            ["", "soft", "stiff", "stiff-thin", "soft-thick", "soft-on-stiff"],
            ["", *LAYERS, "stiff-on-soft"],
        )
        | {
            "disc-uniform-low-nu": {"nu": 0.05},
            "disc-hertz-high-nu-soft": {"nu": 0.45, "pressure": "hertz", "layer": LAYERS["soft"]},
            "disc-hertz-low-nu-stiff-on-soft": {"nu": 0.1, "pressure": "hertz", "layer": STACKS["stiff-on-soft"]},
        },
        quick=("disc-uniform",),
    ),
    Problem(
        "disc-tangential",
        "traction along x on a disc, uniform or Hertzian, on a homogeneous or layered half-space (first harmonic)",
        PARAMETERS,
        solve_tangential,
        _stored(
            "disc-tangential",
            ["", "soft", "stiff", "stiff-thin", "soft-thick"],
            ["", "soft", "stiff-thin", "film-15GPa-200nm", "stiff-on-soft"],
        )
        | {
            "disc-tangential-uniform-low-nu-stiff": {"nu": 0.1, "layer": LAYERS["stiff"]},
            "disc-tangential-hertz-high-nu-soft": {"nu": 0.48, "pressure": "hertz", "layer": LAYERS["soft"]},
        },
    ),
)
