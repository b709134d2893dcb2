"""An elastic, perfectly plastic body (von Mises) under a rigid sphere: indentation from first yield to full plasticity.

A validation of the model, not a gate: half-space codes cap the pressure at a hardness and take H = 2.8 sigma_y; here
the plastic flow below the contact is computed. Small strains and a parabolic indenter, so that all depends on a E* /
(R sigma_y) alone (and weakly on Poisson's ratio).

Biquadratic displacements with 2 x 2 Gauss points (which do not lock in plastic, nearly isochoric flow), the state
kept at those points, radial return with the consistent tangent, Newton's method with a backtracking line search,
displacement control. Contact by a penalty at two Gauss points to a surface cell, so stiff that the overlap moves the
edge by far less than a cell. The range of contact sizes is covered by windows: runs from zero on meshes whose patch
fits the window's largest contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray
from petsc4py import PETSc

from fem_reference import compat, layers, provenance
from fem_reference.contact_body import elastic_body
from fem_reference.contact_solve import weighted_profile
from fem_reference.problem import POISSONS_RATIO, Parameter, Problem
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate
from meshes.contact_block import ContactBlock

WINDOWS = (4.0, 10.0, 25.0, 70.0)
"""Largest a E* / (R sigma_y) of each run, where the contact fills the unit patch."""
CONTACT_SIZES = (1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0)
USED = (0.3, 0.85)
"""The part of each window, as contact radius over patch, whose states are used: resolved, and inside the patch."""
REACH = 40.0
DEGREE = 3
OVERLAP = 0.005
"""Movement of the contact's edge by the penalty, over the size of a surface cell."""


@dataclass(frozen=True)
class Indentation:
    """States of a window where the contact is resolved, and what the last elastic one showed.

    radius, force, approach : (n,) contact radius, force per radian, approach of each state.
    onset : Hertz' central pressure at first yield (0 where no elastic state is resolved).
    hertz : force over Hertz' at the same approach in the last elastic state.
    Lengths in patches, the yield stress and Young's modulus are 1 (linear kinematics make the size of strains
    immaterial).
    """

    window: float
    radius: NDArray[np.float64]
    force: NDArray[np.float64]
    approach: NDArray[np.float64]
    onset: float
    hertz: float
    cells: int
    dofs: int
    iterations: int
    block: ContactBlock


def _isotropic(nu: float) -> tuple[float, float]:
    """Bulk and shear modulus for unit Young's modulus."""
    return 1 / (3 * (1 - 2 * nu)), 1 / (2 * (1 + nu))


UNIT = np.array([1.0, 1.0, 1.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5]) - np.outer(UNIT, UNIT) / 3
"""From strain (rr, tt, zz, engineering rz) to its deviator as a stress-like vector (rz once)."""


def radial_return(
    trial: NDArray[np.float64], bulk: float, shear: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return trial stresses (n, 4) to the von Mises cylinder of unit yield stress.

    Returns stresses (n, 4), consistent tangents (n, 4, 4) and the trial's von Mises stress (n,). Simo and Hughes,
    *Computational Inelasticity* (1998), box 3.2, without hardening.
    """
    mean = trial[:, :3].mean(axis=1)
    deviator = trial - mean[:, None] * UNIT
    norm = np.sqrt(np.sum(deviator[:, :3] ** 2, axis=1) + 2 * deviator[:, 3] ** 2)
    equivalent = np.sqrt(1.5) * norm
    plastic = equivalent > 1
    scale = np.where(plastic, 1 / np.maximum(equivalent, 1e-300), 1.0)
    direction = deviator / np.maximum(norm, 1e-300)[:, None]
    tangent = bulk * np.outer(UNIT, UNIT) + 2 * shear * scale[:, None, None] * DEVIATOR
    tangent -= (2 * shear * scale * plastic)[:, None, None] * direction[:, :, None] * direction[:, None, :]
    return scale[:, None] * deviator + mean[:, None] * UNIT, tangent, equivalent


def indent(window: float, *, nu: float, cells: int, coarsest: int) -> Indentation:
    """One run from first touch until the contact fills most of the patch.

    window : a E* / (R sigma_y) where the contact radius would equal the patch.
    cells : cells over the patch; coarsest : those of the coarsest mesh of the study, on which the growth of cells is
        set.
    RuntimeError when a step does not converge however small.
    """
    curvature = window * (1 - nu**2)  # 1/R: window = patch E*/(R sigma_y), patch = sigma_y = E = 1
    block = ContactBlock(
        patch=1.1, cells=cells, reach=REACH, depth=REACH, growth=1.35 ** (coarsest / cells), layer=None
    )
    mesh, _, facet_tags = compat.load_mesh(block)
    space = compat.function_space(mesh, 2, (2,))
    u = compat.function(space)
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
    stress = compat.quadrature_function(mesh, 4, DEGREE)
    tangent = compat.quadrature_function(mesh, 16, DEGREE)
    approach = compat.constant(mesh, 0.0)
    penalty = 3 / (OVERLAP * block.patch / cells * window)
    r = ufl.SpatialCoordinate(mesh)[0]

    def strain(v: Any) -> Any:
        slope = ufl.grad(v)
        return ufl.as_vector([slope[0, 0], v[0] / r, slope[1, 1], slope[0, 1] + slope[1, 0]])

    inside = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": DEGREE})
    surface = ufl.Measure("ds", domain=mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": DEGREE})
    surface = surface(block.facet_tags["loaded"])
    overlap = approach - curvature * r * r / 2 - u[1]
    touching = ufl.conditional(ufl.gt(overlap, 0.0), 1.0, 0.0)
    pressure = penalty * overlap * touching
    matrix = ufl.as_matrix([[tangent[4 * i + j] for j in range(4)] for i in range(4)])
    residual_form = compat.form(ufl.inner(stress, strain(test)) * r * inside - pressure * test[1] * r * surface)
    jacobian_form = compat.form(
        ufl.inner(matrix * strain(trial), strain(test)) * r * inside
        + penalty * touching * trial[1] * test[1] * r * surface
    )
    force_form = compat.form(pressure * r * surface)
    conditions = compat.fixed(space, facet_tags, block.facet_tags["axis"], [0])
    for side in ("side", "bottom"):
        conditions += compat.fixed(space, facet_tags, block.facet_tags[side], [0, 1])
    strains = compat.quadrature_values(strain(u), mesh, DEGREE)
    bulk, shear = _isotropic(nu)
    elastic = bulk * np.outer(UNIT, UNIT) + 2 * shear * DEVIATOR
    edge = _EdgeFinder(space, block, curvature)

    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("cholesky")
    solver.getPC().setFactorSolverType("mumps")

    old_strain = strains()
    old_stress = np.zeros_like(old_strain)
    equivalent = np.zeros(len(old_strain))
    new_strain, new_stress = old_strain, old_stress
    iterations = 0

    def residual() -> Any:
        nonlocal equivalent, new_strain, new_stress
        new_strain = strains()
        new_stress, moduli, equivalent = radial_return(old_stress + (new_strain - old_strain) @ elastic.T, bulk, shear)
        stress.x.array[:] = new_stress.ravel()
        tangent.x.array[:] = moduli.ravel()
        vector = compat.assemble_vector(residual_form)
        compat.zero_fixed(vector, conditions)
        return vector

    def newton() -> bool:
        nonlocal iterations
        vector = residual()
        size = vector.norm()
        for count in range(15):
            jacobian = compat.assemble_matrix(jacobian_form, conditions)
            solver.setOperators(jacobian)
            step = vector.duplicate()
            solver.solve(vector, step)
            iterations += 1
            start, before, fraction = u.x.array.copy(), size, 1.0
            while True:
                u.x.array[:] = start - fraction * step.array
                vector = residual()
                size = vector.norm()
                # the first step changes the contact set: its residual says nothing yet
                if count == 0 or fraction < 0.1 or size < (1 - 0.1 * fraction) * before:
                    break
                fraction /= 2
            # residual forces against the load
            if count > 0 and size < 1e-7 * compat.fem.assemble_scalar(force_form):
                return True
        return False

    history = [(0.0, u.x.array.copy())]
    radii, forces, approaches, onset, hertz = [], [], [], 0.0, 0.0
    low, high = 0.0025 * curvature, 0.9 * curvature
    waiting = list(np.geomspace(low, high, 1 + int(np.ceil(np.log(high / low) / np.log(1.35)))))
    cuts = 0
    while waiting:
        target = waiting[0]
        approach.value = target
        if len(history) == 2:
            (d0, u0), (d1, u1) = history
            u.x.array[:] = u1 + (u1 - u0) * (target - d1) / (d1 - d0)
        if not newton():
            cuts += 1
            if cuts > 12:
                raise RuntimeError(f"indentation to {target:g} in window {window:g} does not converge")
            u.x.array[:] = history[-1][1]
            waiting.insert(0, 0.5 * (history[-1][0] + target))
            continue
        waiting.pop(0)
        history = [history[-1], (target, u.x.array.copy())]
        old_strain, old_stress = new_strain, new_stress
        radius, force = edge(u.x.array, target), float(compat.fem.assemble_scalar(force_form))
        if np.max(equivalent) <= 1 and radius > USED[0]:
            # Hertz' central pressure of that load, over the largest von Mises stress: what yield begins at
            hertz = force / (4 / 3 / (1 - nu**2) * np.sqrt(target**3 / curvature) / (2 * np.pi))
            onset = (6 * 2 * np.pi * force * curvature**2 / (np.pi**3 * (1 - nu**2) ** 2)) ** (1 / 3) / np.max(
                equivalent
            )
        if radius > USED[1]:
            break
        if radius > USED[0]:
            radii.append(radius)
            forces.append(force)
            approaches.append(target)
    return Indentation(
        window,
        np.array(radii),
        np.array(forces),
        np.array(approaches),
        onset,
        hertz,
        compat.cell_count(mesh),
        compat.dof_count(space),
        iterations,
        block,
    )


class _EdgeFinder:
    """Where the gap closes: found from the open side, between the two Gauss points where the penalty changes."""

    def __init__(self, space: Any, block: ContactBlock, curvature: float) -> None:
        at = space.tabulate_dof_coordinates()
        nodes = np.flatnonzero((at[:, 1] < 1e-7) & (at[:, 0] < block.patch * (1 + 1e-7)))
        nodes = nodes[np.argsort(at[nodes, 0])]
        self.dofs = 2 * nodes + 1
        g = np.array([-1, 1]) / np.sqrt(3)
        self.shape = np.stack([g * (g - 1) / 2, 1 - g * g, g * (g + 1) / 2])
        corners = at[nodes[::2], 0]
        self.x = (corners[:-1, None] + np.diff(corners)[:, None] * (1 + g) / 2).ravel()
        self.profile = curvature * self.x**2 / 2

    def __call__(self, values: NDArray[np.float64], approach: float) -> float:
        """Contact radius; beyond the patch's end when the gap is closed nearly everywhere."""
        w = values[self.dofs]
        gap = self.profile - approach
        gap += sum(
            part[:, None] * shape for part, shape in zip((w[:-2:2], w[1:-1:2], w[2::2]), self.shape, strict=True)
        ).ravel()
        closed = np.flatnonzero(gap < 0)
        last = int(closed[-1]) if closed.size else 0
        if last + 5 >= gap.size:
            return float(self.x[-1])
        # the gap opens like a distance to the power 3/2
        chosen = np.arange(last + 2, last + 5)
        slope, offset = np.polyfit(self.x[chosen], np.maximum(gap[chosen], 0) ** (2 / 3), 1)
        return float(np.clip(-offset / slope, self.x[last], self.x[last + 1]))


CAP = 2.8
"""Hardness over yield stress in the capped model that the plastic one is compared to (Tabor)."""


def capped(
    loads: NDArray[np.float64], sizes: NDArray[np.float64], nu: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Contact sizes and approaches of an elastic body whose pressure is capped at CAP yield stresses.

    loads : what is carried; sizes : contact sizes near the answer, which choose the scale of each problem; all in the
    units of `_express`.

    The condensed body of the contact cases, one mesh; each load by bisection over the approach, each approach by an
    active set with three states: open, in contact, at the cap.
    """
    block = ContactBlock(patch=1.3, cells=104, reach=1.3e5, depth=1.3e5)
    body = elastic_body(block, {"substrate": (1.0, nu)}, axisymmetric=True)
    stiffness = 1 / (1 - nu**2)
    parabola = weighted_profile(body.nodes, lambda x: x * x / 2, axisymmetric=True)

    def pressures(profile: NDArray[np.float64], approach: float) -> NDArray[np.float64]:
        state = np.where(profile < approach * body.weights, 1, 0)
        for _ in range(200):
            free = state == 1
            pressure = np.where(state == 2, CAP, 0.0)
            right = (approach * body.weights - profile - body.compliance @ pressure)[free]
            pressure[free] = np.linalg.solve(body.compliance[np.ix_(free, free)], right)
            gap = body.compliance @ pressure + profile - approach * body.weights
            small = 1e-12 * approach * body.weights
            new = np.where(free & (pressure < 0), 0, state)
            new = np.where(free & (pressure > CAP), 2, new)
            # a node leaves the cap where the gap has opened, and joins the contact where the bodies would overlap
            new = np.where(((state == 2) & (gap > small)) | ((state == 0) & (gap < -small)), 1, new)
            if np.array_equal(new, state):
                return pressure
            state = new
        raise RuntimeError(f"the capped contact at an approach of {approach:g} does not settle")

    radius, depth = np.empty(loads.size), np.empty(loads.size)
    for i, (load, size) in enumerate(zip(loads, sizes, strict=True)):
        force = load / (2 * np.pi * size**2)
        profile = size / stiffness * parabola
        low, high = 0.0, 2 * size / stiffness
        for _ in range(45):
            middle = 0.5 * (low + high)
            pressure = pressures(profile, middle)
            low, high = (middle, high) if body.weights @ pressure < force else (low, middle)
        last = int(np.flatnonzero(pressure > 0)[-1])
        radius[i] = 0.5 * (body.nodes[last] + body.nodes[last + 1]) * size
        depth[i] = middle * size * stiffness
    return radius, depth


def solve_indentation(*, nu: float, sizes: Any, cells: int) -> Result:
    """Indent on three meshes and express the results at given contact sizes."""
    started = provenance.processor_time()
    layers.bodies(nu, None)
    sizes = sorted(float(size) for size in sizes)
    if not sizes or sizes[0] < 1.3 or sizes[-1] > 0.8 * WINDOWS[-1]:
        raise ValueError(f"sizes {sizes}: a E*/(R sigma_y) must lie between 1.3 and {0.8 * WINDOWS[-1]:g}")
    if cells < 10:
        raise ValueError(f"cells {cells}: fewer than 10 over the patch do not resolve the contact")
    meshes = [cells, round(cells * 4 / 3), round(cells * 11 / 6)]
    levels, runs = [], []
    for count in meshes:
        parts = [indent(window, nu=nu, cells=count, coarsest=cells) for window in WINDOWS]
        runs.append(parts)
        levels.append(
            {
                "parameters": parts[0].block.__dict__,
                "cells": parts[0].cells,
                "dofs": parts[0].dofs,
                "size": cells / count,
            }
        )
    curves = [_express(parts, nu, np.array(sizes)) for parts in runs]
    quantities = []
    for name, unit, note in (
        ("mean_pressure", "sigma_y", "load over pi a^2"),
        ("approach", "R (sigma_y / E*)^2", ""),
        ("load", "R^2 sigma_y^3 / E*^2", ""),
    ):
        # over four decades: relative errors, by the logarithm
        logarithms = np.log(np.stack([c[name] for c in curves]))
        figures = estimate([level["size"] for level in levels], logarithms, expected_order=1.0)
        values = np.exp(figures.values)
        bar = np.maximum(figures.error_bar, 0.5 * np.sqrt(np.mean(figures.error_bar**2))) * values
        quantities.append(
            Quantity(
                name,
                unit,
                "a E* / (R sigma_y)",
                as_coordinates([[s, 0, 0] for s in sizes]),
                values.tolist(),
                bar.tolist(),
                figures.order,
                note,
            )
        )
    figures = estimate(
        [level["size"] for level in levels], np.array([[parts[0].onset] for parts in runs]), expected_order=2.0
    )
    quantities.append(
        Quantity(
            "yield_onset",
            "sigma_y",
            "first yield",
            [[0.0, 0.0, 0.0]],
            figures.values.tolist(),
            figures.error_bar.tolist(),
            figures.order,
            "Hertz' central pressure at which the largest von Mises stress of the elastic contact reaches sigma_y",
        )
    )
    # the capped model at the loads of the plastic one; its edge is known to half a cell of a hundred and four on 1.3
    load = np.array(quantities[2].values)
    radius, depth = capped(load, np.array(sizes), nu)
    for name, unit, values, share in (
        ("mean_pressure_capped", "sigma_y", load / (np.pi * radius**2), 2 * 0.5 * 1.3 / 104),
        ("contact_size_capped", "a E* / (R sigma_y)", radius, 0.5 * 1.3 / 104),
        ("approach_capped", "R (sigma_y / E*)^2", depth, 1e-3),
    ):
        quantities.append(
            Quantity(
                name,
                unit,
                "a E* / (R sigma_y)",
                as_coordinates([[s, 0, 0] for s in sizes]),
                values.tolist(),
                (share * values).tolist(),
                None,
                f"elastic body, pressure capped at {CAP:g} sigma_y, at the plastic body's load for that contact size",
            )
        )
    xs, zs = (np.array([c for c in part if c <= 3]) for part in runs[0][0].block.lines())
    return Result(
        case="",
        problem="plasticity-sphere",
        sentence="A rigid sphere is pressed, without friction, into an elastic, perfectly plastic body "
        f"with nu {nu:g} (von Mises, small strains).",
        parameters={"nu": nu, "sizes": sizes, "cells": cells},
        normalisation="Contact sizes as a E* / (R sigma_y), with E* = E / (1 - nu^2); pressures over sigma_y.",
        far_field=f"Held fast {REACH:g} patches away (contacts are 0.3 to 0.85 of a patch): at most 1 % of the "
        "approach, next to nothing of the pressure.",
        mesh={
            "builder": "meshes.contact_block.ContactBlock",
            "levels": levels,
            "picture": {"x": xs.tolist(), "z": zs.tolist(), "note": "coarsest mesh near the contact"},
        },
        quantities=quantities,
        checks={
            "largest fall of the mean pressure": {
                "value": float(min(np.min(np.diff(curves[-1]["mean_pressure"])), 0.0)),
                "expected": 0.0,
                "tolerance": 0.02,
            },
            "load over Hertz' at the same approach, last elastic state": {
                "value": runs[-1][0].hertz,
                "expected": 1.0,
                "tolerance": 0.02,  # a contact of ten cells, the penalty and the far boundary
            },
        },
        versions=provenance.versions(),
        date=provenance.today(),
        time_s=provenance.processor_time() - started,
    )


def _express(parts: list[Indentation], nu: float, sizes: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Mean pressure, approach and load at contact sizes, from smooth curves through all states of all windows.

    The contact radius of a state is uncertain by a fraction of a cell, differently each time; a polynomial of degree
    five through ln a against ln approach, over about forty states, averages that out. The force is smooth as it is.
    """
    stiffness = 1 / (1 - nu**2)
    radius = np.concatenate([p.radius * p.window for p in parts])
    # R = 1 / curvature, curvature = window / stiffness: approach / (R (sigma_y/E*)^2), force / (R^2 sigma_y^3 / E*^2)
    approach = np.concatenate([p.approach * p.window / stiffness * stiffness**2 for p in parts])
    load = np.concatenate([2 * np.pi * p.force * p.window**2 for p in parts])
    position = np.log(approach)
    of_radius = np.polynomial.Polynomial.fit(position, np.log(radius), 5)
    of_load = np.polynomial.Polynomial.fit(position, np.log(load), 7)
    fine = np.linspace(position.min(), position.max(), 4001)
    found = np.interp(np.log(sizes), of_radius(fine), fine)
    total = np.exp(of_load(found))
    return {"mean_pressure": total / (np.pi * sizes**2), "approach": np.exp(found), "load": total}


PROBLEMS = (
    Problem(
        "plasticity-sphere",
        "a rigid sphere on an elastic, perfectly plastic body (axisymmetric, von Mises)",
        (
            POISSONS_RATIO,
            Parameter("sizes", CONTACT_SIZES, "contact sizes a E* / (R sigma_y)", kind=float, count=-1),
            Parameter("cells", 12, "cells over the patch on the coarsest of three meshes"),
        ),
        solve_indentation,
        {"plasticity-sphere-plain": {}},
    ),
)
